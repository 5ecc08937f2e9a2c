"""Equilibria of a scene at rest, at all angles of the rotor, also in contact with stops.

By Newton's method with a line search. What nothing holds yet is pressed by its load against a
softness that lets it go farther in every step, until something holds it. Friction follows the
sliding: an equilibrium has none of it.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.along_axis import held_along_axis
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.probe import Probe, linearised
from exudyn_rotor.linear.model.scene.scene_coordinates import UNHELD, Motion, SceneCoordinates
from exudyn_rotor.solvers.line_search import step_share

NOISE = 1e-10  # share of the largest entry below which a Fourier term is round-off
FAR = 10.0  # lengths of the rotor that only round-off keeps it from leaving
SMALLEST = 1e-5  # m: the tolerance of smaller motions, for Exudyn rounds positions of order 1 m
_ROUNDING = 1e-13  # of the largest stiffness: what turning by a skew axis leaves of none
BALANCED = 1e-8  # m/s² that may be left where a contact resists with the square of its depth,
_FEW_ITERATIONS, _MOST_ITERATIONS = 10, 60  # after these
_SAMPLES = 7  # angles of the rotor, an odd number: the harmonics are exact at all of them
_FIRST_REACH, _FURTHER = 1e-6, 4.0  # m of what nothing holds, and its growth in every step


def motion_at_rest(
    scene: SceneCoordinates,
    probe: Probe,
    tolerance: float,
    angle: float,
    begin: Motion | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return orders (h,) and harmonics (h, k) of the equilibria at all angles of the rotor.

    Exact at the start's angle [rad] and those of the same distance from it. A search begins with
    the motion `begin` where one is given.

    Raises
    ------
    UnconvergedError
        Where there is no equilibrium.
    """
    kept = held_along_axis(scene, probe)
    first, start = begin or (np.arange(-1, 2), journal_start(scene, 0.0, np.arange(-1, 2)))
    count = _SAMPLES
    while True:
        angles = angle + 2.0 * np.pi * np.arange(count) / count
        orders = np.arange(-(count // 2), count // 2 + 1)
        values = []
        for theta in angles:
            near = values[-1] if values else (np.exp(1j * theta * first) @ start).real
            values.append(equilibrium(scene, probe, theta, near, tolerance, kept))
        harmonics = np.exp(-1j * np.outer(orders, angles)) @ values / count
        sizes = np.abs(harmonics).max(axis=1)
        if sizes[[0, -1]].max() <= tolerance * sizes.max() or count > 2 * _SAMPLES:
            return orders, harmonics
        count = 2 * count + 1


def equilibrium(
    scene: SceneCoordinates,
    probe: Probe,
    theta: float,
    start: np.ndarray,
    tolerance: float,
    kept: np.ndarray,
) -> np.ndarray:
    """Return the coordinates (k,) of an equilibrium at rest, at one angle of the rotor [rad].

    Parameters
    ----------
    scene : SceneCoordinates
    probe : Probe
        At the speed 0.
    theta : float
    start : ndarray, shape (k,)
    tolerance : float
        Largest last step, relative to the motion.
    kept : ndarray, shape (k, r)
        Orthonormal motions in which it is looked for.

    Raises
    ------
    UnconvergedError
        Where something is not held, or no equilibrium is found.
    """
    y, still, reach = start, np.zeros_like(start), _FIRST_REACH
    for iteration in range(_MOST_ITERATIONS):
        point = linearised(probe, theta, y, still, still)
        metres = 1.0 / scene.metre(np.diag(point.M))
        step, left = solved_in(kept, point.K, -point.residual)
        pull = left / metres
        held = np.abs(pull).max() <= UNHELD * scene.mass
        most = np.abs(point.residual / metres).max()
        if held and iteration > _FEW_ITERATIONS and most <= BALANCED * scene.mass:
            return y
        if not held:
            soft = np.abs(pull).max() / reach * np.diag(metres**2)
            step = solved_in(kept, point.K + soft, -point.residual)[0]
            reach *= _FURTHER

        def slope(share: float, y: np.ndarray = y, step: np.ndarray = step) -> float:
            return float(step @ probe.unbalanced(theta, y + share * step))

        y = y + step_share(slope) * step
        size = np.abs(y * metres).max()
        if size > FAR * scene.length:
            raise UnconvergedError(
                "scene at rest: a load that nothing holds takes the rotor away; add a support in "
                "its direction"
            )
        if held and np.abs(step * metres).max() < tolerance * max(size, SMALLEST):
            return y
    raise UnconvergedError(
        f"scene at rest: no equilibrium found at the angle {theta:g} rad of the rotor; is a "
        "bearing or a magnetic force stronger than what holds the rotor? A damped run from rest "
        "shows what it does; about='given' needs no equilibrium"
    )


def solved(K: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve with motions that nothing holds left at rest; return what remains of the load, too."""
    sizes = np.abs(K)
    held = np.maximum(sizes.max(axis=1), sizes.max(axis=0)) > _ROUNDING * sizes.max()
    among, answer = K[np.ix_(held, held)], np.zeros(len(load), dtype=np.result_type(K, load))
    if not np.any(held):
        return answer, load
    rows = np.abs(among).max(axis=1)
    # a row of round-off is not blown up to the size of the others
    scale = 1.0 / np.sqrt(np.maximum(rows, NOISE * rows.max()))
    scaled = scale[:, None] * among * scale
    solution = scipy.linalg.lstsq(scaled, scale * load[held], cond=1e-12, lapack_driver="gelsy")
    answer[held] = scale * solution[0]
    return answer, load - K @ answer


def solved_in(kept: np.ndarray, K: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return as :func:`solved`, in orthonormal motions (k, r) alone."""
    answer, left = solved(kept.T @ K @ kept, kept.T @ load)
    return kept @ answer, load - kept @ (kept.T @ load - left)
