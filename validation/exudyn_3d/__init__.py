"""The fixed-axis body beside Exudyn's own 3D body."""
