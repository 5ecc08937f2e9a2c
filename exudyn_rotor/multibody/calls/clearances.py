"""Runs in which a journal leaves the clearance of its bearing, which must not go on.

Newton's method may try states outside, where forces go on by a tangent; a step that has been
accepted there means nothing. Importing this module lets ``mbs.SolveDynamic()`` look at the journals
after an accepted step, beside the script's own function for that, and stop with an error. Where a
:class:`ClearanceStop` acts at the same interface, contact is meant, and nothing is looked at.

Connectors note when they are evaluated outside. A step without such an evaluation is not looked at,
for Exudyn evaluates forces at the state that it accepts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from math import hypot, inf

import exudyn
import numpy as np

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.held_law import HeldLaw
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.multibody.calls.sparse_solver import check_solver
from exudyn_rotor.multibody.mark import Mark, mark_of
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.wrapping import wraps_method

_BEARINGS = "exudyn_rotor: bearings that journals must not leave"  # key in mbs.sys
_OUTSIDE = "exudyn_rotor: connectors of bearings evaluated outside their clearance"
_KINDS = exudyn.OutputVariableType


@dataclass(frozen=True, eq=False)
class _Watched:
    """A bearing's connector: the ``mbs`` must not hold a body that holds it.

    Attributes
    ----------
    bearing : Bearing or MagneticBearing
    number : ObjectIndex
    physics : ObjectIndex
    mark : tuple or None
        By which the rotor, whose object `physics` is, is known again.
    rotor : str or None
        Its name.
    across : ndarray, shape (3, 2), or None
        n1 and n2 in the scene; None where the connector has axes of its own.
    """

    bearing: Bearing | MagneticBearing
    number: exudyn.ObjectIndex
    physics: exudyn.ObjectIndex
    mark: Mark | None
    rotor: str | None
    across: np.ndarray | None

    @cached_property
    def least(self) -> float:
        """Clearance within which the journal touches nowhere [m]."""
        return self.bearing.clearance_along()

    def place(self, mbs: exudyn.MainSystem) -> np.ndarray:
        """Return the journal's place against the bearing [m], shape (2,)."""
        if self.across is None:
            return mbs.GetObjectOutput(self.number, _KINDS.DisplacementLocal)[:2]
        return mbs.GetObjectOutput(self.number, _KINDS.Displacement) @ self.across


def watch_clearance(
    body: RotorItems, bearing: Bearing | MagneticBearing, number: exudyn.ObjectIndex
) -> None:
    """Let runs of the scene stop where the journal of a connector leaves its bearing."""
    local = body.mbs.GetObject(number)["objectType"] == "ConnectorRigidBodySpringDamper"
    across = None if local else body.standing_axes[:, :2]
    physics = body.objects["physics"]
    watched = _Watched(bearing, number, physics, body.mark, body.name, across)
    body.mbs.sys.setdefault(_BEARINGS, []).append(watched)


def noting_outside(
    mbs: exudyn.MainSystem, bearing: Bearing | HeldLaw | MagneticBearing
) -> Callable[[int, float, float], None]:
    """Return what a connector calls by its number and place beyond the least clearance."""
    noted = _outside(mbs)

    def note(item: int, x: float, y: float) -> None:
        distance = hypot(x, y)
        if distance >= bearing.clearance_along(np.array([x / distance, y / distance])):
            noted.add(item)

    return note


def _outside(mbs: exudyn.MainSystem) -> set[int]:
    """Return the connectors that were evaluated outside since the last look."""
    return mbs.sys.setdefault(_OUTSIDE, set())


@contextmanager
def _stopped_outside(mbs: exudyn.MainSystem) -> Iterator[None]:
    """Stop a run within by a ValueError where a journal leaves its clearance."""
    watched = _in_scene(mbs)
    if not watched:
        yield
        return
    given = mbs.GetPostStepUserFunction()
    own = given["function"] if given else None
    left: list[str] = []
    noted = _outside(mbs)
    noted.update(int(each.number) for each in watched)  # the initial state is looked at

    def look(mbs: exudyn.MainSystem, t: float) -> bool:
        if noted:
            noted.clear()
            left.extend(filter(None, (_left(mbs, each, t) for each in watched)))
        return not left and (own is None or own(mbs, t))

    mbs.SetPostStepUserFunction(look)
    try:
        yield
    finally:
        mbs.SetPostStepUserFunction(own or 0)
    if left:
        raise ValueError("mbs.SolveDynamic: " + "; ".join(left))


def _in_scene(mbs: exudyn.MainSystem) -> list[_Watched]:
    """Return the bearings with a clearance that are still there, and without a stop beside."""
    present = [
        each
        for each in mbs.sys.get(_BEARINGS, [])
        if each.mark is not None and mark_of(mbs, each.physics) == each.mark
    ]
    stopped = {
        (each.mark, each.bearing.interface)
        for each in present
        if isinstance(each.bearing, ClearanceStop)
    }
    return [
        each
        for each in present
        if (each.mark, each.bearing.interface) not in stopped and each.least < inf
    ]


def _left(mbs: exudyn.MainSystem, watched: _Watched, t: float) -> str | None:
    """Return what is wrong with a journal outside its clearance; None for one inside."""
    place = watched.place(mbs)
    distance = hypot(*place.tolist())
    if distance < watched.least:
        return None
    gap = watched.bearing.clearance_along(place / distance)
    if distance < gap:
        return None
    return (
        f"rotor {watched.rotor!r} left its bearing at {watched.bearing.interface!r} at t = {t:g} s:"
        f" its journal is {distance:.3g} m from the centre, {distance - gap:.2g} m beyond the "
        "clearance that way; take smaller steps, begin from steady_state(body), reduce the load, "
        "or add a ClearanceStop at that interface for a rub"
    )


@wraps_method("SolveDynamic")
def _solve_dynamic(
    solve: Callable, mbs: exudyn.MainSystem, *given: object, **options: object
) -> bool:
    """Solve as Exudyn does, unless a dense solver cannot, or a journal leaves its bearing."""
    check_solver(mbs, given, options)
    with _stopped_outside(mbs):
        return solve(mbs, *given, **options)
