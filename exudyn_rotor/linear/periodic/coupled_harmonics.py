"""Forced harmonics that only some motions of the coordinates couple, in a small part of the time.

The equations of harmonics n are ``A_n X_n + B Σ_m c_nm BᵀX_m = F_n``, where coefficients that are
not constant act on the motions B alone (:attr:`.PeriodicSystem.ports`): those of supports, of a
foundation, not of all modes. With ``v_n = BᵀX_n``

    v_n + Σ_m BᵀA_n⁻¹B c_nm v_m = BᵀA_n⁻¹F_n,    X_n = A_n⁻¹ (F_n − B Σ_m c_nm v_m)

so that no matrix is larger than one harmonic, or the motions B of all. Source: Woodbury's formula,
Golub, Van Loan, Matrix Computations (2013), Sect. 2.1.4. Where an ``A_n`` is closer to singular
than the whole, that loses digits: a solution holds where its residual is rounding. The condition is
that of LAPACK's estimate; source: Higham, Accuracy and Stability of Numerical Algorithms (2002),
Sect. 15.3.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.periodic.periodic_system import EPSILON, PeriodicSystem

Applied = Callable[[np.ndarray], np.ndarray]

# unknowns from which on the equations as one matrix take longer
_LARGE = 150
_MOST_STEPS = 3  # that refine a solution
# times the rounding of one operation that a residual may be
_RESIDUAL = 10.0
_ESTIMATES = 5  # of a norm


def worth_it(system: PeriodicSystem, count: int) -> bool:
    """Return whether so many harmonics are solved faster by what couples them."""
    # of constant coefficients nothing couples them, and LAPACK has no factor of an empty matrix
    return count * system.size >= _LARGE and 0 < 2 * system.ports.shape[1] <= system.size


def links_of(system: PeriodicSystem, orders: np.ndarray, rate: float) -> np.ndarray:
    """Return what couples harmonics ``exp(i(ω + nΩ)t)`` of one system, shape (h, p, h, p)."""
    count, size = len(orders), system.size
    links = np.zeros((count, size, count, size), dtype=complex)
    apart = orders[:, None] - orders
    for n in np.unique(apart[apart != 0]).tolist():
        rows, columns = np.nonzero(apart == n)
        blocks = system.dynamic(n, 1j * (rate + orders[columns] * system.speed))
        if blocks is not None:
            links[rows, :, columns] = blocks
    return links


def inverted(matrices: np.ndarray) -> np.ndarray:
    """Return inverses (h, k, k); infinite where one is singular."""
    try:
        return np.linalg.inv(matrices)
    except np.linalg.LinAlgError:
        return np.full(matrices.shape, np.inf, dtype=complex)


@dataclass(frozen=True, eq=False)
class CoupledHarmonics:
    """The equations of some harmonics, in scaled unknowns.

    Attributes
    ----------
    matrices, inverses : ndarray, shape (h, k, k)
        A_n.
    ports : ndarray, shape (h, k, p)
        B, without the coordinates that are held in a harmonic.
    links : ndarray, shape (h, p, h, p)
        c_nm.
    """

    matrices: np.ndarray
    inverses: np.ndarray
    ports: np.ndarray
    links: np.ndarray

    def solved(self, loads: np.ndarray) -> tuple[np.ndarray, float] | None:
        """Return the harmonics (h, k) under loads (h, k), and the reciprocal condition number.

        None where rounding leaves more than it leaves of a solution as one matrix.
        """
        loads = loads[..., None]
        if not np.all(np.isfinite(self.inverses)) or self._whole is None:
            return None
        found, norm = self._applied(loads), self._norm
        for _ in range(_MOST_STEPS):
            rest = loads - self._forces(found)
            least = norm * np.abs(found).max() + np.abs(loads).max()
            if np.abs(rest).max() <= _RESIDUAL * EPSILON * least:
                size = self.matrices.shape[0] * self.matrices.shape[1]
                inverse = norm_of_inverse(self._flat(self._applied), self._flat(self._back), size)
                return found[..., 0], float(1.0 / (norm * inverse))
            found = found + self._applied(rest)
        return None

    @cached_property
    def _answers(self) -> np.ndarray:
        """``A_n⁻¹B``, shape (h, k, p)."""
        return self.inverses @ self.ports

    @cached_property
    def _coupling(self) -> np.ndarray:
        """The links as one matrix, shape (h p, h p)."""
        count = self.links.shape[0] * self.links.shape[1]
        return self.links.reshape(count, count)

    @cached_property
    def _whole(self) -> tuple[np.ndarray, np.ndarray] | None:
        """The factor of the equations of ``v``; None where they are singular."""
        at_ports = self.ports.swapaxes(1, 2) @ self._answers
        matrix = np.einsum("npq,nqmr->npmr", at_ports, self.links).reshape(self._coupling.shape)
        matrix[np.diag_indices_from(matrix)] += 1.0
        factor, pivots, singular = la.lapack.zgetrf(matrix)
        return None if singular or not np.all(np.isfinite(factor)) else (factor, pivots)

    @cached_property
    def _norm(self) -> float:
        """A bound of the largest sum of a column."""
        own = np.abs(self.matrices).sum(axis=1)
        amounts = np.abs(self.ports)
        count = amounts.sum(axis=1).ravel() @ np.abs(self._coupling)
        beside = np.einsum("nkp,np->nk", amounts, count.reshape(len(own), -1))
        return float((own + beside).max())

    def _linked(self, motions: np.ndarray, coupling: np.ndarray) -> np.ndarray:
        """Return ``B Σ_m c_nm v_m`` of motions v (h, p, 1)."""
        return self.ports @ (coupling @ motions.ravel()).reshape(motions.shape)

    def _forces(self, x: np.ndarray) -> np.ndarray:
        """Return what harmonics (h, k, 1) need as loads."""
        return self.matrices @ x + self._linked(self.ports.swapaxes(1, 2) @ x, self._coupling)

    def _applied(self, loads: np.ndarray) -> np.ndarray:
        """Return the harmonics (h, k, 1) under loads, but for rounding."""
        alone = self.inverses @ loads
        at_ports = self.ports.swapaxes(1, 2) @ alone
        v = la.lapack.zgetrs(*self._whole, at_ports.ravel())[0].reshape(at_ports.shape)
        return alone - self.inverses @ self._linked(v, self._coupling)

    def _back(self, motions: np.ndarray) -> np.ndarray:
        """Return what the adjoint of the inverse makes of motions (h, k, 1)."""
        alone = _adjoint(self.inverses) @ motions
        forces = self._coupling.conj().T @ (self.ports.swapaxes(1, 2) @ alone).ravel()
        v = la.lapack.zgetrs(*self._whole, forces, trans=2)[0].reshape(len(alone), -1, 1)
        return alone - _adjoint(self.inverses) @ (self.ports @ v)

    def _flat(self, function: Applied) -> Applied:
        shape = *self.matrices.shape[:2], 1
        return lambda x: function(x.reshape(shape)).ravel()


def norm_of_inverse(applied: Applied, adjoint: Applied, size: int) -> float:
    """Return an estimate, from below, of the largest sum of a column of a matrix.

    Parameters
    ----------
    applied, adjoint : callable
        The matrix and its adjoint, of vectors (size,).
    size : int
    """
    places = np.arange(size)
    found = applied(np.full(size, 1.0 / size, dtype=complex))
    norm, last = np.abs(found).sum(), -1
    for _ in range(_ESTIMATES):
        sizes = np.abs(found)
        steepest = np.abs(adjoint(np.where(sizes > 0.0, found / np.maximum(sizes, 1e-300), 1.0)))
        place = int(np.argmax(steepest))
        if last >= 0 and steepest[place] <= steepest[last]:
            break
        found, last = applied((places == place).astype(complex)), place
        if np.abs(found).sum() <= norm:
            break
        norm = np.abs(found).sum()
    signs = np.where(places % 2, -1.0, 1.0)
    uneven = applied(signs * (1.0 + places / max(size - 1, 1)).astype(complex))
    return float(max(norm, 2.0 * np.abs(uneven).sum() / (3.0 * size)))


def _adjoint(X: np.ndarray) -> np.ndarray:
    return X.conj().swapaxes(-1, -2)
