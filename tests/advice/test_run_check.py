"""Checks after a run: every number against one known otherwise, every limit exceeded once."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import (
    LoadCoordinate,
    LoadForceVector,
    LoadTorqueVector,
    MarkerNodeCoordinate,
    MarkerNodeRigid,
)
from models import centered_disc
from point_rotors import ring_rotor
from run_scenes import scene, solve

from exudyn_rotor import (
    AssumptionWarning,
    PrescribedMotion,
    SolidRotor,
    SpinAxis,
    add_rotor,
    check_run,
    craig_bampton_modes,
    keep_modes,
    propose,
)
from exudyn_rotor.advice.run_measures import Measures
from exudyn_rotor.theory.nodal import rotations, translations


@pytest.fixture(scope="module")
def solid():
    return centered_disc().add_point_mass([0.15, 0, 0.215], 0.005)


@pytest.fixture(scope="module")
def reduced(solid):
    return solid.reduce(6).without_shapes()


@pytest.fixture(scope="module")
def run(solid):
    """A quiet run: unbalance and weight at constant speed."""
    reduced = solid.reduce(craig_bampton_modes(solid, 6)).without_shapes()
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
    body = add_rotor(mbs, reduced, **options)
    mbs.Assemble()
    return body


def _modal(body_or_labels, **values):
    return [values.get(name.split(" (")[0].replace(" ", "_"), 0.0) for name in body_or_labels]


def _labels(reduced, **options):
    return _at_rest(reduced, **options).selection.labels


def test_quiet_run_passes_and_says_so(run, recwarn):
    check = check_run(run)
    assert check.ok
    assert check.complete
    assert check.failed == ()
    assert "FAILS" not in str(check)
    assert not recwarn.list
    assert check["unresisted load"].value < 1e-5
    assert check["locked"].value < 1e-9


def test_without_watch_only_the_end_is_known(reduced):
    body = _finished(reduced, "none", watch=False, spin=200.0)
    with pytest.warns(AssumptionWarning, match="only the end state is known"):
        check = check_run(body, limits={"stiffening": 1.0})
    assert not check.complete
    assert "only the end state is known" in str(check)


def test_run_of_few_instants_is_told(reduced):
    mbs, body = scene(reduced, "none", spin=200.0)
    body.start_recording()
    mbs.Assemble()
    check_run(body)  # before a run there is nothing to miss
    solve(mbs, 400, 0.04, period=0.01)
    with pytest.warns(AssumptionWarning, match=r"only 5 instants are known: lower solution"):
        check = check_run(body, limits={"residual": 1.0})
    assert check.instants == 5
    assert not check.complete
    assert check.ok


@pytest.mark.parametrize("translation", ["free", "in-plane", "none"])
@pytest.mark.parametrize("locking", ["mass", "constraints"])
@pytest.mark.parametrize("markers", ["rigid", "position"])
def test_every_formulation_keeps_all_loads(reduced, translation, locking, markers):
    """Weight, unbalance and bearings reach the equations; the axis lies askew to gravity."""
    turn = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    mbs = exu.SystemContainer().AddSystem()
    options = {"rotation": turn, "gravity": [1, -9, 4], "initial_speed": 150.0}
    body = add_rotor(
        mbs, reduced, translation=translation, locking=locking, markers=markers, **options
    )
    ground = mbs.CreateGround()
    for name, place in (("left", [0, 0, 0]), ("right", [0.5, 0, 0])):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)], localPosition0=place, stiffness=[1e6] * 3
        )
    kind = exu.OutputVariableType.Displacement
    journals = [body.add_interface_sensor(name, kind) for name in ("left", "right")]
    body.start_recording()
    mbs.Assemble()
    solve(mbs, 200, 0.02)
    check = check_run(body, warn=False)
    u = np.array([mbs.GetSensorStoredData(journal)[:, 1:] for journal in journals])
    # axial forces k u_x have the lateral displacements as levers, which no equation resists
    lost = (abs(u[:, :, 0]) * np.linalg.norm(u[:, :, 1:], axis=2)).sum(axis=0).max()
    size = Measures(body, body.recorded()).size
    assert check["unresisted load"].value < lost / (
        size * np.linalg.norm(u.sum(axis=0), axis=1).max()
    )
    assert check["locked"].value < 1e-9


def test_watch_is_native_and_asked_for_once(reduced):
    mbs, body = scene(reduced, "none", spin=100.0)
    before = mbs.systemData.NumberOfSensors()
    body.start_recording()
    body.start_recording()
    assert mbs.systemData.NumberOfSensors() == before + 7  # with the forces of the locks
    assert not body.uses_python


def test_tilt_is_the_angle_of_the_axis(reduced):
    """A unit tilt mode turns by 1/√I."""
    labels = _labels(reduced, spin=0.0)
    inertia = reduced.invariants.J[1, 1] + reduced.invariants.J[2, 2]
    body = _at_rest(reduced, spin=0.0, modal_coordinates=_modal(labels, tilt_1=0.05))
    with pytest.warns(AssumptionWarning, match=r"tilt .* exceeds 0\.0316"):
        check = check_run(body)
    assert check["tilt"].value == pytest.approx(0.05 / np.sqrt(inertia), rel=1e-3)
    assert [row.name for row in check.failed] == ["tilt"]
    assert check_run(body, limits={"tilt": 0.2}).ok


def test_a_rotor_that_nothing_holds_is_told():
    """Its centre of mass is 50 mm off the axis about which the speed is kept: it is flung away."""
    ring = ring_rotor(0.1, 0.1, 2.0)
    axis = SpinAxis([0.0, 0.0, 1.0], [0.05, 0.0, 0.0])
    rotor = SolidRotor.from_matrices(ring.mass, ring.stiffness, ring.nodes, axis)
    for translation, away in (("none", True), ("free", False)):
        mbs = exu.SystemContainer().AddSystem()
        body = add_rotor(mbs, rotor.reduce(0), translation=translation, spin=100.0)
        body.start_recording()
        mbs.Assemble()
        solve(mbs, 200, 0.05)
        check = check_run(body, warn=False)
        assert ("adrift" in {row.name for row in check.failed}) == away
        if away:
            moved = np.linalg.norm(body.motion.invariants.S @ body.coordinates()[0]) / 2.0
            assert check["adrift"].value == pytest.approx(
                moved / np.sqrt(0.1**2 + 0.1**2), rel=1e-9
            )
            assert "translation='free'" in check["adrift"].advice


def test_travel_is_that_of_the_centre_of_mass(reduced):
    labels = _labels(reduced, translation="none")
    mass = reduced.invariants.mass
    size = np.sqrt(np.trace(reduced.invariants.J) / mass)
    values = _modal(labels, translation_1=0.2 * size * np.sqrt(mass))
    body = _at_rest(reduced, translation="none", modal_coordinates=values)
    check = check_run(body, warn=False)
    assert check["travel"].value == pytest.approx(0.2, rel=1e-6)
    assert [row.name for row in check.failed] == ["travel"]


def test_deflection_and_top_modes(reduced):
    mass = reduced.invariants.mass
    size = np.sqrt(np.trace(reduced.invariants.J) / mass)
    labels = _labels(reduced, spin=0.0)
    values = _modal(labels, mode_1=0.1 * size * np.sqrt(mass), mode_6=0.05)
    check = check_run(_at_rest(reduced, spin=0.0, modal_coordinates=values), warn=False)
    moved = np.linalg.norm(values[-6:]) / np.sqrt(mass)
    assert check["deflection"].value == pytest.approx(moved / size, rel=1e-2)
    energy = (reduced.frequencies[-6:] * np.array(values[-6:])) ** 2
    assert check["top modes"].value == pytest.approx(energy[-1] / energy.sum(), rel=1e-6)
    assert {row.name for row in check.failed} == {"deflection", "top modes"}


def test_truncated_bending_shows_in_the_highest_modes(reduced):
    """With the lowest pair alone half of its energy is in the highest fifth."""
    few = _finished(keep_modes(reduced, [0, 1]), "none", spin=200.0, gravity=[0, -9.81, 0])
    many = _finished(reduced, "none", spin=200.0, gravity=[0, -9.81, 0])
    few, many = (check_run(body, warn=False)["top modes"] for body in (few, many))
    assert many.ok
    assert few.value > 3 * many.value


@pytest.fixture(scope="module")
def breathing(solid):
    return keep_modes(solid.reduce(40), [0, 1, 2, 3, 4, 5, 10, 11, 28, 29])  # 28 breathes


@pytest.mark.parametrize("start", ["sudden", "settled"])
def test_breathing_of_a_disc_about_its_stretch_is_no_lack_of_modes(breathing, start):
    stretch = 300.0**2 * breathing.invariants.h[6:] / breathing.frequencies[6:] ** 2
    settled = {"modal_coordinates": np.append(np.zeros(5), stretch)} if start == "settled" else {}
    body = _finished(breathing, "none", spin=300.0, steps=200, end_time=0.02, **settled)
    assert check_run(body, warn=False)["top modes"].ok


def test_breathing_of_a_disc_that_was_hit_is_a_lack_of_modes(breathing):
    hit = {"modal_velocities": np.append(np.zeros(14), 0.5), "steps": 2000, "end_time": 0.02}
    check = check_run(_finished(breathing, "none", spin=300.0, **hit), warn=False)
    assert not check["top modes"].ok


@pytest.mark.parametrize(
    ("locking", "steps", "ok"), [("mass", 10, False), ("constraints", 10, True)]
)
def test_a_mass_that_is_driven_may_leave_its_place(reduced, locking, steps, ok):
    """An implicit solver integrates its acceleration, which a constraint needs not."""
    options = {"spin": PrescribedMotion.run_up(0.0, 300.0, 0.02), "locking": locking}
    body = _finished(reduced, "none", steps=steps, end_time=0.02, **options)
    assert check_run(body, warn=False)["locked"].ok == ok


def test_strain_is_that_of_the_static_stretch(solid):
    """With the static deformation u as a mode the strain is ``uᵀ M x_⊥ / Θ``, x_⊥ the radius."""
    prestress = solid.prestress()
    radial = solid.axis.radial(solid.nodes).ravel()
    load = solid.mass @ radial
    stretched = solid.reduce(prestress.displacement[:, None])
    body = _at_rest(stretched, spin=2000.0)
    expected = 2000.0**2 * (prestress.displacement @ load) / (radial @ load)
    check = check_run(body, warn=False, limits={"strain": 1e-6})
    assert check["strain"].value == pytest.approx(expected, rel=1e-3)
    assert not check["strain"].ok


def _stretching(frequency):
    """Return two masses of 1 kg on a spring along x, and four more on the axis z."""
    nodes = np.array([[0.1, 0, 0], [-0.1, 0, 0], [0, 0, 0.2], [0, 0, -0.2]])
    mass = np.eye(12)
    stretch = np.zeros((12, 1))
    stretch[[0, 3], 0] = np.sqrt(0.5) * np.array([1.0, -1.0])
    soft = np.hstack([translations(4), rotations(nodes, np.zeros(3)), stretch])
    rest = np.eye(12) - soft @ np.linalg.pinv(soft)
    stiffness = frequency**2 * stretch @ stretch.T + 1e10 * rest
    return SolidRotor.from_matrices(mass, stiffness, nodes, "z").reduce(1)


@pytest.mark.parametrize(("share", "ok"), [(0.65, True), (0.95, False), (1.05, False)])
def test_divergence_of_masses_on_a_spring(share, ok):
    """They fly apart where Ω reaches the frequency of the spring; looked at in steps of Ω/10."""
    rotor = _stretching(100.0)
    check = check_run(_at_rest(rotor, spin=100.0 * share), warn=False)
    assert check["divergence"].ok == ok
    assert 1.0 / share <= 1.0 / np.sqrt(check["divergence"].value) < 1.0 / share + 0.1


def test_steps_too_long_are_found(reduced):
    body = _finished(reduced, "none", spin=200.0, steps=40, end_time=0.08, gravity=[0, -9.81, 0])
    with pytest.warns(AssumptionWarning) as caught:
        check = check_run(body)
    assert len(caught) == len(check.failed)
    assert check["spin step"].value == pytest.approx(0.4, rel=1e-9)
    assert not check["step"].ok


# |R(iωh)| = 1 for the first three; the others grow by e in 3 steps
EXPLICIT = {
    "RK44": np.sqrt(8.0),
    "RK33": np.sqrt(3.0),
    "VelocityVerlet": 2.0,
    "ExplicitEuler": np.sqrt(2.0 / 3.0),
    "ExplicitMidpoint": (8.0 / 3.0) ** 0.25,
}


@pytest.mark.parametrize("method", EXPLICIT)
def test_unstable_step_of_an_explicit_solver_is_found(reduced, method):
    mbs, body = scene(reduced, "none", spin=200.0, locking="mass")
    mbs.Assemble()
    highest = reduced.frequencies.max() + 200.0
    for factor, ok in ((0.5, True), (1.05, False)):
        step = factor * EXPLICIT[method] / highest
        solve(mbs, 3, 3 * step, solverType=getattr(exu.DynamicSolverType, method))
        check = check_run(body, warn=False)
        assert check["explicit"].value == pytest.approx(factor, rel=1e-6)
        assert check["explicit"].ok == ok


def test_failed_solution_is_said_to_have_failed(reduced):
    mbs, body = scene(reduced, "none", spin=200.0)
    mbs.Assemble()
    state = np.array(mbs.systemData.GetODE2Coordinates())
    state[-1] = np.nan
    mbs.systemData.SetODE2Coordinates(state)
    with pytest.warns(AssumptionWarning, match="the solution failed"):
        check = check_run(body)
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
        ("in-plane", 0, 100.0, False),
        ("none", 0, 100.0, True),
        ("free", 2, 100.0, False),
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
    check = check_run(body, warn=False)
    assert check["unresisted load"].ok != lost
    assert (check["unresisted load"].value > 0.3) == lost


@pytest.mark.parametrize("place", ["centre_of_mass", "mesh_origin"])
@pytest.mark.parametrize("translation", ["free", "in-plane", "none"])
def test_loads_at_the_node_and_weight_are_felt(reduced, translation, place):
    def load(mbs, body):
        marker = mbs.AddMarker(MarkerNodeRigid(nodeNumber=body.nodes["rigid"]))
        mbs.AddLoad(LoadForceVector(markerNumber=marker, loadVector=[30.0, 0.0, 100.0]))
        mbs.AddLoad(LoadTorqueVector(markerNumber=marker, loadVector=[20.0, 0.0, 2.0]))

    options = {"initial_speed": 50.0, "gravity": [0.0, -9.81, 0.0], "frame_node": place}
    body = _finished(reduced, translation, load, steps=100, end_time=0.01, **options)
    assert check_run(body, warn=False)["unresisted load"].value < 1e-3


def test_loads_on_interfaces_are_felt(reduced):
    def load(mbs, body):
        mbs.CreateForce(itemNumber=body.marker("right"), loadVector=[0.0, 50.0, 100.0])
        mbs.CreateTorque(itemNumber=body.marker("left"), loadVector=[20.0, 0.0, 0.0])

    body = _finished(reduced, "in-plane", load, steps=100, end_time=0.01, initial_speed=50.0)
    assert check_run(body, warn=False)["unresisted load"].value < 1e-3


def test_speed_beyond_the_proposal_is_found(reduced, run):
    fast, slow = (propose(reduced, speeds=s, accuracy=0.2) for s in (200.0, 150.0))
    assert check_run(run, proposal=fast, warn=False)["speed"].ok
    row = check_run(run, proposal=slow, warn=False)["speed"]
    assert row.value == pytest.approx(200.0 / 150.0)
    assert not row.ok


def test_yielding_is_found(solid):
    """Von Mises √(3/2 s:s) of the deviator s."""
    reduced = solid.reduce(2, prestress=solid.prestress(yield_stress=1e6))
    check = check_run(_at_rest(reduced, spin=500.0), reduced=reduced, warn=False)
    stress = reduced.static_stress(500.0)
    stress[:, :3] -= stress[:, :3].mean(axis=1, keepdims=True)
    squares = stress**2 @ np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    expected = np.sqrt(1.5 * squares.max()) / 1e6
    assert check["yield"].value == pytest.approx(expected, rel=1e-12)
    assert not check["yield"].ok


def test_rotors_of_every_kind_are_checked():
    """Without a marker body, driven along θ(t), held by its own stiffness, and rigid."""
    rings = ring_rotor(0.1, 0.1, 2.0)
    run_up = PrescribedMotion.run_up(0.0, 10.0, 0.1)
    assert check_run(_at_rest(rings.reduce(0), marker_body=False)).ok
    assert check_run(_at_rest(rings.reduce(3), translation="none", spin=run_up)).ok
    assert check_run(_at_rest(rings.reduce(0), spin=0.0)).ok
