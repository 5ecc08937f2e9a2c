"""Overdamped, free and split modes, and signed frequencies of whirl."""

import numpy as np
import pytest
from asymmetric import asymmetric_shaft
from models import disc_rotor
from test_campbell_frames import SHAFT, point_mass, rings

from exudyn_rotor import SolidRotor, Support, campbell, critical_speed_map, critical_speeds
from exudyn_rotor.linear.modal.whirl import FORWARD
from exudyn_rotor.linear.models.basis.basis_error import judged
from exudyn_rotor.linear.periodic.eigenvalues import quadratic_modes
from exudyn_rotor.linear.periodic.floquet_modes import floquet_modes
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.reduction.craig_bampton import craig_bampton_modes


def test_overdamped_motions_stand_behind_the_others():
    """Two masses, one of them overdamped across the axis: λ = −5 ± √24 times 100."""
    rotor = SolidRotor.from_matrices(
        np.eye(6), np.zeros((6, 6)), [[0, 0, 0], [0, 0, 1.0]], "z",
        interfaces={"damped": [0], "free": [1]}, allow_parts=True,
    )  # fmt: skip
    supports = [
        Support("damped", 1e4 * np.eye(3), 1e3 * np.eye(3)),
        Support("free", 4e4 * np.eye(3)),
    ]
    result = campbell(rotor, [0.0, 50.0], supports=supports)
    np.testing.assert_allclose(result.frequencies_inertial[:, :3], 200.0, rtol=1e-9)
    np.testing.assert_array_equal(result.frequencies_inertial[:, 3:], 0.0)
    slow, fast = (100.0 * (sign * np.sqrt(24.0) - 5.0) for sign in (1, -1))
    np.testing.assert_allclose(result.growth[0, 3:], slow, rtol=1e-6)
    # across a rotor that turns, both real roots are seen with ±iΩ
    np.testing.assert_allclose(np.sort(result.growth[1, 3:]), [fast, slow, slow], rtol=1e-6)
    assert result.oscillates.tolist() == [[True] * 3 + [False] * 3] * 2
    assert [sorted(row) for row in result.whirl[:, 3:]] == [["axial"] + 2 * ["overdamped"]] * 2
    assert np.all(result.continued)
    few = campbell(rotor, [0.0, 50.0], supports=supports, modes=3)
    np.testing.assert_allclose(few.frequencies_inertial, 200.0, rtol=1e-9)


@pytest.mark.parametrize("speed", [0.0, 10.0])
def test_slow_and_fast_decays_on_strong_dampers(speed):
    """λ = −k/c and −c/m; dampers that turn, uneven by more than 2 Ω m, tie the fast one to them."""
    rotor = SolidRotor.from_matrices(
        np.eye(6), np.zeros((6, 6)), [[0, 0, 0], [0, 0, 1.0]], "z",
        interfaces={"left": [0], "right": [1]}, allow_parts=True,
    )  # fmt: skip
    supports = [Support(n, 1e5 * np.eye(3), 1e6 * np.eye(3)) for n in rotor.interfaces]
    supports += [
        Support(n, 0.0, np.diag([100.0, 0.0, 0.0]), frame="rotor") for n in rotor.interfaces
    ]
    result = campbell(rotor, [speed], supports=supports)
    assert not np.any(result.oscillates)
    slow = result.growth[0] > -1.0
    np.testing.assert_allclose(result.growth[0, slow], -0.1, rtol=2e-4)
    np.testing.assert_allclose(result.growth[0, ~slow], -1e6, rtol=2e-4)
    assert slow.sum() == (6 if speed == 0.0 else 4)
    assert set(result.whirl[0].tolist()) == {"overdamped", "axial"}
    np.testing.assert_array_equal(result.damping_ratio, 1.0)


def test_overdamped_motions_are_judged_by_their_decay():
    """The fast one is that of a damper on the mass beside it, of which a finer basis has less."""
    frequencies, growth = np.array([[0.0, 0.0, 300.0, 9e3]]), np.array([[-0.1, -4e6, -1.0, -1.0]])
    for every, expected in ((False, [True, False, True, False]), (True, [True, False, True, True])):
        modes = np.hstack([frequencies, np.arange(5.0)[None] + 1.0])
        chosen = judged(modes, np.hstack([growth, np.zeros((1, 5))]), np.array([200.0]), every)
        assert chosen[0, :4].tolist() == expected


@pytest.mark.parametrize("stiffness", [1e6, np.diag([1e6, 2e6, 0.0])], ids=["even", "uneven"])
def test_free_motions_keep_their_names(stiffness):
    """Lateral springs alone leave the spin and the axial motion free, at rest and at speed."""
    rotor = rings(SHAFT).reduce(2)
    support = Support("all", stiffness, 10.0, 1e4)
    result = campbell(rotor, [0.0, 30.0, 50.0, 90.0], supports=[support])
    for row, words in enumerate(result.whirl):
        free = words[result.frequencies_inertial[row] == 0.0]
        assert sorted(free) == ["axial", "torsional"]


def test_motions_of_a_free_rotor_have_no_damping():
    rotor = disc_rotor()
    reduced = rotor.reduce(craig_bampton_modes(rotor, 2, coupling="RBE3"))
    result = campbell(reduced, [0.0, 100.0, 600.0], accuracy=None)
    free = result.frequencies_inertial == 0.0
    assert np.count_nonzero(free, axis=1).tolist() == [6, 5, 5]
    assert not np.any(result.growth[free])
    assert not np.any(result.damping_ratio[free])
    assert not np.any(result.log_decrement[free])


def test_free_motions_of_periodic_equations_are_those_without_force():
    """Five mixed coordinates, two held, one of them by springs that turn alone; three are free."""
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(5, 5)))[0]
    held = turn[:, :2]
    even, uneven = np.diag([4.0, 0.0]), np.array([[0.3, 0.2j], [0.2j, -0.3]])
    K = {n: held @ X @ held.T for n, X in ((0, even), (2, uneven), (-2, uneven.conj()))}
    system = PeriodicSystem(0.7, {0: np.eye(5)}, {0: 0.1 * held @ held.T}, K)
    modes = floquet_modes(system)
    free = modes.values == 0.0
    assert np.count_nonzero(free) == 3
    vectors = modes.vectors[:, :, free]
    assert np.all(vectors[modes.orders != 0] == 0.0)
    np.testing.assert_allclose(held.T @ modes.central[:, free], 0.0, atol=1e-12)
    assert np.linalg.svd(modes.central[:, free])[1] == pytest.approx(np.ones(3))


def test_whirl_frequencies_have_the_sign_of_the_whirl():
    support = Support("at", np.diag([1e4, 1e4, 4e4]))
    result = campbell(point_mass(), [30.0], supports=[support])
    assert sorted(result.whirl_frequencies[0].round(6)) == [-100.0, 100.0, 200.0]


def test_a_pair_that_is_split_is_one_critical_speed():
    """Springs in the rotor that differ by 0.4 %: √(k/m) along each, once with the distance."""
    support = Support("at", np.diag([1e4, 1.004e4, 1e4]), frame="rotor")
    result = critical_speeds(point_mass(), supports=[support], nodal_diameters=[1])
    forward = np.equal(result.whirl, "forward")
    np.testing.assert_allclose(result.speeds[forward], [100.0], rtol=1e-9)
    np.testing.assert_allclose(result.splits[forward], [np.sqrt(1.004) - 1.0], rtol=1e-6)
    assert "pair, the other 2.0e-03 above" in result.table()


@pytest.mark.parametrize("ratio", [1.5, 1.01])
def test_pairs_on_anisotropic_supports_are_joined(ratio):
    """Each of the two critical speeds of an even rotor once, lower by an uneven one's split.

    On average over a turn, springs of 40 N/m along one direction of the rotor add 20 N/m; a motion
    along x, ``x cos Ωt`` or ``x sin Ωt``, sees 20 ± 10 N/m: ``√((k + 20 ± 10)/m)``, but for the
    coupling of both directions by 10 N/m, which is ``10² / (k_x − k_y)`` where these differ.
    """
    uneven = Support("at", np.diag([0.0, 40.0, 0.0]), frame="rotor")
    stiffness = np.array([1e4, ratio * 1e4])
    even = Support("at", np.diag([*stiffness, 1e4]))
    given = {"nodal_diameters": [1], "max_speed": 200.0}
    result = critical_speeds(point_mass(), supports=[uneven, even], **given)
    lower, upper = np.sqrt(stiffness + 10.0), np.sqrt(stiffness + 30.0)
    error = 1e2 / (stiffness[1] - stiffness[0]) / stiffness[0]
    np.testing.assert_allclose(result.speeds, lower, rtol=error)
    np.testing.assert_allclose(result.splits, upper / lower - 1.0, atol=2.0 * error)


def test_a_map_has_such_a_pair_once():
    """The same springs beside those of the map: `critical_speeds` for each stiffness."""
    uneven = Support("at", np.diag([0.0, 40.0, 0.0]), frame="rotor")
    given = {"supports": [uneven], "nodal_diameters": [1]}
    result = critical_speed_map(point_mass().reduce(0), "at", [1e4, 4e4], **given)
    forward = np.where(result.whirl_codes == FORWARD, result.speeds, np.nan)
    assert np.sum(result.whirl_codes == FORWARD, axis=1).tolist() == [1, 1]
    np.testing.assert_allclose(np.nanmin(forward, axis=1), [100.0, 200.0], rtol=1e-9)


@pytest.mark.parametrize("axis", ["a flat shaft", "independent motions"])
def test_other_critical_speeds_are_not_joined(axis):
    """A flat shaft's two, 10 % apart, and equal ones of two masses that move on their own."""
    if axis == "a flat shaft":
        supports = [Support(name, np.diag([3e5] * 3)) for name in ("left", "right")]
        found = critical_speeds(asymmetric_shaft(), supports=supports, nodal_diameters=[1])
    else:
        rotor = SolidRotor.from_matrices(
            np.eye(6), np.zeros((6, 6)), [[0, 0, 0], [0, 0, 1.0]], "z",
            interfaces={"a": [0], "b": [1]}, allow_parts=True,
        )  # fmt: skip
        supports = [Support(name, 1e4) for name in "ab"]
        found = critical_speeds(rotor, supports=supports, nodal_diameters=[1])
        assert sorted(found.whirl) == ["backward", "backward", "forward", "forward"]
    np.testing.assert_array_equal(found.splits, 0.0)


def test_systems_solved_at_once_have_their_own_free_motions():
    """Springs 1 and 4 on other coordinates of four unit masses: λ = i, 2i and twice 0 each time."""
    held = np.array([[0, 0, 1.0, 4.0], [1.0, 4.0, 0, 0], [1.0, 0, 4.0, 0]])
    stiffnesses = held[:, :, None] * np.eye(4)
    solved = quadratic_modes(np.eye(4), 0.0 * stiffnesses, stiffnesses)[:2]
    for springs, values, vectors in zip(held, *solved, strict=True):
        np.testing.assert_allclose(values, [0, 0, 1j, 2j], atol=1e-12)
        share = np.sum(np.abs(vectors[springs == 0.0]) ** 2, axis=0)
        np.testing.assert_allclose(share, [1, 1, 0, 0], atol=1e-12)
        assert abs(np.vdot(*vectors[:, :2].T)) < 1e-12
