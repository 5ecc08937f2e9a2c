"""Estimates of what a basis leaves out, against the full model of the same mesh."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from models import STEEL, block_beam, centered_disc, disc_rotor
from small_results import rotor as stored_rotor

from exudyn_rotor import (
    Campbell,
    HarmonicForce,
    ReducedRotor,
    SolidRotor,
    SpinAxis,
    Support,
    Unbalance,
    campbell,
    craig_bampton_modes,
    critical_speed_map,
    critical_speeds,
    harmonic_response,
    keep_modes,
    linear_model,
    stability,
    stability_map,
    stability_threshold,
    unbalance_response,
    unstable_ranges,
)
from exudyn_rotor.linear.models.basis.basis_error import NOT_KNOWN, relative_errors
from exudyn_rotor.linear.response.basis_check import looked_at
from exudyn_rotor.reduction.inertial_modes import inertial_modes
from exudyn_rotor.solvers.inertia_relief import inertia_relief

MODES = 8
# of an eigenvalue: energies below a thousandth, at the fastest speed of any rim, are left out
SMALL = 1e-4
SPEEDS = [0.0, 2500.0]
LIMIT = 4000.0  # rad/s, of eigenvalues that are looked at
PAIR = 0.02  # relative distance of modes that the mesh splits: which of them errs is not told


def supports(kind: str) -> list[Support]:
    across = {"soft": 1e6, "stiff": 1e8, "anisotropic": [[1e7, 0.0], [0.0, 4e7]]}[kind]
    return [Support(name, across, damping=200.0) for name in ("left", "right")]


@cache
def solid(level: str) -> SolidRotor:
    rotor = centered_disc(order=1)
    return rotor.with_prestress(rotor.prestress()) if level == "full" else rotor


@cache
def reference(level: str, kind: str) -> Campbell:
    given = {"supports": supports(kind), "stiffening": level}
    if kind == "anisotropic":  # the full model takes long
        return campbell(reduced(level, "RBE3 16"), SPEEDS, accuracy=None, **given)
    return campbell(solid(level), SPEEDS, modes=MODES, **given)


@cache
def reduced(level: str, modes: str) -> ReducedRotor:
    how, count = modes.split()
    rotor = solid(level)
    if how == "free":
        return rotor.reduce(int(count))
    return rotor.reduce(craig_bampton_modes(rotor, int(count), coupling=how))


@pytest.mark.parametrize(
    ("level", "kind", "modes"),
    [
        ("tilt", "soft", "free 4"),
        ("tilt", "stiff", "free 12"),
        ("tilt", "stiff", "RBE3 2"),
        ("tilt", "anisotropic", "free 6"),
        ("full", "stiff", "free 6"),
        ("full", "soft", "RBE3 4"),
    ],
)
def test_estimates_are_the_errors_against_the_full_model(level, kind, modes):
    full, rotor = reference(level, kind), reduced(level, modes)
    given = {"supports": supports(kind), "stiffening": level}
    result = campbell(rotor, full.speeds, modes=rotor.size, **given)
    lowest = campbell(rotor, full.speeds, **given).basis_shifts
    known = np.isfinite(lowest)
    assert 6 <= known.sum(axis=1).min() < rotor.size
    np.testing.assert_allclose(lowest[known], result.basis_shifts[known], rtol=1e-6, atol=1e-6)
    close = []
    for row in range(len(full.speeds)):
        true = full.growth[row] + 1j * full.frequencies_rotor[row]
        given = result.growth[row] + 1j * result.frequencies_rotor[row]
        looked_at = (np.abs(given) < LIMIT) & (given != 0.0)
        given, shifts = given[looked_at], result.basis_shifts[row, looked_at]
        errors = true[np.argmin(np.abs(true - (given + shifts)[:, None]), axis=1)] - given
        pairs = np.abs(given - given[:, None]) < PAIR * np.abs(given)
        of_pairs = [np.where(pairs, np.abs(each), 0.0).max(axis=1) for each in (shifts, errors)]
        estimate, error = (np.maximum(each, SMALL * np.abs(given)) for each in of_pairs)
        assert np.all((estimate < 3.0 * error) & (error < 3.0 * estimate))
        seen = np.abs(errors) > 10.0 * SMALL * np.abs(given)
        close += list(np.abs(shifts - errors)[seen] < 0.2 * np.abs(errors)[seen])
    assert len(close) >= 2
    assert sum(close) > 0.6 * len(close)


@pytest.mark.parametrize("kind", ["turned", "along", "own", "stressed"])
def test_static_responses_to_inertia_forces_are_complete(kind):
    """Their energy, by the full stiffness, is in the modes and the responses added to them."""
    rotor = SolidRotor.from_ngsolve(block_beam(0.05), STEEL, "z", order=1)
    rotor = rotor.with_prestress(rotor.prestress())
    component = craig_bampton_modes(rotor, 2, coupling="RBE3")
    basis = rotor.reduce(component).shapes.matrix
    stiffness = np.maximum(np.einsum("ik,ik->k", basis, rotor.stiffness @ basis), 0.0)
    stiffness[:6] = 0.0
    added = inertial_modes(rotor, component.matrix, basis, stiffness).matrix
    count, elastic = rotor.node_count, basis[:, 6:]
    speed = 1000.0 / np.linalg.norm(rotor.axis.radial(rotor.nodes), axis=1).max()
    e = np.diag(rotor.axis.direction)
    loads = {
        "turned": speed * rotor.mass @ (np.kron(np.eye(count), rotor.axis.skew) @ basis),
        "along": speed * rotor.mass @ (np.kron(np.eye(count), e) @ basis),
        "own": rotor.stiffness @ elastic / np.sqrt(stiffness[6:]),
        "stressed": speed * rotor.carried_prestress.matrix @ basis,
    }[kind]
    loads = loads - rotor.mass @ (basis @ (basis.T @ loads))
    whole = np.einsum("ik,ik->k", loads, inertia_relief(rotor).solve(loads))
    columns = np.hstack([elastic, added])
    work = columns.T @ loads
    part = np.einsum("ik,ik->k", work, np.linalg.solve(columns.T @ rotor.stiffness @ columns, work))
    assert whole.max() > 5e-3
    assert np.all(whole - part < 1e-3)


def test_inertia_forces_along_the_axis_bend_a_blade_across_its_mode():
    """Of a blade oblique to the axis, whose only mode is bending across its thinner side.

    The loads ``MẽẽQ`` have a part across the other side, which ``MẽQ``, along the blade, has not.
    Modes of both sides, or rigid tilts, would make the part along the axis one of those.
    """
    axis = SpinAxis((0.6, 0.8, 0.0), (0.0, 0.0, 0.0))
    blade = SolidRotor.from_ngsolve(block_beam(0.05), STEEL, axis, order=1).clamped("left")
    basis = blade.reduce(1).shapes.matrix
    square = np.einsum("ik,ik->k", basis, blade.stiffness @ basis)
    added = inertial_modes(blade, basis, basis, square).matrix
    along = np.kron(np.eye(blade.node_count), np.outer(axis.direction, axis.direction))
    load = blade.mass @ (along @ basis)
    load -= blade.mass @ (basis @ (basis.T @ load))
    response = inertia_relief(blade).solve(load)
    columns = np.hstack([basis, added])
    reduced = columns.T @ blade.stiffness @ columns
    part = columns @ np.linalg.solve(reduced, columns.T @ load)
    assert part == pytest.approx(response, abs=0.02 * np.abs(response).max())


def test_modes_that_are_dropped_are_known():
    """What `keep_modes` leaves out counts as what no mode was computed for."""
    rotor = reduced("tilt", "free 12")
    fewer = keep_modes(rotor, range(4))
    given = {"supports": supports("stiff"), "modes": 5}
    few, many = (campbell(each, [1000.0], **given) for each in (fewer, rotor))
    values, better = (each.growth + 1j * each.frequencies_rotor for each in (few, many))
    expected = better + many.basis_shifts
    moving = np.abs(values) > 0.0
    found = (values + few.basis_shifts)[moving]
    np.testing.assert_allclose(found, expected[moving], rtol=5e-3)
    assert np.abs(few.basis_shifts).max() > 3.0 * np.abs(many.basis_shifts).max()


def test_errors_are_in_the_table_and_above_the_accuracy_in_a_warning():
    rotor, given = reduced("tilt", "free 4"), {"supports": supports("stiff"), "modes": 5}
    with pytest.warns(UserWarning, match=r"mode \d \(.*\) at .* rpm errs by about .* interfaces"):
        result = campbell(rotor, SPEEDS, **given)
    assert "basis error" in result.table()
    columns = result.columns()["basis error"]
    np.testing.assert_array_equal(columns, result.tracked().basis_errors.ravel())
    # of a frequency at rest it is the share that the frequency is wrong by
    share = np.abs(result.basis_shifts[0].imag[2:]) / result.frequencies_inertial[0, 2:]
    assert np.all(result.basis_errors[0, 2:] >= share)
    held = reduced("tilt", "RBE3 2")
    with pytest.warns(
        UserWarning, match=r"the flexible modes of the reduced rotor \(\d+, up to .* twice as many"
    ):
        campbell(held, SPEEDS, accuracy=1e-6, **given)


@pytest.mark.filterwarnings("error")
def test_no_warning_within_the_accuracy_and_without_a_check():
    rotor, given = reduced("tilt", "free 4"), {"supports": supports("stiff"), "modes": 5}
    unchecked = campbell(rotor, SPEEDS, accuracy=None, **given)
    assert unchecked.basis_errors is None
    assert "error of the basis: not known" in unchecked.table()
    assert np.all(np.isnan(unchecked.columns()["basis error"]))
    campbell(reduced("tilt", "free 12"), SPEEDS, accuracy=0.5, **given)


def test_full_models_have_no_error_and_unknown_ones_say_so():
    full = reference("tilt", "soft")
    assert not np.any(full.basis_shifts)
    assert "basis" not in full.table()
    old = replace(reduced("tilt", "free 4"), attached=None)
    assert campbell(old, [0.0]).basis_shifts is None
    dense = linear_model(disc_rotor(order=1), dense=True)
    assert dense.is_full
    assert stored_rotor(attached=False).in_attached is None


def test_accuracy_is_checked():
    with pytest.raises(ValueError, match="accuracy"):
        campbell(reduced("tilt", "free 4"), [0.0], accuracy=0.0)


@pytest.mark.parametrize("kind", ["soft", "stiff", "anisotropic"])
def test_estimates_of_critical_speeds(kind):
    """Against a basis with twice the modes and all static responses."""
    given = {"supports": supports(kind), "max_speed": 3000.0, "nodal_diameters": [1]}
    better = critical_speeds(reduced("tilt", "free 12").with_attachments, accuracy=None, **given)
    result = critical_speeds(reduced("tilt", "free 6"), **given)
    true = np.abs(better.speeds - result.speeds[:, None])
    expected = true.min(axis=1) / result.speeds
    assert np.all(result.basis_errors > 0.5 * expected)
    size = result.basis_errors * result.speeds
    away = np.abs(true - size[:, None]).min(axis=1)  # of pairs that the mesh splits either one
    assert np.all(away < 0.1 * size)
    assert "basis error" in result.table()


def test_map_of_critical_speeds_has_the_errors_of_each():
    rotor, given = reduced("tilt", "free 6"), {"nodal_diameters": [1], "max_speed": 3000.0}
    with pytest.warns(UserWarning, match="the critical speed of .* rpm errs by about") as told:
        result = critical_speed_map(rotor, ["left", "right"], [1e6, 1e8], **given)
    assert len(told) == 1
    stiff = [Support(name, 1e8) for name in ("left", "right")]
    one = critical_speeds(rotor, supports=stiff, **given)
    np.testing.assert_allclose(result.basis_errors[1, : len(one.speeds)], one.basis_errors)
    assert "basis error up to" in result.table()
    assert critical_speeds(disc_rotor(order=1), max_speed=1000.0).basis_errors.max(initial=0.0) == 0


@pytest.mark.parametrize("modes", ["free 4", "RBE3 2"])
def test_errors_of_unbalance_responses(modes):
    """Against the full model, at interfaces: the finer rotor has their static responses."""
    speeds = [300.0, 1000.0, 2500.0]
    given = {"unbalances": Unbalance("left", 1e-4), "supports": supports("stiff")}
    full = unbalance_response(solid("tilt"), speeds, **given)
    result = unbalance_response(reduced("tilt", modes), speeds, **given)
    assert not np.any(full.basis_errors)
    better, motion = (each.motion[:, :, list(each.orders).index(1), :3] for each in (full, result))
    sizes = np.linalg.norm(better, axis=2)
    sizes = np.maximum(sizes, 0.1 * sizes.max(axis=1, keepdims=True))
    true = np.linalg.norm(better - motion, axis=2) / sizes
    np.testing.assert_allclose(result.basis_errors, true, rtol=0.05, atol=SMALL)
    assert true.max() > 0.01
    assert "basis" in result.table()


def test_errors_of_harmonic_responses_and_of_a_few_speeds_on_anisotropic_supports():
    rotor = reduced("tilt", "free 4")
    force = HarmonicForce("right", (1.0, 0.5j))
    given = {"supports": supports("stiff"), "speed": 500.0, "at": ["left", "right", 3]}
    with pytest.warns(UserWarning, match="the motion of .* at .* (Hz|rpm) errs by about"):
        result = harmonic_response(rotor, [200.0, 800.0], force, **given)
    full = harmonic_response(solid("tilt"), [200.0, 800.0], force, **given)
    true = np.linalg.norm((full.motion - result.motion)[:, :2, :, :3], axis=(2, 3))
    sizes = np.linalg.norm(full.motion[..., :3], axis=(2, 3))
    true = true / np.maximum(sizes[:, :2], 0.1 * sizes.max(axis=1, keepdims=True))
    np.testing.assert_allclose(result.basis_errors[:, :2], true, rtol=0.1, atol=SMALL)
    given = {"unbalances": Unbalance("left", 1e-4), "supports": supports("anisotropic")}
    few = unbalance_response(rotor, np.linspace(100.0, 400.0, 7), **given)
    assert 3 <= np.sum(np.isfinite(few.basis_errors[:, 0])) <= 4
    assert np.nanmax(few.basis_errors) > 0.0


@pytest.mark.parametrize("modes", ["free 4", "RBE3 4"])
def test_errors_of_the_least_stable_motion(modes):
    """Damping in the rotor drives it; against the full model's motion of the same name."""
    given = {"supports": [*supports("stiff"), Support("left", damping=2e4, frame="rotor")]}
    speeds = [800.0, 2500.0]
    full = stability(solid("tilt"), speeds, modes=8, **given)
    with pytest.warns(UserWarning, match="the least stable motion .* errs by about"):
        result = stability(reduced("tilt", modes), speeds, accuracy=1e-5, **given)
    row = np.arange(2)
    values = result.exponents[row, result.least_stable]
    found = values + result.basis_shifts
    away = np.abs(full.exponents - np.where(found.imag < 0.0, found.conj(), found)[:, None])
    assert np.all(away.min(axis=1) < 0.2 * np.abs(result.basis_shifts) + SMALL * np.abs(values))
    assert np.abs(result.basis_shifts).max() > 10.0 * SMALL * np.abs(values).max()
    assert "basis error" in result.table()
    assert not np.any(full.basis_shifts)


def damped(inner: float) -> list[Support]:
    names = ("left", "right")
    return [*supports("stiff"), *(Support(each, damping=inner, frame="rotor") for each in names)]


@pytest.mark.parametrize("parameter", ["speed", "inner damping"])
def test_errors_of_limits_of_stability(parameter):
    """Against the full model's limit; the estimate is of first order in an error of 2 to 4 %."""
    over = (1100.0, 2500.0) if parameter == "speed" else (50.0, 1000.0)
    given = {"supports": damped(400.0)} if parameter == "speed" else {"supports": damped}
    given |= {} if parameter == "speed" else {"speed": 1500.0}
    full = stability_threshold(solid("tilt"), *over, samples=2, modes=6, residual=1e-5, **given)
    with pytest.warns(UserWarning, match="the limit of stability at .* errs by about"):
        result = stability_threshold(reduced("tilt", "free 4"), *over, samples=2, **given)
    errors = full.values - result.values
    assert np.all(np.abs(errors) > 0.01 * result.values)
    np.testing.assert_allclose(result.basis_shifts, errors, rtol=0.1)
    np.testing.assert_allclose(result.basis_errors, np.abs(errors) / result.values, rtol=0.1)
    assert "basis error" in result.table()
    assert "basis" not in full.table()
    np.testing.assert_array_equal(full.basis_errors, 0.0)


def test_errors_of_unstable_ranges_are_in_a_warning():
    rotor, speeds = reduced("tilt", "free 4"), [1100.0, 2500.0]
    with pytest.warns(UserWarning, match="the limit of stability at .* errs by about 0.015"):
        ranges = unstable_ranges(rotor, speeds, supports=damped(400.0))
    unchecked = unstable_ranges(rotor, speeds, supports=damped(400.0), accuracy=None)
    np.testing.assert_array_equal(ranges, unchecked)


def test_errors_of_limits_where_modes_meet():
    """Between two critical speeds, here those of a mesh that is not quite axisymmetric.

    Against the full model; the finer rotor has static responses at the interfaces.
    """
    given = {"supports": [*supports("stiff"), Support("left", damping=2e4, frame="rotor")]}
    result = stability_threshold(reduced("tilt", "free 4"), 400.0, 2500.0, samples=4, **given)
    assert result.frequencies_inertial == pytest.approx(result.values, rel=1e-4)
    limits = {"samples": 4, "modes": 4, "residual": 1e-5}
    near = float(result.values.min() - 60.0), float(result.values.max() + 20.0)
    full = stability_threshold(solid("tilt"), *near, **limits, **given)
    errors = full.values - result.values
    assert np.all(np.abs(errors) > 1e-3 * result.values)
    np.testing.assert_allclose(result.basis_shifts, errors, rtol=0.1)


def test_errors_of_a_map_of_stability_are_those_of_its_points():
    rotor, speeds, amounts = reduced("tilt", "free 4"), [800.0, 2500.0], [5e3, 2e4]

    def build(inner: float, speed: float) -> tuple:
        more = Support("left", damping=inner, frame="rotor")
        return linear_model(rotor, supports=[*supports("stiff"), more]), speed

    with pytest.warns(UserWarning, match=r"the least stable motion at \(.*\) errs by about"):
        result = stability_map(build, amounts, speeds, accuracy=1e-5)
    for row, inner in zip(result.basis_errors, amounts, strict=True):
        single = stability(build(inner, 0.0)[0], speeds, accuracy=0.9)
        least = single.exponents[[0, 1], single.least_stable]
        given = single.basis_shifts, least.real, np.abs(least.imag)
        expected = relative_errors(*(each[:, None] for each in given), np.array(speeds))
        np.testing.assert_allclose(row, expected[:, 0], rtol=1e-3)
    assert "basis error up to" in result.table()
    unchecked = stability_map(build, amounts[:1], speeds[:1], accuracy=None)
    assert unchecked.basis_errors is None
    assert NOT_KNOWN in unchecked.table()


def test_motions_with_harmonics_are_looked_at_at_all_peaks():
    """Three peaks of one place, one of another, both ends and the middle."""
    speeds = np.linspace(0.0, 10.0, 41)
    curves = [np.sin(speeds) ** 2 + 0.1, np.exp(-((speeds - 6.0) ** 2))]
    motions = [
        {1: np.array([[a, 0, 0, 0, 0, 0], [0, b, 0, 0, 0, 0]])}
        for a, b in zip(*curves, strict=True)
    ]
    chosen = looked_at(motions, constant=False)
    peaks = [np.argmin(np.abs(speeds - at)) for at in (np.pi / 2, 1.5 * np.pi, 2.5 * np.pi, 6.0)]
    assert set(peaks) | {0, 20, 40} == set(chosen)
    np.testing.assert_array_equal(looked_at(motions, constant=True), np.arange(41))


def test_a_free_motion_at_rest_has_no_relative_error():
    """Its shift is rounding, and there is neither a frequency nor a speed to compare it with."""
    shifts = np.array([[1e-9 + 0j, 0j, 2e-3j]])
    errors = relative_errors(shifts, np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.zeros(1))
    np.testing.assert_array_equal(errors, [[np.nan, 0.0, 2e-3]])
