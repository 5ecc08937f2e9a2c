"""Bearings at rest under a load: the linear equation between place and force beside a state.

Where a bearing has the force R on the journal, which rests at u,

    A u + B R = c.

A film has the equation of its compliance, about its equilibrium under the load −R: films stiffen so
much that Newton's method in the place would overshoot the clearance. So have magnets, with their
sensors where they act; an integral brings the journal to the centre. The two films of a floating
ring carry the same load: their places and compliances add up, beside one speed of the ring. All
others have the equation of their force at the place.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.journal_bearing import JournalBearing
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.series import FloatingRingBearing
from exudyn_rotor.bearings.short_journal import ShortJournalBearing
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing

_NONE = np.zeros((2, 2))
_UNDER_LOAD = JournalBearing | ShortJournalBearing | TiltingPadBearing | MagneticBearing


@dataclass(frozen=True, eq=False)
class Resting:
    """``A u + B R = c`` of a bearing, each (2, 2), c (2,).

    A rigid bearing is next to rigid, so that several under a rigid rotor share its weight.
    """

    A: np.ndarray
    B: np.ndarray
    c: np.ndarray
    is_rigid: bool = False


@dataclass(frozen=True)
class RigidBearing:
    """A bearing that holds the journal in its centre, rigidly, across the axis."""

    carries: ClassVar[bool] = True

    interface: str


Nonlinear = Bearing | MagneticBearing | FloatingRingBearing | RigidBearing

HELD = Resting(np.eye(2), _NONE, np.zeros(2), is_rigid=True)  # in the centre
UNLOADED = Resting(_NONE, np.eye(2), np.zeros(2))


def resting(bearing: Nonlinear, speed: float, place: np.ndarray, force: np.ndarray) -> Resting:
    """Return the equation of a bearing beside a place of its journal and a force on it.

    A ValueError or ArithmeticError says that a film has no equilibrium under this force.
    """
    if isinstance(bearing, RigidBearing):
        return HELD
    if isinstance(bearing, MagneticBearing) and bearing.controller.integral:
        return Resting(np.eye(2), _NONE, np.zeros(2))  # in the centre
    if isinstance(bearing, FloatingRingBearing):
        films = replace(bearing, load=-force).films(speed)
        rest = sum(film.equilibrium(whirl, -force) for film, whirl in films)
        stiffnesses = [film.coefficients(whirl, -force)[0] for film, whirl in films]
        return _of_compliance(rest, sum(map(np.linalg.inv, stiffnesses)), force)
    if isinstance(bearing, _UNDER_LOAD):
        if isinstance(bearing, TiltingPadBearing):
            stiffness = bearing.static_stiffness(speed, -force)
        elif isinstance(bearing, MagneticBearing):
            stiffness = replace(bearing, load=-force).linearised().static_stiffness
        else:
            stiffness = bearing.coefficients(speed, -force)[0]
        return _of_compliance(bearing.equilibrium(speed, -force), np.linalg.inv(stiffness), force)
    still = 0.0, 0.0, 0.0, speed
    at = np.array(bearing.law(*place, *still))
    tangent = bearing.slopes(*place, *still)[0]
    return Resting(tangent, np.eye(2), at + tangent @ place)


def _of_compliance(rest: np.ndarray, compliance: np.ndarray, force: np.ndarray) -> Resting:
    """Return the equation of what rests at a place (2,) under less the force (2,) on it."""
    return Resting(np.eye(2), compliance, rest + compliance @ force)
