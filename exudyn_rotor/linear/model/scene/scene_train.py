"""Several rotors of a scene as a train: what add_rotor, add_supports and connect_rotors put there.

One revolution is a period of a scene for one spin speed only, so that a linear scene does not do
here. Supports, gears and couplings are known by what made them.
"""

from __future__ import annotations

from collections.abc import Sequence

import exudyn
import numpy as np

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.drives.gear_mesh import GearMesh
from exudyn_rotor.linear.model.rotor_train import Link, RotorTrain
from exudyn_rotor.linear.model.scene.linear_scene import (
    check_body,
    known_objects,
    objects_beside,
)
from exudyn_rotor.multibody.drives import SceneConnection
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.rotor_items import known_rotors
from exudyn_rotor.multibody.supports.add_supports import SceneSupport

_PARALLEL = 1e-9  # entries of axes by which rounding may set rotors apart
_BY_HAND = "give linear analyses a RotorTrain of the reduced rotors, with supports=… and Link(…)"


def scene_train(mbs: exudyn.MainSystem, bodies: Sequence[RotorBody]) -> tuple[RotorTrain, str]:
    """Return the train of all rotors of an assembled scene, and their level of stiffening.

    Ratios are those of the speeds at which the rotors start, over that of the first. Rotors of a
    prescribed spin are :attr:`RotorTrain.driven`; with drive='elastic' their own spin is a
    coordinate there, as it is in the scene.

    Raises
    ------
    TypeError, ValueError
        For rotors of another system, or that are left out; for one that stands still, is mounted
        with other axes, or differs in its level of stiffening; and for anything in the scene that
        is no support, gear mesh or flexible coupling of theirs.
    """
    _check_all_rotors(mbs, bodies)
    for body in bodies:
        _check_alike(bodies[0], body)
    named = {body.name: body for body in bodies}
    links = _links(named)
    known = set().union(*map(known_objects, bodies))
    known |= {int(number) for body in bodies for one in body.drives for number in one.objects}
    for item in objects_beside(mbs, known):
        raise ValueError(
            f"linear scene: {item['objectType']} {item['name']!r} is neither of the rotors nor "
            f"added by add_supports or connect_rotors, so that a train does not have it; {_BY_HAND}"
        )
    speed = bodies[0].placement.speed
    on_ground = {
        name: [one.support for one in body.supports if one.base is None]
        for name, body in named.items()
    }
    train = RotorTrain(
        {name: body.selection.source for name, body in named.items()},
        {name: body.placement.speed / speed for name, body in named.items()},
        on_ground,
        links,
        driven=[name for name, body in named.items() if _is_driven(body)],
    )
    return train, bodies[0].stiffening


def _is_driven(body: RotorBody) -> bool:
    """Return whether θ(t) is prescribed, and is the rotor's mean rotation."""
    return not body.formulation.has_spin and body.formulation.drive == "rigid"


def _check_all_rotors(mbs: exudyn.MainSystem, bodies: Sequence[RotorBody]) -> None:
    """Refuse bodies that are not all rotors of the scene, each once."""
    for body in bodies:
        check_body(mbs, body)
    names, known = ([one.name for one in each] for each in (bodies, known_rotors(mbs)))
    if len(names) < 2 or sorted(names) != sorted(known):
        raise ValueError(f"body: needs all rotors of the scene, {known}, each once, got {names}")


def _check_alike(first: RotorBody, body: RotorBody) -> None:
    """Refuse rotors whose equations have no common axes, speed or level, and what trains lack."""
    connections = [isinstance(drive, SceneConnection) for drive in body.drives]
    for fault, is_there in (
        ("starts without a spin speed, on which ratios depend", body.placement.speed == 0.0),
        (
            f"has axes (n1, n2, e) that are not parallel to those of {first.name!r}",
            np.abs(body.standing_axes - first.standing_axes).max() > _PARALLEL,
        ),
        (f"has another stiffening than {first.name!r}", body.stiffening != first.stiffening),
        ("has damping from add_rotor", body.mass_damping or body.stiffness_damping),
        ("has a drive, whose torque trains do not have", not all(connections)),
    ):
        if is_there:
            raise ValueError(f"body: rotor {body.name!r} {fault}; {_BY_HAND}")


def _links(named: dict[str, RotorBody]) -> list[Link]:
    """Return what stands between two rotors."""
    markers = {
        int(marker): f"{name}:{interface}"
        for name, body in named.items()
        for interface, marker in body.markers.items()
    }
    links = []
    for name, body in named.items():
        for one in body.supports:
            if one.base is not None:
                other = _other_end(body, one, markers)
                links.append(Link(f"{name}:{one.support.interface}", other, one.support))
        for one in body.drives:
            if one.body is body:
                law = one.connection
                given = law if isinstance(law, GearMesh) else law.support(one.at)
                links.append(Link(f"{name}:{one.at}", f"{one.other.name}:{one.other_at}", given))
    return links


def _other_end(body: RotorBody, one: SceneSupport, markers: dict[int, str]) -> str:
    """Return the interface of another rotor on which a support stands."""
    known = isinstance(one.base, exudyn.MarkerIndex) and int(one.base) in markers
    if not known or not isinstance(one.support, Support):
        raise ValueError(
            f"body: the support at {body.name}:{one.support.interface} stands on a body or a "
            "foundation, or is a bearing between two rotors; a train has supports on the ground, "
            f"and Support(…) between rotors; {_BY_HAND}"
        )
    return markers[int(one.base)]
