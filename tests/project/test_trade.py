"""The trade-off between error and cost: errors, orders, fronts and conclusions, never times."""

import json

import numpy as np
import pytest

from validation.trade import error as trade_error
from validation.trade import picture as trade_picture
from validation.trade import plan as trade_plan
from validation.trade import run as trade_run
from validation.trade import scene as trade_scene
from validation.trade import trade
from validation.trade.scene import (
    CONSTANT_SPEED,
    FIXED_AXIS,
    FREE_FRAME,
    STANDARD,
    VIRTUAL,
    Body,
    Config,
)

SHORT = {"duration": 0.05, "settled": 0.04}  # s


@pytest.fixture(scope="module")
def bench() -> trade_run.Bench:
    return trade_run.Bench(trade_scene.Rotor.of(0.1, order=1))


def motion(scale: float = 1.0, shift: float = 0.0) -> trade_error.Motion:
    """Return circles of radius `scale` for all tracks, the disc shifted across the axis."""
    angle = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    circle = scale * np.stack([np.sin(angle), np.cos(angle), np.sin(angle)], axis=1)
    tracks = {name: circle.copy() for name in ("left", "right", "disc", "rim")}
    tracks["disc"][:, 1] += shift
    return trade_error.Motion(tracks)


def test_errors_are_relative_to_the_motion():
    found = trade_error.errors(motion(2.0, 0.1), motion(2.0))
    assert found["disc"] == pytest.approx(0.05)
    assert found["total"] == found["disc"]
    assert found["journal"] == found["rim"] == 0.0


def test_rim_counts_along_the_axis_only():
    reference, other = motion(), motion()
    other.tracks["rim"][:, 1:] += 7.0
    assert trade_error.errors(other, reference)["total"] == 0.0
    other.tracks["rim"][:, 0] += 0.25
    assert trade_error.errors(other, reference)["rim"] == pytest.approx(0.25)


def test_extrapolation_removes_errors_of_second_order():
    limit = motion(1.0 + 0.4).extrapolated(motion(1.0 + 0.1))
    assert trade_error.errors(limit, motion())["total"] < 1e-14


def test_front_holds_what_nothing_beats():
    costs = [(1.0, 0.5), (2.0, 0.1), (2.0, 0.2), (3.0, 0.1), (4.0, 0.01), (0.5, 0.9), (5.0, 0.3)]
    rows = [{"seconds": s, "total": e} for s, e in costs]
    kept = [(row["seconds"], row["total"]) for row in trade_error.front(rows)]
    assert kept == [(0.5, 0.9), (1.0, 0.5), (2.0, 0.1), (4.0, 0.01)]
    assert trade_error.cheapest(rows, 0.2)["seconds"] == 2.0
    assert trade_error.cheapest(rows, 1e-3) is None


def test_crossing_of_a_power_law():
    x = np.array([1e-3, 1e-2, 1e-1])
    assert trade_error.crossing(x, 3.0 * x**2, 3e-3) == pytest.approx(10.0**-1.5)
    assert trade_error.crossing(x, x, 1.0) == np.inf
    assert trade_error.crossing(x, x, 1e-4) == 0.0


@pytest.mark.parametrize("family", [VIRTUAL, FREE_FRAME, CONSTANT_SPEED])
def test_error_of_the_step_is_of_second_order(bench, family):
    body = Body(family, modes=12, markers="position")
    limit, own = bench.converged(body, 24, **SHORT)
    coarse, fine = (bench.scene(body).run(n, "tight", **SHORT)[0] for n in (24, 48))
    coarse, fine = (trade_error.errors(one, limit)["total"] for one in (coarse, fine))
    assert own < 0.02 * fine
    assert coarse / fine == pytest.approx(4.0, rel=0.05)


def test_families_have_one_limit(bench):
    """With the same modes and no step error a fixed axis misses second-order terms alone."""
    limits = {}
    for family in (VIRTUAL, *FIXED_AXIS):
        body = Body(family, modes=12, markers="position")
        limits[family], _ = bench.converged(body, 24, **SHORT)
    for family in FIXED_AXIS:
        assert trade_error.errors(limits[family], limits[VIRTUAL])["total"] < 5e-4


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (Body(STANDARD, modes=12), Body(VIRTUAL, modes=12)),
        (Body(VIRTUAL, modes=12), Body(VIRTUAL, modes=12, markers="position")),
        (Body(FREE_FRAME, modes=12), Body(FREE_FRAME, modes=12, markers="position")),
    ],
)
def test_markers_cost_time_and_change_nothing(bench, one, other):
    first, second = (bench.scene(body).run(8, "tight", **SHORT)[0] for body in (one, other))
    assert trade_error.errors(first, second)["total"] < 1e-7


def test_measured_rows_lead_to_advice(bench):
    configs = [
        Config(Body(STANDARD, modes=12), 4, "default"),
        Config(Body(CONSTANT_SPEED, modes=12, markers="position"), 8),
        Config(Body(FREE_FRAME, modes=12), 4, "default"),
    ]
    reference, _ = bench.scene(Body(VIRTUAL, modes=12)).run(32, "tight", **SHORT)
    rows = trade_run.measure(bench, configs, reference, repeats=1, **SHORT)
    names = [trade_run.USERS, CONSTANT_SPEED, f"{FREE_FRAME}, another call only"]
    assert [row["group"] for row in rows] == names
    assert all(row["seconds"] > 0.0 and 0.0 < row["total"] < 1.0 for row in rows)
    found = trade.advice(rows, (1.0, 1e-9))
    assert json.loads(json.dumps(trade.strict(found), allow_nan=False)) == found
    reached, missed = found[:3], found[3:]
    assert reached[0]["ratio"] == 1.0
    assert reached[1]["ratio"] == pytest.approx(rows[0]["seconds"] / rows[1]["seconds"])
    assert all(row["seconds"] is None and row["ratio"] is None for row in missed)


@pytest.mark.parametrize(
    ("seconds", "word"), [(1.0, "holds"), (3.0, "refuted"), (None, "does not reach")]
)
def test_verdict_follows_from_the_ratio(seconds, word):
    ratio = None if seconds is None else 40.0 / seconds
    row = {"accuracy": 1e-4, "group": FREE_FRAME, "seconds": seconds, "ratio": ratio}
    users = {"accuracy": 1e-4, "group": trade_run.USERS, "seconds": 40.0, "ratio": 1.0}
    lines = trade.verdict([users, row, row | {"accuracy": 1e-3}])
    assert len(lines) == 1
    assert word in lines[0]


def test_limits_by_direction():
    tilts = [1e-3, 1e-2, 1e-1]
    rows = [{"tilt": x, "lateral": x**2, "axial": x, "rim": 1e-6} for x in tilts]
    (row,) = trade.limits(rows, (2e-3,))
    assert row["axial"] == pytest.approx(2e-3)
    assert row["lateral"] == pytest.approx(2e-3**0.5)
    assert trade.strict(row)["rim"] is None


@pytest.mark.parametrize("quick", [True, False])
def test_plan_compares_each_thing_once(quick):
    configs = trade_plan.plan(quick)
    assert len(configs) == len(set(configs))
    assert {config.body.family for config in configs} == set(trade_scene.FAMILIES)
    assert {config.body.stiffening for config in configs} == {"none", "tilt", "full"}
    assert all(config.body.markers == "rigid" for config in trade_plan.run_up(quick))
    slow = [config for config in configs if config.body.family == STANDARD]
    assert all(config.body.markers == "rigid" for config in slow)
    assert any(config.solver == "default" for config in slow)


def test_picture_is_drawn(tmp_path):
    points = [
        {"family": family, "group": group, "basis": "free", "modes": 8, "step": 1e-4}
        | {"seconds": 1.0 + i, "total": 0.9e-2 / (1 + i)}
        for i, (family, group) in enumerate(
            [(FREE_FRAME, FREE_FRAME), (STANDARD, trade_run.USERS), (VIRTUAL, VIRTUAL)]
        )
    ]
    modes = [{"basis": basis, "modes": 8, "error": 1e-3} for basis in ("free", "Craig–Bampton")]
    tilts = [{"tilt": x, "lateral": x**2, "axial": x, "rim": x} for x in (1e-3, 1e-2)]
    path = tmp_path / "trade.png"
    trade_picture.draw(path, points, modes, tilts, (1e-2, 1e-6))
    assert path.stat().st_size > 10_000
