"""What is computed once for each object, and let go with it."""

import gc
import weakref

import numpy as np

from exudyn_rotor import RollingBearing, Support
from exudyn_rotor.cached import kept


class Thing:
    """An object that can be forgotten."""


def test_results_are_kept_for_each_object_and_argument_as_long_as_it_lives():
    calls, released = [], []

    @kept
    def found(each: Thing, level: str = "") -> object:
        """Return an object of its own."""
        calls.append((id(each), level))
        result = Thing()
        weakref.finalize(result, released.append, level)
        return result

    one, other = Thing(), Thing()
    assert found(one, "tilt") is found(one, "tilt")
    assert found(one, "full") is not found(one, "tilt")
    assert found(other, "tilt") is not found(one, "tilt")
    assert len(calls) == 3
    assert found.__doc__ == "Return an object of its own."
    del one
    gc.collect()
    assert sorted(released) == ["full", "tilt"]


def test_coefficients_of_a_support_are_asked_for_once_at_a_speed():
    """Scenes ask at every force, analyses for stiffness and damping in turn."""
    asked = []

    def stiffness(speed):
        asked.append(speed)
        return 1e6 + speed

    support = Support("left", stiffness, damping=5.0)
    for speed in (2.0, 2.0, 3.0, 2.0):
        K, D = support.matrices(speed)
        assert K[0, 0] == 1e6 + speed
        assert D[1, 1] == 5.0
        K[:], D[:] = 0.0, 0.0
    assert asked == [2.0, 3.0, 2.0]
    constant = Support("left", 7.0)
    assert [constant.matrices(speed)[0][0, 0] for speed in (0.0, 5.0)] == [7.0, 7.0]


def test_equilibria_of_a_rolling_bearing_are_found_once_for_all_speeds(monkeypatch):
    bearing = RollingBearing(
        interface="left", count=8, pitch_radius=0.03, element_radius=0.005, stiffness=7e9
    )
    first, other = (bearing.coefficients(100.0, load)[0] for load in ([500.0, 0.0], [0.0, 900.0]))
    assert first[0, 0] < other[1, 1]
    expected = first.copy()
    first[:] = 0.0
    monkeypatch.setattr(RollingBearing, "equilibrium", None)
    assert np.array_equal(bearing.coefficients(300.0, [500.0, 0.0])[0], expected)
    assert np.array_equal(bearing.coefficients(0.0, [0.0, 900.0])[0], other)
