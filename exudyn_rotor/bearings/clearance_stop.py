"""Stop behind a clearance, with friction: rub in seals and back-up bearings.

With the eccentricity e, its rate ė and the penetration δ = e − c > 0, the stop pushes inwards with

    N = max(0, k δ + d δ ė/c),                                                             (1)

whose damping begins at zero with the contact (K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42
(1975)), and the friction on a journal of the radius R at the spin speed Ω opposes the sliding

    T = −μ N tanh(v_s/v_0),   v_s = R Ω + v_t,                                             (2)

Coulomb's friction, smooth below the speed v_0. Dry backward whirl follows where friction
overcomes the damping. Friction brakes the spin by the torque R T.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, tanh
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, LawWithTorque


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
    >>> stop.force([6e-4, 0.0], [0.0, 0.0], speed=100.0).round(6)
    array([-1000.,  -100.])
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

    def force(self, displacement: ArrayLike, velocity: ArrayLike, speed: float) -> np.ndarray:
        """Return the force on the journal (1), (2) [N], shape (2,).

        Parameters
        ----------
        displacement, velocity : array_like, shape (2,)
            Of the journal's centre from that of the stop [m], [m/s].
        speed : float
            Spin speed [rad/s].

        Raises
        ------
        TypeError, ValueError
            For bad input.
        """
        place = checks.vector(displacement, "displacement", "m", size=2)
        rate = checks.vector(velocity, "velocity", "m/s", size=2)
        return np.array(self._law(*place, *rate, 0.0, checks.number(speed, "speed", "rad/s")))

    @property
    def law_with_torque(self) -> LawWithTorque | None:
        """As :attr:`law`, with the torque of friction on the journal [N m]; None without friction.

        Scenes need it where the spin is free.
        """
        return self._law_with_torque if self.friction else None

    def _law(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float]:
        return self._law_with_torque(x, y, vx, vy, angle, speed)[:2]

    def _law_with_torque(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, float, float]:
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

    def _along(
        self, motion: np.ndarray, angles: np.ndarray, speed: float
    ) -> tuple[np.ndarray, np.ndarray]:
        forces, slopes = np.zeros((len(motion), 2)), np.zeros((len(motion), 2, 4))
        e = np.hypot(*motion[:, :2].T)
        touching = np.flatnonzero(e > self.clearance)
        place, rate, e = motion[touching, :2], motion[touching, 2:], e[touching, None]
        n = place / e
        t = n[:, ::-1] * [-1.0, 1.0]
        approach, along = ((rate * each).sum(axis=1, keepdims=True) for each in (n, t))
        depth, harder = e - self.clearance, self.damping / self.clearance
        rigid = self.stiffness + harder * approach
        N = np.maximum(depth * rigid, 0.0)
        pushes = N > 0.0
        N_q = pushes * (rigid * n + depth * harder * along / e * t)
        N_v = pushes * depth * harder * n
        share = np.tanh((self.radius * speed + along) / self.slip_speed)
        steep = (1.0 - share**2) / self.slip_speed
        T = self.friction * share * N
        T_q = self.friction * (share * N_q - N * steep * approach / e * t)
        T_v = self.friction * (share * N_v + N * steep * t)
        forces[touching] = -N * n - T * t
        across = (N * t - T * n)[:, :, None] * (t / e)[:, None]
        n, t = n[:, :, None], t[:, :, None]
        slopes[touching, :, :2] = n * N_q[:, None] + t * T_q[:, None] + across
        slopes[touching, :, 2:] = n * N_v[:, None] + t * T_v[:, None]
        return forces, slopes

    def equilibrium(self, speed: float, load: ArrayLike | None = None) -> np.ndarray:
        """Return the centre, shape (2,): an open stop carries nothing.

        Parameters
        ----------
        speed : float
            Spin speed [rad/s], which plays no part.
        load : array_like, shape (2,), optional
            Of no influence.

        Raises
        ------
        TypeError, ValueError
            For bad input.
        """
        checks.number(speed, "speed", "rad/s")
        if load is not None:
            checks.vector(load, "load", "N", size=2)
        return np.zeros(2)

    def coefficients(
        self, speed: float, load: ArrayLike | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness and damping of the open stop: zeros, each (2, 2).

        Parameters and errors are those of :meth:`equilibrium`.
        """
        self.equilibrium(speed, load)
        return np.zeros((2, 2)), np.zeros((2, 2))
