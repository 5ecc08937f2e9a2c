"""How linear equations are solved; knows nothing of rotors."""
