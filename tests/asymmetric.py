"""A shaft with two bending stiffnesses: a disc between two bearing masses, as point masses."""

import numpy as np

from exudyn_rotor import SolidRotor
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.axis import rotations, translations

DISC, END = 10.0, 1.0  # mass of the disc and of each end [kg]
SHAFT = np.array([4e5, 6e5])  # bending stiffness in the rotor's x and y [N/m]
LENGTH, RADIUS = 0.4, 0.1  # [m]


def asymmetric_shaft() -> ReducedRotor:
    """Return the rotor, axis z, with the interfaces 'left' and 'right' and two bending modes.

    The disc, four points on a circle, is held by SHAFT against the mean of the ends, which are on
    the axis; everything else is rigid.
    """
    points = [(RADIUS, 0, 0), (0, RADIUS, 0), (-RADIUS, 0, 0), (0, -RADIUS, 0)]
    nodes = np.array([*points, (0, 0, -LENGTH / 2), (0, 0, LENGTH / 2)])
    mass = np.kron(np.diag([DISC / 4] * 4 + [END] * 2), np.eye(3))
    # disc against ends without momentum; of unit modal mass
    shape = np.array([1.0] * 4 + [-0.5 * DISC / END] * 2)
    shape /= np.sqrt(shape**2 @ np.diag(mass)[::3])
    bending = np.kron(shape[:, None], np.eye(3)[:, :2])
    rates = SHAFT * (shape[0] - shape[-1]) ** 2
    soft = np.hstack([translations(6), rotations(nodes, np.zeros(3)), bending])
    rest = np.eye(18) - soft @ np.linalg.pinv(soft)
    stiffness = mass @ bending @ np.diag(rates) @ bending.T @ mass + 1e9 * rest
    rotor = SolidRotor.from_matrices(
        mass, stiffness, nodes, "z", interfaces={"left": [4], "right": [5]}
    )
    return rotor.reduce(2)
