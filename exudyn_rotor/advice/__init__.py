"""Advice: what a scene requires before a run, and whether it held after it."""
