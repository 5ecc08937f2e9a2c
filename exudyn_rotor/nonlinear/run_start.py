"""Runs that begin in a steady motion that is known by the coordinates of a reduced rotor.

Of a reduced rotor, ``x = F f + T ζ`` with the motions F of the frame that its formulation has, and
the basis Ψ = Q T of its modal coordinates. After x come the modes of a foundation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.multibody.rotor.record import StartState
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation
from exudyn_rotor.reduction.reduced_rotor import ModeKind
from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.rotating_axes import axes_of


def state_in_scene(
    body: RotorBody,
    x: np.ndarray,
    x_t: np.ndarray,
    beside: int,
    angle: float,
    speed: float,
) -> StartState:
    """Return the state of a scene with a rotor in a motion, everything else at rest.

    Parameters
    ----------
    body : RotorBody
        In an assembled system.
    x, x_t : ndarray, shape (k,)
        Coordinates of the reduced rotor in its own axes, and what is beside it; their rates.
    beside : int
        Number of the latter.
    angle, speed : float
        Of the spin [rad], [rad/s].

    Raises
    ------
    ValueError
        For a scene with another rotor or foundation, or with controllers or pads.
    """
    body.check_assembled()
    if body.formulation.moves_origin:
        raise ValueError(
            f"body: rotor {body.name!r} follows a prescribed translation; a response has none"
        )
    if any(len(one.own_coordinates(body.mbs)) for one in body.supports):
        raise ValueError(
            f"body: supports of rotor {body.name!r} have coordinates of their own, controllers or "
            "pads, in which no run begins; let it settle from steady_state"
        )
    source, base = body.selection.source, _foundation(body)
    standing = 0 if base is None else base.foundation.size
    if standing != beside or source.size + standing != len(x):
        raise ValueError(
            f"body: rotor {body.name!r} has {source.size} coordinates and {standing} of a "
            f"foundation, the response {len(x) - beside} and {beside}; compute it with the reduced "
            "rotor and the foundation of the scene"
        )
    scene = SceneCoordinates.of(body)
    rest = scene.rest.copy()
    rest[scene.free[: scene.count]] = 0.0
    (y, turn), (y_t, turn_t) = (in_body(body, each[: source.size]) for each in (x, x_t))
    # a free spin departs from the mean rotation
    state = replace(scene, rest=rest).state(y, y_t, angle + turn, speed + turn_t)
    state = replace(state, angle=angle, speed=speed)
    state = _with_foundation(body, state, x[source.size :], x_t[source.size :])
    return _with_carried_frame(scene, state, angle, speed)


def _foundation(body: RotorBody) -> SceneFoundation | None:
    """Return the foundation that carries supports of a rotor; None on the ground.

    Raises
    ------
    ValueError
        Where there are several.
    """
    bases = [one.base for one in body.supports if isinstance(one.base, SceneFoundation)]
    if any(base is not bases[0] for base in bases):
        raise ValueError(
            f"body: rotor {body.name!r} stands on several foundations, and a response on one; "
            "compute the response of the scene"
        )
    return bases[0] if bases else None


def _with_foundation(
    body: RotorBody, state: StartState, x: np.ndarray, x_t: np.ndarray
) -> StartState:
    """Add the coordinates of a foundation to the state of a rotor."""
    base = _foundation(body)
    if base is None:
        return state
    q, q_t = state.q.copy(), state.q_t.copy()
    places = np.asarray(body.mbs.systemData.GetObjectLTGODE2(base.objects["physics"]))
    T = base.foundation.mode_shapes
    q[places], q_t[places] = T @ x, T @ x_t
    return replace(state, q=q, q_t=q_t)


def in_body(body: RotorBody, x: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the unknowns y of a rotor in axes that turn with it, and the turn of a free spin."""
    selection, source = body.selection, body.selection.source
    count = body.formulation.translation_count
    held = [
        index
        for index, kind in enumerate(source.kinds)
        if kind in (ModeKind.TRANSLATION_1, ModeKind.TRANSLATION_2)[:count]
        or (kind is ModeKind.AXIAL and count == 3)
    ]
    frame = [np.eye(source.size)[:, held]]
    if body.formulation.has_spin:
        about = source.invariants.moved(selection.origin - source.center_of_mass)
        frame.append(about.g[:, None])  # a rotation of 1 rad about the axis
    f = np.linalg.lstsq(np.hstack([*frame, selection.T]), x, rcond=None)[0]
    # displacement of a rigid translation by its columns, S/m
    shift = source.invariants.S[:, held] @ f[: len(held)] / source.invariants.mass
    turning = axes_of(source.axis)[:, : SceneCoordinates.of(body).count].T @ shift
    zeta = f[len(f) - selection.T.shape[1] :]
    spin = float(f[len(held)]) if body.formulation.has_spin else 0.0
    return np.r_[turning, zeta], spin


def _with_carried_frame(
    scene: SceneCoordinates, state: StartState, angle: float, speed: float
) -> StartState:
    """Add the circle on which an eccentric rotor about its axis carries the frame's origin."""
    body, count = scene.body, scene.count
    if not count:
        return state
    motion = body.motion
    across = body.axis.radial(body.frame.origin)
    A = motion.orientation @ body.axis.rotation(angle)
    e = skew(body.axis.direction)
    q, q_t = state.q.copy(), state.q_t.copy()
    places = scene.free[:count]
    q[places] += motion.free_directions.T @ (A - motion.orientation) @ across
    q_t[places] += speed * motion.free_directions.T @ A @ e @ across
    return replace(state, q=q, q_t=q_t)
