"""Several rotors in linear analyses: against closed forms and one rotor of their parts."""

import numpy as np
import pytest
import scipy.linalg as la
from train_models import (
    FIRST,
    GROUND,
    SECOND,
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
    Link,
    RotorTrain,
    SolidRotor,
    Support,
    campbell,
    critical_speeds,
    linear_model,
    stability,
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


def test_a_counter_rotating_pair_has_no_preferred_sense():
    """Two equal rotors, one turning back: every frequency twice, forward and backward alike."""
    rotor = rigid(*FIRST)
    supports = {name: [Support("a", 3e5), Support("b", 3e5)] for name in "AB"}
    links = [Link(f"A:{n}", f"B:{n}", Support(n, 2e5)) for n in "ab"]
    train = RotorTrain({"A": rotor, "B": rotor}, {"A": 1.0, "B": -1.0}, supports, links)
    values = lateral(campbell(train, [0.0, 400.0])).imag
    np.testing.assert_allclose(values[::2], values[1::2], rtol=1e-9)
    assert np.ptp(values[::2]) > 100.0


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


def test_rotors_of_one_speed_are_one_rotor():
    """At the ratio 1, springs between two rotors are springs inside one."""
    first, second = rings(*FIRST), rings(*SECOND)
    K = la.block_diag(first.stiffness.toarray(), second.stiffness.toarray())
    spring = np.diag([2e5, 2e5, 3e5])
    for name in "ab":
        U = np.hstack(
            [s * r.interfaces[name].mean_motion(10).toarray()[:3]
             for s, r in ((1.0, first), (-1.0, second))]
        )  # fmt: skip
        K += U.T @ spring @ U
    mass = la.block_diag(first.mass.toarray(), second.mass.toarray())
    joined = SolidRotor.from_matrices(mass, K, np.vstack([first.nodes, second.nodes]), "z")
    ground = [Support("a", 3e5, 20.0), Support("b", 4e5, 5.0)]
    inner = Support("b", damping=30.0, frame="rotor")
    for n in "ab":
        joined = joined.with_interface(n, first.interfaces[n].nodes)
    single = stability(joined, [250.0], supports=[*ground, inner], stiffening="none")
    rotors = {"A": first.reduce(24), "B": second.reduce(24)}
    links = [Link(f"A:{n}", f"B:{n}", Support(n, spring)) for n in "ab"]
    train = RotorTrain(rotors, {"A": 1.0, "B": 1.0}, {"A": [*ground, inner]}, links)
    both = stability(train, [250.0], stiffening="none")
    # the one rotor has more: the turn of its parts against each other, softened without a spring
    exact, found = (r.exponents[0][np.abs(r.exponents[0]) < 2e3] for r in (single, both))
    found, exact = found[np.abs(found) > 0.1], np.r_[exact, exact.conj()]
    assert len(found) == 9
    assert np.abs(found[:, None] - exact).min(axis=1).max() < 1e-6


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
        (both, ratios, {"driven": ["A", "A"]}, "every rotor once"),
        (both, ratios, {"links": [Link("A:a", "C:a", spring)]}, "'C' is unknown"),
        (both, ratios, {"links": [Link("A:a", "B:c", spring)]}, "'c' is unknown"),
    ]
    for rotors, speeds, more, words in refused:
        with pytest.raises((TypeError, ValueError), match=words):
            RotorTrain(rotors, speeds, **more)
    with pytest.raises(ValueError, match="'rotor:interface', got 'Aa'"):
        Link("Aa", "B:a", spring)
    with pytest.raises(ValueError, match="is at 'a'"):
        Link("A:b", "B:a", spring)
    with pytest.raises(ValueError, match="same rotor"):
        Link("A:a", "A:b", spring)
    with pytest.raises(ValueError, match="'D' is unknown"):
        two_discs(1.7).relative_to("D")


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
    with pytest.raises(ValueError, match="has its own"):
        linear_model(train, supports=[turning])


def test_table_of_a_link_is_over_the_difference_of_speeds():
    rotors, ratios = dict.fromkeys("AB", rigid(*FIRST)), {"A": 1.0, "B": 1.5}
    table = Support("a", ([0.0, 100.0], [1e5, 2e5]))
    there, back = (
        RotorTrain(rotors, ratios, links=[Link(*ends, table)])
        for ends in (("A:a", "B:a"), ("B:a", "A:a"))
    )
    with pytest.raises(
        ValueError, match=r"not -50 rad/s.* -0.5 times the speed of the analysis, 100 rad/s"
    ):
        linear_model(there).at(100.0)
    linear_model(back).at(100.0)
