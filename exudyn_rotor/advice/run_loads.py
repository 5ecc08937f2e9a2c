"""Loads of a run, from the record of its motion and the equations of the rotor.

The loads on a rotor are what its equations leave over, ``f = M q̈ − Q(q, q̇)``. Forces and moments F
at the places where something acts (:mod:`exudyn_rotor.multibody.load_places`) follow from them by
``Uᵀ F = f`` with the motion U of these places, in the sense of least squares.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.multibody.load_places import load_places
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import skew

_SEEN = 1e-3  # singular values below this share of the largest tell nothing about loads


def instants(record: Record, most: int) -> np.ndarray:
    """Return which instants to look at, evenly over the run; the first has no accelerations."""
    return np.unique(np.linspace(1, len(record.time) - 1, most).astype(int))


def external_load(body: RotorBody, record: Record, index: int) -> np.ndarray:
    """Return the external load at an instant per coordinate of the equations."""
    motion, place = body.motion, body.layout
    t = float(record.time[index])
    q, q_t, q_tt = (rows[index][place.unknowns] for rows in (record.q, record.q_t, record.q_tt))
    return motion.mass_matrix(t, q, q_t) @ q_tt - motion.forces(t, q, q_t)


def external_force(body: RotorBody, record: Record) -> float:
    """Return the largest resultant of the loads on a reduced rotor in a run, by its equations [N].

    Modes that do not move the centre of mass count by their share ``√m`` of a unit of modal mass.
    """
    if len(record.time) < 2:
        return 0.0
    motion, largest = body.motion, 0.0
    for index in instants(record, 50):
        external = external_load(body, record, index)
        modal = np.linalg.norm(external[motion.modes]) * np.sqrt(motion.invariants.mass)
        largest = max(largest, modal, np.linalg.norm(external[motion.translations]))
    return float(largest)


def interface_loads(
    body: RotorBody, record: Record, picked: np.ndarray, size: float
) -> np.ndarray | None:
    """Return forces and moments about the interfaces' references, mesh axes, (p, 6, s).

    Without the weight. Loads elsewhere do not count. `size` [m] makes forces and moments
    comparable. None where the scene knows no interfaces.
    """
    interfaces = body.selection.source.interfaces
    if "marker_body" not in body.objects or not interfaces:
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


def turned(body: RotorBody, q: np.ndarray) -> np.ndarray:
    """Return the orientation (3, 3) of the rotor frame for coordinates of the body's nodes."""
    motion = body.motion
    return motion.orientation @ SpinAxis(motion.invariants.direction).rotation(q[body.locks.spin])


def _without_weight(body: RotorBody, record: Record, index: int) -> np.ndarray:
    """Return loads on the modes and, over √m and in rotor axes, on the frame (m + 3,)."""
    motion, weight = body.motion, np.zeros(3)
    inv, external = motion.invariants, external_load(body, record, index)
    if body.gravity_load is not None:
        gravity = body.mbs.GetLoadParameter(body.gravity_load, "loadVector")
        weight = inv.mass * np.asarray(gravity)
    turn, N = turned(body, record.q[index]), motion.free_directions
    on_modes = external[motion.modes] - inv.S.T @ turn.T @ weight / inv.mass
    on_frame = turn.T @ N @ (external[motion.translations] - N.T @ weight)
    return np.concatenate([on_modes, on_frame / np.sqrt(inv.mass)])
