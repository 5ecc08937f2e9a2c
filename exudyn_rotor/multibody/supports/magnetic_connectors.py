"""A magnetic bearing in a scene: its controller's coordinates, and the force of its actuators.

The coordinates are those of a ``NodeGenericODE2``, along (n1, n2), with the equations of
:mod:`exudyn_rotor.bearings.pid_controller` times a stiffness, so that they are those of linear
analyses. Exudyn does not differentiate the force by them, nor their equations by the rotor's place:
Newton's method takes some more iterations, and modified Newton renews its Jacobian in vain; with a
contractivity of 0.5 a run is several times faster. Exudyn's static solver, which needs these
derivatives, does not find an equilibrium; :func:`exudyn_rotor.steady_state` does.
"""

from __future__ import annotations

from collections.abc import Callable

import exudyn
import numpy as np
from exudyn.itemInterface import (
    CartesianSpringDamper,
    ObjectGenericODE2,
    VObjectGenericODE2,
)

from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.rotor.rotor_nodes import generic_node
from exudyn_rotor.multibody.supports.seats import Seat, point_marker

_KINDS = exudyn.OutputVariableType


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
        springForceUserFunction=_pulled(bearing, seat, node),
    )
    return mbs.AddObject(magnets), number


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


def _pulled(bearing: MagneticBearing, seat: Seat, node: exudyn.NodeIndex) -> Callable:
    """Return the force law of the magnets, by the controller's coordinates."""
    own, turn, force_of = (
        bearing.controller.realisation(),
        bearing.control_axes,
        bearing.actuator.law,
    )
    axes = turn @ seat.axes[:, :2].T  # rows: the control axes
    by_place, by_rate = (np.kron(part, turn) for part in (own.by_place, own.by_rate))

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        read = mbs.GetNodeOutput
        currents = by_place @ read(node, _KINDS.Coordinates)
        currents += by_rate @ read(node, _KINDS.Coordinates_t)
        a, b = (force_of(-i, x) for i, x in zip(currents, axes @ u, strict=True))
        return (-a * axes[0] - b * axes[1]).tolist()

    return force
