"""The rotor as a finite-element model: nodes, matrices, axis, interfaces, surface."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.checks import read_only
from exudyn_rotor.prestress.stressed import StressedRotor, check_unstressed
from exudyn_rotor.solid import fem_interface, matrices, ngsolve_model, units
from exudyn_rotor.solid.interface import Interface
from exudyn_rotor.solid.model import FiniteElementModel, NodeSet, StressRecovery
from exudyn_rotor.solid.point_mass import PointMass, add_nodal_mass
from exudyn_rotor.solid.rigid import count_rigid_motions
from exudyn_rotor.solid.summary import summary
from exudyn_rotor.theory.axis import SpinAxis

if TYPE_CHECKING:
    import ngsolve
    from exudyn.FEM import FEMinterface

    from exudyn_rotor.prestress.prestress import Prestress
    from exudyn_rotor.reduction.reduce import ModeSource
    from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
    from exudyn_rotor.solid.elements import NgsolveElements

AxisLike = SpinAxis | str | ArrayLike


@dataclass(frozen=True, eq=False, repr=False)
class SolidRotor(StressedRotor):
    """Solid finite-element rotor; immutable. Make one with a ``from_…`` constructor.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions in mesh coordinates [m].
    mass, stiffness : scipy.sparse.csr_array, shape (3n, 3n)
        Assembled FE matrices, ordered x0 y0 z0 x1 … [kg], [N/m].
    axis : SpinAxis
        Spin axis in mesh coordinates.
    damping : scipy.sparse.csr_array or None
        Damping of the rotor's own material, acting in the rotor frame [N s/m].
    interfaces : mapping of str to Interface
    triangles : ndarray of int, shape (t, 3) or (t, 6)
        Surface for drawing, 6-node triangles where the mesh is quadratic: corners, then the mid
        nodes of the edges 0-1, 1-2, 2-0.
    stress_recovery : callable or None
        Maps displacement columns (3n, k) to nodal stress (n, 6, k) [Pa], components xx, yy, zz,
        yz, xz, xy in mesh axes.
    point_masses : tuple of PointMass
        What :meth:`add_point_mass` placed, with the snapping distances.
    rigid_motions : int
        How many of the six rigid motions the stiffness leaves free; 6 for a free rotor. A
        rotation that displaces no node (all nodes on its axis) counts as free.
    elements : NgsolveElements or None
        What :meth:`prestress` assembles on; only of :meth:`from_ngsolve`.
    carried_prestress : Prestress or None
        Set by :meth:`with_prestress`.
    """

    nodes: np.ndarray
    mass: sp.csr_array
    stiffness: sp.csr_array
    axis: SpinAxis
    damping: sp.csr_array | None = None
    interfaces: Mapping[str, Interface] = field(default_factory=dict)
    triangles: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int64))
    stress_recovery: StressRecovery | None = None
    point_masses: tuple[PointMass, ...] = ()
    rigid_motions: int = 6
    elements: NgsolveElements | None = None
    carried_prestress: Prestress | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "interfaces", MappingProxyType(dict(self.interfaces)))

    @classmethod
    def from_ngsolve(
        cls,
        mesh: ngsolve.Mesh,
        materials: Mapping[str, Any],
        axis: AxisLike,
        *,
        order: int = 2,
        interfaces: Sequence[str] | None = None,
        check_units: bool = True,
    ) -> SolidRotor:
        """Assemble a rotor from an NGSolve mesh of tetrahedra.

        Parameters
        ----------
        mesh : ngsolve.Mesh
            Gets mid nodes (``SecondOrder``) if `order` is 2 and it has none yet. Node numbers are
            those of the Netgen mesh and of Exudyn's FEMinterface, counted from zero.
        materials : mapping
            Region name → ``{'youngsModulus': Pa, 'poissonsRatio': 1, 'density': kg/m³}``; one
            such dict by itself for a mesh with one material.
        axis : SpinAxis, str or array_like
            Read by :meth:`SpinAxis.of`: 'x', 'y', 'z', a direction, or (direction, point) [m].
        order : int, optional
            Order of the displacements, 2 (10-node tetrahedra) or 1.
        interfaces : sequence of str, optional
            Names of the faces that become interfaces; all faces with a name by default. The
            weights are area shares, see :func:`exudyn_rotor.solid.surface.area_weights`.
        check_units : bool, optional
            Refuse materials and sizes that cannot be in SI units.

        Raises
        ------
        TypeError
            If `mesh` is not an ngsolve.Mesh, or `materials` not a dictionary.
        ValueError
            If the mesh is no tetrahedral solid, a material or face is missing or impossible, or
            the units cannot be SI.
        """
        model = ngsolve_model.assemble_model(
            mesh, materials, order=order, interfaces=interfaces, check_units=check_units
        )
        return cls._checked(model, axis, check_units)

    @classmethod
    def from_fem_interface(
        cls,
        fem: FEMinterface,
        axis: AxisLike,
        *,
        check_units: bool = True,
        grounded: bool | None = None,
    ) -> SolidRotor:
        """Take a rotor from Exudyn's FEMinterface; its node sets with a name become interfaces.

        Parameters
        ----------
        fem : exudyn.FEM.FEMinterface
            With 'Position' nodes, mass and stiffness matrix; surface and node sets are optional.
        axis : SpinAxis, str or array_like
            Read by :meth:`SpinAxis.of`.
        check_units : bool, optional
            Refuse sizes and masses that cannot be in SI units.
        grounded : bool, optional
            Whether springs to the ground are inside the stiffness matrix; needed only if the
            matrix itself does not tell.

        Raises
        ------
        TypeError
            If `fem` is not a FEMinterface.
        ValueError
            If nodes carry rotations, something is missing, or a check of the matrices fails.
        """
        return cls._checked(fem_interface.import_model(fem), axis, check_units, grounded)

    @classmethod
    def from_matrices(
        cls,
        mass: Any,
        stiffness: Any,
        nodes: ArrayLike,
        axis: AxisLike,
        damping: Any = None,
        *,
        interfaces: Mapping[str, Any] | None = None,
        triangles: ArrayLike = (),
        check_units: bool = True,
        grounded: bool | None = None,
    ) -> SolidRotor:
        """Make a rotor from plain arrays.

        Parameters
        ----------
        mass, stiffness, damping : array_like or scipy.sparse, shape (3n, 3n)
            Symmetric, ordered x0 y0 z0 x1 … [kg], [N/m], [N s/m]. The damping is optional.
        nodes : array_like, shape (n, 3)
            Reference positions [m].
        axis : SpinAxis, str or array_like
            Read by :meth:`SpinAxis.of`.
        interfaces : mapping, optional
            Name → node numbers, or name → (node numbers, weights).
        triangles : array_like of int, shape (t, 3) or (t, 6), optional
            Surface for drawing.
        check_units : bool, optional
            Refuse sizes and masses that cannot be in SI units.
        grounded : bool, optional
            Whether springs to the ground are inside the stiffness matrix; needed only if the
            matrix itself does not tell.

        Raises
        ------
        TypeError
            If an array does not hold numbers, or node numbers are not integers.
        ValueError
            If a check fails: shape, finite entries, symmetry, I₃ blocks and positive mass,
            rigid motions, node numbers, units.
        """
        node_sets = {name: _node_set(entry) for name, entry in (interfaces or {}).items()}
        model = FiniteElementModel(nodes, mass, stiffness, damping, node_sets, triangles)
        return cls._checked(model, axis, check_units, grounded)

    @classmethod
    def _checked(
        cls,
        model: FiniteElementModel,
        axis: AxisLike,
        check_units: bool,
        grounded: bool | None = None,
    ) -> SolidRotor:
        nodes = matrices.as_nodes(model.nodes)
        mass = matrices.as_matrix("mass matrix", model.mass, len(nodes))
        matrices.check_mass(mass)
        if check_units:
            units.check_model_units(nodes, float(mass[::3, ::3].sum()))
        stiffness = matrices.as_matrix("stiffness matrix", model.stiffness, len(nodes))
        matrices.check_stiffness(stiffness)
        damping = model.damping
        if damping is not None:
            damping = matrices.as_matrix("damping matrix", damping, len(nodes))
        return cls(
            nodes=nodes,
            mass=mass,
            stiffness=stiffness,
            axis=SpinAxis.of(axis),
            damping=damping,
            interfaces={
                name: _interface(name, nodes, *node_set)
                for name, node_set in model.node_sets.items()
            },
            triangles=matrices.as_triangles(model.triangles, len(nodes)),
            stress_recovery=model.stress_recovery,
            rigid_motions=count_rigid_motions(nodes, stiffness, grounded),
            elements=model.elements,
        )

    @property
    def node_count(self) -> int:
        """Number of nodes n."""
        return len(self.nodes)

    @property
    def total_mass(self) -> float:
        """Mass with all point masses [kg]."""
        return float(self.mass[::3, ::3].sum())

    @property
    def center_of_mass(self) -> np.ndarray:
        """Centre of mass in mesh coordinates, shape (3,) [m]."""
        return read_only((self.mass[::3, ::3] @ self.nodes).sum(axis=0) / self.total_mass)

    @property
    def grounded(self) -> bool:
        """Whether the stiffness matrix holds any rigid motion (springs to the ground inside)."""
        return self.rigid_motions < 6

    @property
    def mass_kind(self) -> str:
        """'lumped' if the mass matrix is diagonal, else 'consistent'."""
        return "lumped" if self.mass.nnz == np.count_nonzero(self.mass.diagonal()) else "consistent"

    def nearest_node(self, position: ArrayLike) -> int:
        """Return the number of the node next to `position` (3,), mesh coordinates [m]."""
        target = np.asarray(position, dtype=float)
        if target.shape != (3,) or not np.all(np.isfinite(target)):
            raise ValueError(f"position: needs three finite coordinates [m], got {position!r}")
        return int(np.argmin(np.linalg.norm(self.nodes - target, axis=1)))

    def add_point_mass(self, position: ArrayLike, mass: float) -> SolidRotor:
        """Return the rotor with `mass` [kg] added to the node next to `position` [m].

        The distance to that node is kept in :attr:`point_masses`. A negative mass takes material
        away.

        Raises
        ------
        ValueError
            If the mass is zero or not finite, more is taken away than the node carries, the
            position is not finite, or the rotor carries a prestress, whose load would change.
        """
        check_unstressed(self)
        node = self.nearest_node(position)
        matrix = matrices.frozen(add_nodal_mass(self.mass, node, mass))
        distance = float(np.linalg.norm(self.nodes[node] - np.asarray(position, dtype=float)))
        placed = PointMass(position, node, float(mass), distance)
        return replace(self, mass=matrix, point_masses=(*self.point_masses, placed))

    def with_interface(
        self, name: str, nodes: Sequence[int], weights: Sequence[float] | None = None
    ) -> SolidRotor:
        """Return the rotor with one more interface on `nodes`; equal weights by default.

        Raises
        ------
        TypeError
            If node numbers are not integers.
        ValueError
            If the name is taken, or nodes or weights are not valid.
        """
        if name in self.interfaces:
            raise ValueError(f"interface {name!r} exists already; choose another name")
        added = _interface(name, self.nodes, nodes, weights)
        return replace(self, interfaces={**self.interfaces, name: added})

    def center_interfaces(self, names: Iterable[str] | None = None) -> SolidRotor:
        """Return the rotor with the reference points of interfaces moved onto the spin axis.

        This removes the false eccentricity that an uneven mesh gives a round face.

        Parameters
        ----------
        names : iterable of str, optional
            All interfaces by default.

        Raises
        ------
        ValueError
            If an interface is unknown.
        """
        chosen = list(self.interfaces if names is None else names)
        unknown = [name for name in chosen if name not in self.interfaces]
        if unknown:
            raise ValueError(f"interfaces {unknown} are unknown; there are {list(self.interfaces)}")
        moved = {}
        for name in chosen:
            interface = self.interfaces[name]
            moved[name] = interface.centered_on(self.axis.project(interface.center))
        return replace(self, interfaces={**self.interfaces, **moved})

    def reduce(
        self,
        modes: ModeSource,
        *,
        stress: bool = False,
        keep_shapes: bool = True,
        rank_tolerance: float = 1e-7,
        prestress: Prestress | bool | None = None,
    ) -> ReducedRotor:
        """Reduce the rotor to component modes and its rigid motions.

        Parameters
        ----------
        modes : int, ModeBasis, FEMinterface or ndarray, shape (3n, r)
            A number of free eigenmodes (0 for a rigid rotor), a basis made by a function of
            :mod:`exudyn_rotor.reduction`, a FEMinterface whose modes have been computed, or
            displacement columns in mesh axes [m].
        stress : bool, optional
            Also recover stress modes, for stress sensors and contour pictures.
        keep_shapes : bool, optional
            Keep the mode shapes at all nodes: needed for sensors at mesh nodes and for drawing.
        rank_tolerance : float, optional
            A column of which less than this share is new is dropped, and named in the result.
        prestress : Prestress or bool, optional
            Static stress for ``stiffening='full'``; True for :meth:`prestress` with its defaults,
            None for that which the rotor carries, if any.

        Raises
        ------
        TypeError, ValueError
            If the modes are of another kind or of another mesh, or nothing is left of them.
        """
        from exudyn_rotor.reduction.reduce import reduce_rotor

        return reduce_rotor(
            self,
            modes,
            stress=stress,
            keep_shapes=keep_shapes,
            rank_tolerance=rank_tolerance,
            prestress=prestress,
        )

    def summary(self) -> str:
        """Return size, mass, supports, interfaces and point masses as lines of text."""
        return summary(self)

    def __repr__(self) -> str:
        return (
            f"SolidRotor({self.node_count} nodes, {self.total_mass:.6g} kg, "
            f"interfaces {list(self.interfaces)}, {self.rigid_motions} rigid motions free)"
        )


def _interface(
    name: str, nodes: np.ndarray, numbers: Sequence[int], weights: Sequence[float] | None
) -> Interface:
    numbers = matrices.as_node_numbers(name, numbers, len(nodes))
    shares = matrices.as_weights(name, weights, numbers.size)
    return Interface(name, numbers, shares, nodes[numbers])


def _node_set(entry: Any) -> NodeSet:
    """Read one entry of ``from_matrices(interfaces=…)``: nodes, or (nodes, weights)."""
    if isinstance(entry, tuple) and len(entry) == 2 and np.ndim(entry[0]) == 1:
        return entry
    return entry, None
