"""Nonlinear steady motion: harmonic balance on a linear rest, branches, their stability."""
