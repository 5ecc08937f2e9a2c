"""The fast rows of the table of extremes, and the helpers behind it."""

import json

import numpy as np
import pytest

from exudyn_rotor import stability
from validation.extremes import (
    bad_numbers,
    bases,
    rotors,
    rows,
    spin,
    steps,
    table,
    turning,
    unbalance,
)

CASES = [
    pytest.param(make, id=f"{group}-{number}")
    for group, makers in table.GROUPS.items()
    for number, make in enumerate(makers)
]


@pytest.mark.filterwarnings("ignore:the (centre of mass|nearest principal axis) is")
@pytest.mark.parametrize("make", CASES)
def test_row_holds(make):
    row = make(quick=True)
    assert row.passed, f"{row.pushed}: {row.measured} above {row.limit}; {row.breaks_at}"


# ------------------------------------------------------------------ breaking points, where known


def test_definiteness_ends_at_the_critical_speed():
    exact = spin.rigid_speeds()["translation"]
    assert spin.smallest_stiffness("tilt", 0.999 * exact) > 0.0
    assert spin.smallest_stiffness("tilt", 1.001 * exact) < 0.0


def test_level_none_turns_unstable_where_tilt_does_not():
    speeds = spin.rigid_speeds()["unstable at 'none'"] * np.array([0.99, 1.01])
    assert stability(spin.rigid_on_support("none"), speeds).stable.tolist() == [True, False]
    assert stability(spin.rigid_on_support("tilt"), speeds).stable.all()


@pytest.mark.parametrize("solver", steps.POLYNOMIALS)
def test_explicit_runs_grow_past_the_limit_only(solver):
    limit = {"RK33": np.sqrt(3.0), "RK44": np.sqrt(8.0)}[solver]
    assert steps.theoretical_limit(steps.POLYNOMIALS[solver]) == pytest.approx(limit, rel=5e-3)
    assert steps.growth(solver, 0.98 * limit, speed=300.0) < 1.5
    assert steps.growth(solver, 1.02 * limit, speed=300.0) > steps.GROWN


def test_phase_loses_a_digit_with_every_ten_times_as_many_revolutions():
    fine, coarse = turning.phase_error(1e6), turning.phase_error(1e9)
    assert 1e-11 < fine < 1.4e-9
    assert coarse / fine == pytest.approx(1e3, rel=0.9)


@pytest.mark.filterwarnings("ignore:the nearest principal axis is")
def test_small_tilts_deviate_with_their_square():
    small, large = unbalance.deviation(0.05), unbalance.deviation(0.5)
    ratio = unbalance.exact_tilt(0.5) / unbalance.exact_tilt(0.05)
    assert large / small == pytest.approx(ratio**2, rel=0.02)


def test_copies_are_dropped_below_the_rank_tolerance_only():
    assert bases.near_copies(1e-6)[1].dropped == ()
    assert len(bases.near_copies(1e-8)[1].dropped) == 3


def test_mirror_image_is_no_trivial_comparison():
    mismatch, lowest = spin.mirrored_run(200)
    assert lowest < -0.1
    assert mismatch > 0.0


def test_refused_numbers_are_found_by_the_search():
    def takes_all(value):
        return value

    def breaks(value):
        raise ZeroDivisionError

    found = bad_numbers.accepted({"open": takes_all, "broken": breaks}, (np.nan,))
    assert found == ["open=nan", "broken=nan (ZeroDivisionError)"]
    never = bad_numbers.refused_finite({"closed": lambda v: bad_numbers.SpinAxis([v, v])})
    assert len(never) == 1


# ------------------------------------------------------------------ rotors with closed forms


def test_two_rings_have_the_stated_moments():
    rotor = rotors.two_rings(3.0, 0.2, 0.3, unbalance=0.2)
    J = rotor.reduce(0).invariants.J
    assert J[0, 0] + J[1, 1] == pytest.approx(3.0 * 0.2**2, rel=1e-12)
    assert (J[0, 0] + J[1, 1]) / 2 + J[2, 2] == pytest.approx(3.0 * (0.02 + 0.09), rel=1e-12)
    assert rotor.center_of_mass == pytest.approx(np.zeros(3), abs=1e-14)
    assert J[0, 2] == pytest.approx(4.0 * 0.2 * 3.0 / 8 * 0.2 * 0.3, rel=1e-12)


def test_shaft_bends_at_its_closed_form_frequency():
    free = rotors.shaft_rotor(10.0, 1.0, (4e5, 6e5)).reduce(2).frequencies[-2:]
    assert free == pytest.approx(np.sqrt(np.array([4e5, 6e5]) * (1 / 10.0 + 1 / 2.0)), rel=1e-9)


# ------------------------------------------------------------------ table


def test_breaking_point_is_found_by_bisection():
    assert rows.breaking_point(lambda x: x < 3.0, 1.0, 1e6) == pytest.approx(3.0, rel=1.1e-3)
    assert rows.breaking_point(lambda x: x > 3.0, 1e6, 1.0) == pytest.approx(3.0, rel=1.1e-3)
    assert np.isnan(rows.breaking_point(lambda x: True, 1.0, 10.0))
    assert np.isnan(rows.breaking_point(lambda x: False, 1.0, 10.0))


def test_rows_that_miss_their_limit_or_measure_nothing_fail(tmp_path):
    good, bad, none = (rows.Row("p", "r", "c", x, 1.0) for x in (0.5, 2.0, np.nan))
    assert (good.passed, bad.passed, none.passed) == (True, False, False)
    table.write_json(tmp_path / "rows.json", {"group": [good, none]})
    written = json.loads((tmp_path / "rows.json").read_text(encoding="utf-8"))["group"]
    assert [entry["passed"] for entry in written] == [True, False]
    assert written[1]["measured"] is None
    text = table.printed({"group": [good, bad]})
    assert "ok   p: r" in text
    assert "FAIL p: r" in text
    with pytest.raises(ValueError, match="unknown"):
        rows.Row("p", "r", "c", 0.0, 1.0, reason="magic")
