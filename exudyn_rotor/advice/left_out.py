"""What the modes of a run leave out at its interfaces: the static response beyond the modes.

The loads at the interfaces, and the centrifugal load of the rotor itself, deform it by more than
the run shows: by what the response of attachment modes has beyond the response of the modes. The
inertia of modes that are left out does not count: next to a resonance, and after a sudden start,
their motion is larger.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.advice.run_loads import instants, interface_loads, turned
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

_MOST = 400  # instants of a run that are looked at
_STILL = 1e-5  # of the rotor's size: motion that counts as none


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
    moved, flexible = _motion(rotor)
    flexibility = _flexibility(rotor.with_attachments) - _flexibility(rotor)
    stretch = _stretch(rotor.with_attachments, body) - _stretch(rotor, body)
    missing = flexibility @ loads.reshape(-1, len(picked))
    missing += np.outer(stretch, record.speed[picked] ** 2)
    bent = moved @ np.where(flexible[:, None], columns, 0.0)
    frame = np.column_stack([_of_frame(body, record.q[index]) for index in picked])
    whole = moved @ columns + np.tile(frame, (len(rotor.interfaces), 1))
    return _largest(missing) / max(_largest(whole), _largest(bent), _STILL * size)


def _of_frame(body: RotorBody, q: np.ndarray) -> np.ndarray:
    """Return how far the frame's axis has moved, in its own axes, without rotation (6,)."""
    motion, turn = body.motion, turned(body, q)
    # the frame may stand in a centre of mass off the axis, and that circles about it
    arm = body.selection.origin - body.axis.project(body.selection.origin)
    shift = motion.free_directions @ q[body.layout.unknowns][motion.translations]
    return np.concatenate([turn.T @ (shift + motion.orientation @ arm) - arm, np.zeros(3)])


def _largest(motion: np.ndarray) -> float:
    """Return the largest displacement of all interfaces together, of motions (6p, s) [m]."""
    displacements = motion.reshape(-1, 6, motion.shape[1])[:, :3]
    return float(np.sqrt((displacements**2).sum(axis=(0, 1))).max())


def _motion(rotor: ReducedRotor) -> tuple[np.ndarray, np.ndarray]:
    """Return the motion of all interfaces (6p, k), and which columns are flexible."""
    flexible = np.arange(rotor.size) >= len(rotor.rigid_kinds)
    return np.vstack([one.motion for one in rotor.interfaces.values()]), flexible


def _flexibility(rotor: ReducedRotor) -> np.ndarray:
    """Return ``Σ φ φᵀ/ω²`` of the flexible modes at the interfaces, (6p, 6p)."""
    motion, flexible = _motion(rotor)
    scaled = motion[:, flexible] / rotor.frequencies[flexible]
    return scaled @ scaled.T


def _stretch(rotor: ReducedRotor, body: RotorBody) -> np.ndarray:
    """Return the static motion of the interfaces by the centrifugal load per ω², (6p,)."""
    motion, flexible = _motion(rotor)
    h = rotor.invariants.moved(body.selection.origin - rotor.center_of_mass).h
    return motion[:, flexible] @ (h[flexible] / rotor.frequencies[flexible] ** 2)
