"""Runs that begin in the steady motion of a linear response.

A response keeps harmonics of coordinates in the axes of the rotor: of the reduced rotor's basis x,
or of a scene y. Of a reduced rotor, ``x = F f + T ζ`` with the motions F of the frame that its
formulation has, and the basis Ψ = Q T of its modal coordinates. After x come the modes of a
foundation, and pairs of controllers' coordinates, which turn as x does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.linear.model.assembly import WORDS
from exudyn_rotor.linear.model.linear_model import ON_FOUNDATION, LinearModel
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.linear.model.scene.scene_model import SceneModel
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.start_state import StartState, spin_at_start
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation
from exudyn_rotor.reduction.fields import ModeKind
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.results import Result, numbers, words
from exudyn_rotor.theory.nodal import skew
from exudyn_rotor.theory.rotating_axes import axes_of

BASES = ("rotor", "scene")
_OWN = dict(zip((MagneticBearing, TiltingPadBearing), WORDS.values(), strict=False))
_SAME_SPEED = 1e-9  # share by which a wanted speed may differ from a computed one
_SAME_MOTION = 1e-4  # share of the largest motion of an interface by small harmonics left out


@dataclass(frozen=True, eq=False)
class RunStart(Result):
    """What a response keeps for runs that begin in its motion.

    Attributes
    ----------
    coordinates : ndarray of complex, shape (s, h, k), optional
        Harmonics of the model's coordinates, rotor frame, −N … N unless the response tells others;
        None for a SolidRotor.
    basis : {'rotor', 'scene'}, optional
        Whether these are of the reduced rotor's basis or of a scene.
    beside : tuple of str, optional
        Names of those after the reduced rotor's: of a foundation, controllers and pads.
    """

    coordinates: np.ndarray | None = numbers(
        "abscissa", "harmonics", "coordinates", dtype=complex, finite=False, optional=True
    )
    basis: str | None = field(default=None, kw_only=True)
    beside: tuple[str, ...] = words("beside", default=(), kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.coordinates is None) != (self.basis is None):
            raise ValueError("coordinates, basis: need each other; give both, or none")
        known = self.coordinates.shape[2] if self.basis == "rotor" else 1
        if len(self.beside) >= known:
            raise ValueError(
                f"beside: needs fewer names than the {known} coordinates of a rotor and what is "
                f"beside it, got {len(self.beside)}"
            )
        if self.basis is not None:
            checks.choice(self.basis, "basis", BASES)
            self._check_harmonics()

    def _start_at_speed(self, speed: float, body: RotorBody, angle: float | None) -> StartState:
        """Return the state at a spin speed; by default at the angle with which the rotor starts."""
        speed = checks.number(speed, "speed", "rad/s")
        reduced_body(body)
        angle = spin_at_start(body)[0] if angle is None else checks.number(angle, "angle", "rad")
        return self._start(speed, body, angle, speed)

    def _start(self, value: float, body: RotorBody, angle: float, speed: float) -> StartState:
        """Return the state of a scene at a computed speed or frequency."""
        reduced_body(body)
        body.check_assembled()
        index = self._computed_at(value)
        scene = self._scene(body)
        phases, rates = self._waves(index)
        turned = np.exp(1j * phases * angle)[:, None] * self.coordinates[index]
        x, x_t = turned.sum(axis=0).real, (1j * rates[:, None] * turned).sum(axis=0).real
        if self.basis == "scene":
            state = scene.state(x, x_t, angle, speed)
        else:
            own = x.size - len(self.beside)
            (y, turn), (y_t, turn_t) = (_in_body(body, one[:own]) for one in (x, x_t))
            # a free spin departs from the mean rotation
            state = scene.state(y, y_t, angle + turn, speed + turn_t)
            state = replace(state, angle=angle, speed=speed)
            state = _with_beside(body, state, x[own:], x_t[own:])
        return _with_carried_frame(scene, state, angle, speed)

    def _check_harmonics(self) -> None:
        if self.coordinates.shape[1] % 2 == 0:
            raise ValueError(
                "coordinates: need the harmonics −N … N, an odd number, got "
                f"{self.coordinates.shape[1]}"
            )

    def _waves(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        """Return phases of the coordinates' harmonics per spin angle, and their rates [rad/s]."""
        top = self.coordinates.shape[1] // 2
        orders = np.arange(-top, top + 1)
        return orders, np.array([self.rates(int(n))[index] for n in orders])

    def _computed_at(self, value: float) -> int:
        """Return where a speed or frequency stands among the computed ones."""
        if self.coordinates is None:
            raise ValueError(
                "state: this response was computed without component modes, on a SolidRotor; "
                "compute it for the ReducedRotor that was added to the scene, or for the scene"
            )
        index = int(np.argmin(np.abs(self.abscissa - value)))
        nearest = self.abscissa[index]
        if abs(nearest - value) > _SAME_SPEED * abs(value):
            raise ValueError(
                f"state: the response was not computed at {value:g} rad/s, the nearest is "
                f"{nearest:g} rad/s; compute it there, too"
            )
        if not np.all(np.isfinite(self.coordinates[index])):
            raise ValueError(f"state: the response has no steady motion at {nearest:g} rad/s")
        return index

    def _scene(self, body: RotorBody) -> SceneCoordinates:
        """Return the coordinates of the scene, the rotor at rest, if the response is of it."""
        if body.formulation.moves_origin:
            raise ValueError(
                f"body: rotor {body.name!r} follows a prescribed translation; a response has none"
            )
        if self.basis == "scene":
            scene = LinearScene.of(body.mbs, body)
            size, motion = scene.size, scene.interface_motion
            known = scene.interfaces
        else:
            scene = SceneCoordinates.of(body)
            source = body.selection.source
            names, standing = _beside(body)
            if names != self.beside:
                raise ValueError(
                    f"body: beside rotor {body.name!r} the scene has {len(names)} coordinates of a "
                    f"foundation, controllers and pads, the response {len(self.beside)}; "
                    "give both the same supports, in the same order, and the same foundation"
                )
            size = source.size + len(names)
            axes = np.kron(np.eye(2), axes_of(source.axis).T)
            known = standing | {
                name: np.pad(axes @ entry.motion, ((0, 0), (0, len(names))))
                for name, entry in source.interfaces.items()
            }
            motion = known.__getitem__

        rest = scene.rest.copy()
        rest[scene.free[: scene.count]] = 0.0
        if self.coordinates.shape[2] == size and all(
            self._is_motion(place, motion(name))
            for place, name in enumerate(self.places)
            if name in known
        ):
            return replace(scene, rest=rest)
        raise ValueError(
            f"body: the response is of another {self.basis} than that of rotor {body.name!r}, or "
            "of another reduction; compute it with what was added to the scene"
        )

    def _is_motion(self, place: int, rows: np.ndarray) -> bool:
        """Return whether coordinates and motion of a place agree, at θ = 0 where it is largest."""
        seen = self.motion[:, place].sum(axis=1).real[:, :3]
        index = int(np.nan_to_num(np.abs(seen)).max(axis=1).argmax())
        x = self.coordinates[index].sum(axis=0).real
        off = np.abs(seen[index] - rows[:3] @ x).max()
        return bool(off <= _SAME_MOTION * np.nanmax(np.abs(self.motion[:, place, :, :3])))


def _beside(body: RotorBody) -> tuple[tuple[str, ...], dict[str, np.ndarray]]:
    """Return the names of a scene's coordinates beside the rotor, and motions of a foundation.

    The latter are those (6, k) of its points along (n1, n2, e), by all coordinates.
    """
    foundation = _foundation(body)
    own = _with_own(body)
    names = tuple(
        f"{_OWN[type(one.support)]} {index} at {one.support.interface}, {number}"
        for index, (one, _, size) in enumerate(own, 1)
        for number in range(1, size + 1)
    )
    if foundation is None:
        return names, {}
    given, own = foundation.foundation, body.selection.source.size
    T = np.kron(np.eye(2), (body.motion.orientation @ axes_of(body.selection.source.axis)).T)
    points = {
        ON_FOUNDATION.format(name): np.pad(T @ U @ given.mode_shapes, ((0, 0), (own, len(names))))
        for name, U in given.points.items()
    }
    standing = tuple(f"foundation, {number}" for number in range(1, given.size + 1))
    return standing + names, points


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


def kept_coordinates(
    model: LinearModel, found: Mapping[int, np.ndarray], speed: float
) -> dict[str, object]:
    """Return what a response keeps for runs, given harmonics (s, k) of coordinates.

    Of one rotor in its own axes, all of its columns are coordinates, and of a scene its unknowns;
    else nothing is kept.
    """
    if isinstance(model, SceneModel):
        return {"coordinates": _in_array(model.unknowns(found, speed)), "basis": "scene"}
    assembly = model.assembly(speed)
    rotor = assembly.bodies[0]
    if len(model.rotors) > 1 or model.turns != 1 or model.ratios[rotor.name] != 1.0:
        return {}
    kept = _in_array(found)
    if rotor.is_apart:  # the spin is a rotation about the axis
        spin = np.pad(rotor.spin.turn - rotor.spin.momentum, (0, model.size - rotor.size))
        kept += (kept[..., : rotor.size] @ rotor.spin.momentum)[..., None] * spin
    return {"coordinates": kept, "basis": "rotor", "beside": model.coordinates[rotor.size :]}


def _in_array(found: Mapping[int, np.ndarray]) -> np.ndarray:
    """Return harmonics −N … N as an array (s, h, k)."""
    top, none = max(map(abs, found)), np.zeros_like(next(iter(found.values())))
    return np.stack([found.get(n, none) for n in range(-top, top + 1)], axis=1)


def _in_body(body: RotorBody, x: np.ndarray) -> tuple[np.ndarray, float]:
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
        frame.append(_unit_spin(source, selection.origin)[:, None])
    f = np.linalg.lstsq(np.hstack([*frame, selection.T]), x, rcond=None)[0]
    # displacement of a rigid translation by its columns, S/m
    shift = source.invariants.S[:, held] @ f[: len(held)] / source.invariants.mass
    turning = axes_of(source.axis)[:, : SceneCoordinates.of(body).count].T @ shift
    zeta = f[len(f) - selection.T.shape[1] :]
    spin = float(f[len(held)]) if body.formulation.has_spin else 0.0
    return np.r_[turning, zeta], spin


def _unit_spin(source: ReducedRotor, origin: np.ndarray) -> np.ndarray:
    """Return a rotation of 1 rad about the axis through `origin`, in the reduced basis."""
    return source.invariants.moved(origin - source.center_of_mass).g


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
