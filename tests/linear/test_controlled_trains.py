"""Trains of rotors on magnetic bearings and on pads that tilt: against the rotors by themselves."""

from dataclasses import replace

import numpy as np
import pytest
from point_rotors import SKEW_AXIS
from test_magnetic_bearing import DELAYED, bearing, pair, rigid
from test_tilting_pad import SPEED, on_pads

from exudyn_rotor import (
    BaseAcceleration,
    HarmonicForce,
    RotorTrain,
    Support,
    Unbalance,
    harmonic_response,
    sensitivity,
    unbalance_response,
)

GIVEN = {"accuracy": None}
MAGNETIC = rigid(), [*pair(angle=0.3)]  # a controller with filter and delay
ON_SPRINGS = rigid(5.0), [Support(name, 2e5, 9.0) for name in ("left", "right")]
PADS = on_pads(SKEW_AXIS)[:2]


def test_responses_without_links_are_those_alone():
    train = RotorTrain(
        {"A": PADS[0], "B": MAGNETIC[0]},
        {"A": 0.8, "B": 1.0},
        {"A": PADS[1], "B": MAGNETIC[1]},
    )
    for name, (rotor, supports), rate in (("A", PADS, 0.8), ("B", MAGNETIC, 1.0)):
        over, alone = train.relative_to(name), {"supports": supports, **GIVEN}
        responses = [
            unbalance_response(target, [rate * SPEED], Unbalance(place, 1e-4), own=False, **given)
            for target, place, given in ((over, f"{name}:left", GIVEN), (rotor, "left", alone))
        ]
        orbits = [
            one.motion[0, one.places.index(place), one.orders.tolist().index(1)]
            for one, place in zip(responses, (f"{name}:right", "right"), strict=True)
        ]
        np.testing.assert_allclose(*orbits, rtol=0.0, atol=1e-9 * np.abs(orbits[1]).max())
        for load in (
            lambda at: HarmonicForce(at, [1.0, 0.5j]),
            lambda at: BaseAcceleration([1.0, 0.5]),
        ):
            shaken = [
                harmonic_response(target, [150.0], load(at + "left"), speed=rate * SPEED, **given)
                .phasor(at + "right")
                for target, at, given in ((over, f"{name}:", GIVEN), (rotor, "", alone))
            ]  # fmt: skip
            np.testing.assert_allclose(*shaken, rtol=1e-9)


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
    with pytest.raises(ValueError, match="a RotorTrain has its own"):
        sensitivity(train, frequencies, supports=MAGNETIC[1])
