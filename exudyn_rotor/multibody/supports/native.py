"""Linear supports with constant coefficients in a scene, as connectors that Exudyn evaluates.

Displacements go through a ``CartesianSpringDamper``: diagonal matrices by numbers, others by a
symbolic function. Tilts go through a ``RigidBodySpringDamper``. Native tilt damping would act on
Exudyn's angular velocity ω of the marker; of a spinning rotor with the tilt ψ, on the ground, the
rate is ``ω + 2 Ω e × ψ``: once since the marker spins, and once because Exudyn gives ω in axes of
the frame. The moment m across the axis has the part ``m · (e × ψ)`` about it: without it springs
that are not alike in all directions, and dampers, would drive a free spin.
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
from exudyn_rotor.multibody.supports.ends import Seat, point_marker, rigid_marker

_ROUNDING = 1e-13  # of the largest entry of a turned matrix
_FUNCTIONS = "symbolic functions of supports"
Parts = list[tuple[exudyn.ObjectIndex, str]]


def native_parts(
    body: RotorItems, support: Support, seat: Seat, grounded: bool
) -> tuple[Parts, Support | None]:
    """Add what Exudyn evaluates itself; return it, and what is left of the support, or None.

    On a base, other than the ground, the rate of its tilts counts, too.
    """
    parts, left = [], {}
    across, tilts = ("stiffness", "damping"), ("tilt_stiffness", "tilt_damping")
    if support.frame == "rotor" or support.couples:
        return parts, support
    constant = [
        not any(varies(getattr(support, name)) for name in kind) for kind in (across, tilts)
    ]
    if constant[0]:
        if any(acts(getattr(support, name)) for name in across):
            parts.append(_displacement_connector(body, support, seat))
    else:
        left |= {name: getattr(support, name) for name in across}
    K, D = (X[3:, 3:] for X in support.matrices(0.0)) if constant[1] else np.zeros((2, 3, 3))
    about = np.any(K[2]) or np.any(K[:, 2]) or np.any(D[2]) or np.any(D[:, 2])
    alike = np.array_equal(K, np.diag([K[0, 0], K[0, 0], 0.0])) and not np.any(D)
    if constant[1] and not about and (alike or grounded):
        if np.any(K) or np.any(D):
            parts.append(_tilt_connector(body, support, seat, K, D))
    else:
        left |= {name: getattr(support, name) for name in tilts}
    left["mass"] = support.mass
    if not any(map(acts, left.values())):
        return parts, None
    return parts, Support(support.interface, **left, extrapolate=support.extrapolate)


def _displacement_connector(
    body: RotorItems, support: Support, seat: Seat
) -> tuple[exudyn.ObjectIndex, str]:
    mbs = body.mbs
    markers = [seat.marker(mbs), point_marker(body, support.interface)]
    item = CartesianSpringDamper(markerNumbers=markers)
    K, D = (_turned(seat.axes, X[:3, :3]) for X in support.matrices(0.0))
    if not np.any(K - np.diag(np.diag(K))) and not np.any(D - np.diag(np.diag(D))):
        item.stiffness, item.damping = np.diag(K), np.diag(D)
        return mbs.AddObject(item), NATIVE

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        pairs = zip(_times(K, u), _times(D, v), strict=True)
        return exudyn.symbolic.Vector([a + b for a, b in pairs])

    item.springForceUserFunction = symbolic_function(mbs, force, item, "springForceUserFunction")
    return mbs.AddObject(item), SYMBOLIC


def _tilt_connector(
    body: RotorItems, support: Support, seat: Seat, K: np.ndarray, D: np.ndarray
) -> tuple[exudyn.ObjectIndex, str]:
    mbs, none = body.mbs, np.zeros((6, 6))
    markers = [seat.marker(mbs), rigid_marker(body, support.interface)]
    item = RigidBodySpringDamper(markerNumbers=markers, stiffness=none, damping=none)
    if not np.any(D) and K[0, 0] == K[1, 1] and not np.any(K - np.diag(np.diag(K))):
        item.stiffness = np.kron(np.diag([0.0, 1.0]), K)
        return mbs.AddObject(item), NATIVE

    def torque(mbs, t, item, u, angles, v, omega, stiffness, damping, r0, r1, offset):
        a, b = angles[0], angles[1]
        rate = [omega[0] - 2.0 * omega[2] * b, omega[1] + 2.0 * omega[2] * a]
        pairs = zip(_times(K[:2, :2], [a, b]), _times(D[:2, :2], rate), strict=True)
        x, y = (spring + damper for spring, damper in pairs)
        return exudyn.symbolic.Vector([0.0, 0.0, 0.0, x, y, y * a - x * b])

    name = "springForceTorqueUserFunction"
    setattr(item, name, symbolic_function(mbs, torque, item, name))
    return mbs.AddObject(item), SYMBOLIC


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


def symbolic_function(
    mbs: exudyn.MainSystem, function: Callable, item: object, name: str
) -> object:
    """Return a function as Exudyn's symbolic one, kept alive by the system."""
    kind = type(item).__name__
    made = CreateSymbolicUserFunction(mbs, function, name, itemTypeName=kind)
    entry(mbs).setdefault(_FUNCTIONS, []).append(made)
    return made
