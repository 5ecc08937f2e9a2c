"""Full finite-element rotors."""
