"""Wrong physics, one line at a time, that the tests must notice."""
