"""Steady motion under unbalance and harmonic loads."""
