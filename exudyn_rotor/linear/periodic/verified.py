"""Exponents whose growth is rounding, found out by their own motion.

Beside stiff supports, rounding of ``ε ω_max`` and more gives eigenvalues of slow motions a real
part. An eigenvector x turns ``λ²M + λD + K`` into the scalar equation

    a λ² + (d + i g) λ + (k + i s) = 0,    a = xᴴMx,
    d = xᴴD₊x,  g = Im xᴴD₋x,  k = xᴴK₊x,  s = Im xᴴK₋x,

with the symmetric (+) and skew (−) parts of D and K. Without damping (d = 0) and circulatory forces
(s = 0) its roots are imaginary to the last digit while ``g² + 4ak ≥ 0``, however wrong x is. Only k
suffers from rounding next to stiff supports, by ``n ε |x|ᵀ|K₊||x|`` at most.
"""

from __future__ import annotations

import cmath

import numpy as np

from exudyn_rotor.linear.periodic.eigenvalues import inverse_iterated
from exudyn_rotor.linear.periodic.hill import hill_matrices
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem


def verified(
    values: np.ndarray, limits: np.ndarray, system: PeriodicSystem, orders: np.ndarray | None = None
) -> np.ndarray:
    """Return exponents; where growth above the limit is rounding, that of the scalar equation.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Exponents [1/s].
    limits : ndarray, shape (n,)
        Growth that is not looked at [1/s].
    system : PeriodicSystem
    orders : ndarray of int, optional
        Harmonics by which exponents of a periodic system were found, not folded; Hill's matrices
        of a system without damping have the same symmetries.
    """
    growing = np.flatnonzero(values.real > limits)
    if growing.size == 0:
        return values
    periodic = orders is not None and len(orders) > 1
    matrices = hill_matrices(system, orders) if periodic else system.matrices(0.0)
    result = values.astype(complex)
    start = np.ones((len(matrices[0]), growing.size))
    motions = inverse_iterated(values[growing], start, *matrices)
    for index, x in zip(growing, motions.T, strict=True):
        checked = _by_its_motion(values[index], x, *matrices)
        if checked.real <= limits[index]:
            result[index] = checked
    return result


def _by_its_motion(
    value: complex, x: np.ndarray, M: np.ndarray, D: np.ndarray, K: np.ndarray
) -> complex:
    """Return the root next to `value` of the scalar equation, with the most favourable rounding."""
    stiff = 0.5 * (K + K.conj().T)
    a = np.vdot(x, M @ x).real
    damping = np.vdot(x, 0.5 * (D + D.conj().T) @ x).real
    b = damping + 1j * np.vdot(x, 0.5 * (D - D.conj().T) @ x).imag
    k = np.vdot(x, stiff @ x).real
    rounding = len(x) * np.finfo(float).eps * float(np.abs(x) @ np.abs(stiff) @ np.abs(x))
    c = k + 1j * np.vdot(x, 0.5 * (K - K.conj().T) @ x).imag
    roots = [_nearest_root(a, b, c + shift, value) for shift in (0.0, rounding)]
    return min(roots, key=lambda root: root.real)


def _nearest_root(a: float, b: complex, c: complex, value: complex) -> complex:
    """Return the root of ``aλ² + bλ + c`` next to `value`."""
    width = cmath.sqrt(b * b - 4.0 * a * c)
    return min(((-b + sign * width) / (2.0 * a) for sign in (1, -1)), key=lambda x: abs(x - value))
