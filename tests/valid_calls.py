"""Arguments of valid calls of public functions, classes and methods, and small objects for them.

A call takes its required arguments from `CALLS`, else by the names of its parameters from `USUAL`
and `SHARED`.
"""

from dataclasses import replace

import exudyn
import numpy as np
import pytest
from exudyn.FEM import FEMinterface
from models import STEEL
from netgen.occ import Box, OCCGeometry, Pnt, Z
from ngsolve import Mesh
from ross_models import example

import exudyn_rotor as er
from exudyn_rotor.theory.stiffening import stiffening

# ------------------------------------------------------------------ small objects


def _bar():
    bar = Box(Pnt(-0.02, -0.03, 0), Pnt(0.02, 0.03, 0.3))
    bar.mat("steel")
    bar.faces.Min(Z).name, bar.faces.Max(Z).name = "left", "right"
    return Mesh(OCCGeometry(bar).GenerateMesh(maxh=0.15))


def _cube():
    meshio = pytest.importorskip("meshio")
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    points = [[x, y, z + h] for h in (0, 1) for x, y, z in corners]
    cells = [("hexahedron", [list(range(8))])]
    return meshio.Mesh(points, cells, point_sets={"low": [0, 1, 2, 3]})


def _point():
    mass = er.SolidRotor.from_matrices(20.0 * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], "z")
    return mass.with_interface("left", [0]).reduce(0)


_FILM = er.ShortJournalBearing(
    interface="left", radius=0.03, length=0.02, clearance=6e-5, viscosity=0.02, load=[0.0, -196.2]
)


def _fem(w):
    fem = FEMinterface()
    named = {"materials": {"steel": STEEL}, "boundaryNamesList": ["left", "right"]}
    fem.ImportMeshFromNGsolve(w.mesh, **named, meshOrder=1)
    fem.ComputeEigenmodes(2, 6)
    return fem


def _scene(rotor, steps=0, assembled=True, **options):
    """Return a rotor in a scene of its own, after some recorded steps."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, **options)
    if steps:
        body.start_recording()
    elif isinstance(body, er.RotorBody):
        er.add_supports(body, [er.Support("left", 1e6 * np.eye(3), 9.0), er.Support("right", 1e6)])
    if assembled:
        mbs.Assemble()
    if steps:
        settings = er.recommended_settings(steps * 1e-5, 1e-5, body=body)
        settings.solution.sensors.writePeriod = 1e-5
        settings.solution.file.write = False
        settings.timeIntegration.verboseMode = 0
        mbs.SolveDynamic(settings)
    return body


FIXED = {"spin": 10.0, "translation": "none"}
FULL = {**FIXED, "stiffening": "tilt"}
PEAK = np.linspace(10.0, 2000.0, 9)
DOWN = [0.0, -9.81, 0.0]
ENDS = ["left", "right"]
TWIN = "ObjectFixedAxisFFRFreducedOrderInterface"
PADS = er.OilFilm(
    0.05, 0.05, 0.1, er.grooved_pads(1e-4, [0.0, np.pi], 0.5, preload=0.3), nodes=24, axial_nodes=0
)


def _build(w):
    return lambda stiffness, speed: (
        er.linear_model(w.ReducedRotor, supports=[*w.supports, er.Support("left", stiffness)]),
        speed,
    )


# shared objects by name, instances by the name of their class; other classes are called as below
MADE = {
    "mesh": lambda w: _bar(),
    "fem": _fem,
    "stressed": lambda w: w.SolidRotor.with_prestress(w.Prestress),
    "selection": lambda w: er.select_modes(w.ReducedRotor, w.Formulation),
    "coordinates": lambda w: 1e-6 * np.ones((4, len(w.selection.labels))),
    "supports": lambda w: [
        er.Support("left", 1e6 * np.eye(3), 100.0),
        er.Support("right", 1e6, 100.0),
    ],
    "turning": lambda w: [er.Support(end, damping=99.0, frame="rotor") for end in ENDS],
    "magnets": lambda w: [replace(w.MagneticBearing, interface=end, sensor=end) for end in ENDS],
    "mbs": lambda w: exudyn.SystemContainer().AddSystem(),
    "free_body": lambda w: _scene(w.ReducedRotor, assembled=False),
    "second_body": lambda w: er.add_rotor(
        w.free_body.mbs,
        w.ReducedRotor,
        name="second",
        position=[w.GearMesh.center_distance, 0.0, 0.0],
    ),
    "recorded": lambda w: _scene(w.ReducedRotor, steps=4),
    "full_recorded": lambda w: _scene(w.SolidRotor, steps=4, **FULL),
    "build": _build,
    TWIN: lambda w: er.ObjectFixedAxisFFRFreducedOrderInterface(w.fem, axis="z"),
    "twin": lambda w: er.ObjectFixedAxisFFRFreducedOrderInterface(w.fem, axis="z"),
    "FullRotorBody": lambda w: _scene(w.SolidRotor, **FULL),
    "Interface": lambda w: w.SolidRotor.interfaces["left"],
    "Invariants": lambda w: w.selection.invariants,
    "Motion": lambda w: w.RotorBody.motion,
    "PointMass": lambda w: w.SolidRotor.add_point_mass([0.0, 0.0, 0.1], 0.1).point_masses[0],
    "ReducedRotor": lambda w: w.SolidRotor.reduce(2, stress=True, prestress=w.Prestress),
    "RigidDisc": lambda w: w.SolidRotor.add_disc(0.15, 1.0, (0.02, 0.02), 0.4).discs[0],
    "RotorBody": lambda w: _scene(w.ReducedRotor, **FIXED),
}
# instances that a valid call returns
RETURNED = {
    **{"BaseResponse": "base_response", "Campbell": "campbell", "ModeBasis": "free_modes"},
    **{"CriticalSpeedMap": "critical_speed_map", "CriticalSpeeds": "critical_speeds"},
    **{"Foundation": "Foundation.from_modes"},
    **{"HarmonicResponse": "harmonic_response", "MotionShapes": "mode_shapes"},
    **{"PrescribedMotion": "PrescribedMotion.run_up", "Prestress": "SolidRotor.prestress"},
    **{"PeriodicResponse": "periodic_response"},
    **{"Proposal": "propose"},
    **{"RunCheck": "check_run", "SceneFoundation": "add_foundation", "Sensitivity": "sensitivity"},
    **{"SeparationMargins": "separation_margins", "SolidRotor": "SolidRotor.from_ngsolve"},
    **{"Spectra": "spectra", "Stability": "stability", "StabilityLevelOne": "stability_level_one"},
    **{"StabilityMap": "stability_map", "StabilityThresholds": "stability_threshold"},
    **{"StartState": "SteadyState.state", "SteadyState": "steady_state"},
    **{"StaticResponse": "static_response"},
    **{"StressField": "StressField.of", "StressHistory": "stress_history"},
    **{"UnbalanceResponse": "unbalance_response"},
}
SCENES = ("mbs", "free_body", "second_body", "RotorBody", "FullRotorBody", "SceneFoundation")

# ------------------------------------------------------------------ valid calls

# what most required parameters take, by their names; classes stand for their instances in MADE
USUAL = {
    **{"angle": 0.1, "clearance": 1e-4, "count": 1, "current": 0.1, "displacement": [1e-5, 0.0]},
    **{"duration": 1.0, "end_speed": 9.0, "force": 100.0, "frequency": 10.0, "gain": 2e4},
    **{"grade": 2.5, "indices": [0], "interface": "left", "interfaces": ENDS, "length": 0.03},
    **{"mass": 5.0, "motion": np.full(12, 1e-5), "name": "left", "node": 0, "node_count": 1000},
    **{"offset": 0.0, "order": 1, "place": "left", "point": [0.0, 0.0, 0.0], "power": 1e6},
    **{"radius": 0.05, "rate": np.full(12, 1e-3), "rotation": np.eye(3), "speed": 100.0},
    **{"speeds": [10.0, 20.0], "start_speed": 0.0, "stiffness": 1e6, "t": 0.0, "value": 10.0},
    **{"velocity": [0.0, 1e-3], "viscosity": 0.1, "where": [0, 1, 2, 3], "other": "right"},
    **{"at": "left", "axis": "z", "output": exudyn.OutputVariableType.Displacement},
    **{"x": [1e6, 2e6], "y": [10.0, 20.0], "frequencies": [10.0, 20.0], "width": 0.02},
    **{"load": [0.0, -500.0], "bearings": ENDS, "index": 0, "time": 0.015, "family": "lateral"},
    **{"position": [0.0, 0.0, 0.1], "points": np.zeros((4, 3)), "diameter": 0.4, "origin": DOWN},
}
SHARED = {
    **{"mbs": "mbs", "mesh": "mesh", "fem": "fem", "femInterface": "fem", "build": "build"},
    **{"rotor": "ReducedRotor", "target": "ReducedRotor", "reduced": "ReducedRotor"},
    **{"body": "RotorBody", "selection": "selection", "prestress": "Prestress"},
    **{"foundation": "Foundation", "record": "BaseRecord", "formulation": "Formulation"},
    **{"invariants": "Invariants", "state": "StartState", "film": "OilFilm", "solid": "SolidRotor"},
    **{"response": "UnbalanceResponse", "field": "StressField", "supports": "supports"},
}


# what the tables above do not say
CALLS = {
    "AnnularSeal": {"radius": 0.1, "pressure_drop": 1e6, "density": 1000.0, "viscosity": 1e-3},
    "BaseAcceleration": {"acceleration": [1.0, 0.0, 0.0]},
    "BaseRecord": {"times": [0.0, 0.01, 0.02, 0.03], "accelerations": np.eye(4)[:, :3]},
    "BaseRecord.from_csv": lambda w: {"path": w.table, "unit": "g"},
    "BaseRecord.integrals": {"times": [0.0, 0.02]},
    "BaseResponse.displacement": {"place": "left", "other": "left"},
    "ClearanceStop": {"stiffness": 1e7},
    "DirectCurrentMotor": {"stall_torque": 5.0, "no_load_speed": 90.0},
    "Drag": {"linear": 0.1},
    "FlexibleCoupling": {"torsion": 1e4, "lateral": [1e6, 2e6]},
    "Formulation": {"translation": "none", "spin": 10.0},
    "Foundation.from_modes": {
        "frequencies": [300.0, 500.0],
        "damping_ratios": [0.02, 0.03],
        "points": {"left": np.ones((6, 2)), "right": np.ones((6, 2)) - np.eye(6)[:, :2]},
        "masses": [1.0, 2.0],
        "participation": np.ones((3, 2)),
        "places": {"left": [0.0, 0.0, 0.0], "right": [0.0, 0.0, 0.3]},
    },
    TWIN: lambda w: {"femInterface": w.fem, "axis": "z"},
    "Foundation.from_solid": lambda w: {
        "solid": w.SolidRotor.clamped(["left"]),
        "points": {"right": [0.0, 0.0, 0.3]},
        "mounts": [er.Mount("right", 1e6)],
        "modes": 1,
    },
    "Foundation.motion": {"place": [0.0, 0.0, 0.0]},
    "Foundation.rigid": {
        "mass": 20.0,
        "inertia": [2.0, 2.0, 1.0],
        "center": [0.0, -0.2, 0.1],
        "mounts": [er.Mount([x, -0.3, z], 1e6) for x in (-0.1, 0.1) for z in (0.0, 0.3)],
        "points": {"left": [0.0, 0.0, 0.0], "right": [0.0, 0.0, 0.3]},
    },
    "Foundation.with_damping_ratio": {"ratio": 0.02},
    "FullRotorBody.recorded": lambda w: {"self": w.full_recorded},
    "FullRotorBody.start_recording": lambda w: {
        "self": _scene(w.SolidRotor, assembled=False, **FULL),
    },
    "GearMesh": {"radii": [0.05, 0.1], "stiffness": 1e8, "teeth": [20, 40], "variation": [0.1]},
    "HarmonicForce": {"force": [1.0, 0.0, 0.0]},
    "InductionMotor": {"breakdown_torque": 5.0, "breakdown_slip": 0.2, "synchronous_speed": 90.0},
    "Invariants.in_basis": lambda w: {"T": np.eye(w.Invariants.size)},
    "Invariants.of": lambda w: {
        "nodes": w.SolidRotor.nodes,
        "mass": w.SolidRotor.mass,
        "stiffness": w.SolidRotor.stiffness,
        "damping": None,
        "basis": np.eye(w.SolidRotor.nodes.size)[:, :4],
        "direction": np.array([0.0, 0.0, 1.0]),
    },
    "JournalBearing.table": {"speeds": [50.0, 100.0]},
    "JournalBearing": lambda w: {"film": w.OilFilm, "load": [0.0, -500.0]},
    "LinearActuator": {"force_current": 80.0, "negative_stiffness": 3e5},
    "Link": {"first": "first:left", "second": "second:left", "connection": er.Support("left", 1e6)},
    "MagneticBearing": lambda w: {
        "actuator": w.SaturatingActuator,
        "controller": w.PIDController,
        "load": [0.0, -500.0],
    },
    "MainSystemCreateFixedAxisFFRFReducedOrderObject": {"axis": "z"},
    "Motion": lambda w: {"second_order": stiffening(w.Invariants, "tilt"), "gravity": DOWN},
    "Motion.body_forces": {"acceleration": DOWN},
    "Motion.drive_torque": lambda w: {"zeta_tt": np.zeros(w.Motion.size)},
    "MotionShapes.animate": lambda w: {"path": w.folder / "shape.gif"},
    "Mount": {"stiffness": 1e6 * np.eye(3)},
    "OilFilm": {
        "length": 0.05,
        "viscosity": 0.02,
        "pads": er.grooved_pads(1e-4, [0.5, 3.6], 0.3),
        "nodes": 24,
    },
    "OilFilm.equilibrium": {"speed": 9.0, "load": [-0.1, 0.0]},
    "PIDController": {
        "proportional": 2e3,
        "derivative": 0.5,
        "filter_frequency": 2e4,
        "amplifier_frequency": 1e4,
    },
    "Pad": {"start": 0.2, "arc": 1.5},
    "RollingBearing": {
        "count": 8,
        "pitch_radius": 0.0326,
        "element_radius": 0.006,
        "stiffness": 7e9,
        "load": [0.0, -500.0],
    },
    "PeriodicResponse.displacement": {"point": 0, "time": [0.0, 0.1]},
    "PeriodicResponse.orbit": {"point": 0},
    "PeriodicResponse.state": {"point": 0},
    "RotorBody.start_recording": lambda w: {"self": w.free_body},
    "RotorTrain": lambda w: {
        "rotors": {"first": w.ReducedRotor, "second": w.ReducedRotor},
        "ratios": {"first": 1.0, "second": -1.0},
        "supports": {"first": w.supports},
        "links": [w.Link],
    },
    "RotorTrain.relative_to": {"rotor": "second"},
    "SaturatingActuator": {
        "constant": 1e-3,
        "bias_current": 2.0,
        "gap": 4e-3,
        "current_limit": 6.0,
    },
    "ShortJournalBearing": {"load": [0.0, -500.0]},
    "from_ross": lambda w: {"rotor": example()},
    "rotor_example": lambda w: {"masses": (1.0, 3.0)},
    "SolidRotor.add_disc": {"position": 0.15, "mass": 1.0, "inertia": [0.02, 0.02], "width": 0.4},
    "SolidRotor.clamped": {"names": ["left"]},
    "SolidRotor.from_matrices": lambda w: {
        "mass": w.SolidRotor.mass,
        "stiffness": w.SolidRotor.stiffness,
        "nodes": w.SolidRotor.nodes,
        "interfaces": {"left": [0, 1, 2, 3]},
    },
    "SolidRotor.from_mesh": lambda w: {
        "mesh": _cube(),
        "materials": STEEL,
        "interfaces": ["low"],
        "leave_out": ["S4"],
    },
    "SolidRotor.from_ngsolve": {"materials": {"steel": STEEL}, "order": 1},
    "SolidRotor.interface_at": {"name": "seat", "position": 0.15, "width": 0.4},
    "SolidRotor.prestress": {},
    "SolidRotor.reduce": {"modes": 2},
    "SolidRotor.with_interface": {"name": "middle", "nodes": [0, 1, 2, 3], "weights": [1.0] * 4},
    "SolidRotor.with_solver": {"solver": "direct"},
    "SpinAxis": {"direction": [0.0, 0.0, 1.0], "point": [0.0, 0.0, 0.0]},
    "SqueezeFilmDamper": {"clearance": 1e-3, "viscosity": 0.01, "centring_stiffness": 5e6},
    "Stiffening": {"K2": np.eye(3), "B": np.eye(3)},
    "StressField.at": lambda w: {"modal_coordinates": w.coordinates[0]},
    "StressField.history": lambda w: {
        "modal_coordinates": w.coordinates,
        "speed": np.full(4, 10.0),
        "nodes": np.arange(3),
    },
    "StressField.plot": lambda w: {"modal_coordinates": w.coordinates[0]},
    "Support": {"stiffness": 1e6 * np.eye(3), "damping": 100.0},
    "FloatingRingBearing": {"inner": _FILM, "outer": _FILM},
    "SeriesSupport": {"inner": er.Support("left", 1e6), "outer": er.Support("left", 1e6)},
    "Support.from_columns": {"source": {"speed": [0.0, 9e3], "kzz": [1e6, 2e6]}},
    "Support.from_table": {
        "speeds": [0.0, 9e3],
        "frequencies": [0.0, 1e3],
        "stiffness": 1e6 * np.ones((2, 2, 2, 2)),
    },
    "TiltingPadBearing": {"film": PADS, "load": [0.0, -500.0], "pad_inertia": 1e-5},
    "TorqueCurve": {"curve": ([0.0, 90.0], [5.0, 0.0])},
    "TorqueCurve.torque": {"speed": 10.0},
    "Unbalance": {"amount": 1e-4},
    "add_base_motion": lambda w: {"bodies": w.SceneFoundation},
    "add_drive": lambda w: {"body": w.free_body, "drive": w.Drag},
    "add_rotor": lambda w: {"modal_coordinates": np.zeros(4), "rotation": np.eye(3)},
    "bearing_loads": {"gravity": DOWN},
    "connect_rotors": lambda w: {
        "connection": w.GearMesh,
        "body": w.free_body,
        "other": w.second_body,
        "other_at": "left",
    },
    "base_response": {"at": ["left"], "end_time": 0.04},
    "check_run": {"warn": False},
    "craig_bampton_modes": lambda w: {"rotor": w.SolidRotor, "interfaces": ["left"]},
    "critical_speed_map": {"stiffnesses": [1e6, 2e6]},
    "free_modes": lambda w: {"rotor": w.SolidRotor, "count": 2},
    "grooved_pads": {"grooves": [0.5, 3.6], "groove_width": 0.3},
    "harmonic_response": lambda w: {"frequencies": PEAK, "loads": [w.HarmonicForce]},
    "load_result": lambda w: {"path": w.stored("Spectra")},
    "plot_orbit": {"motion": np.zeros((3, 2)), "angle": [0.0, 1.0, 2.0]},
    "plot_pressure": lambda w: {"state": w.OilFilm.equilibrium(9.0, [-0.1, 0.0])},
    "propose": {"speeds": (0.0, 40.0)},
    "recommended_settings": {"end_time": 1.0, "step": 1e-3},
    "report": lambda w: {"path": w.folder / "report.html", "contents": {"Rotor": w.ReducedRotor}},
    "response_shapes": lambda w: {"unbalances": [w.Unbalance]},
    "limit_cycles": lambda w: {
        "target": _point(),
        "speeds": [1150.0],
        "onset": er.stability_threshold(_point(), 100.0, 2000.0, supports=_FILM),
        "supports": _FILM,
        "gravity": DOWN,
        "at": "left",
    },
    "periodic_response": {
        "values": [10.0, 20.0],
        "supports": [
            er.SqueezeFilmDamper(
                interface=end,
                radius=0.06,
                length=0.02,
                clearance=1e-4,
                viscosity=0.01,
                centring_stiffness=1e6,
            )
            for end in ENDS
        ],
    },
    "sensitivity": lambda w: {"supports": [*w.magnets, *w.supports]},
    "separation_margins": {"operating_range": (500.0, 800.0)},
    "spectra": {"time": 1e-3 * np.arange(40), "motion": np.ones((40, 2)), "length": 0.02},
    "static_response": {"loads": {"left": [1.0, 2.0, 0.0]}, "gravity": DOWN},
    "stability_level_one": {"cross_coupling": 1e4},
    "stability_threshold": lambda w: {
        "low": 10.0,
        "high": 2000.0,
        "supports": [*w.supports, *w.turning],
    },
    "standard_unbalances": {"mode": "conical", "at": ["left", "right"], "masses": [3.0, 2.0]},
    "stress_history": lambda w: {"time": [0.0, 0.1, 0.2, 0.3], "modal_coordinates": w.coordinates},
    "unbalance_response": lambda w: {"speeds": PEAK, "unbalances": [w.Unbalance]},
}
