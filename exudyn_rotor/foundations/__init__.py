"""What carries the supports of a rotor, and how the ground moves."""
