"""Rotors in scenes: other axis directions, without the marker body, several in one system."""

import exudyn as exu
import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.itemInterface import SensorMarker
from exudyn.utilities import InertiaSphere
from models import centered_disc
from point_rotors import ring_rotor
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    ConstantSpeed,
    Formulation,
    PrescribedMotion,
    SolidRotor,
    Support,
    add_rotor,
    add_supports,
    recommended_settings,
    select_modes,
)
from exudyn_rotor.theory.kernel import Kernel

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
    turned = SolidRotor.from_matrices(
        solid.mass,
        blocks @ (solid.stiffness @ blocks.T),
        solid.nodes @ rotation.T,
        rotation @ [0.0, 0.0, 1.0],
        interfaces={name: (i.nodes, i.weights) for name, i in solid.interfaces.items()},
    ).center_interfaces()
    return turned.reduce(blocks @ modes)


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

    Entries of all sizes count: which are negligible depends on the axes of the mesh.
    """
    mesh_to_space = placed @ options.get("mesh", UNIT).T
    options = {key: value for key, value in options.items() if key != "mesh"}
    body = add_rotor(
        mbs,
        reduced,
        name=name,
        rotation=mesh_to_space,
        gravity=placed @ [1.0, -9.81, 2.0],
        mass_damping=3.0,
        stiffness_damping=1e-6,
        negligible=0.0,
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
    "y in the mesh": (TO_Y, UNIT),
    "skew in the mesh": (SKEW, UNIT),
    "x in space": (UNIT, TO_X),
    "y in space": (UNIT, TO_Y),
    "skew in space": (UNIT, SKEW),
    "skew in both": (SKEW, SKEW @ TO_X),
}


@pytest.fixture(scope="module")
def turned(solid, modes):
    meshes = {"x": TO_X, "y": TO_Y, "skew": SKEW}
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
        assert abs(actual - expected).max() < 1e-9 * abs(expected).max()
    skew_plane = formulation == "in-plane" and "skew in" in direction and placed is not UNIT
    if skew_plane:  # the axial motion is the modes', though any other plane would serve
        travel = mbs.GetNodeOutput(body.nodes["rigid"], exu.OutputVariableType.Coordinates)[:3]
        assert abs(travel @ placed[:, 2]) < 1e-9 * np.linalg.norm(travel)
    assert body.formulation.section == {"free": "2.2", "in-plane": "2.3", "none": "2.4"}.get(
        formulation, "2.2"
    )


# ------------------------------------------------------------------ without the marker body

BARE = {
    "free": ({"initial_speed": 300.0, "initial_angle": 0.3}, UNIT),
    "free, moving": ({"initial_speed": 300.0, "initial_velocity": [0.1, 0.2, -0.1]}, SKEW),
    "in-plane": (
        {"translation": "in-plane", "initial_speed": 300.0, "initial_velocity": [0.1, 0.2, 0.0]},
        UNIT,
    ),
    "in-plane, skew": ({"translation": "in-plane", "initial_speed": 300.0}, SKEW),
    "none": ({"translation": "none", "initial_speed": 300.0}, UNIT),
    "none, skew": ({"translation": "none", "initial_speed": 300.0}, SKEW),
    "none, constant": ({"translation": "none", "spin": 300.0}, SKEW),
}


@pytest.mark.parametrize("case", BARE)
def test_without_the_marker_body_the_motion_is_the_same(reduced, case):
    options, rotation = BARE[case]
    results = []
    for marker_body in (True, False):
        mbs = exu.SystemContainer().AddSystem()
        form = Formulation(options.get("translation", "free"), options.get("spin", "free"))
        count = len(select_modes(reduced, form).labels)
        body = add_rotor(
            mbs,
            reduced,
            rotation=rotation,
            gravity=[1.0, -9.81, 2.0],
            marker_body=marker_body,
            modal_coordinates=1e-4 * np.arange(1, count + 1),
            modal_velocities=1e-2 * np.arange(count, 0, -1),
            **options,
        )
        mbs.Assemble()
        mbs.SolveDynamic(settings(60, 3e-3))
        q, q_t, _ = body.coordinates()
        directions = body.motion.free_directions
        split = directions.shape[1]
        results.append([directions @ q[:split], q[split:], directions @ q_t[:split], q_t[split:]])
    for expected, actual in zip(*results, strict=True):
        scale = max(abs(expected).max(), 1e-12)
        assert abs(actual - expected).max() < 1e-8 * scale


# ------------------------------------------------------------------ several bodies


def test_several_rotors_do_not_know_each_other(reduced):
    cases = {"a": ({"initial_speed": 300.0}, UNIT), "b": ({"spin": -200.0}, TO_X)}
    cases["c"] = ({"translation": "none", "initial_speed": 100.0}, SKEW)
    cases["d"] = ({"spin": PrescribedMotion.run_up(0.0, 100.0, 2e-3)}, TO_Y)
    alone = {}
    for name, (options, placed) in cases.items():
        mbs = exu.SystemContainer().AddSystem()
        _, sensors = add_scene(mbs, reduced, placed, options)
        alone[name] = run(mbs, sensors)

    mbs = exu.SystemContainer().AddSystem()
    ball = mbs.CreateRigidBody(inertia=InertiaSphere(2.0, 0.1), gravity=[0.0, 0.0, -9.81])
    together = {
        name: add_scene(mbs, reduced, placed, options, name)[1]
        for name, (options, placed) in cases.items()
    }
    result = run(mbs, [s for sensors in together.values() for s in sensors])
    for expected, actual in zip(alone.values(), np.split(result, len(cases)), strict=True):
        assert abs(actual - expected).max() < 1e-9 * abs(expected).max()
    fallen = mbs.GetObjectOutputBody(ball, exu.OutputVariableType.Displacement, [0, 0, 0])
    assert fallen[2] == pytest.approx(-0.5 * 9.81 * 3e-3**2, rel=1e-9)


# ------------------------------------------------------------------ reports


def test_report_says_what_was_added(reduced):
    mbs = exu.SystemContainer().AddSystem()
    report = add_rotor(
        mbs, reduced, name="fan", translation="in-plane", initial_speed=1.0, rotation=SKEW
    ).report()
    assert "rotor 'fan': Sect. 2.3, stiffening 'tilt'" in report
    assert "two in the plane of rotation" in report
    assert "7: translation along axis, tilt 1, tilt 2, mode 1" in report
    assert "locked         tilt a, tilt b" in report
    assert "Python user functions" in report
    bare = add_rotor(mbs, reduced, name="bare", spin=3.0, marker_body=False)
    assert bare.locked == ()
    assert "no Python call" in bare.report()


@pytest.mark.parametrize(
    ("options", "python", "locked"),
    [
        ({"spin": 300.0}, False, {"tilt a", "tilt b", "spin"}),
        ({"spin": 300.0, "locking": "constraints"}, False, {"tilt a", "tilt b", "spin"}),
        (
            {"spin": 300.0, "translation": "none"},
            False,
            {"x", "y", "z", "tilt a", "tilt b", "spin"},
        ),
        ({"initial_speed": 300.0}, True, {"tilt a", "tilt b"}),
        (
            {"translation": "in-plane", "initial_speed": 1.0},
            True,
            {"z", "tilt a", "tilt b"},
        ),
    ],
)
def test_python_is_called_only_where_the_report_says_so(
    reduced, monkeypatch, options, python, locked
):
    calls = []
    forces = Kernel.forces

    def counted(self, *arguments):
        calls.append(arguments)
        return forces(self, *arguments)

    monkeypatch.setattr(Kernel, "forces", counted)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, gravity=[0.0, -9.81, 0.0], **options)
    assert body.uses_python == python
    assert set(body.locked) == locked
    mbs.Assemble()
    mbs.SolveDynamic(settings(5, 1e-4))
    assert bool(calls) == python
    physics = mbs.GetObject(body.objects["physics"])
    assert all(bool(physics[f"{kind}UserFunction"]) == python for kind in ("force", "massMatrix"))


@pytest.mark.parametrize("angle", [0.0, 2.0])
def test_an_eccentric_rotor_starts_alike_with_and_without_translation(angle):
    """With the velocity Ω e × d of the centre of mass at d from the axis, to the order h²."""
    speed, spread = 100.0, []
    rotor = ring_rotor(0.1, 0.1, 2.0).add_point_mass([0.1, 0.0, 0.0], 0.1)
    reduced = rotor.with_interface("all", range(10)).reduce(0)
    turned = np.cross([0.0, 0.0, speed], rotor.axis.rotation(angle) @ rotor.center_of_mass)
    for step in (2e-4, 1e-4):
        found = []
        for given in ({"initial_velocity": turned}, {"translation": "none"}):
            mbs = exu.SystemContainer().AddSystem()
            body = add_rotor(mbs, reduced, spin=ConstantSpeed(speed, angle), **given)
            add_supports(body, Support("all", 1e5, 20.0, tilt_stiffness=1e3))
            sensor = body.add_interface_sensor("all", exu.OutputVariableType.Displacement)
            mbs.Assemble()
            settings = recommended_settings(end_time=0.02, step=step)
            settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
            settings.solution.sensors.writePeriod = 2e-4
            mbs.SolveDynamic(settings)
            found.append(mbs.GetSensorStoredData(sensor)[:, 1:])
        spread.append(np.abs(found[0] - found[1]).max() / np.abs(found[1]).max())
    assert spread[0] < 0.02
    assert spread[1] < 0.3 * spread[0]
