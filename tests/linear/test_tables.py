"""Supports with coefficients over speed and frequency, against models that carry the states."""

import warnings
from dataclasses import replace
from functools import partial

import exudyn as exu
import numpy as np
import pytest

from exudyn_rotor import (
    AnnularSeal,
    ClearanceStop,
    Foundation,
    HarmonicForce,
    MagneticBearing,
    Mount,
    OilFilm,
    PIDController,
    SaturatingActuator,
    SolidRotor,
    Support,
    TiltingPadBearing,
    Unbalance,
    add_rotor,
    add_supports,
    campbell,
    critical_speeds,
    grooved_pads,
    harmonic_response,
    linear_model,
    mode_shapes,
    periodic_response,
    stability_map,
    stability_threshold,
    static_response,
    unbalance_response,
)
from tests.models import disc_rotor, disc_with_craig_bampton_modes

NAMES = ("left", "right")
SPEED = 300.0


def rotor():
    """Two masses of 2 kg on a rigid rod."""
    rod = 1e12 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    made = SolidRotor.from_matrices(2.0 * np.eye(6), rod, [[0, 0, -0.1], [0, 0, 0.1]], "z")
    return made.with_interface("left", [0]).with_interface("right", [1])


def magnetic(name):
    return MagneticBearing(
        interface=name,
        actuator=SaturatingActuator(constant=1e-5, bias_current=2.0, gap=4e-4, current_limit=6.0),
        controller=PIDController(
            proportional=2e4, derivative=20.0, filter_frequency=2e4, amplifier_frequency=1e4
        ),
    )


def pads(name, inertia=2e-3):
    film = OilFilm(
        radius=0.05,
        length=0.05,
        viscosity=0.02,
        pads=grooved_pads(1.5e-4, np.radians([54.0, 126.0, 198.0, 270.0, 342.0]), 0.2, preload=0.5),
        nodes=24,
        axial_nodes=0,
    )
    load = [0.0, -2000.0]
    return TiltingPadBearing(interface=name, film=film, load=load, pad_inertia=inertia)


def seal(name):
    return AnnularSeal(
        interface=name, radius=0.1, length=0.04, clearance=3e-4, pressure_drop=1e6,
        density=1000.0, viscosity=1e-3,
    )  # fmt: skip


KINDS = {"magnetic bearing": magnetic, "pads with inertia": pads, "seal with inertia": seal}
LIMITS = dict(zip(KINDS, (2.2e7, 3.8e8, 1.7e7), strict=True))  # about, of cross-coupling [N/m]


@pytest.fixture(scope="module", params=KINDS)
def both(request):
    """Return bearings, and their tables at many frequencies."""
    given = [KINDS[request.param](name) for name in NAMES]
    dense = np.union1d(np.linspace(1.0, 3000.0, 3000), np.geomspace(3000.0, 1e5, 300))
    return given, [one.table([SPEED, SPEED + 1.0], dense) for one in given]


def test_responses_are_those_of_the_bearing_with_its_states(both):
    with_states, tables = both
    force, unbalance = HarmonicForce("left", (1.0, 0.5j)), Unbalance("left", 1e-5)
    frequencies = [1.0, 100.0, 333.4, 1234.5]
    found, expected = (
        harmonic_response(rotor(), frequencies, force, supports=given, speed=SPEED)
        for given in (tables, with_states)
    )
    for name in NAMES:
        for along in ("n1", "n2"):
            pair = found.phasor(name, along), expected.phasor(name, along)
            assert pair[0] == pytest.approx(pair[1], rel=1e-6)
    found, expected = (
        unbalance_response(rotor(), [SPEED], unbalance, supports=given)
        for given in (tables, with_states)
    )
    assert found.semi_axes("left")[0] == pytest.approx(expected.semi_axes("left")[0], rel=1e-6)


def test_each_motion_has_the_coefficients_of_its_own_frequency(both):
    with_states, tables = both
    motions = campbell(rotor(), [SPEED], supports=[each for each in tables])
    for growth, frequency in zip(motions.growth[0], motions.frequencies_inertial[0], strict=True):
        if not 1.0 < frequency < 2e3:
            continue
        exact = [one.table([SPEED], [frequency]) for one in with_states]
        M, D, K, *_ = linear_model(rotor(), supports=exact).matrices(SPEED)
        value = growth + 1j * frequency
        singular = np.linalg.svd(K + value * D + value**2 * M, compute_uv=False)
        shifted = value * (1.0 + 1e-6)
        moved = np.linalg.svd(K + shifted * D + shifted**2 * M, compute_uv=False)
        assert singular[-1] < 0.5 * moved[-1]


@pytest.mark.parametrize("kind", KINDS)
def test_at_the_limit_of_stability_a_motion_is_that_of_the_states(kind):
    """There it neither grows nor decays, as the motions that the coefficients are of."""
    with_states = [KINDS[kind](name) for name in NAMES]
    tables = [
        one.table([SPEED, SPEED + 1.0], np.linspace(1.0, 6000.0, 6000)) for one in with_states
    ]
    stiffness = 1e6 if kind.startswith("seal") else 0.0

    def beside(given: list, cross: float) -> list:
        matrix = [[stiffness, cross], [-cross, stiffness]]
        return [*given, Support("left", matrix), Support("right", stiffness)]

    low, high = 0.9 * LIMITS[kind], 1.1 * LIMITS[kind]
    how = {"speed": SPEED, "samples": 2, "accuracy": None}
    limits, values = [], []
    for given in (with_states, tables):
        supports = partial(beside, given)
        found = stability_threshold(rotor(), low, high, supports=supports, **how)
        [limit] = found.values
        state = campbell(rotor(), [SPEED], supports=beside(given, limit), accuracy=None)
        limits.append(limit)
        growth, frequencies = state.growth[0], state.frequencies_inertial[0]
        whirls = (frequencies > 1.0) & (frequencies < 1e4)  # the rod's stretch is faster
        values.append(frequencies[np.nanargmin(np.where(whirls, np.abs(growth), np.inf))])
    assert limits[1] == pytest.approx(limits[0], rel=1e-6)
    assert values[1] == pytest.approx(values[0], rel=1e-6)


def test_closed_forms_of_a_spring_behind_a_damper():
    """Of k + c iω a/(iω + a): critical speeds, a map, and the frequency zero."""
    k, c, a, m = 1e4, 2e4, 80.0, 2.0
    w = np.linspace(0.0, 400.0, 4001)
    K, D = (
        x[:, None, None] * np.eye(2) for x in (k + c * w**2 / (w**2 + a**2), c * a / (w**2 + a**2))
    )
    given = [Support.from_table(n, frequencies=w, stiffness=K, damping=D) for n in NAMES]
    found = critical_speeds(rotor(), supports=given, max_speed=300.0, nodal_diameters=[1])
    own = np.sqrt(np.roots([m, m * a**2 - k - c, -k * a**2]).max())
    assert found.speeds == pytest.approx(own, rel=1e-6)
    twice = critical_speeds(rotor(), supports=given, max_speed=300.0, nodal_diameters=[1], order=2)
    assert twice.speeds == pytest.approx(0.5 * own, rel=1e-6)
    sag = static_response(rotor(), {"left": [1.0, 0.0, 0.0]}, supports=given, speed=50.0)
    assert sag.displacement[0, 0] == pytest.approx(1.0 / k, rel=1e-9)
    growth = campbell(rotor(), [0.0], supports=given).growth
    held = [*given, Support("left", np.diag([0.0, 0.0, 1e5]), np.diag([0.0, 0.0, 1e3]))]
    mapped = stability_map(
        lambda x, y: (linear_model(rotor(), supports=held), y), [0.0], [0.0, 9.0]
    )
    assert mapped.growth.ravel() == pytest.approx(np.max(growth[growth < -1.0]), rel=1e-6)


def test_six_by_six_is_a_rigid_housing_on_springs():
    """The housing, seen from the bearing in its middle; a stiff support holds the shaft in it."""
    made = disc_with_craig_bampton_modes()
    at = made.axis.project(made.interfaces["left"].reference)
    k, d, mass, inertia = np.array([2e6, 3e6, 1e6]), np.array([20.0, 10.0, 30.0]), 3.0, 0.02
    places = np.array([[x, y, 0.03] for x in (-0.1, 0.1) for y in (-0.05, 0.05)])
    K, D = np.zeros((2, 6, 6))
    for x, y, z in places:
        B = np.hstack([np.eye(3), [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]])
        K += B.T @ np.diag(k) @ B
        D += B.T @ np.diag(d) @ B
    M = np.diag([mass] * 3 + [inertia] * 3)
    for X in (K, D, M):
        X[5], X[:, 5] = 0.0, 0.0  # a bearing does not hold the spin
    both = {"speeds": [0.0, 1000.0], "stiffness": [K] * 2, "damping": [D] * 2, "mass": [M] * 2}
    housing = Support.from_table("left", **both)
    block = Foundation.rigid(
        mass, [inertia] * 3, at, [Mount(at + place, k, d) for place in places], {"left": at}
    )
    stiff = Support("left", 1e14 * np.eye(3), tilt_stiffness=1e12 * np.eye(2))
    load, frequencies = HarmonicForce("right", (1.0, 0.0)), [50.0, 400.0, 900.0]
    found, expected = (
        harmonic_response(linear_model(made, **given), frequencies, load, speed=200.0).phasor(
            "right", "n2"
        )
        for given in ({"supports": housing}, {"supports": stiff, "foundation": block})
    )
    assert found == pytest.approx(expected, rel=1e-6)


def test_a_mass_that_differs_in_two_directions():
    """Closed forms of one of both masses: it has a mass of its own in each direction."""
    added, rates, k, c = np.array([1.5, 3.0]), np.array([50.0, 200.0]), 2e4, 10.0
    given = [Support("left", k, c, mass=np.diag(added)), Support("right", k, c)]
    turning = unbalance_response(rotor(), rates, Unbalance("left", 1e-4), supports=given)
    force = HarmonicForce("left", (1.0, 1.0))
    shaken = harmonic_response(rotor(), rates, force, speed=100.0, supports=given)
    for i, direction in enumerate(("n1", "n2")):
        moved = 1.0 / (k - (2.0 + added[i]) * rates**2 + 1j * c * rates)
        load = 1e-4 * rates**2 * (-1j) ** i
        assert turning.phasor("left", direction) == pytest.approx(load * moved, rel=1e-9)
        assert shaken.phasor("left", direction) == pytest.approx(moved, rel=1e-9)
    sag = static_response(rotor(), {"left": [0.0, 1.0, 0.0]}, supports=given)
    assert sag.displacement[0, 1] == pytest.approx(1.0 / k, rel=1e-9)
    with pytest.warns(UserWarning, match="one of a pair"):
        halves = disc_rotor().reduce(1)
    model = replace(linear_model(halves, supports=given), largest_unevenness=2.0)
    assert model.axes == "inertial"


def test_what_has_several_frequencies_at_once_refuses_them():
    given = [
        Support.from_table(n, frequencies=[1.0, 2.0], stiffness=[np.eye(2)] * 2) for n in NAMES
    ]
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor().reduce(0), spin=50.0)
    with pytest.raises(ValueError, match="a scene has no single frequency"):
        add_supports(body, given)
    add_supports(body, [one.at_frequency(1.5) for one in given])
    with pytest.raises(ValueError, match="round"):
        linear_model(rotor(), supports=given, axes="rotor").at(1.0)
    stop = ClearanceStop(interface="left", radius=0.05, clearance=1e-3, stiffness=1e6)
    with pytest.raises(ValueError, match="periodic motion has several"):
        periodic_response(rotor(), [5.0], Unbalance("left", 1e-3), supports=[*given, stop])
    with pytest.warns(UserWarning, match="holds 1 to 2 rad/s, and keeps its ends for motions of 5"):
        unbalance_response(rotor(), [5.0], Unbalance("left", 1e-3), supports=given)


@pytest.mark.parametrize("shown", [campbell, mode_shapes])
def test_motions_beyond_a_table_are_told_where_they_are_shown(shown):
    """√(k/m) is 71 rad/s of one end and 141 rad/s of the other."""
    given = [
        Support.from_table(name, frequencies=[1.0, 100.0], stiffness=[k * np.eye(2)] * 2)
        for name, k in zip(NAMES, (1e4, 4e4), strict=True)
    ]
    speed = [5.0] if shown is campbell else 5.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shown(rotor(), speed, supports=given, modes=3)
    with pytest.warns(UserWarning, match="keeps its ends for motions of 141.42 to 141.42 rad/s"):
        shown(rotor(), speed, supports=given, modes=5)


def test_a_motion_in_a_jump_is_nan_and_costs_no_other():
    stiffness = np.multiply.outer([1e8, 1e8, 1e3, 1e3], np.eye(2))
    jump = Support.from_table(
        "left", frequencies=[0.0, 50.0, 50.0 + 1e-9, 2e3], stiffness=stiffness
    )
    with pytest.warns(UserWarning, match="do not settle at their own frequency"):
        found = campbell(rotor(), [0.0], supports=[jump, Support("right", 1e4)], accuracy=None)
    values = found.frequencies_inertial[0]
    assert np.isnan(values).sum() == 2
    assert values[~np.isnan(values)][1:3] == pytest.approx(np.sqrt(1e4 / 2.0), rel=1e-6)
