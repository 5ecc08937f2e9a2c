"""Linear equations with periodic coefficients, and how they are solved."""
