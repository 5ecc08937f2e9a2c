"""Measurements behind the table of extremes: one function makes one row."""
