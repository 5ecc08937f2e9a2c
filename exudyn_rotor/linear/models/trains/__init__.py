"""Several rotors."""
