"""Interfaces of a rotor: node sets whose weighted mean motion carries bearings and loads."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.solid import matrices
from exudyn_rotor.theory.nodal import skew


@dataclass(frozen=True, eq=False, repr=False)
class Interface:
    """A named node set with weights.

    Parameters
    ----------
    name : str
    nodes : ndarray of int, shape (k,)
        Node numbers in the mesh.
    weights : array_like, shape (k,)
        Shares of the interface's area, not negative; kept such that they sum to one. Equal ones
        for None.
    positions : ndarray, shape (k, 3)
        Reference positions of these nodes in mesh coordinates [m].
    reference : ndarray, shape (3,), optional
        The point whose motion is reported. By default the weighted centre; move it onto the spin
        axis with :meth:`centered_on` so that an uneven mesh does not make a false eccentricity.

    Raises
    ------
    TypeError, ValueError
        If an argument is of another kind, shapes do not fit, a node is listed twice, or a weight
        is negative.

    Examples
    --------
    >>> from exudyn_rotor import Interface
    >>> seat = Interface("seat", [4, 7], [1.0, 3.0], [[0.02, 0, 0], [-0.02, 0, 0]])
    >>> seat
    Interface('seat', 2 nodes, centre [-0.01, 0, 0] m)
    >>> seat.centered_on([0, 0, 0]).mean_motion(node_count=10).shape
    (6, 30)
    """

    name: str
    nodes: np.ndarray
    weights: np.ndarray | None
    positions: np.ndarray
    reference: np.ndarray | None = None
    center: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        name = checks.label(self.name, "interface: its name")
        nodes = matrices.as_node_numbers(name, self.nodes)
        weights = matrices.as_weights(name, self.weights, nodes.size)
        weights = checks.read_only(weights / weights.sum())
        label = f"interface {name!r}: positions"
        positions = checks.array(self.positions, label, "m", shape=(nodes.size, 3))
        center = checks.read_only(weights @ positions)
        reference = center
        if self.reference is not None:
            reference = checks.vector(self.reference, f"interface {name!r}: reference", "m")
        checks.keep(
            self,
            nodes=nodes,
            weights=weights,
            positions=positions,
            center=center,
            reference=reference,
        )

    def __repr__(self) -> str:
        center = ", ".join(f"{value:.5g}" for value in self.center)
        return f"Interface({self.name!r}, {self.nodes.size} nodes, centre [{center}] m)"

    @property
    def radius(self) -> float:
        """Root mean square distance of the nodes from the weighted centre [m]."""
        arms = self.positions - self.center
        return float(np.sqrt(self.weights @ np.sum(arms**2, axis=1)))

    def centered_on(self, point: np.ndarray) -> Interface:
        """Return the interface with its reference point moved to `point`, weights unchanged."""
        point = checks.vector(point, "point", "m")
        return Interface(self.name, self.nodes, self.weights, self.positions, point)

    def mean_motion(self, node_count: int) -> sp.csr_array:
        """Return the averaging operator, shape (6, 3·node_count), mesh axes.

        Rows 0–2 give the displacement of the reference point and rows 3–5 the rotation
        ``θ = W⁻¹ Σ w p̃ (u − ū)`` with ``W = −Σ w p̃ p̃``: the least-squares rigid motion that
        Exudyn's ``MarkerSuperElementRigid`` uses (``useAlternativeApproach=True``). Directions in
        which the nodes have no arm (a single node, nodes on a line) get no rotation.
        """
        node_count = checks.count(node_count, "node_count", least=int(self.nodes.max()) + 1)
        inertia, levers = rotation_moments(self.positions - self.center, self.weights)
        lever = np.linalg.pinv(inertia, rcond=1e-9, hermitian=True)
        turn = np.einsum("ab,kbc->kac", lever, levers)
        shift = self.weights[:, None, None] * np.eye(3)
        shift = shift - skew(self.reference - self.center) @ turn
        blocks = np.concatenate([shift, turn], axis=1)
        columns = (3 * self.nodes[:, None] + np.arange(3)).ravel()
        dense = blocks.transpose(1, 0, 2).reshape(6, -1)
        selector = sp.csr_array(
            (np.ones(columns.size), (np.arange(columns.size), columns)),
            shape=(columns.size, 3 * node_count),
        )
        return sp.csr_array(sp.csr_array(dense) @ selector)


def rotation_moments(arms: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return ``W = −Σ w p̃ p̃``, shape (3, 3), and ``w p̃`` of every node, shape (k, 3, 3).

    The mean rotation of displacements u is ``W⁻¹ Σ w p̃ u``, with the arms p (k, 3) from the
    weighted centre; see :meth:`Interface.mean_motion`.
    """
    tildes = np.array([skew(arm) for arm in arms])
    return -np.einsum("k,kab,kbc->ac", weights, tildes, tildes), weights[:, None, None] * tildes
