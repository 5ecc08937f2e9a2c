"""Films that conserve mass, in scenes: what their voids remember is coordinates beside the scene's.

Forces by place and velocity do not tell what such films do, so a scene has them without stiffness
and damping. They are added as elements, as in lists of supports, about a journal that rests under
the mean force of a revolution (:class:`exudyn_rotor.bearings.film.void_states.VoidStates`).

A rotor on an uneven mesh moves under its weight twice in a revolution. A motion of ε clearances
changes the coefficients of films by a share of order ε, whose mean is zero, and exponents by one of
order ε², which is left out here, as in lists of supports.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.bearings.controlled_support import FilmSupport
from exudyn_rotor.bearings.film.state import FilmState
from exudyn_rotor.bearings.film.void_states import COUNT
from exudyn_rotor.bearings.journal_bearing import LITTLE, JournalBearing
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.assembly import (
    Assembly,
    Element,
    OwnBody,
    own_body,
    support_element,
    with_own,
)
from exudyn_rotor.linear.model.scene.linear_scene import Journal, LinearScene

_STEPS = 3  # of Newton's method: ε², ε⁴, ε⁸
MOST_MOTION = 1e-2  # of the clearance: what it leaves out is of the order of its square


def film_bodies(scene: LinearScene, turns: int) -> list[OwnBody]:
    """Return the coordinates of the films that remember, in axes that turn with `turns`·Ω."""
    names = [one.support.interface for one in scene.remembering]
    given = [FilmSupport(name, _inertia(scene), lambda _: None, np.zeros((2, 2))) for name in names]
    return [own_body(one, number, turns) for number, one in enumerate(given, start=1)]


def _inertia(scene: LinearScene) -> np.ndarray:
    return np.full(COUNT // 2, LITTLE * scene.mass / len(scene.remembering))


def film_elements(
    scene: LinearScene,
    journals: Sequence[Journal],
    speed: float,
    assembly: Assembly,
    undamped: bool,
) -> tuple[Element, ...]:
    """Return the films at a speed [rad/s], from their journals over a revolution.

    Undamped ones have their stiffness of slow motions.
    """
    found, own = [], assembly.bodies[2:]
    for i, (one, journal) in enumerate(zip(scene.remembering, journals, strict=True)):
        name = one.support.interface
        end, base = ("", name), None if one.base is None else ("scene", name)
        state = at_rest(one.support, journal, speed)
        K, _ = state.coefficients()
        if undamped:
            found.append(support_element(Support(name, K).undamped(), end, base, 1.0, 1.0))
            continue
        mass = _inertia(scene)
        both = state.void_states.matrices(mass[0])
        film = FilmSupport(name, mass, lambda _, both=both: both, K)
        found += with_own(film, end, {} if base is None else {name: base}, 1.0, own[i])
    return tuple(found)


def at_rest(bearing: JournalBearing, journal: Journal, speed: float) -> FilmState:
    """Return the film of a journal that rests where it has the mean force of a revolution.

    By Newton's method from its mean place, which is off by the order of ε².

    Raises
    ------
    UnconvergedError
        Outside the film, and for a journal that moves.
    """
    where = f"linear scene at {speed:g} rad/s: the journal at {bearing.interface!r}"
    if any(place is None for place in journal):
        raise UnconvergedError(
            f"{where} is outside its film, which its grid does not resolve there; give more nodes"
        )
    places, forces = (np.array(each) for each in zip(*journal, strict=True))
    mean = places.mean(axis=0)
    moved = np.linalg.norm(places - mean, axis=1).max() / bearing.film.clearance
    if moved > MOST_MOTION:
        raise UnconvergedError(
            f"{where} moves by {moved:.2g} of its clearance in a revolution, and a film with "
            f"cavitation='mass-conserving' is linearised about a journal at rest, up to "
            f"{MOST_MOTION:g}; leave the unbalance out (linear_model(…, about='equilibrium')), or "
            "look at a run"
        )
    state = bearing.film.state(mean, np.zeros(2), speed)
    for _ in range(_STEPS):
        step = np.linalg.lstsq(state.slow_stiffness, state.force - forces.mean(axis=0))[0]
        state = bearing.film.state(state.position + step, np.zeros(2), speed)
    return state
