"""The first bound of exponents is above what the check tells at length, and hardly larger."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from asymmetric import asymmetric_shaft
from models import disc_with_craig_bampton_modes
from test_stability import anisotropic
from transformed import transformed

from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic import first_bound as first_bound_module
from exudyn_rotor.linear.periodic.exponents import _chosen_by_hill
from exudyn_rotor.linear.periodic.first_bound import (
    _remainder,
    _share,
    first_bound,
    largest_share,
    left_to_rest,
)
from exudyn_rotor.linear.periodic.harmonics import shifted
from exudyn_rotor.linear.periodic.hill_motions import HillMotions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError
from exudyn_rotor.linear.periodic.remainder import _Remainder, _States, checked
from exudyn_rotor.linear.periodic.shared_motions import _owners, shared_motions

TOLERANCE = 1e-9


def given(system: PeriodicSystem, found: HillMotions) -> tuple[HillMotions, tuple, list]:
    """Return all motions, where pairs are, and what motions span together."""
    every = found.with_conjugates()
    paired = np.flatnonzero(found.paired)
    pairs = paired, len(found.values) + np.arange(len(paired))
    return every, pairs, shared_motions(system, every)


def both_bounds(system: PeriodicSystem, found: HillMotions, radius: float) -> tuple[float, float]:
    """Return the first bound, and the share of equal radii after one change of coordinates."""
    every, pairs, groups = given(system, found)
    radii = np.full(len(every.values), radius)
    first = first_bound(system, every, pairs, groups, radii)
    return first, _States.of(system, every, groups).remainder(radii)._smaller().share


def on_uneven_supports(speed: float) -> PeriodicSystem:
    """Return a rotor with free motions, which share their exponent."""
    return LinearRotor.of(disc_with_craig_bampton_modes(), anisotropic()).at(speed)


def two_motions(damping: float, first: float = 20.0) -> PeriodicSystem:
    """Return a system with one or two motions in pairs, and a free one without a `first` spring."""
    C, K = np.diag([0.01 * first, damping]), np.diag([first, 70.0])
    return transformed(3.0, C, K, {2: np.full((2, 2), 0.3)}, 0.3)[0]


SYSTEMS = {
    "pairs": partial(two_motions, 0.4),
    "beside real ones": partial(two_motions, 20.0),
    "free": partial(on_uneven_supports, 200.0),
    "free, the other way": partial(on_uneven_supports, -200.0),
    "free, with harmonics": partial(two_motions, 0.4, 0.0),
    "uneven rotor": lambda: LinearRotor.of(asymmetric_shaft(), anisotropic()).at(50.0),
}


# what is left of a free motion with harmonics is rounding
@pytest.mark.parametrize("name", [name for name in SYSTEMS if name != "free, with harmonics"])
def test_it_is_above_what_a_change_of_coordinates_leaves(name):
    """By sums of sizes in the place of largest sums; a little depends on weights of columns."""
    system = SYSTEMS[name]()
    found = _chosen_by_hill(system, TOLERANCE, True)
    first, share = both_bounds(system, found, 1e-6)
    assert 0.99 * share <= first <= 5.0 * share


@pytest.mark.parametrize("name", SYSTEMS)
def test_half_of_the_columns_are_those_of_all_motions(name):
    """But for factors of motions, of which ``F_ij F_ji`` is free; of wrong motions, too."""
    system = SYSTEMS[name]()
    every, (first, second), groups = given(system, _chosen_by_hill(system, TOLERANCE, True))
    every = replace(every, shapes=1j * every.shapes)
    groups = [replace(group, speeds=1.001 * group.speeds) for group in groups]
    rest = _States.of(system, every, groups).remainder(np.ones(len(every.values)))
    own = np.setdiff1d(np.arange(len(every.values)), [*first, *second])
    half = np.append(own, first)
    values, F, _ = _remainder(system, every, half, len(own), groups)
    scale = np.abs(every.values).max()
    assert np.abs(values - rest.values[np.append(half, second)]).max() <= 1e-12 * scale
    both = F[:, : len(half)], rest.F[:, half][..., half]
    product, expected = (X * X.swapaxes(1, 2) for X in both)
    assert np.abs(product - expected).max() <= 1e-3 * np.abs(expected).max()


def test_shared_motions_that_are_wrong_are_seen():
    """By 1e-3 of their displacements or of their speeds."""
    system = SYSTEMS["free, with harmonics"]()
    every, pairs, groups = given(system, _chosen_by_hill(system, TOLERANCE, True))
    radii = np.full(len(every.values), 1e-6)
    right = first_bound(system, every, pairs, groups, radii)
    for name in ("shapes", "speeds"):
        wrong = [replace(group, **{name: 1.001 * getattr(group, name)}) for group in groups]
        assert first_bound(system, every, pairs, wrong, radii) > 10.0 * right


def test_motions_that_are_none_together_are_not_judged():
    """A column of zeros is singular on every processor; two equal ones are on some."""
    system = two_motions(0.4)
    every, pairs, groups = given(system, _chosen_by_hill(system, TOLERANCE, True))
    shapes = every.shapes.copy()
    shapes[..., [pairs[0][0], pairs[1][0]]] = 0.0
    every = replace(every, shapes=shapes)
    assert first_bound(system, every, pairs, groups, np.ones(len(every.values))) == np.inf


def in_conjugate_pairs(size: float, count: int = 2, pairs: int = 2) -> tuple[np.ndarray, ...]:
    """Return λ and F of real motions and of pairs, with harmonics −1, 0 and 1 at 33 angles.

    F of ``P_R U`` is ``U⁻¹ R U`` with real R, where U combines real and imaginary parts.
    """
    rng = np.random.default_rng(5)
    angles = 2.0 * np.pi * np.arange(33) / 33
    order = count + 2 * pairs
    waves = np.array([np.ones(33), np.cos(angles), np.sin(angles)])
    R = size * np.einsum("wn,wij->nij", waves, rng.normal(size=(3, order, order)))
    one, none = np.eye(pairs), np.zeros((count, pairs))
    U = np.block([[np.eye(count), none, none], [none.T, one, one], [none.T, 1j * one, -1j * one]])
    some = -0.2 + 1j * (0.2 + np.arange(pairs) / (2.1 * pairs))
    values = np.concatenate([-1.0 - np.arange(count), some, some.conj()])
    return values, np.linalg.inv(U) @ R @ U


@pytest.mark.parametrize(("count", "pairs"), [(2, 2), (0, 3), (3, 0), (1, 1)])
@pytest.mark.parametrize("size", [1e-2, 1e-4])
def test_it_is_of_the_second_order(size, count, pairs):
    """Of a rest F with harmonics all alike, of which each has its part in all others."""
    values, F = in_conjugate_pairs(size, count, pairs)
    none, radii = np.zeros(count + pairs), np.full(len(values), 1e-3)
    rest = _Remainder(F, values, radii, 1.0, np.zeros(len(values)))
    first = _share(values, F[..., : count + pairs], none, radii, 1.0)
    left = rest._smaller().share
    moved = np.abs(np.diagonal(F.mean(axis=0))).max() / 1e-3  # in both alike
    assert left <= first
    assert first - moved <= 30.0 * (left - moved)
    assert first - moved <= 3e3 * (size / 1e-2) ** 2


def test_a_copy_of_a_shared_motion_is_brought_beside_it():
    """One of two that share zero, as its copy that is one base higher, or lower."""
    system = SYSTEMS["free, with harmonics"]()
    every, _, (group,) = given(system, _chosen_by_hill(system, TOLERANCE, True))
    one = group.columns[0]
    for steps in (1, -1):
        values, shapes = every.values.copy(), every.shapes.copy()
        values[one] += 1j * steps * system.base
        shapes[..., one] = shifted(shapes[..., one], steps)
        (found,) = shared_motions(system, replace(every, values=values, shapes=shapes))
        assert set(found.columns) == set(group.columns)


def test_an_exponent_is_that_which_is_told_best():
    """0.45 and 0.5i, of 0 and 1: the sum of distances is least the other way round."""
    exponents, values = np.array([0.45, 0.5j]), np.array([0.0, 1.0])
    assert list(_owners(exponents, values, np.array([1e-3, 1.0]))) == [0, 1]
    assert list(_owners(exponents, values, np.ones(2))) == [1, 0]


def test_what_no_change_of_coordinates_takes_away_is_left():
    """Of two exponents that are one, by ±a with a symmetric F."""
    values, F = np.full(2, -1.0 + 0j), np.zeros((3, 2, 2), dtype=complex)
    F[:, [0, 1], [1, 0]] = 0.01
    assert _share(values, F, np.zeros(2), np.ones(2), 10.0) == pytest.approx(0.01)


def test_exponents_that_are_one_are_not_parted():
    """A rest of 1e-12 over a distance of 1e-11 is rounding over rounding, where 1e-3 is allowed."""
    harmonics, radii = np.full((1, 1, 1), 1e-12), np.full((1, 1), 1e-3)
    for apart, left in ((1e-11, True), (1e-3, False)):
        assert left_to_rest(harmonics, np.full((1, 1, 1), apart), radii) == left


def test_motions_that_are_not_coupled_have_a_weight():
    """The weight of each motion divides; that of one beside a larger root is rounding."""
    coupled = [[3.2, 0.0, 0.0], [0.0, 1.5, 0.23], [0.0, 0.28, 0.51]]
    share, weights = largest_share(1e-15 * np.array(coupled), np.full(3, 3.7e-9))
    assert share == pytest.approx(3.2e-15 / 3.7e-9)
    assert weights.min() > 0.0


def test_a_change_of_coordinates_without_an_inverse_tells_nothing():
    """Where the sizes of G have a spectral radius of nearly 4, ``(I − g)⁻¹`` bounds nothing."""
    values = -1e-3 + 1j * np.arange(16.0)
    apart = np.abs(values - values[:, None])
    every = np.append(values, values.conj())
    F = np.zeros((5, 32, 16), dtype=complex)
    F[:, :16] = 0.28 * apart
    assert _share(every, F, np.zeros(16), np.ones(32), 100.0) == np.inf


@pytest.mark.parametrize("name", ["free", "free, the other way"])
@pytest.mark.parametrize("wrong", ["value", "twice"])
def test_motions_in_pairs_that_are_wrong_are_seen(name, wrong):
    """λ off by more than is told; one motion twice, and another one not at all."""
    system = SYSTEMS[name]()
    found = _chosen_by_hill(system, TOLERANCE, True)
    gone = np.zeros(len(found.values), dtype=bool)
    assert checked(system, found, gone, TOLERANCE) is found  # the first bound is enough
    values, shapes = found.values.copy(), found.shapes.copy()
    pairs = np.flatnonzero(found.paired)
    slow = pairs[np.argsort(np.abs(values[pairs]))][:2]
    if wrong == "value":
        values[slow[0]] += 100.0 * found.bounds[slow[0]] + 1e-4 * abs(system.speed)
    else:
        values[slow[0]], shapes[..., slow[0]] = values[slow[1]], shapes[..., slow[1]]
    with pytest.raises(UnconvergedError, match="may be off by"):
        checked(system, replace(found, values=values, shapes=shapes), gone, TOLERANCE)


@pytest.mark.parametrize("frozen", [0, 2])
def test_singular_states_tell_nothing_and_do_not_warn(frozen, monkeypatch):
    """Rounding decides whether a factor of dependent states has a zero."""

    def singular(*_):
        raise np.linalg.LinAlgError

    system = on_uneven_supports(300.0)
    every, pairs, groups = given(system, _chosen_by_hill(system, TOLERANCE, True))
    F = np.full((5, 2 + frozen, 2 + frozen), np.inf, dtype=complex)
    none = np.zeros(2 + frozen, dtype=complex)
    assert _Remainder(F, none, np.ones(2), 10.0, none[:2]).smallest().share == np.inf
    monkeypatch.setattr(np.linalg, "solve", singular)
    monkeypatch.setattr(first_bound_module, "accelerations", lambda system, M, forces: forces)
    radii = np.ones(len(every.values))
    assert first_bound(system, every, pairs, groups, radii) == np.inf
