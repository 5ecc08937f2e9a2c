"""Linear supports with constant coefficients in a scene, as connectors that Exudyn evaluates.

Displacements go through a ``CartesianSpringDamper``: diagonal matrices by numbers, others by a
symbolic function. Springs against tilts, alike in both directions, are a ``RigidBodySpringDamper``;
others, and dampers, stay: Exudyn gives the angular velocity of a marker in axes of the spinning
frame, and the moment m across the axis has the part ``m · (e × ψ)`` about it, by the tilt ψ,
without which it would drive a free spin.
"""

from __future__ import annotations

from collections.abc import Callable

import exudyn
import numpy as np
from exudyn.advancedUtilities import CreateSymbolicUserFunction
from exudyn.itemInterface import CartesianSpringDamper, RigidBodySpringDamper

from exudyn_rotor.bearings.support import Support, acts, varies
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems, entry
from exudyn_rotor.multibody.supports.connector import NATIVE, SYMBOLIC
from exudyn_rotor.multibody.supports.ends import Seat, marker_on_axis

_ROUNDING = 1e-13  # of the largest entry of a turned matrix
_FUNCTIONS = "symbolic functions of supports"
Part = tuple[exudyn.ObjectIndex, str]


def native_parts(
    body: RotorItems, support: Support, seat: Seat
) -> tuple[list[Part], Support | None]:
    """Add what Exudyn evaluates itself; return it, and what is left of the support, or None."""
    parts, left = [], {"mass": support.mass}
    if support.frame == "rotor" or support.couples:
        return parts, support
    for names, rows, add in (
        (("stiffness", "damping"), slice(3), _displacement_connector),
        (("tilt_stiffness", "tilt_damping"), slice(3, 6), _tilt_connector),
    ):
        given = {name: getattr(support, name) for name in names}
        if not any(map(acts, given.values())):
            continue
        K, D = (X[rows, rows] for X in support.matrices(0.0))
        native = not any(map(varies, given.values())) and add(body, support, seat, K, D)
        if native:
            parts.append(native)
        else:
            left |= given
    if not any(map(acts, left.values())):
        return parts, None
    return parts, Support(support.interface, **left, extrapolate=support.extrapolate)


def _displacement_connector(
    body: RotorItems, support: Support, seat: Seat, K: np.ndarray, D: np.ndarray
) -> Part:
    mbs = body.mbs
    markers = [seat.marker(mbs), marker_on_axis(body, support.interface, "position")]
    item = CartesianSpringDamper(markerNumbers=markers)
    K, D = _turned(seat.axes, K), _turned(seat.axes, D)
    if not np.any(K - np.diag(np.diag(K))) and not np.any(D - np.diag(np.diag(D))):
        item.stiffness, item.damping = np.diag(K), np.diag(D)
        return mbs.AddObject(item), NATIVE

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        pairs = zip(_times(K, u), _times(D, v), strict=True)
        return exudyn.symbolic.Vector([a + b for a, b in pairs])

    set_symbolic_force(mbs, item, force)
    return mbs.AddObject(item), SYMBOLIC


def _tilt_connector(
    body: RotorItems, support: Support, seat: Seat, K: np.ndarray, D: np.ndarray
) -> Part | None:
    if np.any(D) or not np.array_equal(K, np.diag([K[0, 0], K[0, 0], 0.0])):
        return None
    markers = [seat.marker(body.mbs), marker_on_axis(body, support.interface, "rigid")]
    stiffness, none = np.kron(np.diag([0.0, 1.0]), K), np.zeros((6, 6))
    item = RigidBodySpringDamper(markerNumbers=markers, stiffness=stiffness, damping=none)
    return body.mbs.AddObject(item), NATIVE


def _turned(axes: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Return a matrix in inertial axes, its rounding cut off."""
    turned = axes @ matrix @ axes.T
    turned[np.abs(turned) <= _ROUNDING * np.abs(turned).max()] = 0.0
    return turned


def _times(matrix: np.ndarray, vector: list) -> list:
    """Return a matrix times symbols, without its zeros."""
    return [
        sum((float(row[i]) * vector[i] for i in np.flatnonzero(row)), start=0.0 * vector[0])
        for row in matrix
    ]


def set_symbolic_force(mbs: exudyn.MainSystem, item: object, force: Callable) -> None:
    """Give a connector its force as a symbolic function of Exudyn, kept alive by the system."""
    kind, name = type(item).__name__, "springForceUserFunction"
    item.springForceUserFunction = CreateSymbolicUserFunction(mbs, force, name, itemTypeName=kind)
    entry(mbs).setdefault(_FUNCTIONS, []).append(item.springForceUserFunction)
