"""Gears and couplings between rotors in a scene, by one object on the coordinates of both.

Its forces are those of the connection, taken to the coordinates by the derivative of the motion of
both interfaces: action and reaction are exact, and the Jacobian has what couples the rotors.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.drives.connection import Connection
from exudyn_rotor.multibody.drives.add_drive import check_turning_interface
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.sensors import add_function_sensor
from exudyn_rotor.multibody.supports.connector import Connector, Force
from exudyn_rotor.multibody.supports.ends import RotorEnd, Seat
from exudyn_rotor.multibody.supports.native import PYTHON
from exudyn_rotor.solid.places import off_place
from exudyn_rotor.theory.formulation import ConstantSpeed, PrescribedMotion, start_values

_SAME_SPEED = 1e-9  # share of a speed by which constant ones may differ
_SHAFTS = (ConstantSpeed, PrescribedMotion)
Body = RotorBody | FullRotorBody


@dataclass(frozen=True, eq=False)
class SceneConnection:
    """A gear mesh or coupling in a scene.

    Attributes
    ----------
    connection : Connection
    body : RotorBody or FullRotorBody
        The first rotor.
    at : str
        Its interface.
    object : ObjectIndex
    connector : RotorConnector
        Its law by the coordinates of both rotors.
    other : RotorBody or FullRotorBody, optional
        The second rotor; None for a shaft.
    other_at : str, optional
        Its interface.
    shaft : ConstantSpeed or PrescribedMotion, optional
        The angle of a shaft in place of a second rotor.
    """

    connection: Connection
    body: Body
    at: str
    object: exudyn.ObjectIndex
    connector: RotorConnector
    other: Body | None = None
    other_at: str | None = None
    shaft: ConstantSpeed | PrescribedMotion | None = None

    @property
    def uses_python(self) -> bool:
        """True: a time step calls Python for it."""
        return True

    def add_sensor(self, **options: Any) -> exudyn.SensorIndex:
        """Add a sensor of what is transmitted, elastic energy [J] and power lost [W].

        Transmitted is the force of a mesh [N], the torque of a coupling on the second rotor [N m].

        Parameters
        ----------
        **options
            Of ``SensorUserFunction``: name, storeInternal, writeToFile, fileName.

        Raises
        ------
        TypeError, ValueError
            For other options.
        """
        law = self.connection.law

        def output(mbs, t, sensors, factors, configuration):
            made = self.connector
            made.read(*made.state(mbs, configuration))
            x, x_t = made.motion(t)
            return [law.transmitted(x, x_t), law.energy(x), law.loss(x, x_t)]

        return add_function_sensor(self.body, output, options)

    def __str__(self) -> str:
        """Return kind, place and who evaluates it."""
        return f"{type(self.connection).__name__} at {self.at} by {PYTHON}"


def connect_rotors(
    connection: Connection,
    body: Body,
    at: str,
    other: Body | ConstantSpeed | PrescribedMotion,
    other_at: str | None = None,
) -> SceneConnection:
    """Put a gear mesh or a coupling between two rotors in a scene, or a rotor and a shaft.

    Call it before ``mbs.Assemble()``. Teeth mesh, and couplings are relaxed, where both rotors
    start: spin angles count from there.

    Parameters
    ----------
    connection : GearMesh, FlexibleCoupling or CardanJoint
        Its axes are those of `body` as it is mounted.
    body : RotorBody or FullRotorBody
        The first rotor, with its marker body; spin free or prescribed.
    at : str
        Its interface.
    other : RotorBody, FullRotorBody, ConstantSpeed or PrescribedMotion
        The second rotor, in the same system; or the angle of a shaft whose axis stands still where
        the connection needs it.
    other_at : str, optional
        Interface of the second rotor.

    Returns
    -------
    SceneConnection
        With the number of its object; ``add_sensor()`` records force or torque and energy.

    Raises
    ------
    TypeError, ValueError
        For bad input, and for rotors that are not mounted as the connection needs them; nothing has
        been added then.

    Examples
    --------
    A pinion at 30 rad/s drives a wheel of twice its base radius:

    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import (
    ...     GearMesh, SolidRotor, add_rotor, connect_rotors, recommended_settings
    ... )
    >>> square = 0.05 * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    >>> wheel = SolidRotor.from_matrices(
    ...     np.eye(12), np.zeros((12, 12)), square, "z", interfaces={"gear": range(4)},
    ...     allow_parts=True,
    ... ).reduce(0)
    >>> mesh = GearMesh(radii=[0.03, 0.06], stiffness=1e7, damping=2e3)
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> pinion = add_rotor(mbs, wheel, name="pinion", spin=30.0, translation="none")
    >>> driven = add_rotor(
    ...     mbs, wheel, name="driven", translation="none", position=[mesh.center_distance, 0, 0],
    ...     initial_speed=-15.0,
    ... )
    >>> print(connect_rotors(mesh, pinion, "gear", driven, "gear"))
    GearMesh at gear by Python function
    >>> mbs.Assemble()
    >>> settings = recommended_settings(end_time=0.05, step=1e-3)
    >>> settings.timeIntegration.verboseMode = 0
    >>> settings.solution.file.write = False
    >>> mbs.SolveDynamic(settings)
    True
    >>> float(driven.coordinates()[1][0].round(6))
    -15.0
    """
    checks.instance(connection, "connection", Connection, "GearMesh is one")
    first = _checked_end(body, at, "body", "at")
    if isinstance(other, _SHAFTS):
        if other_at is not None:
            raise ValueError("other_at: a shaft has no interface; leave it out")
        start_values(other, "spin")
        _check_speeds(connection, body, other, 1.0)
        ends = [(body, at, first)]
    else:
        second = _checked_end(other, other_at, "other", "other_at")
        if other.mbs is not body.mbs or other is body:
            raise ValueError("other: needs another rotor of the same system")
        apart = off_place(second.place - first.place, first.leeway, second.leeway)
        axis = first.axes.T @ second.axes[:, 2]
        connection.law.check_places(first.axes.T @ apart, axis)
        sense = float(np.sign(axis @ connection.second_axis))
        _check_speeds(connection, body, other.formulation.spin, sense)
        ends = [(body, at, first), (other, other_at, second)]
    parts = [RotorEnd(rotor, name) for rotor, name, _ in ends]
    shaft = other if isinstance(other, _SHAFTS) else None
    made = RotorConnector(connection, parts[0], parts[1] if parts[1:] else None, shaft)
    end = ends[1][:2] if ends[1:] else (None, None, other)
    added = SceneConnection(connection, body, at, body.mbs.AddObject(made.item()), made, *end)
    for rotor, *_ in ends:
        rotor.drives.append(added)
    return added


def _checked_end(body: Body, at: str, argument: str, place: str) -> Seat:
    checks.instance(body, argument, (RotorBody, FullRotorBody), "add_rotor returns one")
    body.check_present()
    check_turning_interface(body, at, place)
    return Seat.of(body, at, None)


def _check_speeds(connection: Connection, body: Body, other: object, sense: float) -> None:
    """Refuse constant speeds between which a connection winds up; `sense` is of the second axis."""
    own = body.formulation.spin
    if not (isinstance(own, ConstantSpeed) and isinstance(other, ConstantSpeed)):
        return
    expected = sense * connection.mean_speed_ratio * own.speed
    if abs(other.speed - expected) > _SAME_SPEED * max(abs(other.speed), abs(expected)):
        raise ValueError(
            f"other: its constant speed of {other.speed:g} rad/s would wind up the connection to "
            f"rotor {body.name!r} at {own.speed:g} rad/s without bound; prescribe "
            f"{expected!r} rad/s, or leave one spin free"
        )


class RotorConnector(Connector):
    """A gear or coupling between two rotors, whose motions count from where they start.

    In axes of the first rotor, in which the second has rows of its own; or between a rotor and a
    shaft, whose angle is a function of time.
    """

    whole = True

    def __init__(
        self,
        connection: Connection,
        end: RotorEnd,
        other: RotorEnd | None = None,
        shaft: ConstantSpeed | PrescribedMotion | None = None,
    ) -> None:
        super().__init__(end, None)
        self._law, self._other, self._shaft = connection.law, other, shaft
        if other is not None:
            self.nodes = (*end.nodes, *other.nodes)
            self.size = end.size + other.size
            self._into = np.kron(np.eye(2), end.axes.T @ other.axes)

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion of both ends from coordinates and their rates."""
        super().read(q, q_t)
        if self._other is not None:
            self._other.read(q[self._first :], q_t[self._first :], True)

    def motion(self, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Return motion and rate of both ends, each (12,)."""
        x, x_t = self.end.motion
        if self._other is not None:
            y, y_t = self._other.motion
            return np.concatenate([x, self._into @ y]), np.concatenate([x_t, self._into @ y_t])
        axis, none = self._law.second_axis, np.zeros(3)
        angle, rate = self._shaft.value(t) - self._shaft.value(0.0), self._shaft.rate(t)
        return np.concatenate([x, none, angle * axis]), np.concatenate([x_t, none, rate * axis])

    def rows(self) -> np.ndarray:
        """Return the rows J (12, size) of both ends."""
        J = np.zeros((12, self.size))
        J[:6, : self._first] = self.end.rows()
        if self._other is not None:
            J[6:, self._first :] = self._into @ self._other.rows()
        return J

    def wrench(self, t: float) -> tuple[np.ndarray]:
        """Return the forces on all coordinates."""
        return (self._law.forces(*self.motion(t)) @ self.rows(),)

    def pull(self, forces: np.ndarray) -> list[float]:
        """Return the forces on all coordinates as a list."""
        return forces.tolist()

    def tangent(self, t: float) -> Force:
        """Return the law's forces on both ends, its tangent, and rows (12, size)."""
        x, x_t = self.motion(t)
        rows = self.rows(), self.rate_rows()
        return Force(self._law.forces(x, x_t), *rows, *self._law.tangent(x, x_t))

    def rate_rows(self) -> np.ndarray:
        """Return the derivative (12, size) of the rates of both ends by the coordinates."""
        L = np.zeros((12, self.size))
        L[:6, : self._first] = self.end.rate_rows()
        if self._other is not None:
            L[6:, self._first :] = self._into @ self._other.rate_rows()
        return L
