"""Runs in which a journal leaves the clearance of its bearing, which must not go on.

Newton's method may try states outside, where forces go on by a tangent; a step that has been
accepted there means nothing. A connector that is evaluated outside looks at the beginning of its
step, the state accepted last, and ends the run by an error where that was outside, too. Where a
:class:`ClearanceStop` acts at the same interface, contact is meant.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot

import exudyn
import numpy as np

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.held_law import HeldLaw
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.multibody.mark import Mark, entry
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

_WATCHED, _STOPS = "bearings that journals must not leave", "stops"
_START = exudyn.ConfigurationType.StartOfStep


@dataclass(frozen=True, eq=False)
class _Watched:
    """A bearing's connector: the ``mbs`` must not hold a body that holds it.

    Attributes
    ----------
    place : tuple
        Mark of the rotor, and the interface.
    rotor : str or None
        Its name.
    across : ndarray, shape (3, 2)
        n1 and n2 in the scene.
    """

    place: tuple[Mark | None, str]
    rotor: str | None
    across: np.ndarray


def watch_clearance(
    body: RotorItems, bearing: Bearing | MagneticBearing, number: exudyn.ObjectIndex
) -> None:
    """Let runs of the scene stop where the journal of a connector leaves its bearing."""
    place = body.mark, bearing.interface
    if isinstance(bearing, ClearanceStop):
        entry(body.mbs).setdefault(_STOPS, set()).add(place)
        return
    watched = _Watched(place, body.name, body.standing_axes[:, :2])
    entry(body.mbs).setdefault(_WATCHED, {})[int(number)] = watched


def noting_outside(
    mbs: exudyn.MainSystem, bearing: Bearing | HeldLaw | MagneticBearing
) -> Callable[[int, float, float], None]:
    """Return what a connector calls by its number and place beyond the least clearance."""

    def note(item: int, x: float, y: float) -> None:
        own = entry(mbs)
        watched = own.get(_WATCHED, {}).get(int(item))
        if watched is None or watched.place in own.get(_STOPS, ()):
            return
        time = mbs.systemData.GetTime(_START)
        if time <= 0.0:  # nothing has been accepted yet
            return
        ends = (mbs.GetObject(item)["markerNumbers"][i] for i in (1, 0))
        journal, bore = (
            mbs.GetMarkerOutput(end, exudyn.OutputVariableType.Position, _START) for end in ends
        )
        place = (journal - bore) @ watched.across
        distance = hypot(*place.tolist())
        if distance < bearing.clearance_along():
            return
        beyond = distance - bearing.clearance_along(place / distance)
        if beyond >= 0.0:
            raise ValueError(_left(watched, bearing, time, place, beyond))

    return note


def _left(watched: _Watched, bearing: object, t: float, place: np.ndarray, beyond: float) -> str:
    """Return what is wrong with a journal outside its clearance."""
    advice = "take smaller steps, begin from steady_state(body), reduce the load"
    if isinstance(bearing, MagneticBearing):
        advice = "its loop may be unstable, which stability(…) shows; else " + advice
    return (
        f"rotor {watched.rotor!r} left its bearing at {watched.place[1]!r} at t = {t:g} s: its "
        f"journal is {hypot(*place.tolist()):.3g} m from the centre, {beyond:.2g} m beyond the "
        f"clearance that way; {advice}, or add a ClearanceStop at that interface for a rub"
    )
