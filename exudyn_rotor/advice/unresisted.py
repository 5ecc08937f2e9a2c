"""Loads that nothing resists: on frame coordinates that the formulation does not have.

A load at an interface acts on the modes, and on locked coordinates of the frame's node as a
reaction; the two are in proportion: the translation or tilt ``a`` is the combination ``Sᵀa`` or
``Lᵀa`` of the modes, with ``S = Σ M ψ`` and ``L = Σ M x × ψ``. What a locked coordinate holds
beyond that moves nothing: a load on the coordinate, or the moment arm that a load gets by the
deflection.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.advice.run_loads import external_load, instants, turned, weight
from exudyn_rotor.multibody.drives.add_drive import SceneDrive
from exudyn_rotor.multibody.rotor.record import Record, last_solver, newton_tolerance
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.theory.nodal import skew

_SINGULAR = 0.1  # singular value of the node's axes below which they do not show a direction


def unresisted_load(body: RotorBody, record: Record, size: float) -> float | None:
    """Return the largest load that no equation resists, over the largest load of the run.

    `size` [m] makes forces and moments comparable. Needs accelerations, so the first instant of a
    run does not count. None where explicit solvers eliminate the constraints: the forces on locked
    coordinates are not known then.
    """
    solver = last_solver(body)
    if body.constraints and solver is not None and solver.explicit:
        return None
    if "marker_body" not in body.objects or len(record.time) < 2:
        return 0.0
    unresisted, largest = 0.0, 0.0
    for index in instants(record):
        force, moment, missing, uncertain = _balance(body, record, index)
        largest = max(largest, size * np.linalg.norm(force), np.linalg.norm(moment))
        excess = max(size * np.linalg.norm(missing[:3]), np.linalg.norm(missing[3:]))
        unresisted = max(unresisted, excess - size * uncertain)
    return float(unresisted / largest) if largest else 0.0


def _balance(
    body: RotorBody, record: Record, index: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Return force and moment on the rotor, what of both (6,) is unresisted, and a force [N].

    The latter is what Newton's method may leave of the inertia forces, which are known to that.
    """
    motion, place = body.motion, body.layout
    t = float(record.time[index])
    q, q_tt = record.q[index], record.q_tt[index]
    inertia, external = external_load(body, record, index)
    load = place.lock_mass * q_tt + record.held[index]
    if body.plan.setup.locking == "mass":
        for number, driven in body.locks.varying.items():
            load[number] -= place.lock_mass[number] * driven.acceleration(t)
    load[place.unknowns] = external
    # a drive of the whole rotor acts on the coordinate, not as a moment along its axis
    drives = [one.drive for one in body.drives if isinstance(one, SceneDrive) and one.at is None]
    load[body.locks.spin] -= sum(one.law(float(record.speed[index]), t) for one in drives)
    turn = turned(body, q)
    on_modes = external[motion.modes]
    missing = np.zeros(6)
    modal_force = turn @ motion.invariants.S @ on_modes
    for number in body.locks.fixed:
        if number < 3:
            missing[number] = load[number] - modal_force[number]
    force = motion.free_directions @ external[motion.translations] + modal_force
    modal_moment = turn @ _angular_momenta(body) @ on_modes
    known, seen = _moment_on_node(body, q, load)
    # about the origin of the formulation, which may be elsewhere on the axis
    arm = turn @ (body.selection.origin - body.frame.origin)
    known = known - seen @ np.cross(arm, force)
    e = motion.orientation @ motion.invariants.direction
    tilting = (np.eye(3) - np.outer(e, e)) @ seen
    unresisted = tilting @ (known - modal_moment)
    # tilts are resisted about the centre of mass, also where that has left the frame's node
    zeta = q[place.unknowns][motion.modes]
    arm = turn @ motion.invariants.S @ zeta / motion.invariants.mass
    by_arm = np.cross(arm, force - weight(body))  # Exudyn's gravity gets no arm
    # position markers exert it on the node, rigid ones do not
    missing[3:] = min(unresisted, unresisted - tilting @ by_arm, key=np.linalg.norm)
    moment = modal_moment + seen @ (known - modal_moment)
    residual = newton_tolerance(body) * np.abs(inertia[motion.modes]).max(initial=0.0)
    return force, moment, missing, float(residual * np.sqrt(motion.invariants.mass))


def _angular_momenta(body: RotorBody) -> np.ndarray:
    """Return ``L = Σ M x × ψ`` of every mode, (3, m), mesh axes."""
    epsilon = np.array([skew(unit) for unit in np.eye(3)])
    return np.einsum("aib,abk->ik", epsilon, body.motion.invariants.P)


def _moment_on_node(
    body: RotorBody, q: np.ndarray, load: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the moment on the node in inertial axes, and the projector (3, 3) on what it shows.

    The node's generalised moments are components along its axes of rotation. Two of these coincide
    where the second angle is a right one, and say nothing of the direction across all of them.
    """
    left, sizes, right = np.linalg.svd(_axes_of_rotation(body, q))
    shown = sizes > _SINGULAR
    moment = right[shown].T @ ((left[:, shown].T @ load[3:6]) / sizes[shown])
    return moment, right[shown].T @ right[shown]


def _axes_of_rotation(body: RotorBody, q: np.ndarray) -> np.ndarray:
    """Return the inertial axes (3, 3), in rows, that the node's angles turn about, θ about e."""
    return body.frame.axes_of_angles(q[3:6])
