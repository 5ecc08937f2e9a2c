"""Laws of bearings on a base that turns.

A law holds in axes of the bore. One that turns about the axis at the rate w sees the rotor turn at
Ω − w, and move by ``v − w e × u``, with the displacement u and the velocity v of the journal
against it: a film drags by what the two turn against each other. The angle of the bore is small and
left out. On a linear foundation, which hardly turns, so is w with a prescribed spin, which feels no
friction, as in linear analyses.

On another rotor neither is small: the bore turns by its spin angle, and w is its speed, whether
spins are free or prescribed. Grooves turn with it, and so does the outer ring whose elements an
inner ring takes along.

Forces act along the axes at rest, also where the base tilts. With a static force F₀ and a tilt φ
this leaves out ``φ × F₀``, as foundations leave out what their weight does in a deflection: beside
the bearing's stiffness K at a lever l it is F₀/(K l), the journal's displacement over the lever.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin

import exudyn
import numpy as np

from exudyn_rotor.multibody.rotor.known_rotor import KnownRotor
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

_ANGULAR_VELOCITY = exudyn.OutputVariableType.AngularVelocity
_ROTATION = exudyn.OutputVariableType.RotationMatrix
_CURRENT = exudyn.ConfigurationType.Current
_LINEAR = "FFRFreducedOrder"  # of the markers of foundations, and of pads on them


def carrying_marker(
    mbs: exudyn.MainSystem, connector: exudyn.ObjectIndex, base: object | None
) -> exudyn.MarkerIndex | None:
    """Return the marker of the base in a bearing's connector; None for the ground."""
    return None if base is None else mbs.GetObject(connector)["markerNumbers"][0]


def feels_turning(body: RotorItems, base: exudyn.MarkerIndex | None) -> bool:
    """Return whether bearings on a marker feel the rate at which it turns about the axis."""
    if body.formulation.has_spin or base is None:
        return base is not None
    item = body.mbs.GetMarker(base)
    return "bodyNumber" in item and body.mbs.GetObject(item["bodyNumber"])["objectType"] != _LINEAR


def on_turning_base(
    law: Callable, mbs: exudyn.MainSystem, base: exudyn.MarkerIndex | None, axes: np.ndarray
) -> Callable:
    """Return a law as it is on a marker of a base; `axes` are (n1, n2, e) as columns."""
    if base is None:
        return law
    a, b, c = axes[:, 2].tolist()

    def turned(
        x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        omega = mbs.GetMarkerOutput(base, _ANGULAR_VELOCITY)
        w = float(a * omega[0] + b * omega[1] + c * omega[2])
        return law(x, y, vx + w * y, vy - w * x, angle, speed - w)

    return turned


def on_turning_rotor(
    law: Callable, mbs: exudyn.MainSystem, rotor: KnownRotor, axes: np.ndarray
) -> Callable:
    """Return a law as it is on another rotor; `axes` are (n1, n2, e) as columns."""
    seen = seen_from_rotor(mbs, rotor, axes)

    def turned(*motion: float) -> tuple[float, ...]:
        (c, s), within = seen(motion)
        fx, fy, *torque = law(*within)
        return c * fx - s * fy, s * fx + c * fy, *torque

    return turned


def seen_from_rotor(
    mbs: exudyn.MainSystem,
    rotor: KnownRotor,
    axes: np.ndarray,
    state: exudyn.ConfigurationType = _CURRENT,
) -> Callable:
    """Return what gives x, y, ẋ, ẏ, θ and Ω of a journal as its bore on another rotor sees them.

    Before them cosine and sine of the angle by which the bore has turned.
    """
    sense = float(np.sign(rotor.axis @ axes[:, 2]))

    def seen(motion: tuple[float, ...]) -> tuple[tuple[float, float], tuple[float, ...]]:
        x, y, vx, vy, angle, speed = motion
        turn, w = (sense * value for value in rotor.spin(mbs, state))
        c, s = cos(turn), sin(turn)
        vx, vy = w * y + vx, vy - w * x
        place, rate = (c * x + s * y, c * y - s * x), (c * vx + s * vy, c * vy - s * vx)
        return (c, s), (*place, *rate, angle - turn, speed - w)

    return seen


def in_axes_at_rest(
    function: Callable, base: exudyn.MarkerIndex | None, axes: np.ndarray
) -> Callable:
    """Return a user function of a ``RigidBodySpringDamper`` whose axes do not turn with the base.

    Exudyn takes displacement, velocity, force and torque along axes of the base's marker; the
    function has them along `axes` (n1, n2, e) as columns.
    """
    if base is None:
        return function

    def force(
        mbs: exudyn.MainSystem, t: float, item: int, u: list, angles: list, v: list, *more: object
    ) -> list[float]:
        turn = axes.T @ np.reshape(mbs.GetMarkerOutput(base, _ROTATION), (3, 3))
        u, v = (turn @ u).tolist(), (turn @ v).tolist()
        loads = np.reshape(function(mbs, t, item, u, angles, v, *more), (2, 3))
        return (loads @ turn).ravel().tolist()

    return force
