"""Motors and drag on a rotor in a scene whose spin is free."""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import CoordinateSpringDamper, MarkerNodeCoordinate, NodePointGround

from exudyn_rotor import checks
from exudyn_rotor.drives.drive import Drive
from exudyn_rotor.multibody.supports.connector import (
    CURRENT,
    PYTHON,
    SYMBOLIC,
    Body,
    Connector,
    Force,
    SceneLaw,
    check_body,
)
from exudyn_rotor.multibody.supports.ends import Base, BaseEnd, RotorEnd, Seat
from exudyn_rotor.multibody.supports.native import symbolic_function

_KINDS = exudyn.OutputVariableType
_STEP = 1e-6  # of the speed, or of 1 rad/s


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
        check_turning_interface(body, at, "at")
        made = DriveConnector(drive, RotorEnd(body, at), Seat.of(body, at, base).end(body.mbs))
        number = body.mbs.AddObject(made.item())
        added = SceneDrive(body, (number,), (PYTHON,), made, drive, at)
    body.drives.append(added)
    return added


def check_turning_interface(body: Body, name: str, argument: str) -> None:
    """Refuse what is no interface of the rotor, or has no rotation.

    Raises
    ------
    TypeError, ValueError
    """
    known = body.selection.source.interfaces
    (name,) = checks.labels(checks.label(name, argument), argument, known)
    if known[name].radius == 0.0:
        raise ValueError(
            f"{argument}: {name!r} is a single node, which has no rotation; make the interface of "
            "three nodes or more"
        )


def _on_the_spin(body: Body, drive: Drive) -> SceneDrive:
    mbs, law = body.mbs, drive.law
    ground = MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0)
    spin = MarkerNodeCoordinate(nodeNumber=body.nodes["rigid"], coordinate=body.locks.spin)
    item = CoordinateSpringDamper(markerNumbers=[mbs.AddMarker(ground), mbs.AddMarker(spin)])

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        return -law(v, t)

    if drive.is_formula:
        force = symbolic_function(mbs, force, item, "springForceUserFunction")
    item.springForceUserFunction = force
    told = (SYMBOLIC if drive.is_formula else PYTHON,)
    return SceneDrive(body, (mbs.AddObject(item),), told, None, drive, None)


class DriveConnector(Connector):
    """A torque about the axis by the speed of an interface against what carries the stator."""

    def __init__(self, drive: Drive, end: RotorEnd, base: BaseEnd | None) -> None:
        super().__init__(end, base)
        self._law = drive.law

    @property
    def speed(self) -> float:
        """Speed of the interface against the base [rad/s]."""
        turning = self.end.speed + self.end.tilt_rate[2]
        return turning - (0.0 if self.base is None else self.base.speed)

    def wrench(self, t: float) -> tuple:
        """Return the torque on the rotor."""
        return 0.0, 0.0, 0.0, (0.0, 0.0, float(self._law(self.speed, t)))

    def tangent(self, t: float) -> Force:
        """Return the torque, its derivative by the speed, and the row (1, size)."""
        torque, step = self._law(self.speed, t), _STEP * max(abs(self.speed), 1.0)
        try:
            ahead = self._law(self.speed + step, t)
        except ValueError:  # at the end of a table
            ahead, step = self._law(self.speed - step, t), -step
        damping = np.array([[(torque - ahead) / step]])
        rows = self.rows()[5:], self.rate_rows()[5:]
        return Force(np.array([torque]), *rows, 0.0 * damping, damping)
