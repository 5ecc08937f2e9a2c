"""Exponents of linear equations, for tests that compare two models."""

import numpy as np

from exudyn_rotor.linear.equations import PeriodicSystem
from exudyn_rotor.linear.solve.motions import motions_of


def exponents(system: PeriodicSystem) -> np.ndarray:
    """Return the 2k exponents of one system [1/s], descending in their real parts."""
    values = motions_of([system])[0].values
    both = np.r_[values, values.conj()]
    return both[np.argsort(-both.real, kind="stable")]


def fold(exponents: np.ndarray, base: float) -> np.ndarray:
    """Bring imaginary parts into (−base/2, base/2]; no change for ``base = 0``."""
    if base == 0.0:
        return exponents
    return exponents - 1j * base * np.ceil(exponents.imag / base - 0.5)
