"""Supports, bearings and foundations in scenes."""
