"""Stop behind a clearance, with friction: rub in seals and back-up bearings.

The damping begins at zero with the contact (K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42
(1975)); friction is Coulomb's, smooth below the speed v_0. Dry backward whirl follows where it
overcomes the damping. It brakes the spin by R T.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, tanh
from typing import ClassVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, Numbers, Pair, turned


@dataclass(frozen=True, eq=False, kw_only=True)
class ClearanceStop(Bearing):
    """Stop behind a clearance; a rub.

    At the penetration δ it pushes with ``N = max(0, k δ + d δ δ̇/c)`` (1), and friction opposes the
    sliding speed v_s with ``μ N tanh(v_s/v_0)`` (2).

    Linear analyses see it open: it has no coefficients, for small motions do not touch it.

    Parameters
    ----------
    interface : str
        Interface of the rotor that may touch.
    radius : float
        Of the journal [m].
    clearance : float
        Radial clearance [m].
    stiffness : float
        Of the contact [N/m].
    damping : float, optional
        Of the contact, at a penetration as large as the clearance [N s/m].
    friction : float, optional
        Coefficient of friction.
    slip_speed : float, optional
        Sliding speed v_0 below which the friction is smooth [m/s].
    load : array_like, shape (2,), optional
        Of no influence.

    Raises
    ------
    TypeError, ValueError
        For sizes that are not above zero, negative damping or friction.

    Examples
    --------
    A journal 0.1 mm inside the stop, which it slides along:

    >>> from exudyn_rotor import ClearanceStop
    >>> stop = ClearanceStop(
    ...     interface="left", radius=0.05, clearance=5e-4, stiffness=1e7, friction=0.1
    ... )
    >>> [round(part, 6) for part in stop.law(6e-4, 0.0, 0.0, 0.0, angle=0.0, speed=100.0)]
    [-1000.0, -100.0]
    """

    carries: ClassVar[bool] = False  # while it is open
    _unloaded: ClassVar[bool] = True

    radius: float
    clearance: float
    stiffness: float
    damping: float = 0.0
    friction: float = 0.0
    slip_speed: float = 0.01

    def __post_init__(self) -> None:
        super().__post_init__()
        positive = {"radius": "m", "clearance": "m", "stiffness": "N/m", "slip_speed": "m/s"}
        checks.keep_numbers(self, positive, above=0.0)
        checks.keep_numbers(self, {"damping": "N s/m", "friction": ""}, least=0.0)

    def law_with_torque(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float, float]:
        """Return the force on the journal (1), (2) [N], and the torque of friction [N m]."""
        e = hypot(x, y)
        depth = e - self.clearance
        if depth <= 0.0:
            return 0.0, 0.0, 0.0
        nx, ny = x / e, y / e
        approach = vx * nx + vy * ny
        normal = max(0.0, depth * (self.stiffness + self.damping * approach / self.clearance))
        sliding = self.radius * speed + vy * nx - vx * ny
        drag = self.friction * normal * tanh(sliding / self.slip_speed)
        return drag * ny - normal * nx, -drag * nx - normal * ny, -self.radius * drag

    def slopes(self, x: float, y: float, vx: float, vy: float, angle: float, speed: float) -> Pair:
        """Return less the derivatives (2, 2) of :meth:`law` by place and by velocity."""
        if hypot(x, y) <= self.clearance:
            return np.zeros((2, 2)), np.zeros((2, 2))
        found = np.reshape(self._contact(x, y, vx, vy, speed)[2:], (2, 4))
        return found[:, :2], found[:, 2:]

    def law_along(self, motion: np.ndarray, angles: np.ndarray, speed: float) -> Pair:
        """Return forces (t, 2) and less their derivatives (t, 2, 4); see :class:`Bearing`."""
        touching = np.hypot(*motion[:, :2].T) > self.clearance
        found = np.zeros((len(motion), 10))
        found[touching] = np.stack(self._contact(*motion[touching].T, speed), axis=-1)
        return found[:, :2], found[:, 2:].reshape(-1, 2, 4)

    def _contact(
        self, x: Numbers, y: Numbers, vx: Numbers, vy: Numbers, speed: float
    ) -> list[Numbers]:
        """Return force and tangent of a stop that is touched, its rows by x, y, ẋ and ẏ.

        With the directions n outwards and t = e × n, ``F = −N n − T t``.
        """
        e = np.hypot(x, y)
        nx, ny = x / e, y / e
        approach, along = vx * nx + vy * ny, vy * nx - vx * ny
        depth, harder = e - self.clearance, self.damping / self.clearance
        rigid = self.stiffness + harder * approach
        N = np.maximum(depth * rigid, 0.0)
        pushes = N > 0.0
        # derivatives of N and T by motions along n and t, and by their rates
        N_n, N_t, N_a = pushes * rigid, pushes * depth * harder * along / e, pushes * depth * harder
        share = np.tanh((self.radius * speed + along) / self.slip_speed)
        steep = N * (1.0 - share**2) / self.slip_speed
        T, T_n, T_a = (self.friction * share * X for X in (N, N_n, N_a))
        T_t = self.friction * (share * N_t - steep * approach / e)
        T_b = self.friction * steep
        by_place = turned(nx, ny, N_n, N_t - T / e, T_n, T_t + N / e)
        by_rate = turned(nx, ny, N_a, 0.0, T_a, T_b)
        force = [T * ny - N * nx, -T * nx - N * ny]
        return [*force, *by_place[:2], *by_rate[:2], *by_place[2:], *by_rate[2:]]

    def _matrices(self, speed: float, load: np.ndarray) -> Pair:
        """Return zeros, as of an open stop."""
        return np.zeros((2, 2)), np.zeros((2, 2))
