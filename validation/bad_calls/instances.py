"""Instances of public classes: their methods are called, and their arguments construct them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from exudyn import SystemContainer

import exudyn_rotor as er
from validation.bad_calls.world import World

INSTANCES: dict[str, Callable[[World], Any]] = {
    "BaseAcceleration": lambda w: er.BaseAcceleration([1.0, 0.0, 0.0]),
    "BaseRecord": lambda w: w.record,
    "BaseResponse": lambda w: er.base_response(w.reduced, w.record, supports=w.supports),
    "Campbell": lambda w: w.campbell,
    "CardanJoint": lambda w: er.CardanJoint(joint_angle=0.3, stiffness=1e4),
    "ConstantSpeed": lambda w: er.ConstantSpeed(10.0, 0.1),
    "CriticalSpeedMap": lambda w: w.critical_map,
    "CriticalSpeeds": lambda w: w.critical,
    "FlexibleCoupling": lambda w: er.FlexibleCoupling(torsion=1e4, lateral=[1e6, 2e6]),
    "Formulation": lambda w: er.Formulation("none", 10.0),
    "DirectCurrentMotor": lambda w: er.DirectCurrentMotor(stall_torque=5.0, no_load_speed=90.0),
    "Drag": lambda w: er.Drag(linear=0.1),
    "GearMesh": lambda w: w.gears,
    "Foundation": lambda w: w.foundation,
    "HarmonicForce": lambda w: er.HarmonicForce("left", [1.0, 0.0, 0.0]),
    "Link": lambda w: w.train.links[0],
    "RotorTrain": lambda w: w.train,
    "HarmonicResponse": lambda w: w.harmonic,
    "InductionMotor": lambda w: er.InductionMotor(
        breakdown_torque=5.0, breakdown_slip=0.2, synchronous_speed=90.0
    ),
    "Interface": lambda w: w.solid.interfaces["left"],
    "Invariants": lambda w: w.selection.invariants,
    "LimitedPower": lambda w: er.LimitedPower(power=9.0, stall_torque=5.0),
    "ModeBasis": lambda w: er.free_modes(w.solid, 2),
    "Motion": lambda w: w.motion,
    "Mount": lambda w: er.Mount("left", 1e6 * np.eye(3), 10.0 * np.eye(3)),
    "MotionShapes": lambda w: w.shapes,
    "ObjectFixedAxisFFRFreducedOrderInterface": lambda w: (
        er.ObjectFixedAxisFFRFreducedOrderInterface(w.fem, axis="z")
    ),
    "OilFilm": lambda w: w.film,
    "Pad": lambda w: er.Pad(0.2, 1.5, 1e-4),
    "PointMass": lambda w: w.solid.add_point_mass([0.0, 0.0, 0.1], 0.1).point_masses[0],
    "PrescribedMotion": lambda w: er.PrescribedMotion.run_up(0.0, 10.0, 1.0),
    "Prestress": lambda w: w.prestress,
    "Proposal": lambda w: w.proposal,
    "ReducedRotor": lambda w: w.reduced,
    "RigidDisc": lambda w: w.solid.add_disc(0.15, 1.0, (0.02, 0.02), 0.4).discs[0],
    "FullRotorBody": lambda w: w.full_body,
    "FullRotorBody.recorded": lambda w: w.full_recorded,
    "FullRotorBody.start_recording": lambda w: er.add_rotor(
        SystemContainer().AddSystem(), w.solid, spin=10.0, translation="none", stiffening="tilt"
    ),
    "RotorBody": lambda w: w.body,
    "RotorBody.start_recording": lambda w: er.add_rotor(SystemContainer().AddSystem(), w.reduced),
    "RunCheck": lambda w: w.run_check,
    "SceneFoundation": lambda w: er.add_foundation(SystemContainer().AddSystem(), w.foundation),
    "SeparationMargins": lambda w: w.separation,
    "SolidRotor": lambda w: w.solid,
    "Spectra": lambda w: w.spectra,
    "SpinAxis": lambda w: er.SpinAxis([0.0, 0.0, 1.0]),
    "Stability": lambda w: w.stability,
    "StabilityLevelOne": lambda w: w.level_one,
    "StabilityMap": lambda w: w.stability_map,
    "EnergyBalance": lambda w: er.energy_balance(w.recorded),
    "StabilityThresholds": lambda w: w.thresholds,
    "Stiffening": lambda w: er.Stiffening(np.eye(3), np.eye(3)),
    "StartState": lambda w: w.steady.state(),
    "SteadyState": lambda w: w.steady,
    "StressField": lambda w: w.stress,
    "StressHistory": lambda w: w.history,
    "AnnularSeal": lambda w: w.seal,
    "ClearanceStop": lambda w: w.stop,
    "JournalBearing": lambda w: w.film_bearing,
    "LinearActuator": lambda w: er.LinearActuator(80.0, 3e5),
    "MagneticBearing": lambda w: w.magnetic,
    "PIDController": lambda w: w.magnetic.controller,
    "RollingBearing": lambda w: w.rolling,
    "RollingBearingResponse": lambda w: w.rolls,
    "SaturatingActuator": lambda w: w.magnetic.actuator,
    "Sensitivity": lambda w: er.Sensitivity(("left, 1",), [10.0, 20.0], [[1.0 + 0j, 2j]], 0.0),
    "ShortJournalBearing": lambda w: w.journal,
    "SqueezeFilmDamper": lambda w: w.damper,
    "Support": lambda w: w.supports[0],
    "TiltingPadBearing": lambda w: w.tilting,
    "TorqueCurve": lambda w: er.TorqueCurve(([0.0, 90.0], [5.0, 0.0])),
    "Unbalance": lambda w: er.Unbalance("left", 1e-4),
    "UnbalanceResponse": lambda w: w.unbalance,
}
