"""A rigid rotor on ground that shakes."""

from functools import cache

import numpy as np
from point_rotors import ring_rotor

from exudyn_rotor import BaseRecord, Support

ENDS = ("left", "right")


@cache
def rigid():
    rotor = ring_rotor(0.1, 0.15, 5.0)
    return rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)


def springs(omega, ratio=0.0):
    """Return supports on which the rotor's 5 kg have a natural frequency [rad/s]."""
    k = 2.5 * omega**2 * np.eye(3)
    return [Support(name, k, 5.0 * ratio * omega * np.eye(3)) for name in ENDS]


def record(function, end, step, direction=(1.0, 0.0, 0.0)):
    t = np.linspace(0.0, end, round(end / step) + 1)
    return BaseRecord(t, np.outer(function(t), direction))
