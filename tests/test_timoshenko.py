"""Slender solid shafts against Timoshenko beams of ross-rotordynamics 2.3.0.

The numbers are in validation/reference/timoshenko_ross.json, written by ross_reference.py.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "validation"))

from timoshenko import compare_all


@pytest.fixture(scope="module")
def results():
    return compare_all(0.04)[1]


def array(result: dict) -> np.ndarray:
    return np.array(result["frequencies"])


def test_uniform_shaft_agrees_within_two_per_mille(results):
    """Six modes up to twice the first critical speed; the rest is beam against solid."""
    assert np.abs(array(results["uniform"])).max() < 2e-3
    assert np.abs(results["uniform"]["critical_speeds"]).max() < 2e-3


def test_bonded_discs_lie_between_points_and_rigid_hubs(results):
    """A solid disc stiffens the shaft over its width, less than a rigid hub would."""
    softer = array(results["two discs against points"])[0]
    stiffer = array(results["two discs against rigid hubs"])[0]
    assert np.all(softer > 0.01)
    assert np.all(stiffer < -0.01)


def test_elastic_disc_tilt_explains_what_changes_with_speed(results):
    """With I_p/2 per disc, the two lowest pairs keep their deviation at rest up to 600 rad/s."""
    level_tilt = array(results["two discs against points"])
    elastic = array(results["two discs with elastic disc tilt against points"])
    at_rest = level_tilt[0, :4]
    assert np.abs(elastic[-1, :4] - at_rest).max() < 2e-3
    assert np.abs(level_tilt[-1, :2] - at_rest[:2]).max() > 2e-2
