"""The stiffness's inverse under linear constraints, with one positive definite factorisation."""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from exudyn_rotor.solvers.inertia_relief import InertiaRelief

# two constraints are taken for the same one if the scaled matrix is this near to singular
_SMALLEST_RECIPROCAL_CONDITION = 1e-12


class ConstrainedInverse:
    """Solve ``K u + Cᵀ λ = f`` with ``C u − S λ = d``, S the flexibility of springs (c,) or zero.

    With the elastic inverse ``G`` and the rigid motions ``R`` that the constraints hold, every
    solution is ``u = G (f − Cᵀλ) + R q``, where the load and the reactions balance,
    ``Rᵀ(f − Cᵀλ) = 0``. Together with ``C u − S λ = d`` this is a small dense system for ``λ`` and
    ``q``; the indefinite saddle matrix of the whole mesh is never factorised. Without ``d`` the map
    from ``f`` to ``u`` is symmetric and positive semi-definite, as eigenvalue iteration needs it.

    `rigid` (3n, r) is R, all free rigid motions by default. ValueError if constraints depend on
    each other or do not hold R.
    """

    def __init__(
        self,
        relief: InertiaRelief,
        constraints: sp.csr_array,
        flexibility: np.ndarray | float = 0.0,
        rigid: np.ndarray | None = None,
    ) -> None:
        self._relief, self._constraints = relief, constraints
        self._rigid = relief.rigid if rigid is None else rigid
        self.iterative, self.precision = relief.iterative, relief.precision
        self.left_out = constraints.shape[0]
        self.start = relief.start
        self._flexible = relief.solve(constraints.T.toarray())
        held = constraints @ self._rigid
        compliance = constraints @ self._flexible
        compliance[np.diag_indices_from(compliance)] += flexibility
        matrix = np.block([[compliance, -held], [held.T, np.zeros((held.shape[1],) * 2)]])
        # forces and displacements have different units: bring all entries to one or less
        stiff = 1.0 / np.sqrt(np.diag(compliance))
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
        """Return the displacement of a load, both (3n,) or (3n, k), with ``d = 0``."""
        elastic, resultant = self._relief.solve(load), self._rigid.T @ load
        return elastic + self._correction(self._constraints @ elastic, resultant)

    def reactions(self, load: np.ndarray) -> np.ndarray:
        """Return the forces ``−Cᵀ λ`` (3n,) or (3n, k) of the constraints under a load."""
        # by CG = (GCᵀ)ᵀ
        _, reaction = self._balance(self._flexible.T @ load, self._rigid.T @ load)
        return -(self._constraints.T @ reaction)

    def without_reactions(self, force: np.ndarray) -> np.ndarray:
        """Return the part of forces (3n, k) that reactions ``Cᵀ λ`` cannot balance."""
        constraints = self._constraints
        gram = (constraints @ constraints.T).toarray()
        return force - constraints.T @ la.solve(gram, constraints @ force, assume_a="pos")

    def precondition(self, load: np.ndarray) -> np.ndarray:
        """Return roughly what :meth:`solve` does, for shape (3n, k), with ``C u = 0``."""
        load = load + self.reactions(load)
        elastic = self._relief.precondition(load)
        return elastic + self._correction(self._constraints @ elastic, self._rigid.T @ load)

    def prescribe(self, values: np.ndarray) -> np.ndarray:
        """Return the unloaded displacement (3n, k) with ``C u = d`` for `values` (c, k)."""
        return self._correction(-values, np.zeros((self._rigid.shape[1], values.shape[1])))

    def _correction(self, gap: np.ndarray, resultant: np.ndarray) -> np.ndarray:
        """Return ``R q − G Cᵀ λ`` that closes the gap and balances the resultant."""
        rigid, reaction = self._balance(gap, resultant)
        return self._rigid @ rigid - self._flexible @ reaction

    def _balance(self, gap: np.ndarray, resultant: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return q and λ."""
        right = np.concatenate([gap, resultant])
        scaled = la.lu_solve(self._factor, (right.T * self._scale).T)
        reaction, rigid = np.split((scaled.T * self._scale).T, [len(gap)])
        return rigid, reaction
