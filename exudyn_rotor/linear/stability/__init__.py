"""Growth over the speed, and its limits."""
