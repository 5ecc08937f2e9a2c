"""Active magnetic bearing: actuators and controllers of two axes across the rotor.

The control axes are n1 and n2 turned by an angle. On each, the sensor measures the displacement of
its interface; the controller (:mod:`exudyn_rotor.bearings.pid_controller`) makes a
current of it, the actuator (:mod:`exudyn_rotor.bearings.actuator`) a force,

    y = u_sensor,   i = −C(s) y,   F = F(i, u_actuator).                                   (1)

With its sensors at another interface than its magnets (non-collocation) the controller may drive
bending modes unstable whose node is between the two.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, inf, sin
from typing import ClassVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.actuator import Actuator, SaturatingActuator
from exudyn_rotor.bearings.bearing import LoadedBearing
from exudyn_rotor.bearings.controlled_support import ControlledSupport
from exudyn_rotor.bearings.pid_controller import PIDController, Realisation


@dataclass(frozen=True, eq=False, kw_only=True)
class MagneticBearing(LoadedBearing):
    """Active magnetic bearing with two control axes.

    In a scene the controller's states are coordinates of the scene; in linear analyses, which take
    the actuators' slopes in the equilibrium, coordinates beside the rotor's.

    Parameters
    ----------
    interface : str
        Interface of the rotor on which the magnets act.
    actuator : LinearActuator or SaturatingActuator
        Of each axis.
    controller : PIDController
        Of each axis.
    angle : float, optional
        From n1 to the first control axis [rad].
    sensor : str, optional
        Interface whose displacement is measured; where the magnets act by default.
    load : array_like, shape (2,), optional
        Static load on the rotor along (n1, n2) [N], in whose equilibrium linear analyses take the
        actuators; none by default. It makes a difference to saturating actuators only.

    Raises
    ------
    TypeError, ValueError

    Examples
    --------
    >>> from exudyn_rotor import MagneticBearing, PIDController, SaturatingActuator
    >>> bearing = MagneticBearing(
    ...     interface="left",
    ...     actuator=SaturatingActuator(
    ...         constant=1e-5, bias_current=2.0, gap=4e-4, current_limit=6.0
    ...     ),
    ...     controller=PIDController(
    ...         proportional=2e4, derivative=20.0, filter_frequency=2e4, amplifier_frequency=1e4
    ...     ),
    ...     load=[0.0, -300.0],
    ... )
    >>> print(1e6 * bearing.equilibrium(speed=0.0).round(8))
    [  0.   -40.88]
    """

    _unloaded: ClassVar[bool] = True

    actuator: Actuator
    controller: PIDController
    angle: float = 0.0
    sensor: str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.instance(self.actuator, "actuator", Actuator, "LinearActuator is one")
        checks.instance(self.controller, "controller", PIDController)
        checks.keep_numbers(self, {"angle": "rad"})
        if self.sensor is not None:
            checks.label(self.sensor, "sensor")

    @property
    def sensor_interface(self) -> str:
        """Interface whose displacement is measured."""
        return self.interface if self.sensor is None else self.sensor

    @cached_property
    def realisation(self) -> Realisation:
        """The controllers' equations in pairs along (n1, n2), times a stiffness, as forces.

        With ``K_i (P + D ω_a)``, in the centre, both directions of the coupling are alike.
        """
        given, both = self.controller, np.eye(2)
        gain = given.proportional + given.derivative * given.amplifier_frequency
        scale, one = self.actuator.force_current * gain, given.realisation()
        return Realisation(
            np.repeat(scale * one.inertia, 2),
            scale * np.kron(one.damping, both),
            scale * np.kron(one.stiffness, both),
            scale * np.kron(one.place[:, None], both),
            one.by_place,
            one.by_rate,
        )

    @property
    def control_axes(self) -> np.ndarray:
        """The control axes as rows along (n1, n2), shape (2, 2)."""
        c, s = cos(self.angle), sin(self.angle)
        return np.array([[c, s], [-s, c]])

    def clearance_along(self, direction: np.ndarray | None = None) -> float:
        """Return how far the journal may go in any direction [m]: the air gap, or infinity."""
        return self.actuator.gap if isinstance(self.actuator, SaturatingActuator) else inf

    def _rest(self, speed: float, load: np.ndarray) -> np.ndarray:
        """Return where the journal rests [m], as if the sensors were where the magnets are.

        An integral brings it to the centre.
        """
        return self.control_axes.T @ [place for place, _ in self._states(load)]

    def _states(self, load: np.ndarray) -> list[tuple[float, float]]:
        """Return place [m] and current [A] of each control axis in the equilibrium."""
        axes, gain, actuator = self.control_axes, self.controller.proportional, self.actuator
        held, pulled = actuator.force_current * gain, actuator.negative_stiffness
        if held <= pulled:
            raise ValueError(
                f"controller: unstable: K_i P of {held:.4g} N/m is not above the negative "
                f"stiffness K_s of {pulled:.4g} N/m, so that there is no equilibrium; give a "
                "larger proportional gain"
            )
        current, place = (-1.0, 0.0) if self.controller.integral else (-gain, 1.0)
        shares = [actuator._carrying(pull, current, place) for pull in axes @ load]
        return [(place * share, current * share) for share in shares]

    def linearised(self) -> ControlledSupport:
        """Return the equations for linear analyses, about the equilibrium under the load.

        Without load about the centre, also where a controller does not hold there.

        Raises
        ------
        ValueError
            As :meth:`equilibrium`.
        """
        load = self._static_load(None)
        states = self._states(load) if np.any(load) else [(0.0, 0.0)] * 2
        slopes = np.array([self.actuator.slopes(i, x) for x, i in states])
        damping, stiffness = self.coupling(slopes)
        by_current = self.control_axes.T @ (slopes[:, 0, None] * self.control_axes)
        static = self.controller.proportional * by_current + stiffness[:2, :2]
        return ControlledSupport(
            self.interface,
            self.realisation.inertia,
            lambda _: (stiffness, damping),
            static,
            self.sensor_interface,
        )

    def coupling(self, slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return damping and stiffness of the ports of :class:`ControlledSupport`.

        Parameters
        ----------
        slopes : ndarray, shape (2, 2)
            Derivatives of the force of each control axis by current [N/A] and place [N/m].
        """
        turn, own = self.control_axes, self.realisation
        by_current, by_place = (turn.T @ (slopes[:, i, None] * turn) for i in (0, 1))
        damping, stiffness = np.zeros((2, *[4 + len(own.inertia)] * 2))
        damping[4:, 4:] = own.damping
        stiffness[4:, 4:] = own.stiffness
        stiffness[4:, 2:4] = -own.place
        damping[:2, 4:] = np.kron(own.by_rate, by_current)
        stiffness[:2, 4:] = np.kron(own.by_place, by_current)
        stiffness[:2, :2] = -by_place
        return damping, stiffness
