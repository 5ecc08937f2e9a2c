"""Inverse iteration on both sides for eigenvalues of ``λ²M + λD + K`` near known motions."""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import zgetrf, zgetrs

# relative distance from an eigenvalue that keeps its matrix invertible
OFF_ROOT = 1e-9
_MOST_STEPS = 5


def root_near(
    constant: np.ndarray,
    linear: np.ndarray,
    square: np.ndarray,
    right: np.ndarray,
    left: np.ndarray,
) -> tuple[complex, np.ndarray, np.ndarray]:
    """Return δ of ``(constant + δ linear + δ² square) z = 0`` with z and the left vector w.

    By one inverse iteration, ``z = constant⁻¹ right`` and ``w = constant⁻ᴴ left``, and the root
    of ``wᴴ(…)z = 0`` next to zero; NaN where the matrix is singular.
    """
    # LAPACK itself: with so many small matrices scipy's checks would take longer
    lu, pivots, singular = zgetrf(constant)
    if singular:
        return np.nan, right, left
    z, _ = zgetrs(lu, pivots, right)
    w, _ = zgetrs(lu, pivots, left, trans=2)
    a, b, c = np.vdot(w, square @ z), np.vdot(w, linear @ z), np.vdot(w, right)
    root = np.sqrt(b**2 - 4.0 * a * c + 0j)
    return -2.0 * c / max(b + root, b - root, key=abs) if c != 0.0 else 0.0, z, w


def settled(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, value: complex, x: np.ndarray, limit: float
) -> tuple[complex, np.ndarray, np.ndarray] | None:
    """Return the eigenvalue of ``λ²M + λD + K`` near `value`, with its right and left vector.

    Begins with a vector x and ends with the first step below `limit` [1/s]; as convergence is
    cubic, the error is far smaller then. None where that takes more than five steps.
    """
    left = M @ x
    for _ in range(_MOST_STEPS):
        shifted = value * (1.0 + OFF_ROOT)
        linear = 2.0 * shifted * M + D
        dynamic = shifted * (shifted * M + D) + K
        move, z, w = root_near(dynamic, linear, M, linear @ x, left)
        if not np.isfinite(move):
            return None
        last, value = value, shifted + move
        x, w = z / np.linalg.norm(z), w / np.linalg.norm(w)
        if abs(value - last) <= limit:
            return value, x, w
        left = linear.conj().T @ w
    return None
