"""Growth that is rounding next to stiff supports, and growth that is not."""

import netgen.occ as occ
import ngsolve as ngs
import numpy as np
import pytest
from exponent_methods import constant_exponents
from hypothesis import given, settings
from hypothesis import strategies as st
from models import STEEL
from point_rotors import ring_rotor

from exudyn_rotor import SolidRotor, Support, craig_bampton_modes, stability
from exudyn_rotor.linear.periodic import eigenvalues
from exudyn_rotor.linear.periodic.eigenvalues import quadratic_modes
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.linear.stability.growth import growth_of


def conservative(seed: int, stiffness: float) -> PeriodicSystem:
    """Return a gyroscopic system of ten coordinates, one of them on a stiff spring as well."""
    rng = np.random.default_rng(seed)
    root, spring = rng.normal(size=(10, 10)), rng.normal(size=10)
    gyroscopic = rng.normal(size=(10, 10))
    K = 1e4 * (root @ root.T + np.eye(10)) + stiffness * np.outer(spring, spring)
    return PeriodicSystem(
        100.0, {0: np.eye(10)}, {0: 20.0 * (gyroscopic - gyroscopic.T)}, {0: 0.5 * (K + K.T)}
    )


def exact(system: PeriodicSystem, value: complex) -> complex:
    """Return the eigenvalue next to one that was computed, by Newton's method in long double.

    The residual is that of ``(λ²M + λD + K) x = 0`` and ``cᴴx = 1`` to 64 bits.
    """
    M, D, K = (X.astype(np.clongdouble) for X in system.matrices(0.0))
    dynamic = value**2 * M + value * D + K
    x = np.linalg.svd(dynamic.astype(complex))[2][-1].conj().astype(np.clongdouble)
    c, value = x.conj() / np.sum(np.abs(x) ** 2), np.clongdouble(value)
    size = np.sqrt(np.abs(np.diag(K + M)))
    for _ in range(4):
        dynamic, slope = value**2 * M + value * D + K, (2 * value * M + D) @ x
        bordered = np.block([[dynamic, slope[:, None]], [c[None], np.zeros((1, 1))]])
        left = np.append(dynamic @ x, c @ x - 1)
        scale = np.append(1.0 / size, 1.0)
        step = np.linalg.solve(
            (scale[:, None] * bordered * scale).astype(complex), (scale * left).astype(complex)
        )
        x, value = x - (scale * step)[:-1], value - (scale * step)[-1]
    return complex(value)


KINDS = ("damped", "internal damping", "stiff damper", "free", "repeated", "softened by the spin")


def system_of(kind: str, seed: int, stiffness: float) -> PeriodicSystem:
    """Return a system of eight coordinates with a stiff spring."""
    rng = np.random.default_rng(seed)
    size = 4 if kind == "repeated" else 8
    root, gyroscopic, inner = rng.normal(size=(3, size, size))
    spring = rng.normal(size=(size, 2))
    K = 1e4 * (root @ root.T + 0.1 * np.eye(size))
    if kind == "free":
        K -= K @ np.outer(root[0], root[0]) @ K / (root[0] @ K @ root[0])
        spring -= np.outer(root[0], root[0] @ spring) / (root[0] @ root[0])
    M, D = np.eye(size) + 0.1 * inner @ inner.T, 20.0 * (gyroscopic - gyroscopic.T)
    if kind == "softened by the spin":
        K -= 2e4 * np.diag([1.0] * 4 + [0.0] * 4)
    else:
        D += 0.3 * inner @ inner.T
    if kind == "stiff damper":
        D += 1e-4 * stiffness * np.outer(spring[:, 0], spring[:, 0])
    K += stiffness * spring @ spring.T
    if kind == "repeated":
        M, D, K = (np.kron(np.eye(2), X) for X in (M, 0.5 * (D + D.T), K))
        D += 30.0 * np.kron([[0.0, 1.0], [-1.0, 0.0]], np.eye(size))
    K = 0.5 * (K + K.T)
    if kind == "internal damping":
        K = K + 100.0 * (gyroscopic - gyroscopic.T)
    return PeriodicSystem(100.0, {0: M}, {0: D}, {0: K})


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1), st.floats(6.0, 14.0), st.sampled_from(KINDS))
def test_bounds_hold_for_all_exponents(seed, power, kind):
    """Also where the stiffness is another one by its rounding, which is symmetric."""
    system = system_of(kind, seed, 10.0**power)
    modes = motions(system, shapes=False)
    rng = np.random.default_rng([seed, 1])
    R = 1.0 + np.finfo(float).eps * rng.uniform(-1.0, 1.0, system.K[0].shape)
    K, found = system.K[0], modes.values[modes.values.imag >= 0.0]
    bounds = modes.bounds[modes.values.imag >= 0.0]
    symmetric, skew = 0.5 * (K + K.T) * R, 0.5 * (K - K.T)
    K = 0.5 * (symmetric + symmetric.T) + skew
    rounded = PeriodicSystem(100.0, system.M, system.D, {0: K})
    for other in (system, rounded):
        reference = np.array([exact(other, value) for value in found])
        near = np.abs(reference - found) < 1e-3 * np.abs(found) + 1.0
        assert np.mean(near) > 0.8  # Newton's method may go to another
        np.testing.assert_array_less(np.abs((reference - found).real)[near], bounds[near])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("stiffness", [1e4, 1e14, 1e18, 1e22])
def test_rounding_next_to_stiff_springs_is_no_growth(seed, stiffness):
    """With K positive definite and without damping a gyroscopic system does not grow (Kelvin).

    At 1e22 the rounding of the stiff spring is larger than all others.
    """
    system = conservative(seed, stiffness)
    modes = motions(system)
    assert growth_of(modes, system).excess <= 0.0


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("cause", ["damping", "circulatory"])
def test_little_growth_by_forces_beside_rigid_springs_is_told(seed, cause):
    """Damping −d/2, or circulatory forces of 1e-5 of the stiffness, at ε·ω_max = 2e-9."""
    system = conservative(seed, 1e14)
    grown = []
    for share in (1.0, 1e4):
        D, K = system.D[0].copy(), system.K[0].copy()
        if cause == "damping":
            D -= 2e-5 * share * np.eye(10)
        else:
            K += np.sqrt(share) * (D / np.abs(D).max())
        forced = PeriodicSystem(100.0, system.M, {0: D}, {0: K})
        growth = growth_of(motions(forced), forced)
        assert growth.excess > 0.0
        grown.append(growth.values.real.max())
    if cause == "damping":
        assert grown[1] / grown[0] == pytest.approx(1e4, rel=0.01)


def test_bar_on_rigid_bearings_is_unstable_between_its_critical_speeds_only():
    """The range of a flat bar does not depend on bearings of 1e12 or 1e15 N/m, 1e5 times its own.

    The speeds are 30 rad/s apart; the bearings move the limits by less than 1e-4. A narrow range of
    two modes together, 0.5 rad/s wide at 1750 rad/s, is between two of them.
    """
    bar = occ.Box((-0.03, -0.02, 0.0), (0.03, 0.02, 1.0))
    bar.faces.Min(occ.Z).name, bar.faces.Max(occ.Z).name = "left", "right"
    mesh = ngs.Mesh(occ.OCCGeometry(bar).GenerateMesh(maxh=0.06))
    rotor = SolidRotor.from_ngsolve(mesh, STEEL, "z").center_interfaces()
    reduced = rotor.reduce(craig_bampton_modes(rotor, 8, coupling="RBE3"))
    torsion = Support("left", tilt_stiffness=np.diag([0.0, 0.0, 1e4]), frame="rotor")
    speeds = np.linspace(115.0, 2005.0, 64)
    verdicts = []
    for stiffness in (1e12, 1e15):
        bearings = [Support(name, stiffness * np.eye(3)) for name in ("left", "right")]
        verdicts.append(stability(reduced, speeds, supports=[*bearings, torsion]).stable)
    np.testing.assert_array_equal(*verdicts)
    assert 5 < np.sum(~verdicts[0]) < 12
    assert np.sum(np.diff(verdicts[0].astype(int)) != 0) == 2


def test_soft_directions_are_exact_beside_stiff_ones():
    """Six coordinates, every second one 1e8 times as stiff: the soft half is a system by itself."""
    soft = np.array([[3.0, 1.0, 0.5], [1.0, 2.0, 0.7], [0.5, 0.7, 4.0]])
    both = np.kron(soft, np.diag([1.0, 1e8]))
    parts = [
        PeriodicSystem(0.0, *({0: X} for X in (np.eye(len(K)), 0.0 * K, K))) for K in (soft, both)
    ]
    alone, beside = (np.sort(np.abs(constant_exponents(part))) for part in parts)
    np.testing.assert_allclose(beside[:6], alone, rtol=1e-14)


@pytest.mark.parametrize("damping", [[10.0, 10.0, 10.0], [1e3, 1e3, 0.0], [10.0, 1e3, 0.0]])
@pytest.mark.parametrize("masses", [[1e-2, 1e-9], [1e-4, 1e-4], [1e-3, 1e-2]])
def test_uneven_rotor_held_by_dampers_alone_does_not_grow(damping, masses):
    """A free place and tilt in space are neutral, on dampers as without; excess masses [kg]."""
    rotor = ring_rotor(0.1, 0.15, 20.0)
    for node, mass in zip((5, 2), masses, strict=True):
        rotor = rotor.add_point_mass(rotor.nodes[node], mass)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)
    dampers = [Support(name, 0.0, np.diag(damping)) for name in ("left", "right")]
    found = stability(rotor, [30.0, 300.0], supports=dampers, stiffening="tilt")
    assert np.all(found.stable)
    assert np.all(found.growth < 1e-3)
    # theirs are rounding, not its root, which a motion that meets another one has: √ε Ω
    moving = np.abs(found.exponents.real) > 0.1
    root = np.sqrt(np.finfo(float).eps) * found.speeds[:, None]
    assert np.all((found.bounds < 0.1 * root)[moving])
    pushed = [Support(name, np.diag([-5.0, -5.0, 0.0])) for name in ("left", "right")]
    pushed = stability(rotor, [30.0, 300.0], supports=[*dampers, *pushed], stiffening="tilt")
    assert not np.any(pushed.stable)  # springs that push away, 5 N/m beside 1e3 N s/m


@given(st.integers(0, 10**6), st.floats(-1.0, 5.0))
@settings(max_examples=60, deadline=None, derandomize=True)
def test_free_motions_turn_with_the_axes(seed, exponent):
    """Two free translations seen from axes of Ω: iΩ twice, with one vector, beside stiff springs.

    Rounding splits them by the root of ‖A‖‖E‖, which is no reason to take them for zero.
    """
    rng, speed = np.random.default_rng(seed), 10.0**exponent
    size = int(rng.integers(2, 9))
    turn = np.linalg.qr(rng.standard_normal((size, size)))[0] if seed % 2 else np.eye(size)
    D, K = np.zeros((size, size)), np.diag(10.0 ** rng.uniform(4, 12, size))
    D[:2, :2] = 2.0 * speed * np.array([[0, -1], [1, 0]])
    K[:2, :2] = -(speed**2) * np.eye(2)
    D, K = turn @ D @ turn.T, turn @ K @ turn.T
    system = np.eye(size), 0.5 * (D - D.T)[None], 0.5 * (K + K.T)[None]
    values = quadratic_modes(*system)[0][0]
    # 16 ε for the split of what is 1e6 rad/s at most
    split = np.sqrt(16.0 * np.finfo(float).eps) * max(1e6, speed)
    slow = 3.0 * split > speed  # may be zero as far as rounding tells
    assert slow or np.count_nonzero(np.abs(np.abs(values) - speed) <= split) >= 2


def test_inverse_iteration_at_a_root_keeps_the_vector():
    """Where the shift that keeps off the root meets another one, to the last bit."""
    value = 3.0
    shifted = value * (1.0 + eigenvalues._OFF_ROOT)
    vectors = np.array([[0.6], [0.8]])
    K = -(np.array([shifted**2, shifted, 1.0]) @ [1.0, 0.0, 0.0]) * np.eye(2)
    found = eigenvalues.inverse_iterated(np.array([value]), vectors, np.eye(2), np.zeros((2, 2)), K)
    np.testing.assert_array_equal(found, vectors)


@settings(max_examples=30, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1), st.floats(6.0, 12.0), st.sampled_from(KINDS), st.booleans())
def test_bounds_of_inexact_entries_hold_beside_fast_states(seed, power, kind, by_rows):
    """Each entry errs by its share, or by that of its row; a fast controller feels the motion."""
    rng, share, size = np.random.default_rng([seed, 2]), 1e-10, 8
    given_one = system_of(kind, seed, 1e4)
    M, D, K = (np.pad(X, (0, 2)) for X in given_one.matrices(0.0))
    M[size:, size:], D[size:, size:] = np.eye(2), 10.0 ** (0.5 * power) * np.eye(2)
    K[size:, size:], K[size, 0], K[0, size] = 10.0**power * np.eye(2), -(10.0**power), 1e4
    system = PeriodicSystem(100.0, {0: M}, {0: D}, {0: K}, rounding=share)
    modes = motions(system, shapes=False)
    unit = np.sqrt(np.diag(M))
    for _ in range(5):
        changed = []
        for X in (D, K):
            rows = np.linalg.norm(X / unit / unit[:, None], axis=1)[:, None] * unit * unit[:, None]
            error = np.where(X == 0.0, 0.0, rows) if by_rows else np.abs(X)
            changed.append({0: X + share * error * rng.uniform(-1.0, 1.0, X.shape)})
        other = motions(PeriodicSystem(100.0, {0: M}, *changed), shapes=False).values
        apart = np.abs(modes.values[:, None] - other)
        moved = apart.min(axis=1)
        alone = np.sort(np.abs(modes.values[:, None] - modes.values), axis=1)[:, 1] > 100.0 * moved
        assert np.mean(alone) > 0.5
        np.testing.assert_array_less(moved[alone], modes.bounds[alone] + 1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_bounds_of_inexact_entries_are_not_of_what_stands_beside(seed):
    """A controller without a link, of 1e12 1/s², brings the rounding of the eigensolver alone."""
    M, D, K = system_of("damped", seed, 1e4).matrices(0.0)
    terms = (np.pad(X, (0, 1)) for X in (M, D, K))
    fast = [np.diag([0.0] * 8 + [x]) for x in (1.0, 1e6, 1e12)]
    both = [{0: X + Y} for X, Y in zip(terms, fast, strict=True)]
    alone, beside = (
        motions(PeriodicSystem(100.0, *given_terms, rounding=1e-11), shapes=False)
        for given_terms in (({0: M}, {0: D}, {0: K}), both)
    )
    slow = np.abs(beside.values) < 1e5
    assert np.count_nonzero(slow) == len(alone.values)
    solver = 100.0 * np.finfo(float).eps * 1e12 / np.abs(beside.values).min()
    assert beside.bounds[slow].max() < 1.01 * alone.bounds.max() + solver
