"""The stiffness's inverse under linear constraints, with one positive definite factorisation."""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from exudyn_rotor.solvers.inertia_relief import InertiaRelief

# two constraints are taken for the same one if the scaled matrix is this near to singular
_SMALLEST_RECIPROCAL_CONDITION = 1e-12


class ConstrainedInverse:
    """Solve ``K u + Cᵀ λ = f`` with ``C u = d``.

    With the elastic inverse ``G`` and the free rigid motions ``R``, every solution is
    ``u = G (f − Cᵀλ) + R q``, where the load and the reactions balance, ``Rᵀ(f − Cᵀλ) = 0``.
    Together with ``C u = d`` this is a small dense system for ``λ`` and ``q``; the indefinite
    saddle matrix of the whole mesh is never factorised. Without ``d`` the map from ``f`` to ``u``
    is symmetric and positive semi-definite, as an eigenvalue iteration needs it.

    ValueError if constraints depend on each other or do not hold the free rigid motions.
    """

    def __init__(self, relief: InertiaRelief, constraints: sp.csr_array) -> None:
        self._relief, self._constraints = relief, constraints
        self.iterative = relief.iterative
        self.start = relief.start
        self._flexibility = relief.solve(constraints.T.toarray())
        held = constraints @ relief.rigid
        flexibility = constraints @ self._flexibility
        matrix = np.block([[flexibility, -held], [held.T, np.zeros((held.shape[1],) * 2)]])
        # forces and displacements have different units: bring all entries to one or less
        stiff = 1.0 / np.sqrt(np.diag(flexibility))
        loose = 1.0 / np.linalg.norm(stiff[:, None] * held, axis=0)
        self._scale = np.concatenate([stiff, loose])
        scaled = self._scale[:, None] * matrix * self._scale
        if not np.linalg.cond(scaled) < 1.0 / _SMALLEST_RECIPROCAL_CONDITION:
            raise ValueError(
                "the interfaces depend on each other or do not hold the rotor's rigid motions; "
                "leave out one of two interfaces with the same nodes, or add an interface"
            )
        self._factor = la.lu_factor(scaled)

    def solve(self, load: np.ndarray) -> np.ndarray:
        """Return the displacement of a load, both (3n,) or (3n, k), with ``C u = 0``."""
        elastic, resultant = self._relief.solve(load), self._relief.rigid.T @ load
        return elastic + self._correction(self._constraints @ elastic, resultant)

    def precondition(self, load: np.ndarray) -> np.ndarray:
        """Return roughly what :meth:`solve` does, for shape (3n, k), with ``C u = 0``."""
        # the reactions are those of the exact solution, by CG = (GCᵀ)ᵀ
        _, reaction = self._balance(self._flexibility.T @ load, self._relief.rigid.T @ load)
        load = load - self._constraints.T @ reaction
        elastic = self._relief.precondition(load)
        return elastic + self._correction(self._constraints @ elastic, self._relief.rigid.T @ load)

    def prescribe(self, values: np.ndarray) -> np.ndarray:
        """Return the unloaded displacement (3n, k) with ``C u = d`` for `values` (c, k)."""
        resultant = np.zeros((self._relief.rigid.shape[1], values.shape[1]))
        return self._correction(-values, resultant)

    def _correction(self, gap: np.ndarray, resultant: np.ndarray) -> np.ndarray:
        """Return ``R q − G Cᵀ λ`` that closes the gap and balances the resultant."""
        rigid, reaction = self._balance(gap, resultant)
        return self._relief.rigid @ rigid - self._flexibility @ reaction

    def _balance(self, gap: np.ndarray, resultant: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return q and λ."""
        right = np.concatenate([gap, resultant])
        scaled = la.lu_solve(self._factor, (right.T * self._scale).T)
        reaction, rigid = np.split((scaled.T * self._scale).T, [len(gap)])
        return rigid, reaction
