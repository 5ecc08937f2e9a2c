"""Published and closed-form references of beams and plates."""
