"""Loads of a run, from the record of its motion and the equations of the rotor."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.theory.axis import SpinAxis

_MOST = 400  # instants of a run that are looked at


def instants(record: Record, most: int = _MOST) -> np.ndarray:
    """Return which instants to look at, evenly over the run; the first has no accelerations."""
    return np.unique(np.linspace(1, len(record.time) - 1, most).astype(int))


def external_load(body: RotorBody, record: Record, index: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the inertia forces and the external load at an instant, each per coordinate."""
    motion, place = body.motion, body.layout
    t = float(record.time[index])
    q, q_t, q_tt = (rows[index][place.unknowns] for rows in (record.q, record.q_t, record.q_tt))
    inertia = motion.mass_matrix(t, q, q_t) @ q_tt
    return inertia, inertia - motion.forces(t, q, q_t)


def turned(body: RotorBody, q: np.ndarray) -> np.ndarray:
    """Return the orientation (3, 3) of the rotor frame for coordinates of the body's nodes."""
    motion = body.motion
    return motion.orientation @ SpinAxis(motion.invariants.direction).rotation(q[body.locks.spin])


def weight(body: RotorBody) -> np.ndarray:
    """Return the weight that Exudyn applies, inertial axes [N]."""
    if body.gravity_load is None:
        return np.zeros(3)
    gravity = body.mbs.GetLoadParameter(body.gravity_load, "loadVector")
    return body.motion.invariants.mass * np.asarray(gravity)


def external_force(body: RotorBody, record: Record) -> float:
    """Return the largest resultant of the loads on a reduced rotor in a run, by its equations [N].

    Modes that do not move the centre of mass count by their share ``√m`` of a unit of modal mass.
    """
    if len(record.time) < 2:
        return 0.0
    motion, largest = body.motion, 0.0
    for index in instants(record, 50):
        external = external_load(body, record, index)[1]
        modal = np.linalg.norm(external[motion.modes]) * np.sqrt(motion.invariants.mass)
        largest = max(largest, modal, np.linalg.norm(external[motion.translations]))
    return float(largest)
