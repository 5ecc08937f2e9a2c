"""Bearings of a scene while it is linearised: their laws can be held, and cages stand."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import exudyn

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.held_law import HeldBearing
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.supports.support_connectors import (
    SpinReader,
    bearing_function,
    spin_reader,
)
from exudyn_rotor.multibody.supports.turning_base import carrying_marker


@contextmanager
def linear_laws(body: RotorItems, cage: float | None) -> Iterator[tuple[HeldBearing, ...]]:
    """Give bearings laws that can be held, and hold cages where they are at a spin angle [rad].

    Stops keep theirs: their friction follows the contact's force, which small motions change.
    Without an angle cages turn with the rotor.
    """
    given = [one for one in body.supports if isinstance(one.support, Bearing)]
    given = [one for one in given if not isinstance(one.support, ClearanceStop)]
    bearings = tuple(HeldBearing.of(one.support) for one in given)
    turning = spin_reader(body)
    standing = turning if cage is None else _held(turning, cage)

    def let(held: bool) -> None:
        for one, bearing in zip(given, bearings, strict=True):
            spin = standing if held and one.support.uses_angle else turning
            for number, law in zip(one.objects, bearing.laws, strict=False):  # pads come last
                base = carrying_marker(body.mbs, number, one.base)
                law = law if held else law.bearing
                function = bearing_function(body, law, body.standing_axes, spin, base)
                body.mbs.SetObjectParameter(number, *function)

    let(True)
    try:
        yield bearings
    finally:
        let(False)


def _held(turning: SpinReader, angle: float) -> Callable:
    def held(mbs: exudyn.MainSystem) -> tuple[float, float]:
        return angle, turning(mbs)[1]

    return held
