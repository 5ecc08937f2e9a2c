"""Fourier terms of a scene's equations from their samples over a revolution."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from exudyn_rotor.linear.equations import Terms
from exudyn_rotor.linear.model.scene.equilibrium import NOISE
from exudyn_rotor.linear.model.scene.probe import LinearPoint

_CONVERGED = 1e-8  # share of the largest entry that the highest harmonics may have


def _scaled_samples(points: Sequence[LinearPoint]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the Fourier terms n of M, D, K, (n, k, k), and their largest entries as shares."""
    M, D, K = (np.array([point[i] for point in points]) for i in range(3))
    scale = 1.0 / np.sqrt(np.maximum(np.diag(M[0]), 1e-300))
    scale = np.outer(scale, scale)
    largest = [np.abs(X * scale).max() for X in (M, D, K)]
    largest[1] = max(largest[1], np.sqrt(largest[2]))
    for X, size in zip((M, D, K), largest, strict=True):
        spectrum = np.fft.fft(X, axis=0) / len(points)
        yield spectrum, np.abs(spectrum * scale).max(axis=(1, 2)) / size


def is_resolved(points: Sequence[LinearPoint]) -> bool:
    """Return whether the angles resolve the coefficients."""
    top = len(points) // 2
    return all(s[top - 1 : top + 2].max() <= _CONVERGED for _, s in _scaled_samples(points))


def hill_stiffness(points: Sequence[LinearPoint], orders: np.ndarray, speed: float) -> np.ndarray:
    """Return ``K + iΩmD − Ω²m²M`` between harmonics m, (h k, h k), as the sampled angles see it.

    The Fourier terms n and n + samples are the same there.
    """
    h, count, k = len(orders), len(points), len(points[0].M)
    apart = np.subtract.outer(orders, orders) % count
    rates = 1j * speed * orders
    total = np.zeros((h, k, h, k), dtype=complex)
    for power, (spectrum, shares) in zip((2, 1, 0), _scaled_samples(points), strict=True):
        spectrum[1:][shares[1:] <= NOISE] = 0.0
        total += np.einsum("abij,b->aibj", spectrum[apart], rates**power)
    return total.reshape(h * k, h * k)


def terms_of(samples: np.ndarray, scale: np.ndarray, least: float) -> Terms:
    """Return the Fourier terms of samples (n, k, k) that have more than a share of the largest.

    `scale` (k,) makes coordinates alike.
    """
    count, scale = len(samples), np.outer(scale, scale)
    spectrum = np.fft.fft(samples, axis=0) / count
    sizes = np.abs(spectrum * scale).max(axis=(1, 2))
    terms = {0: spectrum[0].real}
    for n in range(1, max(count // 2 - 1, 1)):
        if sizes[n] > least * np.abs(samples * scale).max():
            terms[n], terms[-n] = spectrum[n], spectrum[n].conj()
    return terms
