"""A ring rotor and the closed forms of its forced motions."""

import numpy as np
from point_rotors import ring_rotor

from exudyn_rotor import Support

MASS, RADIUS, LENGTH = 10.0, 0.1, 0.2  # ring rotor: I_p = m r², I_t = m (r²/2 + l²)
K, C = 4e5, 200.0  # critical speed sqrt(K/MASS) = 200 rad/s
TILT_K, TILT_C = 5e4, 10.0
SPEEDS = np.linspace(0.0, 600.0, 31)
# closed forms are met to rounding times the condition of the equations near resonance
EXACT = 1e-11


def rings(modes: int = 0, point_mass: float = 0.0):
    """Return the ring rotor, rigid by default, with equal masses beside both rings' first node."""
    rotor = ring_rotor(RADIUS, LENGTH, MASS)
    if point_mass:
        for z in (-LENGTH, LENGTH):
            rotor = rotor.add_point_mass([RADIUS, 0.0, z], point_mass)
    rotor = rotor.with_interface("mid", range(10))
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.reduce(modes)


def held(stiffness=K, damping=C) -> list[Support]:
    """Return a support in the middle: translations and tilts are then oscillators of their own."""
    return [Support("mid", stiffness, damping, TILT_K, TILT_C)]


def oscillator(k, c, m, rate):
    return 1.0 / (k - m * rate**2 + 1j * c * rate)


def close(found, expected, tolerance=EXACT):
    return np.abs(found - expected).max() <= tolerance * np.abs(expected).max()
