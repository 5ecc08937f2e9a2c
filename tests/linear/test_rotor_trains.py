"""Several rotors in linear analyses: against closed forms and one rotor of their parts."""

from dataclasses import replace

import numpy as np
import pytest
from test_inter_shaft import SHORT
from train_models import (
    FIRST,
    GROUND,
    UNEVEN,
    bar,
    by_hand,
    exponents_of,
    lateral,
    rigid,
    rings,
    two_discs,
)

from exudyn_rotor import (
    GearMesh,
    Link,
    RotorTrain,
    Support,
    campbell,
    critical_speeds,
    linear_model,
    static_response,
    unbalance_response,
)


@pytest.mark.parametrize("ratio", [1.7, -1.3, 1.0])
@pytest.mark.parametrize("ground", [GROUND[0], UNEVEN], ids=["isotropic", "cross-coupled"])
def test_two_rigid_discs_are_those_of_the_closed_form(ratio, ground):
    """Constant equations, or Hill's method: both to the rounding of an eigenvalue."""
    found = campbell(two_discs(ratio, ground), [0.0, 300.0])
    for row, speed in enumerate(found.speeds):
        exact = exponents_of(*by_hand(ratio, speed, ground))
        exact = exact[np.argsort(exact.imag)]
        np.testing.assert_allclose(lateral(found, row), exact, rtol=1e-9, atol=1e-7)


@pytest.mark.parametrize("order", [1.0, 1.7])
def test_critical_speeds_by_unbalance_of_either_rotor(order):
    """``Im λ(Ω) = pΩ`` of the closed form without damping; relative to the rotor as well."""
    train = two_discs(1.7)
    found = critical_speeds(train, order=order, nodal_diameters=[1]).speeds
    for speed in found:
        exact = exponents_of(*by_hand(1.7, speed, damped=False)).imag
        assert np.abs(exact / (order * speed) - 1.0).min() < 1e-9
    if order != 1.0:
        again = critical_speeds(train.relative_to("B"), nodal_diameters=[1]).speeds
        np.testing.assert_allclose(again / order, found, rtol=1e-8)


def test_bad_trains_are_refused():
    rotor, spring = rigid(*FIRST), Support("a", 1e5)
    both, ratios = {"A": rotor, "B": rotor}, {"A": 1.0, "B": 1.5}
    refused = [
        ({"A": rings(*FIRST)}, {"A": 1.0}, {}, "reduce a SolidRotor"),
        ({}, {}, {}, "at least one"),
        ({"A:1": rotor}, {"A:1": 1.0}, {}, "without a colon"),
        (both, {"A": 1.0}, {}, "one for each"),
        (both, {"A": 1.0, "B": 0.0}, {}, "foundation"),
        (both, ratios, {"supports": {"C": [spring]}}, "'C' is unknown"),
        (both, ratios, {"supports": {"A": [Support("c", 1.0)]}}, "no such interface"),
        (both, ratios, {"links": [Link("A:a", "C:a", spring)]}, "'C' is unknown"),
        (both, ratios, {"links": [Link("A:a", "B:c", spring)]}, "'c' is unknown"),
    ]
    for rotors, speeds, more, words in refused:
        with pytest.raises((TypeError, ValueError), match=words):
            RotorTrain(rotors, speeds, **more)
    mesh = GearMesh(radii=[0.1, 0.2], stiffness=3e6, backlash=1e-5)
    for call, words in (
        (lambda: Link("Aa", "B:a", spring), "'rotor:interface', got 'Aa'"),
        (lambda: Link("A:b", "B:a", spring), "is at 'a'"),
        (lambda: Link("A:a", "A:b", spring), "same rotor"),
        (lambda: Link("A:a", "B:a", mesh), "with backlash, .* give one without"),
        (lambda: Link("A:a", "B:a", replace(SHORT, load=[0.0, -9.0]).linearised()), "as a table"),
        (lambda: two_discs(1.7).relative_to("D"), "'D' is unknown"),
        (lambda: unbalance_response(two_discs(1.7), [9.0], at=3), "3: of several rotors, name an"),
        (lambda: static_response(two_discs(1.7), gravity=[9, 0, 0], stress=True), "one rotor"),
    ):
        with pytest.raises(ValueError, match=words):
            call()


def test_what_does_not_repeat_is_refused():
    """Uneven rotors and supports that turn, at ratios that are no whole numbers."""
    uneven = {"A": rigid(*FIRST), "B": bar()}
    springs = {"B": [Support("a", 1e5)]}
    with pytest.raises(ValueError, match=r"'B'.*: its unevenness is 0\.\d+, .*largest_unev"):
        linear_model(RotorTrain(uneven, {"A": 1.0, "B": 1.7}, springs)).at(100.0)
    linear_model(RotorTrain(uneven, {"A": 1.7, "B": 1.0}, springs)).at(100.0)
    turning = Support("a", [[1e5, 0.0], [0.0, 2e5]], frame="rotor")
    train = two_discs(1.7)
    with pytest.raises(ValueError, match="B:a is not the same in all directions"):
        linear_model(RotorTrain(train.rotors, train.ratios, {"B": [turning]})).at(100.0)
    with pytest.raises(ValueError, match="have their own"):
        linear_model(train, supports=[turning])


def test_table_of_a_link_is_over_the_difference_of_speeds():
    rotors, ratios = dict.fromkeys("AB", rigid(*FIRST)), {"A": 1.0, "B": 1.5}
    table = Support("a", ([0.0, 100.0], [1e5, 2e5]))
    there, back = (
        RotorTrain(rotors, ratios, links=[Link(*ends, table)])
        for ends in (("A:a", "B:a"), ("B:a", "A:a"))
    )
    with pytest.raises(ValueError, match="not -50 rad/s"):
        linear_model(there).at(100.0)
    linear_model(back).at(100.0)
