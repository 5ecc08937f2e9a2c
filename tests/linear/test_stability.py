"""Exponents over the spin speed against closed forms."""

import warnings

import numpy as np
import pytest
from asymmetric import asymmetric_shaft

from exudyn_rotor import SolidRotor, Support, linear_model, stability
from exudyn_rotor.linear.equations import PeriodicSystem, joined
from exudyn_rotor.linear.solve.motions import motions_of

MASS, STIFFNESS, OUTER, INNER = 2.0, 2e4, 10.0, 5.0  # of each of two masses; ω = 100 rad/s


@pytest.fixture(scope="module")
def rod():
    """Return two masses on a rod that is stiff along the axis, free otherwise."""
    stiff = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    rotor = SolidRotor.from_matrices(
        MASS * np.eye(6), stiff, [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]], "z"
    )
    return rotor.with_interface("left", [0]).with_interface("right", [1])


def both(*given, **more) -> list[Support]:
    return [Support(name, *given, **more) for name in ("left", "right")]


def lateral(speed: float, inner: float = 0.0, cross: float = 0.0) -> np.ndarray:
    """Return λ of ``m z̈ + (c_o + c_i) ż + (k − iΩ c_i − iq) z = 0``, z = x + iy standing still."""
    return np.roots([MASS, OUTER + inner, STIFFNESS - 1j * (speed * inner + cross)])


@pytest.mark.parametrize("speed", [0.0, 50.0, 299.0, 301.0, 800.0])
@pytest.mark.parametrize("cross", [0.0, 500.0])
def test_inner_damping_and_cross_coupling(rod, speed, cross):
    supports = [
        *both([[STIFFNESS, cross], [-cross, STIFFNESS]], OUTER),
        *both(damping=INNER, frame="rotor"),
    ]
    result = stability(rod, [speed], supports=supports)
    expected = lateral(speed, INNER, cross)
    worst = expected[np.argmax(expected.real)]
    assert result.growth_of("lateral")[0] == pytest.approx(worst.real, rel=1e-9)
    assert result.stable[0] == (worst.real < 0.0)
    row, column = 0, np.argmax(result.families[0] == "lateral")
    assert result.frequencies_inertial[row, column] == pytest.approx(abs(worst.imag), rel=1e-9)
    assert result.log_decrement[row, column] == pytest.approx(
        -2.0 * np.pi * worst.real / abs(worst.imag), rel=1e-8
    )
    if speed or cross:
        assert result.whirl[row, column] == "forward"
        wanted = abs(worst.imag - speed) if worst.imag > 0.0 else abs(worst.imag + speed)
        assert result.exponents[row, column].imag == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("ratio", [1.5, 2.0, 10.0])
@pytest.mark.parametrize("damping", [0.0, 10.0, 1e3])
def test_uneven_bearings_from_rest_on_take_the_eigenvalues_of_each_direction(rod, ratio, damping):
    """Slow speeds too: a round rotor has constant equations in axes that stand still."""
    K = np.diag([STIFFNESS, ratio * STIFFNESS])
    result = stability(rod, [0.0, 0.1, 5.0, 60.0], supports=both(K, damping))
    assert result.axes == "inertial"
    expected = [np.roots([MASS, damping, k]) for k in np.diag(K)]
    worst = max(value.real for roots in expected for value in roots)
    assert result.growth_of("lateral") == pytest.approx([worst] * 4, rel=1e-9, abs=1e-9)
    assert np.all(result.stable)


def test_periodic_motion_has_frequencies_seen_from_outside():
    """An asymmetric shaft on uneven bearings; the two methods share nothing but the equations."""
    shaft = asymmetric_shaft()
    supports = [Support(n, np.diag([3e4, 5e4]), 40.0) for n in list(shaft.interfaces)[:1]]
    wanted = stability(shaft, [120.0], supports=supports, method="hill")
    result = stability(shaft, [120.0], supports=supports, method="floquet")
    known = np.isfinite(result.exponents[0])
    assert np.count_nonzero(known) >= 2
    for value, heard, decrement in zip(
        result.exponents[0][known], result.frequencies_inertial[0][known],
        result.log_decrement[0][known], strict=True,
    ):  # fmt: skip
        at = np.argmin(np.abs(wanted.exponents[0] - value))
        assert abs(wanted.exponents[0][at] - value) < 1e-5 * max(abs(value), 120.0)
        assert heard == pytest.approx(wanted.frequencies_inertial[0][at], rel=1e-5, abs=1e-6)
        if np.isfinite(decrement):
            assert decrement == pytest.approx(wanted.log_decrement[0][at], rel=1e-4, abs=1e-7)


def test_speeds_beyond_a_table_are_nan_and_cost_no_other(rod):
    K = np.array([STIFFNESS, 2.0 * STIFFNESS])
    supports = both(([0.0, 100.0], K), OUTER)
    with pytest.warns(UserWarning, match="no values at 150 rad/s") as heard:
        result = stability(rod, [50.0, 100.0, 150.0], supports=supports)
    assert len(heard) == 1
    assert np.isfinite(result.growth).tolist() == [True, True, False]
    assert result.stable.tolist() == [True, True, False]
    assert result.table().splitlines()[3].split()[-1] == "-"
    axes = result.plot()
    assert axes.get_xlabel() == "spin speed [rpm]"


def test_an_undamped_rotor_is_stable(rod):
    result = stability(linear_model(rod, supports=both(STIFFNESS)), [0.0, 100.0, 1e3])
    assert np.all(result.stable)
    assert np.all(result.growth <= result.bounds)


@pytest.mark.parametrize("stiffness", [1e5, 1e10, 1e13])
def test_stiff_supports_do_not_make_a_rotor_unstable(rod, stiffness):
    supports = both(np.diag([stiffness, 2.0 * stiffness]), 1e-3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.all(stability(rod, [10.0, 300.0], supports=supports, accuracy=None).stable)


def test_mathieus_equation():
    """``ẍ + (δ + ε cos t) x = 0`` is unstable about δ = 1/4 between ± ε/2, by ε at most."""
    one, none, epsilon = np.ones((1, 1)), np.zeros((1, 1)), 0.1
    given = [
        PeriodicSystem(1.0, one, {0: none}, {0: delta * one, 1: 0.5 * epsilon * one,
                                             -1: 0.5 * epsilon * one})
        for delta in (0.19, 0.25, 0.31)
    ]  # fmt: skip
    for method in ("hill", "floquet"):
        growth = motions_of(joined(given), method).values.real[:, 0]
        assert (growth > 1e-6).tolist() == [False, True, False]
        assert growth[1] == pytest.approx(0.5 * epsilon, rel=1e-2)


@pytest.mark.parametrize(
    ("delta", "epsilon", "growth"),
    [(4.0, 6.0, 0.180933), (2.25, 5.0, 0.400392), (6.25, 9.0, 0.379643)],
)
def test_growth_is_not_missed_among_many_motions(delta, epsilon, growth):
    """Mathieu's equation, integrated over a period, beside others that need no harmonics.

    Few harmonics are affordable for all. At δ = 2.25 and 4 the multipliers are negative.
    """
    k = 17
    mean = np.diag(np.r_[delta, np.linspace(3.0, 40.0, k - 1) ** 2])
    wave = np.zeros((k, k), dtype=complex)
    wave[0, 0] = 0.5 * epsilon
    damping = np.diag(np.r_[0.0, np.full(k - 1, 0.01)])
    system = PeriodicSystem(1.0, np.eye(k), {0: damping}, {0: mean, 1: wave, -1: wave})
    for method in ("auto", "floquet"):
        found = motions_of(joined([system]), method).values.real
        assert np.nanmax(found) == pytest.approx(growth, abs=2e-5)


def _with_waves(damping: float, stiffness: float) -> PeriodicSystem:
    """``x'' + d (1 + 0.9 cos t) x' + k (1 + 0.8 cos t) x = 0``, beside a slow motion."""
    D, K = np.diag([damping, 0.1]), np.diag([stiffness, 0.3])
    waves = [np.diag([share * X[0, 0], 0.0]).astype(complex) for share, X in ((0.45, D), (0.4, K))]
    terms = ({0: X, 1: wave, -1: wave} for X, wave in zip((D, K), waves, strict=True))
    return joined([PeriodicSystem(1.0, np.eye(2), *terms)])


def test_a_motion_of_many_harmonics_is_found():
    """Its exponent is −1 ± 0.4406533i by integration over a period (DOP853, rtol 1e-11)."""
    values = motions_of(_with_waves(2.0, 300.0), "hill").values[0]
    [found] = values[np.abs(values) > 1.0]
    turned = found - 1j * np.round(found.imag)
    assert complex(turned.real, abs(turned.imag)) == pytest.approx(-1.0 + 0.4406533j, abs=1e-4)


@pytest.mark.parametrize(
    ("damping", "stiffness", "lost"), [(20.0, 130.0, ()), (2.0, 3000.0, (1.0,))]
)
def test_decays_that_are_over_at_once_are_not_told_as_lost(damping, stiffness, lost):
    """Both motions need more harmonics than there are; nobody looks at the first one."""
    found = motions_of(_with_waves(damping, stiffness), "hill")
    assert np.nanmax(found.values.real) == pytest.approx(-0.05, rel=1e-9)
    assert tuple(speed for speed, _ in found.lost) == lost


def test_fast_motions_that_harmonics_lose_leave_the_others():
    """The second motion is stable, and needs more harmonics than there are."""
    wave = np.diag([0.0, 4e3]).astype(complex)
    none, K = np.zeros((2, 2)), np.diag([0.3, 1e4])
    system = joined([PeriodicSystem(1.0, np.eye(2), {0: none}, {0: K, 1: wave, -1: wave})])
    found, by_hill = (motions_of(system, way) for way in ("auto", "hill"))
    assert np.array_equal(found.values, by_hill.values, equal_nan=True)
    assert np.nanmin(np.abs(found.values)) == pytest.approx(np.sqrt(0.3), rel=1e-9)


def test_floquets_method_takes_shorter_steps_on_stiff_supports():
    supports = [Support(name, np.diag([1e10, 3e10])) for name in ("left", "right")]
    with pytest.warns(UserWarning, match="do not converge for all motions"):
        result = stability(asymmetric_shaft(), [1.0], supports=supports, method="floquet")
    assert np.all(result.stable)


def test_motions_that_are_lost_among_copies_cost_none_of_the_others():
    """The growth is Floquet's; at a thousandth of the lowest frequency some motions are lost."""
    supports = [Support(name, np.diag([1e7, 1.5e7]), damping=10.0) for name in ("left", "right")]
    with pytest.warns(UserWarning, match="do not converge for all motions"):
        found, other = (
            stability(asymmetric_shaft(), [1.0], supports=supports, method=way)
            for way in ("hill", "floquet")
        )
    assert 0 < np.count_nonzero(np.isnan(found.exponents)) < found.exponents.size
    np.testing.assert_allclose(found.growth, other.growth, rtol=1e-6)


def test_of_real_exponents_the_less_damped_half_is_shown():
    """By all eigenvalues of Hill's matrix with 24 harmonics on either side; one decay is -4899."""
    supports = [
        Support(name, np.diag([1e7, 1.5e7]), np.diag([1e4, 2e4])) for name in ("left", "right")
    ]
    found = stability(asymmetric_shaft(), [100.0, 125.0], supports=supports).exponents.real
    expected = [-1256.04, -1158.24, -802.49, -792.98], [-1255.73, -1158.24, -802.60, -792.99]
    np.testing.assert_allclose(np.sort(found)[:, :4], expected, atol=0.01)
