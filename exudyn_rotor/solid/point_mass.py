"""Point masses on a rotor: unbalances, balancing weights, lumped parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from exudyn_rotor import checks


@dataclass(frozen=True, eq=False)
class PointMass:
    """A point mass, asked for at `position` and placed on the nearest `node`.

    Attributes
    ----------
    position : ndarray, shape (3,)
        Where the mass was asked for, mesh coordinates [m].
    node : int
        Node that carries it.
    mass : float
        Added mass, negative where material was taken away [kg].
    distance : float
        How far the node lies from `position` [m].

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor
    >>> rotor = SolidRotor.from_matrices(np.eye(3), 1e6 * np.eye(3), [[0.1, 0, 0]], "z")
    >>> placed = rotor.add_point_mass([0.1, 0.02, 0], 0.005).point_masses[0]
    >>> placed.node, placed.mass, placed.distance
    (0, 0.005, 0.02)
    """

    position: np.ndarray
    node: int
    mass: float
    distance: float

    def __post_init__(self) -> None:
        checks.keep(
            self,
            position=checks.vector(self.position, "position", "m"),
            node=checks.count(self.node, "node"),
            mass=checks.number(self.mass, "mass", "kg"),
            distance=checks.number(self.distance, "distance", "m", least=0.0),
        )


def add_nodal_mass(matrix: sp.csr_array, node: int, mass: float) -> sp.csr_array:
    """Return the mass matrix `matrix` with `mass` [kg] added to all three directions of `node`."""
    if checks.number(mass, "mass", "kg") == 0.0:
        raise ValueError(f"mass: needs a number [kg] other than zero, got {mass}")
    if mass < 0.0:
        _check_removable(matrix, node, -mass)
    rows = 3 * node + np.arange(3)
    return sp.csr_array(matrix + sp.csr_array((np.full(3, mass), (rows, rows)), matrix.shape))


def _check_removable(matrix: sp.csr_array, node: int, removed: float) -> None:
    """Raise unless the mass matrix stays positive definite without `removed` at `node`."""
    scalar = sp.csc_array(matrix[::3, ::3])
    unit = np.zeros(scalar.shape[0])
    unit[node] = 1.0
    # M − m u uᵀ is positive definite exactly as long as m uᵀM⁻¹u < 1 (determinant lemma)
    available = 1.0 / spsolve(scalar, unit)[node]
    if removed >= available:
        raise ValueError(
            f"point mass: taking {removed:.6g} kg from node {node} leaves a negative mass; "
            f"this node can give less than {available:.6g} kg, so spread it over several nodes"
        )
