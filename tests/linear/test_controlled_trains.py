"""Trains of rotors on magnetic bearings and on pads that tilt: against the rotors by themselves."""

from dataclasses import replace

import numpy as np
import pytest
from test_magnetic_bearing import DELAYED, bearing, pair, rigid

from exudyn_rotor import (
    RotorTrain,
    Support,
    sensitivity,
)

MAGNETIC = rigid(), [*pair(angle=0.3)]  # a controller with filter and delay
ON_SPRINGS = rigid(5.0), [Support(name, 2e5, 9.0) for name in ("left", "right")]


def test_loops_of_a_train_have_their_sensitivity():
    frequencies = np.array([50.0, 400.0, 2e3])
    rotors, ratios = {"A": rigid(5.0), "B": MAGNETIC[0]}, {"A": 1.0, "B": 1.6}
    supports = {"A": ON_SPRINGS[1], "B": MAGNETIC[1]}
    train = RotorTrain(rotors, ratios, supports)
    found = sensitivity(train, frequencies, speed=100.0)
    alone = sensitivity(MAGNETIC[0], frequencies, supports=MAGNETIC[1], speed=160.0)
    assert found.axes[:2] == ("B:left, 1", "B:left, 2")
    columns = np.searchsorted(found.frequencies, frequencies)
    expected = alone.values[:, np.searchsorted(alone.frequencies, frequencies)]
    np.testing.assert_allclose(found.values[:, columns], expected, rtol=1e-8)
    slow = replace(DELAYED, derivative=0.0)
    loose = RotorTrain(
        rotors, ratios, {"A": [bearing("left"), bearing("right")], "B": pair(controller=slow)}
    )
    with pytest.raises(ValueError, match=r"a motion of .* grows by"):
        sensitivity(loose, frequencies)
    with pytest.raises(ValueError, match="a RotorTrain and a linear model"):
        sensitivity(train, frequencies, supports=MAGNETIC[1])
