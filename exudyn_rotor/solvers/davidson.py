"""Lowest modes of ``K φ = ω² M φ`` by block Davidson iteration, without a factor of K."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from tqdm import tqdm

from exudyn_rotor.solvers.lanczos import Modes
from exudyn_rotor.solvers.rounding import rounding_unit

_BLOCKS = 3, 5  # of as many columns as modes are sought are kept, at least and at most
_ROOM = 1e9  # bytes of a basis; only the least number of blocks may take more
_MORE = 5  # modes are sought beside those that are wanted
_GUARDS = 2  # of them must nearly converge, so that none below is missed
_GUARD_MULTIPLE = 1e4
_RESIDUAL = 3e-7  # of ω² M φ, below what lanczos.check_modes allows
_ROUNDING_SHARE = 0.1
_MOST_STEPS = 300
_DEPENDENT = 1e-13
_SHOWN_FROM = 100_000  # coordinates
_SEED = 6


class ApproximateInverse(Protocol):
    """Approximate inverse of a stiffness on the motions that are allowed."""

    def precondition(self, load: np.ndarray) -> np.ndarray: ...
    def start(self, count: int) -> np.ndarray: ...


def davidson_modes(
    stiffness: sp.csr_array,
    mass: sp.csr_array,
    inverse: ApproximateInverse,
    count: int,
    tolerance: float,
    balanced: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Modes:
    """Return the `count` lowest modes by Davidson iteration with an approximate ``K⁻¹``.

    Parameters
    ----------
    stiffness, mass : scipy.sparse.csr_array, shape (n, n)
    inverse : InertiaRelief or ConstrainedInverse
        Its approximation ``precondition`` is used, and motions to ``start`` with.
    count : int
    tolerance : float
        Relative accuracy of the eigenvalues; their error is of second order in the residual.
    balanced : callable, optional
        Takes what reactions balance out of residuals (n, k).

    Returns
    -------
    eigenvalues : ndarray, shape (count,)
        ``ω²``, ascending [rad²/s²].
    modes : ndarray, shape (n, count)
        Mass-normalised.

    Raises
    ------
    ValueError
        If the iteration does not converge.

    Notes
    -----
    Restarts keep the latest Ritz vectors and those before them ("GD+k"): Stathopoulos, Saad,
    "Restarting techniques for the (Jacobi-)Davidson symmetric eigenvalue methods", ETNA 7 (1998).
    """
    size = stiffness.shape[0]
    sought = min(count + _MORE, size)
    first = inverse.start(sought)
    seeded = np.random.default_rng(_SEED).standard_normal((size, _GUARDS))
    first = inverse.precondition(mass @ np.hstack([first, seeded]))
    blocks = int(np.clip(_ROOM / (8.0 * size * sought), *_BLOCKS))
    space = _Space(stiffness, mass, first, max(blocks * sought, first.shape[1] + sought))
    unit = _ROUNDING_SHARE * rounding_unit(stiffness)
    share = min(_RESIDUAL, np.sqrt(tolerance))
    factors = np.where(np.arange(sought) < count, 1.0, _GUARD_MULTIPLE)[: count + _GUARDS]
    with tqdm(total=count, desc="modes", disable=size < _SHOWN_FROM, leave=False) as bar:
        for _ in range(_MOST_STEPS):
            values, modes, residual, inertia = space.lowest(sought)
            if balanced is not None:
                residual = balanced(residual)
            allowed = share * np.linalg.norm(inertia, axis=0)
            allowed = allowed + unit * np.linalg.norm(modes, axis=0)
            excess = np.linalg.norm(residual, axis=0) / allowed
            checked = excess[: factors.size] <= factors[: excess.size]
            bar.update(int(np.count_nonzero(checked[:count])) - bar.n)
            bar.set_postfix_str(f"residual {excess[:count].max():.0e} of the limit")
            if np.all(checked):
                return values[:count], modes[:, :count]
            space.extend(inverse.precondition(residual[:, excess > 1.0]))
    raise ValueError(
        f"only {np.count_nonzero(checked[:count])} of {count} modes converged in {_MOST_STEPS} "
        "steps; use rotor.with_solver('direct'), or a mesh with less flat elements"
    )


class _Space:
    """A mass-orthonormal basis that grows, with its products with K and M."""

    def __init__(self, stiffness, mass, columns: np.ndarray, limit: int) -> None:
        self._stiffness, self._mass = stiffness, mass
        self._basis, self._forces, self._momenta = (
            np.empty((len(columns), limit), order="F") for _ in range(3)
        )
        self._energy = np.zeros((limit, limit))
        self._count = 0
        self._latest = self._before = np.zeros((0, 0))
        self.extend(columns)

    def lowest(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return eigenvalues, modes, ``Kφ − ω²Mφ`` and ``ω²Mφ`` of the lowest Ritz vectors."""
        basis, forces, momenta = self._columns()
        values, turn = np.linalg.eigh(self._energy[: self._count, : self._count])
        values, turn = values[:count], turn[:, :count]
        self._before, self._latest = self._latest, turn
        inertia = (momenta @ turn) * values
        return values, basis @ turn, forces @ turn - inertia, inertia

    def extend(self, columns: np.ndarray) -> None:
        """Add columns, or what is new in them; restart where there is no room left."""
        if self._count + columns.shape[1] > self._basis.shape[1]:
            self._restart()
        new, momenta = self._orthonormal(columns / np.linalg.norm(columns, axis=0))
        added = slice(self._count, self._count + new.shape[1])
        self._basis[:, added], self._momenta[:, added] = new, momenta
        self._forces[:, added] = self._stiffness @ new
        self._count = added.stop
        energy = self._basis[:, : added.stop].T @ self._forces[:, added]
        self._energy[: added.stop, added], self._energy[added, : added.stop] = energy, energy.T

    def _columns(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        every = (self._basis, self._forces, self._momenta)
        return tuple(array[:, : self._count] for array in every)

    def _restart(self) -> None:
        before = np.zeros((len(self._latest), self._before.shape[1]))
        before[: len(self._before)] = self._before
        room = self._basis.shape[1] - self._latest.shape[1]
        kept, _ = np.linalg.qr(np.hstack([self._latest, before])[:, :room])
        for array in self._columns():
            array[:, : kept.shape[1]] = array @ kept
        energy = kept.T @ self._energy[: self._count, : self._count] @ kept
        self._count = kept.shape[1]
        self._energy[: self._count, : self._count] = energy
        self._latest = np.eye(self._count, self._latest.shape[1])

    def _orthonormal(self, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        basis, _, momenta = self._columns()
        weighted = self._mass @ columns
        for _ in range(2):
            share = momenta.T @ columns
            columns = columns - basis @ share
            weighted = weighted - momenta @ share
            gram = columns.T @ weighted
            scale = 1.0 / np.sqrt(np.diag(gram))
            values, turn = np.linalg.eigh(scale[:, None] * gram * scale)
            new = values > _DEPENDENT * values[-1]
            turn = (scale[:, None] * turn[:, new]) / np.sqrt(values[new])
            columns, weighted = columns @ turn, weighted @ turn
        return columns, weighted
