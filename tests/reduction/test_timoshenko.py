"""Slender solid shafts against Timoshenko beams of ross-rotordynamics 2.3.0.

The numbers are in validation/references/timoshenko_ross.json, written by the script beside it.
"""

import numpy as np
import pytest

from validation.references.timoshenko import compare_all

UNIFORM, POINTS, HUBS = "uniform", "two discs against points", "two discs against rigid hubs"
WANTED = [f"{UNIFORM}, 'full'", f"{POINTS}, 'full'", f"{POINTS}, 'tilt'", f"{HUBS}, 'full'"]


@pytest.fixture(scope="module")
def results():
    return compare_all(0.06, 1.5, WANTED)[1]


def array(result: dict) -> np.ndarray:
    return np.array(result["frequencies"])


def test_uniform_shaft_agrees_with_the_beam(results):
    """Six modes up to twice the first critical speed; 0.9e-3 is beam against solid."""
    full = results["uniform, 'full'"]
    assert np.abs(array(full)).max() < 1.2e-3
    assert np.abs(full["critical_speeds"]).max() < 1.2e-3
    assert np.ptp(array(full)[1:], axis=0).max() < 2e-5  # the deviation does not grow with speed


def test_bonded_discs_lie_between_points_and_rigid_hubs(results):
    """A solid disc stiffens the shaft over its width, less than a rigid hub would."""
    softer = array(results["two discs against points, 'full'"])[0]
    stiffer = array(results["two discs against rigid hubs, 'full'"])[0]
    assert np.all(softer > 0.01)
    assert np.all(stiffer < -0.01)


def test_discs_on_a_bending_shaft_need_the_full_level(results):
    """The two lowest pairs keep their deviation up to 600 rad/s; with 'tilt' they soften."""
    full = array(results["two discs against points, 'full'"])
    tilt = array(results["two discs against points, 'tilt'"])
    assert np.abs(full[-1, :4] - full[0, :4]).max() < 1.5e-3
    assert np.abs(tilt[-1, :2] - full[0, :2]).max() > 2e-2
