"""What the modes of a run leave out: static response of the interfaces beyond the modes.

The loads F where something acts on the rotor (:mod:`exudyn_rotor.multibody.load_places`) follow
from the equations of motion, ``Uᵀ F = f`` with the motion U of these places, in the sense of least
squares. With R, the flexibility of the attachment modes beyond that of the modes, those at
interfaces deform the rotor there by ``R F`` more than the run shows. The rotor's own centrifugal
load stretches it likewise, by Ω² times what its static response has beyond the modes.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.advice.run_loads import external_load, instants, turned, weight
from exudyn_rotor.multibody.load_places import LoadPlace, load_places
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.nodal import skew

_SEEN = 1e-3  # singular values below this share of the largest tell nothing about loads


def residual_deflection(body: RotorBody, record: Record, size: float) -> float | None:
    """Return the deflection at interfaces that the modes leave out, over their displacement.

    Against the rotor's mean motion. Stiff supports let the interfaces move less than the rotor
    bends; then over its bending there. Other loads elsewhere, and on the spin of the frame, do not
    count. `size` [m] makes forces and moments comparable. None where it is not known what the modes
    leave out.
    """
    rotor = body.selection.source
    if rotor.with_attachments is None or not rotor.interfaces or "marker_body" not in body.objects:
        return None
    if len(record.time) < 2:
        return 0.0
    picked = instants(record)
    motion, flexible = _motion(rotor)
    loads, zeta, frame = recorded_states(body, record, picked)
    rest = _flexibility(rotor.with_attachments) - _flexibility(rotor)
    stretch = _stretch(rotor.with_attachments, body) - _stretch(rotor, body)
    columns = body.selection.T @ zeta
    bent = motion @ np.where(flexible[:, None], columns, 0.0)
    moved = motion @ columns
    moved += np.tile(np.vstack([frame, np.zeros_like(frame)]), (len(rotor.interfaces), 1))
    left_out = np.outer(stretch, record.speed[picked] ** 2)
    left_out += rest @ at_interfaces(rotor, place_loads(body, loads, size), len(picked))
    shown = np.tile([True] * 3 + [False] * 3, len(rotor.interfaces))
    missing, *sizes = (
        np.linalg.norm(values[shown], axis=0).max() for values in (left_out, moved, bent)
    )
    return float(missing / max(sizes)) if max(sizes) else 0.0


def place_loads(
    body: RotorBody, loads: np.ndarray, size: float
) -> list[tuple[LoadPlace, np.ndarray]]:
    """Return the places of the rotor's loads, with forces and moments there (3 or 6, s).

    In mesh axes, which turn with the rotor. `loads` are those of :func:`recorded_states`; `size`
    [m] makes forces and moments comparable.
    """
    places = load_places(body)
    if not places:
        return []
    counts = [len(place.motion) for place in places]
    scale = np.concatenate([([1.0] * 3 + [size] * 3)[:count] for count in counts])
    solve = np.linalg.pinv(_equations(body, places) * scale, rcond=_SEEN)
    found = np.split(scale[:, None] * (solve @ loads), np.cumsum(counts)[:-1])
    return list(zip(places, found, strict=True))


def at_interfaces(
    rotor: ReducedRotor, found: list[tuple[LoadPlace, np.ndarray]], count: int
) -> np.ndarray:
    """Return forces and moments (6n, count) about the reference points of all interfaces.

    `found` is what :func:`place_loads` returns.
    """
    names = list(rotor.interfaces)
    total = np.zeros((len(names), 6, count))
    for place, values in found:
        if place.interface is None:
            continue
        row = total[names.index(place.interface)]
        row[: len(values)] += values
        arm = place.point - rotor.interfaces[place.interface].reference
        row[3:] += skew(arm) @ values[:3]
    return total.reshape(6 * len(names), count)


def recorded_states(
    body: RotorBody, record: Record, picked: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the states at instants, in columns.

    Loads on modes and frame as in :func:`_equations`, without the weight; modal coordinates; how
    far the frame's axis has moved, in its own axes (3, s).
    """
    rows = [_state(body, record, index) for index in picked]
    return tuple(np.array(part).T for part in zip(*rows, strict=True))


def _motion(rotor: ReducedRotor) -> tuple[np.ndarray, np.ndarray]:
    """Return the motion of all interfaces (6n, k), and which columns are flexible."""
    flexible = np.arange(rotor.size) >= len(rotor.rigid_kinds)
    return np.vstack([one.motion for one in rotor.interfaces.values()]), flexible


def _flexibility(rotor: ReducedRotor) -> np.ndarray:
    """Return ``Σ φ φᵀ/ω²`` of the flexible modes at the interfaces, (6n, 6n)."""
    motion, flexible = _motion(rotor)
    scaled = motion[:, flexible] / rotor.frequencies[flexible]
    return scaled @ scaled.T


def _stretch(rotor: ReducedRotor, body: RotorBody) -> np.ndarray:
    """Return the static motion of the interfaces by the centrifugal load per ω², (6n,)."""
    motion, flexible = _motion(rotor)
    h = rotor.invariants.moved(body.selection.origin - rotor.center_of_mass).h
    return motion[:, flexible] @ (h[flexible] / rotor.frequencies[flexible] ** 2)


def _equations(body: RotorBody, places: Sequence[LoadPlace]) -> np.ndarray:
    """Return what loads at places do: on the modes, and as forces on the frame."""
    on_modes = np.vstack([place.motion for place in places]).T
    forces = np.hstack([np.eye(3, len(place.motion)) for place in places])
    e = body.motion.invariants.direction
    free = {0: np.zeros((3, 3)), 2: np.eye(3) - np.outer(e, e), 3: np.eye(3)}
    frame = free[body.formulation.translation_count] @ forces
    return np.vstack([on_modes, frame / np.sqrt(body.motion.invariants.mass)])


def _state(body: RotorBody, record: Record, index: int) -> tuple[np.ndarray, ...]:
    """Return loads on modes and frame as in :func:`_equations`, modal coordinates, and how
    far the frame's axis has moved, in its own axes."""
    motion = body.motion
    mass = motion.invariants.mass
    external = external_load(body, record, index)[1]
    q = record.q[index]
    turn = turned(body, q)
    unknowns = q[body.layout.unknowns]
    weight_in_rotor = turn.T @ weight(body)
    along = turn.T @ motion.free_directions
    on_modes = external[motion.modes] - motion.invariants.S.T @ weight_in_rotor / mass
    on_frame = along @ (external[motion.translations] - motion.free_directions.T @ weight(body))
    # the frame may stand in a centre of mass off the axis, and that circles about it
    arm = body.selection.origin - body.axis.project(body.selection.origin)
    circled = turn.T @ motion.orientation @ arm - arm
    return (
        np.concatenate([on_modes, on_frame / np.sqrt(mass)]),
        unknowns[motion.modes],
        along @ unknowns[motion.translations] + circled,
    )
