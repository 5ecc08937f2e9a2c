"""Flexible coupling between two shafts, and what misalignment does to it.

With the motions x₁ and x₂ of both ends, the misalignment m that stands still and the runout r of
the hub, which turns with the first shaft by θ₁, the coupling is deformed by

    ξ = Rᵀ(θ₁)(x₂ − x₁ + m) − r,                                                            (1)

and its energy is ξᵀKξ/2, K diagonal in axes that turn with the first shaft. The forces follow as
its derivative, f = −(∂ξ/∂x)ᵀ(K ξ + D ξ̇), so that power is conserved but for the damping: lateral
forces of a misaligned coupling act on the spin, too.

Equal stiffnesses in both lateral directions make of m a load that stands still. Unequal ones,
k₁ ≠ k₂, add a load of twice the spin speed, (k₁ − k₂)/2 · m; a runout makes one of the spin speed.
(A. W. Lees, J. Sound Vib. 305 (2007), on couplings of pins.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.drives.connection import Connection, Springs
from exudyn_rotor.solid.places import SAME_PLACE
from exudyn_rotor.theory.rotating_axes import axial_rotation, axial_skew

_ACROSS = (0, 1, 3, 4)  # rows of the two offsets and the two tilts
_SAME_AXIS = 1e-6  # rad


@dataclass(frozen=True, eq=False, kw_only=True)
class FlexibleCoupling(Connection):
    """Flexible coupling between two shafts on one axis.

    Parameters
    ----------
    torsion : float
        Stiffness about the axis [N m/rad].
    lateral, angular : float or array_like, shape (2,), optional
        Stiffness against offsets [N/m] and against tilts [N m/rad]; two numbers are for two
        directions that turn with the first shaft, n1 and n2 at the start.
    axial : float, optional
        Stiffness along the axis [N/m].
    damping : array_like, shape (4,), optional
        Lateral [N s/m], axial [N s/m], angular and torsional [N m s/rad], in axes that turn.
    misalignment : array_like, shape (4,), optional
        By how much the second shaft is mounted off the first: offset along n1 and n2 [m], rotation
        about them [rad]. The rotors themselves stand on one axis in the scene.
    runout : array_like, shape (4,), optional
        The same for the hub on the first shaft: it turns with it.

    Raises
    ------
    TypeError, ValueError
        For bad input.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import FlexibleCoupling
    >>> coupling = FlexibleCoupling(torsion=2e4, lateral=1e6, misalignment=[1e-3, 0.0, 0.0, 0.0])
    >>> coupling.forces(np.zeros(12), np.zeros(12))[:3]
    array([1000.,    0.,    0.])
    """

    torsion: float
    lateral: np.ndarray = 0.0
    angular: np.ndarray = 0.0
    axial: float = 0.0
    damping: np.ndarray = (0.0, 0.0, 0.0, 0.0)
    misalignment: np.ndarray = (0.0, 0.0, 0.0, 0.0)
    runout: np.ndarray = (0.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        checks.keep_numbers(self, {"torsion": "N m/rad"}, above=0.0)
        checks.keep_numbers(self, {"axial": "N/m"}, least=0.0)
        lateral = checks.one_or_each(self.lateral, "lateral", "N/m", 2, least=0.0)
        angular = checks.one_or_each(self.angular, "angular", "N m/rad", 2, least=0.0)
        damping = checks.one_or_each(self.damping, "damping", "", 4, least=0.0)
        checks.keep(self, lateral=lateral, angular=angular, damping=damping)
        for name in ("misalignment", "runout"):
            checks.keep(self, **{name: checks.vector(getattr(self, name), name, size=4)})
        K = np.array([*self.lateral, self.axial, *self.angular, self.torsion])
        fixed, turning = np.zeros((2, 6))
        fixed[list(_ACROSS)], turning[list(_ACROSS)] = self.misalignment, self.runout
        checks.keep(self, _K=K, _D=damping[[0, 0, 1, 2, 2, 3]])
        checks.keep(self, _fixed=fixed, _turning=turning)

    def support(self, interface: str) -> Support:
        """Return what linear analyses take for a coupling, without its misalignment.

        Parameters
        ----------
        interface : str
            Of the first rotor of the :class:`Link` that gets it.

        Raises
        ------
        TypeError, ValueError
            For bad input.
        """
        parts = (self._K[:3], self._D[:3], self._K[3:], self._D[3:])
        return Support(interface, *map(np.diag, parts), frame="rotor")

    def springs(self, x: np.ndarray, x_t: np.ndarray) -> Springs:
        """Return six springs and dampers, deformed by ξ of (1)."""
        R = axial_rotation(x[5], 6)
        apart = x[6:] - x[:6] + self._fixed
        by_motion = np.hstack([-R.T, R.T])
        by_motion[:, 5] -= R.T @ axial_skew(6) @ apart
        return Springs(R.T @ apart - self._turning, by_motion, self._K, self._D)

    def transmitted(self, x: np.ndarray, x_t: np.ndarray) -> float:
        """Return the torque on the second rotor [N m]."""
        return float(self.forces(x, x_t)[11])

    def check_places(self, apart: np.ndarray, axis: np.ndarray) -> None:
        """Refuse rotors that are not on one axis, at one place."""
        if np.linalg.norm(apart) > SAME_PLACE:
            raise ValueError(
                f"other: its interface is {np.linalg.norm(apart):.4g} m from that of the first "
                "rotor; couplings need both at one place (a small offset is misalignment=…)"
            )
        if np.hypot(axis[0], axis[1]) > _SAME_AXIS:
            raise ValueError(
                "other: a flexible coupling needs both rotors on one axis, and the second is "
                f"{np.hypot(axis[0], axis[1]):.3g} rad off; a small angle is misalignment=…"
            )
