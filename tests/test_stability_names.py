"""Kind, whirl and frequency of what grows, margins by kind, and all thresholds of a range."""

import warnings
from itertools import pairwise

import numpy as np
import pytest
from asymmetric import asymmetric_shaft
from matplotlib import pyplot
from point_rotors import ring_rotor
from test_stability import (
    BEARING,
    INNER,
    MASS,
    OUTER,
    STIFFNESS,
    anisotropic,
    asymmetric_limits,
    inertial_multipliers,
)

from exudyn_rotor import (
    SolidRotor,
    Stability,
    StabilityThresholds,
    Support,
    campbell,
    stability,
    stability_threshold,
)
from exudyn_rotor.linear.modal.whirl import WHIRLS
from validation.extremes.rotors import held, shaft_rotor

TORSION, AXIAL = 3e3, 4e5
POLAR = MASS * 0.1**2


@pytest.fixture(scope="module")
def rings():
    return ring_rotor(0.1, 0.05, MASS).with_interface("all", range(10)).reduce(0)


def bearings(inner: float) -> list[Support]:
    """Return springs in all directions, dampers across the axis in the ground and the rotor."""
    tilt = np.diag([1e4, 1e4, TORSION])
    outer = Support("all", np.diag([STIFFNESS, STIFFNESS, AXIAL]), OUTER, tilt, 1.0)
    return [outer, Support("all", damping=inner, frame="rotor")]


def lateral(speed: float, inner: float) -> np.ndarray:
    """Return λ of ``m z̈ + (c_e + c_i) ż + (k − iΩ c_i) z = 0``, z = x + iy in inertial axes."""
    return np.roots([MASS, OUTER + inner, STIFFNESS - 1j * speed * inner])


def test_an_undamped_axial_mode_does_not_hide_the_lateral_growth(rings):
    """Each kind apart; the torsion's damping is d/(2 I_p)."""
    speeds = np.array([100.0, 300.0, 600.0])
    result = stability(rings, speeds, supports=bearings(INNER))
    expected = [max(lateral(speed, INNER).real) for speed in speeds]
    np.testing.assert_allclose(result.growth_of("lateral"), expected, rtol=1e-9)
    np.testing.assert_array_equal(result.growth_of("axial"), 0.0)
    np.testing.assert_array_equal(result.growth_of("torsional"), 0.0)
    assert np.isnan(result.growth_of("disc")).all()
    assert result.stable.tolist() == [True, True, False]
    at = 2, result.least_stable[2]
    assert (result.whirl[at], result.families[at], result.nodal_diameters[at]) == (
        "forward", "lateral", 1
    )  # fmt: skip
    root = max(lateral(600.0, INNER), key=lambda value: value.real)
    assert result.frequencies_inertial[at] == pytest.approx(root.imag, rel=1e-9)
    assert result.damping_ratio[at] == pytest.approx(-root.real / abs(root), rel=1e-9)
    assert result.log_decrement[at] == pytest.approx(-2.0 * np.pi * root.real / root.imag)
    assert "forward" in result.table()


def test_the_least_stable_motion_of_each_family_is_named():
    """Torsion with little damping is the least stable of all, and hid which lateral motion is.

    ``I_p φ̈ + d φ̇ + k φ = 0`` decays with d/(2 I_p).
    """
    rings = ring_rotor(0.1, 0.05, MASS).with_interface("all", range(10)).reduce(0)
    speeds, damping = np.array([100.0, 200.0]), 1e-3 * np.diag([1e3, 1e3, 1.0])
    tilt = np.diag([1e5, 1e5, TORSION])
    springs = Support("all", np.diag([STIFFNESS, STIFFNESS, AXIAL]), OUTER, tilt, damping)
    result = stability(
        rings, speeds, supports=[springs, Support("all", damping=1.0, frame="rotor")]
    )
    assert set(result.families[[0, 1], result.least_stable]) == {"torsional"}
    assert result.exponents[result.least_stable_of("torsional")].real == pytest.approx(
        -0.5e-3 / POLAR, rel=1e-6
    )
    row, column = result.least_stable_of("lateral")
    root = max((max(lateral(speed, 1.0), key=lambda value: value.real) for speed in speeds),
               key=lambda value: value.real)  # fmt: skip
    assert (row, result.whirl[row, column]) == (1, "forward")
    assert result.exponents[row, column].real == pytest.approx(root.real, rel=1e-9)
    decrement = -2.0 * np.pi * root.real / root.imag
    told = f"least stable lateral motion: {root.real:.4g} 1/s at 1909.86 rpm, "
    told += f"{root.imag / (2.0 * np.pi):.5g} Hz, forward, n = 1, log decrement {decrement:.3g}"
    assert told in result.table(units="rpm").splitlines()
    assert result.least_stable_of("disc") is None
    for word, omega in (("axial", AXIAL / MASS), ("torsional", TORSION / POLAR)):
        found = result.frequencies_inertial[result.whirl == word]
        np.testing.assert_allclose(found, np.sqrt(omega), rtol=1e-6)


def test_a_rotor_without_damping_has_no_least_stable_motion():
    """Few modes would err in some motion that rounding makes the largest; none is named."""
    rotor = shaft_rotor().reduce(2)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = stability(rotor, [0.0, 30.0], supports=held(1e5, "left", "right"))
    assert result.stable.all()
    assert result.neutral.all()
    assert np.isnan(result.basis_errors).all()
    for line in result.table().splitlines()[1:3]:
        assert line.split()[-4:] == ["-", "-", "-", "stable"]


@pytest.mark.parametrize("speed", [0.0, 17.0, 150.0])
def test_frequencies_of_a_periodic_system_are_those_seen_from_outside(rings, speed):
    """Springs that differ along n1 and n2: √(k/m − (c/2m)²), also far above the base 2Ω."""
    k = np.array([4e5, 1e5, 2e5])
    support = Support("all", np.diag(k), 8.0 * np.eye(3), np.diag([1e4, 1e4, TORSION]))
    result = stability(rings, [speed], supports=[support])
    decay = 8.0 / MASS / 2.0
    for stiffness in k:
        expected = np.sqrt(stiffness / MASS - decay**2)
        near = np.abs(result.frequencies_inertial - expected) < 1e-6 * expected
        assert np.count_nonzero(near) == 2
        np.testing.assert_allclose(result.exponents[near].real, -decay, rtol=1e-6)
    assert np.all(result.families[result.whirl == "axial"] == "axial")


def test_what_does_not_oscillate_has_no_decrement():
    """One kilogram with k = 1e4, d: overdamped in all three directions, ratio 1."""
    point = SolidRotor.from_matrices(
        np.eye(3), np.zeros((3, 3)), [[0.0, 0.0, 0.0]], "z", interfaces={"at": [0]}
    )
    support = Support("at", 1e4 * np.eye(3), 250.0 * np.eye(3))
    for result in (
        stability(point, [0.0, 70.0], supports=[support]),
        campbell(point, [0.0, 70.0], supports=[support]),
    ):
        np.testing.assert_allclose(result.damping_ratio, 1.0, rtol=1e-12)
        assert np.isnan(result.log_decrement).all()
    light = campbell(point, [0.0, 70.0], supports=[Support("at", 1e4 * np.eye(3), np.eye(3))])
    assert np.all(light.log_decrement < 0.1)


def test_thresholds_over_any_parameter(rings):
    """The inner damping from which a speed is unstable, and the stiffness below which it is."""
    speed, omega = 500.0, np.sqrt(STIFFNESS / MASS)
    inner = stability_threshold(rings, 10.0, 200.0, supports=bearings, speed=speed)
    np.testing.assert_allclose(inner.values, OUTER / (speed / omega - 1.0), rtol=1e-6)
    assert inner.onset.tolist() == [True]
    assert inner.frequencies_inertial == pytest.approx([omega], rel=1e-4)

    def softer(stiffness: float) -> list[Support]:
        return [Support("all", stiffness), *bearings(INNER)]

    added = stability_threshold(rings, 1.0, 9e5, supports=softer, speed=600.0, samples=3)
    expected = MASS * (600.0 / (1.0 + OUTER / INNER)) ** 2 - STIFFNESS
    np.testing.assert_allclose(added.values, expected, rtol=1e-6)
    assert added.onset.tolist() == [False]
    np.testing.assert_allclose(added.ranges, [[1.0, expected]], rtol=1e-6)


def test_a_narrow_range_between_samples_is_found():
    """An asymmetric shaft between its critical speeds, which no sample meets: ν = 0 there."""
    limits = asymmetric_limits()
    supports = [Support(name, np.diag([BEARING[0, 0]] * 3)) for name in ("left", "right")]
    samples = np.linspace(20.0, 250.0, 4)
    assert not np.any((samples > limits[0]) & (samples < limits[1]))
    found = stability_threshold(asymmetric_shaft(), 20.0, 250.0, supports=supports, samples=3)
    np.testing.assert_allclose(found.values, limits, rtol=1e-6)
    assert found.onset.tolist() == [True, False]
    np.testing.assert_allclose(found.frequencies_inertial, limits, rtol=1e-4)
    assert set(found.nodal_diameters) == {1}


def test_a_range_beside_a_limit_between_two_samples_is_found():
    """A mass on springs k₁, k₂ that turn, damped in the rotor (c_i) and in the ground (c_e):

    ``m ẍ + (c_i + c_e + 2mΩJ) ẋ + (diag(k₁, k₂) − mΩ² + c_eΩJ) x = 0``, J the quarter turn. It is
    unstable where ``(k₁ − mΩ²)(k₂ − mΩ²) + (c_eΩ)² < 0``, and again from where two of its roots are
    imaginary. Of samples at 50, 400 and 750 rad/s the first alone is stable.
    """
    k, inner, outer = np.array([100.0**2, 150.0**2]), 1.0, 2.0
    mass = SolidRotor.from_matrices(
        np.eye(3),
        np.diag([*k, 1e5]),
        [[0, 0, 0.1]],
        "z",
        inner * np.eye(3),
        interfaces={"disc": [0]},
    )
    supports = [Support("disc", damping=outer)]

    def roots(speed: float) -> np.ndarray:
        one, other = ([1.0, inner + outer, spring - speed**2] for spring in k)
        turning = [2.0 * speed, outer * speed]
        return np.roots(np.polyadd(np.polymul(one, other), np.polymul(turning, turning)))

    split = np.sqrt(np.roots([1.0, outer**2 - k.sum(), k.prod()])[::-1])
    low, high = 300.0, 400.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if roots(middle).real.max() > 0.0 else (middle, high)
    found = stability_threshold(mass, 50.0, 750.0, supports=supports, samples=2)
    np.testing.assert_allclose(found.values, [*split, low], rtol=1e-6)
    assert found.onset.tolist() == [True, False, True]


def test_gaps_between_unstable_samples_are_found():
    """Two gaps of 1.6 and 1.0 rad/s; multipliers of the same disc by a Runge–Kutta solution."""
    found = stability_threshold(asymmetric_shaft(), 150.0, 180.0, supports=anisotropic(), samples=3)
    assert len(found.ranges) == 3
    for (_, end), (start, _) in pairwise(found.ranges):
        assert np.abs(inertial_multipliers(0.5 * (end + start))).max() < 1.0
    assert "unstable" in found.table()
    assert found.plot().get_xlim() == (150.0, 180.0)


def test_a_gap_far_from_the_middle_of_two_samples_is_found():
    """The search goes to where growth falls; it would miss this gap on any other way."""
    found = stability_threshold(asymmetric_shaft(), 171.0, 179.0, supports=anisotropic(), samples=2)
    (_, end), (start, _) = found.ranges
    assert np.abs(inertial_multipliers(0.5 * (end + start))).max() < 1.0


def families_of(growth: dict[str, list[float]], speeds: list[float]) -> Stability:
    """Return a result with one motion for each word of whirl."""
    exponents = np.array(list(growth.values())).T + 100j
    codes = np.tile([WHIRLS.index(word) for word in growth], (len(speeds), 1))
    names = {"frequencies_inertial": np.full(codes.shape, 100.0), "whirl_codes": codes}
    names |= {"nodal_diameters": np.where(codes < 2, 1, 0), "bounds": np.zeros(codes.shape)}
    return Stability(
        speeds, exponents, exponents, exponents.real.max(axis=1), np.full(len(speeds), True),
        np.zeros(len(speeds)), **names, tolerance=1e-9, basis_shifts=[1e-3j] * len(speeds),
    )  # fmt: skip


def test_columns_of_the_table_end_where_their_heads_do():
    growth = {"forward": [-1.2345e-5, -12345.6], "torsional": [-0.00058684, -1.2345e-105]}
    lines = families_of(growth, [0.0, 2e5]).table().splitlines()
    for head, column in (("lateral [1/s]", 0), ("torsional", 1), ("basis error", -1)):
        end = lines[0].index(head) + len(head)
        for row, line in enumerate(lines[1:3]):
            shown = line[:end].split()[-1]
            assert line[end : end + 1] in (" ", "")
            if column >= 0:
                assert shown == f"{list(growth.values())[column][row]:.4g}"
    start = lines[0].index("verdict")
    assert [line[start:].split()[0] for line in lines[1:3]] == ["stable", "stable"]


def test_picture_has_a_line_for_each_family():
    """A torsional motion almost without damping leaves the lateral one to be seen."""
    growth = {"forward": [-6.0, -12.0], "torsional": [-5e-4, -1e-3], "axial": [-170.0, -169.0]}
    ax = families_of(growth, [0.0, 100.0]).plot(units="SI")
    drawn = {line.get_label(): line.get_ydata() for line in ax.lines}
    np.testing.assert_array_equal(drawn["lateral"], growth["forward"])
    np.testing.assert_array_equal(drawn["torsional"], growth["torsional"])
    np.testing.assert_array_equal(drawn["least stable"], growth["torsional"])
    assert np.all(np.isnan(drawn["axial: -169 at most"]))
    assert -15.0 < ax.get_ylim()[0] < -12.0
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["least stable", "lateral", "torsional", "axial: -169 at most"]


def test_picture_marks_the_least_stable_motion_through_its_threshold():
    """It is neutral there, which a motion that is neutral at all speeds does not replace."""
    growth = {"forward": [-2.0, 0.0, 1.0], "backward": [-3.0, -4.0, -5.0], "axial": [0.0] * 3}
    ax = families_of(growth, [0.0, 50.0, 100.0]).plot()
    drawn = {line.get_label(): line.get_ydata() for line in ax.lines}
    np.testing.assert_array_equal(drawn["least stable"], [-2.0, 0.0, 1.0])
    np.testing.assert_array_equal(drawn["axial"], 0.0)


def test_thresholds_stand_below_their_heads():
    label = "damping of the seal [N s/m]"
    given = [[3e-7, 5e5], [True, False], [9.0, 9.0], [4, 0], [0, 1], 0.0, 1e6, False]
    lines = StabilityThresholds(*given, label=label).table().splitlines()[:3]
    assert [line[: len(label)].strip() for line in lines] == [label, "3e-07", "500000"]
    kind = lines[0].index("kind")
    assert [line[kind:] for line in lines[1:]] == ["torsional", "lateral"]


def test_picture_without_thresholds_tells_the_verdict():
    for unstable, verdict in ((False, "stable"), (True, "unstable")):
        ax = StabilityThresholds([], [], [], [], [], 10.0, 30.0, unstable).plot()
        assert ax.get_title() == f"{verdict} in the whole range"


def test_growth_below_its_bound_is_told_with_the_bound():
    """Where differences of forces leave 4e-3 1/s, an axial growth of −2e-3 1/s is not known."""
    values = [[-1.0 + 100.0j, -2e-3 + 50.0j, 1e-14 + 70.0j]]
    names = {"frequencies_inertial": [[100.0, 50.0, 70.0]], "nodal_diameters": [[1, 0, 0]]}
    names["whirl_codes"] = [[WHIRLS.index(name) for name in ("forward", "axial", "torsional")]]
    names["bounds"] = [[1e-3, 4e-3, 1e-12]]
    result = Stability([50.0], values, values, [-2e-3], [True], [0.0], **names, tolerance=1e-9)
    assert result.table().splitlines()[1].split()[:4] == ["50.0000", "-1", "0", "±0.004"]


def test_limits_over_the_speed_in_engineering_units():
    """300 rad/s are 2864.8 rpm, 100 rad/s are 15.915 Hz; a damping keeps its unit."""
    given = [300.0], [True], [100.0], [0], [1], 0.0, 400.0, False
    limits = StabilityThresholds(*given)
    assert limits.table(units="rpm").splitlines()[1].split()[:3] == [
        "2864.789",
        "unstable",
        "15.915",
    ]
    assert next(iter(limits.columns("rpm"))) == "speed [rpm]"
    ax = limits.plot(units="rpm")
    np.testing.assert_allclose(ax.lines[0].get_xydata(), [[9000.0 / np.pi, 50.0 / np.pi]])
    np.testing.assert_allclose(ax.get_xlim(), (0.0, 12000.0 / np.pi))
    assert ax.get_xlabel() == "speed [rpm]"
    pyplot.close(ax.figure)
    damping = StabilityThresholds(*given, label="damping [N s/m]")
    row = damping.table(units="rpm").splitlines()[1].split()
    assert row[:3] == ["300", "unstable", "15.915"]
