"""Drives, couplings and gears in scenes."""
