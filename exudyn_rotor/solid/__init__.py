"""The rotor as a finite-element model: matrices, interfaces, checks, sources of models."""
