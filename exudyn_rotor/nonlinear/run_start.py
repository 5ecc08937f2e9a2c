"""Runs that begin in a steady motion that is known by the coordinates of a reduced rotor.

Of a reduced rotor, ``x = F f + T ζ`` with the motions F of the frame that its formulation has, and
the basis Ψ = Q T of its modal coordinates. After x come the modes of a foundation, and pairs of
controllers' coordinates, which turn as x does.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.linear.model.assembly import WORDS
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.multibody.rotor.record import StartState
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation
from exudyn_rotor.reduction.reduced_rotor import ModeKind
from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.rotating_axes import axes_of

_OWN = dict(zip((MagneticBearing, TiltingPadBearing), WORDS.values(), strict=False))


def state_in_scene(
    body: RotorBody,
    x: np.ndarray,
    x_t: np.ndarray,
    beside: tuple[str, ...],
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
    beside : tuple of str
        Names of the latter.
    angle, speed : float
        Of the spin [rad], [rad/s].

    Raises
    ------
    ValueError
        For a scene with another rotor, foundation or controllers.
    """
    body.check_assembled()
    if body.formulation.moves_origin:
        raise ValueError(
            f"body: rotor {body.name!r} follows a prescribed translation; a response has none"
        )
    source, names = body.selection.source, _beside(body)
    if names != beside or source.size + len(names) != len(x):
        raise ValueError(
            f"body: rotor {body.name!r} has {source.size} coordinates and {len(names)} of a "
            f"foundation, controllers and pads, the response {len(x) - len(beside)} and "
            f"{len(beside)}; compute it with the reduced rotor, the foundation and the supports, "
            "in the same order, of the scene"
        )
    scene = SceneCoordinates.of(body)
    rest = scene.rest.copy()
    rest[scene.free[: scene.count]] = 0.0
    (y, turn), (y_t, turn_t) = (in_body(body, each[: source.size]) for each in (x, x_t))
    # a free spin departs from the mean rotation
    state = replace(scene, rest=rest).state(y, y_t, angle + turn, speed + turn_t)
    state = replace(state, angle=angle, speed=speed)
    state = _with_beside(body, state, x[source.size :], x_t[source.size :])
    return _with_carried_frame(scene, state, angle, speed)


def _beside(body: RotorBody) -> tuple[str, ...]:
    """Return the names of a scene's coordinates beside the rotor."""
    foundation = _foundation(body)
    standing = 0 if foundation is None else foundation.foundation.size
    return tuple(f"foundation, {number}" for number in range(1, standing + 1)) + tuple(
        f"{_OWN[type(one.support)]} {index} at {one.support.interface}, {number}"
        for index, (one, _, size) in enumerate(_with_own(body), 1)
        for number in range(1, size + 1)
    )


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


def _with_own(body: RotorBody) -> list[tuple[SceneSupport, np.ndarray, int]]:
    """Return supports with own coordinates, where a scene has these, and how many.

    In the order of linear models.
    """
    places = [(one, one.own_coordinates(body.mbs)) for one in body.supports]
    found = [(one, where, len(where)) for one, where in places if len(where)]
    return sorted(found, key=lambda each: list(_OWN).index(type(each[0].support)))


def _with_beside(body: RotorBody, state: StartState, x: np.ndarray, x_t: np.ndarray) -> StartState:
    """Add the coordinates of a foundation, controllers and pads to the state of a rotor."""
    q, q_t = state.q.copy(), state.q_t.copy()
    base, first = _foundation(body), 0
    if base is not None:
        places = np.asarray(body.mbs.systemData.GetObjectLTGODE2(base.objects["physics"]))
        T, first = base.foundation.mode_shapes, base.foundation.size
        q[places], q_t[places] = T @ x[:first], T @ x_t[:first]
    c, s = np.cos(state.angle), np.sin(state.angle)
    R, R_t = np.array([[c, s], [-s, c]]), state.speed * np.array([[-s, c], [-c, -s]])
    for one, places, size in _with_own(body):
        own, rates = (X[first : first + size] for X in (x, x_t))
        first += size
        if isinstance(one.support, TiltingPadBearing):
            radius = one.support.film.radius
            q[places], q_t[places] = -own / radius, -rates / radius
        else:
            pairs, rates = own.reshape(-1, 2), rates.reshape(-1, 2)
            q[places], q_t[places] = (pairs @ R).ravel(), (rates @ R + pairs @ R_t).ravel()
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
