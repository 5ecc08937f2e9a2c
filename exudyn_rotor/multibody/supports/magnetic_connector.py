"""A magnetic bearing in a scene, its controller's coordinates beside those of rotor and base."""

from __future__ import annotations

import exudyn
import numpy as np

from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.multibody.supports.connector import Connector, Force
from exudyn_rotor.multibody.supports.ends import BaseEnd, RotorEnd


class MagneticConnector(Connector):
    """Magnets that pull by the controller's coordinates, which follow what the sensors show.

    The coordinates are pairs along (n1, n2), with the equations of
    :mod:`exudyn_rotor.bearings.pid_controller` times a stiffness, so that they are those of linear
    analyses.

    Attributes
    ----------
    bearing : MagneticBearing
    sensor_base : BaseEnd or None
        What carries the sensors.
    outside : bool
        Whether it was evaluated beyond the air gap.
    """

    def __init__(
        self,
        bearing: MagneticBearing,
        ends: tuple[RotorEnd, BaseEnd | None],
        sensors: tuple[RotorEnd, BaseEnd | None],
        own: exudyn.NodeIndex,
    ) -> None:
        realised = bearing.controller.realisation()
        super().__init__(*ends, own, 2 * len(realised.inertia))
        self.bearing, self.parts, self.outside = bearing, [bearing], False
        self._sensor, self.sensor_base = sensors
        self._turn, self._offset = bearing.control_axes, bearing.sensor_offset
        parts = realised.by_place, realised.by_rate
        self._by_place, self._by_rate = (np.kron(part, self._turn) for part in parts)
        self._shares = bearing.scale * realised.place
        self._least = bearing.clearance_along() ** 2

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion of magnets, sensors and controller."""
        super().read(q, q_t)
        first, second = self._first, self._second
        if self._sensor is not self.end:
            self._sensor.read(q[:first], q_t[:first])
        if self.sensor_base is not self.base:
            self.sensor_base.read(q[first:second], q_t[first:second])
        self._currents = -self._by_place.dot(q[second:]) - self._by_rate.dot(q_t[second:])

    def motions(self) -> list[tuple[float, ...]]:
        """Return x, y, ẋ, ẏ, θ and Ω of the journal, as one of a list."""
        return [self.relative]

    @property
    def axes_states(self) -> list[tuple[float, float]]:
        """Current [A] and place [m] of each control axis."""
        return list(zip(self._currents.tolist(), (self._turn @ self.relative[:2]), strict=True))

    def wrench(self, t: float) -> tuple:
        """Return the force on the rotor, and what drives the controller's coordinates."""
        x, y = self.relative[:2]
        if x * x + y * y >= self._least:
            self.outside = True
        law = self.bearing.actuator.law
        force = self._turn.T @ [law(*state) for state in self.axes_states]
        seen = np.array(self._sensor.place[:2])
        if self.sensor_base is not None:
            seen = seen - self.sensor_base.place[:2]
        own = np.outer(self._shares, seen + self._offset).ravel()
        return float(force[0]), float(force[1]), 0.0, None, own

    def tangent(self, t: float) -> Force:
        """Return the force, its tangent, and rows: of magnets, sensors and own coordinates."""
        slopes = [self.bearing.actuator.slopes(*state) for state in self.axes_states]
        return self.assembled(slopes)

    def assembled(self, slopes: list[tuple[float, float]]) -> Force:
        """Return force and tangent on the ports, from the slopes of the actuators."""
        D, K = self.bearing.coupling(np.array(slopes))
        fx, fy, _, _, own = self.wrench(0.0)
        J = np.zeros((4 + self.own, self.size))
        J[:2] = self.rows()[:2]
        J[2:4, : self._first] = self._sensor.rows()[:2]
        if self.sensor_base is not None:
            J[2:4, self._first : self._second] = -self.sensor_base.rows()[:2]
        J[4:, self._second :] = np.eye(self.own)
        L = np.zeros_like(J)
        L[:2, : self._first] = self.end.rate_rows()[:2]
        return Force(np.array([fx, fy, 0.0, 0.0, *own]), J, L, K, D)
