"""Full bodies in scenes: all nodal displacements, against reduced rotors with all their modes."""

import exudyn
import netgen.occ as occ
import ngsolve
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import exudyn_rotor as er
from exudyn_rotor.multibody.full import add_full
from exudyn_rotor.solvers.factor import TooLittleMemoryError

STEP, STEPS, NEWTON = 1e-4, 20, 1e-10
GRAVITY = [1.0, -9.81, 3.0]
SKEW = np.array([1.0, 2.0, 2.0]) / 3.0
KINDS = exudyn.OutputVariableType
RUN_UP = er.PrescribedMotion.run_up(100.0, 300.0, 1e-3)
SHAKEN = er.PrescribedMotion(
    lambda t: np.array([1e-3 * np.sin(200.0 * t), 0.0, 5e-4 * np.sin(300.0 * t)]),
    lambda t: np.array([0.2 * np.cos(200.0 * t), 0.0, 0.15 * np.cos(300.0 * t)]),
    lambda t: np.array([-40.0 * np.sin(200.0 * t), 0.0, -45.0 * np.sin(300.0 * t)]),
)


@pytest.fixture(scope="module")
def bar():
    """A soft bar of 20 nodes with an unbalance, no symmetry about its axis z."""
    solid = occ.Box((-0.03, -0.025, 0.0), (0.03, 0.025, 0.3))
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
    mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.3))
    rubber = {"youngsModulus": 2.1e9, "poissonsRatio": 0.3, "density": 7850.0}
    rotor = er.SolidRotor.from_ngsolve(mesh, rubber, "z", order=1)
    return rotor.add_point_mass([0.03, 0.025, 0.3], 0.5)


def turned(rotor, direction, point=(0.0, 0.0, 0.0)):
    """The same rotor with its length along `direction`, its axis through `point` of the mesh."""
    R = Rotation.align_vectors([direction], [[0.0, 0.0, 1.0]])[0].as_matrix()
    B = np.kron(np.eye(rotor.node_count), R)
    sets = {name: face.nodes for name, face in rotor.interfaces.items()}
    stiffness = B @ rotor.stiffness.toarray() @ B.T
    axis = er.SpinAxis(direction, R @ np.array(point))
    nodes = rotor.nodes @ R.T
    return er.SolidRotor.from_matrices(rotor.mass, stiffness, nodes, axis, interfaces=sets)


def on_axis(bar, axis):
    """The bar about its axis, turned to another direction, or moved beside it."""
    turns = {
        "x": ([1.0, 0.0, 0.0],),
        "skew": (SKEW,),
        "down": ([0.0, 0.0, -1.0],),
        "off": (SKEW, (0.02, 0.01, 0.0)),
    }
    return bar if axis == "z" else turned(bar, *turns[axis])


def run(rotor, source, supports=(), **options):
    """Run a rotor on two springs and supports; return body and histories: ends, drive, energy."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, source, gravity=GRAVITY, **options)
    er.add_supports(body, supports)
    place = options.get("rotation", np.eye(3))
    sensors = []
    for name in ("left", "right"):
        ground = mbs.CreateGround(referencePosition=place @ rotor.interfaces[name].reference)
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            stiffness=[1e5, 2e5, 1.5e5],
            damping=[20.0, 10.0, 5.0],
        )
        sensors += [
            body.add_interface_sensor(name, kind) for kind in (KINDS.Position, KINDS.Rotation)
        ]
    free = options["spin"] == "free"
    sensors += [body.add_spin_sensor() if free else body.add_drive_torque_sensor()]
    sensors += [body.add_energy_sensor()]
    mbs.Assemble()
    mbs.SolveDynamic(tight_settings(body, STEP))
    return body, [mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in sensors]


def tight_settings(body, step, steps=STEPS):
    """Settings with a tight tolerance of Newton's method, which store sensors at every step."""
    settings = er.recommended_settings(steps * step, step, body=body)
    settings.timeIntegration.newton.relativeTolerance = NEWTON
    settings.timeIntegration.newton.absoluteTolerance = 1e-3 * NEWTON
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    return settings


FAMILY = {
    "2.2": ({"translation": "free", "spin": "free", "initial_speed": 300.0}, 4),
    "2.3": ({"translation": "in-plane", "spin": "free", "initial_speed": 300.0}, 3),
    "2.4": (
        {
            "translation": "none",
            "spin": "free",
            "initial_speed": 300.0,
            "stiffness_damping": 1e-6,
        },
        1,
    ),
    "2.5": ({"translation": "none", "spin": 300.0}, 1),
    "2.5, elastic": ({"translation": "none", "spin": 300.0, "drive": "elastic"}, 0),
    "2.5, θ(t)": ({"translation": "none", "spin": RUN_UP}, 1),
    "2.5, τ(t)": ({"translation": SHAKEN, "spin": 300.0}, 1),
    "frozen": (
        {
            "translation": "free",
            "spin": "free",
            "initial_speed": 300.0,
            "spin_coupling": "frozen",
        },
        4,
    ),
}
CASES = [(name, "z", "tilt") for name in FAMILY] + [
    ("2.2", "x", "none"),
    ("2.2", "skew", "tilt"),
    ("2.4", "down", "tilt"),
    ("2.5, θ(t)", "off", "tilt"),
    ("2.4", "z", "full"),
]


@pytest.mark.parametrize(("name", "axis", "level"), CASES)
def test_full_and_reduced_with_all_modes_agree(bar, name, axis, level):
    """The same equations in two bases: all differences are those of Newton's tolerance.

    Of the motion that is 1e-10 times what a step repeats, 20 times; speeds, torques and energies
    have lost three digits more to the differences that they are.
    """
    rotor = on_axis(bar, axis)
    options, conditions = FAMILY[name]
    options = options | {"stiffening": level}
    if axis == "skew":
        options["rotation"] = Rotation.from_rotvec([0.3, 0.5, -0.2]).as_matrix()
    reduced = rotor.reduce(3 * rotor.node_count - 6)
    _, few = run(rotor, reduced, **options)
    body, all_ = run(rotor, rotor, **options)
    assert len(body.selection.conditions.rows) == conditions
    assert body.uses_python == (name not in ("2.5", "2.5, elastic"))
    for index, (one, other) in enumerate(zip(few, all_, strict=True)):
        size = np.abs(one - one[0]).max()
        assert np.abs(one - other).max() < (1e-8 if index < 4 else 1e-5) * size


def scene(source, **options):
    """Return an empty scene with the rotor at 10 rad/s, held in space."""
    mbs = exudyn.SystemContainer().AddSystem()
    return mbs, er.add_rotor(mbs, source, **({"spin": 10.0, "translation": "none"} | options))


def test_markers_and_sensors_at_mesh_nodes_move_with_them(bar):
    mbs, body = scene(bar)
    corner = int(bar.interfaces["right"].nodes[0])
    marker = body.add_marker([corner], kind="position")
    sensor = body.add_node_sensor(corner, KINDS.DisplacementLocal)
    place = body.add_node_sensor(corner, KINDS.Position)
    mbs.CreateForce(itemNumber=marker, loadVector=[0.0, 0.0, 50.0])
    mbs.Assemble()
    mbs.SolveDynamic(er.recommended_settings(1e-3, 1e-4, body=body))
    moved = body.displacement()[corner]
    assert moved[2] > 1e-9
    np.testing.assert_allclose(mbs.GetSensorValues(sensor), moved, rtol=1e-9)
    state = mbs.systemData.GetODE2Coordinates()
    mbs.systemData.SetODE2Coordinates(state, exudyn.ConfigurationType.Visualization)
    (drawn,) = add_full.surface_drawing(body, *body.nodes.values())(mbs, 0)
    points = np.reshape(drawn["points"], (-1, 3))
    assert np.linalg.norm(points - mbs.GetSensorValues(place), axis=1).min() < 1e-12


def test_stress_is_that_of_the_rotation(bar):
    """A clamped bar at rest in the rotating frame has the stress of the static solution.

    Beside that of the spin softening, (Ω/ω₁)² of it, below 1e-4 at 1 rad/s.
    """
    rotor = bar.clamped("left")
    rotor = rotor.with_prestress(rotor.prestress())
    mbs, body = scene(rotor, spin=1.0, stiffening="none")
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.staticSolver.verboseMode = 0
    mbs.SolveStatic(settings)
    known = rotor.carried_prestress.stress
    assert np.abs(body.stress() - known).max() < 1e-4 * np.abs(known).max()


def test_too_little_memory_is_said_before_anything_is_added(bar, monkeypatch):
    monkeypatch.setattr(add_full, "available_memory", lambda: 1e5)
    mbs = exudyn.SystemContainer().AddSystem()
    with pytest.raises(TooLittleMemoryError, match=r"60 displacements needs .*rotor\.reduce"):
        er.add_rotor(mbs, bar, spin=10.0)
    assert mbs.systemData.NumberOfNodes() == 0
    monkeypatch.setattr(add_full, "available_memory", lambda: 1e9)
    er.add_rotor(mbs, bar, spin=10.0)
