"""From solid to reduced rotor: component modes, reduction, modes of a formulation, truncation."""
