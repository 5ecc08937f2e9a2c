"""Sensors of a rotor body: native ones by mesh node and interface, spin, and drive torque."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import exudyn
import numpy as np
from exudyn.itemInterface import SensorMarker, SensorSuperElement, SensorUserFunction

from exudyn_rotor.multibody.locking import SPIN, guiding_force
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import ConstantSpeed

if TYPE_CHECKING:
    from exudyn_rotor.multibody.rotor_body import RotorBody

_KINDS = exudyn.OutputVariableType


def add_node_sensor(body: RotorBody, node: int, output, **options) -> exudyn.SensorIndex:
    """Add a ``SensorSuperElement`` at mesh node `node`, stored internally by default.

    Exudyn takes stress (``StressLocal``), here and in its contour plots, from the modal coordinates
    alone. The static centrifugal stress that the modes do not show is missing, which can be nearly
    all of the stress; :class:`exudyn_rotor.StressField` adds it.

    Warns
    -----
    UserWarning
        For stress of a rotor that was reduced with a prestress and spins.
    """
    shell = _shell(body)
    count = body.mesh_node_count
    if not 0 <= node < count:
        raise ValueError(
            f"rotor {body.name!r} has mesh nodes 0 … {count - 1}, not {node}"
            + ("" if count else "; it was reduced without shapes (keep_shapes=False)")
        )
    _warn_of_static_stress(body, output)
    settings = {"storeInternal": True, "writeToFile": False} | options
    return body.mbs.AddSensor(
        SensorSuperElement(
            bodyNumber=shell, meshNodeNumber=int(node), outputVariableType=output, **settings
        )
    )


def _warn_of_static_stress(body: RotorBody, output: exudyn.OutputVariableType) -> None:
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


def add_interface_sensor(body: RotorBody, interface: str, output, **options):
    """Add a ``SensorMarker`` at an interface, stored internally by default."""
    settings = {"storeInternal": True, "writeToFile": False} | options
    return body.mbs.AddSensor(
        SensorMarker(markerNumber=body.marker(interface), outputVariableType=output, **settings)
    )


def add_spin_sensor(body: RotorBody, **options) -> exudyn.SensorIndex:
    """Add a sensor of θ [rad] and ω [rad/s]."""
    if "rigid" in body.nodes:
        node, index = body.nodes["rigid"], SPIN
    elif body.formulation.has_spin:
        node, index = body.nodes["coordinates"], body.formulation.translation_count
    else:
        raise ValueError(f"rotor {body.name!r}: without the shell a prescribed spin has no node")

    def spin(mbs, t, sensors, factors, configuration):
        angle = mbs.GetNodeOutput(node, _KINDS.Coordinates, configuration)[index]
        speed = mbs.GetNodeOutput(node, _KINDS.Coordinates_t, configuration)[index]
        return [float(angle), float(speed)]

    return _add_function_sensor(body, spin, options)


def add_drive_torque_sensor(body: RotorBody, **options) -> exudyn.SensorIndex:
    """Add a sensor of the drive torque about e [N m].

    The torque is the rotor's own share (the row of θ in (84–86)) minus the moment of all external
    forces, which the locked coordinate of the shell collects. In static solutions it is right for
    a constant spin; not for θ(t) held by a constraint, because Exudyn's static solver returns
    multipliers with the opposite sign. Explicit solvers have no accelerations at the first
    instant, so the first value is wrong with them.
    """
    _shell(body)
    if body.formulation.has_spin:
        raise ValueError(
            f"rotor {body.name!r} spins freely and has no drive; a prescribed spin has one"
        )
    external = _external_moment(body)

    def torque(mbs, t, sensors, factors, configuration):
        q, q_t, q_tt = body.coordinates(configuration)
        modes = slice(body.motion.formulation.translation_count, None)
        own = body.motion.drive_torque(t, q, q_t, q_tt[modes])
        return [own - external(t, configuration) - _deflected_weight(body, t, q[modes])]

    return _add_function_sensor(body, torque, options)


def _deflected_weight(body: RotorBody, t: float, zeta: np.ndarray) -> float:
    """Return the moment about e of gravity by the deflection Sζ, which Exudyn's load leaves out."""
    if body.gravity_load is None:
        return 0.0
    motion = body.motion
    axis = SpinAxis(motion.invariants.direction)
    gravity = np.asarray(body.mbs.GetLoadParameter(body.gravity_load, "loadVector"))
    turn = motion.orientation @ axis.rotation(motion.formulation.spin.value(t))
    return float(turn @ axis.skew @ (motion.invariants.S @ zeta) @ gravity)


def _external_moment(body: RotorBody):
    """Return a function that reads the external moment about e on the shell's spin coordinate."""
    place, node, mbs = body.layout, body.nodes["rigid"], body.mbs
    guide = guiding_force(body.locks, place)
    constraint = body.constraints.get("spin")

    def moment(t, configuration) -> float:
        kinds = (_KINDS.Coordinates, _KINDS.Coordinates_t, _KINDS.Coordinates_tt)
        theta, omega, omega_t = (
            float(mbs.GetNodeOutput(node, kind, configuration)[SPIN]) for kind in kinds
        )
        held = (
            place.lock_mass[SPIN] * omega_t
            + place.lock_damping[SPIN] * omega
            + place.lock_stiffness[SPIN] * theta
        )
        if guide is not None:
            held -= guide(t)[SPIN]
        if constraint is not None:
            held += float(np.ravel(mbs.GetObjectOutput(constraint, _KINDS.Force))[0])
        return held

    return moment


def _shell(body: RotorBody) -> exudyn.ObjectIndex:
    if "shell" not in body.objects:
        raise ValueError(
            f"rotor {body.name!r} was added with native_shell=False; this sensor needs the shell"
        )
    return body.objects["shell"]


def _add_function_sensor(body: RotorBody, function, options: dict) -> exudyn.SensorIndex:
    settings = {"storeInternal": True, "writeToFile": False} | options
    return body.mbs.AddSensor(SensorUserFunction(sensorUserFunction=function, **settings))
