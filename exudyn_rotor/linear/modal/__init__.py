"""Natural frequencies over the speed, and critical speeds."""
