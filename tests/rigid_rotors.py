"""Nonlinear equations of a rigid rotor of point masses on isotropic springs, for tests.

Written with finite rotations, without anything of the package: Newton's second law for every mass,
along the derivatives of its position by the coordinates, in axes that turn with the rotor.
"""

import numpy as np
from scipy.spatial.transform import Rotation

_STEP = 1e-4  # of central differences; forces are smooth over 1 m and 1 rad


class RigidRotor:
    """Masses on springs between points of the axis z and the ground.

    Coordinates in the rotor frame: displacement of the origin, rotation vector across the axis, and
    with a free spin its angle.
    """

    def __init__(self, nodes, masses, places, stiffness, damping, axial, speed, free):
        self.nodes, self.masses, self.speed = np.asarray(nodes), np.asarray(masses), speed
        self.places = np.column_stack([np.zeros((len(places), 2)), places])
        across = np.array([1.0, 1.0, 0.0])
        self.stiffness = stiffness * across + axial * np.array([0.0, 0.0, 1.0])
        self.damping, self.size = damping, 6 if free else 5

    def positions(self, points, q, t):
        angle = self.speed * t + (q[5] if self.size == 6 else 0.0)
        tilted = q[:3] + Rotation.from_rotvec([q[3], q[4], 0.0]).apply(points)
        return Rotation.from_rotvec([0.0, 0.0, angle]).apply(tilted)

    def left(self, q, v, a):
        """Return what forces lack, (size,), at t = 0 from coordinates, rates and accelerations."""

        def at(s, points):
            return self.positions(points, q + s * v + 0.5 * s**2 * a, s)

        ends = [at(s * _STEP, self.nodes) for s in (-2, -1, 0, 1, 2)]
        accelerations = np.tensordot([-1, 16, -30, 16, -1], ends, 1) / (12 * _STEP**2)
        held = [at(s * _STEP, self.places) for s in (-2, -1, 0, 1, 2)]
        rates = np.tensordot([1, -8, 0, 8, -1], held, 1) / (12 * _STEP)
        pull = self.stiffness * (held[2] - self.places) + self.damping * rates * [1, 1, 0]
        result = np.zeros(self.size)
        for i, e in enumerate(np.eye(self.size) * 1e-3):
            for points, forces in (
                (self.nodes, self.masses[:, None] * accelerations),
                (self.places, pull),
            ):
                moved = [self.positions(points, q + s * e, 0.0) for s in (-2, -1, 1, 2)]
                result[i] += np.sum(forces * np.tensordot([1, -8, 8, -1], moved, 1)) / 12e-3
        return result

    def exponents(self):
        """Return the exponents about the steady motion, which stands still in the rotor frame."""
        steady, still = np.zeros((3, self.size)), np.eye(self.size)[:5]
        for _ in range(3):  # Newton's method: the forces are all but linear
            K = np.array([self._slope(steady, 0, e) for e in still]).T[:5]
            steady[0, :5] -= np.linalg.solve(K, self.left(*steady)[:5])
        identity = np.eye(self.size)
        K, D, M = (
            np.array([self._slope(steady, order, e) for e in identity]).T for order in range(3)
        )
        left = -np.linalg.solve(M, np.hstack([K, D]))
        A = np.vstack([np.hstack([0.0 * identity, identity]), left])
        return np.linalg.eigvals(A)

    def _slope(self, about, order, e):
        step = (1e-3, 1.0, 10.0)[order]
        ends = []
        for s in (-2, -1, 1, 2):
            moved = about.copy()
            moved[order] += s * step * e
            ends.append(self.left(*moved))
        return np.tensordot([1, -8, 8, -1], ends, 1) / (12 * step)
