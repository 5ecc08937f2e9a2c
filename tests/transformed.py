"""Periodic systems with known exponents, by periodic coordinates of constant ones."""

import numpy as np

from exudyn_rotor.linear.periodic.companion import Companion
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem


def transformed(
    speed: float,
    damping: np.ndarray,
    stiffness: np.ndarray,
    shears: dict[int, np.ndarray],
    swell: float = 0.0,
    turns: int = 0,
) -> tuple[PeriodicSystem, np.ndarray]:
    """Return the equations of ``x = S(θ) y`` with ``ÿ + Cẏ + Ky = 0``, and the exponents of y.

    ``S = exp(a sin 2θ) T(θ) N(θ)``: T turns the first two coordinates by nθ, and N is one and a
    polynomial above its diagonal, which has an inverse of the same kind. With ``Z = S⁻¹`` it is
    ``ẍ + S (2Ż + CZ) ẋ + S (Z̈ + CŻ + KZ) x = 0``.

    Parameters
    ----------
    speed : float
    damping, stiffness : ndarray, shape (k, k)
        C and K.
    shears : mapping of int to ndarray, shape (k, k)
        Fourier terms n ≥ 0 of N; what is on or below their diagonals is not looked at.
    swell : float
        a.
    turns : int
        n.
    """
    size, count = len(stiffness), 64
    angles = 2.0 * np.pi * np.arange(count) / count
    one = np.eye(size)
    N = sum(
        np.real(np.exp(1j * n * angles)[:, None, None] * np.triu(X, 1)) for n, X in shears.items()
    )
    T = np.tile(one, (count, 1, 1))
    if size > 1 and turns:
        c, s = np.cos(turns * angles), np.sin(turns * angles)
        T[:, :2, :2] = np.moveaxis(np.array([[c, -s], [s, c]]), -1, 0)
    S = T @ (one + N)
    Z = np.linalg.inv(S)

    def rate(X: np.ndarray) -> np.ndarray:
        orders = np.fft.fftfreq(count, 1.0 / count)[:, None, None]
        return np.fft.ifft(1j * orders * speed * np.fft.fft(X, axis=0), axis=0).real

    # the swelling e^g is a number: of e^-g Z, Ż and Z̈ are Ż − ġZ and Z̈ − 2ġŻ + (ġ² − g̈)Z
    first = (2.0 * swell * speed * np.cos(2.0 * angles))[:, None, None]
    second = (-4.0 * swell * speed**2 * np.sin(2.0 * angles))[:, None, None]
    once = rate(Z) - first * Z
    twice = rate(rate(Z)) - 2.0 * first * rate(Z) + (first**2 - second) * Z
    system = PeriodicSystem(
        speed,
        {0: one},
        _terms(S @ (2.0 * once + damping @ Z)),
        _terms(S @ (twice + damping @ once + stiffness @ Z)),
    )
    return system, Companion.of(one, damping, stiffness).values()


def _terms(X: np.ndarray) -> dict[int, np.ndarray]:
    """Return the Fourier terms of samples of a polynomial, without those that are rounding."""
    found = np.fft.fft(X, axis=0) / len(X)
    least = 1e-14 * np.abs(found).max()
    kept = [n for n in range(1, len(X) // 2) if np.abs(found[n]).max() > least]
    terms = {n: found[n] for n in kept} | {-n: found[n].conj() for n in kept}
    return {0: found[0].real} | terms
