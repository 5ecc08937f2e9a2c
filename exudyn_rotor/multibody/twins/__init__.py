"""The twins of Exudyn's own calls."""
