"""Runs that begin in a steady motion that is known by the coordinates of a reduced rotor."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, StartState
from exudyn_rotor.nonlinear.scene import check_origin, foundation_below


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
    (y, y_t), (turn, turn_t) = scene.of_coordinates(np.array([x[:size], x_t[:size]]))
    state = scene.state(y, y_t, angle + turn, speed + turn_t)  # a free spin departs from the mean
    q, q_t = state.q.copy(), state.q_t.copy()
    if base is not None:
        places = np.asarray(body.mbs.systemData.GetObjectLTGODE2(base.objects["physics"]))
        T = base.foundation.mode_shapes
        q[places], q_t[places] = T @ x[size:], T @ x_t[size:]
    return StartState(q, q_t, angle, speed)
