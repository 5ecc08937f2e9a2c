"""Point masses, and rigid discs on a rotor: mass and inertia of wheels that are not meshed.

A disc holds the nodes of a section rigid: stiff springs resist what is no rigid motion of these
nodes. Its mass is that of a body which moves with them. With the mean displacement ``a·u`` and the
mean gradient ``b_k·u`` of some of the nodes, its kinetic energy is

    ½ m |a·u̇|² + ½ Σ E_kl (b_k·u̇)·(b_l·u̇),    E = ½ tr(J) I − J,

J the inertia tensor and E the second moments of the mass. All directions have the same coefficients
(I₃ blocks (24)), so that gyroscopic and centrifugal terms follow as for every other mass: the
moments of a rotation ``φ × x`` are those of J.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from exudyn_rotor import checks
from exudyn_rotor.checks import Checked, numbers
from exudyn_rotor.solid.matrices import as_node_numbers, in_all_directions
from exudyn_rotor.theory.axis import coordinates, rigid_motions


@dataclass(frozen=True, eq=False)
class PointMass(Checked):
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
    >>> from exudyn_rotor import rotor_example
    >>> placed = rotor_example().add_point_mass([0, 0, 0.08], 0.005).point_masses[0]
    >>> placed.node, placed.mass, round(placed.distance, 9)
    (1, 0.005, 0.02)
    """

    position: np.ndarray = numbers(3)
    node: int
    mass: float
    distance: float

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.count(self.node, "node")
        checks.number(self.distance, "distance", "m", least=0.0)


def add_nodal_mass(matrix: sp.csr_array, node: int, mass: float) -> sp.csr_array:
    """Return the mass matrix `matrix` with `mass` [kg] added to all three directions of `node`."""
    if checks.number(mass, "mass", "kg") < 0.0:
        # M − m u uᵀ is positive definite exactly as long as m uᵀM⁻¹u < 1 (determinant lemma)
        unit = np.eye(1, matrix.shape[0] // 3, node)[0]
        available = 1.0 / spsolve(sp.csc_array(matrix[::3, ::3]), unit)[node]
        if -mass >= available:
            raise ValueError(
                f"point mass: taking {-mass:.6g} kg from node {node} leaves a negative mass; this "
                f"node can give less than {available:.6g} kg, so spread it over several nodes"
            )
    rows = 3 * node + np.arange(3)
    return sp.csr_array(matrix + sp.csr_array((np.full(3, mass), (rows, rows)), matrix.shape))


# springs of a rigid section over its own stiffness: a shaft 40 diameters long errs by 6e-6 in its
# first frequency; stiffer ones cost digits of every static solution
STIFF = 1e2
# nodes that tell the mean motion; a rigid section needs no more
_MEAN_NODES = 12
# of the largest second moment, and of the largest arm: rounding of what was given
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class RigidDisc(Checked):
    """A rigid disc on the nodes of a section, made by :meth:`SolidRotor.add_disc`.

    Attributes
    ----------
    center : ndarray, shape (3,)
        On the spin axis, mesh coordinates [m].
    mass : float
        [kg]
    inertia : ndarray, shape (3, 3)
        About `center`, mesh axes [kg m²].
    nodes : ndarray of int, shape (k,)
        Nodes that it holds rigid.
    positions : ndarray, shape (k, 3)
        Of these nodes [m].
    spring : float
        Stiffness by which it does so [N/m].

    Raises
    ------
    TypeError, ValueError
        If an argument is of another kind, the inertia is none of a body, or the nodes do not hold
        its rotations.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import RigidDisc
    >>> corners = [[1, 1, 0.1], [-1, -1, 0.1], [-1, 1, -0.1], [1, -1, -0.1]]
    >>> disc = RigidDisc([0, 0, 0], 2.0, np.diag([3, 3, 4]), [4, 5, 6, 7], corners, 1e9)
    >>> matrix = disc.mass_matrix(8)[::3, ::3]
    >>> round(float(matrix.sum()), 9)
    2.0
    """

    center: np.ndarray = numbers(3)
    mass: float
    inertia: np.ndarray = numbers(3, 3)
    nodes: np.ndarray = numbers("nodes", dtype=int)
    positions: np.ndarray = numbers("nodes", 3)
    spring: float

    def __post_init__(self) -> None:
        super().__post_init__()
        as_node_numbers("disc", self.nodes)
        checks.number(self.mass, "mass", "kg", above=0.0)
        checks.number(self.spring, "spring", "N/m", above=0.0)
        _check_inertia(self.inertia)
        arms = (self.positions - self.center)[self._some]
        seen = self._affine[1:] @ np.column_stack([np.ones(len(arms)), arms])
        loss = np.abs(seen[:, 1:] @ self._moments @ seen[:, 1:].T - self._moments).max()
        if loss > 1e-6 * np.abs(self._moments).max():
            raise ValueError(
                f"width: the {self.nodes.size} nodes of the section lie on one line, or in one "
                "plane and the inertia is that of a disc with a thickness; use a wider band"
            )

    @property
    def _moments(self) -> np.ndarray:
        """``E = ½ tr(J) I − J``, shape (3, 3) [kg m²]."""
        return 0.5 * np.trace(self.inertia) * np.eye(3) - self.inertia

    @cached_property
    def _some(self) -> np.ndarray:
        """Places in `nodes` of those that tell the mean motion: far from each other."""
        arms = self.positions - self.center
        chosen = [int(np.argmax(np.linalg.norm(arms, axis=1)))]
        distance = np.linalg.norm(arms - arms[chosen[0]], axis=1)
        while len(chosen) < min(_MEAN_NODES, self.nodes.size):
            chosen.append(int(np.argmax(distance)))
            distance = np.minimum(distance, np.linalg.norm(arms - arms[chosen[-1]], axis=1))
        return np.array(chosen)

    @cached_property
    def _affine(self) -> np.ndarray:
        """a and b_1 … b_3 on these nodes, shape (4, s): least squares of ``u = t + F (x − c)``."""
        arms = self.positions[self._some] - self.center
        fields = np.column_stack([np.ones(len(arms)), arms])
        return np.linalg.pinv(fields, rcond=_ROUNDING)

    def mass_matrix(self, node_count: int) -> sp.csr_array:
        """Return what the disc adds to the mass matrix, shape (3n, 3n) [kg]."""
        checks.count(node_count, "node_count", least=int(self.nodes.max()) + 1)
        some = sp.eye_array(node_count, format="csr")[self.nodes[self._some]]
        affine = sp.csr_array(self._affine) @ some
        moments = la.block_diag(self.mass, self._moments)
        return in_all_directions(affine.T @ sp.csr_array(moments) @ affine)

    def stiffness_matrix(self, node_count: int) -> sp.csr_array:
        """Return the springs that hold the section rigid, shape (3n, 3n) [N/m]."""
        checks.count(node_count, "node_count", least=int(self.nodes.max()) + 1)
        rigid, some = rigid_motions(self.positions, self.center), coordinates(self._some)
        follow = rigid @ np.linalg.pinv(rigid[some])
        identity = sp.eye_array(3 * self.nodes.size, format="csr")
        held = identity - sp.csr_array(follow) @ identity[some]
        strain = held @ sp.eye_array(3 * node_count, format="csr")[coordinates(self.nodes)]
        matrix = self.spring * (strain.T @ strain)
        return sp.csr_array(0.5 * (matrix + matrix.T))


def _check_inertia(inertia: np.ndarray) -> None:
    moments = np.linalg.eigvalsh(checks.symmetric(inertia, "inertia", "kg m²", size=3))
    if moments[0] < 0.0 or moments[2] <= 0.0:
        raise ValueError(f"inertia: needs moments above zero [kg m²], got {moments.tolist()}")
    # a polar moment of twice the transverse one is that of a thin disc
    if moments[2] > (moments[0] + moments[1]) * (1.0 + _ROUNDING):
        raise ValueError(
            f"inertia: no moment can be larger than the sum of the two others, got "
            f"{moments.tolist()} kg m²; a disc has polar ≤ 2 × transverse"
        )
