"""Estimates of what a basis leaves out, against a basis with many more modes."""

from functools import cache

import numpy as np
import pytest
from models import centered_disc

import exudyn_rotor as er

SPEEDS = [0.0, 2500.0]


def supports(kind: str) -> list[er.Support]:
    across = {"soft": 1e6, "stiff": 1e8, "anisotropic": [[1e7, 0.0], [0.0, 4e7]]}[kind]
    return [er.Support(name, across, damping=200.0) for name in ("left", "right")]


@cache
def solid(level: str) -> er.SolidRotor:
    rotor = centered_disc(order=1)
    return rotor.with_prestress(rotor.prestress()) if level == "full" else rotor


@cache
def reduced(level: str, modes: str) -> er.ReducedRotor:
    how, count = modes.split()
    rotor = solid(level)
    if how == "free":
        return rotor.reduce(int(count))
    return rotor.reduce(er.craig_bampton_modes(rotor, int(count), coupling=how))


FINE, GIVEN = "RBE3 16", {"accuracy": None}


@pytest.mark.parametrize(("kind", "modes"), [("soft", "free 4"), ("stiff", "free 6")])
def test_estimates_of_eigenvalues_are_the_errors(kind, modes):
    """Of the lowest that are no rigid motion, at rest: of frequency and growth together."""
    given = {"supports": supports(kind)}
    better, result = (
        er.campbell(reduced("tilt", each), 0.0, accuracy=0.9, **given) for each in (FINE, modes)
    )
    finer, found = (each.growth[0] + 1j * each.frequencies_inertial[0] for each in (better, result))
    found = found[2:6]
    away = finer[np.argmin(np.abs(finer - found[:, None]), axis=1)] - found
    sizes = np.maximum(np.abs(found.real), 1e-2 * found.imag)
    true = np.maximum(np.abs(away.imag) / found.imag, np.abs(away.real) / sizes)
    assert true.max() > 1e-3
    assert np.all(true < 1.5 * result.basis_errors[0, 2:6] + 1e-4)


@pytest.mark.parametrize("modes", ["free 4", "RBE3 2"])
def test_errors_of_unbalance_responses(modes):
    given = {"unbalances": er.Unbalance("left", 1e-4), "supports": supports("stiff")}
    speeds = [300.0, 1000.0, 2500.0]
    better = er.unbalance_response(reduced("tilt", FINE), speeds, **given, **GIVEN)
    result = er.unbalance_response(reduced("tilt", modes), speeds, **given, accuracy=0.9)
    finer, motion = (each.motion[:, :, list(each.orders).index(1), :3] for each in (better, result))
    sizes = np.maximum(*(np.linalg.norm(each, axis=2) for each in (finer, motion)))
    sizes = np.maximum(sizes, 0.1 * sizes.max(axis=1, keepdims=True))
    true = np.linalg.norm(finer - motion, axis=2) / sizes
    np.testing.assert_allclose(result.basis_errors, true, rtol=0.2, atol=2e-3)
    assert true.max() > 0.01
    assert "basis" in result.table()


def inner_damping() -> list[er.Support]:
    names = ("left", "right")
    return [*supports("stiff"), *(er.Support(each, damping=400.0, frame="rotor") for each in names)]


def test_errors_of_limits_of_stability():
    given, over = {"supports": inner_damping(), "samples": 2}, (1100.0, 2500.0)
    better = er.stability_threshold(reduced("tilt", FINE), *over, **given, **GIVEN)
    with pytest.warns(UserWarning, match="the limit of stability at .* errs by about"):
        result = er.stability_threshold(reduced("tilt", "free 4"), *over, **given)
    errors = np.abs(better.values - result.values) / result.values
    assert np.all(errors > 0.01)
    np.testing.assert_allclose(result.basis_errors, errors, rtol=0.3)
    assert "basis error" in result.table()


def test_errors_of_the_least_stable_motion_are_in_a_warning():
    given = {"supports": inner_damping(), "accuracy": 1e-5}
    with pytest.warns(UserWarning, match="the least stable motion .* errs by about"):
        result = er.stability(reduced("tilt", "free 4"), [800.0, 2500.0], **given)
    assert "basis error" in result.table()


def test_errors_are_in_the_table_and_above_the_accuracy_in_a_warning():
    rotor, given = reduced("tilt", "free 4"), {"supports": supports("stiff"), "modes": 5}
    with pytest.warns(UserWarning, match=r"mode \d \(.*\) at .* rpm errs by about .* interfaces"):
        result = er.campbell(rotor, SPEEDS, **given)
    assert "basis error" in result.table()
    columns = result.columns()["basis error"]
    np.testing.assert_array_equal(columns, result.tracked().basis_errors.ravel())
    held = reduced("tilt", "RBE3 2")
    with pytest.warns(
        UserWarning, match=r"the flexible modes of the reduced rotor \(\d+, up to .* twice as many"
    ):
        er.campbell(held, SPEEDS, accuracy=1e-6, **given)


@pytest.mark.filterwarnings("error")
def test_no_warning_within_the_accuracy_and_without_a_check():
    rotor, given = reduced("tilt", "free 4"), {"supports": supports("stiff"), "modes": 5}
    unchecked = er.campbell(rotor, SPEEDS, accuracy=None, **given)
    assert unchecked.basis_errors is None
    assert "error of the basis: not known" in unchecked.table()
    assert np.all(np.isnan(unchecked.columns()["basis error"]))
    er.campbell(reduced("tilt", "free 12"), SPEEDS, accuracy=0.5, **given)


@pytest.mark.parametrize("kind", ["soft", "stiff", "anisotropic"])
def test_estimates_of_critical_speeds(kind):
    """Against a basis with twice the modes and all static responses."""
    given = {"supports": supports(kind), "max_speed": 3000.0, "nodal_diameters": [1]}
    better = er.critical_speeds(reduced("tilt", "free 12").with_attachments, accuracy=None, **given)
    result = er.critical_speeds(reduced("tilt", "free 6"), **given)
    true = np.abs(better.speeds - result.speeds[:, None])
    expected = true.min(axis=1) / result.speeds
    assert np.all(result.basis_errors > 0.5 * expected)
    size = result.basis_errors * result.speeds
    away = np.abs(true - size[:, None]).min(axis=1)  # of pairs that the mesh splits either one
    assert np.all(away < 0.1 * size)
    assert "basis error" in result.table()
