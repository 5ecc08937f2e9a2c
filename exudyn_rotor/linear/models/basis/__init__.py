"""What the basis of a reduced rotor leaves out."""
