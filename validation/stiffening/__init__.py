"""Centrifugal stiffening beside nonlinear solids, beams and plates."""
