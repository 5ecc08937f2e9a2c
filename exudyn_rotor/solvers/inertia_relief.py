"""Free rigid motions of a stiffness, and inertia relief: the elastic displacement without them."""

from __future__ import annotations

import weakref
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from exudyn_rotor.solvers.factor import (
    NotPositiveDefiniteError,
    SparseCholesky,
    TooLittleMemoryError,
    available_memory,
    factor_bytes,
    has_pardiso,
    rounding_unit,
    row_norm,
)
from exudyn_rotor.solvers.two_level import TwoLevel, conjugate_gradients
from exudyn_rotor.theory.axis import coordinates, rigid_motions

Rotor = Any  # a FiniteElementRotor, of the layer above
SOLVERS = ("auto", "direct", "iterative")
PRECISE = 1e-12  # share of a load that iteration may leave
# steps in which iteration must leave that share of a smooth load: 6 are needed for compact solids,
# 80 for nearly incompressible ones, 200 for blades, where modes would not converge
_TRIED, _TRIED_TO, _SEED = 100, 1e-2, 7
# coordinates below which a factor takes less memory than any machine has, and those from which 20
# modes by iteration take half the time that they take with a factor of NGSolve, and of Pardiso
_QUICK = 50_000
_ITERATED, _ITERATED_BESIDE_PARDISO = 400_000, 1_000_000
# bytes that iteration takes for every entry of the matrix and every coordinate
_ITERATIVE_PER_ENTRY, _ITERATIVE_PER_COORDINATE = 6.0, 5200.0
# Largest |K r| of a free motion r, as a share of ‖K‖∞ ‖r‖∞. Full precision leaves 1e-16, rounding
# to d digits in an export 0.2·10⁻ᵈ (8 digits moved the lowest frequencies by 1e-4); a support of
# k N/m leaves about k / ‖K‖∞
_STRAIN_LIMIT = 1e-8


def interpolation_of(
    rotor: Rotor, stiffness: sp.csr_array, nodes: np.ndarray | None = None
) -> sp.csr_array | None:
    """Return P of :class:`TwoLevel` if a stiffness is to be inverted by iteration, else None.

    The stiffness is that of a rotor, of some `nodes` or of all.
    """
    size = stiffness.shape[0]
    if rotor.solver == "direct" or (rotor.solver == "auto" and size < _QUICK):
        return None
    linear = None if rotor.elements is None else rotor.elements.interpolation()
    if rotor.solver == "auto":
        longest = _ITERATED_BESIDE_PARDISO if has_pardiso() else _ITERATED
        if size <= longest and factor_bytes(stiffness) <= available_memory():
            return None
    elif linear is None:
        raise ValueError(
            "solver='iterative' needs a model of second-order elements made by "
            "SolidRotor.from_ngsolve; matrices without a mesh have the direct solver only"
        )
    if linear is None or nodes is None:
        return linear
    vertices = nodes[nodes < linear.shape[1] // 3]
    return linear[coordinates(nodes)][:, coordinates(vertices)]


def _check_memory(stiffness: sp.csr_array, iterative: bool) -> None:
    size, available = stiffness.shape[0], available_memory()
    needed = factor_bytes(stiffness)
    if iterative:
        needed = _ITERATIVE_PER_ENTRY * stiffness.nnz + _ITERATIVE_PER_COORDINATE * size
    if size >= _QUICK and needed > available:
        raise TooLittleMemoryError(
            f"a static solution of {size} coordinates needs up to {needed / 1e9:.1f} GB, and "
            f"{available / 1e9:.1f} GB of memory are available; use a coarser mesh, or "
            "second-order elements in SolidRotor.from_ngsolve with_solver('auto'), for which "
            "there is an iterative solver that takes less than a factor"
        )


def free_rigid_motions(
    nodes: np.ndarray, mass: sp.csr_array, stiffness: sp.csr_array, count: int
) -> np.ndarray:
    """Return the rigid motions that the stiffness leaves free, mass-orthonormal.

    `count` says how many of the six are free. A rotation about a line that all nodes are on
    counts, but displaces nothing and is not returned. ValueError if the stiffness resists one.
    """
    size = np.linalg.norm(np.ptp(nodes, axis=0)) or 1.0
    motions = rigid_motions(nodes / size, nodes.mean(axis=0) / size)
    values, turn = np.linalg.eigh(motions.T @ (mass @ motions))
    seen = values > 1e-12 * values[-1]  # nodes on one line have no moment of inertia about it
    motions = motions @ (turn[:, seen] / np.sqrt(values[seen]))
    moving = max(0, count - (6 - motions.shape[1]))
    free = motions @ np.linalg.eigh(motions.T @ (stiffness @ motions))[1][:, :moving]
    if relative_rounding(stiffness, free) > _STRAIN_LIMIT:
        raise ValueError(
            f"the rotor claims {count} free rigid motions, but its stiffness resists one of them; "
            "it holds supports, or lost digits in an export (write at least 10)"
        )
    return free


def relative_rounding(stiffness: sp.csr_array, rigid: np.ndarray) -> float:
    """Return how precisely the stiffness is known: what ``K R = 0`` leaves of ``‖K‖∞ ‖R‖∞``.

    This is the machine precision, or more where the matrix lost digits in an export.
    """
    terms = np.maximum(
        row_norm(stiffness) * np.abs(rigid).max(axis=0, initial=0.0), np.finfo(float).tiny
    )
    strains = np.abs(stiffness @ rigid).max(axis=0, initial=0.0) / terms
    return max(np.finfo(float).eps, strains.max(initial=0.0))


class InertiaRelief:
    """Elastic inverse of a stiffness that may leave rigid motions free.

    For a load ``f`` it gives the ``u`` with ``K u = f − M R Rᵀ f`` and ``RᵀM u = 0``: the load is
    balanced by the inertia forces of the rigid acceleration, and the answer has no rigid part.
    `rigid` (m, r) are the mass-orthonormal motions ``R`` of :func:`free_rigid_motions`; with
    ``r = 0`` this is the ordinary inverse.

    This is exact with one factorisation: as many coordinates as there are free rigid motions are
    held by springs; a balanced load causes no reactions there, so where the springs are and how
    stiff does not matter. Or conjugate gradients find it, which a balanced load never leads into
    a rigid motion, by the `interpolation` (m, c) of displacements from those of the vertices.

    ValueError if the stiffness is singular even with the rigid motions held.
    """

    def __init__(
        self,
        stiffness: sp.csr_array,
        mass: sp.csr_array,
        rigid: np.ndarray,
        interpolation: sp.csr_array | None = None,
    ) -> None:
        self.rigid, self.left_out = rigid, rigid.shape[1]
        self.precision = relative_rounding(stiffness, rigid)
        self._momentum = mass @ rigid
        self.iterative = interpolation is not None
        _check_memory(stiffness, self.iterative)
        try:
            if self.iterative:
                self._two_level = TwoLevel(stiffness, mass, rigid, interpolation, InertiaRelief)
                # not the matrix itself, whose end is the end of what inertia_relief knows
                arrays = stiffness.data, stiffness.indices, stiffness.indptr
                self._stiffness = sp.csr_array(arrays, shape=stiffness.shape)
                self._unit = rounding_unit(stiffness)
                self._check_rate(mass)
            else:
                self._factor = SparseCholesky(_held(stiffness, rigid))
        except NotPositiveDefiniteError as error:
            raise ValueError(
                f"the stiffness leaves more motions free than the {rigid.shape[1]} rigid ones "
                f"({error}); look for loose parts, nodes without elements, or negative moduli"
            ) from error

    def solve(self, load: np.ndarray, tolerance: float = PRECISE) -> np.ndarray:
        """Return the elastic displacement [m] of `load` [N], shape (m,) or (m, k).

        `tolerance` is what iteration may leave of the load, beside the rounding of a factor.
        """
        load = np.asarray(load, dtype=float)
        balanced = self._balanced(load)
        if not self.iterative:
            return self._elastic(self._factor.solve(balanced))
        columns = balanced.reshape(len(load), -1)
        solved = conjugate_gradients(
            self._stiffness, self.precondition, columns, self._unit, tolerance
        )
        return self._elastic(solved.reshape(load.shape))

    def without_reactions(self, force: np.ndarray) -> np.ndarray:
        """Return all of the forces (m, k): there are no reactions."""
        return force

    def precondition(self, load: np.ndarray) -> np.ndarray:
        """Return roughly what :meth:`solve` does, for shape (m, k); symmetric and definite."""
        return self._elastic(self._two_level(self._balanced(load)))

    def start(self, count: int) -> np.ndarray:
        """Return `count` motions (m, count) to begin with, near the lowest modes."""
        return self._two_level.start(count)

    def _check_rate(self, mass: sp.csr_array) -> None:
        """Refuse iteration that a smooth load shows to be too slow."""
        load = np.random.default_rng(_SEED).standard_normal((mass.shape[0], 1))
        for _ in range(2):
            load = mass @ self.precondition(mass @ load)
        load = self._balanced(load)
        conjugate_gradients(self._stiffness, self.precondition, load, self._unit, _TRIED_TO, _TRIED)

    def _balanced(self, load: np.ndarray) -> np.ndarray:
        return load - self._momentum @ (self.rigid.T @ load)

    def _elastic(self, displacement: np.ndarray) -> np.ndarray:
        return displacement - self.rigid @ (self._momentum.T @ displacement)


def _held(stiffness: sp.csr_array, rigid: np.ndarray) -> sp.csr_array:
    """Return the stiffness with springs that hold the rigid motions, as far apart as can be."""
    count = rigid.shape[1]
    if count == 0:
        return stiffness
    # column pivoting picks the rows of R that form the best conditioned square matrix
    places = la.qr(rigid.T, mode="r", pivoting=True)[1][:count]
    diagonal = stiffness.diagonal()
    springs = np.where(diagonal[places] > 0.0, diagonal[places], diagonal.max())
    return stiffness + sp.csr_array((springs, (places, places)), shape=stiffness.shape)


def held_inverse(rotor: Rotor, nodes: np.ndarray) -> InertiaRelief:
    """Return the inverse of the stiffness of `nodes` with all others held.

    ValueError if that leaves motions free.
    """
    inner = coordinates(nodes)
    stiffness, mass = (matrix[inner][:, inner] for matrix in (rotor.stiffness, rotor.mass))
    linear = interpolation_of(rotor, stiffness, nodes)
    return InertiaRelief(stiffness, mass, np.zeros((inner.size, 0)), linear)


# by the id of a living stiffness matrix: modes, attachment modes and prestress share the factor
_known: dict[int, tuple[weakref.ref[sp.csr_array], tuple, InertiaRelief]] = {}


def _known_relief(rotor: Rotor) -> InertiaRelief | None:
    mass, model, relief = _known.get(id(rotor.stiffness), (lambda: None, None, None))
    same = mass() is rotor.mass and model == (rotor.rigid_motions, rotor.solver)
    return relief if same else None


def free_motions_of(rotor: Rotor) -> np.ndarray:
    """Return the :func:`free_rigid_motions` of a rotor; those of its elastic inverse if known."""
    known = _known_relief(rotor)
    if known is not None:
        return known.rigid
    return free_rigid_motions(rotor.nodes, rotor.mass, rotor.stiffness, rotor.rigid_motions)


def inertia_relief(rotor: Rotor) -> InertiaRelief:
    """Return the elastic inverse of a rotor; factorised once as long as its matrices live.

    ValueError if the stiffness resists a motion that should be free, or leaves others free.
    """
    known = _known_relief(rotor)
    if known is not None:
        return known
    stiffness, mass = rotor.stiffness, rotor.mass
    linear = interpolation_of(rotor, stiffness)
    relief = InertiaRelief(stiffness, mass, free_motions_of(rotor), linear)
    if id(stiffness) not in _known:
        weakref.finalize(stiffness, _known.pop, id(stiffness), None)
    _known[id(stiffness)] = weakref.ref(mass), (rotor.rigid_motions, rotor.solver), relief
    return relief
