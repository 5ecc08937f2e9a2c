"""Stress of a running rotor: static by the rotation, dynamic by the modes; peaks and histories."""
