"""The rotor as a finite-element model: nodes, matrices, axis, interfaces, surface."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.solid import matrices, units
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.elements import NgsolveElements
from exudyn_rotor.solid.interface import Interface
from exudyn_rotor.solid.model import FiniteElementModel, StressRecovery
from exudyn_rotor.solid.parts import check_connected
from exudyn_rotor.solid.point_mass import PointMass, add_nodal_mass
from exudyn_rotor.solid.rigid import count_rigid_motions, rigid_basis
from exudyn_rotor.theory.axis import SpinAxis

AxisLike = SpinAxis | str | ArrayLike
Rotor = TypeVar("Rotor", bound="FiniteElementRotor")

# of the largest diagonal entry: clamped nodes move by less than 1e-10 of the others, and dense
# eigenvalues, whose error is relative to the stiffest spring, keep four digits
_CLAMP = 1e6


@dataclass(frozen=True, eq=False, repr=False)
class FiniteElementRotor:
    """What a solid rotor consists of; attributes as of :class:`exudyn_rotor.SolidRotor`."""

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
    mass_damping: sp.csr_array | None = None
    structural_damping: sp.csr_array | None = None

    def __post_init__(self) -> None:
        nodes = matrices.as_nodes(self.nodes)
        checked = {
            "nodes": nodes,
            "mass": matrices.as_mass(self.mass, len(nodes)),
            "stiffness": matrices.as_stiffness(self.stiffness, len(nodes)),
            "axis": SpinAxis.of(self.axis),
            "interfaces": _checked_interfaces(self.interfaces, nodes),
            "triangles": matrices.as_triangles(self.triangles, len(nodes)),
            "point_masses": checks.instances(self.point_masses, "point_masses", PointMass),
            "rigid_motions": checks.count(self.rigid_motions, "rigid_motions", most=6),
        }
        for name in ("damping", "mass_damping", "structural_damping"):
            if getattr(self, name) is not None:
                label = "damping matrix" if name == "damping" else name
                checked[name] = matrices.as_matrix(label, getattr(self, name), len(nodes))
        if self.stress_recovery is not None:
            checks.function(self.stress_recovery, "stress_recovery")
        if self.elements is not None:
            checks.instance(self.elements, "elements", NgsolveElements)
        if self.carried_prestress is not None:
            checks.instance(self.carried_prestress, "carried_prestress", Prestress)
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    @classmethod
    def _of_model(
        cls: type[Rotor],
        model: FiniteElementModel,
        axis: AxisLike,
        check_units: bool,
        grounded: bool | None = None,
        allow_parts: bool = False,
    ) -> Rotor:
        """Return the rotor of a model whose arrays are checked here; as ``from_matrices``."""
        checks.flag(check_units, "check_units")
        checks.flag(allow_parts, "allow_parts")
        if grounded is not None:
            checks.flag(grounded, "grounded")
        nodes = matrices.as_nodes(model.nodes)
        mass = matrices.as_mass(model.mass, len(nodes))
        if check_units:
            units.check_model_units(nodes, float(mass[::3, ::3].sum()))
        stiffness = matrices.as_stiffness(model.stiffness, len(nodes))
        if not allow_parts:
            check_connected(nodes, mass, stiffness, model.elements)
        return cls(
            nodes=nodes,
            mass=mass,
            stiffness=stiffness,
            axis=axis,
            damping=model.damping,
            interfaces={
                name: _interface(name, nodes, *node_set)
                for name, node_set in model.node_sets.items()
            },
            triangles=model.triangles,
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
        return checks.read_only((self.mass[::3, ::3] @ self.nodes).sum(axis=0) / self.total_mass)

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
        target = checks.vector(position, "position", "m")
        return int(np.argmin(np.linalg.norm(self.nodes - target, axis=1)))

    def add_point_mass(self: Rotor, position: ArrayLike, mass: float) -> Rotor:
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
        placed = PointMass(position, node, mass, distance)
        return replace(self, mass=matrix, point_masses=(*self.point_masses, placed))

    def with_interface(
        self: Rotor, name: str, nodes: Sequence[int], weights: Sequence[float] | None = None
    ) -> Rotor:
        """Return the rotor with one more interface on `nodes`; equal weights by default.

        Raises
        ------
        TypeError
            If node numbers are not integers.
        ValueError
            If the name is taken, or nodes or weights are not valid.
        """
        if checks.label(name, "name") in self.interfaces:
            raise ValueError(f"interface {name!r} exists already; choose another name")
        added = _interface(name, self.nodes, nodes, weights)
        return replace(self, interfaces={**self.interfaces, name: added})

    def center_interfaces(self: Rotor, names: Iterable[str] | None = None) -> Rotor:
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
        chosen = tuple(self.interfaces) if names is None else names
        moved = {}
        for name in checks.labels(chosen, "names", self.interfaces):
            interface = self.interfaces[name]
            moved[name] = interface.centered_on(self.axis.project(interface.center))
        return replace(self, interfaces={**self.interfaces, **moved})

    def clamped(self: Rotor, names: str | Sequence[str]) -> Rotor:
        """Return the rotor with all nodes of interfaces held fixed, e.g. a blade at its root.

        The rotor is then grounded in its own frame: it needs a frame whose motion is prescribed.
        The held coordinates keep one stiff spring each and no other stiffness.

        Parameters
        ----------
        names : str or sequence of str

        Raises
        ------
        ValueError
            If an interface is unknown, none is given, all its nodes are on one line, or the rotor
            carries a prestress.
        """
        check_unstressed(self)
        names = checks.labels(names, "names", self.interfaces)
        if not names:
            raise ValueError(
                f"names: needs one interface or more of {list(self.interfaces)}, got none"
            )
        held = np.unique(np.concatenate([self.interfaces[name].nodes for name in names]))
        if rigid_basis(self.nodes[held]).shape[1] < 6:
            raise ValueError(
                f"clamped: the {held.size} nodes of {list(names)} lie on one line and cannot hold "
                "rotations about it; clamp three nodes or more that do not"
            )
        springs = np.zeros((self.node_count, 3))
        springs[held] = _CLAMP * self.stiffness.diagonal().max()
        free = matrices.without_nodes(self.stiffness, held)
        stiffness = matrices.frozen(sp.csr_array(free + sp.diags_array(springs.ravel())))
        return replace(
            self,
            stiffness=stiffness,
            rigid_motions=count_rigid_motions(self.nodes, stiffness),
            elements=None if self.elements is None else self.elements.holding(held),
        )

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({self.node_count} nodes, {self.total_mass:.6g} kg, "
            f"interfaces {list(self.interfaces)}, {self.rigid_motions} rigid motions free)"
        )


def check_unstressed(rotor: FiniteElementRotor) -> None:
    """Raise ValueError if the rotor carries a prestress."""
    if rotor.carried_prestress is not None:
        raise ValueError(
            "the rotor carries a prestress already; do this with the rotor before with_prestress"
        )


def _checked_interfaces(given: Mapping[str, Interface], nodes: np.ndarray) -> Mapping:
    checks.mapping(given, "interfaces", "Interface")
    for name, interface in given.items():
        checks.instance(interface, f"interfaces: {name!r}", Interface)
        matrices.as_node_numbers(name, interface.nodes, len(nodes))
    return checks.read_only_mapping(given)


def _interface(
    name: str, nodes: np.ndarray, numbers: Sequence[int], weights: Sequence[float] | None
) -> Interface:
    numbers = matrices.as_node_numbers(name, numbers, len(nodes))
    shares = matrices.as_weights(name, weights, numbers.size)
    return Interface(name, numbers, shares, nodes[numbers])
