"""A scene as a rotor, or a train of rotors, on supports and laws, and the start of a run in it.

Laws are known by what :func:`exudyn_rotor.add_supports` added, and Exudyn's own forces by their
constants. Anything else might be nonlinear, and is refused by its name.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import exudyn
import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given, given_supports
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.model.build import Target
from exudyn_rotor.linear.model.scene.linear_scene import (
    LinearScene,
    check_scene,
    known_objects,
    objects_beside,
)
from exudyn_rotor.linear.model.scene.scene_train import scene_train
from exudyn_rotor.linear.response.loads import HarmonicForce
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, StartState
from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation

_INSTEAD = (
    "periodic_response takes laws of add_supports on the ground or on one foundation, and constant "
    "forces at interfaces; leave it out, or look at a run"
)


class Listed(NamedTuple):
    """A scene as it is given by lists; gravity is in axes of the (first) rotor's mesh."""

    target: Target
    supports: tuple[Given, ...]
    foundation: Foundation | None
    gravity: np.ndarray
    loads: tuple[HarmonicForce, ...]
    stiffening: str


def as_lists(
    target: Target,
    body: RotorBody | Sequence[RotorBody] | None,
    supports: Sequence[Given] | Given,
    foundation: Foundation | None,
    gravity: ArrayLike,
    loads: Sequence[HarmonicForce] | HarmonicForce,
    stiffening: str,
) -> Listed:
    """Return what is given by lists, checked; of a scene, what it has.

    With constant speeds in place of the drives of a scene.
    """
    supports = given_supports(supports)
    loads = checks.instances(loads, "loads", HarmonicForce)
    gravity = checks.vector(gravity, "gravity", "m/s²")
    if not isinstance(target, exudyn.MainSystem):
        if body is not None:
            raise TypeError("body: is only for an exudyn.MainSystem, not for the rotor itself")
        return Listed(target, supports, foundation, gravity, loads, stiffening)
    if supports or loads or foundation or np.any(gravity):
        raise ValueError(
            "supports, foundation, gravity, loads: a scene has its own; leave these out"
        )
    mbs = target
    if isinstance(body, list | tuple):
        target, level = scene_train(mbs, body)
        bodies, base, supports, foundation = list(body), None, (), None
    else:
        check_scene(mbs, reduced_body(body, how="the rotor in the scene, of add_rotor"))
        base = foundation_below(body)
        _check_objects(body, base)
        target, level, bodies = body.selection.source, body.stiffening, [body]
        supports = tuple(one.support for one in body.supports)
        foundation = None if base is None else _in_mesh(base, body)
    for one in bodies:
        check_origin(one)
    gravity = bodies[0].gravity
    if any(np.any(one.gravity != gravity) for one in bodies):
        raise ValueError("body: the rotors of this scene have different gravity; give all the same")
    gravity = bodies[0].placement.rotation.T @ gravity
    loads = tuple(_loads(mbs, bodies, base))
    return Listed(target, supports, foundation, gravity, loads, level)


def check_origin(body: RotorBody) -> None:
    """Refuse a rotor whose place is moved."""
    if body.formulation.moves_origin:
        raise ValueError(
            f"body: rotor {body.name!r} follows a prescribed translation, which no steady motion "
            "here has; look at a run"
        )


def foundation_below(body: RotorBody) -> SceneFoundation | None:
    """Return what carries all supports of a rotor; None for the ground."""
    bases = [one.base for one in body.supports]
    for one in body.supports:
        if one.base is not bases[0] or not isinstance(one.base, SceneFoundation | None):
            raise ValueError(
                f"body: the support at {one.support.interface!r} stands on something else; "
                f"{_INSTEAD}"
            )
    return bases[0] if bases else None


def _in_mesh(base: SceneFoundation, body: RotorBody) -> Foundation:
    """Return a foundation of a scene in axes of the rotor's mesh."""
    placement, found = body.placement, base.foundation
    back = placement.rotation.T
    if base.gravity_load is None:  # it does not sag, in lists either
        found = replace(found, participation=np.zeros((3, found.size)))
    return found.turned(back, -back @ placement.position)


def _check_objects(body: RotorBody, base: SceneFoundation | None) -> None:
    """Refuse all objects but known ones."""
    known = known_objects(body)
    known |= set() if base is None else set(map(int, base.objects.values()))
    for item in objects_beside(body.mbs, known):
        raise ValueError(
            f"mbs: {item['objectType']} {item['name']!r} is no law of this package; {_INSTEAD}"
        )


def _loads(
    mbs: exudyn.MainSystem, bodies: Sequence[RotorBody], base: SceneFoundation | None
) -> Iterator[HarmonicForce]:
    """Yield constant forces at interfaces, and refuse all loads but these and weights."""
    weights = [one.gravity_load for one in (*bodies, *([] if base is None else [base]))]
    weights = {int(number) for number in weights if number is not None}
    named = {
        int(marker): (f"{one.name}:{name}" if len(bodies) > 1 else name, one.standing_axes)
        for one in bodies
        for name, marker in one.markers.items()
    }
    for number in set(range(mbs.systemData.NumberOfLoads())) - weights:
        load = mbs.GetLoad(number)
        is_known = load["loadType"] == "ForceVector" and int(load["markerNumber"]) in named
        if not is_known or load["bodyFixed"] or load["loadVectorUserFunction"]:
            raise ValueError(
                f"mbs: load {number} ({load['loadType']} {load['name']!r}) is no constant force at "
                f"an interface; {_INSTEAD}"
            )
        at, axes = named[int(load["markerNumber"])]
        yield HarmonicForce(at, axes.T @ load["loadVector"])


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
