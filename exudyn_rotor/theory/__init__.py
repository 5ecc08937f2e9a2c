"""The formulation: axis, coordinates, inertia invariants, stiffening, equations of motion."""
