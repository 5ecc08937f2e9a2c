"""Sensors of a rotor body: native ones by mesh node and interface, spin, torque and energy."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import SensorSuperElement, SensorUserFunction

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.frame import LOCKS, driving_force
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import ConstantSpeed

_KINDS = exudyn.OutputVariableType
_AT_MESH_NODE = (
    _KINDS.Position,
    _KINDS.Displacement,
    _KINDS.DisplacementLocal,
    _KINDS.Velocity,
    _KINDS.VelocityLocal,
    _KINDS.Acceleration,
)
AT_MARKER = {
    "position": (_KINDS.Position, _KINDS.Displacement, _KINDS.Velocity),
    "rigid": (
        _KINDS.Position,
        _KINDS.Displacement,
        _KINDS.Velocity,
        _KINDS.Rotation,
        _KINDS.RotationMatrix,
        _KINDS.AngularVelocity,
        _KINDS.AngularVelocityLocal,
        _KINDS.HomogeneousTransformation,
    ),
}


def add_node_sensor(
    body: RotorItems, node: int, output: exudyn.OutputVariableType, **options: Any
) -> exudyn.SensorIndex:
    """Add a ``SensorSuperElement`` at mesh node `node`, stored internally by default."""
    marker_body, count = body.objects["marker_body"], body.mesh_node_count
    if checks.count(node, "node", least=-1) not in range(count):
        raise ValueError(
            f"node: rotor {body.name!r} has mesh nodes 0 … {count - 1}, not {node}"
            + ("" if count else "; it has no shapes (without_shapes)")
        )
    stress = body.mbs.GetObjectParameter(marker_body, "outputVariableModeBasis")
    with_stress = np.size(stress) > 0
    check_output(
        output,
        (*_AT_MESH_NODE, _KINDS.StressLocal) if with_stress else _AT_MESH_NODE,
        "at a mesh node" + ("" if with_stress else ", of a rotor reduced without stress"),
    )
    settings = settings_of(body, options)
    _warn_of_static_stress(body, output)
    return body.mbs.AddSensor(
        SensorSuperElement(
            bodyNumber=marker_body,
            meshNodeNumber=int(node),
            outputVariableType=output,
            **settings,
        )
    )


def settings_at_mesh_node(
    body: RotorItems, output: exudyn.OutputVariableType, options: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the settings of a sensor at a mesh node of a full body; stress is none of them."""
    check_output(output, _AT_MESH_NODE, "at a mesh node of a full body (stress: body.stress())")
    return settings_of(body, options)


def _warn_of_static_stress(body: RotorItems, output: exudyn.OutputVariableType) -> None:
    """Warn where a native stress sensor leaves out a static stress that the rotor was given."""
    spin = body.formulation.spin
    at_rest = isinstance(spin, ConstantSpeed) and spin.speed == 0.0
    # K2 is what a body keeps of a prestress
    if output != _KINDS.StressLocal or at_rest or body.selection.invariants.K2 is None:
        return
    warnings.warn(
        f"rotor {body.name!r}: Exudyn's stress sensor shows the stress of the modes alone, without "
        "the static centrifugal stress that they do not hold; record the modal coordinates and use "
        "StressField.of(reduced, body) with stress_history",
        UserWarning,
        stacklevel=4,
    )


def add_drive_torque_sensor(body: RotorItems, **options: Any) -> exudyn.SensorIndex:
    """Add a sensor of the drive torque about e [N m].

    The torque is the rotor's own share (the row of θ in (84–86)) minus the moment of all external
    forces, which the locked coordinate of the marker body collects, and minus the friction of
    bearings and stops, which the motion of a prescribed spin does not feel. Not in static
    solutions: Exudyn's static solver returns multipliers with the opposite sign. Explicit solvers
    have no accelerations at the first instant, so the first value is wrong with them.
    """
    if body.formulation.has_spin:
        raise ValueError(
            f"rotor {body.name!r} spins freely and has no drive; a prescribed spin has one"
        )
    external = _external_moment(body)

    def torque(mbs, t, sensors, factors, configuration):
        q, q_t, q_tt = body.coordinates(configuration)
        modes = slice(body.motion.formulation.translation_count, None)
        needed = body.motion.drive_torque(t, q, q_t, q_tt[modes])
        given = external(t, configuration) + _deflected_weight(body, t, q[modes])
        return [needed - given - _friction(body, configuration)]

    return add_function_sensor(body, torque, options)


def _friction(body: RotorItems, configuration: exudyn.ConfigurationType) -> float:
    """Return the torque of bearings and stops on a rotor that does not feel it [N m]."""
    total = 0.0
    for made in (one.connector for one in body.supports):
        made.read(*made.state(body.mbs, configuration))
        total += made.friction()
    return total


def _deflected_weight(body: RotorItems, t: float, zeta: np.ndarray) -> float:
    """Return the moment about e of gravity by the deflection Sζ, which Exudyn's load leaves out."""
    if body.gravity_load is None:
        return 0.0
    motion = body.motion
    axis = SpinAxis(motion.invariants.direction)
    gravity = np.asarray(body.mbs.GetLoadParameter(body.gravity_load, "loadVector"))
    turn = motion.orientation @ axis.rotation(motion.formulation.spin.value(t))
    return float(turn @ axis.skew @ (motion.invariants.S @ zeta) @ gravity)


def _external_moment(body: RotorItems):
    """Return a function that reads the external moment about e from the locked spin."""
    node, mbs, spin = body.nodes["rigid"], body.mbs, body.locks.spin
    mass, drive = body.layout.lock_mass, driving_force(body.locks, body.layout.lock_mass)
    own = "spin" in body.constraints
    constraint = body.constraints.get("spin", body.constraints.get(LOCKS))
    share = np.ones(1) if own else body.locks.rows[0][:, spin]

    def moment(t, configuration) -> float:
        acceleration = mbs.GetNodeOutput(node, _KINDS.Coordinates_tt, configuration)[spin]
        reaction = mass[spin] * float(acceleration)
        if constraint is not None:
            reaction += float(share @ np.ravel(mbs.GetObjectOutput(constraint, _KINDS.Force)))
        if drive is not None and constraint is None:
            reaction -= drive(t)[spin]
        return reaction

    return moment


def add_function_sensor(
    body: RotorItems, function: Callable, options: Mapping[str, Any]
) -> exudyn.SensorIndex:
    """Add a sensor of what a user function returns."""
    settings = settings_of(body, options)
    return body.mbs.AddSensor(SensorUserFunction(sensorUserFunction=function, **settings))


def check_output(
    output: exudyn.OutputVariableType, known: tuple[exudyn.OutputVariableType, ...], where: str
) -> None:
    """Refuse what Exudyn would refuse as late as in ``mbs.Assemble()``."""
    names = ", ".join(kind.name for kind in known)
    checks.instance(
        output, "output", _KINDS, f"{where} there are, of exudyn.OutputVariableType: {names}"
    )
    if output not in known:
        raise ValueError(f"output: {output.name} is not available {where}; there are: {names}")


def settings_of(body: RotorItems, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of a sensor, stored internally by default."""
    body.check_present()
    known = ("name", "storeInternal", "writeToFile", "fileName")
    for option in options:
        if option not in known:
            raise TypeError(f"{option}: is no option of this sensor; it takes {', '.join(known)}")
    settings = {"storeInternal": True, "writeToFile": False} | dict(options)
    for option in ("storeInternal", "writeToFile"):
        checks.flag(settings[option], option)
    if "fileName" in settings:
        settings["fileName"] = os.fspath(checks.path(settings["fileName"], "fileName"))
    if "name" in settings:
        name = checks.label(settings["name"], "name")
        if int(body.mbs.GetSensorNumber(name)) != -1:
            raise ValueError(f"name: this system already has a sensor {name!r}; choose another")
    return settings
