"""Scenes linearised over a revolution, against linear rotors and against their own simulation."""

import exudyn as exu
import numpy as np
import pytest
from apart import distance, exponents
from asymmetric import LENGTH, asymmetric_shaft
from exudyn.itemInterface import (
    CoordinateConstraint,
    CoordinateSpringDamper,
    MarkerNodeCoordinate,
    Node1D,
    NodePointGround,
    Rotor1D,
    SensorNode,
)
from exudyn.rigidBodyUtilities import InertiaCuboid
from point_rotors import ring_rotor
from run_scenes import solve

from exudyn_rotor import (
    Drag,
    PrescribedMotion,
    SolidRotor,
    add_drive,
    add_rotor,
    add_supports,
    campbell,
    linear_model,
    stability,
    steady_state,
)
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.over import motions_over

BEARING = np.array([2.0e6, 1.2e6, 3e6]), np.array([300.0, 200.0, 100.0])
SPEED = 200.0


def rings(modes=2, unbalance=1e-3):
    """Return a slightly eccentric rotor with two flexible modes, z from −0.15 to 0.15 m.

    These are half of a pair each; without them the rotor is round but for its eccentric mass.
    """
    rotor = ring_rotor(0.1, 0.15, 5.0).add_point_mass([0.1, 0.0, 0.15], unbalance)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.reduce(modes)


def on_springs(markers="position", law=None, modes=2, reduced=None, **options):
    """Return an mbs with the rings on two springs to the ground, and the body."""
    reduced = reduced or rings(modes)
    mbs = exu.SystemContainer().AddSystem()
    kinds = dict.fromkeys(reduced.interfaces, markers)
    body = add_rotor(mbs, reduced, markers=kinds, **options)
    ground = mbs.CreateGround()
    for name in reduced.interfaces:
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=list(reduced.interfaces[name].reference),
            stiffness=list(BEARING[0]),
            damping=list(BEARING[1]),
            springForceUserFunction=law or 0,
        )
    mbs.Assemble()
    return mbs, body


def in_a_list(modes=2, rotor=None):
    """Return the rings, or another rotor, on the same springs."""
    supports = [Support(name, *map(np.diag, BEARING)) for name in ("left", "right")]
    return linear_model(rotor or rings(modes), supports=supports)


@pytest.mark.parametrize(
    ("markers", "options"),
    [
        ("position", {"spin": "free", "initial_speed": 31.0}),
        ("rigid", {"spin": 31.0, "translation": "none"}),
        ("rigid", {"translation": "in-plane", "initial_angle": 0.4}),
        ("position", {"spin": SPEED, "locking": "constraints"}),
        ("position", {"spin": "free", "translation": "none", "gravity": [0.0, -9.81, 0.0]}),
        ("position", {"spin": PrescribedMotion.run_up(0.0, 9.0, 1.0)}),
    ],
)
@pytest.mark.parametrize(("modes", "axes"), [(0, "inertial"), (2, "rotor")])
def test_springs_are_supports(markers, options, modes, axes):
    mbs, body = on_springs(markers, modes=modes, **options)
    model, expected = linear_model(mbs, body=body), in_a_list(modes=modes)
    assert model.axes == expected.axes == axes
    assert distance(model, expected, SPEED) < 1e-7
    assert distance(model, expected, 0.0) < 1e-7


@pytest.mark.parametrize("modes", [0, 2])
def test_interface_motion_and_unbalance_agree_with_the_list(modes):
    mbs, body = on_springs("rigid", spin=SPEED, translation="none", drive="elastic", modes=modes)
    model, expected = linear_model(mbs, body=body), in_a_list(modes=modes)
    for name in ("left", "right"):
        found, seen = model.seen(name), expected.seen(name)
        assert all(np.allclose(found[n], seen[n], rtol=0.0, atol=1e-12) for n in seen)
    found, load = model.unbalance(), expected.unbalance()
    assert all(np.allclose(found[n], load[n], rtol=0.0, atol=1e-15) for n in load)
    assert max(np.abs(each).max() for each in load.values()) > 1e-6


def foundation_scene(speed):
    """Return an asymmetric shaft on anisotropic bearings on a sprung block, and the body."""
    mbs = exu.SystemContainer().AddSystem()
    markers = {"left": "position", "right": "position"}
    body = add_rotor(mbs, asymmetric_shaft(), spin=speed, translation="none", markers=markers)
    block = InertiaCuboid(density=2500.0, sideLengths=[0.3, 0.1, 0.5])
    node = exu.NodeType.RotationRxyz
    base = mbs.CreateRigidBody(inertia=block, referencePosition=[0, -0.2, 0], nodeType=node)
    ground = mbs.CreateGround()
    for x, z in ((-0.15, -0.25), (-0.15, 0.25), (0.15, -0.25), (0.15, 0.25)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, base],
            localPosition0=[x, -0.25, z],
            localPosition1=[x, -0.05, z],
            stiffness=[4e5, 6e5, 5e5],
            damping=[100.0] * 3,
        )
    for name, z in (("left", -LENGTH / 2), ("right", LENGTH / 2)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[base, body.marker(name)],
            localPosition0=[0, 0.2, z],
            stiffness=[3e5, 5e5, 1e6],
            damping=[20.0, 30.0, 20.0],
        )
    mbs.AddSensor(
        SensorNode(
            nodeNumber=body.nodes["modes"],
            outputVariableType=exu.OutputVariableType.Coordinates,
            storeInternal=True,
            writeToFile=False,
        )
    )
    mbs.Assemble()
    return mbs, body


def measured_growth(mbs, body, speed, steps, size=1e-5, revolutions=20):
    """Return growth [1/s] of the least stable motion in the transient simulation.

    It starts with its Floquet vector; once per revolution the state lies in the plane of the
    vector's real and imaginary part, and its coefficient there grows as ``exp(λt)``.
    """
    model = linear_model(mbs, body=body, axes="rotor")
    [found] = motions_over(model, [speed], method="floquet")
    most = np.argmax(found.values.real)
    value, X = found.values[most], found.vectors[:, :, most]
    scene = model.scene
    y, y_t = np.zeros((2, scene.size), dtype=complex)
    for rows, place, terms in model.in_scene(model.assembly(speed)):
        for m, L in terms.items():
            for n, x in zip(found.orders.tolist(), X, strict=True):
                y[rows] += L @ x[place]
                y_t[rows] += (value + 1j * (m + n) * speed) * (L @ x[place])
    y, y_t = (size * each / np.abs(y).max() for each in (y, y_t))
    T, T1, _ = scene.turn(0.0)
    q, q_t = scene.rest.copy(), np.array(mbs.systemData.GetODE2Coordinates_t())
    q[scene.free] += (T @ y).real
    q_t[scene.free] = (T @ y_t + speed * T1 @ y).real
    mbs.systemData.SetODE2Coordinates(q, exu.ConfigurationType.Initial)
    mbs.systemData.SetODE2Coordinates_t(q_t, exu.ConfigurationType.Initial)
    period = 2.0 * np.pi / speed
    rule = exu.DynamicSolverType.TrapezoidalIndex2
    solve(mbs, revolutions * steps, revolutions * period, period, solverType=rule)
    data = mbs.GetSensorStoredData(0)
    shape = (T @ y)[: data.shape[1] - 1]
    plane = np.column_stack([shape.real, -shape.imag])
    parts = np.linalg.lstsq(plane, data[:, 1:].T, rcond=1e-9)[0]
    return np.polyfit(data[:, 0], np.log(np.hypot(*parts)), 1)[0]


def test_growth_is_that_of_the_transient_simulation():
    speed, measured = 160.0, []
    for steps in (400, 800):
        mbs, body = foundation_scene(speed)
        measured.append(measured_growth(mbs, body, speed, steps))
    [found] = motions_over(linear_model(mbs, body=body), [speed], method="floquet")
    growth = found.values.real.max()
    assert growth > 0.0
    # the trapezoidal rule's error falls with the square of the step
    limit = (4.0 * measured[1] - measured[0]) / 3.0
    assert abs(measured[1] / limit - 1.0) > 1e-5
    assert limit == pytest.approx(growth, rel=1e-4)


HARDENING, WEIGHT = 1e13, 9.81  # [N/m³], [m/s²]


def hardening(mbs, t, item, displacement, velocity, stiffness, damping, offset):
    x, y, z = displacement
    return [2e4 * x, 2e4 * y + HARDENING * y**3, 2e4 * z]


def test_nonlinear_bearings_are_linearised_at_the_sag():
    # the sag y of m g / 2 = k y + k₃ y³; tangent k + 3 k₃ y²
    reduced = rings(0, unbalance=1e-9)
    mbs, body = on_springs(law=hardening, reduced=reduced, gravity=[0.0, -WEIGHT, 0.0])
    sag = np.roots([HARDENING, 0.0, 2e4, -2.5 * WEIGHT])
    sag = sag[np.abs(sag.imag) < 1e-12].real[0]
    tangent = np.diag([2e4, 2e4 + 3.0 * HARDENING * sag**2, 2e4])
    assert tangent[1, 1] > 2.0 * 2e4
    supports = [Support(name, tangent) for name in ("left", "right")]
    expected = linear_model(reduced, supports=supports)
    assert distance(linear_model(mbs, body=body), expected, SPEED) < 1e-5


def test_refused_scenes():
    mbs, body = on_springs()
    add_rotor(mbs, rings(), name="second")
    with pytest.raises(ValueError, match="not assembled"):
        linear_model(mbs, body=body)
    mbs.Assemble()
    with pytest.raises(ValueError, match="second rotor"):
        linear_model(mbs, body=body)


def with_item(item, node="rigid", coordinate=5, inertia=0.0, **options):
    """Return rings with an item between a coordinate, the spin, and the ground or a flywheel."""
    mbs, body = on_springs("rigid", modes=0, initial_speed=SPEED)
    first = mbs.AddNode(Node1D(referenceCoordinates=[0.0]) if inertia else NodePointGround())
    if inertia:
        mbs.AddObject(Rotor1D(inertia=inertia, nodeNumber=first))
    places = {first: 0, body.nodes[node]: coordinate}.items()
    ends = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=n, coordinate=c)) for n, c in places]
    mbs.AddObject(item(markerNumbers=ends, **options))
    mbs.Assemble()
    return mbs, body


def test_what_acts_otherwise_as_the_rotor_turns_is_refused():
    mbs, body = with_item(CoordinateSpringDamper, "modes", 1, stiffness=1e6)
    with pytest.raises(ValueError, match=r"otherwise as the rotor turns.*add_disc"):
        linear_model(mbs, body=body).matrices(SPEED)
    assert not linear_model(mbs, body=body, axes="rotor").at(SPEED).is_constant


def test_a_constraint_holds_a_free_spin():
    mbs, body = with_item(CoordinateConstraint, velocityLevel=True, offset=SPEED)
    lateral = campbell(in_a_list(modes=0), [SPEED]).frequencies_inertial[0, 1:]
    found = campbell(mbs, [SPEED], body=body).frequencies_inertial[0]
    np.testing.assert_allclose(found, lateral, rtol=1e-6)


@pytest.mark.parametrize("inertia", [0.0, 0.02])
def test_springs_on_a_free_spin_are_refused(inertia):
    mbs, body = with_item(CoordinateSpringDamper, stiffness=50.0, inertia=inertia)
    for analysis in (lambda: stability(mbs, [SPEED], body=body), lambda: steady_state(body)):
        with pytest.raises(ValueError, match="holds the free spin, 50 N m/rad"):
            analysis()


def test_dampers_on_a_free_spin_are_refused_and_drag_is_not():
    mbs, body = with_item(CoordinateSpringDamper, damping=0.5)
    with pytest.raises(ValueError, match=r"brakes the free spin, 0.5 N m s/rad.*Drag"):
        stability(mbs, [SPEED], body=body)
    assert steady_state(body).speed == linear_model(mbs, body=body).undamped().at(SPEED).speed
    mbs, body = on_springs("rigid", modes=0, initial_speed=SPEED)
    drive = add_drive(body, Drag(linear=0.5))
    mbs.Assemble()
    assert stability(mbs, [SPEED], body=body).stable.all()
    assert drive.values()[0] == -0.5 * SPEED  # as before the analysis


def test_an_own_spin_that_nothing_holds_is_refused():
    _, body = on_springs("rigid", spin=SPEED, drive="elastic", modes=0)
    with pytest.raises(ValueError, match=r"own spin.*tilt_stiffness"):
        steady_state(body)


# ------------------------------------------------------------------ as in lists


def on_two_supports(rotor, **options):
    """Return a scene and a list of a rotor on two supports."""
    mbs, in_list = exu.SystemContainer().AddSystem(), in_a_list(rotor=rotor)
    body = add_rotor(mbs, rotor, **options)
    add_supports(body, in_list.supports[""])
    mbs.Assemble()
    return linear_model(mbs, body=body), in_list


def test_what_the_basis_leaves_out_is_known_in_scenes():
    models = on_two_supports(rings(0), spin=SPEED)
    errors = [campbell(model, [SPEED]).basis_errors[0] for model in models]
    errors = [np.sort(each[np.isfinite(each)])[-4:] for each in errors]
    assert errors[1].max() > 1e-6
    np.testing.assert_allclose(errors[0], errors[1], rtol=1e-6, atol=1e-9)
    mbs, body = on_springs("rigid", modes=0, spin=SPEED)
    foreign = campbell(mbs, [SPEED], body=body)  # forces that do not know more shapes
    assert foreign.basis_errors is None
    assert "not known" in foreign.table()


def test_waves_of_many_nodal_diameters_are_told_by_mesh_nodes_as_in_lists():
    ring = ring_rotor(0.1, 0.15, 5.0)
    soft = SolidRotor.from_matrices(ring.mass, 1e-4 * ring.stiffness, ring.nodes, "z")
    rotor = soft.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(24)
    free, in_list = on_two_supports(rotor, initial_speed=20.0)
    driven, _ = on_two_supports(rotor, spin=20.0)
    for model, held in ((free, False), (driven, True)):
        found, expected = (exponents(one, 20.0, held=held) for one in (model, in_list))
        np.testing.assert_allclose(np.sort(np.abs(found)), np.sort(np.abs(expected)), atol=1e-6)
