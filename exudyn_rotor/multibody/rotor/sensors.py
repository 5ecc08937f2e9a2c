"""Sensors of a rotor body: native ones by mesh node and interface, spin, torque and energy."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import SensorUserFunction

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.frame import LOCKS
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import ConstantSpeed

_KINDS = exudyn.OutputVariableType


def warn_of_static_stress(body: RotorItems, output: exudyn.OutputVariableType) -> None:
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
        stacklevel=3,
    )


def friction(body: RotorItems, configuration: exudyn.ConfigurationType) -> float:
    """Return the torque of bearings and stops on a rotor that does not feel it [N m]."""
    total = 0.0
    for made in (one.connector for one in body.supports):
        made.read(*made.state(body.mbs, configuration))
        total += made.friction()
    return total


def deflected_weight(body: RotorItems, t: float, zeta: np.ndarray) -> float:
    """Return the moment about e of gravity by the deflection Sζ, which Exudyn's load leaves out."""
    if body.gravity_load is None:
        return 0.0
    motion = body.motion
    axis = SpinAxis(motion.invariants.direction)
    gravity = np.asarray(body.mbs.GetLoadParameter(body.gravity_load, "loadVector"))
    turn = motion.orientation @ axis.rotation(motion.formulation.spin.value(t))
    return float(turn @ axis.skew @ (motion.invariants.S @ zeta) @ gravity)


def external_moment(body: RotorItems, t: float, configuration: exudyn.ConfigurationType) -> float:
    """Return the external moment about e, which the locked spin collects [N m]."""
    node, mbs, spin = body.nodes["rigid"], body.mbs, body.locks.spin
    acceleration = mbs.GetNodeOutput(node, _KINDS.Coordinates_tt, configuration)[spin]
    moment = body.layout.lock_mass[spin] * float(acceleration)
    if body.guide is not None:
        moment -= body.guide(t)[spin]
    if "spin" in body.constraints:
        moment += float(np.ravel(mbs.GetObjectOutput(body.constraints["spin"], _KINDS.Force))[0])
    elif body.constraints:
        share = body.locks.rows[0][:, spin]
        moment += float(share @ mbs.GetObjectOutput(body.constraints[LOCKS], _KINDS.Force))
    return moment


def add_function_sensor(
    body: RotorItems, function: Callable, options: Mapping[str, Any]
) -> exudyn.SensorIndex:
    """Add a sensor of what a user function returns."""
    settings = settings_of(body, options)
    return body.mbs.AddSensor(SensorUserFunction(sensorUserFunction=function, **settings))


def native_settings(
    body: RotorItems, output: exudyn.OutputVariableType, options: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the settings of a native sensor; Exudyn refuses unsuited outputs in Assemble."""
    checks.instance(output, "output", _KINDS)
    return {"outputVariableType": output} | settings_of(body, options)


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
