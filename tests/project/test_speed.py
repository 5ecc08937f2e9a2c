"""The measurements of speed: their scenes and their arithmetic, never the times."""

import dataclasses

import pytest

from validation.peer.scene import Run, Scene
from validation.speed import ablation, frozen_spin, small_models, speed
from validation.speed import scenes as speed_scenes

STEPS = 20


@pytest.fixture(scope="module")
def model() -> speed_scenes.Model:
    return speed_scenes.Model.of(0.1, 8, safety=1.0)


@pytest.mark.parametrize(
    ("body", "kinds"),
    [
        ("fixed axis, free spin", {"mass", "force", "jacobian"}),
        ("fixed axis, constant speed", set()),
    ],
)
def test_python_calls_are_counted(model, body, kinds):
    settings = speed.recommended(STEPS)
    calls = speed_scenes.python_calls(speed_scenes.BODIES[body], model.with_modes(8), settings)
    assert set(calls.count) == kinds
    assert all(calls.microseconds[kind] > 0.0 for kind in kinds)
    if kinds:
        assert calls.count["mass"] == calls.count["force"] >= STEPS


@pytest.mark.parametrize("body", [name for name in speed_scenes.BODIES if "floor" in name])
def test_the_floor_calls_no_python(model, body):
    """Of the floor's object nothing but constant matrices is left."""
    mbs, made = speed_scenes.assemble(speed_scenes.BODIES[body], model.with_modes(8))
    physics = made["FFRFReducedOrderObjectDict"]["rotorBody"].objects["physics"]
    assert not any(mbs.GetObject(physics)[name] for name in speed_scenes.CALLS)
    assert speed_scenes.seconds(mbs, speed.recommended(STEPS)) > 0.0


def test_ratios_stand_beside_their_targets():
    costs = dict(zip(speed_scenes.BODIES, (600.0, 90.0, 30.0, 20.0, 10.0, 8.0), strict=True))
    rows = [
        {"modes": 20, "body": body, "markers": "rigid", "tolerances": "default"}
        | {"microseconds": cost}
        for body, cost in costs.items()
    ]
    constant = next(row for row in speed.ratios(rows) if "constant" in row["body"])
    assert constant["standard"] == pytest.approx(60.0)
    assert constant["standard target"] == 15
    assert constant["virtual"] == pytest.approx(9.0)
    assert constant["floor"] == pytest.approx(1.25)


def test_every_ablation_runs_and_changes_one_thing():
    rotors = ablation.Rotors(0.1, safety=1.0)
    for (base, change), (before, after) in ablation.VARIANTS.items():
        assert ablation.cost(rotors, after, STEPS) > 0.0, (base, change)
        fields = [f.name for f in dataclasses.fields(ablation.Variant)]
        changed = [n for n in fields if getattr(before, n) != getattr(after, n)]
        assert 1 <= len(changed) <= 2, (base, change)


def test_small_models_are_timed_with_both_settings(monkeypatch):
    times = iter([4.0, 2.0, 6.0, 1.0, 3.0, 3.0, 8.0, 2.0])
    changes = []

    def run(scene, call, share, change=None):
        changes.append(change)
        return Run([], next(times), 371, 8)

    monkeypatch.setattr(small_models, "run", run)
    scene = Scene("rotor", lambda script: None, 0.02, 1e-4)
    default, full = small_models.compare(scene, 2, 1.0)
    assert changes == [None] * 4 + [small_models.full_newton] * 4
    assert (default["median"], default["least"]) == (4.0, 2.0)  # of 4/2 and 6/1
    assert (full["median"], full["least"]) == (2.5, 1.0)
    assert default["microseconds"] == pytest.approx([4.0 / 200 * 1e6, 1.0 / 200 * 1e6])


def test_a_frozen_spin_errs_by_what_is_reported():
    row = frozen_spin.compare(0.1, 0.0, 0.005, 1)
    assert 0.0 < row["speed"] < 2.0 * row["reported"] < 1e-4
    assert row["lateral"] < 1e-3
