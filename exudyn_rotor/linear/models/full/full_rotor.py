"""A full finite-element rotor on supports as a linear model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.free_motions import free_motions_of_solid
from exudyn_rotor.linear.models.full.full_equations import FullEquations
from exudyn_rotor.linear.models.full.subspace import Subspace
from exudyn_rotor.linear.models.points import spread
from exudyn_rotor.linear.models.protocol import Mesh, PointMotions
from exudyn_rotor.theory.rotating_axes import axes_of

_MOST_NODES = 400  # by which motions are told: their displacements are coordinates here


@dataclass(frozen=True, eq=False)
class FullRotor(FullEquations):
    """A solid rotor with linear supports, unreduced; analyses find its lowest modes.

    See :class:`FullEquations` and :class:`LinearModel`.
    """

    gives_all: ClassVar[bool] = False
    voids: ClassVar[np.ndarray] = np.zeros(0, dtype=int)
    is_full: ClassVar[bool] = True

    @property
    def mesh(self) -> Mesh:
        """Nodes of the mesh."""
        columns = sp.eye_array(self.size, format="csr")
        return Mesh(self.nodes, columns, self.axis, self.rotor.triangles)

    @cached_property
    def free_motions(self) -> tuple[str, ...]:
        """Rigid motions that no spring holds."""
        decoupled = self.with_spin().free_spin is not None
        return free_motions_of_solid(self.rotor, self.supports, decoupled)

    def interface_motion(self, name: str) -> np.ndarray:
        """Return the interface's motion (6, 3n): displacement and rotation along (n1, n2, e)."""
        turn = np.kron(np.eye(2), axes_of(self.axis).T)
        return turn @ self.rotor.interfaces[name].mean_motion(self.rotor.node_count).toarray()

    def point_motions(self, most: int) -> PointMotions:
        """Return up to `most` nodes, or 400, spread over the mesh; `rows` are their motions."""
        axes = axes_of(self.axis)
        nodes = spread(len(self.nodes), min(most, _MOST_NODES))
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        points = (self.nodes[nodes] - self.axis.point) @ axes
        return PointMotions(points, np.kron(np.eye(len(nodes)), axes.T), rows, True)

    def space(
        self,
        count: int,
        fastest: float,
        *,
        loads: Sequence[np.ndarray] = (),
        held: bool = False,
        residual: float = 1e-7,
    ) -> Subspace:
        """Return a subspace for the lowest modes and for steady motions under the loads."""
        options = {"loads": loads, "held": held, "residual": residual}
        return Subspace(self.with_spin(), count, fastest, **options)
