"""Checks of what a user hands to the Exudyn layer, all done before anything is added."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import exudyn
import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.formulation import Formulation, start_values

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
    direction: np.ndarray,
    position: ArrayLike,
    rotation: ArrayLike | None,
    initial_velocity: ArrayLike,
    initial_angle: float | None,
    initial_speed: float | None,
) -> Placement:
    """Check and complete the placement; a prescribed motion brings its own initial values.

    `direction` is the spin axis in mesh axes.
    """
    place, turn = vector(position, "position", "m"), rotation_matrix(rotation)
    velocity = vector(initial_velocity, "initial_velocity", "m/s")
    if formulation.moves_origin:
        if np.any(velocity):
            raise ValueError(
                "velocity given twice: by initial_velocity and by the translation τ(t)"
            )
        _, velocity, _ = start_values(formulation.translation, "translation")
    else:
        _check_direction(formulation, velocity, turn @ direction)
    if formulation.has_spin:
        angle = number(initial_angle or 0.0, "initial_angle", "rad")
        speed = number(initial_speed or 0.0, "initial_speed", "rad/s")
        return Placement(place, turn, velocity, angle, speed)
    for name, value in (("initial_angle", initial_angle), ("initial_speed", initial_speed)):
        if value is not None:
            raise ValueError(
                f"spin given twice: {name}={value} and a prescribed spin; leave {name} out"
            )
    angle, speed, _ = start_values(formulation.spin, "spin")
    return Placement(place, turn, velocity, angle, speed)


def _check_direction(formulation: Formulation, velocity: np.ndarray, axis: np.ndarray) -> None:
    """Refuse a velocity that the formulation cannot have; `axis` in inertial axes."""
    if np.any(velocity) and formulation.translation_count == 0:
        raise ValueError(
            f"initial_velocity {velocity.tolist()} m/s: translation='none' holds the rotor"
        )
    along = abs(axis @ velocity)
    if formulation.translation_count == 2 and along > 1e-9 * np.linalg.norm(velocity):
        raise ValueError(
            f"initial_velocity {velocity.tolist()} m/s has {along:.3g} m/s along the spin axis: "
            "translation='in-plane' has no such motion; give it as a modal velocity of "
            "'translation along axis', or use translation='free'"
        )


def _finite(values: ArrayLike, name: str, unit: str, size: int | None) -> np.ndarray:
    """Return a finite float array of `size` entries, or of no dimension for None."""
    needed = "a finite number" if size is None else f"{size} finite numbers"
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: needs {needed} [{unit}], got {values!r}") from error
    text = isinstance(values, (str, bytes))  # NumPy reads numbers out of it
    if text or array.shape != (() if size is None else (size,)) or not np.all(np.isfinite(array)):
        raise ValueError(f"{name}: needs {needed} [{unit}], got {values!r}")
    return array


def number(value: float, name: str, unit: str) -> float:
    """Return `value` as a finite float."""
    return float(_finite(value, name, unit, None))


def vector(values: ArrayLike, name: str, unit: str, size: int = 3) -> np.ndarray:
    """Return `values` as a finite float array of `size` entries."""
    return _finite(values, name, unit, size)


def modal_values(values: ArrayLike | None, name: str, labels: tuple[str, ...]) -> np.ndarray:
    """Return one value per mode, zeros for None."""
    if values is None:
        return np.zeros(len(labels))
    return vector(values, f"{name} (one per mode: {', '.join(labels)})", "√kg m", len(labels))


def rotation_matrix(rotation: ArrayLike | None) -> np.ndarray:
    """Return a proper rotation matrix, the unit matrix for None."""
    if rotation is None:
        return np.eye(3)
    try:
        matrix = np.asarray(rotation, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"rotation: needs a 3 × 3 rotation matrix, got {rotation!r}") from error
    proper = matrix.shape == (3, 3) and np.all(np.isfinite(matrix))
    proper = proper and np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-9)
    if not proper or np.linalg.det(matrix) < 0.0:
        raise ValueError(f"rotation: needs a proper 3 × 3 rotation matrix, got {rotation!r}")
    return matrix


def damping_factor(value: float, name: str) -> float:
    """Return a finite, non-negative Rayleigh factor."""
    factor = number(value, name, "SI")
    if factor < 0.0:
        raise ValueError(f"{name}: needs a number ≥ 0, got {value}")
    return factor


@dataclass(frozen=True, eq=False)
class MarkerRequest:
    """A marker to be made at an interface: its kind, offset [m, mesh axes], and visibility."""

    kind: str
    offset: np.ndarray
    show: bool


def marker_requests(
    reduced: ReducedRotor,
    markers: Mapping[str, str] | str | None,
    offsets: Mapping[str, ArrayLike],
    show: bool,
) -> dict[str, MarkerRequest]:
    """Return the markers to make; None asks for rigid markers at all interfaces."""
    kinds = "rigid" if markers is None else markers
    if isinstance(kinds, str):
        kinds = dict.fromkeys(reduced.interfaces, kinds)
    if not isinstance(kinds, Mapping):
        raise TypeError(
            "markers: needs 'rigid', 'position' or a mapping of interface to one of them, got "
            f"{kinds!r}"
        )
    for name in (*kinds, *offsets):
        if name not in reduced.interfaces:
            known = ", ".join(reduced.interfaces) or "none"
            raise ValueError(f"markers: interface {name!r} is unknown; the rotor has: {known}")
    for name in offsets:
        if name not in kinds:
            raise ValueError(
                f"marker_offsets: interface {name!r} gets no marker; add it to markers"
            )
    requests = {}
    for name, kind in kinds.items():
        if kind not in MARKER_KINDS:
            raise ValueError(
                f"markers: kind {kind!r} of {name!r} is unknown; use 'rigid' or 'position'"
            )
        offset = vector(offsets.get(name, np.zeros(3)), f"marker offset of {name!r}", "m")
        requests[name] = MarkerRequest(kind, offset, show)
    return requests


def check_mbs(mbs: exudyn.MainSystem) -> None:
    """Refuse anything that is not an Exudyn system."""
    if not isinstance(mbs, exudyn.MainSystem):
        raise TypeError(f"mbs: needs an exudyn.MainSystem, got {type(mbs).__name__}")


def check_reduced(reduced: ReducedRotor) -> None:
    """Refuse anything that is not a reduced rotor."""
    if not isinstance(reduced, ReducedRotor):
        raise TypeError(
            f"reduced: needs a ReducedRotor, got {type(reduced).__name__}; "
            "SolidRotor.reduce(…) makes one"
        )


def item_name(prefix: str, name: str | None) -> str:
    """Return the name of an item, empty for a rotor without a name."""
    return "" if name is None else f"{prefix}{name}"


def marker_name(name: str | None, interface: str) -> str:
    """Return the name of an interface's marker."""
    return interface if name is None else f"{name}:{interface}"


def check_free_names(
    mbs: exudyn.MainSystem, name: str | None, interfaces: Mapping[str, MarkerRequest]
) -> None:
    """Refuse a name that an item of `mbs` already has."""
    if name is not None and not (isinstance(name, str) and name):
        raise ValueError(f"name: needs a non-empty string or None, got {name!r}")
    taken = [(mbs.GetMarkerNumber, marker_name(name, interface)) for interface in interfaces]
    if name is not None:
        taken += [
            (mbs.GetObjectNumber, name),
            (mbs.GetNodeNumber, item_name("NodeRigidBody:", name)),
            (mbs.GetNodeNumber, item_name("NodeGeneric:", name)),
        ]
    for find, item in taken:
        if int(find(item)) != -1:
            raise ValueError(
                f"name {name!r}: this system already has an item {item!r}; "
                "give the second rotor another name"
            )
