"""Measurements behind ``extremes.py``: one function makes one row of its table."""
