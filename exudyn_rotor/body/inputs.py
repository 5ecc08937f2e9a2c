"""Checks of what a user hands to the Exudyn layer, all done before anything is added."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import exudyn
import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor.formulation import Formulation
from exudyn_rotor.reduced import ReducedRotor

MARKER_KINDS = ("rigid", "position")


@dataclass(frozen=True, eq=False)
class Placement:
    """Where the rotor stands and how it starts.

    Attributes
    ----------
    position : ndarray, shape (3,)
        Place of the mesh origin, inertial axes [m].
    rotation : ndarray, shape (3, 3)
        Mesh axes → inertial axes at θ = 0.
    velocity : ndarray, shape (3,)
        Initial velocity of the frame origin, inertial axes [m/s].
    angle, speed : float
        Initial spin angle [rad] and speed [rad/s].
    """

    position: np.ndarray
    rotation: np.ndarray
    velocity: np.ndarray
    angle: float
    speed: float


def placement(
    formulation: Formulation,
    position: ArrayLike,
    rotation: ArrayLike | None,
    initial_velocity: ArrayLike,
    initial_angle: float | None,
    initial_speed: float | None,
) -> Placement:
    """Check and complete the placement; a prescribed motion brings its own initial values."""
    velocity = vector(initial_velocity, "initial_velocity", "m/s")
    if formulation.moves_origin:
        if np.any(velocity):
            raise ValueError(
                "velocity given twice: by initial_velocity and by the translation τ(t)"
            )
        velocity = vector(formulation.translation.rate(0.0), "translation.rate(0)", "m/s")
    elif np.any(velocity) and formulation.translation_count == 0:
        raise ValueError(
            f"initial_velocity {velocity.tolist()} m/s: translation='none' holds the rotor"
        )
    angle, speed = initial_angle or 0.0, initial_speed or 0.0
    if not formulation.has_spin:
        for name, value in (("initial_angle", initial_angle), ("initial_speed", initial_speed)):
            if value is not None:
                raise ValueError(
                    f"spin given twice: {name}={value} and a prescribed spin; leave {name} out"
                )
        angle, speed = formulation.spin.value(0.0), formulation.spin.rate(0.0)
    if not (np.isfinite(angle) and np.isfinite(speed)):
        raise ValueError(f"initial spin: angle {angle} rad and speed {speed} rad/s must be finite")
    return Placement(
        vector(position, "position", "m"), rotation_matrix(rotation), velocity, angle, speed
    )


def vector(values: ArrayLike, name: str, unit: str, size: int = 3) -> np.ndarray:
    """Return `values` as a finite float array of `size` entries."""
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: needs {size} numbers [{unit}], got {values!r}") from error
    if array.shape != (size,) or not np.all(np.isfinite(array)):
        raise ValueError(f"{name}: needs {size} finite numbers [{unit}], got {values!r}")
    return array


def rotation_matrix(rotation: ArrayLike | None) -> np.ndarray:
    """Return a proper rotation matrix, the unit matrix for None."""
    if rotation is None:
        return np.eye(3)
    matrix = np.asarray(rotation, dtype=float)
    proper = matrix.shape == (3, 3) and np.all(np.isfinite(matrix))
    proper = proper and np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-9)
    if not proper or np.linalg.det(matrix) < 0.0:
        raise ValueError(f"rotation: needs a proper 3 × 3 rotation matrix, got {rotation!r}")
    return matrix


def damping_factor(value: float, name: str) -> float:
    """Return a finite, non-negative Rayleigh factor."""
    if not (np.isfinite(value) and value >= 0.0):
        raise ValueError(f"{name}: needs a finite number ≥ 0, got {value}")
    return float(value)


@dataclass(frozen=True, eq=False)
class MarkerRequest:
    """A marker to be made at an interface: its kind, offset [m, mesh axes], and visibility."""

    kind: str
    offset: np.ndarray
    show: bool


def marker_requests(
    reduced: ReducedRotor,
    markers: Mapping[str, str] | None,
    offsets: Mapping[str, ArrayLike],
    show: bool,
) -> dict[str, MarkerRequest]:
    """Return the markers to make; None asks for rigid markers at all interfaces."""
    kinds = dict.fromkeys(reduced.interfaces, "rigid") if markers is None else markers
    for name in (*kinds, *offsets):
        if name not in reduced.interfaces:
            known = ", ".join(reduced.interfaces) or "none"
            raise ValueError(f"markers: interface {name!r} is unknown; the rotor has: {known}")
    requests = {}
    for name, kind in kinds.items():
        if kind not in MARKER_KINDS:
            raise ValueError(
                f"markers: kind {kind!r} of {name!r} is unknown; use 'rigid' or 'position'"
            )
        offset = vector(offsets.get(name, np.zeros(3)), f"marker offset of {name!r}", "m")
        if kind == "position" and np.any(offset):
            raise ValueError(f"markers: {name!r} has an offset, so it must be of kind 'rigid'")
        requests[name] = MarkerRequest(kind, offset, show)
    return requests


def check_mbs(mbs: exudyn.MainSystem) -> None:
    """Refuse anything that is not an Exudyn system."""
    if not isinstance(mbs, exudyn.MainSystem):
        raise TypeError(f"mbs: needs an exudyn.MainSystem, got {type(mbs).__name__}")


def check_free_names(mbs: exudyn.MainSystem, name: str, interfaces: Mapping[str, str]) -> None:
    """Refuse a name that an item of `mbs` already has."""
    if not isinstance(name, str) or not name:
        raise ValueError(f"name: needs a non-empty string, got {name!r}")
    taken = [
        (mbs.GetObjectNumber, name),
        (mbs.GetNodeNumber, f"NodeRigidBody:{name}"),
        (mbs.GetNodeNumber, f"NodeGeneric:{name}"),
        *((mbs.GetMarkerNumber, f"{name}:{interface}") for interface in interfaces),
    ]
    for find, item in taken:
        if int(find(item)) != -1:
            raise ValueError(
                f"name {name!r}: this system already has an item {item!r}; "
                "give the second rotor another name"
            )
