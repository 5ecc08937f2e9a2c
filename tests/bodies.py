"""A point mass and rotors of two rings, whose motions have closed forms."""

import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import SolidRotor

MASS = 12.0
DISC, SHAFT = (0.3, 0.02), (0.1, 0.4)  # radius, half length of two rings
BODIES = pytest.mark.parametrize("shape", [DISC, SHAFT], ids=["disc", "shaft"])


def point_mass() -> SolidRotor:
    return SolidRotor.from_matrices(
        np.eye(3), np.zeros((3, 3)), [[0.0, 0.0, 0.0]], "z", interfaces={"at": [0]}
    )


def rings(shape: tuple[float, float]) -> SolidRotor:
    """Return a free rotor of two rings; the interface 'all' follows its mean motion."""
    return ring_rotor(*shape, MASS).with_interface("all", range(10))


def moments(shape: tuple[float, float]) -> tuple[float, float]:
    """Return I_p and I_t of two rings."""
    radius, half_length = shape
    return MASS * radius**2, MASS * (radius**2 / 2 + half_length**2)
