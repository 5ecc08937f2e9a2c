"""Rotors in scenes: other axis directions, without the marker body, several in one system."""

import exudyn as exu
import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.itemInterface import SensorMarker
from models import centered_disc
from scipy.spatial.transform import Rotation

import exudyn_rotor as er

TO_X = Rotation.from_euler("y", np.pi / 2).as_matrix()
TO_Y = Rotation.from_euler("x", -np.pi / 2).as_matrix()
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
UNIT = np.eye(3)


@pytest.fixture(scope="module")
def solid():
    rotor = centered_disc(order=1)
    return rotor.add_point_mass([0.15, 0.0, 0.2], 0.1)


@pytest.fixture(scope="module")
def modes(solid):
    """Displacement columns of the lowest free modes, from the reduced shapes."""
    shapes = solid.reduce(4).shapes.matrix
    return shapes[:, 6:]


@pytest.fixture(scope="module")
def reduced(solid, modes):
    return turned_rotor(solid, modes, UNIT)


def turned_rotor(solid, modes, rotation):
    """Return the reduced rotor with its mesh turned."""
    blocks = sp.block_diag([rotation] * solid.node_count, format="csr")
    turned = er.SolidRotor.from_matrices(
        solid.mass,
        blocks @ (solid.stiffness @ blocks.T),
        solid.nodes @ rotation.T,
        rotation @ [0.0, 0.0, 1.0],
    )
    for name, interface in solid.interfaces.items():
        turned = turned.with_interface(name, interface.nodes, interface.weights)
    return turned.center_interfaces().reduce(blocks @ modes)


def settings(steps, end_time):
    result = exu.SimulationSettings()
    result.timeIntegration.numberOfSteps = steps
    result.timeIntegration.endTime = end_time
    result.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    result.timeIntegration.newton.relativeTolerance = 1e-10
    result.timeIntegration.newton.useModifiedNewton = False
    result.timeIntegration.verboseMode = 0
    result.solution.file.write = False
    result.solution.sensors.writePeriod = end_time / steps
    return result


def add_scene(mbs, reduced, placed, options, name="rotor"):
    """Add a rotor on two bearings with gravity and loads; `placed` turns rotor axes to space.

    Which couplings are negligible depends on the axes of the mesh: 2e-9 of the motion.
    """
    mesh_to_space = placed @ options.get("mesh", UNIT).T
    options = {key: value for key, value in options.items() if key != "mesh"}
    body = er.add_rotor(
        mbs,
        reduced,
        name=name,
        rotation=mesh_to_space,
        gravity=placed @ [1.0, -9.81, 2.0],
        mass_damping=3.0,
        stiffness_damping=1e-6,
        **options,
    )
    ground = mbs.CreateGround()
    for key, interface in reduced.interfaces.items():
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(key)],
            localPosition0=mesh_to_space @ interface.reference,
            stiffness=[4e6] * 3,
            damping=[500.0] * 3,
        )
    mbs.CreateTorque(itemNumber=body.marker("left"), loadVector=placed @ [10.0, 5.0, 20.0])
    mbs.CreateForce(itemNumber=body.marker("right"), loadVector=placed @ [50.0, 90.0, 70.0])
    sensors = [
        mbs.AddSensor(
            SensorMarker(markerNumber=body.marker(key), outputVariableType=kind, storeInternal=True)
        )
        for key in reduced.interfaces
        for kind in (
            exu.OutputVariableType.Displacement,
            exu.OutputVariableType.Velocity,
            exu.OutputVariableType.AngularVelocity,
        )
    ]
    return body, sensors


def run(mbs, sensors, placed=UNIT, steps=60, end_time=3e-3):
    """Return the sensors' vectors, turned back to rotor axes."""
    mbs.Assemble()
    mbs.SolveDynamic(settings(steps, end_time))
    return np.array([mbs.GetSensorStoredData(s)[:, 1:] @ placed for s in sensors])


# ------------------------------------------------------------------ directions

FORMULATIONS = {
    "free": {"initial_speed": 300.0},
    "in-plane": {"translation": "in-plane", "initial_speed": 300.0},
    "none": {"translation": "none", "initial_speed": 300.0},
    "constant": {"spin": 300.0},
}
DIRECTIONS = {
    "x in the mesh": (TO_X, UNIT),
    "skew in the mesh": (SKEW, UNIT),
    "y in space": (UNIT, TO_Y),
    "skew in both": (SKEW, SKEW @ TO_X),
}


@pytest.fixture(scope="module")
def turned(solid, modes):
    meshes = {"x": TO_X, "skew": SKEW}
    rotors = {key: turned_rotor(solid, modes, mesh) for key, mesh in meshes.items()}
    return lambda mesh: next((rotors[key] for key in meshes if meshes[key] is mesh), None)


@pytest.fixture(scope="module")
def references(reduced):
    results = {}
    for name, options in FORMULATIONS.items():
        mbs = exu.SystemContainer().AddSystem()
        _, sensors = add_scene(mbs, reduced, UNIT, options)
        results[name] = run(mbs, sensors)
    return results


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_directions_of_mesh_and_scene_change_nothing_else(
    reduced, turned, references, formulation, direction
):
    mesh, placed = DIRECTIONS[direction]
    mbs = exu.SystemContainer().AddSystem()
    body, sensors = add_scene(
        mbs, turned(mesh) or reduced, placed, FORMULATIONS[formulation] | {"mesh": mesh}
    )
    result = run(mbs, sensors, placed)
    for expected, actual in zip(references[formulation], result, strict=True):
        assert abs(actual - expected).max() < 1e-8 * abs(expected).max()
    # a plane that is skew in space is not held: the same motion with all three translations
    in_plane = "2.2" if direction == "skew in both" else "2.3"
    assert body.formulation.section == {"in-plane": in_plane, "none": "2.4"}.get(formulation, "2.2")


# ------------------------------------------------------------------ several bodies
