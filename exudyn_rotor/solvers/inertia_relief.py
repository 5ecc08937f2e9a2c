"""Inertia relief: the elastic displacement of a body that nothing holds."""

from __future__ import annotations

import weakref
from typing import Protocol

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from exudyn_rotor.solvers import conjugate_gradients, pardiso
from exudyn_rotor.solvers.choice import (
    DIRECT,
    Model,
    Way,
    coordinates,
    fits_directly,
    is_iterative,
    way_of,
)
from exudyn_rotor.solvers.factor import NotPositiveDefiniteError, Solve, SparseCholesky
from exudyn_rotor.solvers.rounding import rounding_unit, row_norm
from exudyn_rotor.solvers.two_level import TwoLevel
from exudyn_rotor.theory.nodal import rotations, translations

# Largest |K r| of a free motion r, as a share of ‖K‖∞ ‖r‖∞. Full precision leaves 1e-16, rounding
# to d digits in an export 0.2·10⁻ᵈ (8 digits moved the lowest frequencies by 1e-4); a support of
# k N/m leaves about k / ‖K‖∞
_STRAIN_LIMIT = 1e-8
# share of an error that a step of conjugate gradients leaves, from which a factor is quicker: 0.35
# for compact solids, 0.7 for Poisson's ratio 0.49 or flat elements, 0.96 for thin blades
_SLOW = 0.75


class ElasticBody(Model, Protocol):
    """What inertia relief needs of a rotor: matrices, number of free rigid motions."""

    @property
    def mass(self) -> sp.csr_array: ...
    @property
    def stiffness(self) -> sp.csr_array: ...
    @property
    def rigid_motions(self) -> int: ...


def free_rigid_motions(
    nodes: np.ndarray, mass: sp.csr_array, stiffness: sp.csr_array, count: int
) -> np.ndarray:
    """Return the rigid motions that the stiffness leaves free, mass-orthonormal.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Node positions in mesh coordinates [m].
    mass, stiffness : scipy.sparse.csr_array, shape (3n, 3n)
    count : int
        How many of the six are free: 6 for a free body, fewer where springs to ground hold it.
        A rotation about a line that all nodes are on counts, but displaces nothing.

    Returns
    -------
    ndarray, shape (3n, r)
        ``r`` is `count` less the rotations that displace nothing.

    Raises
    ------
    ValueError
        If the stiffness resists one of these motions.
    """
    size = np.linalg.norm(np.ptp(nodes, axis=0)) or 1.0
    motions = np.hstack([translations(len(nodes)), rotations(nodes, nodes.mean(axis=0)) / size])
    motions = _mass_orthonormal(motions, mass)
    moving = max(0, count - (6 - motions.shape[1]))
    softest = np.linalg.eigh(motions.T @ (stiffness @ motions))[1][:, :moving]
    free = motions @ softest
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
    terms = np.maximum(row_norm(stiffness) * np.abs(rigid).max(axis=0), np.finfo(float).tiny)
    strains = np.abs(stiffness @ rigid).max(axis=0) / terms
    return max(np.finfo(float).eps, strains.max(initial=0.0))


def _mass_orthonormal(motions: np.ndarray, mass: sp.csr_array) -> np.ndarray:
    values, vectors = np.linalg.eigh(motions.T @ (mass @ motions))
    # nodes on one line have no moment of inertia about it
    seen = values > 1e-12 * values[-1]
    return motions @ (vectors[:, seen] / np.sqrt(values[seen]))


class InertiaRelief:
    """Elastic inverse of a stiffness that may leave rigid motions free.

    For a load ``f`` it gives the ``u`` with ``K u = f − M R Rᵀ f`` and ``RᵀM u = 0``: the load is
    balanced by the inertia forces of the rigid acceleration, and the answer has no rigid part.
    This is exact with one factorisation: as many coordinates as there are free rigid motions are
    held by springs; a balanced load causes no reactions there, so where the springs are and how
    stiff does not matter. Or conjugate gradients find it, which a balanced load never leads into
    a rigid motion.

    Parameters
    ----------
    stiffness, mass : scipy.sparse.csr_array, shape (m, m)
    rigid : ndarray, shape (m, r)
        Mass-orthonormal free rigid motions ``R`` of :func:`free_rigid_motions`; with ``r = 0``
        this is the ordinary inverse.
    way : Way
        Direct or iterative, see :mod:`exudyn_rotor.solvers.choice`.

    Attributes
    ----------
    iterative : bool
        Whether there is no factor.

    Raises
    ------
    ValueError
        If the stiffness is singular even with the rigid motions held.
    TooLittleMemoryError
        If neither way fits into the memory that is available.
    """

    def __init__(
        self, stiffness: sp.csr_array, mass: sp.csr_array, rigid: np.ndarray, way: Way = DIRECT
    ) -> None:
        self.rigid = rigid
        self._momentum = mass @ rigid
        held, ordered = _held(stiffness, rigid), None
        if way.solver != "iterative" and pardiso.is_used(stiffness.shape[0]):
            ordered = pardiso.Ordered(held)
        elif way.solver != "iterative" and pardiso.would_help(stiffness.shape[0]):
            pardiso.tell_of_mkl()
        self.iterative = is_iterative(way, stiffness, ordered)
        try:
            if self.iterative:
                self._prepare_iteration(stiffness, mass, way, ordered)
            if not self.iterative:
                self._factor = SparseCholesky(held, ordered)
        except NotPositiveDefiniteError as error:
            raise ValueError(
                f"the stiffness leaves more motions free than the {rigid.shape[1]} rigid ones "
                f"({error}); look for loose parts, nodes without elements, or negative moduli"
            ) from error

    def solve(self, load: np.ndarray, tolerance: float = conjugate_gradients.PRECISE) -> np.ndarray:
        """Return the elastic displacement [m] of `load` [N], shape (m,) or (m, k).

        `tolerance` is what iteration may leave of the load, beside the rounding of a factor.
        """
        load = np.asarray(load, dtype=float)
        balanced = self._balanced(load)
        if self.iterative:
            columns = balanced.reshape(len(load), -1)
            solved = conjugate_gradients.solved(
                self._stiffness, self.precondition, columns, self._unit, tolerance
            )
            displacement = solved.reshape(load.shape)
        else:
            displacement = self._factor.solve(balanced)
        return self._elastic(displacement)

    def precondition(self, load: np.ndarray) -> np.ndarray:
        """Return roughly what :meth:`solve` does, for shape (m, k); symmetric and definite."""
        return self._elastic(self._two_level(self._balanced(load)))

    def start(self, count: int) -> np.ndarray:
        """Return `count` motions (m, count) to begin with, near the lowest modes."""
        return self._two_level.start(count)

    def _prepare_iteration(
        self,
        stiffness: sp.csr_array,
        mass: sp.csr_array,
        way: Way,
        ordered: pardiso.Ordered | None,
    ) -> None:
        self._two_level = TwoLevel(stiffness, mass, self.rigid, way.interpolation, _coarse_solve)
        # not the matrix itself, whose end is the end of what inertia_relief knows
        arrays = stiffness.data, stiffness.indices, stiffness.indptr
        self._stiffness = sp.csr_array(arrays, shape=stiffness.shape)
        self._unit = rounding_unit(stiffness)
        if way.solver == "auto":
            load = self._balanced(mass @ _quadratic(way.nodes))
            rate = conjugate_gradients.rate(self._stiffness, self.precondition, load)
            if rate > _SLOW and fits_directly(way, stiffness, ordered):
                self.iterative, self._two_level = False, None

    def _balanced(self, load: np.ndarray) -> np.ndarray:
        return load - self._momentum @ (self.rigid.T @ load)

    def _elastic(self, displacement: np.ndarray) -> np.ndarray:
        return displacement - self.rigid @ (self._momentum.T @ displacement)


def _quadratic(nodes: np.ndarray) -> np.ndarray:
    """Return a displacement (3n,) that bends a body in all directions."""
    positions = nodes - nodes.mean(axis=0)
    squares = np.sum(positions, axis=1) ** 2 + positions[:, 0] * positions[:, 1]
    return np.repeat(squares, 3)


def _coarse_solve(stiffness: sp.csr_array, mass: sp.csr_array, rigid: np.ndarray) -> Solve:
    return InertiaRelief(stiffness, mass, rigid).solve


def _held(stiffness: sp.csr_array, rigid: np.ndarray) -> sp.csr_array:
    """Return the stiffness with springs to the ground that hold the rigid motions."""
    if rigid.shape[1] == 0:
        return stiffness
    places, diagonal = _places(rigid), stiffness.diagonal()
    springs = np.where(diagonal[places] > 0.0, diagonal[places], diagonal.max())
    return stiffness + sp.csr_array((springs, (places, places)), shape=stiffness.shape)


def _places(rigid: np.ndarray) -> np.ndarray:
    """Return coordinates that hold the rigid motions and nothing else, as far apart as can be."""
    # column pivoting picks the rows of R that form the best conditioned square matrix
    _, order = la.qr(rigid.T, mode="r", pivoting=True)
    return order[: rigid.shape[1]]


def held_inverse(rotor: ElasticBody, nodes: np.ndarray) -> InertiaRelief:
    """Return the inverse of the stiffness of `nodes` with all others held.

    Raises
    ------
    ValueError
        If that leaves motions free.
    TooLittleMemoryError
        If neither way fits into the memory that is available.
    """
    inner = coordinates(nodes)
    stiffness, mass = (matrix[inner][:, inner] for matrix in (rotor.stiffness, rotor.mass))
    return InertiaRelief(
        stiffness, mass, np.zeros((inner.size, 0)), way_of(rotor).restricted(nodes)
    )


# by the id of a living stiffness matrix: modes, attachment modes and prestress share the factor
_known: dict[int, tuple[weakref.ref[sp.csr_array], tuple, InertiaRelief]] = {}


def free_motions_of(rotor: ElasticBody) -> np.ndarray:
    """Return the :func:`free_rigid_motions` of a rotor; those of its elastic inverse if known."""
    known = _known_relief(rotor)
    if known is not None:
        return known.rigid
    return free_rigid_motions(rotor.nodes, rotor.mass, rotor.stiffness, rotor.rigid_motions)


def _known_relief(rotor: ElasticBody) -> InertiaRelief | None:
    earlier = _known.get(id(rotor.stiffness))
    same = earlier is not None and earlier[0]() is rotor.mass
    return earlier[2] if same and earlier[1] == (rotor.rigid_motions, rotor.solver) else None


def inertia_relief(rotor: ElasticBody, rigid: np.ndarray | None = None) -> InertiaRelief:
    """Return the elastic inverse of a rotor; factorised once as long as its matrices live.

    `rigid` are its :func:`free_motions_of`, where they are computed already.

    Raises
    ------
    ValueError
        If the stiffness resists a motion that should be free, or leaves others free.
    TooLittleMemoryError
        If neither way fits into the memory that is available.
    """
    known = _known_relief(rotor)
    if known is not None:
        return known
    stiffness, mass = rotor.stiffness, rotor.mass
    rigid = free_motions_of(rotor) if rigid is None else rigid
    relief = InertiaRelief(stiffness, mass, rigid, way_of(rotor))
    if id(stiffness) not in _known:
        weakref.finalize(stiffness, _known.pop, id(stiffness), None)
    _known[id(stiffness)] = weakref.ref(mass), (rotor.rigid_motions, rotor.solver), relief
    return relief
