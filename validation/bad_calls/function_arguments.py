"""Arguments of valid calls of public functions and classes.

Classes without an entry take those of their instance in :mod:`validation.bad_calls.instances`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from exudyn import SystemContainer

import exudyn_rotor as er
from validation.bad_calls.world import SPEEDS, World


def _rotor(world: World) -> dict[str, Any]:
    return {"target": world.reduced, "supports": world.supports}


OF_FUNCTIONS: dict[str, Callable[[World], dict[str, Any]]] = {
    "add_base_motion": lambda w: {
        "mbs": w.mbs,
        "record": w.record,
        "bodies": er.add_foundation(w.mbs, w.foundation),
        "rotation": np.eye(3),
    },
    "add_drive": lambda w: {
        "body": er.add_rotor(SystemContainer().AddSystem(), w.reduced),
        "drive": er.Drag(linear=0.1),
        "at": "left",
    },
    "add_foundation": lambda w: {
        "mbs": w.mbs,
        "foundation": w.foundation,
        "rotation": np.eye(3),
    },
    "add_rotor": lambda w: {
        "mbs": w.mbs,
        "rotor": w.reduced,
        "name": None,
        "modal_coordinates": np.zeros(4),
        "modal_velocities": np.zeros(4),
        "marker_offsets": {"left": [0.0, 0.0, 0.01]},
        "rotation": np.eye(3),
    },
    "add_supports": lambda w: {"body": w.body, "supports": w.supports},
    "anticipated_cross_coupling": lambda w: {
        "power": 1e6,
        "speed": 300.0,
        "diameter": 0.4,
        "width": 0.02,
    },
    "base_response": lambda w: {
        "target": w.reduced,
        "record": w.record,
        "supports": w.supports,
        "at": ["left"],
        "end_time": 0.04,
    },
    "bearing_loads": lambda w: {
        "rotor": w.reduced,
        "bearings": ["left", "right"],
        "gravity": [0.0, -9.81, 0.0],
    },
    "bearing_masses": lambda w: {"rotor": w.reduced, "bearings": ["left", "right"]},
    "campbell": lambda w: {**_rotor(w), "speeds": SPEEDS[:2]},
    "check_run": lambda w: {
        "body": w.body,
        "reduced": w.reduced,
        "solid": w.solid,
        "nodes": [0],
        "limits": {"tilt": 0.1},
        "warn": False,
    },
    "connect_rotors": lambda w: {
        "connection": w.gears,
        "body": er.add_rotor(SystemContainer().AddSystem(), w.reduced),
        "at": "left",
        "other": er.ConstantSpeed(10.0),
    },
    "craig_bampton_modes": lambda w: {"rotor": w.solid, "count": 1, "interfaces": ["left"]},
    "critical_speed_map": lambda w: {
        "target": w.reduced,
        "interfaces": ["left", "right"],
        "stiffnesses": [1e6, 2e6],
        "supports": w.axial,
    },
    "critical_speeds": lambda w: _rotor(w),
    "energy_balance": lambda w: {"body": w.recorded},
    "free_modes": lambda w: {"rotor": w.solid, "count": 2},
    "grooved_pads": lambda w: {"clearance": 1e-4, "grooves": [0.5, 3.6], "groove_width": 0.3},
    "harmonic_response": lambda w: {
        **_rotor(w),
        "frequencies": SPEEDS[:2],
        "loads": [er.HarmonicForce("left", [1.0, 0.0, 0.0])],
        "at": ["left"],
    },
    "keep_modes": lambda w: {"reduced": w.reduced, "indices": [0]},
    "linear_model": lambda w: _rotor(w),
    "load_result": lambda w: {"path": w.stored(w.campbell)},
    "MainSystemCreateFixedAxisFFRFReducedOrderObject": lambda w: {
        "mbs": w.mbs,
        "name": None,
        "femInterface": w.fem,
        "axis": "z",
        "superElementRigidMarkersOffsets": np.zeros((2, 3)),
    },
    "mode_shapes": lambda w: {**_rotor(w), "speed": 10.0},
    "Motion": lambda w: {
        "invariants": w.selection.invariants,
        "formulation": er.Formulation("none", 10.0),
        "second_order": w.second_order,
        "orientation": np.eye(3),
        "gravity": [0.0, 0.0, -9.81],
    },
    "ObjectFixedAxisFFRFreducedOrderInterface": lambda w: {"femInterface": w.fem, "axis": "z"},
    "permissible_unbalance": lambda w: {"grade": 2.5, "mass": 10.0, "speed": 300.0},
    "plot_orbit": lambda w: {"motion": np.zeros((3, 2)), "angle": [0.0, 1.0, 2.0]},
    "plot_pressure": lambda w: {"state": w.film.equilibrium(9.0, [-0.1, 0.0])},
    "propose": lambda w: {**_rotor(w), "speeds": (0.0, 40.0), "load_frequencies": (0.0, 10.0)},
    "recommended_settings": lambda w: {"end_time": 1.0, "step": 1e-3},
    "report": lambda w: {
        "path": w.folder / "report.html",
        "contents": [w.reduced, w.supports, w.campbell],
        "raised": ["a warning"],
    },
    "response_shapes": lambda w: {
        **_rotor(w),
        "speeds": SPEEDS[:2],
        "unbalances": [er.Unbalance("left", 1e-4)],
    },
    "rolling_bearing_response": lambda w: {
        "target": w.reduced,
        "speeds": SPEEDS[:2],
        "unbalances": [er.Unbalance("left", 1e-6)],
        "supports": [w.rolling, *w.supports],
        "gravity": [0.0, -9.81, 0.0],
        "loads": [er.HarmonicForce("left", [0.0, -100.0])],
        "at": ["left"],
    },
    "select_modes": lambda w: {"reduced": w.reduced, "formulation": er.Formulation()},
    "sensitivity": lambda w: {
        "rotor": w.reduced,
        "frequencies": [10.0, 90.0],
        "supports": [w.magnetic, w.magnetic_right, *w.supports],
    },
    "separation_margins": lambda w: {
        "response": w.unbalance,
        "operating_range": (500.0, 800.0),
        "places": ["left"],
    },
    "spectra": lambda w: {
        "time": 1e-3 * np.arange(40),
        "motion": np.ones((40, 2)),
        "speed": 10.0,
        "length": 0.02,
    },
    "spinning_modes": lambda w: {"rotor": w.stressed, "count": 1, "speeds": (5.0, 10.0)},
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
    "unstable_ranges": lambda w: {**_rotor(w), "speeds": SPEEDS[:2]},
    "use_mean_axis_modes": lambda w: {"fem": w.fem},
}
