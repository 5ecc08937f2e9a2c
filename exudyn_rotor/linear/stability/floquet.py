"""Exponents of a linear system with constant or periodic coefficients.

A solution of ``M(θ)ẍ + D(θ)ẋ + K(θ)x = 0`` with θ = Ωt is ``x(t) = exp(λt) p(t)`` with p of the
coefficients' period T. The 2k exponents λ are determined but for multiples of ``i 2π/T``; the
multipliers ``exp(λT)`` are the eigenvalues of the fundamental matrix over one period. Sources:
Floquet, Ann. sci. É.N.S. 12 (1883); Hill, Acta Math. 8 (1886); for rotors Friswell, Penny, Garvey,
Lees, Dynamics of Rotating Machines (2010), Sect. 7.

Two independent ways for periodic systems:

Hill
    A constant eigenvalue problem for the harmonics of p. Of the copies ``λ + i n 2π/T`` it returns
    the most central one is kept; the coupling to the first harmonics left out gives the error.
Floquet
    The fundamental matrix by a sixth-order Magnus series and matrix exponentials, the number of
    steps doubled until it no longer changes. Source: Blanes, Casas, Oteo, Ros, Phys. Rep. 470
    (2009), Eq. (253). Strongly damped exponents lose digits: their multipliers are tiny.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from exudyn_rotor.linear.equations.hill import harmonic_step, harmonics, hill_matrices
from exudyn_rotor.linear.equations.system import PeriodicSystem

MOST_STEPS = 2**14
MOST_UNKNOWNS = 1600  # of Hill's problem in first-order form
_CHUNK = 128


class UnconvergedError(ValueError):
    """A truncation does not reach the tolerance asked for."""


def base_frequency(system: PeriodicSystem) -> float:
    """Return 2π/T of the coefficients [rad/s]: pΩ with p the step of their harmonics; 0: constant.

    For anisotropic supports p = 2: they repeat every half revolution.
    """
    return harmonic_step(system) * system.speed


def fold(exponents: np.ndarray, base: float) -> np.ndarray:
    """Bring imaginary parts into (−base/2, base/2]; no change for ``base = 0``."""
    if base == 0.0:
        return exponents
    return exponents - 1j * base * np.ceil(exponents.imag / base - 0.5)


def constant_exponents(system: PeriodicSystem) -> np.ndarray:
    """Return the 2k eigenvalues of ``λ²M + λD + K`` with the matrices at θ = 0 [1/s]."""
    return np.linalg.eigvals(_state_matrix(*system.matrices(0.0)))


def _state_matrix(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return A of ``ż = A z`` with ``z = (x, ẋ)``; any leading dimensions."""
    size = M.shape[-1]
    A = np.zeros((*np.broadcast_shapes(M.shape, D.shape, K.shape)[:-2], 2 * size, 2 * size))
    A[..., :size, size:] = np.eye(size)
    A[..., size:, :] = -np.linalg.solve(M, np.concatenate([K, D], axis=-1))
    return A


def hill_exponents(system: PeriodicSystem, tolerance: float = 1e-9) -> tuple[np.ndarray, float]:
    """Return the 2k exponents by Hill's method [1/s], and their truncation error.

    Harmonics are added until the error, relative to Ω, is below `tolerance`.

    Raises
    ------
    UnconvergedError
        If that takes more than 1600 unknowns.
    """
    step = harmonic_step(system)
    order, error = 2 * step, np.inf
    while True:
        orders = harmonics(system, order)
        unknowns = 2 * len(orders) * system.size
        if unknowns > MOST_UNKNOWNS and order > 2 * step:
            raise UnconvergedError(
                f"Hill's method at {system.speed:g} rad/s: error {error:.1e} with harmonics up to "
                f"{order - step}, more than the tolerance {tolerance:.1e}"
            )
        values, error = _hill_once(system, orders, step)
        if error <= tolerance:
            return fold(values, step * system.speed), error
        order += step * max(1, order // (2 * step))


def _hill_once(system: PeriodicSystem, orders: np.ndarray, step: int) -> tuple[np.ndarray, float]:
    """Solve one truncation; an infinite error says that the central copies are not clear yet."""
    u = _real_basis(len(orders))
    matrices = [_turned(X, u) for X in hill_matrices(system, orders)]
    A = _state_matrix(*matrices)
    values, vectors = np.linalg.eig(A)
    half = len(A) // 2
    shapes = np.einsum("nh,nkj->hkj", u.conj(), vectors[:half].reshape(len(orders), -1, 2 * half))
    chosen = _central(shapes, orders, step, 2 * system.size)
    if chosen is None:
        return values, np.inf
    left = _inverse(vectors)[chosen, half:]
    values, shapes = values[chosen], shapes[:, :, chosen]
    feedback = _feedback(system, values, shapes, orders)
    load = np.einsum("nh,hkj->nkj", u, feedback).reshape(half, -1)
    shift = np.einsum("jr,rj->j", left, np.linalg.solve(matrices[0], load))
    return values, float(np.abs(shift).max() / system.speed)


def _inverse(vectors: np.ndarray) -> np.ndarray:
    """Return the left eigenvectors as rows; rigid motions can make the vectors dependent."""
    try:
        return np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        return np.linalg.pinv(vectors)


def _real_basis(count: int) -> np.ndarray:
    """Return the unitary matrix from harmonics −N … N to cosine and sine terms.

    In these Hill's matrices are real, which is three times faster to solve.
    """
    middle = count // 2
    u = np.zeros((count, count), dtype=complex)
    u[middle, middle] = 1.0
    for n in range(1, middle + 1):
        u[middle + n, [middle + n, middle - n]] = np.sqrt(0.5)
        u[middle - n, [middle + n, middle - n]] = -1j * np.sqrt(0.5), 1j * np.sqrt(0.5)
    return u


def _turned(matrix: np.ndarray, u: np.ndarray) -> np.ndarray:
    count, size = len(u), len(matrix) // len(u)
    blocks = matrix.reshape(count, size, count, size)
    turned = np.tensordot(u, np.tensordot(blocks, u.conj(), (2, 1)), (1, 0))  # n, a, b, m
    return turned.transpose(0, 1, 3, 2).reshape(matrix.shape).real


def _central(shapes: np.ndarray, orders: np.ndarray, step: int, count: int) -> np.ndarray | None:
    """Return which solutions are the most central copies, one of each; None where unclear.

    The mean harmonic of a copy shifts by the step p from copy to copy, so every interval of that
    length holds each exponent once; it begins in the widest gap near −p/2.
    """
    weights = np.sum(np.abs(shapes) ** 2, axis=1)
    means = orders @ weights / np.sum(weights, axis=0)
    inner = np.sort(np.mod(means[np.abs(means) < step], step))
    if inner.size == 0:
        return None
    gaps = np.diff(inner, append=inner[0] + step)
    middles = inner + 0.5 * gaps
    distance = np.abs(np.mod(middles, step) - 0.5 * step)
    end = np.mod(middles[np.argmax(gaps - 0.5 * distance)], step)
    chosen = np.flatnonzero((means > end - step) & (means <= end))
    return chosen if len(chosen) == count else None


def _feedback(
    system: PeriodicSystem, values: np.ndarray, shapes: np.ndarray, orders: np.ndarray
) -> np.ndarray:
    """Return what the first harmonics left out, once excited, do to those kept; as `shapes`."""
    highest, result = orders[-1], np.zeros_like(shapes)
    terms = (system.M, system.D, system.K)
    reach = range(highest + 1, highest + system.order + 1)
    for n in [*reach, *(-m for m in reach)]:
        links = {m: _links(terms, n - orders[m]) for m in range(len(orders))}
        excited = 0.0
        for m, (M, D, K) in ((m, link) for m, link in links.items() if link is not None):
            excited = excited + _applied(M, D, K, values + 1j * orders[m] * system.speed, shapes[m])
        if np.ndim(excited) == 0:
            continue
        rate = (values + 1j * n * system.speed)[:, None, None]
        own = rate**2 * system.M[0] + rate * system.D[0] + system.K[0]
        answer = -np.linalg.solve(own, excited.T[:, :, None])[:, :, 0].T
        for m in range(len(orders)):
            back = _links(terms, orders[m] - n)
            if back is not None:
                result[m] += _applied(*back, values + 1j * n * system.speed, answer)
    return result


def _links(terms: tuple, n: int) -> tuple | None:
    """Return the Fourier terms n of M, D, K; None where there is none."""
    found = [X.get(int(n)) for X in terms]
    return None if all(X is None for X in found) else tuple(0.0 if X is None else X for X in found)


def _applied(M, D, K, rate: np.ndarray, shape: np.ndarray) -> np.ndarray:
    """Return ``(λ²M + λD + K) X`` column by column; absent matrices are 0.0."""
    parts = ((M, shape * rate**2), (D, shape * rate), (K, shape))
    return sum(X @ column for X, column in parts if np.ndim(X))


def monodromy(system: PeriodicSystem, tolerance: float = 1e-9) -> np.ndarray:
    """Return the fundamental matrix of (x, ẋ) over one period of the coefficients, from θ = 0.

    Shape (2k, 2k), real. For a constant system the period is one revolution.

    Raises
    ------
    ValueError
        At zero speed, which has no period.
    UnconvergedError
        If 2¹⁴ steps do not reach `tolerance`, relative to the largest entry in the state
        ``(x · max|λ|, ẋ)``.
    """
    if system.speed == 0.0:
        raise ValueError("floquet: at 0 rad/s the coefficients have no period")
    period = 2.0 * np.pi / abs(base_frequency(system) or system.speed)
    fastest = np.abs(constant_exponents(system)).max()
    scale = np.repeat([fastest or 1.0, 1.0], system.size)
    steps = max(8, 2 ** int(np.ceil(np.log2(0.5 * fastest * period + 1.0))))
    error, last = np.inf, None
    while steps <= MOST_STEPS:
        fundamental = _magnus(system, period, steps)
        if last is not None:
            scaled = scale[:, None] * np.array([fundamental, fundamental - last]) / scale
            error = np.abs(scaled[1]).max() / np.abs(scaled[0]).max() / 63.0
            if error <= tolerance:
                return fundamental
        steps, last = 2 * steps, fundamental
    raise UnconvergedError(
        f"floquet at {system.speed:g} rad/s: error {error:.1e} with {MOST_STEPS} steps a period, "
        f"more than the tolerance {tolerance:.1e}; use method='hill', or fewer high modes"
    )


def _magnus(system: PeriodicSystem, period: float, steps: int) -> np.ndarray:
    """Return the fundamental matrix by `steps` sixth-order Magnus steps."""
    h = period / steps
    fundamental = np.eye(2 * system.size)
    nodes = 0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0])  # Gauss points
    for first in range(0, steps, _CHUNK):
        starts = np.arange(first, min(first + _CHUNK, steps))
        angles = system.speed * h * (starts[None, :] + nodes[:, None])
        A1, A2, A3 = h * _state_matrix(*_sampled(system, angles))
        a1, a2, a3 = A2, np.sqrt(15.0) / 3.0 * (A3 - A1), 10.0 / 3.0 * (A3 - 2.0 * A2 + A1)
        c1 = _commutator(a1, a2)
        c2 = -_commutator(a1, 2.0 * a3 + c1) / 60.0
        exponent = a1 + a3 / 12.0 + _commutator(-20.0 * a1 - a3 + c1, a2 + c2) / 240.0
        for factor in scipy.linalg.expm(exponent):
            fundamental = factor @ fundamental
    return fundamental


def _sampled(system: PeriodicSystem, angles: np.ndarray) -> list[np.ndarray]:
    """Return M, D, K at many angles, each (*angles.shape, k, k)."""
    return [
        sum(np.exp(1j * n * angles)[..., None, None] * X for n, X in terms.items()).real
        for terms in (system.M, system.D, system.K)
    ]


def _commutator(A: np.ndarray, B: np.ndarray) -> np.ndarray:
    return A @ B - B @ A


def floquet_exponents(system: PeriodicSystem, tolerance: float = 1e-9) -> np.ndarray:
    """Return the 2k exponents from the fundamental matrix [1/s], see :func:`monodromy`."""
    multipliers = np.linalg.eigvals(monodromy(system, tolerance)).astype(complex)
    base = base_frequency(system) or system.speed
    return fold(np.log(multipliers) * abs(base) / (2.0 * np.pi), abs(base))
