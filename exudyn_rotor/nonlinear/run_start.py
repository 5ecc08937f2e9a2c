"""Runs that begin in a steady motion that is known by the coordinates of a reduced rotor.

Of a reduced rotor, ``x = F f + T ζ`` with the motions F of the frame that its formulation has, and
the basis Ψ = Q T of its modal coordinates. After x come the modes of a foundation.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, StartState
from exudyn_rotor.nonlinear.scene import check_origin, foundation_below
from exudyn_rotor.reduction.reduced_rotor import ModeKind
from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.rotating_axes import axes_of


def state_in_scene(
    body: RotorBody, x: np.ndarray, x_t: np.ndarray, beside: int, angle: float, speed: float
) -> StartState:
    """Return the state of a scene with a rotor in a motion, everything else at rest.

    `x` and `x_t` (k,) are the coordinates of the reduced rotor in its own axes, those `beside` it,
    and their rates; `angle` and `speed` are of the spin [rad], [rad/s].
    """
    body.check_assembled()
    check_origin(body)
    if any(len(one.own_coordinates(body.mbs)) for one in body.supports):
        raise ValueError(
            f"body: supports of rotor {body.name!r} have coordinates of their own, controllers or "
            "pads, in which no run begins; let it settle from steady_state"
        )
    size, base = body.selection.source.size, foundation_below(body)
    standing = 0 if base is None else base.foundation.size
    if standing != beside or size + standing != len(x):
        raise ValueError(
            f"body: rotor {body.name!r} has {size} coordinates and {standing} of a foundation, the "
            f"response {len(x) - beside} and {beside}; compute it with the reduced rotor and the "
            "foundation of the scene"
        )
    scene = LinearScene.of_rotor(body)
    rest = scene.rest.copy()
    rest[scene.free[: scene.count]] = 0.0
    (y, turn), (y_t, turn_t) = (in_body(body, each[:size]) for each in (x, x_t))
    # a free spin departs from the mean rotation
    state = replace(scene, rest=rest).state(y, y_t, angle + turn, speed + turn_t)
    q, q_t = state.q.copy(), state.q_t.copy()
    if base is not None:
        places = np.asarray(body.mbs.systemData.GetObjectLTGODE2(base.objects["physics"]))
        T = base.foundation.mode_shapes
        q[places], q_t[places] = T @ x[size:], T @ x_t[size:]
    # the circle on which an eccentric rotor about its axis carries the frame's origin
    motion, places = body.motion, scene.free[: scene.count]
    across, N = body.axis.radial(body.frame.origin), motion.free_directions
    A = motion.orientation @ body.axis.rotation(angle)
    q[places] += N.T @ (A - motion.orientation) @ across
    q_t[places] += speed * N.T @ A @ skew(body.axis.direction) @ across
    return StartState(q, q_t, angle, speed)


def in_body(body: RotorBody, x: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the unknowns y of a rotor in axes that turn with it, and the turn of a free spin."""
    selection, source = body.selection, body.selection.source
    count = body.formulation.translation_count
    kinds = (ModeKind.TRANSLATION_1, ModeKind.TRANSLATION_2, ModeKind.AXIAL)[:count]
    held = [index for index, kind in enumerate(source.kinds) if kind in kinds]
    frame = [np.eye(source.size)[:, held]]
    if body.formulation.has_spin:
        about = source.invariants.moved(selection.origin - source.center_of_mass)
        frame.append(about.g[:, None])  # a rotation of 1 rad about the axis
    f = np.linalg.lstsq(np.hstack([*frame, selection.T]), x, rcond=None)[0]
    # displacement of a rigid translation by its columns, S/m
    shift = source.invariants.S[:, held] @ f[: len(held)] / source.invariants.mass
    turning = axes_of(source.axis)[:, :count].T @ shift
    zeta = f[len(f) - selection.T.shape[1] :]
    spin = float(f[len(held)]) if body.formulation.has_spin else 0.0
    return np.r_[turning, zeta], spin
