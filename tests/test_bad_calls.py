"""Bad calls made from signatures are refused by a message that names the argument.

``python -m validation bad_calls`` makes all, in processes of their own; here a share of them.
"""

import warnings

import numpy as np
import pytest

from validation.bad_calls import calls, judge, parameters, report
from validation.bad_calls.world import World

# of some ten thousands
BAD, TWICE_BAD, GOOD = 500, 100, 100


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


@pytest.fixture
def answers(world, monkeypatch):
    """Return the answers of some calls, drawn at random but always the same ones."""
    monkeypatch.chdir(world.folder)

    def made(cases, count):
        assert len(cases) >= count
        drawn = [cases[n] for n in report.chosen(len(cases), count)]
        return [(case, judge.answer(case, world)) for case in drawn]

    return made


def test_bad_calls_are_refused_clearly(world, answers):
    """All of these; of all that there are, 99 % must be."""
    single = list(judge.bad_cases(world))
    assert len(single) > 30_000
    assert report.listed(answers(single, BAD)) == ""
    assert report.listed(answers(list(judge.pairs(single, TWICE_BAD)), TWICE_BAD)) == ""


def test_good_values_of_unusual_kinds_pass(world, answers):
    assert report.listed(answers(list(judge.good_cases(world)), GOOD), judge.ACCEPTED) == ""


def test_foreign_messages_would_be_seen(world):
    """A message of numpy is none of ours, and one of ours without the name does not count."""
    foreign = judge._outcome(np.zeros, {"shape": "speed"}, {"speed"})
    assert foreign.outcome == judge.FOREIGN
    support = world.supports[0].matrices
    assert judge._outcome(support, {"speed": "x"}, {"speed"}).outcome == judge.CLEAR
    assert judge._outcome(support, {"speed": "x"}, {"value"}).outcome == judge.UNNAMED
    assert judge._outcome(support, {"speed": 1.0}, {"speed"}).outcome == judge.ACCEPTED
