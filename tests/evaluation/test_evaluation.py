"""Evaluation by API RP 684: against closed forms of the Jeffcott rotor and the printed rules."""

from functools import partial

import numpy as np
import pytest
from matplotlib import pyplot
from point_rotors import ring_rotor

from exudyn_rotor import (
    SolidRotor,
    StabilityLevelOne,
    Support,
    Unbalance,
    UnbalanceResponse,
    anticipated_cross_coupling,
    campbell,
    separation_margins,
    stability,
    stability_level_one,
    standard_unbalances,
    unbalance_response,
)
from exudyn_rotor.evaluation.level_one import largest_speed_ratio
from exudyn_rotor.evaluation.separation import required_margin

RPM = np.pi / 30.0
OMEGA = 100.0  # of the point on its support [rad/s]


def point(axis="z"):
    """A point of 1 kg."""
    return SolidRotor.from_matrices(
        np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], axis=axis, interfaces={"disc": [0]}
    )


def jeffcott(ratio):
    """The response of a Jeffcott rotor: ω = 100 rad/s, damping ratio ζ."""
    support = Support("disc", OMEGA**2, damping=2.0 * ratio * OMEGA)
    speeds, load = np.linspace(0.0, 400.0, 41), [Unbalance("disc", 1e-4)]
    return unbalance_response(point(), speeds, load, supports=[support], refine=True)


def sized(speeds, size):
    """A circular response of given size."""
    motion = np.array([1.0, -1j, 0, 0, 0, 0]) * np.asarray(size)[:, None]
    return UnbalanceResponse(("a",), [1], motion[:, None, None], "inertial", speeds)


# ------------------------------------------------------------------ amplification and margins


@pytest.mark.parametrize("ratio", [0.005, 0.05, 0.15])
def test_amplification_of_a_jeffcott_rotor(ratio):
    """|u| = e s/√((1 − s)² + 4ζ²s), s = (Ω/ω)²: peak 1/(2ζ√(1 − ζ²)) at s = 1/(1 − 2ζ²).

    The half-power points solve (P − 2)s² + P(4ζ² − 2)s + P = 0 with the square P of the peak. The
    parabola through three points leaves 1 % at refined resonances.
    """
    found = separation_margins(jeffcott(ratio), (200.0, 300.0))
    square = 1.0 / (4.0 * ratio**2 * (1.0 - ratio**2))
    sides = np.sqrt(np.sort(np.roots([square - 2.0, square * (4.0 * ratio**2 - 2.0), square]).real))
    peak = 1.0 / np.sqrt(1.0 - 2.0 * ratio**2)
    exact = peak / (sides[1] - sides[0])
    assert found.amplification == pytest.approx(exact, rel=0.01)
    assert found.peaks == pytest.approx(OMEGA * peak, rel=0.02 * ratio)
    np.testing.assert_allclose(found.half_power[0], OMEGA * sides, atol=0.02 * ratio * OMEGA)
    if ratio < 0.01:
        assert found.amplification == pytest.approx(0.5 / ratio, rel=0.01)


def test_margins_of_the_standard():
    """By hand: AF 10 gives 17 (1 − 1/8.5) = 15 % below and 25 % above; 16 % and 26 % are most."""
    factors = [2.49, 2.5, 3.5, 10.0, 100.0]
    np.testing.assert_allclose(required_margin(factors, False), [0, 0, 0.085, 0.15, 0.16])
    np.testing.assert_allclose(required_margin(factors, True), [0, 0.1, 0.185, 0.25, 0.26])


def test_margins_count_from_the_nearest_end_of_the_range():
    """A Jeffcott rotor with AF 10 at 100 rad/s: 15.0 % below and 25.0 % above are asked for."""
    response = jeffcott(0.05)
    for limits, actual, accepted in (
        ((120.0, 150.0), 0.167, True),
        ((115.0, 150.0), 0.128, False),
        ((60.0, 78.0), 0.285, True),
        ((60.0, 85.0), 0.179, False),
        ((90.0, 110.0), 0.0, False),
    ):
        found = separation_margins(response, limits)
        assert found.actual == pytest.approx(actual, abs=0.005)
        assert found.accepted.tolist() == [accepted]
    assert separation_margins(jeffcott(0.25), (90.0, 110.0)).accepted.tolist() == [True]


def test_one_side_of_a_peak_is_doubled_and_none_is_unknown():
    """1/size² = 1 + ((Ω − 100)/5)² has its half-power points at 95 and 105 rad/s."""
    speeds = np.linspace(98.0, 120.0, 111)
    beside, limits = sized(speeds, 1 / np.sqrt(1 + ((speeds - 100) / 5) ** 2)), (150, 200)
    with pytest.warns(UserWarning, match="from 126 to 252 rad/s count"):
        cut = separation_margins(beside, limits)
    assert np.isnan(cut.half_power[0, 0])
    assert cut.half_power[0, 1] == pytest.approx(105.0, rel=1e-9)
    assert cut.amplification == pytest.approx(10.0, rel=1e-9)
    with pytest.warns(UserWarning, match="known from 98 to 120 rad/s only"):
        bump = separation_margins(sized(speeds, 1 - 0.1 * ((speeds - 105) / 20) ** 2), limits)
    assert np.isnan(bump.amplification).tolist() == [True]
    assert bump.accepted.tolist() == [False]
    assert "no fall to 0.707" in bump.table()


def test_two_peaks_a_valley_and_no_peak():
    """The valley between two peaks stays above 0.707 of the second, which has one side only."""
    speeds = np.linspace(50.0, 210.0, 1601)
    size = 1 / np.hypot(1, (speeds - 100) / 5) + 0.6 / np.hypot(1, (speeds - 125) / 12)
    found = separation_margins(sized(speeds, size), (140.0, 160.0))
    assert len(found.peaks) == 2
    assert np.isnan(found.half_power).tolist() == [[False, False], [True, False]]
    none = separation_margins(sized(speeds, speeds), (60.0, 100.0))
    assert none.places == ()
    assert "no peak" in none.table()
    ax = none.plot()
    assert len(ax.lines) == 1
    pyplot.close(ax.figure)


# ------------------------------------------------------------------ unbalance


def test_amount_is_twice_four_times_weight_over_speed():
    """4 W/N oz in, W in lb, N in rpm: 1 oz = 28.349523 g, 1 in = 25.4 mm, 1 lb = 0.45359237 kg."""
    pounds, rpm = 1000.0, 8000.0
    [one] = standard_unbalances("translatory", ["disc"], 0.45359237 * pounds, rpm * RPM)
    assert one.amount == pytest.approx(2 * 4 * pounds / rpm * 28.349523e-3 * 25.4e-3, rel=1e-5)
    fast = [standard_unbalances("overhung", "end", 5.0, n * RPM)[0].amount for n in (25e3, 50e3)]
    assert fast[0] == fast[1] == pytest.approx(2 * 5.0 * 0.254e-6)


def test_placement_by_mode():
    [one] = standard_unbalances("first bending", "mid", [60.0, 40.0], 1000.0)
    pair = standard_unbalances("conical", ["left", "right"], [60.0, 40.0], 1000.0)
    assert [two.at for two in pair] == ["left", "right"]
    assert pair[0].amount + pair[1].amount == pytest.approx(one.amount)
    assert pair[0].amount / pair[1].amount == pytest.approx(1.5)
    assert np.cos(pair[1].angle - pair[0].angle) == pytest.approx(-1.0)
    half = standard_unbalances("second bending", ["a", "b"], [60.0, 40.0], 1000.0, multiple=1.0)
    assert 2.0 * half[0].amount == pytest.approx(pair[0].amount)


# ------------------------------------------------------------------ stability of level I


def test_anticipated_cross_coupling_of_the_printed_formula():
    """q = P·3·9.55·(ρd/ρs)/(D H N) in kN/mm with W, mm and rpm; the constant is 30/π."""
    power, diameter, width, rpm, ratio = 2e6, 400.0, 15.0, 9000.0, 1.3
    printed = power * 3.0 * (30.0 / np.pi) * ratio / (diameter * width * rpm) * 1e3 / 1e-3 * 1e-3
    found = anticipated_cross_coupling(power, rpm * RPM, 0.4, 0.015, density_ratio=ratio)
    assert found == pytest.approx(printed * 1e3, rel=1e-12)
    blades = anticipated_cross_coupling(power, rpm * RPM, 0.4, 0.015, machine="axial")
    assert blades == pytest.approx(found / (2.0 * ratio), rel=1e-12)


def level_one(coupling, damping, axis="z", **given):
    support = Support("disc", OMEGA**2, damping=damping)
    rotor = point(axis).reduce(0)
    return stability_level_one(rotor, 300.0, coupling, "disc", supports=support, **given)


@pytest.mark.parametrize(
    ("coupling", "damping", "axis"),
    [(500.0, 20.0, "x"), (1500.0, 20.0, "z"), (150.0, 5.0, [1.0, 2.0, -0.5])],
)
def test_threshold_of_a_jeffcott_rotor(coupling, damping, axis):
    """λ² + cλ + ω² − iQ = 0: the forward mode has δ = 0 at Q = c ω, and δ = 2πζ/√(1 − ζ²) at 0."""
    found = level_one(coupling, damping, axis)
    assert found.threshold == pytest.approx(damping * OMEGA, rel=1e-9)
    roots = [np.roots([1.0, damping, OMEGA**2 - 1j * q]) for q in found.applied]
    forward = np.array([pair[pair.imag.argmax()] for pair in roots])
    np.testing.assert_allclose(
        found.log_decrement, -2 * np.pi * forward.real / forward.imag, atol=1e-9
    )
    np.testing.assert_allclose(found.frequencies, forward.imag, rtol=1e-9)
    ratio = damping / (2.0 * OMEGA)
    assert found.log_decrement[0] == pytest.approx(2 * np.pi * ratio / np.sqrt(1 - ratio**2))


GYROSCOPIC = (0.3, 0.2, 10.0), 1e5, 4e5
UNEQUAL = (0.1, 0.3, 6.0), np.diag([1e6, 1.6e6]), np.diag([8e5, 1.5e6])


@pytest.mark.parametrize(
    ("shape", "left", "right", "damping", "place", "coupling", "mode"),
    [
        (*GYROSCOPIC, 40.0, "left", 4e3, 3),
        (*GYROSCOPIC, 40.0, "right", 4e3, 5),  # the second forward mode
        (*UNEQUAL, 45.0, "right", 2e4, 4),
        (*UNEQUAL, 150.0, "right", 2e4, 4),
    ],
)
def test_one_mode_is_followed_to_its_limit(shape, left, right, damping, place, coupling, mode):
    """Up to 10 or 20 Q_A alike; `campbell` and `stability` know nothing of it."""
    rotor = ring_rotor(*shape).with_interface("left", range(5))
    rotor = rotor.with_interface("right", range(5, 10)).reduce(0)
    held = [Support("left", left, damping), Support("right", right, damping)]
    given = {"at": place, "supports": held}
    few, found = (stability_level_one(rotor, 300.0, q * coupling, **given) for q in (1.0, 2.0))
    np.testing.assert_allclose(few.log_decrement[::2], found.log_decrement[:6], rtol=1e-9)
    modes = campbell(rotor, 300.0, supports=held)
    assert found.frequencies[0] == pytest.approx(modes.frequencies_inertial[0, mode], rel=1e-9)
    assert found.log_decrement[0] == pytest.approx(modes.log_decrement[0, mode], rel=1e-7)
    for share, stable in ((0.999, True), (1.001, False)):
        q = share * found.threshold
        coupled = [*held, Support(place, [[0.0, q], [-q, 0.0]])]
        assert stability(rotor, 300.0, supports=coupled).stable.tolist() == [stable]


def test_when_level_two_is_required():
    """SP6.8.5.10, each rule on both sides of its limit."""

    def reasons(**changes):
        given = {
            "applied": [0.0, 1.0, 2.0], "log_decrement": [0.4, 0.3, 0.2],
            "frequencies": [1.0] * 3, "anticipated": 1.0, "speed": 1.0,
            "machine": "centrifugal", "threshold": 5.0, "critical_speed_ratio": 2.0,
            "gas_density": 40.0,
        }  # fmt: skip
        return " ".join(StabilityLevelOne(**(given | changes)).reasons)

    assert reasons() == ""
    assert "log decrement at QA is below 0.1" in reasons(log_decrement=[0.2, 0.09, 0.0])
    assert reasons(log_decrement=[0.2, 0.11, 0.0]) == ""
    assert reasons(threshold=1.9) == "Q0/QA is below 2"
    assert reasons(threshold=None, critical_speed_ratio=None) == ""
    assert reasons(critical_speed_ratio=2.24) != "" == reasons(critical_speed_ratio=2.22)
    assert "not given" in reasons(gas_density=None)
    assert reasons(machine="axial", threshold=1.5) == ""
    assert [largest_speed_ratio(rho) for rho in (5.0, 60.1)] == [2.5, 0.0]
    assert largest_speed_ratio(60.0) == pytest.approx(2.0)


def test_several_stages_share_the_coupling_and_beyond_ten_times_there_is_no_threshold():
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    rotor = SolidRotor.from_matrices(np.eye(6), rod, [[0, 0, -0.1], [0, 0, 0.1]], "z")
    rotor = rotor.with_interface("left", [0]).with_interface("right", [1]).reduce(0)
    held = [Support("left", 1e4, damping=20.0), Support("right", 1.2e4, damping=30.0)]
    given = {"at": ["left", "right"], "supports": held}
    found = stability_level_one(rotor, 300.0, [500.0, 1.0], **given)
    assert found.anticipated == 501.0
    assert found.threshold == pytest.approx(2000.0 * 501.0 / 500.0, rel=1e-6)
    none = stability_level_one(rotor, 300.0, [10.0, 10.0], **given)
    assert none.threshold is None
    assert "Q0 above 10 QA" in none.table()
    assert not none.needs_level_two


def test_the_picture_shows_range_margin_and_factor():
    ax = separation_margins(jeffcott(0.05), (120.0, 150.0)).plot(units="SI")
    assert [text.get_text() for text in ax.texts] == ["AF 9.9"]
    assert ax.patches[0].get_x() == pytest.approx(120.0)
    assert ax.patches[1].get_width() == pytest.approx(0.15 * 120.0, rel=0.01)
    pyplot.close(ax.figure)


@pytest.mark.parametrize("damping", [2.0, 20.0])
def test_picture_of_level_one_has_threshold_and_limit_in_it(damping):
    """Q₀ on the line, also where it is a part of the first step; the limit not on the frame."""
    found = level_one(5e3, damping)
    ax = found.plot()
    line = ax.lines[0]
    assert np.interp(1e-6 * found.threshold, *line.get_data()) == pytest.approx(0.0, abs=1e-12)
    low, high = ax.get_ylim()
    assert low < -0.01 * (high - low)
    assert high > 0.1 + 0.01 * (high - low)
    pyplot.close(ax.figure)


def test_a_flank_from_rest_is_a_line():
    """Between 0 at rest and 0.9 at 10 rad/s; the peak at 20 rad/s is known from three points."""
    response = sized([0.0, 10.0, 20.0, 30.0, 40.0], [0.0, 0.9, 1.0, 0.6, 0.5])
    with pytest.warns(UserWarning, match="too far apart"):
        found = separation_margins(response, (1.0, 2.0))
    assert found.half_power[0, 0] == pytest.approx(10.0 / 0.9 * np.sqrt(0.5) * found.sizes[0])


SOFT, stage = Support("disc", 1.0), partial(anticipated_cross_coupling, 1e6, 100.0, 0.4, 0.01)
STIFF = SolidRotor.from_matrices(
    np.eye(3), np.diag([1e9, 1e9, 1e4]), [[0, 0, 0]], "z", interfaces={"disc": [0]}
).reduce(1)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: level_one(-1.0, 20.0), "cross_coupling: needs a positive number .* got -1.0"),
        (lambda: level_one([1.0, 2.0], 20.0), "cross_coupling: needs a positive number"),
        (lambda: level_one(5.0, 20.0, critical_speed_ratio=0.0), "critical_speed_ratio: needs"),
        (lambda: stability_level_one(STIFF, 9.0, 5.0, "disc", supports=SOFT), "no lateral mode"),
        (
            lambda: stability_level_one(STIFF, 9.0, 5.0, "disc", supports=()),
            "needs the bearings of",
        ),
        (
            lambda: stage(density_ratio=1.1, machine="axial"),
            "density_ratio: axial stages have none",
        ),
        (lambda: standard_unbalances("conical", "a", 5.0, 1.0), "'conical' takes 2 place"),
        (lambda: standard_unbalances("conical", ["a", "a"], [5.0, 5.0], 1.0), "got 'a' twice"),
        (
            lambda: standard_unbalances("conical", ["a", "b"], 5.0, 1.0),
            "masses: needs two positive",
        ),
        (lambda: standard_unbalances("overhung", "a", -5.0, 1.0), "masses: needs one or two"),
        (lambda: separation_margins(jeffcott(0.1), (9, 5)), "operating_range: needs the lowest"),
    ],
)
def test_what_is_refused_is_told(call, words):
    with pytest.raises((TypeError, ValueError), match=words):
        call()
