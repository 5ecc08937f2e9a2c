"""Equilibria of a scene, also in contact with stops.

By Newton's method with a line search. What nothing holds yet is pressed by its load against a
softness that lets it go farther in every step, until something holds it. Friction follows the
sliding: an equilibrium has none of it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.linalg

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.probe import Probe, linearised, unbalanced
from exudyn_rotor.linear.model.scene.scene_coordinates import UNHELD, Motion, SceneCoordinates
from exudyn_rotor.solvers.line_search import step_share

NOISE = 1e-10  # share of the largest entry below which a Fourier term is round-off
FAR = 10.0  # lengths of the rotor that only round-off keeps it from leaving
SMALLEST = 1e-5  # m: the tolerance of smaller motions, for Exudyn rounds positions of order 1 m
_ROUNDING = 1e-13  # of the largest stiffness: what turning by a skew axis leaves of none
_SINGULAR = 1e-12  # reciprocal condition of a stiffness that leaves a motion free
BALANCED = 1e-8  # m/s² that may be left where a contact resists with the square of its depth,
_FEW_ITERATIONS, _MOST_ITERATIONS = 10, 60  # after these
_FIRST_REACH, _FURTHER = 1e-6, 4.0  # m of what nothing holds, and its growth in every step


def motion_at_rest(
    scene: SceneCoordinates,
    probe: Probe,
    tolerance: float,
    angle: float,
    begin: Motion | None = None,
) -> Motion:
    """Return orders (3,) and harmonics (3, k) of the equilibria at three angles of the rotor.

    The first is the start's angle [rad]. A search begins with the motion `begin` where one is
    given.

    Raises
    ------
    UnconvergedError
        Where there is no equilibrium.
    """
    orders = np.arange(-1, 2)
    first, start = begin or (orders, journal_start(scene, 0.0, orders))
    metres = 1.0 / scene.metre(probe.masses)
    angles, found = angle + 2.0 * np.pi * np.arange(3) / 3.0, []
    for theta in angles:
        near = found[-1] if found else (np.exp(1j * theta * first) @ start).real
        still = np.zeros_like(near)

        def at(y: np.ndarray, theta: float = theta, none: np.ndarray = still) -> tuple:
            point = linearised(probe, theta, y, none, none)
            return point.K, point.residual

        def left(y: np.ndarray, theta: float = theta, none: np.ndarray = still) -> np.ndarray:
            return unbalanced(probe, theta, y, none, none)

        where = f"scene at rest, at the angle {theta:g} rad of the rotor"
        found.append(equilibrium(scene, at, left, metres, near, tolerance, where))
    return orders, np.exp(-1j * np.outer(orders, angles)) @ found / 3.0


def equilibrium(
    scene: SceneCoordinates,
    linearised: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
    unbalanced: Callable[[np.ndarray], np.ndarray],
    metres: np.ndarray,
    start: np.ndarray,
    tolerance: float,
    where: str,
) -> np.ndarray:
    """Return the coordinates (k,) of an equilibrium, beside `start`.

    `linearised` gives stiffness (k, k) and what is unbalanced (k,), `unbalanced` the latter alone;
    `metres` are those per unit of each coordinate, the last step is below `tolerance` of the
    motion, and messages begin with `where`.

    Raises
    ------
    UnconvergedError
        Where something is not held, or no equilibrium is found.
    """
    y, reach = start, _FIRST_REACH
    for iteration in range(_MOST_ITERATIONS):
        K, residual = linearised(y)
        step, left = solved(K, -residual)
        pull = left / metres
        held = np.abs(pull).max(initial=0.0) <= UNHELD * scene.mass
        most = np.abs(residual / metres).max(initial=0.0)
        if held and iteration > _FEW_ITERATIONS and most <= BALANCED * scene.mass:
            return y
        if not held:
            soft = np.abs(pull).max() / reach * np.diag(metres**2)
            step = solved(K + soft, -residual)[0]
            reach *= _FURTHER

        def slope(share: float, y: np.ndarray = y, step: np.ndarray = step) -> float:
            return float(step @ unbalanced(y + share * step))

        y = y + step_share(slope) * step
        size = np.abs(y * metres).max(initial=0.0)
        if size > FAR * scene.length:
            raise UnconvergedError(
                f"{where}: a load that nothing holds takes the rotor away; add a support in its "
                "direction"
            )
        if held and np.abs(step * metres).max(initial=0.0) < tolerance * max(size, SMALLEST):
            return y
    raise UnconvergedError(
        f"{where}: no equilibrium found; is a bearing or a magnetic force stronger than what holds "
        "the rotor? A damped run from rest shows what it does"
    )


def solved(K: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve with motions that nothing holds left at rest; return what remains of the load, too.

    So is a rotor along its axis that springs, films and rolling elements across it leave free.
    """
    sizes = np.abs(K)
    held = np.maximum(sizes.max(axis=1), sizes.max(axis=0)) > _ROUNDING * sizes.max()
    among, answer = K[np.ix_(held, held)], np.zeros(len(load), dtype=np.result_type(K, load))
    if not np.any(held):
        return answer, load
    rows = np.abs(among).max(axis=1)
    # a row of round-off is not blown up to the size of the others
    scale = 1.0 / np.sqrt(np.maximum(rows, NOISE * rows.max()))
    scaled = scale[:, None] * among * scale
    answer[held] = scale * _least_squares(scaled, scale * load[held])
    return answer, load - K @ answer


def _least_squares(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the solution, of a singular matrix the smallest one that leaves least."""
    factor, condition, solve = scipy.linalg.get_lapack_funcs(("getrf", "gecon", "getrs"), (A, b))
    lu, pivots, info = factor(A)
    if info == 0 and condition(lu, np.abs(A).sum(axis=0).max())[0] > _SINGULAR:
        return solve(lu, pivots, b)[0]
    return scipy.linalg.lstsq(A, b, cond=_SINGULAR, lapack_driver="gelsy")[0]
