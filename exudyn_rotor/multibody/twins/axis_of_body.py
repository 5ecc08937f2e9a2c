"""The spin axis of a body whose script does not name one, where the body itself shows it."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.solid.interface import Interface
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis

# share of the length by which an uneven mesh may put the centres of round faces off the axis
_UNEVEN = 1e-2
_OFF_PRINCIPAL = np.radians(10.0)  # of an axis that an angular velocity gives
_OFF_PRINCIPAL_AT_REST = np.radians(2.0)
_OFF_CENTER = 0.05  # of the centre of mass from the axis at rest, over the radius of gyration
_UNEQUAL = 0.1  # relative difference of the two moments of inertia across the axis, at rest
_ROUND = 1.3  # widest over narrowest width of a round seat: √2 of a square, 1.24 of a pentagon
_POINT = 1e-2  # width of a seat that is a point, over the radius of gyration
_NAME_IT = "give axis='x', 'y', 'z' or a direction in mesh coordinates"


def axis_of_motion(rotor: SolidRotor, omega: np.ndarray) -> SpinAxis:
    """Return the axis of an angular velocity (3,), mesh axes, through the mesh origin.

    Its largest component is positive, so that the spin counts like the angle of Exudyn's node.

    Raises
    ------
    ValueError
        If that is no principal axis of inertia within 10°: the body would tumble.
    """
    direction = omega * np.sign(omega[np.argmax(np.abs(omega))]) / np.linalg.norm(omega)
    off = _off_principal(_inertia(rotor), direction)
    if off > _OFF_PRINCIPAL:
        raise ValueError(
            f"axis: initialAngularVelocity is {np.degrees(off):.2g}° off the next principal axis "
            f"of inertia, so it does not show the spin axis (10° may be); {_NAME_IT}"
        )
    return SpinAxis(direction)


def axis_at_rest(rotor: SolidRotor) -> SpinAxis:
    """Return the line through the centres of the seats of a body that looks like a rotor.

    A line that is a mesh axis but for the unevenness of the mesh is taken as that axis.

    Raises
    ------
    ValueError
        If there are fewer than two seats, their centres are not on one line, or body or seats do
        not look the same all around it: it may be a pendulum, or a blade.
    """
    reason = ""
    axis = _line_through_seats(list(rotor.interfaces.values()))
    if axis is None:
        reason = f"the centres of its {len(rotor.interfaces)} node sets are not on one line"
    else:
        reason = _why_no_rotor(rotor, axis)
    if reason:
        raise ValueError(f"axis: is not known: the rotor starts at rest, and {reason}; {_NAME_IT}")
    return axis


def _line_through_seats(seats: list[Interface]) -> SpinAxis | None:
    centers = np.array([seat.center for seat in seats]).reshape(-1, 3)
    if len(centers) < 2:
        return None
    mean = centers.mean(axis=0)
    _, spread, lines = np.linalg.svd(centers - mean)
    if spread[0] == 0.0 or np.any(spread[1:] > _UNEVEN * spread[0]):
        return None
    direction = lines[0] * np.sign(lines[0][np.argmax(np.abs(lines[0]))])
    nearest = np.eye(3)[np.argmax(direction)]
    offset = mean - nearest * (nearest @ mean)
    if np.linalg.norm(direction - nearest) < _UNEVEN:
        direction = nearest
        if np.linalg.norm(offset) < _UNEVEN * spread[0]:
            mean = np.zeros(3)
    return SpinAxis(direction, mean)


def _why_no_rotor(rotor: SolidRotor, axis: SpinAxis) -> str:
    """Return what speaks against a rotor about `axis`; empty for nothing."""
    J, across = _inertia(rotor), axis.plane
    off = _off_principal(J, axis.direction)
    if off > _OFF_PRINCIPAL_AT_REST:
        return f"the line through its node sets is {np.degrees(off):.2g}° off a principal axis"
    radius = np.sqrt(0.5 * np.trace(J) / rotor.total_mass)
    away = float(np.linalg.norm(axis.radial(rotor.center_of_mass)))
    if away > _OFF_CENTER * radius:
        return f"the centre of mass is {away:.3g} m off the line through its node sets"
    low, high = np.linalg.eigvalsh(across.T @ J @ across)
    if high - low > _UNEQUAL * high:
        return (
            f"its moments of inertia across the line through its node sets, {low:.4g} and "
            f"{high:.4g} kg m², are not those of a round body"
        )
    for seat in rotor.interfaces.values():
        if not _is_round(rotor.nodes[seat.nodes], axis, _POINT * radius):
            return f"the node set {seat.name!r} is not round about the line through the node sets"
    return ""


def _inertia(rotor: SolidRotor) -> np.ndarray:
    """Return the tensor of inertia about the centre of mass, shape (3, 3) [kg m²]."""
    arms = rotor.nodes - rotor.center_of_mass
    moments = arms.T @ (rotor.mass[::3, ::3] @ arms)
    return np.trace(moments) * np.eye(3) - moments


def _off_principal(J: np.ndarray, direction: np.ndarray) -> float:
    """Return the angle between a direction and a principal axis [rad].

    Where moments of inertia are nearly equal, principal axes say little: then the angle between
    angular velocity and angular momentum counts.
    """
    along = direction @ J @ direction
    coupling = J @ direction - along * direction
    size = np.linalg.norm(coupling)
    if size <= 1e-12 * np.trace(J):
        return 0.0
    other = coupling / size
    principal = 0.5 * np.arctan2(2.0 * size, abs(along - other @ J @ other))
    return float(min(principal, np.arctan2(size, along)))


def _is_round(points: np.ndarray, axis: SpinAxis, point: float) -> bool:
    """Return whether points reach as far from the axis all around it, or are all on it."""
    angles = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
    arms = axis.radial(points) @ axis.plane
    widths = np.max(arms @ np.vstack([np.cos(angles), np.sin(angles)]), axis=0)
    return bool(widths.max() < point or widths.max() <= _ROUND * widths.min())
