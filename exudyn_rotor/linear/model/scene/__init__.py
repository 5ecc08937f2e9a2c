"""Scenes with a rotor, linearised about their steady motion."""
