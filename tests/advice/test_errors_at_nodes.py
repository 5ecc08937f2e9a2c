"""Errors of reduced runs at mesh nodes: what `check_run` estimates, against full runs."""

import exudyn
import numpy as np
import pytest
from exudyn.itemInterface import LoadForceVector, MarkerSuperElementPosition
from run_scenes import solve
from scipy.spatial.transform import Rotation
from soft_bars import STEP, STEPS, bar, run

from exudyn_rotor import (
    PrescribedMotion,
    StressField,
    add_rotor,
    check_run,
    craig_bampton_modes,
    keep_modes,
    recommended_settings,
)
from exudyn_rotor.advice.left_out_fields import left_out_at_nodes
from exudyn_rotor.advice.residual import at_interfaces, place_loads, recorded_states
from exudyn_rotor.advice.run_measures import Measures
from exudyn_rotor.multibody.full.full_plan import make_full_plan
from exudyn_rotor.multibody.load_places import LoadPlace
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.theory.nodal import rotations, translations

RUN_UP = PrescribedMotion.run_up(0.0, 300.0, 1e-2)
FAST = PrescribedMotion.run_up(0.0, 800.0, STEPS * STEP)


@pytest.fixture(scope="module")
def upright():
    rotor = bar("z")
    return rotor.with_prestress(rotor.prestress(initial_displacement=True, euler=True))


@pytest.fixture(scope="module")
def eccentric():
    rotor = bar("y")
    return rotor.with_prestress(rotor.prestress())


@pytest.fixture(scope="module")
def ran(upright):
    """A run-up with four modes."""
    reduced = upright.reduce(4, stress=True)
    return reduced, run(upright, reduced, **SCENES["run-up"])


def recorded(body, reduced):
    """Return record, modal coordinates (m, s) and displacements of the nodes (3n, s)."""
    record = body.recorded()
    zeta = record.q[:, body.layout.unknowns][:, body.motion.modes].T
    return record, zeta, reduced.shapes.matrix @ body.selection.T @ zeta


SCENES = {
    "run-up": {"translation": "none", "spin": RUN_UP},
    "free": {"translation": "free", "spin": "free", "initial_speed": 300.0},
    "tilt": {"translation": "in-plane", "spin": 300.0, "stiffening": "tilt"},
}


@pytest.mark.parametrize(
    ("rotor", "scene"), [("upright", "run-up"), ("eccentric", "free"), ("upright", "tilt")]
)
def test_errors_are_those_of_the_full_run(rotor, scene, request):
    """The estimate is the first correction, without the inertia of the modes that are left out.

    After a quarter of the run: ringing of the start at speed is not in the estimate.
    """
    solid, options = request.getfixturevalue(rotor), SCENES[scene]
    full = run(solid, solid, **options).recorded()
    for modes in (4, craig_bampton_modes(solid, 4, coupling="RBE3")):
        reduced = solid.reduce(modes, stress=True)
        body = run(solid, reduced, **options)
        record, zeta, moved = recorded(body, reduced)
        off = np.linalg.norm(moved.T.reshape(STEPS + 1, -1, 3) - full.displacement, axis=2)
        stress = StressField.of(reduced, body).history(zeta.T, record.speed, slice(None))
        wrong = von_mises(stress - full.stress)
        left_out = at_nodes(body, reduced, solid)
        for truth, estimate in ((off, left_out.displacement), (wrong, left_out.stress)):
            assert truth[STEPS // 4 :].max() == pytest.approx(estimate.max(), rel=0.2)


def test_damping_delays_the_stress_of_a_run_up(upright):
    """The share 2βω̇/ω of the static stress; without it the truth is 3.9 times the estimate."""
    solid = upright.with_damping(stiffness=3e-4)
    reduced = solid.reduce(craig_bampton_modes(solid, 30, coupling="RBE3"), stress=True)
    full = run(solid, solid, **SCENES["run-up"]).recorded()
    body = run(solid, reduced, **SCENES["run-up"])
    record, zeta, _ = recorded(body, reduced)
    stress = StressField.of(reduced, body).history(zeta.T, record.speed, slice(None))
    truth = von_mises(stress - full.stress)
    assert truth.max() == pytest.approx(at_nodes(body, reduced, solid).stress.max(), rel=0.1)


def at_nodes(body, reduced, solid, nodes=None):
    record = body.recorded()
    nodes = np.arange(solid.node_count) if nodes is None else np.array(nodes)
    return left_out_at_nodes(body, record, Measures(body, record).size, reduced, solid, nodes)


def spring_forces(solid, body, moved, record):
    """Return the nodal forces (3n, s) of both springs in the turning axes; the frame stays."""
    forces = np.zeros_like(moved)
    for end in solid.interfaces.values():
        mean = end.mean_motion(solid.node_count)[:3]
        arm = end.reference - body.axis.project(end.reference)
        for index, t in enumerate(record.time):
            A = body.axis.rotation(body.formulation.spin.value(t))
            u = A @ (mean @ moved[:, index] + arm) - arm
            forces[:, index] -= mean.T @ (A.T @ (2e5 * u))
    return forces


@pytest.mark.parametrize("level", ["full", "tilt"])
def test_left_out_is_the_static_solution_of_the_residual(upright, level):
    """With forces of the springs by their law, the full equations, and a pseudo-inverse of K.

    Damping works on what is left out of the static stretch ω²s, too. To the tolerance of Newton's
    method, 1e-9, to which the motion keeps its equations, times the largest stiffness over the
    lowest, some hundreds.
    """
    reduced = upright.reduce(8, stress=True)  # these tell all loads of both interfaces
    body = run(upright, reduced, damping=0.0, translation="none", spin=FAST, stiffening=level)
    record, _, moved = recorded(body, reduced)
    basis, modes = reduced.shapes.matrix @ body.selection.T, body.motion.modes
    rate, second = (
        basis @ rows[:, body.layout.unknowns][:, modes].T for rows in (record.q_t, record.q_tt)
    )
    springs = spring_forces(upright, body, moved, record)
    full = make_full_plan(upright, body.plan.setup).motion
    stiffness = np.linalg.pinv(upright.stiffness.toarray(), rcond=1e-12, hermitian=True)
    rigid = np.hstack([translations(upright.node_count), rotations(upright.nodes, np.zeros(3))])
    relief = np.linalg.solve(rigid.T @ (upright.mass @ rigid), rigid.T)
    picked = np.arange(1, STEPS + 1)
    missing = np.zeros_like(moved)

    def solved(r):
        u = stiffness @ (r - upright.mass @ (rigid @ (relief @ r)))
        return u - rigid @ (relief @ (upright.mass @ u))

    flexible = reduced.shapes.matrix[:, 6:]
    stretch = solved(full.spin_terms.h)
    stretch -= flexible @ (
        flexible.T @ (upright.stiffness @ stretch) / reduced.frequencies[6:] ** 2
    )
    delay = 2.0 * upright.damping @ stretch
    for i in picked:
        r = springs[:, i] + full.varying_forces(record.time[i], moved[:, i], rate[:, i])
        r -= upright.stiffness @ moved[:, i] + upright.damping @ rate[:, i]
        r -= upright.mass @ second[:, i]
        r -= delay * FAST.rate(record.time[i]) * FAST.acceleration(record.time[i])
        missing[:, i] = solved(r)
    expected = np.linalg.norm(missing.reshape(-1, 3, STEPS + 1), axis=1).T[picked]
    found = at_nodes(body, reduced, upright)
    np.testing.assert_allclose(found.displacement, expected, atol=1e-6 * expected.max())
    whole = von_mises(np.moveaxis(upright.stress_recovery(moved + missing)[:, :, 1:], 2, 0))
    np.testing.assert_allclose(found.stressed, whole, atol=1e-6 * whole.max())
    lengths = np.linalg.norm((moved + missing).reshape(-1, 3, STEPS + 1), axis=1).T[1:]
    np.testing.assert_allclose(found.moved, lengths, atol=1e-6 * lengths.max())


def test_rows_are_the_largest_of_the_nodes_asked_for(ran, upright):
    reduced, body = ran
    for nodes in (None, [3, 7]):
        found = at_nodes(body, reduced, upright, nodes)
        check = check_run(body, reduced=reduced, solid=upright, nodes=nodes, warn=False)
        for name, part, whole in (
            ("displacement", found.displacement, found.moved),
            ("stress", found.stress, found.stressed),
        ):
            assert check[name].value == pytest.approx(part.max() / whole.max(), rel=1e-12)
            worst = (nodes or range(upright.node_count))[part.max(axis=0).argmax()]
            assert check[name].meaning.endswith(f"at node {worst}")
            assert not check[name].ok
    assert "stress" not in str(check_run(body, reduced=reduced, warn=False))
    bare = upright.reduce(4)
    rows = check_run(
        run(upright, bare, **SCENES["run-up"]), reduced=bare, solid=upright, warn=False
    )
    assert rows["displacement"].value > 0.0
    assert "stress" not in {row.name for row in rows.rows}


def test_held_rotor_errs_by_its_weight_too(upright):
    """A blade that hangs in its frame: what its modes lack of the static sag under its weight."""
    blade = bar("z").clamped("left")
    reduced = blade.reduce(2)
    mbs = exudyn.SystemContainer().AddSystem()
    options = {"spin": 0.0, "translation": "none", "gravity": [0.0, -9.81, 0.0]}
    body = add_rotor(mbs, reduced, marker_body=True, markers="position", **options)
    body.start_recording()
    mbs.Assemble()
    settings = recommended_settings(0.5, 0.01)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.0
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.1
    mbs.SolveDynamic(settings)
    load = blade.mass @ np.tile([0.0, -9.81, 0.0], blade.node_count)
    sag = np.linalg.solve(blade.stiffness.toarray(), load)
    modes = reduced.shapes.matrix
    lacking = sag - modes @ (modes.T @ load / reduced.frequencies**2)
    found = at_nodes(body, reduced, blade)
    for values, field in ((found.displacement, lacking), (found.moved, sag)):
        expected = np.linalg.norm(field.reshape(-1, 3), axis=1).max()
        assert values[-1].max() == pytest.approx(expected, rel=1e-2)


def test_what_does_not_fit_is_refused(ran, upright, eccentric):
    reduced, body = ran
    fewer, bare = keep_modes(reduced, [0, 1]), reduced.without_shapes()
    for given, text in (
        ({"nodes": [1]}, "nodes: the error at nodes needs the full model"),
        ({"solid": upright}, "solid: the error at nodes needs the modes"),
        ({"solid": upright, "reduced": fewer}, "reduced: has other modes"),
        ({"solid": upright, "reduced": bare}, "reduced: has no shapes"),
        ({"solid": eccentric, "reduced": reduced}, "solid: .* is not the model of"),
        ({"solid": upright, "reduced": reduced, "nodes": [20]}, "nodes"),
        ({"solid": upright, "reduced": reduced, "nodes": []}, "nodes: needs one or more"),
    ):
        with pytest.raises(ValueError, match=text):
            check_run(body, **given)
    with pytest.raises(TypeError, match="solid"):
        check_run(body, reduced=reduced, solid=reduced)
    mbs = exudyn.SystemContainer().AddSystem()
    lone = add_rotor(mbs, reduced, marker_body=False)
    mbs.Assemble()
    with pytest.raises(ValueError, match=r"solid: .* marker_body=False"):
        check_run(lone, reduced=reduced, solid=upright)


@pytest.mark.parametrize(
    ("rotor", "turn"), [("upright", [0.0, 0.0, 0.0]), ("eccentric", [0.3, 0.5, -0.2])]
)
def test_loads_of_a_scene_are_told_by_its_motion(rotor, turn, request):
    """Springs at the ends, force and torque on a marker at nodes, a force on a script's marker."""
    solid = request.getfixturevalue(rotor)
    reduced = solid.reduce(16)
    mbs = exudyn.SystemContainer().AddSystem()
    R = Rotation.from_rotvec(turn).as_matrix()
    options = {"spin": 0.0, "translation": "none", "condense_markers": False}
    body = add_rotor(mbs, reduced, rotation=R, **options)
    ground, on_body = mbs.CreateGround(), body.objects["marker_body"]
    points = {name: end.reference for name, end in solid.interfaces.items()}
    arm = np.array([0.02, 0.01, 0.03])
    points["right"] = points["right"] + arm
    markers = {"left": body.marker("left"), "right": body.add_marker("right", arm)}
    for name, marker in markers.items():
        spring = {"stiffness": [2e5] * 3, "localPosition0": R @ points[name]}
        mbs.CreateCartesianSpringDamper(itemNumbers=[ground, marker], **spring)
    some, offset = [2, 5, 9, 12], np.array([0.01, 0.02, 0.0])
    rigid = body.add_marker(some, offset)
    force, torque, other = np.array([[3.0, 5.0, -2.0], [0.4, -0.2, 0.1], [0.0, 7.0, 1.0]])
    mbs.CreateForce(itemNumber=rigid, loadVector=force)
    mbs.CreateTorque(itemNumber=rigid, loadVector=torque)
    own = mbs.AddMarker(
        MarkerSuperElementPosition(bodyNumber=on_body, meshNodeNumbers=[4], weightingFactors=[1.0])
    )
    mbs.AddLoad(LoadForceVector(markerNumber=own, loadVector=other))
    body.add_marker("left")  # nothing acts there
    body.start_recording()
    mbs.Assemble()
    solve(mbs, 20, 2e-3)
    record = body.recorded()
    loads = recorded_states(body, record, np.array([20]))[0]
    found = place_loads(body, loads, Measures(body, record).size)
    places = {place.interface or len(place.motion): (place, each) for place, each in found}
    assert set(places) == {"left", "right", 6, 3}
    assert len(found) == 4
    zeta = record.q[20][body.layout.unknowns][body.motion.modes]
    for name in ("left", "right"):
        place, each = places[name]
        moved = reduced.interfaces[name].motion @ body.selection.T @ zeta
        lever = np.cross(moved[3:], points[name] - solid.interfaces[name].reference)
        np.testing.assert_allclose(each[:, 0], -2e5 * (moved[:3] + lever), atol=1e-4)
        np.testing.assert_allclose(place.point, points[name], atol=1e-12)
        columns = place.load_columns(solid)
        rigid = np.hstack([translations(solid.node_count), rotations(solid.nodes, points[name])])
        np.testing.assert_allclose(rigid.T @ columns, np.eye(6, 3), atol=1e-9)
        assert set(np.flatnonzero(columns.any(axis=1)) // 3) == set(solid.interfaces[name].nodes)
    np.testing.assert_allclose(places[6][1][:, 0], [*force @ R, *torque @ R], atol=1e-4)
    np.testing.assert_allclose(places[3][1][:, 0], other @ R, atol=1e-4)
    # total force and moment about the point of the marker
    point = solid.nodes[some].mean(axis=0) + offset
    columns = places[6][0].load_columns(solid)
    motions = np.hstack([translations(solid.node_count), rotations(solid.nodes, point)])
    np.testing.assert_allclose(motions.T @ columns, np.eye(6), atol=1e-9)
    assert set(np.flatnonzero(columns.any(axis=1)) // 3) == set(some)
    single = places[3][0].load_columns(solid)
    np.testing.assert_array_equal(single[12:15], np.eye(3))
    assert np.count_nonzero(single) == 3


def test_loads_beside_the_reference_point_have_a_moment(upright):
    reduced = upright.reduce(0)
    arm, force = np.array([0.1, 0.2, 0.3]), np.array([[5.0], [7.0], [11.0]])
    motion = np.zeros((3, reduced.size))
    point = reduced.interfaces["right"].reference + arm
    beside, elsewhere = (LoadPlace(point, motion, name, None) for name in ("right", None))
    total = at_interfaces(reduced, [(beside, force), (beside, force), (elsewhere, force)], 1)
    order = list(reduced.interfaces).index("right")
    expected = np.zeros((2, 6))
    expected[order] = 2.0 * np.r_[force[:, 0], np.cross(arm, force[:, 0])]
    np.testing.assert_allclose(total[:, 0], expected.ravel(), atol=1e-14)
