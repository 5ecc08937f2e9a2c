"""Formulations, and the motions that they prescribe."""

import pytest

from exudyn_rotor import Formulation, PrescribedMotion


def test_run_up_has_the_rates_that_it_says():
    motion = PrescribedMotion.run_up(10.0, 70.0, 2.0, angle=0.4)
    assert motion.value(0.0) == 0.4
    assert motion.rate(-1.0) == motion.rate(0.0) == 10.0
    assert motion.rate(2.0) == pytest.approx(70.0, rel=1e-15)
    assert motion.rate(5.0) == motion.rate(2.0)
    assert motion.value(2.0) == pytest.approx(0.4 + 2.0 * (10.0 + 70.0) / 2, rel=1e-15)
    assert motion.value(3.0) - motion.value(2.0) == pytest.approx(70.0, rel=1e-14)
    assert motion.acceleration(0.0) == motion.acceleration(3.0) == 0.0
    assert motion.acceleration(2.0) == pytest.approx(0.0, abs=1e-12)
    # fourth-order differences leave step⁴/30 of the fifth derivative (below 1e4) and 1e-11
    step = 1e-3
    for t in (-0.5, 0.1, 0.7, 1.0, 1.9, 3.0):
        for function, derivative in (
            (motion.value, motion.rate),
            (motion.rate, motion.acceleration),
        ):
            near = function(t + step) - function(t - step)
            far = function(t + 2 * step) - function(t - 2 * step)
            assert (8 * near - far) / (12 * step) == pytest.approx(derivative(t), abs=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"translation": "plane"}, "translation.*: 'plane' is unknown"),
        ({"translation": None}, "translation.*: None is unknown; use one of"),
        ({"spin": "constant"}, "spin.*: 'constant' is unknown"),
        ({"spin": True}, "spin: .* got True"),
        ({"spin": float("nan")}, "spin: .* got nan"),
        ({"spin": 1.0, "drive": "soft"}, "drive: 'soft' is unknown"),
        ({"drive": "elastic"}, "needs a prescribed spin"),
        ({"spin": PrescribedMotion(max, max, max)}, "spin: its value needs to be a function of t"),
    ],
)
def test_wrong_formulations_are_refused(arguments, message):
    with pytest.raises((TypeError, ValueError), match=message):
        Formulation(**arguments)
