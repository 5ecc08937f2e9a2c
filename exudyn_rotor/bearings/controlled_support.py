"""Linear supports with coordinates of their own, active bearings and pads, and their tables.

Of the ports p, journal j, sensors s and own coordinates o, a motion of the frequency ν has
``Z = K + iν D − ν² M``; nothing acts on the own coordinates, so that

    Z_b = Z_jj − Z_jo Z_oo⁻¹ Z_oj,   K_b = Re Z_b,   D_b = Im Z_b/ν.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Coefficient, Support


@dataclass(frozen=True, eq=False)
class ControlledSupport:
    """Linear equations of a support and coordinates of its own, ``M p̈ + D ṗ + K p = 0``.

    The ports p are the displacement where it acts along (n1, n2), which stand still, that where its
    sensors are, if it has any, and its own coordinates, which alone have the inertia `masses`: of a
    controller pairs along (n1, n2); of pads the motion s of each bore along the tangent t at the
    pivot, whose film acts on ``x − s t``. `matrices` returns stiffness and damping of the ports by
    the spin speed; a ValueError says that the journal has no equilibrium. Critical speeds are found
    with the `static_stiffness` of all, the own coordinates eliminated, slowly and without an
    integral, of pads in the whirl. A controller measures at the interface `sensor`.
    """

    interface: str
    masses: np.ndarray
    matrices: Callable[[float], tuple[np.ndarray, np.ndarray]]
    static_stiffness: Coefficient
    sensor: str | None = None

    @property
    def size(self) -> int:
        """Number of own coordinates."""
        return len(self.masses)

    @property
    def word(self) -> str:
        """What it is, for labels."""
        return "pads" if self.sensor is None else "controller"


def table_of(
    linear: Support | ControlledSupport, speeds: ArrayLike, frequencies: ArrayLike
) -> Support:
    """Return linear equations of a bearing as tables, see :meth:`LoadedBearing.table`."""
    speeds = checks.ascending(speeds, "speeds", "rad/s")
    frequencies = checks.ascending(frequencies, "frequencies", "rad/s")
    if frequencies[0] <= 0.0:
        raise ValueError(
            f"frequencies: needs values above zero [rad/s], got {frequencies[0]:g}; supports keep "
            "the value at the lowest below it"
        )
    if getattr(linear, "sensor", None) not in (None, linear.interface):
        raise ValueError(
            f"bearing at {linear.interface!r}: measures at {linear.sensor!r}, and a table has one "
            "place; give the bearing itself"
        )
    rows = [_at_speed(linear, speed, frequencies) for speed in speeds.tolist()]
    K, D, M = (np.array(part) for part in zip(*rows, strict=True))
    mass = M if np.any(M) else None
    given = {"speeds": speeds, "frequencies": frequencies}
    return Support.from_table(linear.interface, **given, stiffness=K, damping=D, mass=mass)


def _at_speed(
    linear: Support | ControlledSupport, speed: float, frequencies: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness, damping and mass at one speed, each (f, 2, 2)."""
    none = np.zeros((len(frequencies), 2, 2))
    if isinstance(linear, Support):
        linear.check_range(speed)
        parts = *linear.matrices(speed), linear.mass_matrix(speed)
        return tuple(none + X[:2, :2] for X in parts)
    Z = impedance(*linear.matrices(speed), linear.masses, frequencies)
    return Z.real, Z.imag / frequencies[:, None, None], none


def impedance(
    K: np.ndarray, D: np.ndarray, masses: np.ndarray, frequencies: ArrayLike
) -> np.ndarray:
    """Return Z_b (f, 2, 2) of stiffness and damping between ports, the last with `masses`."""
    nu = np.asarray(frequencies)[:, None, None]
    first, whole = len(K) - len(masses), K + 1j * nu * D
    seen = np.tile(np.eye(2), (first // 2, 1))  # sensors move as the magnets do
    own = whole[:, first:, first:] - nu**2 * np.diag(masses)
    inner = np.linalg.solve(own, whole[:, first:, :first] @ seen)
    return seen.T @ (whole[:, :first, :first] @ seen - whole[:, :first, first:] @ inner)
