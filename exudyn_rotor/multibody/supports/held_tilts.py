"""Moments of supports against tilts on a base, while a scene is linearised.

A static moment M₀ turns with the base of a run, in its direction and in the axes of the stiffness.
Linear equations leave out what static loads do by small motions, M₀ times the tilt, as those of
bearings' forces: a part of it would be no better than none. So the moment at a place is held along
axes at rest, and goes on by stiffness and damping times the small tilts.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import exudyn
import numpy as np

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.supports.support_connectors import (
    moment_of,
    spin_reader,
    twist_of,
    varying_torque,
)

_ROTATION = exudyn.OutputVariableType.RotationMatrix
_FUNCTION = "springForceTorqueUserFunction"


class HeldTilts:
    """Moment of a support on a base that, once held, is linear about the next place.

    Attributes
    ----------
    support : Support
    number : ObjectIndex
        Its connector against tilts.
    """

    def __init__(self, body: RotorItems, support: Support, number: exudyn.ObjectIndex) -> None:
        self.support, self.number = support, number
        self._markers = body.mbs.GetObject(number)["markerNumbers"]
        self._axes, self._spin = body.standing_axes, spin_reader(body)
        self._whole = varying_torque(body, support, self._markers[0])
        self._held, self._rest = False, None

    def hold(self, held: bool) -> None:
        """Let the moment be held at the next place, or not any more."""
        self._held, self._rest = held, None

    def torque(self, mbs, t, item, u, angles, v, omega, *more):
        """Return force and moment as a user function of a ``RigidBodySpringDamper``."""
        whole = self._whole(mbs, t, item, u, angles, v, omega, *more)
        if not self._held:
            return whole
        base, rotor = (self._turned(mbs, marker) for marker in self._markers)
        angle, speed = self._spin(mbs)
        first, second = _tilts(rotor), _tilts(base)
        tilt = np.array([*(first - second), twist_of(angles, angle)])
        rate = base @ omega + 2.0 * speed * np.array([-first[1], first[0], 0.0])
        moment = moment_of(self.support, tilt, rate, angle, speed)
        if self._rest is None:
            self._rest = base @ whole[3:] - moment
        return [0.0, 0.0, 0.0, *((self._rest + moment) @ base).tolist()]

    def _turned(self, mbs: exudyn.MainSystem, marker: exudyn.MarkerIndex) -> np.ndarray:
        """Return axes of a marker, as columns, along (n1, n2, e)."""
        return self._axes.T @ np.reshape(mbs.GetMarkerOutput(marker, _ROTATION), (3, 3))


def _tilts(turned: np.ndarray) -> np.ndarray:
    """Return the tilts (2,) of axes (3, 3)."""
    return np.array([-turned[1, 2], turned[0, 2]])


@contextmanager
def held_tilts(body: RotorItems) -> Iterator[tuple[HeldTilts, ...]]:
    """Give supports against tilts on a base moments that can be held."""
    tilts = tuple(
        HeldTilts(body, one.support, number)
        for one in body.supports
        for number in one.objects
        if isinstance(one.support, Support)
        and one.base is not None
        and _resists_tilts(body, number)
    )
    given = [body.mbs.GetObjectParameter(each.number, _FUNCTION) for each in tilts]
    for each in tilts:
        body.mbs.SetObjectParameter(each.number, _FUNCTION, each.torque)
    try:
        yield tilts
    finally:
        for each, function in zip(tilts, given, strict=True):
            body.mbs.SetObjectParameter(each.number, _FUNCTION, function)


def _resists_tilts(body: RotorItems, number: exudyn.ObjectIndex) -> bool:
    return _FUNCTION in body.mbs.GetObject(number)
