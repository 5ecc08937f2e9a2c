"""A full finite-element rotor on supports as a linear model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.linear.models.eccentricity import is_balanced
from exudyn_rotor.linear.models.free_motions import free_motions_of_solid
from exudyn_rotor.linear.models.full_equations import FullEquations
from exudyn_rotor.linear.models.points import radius_of_gyration, spread
from exudyn_rotor.linear.models.protocol import Mesh, PointMotions
from exudyn_rotor.linear.models.subspace import Subspace
from exudyn_rotor.linear.periodic.rotating_axes import axes_of


@dataclass(frozen=True, eq=False)
class FullRotor(FullEquations):
    """A solid rotor with linear supports, unreduced; analyses find its lowest modes.

    See :class:`FullEquations` and :class:`LinearModel`.
    """

    gives_all: ClassVar[bool] = False

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the rotor's interfaces."""
        return tuple(self.rotor.interfaces)

    @property
    def mesh(self) -> Mesh:
        """Nodes of the mesh."""
        return Mesh(self.nodes, sp.eye_array(self.size, format="csr"), self.axis)

    @cached_property
    def free_motions(self) -> tuple[str, ...]:
        """Rigid motions that no spring holds."""
        decoupled = self.with_spin().free_spin is not None
        return free_motions_of_solid(self.rotor, self.supports, decoupled)

    @property
    def mass_matrix(self) -> sp.csr_array:
        """M, shape (3n, 3n)."""
        return self.invariants.M

    @property
    def unit_unbalance(self) -> np.ndarray:
        """Load of the rotor's own eccentricity per Ω², ``h`` (83), shape (3n,), rotor frame."""
        return self.invariants.h

    @property
    def is_balanced(self) -> bool:
        """True where centre of mass and principal axis are on the spin axis but for rounding."""
        return is_balanced(self.invariants)

    @property
    def base_loads(self) -> np.ndarray:
        """Loads of unit accelerations of the ground (109), shape (3, 3n)."""
        return -axes_of(self.axis).T @ self.invariants.S

    @property
    def radius(self) -> float:
        """The rotor's radius of gyration [m]."""
        return radius_of_gyration(self.invariants)

    @property
    def stiffness_varies(self) -> bool:
        """True where the stiffness of a support depends on the speed."""
        return any(support.stiffness_varies for support in self.supports)

    @property
    def has_structural_damping(self) -> bool:
        """True where steady motions have structural damping, which other analyses leave out."""
        return self.invariants.H is not None

    def interface_motion(self, name: str) -> np.ndarray:
        """Return the interface's motion (6, 3n): displacement and rotation along (n1, n2, e)."""
        turn = np.kron(np.eye(2), axes_of(self.axis).T)
        return turn @ self.rotor.interfaces[name].mean_motion(self.rotor.node_count).toarray()

    def undamped(self) -> FullRotor:
        """Return the model without damping, and without the skew part of supports' stiffness."""
        supports = tuple(support.undamped() for support in self.supports)
        undamped = replace(self.invariants, D=0.0 * self.invariants.D, H=None)
        return replace(self, supports=supports, invariants=undamped)

    def point_motions(self, most: int) -> PointMotions:
        """Return up to `most` nodes spread over the mesh; `rows` are their displacements."""
        axes = axes_of(self.axis)
        nodes = spread(len(self.nodes), most // 2)
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
