"""Checks after a run: every number against one known otherwise, every limit exceeded once."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import LoadCoordinate, MarkerNodeCoordinate
from models import centered_disc
from run_scenes import scene, solve
from scipy.spatial.transform import Rotation

import exudyn_rotor as er


@pytest.fixture(scope="module")
def solid():
    return centered_disc().add_point_mass([0.15, 0, 0.215], 0.005)


@pytest.fixture(scope="module")
def reduced(solid):
    return solid.reduce(6).without_shapes()


@pytest.fixture(scope="module")
def run(solid):
    """A quiet run: unbalance and weight at constant speed."""
    reduced = solid.reduce(er.craig_bampton_modes(solid, 6)).without_shapes()
    return _finished(reduced, "none", spin=200.0, gravity=[0, -9.81, 0])


def _finished(reduced, translation, load=None, steps=400, end_time=0.04, watch=True, **options):
    mbs, body = scene(reduced, translation, **options)
    if load is not None:
        load(mbs, body)
    if watch:
        body.start_recording()
    mbs.Assemble()
    solve(mbs, steps, end_time)
    return body


def _at_rest(reduced, **options):
    """Return a body with initial values and no run: checks look at the state."""
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, **options)
    mbs.Assemble()
    return body


def test_quiet_run_passes_and_says_so(run, recwarn):
    check = er.check_run(run)
    assert check.ok
    assert check.complete
    assert check.failed == ()
    assert "FAILS" not in str(check)
    assert not recwarn.list
    assert check["unresisted load"].value < 1e-5
    with pytest.raises(KeyError, match="no check 'steps' here; there are: "):
        check["steps"]


def test_a_rotor_that_rests_has_no_error_of_the_step(reduced):
    check = er.check_run(_finished(reduced, "none", steps=30, end_time=1e-3, spin=0.0))
    assert check["step"].value == 0.0


def test_a_joint_at_a_place_leaves_no_linear_equations(reduced):
    def joint(mbs, body):
        ends = [mbs.CreateGround(), body.marker("left")]
        mbs.CreateGenericJoint(itemNumbers=ends, constrainedAxes=[1, 1, 0, 0, 0, 0])

    body = _finished(reduced, "none", joint, steps=30, end_time=1e-3, spin=200.0)
    assert "growth" not in [row.name for row in er.check_run(body, warn=False).rows]


def test_run_of_few_instants_is_told(reduced):
    mbs, body = scene(reduced, "none", spin=200.0)
    for _ in range(2):  # the second call finds the sensors of the first
        body.start_recording()
    mbs.Assemble()
    er.check_run(body)  # before a run there is nothing to miss
    solve(mbs, 400, 0.04, period=0.01)
    with pytest.warns(
        er.AssumptionWarning, match=r"only 5 of at least 20 instants .* and lower solution"
    ):
        check = er.check_run(body, accuracy=0.5)
    assert check.instants == len(body.recorded().time) == 5
    assert not check.complete
    assert check.ok


SKEW = Rotation.from_rotvec([0.3, -0.8, 0.5]).as_matrix()


@pytest.mark.parametrize("translation", ["free", "none"])
def test_motors_and_shaken_ground_are_resisted(reduced, translation):
    """Of a rotor that is mounted askew."""
    options = {"rotation": SKEW, "gravity": [0, -9.81, 0], "initial_speed": 100.0}
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, translation=translation, **options)
    er.add_supports(body, [er.Support(name, 2e6, damping=500.0) for name in ("left", "right")])
    er.add_drive(body, er.DirectCurrentMotor(stall_torque=10.0, no_load_speed=150.0))
    er.add_base_motion(mbs, er.BaseRecord([0.0, 1.0], [[3.0, 1.5, 1.0]] * 2), body)
    body.start_recording()
    mbs.Assemble()
    solve(mbs, 100, 0.01)
    assert er.check_run(body, warn=False)["unresisted load"].value < 1e-3


def test_pads_with_inertia_pull_without_moments(reduced):
    """Of five pads all around a journal in the middle, alike, nothing is left."""
    angles = np.radians([18.0, 90.0, 162.0, 234.0, 306.0])
    pads = er.grooved_pads(1e-4, angles, 0.2, preload=0.5)
    film = er.OilFilm(radius=0.02, length=0.02, viscosity=0.01, pads=pads, nodes=24, axial_nodes=0)
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, spin=200.0)
    er.add_supports(body, [er.Support(name, 2e6, damping=500.0) for name in ("left", "right")])
    er.add_supports(body, er.TiltingPadBearing(interface="left", film=film, pad_inertia=1e-4))
    body.start_recording()
    mbs.Assemble()
    solve(mbs, 20, 0.002)
    assert er.check_run(body, warn=False)["unresisted load"].value < 1e-3


@pytest.mark.parametrize("translation", ["free", "in-plane", "none"])
@pytest.mark.parametrize(("locking", "markers"), [("mass", "rigid"), ("constraints", "position")])
def test_every_formulation_keeps_all_loads(reduced, translation, locking, markers):
    """Weight, unbalance and bearings reach the equations; the axis lies askew to gravity."""
    turn = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    mbs = exu.SystemContainer().AddSystem()
    options = {"rotation": turn, "gravity": [1, -9, 4], "initial_speed": 150.0}
    body = er.add_rotor(
        mbs, reduced, translation=translation, locking=locking, markers=markers, **options
    )
    ground = mbs.CreateGround()
    for name, place in (("left", [0, 0, 0]), ("right", [0.5, 0, 0])):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)], localPosition0=place, stiffness=[1e6] * 3
        )
    body.start_recording()
    mbs.Assemble()
    solve(mbs, 200, 0.02)
    check = er.check_run(body, warn=False)
    assert check["unresisted load"].value == 0.0


def test_truncated_bending_shows_in_the_highest_modes(reduced):
    """With the lowest pair alone half of its energy is in the highest fifth."""
    few = _finished(er.keep_modes(reduced, [0, 1]), "none", spin=200.0, gravity=[0, -9.81, 0])
    many = _finished(reduced, "none", spin=200.0, gravity=[0, -9.81, 0])
    few, many = (er.check_run(body, warn=False)["top modes"] for body in (few, many))
    assert many.ok
    assert few.value > 3 * many.value


def test_steps_too_long_are_found(reduced):
    body = _finished(reduced, "none", spin=200.0, steps=40, end_time=0.08, gravity=[0, -9.81, 0])
    with pytest.warns(er.AssumptionWarning) as caught:
        check = er.check_run(body)
    assert len(caught) == len(check.failed)
    assert not check["step"].ok


def test_failed_solution_is_said_to_have_failed(reduced):
    mbs, body = scene(reduced, "none", spin=200.0)
    mbs.Assemble()
    state = np.array(mbs.systemData.GetODE2Coordinates())
    state[-1] = np.nan
    mbs.systemData.SetODE2Coordinates(state)
    with pytest.warns(er.AssumptionWarning, match="the solution failed"):
        check = er.check_run(body)
    assert not check.ok


def _on_coordinate(index, size):
    def load(mbs, body):
        node = body.nodes["rigid"]
        marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=index))
        mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=size))

    return load


@pytest.mark.filterwarnings("ignore::exudyn_rotor.ConnectionWarning")
@pytest.mark.parametrize("locking", ["mass", "constraints"])
@pytest.mark.parametrize(
    ("translation", "index", "size", "lost"),
    [
        ("in-plane", 2, 100.0, True),
        ("none", 0, 100.0, True),
        ("free", 3, 20.0, True),
        ("free", 5, 2.0, False),
    ],
)
def test_loads_that_the_frame_does_not_take_are_found(
    reduced, locking, translation, index, size, lost
):
    """A load on a coordinate of the frame's node counts where the formulation has that."""
    load = _on_coordinate(index, size)
    options = {"initial_speed": 50.0, "locking": locking}
    body = _finished(reduced, translation, load, steps=100, end_time=0.01, **options)
    check = er.check_run(body, warn=False)
    assert check["unresisted load"].ok != lost
    assert (check["unresisted load"].value > 0.3) == lost


def test_supports_by_a_law_of_their_own_load_the_rotor_alike(reduced):
    """What the modes leave out follows from the bearings' forces, whoever evaluates them."""
    found = []
    for stiffness in (2e7, lambda speed: 2e7 * np.eye(2)):
        mbs = exu.SystemContainer().AddSystem()
        body = er.add_rotor(mbs, reduced, spin=100.0, translation="none", gravity=[0, -9.81, 0])
        er.add_supports(body, [er.Support(name, stiffness, 500.0) for name in ("left", "right")])
        body.start_recording()
        mbs.Assemble()
        solve(mbs, 100, 0.01)
        found.append(er.check_run(body, warn=False)["residual"].value)
    assert found[0] > 1e-3
    assert found[1] == pytest.approx(found[0], rel=1e-3)


def test_yielding_is_found(solid):
    """Von Mises √(3/2 s:s) of the deviator s."""
    reduced = solid.reduce(2, prestress=solid.prestress(yield_stress=1e6))
    check = er.check_run(_at_rest(reduced, spin=500.0), reduced=reduced, warn=False)
    stress = reduced.static_stress(500.0)
    stress[:, :3] -= stress[:, :3].mean(axis=1, keepdims=True)
    squares = stress**2 @ np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    expected = np.sqrt(1.5 * squares.max()) / 1e6
    assert check["yield"].value == pytest.approx(expected, rel=1e-12)
    assert not check["yield"].ok
