"""Linear models: what is analysed."""
