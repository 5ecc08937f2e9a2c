"""Processor time of linear analyses against the eigenvalue problems that they cannot do without.

The demonstration's rotor on two bearings: alike in all directions, unlike in two, and with tables
over the speed. The floor is `numpy.linalg.eig` of as many first-order matrices of the same size, or
`numpy.linalg.solve` of as many dynamic stiffnesses. All take turns, and the shortest time counts.

Forced motions count the unevenness of the mesh, by which a critical speed is two: near it they
depend on it to first order, and a mean would err by some percent. On bearings that are unlike in
two directions an uneven rotor has Hill's matrix. The floor is the dense solution of its least, in
the axes of the rotor: harmonics 0 and ±2 of an unbalance, ±1 of a force that stands still.

python -m validation linear [--quick]
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable, Sequence

import numpy as np

from exudyn_rotor import (
    HarmonicForce,
    LinearModel,
    ReducedRotor,
    SolidRotor,
    Support,
    Unbalance,
    campbell,
    harmonic_response,
    linear_model,
    stability_map,
    stability_threshold,
    unbalance_response,
)
from exudyn_rotor.demo.scene import disc_on_shaft
from validation.rows import verdict

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
NAMES = ("left", "right")
REPEATS, SPEEDS = 5, np.linspace(0.0, 1500.0, 51)
TABLE = (
    [0.0, 500.0, 1000.0, 1500.0],
    [np.diag([(1.0 + i) * 1e7, (2.0 + i) * 1e7]) for i in range(4)],
)
KINDS = {"alike": 2e7, "unlike": np.diag([2e7, 4e7]), "table": TABLE}


def supports(kind: str) -> list[Support]:
    """Return two bearings with damping."""
    return [Support(name, KINDS[kind], 2e3) for name in NAMES]


def companion(model: LinearModel, speed: float) -> np.ndarray:
    """Return the first-order matrix (2k, 2k) of constant equations."""
    M, D, K = model.at(speed).matrices()
    k = len(M)
    lower = -np.linalg.solve(M, np.hstack([K, D]))
    return np.vstack([np.eye(k, 2 * k, k), lower])


def eigenvalues(model: LinearModel, count: int) -> Callable[[], object]:
    """Return a call that solves so many eigenvalue problems of a model."""
    matrices = [companion(model, speed) for speed in np.linspace(1.0, 1500.0, count)]
    return lambda: [np.linalg.eig(A) for A in matrices]


def dynamic_stiffness(system, rate: float, orders: Sequence[int]) -> np.ndarray:
    """Return the dynamic stiffness between harmonics, (h k, h k)."""
    M, none = system.M, np.zeros_like(system.M)
    rates = {n: rate + n * system.speed for n in orders}
    D, K = (
        {n - m: X.get(n - m, none) for m in orders for n in orders} for X in (system.D, system.K)
    )
    return np.block(
        [
            [K[m - n] + 1j * w * D[m - n] - (m == n) * w**2 * M for n, w in rates.items()]
            for m in orders
        ]
    )


def solutions(
    model: LinearModel, speeds: np.ndarray, rates: np.ndarray, orders: Sequence[int]
) -> Callable[[], object]:
    """Return a call that solves Hill's matrices of harmonics, or each alone where equations are."""
    matrices = []
    for speed, rate in zip(speeds, rates, strict=True):
        system = model.at(speed)
        groups = [[0]] if orders[0] == -2 else [[n] for n in orders]
        for group in groups if system.is_constant else [orders]:
            matrices.append(dynamic_stiffness(system, rate, group))
    return lambda: [np.linalg.solve(A, np.ones(len(A))) for A in matrices]


def seconds(*calls: Callable[[], object], repeats: int = REPEATS) -> list[float]:
    """Return the shortest processor time of each call; all take turns."""
    times = np.full((repeats, len(calls)), np.inf)
    for row in times:
        for column, call in enumerate(calls):
            start = time.process_time()
            call()
            row[column] = time.process_time() - start
    return times.min(axis=0).tolist()


def ratios(rotor: ReducedRotor) -> dict[str, float]:
    """Return the time of each analysis over its floor."""
    found = {}
    model = linear_model(rotor, supports=supports("unlike"))
    floor = eigenvalues(model, len(SPEEDS))
    for kind in KINDS:
        given = {"supports": supports(kind)}
        few, all_of_it, least = seconds(
            lambda given=given: campbell(rotor, SPEEDS, **given, accuracy=None),
            lambda given=given: campbell(rotor, SPEEDS, **given),
            floor,
        )
        found[f"Campbell, {kind}"] = few / least
        found[f"Campbell with the error of the basis, {kind}"] = all_of_it / least
    limit, least = seconds(
        lambda: stability_threshold(model, 10.0, 1500.0, accuracy=None), eigenvalues(model, 80)
    )
    found["threshold, over 80 eigenvalue problems"] = limit / least
    # springs that turn with it make the rotor uneven: 49 samples of Hill's matrix, 0, ±2 and ±4
    uneven = Support("left", np.diag([1e7, 3e7]), frame="rotor")
    model = linear_model(rotor, supports=[uneven, *supports("unlike")])
    matrix = np.random.default_rng(1).normal(size=(10 * rotor.size, 10 * rotor.size))
    limit, least = seconds(
        lambda: stability_threshold(model, 150.0, 1500.0, accuracy=None),
        lambda: [np.linalg.eig(matrix) for _ in range(49)],
        repeats=1,
    )
    found["threshold of an uneven rotor, over 49 of Hill's matrices"] = limit / least

    def at_point(stiffness: float, damping: float) -> tuple[LinearModel, float]:
        K = np.diag([stiffness, 2.0 * stiffness])
        return linear_model(rotor, supports=[Support(n, K, damping) for n in NAMES]), 500.0

    axes = np.geomspace(1e6, 1e8, 20), np.geomspace(1e2, 1e4, 10)
    points, least = seconds(
        lambda: stability_map(at_point, *axes, accuracy=None), eigenvalues(model, 200)
    )
    found["map of 200 points"] = points / least
    speeds, still = SPEEDS[1:], np.full(len(SPEEDS) - 1, 300.0)
    unbalance, force = Unbalance("left", 1e-4), HarmonicForce("left", (1.0, 0.0))
    for kind in KINDS:
        model = linear_model(rotor, supports=supports(kind), axes="rotor")
        one, least, other, its_least = seconds(
            lambda model=model: unbalance_response(model, speeds, unbalance, accuracy=None),
            solutions(model, speeds, 0.0 * speeds, [-2, 0, 2]),
            lambda model=model: harmonic_response(model, speeds, force, speed=300.0, accuracy=None),
            solutions(model, still, speeds, [-1, 1]),
        )
        found[f"unbalance response, {kind}"] = one / least
        found[f"harmonic response, {kind}"] = other / its_least
    return found


def main() -> int:
    """Print the ratios of rotors with few and with many coordinates, and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one small rotor")
    quick = parser.parse_args().quick
    solid = SolidRotor.from_ngsolve(disc_on_shaft(0.1 if quick else 0.05), STEEL, axis="x")
    warnings.simplefilter("ignore")
    worst = 0.0
    for modes in (8,) if quick else (8, 20, 54):
        rotor = solid.center_interfaces().reduce(modes)
        print(f"{rotor.size} coordinates: processor time over its floor")
        found = ratios(rotor)
        for name, ratio in found.items():
            print(f"  {name:56} {ratio:6.1f}")
        worst = max(worst, *found.values())
    return verdict({"time over its floor": (worst, 20.0)})
