"""Cardan (universal) joint: it turns the second shaft unevenly, by its angle.

The second axis is e₂ = e₁ turned by β about a, and α the angle of the first fork from a, about e₁.
The pins of both forks stay at right angles to each other, so that (F. Duditza,
Kardangelenkgetriebe, 1973)

    tan α₂ = cos β tan α,   Ω₂/Ω₁ = cos β/(1 − sin² β sin² α).                              (1)

The cross carries no moment about its pins, so the moment M w on the second shaft is along its
normal; scaled by w·e₂ = 1,

    w = e₂ + sin β (sin α cos α a + cos β sin² α b)/(1 − sin² β sin² α),   b = e₂ × a,        (2)

whose part across the axis bends both shafts, at twice the spin speed. A spring k and a damper d
between both shafts act on

    η = α₂ − α₂(α) + w·(tilts of the second − tilts of the first),   M = k η + d η̇.         (3)
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, pi, sin

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.drives.connection import Connection
from exudyn_rotor.drives.coupling import check_same_place

_SAME_AXIS = 1e-6  # rad


@dataclass(frozen=True, eq=False, kw_only=True)
class CardanJoint(Connection):
    """Cardan joint between two shafts whose axes meet.

    Parameters
    ----------
    joint_angle : float
        Between the axes, β [rad], at least 0 and below π/2.
    stiffness : float
        Against twist between both shafts [N m/rad].
    damping : float, optional
        Likewise [N m s/rad].
    turn_direction : float, optional
        The second axis is the first one turned by β about the direction a at this angle from n1
        towards n2 of the first rotor [rad].
    fork_angle : float, optional
        Angle of the first fork from a, about e, at the start [rad].

    Raises
    ------
    TypeError, ValueError
        For bad input.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import CardanJoint
    >>> joint = CardanJoint(joint_angle=np.radians(20.0), stiffness=1e4)
    >>> [round(joint.speed_ratio(angle), 4) for angle in (0.0, np.pi / 2)]
    [0.9397, 1.0642]
    """

    joint_angle: float
    stiffness: float
    damping: float = 0.0
    turn_direction: float = 0.0
    fork_angle: float = 0.0

    def __post_init__(self) -> None:
        def keep(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        checks.keep_numbers(self, {"joint_angle": "rad"}, least=0.0, below=0.5 * pi)
        checks.keep_numbers(self, {"stiffness": "N m/rad"}, above=0.0)
        checks.keep_numbers(self, {"damping": "N m s/rad"}, least=0.0)
        checks.keep_numbers(self, {"turn_direction": "rad", "fork_angle": "rad"})
        angle = self.joint_angle
        a = np.array([cos(self.turn_direction), sin(self.turn_direction), 0.0])
        beside = np.array([-a[1], a[0], 0.0])  # e₁ × a
        axis = np.array([0.0, 0.0, cos(angle)]) - sin(angle) * beside
        keep("_axes", (a, np.cross(axis, a), axis))
        keep("_start", self._turned(self.fork_angle))

    @property
    def second_axis(self) -> np.ndarray:
        """e₂, shape (3,), in the axes (n1, n2, e) of the first rotor."""
        return self._axes[2]

    def speed_ratio(self, angle: float) -> float:
        """Return Ω₂/Ω₁ of the stiff joint (1).

        Parameters
        ----------
        angle : float
            Rotation of the first shaft from the start [rad].

        Raises
        ------
        TypeError, ValueError
            For bad input.
        """
        return self._ratio(checks.number(angle, "angle", "rad") + self.fork_angle)

    # -------------------------------------------------------------- law

    def _ratio(self, alpha: float) -> float:
        return cos(self.joint_angle) / (1.0 - (sin(self.joint_angle) * sin(alpha)) ** 2)

    def _turned(self, alpha: float) -> float:
        """Return α₂(α) of (1), without jumps."""
        c, s, k = cos(alpha), sin(alpha), cos(self.joint_angle)
        return alpha + atan2((k - 1.0) * s * c, c * c + k * s * s)

    def _normal(self, alpha: float) -> tuple[np.ndarray, np.ndarray]:
        """Return w of (2) and its derivative by α, each (3,)."""
        a, b, axis = self._axes
        c, s, k, q = cos(alpha), sin(alpha), cos(self.joint_angle), sin(self.joint_angle)
        share = 1.0 - (q * s) ** 2
        across, slope = s * c * a + k * s * s * b, (c * c - s * s) * a + 2.0 * k * s * c * b
        gain = 2.0 * q * q * s * c / share
        return axis + q * across / share, q * (slope + gain * across) / share

    def _deformation(self, x: np.ndarray) -> tuple[float, np.ndarray]:
        """Return η of (3) and its derivative by x (12,)."""
        axis, alpha = self._axes[2], x[5] + self.fork_angle
        w, slope = self._normal(alpha)
        first, second = np.array([x[3], x[4], 0.0]), x[9:] - axis * (axis @ x[9:])
        turned = self._turned(alpha) - self._start
        eta = axis @ x[9:] - turned + w @ (second - first)
        by_motion = np.zeros(12)
        by_motion[3:6], by_motion[9:] = -w, w
        by_motion[5] += slope @ (second - first)
        return float(eta), by_motion

    def _moment(self, x: np.ndarray, x_t: np.ndarray) -> tuple[float, np.ndarray]:
        eta, by_motion = self._deformation(x)
        return self.stiffness * eta + self.damping * float(by_motion @ x_t), by_motion

    def _forces(self, x: np.ndarray, x_t: np.ndarray) -> np.ndarray:
        moment, by_motion = self._moment(x, x_t)
        return -moment * by_motion

    def _tangent(self, x: np.ndarray, x_t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Leave out how the joint turns."""
        _, by_motion = self._deformation(x)
        both = np.outer(by_motion, by_motion)
        return self.stiffness * both, self.damping * both

    def _transmitted(self, x: np.ndarray, x_t: np.ndarray) -> float:
        return -self._moment(x, x_t)[0]

    def _energy(self, x: np.ndarray) -> float:
        return 0.5 * self.stiffness * self._deformation(x)[0] ** 2

    def _loss(self, x: np.ndarray, x_t: np.ndarray) -> float:
        return self.damping * float(self._deformation(x)[1] @ x_t) ** 2

    def _check_places(self, apart: np.ndarray, axis: np.ndarray) -> None:
        check_same_place(apart)
        if np.linalg.norm(axis - self.second_axis) > _SAME_AXIS:
            raise ValueError(
                f"other: its axis is {np.round(axis, 6).tolist()} in axes of the first rotor; "
                "joint_angle and turn_direction need "
                f"{np.round(self.second_axis, 6).tolist()}"
            )
