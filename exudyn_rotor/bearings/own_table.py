"""The table of a bearing over speed and frequency: its own coordinates eliminated.

Of the ports p of a bearing, journal j, sensors s and own coordinates o, a motion of the frequency ν
has ``Z = K + iν D − ν² M``; nothing acts on the own coordinates, so that

    Z_b = Z_jj − Z_jo Z_oo⁻¹ Z_oj,   K_b = Re Z_b,   D_b = Im Z_b/ν.
"""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.controlled_support import ControlledSupport
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.calls import user_level


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
    kept, rows, refused = [], [], None
    for speed in speeds.tolist():
        try:
            rows.append(_at_speed(linear, speed, frequencies))
        except ValueError as error:
            refused = error
        else:
            kept.append(speed)
    if not kept:
        raise refused
    if refused is not None:
        warnings.warn(
            f"table: {len(speeds) - len(kept)} speeds are left out: {refused}",
            UserWarning,
            stacklevel=user_level(),
        )
    K, D, M = (np.array(part) for part in zip(*rows, strict=True))
    mass = M if np.any(M) else None
    given = {"speeds": kept, "frequencies": frequencies}
    return Support.from_table(linear.interface, **given, stiffness=K, damping=D, mass=mass)


def _at_speed(
    linear: Support | ControlledSupport, speed: float, frequencies: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness, damping and mass at one speed, each (f, 2, 2)."""
    nu, none = frequencies[:, None, None], np.zeros((len(frequencies), 2, 2))
    if isinstance(linear, Support):
        linear.check_range(speed)
        parts = *linear.matrices(speed), linear.mass_matrix(speed)
        return tuple(none + X[:2, :2] for X in parts)
    K, D = linear.matrices(speed)
    first, whole = len(K) - linear.size, K + 1j * nu * D
    seen = np.tile(np.eye(2), (first // 2, 1))  # sensors move as the magnets do
    own = whole[:, first:, first:] - nu**2 * np.diag(linear.masses)
    inner = np.linalg.solve(own, whole[:, first:, :first] @ seen)
    Z = seen.T @ (whole[:, :first, :first] @ seen - whole[:, :first, first:] @ inner)
    return Z.real, Z.imag / nu, none
