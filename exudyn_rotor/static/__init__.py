"""Loads that stand still: deflection, reactions, stress."""
