"""Linear algebra of large models: factors, inertia relief, constrained solves, Lanczos modes."""
