"""Laws of drives, couplings and gears, for scenes and linear analyses alike."""
