"""Motors, drag, gears and couplings in a scene.

A connection of two rotors is one object on the coordinates of both: action and reaction are exact,
and the Jacobian has what couples the rotors.
"""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import CoordinateSpringDamper, MarkerNodeCoordinate, NodePointGround

from exudyn_rotor import checks
from exudyn_rotor.drives.connection import Connection
from exudyn_rotor.drives.drive import Drive
from exudyn_rotor.multibody.supports.connector import (
    CURRENT,
    PYTHON,
    SPEED_STEP,
    SYMBOLIC,
    Body,
    Connector,
    SceneLaw,
    Tangent,
    check_body,
)
from exudyn_rotor.multibody.supports.ends import Base, BaseEnd, RotorEnd, Seat
from exudyn_rotor.multibody.supports.native import set_symbolic_force
from exudyn_rotor.solid.places import off_place
from exudyn_rotor.theory.formulation import ConstantSpeed

_KINDS = exudyn.OutputVariableType
_SAME_SPEED = 1e-9  # share of a speed by which constant ones may differ


@dataclass(frozen=True, eq=False)
class SceneDrive(SceneLaw):
    """A drive in a scene; without a connector where it acts on the whole rotor.

    Attributes
    ----------
    body, objects, evaluation, connector
        See :class:`SceneLaw`.
    drive : Drive
    at : str or None
        Its interface; None for the whole rotor.
    """

    drive: Drive
    at: str | None

    def values(self, configuration: exudyn.ConfigurationType = CURRENT) -> tuple[float, float]:
        """Return torque about e [N m] and power [W] on the rotor."""
        mbs, made = self.body.mbs, self.connector
        if made is None:
            node, spin = self.body.nodes["rigid"], self.body.locks.spin
            speed = float(mbs.GetNodeOutput(node, _KINDS.Coordinates_t, configuration)[spin])
        else:
            made.read(*made.state(mbs, configuration))
            speed = made.speed
        torque = float(self.drive.law(speed, mbs.systemData.GetTime(configuration)))
        return torque, torque * speed

    def __str__(self) -> str:
        """Return kind, place and who evaluates it."""
        where = "" if self.at is None else f" at {self.at}"
        return f"{type(self.drive).__name__}{where} by {self.evaluation[0]}"


def add_drive(
    body: Body,
    drive: Drive,
    at: str | None = None,
    base: Base | None = None,
) -> SceneDrive:
    """Put a motor or drag on a rotor in a scene, whose spin is free.

    Call it before ``mbs.Assemble()``. Several drives add up.

    Parameters
    ----------
    body : RotorBody or FullRotorBody
        From :func:`exudyn_rotor.add_rotor` with ``spin='free'`` and its marker body.
    drive : Drive
        InductionMotor, DirectCurrentMotor, TorqueCurve or Drag.
    at : str, optional
        Interface on which the torque acts, about the spin axis, by its mean rotation there. The
        whole rotor by default: the torque acts on the spin and bends or twists nothing.
    base : MarkerIndex or ObjectIndex, optional
        What carries the stator and takes the reaction: a rigid body, or a marker at the place of
        the interface; the ground by default. The speed is that against it.

    Returns
    -------
    SceneDrive
        With the number of its connector; ``add_sensor()`` records torque and power.

    Raises
    ------
    TypeError, ValueError
        For bad input, a prescribed spin above all, and for a curve that has no torque at the spin
        speed of the start; nothing has been added then. A run that leaves the range of a table
        stops with an error.

    Examples
    --------
    A rotor of 0.01 kg m² reaches (1 − 1/e) of the no-load speed after J Ω_0/T_0 = 0.2 s:

    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import (
    ...     DirectCurrentMotor, SolidRotor, add_drive, add_rotor, recommended_settings
    ... )
    >>> rotor = SolidRotor.from_matrices(
    ...     0.5 * np.eye(6), np.zeros((6, 6)), [[0.1, 0, 0], [-0.1, 0, 0]], "z"
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(0), translation="none")
    >>> added = add_drive(body, DirectCurrentMotor(stall_torque=5.0, no_load_speed=100.0))
    >>> print(added)
    DirectCurrentMotor by symbolic function
    >>> mbs.Assemble()
    >>> settings = recommended_settings(end_time=0.2, step=1e-3)
    >>> settings.timeIntegration.verboseMode = 0
    >>> settings.solution.file.write = False
    >>> mbs.SolveDynamic(settings)
    True
    >>> float(body.coordinates()[1][0].round(2))
    63.21
    """
    check_body(body, "body")
    checks.instance(drive, "drive", Drive, "DirectCurrentMotor, Drag and others are")
    if not body.formulation.has_spin:
        raise ValueError(
            f"body: rotor {body.name!r} has a prescribed spin, which no torque changes; add it "
            "with spin='free', or read its drive torque with body.add_drive_torque_sensor()"
        )
    drive.torque(body.placement.speed)  # a curve that fails does so here, not in a run
    if at is None:
        if base is not None:
            raise ValueError("base: a drive on the whole rotor has none; give at='…', an interface")
        added = _on_the_spin(body, drive)
    else:
        seat = _turning_seat(body, at, "at", base)
        made = DriveConnector(drive, RotorEnd(body, at), seat.end)
        number = body.mbs.AddObject(made.item())
        added = SceneDrive(body, (number,), (PYTHON,), made, drive, at)
    body.drives.append(added)
    return added


def _turning_seat(body: Body, name: str, argument: str, base: Base | None = None) -> Seat:
    """Return where a torque acts; refuse what is no interface of a rotor, or has no rotation."""
    interfaces = body.selection.source.interfaces
    if interfaces[checks.choice(name, argument, interfaces)].radius == 0.0:
        raise ValueError(
            f"{argument}: {name!r} is a single node, which has no rotation; make the interface of "
            "three nodes or more"
        )
    return Seat.of(body, name, base)


def _on_the_spin(body: Body, drive: Drive) -> SceneDrive:
    mbs, law = body.mbs, drive.law
    ground = MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0)
    spin = MarkerNodeCoordinate(nodeNumber=body.nodes["rigid"], coordinate=body.locks.spin)
    item = CoordinateSpringDamper(markerNumbers=[mbs.AddMarker(ground), mbs.AddMarker(spin)])

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        return -law(v, t)

    item.springForceUserFunction = force
    if drive.is_formula:
        set_symbolic_force(mbs, item, force)
    told = (SYMBOLIC if drive.is_formula else PYTHON,)
    return SceneDrive(body, (mbs.AddObject(item),), told, None, drive, None)


class DriveConnector(Connector):
    """A torque about the axis by the speed of an interface against what carries the stator."""

    def __init__(self, drive: Drive, end: RotorEnd, base: BaseEnd) -> None:
        super().__init__(end, base)
        self._law = drive.law

    @property
    def speed(self) -> float:
        """Speed of the interface against the base [rad/s]."""
        return self.end.speed + self.end.tilt_rate[2] - self.base.speed

    def wrench(self, t: float) -> tuple:
        """Return the torque on the rotor."""
        return 0.0, 0.0, 0.0, (0.0, 0.0, float(self._law(self.speed, t)))

    def tangent(self, t: float) -> Tangent:
        """Return the derivative of the torque by the speed, with the row (1, size)."""
        torque, step = self._law(self.speed, t), SPEED_STEP * max(abs(self.speed), 1.0)
        damping = np.array([[(torque - self._law(self.speed + step, t)) / step]])
        rows = self.rows()[5:], self.rate_rows()[5:]
        return *rows, 0.0 * damping, damping


@dataclass(frozen=True, eq=False)
class SceneConnection(SceneLaw):
    """A gear mesh or coupling in a scene.

    Attributes
    ----------
    body, objects, evaluation, connector
        See :class:`SceneLaw`; `body` is the first rotor.
    connection : Connection
    at : str
        Interface of the first rotor.
    other : RotorBody or FullRotorBody
        The second rotor.
    other_at : str
        Its interface.
    """

    connection: Connection
    at: str
    other: Body
    other_at: str

    def values(
        self, configuration: exudyn.ConfigurationType = CURRENT
    ) -> tuple[float, float, float]:
        """Return what is transmitted, elastic energy [J] and power lost [W].

        Transmitted is the force of a mesh [N], the torque of a coupling on the second rotor [N m].
        """
        law, made = self.connection, self.connector
        made.read(*made.state(self.body.mbs, configuration))
        x, x_t = made.motion
        return law.transmitted(x, x_t), law.energy(x), law.loss(x, x_t)

    def __str__(self) -> str:
        """Return kind, place and who evaluates it."""
        return f"{type(self.connection).__name__} at {self.at} by {PYTHON}"


def connect_rotors(
    connection: Connection,
    body: Body,
    at: str,
    other: Body,
    other_at: str,
) -> SceneConnection:
    """Put a gear mesh or a coupling between two rotors in a scene.

    Call it before ``mbs.Assemble()``. Teeth mesh, and couplings are relaxed, where both rotors
    start: spin angles count from there.

    Parameters
    ----------
    connection : GearMesh or FlexibleCoupling
        Its axes are those of `body` as it is mounted.
    body : RotorBody or FullRotorBody
        The first rotor, with its marker body; spin free or prescribed.
    at : str
        Its interface.
    other : RotorBody or FullRotorBody
        The second rotor, in the same system.
    other_at : str
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
    ...     np.eye(12), np.zeros((12, 12)), square, "z", interfaces={"gear": range(4)}
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
    check_body(body, "body")
    check_body(other, "other")
    first, second = _turning_seat(body, at, "at"), _turning_seat(other, other_at, "other_at")
    if other.mbs is not body.mbs or other is body:
        raise ValueError("other: needs another rotor of the same system")
    apart = off_place(second.place - first.place, first.leeway, second.leeway)
    axis = first.axes.T @ second.axes[:, 2]
    connection.check_places(first.axes.T @ apart, axis)
    _check_speeds(connection, body, other, float(np.sign(axis[2])))
    made = RotorConnector(connection, RotorEnd(body, at), RotorEnd(other, other_at))
    number = body.mbs.AddObject(made.item())
    added = SceneConnection(body, (number,), (PYTHON,), made, connection, at, other, other_at)
    for rotor in (body, other):
        rotor.drives.append(added)
    return added


def _check_speeds(connection: Connection, body: Body, other: Body, sense: float) -> None:
    """Refuse constant speeds between which a connection winds up; `sense` is of the second axis."""
    own, second = body.formulation.spin, other.formulation.spin
    if not (isinstance(own, ConstantSpeed) and isinstance(second, ConstantSpeed)):
        return
    expected = sense * connection.mean_speed_ratio * own.speed
    if abs(second.speed - expected) > _SAME_SPEED * max(abs(second.speed), abs(expected)):
        raise ValueError(
            f"other: its constant speed of {second.speed:g} rad/s would wind up the connection to "
            f"rotor {body.name!r} at {own.speed:g} rad/s without bound; prescribe "
            f"{expected!r} rad/s, or leave one spin free"
        )


class RotorConnector(Connector):
    """A gear or coupling between two rotors, whose motions count from where they start.

    In axes of the first rotor, in which the second has rows of its own.
    """

    def __init__(self, connection: Connection, end: RotorEnd, other: RotorEnd) -> None:
        super().__init__(end, other)
        self._law = connection
        self._into = np.kron(np.eye(2), end.axes.T @ other.axes)

    @property
    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Return motion and rate of both ends, each (12,)."""
        pairs = zip(self.end.motion, self.base.motion, strict=True)
        return tuple(np.concatenate([one, self._into @ two]) for one, two in pairs)

    def rows(self) -> np.ndarray:
        """Return the rows J (12, size) of both ends."""
        return self._of_both(self.end.rows(), self.base.rows())

    def rate_rows(self) -> np.ndarray:
        """Return the derivative (12, size) of the rates of both ends by the coordinates."""
        return self._of_both(self.end.rate_rows(), self.base.rate_rows())

    def _of_both(self, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        """Return rows of both ends, one under the other, in axes of the first rotor."""
        rows = np.zeros((12, self.size))
        rows[:6, : self._first], rows[6:, self._first :] = first, self._into @ second
        return rows

    def wrench(self, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Return force and moment on both ends, each (6,) in axes of its own."""
        forces = self._law.forces(*self.motion)
        return forces[:6], forces[6:] @ self._into

    def pull(self, first: np.ndarray, second: np.ndarray) -> list[float]:
        """Return the forces on all coordinates by those of both ends."""
        pairs = (self.end, first.tolist()), (self.base, second.tolist())
        return [f for end, loads in pairs for f in end.pull(*loads[:3], loads[3:]).tolist()]

    def tangent(self, t: float) -> Tangent:
        """Return the law's tangent, with rows (12, size) of both ends."""
        return self.rows(), self.rate_rows(), *self._law.tangent(*self.motion)
