"""Evaluation of rotors by standards: what an analysis found against what is asked."""
