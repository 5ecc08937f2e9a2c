"""Shapes of motions as pictures, animations and VTK files; spectra and orbits of runs."""
