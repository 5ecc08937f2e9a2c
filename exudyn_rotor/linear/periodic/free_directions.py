"""Directions that nothing resists: no stiffness, no damping, no gyroscopic force.

With ``Kf = Df = 0`` and ``fᵀK = fᵀD = 0`` at all angles, ``λ²fᵀMx = 0`` for every motion: those
with λ ≠ 0 are mass-orthogonal to f, and f itself has λ = 0 twice, with ``x = f`` and ``x = t f``.
Without these directions the equations of all other motions are complete. With them an eigenvalue
problem has a Jordan block at zero: rounding splits it by its root, and mixes f into slow motions,
as those that a rotor at its critical speed sees at rest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.periodic.companion import rounding_of
from exudyn_rotor.linear.periodic.periodic_system import (
    EPSILON,
    ConstantSystems,
    PeriodicSystem,
    Terms,
)

# share of a matrix's rounding that is none: a smaller λ² would be zero in any case
_NOTHING = 0.5
_GROUPS = 3  # of systems with free directions of their own


class FreeDirections(NamedTuple):
    """Directions that nothing resists, and all others.

    Attributes
    ----------
    free : ndarray, shape (k, f)
        Columns of unit length.
    others : ndarray, shape (k, k − f)
        Mass-orthogonal to these.
    """

    free: np.ndarray
    others: np.ndarray

    @classmethod
    def of(cls, system: PeriodicSystem) -> FreeDirections | None:
        """Return those of one system at all angles; None where there are none."""
        M, D, K = (np.array(list(_parts(terms))) for terms in (system.M, system.D, system.K))
        axes = _axes_of(M[0])
        return None if axes is None else _apart(M[0], axes, (K, D, M[1:]), system.rounding)


def parted(
    systems: ConstantSystems,
) -> Iterator[tuple[np.ndarray, ConstantSystems, FreeDirections | None]]:
    """Yield which systems have the same free directions, these without them, and the directions.

    The systems have one mass matrix. At rest more may be free than where gyroscopic forces act: the
    one of the smallest damping matrix is looked at first.
    """
    M, D, K = systems.M[0], systems.D, systems.K
    left, axes = np.argsort(np.linalg.norm(D, axis=(1, 2)), kind="stable"), _axes_of(M)
    for _ in range(_GROUPS if axes is not None else 0):
        first = left[:1]
        apart = _apart(M, axes, (K[first], D[first]), systems.rounding)
        if apart is None:
            break
        alike = np.ones(len(left), dtype=bool)
        for X in (K[left], D[left]):
            alike &= _forces(X, apart.free, axes) <= _noise(X, axes, systems.rounding)
        alike[0] = True
        same, left = np.sort(left[alike]), left[~alike]
        few = ConstantSystems(systems.M, D[same], K[same], systems.rounding)
        yield same, few.projected(apart.others), apart
        if not left.size:
            return
    left = np.sort(left)
    yield left, ConstantSystems(systems.M, D[left], K[left], systems.rounding), None


def _parts(terms: Terms) -> Iterator[np.ndarray]:
    """Yield the parts of all Fourier terms, that of the mean first."""
    yield terms[0].real
    for n, X in terms.items():
        if n > 0:
            yield X.real
            yield X.imag


def _axes_of(M: np.ndarray) -> np.ndarray | None:
    """Return ``L⁻ᵀ`` with ``M = LLᵀ``; None where that fails, which who solves tells about."""
    try:
        return np.linalg.inv(np.linalg.cholesky(M)).T
    except np.linalg.LinAlgError:
        return None


def _noise(X: np.ndarray, axes: np.ndarray, rounding: float) -> float:
    """Return what counts as nothing beside the largest of matrices (n, k, k), per unit mass."""
    largest = X[np.argmax(np.linalg.norm(X, axis=(1, 2)))]
    return _NOTHING * float(rounding_of(largest, axes, rounding))


def _forces(X: np.ndarray, free: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Return the size of what matrices (n, k, k) do at directions, from either side, (n,)."""
    free = free / np.linalg.norm(np.linalg.solve(axes, free), axis=0)
    sides = (axes.T @ (Y @ free) for Y in (X, X.swapaxes(1, 2)))
    return np.max([np.linalg.norm(Y, axis=(1, 2)) for Y in sides], axis=0)


def _apart(
    M: np.ndarray, axes: np.ndarray, given: Sequence[np.ndarray], rounding: float
) -> FreeDirections | None:
    """Return the directions that none of the matrices (n, k, k) acts on, and the others."""
    acting = []
    for X in given:
        X = X[np.any(X, axis=(1, 2))]
        if len(X):
            noise = _noise(X, axes, rounding)
            acting += [axes.T @ Y @ axes / noise for each in X for Y in _sides(each)]
    if not all(np.all(np.isfinite(X)) for X in acting):
        return None
    rows, held = np.eye(len(M)), 0
    if acting:
        _, sizes, rows = np.linalg.svd(np.vstack(acting), full_matrices=False)
        held = np.count_nonzero(sizes > 1.0)
    if held == len(M):
        return None
    free = axes @ rows[held:].T
    return FreeDirections(free / np.linalg.norm(free, axis=0), _orthogonal(M, free))


def _sides(X: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return a matrix, and its transpose where that is another."""
    return (X,) if np.array_equal(abs(X), abs(X.T)) else (X, X.T)


def _orthogonal(M: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Return columns mass-orthogonal to some: unit coordinates, with as many others as it takes.

    So what is apart in the equations stays apart.
    """
    size, count = free.shape
    momenta = free.T @ M
    order = la.qr(momenta, mode="r", pivoting=True)[1]
    taken, kept = order[:count], np.sort(order[count:])
    shares = -la.solve(momenta[:, taken], momenta[:, kept])
    others = np.zeros((size, size - count))
    others[kept, np.arange(size - count)] = 1.0
    others[taken] = np.where(np.abs(shares) > size * EPSILON, shares, 0.0)
    return others
