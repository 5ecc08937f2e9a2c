"""One valid call of every public function, constructor and method."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from typing import Any

import exudyn
import numpy as np
from exudyn import OutputVariableType, SystemContainer

import exudyn_rotor as er
from validation.bad_calls.world import SPEEDS, World, arguments

Call = tuple[Callable, dict[str, Any]]

# what has no arguments of its own to refuse
LEFT_OUT = {
    "AssumptionWarning": "a warning takes any text, as every exception of Python",
    "ConnectionWarning": "a warning takes any text, as every exception of Python",
    "LinearModel": "a protocol; linear_model makes what follows it",
    "Result": "the base of classes that are called",
}

# instances of public classes, on which methods are called and from which constructors are given
# their arguments
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

_ZEROS = np.zeros(3)


def _rotor(world: World) -> dict[str, Any]:
    return {"target": world.reduced, "supports": world.supports}


# arguments of valid calls; constructors without an entry take those of their instance
ARGUMENTS: dict[str, Callable[[World], dict[str, Any]]] = {
    "OilFilm.force": lambda w: {"displacement": [1e-5, 0.0], "velocity": [0.0, 1e-3], "speed": 9.0},
    "OilFilm.state": lambda w: {"displacement": [1e-5, 0.0], "velocity": [0.0, 1e-3], "speed": 9.0},
    "OilFilm.equilibrium": lambda w: {"speed": 9.0, "load": [-0.1, 0.0]},
    "grooved_pads": lambda w: {"clearance": 1e-4, "grooves": [0.5, 3.6], "groove_width": 0.3},
    "plot_pressure": lambda w: {"state": w.film.equilibrium(9.0, [-0.1, 0.0])},
    "MainSystemCreateFixedAxisFFRFReducedOrderObject": lambda w: {
        "mbs": w.mbs,
        "name": None,
        "femInterface": w.fem,
        "axis": "z",
        "superElementRigidMarkersOffsets": np.zeros((2, 3)),
    },
    "ObjectFixedAxisFFRFreducedOrderInterface": lambda w: {"femInterface": w.fem, "axis": "z"},
    "*.AddObjectFFRFreducedOrder": lambda w: {"mbs": w.mbs, "rotationMatrixRef": np.eye(3)},
    "*.AddObjectFFRFreducedOrderWithUserFunctions": lambda w: {
        "exu": exudyn,
        "mbs": w.mbs,
        "eulerParametersRef": [1.0, 0.0, 0.0, 0.0],
    },
    "*.SaveToFile": lambda w: {"fileName": w.folder / "interface.npz"},
    "*.LoadFromFile": lambda w: {"fileName": w.stored(w.reduced)},
    "add_rotor": lambda w: {
        "mbs": w.mbs,
        "rotor": w.reduced,
        "name": None,
        "modal_coordinates": np.zeros(4),
        "modal_velocities": np.zeros(4),
        "marker_offsets": {"left": [0.0, 0.0, 0.01]},
        "rotation": np.eye(3),
    },
    "anticipated_cross_coupling": lambda w: {
        "power": 1e6,
        "speed": 300.0,
        "diameter": 0.4,
        "width": 0.02,
    },
    "bearing_loads": lambda w: {
        "rotor": w.reduced,
        "bearings": ["left", "right"],
        "gravity": [0.0, -9.81, 0.0],
    },
    "bearing_masses": lambda w: {"rotor": w.reduced, "bearings": ["left", "right"]},
    "campbell": lambda w: {**_rotor(w), "speeds": SPEEDS[:2]},
    "energy_balance": lambda w: {"body": w.recorded},
    "check_run": lambda w: {
        "body": w.body,
        "reduced": w.reduced,
        "solid": w.solid,
        "nodes": [0],
        "limits": {"tilt": 0.1},
        "warn": False,
    },
    "craig_bampton_modes": lambda w: {"rotor": w.solid, "count": 1, "interfaces": ["left"]},
    "sensitivity": lambda w: {
        "rotor": w.reduced,
        "frequencies": [10.0, 90.0],
        "supports": [w.magnetic, w.magnetic_right, *w.supports],
    },
    "critical_speed_map": lambda w: {
        "target": w.reduced,
        "interfaces": ["left", "right"],
        "stiffnesses": [1e6, 2e6],
        "supports": w.axial,
    },
    "critical_speeds": lambda w: _rotor(w),
    "free_modes": lambda w: {"rotor": w.solid, "count": 2},
    "harmonic_response": lambda w: {
        **_rotor(w),
        "frequencies": SPEEDS[:2],
        "loads": [er.HarmonicForce("left", [1.0, 0.0, 0.0])],
        "at": ["left"],
    },
    "keep_modes": lambda w: {"reduced": w.reduced, "indices": [0]},
    "add_drive": lambda w: {
        "body": er.add_rotor(SystemContainer().AddSystem(), w.reduced),
        "drive": er.Drag(linear=0.1),
        "at": "left",
    },
    "BaseRecord.at": lambda w: {"time": 0.015},
    "BaseRecord.from_csv": lambda w: {"path": w.table, "unit": "g"},
    "BaseRecord.integrals": lambda w: {"times": np.array([0.0, 0.02])},
    "BaseRecord.turned": lambda w: {"rotation": np.eye(3)},
    "BaseResponse.between": lambda w: {"place": "left", "other": "right"},
    "BaseResponse.displacement": lambda w: {"place": "left"},
    "BaseResponse.peak": lambda w: {"place": "left", "other": "right"},
    "add_base_motion": lambda w: {
        "mbs": w.mbs,
        "record": w.record,
        "bodies": er.add_foundation(w.mbs, w.foundation),
        "rotation": np.eye(3),
    },
    "base_response": lambda w: {
        "target": w.reduced,
        "record": w.record,
        "supports": w.supports,
        "at": ["left"],
        "end_time": 0.04,
    },
    "Foundation.from_modes": lambda w: {
        "frequencies": [300.0, 500.0],
        "damping_ratios": [0.02, 0.03],
        "points": w.foundation.points,
        "masses": [1.0, 2.0],
        "places": w.foundation.places,
        "participation": w.foundation.participation,
    },
    "Foundation.from_solid": lambda w: {
        "solid": w.solid.clamped(["left"]),
        "points": {"right": [0.0, 0.0, 0.3]},
        "mounts": [er.Mount("right", 1e6)],
        "modes": 1,
    },
    "Foundation.motion": lambda w: {"name": "left", "place": [0.0, 0.0, 0.0]},
    "Foundation.rigid": lambda w: {
        "mass": 20.0,
        "inertia": [2.0, 2.0, 1.0],
        "center": [0.0, -0.2, 0.1],
        "mounts": [er.Mount([x, -0.3, z], 1e6) for x in (-0.1, 0.1) for z in (0.0, 0.3)],
        "points": w.foundation.places,
    },
    "Foundation.turned": lambda w: {"rotation": np.eye(3)},
    "Foundation.with_damping_ratio": lambda w: {"ratio": 0.02},
    "SceneFoundation.add_sensor": lambda w: {
        "name": "left",
        "output": OutputVariableType.Displacement,
    },
    "SceneFoundation.marker": lambda w: {"name": "left"},
    "add_foundation": lambda w: {
        "mbs": w.mbs,
        "foundation": w.foundation,
        "rotation": np.eye(3),
    },
    "connect_rotors": lambda w: {
        "connection": w.gears,
        "body": er.add_rotor(SystemContainer().AddSystem(), w.reduced),
        "at": "left",
        "other": er.ConstantSpeed(10.0),
    },
    "add_supports": lambda w: {"body": w.body, "supports": w.supports},
    "linear_model": lambda w: _rotor(w),
    "load_result": lambda w: {"path": w.stored(w.campbell)},
    "mode_shapes": lambda w: {**_rotor(w), "speed": 10.0},
    "plot_orbit": lambda w: {"motion": np.zeros((3, 2)), "angle": [0.0, 1.0, 2.0]},
    "response_shapes": lambda w: {
        **_rotor(w),
        "speeds": SPEEDS[:2],
        "unbalances": [er.Unbalance("left", 1e-4)],
    },
    "spectra": lambda w: {
        "time": 1e-3 * np.arange(40),
        "motion": np.ones((40, 2)),
        "speed": 10.0,
        "length": 0.02,
    },
    "permissible_unbalance": lambda w: {"grade": 2.5, "mass": 10.0, "speed": 300.0},
    "propose": lambda w: {**_rotor(w), "speeds": (0.0, 40.0), "load_frequencies": (0.0, 10.0)},
    "recommended_settings": lambda w: {"end_time": 1.0, "step": 1e-3},
    "report": lambda w: {
        "path": w.folder / "report.html",
        "contents": [w.reduced, w.supports, w.campbell],
        "raised": ["a warning"],
    },
    "select_modes": lambda w: {"reduced": w.reduced, "formulation": er.Formulation()},
    "separation_margins": lambda w: {
        "response": w.unbalance,
        "operating_range": (500.0, 800.0),
        "places": ["left"],
    },
    "spinning_modes": lambda w: {"rotor": w.stressed, "count": 1, "speeds": (5.0, 10.0)},
    "Stability.growth_of": lambda w: {"family": "lateral"},
    "stability": lambda w: {**_rotor(w), "speeds": SPEEDS[:2]},
    "stability_level_one": lambda w: {
        "target": w.reduced,
        "speed": 300.0,
        "cross_coupling": [1e4, 1e4],
        "at": ["left", "right"],
        "supports": w.supports,
    },
    "stability_map": lambda w: {"build": w.build, "x": [1e6, 2e6], "y": SPEEDS[:2]},
    "stability_threshold": lambda w: {
        "target": w.reduced,
        "low": 10.0,
        "high": 2000.0,
        "supports": w.isotropic,
    },
    "standard_unbalances": lambda w: {
        "mode": "conical",
        "at": ["left", "right"],
        "masses": [3.0, 2.0],
        "speed": 300.0,
    },
    "steady_state": lambda w: {"body": w.body},
    "stress_history": lambda w: {
        "field": w.stress,
        "time": [0.0, 0.1, 0.2, 0.3],
        "modal_coordinates": w.coordinates,
        "speed": 10.0,
        "nodes": [0, 1],
    },
    "unbalance_response": lambda w: {
        **_rotor(w),
        "speeds": SPEEDS[:2],
        "unbalances": [er.Unbalance("left", 1e-4)],
        "at": ["left"],
    },
    "use_mean_axis_modes": lambda w: {"fem": w.fem},
    "unstable_ranges": lambda w: {**_rotor(w), "speeds": SPEEDS[:2]},
    "Motion": lambda w: {
        "invariants": w.selection.invariants,
        "formulation": er.Formulation("none", 10.0),
        "second_order": w.second_order,
        "orientation": np.eye(3),
        "gravity": [0.0, 0.0, -9.81],
    },
    "Motion.body_forces": lambda w: {
        "t": 0.0,
        "q": np.zeros(w.motion.size),
        "acceleration": [0.0, -9.81, 0.0],
    },
    "Motion.drive_torque": lambda w: {**_state(w), "zeta_tt": np.zeros(w.motion.size)},
    "Motion.energy": lambda w: _state(w),
    "Motion.forces": lambda w: _state(w),
    "Motion.jacobian": lambda w: _state(w),
    "Motion.mass_matrix": lambda w: {"t": 0.0, "q": np.zeros(w.motion.size)},
    "Motion.momentum": lambda w: _state(w),
    "Motion.terms": lambda w: _state(w),
    "ConstantSpeed.acceleration": lambda w: {"t": 0.0},
    "ConstantSpeed.rate": lambda w: {"t": 0.0},
    "ConstantSpeed.value": lambda w: {"t": 0.0},
    "*.save": lambda w: {"path": w.folder / "saved.npz"},
    "*.to_csv": lambda w: {"path": w.folder / "table.csv"},
    "*.orbit": lambda w: {"value": 10.0},
    "*.plot_orbit": lambda w: {"value": 10.0},
    "*.rates": lambda w: {"order": 1},
    "Interface.centered_on": lambda w: {"point": _ZEROS},
    "Interface.mean_motion": lambda w: {"node_count": w.solid.node_count},
    "Invariants.in_basis": lambda w: {"T": np.eye(w.selection.invariants.size)},
    "Invariants.moved": lambda w: {"origin": _ZEROS},
    "Invariants.of": lambda w: {
        "nodes": w.solid.nodes,
        "mass": w.solid.mass,
        "stiffness": w.solid.stiffness,
        "damping": None,
        "basis": np.eye(w.solid.nodes.size)[:, :4],
        "direction": np.array([0.0, 0.0, 1.0]),
    },
    "PrescribedMotion.run_up": lambda w: {"start_speed": 0.0, "end_speed": 9.0, "duration": 1.0},
    "Prestress.from_matrix": lambda w: {
        "matrix": w.prestress.matrix,
        "nodes": w.solid.nodes,
        "euler": w.prestress.euler,
    },
    "Proposal.truncated": lambda w: {"reduced": w.reduced},
    "ReducedRotor.static_displacement": lambda w: {"speed": 10.0},
    "ReducedRotor.static_stress": lambda w: {"speed": 10.0},
    "FullRotorBody.add_interface_sensor": lambda w: _sensor(interface="left"),
    "FullRotorBody.add_marker": lambda w: {"where": [0, 1, 2, 3], "weights": [1.0, 1.0, 1.0, 2.0]},
    "FullRotorBody.add_node_sensor": lambda w: _sensor(node=0),
    "FullRotorBody.start_recording": lambda w: {"instants": [0.0, 1e-3]},
    "FullRotorBody.marker": lambda w: {"interface": "left"},
    "RotorBody.add_interface_sensor": lambda w: _sensor(interface="left"),
    "RotorBody.add_marker": lambda w: {"where": [0, 1, 2, 3], "weights": [1.0, 1.0, 1.0, 2.0]},
    "RotorBody.add_node_sensor": lambda w: _sensor(node=0),
    "RotorBody.start_from": lambda w: {"state": w.steady.state()},
    "HarmonicResponse.state": lambda w: {"frequency": w.harmonic.frequencies[0], "body": w.body},
    "UnbalanceResponse.state": lambda w: {"speed": w.unbalance.speeds[0], "body": w.body},
    "SteadyState.interface_motion": lambda w: {"interface": "left"},
    "SteadyState.state": lambda w: {},
    "RotorBody.marker": lambda w: {"interface": "left"},
    "RigidDisc.mass_matrix": lambda w: {"node_count": 1000},
    "RigidDisc.stiffness_matrix": lambda w: {"node_count": 1000},
    "SolidRotor.add_disc": lambda w: {
        "position": 0.15,
        "mass": 1.0,
        "inertia": [0.02, 0.02],
        "width": 0.4,
        "name": "disc",
    },
    "SolidRotor.add_point_mass": lambda w: {"position": [0.0, 0.0, 0.1], "mass": 0.1},
    "SolidRotor.clamped": lambda w: {"names": ["left"], "directions": ["axial"]},
    "SolidRotor.from_fem_interface": lambda w: {"fem": w.fem, "axis": "z"},
    "SolidRotor.from_matrices": lambda w: {
        "mass": w.solid.mass,
        "stiffness": w.solid.stiffness,
        "nodes": w.solid.nodes,
        "axis": "z",
        "damping": 1e-6 * w.solid.stiffness,
        "interfaces": {"left": [0, 1, 2, 3]},
        "triangles": w.solid.triangles,
    },
    "SolidRotor.from_ngsolve": lambda w: {
        "mesh": w.mesh,
        "materials": {"steel": w.steel},
        "axis": "z",
        "order": 1,
        "interfaces": ["left"],
    },
    "SolidRotor.interface_at": lambda w: {"name": "seat", "position": 0.15, "width": 0.4},
    "SolidRotor.nearest_node": lambda w: {"position": _ZEROS},
    "SolidRotor.prestress": lambda w: {"yield_stress": 1e9, "speed": 10.0},
    "SolidRotor.reduce": lambda w: {"modes": 2},
    "SolidRotor.with_damping": lambda w: {
        "stiffness": 1e-6,
        "loss": 0.01,
        "materials": {"steel": {"mass": 0.1, "loss": 0.02}},
    },
    "SolidRotor.with_solver": lambda w: {"solver": "direct"},
    "SolidRotor.with_interface": lambda w: {
        "name": "middle",
        "nodes": [0, 1, 2, 3],
        "weights": [1.0, 1.0, 1.0, 2.0],
    },
    "SolidRotor.with_prestress": lambda w: {"prestress": w.prestress},
    "SpinAxis.of": lambda w: {"axis": "z"},
    "SpinAxis.project": lambda w: {"points": np.zeros((4, 3))},
    "SpinAxis.radial": lambda w: {"points": np.zeros((4, 3))},
    "SpinAxis.rotation": lambda w: {"angle": 0.1},
    "SpinAxis.turned": lambda w: {"rotation": np.eye(3)},
    "StressField.at": lambda w: {
        "modal_coordinates": w.coordinates[0],
        "speed": 10.0,
        "nodes": np.arange(3),
    },
    "StressField.history": lambda w: {
        "modal_coordinates": w.coordinates,
        "speed": np.full(4, 10.0),
        "nodes": np.arange(3),
    },
    "StressField.of": lambda w: {"reduced": w.reduced, "selection": w.selection},
    "StressField.plot": lambda w: {"modal_coordinates": w.coordinates[0], "speed": 10.0},
    "StressField.to_vtk": lambda w: {
        "path": w.folder / "stress.vtu",
        "modal_coordinates": w.coordinates[0],
        "speed": 10.0,
    },
    "GearMesh.mesh_frequency": lambda w: {"speed": 100.0},
    "*.forces": lambda w: {"motion": np.full(12, 1e-5), "rate": np.full(12, 1e-3)},
    "*.transmitted": lambda w: {"motion": np.full(12, 1e-5), "rate": np.full(12, 1e-3)},
    "FlexibleCoupling.support": lambda w: {"interface": "left"},
    "CardanJoint.speed_ratio": lambda w: {"angle": 1.0},
    "*.torque": lambda w: {"speed": 10.0},
    "RotorTrain.relative_to": lambda w: {"rotor": "second"},
    "MotionShapes.animate": lambda w: {"path": w.folder / "shape.gif", "frames": 2},
    "MotionShapes.displacement": lambda w: {"index": 0, "time": 0.1},
    "MotionShapes.orbits": lambda w: {"index": 0},
    "MotionShapes.to_vtk": lambda w: {"path": w.folder / "shape.vtu"},
    "*.coefficients": lambda w: {"speed": 100.0, "load": [0.0, -500.0]},
    "*.eccentricity_ratio": lambda w: {"speed": 100.0, "load": [0.0, -500.0]},
    "*.equilibrium": lambda w: {"speed": 100.0, "load": [0.0, -500.0]},
    "*.power_loss": lambda w: {"speed": 100.0, "load": [0.0, -500.0]},
    "AnnularSeal.added_mass": lambda w: {"speed": 100.0},
    "AnnularSeal.axial_velocity": lambda w: {"speed": 100.0},
    "AnnularSeal.terms": lambda w: {"speed": 100.0},
    "*.current_for": lambda w: {"force": 100.0, "place": 1e-5},
    "*.place_under": lambda w: {"load": 100.0, "gain": 2e4, "offset": 0.0},
    "*.slopes": lambda w: {"current": 0.1, "place": 1e-5},
    "LinearActuator.force": lambda w: {"current": 0.1, "place": 1e-5},
    "SaturatingActuator.force": lambda w: {"current": 0.1, "place": 1e-5},
    "PIDController.transfer": lambda w: {"frequencies": [10.0, 20.0]},
    "*.tilts": lambda w: {"speed": 100.0, "load": [0.0, -500.0]},
    "*.with_load": lambda w: {"load": [0.0, -500.0]},
    "SqueezeFilmDamper.force": lambda w: {
        "displacement": [1e-5, 2e-5],
        "velocity": [0.0, 1e-3],
    },
    "ClearanceStop.force": lambda w: {
        "displacement": [1e-5, 2e-5],
        "velocity": [0.0, 1e-3],
        "speed": 100.0,
    },
    "RollingBearing.element_loads": lambda w: {"displacement": [1e-5, 2e-5]},
    "RollingBearing.passing_frequency": lambda w: {"speed": 100.0},
    "ShortJournalBearing.force": lambda w: {
        "displacement": [1e-5, 2e-5],
        "velocity": [0.0, 1e-3],
        "speed": 100.0,
    },
    "Support.check_range": lambda w: {"speed": 10.0},
    "Support.matrices": lambda w: {"speed": 10.0},
    "Support.terms": lambda w: {"speed": 10.0},
    "Support.parts": lambda w: {"speed": 10.0},
    "Unbalance.from_grade": lambda w: {"at": "left", "grade": 2.5, "mass": 5.0, "speed": 300.0},
}


def _sensor_options(*, storeInternal: bool = True, writeToFile: bool = False) -> None: ...


# whose keyword arguments ``**options`` are; beside them every call gets one that does not exist
OPTIONS: dict[str, Callable] = {
    "stability_threshold": er.stability,
    "unstable_ranges": er.stability,
    "*.add_drive_torque_sensor": _sensor_options,
    "*.add_energy_sensor": _sensor_options,
    "*.add_interface_sensor": _sensor_options,
    "*.add_node_sensor": _sensor_options,
    "*.add_spin_sensor": _sensor_options,
}


def _state(world: World) -> dict[str, Any]:
    return {"t": 0.0, "q": np.zeros(world.motion.size), "q_t": np.zeros(world.motion.size)}


def _sensor(**place: Any) -> dict[str, Any]:
    return {**place, "output": OutputVariableType.Displacement}


def public_calls() -> Iterator[str]:
    """Yield the names of all that can be called: 'function', 'Class', 'Class.method'."""
    for name in sorted(er.__all__):
        if name in LEFT_OUT:
            continue
        yield name
        owner = getattr(er, name)
        if inspect.isclass(owner):
            for method in sorted(dir(owner)):
                static = inspect.getattr_static(owner, method)
                if not method.startswith("_") and _is_method(static):
                    yield f"{name}.{method}"


def _is_method(static: object) -> bool:
    return isinstance(static, staticmethod | classmethod) or inspect.isfunction(static)


def function_of(name: str) -> Callable:
    """Return the function or class behind a name of :func:`public_calls`, as its signature says."""
    owner, _, method = name.partition(".")
    found = getattr(er, owner)
    return getattr(found, method) if method else found


def parameters(name: str) -> dict[str, inspect.Parameter]:
    """Return the parameters of a call without that of its own instance; options one by one."""
    found = dict(inspect.signature(function_of(name)).parameters)
    found.pop("self", None)
    rest = [p.name for p in found.values() if p.kind is p.VAR_KEYWORD]
    if rest:
        del found[rest[0]]
        source = OPTIONS.get(name) or OPTIONS[f"*.{name.partition('.')[2]}"]
        every = inspect.signature(source).parameters.values()
        found |= {p.name: p for p in every if p.kind is p.KEYWORD_ONLY}
        found["nonsense"] = inspect.Parameter("nonsense", inspect.Parameter.KEYWORD_ONLY)
    return found


def valid(name: str, world: World) -> Call:
    """Return a function and the arguments of a valid call, made anew.

    Raises
    ------
    KeyError
        If the call has no entry in the tables above.
    """
    owner, _, method = name.partition(".")
    if method == "load":
        return function_of(name), {"path": world.stored(INSTANCES[owner](world))}
    make = ARGUMENTS.get(name) or ARGUMENTS.get(f"*.{method}")
    function = getattr(er, owner)
    if method:
        static = inspect.getattr_static(function, method)
        bound = isinstance(static, staticmethod | classmethod)
        instance = INSTANCES.get(name, INSTANCES[owner])
        function = getattr(function if bound else instance(world), method)
        required = [
            p
            for p in inspect.signature(function).parameters.values()
            if p.default is p.empty and p.kind is not p.VAR_KEYWORD
        ]
        if make is None and required:
            raise KeyError(f"{name}: no arguments of a valid call in the table")
        return function, make(world) if make else {}
    if make is None:
        return function, arguments(INSTANCES[name](world))
    return function, make(world)
