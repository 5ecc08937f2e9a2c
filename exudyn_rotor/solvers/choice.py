"""Which way a large stiffness is inverted: a factor, or iteration with the linear elements."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.solvers import pardiso
from exudyn_rotor.solvers.memory import TooLittleMemoryError, available_memory

SOLVERS = ("auto", "direct", "iterative")
# coordinates below which a factor is quick, and takes less memory than any machine has
_QUICK = 50_000
_QUICK_MEMORY = 1e9
# bytes that a factor takes beside its entries, for every entry of the matrix, and what iteration
# takes for every entry and for every coordinate; peaks of runs with 20 modes
_DIRECT_PER_ENTRY = 30.0
_ITERATIVE_PER_ENTRY = 6.0
_ITERATIVE_PER_COORDINATE = 5200.0
# seconds of 20 modes, one thread: per operation of the factorisation, per entry of the factor in 60
# solutions, and per entry of the matrix by iteration; only their ratios count
_PER_OPERATION, _PER_FACTOR_ENTRY, _PER_MATRIX_ENTRY = 7e-11, 1.6e-7, 2e-6
_WORTH_IT = 2.0
# of Pardiso: per operation that it counts itself, and per byte of the factor in 110 solutions
_PARDISO_PER_OPERATION, _PARDISO_PER_BYTE = 4e-11, 7e-9
# bytes that 20 modes take beside its factor, for every coordinate
_PARDISO_PER_COORDINATE = 2600.0


class Fill(NamedTuple):
    """Entries of a Cholesky factor, and multiplications to compute it."""

    entries: float
    operations: float


def estimated_fill(size: int) -> Fill:
    """Return what a factor of `size` coordinates of a solid rotor has, by nested dissection.

    The powers are those of bodies in three dimensions (George, SIAM J. Numer. Anal. 10 (1973)), the
    numbers those of discs on shafts of 20,000 to 200,000 coordinates.
    """
    return Fill(11.0 * size ** (4.0 / 3.0), 6.5 * size**2)


class Elements(Protocol):
    """Elements of a mesh, whose vertices are the first nodes."""

    def interpolation(self) -> sp.csr_array | None: ...


class Model(Protocol):
    """What the choice needs of a rotor."""

    @property
    def nodes(self) -> np.ndarray: ...
    @property
    def solver(self) -> str: ...
    @property
    def elements(self) -> Elements | None: ...


@dataclass(frozen=True, eq=False)
class Way:
    """How the stiffness of a model may be inverted.

    Attributes
    ----------
    solver : {'auto', 'direct', 'iterative'}
    nodes : ndarray, shape (n, 3), optional
        Node positions, for the estimate of memory; none is made without them.
    interpolation : scipy.sparse.csr_array, shape (3n, 3v), optional
        Displacements of all nodes from those of the elements' vertices; without it there is only
        the direct way.
    """

    solver: str = "auto"
    nodes: np.ndarray | None = None
    interpolation: sp.csr_array | None = None

    def restricted(self, nodes: np.ndarray) -> Way:
        """Return the way for the rows and columns of some nodes."""
        if self.interpolation is None:
            return replace(self, nodes=self.nodes[nodes])
        columns = nodes[nodes < self.interpolation.shape[1] // 3]
        interpolation = self.interpolation[coordinates(nodes)][:, coordinates(columns)]
        return replace(self, nodes=self.nodes[nodes], interpolation=interpolation)


DIRECT = Way("direct")


def way_of(rotor: Model) -> Way:
    """Return how the stiffness of a rotor may be inverted."""
    linear = None if rotor.elements is None else rotor.elements.interpolation()
    return Way(rotor.solver, rotor.nodes, linear)


def coordinates(nodes: np.ndarray) -> np.ndarray:
    """Return the numbers of the coordinates of nodes."""
    return (3 * np.asarray(nodes)[:, None] + np.arange(3)).ravel()


def is_iterative(way: Way, stiffness: sp.csr_array, ordered: pardiso.Ordered | None = None) -> bool:
    """Return whether iteration is asked for, or the better way.

    Parameters
    ----------
    way : Way
    stiffness : scipy.sparse.csr_array, shape (m, m)
    ordered : pardiso.Ordered, optional
        The same matrix, if Pardiso is to make its factor; else the factor's size is estimated.

    Raises
    ------
    ValueError
        If iteration is asked for where the model has no linear elements.
    TooLittleMemoryError
        If the way does not fit into the memory that is available, or none does.
    """
    size, entries = stiffness.shape[0], stiffness.nnz
    if way.solver == "iterative":
        if way.interpolation is None:
            raise ValueError(
                "solver='iterative' needs a model of second-order elements made by "
                "SolidRotor.from_ngsolve; matrices without a mesh have the direct solver only"
            )
        return True
    available = available_memory()
    if way.nodes is None or (size < _QUICK and available > _QUICK_MEMORY):
        return False
    direct, seconds = _costs(way, stiffness, ordered)
    slow = direct > available or seconds > _WORTH_IT * _PER_MATRIX_ENTRY * entries
    if slow and way.solver == "auto" and way.interpolation is not None:
        _check_iterative(size, entries, available)
        return True
    if direct > available:
        raise TooLittleMemoryError(
            f"the factor of a stiffness matrix with {size} coordinates needs up to "
            f"{direct / 1e9:.1f} GB, and {available / 1e9:.1f} GB of memory are available; "
            + _advice(way)
        )
    return False


def fits_directly(
    way: Way, stiffness: sp.csr_array, ordered: pardiso.Ordered | None = None
) -> bool:
    """Return whether a factor fits into the memory; parameters of :func:`is_iterative`."""
    return _costs(way, stiffness, ordered)[0] < available_memory()


def _costs(
    way: Way, stiffness: sp.csr_array, ordered: pardiso.Ordered | None
) -> tuple[float, float]:
    """Return the bytes of a factor, and the seconds of 20 modes with it."""
    if ordered is not None:
        seconds = _PARDISO_PER_OPERATION * ordered.operations + _PARDISO_PER_BYTE * ordered.needed
        return ordered.needed + _PARDISO_PER_COORDINATE * stiffness.shape[0], seconds
    fill = estimated_fill(stiffness.shape[0])
    seconds = _PER_OPERATION * fill.operations + _PER_FACTOR_ENTRY * fill.entries
    return 8.0 * fill.entries + _DIRECT_PER_ENTRY * stiffness.nnz, seconds


def _check_iterative(size: int, entries: int, available: float) -> None:
    needed = _ITERATIVE_PER_ENTRY * entries + _ITERATIVE_PER_COORDINATE * size
    if needed > available:
        raise TooLittleMemoryError(
            f"the iterative solver needs about {needed / 1e9:.1f} GB for {size} coordinates, and "
            f"{available / 1e9:.1f} GB of memory are available; use a coarser mesh"
        )


def _advice(way: Way) -> str:
    if way.interpolation is not None:
        return "use rotor.with_solver('auto'), which iterates instead, or a coarser mesh"
    return (
        "use a coarser mesh, or second-order elements in SolidRotor.from_ngsolve, for which there "
        "is an iterative solver that takes less"
    )
