"""Loads that the model does not feel: on frame coordinates that the formulation does not have.

A load at an interface acts on the modes, and on locked coordinates of the frame's node as a
reaction; the two are in proportion: the rigid motion ``a`` is the combination ``Lᵀa`` or ``Sᵀa`` of
the modes, with ``L = Σ M x × ψ`` and ``S = Σ M ψ``. What a locked coordinate holds beyond that
moves nothing: a load on the frame's node, or the lever that a load gets by the deflection.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.advice.loads import external_load, instants, turned, weight
from exudyn_rotor.multibody.locking import SPIN, TILTS
from exudyn_rotor.multibody.record import Record, newton_tolerance
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.theory.nodal import skew

_SINGULAR = 1e-3  # of the node's axes, where its second angle is near a right one


def lost_load(body: RotorBody, record: Record, size: float) -> float:
    """Return the largest load that the equations do not feel, over the largest load of the run.

    `size` [m] makes forces and moments comparable. Needs accelerations, so the first instant of a
    run does not count.
    """
    if "shell" not in body.objects or len(record.time) < 2:
        return 0.0
    lost, whole = 0.0, 0.0
    for index in instants(record):
        force, torque, missing, unbalanced = _balance(body, record, index)
        whole = max(whole, size * np.linalg.norm(force), np.linalg.norm(torque))
        beyond = max(size * np.linalg.norm(missing[:3]), np.linalg.norm(missing[3:]))
        lost = max(lost, beyond - size * unbalanced)
    return float(lost / whole) if whole else 0.0


def _balance(
    body: RotorBody, record: Record, index: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Return force and moment on the rotor, the part of both (6,) that is lost, and a force [N].

    The latter is what Newton's method may leave of the inertia forces, which are known to that.
    """
    motion, place = body.motion, body.layout
    t = float(record.time[index])
    q, q_t, q_tt = (part[index] for part in (record.q, record.q_t, record.q_tt))
    own = q[place.unknowns]
    inertia, external = external_load(body, record, index)
    held = place.lock_mass * q_tt + place.lock_damping * q_t + place.lock_stiffness * q
    held += record.held[index]
    for number, guide in body.locks.prescribed.items():
        held[number] -= (
            place.lock_mass[number] * guide.acceleration(t)
            + place.lock_damping[number] * guide.rate(t)
            + place.lock_stiffness[number] * guide.value(t)
        )
    held[place.unknowns] = external
    turn = turned(body, q)
    felt = external[motion.modes]
    missing = np.zeros(6)
    push = turn @ motion.invariants.S @ felt
    for number in body.locks.fixed:
        if number < 3:
            missing[number] = held[number] - push[number]
    force = motion.free_directions @ external[motion.translations] + push
    torque, lost = _moment(body, held, turn @ _levers(body) @ felt)
    # tilts are felt about the centre of mass, also where that has left the frame's node
    travel = turn @ motion.invariants.S @ own[motion.modes] / motion.invariants.mass
    e = body.motion.orientation @ motion.invariants.direction
    lever = np.cross(travel, force - weight(body))  # Exudyn's gravity gets no lever
    # position markers exert it on the node, rigid ones do not
    missing[3:] = min(lost, lost - (lever - e * (e @ lever)), key=np.linalg.norm)
    residual = newton_tolerance(body) * np.abs(inertia[motion.modes]).max(initial=0.0)
    return force, torque, missing, float(residual * np.sqrt(motion.invariants.mass))


def _levers(body: RotorBody) -> np.ndarray:
    """Return ``L = Σ M x × ψ`` of every mode, (3, m), mesh axes."""
    epsilon = np.array([skew(unit) for unit in np.eye(3)])
    return np.einsum("aib,abk->ik", epsilon, body.motion.invariants.P)


def _moment(body: RotorBody, held: np.ndarray, felt: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the moment on the node in inertial axes, and what of it tilts and is not felt."""
    first = body.frame.angles[0]
    e = body.motion.orientation @ body.motion.invariants.direction
    turned = np.array([0.0, np.cos(first), np.sin(first)])
    axes = np.array([[1.0, 0.0, 0.0], turned, e])
    if abs(np.linalg.det(axes)) < _SINGULAR:
        return felt, np.zeros(3)
    moment = np.linalg.solve(axes, held[[*TILTS, SPIN]])
    missing = moment - felt
    return moment, missing - e * (e @ missing)
