"""Cost of time steps and of the set-up."""
