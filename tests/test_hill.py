"""Hill's method: motions that follow from a small truncation into larger ones."""

from dataclasses import replace

import numpy as np
import pytest
from asymmetric import asymmetric_shaft
from exponent_methods import floquet_exponents
from models import disc_with_craig_bampton_modes
from scipy.optimize import linear_sum_assignment
from test_stability import anisotropic, mathieu, random_system
from transformed import transformed

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic import fundamental, hill, truncation
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.floquet_modes import floquet_modes
from exudyn_rotor.linear.periodic.harmonics import hill_matrices
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError, fold

WEAK = 0.2


def weakly_periodic(seed: int) -> PeriodicSystem:
    """Return a random system whose exponents follow from the smallest truncation."""
    given = random_system(seed)
    terms = ({n: X if n == 0 else WEAK * X for n, X in Y.items()} for Y in (given.D, given.K))
    return PeriodicSystem(7.0, {0: given.M[0]}, *terms)


@pytest.fixture
def sizes_solved(monkeypatch):
    """Return a list that records how many harmonics each whole solution has."""
    solve, sizes = truncation._solved, []

    def recorded(system, orders):
        sizes.append(len(orders))
        return solve(system, orders)

    monkeypatch.setattr(truncation, "_solved", recorded)
    return sizes


def turning_rotor(seed: int) -> PeriodicSystem:
    """Return random oscillators with gyroscopic terms and springs with harmonics ±2."""
    rng = np.random.default_rng(seed)
    skew = rng.normal(size=(4, 4))
    term = rng.normal(size=(4, 4)) + 1j * rng.normal(size=(4, 4))
    stiffness = {
        0: np.diag(rng.uniform(5.0, 60.0, 4)),
        2: term + term.T,
        -2: (term + term.T).conj(),
    }
    damping = {0: 0.1 * np.eye(4) + skew - skew.T}
    return PeriodicSystem((-1.0) ** seed * 8.0, {0: np.eye(4)}, damping, stiffness)


@pytest.mark.parametrize("seed", range(4))
def test_motions_follow_from_two_harmonics_halfway(seed, sizes_solved):
    """At both senses of the spin; as many as Floquet's exponents, and the same."""
    system = turning_rotor(seed)
    found, exact = motions(system, "hill", 1e-10), floquet_exponents(system, 1e-13)
    assert sizes_solved == [2]
    apart = np.abs(fold(found.values[:, None] - exact, system.base))
    assert len(found.values) == len(exact)
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-9 * abs(system.speed)
    modes = floquet_modes(system, tolerance=1e-10)
    assert sizes_solved == [2, 2]
    assert np.all(np.diff(modes.values.imag, prepend=0.0) >= 0.0)
    central = np.linalg.norm(modes.central, axis=0)
    assert np.all(central >= np.linalg.norm(modes.vectors, axis=1).max(axis=0) - 1e-6)


def test_harmonics_that_two_halfway_leave_out_are_on_their_side(sizes_solved):
    """Those beside the largest harmonic are 2 % of it, and err by as small a share of that.

    Half of the next ones, ±4, are not looked for where none is followed.
    """
    given = turning_rotor(0)
    stiffness = {n: X if n == 0 else WEAK * X for n, X in given.K.items()}
    system = replace(given, K=stiffness)
    found, exact = (motions(system, "hill", tolerance) for tolerance in (1e-1, 1e-11))
    assert sizes_solved == [2, 2]
    assert found.orders.tolist() == [-4, -2, 0, 2, 4]
    kept = exact.vectors[np.isin(exact.orders, found.orders)]
    errors, sizes = np.zeros((2, 5, len(found.values)))
    for j, value in enumerate(found.values):
        other = kept[:, :, np.argmin(np.abs(exact.values - value))]
        one = found.vectors[:, :, j]
        one = one * np.vdot(one, other) / np.linalg.norm(one) ** 2
        errors[:, j] = np.linalg.norm(one - other, axis=1)
        sizes[:, j] = np.linalg.norm(other, axis=1)
    assert np.all(errors.max(axis=1)[1:4] < 0.02 * sizes.max(axis=1)[1:4])


@pytest.mark.parametrize(("share", "first"), [(1.0, 2), (1e-11, 3)])
def test_harmonics_that_hardly_couple_are_not_told_apart_halfway(share, first, sizes_solved):
    """Copies mix by ε over the coupling, which every processor rounds in its own way."""
    given = turning_rotor(0)
    stiffness = {n: X if n == 0 else share * X for n, X in given.K.items()}
    motions(replace(given, K=stiffness), "hill", 1e-10)
    assert sizes_solved[0] == first


@pytest.mark.parametrize("seed", range(4))
def test_motions_follow_from_the_smallest_truncation(seed, sizes_solved):
    """They meet Floquet's exponents, and the equations of all of their harmonics."""
    system = weakly_periodic(seed)
    found = motions(system, "hill", 1e-11)
    assert sizes_solved == [3]
    assert len(found.orders) > 3
    exact = floquet_exponents(system, 1e-13)
    apart = np.abs(fold(found.values[:, None] - exact, system.base))
    assert len(found.values) == 2 * system.size
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-9
    parts = hill_matrices(system, found.orders)
    X = found.vectors.reshape(-1, len(found.values))
    each = [found.values**power * (Y @ X) for power, Y in zip((2, 1, 0), parts, strict=True)]
    residual = np.linalg.norm(sum(each), axis=0) / sum(np.linalg.norm(Y, axis=0) for Y in each)
    # λ errs by the square of what is missing in a motion
    assert residual.max() < 10.0 * np.sqrt(1e-11)


def test_motions_that_need_no_more_harmonics_have_the_first_left_out():
    system = weakly_periodic(0)
    found, exact = (motions(system, "hill", tolerance) for tolerance in (1e-1, 1e-11))
    assert found.orders.tolist() == system.harmonics(2).tolist()
    outer = np.linalg.norm(found.vectors[[0, -1]], axis=1)
    kept = np.isin(exact.orders, found.orders[[0, -1]])
    expected = np.linalg.norm(exact.vectors[kept], axis=1)
    assert np.abs(outer - expected).max() < 0.1 * expected.max()


def test_two_steps_of_harmonics_are_taken_of_any_number_of_coordinates(monkeypatch):
    monkeypatch.setattr(hill, "MOST_UNKNOWNS", 1)
    system = weakly_periodic(0)
    assert motions(system, "hill", 1e-3).orders.tolist() == system.harmonics(2).tolist()
    with pytest.raises(UnconvergedError, match="harmonics up to 2"):
        motions(system, "hill", 1e-11)


def test_motions_follow_into_truncations_too_large_to_be_solved(monkeypatch):
    system = weakly_periodic(0)
    exact = motions(system, "hill", 1e-11)
    unknowns = 2 * len(exact.orders) * system.size
    monkeypatch.setattr(hill, "_MORE_OF_FEW", 1.0)
    monkeypatch.setattr(hill, "MOST_UNKNOWNS", int(0.6 * unknowns))
    assert np.array_equal(motions(system, "hill", 1e-11).values, exact.values)
    monkeypatch.setattr(hill, "MOST_UNKNOWNS", int(0.2 * unknowns))
    with pytest.raises(UnconvergedError, match="harmonics up to"):
        motions(system, "hill", 1e-11)


def test_strong_coupling_is_solved_as_a_whole(sizes_solved):
    strong = mathieu(2.0, 30.0)
    found = motions(strong, "hill", 1e-9).values
    assert max(sizes_solved) > 3
    exact = floquet_exponents(strong, 1e-13)
    assert np.abs(fold(found[:, None] - exact, strong.base)).min(axis=0).max() < 1e-7


def test_a_copy_is_not_another_motion():
    system = weakly_periodic(0)
    orders = system.harmonics(3)
    rng = np.random.default_rng(1)
    shapes = rng.normal(size=(7, 4, 2)) + 1j * rng.normal(size=(7, 4, 2))
    shapes[[0, 1, 5, 6]] = 0.0
    values = np.array([-0.1 + 2.0j, -0.1 + 2.0j + 1j * system.base])
    unused, unpaired = np.ones(2), np.zeros(2, dtype=bool)
    found = hill.HillMotions(values, shapes, orders, unused, 0.0, unused, unused, {}, unpaired)
    both = np.arange(2)
    assert hill.differ(found, both, system.base)
    for steps in (1, -1):  # exp((λ + ipΩ)t) X_m exp(imΩt) has the harmonics Y_m = X_{m + p}
        shapes[:, :, 1] = np.roll(shapes[:, :, 0], -steps, axis=0)
        assert hill.differ(found, both, system.base) == (steps < 0)
    shapes[:, :, 1] = shapes[:, :, 0]
    assert hill.differ(found, both, system.base)
    assert not hill.differ(replace(found, values=values[[0, 0]]), both, system.base)


@pytest.mark.parametrize("speed", [20.0, 50.0])
def test_a_rotor_that_spins_the_other_way_has_the_same_exponents(speed):
    """Without internal damping the equations at −Ω are the transposed ones at Ω."""
    model = LinearRotor.of(asymmetric_shaft(), anisotropic())
    values = [floquet_modes(model.at(each), tolerance=1e-9).values for each in (speed, -speed)]
    one, other = (np.concatenate([each, each.conj()]) for each in values)
    apart = np.abs(fold(one[:, None] - other, 2.0 * speed))
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-8


@pytest.mark.parametrize(("stiffness", "damping"), [(1e7, 1e5), (1e8, 1e6)])
def test_stiff_dampers_do_not_hide_slow_motions(stiffness, damping):
    """Motions that are gone within a turn need many harmonics, and are not waited for."""
    reduced = disc_with_craig_bampton_modes()
    uneven = stiffness * np.array([[1.0, 0.3], [-0.2, 2.0]]), damping * np.diag([1.0, 3.0])
    model = LinearRotor.of(reduced, [Support(name, *uneven) for name in ("left", "right")])
    system = model.at(100.0)
    found, modes = motions(system, "hill"), floquet_modes(system, tolerance=1e-11)
    assert found.orders[-1] <= 18
    assert len(found.values) == 2 * system.size
    slow = modes.values[np.abs(modes.values.real) < system.speed]
    apart = np.abs(fold(found.values[:, None] - slow, system.base))
    assert apart.min(axis=0).max() < 1e-8 * system.speed


def test_modes_gone_within_a_turn_are_not_waited_for():
    """Dampers of an uneven shaft at low speed: 56 harmonics for a motion that decays with 460 Ω."""
    uneven = 4e6 * np.array([[1.0, 0.3], [-0.2, 1.5]]), 1257.4334 * np.diag([1.0, 4.0])
    supports = [Support(name, *uneven) for name in ("left", "right")]
    system = LinearRotor.of(asymmetric_shaft(), supports).at(10.0)
    modes, exact = floquet_modes(system), floquet_exponents(system, 1e-10)
    assert modes.orders[-1] <= 16
    slow = modes.values[np.abs(modes.values.real) < 10.0 * system.speed]
    assert len(slow) == 4
    apart = np.abs(fold(slow[:, None] - exact, system.base))
    assert apart.min(axis=1).max() < 1e-6 * system.speed


@pytest.mark.parametrize(
    ("held", "k", "drag"),
    [
        *((3.0, 0.0, 0.0), (3.0, 0.0, 1e-3), (3.0, 0.0, 5.0), (3.0, 40.0, 0.0)),
        *((1e-5, 1e-6, 0.0), (2e-5, 3e-6, 0.0), (4e-6, 9e-6, 0.0)),
    ],
)
def test_a_mass_that_one_direction_alone_holds(held, k, drag):
    """Seen from axes that turn: its exponents are those of two oscillators at rest."""
    speed = 7.0
    J = np.array([[0.0, -1.0], [1.0, 0.0]])
    support = Support("place", np.diag([held, k]), np.diag([0.0, drag]))
    damping, stiffness = ({n: X[:2, :2] for n, X in Y.items()} for Y in support.terms(speed))
    damping[0] = damping.get(0, 0.0) + 2.0 * speed * J
    stiffness[0] = stiffness[0] - speed**2 * np.eye(2)
    system = PeriodicSystem(speed, {0: np.eye(2)}, damping, stiffness)
    exact = np.concatenate([np.roots([1.0, 0.0, held]), np.roots([1.0, drag, k])]) + 1j * speed
    every = motions(system, "hill").values
    apart = np.abs(fold(every[:, None] - exact, system.base))
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-6
    found = floquet_modes(system)
    values = np.concatenate([found.values, found.values.conj()])
    if k == 0.0:  # the more damped one of two real exponents is not among the modes
        exact = exact[np.argsort(exact.real)[drag > 0.0 :]]
    apart = np.abs(fold(values[:, None] - exact, system.base))
    assert len(found.values) == 2
    assert apart.min(axis=0).max() < 1e-6  # of the double root 0, the root of rounding


def test_a_multiplier_that_rounding_makes_zero_is_known_from_above(monkeypatch):
    known = np.diag([1e30, 0.0]), 8, 1e21
    monkeypatch.setattr(fundamental, "monodromy", lambda *_: known)
    values, _, bounds = fundamental.floquet_motions(mathieu(2.0, 1.0))
    assert values[0].real == pytest.approx(30.0 * np.log(10.0) / np.pi)
    assert np.all(np.isfinite(values))
    # the matrix errs by 1e21, and so may the multiplier
    assert (values + bounds)[1].real >= 21.0 * np.log(10.0) / np.pi
    assert np.isfinite(bounds[1])


@pytest.mark.parametrize(
    ("size", "order", "larger"), [(126, 2, 3), (126, 3, 4), (186, 2, 3), (30, 8, 12)]
)
def test_models_with_many_modes_have_four_steps_of_harmonics(size, order, larger):
    """Two steps refused a rotor and a foundation of 60 modes each at 20 Hz."""
    system = PeriodicSystem(1.0, {0: np.eye(size)}, {0: np.eye(size)}, {0: np.eye(size)})
    uneven = replace(system, K=system.K | {n: 0.1 * np.eye(size) for n in (-1, 1)})
    assert hill._next(uneven, order, 1.0, 1e-8) == larger
    followed = hill._next(uneven, 4, 1.0, 1e-8, 2)
    assert followed == 6
    with pytest.raises(UnconvergedError, match="harmonics up to"):
        hill._next(uneven, 100, 1.0, 1e-8, 2)


def test_motions_that_lack_nothing_but_cannot_be_followed_take_a_larger_truncation(monkeypatch):
    """Where a truncation takes long, too: there are no slow motions to look at by themselves."""
    system = weakly_periodic(0)
    expected = fold(motions(system, "hill", 1e-10).values, system.base)
    follow, tried = hill._followed, []

    def late(*given):
        tried.append(given)
        return None if len(tried) == 1 else follow(*given)

    monkeypatch.setattr(hill, "_LONG", 0)
    monkeypatch.setattr(hill, "_followed", late)
    found = fold(motions(system, "hill", 1e-10).values, system.base)
    assert len(tried) > 1
    apart = np.abs(fold(found[:, None] - expected, system.base)).min(axis=1)
    assert np.all(apart < 1e-9 * system.speed)


@pytest.mark.parametrize(
    ("seed", "eccentric", "more"),
    [(0, True, 0), *((seed, False, more) for seed in range(3) for more in (0, 24))],
)
def test_motions_by_slow_ones_are_those_of_large_truncations(seed, eccentric, more, monkeypatch):
    """A few coupled soft coordinates beside stiff ones, at a speed that splits their frequencies.

    Also where the others have `more` harmonics than these. The reference is Hill's method without
    this way, to the tolerances of both.
    """
    rng, size, soft = np.random.default_rng(seed), 14, 3
    rates = np.concatenate([rng.uniform(200.0, 400.0, soft), rng.uniform(4e3, 2e4, size - soft)])
    links = 1e3 * np.outer(*(2 * [np.where(np.arange(size) < soft, 8.0, 1.0)]))
    turning = links * (rng.normal(size=(size, size)) + 1j * rng.normal(size=(size, size)))
    K = {0: np.diag(rates**2), 2: 0.25 * (turning + turning.T)}
    if eccentric:
        K[1] = 0.1 * (turning + turning.T)
    K |= {-n: K[n].conj() for n in K if n}
    D = {0: 0.02 * np.diag(rates)}
    system = PeriodicSystem(60.0, {0: np.eye(size)}, D, K)
    expected = fold(motions(system, "hill", 1e-9).values, abs(system.base))
    follow = hill._followed

    def followed(given, found, tolerance):
        found, orders = follow(given, found, tolerance), given.harmonics(more)
        if found is None or given.size < size or len(orders) <= len(found.orders):
            return found
        return replace(found, shapes=hill._widened(found, orders), orders=orders)

    monkeypatch.setattr(hill, "_followed", followed)
    monkeypatch.setattr(hill, "_LONG", 0)
    used, original = [], hill._by_slow_motions
    monkeypatch.setattr(hill, "_by_slow_motions", lambda *a: used.append(original(*a)) or used[-1])
    found = fold(motions(system, "hill", 1e-9).values, abs(system.base))
    assert any(each is not None for each in used)
    apart = np.abs(fold(found[:, None] - expected, abs(system.base)))
    rows, columns = linear_sum_assignment(apart)
    assert np.all(apart[rows, columns] < 1e-8 * np.maximum(-expected[columns].real, system.speed))


def test_motions_that_became_one_are_sought_in_a_larger_truncation(monkeypatch):
    """Of those near their exponents none is sought by slow ones, as of a shaft with keyways.

    ``ÿ + 0.2ẏ + k y = 0`` in axes that turn by 2θ against those of x.
    """
    k, damping = np.diag([20.0, 70.0]), 0.2 * np.eye(2)
    system, exact = transformed(3.0, damping, k, {2: np.full((2, 2), 0.1)}, turns=2)
    lost, original = [None] * 2, hill._followed
    monkeypatch.setattr(hill, "_LONG", 0)
    monkeypatch.setattr(hill, "_followed", lambda *a: lost.pop() if lost else original(*a))
    found = motions(system, "hill", 1e-9)
    assert not lost
    apart = np.abs(fold(found.values[:, None] - exact, abs(system.base)))
    assert np.all(apart.min(axis=1) < 1e-7)
