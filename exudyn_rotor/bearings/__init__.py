"""Bearings and supports: their laws, for scenes and linear analyses alike."""
