"""Rotors in Exudyn scenes: the only folder that talks to ``mbs``."""

ENTRY = "exudyn_rotor"  # the package's one entry of mbs.sys
