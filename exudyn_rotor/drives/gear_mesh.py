"""Mesh of two external gears on parallel axes: a spring along the line of action.

With r from the centre of the first gear to the pitch point, t = e × r and the flank s = ±1, the
flank of the first gear pushes that of the second along

    n = cos β_b (s cos α t + sin α r) − s sin β_b e,   tan β_b = tan β cos α,               (1)

α the transverse pressure angle and β the helix angle at the pitch circle. Displacements u and
rotations φ of the gears bring the flanks together by (M. Kubur et al., J. Vib. Acoust. 126 (2004))

    δ = n·(u₁ − u₂) + (r_p1 r × n)·φ₁ + (r_p2 r × n)·φ₂ = vᵀ x,   r_p = r_b/cos α,           (2)

in which the rotations about e have the factors s r_b cos β_b. The mesh force N = k δ + d δ̇ acts as
f = −v N, so that the stiffness matrix is k v vᵀ. With backlash both flanks count, each with δ − b/2
in place of δ, and a flank only pushes: N = max(0, …) where δ > b/2, else 0. The stiffness may vary
with the rotation of the first gear, k(φ₁) = k (1 + Σ_j a_j cos(j z₁ φ₁)); the moment −k′(φ₁) δ²/2
that goes with it conserves energy.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, pi, sin, tan

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.drives.connection import ABOUT_AXIS, Connection, Springs

_SAME_RATIO = 1e-6  # of radii and numbers of teeth
_SAME_PLACE = 1e-3  # of the centre distance


@dataclass(frozen=True, eq=False, kw_only=True)
class GearMesh(Connection):
    """Mesh of two external gears on parallel axes.

    Parameters
    ----------
    radii : array_like, shape (2,)
        Base radii of the first and the second gear [m].
    stiffness : float
        Mean stiffness of the mesh along the line of action [N/m].
    damping : float, optional
        Along the line of action [N s/m].
    pressure_angle : float, optional
        In the plane of rotation, at the centre distance as mounted [rad]; 20° by default.
    helix_angle : float, optional
        At the pitch circle [rad], positive where the first gear is right-handed about e.
    line_angle : float, optional
        Direction from the first centre to the second: angle about e from n1 of the first rotor
        [rad].
    flank : {1, -1}, optional
        1 where the first gear drives with a positive torque about e, or is driven by a negative
        one. What linear analyses take, and scenes without backlash.
    backlash : float, optional
        Along the line of action, of both sides together [m]. Without it teeth never part.
    teeth : array_like of two int, optional
        Numbers of teeth; needed for a stiffness that varies.
    variation : array_like, optional
        Amplitudes a_j of the harmonics of the mesh frequency, over the mean stiffness.

    Raises
    ------
    TypeError, ValueError
        For bad input, e.g. numbers of teeth in another ratio than the radii.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import GearMesh
    >>> mesh = GearMesh(radii=[0.05, 0.1], stiffness=2e8, teeth=[20, 40])
    >>> mesh.direction.round(3)
    array([ 0.342,  0.94 ,  0.   ,  0.   ,  0.   ,  0.05 , -0.342, -0.94 ,
           -0.   ,  0.   ,  0.   ,  0.1  ])
    """

    radii: np.ndarray
    stiffness: float
    damping: float = 0.0
    pressure_angle: float = pi / 9.0
    helix_angle: float = 0.0
    line_angle: float = 0.0
    flank: int = 1
    backlash: float | None = None
    teeth: np.ndarray | None = None
    variation: np.ndarray = ()

    def __post_init__(self) -> None:
        checks.keep(self, radii=checks.one_or_each(self.radii, "radii", "m", 2, above=0.0))
        checks.keep_numbers(self, {"stiffness": "N/m"}, above=0.0)
        checks.keep_numbers(self, {"damping": "N s/m"}, least=0.0)
        checks.keep_numbers(self, {"pressure_angle": "rad"}, above=0.0, below=0.5 * pi)
        checks.keep_numbers(self, {"helix_angle": "rad"}, above=-0.5 * pi, below=0.5 * pi)
        checks.keep_numbers(self, {"line_angle": "rad"})
        if checks.whole_number(self.flank, "flank") not in (1, -1):
            raise ValueError(f"flank: needs 1 or -1, got {self.flank}")
        if self.backlash is not None:
            checks.keep_numbers(self, {"backlash": "m"}, least=0.0)
        self._check_teeth()
        sides = (self.flank,) if self.backlash is None else (self.flank, -self.flank)
        flanks = np.array([self._direction(side) for side in sides])
        checks.keep(self, _flanks=checks.read_only(flanks))

    def _check_teeth(self) -> None:
        amplitudes = checks.vector(self.variation, "variation", size=None)
        checks.keep(self, variation=amplitudes)
        if np.abs(amplitudes).sum() >= 1.0:
            raise ValueError(
                "variation: needs amplitudes whose sum is below 1, or the stiffness may vanish, "
                f"got {checks.shown(amplitudes.tolist())}"
            )
        if self.teeth is None and amplitudes.size:
            raise ValueError("variation: needs the numbers of teeth; give teeth=[…, …]")
        if self.teeth is None:
            return
        teeth = checks.whole_numbers(self.teeth, "teeth", least=1)
        checks.keep(self, teeth=teeth)
        if teeth.shape != (2,):
            raise ValueError(f"teeth: needs two whole numbers, got {len(teeth)}")
        if abs(teeth[0] * self.radii[1] / (teeth[1] * self.radii[0]) - 1.0) > _SAME_RATIO:
            raise ValueError(
                f"teeth: {teeth[0]} to {teeth[1]} is not the ratio of the radii, "
                f"{self.radii[0]:g} to {self.radii[1]:g} m; give radii in the ratio of the teeth"
            )

    @property
    def direction(self) -> np.ndarray:
        """v of (2) for the flank, shape (12,): the stiffness matrix of the mesh is k v vᵀ.

        Rows: displacement of the first gear along (n1, n2, e) of the first rotor, rotation about
        them, then the same of the second gear in the same axes.
        """
        return self._flanks[0]

    @property
    def center_distance(self) -> float:
        """Distance of the axes [m]."""
        return float(self.radii.sum() / cos(self.pressure_angle))

    @property
    def mean_speed_ratio(self) -> float:
        """Speed of the second rotor over that of the first, ``−r1/r2``."""
        return -float(self.radii[0] / self.radii[1])

    def _direction(self, flank: int) -> np.ndarray:
        alpha, angle = self.pressure_angle, self.line_angle
        base_helix = atan(tan(self.helix_angle) * cos(alpha))
        radial = np.array([cos(angle), sin(angle), 0.0])
        along, axis = np.array([-sin(angle), cos(angle), 0.0]), np.array([0.0, 0.0, 1.0])
        normal = cos(base_helix) * (flank * cos(alpha) * along + sin(alpha) * radial)
        normal = normal - flank * sin(base_helix) * axis
        lever = np.cross(radial, normal) / cos(alpha)
        first, second = self.radii
        return np.hstack([normal, first * lever, -normal, second * lever])

    def matrices(self) -> tuple[np.ndarray, np.ndarray]:
        """Return mean stiffness and damping matrix, each (12, 12), in the rows of `direction`."""
        both = np.outer(self.direction, self.direction)
        return self.stiffness * both, self.damping * both

    def springs(self, x: np.ndarray, x_t: np.ndarray) -> Springs:
        """Return a spring and damper for each flank in reach; without backlash for the one.

        A flank that would pull has the damping that leaves no force.
        """
        share, slope = 1.0, 0.0
        if self.variation.size:
            orders = self.teeth[0] * np.arange(1, len(self.variation) + 1)
            angles = orders * x[ABOUT_AXIS]
            share += float(self.variation @ np.cos(angles))
            slope -= float((self.variation * orders) @ np.sin(angles))
        k, d, B, xi = self.stiffness * share, self.damping, self._flanks, self._flanks @ x
        if self.backlash is not None:
            near = xi > 0.5 * self.backlash
            B, xi = B[near], xi[near] - 0.5 * self.backlash
            rate = B @ x_t
            pulls = k * xi + d * rate < 0.0
            d = np.full(len(xi), d)
            d[pulls] = -k * xi[pulls] / rate[pulls]
        return Springs(xi, B, k, d, self.stiffness * slope)

    def transmitted(self, x: np.ndarray, x_t: np.ndarray) -> float:
        """Return the force along the line of action, negative on the other flank."""
        xi, B, k, d, _ = self.springs(x, x_t)
        sides = self.flank * np.sign(B[:, ABOUT_AXIS])
        return float(sides @ (k * xi + d * (B @ x_t)))

    def check_places(self, apart: np.ndarray, axis: np.ndarray) -> None:
        """Refuse axes that are not parallel, or elsewhere than the gears say."""
        if np.hypot(axis[0], axis[1]) > _SAME_PLACE:
            raise ValueError("other: gears need parallel axes, and those of the rotors are skew")
        distance, off = self.center_distance, _SAME_PLACE * self.center_distance
        if abs(apart[2]) > off:
            raise ValueError(
                f"other: its gear is {apart[2]:.4g} m along the axis from that of the first rotor; "
                "give the rotors positions with both gears in one plane"
            )
        expected = distance * np.array([cos(self.line_angle), sin(self.line_angle)])
        if np.hypot(*(apart[:2] - expected)) > off:
            raise ValueError(
                f"other: its axis is {np.hypot(*apart[:2]):.6g} m from that of the first rotor, at "
                f"{np.arctan2(apart[1], apart[0]):.4g} rad; the gears need {distance:.6g} m "
                f"(center_distance) at line_angle, {self.line_angle:.4g} rad"
            )
