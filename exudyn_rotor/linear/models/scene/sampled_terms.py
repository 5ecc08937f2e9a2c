"""Fourier terms of a scene's equations from their samples over a revolution."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from exudyn_rotor.linear.models.scene.equilibrium import NOISE
from exudyn_rotor.linear.models.scene.probe import LinearPoint
from exudyn_rotor.linear.periodic.periodic_system import Terms

_CONVERGED = 1e-8  # share of the largest entry that the highest harmonics may have


def scaled_samples(points: list[LinearPoint]) -> Iterator[tuple[np.ndarray, np.ndarray, float]]:
    """Yield samples of M, D, K (n, k, k), the scale of coordinates, and what counts as zero."""
    M, D, K = (np.array([point[i] for point in points]) for i in range(3))
    scale = 1.0 / np.sqrt(np.maximum(np.diag(M[0]), 1e-300))
    largest = [np.abs(X * np.outer(scale, scale)).max() for X in (M, D, K)]
    largest[1] = max(largest[1], np.sqrt(largest[2]))
    for X, size in zip((M, D, K), largest, strict=True):
        yield X, scale, size


def fourier_terms(points: list[LinearPoint]) -> tuple[list[Terms], bool]:
    """Return the Fourier terms of M, D, K, and whether the samples resolve them."""
    found = [_fourier_terms(*entry) for entry in scaled_samples(points)]
    return [terms for terms, _ in found], all(resolved for _, resolved in found)


def _fourier_terms(samples: np.ndarray, scale: np.ndarray, largest: float) -> tuple[Terms, bool]:
    """Return the Fourier terms of samples over a revolution, and whether these resolve it."""
    count = len(samples)
    spectrum = np.fft.fft(samples, axis=0) / count
    sizes = np.abs(spectrum * np.outer(scale, scale)).max(axis=(1, 2))
    top = count // 2
    resolved = bool(sizes[top - 1 : top + 2].max() <= _CONVERGED * largest)
    terms = {0: spectrum[0].real}
    for n in range(1, top - 1):
        if sizes[n] > NOISE * largest:
            terms[n], terms[-n] = spectrum[n], spectrum[n].conj()
    return terms, resolved


def terms_at_angles(points: list[LinearPoint], orders: np.ndarray) -> list[dict[int, np.ndarray]]:
    """Return the terms of M, D, K between harmonics of `orders` as the sampled angles see them.

    The Fourier terms n and n + samples are the same there.
    """
    count, reach = len(points), range(2 * orders[0], 2 * orders[-1] + 1)
    terms = []
    for X, scale, size in scaled_samples(points):
        spectrum = np.fft.fft(X, axis=0) / count
        kept = np.abs(spectrum * np.outer(scale, scale)).max(axis=(1, 2)) > NOISE * size
        kept[0] = True
        terms.append({n: spectrum[n % count] for n in reach if kept[n % count]})
    return terms
