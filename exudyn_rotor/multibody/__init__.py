"""Rotors in Exudyn scenes: the only folder that talks to ``mbs``."""
