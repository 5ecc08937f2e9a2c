"""Exudyn's own features on the rotor's marker body: sensors, loads, pictures, solution files."""

import exudyn as exu
import matplotlib

matplotlib.use("Agg")
import numpy as np
import pytest
from exudyn.interactive import ShowImage
from exudyn.itemInterface import LoadCoordinate, MarkerNodeCoordinate
from models import STEEL, block_beam

from exudyn_rotor import SolidRotor, add_rotor


def shapes_motion(reduced, body, node):
    """Return position, velocity and stress of a mesh node from the mode shapes alone."""
    q, q_t, _ = body.coordinates()
    motion = body.motion
    theta, omega = q[3], q_t[3]
    e = motion.invariants.direction
    turn = motion.orientation @ reduced.axis.rotation(theta)
    rows = (reduced.shapes.matrix @ body.selection.T).reshape(-1, 3, len(q) - 4)[node]
    local = reduced.shapes.nodes[node] - body.frame.origin + rows @ q[4:]
    start = body.frame.position + q[:3]
    velocity = q_t[:3] + turn @ (omega * np.cross(e, local) + rows @ q_t[4:])
    stress = reduced.shapes.stress[node] @ body.selection.T @ q[4:]
    return start + turn @ local, velocity, stress


KINDS = exu.OutputVariableType


@pytest.fixture(scope="module")
def solid():
    return SolidRotor.from_ngsolve(block_beam(), STEEL, "z", order=2)


@pytest.fixture(scope="module")
def reduced(solid):
    # without the static stress, which Exudyn's sensors would not show
    return solid.reduce(4, stress=True, prestress=False)


def settings(steps=20, end_time=1e-3):
    result = exu.SimulationSettings()
    result.timeIntegration.numberOfSteps = steps
    result.timeIntegration.endTime = end_time
    result.timeIntegration.verboseMode = result.staticSolver.verboseMode = 0
    result.solution.file.write = False
    result.solution.sensors.writePeriod = end_time / steps
    return result


def one_rotor(reduced, **options):
    SC = exu.SystemContainer()
    mbs = SC.AddSystem()
    return SC, mbs, add_rotor(mbs, reduced, **options)


def test_loads_on_coordinates(reduced, tmp_path):
    """A modal force f moves its mode of unit mass by f (1 − cos ωt) / ω², a torque the spin."""
    _, mbs, body = one_rotor(reduced, locking="mass")
    mode = len(body.selection.labels) - 1
    frequency = np.sqrt(body.motion.invariants.K[mode, mode])
    for node, index, load in ((body.nodes["modes"], mode, 50.0), (body.nodes["rigid"], 5, 0.2)):
        marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=index))
        mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=load))
    spin = body.add_spin_sensor(fileName=tmp_path / "spin.txt", writeToFile=True)
    mbs.Assemble()
    mbs.SolveDynamic(settings(400), solverType=exu.DynamicSolverType.RK44)
    q = body.coordinates()[0]
    assert q[4 + mode] == pytest.approx(
        50.0 * (1 - np.cos(frequency * 1e-3)) / frequency**2, rel=1e-3
    )
    inertia = body.motion.invariants.Theta
    written = np.loadtxt(tmp_path / "spin.txt", delimiter=",")
    np.testing.assert_allclose(written, mbs.GetSensorStoredData(spin), rtol=1e-9)
    assert mbs.GetSensorValues(spin) == pytest.approx(
        [0.5e-6 * 0.2 / inertia, 1e-3 * 0.2 / inertia], rel=1e-3
    )


def test_pictures_show_the_rotor_its_deformation_and_its_stress(solid, reduced):
    assert solid.triangles.shape[1] == 6
    SC, mbs, body = one_rotor(reduced)
    mbs.Assemble()
    pixels = {}
    bent = np.zeros(len(body.selection.labels))
    bent[2] = 0.02 / abs(body.selection.T[:, 2] @ reduced.shapes.matrix.T).max()
    for name, modes, contour in (
        ("straight", 0.0 * bent, None),
        ("bent", bent, None),
        ("stress", bent, KINDS.StressLocal),
    ):
        state = np.concatenate([np.zeros(6), modes])
        mbs.systemData.SetODE2Coordinates(state, exu.ConfigurationType.Current)
        settings = SC.visualizationSettings
        settings.markers.show = settings.nodes.show = False
        settings.contour.outputVariable = contour or KINDS._None
        settings.contour.outputVariableComponent = -1
        pixels[name] = ShowImage(SC, size=(300, 200), show=False)[:, :, :3] / 255.0
    background = pixels["straight"][-3, -3]
    share = (abs(pixels["straight"] - background).max(axis=2) > 0.05).mean()
    assert share > 0.02
    for first, second in (("straight", "bent"), ("bent", "stress")):
        assert (abs(pixels[first] - pixels[second]).max(axis=2) > 0.1).mean() > 0.005


def test_sensors_at_mesh_nodes_read_the_mode_shapes(solid, reduced):
    _, mbs, body = one_rotor(
        reduced,
        initial_speed=200.0,
        position=[1.0, 2.0, 3.0],
        rotation=[[0, 0, 1], [1, 0, 0], [0, 1, 0]],
        modal_velocities=[0.3, 0.2, 2.0, 1.0, 1.0, 3.0],
    )
    node = solid.nearest_node([0.02, 0.03, 0.3])
    kinds = KINDS.Position, KINDS.Velocity, KINDS.StressLocal, KINDS.Displacement
    sensors = [body.add_node_sensor(node, kind) for kind in kinds]
    mbs.Assemble()
    mbs.SolveDynamic(settings())
    values = [mbs.GetSensorValues(sensor) for sensor in sensors]
    expected = shapes_motion(reduced, body, node)
    for value, wanted in zip(values, expected, strict=False):
        assert abs(value - wanted).max() < 1e-9 * abs(wanted).max()
    assert abs(expected[2]).max() > 1e6
    rest = body.frame.position + body.placement.rotation @ (solid.nodes[node] - body.frame.origin)
    assert abs(values[3] - (expected[0] - rest)).max() < 1e-12
