"""The search of limits of stability over growth given as a function."""

from collections.abc import Callable

import numpy as np
import pytest
from asymmetric import asymmetric_shaft
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, linear_sum_assignment

from exudyn_rotor import SolidRotor, Support, linear_model, stability_threshold, unstable_ranges
from exudyn_rotor.linear.periodic.periodic_system import UnconvergedError
from exudyn_rotor.linear.stability import thresholds
from exudyn_rotor.linear.stability.growth import Growth, GrowthAt
from exudyn_rotor.linear.stability.growth_over import GrowthOver
from exudyn_rotor.linear.stability.threshold_search import Search
from validation.extremes.rotors import held, shaft_frequencies, shaft_rotor


class Given(GrowthOver):
    """Growth of one motion, a function of the parameter; counts its calls."""

    def __init__(self, real: Callable[[float], float]) -> None:
        self.real, self.calls = real, 0

    def growth(self, value: float) -> Growth:
        self.calls += 1
        return Growth(np.array([self.real(value) + 3.0j]), np.array([1e-12]), 0.0, ())


@pytest.mark.parametrize(
    ("real", "calls"),
    [
        (lambda value: 2.0 * (value - np.pi / 10), 12),
        (lambda value: 0.3 * np.sinh(value - np.pi / 10), 16),
        (lambda value: np.sqrt(max(value - np.pi / 10, 0.0)) - 1e-9, 40),
        (lambda value: 1.0 if value > np.pi / 10 else -1.0, 40),
        (lambda value: 2.0 - value if value > np.pi / 10 else -1.0, 40),
    ],
    ids=["line", "curve", "root", "jump", "falling"],
)
@pytest.mark.parametrize("onset", [True, False])
def test_limits_of_any_growth_are_found(real, calls, onset):
    """To the accuracy asked for, here 1e-9; halving alone takes 30 calls."""
    made = Given(real if onset else lambda value: real(1.0 - value))
    search = Search(made, 1.0)
    for value in (0.0, 1.0):
        search.at(value)
    [(limit, found)] = search.changes(1e-9)
    assert found == onset
    assert limit == pytest.approx(np.pi / 10 if onset else 1.0 - np.pi / 10, abs=2e-9)
    assert made.calls <= calls


@pytest.mark.parametrize("shift", [0.0, 1e-4, -3e-3, 0.03])
@pytest.mark.parametrize("onset", [True, False])
def test_a_limit_of_a_finer_model_is_searched_beside_the_limit(monkeypatch, shift, onset):
    """Growth with the root of the parameter: to 2 % of steps up to four times the distance."""
    sign = 1.0 if onset else -1.0

    def real(value: float) -> float:
        return float(np.sqrt(complex(sign * (value - 0.5 - shift))).real) - 1e-9

    finer = Given(real)
    monkeypatch.setattr(thresholds, "Finer", lambda _: finer)
    search = Search(finer, 1.0)
    search.at(0.0), search.at(1.0)
    finer.calls = 0
    found = thresholds._searched_again(search, 0.5, onset)
    assert found == pytest.approx(shift, rel=0.08, abs=1e-6)
    assert finer.calls <= 16


@pytest.mark.parametrize(("onset", "distance"), [(True, 0.02), (False, 0.022)])
def test_a_narrow_range_of_a_finer_model_is_found(monkeypatch, onset, distance):
    """Unstable from 0.52 to 0.522, between the steps away from a limit at 0.5."""
    finer = Given(lambda value: 1e-6 - (value - 0.521) ** 2)
    monkeypatch.setattr(thresholds, "Finer", lambda _: finer)
    search = Search(finer, 1.0)
    search.at(0.0), search.at(1.0)
    found = thresholds._searched_again(search, 0.5, onset)
    assert found == pytest.approx(distance, abs=2e-6)


@pytest.mark.parametrize("speed", [40.0, 150.0, 310.0])
def test_rates_of_periodic_exponents_are_those_of_a_second_growth(speed):
    """By inverse iterations, as by central differences of the exponents; of the folded copies."""
    over = np.array([0.0, 500.0])
    uneven = np.array([[[2e6, 1e5], [-5e4, 1e6]], [[3e6, 1e5], [-5e4, 1.2e6]]])
    held = [Support(name, (over, uneven), 300.0) for name in ("left", "right")]
    space = linear_model(asymmetric_shaft(), supports=held).space(0, 500.0, held=True)
    growth, step = GrowthAt(space, "auto", 1e-11, keeps=True), 1e-3
    low, here, high = (growth(speed + sign * step) for sign in (-1.0, 0.0, 1.0))
    columns = [linear_sum_assignment(np.abs(here.values[:, None] - one.values))[1]
               for one in (low, high)]  # fmt: skip
    expected = (high.values[columns[1]] - low.values[columns[0]]) / (2.0 * step)
    rates = growth.rates(here, speed, step)
    assert np.abs(rates).max() > 1.0
    np.testing.assert_allclose(rates, expected, atol=1e-4)


def test_narrow_ranges_of_an_undamped_shaft_are_named():
    """Between the critical speeds in both directions, and between their means, which combine.

    Each range is narrower than the steps of the search, and ends before a step aside.
    """
    bending, bearing = np.array([4e5, 4e5 * (1.0 + 1e-5)]), 4e5
    ends = np.array([shaft_frequencies(10.0, 1.0, k, bearing) for k in bending])
    rotor, supports = shaft_rotor(10.0, 1.0, bending).reduce(8), held(bearing, "left", "right")
    given = {"supports": supports, "samples": 4, "accuracy": None}
    found = stability_threshold(rotor, 50.0, 1200.0, **given)
    assert found.onset.tolist() == [True, False] * 3
    for place, exact in ((slice(0, 2), ends[:, 0]), (slice(4, 6), ends[:, 1])):
        np.testing.assert_allclose(found.values[place], exact, atol=0.02 * np.ptp(exact))
    means = ends.mean(axis=0)
    np.testing.assert_allclose(found.values[2:4].mean(), means.mean(), rtol=1e-6)
    apart = np.abs(found.frequencies_inertial[:, None] / means - 1.0)
    assert apart.min(axis=1).max() < 1e-5
    assert apart.argmin(axis=1)[[0, 1, 4, 5]].tolist() == [0, 0, 1, 1]


def test_unstable_values_of_two_ranges_are_not_of_one():
    search = Search(Given(lambda value: 1e-6 - min(abs(value - 0.3), abs(value - 0.8))), 1.0)
    for value in (0.0, 0.3, 0.8, 1.0):
        search.at(value)
    search._part(0.0, 1.0)
    limits = [value for value, _ in search.changes(1e-9)]
    assert limits == pytest.approx([0.3 - 1e-6, 0.3 + 1e-6, 0.8 - 1e-6, 0.8 + 1e-6], abs=2e-9)


def uneven_mass(turning: float) -> SolidRotor:
    """Return a mass of 1 kg with a spring in y that turns with it."""
    stiffness = np.diag([0.0, turning, 1e4])
    return SolidRotor.from_matrices(
        np.eye(3), stiffness, [[0, 0, 0.1]], "z", interfaces={"disc": [0]}
    )


def growth_over_half_a_turn(speed: float, turning: float, ground: np.ndarray, c: float) -> float:
    """Return the largest ``ln |μ|`` of ``ẍ + c ẋ + (K + R diag(0, k) Rᵀ) x = 0``, integrated."""

    def rate(t: float, z: np.ndarray) -> np.ndarray:
        x, v = np.split(z.reshape(4, 4), 2)
        across = np.array([-np.sin(speed * t), np.cos(speed * t)])
        pull = ground @ x + c * v + turning * np.outer(across, across @ x)
        return np.concatenate([v, -pull]).ravel()

    span = (0.0, np.pi / speed)
    solved = solve_ivp(rate, span, np.eye(4).ravel(), "DOP853", rtol=1e-11, atol=1e-11)
    return float(np.log(np.abs(np.linalg.eigvals(solved.y[:, -1].reshape(4, 4)))).max())


@pytest.mark.parametrize("samples", [2, 24])
def test_a_range_of_turning_coefficients_may_begin_at_rest(samples):
    """Near rest the damped motions change by thousands of powers of ten within a turn.

    Limits of a mass on a spring that turns, by the integrated equations in inertial axes.
    """
    given = 2e3, np.diag([1e4, 1.3e4]), 4.0
    held = Support("disc", given[1], given[2])
    found = stability_threshold(uneven_mass(given[0]), 0.0, 250.0, supports=held, samples=samples)
    first = brentq(growth_over_half_a_turn, 102.0, 104.0, args=given, xtol=1e-8)
    assert found.values[0] == pytest.approx(first, abs=3e-6)
    assert found.onset[:4].tolist() == [True, False] * 2
    for value, onset in zip(found.values, found.onset, strict=True):
        sides = [growth_over_half_a_turn(value + side, *given) > 0.0 for side in (-0.01, 0.01)]
        assert sides == [not onset, onset]


class Turning(GrowthOver):
    """Growth of equations that turn, told from 0.3 rad/s on, and at rest."""

    def __init__(self, at_rest: float, above: Callable[[float], float]) -> None:
        self.at_rest, self.above = at_rest, above

    def is_at_rest(self, value: float) -> bool:
        return value == 0.0

    def growth(self, value: float) -> Growth:
        if 0.0 < value < 0.3:
            raise UnconvergedError("too slow")
        real = self.above(value) if value else self.at_rest
        return Growth(np.array([real + 3.0j]), np.array([1e-12]), 2.0 * value, ())


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_limit_below_the_slowest_speed_is_told_there_with_a_warning(sign):
    """As of cross-coupled forces that a spring keeps from flutter at rest, but not where it turns.

    Halves of 16 rad/s go down to 0.5, the last one above 0.3. A limit above is found as ever.
    """
    search = Search(Turning(-sign, lambda value: sign * (1.0 + value)), 16.0)
    search.at(0.0), search.at(16.0)
    search.refine()
    with pytest.warns(UserWarning, match="at rest and .*stable from 0.[345]"):
        [(value, onset)] = search.changes(1e-8)
    assert 0.3 <= value <= 0.5
    assert onset == (sign > 0.0)
    search = Search(Turning(-sign, lambda value: sign * (value - 5.0)), 16.0)
    search.at(0.0), search.at(16.0)
    search.refine()
    [(value, onset)] = search.changes(1e-8)
    assert (value, onset) == (pytest.approx(5.0, abs=1e-8), sign > 0.0)


def test_limits_of_a_full_rotor_by_floquet():
    """Nothing is left out of its coordinates; the error of the limits is zero, not unknown."""
    given = 2e3, np.diag([1e4, 1.3e4]), 4.0
    held = Support("disc", given[1], given[2])
    found = stability_threshold(
        uneven_mass(given[0]), 90.0, 104.0, supports=held, samples=4, method="floquet"
    )
    first = brentq(growth_over_half_a_turn, 102.0, 104.0, args=given, xtol=1e-8)
    assert found.values == pytest.approx([first], abs=3e-6)
    assert found.basis_shifts.tolist() == [0.0]


class Crossing(GrowthOver):
    """Undamped motions whose frequencies all meet, some at every value; counts its calls."""

    def __init__(self, count: int) -> None:
        self.slopes, self.calls = np.linspace(-1.0, 1.0, count) ** 3, 0

    def growth(self, value: float) -> Growth:
        self.calls += 1
        frequencies = 3.0 + self.slopes * (value - 0.5) + 0.1 * np.cos(9.0 * self.slopes) ** 2
        return Growth(1j * frequencies - 1e-9, np.full(len(self.slopes), 1e-12), 0.0, ())


def test_motions_that_meet_are_followed_as_long_as_that_is_worth_it(monkeypatch):
    """A shaft with one bending mode of two took a minute for the error of one limit."""
    finer = Crossing(60)
    monkeypatch.setattr(thresholds, "Finer", lambda _: finer)
    search = Search(finer, 1.0)
    search.at(0.0), search.at(1.0)
    finer.calls = 0
    assert np.isnan(thresholds._searched_again(search, 0.5, True))
    assert thresholds._MOST <= finer.calls < 3 * thresholds._MOST


@pytest.mark.parametrize("stiffer", [1.0, 1.3, 4.0])
@pytest.mark.parametrize("inner", [9.0, 40.0])
def test_the_limit_of_a_motion_on_uneven_supports_takes_few_solutions(monkeypatch, stiffer, inner):
    """Of two masses: at the end of the range the one that grows later may grow faster.

    ``(ms² + cs + k)(ms² + cs + l) + (dΩ)² = 0`` with springs k, l, dampers c = outer + d, d turning
    with the rotor, has ``s = iω`` for ``ω² = (k + l)/2m``, ``(dΩ)² = (k − l)²/4 + c²ω²``.
    """
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, [[0, 0, -0.1], [0, 0, 0.1]], "z")
    limits, supports = [], []
    masses = {"left": (2e4, 2.4e4, 9.0), "right": (1.2e4, 3.5e4 * stiffer, inner)}
    for place, (name, (k, el, d)) in enumerate(masses.items()):
        rotor = rotor.with_interface(name, [place])
        supports += [Support(name, np.diag([k, el]), 10.0), Support(name, damping=d, frame="rotor")]
        limits.append(np.hypot(0.5 * (k - el), (10.0 + d) * np.sqrt((k + el) / 4.0)) / d)
    solved, solve = [], GrowthAt.__call__
    monkeypatch.setattr(GrowthAt, "__call__", lambda *given: solved.append(1) or solve(*given))
    highest = 1.5 * max(limits)
    found = unstable_ranges(rotor, [50.0, highest], supports=supports, stiffening="none")
    assert found == pytest.approx(np.array([[min(limits), highest]]), abs=1e-8 * highest)
    assert len(solved) <= 2 + 2 + 2 + 2 + 1  # samples, halves, limits of both masses, name
