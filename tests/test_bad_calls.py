"""Bad calls made from signatures are refused by a message that names the argument.

``validation/bad_calls.py`` makes all of them, in processes of their own; here a share of them.
"""

import warnings

import pytest
from bad_calls import calls, judge, parameters, report
from bad_calls.world import World

CALLS = 400  # of some ten thousands
CLEAN = ("PrescribedMotion", "SolidRotor.with_prestress", "StressField.of")


@pytest.fixture(scope="module")
def world():
    return World()


@pytest.mark.parametrize("name", sorted(calls.public_calls()))
def test_valid_call_passes(world, name):
    function, given = calls.valid(name, world)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        function(**given)
    world.renew()


def test_tables_hold_nothing_else():
    """Every argument has a kind, and no entry is left of what is gone."""
    names = list(calls.public_calls())
    used = {(name, argument) for name in names for argument in calls.parameters(name)}
    for name, argument in used:
        parameters.kind_of(name, argument)
    beside = {(f"*.{name.partition('.')[2]}", argument) for name, argument in used}
    assert set(parameters.BY_NAME) <= {argument for _, argument in used}
    assert set(parameters.BY_CALL) <= used | beside
    places = {*names, *(f"*.{name.partition('.')[2]}" for name in names)}
    assert set(calls.ARGUMENTS) | set(calls.OPTIONS) | set(calls.INSTANCES) <= places


def test_bad_calls_are_refused_clearly(world, monkeypatch):
    monkeypatch.chdir(world.folder)
    made = [(case, make) for case, make in judge.cases(world) if case.call in CLEAN]
    numbers = report.chosen(len(made), CALLS)
    assert len(numbers) >= 300
    found = [(made[n][0], judge.answer(*made[n], world)) for n in numbers]
    assert report.listed(found) == ""
