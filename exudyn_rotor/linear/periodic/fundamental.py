"""Floquet's method: exponents from the fundamental matrix over one period.

The multipliers ``exp(λT)`` are the eigenvalues of the fundamental matrix, which is found by a
sixth-order Magnus series and matrix exponentials, the number of steps doubled until it no longer
changes. Source: Blanes, Casas, Oteo, Ros, Phys. Rep. 470 (2009), Eq. (253). Strongly damped
exponents lose digits: their multipliers are tiny.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from tqdm import tqdm

from exudyn_rotor.linear.periodic.harmonics import shifted
from exudyn_rotor.linear.periodic.hill_motions import HillMotions
from exudyn_rotor.linear.periodic.periodic_system import (
    EPSILON,
    PeriodicSystem,
    Terms,
    UnconvergedError,
    fold,
)

MOST_STEPS = 2**14
# shares of a step: those of Gauss's quadrature with two points
GAUSS_POINTS = 0.5 + np.array([-1.0, 1.0]) * np.sqrt(3.0) / 6.0
_CHUNK = 128
_SHOWN_FROM = 4e9  # steps times entries cubed, of some seconds
_MORE = 2.0  # times its estimate that the error of a fundamental matrix may be
_OF_A_WAVE = 2  # steps at least, of the highest harmonic
_SAMPLES = 8  # angles of a period, doubled at least once
# of the tolerance: share of a motion that its outermost harmonics may be
_TAIL = 0.1
# share of the base: exponents that are known no better, about zero, are not told from growth
_TOLD = 1e-2
_WHOLE = 1e-12
# share of the largest entry that stands for a multiplier of which rounding leaves nothing
_LEAST = EPSILON**2


def monodromy(system: PeriodicSystem, tolerance: float = 1e-9) -> tuple[np.ndarray, int, float]:
    """Return the fundamental matrix of (x, ẋ) over one period of the coefficients, from θ = 0.

    Shape (2k, 2k), real. For a constant system the period is one revolution. With the steps that it
    takes, and a bound of the error of the matrix for the state ``(x · max|λ|, ẋ)``, Frobenius norm:
    twice what two numbers of steps tell, and rounding of every step.

    Raises
    ------
    ValueError
        At zero speed, which has no period.
    UnconvergedError
        If 2¹⁴ steps do not reach `tolerance`, relative to the largest entry for that state.
    """
    if system.speed == 0.0:
        raise ValueError("floquet: at 0 rad/s the coefficients have no period")
    period = 2.0 * np.pi / abs(system.base or system.speed)
    scale = _scale(system)
    fastest = scale[0]
    most = max(0.5 * fastest * period, _OF_A_WAVE * system.order / max(system.step, 1))
    steps = max(8, 2 ** int(np.ceil(np.log2(most + 1.0))))
    error, last = np.inf, None
    if 2 * steps > MOST_STEPS:  # the error is told by two solutions
        raise UnconvergedError(
            f"floquet at {system.speed:g} rad/s: the fastest motion, {fastest:.3g} 1/s, needs more "
            f"than {MOST_STEPS} steps a period; use method='hill', a larger speed (or 0), or fewer "
            "high modes"
        )
    while steps <= MOST_STEPS:
        with np.errstate(over="ignore", invalid="ignore"):
            fundamental = _magnus(system, period, steps)
        if not np.all(np.isfinite(fundamental)):
            break  # what grows exceeds the largest number within a period
        if last is not None:
            scaled, change = scale[:, None] * np.array([fundamental, fundamental - last]) / scale
            error = np.abs(change).max() / np.abs(scaled).max() / 63.0
            if error <= tolerance:
                rounding = steps * np.sqrt(len(scale)) * EPSILON * np.linalg.norm(scaled)
                return fundamental, steps, _MORE / 63.0 * np.linalg.norm(change) + rounding
        steps, last = 2 * steps, fundamental
    raise UnconvergedError(
        f"floquet at {system.speed:g} rad/s: error {error:.1e} with {MOST_STEPS} steps a period, "
        f"more than the tolerance {tolerance:.1e}; use method='hill', or fewer high modes"
    )


def _scale(system: PeriodicSystem) -> np.ndarray:
    """Return max|λ| at θ = 0 for x, 1 for ẋ, shape (2k,)."""
    fastest = np.abs(np.linalg.eigvals(state_matrix(*system.matrices(0.0)))).max()
    return np.repeat([fastest or 1.0, 1.0], system.size)


def _magnus(system: PeriodicSystem, period: float, steps: int, start: float = 0.0) -> np.ndarray:
    """Return the fundamental matrix from the angle `start` by sixth-order Magnus steps."""
    h = period / steps
    fundamental = np.eye(2 * system.size)
    nodes = 0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0])  # Gauss points
    brief = steps * (2 * system.size) ** 3 < _SHOWN_FROM
    for first in tqdm(range(0, steps, _CHUNK), desc="floquet", disable=brief, leave=False):
        starts = np.arange(first, min(first + _CHUNK, steps))
        angles = start + system.speed * h * (starts[None, :] + nodes[:, None])
        A1, A2, A3 = h * state_matrix(*sampled(system, angles))
        a1, a2, a3 = A2, np.sqrt(15.0) / 3.0 * (A3 - A1), 10.0 / 3.0 * (A3 - 2.0 * A2 + A1)
        c1 = _commutator(a1, a2)
        c2 = -_commutator(a1, 2.0 * a3 + c1) / 60.0
        exponent = a1 + a3 / 12.0 + _commutator(-20.0 * a1 - a3 + c1, a2 + c2) / 240.0
        for factor in scipy.linalg.expm(exponent):
            fundamental = factor @ fundamental
    return fundamental


def sampled(system: PeriodicSystem, angles: np.ndarray) -> list[np.ndarray]:
    """Return M, D, K at many angles, each (*angles.shape, k, k); a constant one as a view."""
    return [_at_angles(terms, angles) for terms in (system.M, system.D, system.K)]


def _at_angles(terms: Terms, angles: np.ndarray) -> np.ndarray:
    """Return ``X₀ + 2 Re Σ X_n exp(inθ)``, n > 0, at angles."""
    shape = *angles.shape, *terms[0].shape
    orders = [n for n in terms if n > 0]
    if not orders:
        return np.broadcast_to(terms[0].real, shape)
    turned = np.multiply.outer(angles, orders)
    waves = np.concatenate([2.0 * np.cos(turned), -2.0 * np.sin(turned)], axis=-1)
    parts = [X.ravel() for part in (np.real, np.imag) for X in map(part, map(terms.get, orders))]
    return terms[0].real + (waves @ np.array(parts)).reshape(shape)


def accelerations(system: PeriodicSystem, M: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """Return ``M⁻¹F`` of mass matrices (n, k, k) and forces (n, k, j) at angles."""
    if len(system.M) > 1:
        return np.linalg.solve(M, forces)
    count, size, _ = forces.shape
    flat = forces.transpose(1, 0, 2).reshape(size, -1)
    return np.linalg.solve(M[0], flat).reshape(size, count, -1).transpose(1, 0, 2)


def _commutator(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    return A @ B - B @ A


def floquet_motions(
    system: PeriodicSystem, tolerance: float = 1e-9
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the 2k exponents, the states (x, ẋ) at θ = 0 as columns, and bounds of the error.

    The bounds [1/s] are those of an eigenvalue of a matrix that errs by rounding, ``2kε`` of its
    norm, and by what :func:`monodromy` says, scaled as there, times its condition. Of two
    that nearly share their vector, g apart, a change δ has ``δ (δ + g)`` in the place of ``δ g``,
    which leaves the root. Of a multiplier that is smaller than its error δ the exponent is known
    from above alone: ``Re λ ≤ log(|μ| + δ)/T``.

    Raises
    ------
    UnconvergedError
        If none grows for sure, and it is not told whether another one does.
    """
    fundamental, _, error = monodromy(system, tolerance)
    return _motions_of(system, fundamental, error)


def _motions_of(
    system: PeriodicSystem, fundamental: np.ndarray, error: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return what :func:`floquet_motions` does, of a fundamental matrix with its error."""
    scale = _scale(system)
    scaled = scale[:, None] * fundamental / scale
    multipliers, states = np.linalg.eig(scaled)
    multipliers = np.where(multipliers == 0.0, _LEAST * np.abs(scaled).max(), multipliers)
    base = abs(system.base or system.speed)
    values = np.log(multipliers.astype(complex)) * base / (2.0 * np.pi)
    condition = np.linalg.norm(np.linalg.pinv(states), axis=1)
    moved = condition * (error + len(scale) * system.rounding * np.linalg.norm(scaled))
    apart = np.abs(multipliers[:, None] - multipliers) + np.diag(np.full(len(scale), np.inf))
    moved = np.minimum(moved, np.sqrt(moved * apart.min(axis=1)))
    relative, decays = moved / np.abs(multipliers), np.abs(multipliers) < 1.0
    bounds = np.where(decays, np.log1p(relative), relative) * base / (2.0 * np.pi)
    unknown = (np.abs(values.real) <= bounds) & (bounds > _TOLD * base)
    if np.any(unknown) and not np.any(values.real > bounds):
        raise UnconvergedError(
            f"floquet at {system.speed:g} rad/s: it is not told whether a motion grows: its "
            f"exponent may be off by {bounds[unknown].max():.1e} 1/s, as others change by many "
            "powers of ten within a turn; use a larger speed (or 0)"
        )
    return fold(values, base), states.astype(complex) / scale[:, None], bounds


def propagated(system: PeriodicSystem, tolerance: float) -> HillMotions:
    """Return the motions of Floquet's method as harmonics, one for each pair of exponents.

    ``x(t) exp(−λt)`` at angles of one period, twice as many until the harmonics die away. Of each
    motion the copy with the largest harmonic 0 is taken. Those that decay fast follow the
    fundamental matrix with its error; :func:`.remainder.checked` tells if that is too much.
    """
    fundamental, steps, error = monodromy(system, tolerance)
    values, states, bounds = _motions_of(system, fundamental, error)
    base = abs(system.base)
    count, tail = _SAMPLES, np.inf
    while tail > tolerance * _TAIL and 2 * count <= max(steps, 2 * _SAMPLES):
        count *= 2
        shapes = _harmonics(system, values, states, count, max(1, steps // count))
        sizes = np.linalg.norm(shapes, axis=1)
        tail = np.max((sizes[0] + sizes[-1]) / sizes.max(axis=0))
    middle = len(shapes) // 2
    orders = system.step * np.arange(-middle, middle + 1)
    central = np.argmax(np.linalg.norm(shapes, axis=1), axis=0) - middle
    values = values + 1j * system.base * central
    shapes = np.stack([shifted(shapes[..., j], n) for j, n in enumerate(central)], axis=-1)
    shapes = shapes / np.linalg.norm(shapes, axis=(0, 1))
    halves = values.imag / (0.5 * base)  # of negative and positive multipliers whole ones
    alone = np.abs(halves - np.rint(halves)) <= _WHOLE
    below = values.imag < 0.0
    kept = alone | ~below
    values = np.where(below, values.conj(), values)
    shapes = np.where(below, shapes[::-1].conj(), shapes)
    sizes = np.maximum(np.abs(values), base)
    none = np.zeros(len(values))
    found = HillMotions(values, shapes, orders, sizes, 0.0, bounds, none, {}, ~alone)
    return found.columns(np.flatnonzero(kept))


def _harmonics(
    system: PeriodicSystem, values: np.ndarray, states: np.ndarray, count: int, steps: int
) -> np.ndarray:
    """Return the harmonics (h, k, 2k) of motions with the states (2k, 2k) at θ = 0.

    From `count` angles of a period, `steps` apart.
    """
    times = 2.0 * np.pi / abs(system.base) / count * np.arange(count)
    now, at = states.astype(complex), []
    for time in times:
        at.append(now[: system.size] * np.exp(-values * time))
        now = _magnus(system, times[1], steps, system.speed * time) @ now
    found = np.fft.fftshift(np.fft.fft(np.array(at), axis=0), axes=0)[1:] / count
    return found if system.base > 0.0 else found[::-1]


def magnus_exponent(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Return the exponent of a Magnus step of fourth order; any leading dimensions.

    Of the rates times the step at :data:`GAUSS_POINTS` of it. Source: Blanes, Casas, Oteo, Ros,
    Phys. Rep. 470 (2009), Eq. (254).
    """
    return 0.5 * (A + B) - np.sqrt(3.0) / 12.0 * _commutator(A, B)


def state_matrix(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return A of ``ż = A z`` with ``z = (x, ẋ)``; any leading dimensions."""
    size = M.shape[-1]
    solved = np.linalg.solve(M, np.concatenate([K, D], axis=-1))
    return unit_state_matrix(solved[..., size:], solved[..., :size])


def unit_state_matrix(D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return what :func:`state_matrix` does for unit masses."""
    size = K.shape[-1]
    A = np.zeros((*np.broadcast_shapes(D.shape, K.shape)[:-2], 2 * size, 2 * size))
    A[..., :size, size:] = np.eye(size)
    A[..., size:, :size], A[..., size:, size:] = -K, -D
    return A
