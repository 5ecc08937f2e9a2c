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
from math import hypot, inf
from typing import Any

import exudyn
import numpy as np

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.multibody.calls.sparse_solver import check_solver
from exudyn_rotor.multibody.mark import Mark, mark_of
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.wrapping import wraps_method

_BEARINGS = "exudyn_rotor: bearings that journals must not leave"  # key in mbs.sys


@dataclass(frozen=True, eq=False)
class _Watched:
    """A bearing's connector: the ``mbs`` must not hold a body that holds it.

    Attributes
    ----------
    connector : BearingConnector or MagneticConnector
    physics : ObjectIndex
    mark : tuple or None
        By which the rotor, whose object `physics` is, is known again.
    rotor : str or None
        Its name.
    """

    connector: Any
    physics: exudyn.ObjectIndex
    mark: Mark | None
    rotor: str | None

    @property
    def interface(self) -> str:
        """Name of the journal's interface."""
        return self.connector.bearing.interface

    @property
    def least(self) -> float:
        """Clearance within which the journal touches nowhere [m]."""
        return self.connector.parts[0].clearance_along()

    def places(
        self, mbs: exudyn.MainSystem
    ) -> Iterator[tuple[np.ndarray, Bearing | MagneticBearing]]:
        """Yield the journal's place [m], shape (2,), against the bearing, or against each pad."""
        made = self.connector
        made.read(*made.state(mbs))
        for part, motion in zip(made.parts, made.motions(), strict=True):
            yield np.array(motion[:2]), part


def watch_clearance(body: RotorItems, connector: Any) -> None:
    """Let runs of the scene stop where the journal of a connector leaves its bearing."""
    watched = _Watched(connector, body.objects["physics"], body.mark, body.name)
    body.mbs.sys.setdefault(_BEARINGS, []).append(watched)


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
    made = [each.connector for each in watched]
    for connector in made:
        connector.outside = True  # the initial state is looked at

    def look(mbs: exudyn.MainSystem, t: float) -> bool:
        if any(connector.outside for connector in made):
            for connector in made:
                connector.outside = False
            left.extend(reason for each in watched for reason in _left(mbs, each, t))
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
        (each.mark, each.interface)
        for each in present
        if isinstance(each.connector.bearing, ClearanceStop)
    }
    return [
        each for each in present if (each.mark, each.interface) not in stopped and each.least < inf
    ]


def _left(mbs: exudyn.MainSystem, watched: _Watched, t: float) -> Iterator[str]:
    """Yield what is wrong with journals outside their clearance."""
    for place, part in watched.places(mbs):
        distance = hypot(*place.tolist())
        gap = part.clearance_along(place / distance) if distance else inf
        if distance < gap:
            continue
        advice = "take smaller steps, begin from steady_state(body), reduce the load, or add a"
        if isinstance(part, MagneticBearing):
            advice = (
                "is the loop of controller and magnets unstable? stability(reduced, speeds, "
                "supports=…) tells; else reduce the load, or add a"
            )
        yield (
            f"rotor {watched.rotor!r} left its bearing at {watched.interface!r} at t = {t:g} s: "
            f"its journal is {distance:.3g} m from the centre, {distance - gap:.2g} m beyond the "
            f"clearance that way; {advice} ClearanceStop at that interface for a rub"
        )


@wraps_method("SolveDynamic")
def _solve_dynamic(
    solve: Callable, mbs: exudyn.MainSystem, *given: object, **options: object
) -> bool:
    """Solve as Exudyn does, unless a dense solver cannot, or a journal leaves its bearing."""
    check_solver(mbs, given, options)
    with _stopped_outside(mbs):
        return solve(mbs, *given, **options)
