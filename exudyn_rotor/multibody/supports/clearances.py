"""Runs in which a journal leaves the clearance of its bearing, which must not go on.

Newton's method may try states outside, where forces go on by a tangent; a step that has been
accepted there means nothing. A connector that is evaluated outside looks at the beginning of its
step, the state accepted last, and ends the run by an error where that was outside, too. Where a
:class:`ClearanceStop` acts at the same interface, contact is meant.
"""

from __future__ import annotations

from math import hypot, inf

import exudyn
import numpy as np

from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.multibody.mark import entry
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.supports.bearing_connector import BearingConnector
from exudyn_rotor.multibody.supports.connector import START
from exudyn_rotor.multibody.supports.magnetic_connector import MagneticConnector

_STOPS = "clearance stops"


def watch_clearance(body: RotorItems, connector: BearingConnector | MagneticConnector) -> None:
    """Let runs of the scene stop where the journal of a connector leaves its bearing."""
    bearing, name = connector.bearing, body.name
    stops = entry(body.mbs).setdefault(_STOPS, set())
    place = body.mark, bearing.interface
    if isinstance(bearing, ClearanceStop):
        stops.add(place)
        return
    if connector.parts[0].clearance_along() == inf:
        return

    def guard(mbs: exudyn.MainSystem) -> None:
        time = mbs.systemData.GetTime(START)
        if time <= 0.0 or place in stops:  # nothing has been accepted yet, or a rub is meant
            return
        connector.read(*connector.state(mbs, START))
        for part, motion in zip(connector.parts, connector.motions(), strict=True):
            distance = hypot(*motion[:2])
            beyond = distance - part.clearance_along(np.array(motion[:2]) / distance)
            if beyond >= 0.0:
                raise ValueError(
                    f"rotor {name!r} left its bearing at {bearing.interface!r} at t = {time:g} s: "
                    f"its journal is {distance:.3g} m from the centre, {beyond:.2g} m beyond the "
                    f"clearance that way; {_advice(part)} ClearanceStop at that interface for a rub"
                )

    connector.guard = guard


def _advice(part: object) -> str:
    if isinstance(part, MagneticBearing):
        return (
            "is the loop of controller and magnets unstable? stability(reduced, speeds, "
            "supports=…) tells; else reduce the load, or add a"
        )
    return "take smaller steps, begin from steady_state(body), reduce the load, or add a"
