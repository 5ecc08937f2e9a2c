"""Motions beside a direction that nothing resists, where they are slow in the rotor frame."""

import numpy as np
import pytest
from exponent_methods import constant_exponents
from point_rotors import SKEW_AXIS, ring_rotor

from exudyn_rotor import (
    SolidRotor,
    Support,
    campbell,
    linear_model,
    stability,
    stability_threshold,
)
from exudyn_rotor.linear.modal.whirl import WHIRLS
from exudyn_rotor.linear.periodic import floquet_modes as floquet
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.free_directions import FreeDirections, parted
from exudyn_rotor.linear.periodic.periodic_system import ConstantSystems, PeriodicSystem

MASS, ENDS = 2.0, ("left", "right")
AXES = ("z", "x", SKEW_AXIS)
# relative distance from the critical speed, down to where rounding alone is left
NEAR = (0.0, 1e-14, 1e-12, -1e-10, 1e-9, 1e-8, -1e-7, 1e-6)


def rod(axis: str | np.ndarray, offset: float = 0.0) -> SolidRotor:
    """Return two masses on a rod along the axis; its frequency is 10 krad/s."""
    e = np.eye(3)["xyz".index(axis)] if isinstance(axis, str) else axis
    across = np.linalg.svd(e[None])[2][1]
    nodes = [offset * across - 0.1 * e, offset * across + 0.1 * e]
    stiffness = 0.5e8 * MASS * np.kron([[1, -1], [-1, 1]], np.outer(e, e))
    rotor = SolidRotor.from_matrices(MASS * np.eye(6), stiffness, nodes, axis)
    return rotor.with_interface("left", [0]).with_interface("right", [1])


@pytest.mark.parametrize("axis", AXES, ids=str)
@pytest.mark.parametrize("spring", [1e4, 2e4, 1.23e4])
def test_whirl_at_the_critical_speed_keeps_its_name(axis, spring):
    """Each mass moves on its own: lateral frequencies are √(k/m), whatever the speed."""
    rotor, supports = rod(axis), [Support(end, spring) for end in ENDS]
    critical = np.sqrt(spring / MASS)
    for distance in NEAR:
        speed = critical * (1.0 + distance)
        diagram = campbell(rotor, [0.5 * critical, speed], supports=supports)
        names = diagram.whirl[1]
        assert sorted(names) == ["axial"] * 2 + ["backward"] * 2 + ["forward"] * 2
        lateral = diagram.frequencies_inertial[1, np.isin(names, ["forward", "backward"])]
        np.testing.assert_allclose(lateral, critical, rtol=1e-9)
        assert np.all(diagram.growth == 0.0) or np.abs(diagram.growth).max() < 1e-9 * critical
        names = stability(rotor, [speed], supports=supports).whirl[0]
        assert sorted(names) == ["axial"] * 4 + ["backward"] * 4 + ["forward"] * 4


@pytest.mark.parametrize("damping", [1e-3, 5.0])
def test_limit_without_damping_at_rest_is_named(damping):
    """Damping that turns destabilises forward whirl above the critical speed, where λ = 0.

    Genta, Dynamics of Rotating Systems (2005), Sect. 4.4, without damping at rest.
    """
    supports = [Support(end, 1.7e4) for end in ENDS]
    supports += [Support(end, damping=damping, frame="rotor") for end in ENDS]
    found = stability_threshold(rod("z"), 50.0, 150.0, supports=supports)
    np.testing.assert_allclose(found.values, np.sqrt(1.7e4 / MASS), rtol=1e-6)
    assert WHIRLS[found.whirl_codes[0]] == "forward"


@pytest.mark.parametrize("distance", [0.0, 1e-12, -1e-9, 1e-7])
def test_motions_on_uneven_supports_keep_their_names(distance):
    """Periodic equations: each mass moves at √(k/m) of one direction, forward and back."""
    supports = [Support(end, np.diag([2e4, 3e4])) for end in ENDS]
    speed = 100.0 * (1.0 + distance)
    diagram = campbell(rod(SKEW_AXIS), [speed], supports=supports)
    assert sorted(diagram.whirl[0]) == ["axial"] * 2 + ["mixed"] * 4
    seen = diagram.frequencies_inertial[0, diagram.whirl[0] == "mixed"]
    np.testing.assert_allclose(np.sort(seen), np.sqrt([1e4, 1e4, 1.5e4, 1.5e4]), rtol=1e-8)
    found = stability(rod(SKEW_AXIS), [speed], supports=supports)
    assert found.stable[0]
    assert np.abs(found.growth[0]) < 1e-8 * speed


def free_and_held(seed: int) -> PeriodicSystem:
    """Return a damped gyroscopic system of six coordinates with two free directions."""
    rng = np.random.default_rng(seed)
    root, skew, mixing = rng.normal(size=(3, 6, 6))
    root[:, :2] = skew[:, :2] = skew[:2] = 0.0
    D = 0.1 * root.T @ root + skew - skew.T
    M, D, K = (mixing.T @ X @ mixing for X in (np.eye(6), D, 1e4 * root.T @ root))
    M, K = (0.5 * (X + X.T) for X in (M, K))
    return PeriodicSystem(10.0, {0: M}, {0: D}, {0: K})


@pytest.mark.parametrize("seed", range(4))
def test_free_directions_are_found_in_any_coordinates(seed):
    system = free_and_held(seed)
    M, D, K = system.matrices(0.0)
    apart = FreeDirections.of(system)
    assert apart.free.shape == (6, 2)
    noise = 1e-13 * np.linalg.cond(M)
    for X in (D, K):
        for side in (X, X.T):
            assert np.abs(side @ apart.free).max() < noise * np.abs(X).max()
    assert np.abs(apart.others.T @ M @ apart.free).max() < noise * np.abs(M).max()
    found = motions(system)
    assert np.count_nonzero(found.values == 0.0) == 4
    expected = constant_exponents(system.projected(apart.others))
    moving = found.values[found.values != 0.0]
    apart_by = np.abs(moving[:, None] - expected).min(axis=0)
    assert np.all(apart_by < 1e-11 * np.linalg.cond(M) * np.abs(expected).max())


def test_what_is_resisted_is_not_free():
    """A damper, a gyroscopic force or a spring on one side alone resists."""
    M, none = np.eye(3), np.zeros((3, 3))
    spring = np.diag([1e4, 2e4, 0.0])
    damper, gyroscopic, one_sided = none.copy(), none.copy(), spring.copy()
    damper[2, 2] = 1e-3
    gyroscopic[0, 2], gyroscopic[2, 0] = 1.0, -1.0
    one_sided[0, 2] = 1.0
    for D, K in ((damper, spring), (gyroscopic, spring), (none, one_sided)):
        assert FreeDirections.of(PeriodicSystem(1.0, {0: M}, {0: D}, {0: K})) is None
    harmonics = {0: spring, 2: 1j * damper, -2: -1j * damper}  # a mean of none
    assert FreeDirections.of(PeriodicSystem(1.0, {0: M}, {0: none}, harmonics)) is None
    both = ConstantSystems(M[None], np.stack([none] * 2), np.stack([spring] * 2))
    ((rows, held, apart),) = parted(both)
    assert rows.tolist() == [0, 1]
    assert held.D.shape == (2, 2, 2)
    np.testing.assert_allclose(np.abs(apart.free.T), [[0.0, 0.0, 1.0]], atol=1e-15)


def test_more_is_free_at_rest():
    """A disc on a bearing without stiffness against tilting: at rest its tilts are free, too."""
    rotor = ring_rotor(0.1, 0.05, MASS).with_interface("all", range(10))
    supports = [Support("all", 2e4)]
    together = campbell(rotor, [0.0, 10.0], supports=supports, modes=6)
    alone = campbell(rotor, [0.0], supports=supports, modes=6)
    assert np.count_nonzero(together.frequencies_inertial[0] == 0.0) == 4
    np.testing.assert_allclose(
        together.frequencies_inertial[0], alone.frequencies_inertial[0], rtol=1e-12
    )
    # a free tilt precesses at I_p/I_t Ω
    ratio = 0.1**2 / (0.1**2 / 2.0 + 0.05**2)
    assert np.isclose(together.frequencies_inertial[1], 10.0 * ratio).any()


def test_a_rotor_that_nothing_holds_has_free_motions_alone():
    rotor = SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), [[0.0, 0.0, 0.0]], "z")
    assert np.all(campbell(rotor, [0.0]).frequencies_inertial == 0.0)
    exponents = stability(rotor, [0.0]).exponents
    assert exponents.shape == (1, 6)
    assert np.all(exponents == 0.0)


def test_modes_are_of_unit_length_and_orthogonal_to_free_ones():
    system = free_and_held(5)
    modes, M = floquet.floquet_modes(system), system.M[0]
    assert len(modes.values) == 6
    np.testing.assert_allclose(np.linalg.norm(modes.central, axis=0), 1.0)
    free = modes.values == 0.0
    coupling = modes.central[:, free].T @ M @ modes.central[:, ~free]
    assert np.abs(coupling).max() < 1e-13 * np.linalg.cond(M) * np.abs(M).max()


@pytest.mark.parametrize("axis", [[1.0, 2.0, 2.0], [0.3, -0.7, 0.2], [0.1, 0.2, 0.7]])
def test_a_single_point_mass_has_no_spin(axis):
    """It is off its own centre by rounding alone: a Jeffcott rotor of one point.

    On uneven springs its exponents at rest are ``λ² + λd/m + k/m = 0``, at any speed.
    """
    axis, mass = np.array(axis) / np.linalg.norm(axis), 0.3
    rotor = SolidRotor.from_matrices(
        mass * np.eye(3), np.zeros((3, 3)), [0.13 * axis], axis, check_units=False
    ).with_interface("mass", [0])
    supports = [Support("mass", np.diag([1e4, 1.5e4]) * mass, 2.0 * mass)]
    assert linear_model(rotor, supports=supports).free_motions == ("translation along axis",)
    found = stability(rotor, [70.0], supports=supports)
    assert found.exponents.shape == (1, 6)
    np.testing.assert_allclose(found.growth, 0.0)
    np.testing.assert_allclose(found.exponents[0, 2:].real, -1.0, rtol=1e-9)
    seen = campbell(rotor, [70.0], supports=supports).frequencies_inertial[0]
    np.testing.assert_allclose(np.sort(seen), [0.0, *np.sqrt([1e4 - 1.0, 1.5e4 - 1.0])], rtol=1e-9)
