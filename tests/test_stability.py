"""Exponents of constant and periodic systems against closed forms and other methods."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from asymmetric import DISC, END, SHAFT, asymmetric_shaft
from exponent_methods import constant_exponents, floquet_exponents, hill_exponents
from matplotlib import pyplot
from point_rotors import ring_rotor
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic.exponents import exponents, motions
from exudyn_rotor.linear.periodic.fundamental import _magnus, monodromy
from exudyn_rotor.linear.equations import PeriodicSystem, UnconvergedError, fold
from exudyn_rotor.linear.stability.stability import stability
from exudyn_rotor.linear.stability.stability_map import StabilityMap, stability_map
from exudyn_rotor.linear.stability.stability_result import Stability
from exudyn_rotor.linear.stability.thresholds import stability_threshold, unstable_ranges
from exudyn_rotor.results import load_result

STIFFNESS, OUTER, INNER, MASS = 2e5, 60.0, 40.0, 5.0
BEARING, BEARING_DAMPING = np.diag([3e5, 5e5]), np.diag([20.0, 30.0])


def mathieu(a: float, q: float) -> PeriodicSystem:
    """Return ``x″ + (a − 2q cos 2t) x = 0``, with t as the spin angle."""
    one = np.eye(1)
    return PeriodicSystem(1.0, {0: one}, {0: 0.0 * one}, {0: a * one, 2: -q * one, -2: -q * one})


def random_system(seed: int, size: int = 4) -> PeriodicSystem:
    """Return a damped gyroscopic system with harmonics 1 and 3 in all matrices, M symmetric."""
    rng = np.random.default_rng(seed)

    def terms(mean: np.ndarray, share: float, symmetric: bool = False) -> dict[int, np.ndarray]:
        made = {0: mean}
        for n in (1, 3):
            term = share * (rng.normal(size=(size, size)) + 1j * rng.normal(size=(size, size)))
            term = 0.5 * (term + term.T) if symmetric else term
            made[n], made[-n] = term, term.conj()
        return made

    skew = rng.normal(size=(size, size))
    stiffness = np.diag(rng.uniform(2.0, 60.0, size))
    return PeriodicSystem(
        1.3,
        terms(np.eye(size), 0.01, symmetric=True),
        terms(0.3 * np.eye(size) + skew - skew.T, 0.05),
        terms(stiffness, 0.8),
    )


def paired(found: np.ndarray, expected: np.ndarray, base: float) -> float:
    """Return the largest distance of `expected` to its nearest `found`, modulo i·base."""
    return np.abs(fold(found[:, None] - expected + 0.0j, base)).min(axis=0).max()


@pytest.mark.parametrize("q", [0.3, 1.0, 5.0])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_mathieu_characteristic_values_bound_the_instability(order, q):
    # at a_n(q), b_n(q) a solution is periodic in π (n even) or antiperiodic (McLachlan 1947)
    for value in (mathieu_a(order, q), mathieu_b(order, q)):
        trace = np.trace(monodromy(mathieu(value, q), 1e-12)[0])
        assert trace == pytest.approx(2.0 * (-1.0) ** order, abs=1e-9 * np.exp(q))
    inside = mathieu(0.5 * (mathieu_a(order, q) + mathieu_b(order, q)), q)
    beyond = mathieu(0.5 * (mathieu_a(order, q) + mathieu_b(order + 1, q)), q)
    assert hill_exponents(inside)[0].real.max() > 1e-5
    assert abs(hill_exponents(beyond)[0].real).max() < 1e-9


@pytest.mark.parametrize("steps", [16, 32])
def test_magnus_steps_are_of_sixth_order(steps):
    """Against a Runge–Kutta solution of Mathieu's equation; halving the step divides by 2⁶.

    Of the same order are terms with h⁸, relative to h⁶ some (h √a)² = 0.2 or less.
    """
    a, q = 5.0, 2.0

    def rate(t: float, z: np.ndarray) -> np.ndarray:
        x, v = z.reshape(2, 2)
        return np.array([v, -(a - 2.0 * q * np.cos(2.0 * t)) * x]).ravel()

    solved = solve_ivp(rate, (0.0, np.pi), np.eye(2).ravel(), "DOP853", rtol=1e-13, atol=1e-13)
    exact = solved.y[:, -1].reshape(2, 2)
    coarse, fine = (
        np.abs(_magnus(mathieu(a, q), np.pi, n) - exact).max() for n in (steps, 2 * steps)
    )
    assert np.log2(coarse / fine) == pytest.approx(6.0, abs=0.4)


@pytest.mark.parametrize("seed", range(4))
def test_hill_and_floquet_agree(seed):
    system = random_system(seed)
    hill, error = hill_exponents(system, 1e-10)
    floquet = floquet_exponents(system, 1e-12)
    assert error <= 1e-10
    assert len(hill) == len(floquet) == 8
    assert paired(hill, floquet, 1.3) < 1e-8
    assert paired(floquet, hill, 1.3) < 1e-8


def test_motions_that_die_within_a_turn_are_not_taken_for_neutral():
    """Of a multiplier of 1e-12 rounding leaves that it is small, by Floquet's method."""
    coupling = np.array([[1e3, 2e4], [2e4, 5e4]])
    stiffness = {0: np.diag([1e4, 1e6]), 2: coupling, -2: coupling}
    system = PeriodicSystem(300.0, {0: np.eye(2)}, {0: np.diag([1.0, 3e3])}, stiffness)
    found, exact = motions(system, "floquet"), motions(system, "hill").values
    assert np.all(found.values.real + found.bounds < 0.0)
    apart = np.abs(fold(found.values[:, None] - exact, system.base))
    assert np.all(apart.min(axis=1) < found.bounds + 1e-6)


def test_the_error_of_hills_method_is_not_underestimated():
    system = random_system(0)
    exact = floquet_exponents(system, 1e-13)
    for tolerance in (1e-2, 1e-4, 1e-6):
        values, error = hill_exponents(system, tolerance)
        assert error <= tolerance
        assert paired(values, exact, 1.3) < 3.0 * 1.3 * error + 1e-11


def test_exponents_sum_to_the_mean_trace():
    # Liouville: det Φ(T) = exp ∫ tr A dt, and tr A = −tr M⁻¹D
    system = random_system(1)
    angles = 2.0 * np.pi * np.arange(400) / 400
    traces = [np.trace(np.linalg.solve(M, D)) for M, D, _ in map(system.matrices, angles)]
    assert hill_exponents(system)[0].real.sum() == pytest.approx(-np.mean(traces), abs=1e-7)


def test_internal_damping_sets_in_at_the_closed_form_speed():
    # rigid rotor on one spring: Ω = ω (1 + c_e/c_i), Friswell et al. (2010), Sect. 7.2
    rotor = ring_rotor(0.1, 0.05, MASS).with_interface("all", range(10)).reduce(0)
    outer = Support("all", np.diag([STIFFNESS] * 3), OUTER, tilt_stiffness=1e4)
    inner = Support("all", damping=INNER, frame="rotor")
    expected = np.sqrt(STIFFNESS / MASS) * (1.0 + OUTER / INNER)
    found = stability_threshold(rotor, 100.0, 900.0, supports=[outer, inner])
    assert found.values == pytest.approx([expected], rel=1e-6)
    result = stability(rotor, [0.0, 0.99 * expected, 1.01 * expected], supports=[outer, inner])
    assert result.stable.tolist() == [True, True, False]
    assert np.all(result.base == 0.0)
    assert np.isnan(result.multipliers[0]).all()


def asymmetric_limits() -> np.ndarray:
    """Return the speeds at which an asymmetric shaft on isotropic supports is unstable between.

    A deflection along a principal direction of stiffness k is in equilibrium at Ω where
    ``(k − mΩ²)(k + k_b − 2m_eΩ²) = k²``; k_b is the stiffness of both bearings.
    """

    def balance(speed: float, k: float) -> float:
        disc, ends = k - DISC * speed**2, k + 2.0 * BEARING[0, 0] - 2.0 * END * speed**2
        return disc * ends - k**2

    return np.array([brentq(balance, 50.0, 250.0, args=(k,), xtol=1e-12) for k in SHAFT])


def test_asymmetric_shaft_on_isotropic_supports():
    supports = [Support(name, np.diag([BEARING[0, 0]] * 3)) for name in ("left", "right")]
    found = unstable_ranges(asymmetric_shaft(), np.linspace(0.0, 250.0, 26), supports=supports)
    assert found == pytest.approx(asymmetric_limits()[None, :], rel=1e-6)


def inertial_multipliers(speed: float) -> np.ndarray:
    """Return the multipliers over half a revolution of disc and bearings, inertial coordinates.

    Four coordinates: the disc and the mean of the ends, integrated by an explicit Runge–Kutta
    method of order 8.
    """

    def rate(t: float, z: np.ndarray) -> np.ndarray:
        (c, s), states = (np.cos(speed * t), np.sin(speed * t)), z.reshape(8, 8)
        turn = np.array([[c, -s], [s, c]])
        disc, ends, disc_t, ends_t = states[:2], states[2:4], states[4:6], states[6:]
        pull = turn @ np.diag(SHAFT) @ turn.T @ (disc - ends)
        hold = 2.0 * (BEARING @ ends + BEARING_DAMPING @ ends_t)
        return np.vstack([disc_t, ends_t, -pull / DISC, (pull - hold) / (2.0 * END)]).ravel()

    span = (0.0, np.pi / speed)
    solved = solve_ivp(rate, span, np.eye(8).ravel(), "DOP853", rtol=1e-11, atol=1e-9)
    return np.linalg.eigvals(solved.y[:, -1].reshape(8, 8))


def anisotropic() -> list[Support]:
    return [
        Support(name, np.diag([*np.diag(BEARING), 1e6]), BEARING_DAMPING)
        for name in ("left", "right")
    ]


@pytest.mark.parametrize("method", ["hill", "floquet"])
def test_asymmetric_shaft_on_anisotropic_supports(method):
    speeds = np.array([120.0, 156.0, 200.0])
    result = stability(asymmetric_shaft(), speeds, supports=anisotropic(), method=method)
    assert result.base == pytest.approx(2.0 * speeds)
    for speed, found in zip(speeds, result.exponents, strict=True):
        expected = np.log(inertial_multipliers(speed).astype(complex)) * speed / np.pi
        # the multipliers' frame turns by half a revolution, which takes the sign of each
        assert paired(found + 1j * speed, expected, 2.0 * speed) < 1e-6 * speed
    assert not result.stable.all()
    assert result.stable.any()


def test_limits_of_an_asymmetric_shaft_on_anisotropic_supports():
    speeds = [100.0, 140.0, 160.0, 164.5, 175.0, 220.0]  # there are two ranges, close together
    found = unstable_ranges(asymmetric_shaft(), speeds, supports=anisotropic())
    assert len(found) == 2

    def excess(speed: float) -> float:
        return np.log(np.abs(inertial_multipliers(speed)).max())

    for low, high in found:
        assert excess(low * (1.0 - 1e-6)) < 0.0 < excess(low * (1.0 + 1e-6))
        assert excess(high * (1.0 + 1e-6)) < 0.0 < excess(high * (1.0 - 1e-6))


def test_a_symmetric_rotor_does_not_depend_on_the_frame():
    # without tilts and asymmetry: eigenvalues of the plain springs, seen from the rotor ± iΩ
    rotor = ring_rotor(0.1, 0.05, MASS).with_interface("all", range(10)).reduce(0)
    support = Support("all", np.diag([4e5, 1e5, 2e5]), np.diag([8.0, 5.0, 3.0]))
    speed = 150.0
    found = stability(rotor, [speed], supports=[support]).exponents[0]
    for k, c in ((4e5, 8.0), (1e5, 5.0)):
        expected = np.roots([MASS, c, k]) + 1j * speed
        assert paired(found, expected, 2.0 * speed) < 1e-9 * np.sqrt(k / MASS)


def test_a_free_spin_of_an_eccentric_rotor_is_not_called_unstable():
    rotor = ring_rotor(0.1, 0.05, MASS).add_point_mass([0.1, 0.0, 0.05], 0.05)
    reduced = rotor.with_interface("all", range(10)).reduce(0)
    support = Support("all", np.diag([2e5] * 3), 20.0, tilt_stiffness=1e4, tilt_damping=1.0)
    assert stability(reduced, [50.0, 120.0], supports=[support]).stable.all()
    torsion = Support("all", tilt_stiffness=np.diag([0.0, 0.0, 100.0]))
    held = stability(reduced, [50.0, 120.0], supports=[support])
    free = stability(reduced, [50.0, 120.0], supports=[support, torsion])
    assert free.exponents.shape[1] == held.exponents.shape[1] + 2
    assert abs(free.exponents.imag).min(axis=1) == pytest.approx(np.sqrt(100.0 / 0.05), rel=0.02)


def test_zero_speed_is_the_rotor_at_rest():
    result = stability(asymmetric_shaft(), [0.0], supports=anisotropic())
    system = LinearRotor.of(asymmetric_shaft(), anisotropic()).at(0.0)
    assert paired(constant_exponents(system), result.exponents[0], 0.0) < 1e-6
    assert result.stable[0]


def _jeffcott(inner: float, speed: float) -> tuple[LinearRotor, float]:
    rotor = ring_rotor(0.1, 0.05, MASS).with_interface("all", range(10)).reduce(0)
    outer = Support("all", np.diag([STIFFNESS] * 3), OUTER, tilt_stiffness=1e4)
    return LinearRotor.of(rotor, [outer, Support("all", damping=inner, frame="rotor")]), speed


def test_map_over_two_parameters(tmp_path):
    inner, speeds = np.array([20.0, 40.0, 80.0]), np.array([200.0, 400.0, 550.0, 700.0])
    result = stability_map(_jeffcott, inner, speeds, labels=("c_i", "Ω"))
    limit = np.sqrt(STIFFNESS / MASS) * (1.0 + OUTER / inner)
    assert np.array_equal(result.stable, speeds < limit[:, None])
    for damping, growth in zip(inner, result.growth, strict=True):
        assert np.array_equal(growth, stability(_jeffcott(damping, 0.0)[0], speeds).growth)
    assert result.plot().get_ylabel() == "Ω"
    result.save(tmp_path / "map.npz")
    assert np.array_equal(load_result(tmp_path / "map.npz").growth, result.growth)


@pytest.mark.parametrize("shape", [(1, 1), (1, 3), (3, 1)])
def test_a_map_with_one_value_of_a_parameter_is_a_curve(shape):
    growth = np.array([-0.5, 0.2, 0.4])[: max(shape)].reshape(shape)
    x, y = ([1.0, 2.0, 3.0][:count] for count in shape)
    ax = StabilityMap(x, y, growth, growth < 0.0, ("k", "c")).plot()
    curve, given, fixed = ax.lines[1].get_xydata(), *((y, "k") if shape[1] > 1 else (x, "c"))
    np.testing.assert_array_equal(curve, np.column_stack([given, growth.ravel()]))
    assert ax.get_title() == f"{fixed} = 1"
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("c" if fixed == "k" else "k", "growth [1/s]")
    marked = [line.get_xdata().tolist() for line in ax.lines[2:]]
    assert marked == [given[1:]] * (len(given) > 1)
    pyplot.close(ax.figure)


@pytest.mark.parametrize("as_system", [True, False])
def test_map_by_each_method_and_elsewhere(as_system):
    """Exponents by Floquet's method agree with Hill's; what is computed elsewhere is the same."""

    def build(across: float, speed: float):
        supports = [Support(name, np.diag([3e5, across, 1e6]), 20.0) for name in ("left", "right")]
        model = LinearRotor.of(asymmetric_shaft(), supports)
        return model.at(speed) if as_system else (model, speed)

    class Counting(ThreadPoolExecutor):
        tasks = 0

        def submit(self, *task):
            self.tasks += 1
            return super().submit(*task)

    grid = [4e5, 5e5], [120.0, 156.0]
    hill = stability_map(build, *grid, method="hill")
    floquet = stability_map(build, *grid, method="floquet", tolerance=1e-11)
    assert not np.array_equal(floquet.growth, hill.growth)
    np.testing.assert_allclose(floquet.growth, hill.growth, rtol=0.0, atol=1e-9 * grid[1][-1])
    with pytest.raises(ValueError, match="method='eigen': at 120 rad/s the system is periodic"):
        stability_map(build, *grid, method="eigen")
    with Counting(2) as threads:
        there = stability_map(build, *grid, method="hill", executor=threads)
    assert threads.tasks == 4
    assert np.array_equal(there.growth, hill.growth)


def test_result_is_stored_drawn_and_printed(tmp_path):
    result = stability(asymmetric_shaft(), [100.0, 156.0], supports=anisotropic())
    result.save(tmp_path / "stability.npz")
    again = Stability.load(tmp_path / "stability.npz")
    assert np.array_equal(again.exponents, result.exponents)
    assert "1/s" in result.plot().get_ylabel()
    assert "unstable" in result.table()
    np.testing.assert_allclose(
        result.multipliers, np.exp(result.exponents * np.pi / result.speeds[:, None]), rtol=1e-12
    )


@pytest.mark.parametrize(
    ("speeds", "options", "message"),
    [
        ([200.0, 100.0], {}, "ascending"),
        ([-1.0, 100.0], {}, "≥ 0"),
        ([np.nan], {}, "finite"),
        ([], {}, "speeds: needs at least one number"),
        ([100.0], {"method": "guess"}, "unknown"),
        ([100.0], {"tolerance": 0.0}, "tolerance"),
        ([100.0], {"method": "eigen"}, "periodic"),
    ],
)
def test_bad_input(speeds, options, message):
    with pytest.raises(ValueError, match=message):
        stability(asymmetric_shaft(), speeds, supports=anisotropic(), **options)


def test_unreached_tolerances_are_errors(monkeypatch):
    slow = mathieu(50.0, 20.0)
    slow = PeriodicSystem(0.1, slow.M, slow.D, slow.K)
    monkeypatch.setattr("exudyn_rotor.linear.periodic.hill.MOST_UNKNOWNS", 30)
    with pytest.raises(UnconvergedError, match="harmonics up to"):
        hill_exponents(slow)
    fallen_back = exponents(slow)
    assert np.array_equal(np.sort(fallen_back), np.sort(floquet_exponents(slow)))
    monkeypatch.setattr("exudyn_rotor.linear.periodic.fundamental.MOST_STEPS", 512)
    with pytest.raises(UnconvergedError, match="steps a period"):
        floquet_exponents(slow)
    with pytest.raises(UnconvergedError, match=r"use a larger speed \(or 0\)"):
        exponents(slow)


def test_growth_beyond_the_largest_number_within_a_period_is_an_error():
    """``exp(20 · 62.8)`` overflows; numpy does not warn (warnings are errors here)."""
    growing = mathieu(50.0, 20.0)
    growing = PeriodicSystem(0.1, growing.M, {0: np.array([[-40.0]])}, growing.K)
    with pytest.raises(UnconvergedError, match="steps a period"):
        floquet_exponents(growing)


def test_more_bad_input():
    resting = PeriodicSystem(0.0, *({0: np.eye(1)} for _ in range(3)))
    with pytest.raises(ValueError, match="no period"):
        monodromy(resting)
    with pytest.raises(ValueError, match="speed: is the parameter"):
        stability_threshold(asymmetric_shaft(), 10.0, 20.0, supports=anisotropic(), speed=5.0)
    with pytest.raises(ValueError, match="speed: needs the spin speed"):
        stability_threshold(lambda stiffness: asymmetric_shaft(), 10.0, 20.0)
    with pytest.raises(TypeError, match="unknown option guess"):
        unstable_ranges(asymmetric_shaft(), [10.0, 20.0], guess=1)
    with pytest.raises(ValueError, match=r"y: needs .* ascending order"):
        stability_map(_jeffcott, [1.0, 2.0], [2.0, 1.0])
    with pytest.raises(ValueError, match=r"at \(1\.0, -2\.0\): build: the speed .*, got -2\.0$"):
        stability_map(_jeffcott, [1.0], [-2.0])
