"""Flexible solid rotors about one fixed axis, for Exudyn multibody scenes."""
