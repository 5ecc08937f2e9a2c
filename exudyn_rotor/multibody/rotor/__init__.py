"""Rotors in a scene: their coordinates, nodes, markers and sensors."""
