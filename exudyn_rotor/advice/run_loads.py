"""Loads of a run, and the static response to them that the modes leave out.

The loads on a rotor are what its equations leave over, ``f = M q̈ − Q(q, q̇)``. Forces and moments F
at the places where something acts (`load_places`) follow from them by
``Uᵀ F = f`` with the motion U of these places, in the sense of least squares. They, and the
centrifugal load of the rotor itself, deform it by more than the run shows: by what the response of
attachment modes has beyond the response of the modes. The inertia of modes that are left out does
not count: next to a resonance, and after a sudden start, their motion is larger.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.multibody.rotor.connections import load_places
from exudyn_rotor.multibody.rotor.rotor_body import Record, RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.axis import skew

_MOST = 400  # instants of a run that are looked at
_STILL = 1e-5  # of the rotor's size: motion that counts as none
_SEEN = 1e-3  # singular values below this share of the largest tell nothing about loads


def instants(record: Record, most: int) -> np.ndarray:
    """Return which instants to look at, evenly over the run; the first has no accelerations."""
    return np.unique(np.linspace(1, len(record.time) - 1, most).astype(int))


def interface_loads(
    body: RotorBody, record: Record, picked: np.ndarray, size: float
) -> np.ndarray | None:
    """Return forces and moments about the interfaces' references, mesh axes, (p, 6, s).

    Without the weight. Loads elsewhere do not count. `size` [m] makes forces and moments
    comparable. None where the scene knows no interfaces.
    """
    interfaces = body.selection.source.interfaces
    if not interfaces:
        return None
    names, total = list(interfaces), np.zeros((len(interfaces), 6, len(picked)))
    places = load_places(body)
    if not places:
        return total
    inv, e = body.motion.invariants, body.motion.invariants.direction
    units = np.concatenate([np.repeat([1.0, size], 3)[: len(place.motion)] for place in places])
    forces = np.hstack([np.eye(3, len(place.motion)) for place in places])
    free = {0: np.zeros((3, 3)), 2: np.eye(3) - np.outer(e, e), 3: np.eye(3)}
    frame = free[body.formulation.translation_count] @ forces / np.sqrt(inv.mass)
    equations = np.vstack([np.vstack([place.motion for place in places]).T, frame])
    loads = np.column_stack([_without_weight(body, record, index) for index in picked])
    found = units[:, None] * (np.linalg.pinv(equations * units, rcond=_SEEN) @ loads)
    ends = np.cumsum([len(place.motion) for place in places])
    for place, values in zip(places, np.split(found, ends[:-1]), strict=True):
        if place.interface is not None:
            row = total[names.index(place.interface)]
            row[: len(values)] += values
            row[3:] += skew(place.point - interfaces[place.interface].reference) @ values[:3]
    return total


def _without_weight(body: RotorBody, record: Record, index: int) -> np.ndarray:
    """Return loads on the modes and, over √m and in rotor axes, on the frame (m + 3,)."""
    motion, inv, weight = body.motion, body.motion.invariants, np.zeros(3)
    t, places = float(record.time[index]), body.layout.unknowns
    q, q_t, q_tt = (rows[index][places] for rows in (record.q, record.q_t, record.q_tt))
    external = motion.mass_matrix(t, q) @ q_tt - motion.forces(t, q, q_t)
    if body.gravity_load is not None:
        gravity = body.mbs.GetLoadParameter(body.gravity_load, "loadVector")
        weight = inv.mass * np.asarray(gravity)
    turn, N = motion.at(t, q, q_t).A, motion.free_directions
    on_modes = external[motion.modes] - inv.S.T @ turn.T @ weight / inv.mass
    on_frame = turn.T @ N @ (external[motion.translations] - N.T @ weight)
    return np.concatenate([on_modes, on_frame / np.sqrt(inv.mass)])


def residual_deflection(body: RotorBody, record: Record, size: float) -> float | None:
    """Return the deflection at interfaces that the modes leave out, over their displacement.

    Against the rotor's mean motion. Stiff supports let the interfaces move less than the rotor
    bends; then over its bending there. Loads elsewhere, and on the spin of the frame, do not count.
    `size` [m] makes forces and moments comparable. None where it is not known what the modes leave
    out.
    """
    rotor, motion = body.selection.source, body.motion
    if rotor.with_attachments is None or len(record.time) < 2:
        return None if rotor.with_attachments is None else 0.0
    picked = instants(record, _MOST)
    loads = interface_loads(body, record, picked, size)
    if loads is None:
        return None
    columns = body.selection.T @ record.q[picked][:, body.layout.unknowns][:, motion.modes].T
    moved = np.vstack([one.motion for one in rotor.interfaces.values()])
    (all_, stretch), (own, own_stretch) = (
        _static(each, body) for each in (rotor.with_attachments, rotor)
    )
    missing = (all_ - own) @ loads.reshape(-1, len(picked))
    missing += np.outer(stretch - own_stretch, record.speed[picked] ** 2)
    rigid = len(rotor.rigid_kinds)
    bent = moved[:, rigid:] @ columns[rigid:]
    frame = np.column_stack([_of_frame(body, record, index) for index in picked])
    whole = moved @ columns + np.tile(frame, (len(rotor.interfaces), 1))
    return _largest(missing) / max(_largest(whole), _largest(bent), _STILL * size)


def _of_frame(body: RotorBody, record: Record, index: int) -> np.ndarray:
    """Return how far the frame's axis has moved, in its own axes, without rotation (6,)."""
    motion, places = body.motion, body.layout.unknowns
    q, q_t = record.q[index][places], record.q_t[index][places]
    turn = motion.at(float(record.time[index]), q, q_t).A
    # the frame may stand in a centre of mass off the axis, and that circles about it
    arm = body.selection.origin - body.axis.project(body.selection.origin)
    shift = motion.free_directions @ q[motion.translations]
    return np.concatenate([turn.T @ (shift + motion.orientation @ arm) - arm, np.zeros(3)])


def _largest(motion: np.ndarray) -> float:
    """Return the largest displacement of all interfaces together, of motions (6p, s) [m]."""
    displacements = motion.reshape(-1, 6, motion.shape[1])[:, :3]
    return float(np.sqrt((displacements**2).sum(axis=(0, 1))).max())


def _static(rotor: ReducedRotor, body: RotorBody) -> tuple[np.ndarray, np.ndarray]:
    """Return static motions of the interfaces by the flexible modes.

    By loads there, ``Σ φ φᵀ/ω²`` (6p, 6p), and by the centrifugal load per ω², (6p,).
    """
    flexible = slice(len(rotor.rigid_kinds), None)
    frequencies = rotor.frequencies[flexible]
    motion = np.vstack([one.motion[:, flexible] for one in rotor.interfaces.values()])
    scaled = motion / frequencies
    h = rotor.invariants.moved(body.selection.origin - rotor.center_of_mass).h
    return scaled @ scaled.T, scaled @ (h[flexible] / frequencies)
