"""Ranges of instability between samples: uneven rotors on uneven supports, and tables."""

import exudyn
import numpy as np
import pytest

from exudyn_rotor import (
    RotorTrain,
    SolidRotor,
    Support,
    add_rotor,
    add_supports,
    linear_model,
    stability_threshold,
)
from exudyn_rotor.linear.periodic.exponents import exponents
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.linear.stability.between_samples import PARTS, to_look_at
from exudyn_rotor.linear.stability.growth_scan import GrowthScan

MASSES, STEPS = 4, 300


def uneven(rng: np.random.Generator, size: float, most: float) -> np.ndarray:
    """Return a random stiffness (2, 2) whose larger value is up to 1 + `most` times the smaller."""
    angle = rng.uniform(0.0, np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return size * turn @ np.diag([1.0, 1.0 + rng.uniform(0.02, most)]) @ turn.T


def chain(seed: int, damping: float) -> tuple[SolidRotor, list[Support]]:
    """Return point masses on an uneven shaft, and uneven supports of both ends."""
    rng = np.random.default_rng(seed)
    places = np.linspace(-0.3, 0.3, MASSES) + rng.uniform(-0.05, 0.05, MASSES)
    nodes = np.outer(places, [0.0, 0.0, 1.0])
    stiffness = np.zeros((3 * MASSES, 3 * MASSES))
    for i in range(MASSES - 1):
        rod = np.zeros(3 * MASSES)
        rod[[3 * i + 2, 3 * i + 5]] = 1.0, -1.0
        stiffness += 1e7 * np.outer(rod, rod)
    for i in range(1, MASSES - 1):
        before, after = np.diff(places)[i - 1 : i + 1]
        bent = np.zeros((2, 3 * MASSES))
        for j, share in enumerate(np.array([after, -before - after, before]) / (before + after)):
            bent[:, 3 * (i - 1 + j) : 3 * (i - 1 + j) + 2] = share * np.eye(2)
        stiffness += bent.T @ uneven(rng, 10.0 ** rng.uniform(5.3, 6.5), 1.0) @ bent
    mass = np.kron(np.diag(rng.uniform(1.0, 10.0, MASSES)), np.eye(3))
    ends = {"left": [0], "right": [MASSES - 1]}
    rotor = SolidRotor.from_matrices(mass, stiffness, nodes, "z", interfaces=ends)
    supports = []
    for name in ends:
        K = np.diag([0.0, 0.0, 1e5])
        K[:2, :2] = uneven(rng, 10.0 ** rng.uniform(5.0, 6.5), 3.0)
        supports.append(Support(name, K, np.diag([damping, damping, 50.0])))
    return rotor, supports


def largest_growth(system_at, speeds: np.ndarray) -> np.ndarray:
    """Return the growth at speeds by monodromy matrices, Runge and Kutta's steps; lateral only."""
    lateral = np.flatnonzero(np.arange(3 * MASSES) % 3 != 2)
    systems = [system_at(speed) for speed in speeds]

    def rates(theta: float) -> np.ndarray:
        result = []
        for system in systems:
            M, D, K = (X[np.ix_(lateral, lateral)] for X in system.matrices(theta))
            none, one = np.zeros_like(M), np.eye(len(M))
            result.append(np.block([[none, one], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]]))
        return np.array(result)

    # the coefficients are second harmonics
    there, back = rates(0.0), rates(np.pi / 2)
    middle, cosine = 0.5 * (there + back), 0.5 * (there - back)
    sine = 0.5 * (rates(np.pi / 4) - rates(3 * np.pi / 4))
    angles = np.pi * np.arange(2 * STEPS + 1) / (2 * STEPS)
    A = [middle + np.cos(2.0 * a) * cosine + np.sin(2.0 * a) * sine for a in angles]
    h = np.pi / STEPS / speeds[:, None, None]
    Y = np.broadcast_to(np.eye(4 * MASSES), A[0].shape)
    for i in range(0, 2 * STEPS, 2):
        one = A[i] @ Y
        two = A[i + 1] @ (Y + 0.5 * h * one)
        three = A[i + 1] @ (Y + 0.5 * h * two)
        Y = Y + h / 6.0 * (one + 2.0 * (two + three) + A[i + 2] @ (Y + h * three))
    return np.log(np.abs(np.linalg.eigvals(Y)).max(axis=1)) * speeds / np.pi


def missed(seed: int, low: float, high: float, given: dict) -> np.ndarray:
    """Return speeds at which the verdict is not that of monodromy matrices, of 61.

    Where these tell it: their steps of integration err by less than 1e-3 1/s.
    """
    rotor, supports = chain(seed, 20.0)
    found = stability_threshold(rotor, low, high, **given, supports=supports, accuracy=None)
    speeds = np.linspace(low, high, 61)
    space = linear_model(rotor, supports=supports).space(0, high, held=True)
    growth = largest_growth(space.at, speeds)
    assert np.any(growth > 1e-3)
    inside = np.any([(a <= speeds) & (speeds <= b) for a, b in found.ranges], axis=0)
    return speeds[(inside != (growth > 0.0)) & (np.abs(growth) > 1e-3)]


def test_ranges_between_samples_are_those_of_monodromy_matrices():
    """A range 1 rad/s wide was missed."""
    assert missed(0, 390.0, 420.0, {"samples": 2}).size == 0


def given_systems(masses: int, step: int):
    """Return random equations whose terms are of second order in their parameter, the speed."""
    rng = np.random.default_rng(7)

    def whole(size: float) -> np.ndarray:
        X = rng.normal(size=(masses, masses))
        return size * (X @ X.T / masses + np.eye(masses))

    def wave(size: float) -> np.ndarray:
        X = rng.normal(size=(2, masses, masses)) * size / masses
        return X[0] + X[0].T + 1j * (X[1] + X[1].T)

    M, M2, D, K, K2 = whole(1.0), wave(0.2), 0.05 * whole(1.0), whole(300.0), wave(250.0)
    G = rng.normal(size=(masses, masses))

    def at(speed: float, varies: bool) -> PeriodicSystem:
        inertia = {0: M} | ({step: M2, -step: M2.conj()} if varies else {})
        gyroscopic = {0: D + speed * (G - G.T) * 0.1}
        stiffness = {0: K + 0.05 * speed**2 * M, step: K2, -step: K2.conj()}
        return PeriodicSystem(speed, inertia, gyroscopic, stiffness)

    return at


@pytest.mark.parametrize("varies", [False, True])
@pytest.mark.parametrize("step", [1, 2])
def test_growths_of_a_scan_are_those_of_the_exponents(step, varies):
    """Steps of at most 0.4 rad of the fastest motion: of fourth order, 0.4⁴/720 of its rate.

    Not at the edge of the range, at 15 rad/s, where growth changes with the root of frequencies.
    """
    at = given_systems(3, step)
    values = np.linspace(15.0, 25.0, 5)
    systems = [at(value, varies) for value in values]
    assert GrowthScan.can(systems)
    places = np.linspace(16.9, 24.7, 7)
    expected = [exponents(at(value, varies), "floquet")[0].real for value in places]
    fastest = np.sqrt(np.abs(np.linalg.eigvals(
        np.linalg.solve(systems[0].M[0].real, systems[0].K[0].real))).max())  # fmt: skip
    found = GrowthScan(values, systems).growths(places)
    np.testing.assert_allclose(found, expected, atol=0.4**4 / 720 * fastest)
    assert np.ptp(expected) > 1e-3 * fastest


def test_equations_that_do_not_turn_or_differ_in_kind_are_not_scanned():
    at = given_systems(3, 2)
    one, still = (
        at(15.0, False),
        PeriodicSystem(15.0, {0: np.eye(3)}, {0: np.eye(3)}, {0: np.eye(3)}),
    )
    assert not GrowthScan.can([one, None])
    assert not GrowthScan.can([one, still])
    assert not GrowthScan.can([one, given_systems(2, 2)(15.0, False)])
    assert not GrowthScan.can([one, given_systems(3, 1)(15.0, False)])


class Given:
    """A scan of growth given as a function; counts the values."""

    def __init__(self, growth) -> None:
        self.growth, self.calls = growth, 0

    def speeds(self, values: np.ndarray) -> np.ndarray:
        return np.zeros(len(values))

    def growths(self, values: np.ndarray) -> np.ndarray:
        self.calls += len(values)
        return self.growth(np.asarray(values))


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_peak_narrower_than_the_parts_is_seen_by_its_foot(sense):
    """An unstable range of a 200th of the gap, or a stable one."""
    scan = Given(lambda value: sense * (0.0025 - np.abs(value - 0.5112)))
    known = {0.0: sense < 0.0, 1.0: sense < 0.0}
    [value] = to_look_at(scan, (0.0, 1.0), known)
    assert value == pytest.approx(0.5112, abs=0.0025)
    assert scan.calls < 2 * PARTS
    assert to_look_at(scan, (0.0, 1.0), known | {0.512: sense > 0.0}) == []


def test_ranges_beside_a_change_of_the_verdict_are_looked_at():
    scan = Given(lambda value: np.cos(5.0 * np.pi * value))  # changes at 0.1, 0.3 … 0.9
    found = to_look_at(scan, (0.0, 1.0), {0.0: True, 1.0: False})
    assert found == pytest.approx([0.2, 0.4, 0.6, 0.8])


def test_nothing_is_seen_closer_where_growth_does_not_change():
    scan = Given(lambda value: np.full(len(value), -1.0))
    assert to_look_at(scan, (0.0, 1.0), {0.0: False, 1.0: False}) == []
    assert scan.calls == PARTS + 1


KNOTS = [0.0, 148.0, 150.0, 152.0, 500.0]
DAMPING = [20.0, 20.0, 0.1, 20.0, 20.0]  # N s/m
# inner damping of 5 N s/m of a mass with ω = 100 rad/s grows from Ω = ω (1 + outer/5) on
DIP = [150.0 - 2.4 / 10.0, 150.0 + 2.4 / 9.9]


@pytest.mark.parametrize("kind", ["list", "model", "train"])
def test_a_range_within_a_dip_of_a_table_is_found(kind):
    nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    ends = {"left": [0], "right": [1]}
    rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z", interfaces=ends)
    table = np.array(KNOTS), np.array(DAMPING)
    supports = [Support(name, 2e4 * np.eye(3), table) for name in ends]
    supports += [Support(name, damping=5.0, frame="rotor") for name in ends]
    low, high, given = 110.0, 400.0, {}
    if kind == "list":
        target, given = rotor, {"supports": supports}
    elif kind == "model":
        target = linear_model(rotor, supports=supports)
    else:  # a second rotor at half the speed of this one
        other = [Support(name, 2e4 * np.eye(3), 20.0) for name in ends]
        target = RotorTrain(
            rotors={"slow": rotor.reduce(0), "fast": rotor.reduce(0)},
            ratios={"slow": 1.0, "fast": 2.0},
            supports={"slow": other, "fast": supports},
        )
        low, high = 60.0, 200.0
    found = stability_threshold(target, low, high, samples=7, accuracy=None, **given)
    ratio = 2.0 if kind == "train" else 1.0
    np.testing.assert_allclose(found.values, np.divide(DIP, ratio), rtol=1e-7)


def test_a_scene_has_the_speeds_of_its_tables():
    nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]
    ends = {"left": [0], "right": [1]}
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z", interfaces=ends)
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor.reduce(0), spin=0.0)
    table = np.array(KNOTS), np.array(DAMPING)
    add_supports(body, [Support("left", 2e4, table), Support("right", 2e4, 20.0)])
    mbs.Assemble()
    np.testing.assert_array_equal(linear_model(mbs, body=body).table_speeds, KNOTS)
