"""A magnetic bearing in a scene: its controller's coordinates, and the force of its actuators.

The coordinates are those of a ``NodeGenericODE2``, along (n1, n2), with the equations of
:mod:`exudyn_rotor.bearings.pid_controller` times a stiffness, so that they are those of linear
analyses. Exudyn does not differentiate the force by them, nor their equations by the rotor's place:
Newton's method takes some more iterations, and modified Newton renews its Jacobian in vain; with a
contractivity of 0.5 a run is several times faster. Exudyn's static solver, which needs these
derivatives, does not find an equilibrium; :func:`exudyn_rotor.steady_state` does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import exudyn
import numpy as np
from exudyn.itemInterface import (
    CartesianSpringDamper,
    ObjectGenericODE2,
    VObjectGenericODE2,
)

from exudyn_rotor.bearings.actuator import Actuator, SaturatingActuator
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.multibody.rotor.plan import generic_node
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.supports.clearances import noting_outside, watch_clearance
from exudyn_rotor.multibody.supports.seats import Seat, point_marker

_KINDS = exudyn.OutputVariableType
Law = Callable[[float, float], float]


def add_magnetic(
    body: RotorItems,
    bearing: MagneticBearing,
    seat: Seat,
    base: exudyn.MarkerIndex,
    sensor_base: exudyn.MarkerIndex,
) -> tuple[exudyn.ObjectIndex, exudyn.ObjectIndex]:
    """Add connector and controller of a magnetic bearing.

    `base` and `sensor_base` carry the magnets and the sensors.
    """
    mbs, own, scale, both = body.mbs, bearing.controller.realisation(), bearing.scale, np.eye(2)
    node = mbs.AddNode(generic_node(*np.zeros((2, 2 * len(own.inertia)))))
    sensor = point_marker(body, bearing.sensor_interface)
    controller = ObjectGenericODE2(
        nodeNumbers=[node],
        massMatrix=scale * np.diag(np.repeat(own.inertia, 2)),
        dampingMatrix=scale * np.kron(own.damping, both),
        stiffnessMatrix=scale * np.kron(own.stiffness, both),
        forceUserFunction=_sensed(bearing, seat, sensor_base, sensor),
        visualization=VObjectGenericODE2(show=False),
    )
    number = mbs.AddObject(controller)
    magnets = CartesianSpringDamper(
        markerNumbers=[base, point_marker(body, bearing.interface)],
        springForceUserFunction=_pulled(
            bearing, [bearing.actuator.law] * 2, seat.axes, node, noting_outside(mbs, bearing)
        ),
    )
    connector = mbs.AddObject(magnets)
    watch_clearance(body, bearing, connector)
    return connector, number


class TangentMagnets:
    """Force of a control axis that goes on by its tangent, once held, from the next state.

    Differences would cross where a magnet is without current: the coordinates of a controller have
    so little inertia that no step of theirs is short.

    Attributes
    ----------
    seen : list of tuple
        Current [A] and place [m] wherever it has been held.
    """

    def __init__(self, actuator: Actuator) -> None:
        self._actuator, self._held = actuator, False
        self._tangent: tuple[float, ...] | None = None
        self.seen: list[tuple[float, float]] = []
        self._slopes: tuple[float, float] | None = None

    @property
    def settles(self) -> bool:
        """Whether lists take it otherwise than where it has been seen, see :meth:`settle`."""
        return isinstance(self._actuator, SaturatingActuator)

    def settle(self, speed: float) -> None:
        """Let the force go on as at the mean of the currents and places seen, as in lists.

        Under an uneven mesh a journal moves a little; what that changes is beside the square of
        the motion over the gap. At which speed plays no part.
        """
        self._slopes = self._actuator.slopes(*np.mean(self.seen, axis=0).tolist())

    def release(self) -> None:
        """Take back what :meth:`settle` did."""
        self._slopes = None

    def hold(self, held: bool) -> None:
        """Hold the force by the tangent from the next state on, or let it go."""
        self._held, self._tangent = held, None

    def law(self, current: float, place: float) -> float:
        """Return the force [N] at a current [A] and a place [m]."""
        if self._held and self._tangent is None:
            slopes = self._slopes or self._actuator.slopes(current, place)
            self._tangent = current, place, self._actuator.law(current, place), *slopes
            self.seen.append((current, place))
        if self._tangent is None:
            return self._actuator.law(current, place)
        i, x, force, by_current, by_place = self._tangent
        return force + by_current * (current - i) + by_place * (place - x)


@contextmanager
def tangent_magnets(body: RotorItems) -> Iterator[tuple[TangentMagnets, ...]]:
    """Give the control axes of all magnetic bearings, whose tangents can be held."""
    bearings = [one for one in body.supports if isinstance(one.support, MagneticBearing)]
    pairs = [[TangentMagnets(one.support.actuator) for _ in range(2)] for one in bearings]

    def let(laws: Sequence[Sequence[Law]]) -> None:
        for one, pair in zip(bearings, laws, strict=True):
            magnets, controller = one.objects
            node = body.mbs.GetObject(controller)["nodeNumbers"][0]
            note = noting_outside(body.mbs, one.support)
            function = _pulled(one.support, pair, body.standing_axes, node, note)
            body.mbs.SetObjectParameter(magnets, "springForceUserFunction", function)

    let([[axis.law for axis in pair] for pair in pairs])
    try:
        yield tuple(axis for pair in pairs for axis in pair)
    finally:
        let([[one.support.actuator.law] * 2 for one in bearings])


def _sensed(
    bearing: MagneticBearing, seat: Seat, base: exudyn.MarkerIndex, sensor: exudyn.MarkerIndex
) -> Callable:
    """Return what drives the controller's coordinates: the place that the sensors show."""
    shares = bearing.scale * bearing.controller.realisation().place
    across, offset = seat.axes[:, :2], bearing.sensor_offset

    def drive(mbs, t, item, q, q_t):
        read = mbs.GetMarkerOutput
        apart = read(sensor, _KINDS.Position) - read(base, _KINDS.Position)
        return np.outer(shares, apart @ across + offset).ravel()

    return drive


def _pulled(
    bearing: MagneticBearing,
    laws: Sequence[Law],
    axes: np.ndarray,
    node: exudyn.NodeIndex,
    note: Callable[[int, float, float], None],
) -> Callable:
    """Return the force of the magnets by the controller's coordinates, with the law of each axis.

    The columns of `axes` are n1, n2, e. Beyond the air gap it calls `note`.
    """
    own, turn = bearing.controller.realisation(), bearing.control_axes
    rows = turn @ axes[:, :2].T  # the control axes
    by_place, by_rate = (np.kron(part, turn) for part in (own.by_place, own.by_rate))
    (first, second), least = laws, bearing.clearance_along() ** 2

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        read = mbs.GetNodeOutput
        currents = by_place @ read(node, _KINDS.Coordinates)
        currents += by_rate @ read(node, _KINDS.Coordinates_t)
        (i, j), (x, y) = currents, rows @ u
        if x * x + y * y >= least:
            note(item, x, y)
        return (-first(-i, x) * rows[0] - second(-j, y) * rows[1]).tolist()

    return force
