"""The rotor as a finite-element model: nodes, matrices, axis, interfaces, surface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.elements import SolidElements
from exudyn_rotor.solid.model import (
    FiniteElementModel,
    check_connected,
    check_model_units,
    count_rigid_motions,
    holding_spring,
    rigid_basis,
)
from exudyn_rotor.solid.rigid_disc import STIFF, PointMass, RigidDisc, add_nodal_mass
from exudyn_rotor.solid.surface import outer_section
from exudyn_rotor.solvers.inertia_relief import SOLVERS
from exudyn_rotor.theory.axis import SpinAxis, coordinates, skew


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
        share = self.weights[:, None, None] * np.eye(3)
        shift = share - skew(self.reference - self.center) @ turn
        entries = np.concatenate([shift, turn], axis=1).transpose(1, 0, 2).ravel()
        rows = np.repeat(np.arange(6), 3 * self.nodes.size)
        columns = np.tile(coordinates(self.nodes), 6)
        return sp.csr_array((entries, (rows, columns)), shape=(6, 3 * node_count))


def rotation_moments(arms: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return ``W = −Σ w p̃ p̃``, shape (3, 3), and ``w p̃`` of every node, shape (k, 3, 3).

    The mean rotation of displacements u is ``W⁻¹ Σ w p̃ u``, with the arms p (k, 3) from the
    weighted centre; see :meth:`Interface.mean_motion`.
    """
    tildes = np.array([skew(arm) for arm in arms])
    return -np.einsum("k,kab,kbc->ac", weights, tildes, tildes), weights[:, None, None] * tildes


LOSS_LEFT_OUT = (
    "structural damping, with_damping(loss=η), belongs to one frequency at a time: only "
    "harmonic_response and unbalance_response take it. {} without it; with_damping(stiffness=η/ν) "
    "is viscous damping that is equal at the frequency ν [rad/s] seen in the rotor frame"
)

_BESIDE = 0.1  # of the elements' size and radius: how far beside a mesh a point mass may be

AxisLike = SpinAxis | str | ArrayLike
Rotor = TypeVar("Rotor", bound="FiniteElementRotor")


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
    point_masses: tuple[PointMass, ...] = ()
    rigid_motions: int = 6
    elements: SolidElements | None = None
    carried_prestress: Prestress | None = None
    mass_damping: float = 0.0
    structural_damping: float = 0.0
    discs: tuple[RigidDisc, ...] = ()
    solver: str = "auto"

    def __post_init__(self) -> None:
        nodes = matrices.as_nodes(self.nodes)
        checked = {
            "nodes": nodes,
            "mass": matrices.as_mass(self.mass, len(nodes)),
            "stiffness": matrices.as_matrix("stiffness matrix", self.stiffness, len(nodes)),
            "axis": SpinAxis.of(self.axis),
            "interfaces": _checked_interfaces(self.interfaces, nodes),
            "triangles": matrices.as_triangles(self.triangles, len(nodes)),
            "point_masses": checks.instances(self.point_masses, "point_masses", PointMass),
            "rigid_motions": checks.count(self.rigid_motions, "rigid_motions", most=6),
            "solver": checks.choice(self.solver, "solver", SOLVERS),
            "discs": checks.instances(self.discs, "discs", RigidDisc),
            "mass_damping": checks.number(self.mass_damping, "mass_damping", "1/s", least=0.0),
            "structural_damping": checks.number(
                self.structural_damping, "structural_damping", least=0.0
            ),
        }
        if self.damping is not None:
            checked["damping"] = matrices.as_matrix("damping matrix", self.damping, len(nodes))
        if self.elements is not None:
            checks.instance(self.elements, "elements", SolidElements)
        if self.carried_prestress is not None:
            checks.instance(self.carried_prestress, "carried_prestress", Prestress)
        checks.keep(self, **checked)

    @classmethod
    def _of_model(
        cls: type[Rotor], model: FiniteElementModel, axis: AxisLike, check_units: bool
    ) -> Rotor:
        """Return the rotor of a model whose arrays are checked here; as ``from_matrices``."""
        checks.flag(check_units, "check_units")
        nodes = matrices.as_nodes(model.nodes)
        mass = matrices.as_mass(model.mass, len(nodes))
        if check_units:
            check_model_units(nodes, float(mass[::3, ::3].sum()))
        if model.elements is not None:
            check_connected(nodes, mass)
        stiffness = matrices.as_matrix("stiffness matrix", model.stiffness, len(nodes))
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
            rigid_motions=count_rigid_motions(nodes, stiffness),
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
    def centrifugal_load(self) -> np.ndarray:
        """Centrifugal nodal load ``f_c = M x_⊥`` per ω², shape (3n,) [N s²]."""
        return self.mass @ self.axis.radial(self.nodes).ravel()

    def with_solver(self: Rotor, solver: str) -> Rotor:
        """Return the rotor with another solver, 'auto', 'direct' or 'iterative'.

        'direct' factorises the stiffness matrix, if the factor fits into memory. 'iterative' is for
        second-order elements of ``from_ngsolve``: a few kilobytes a node, the same steps on any
        mesh, but many where elements are flat or nearly incompressible. 'auto', the default, takes
        the quicker one that fits. Both leave the same residuals. ValueError for any other.
        """
        return replace(self, solver=solver)

    def nearest_node(self, position: ArrayLike) -> int:
        """Return the number of the node next to `position` (3,), mesh coordinates [m]."""
        target = checks.vector(position, "position", "m")
        return int(np.argmin(np.linalg.norm(self.nodes - target, axis=1)))

    def add_point_mass(self: Rotor, position: ArrayLike, mass: float) -> Rotor:
        """Return the rotor with `mass` [kg] added to the node next to `position` [m].

        The mass has the radius and the height of that node; the distance to it is kept in
        :attr:`point_masses`. A negative mass takes material away.

        Raises
        ------
        ValueError
            If the mass is not finite, more is taken away than the node carries, the
            position is not finite or not on the mesh, as the rim of a wheel of :meth:`add_disc`,
            or the rotor carries a prestress, whose load would change.
        """
        check_unstressed(self)
        node = self.nearest_node(position)
        matrix = matrices.frozen(add_nodal_mass(self.mass, node, mass))
        distance = float(np.linalg.norm(self.nodes[node] - np.asarray(position, dtype=float)))
        placed = PointMass(position, node, mass, distance)
        self._check_on_mesh(placed)
        return replace(self, mass=matrix, point_masses=(*self.point_masses, placed))

    def _check_on_mesh(self, placed: PointMass) -> None:
        """Raise ValueError if a mass is beyond the nodes that share an element with its node."""
        rows = slice(3 * placed.node, 3 * placed.node + 3)
        coupled = np.concatenate([self.mass[rows].indices, self.stiffness[rows].indices])
        around = self.nodes[np.unique(coupled // 3)]
        reach = np.linalg.norm(around - self.nodes[placed.node], axis=1).max()
        heights = (around - placed.position) @ self.axis.direction
        beyond = max(heights.min(), -heights.max())
        radius = np.linalg.norm(self.axis.radial(placed.position))
        widest = np.linalg.norm(self.axis.radial(around), axis=1).max()
        if max(placed.distance, beyond / _BESIDE) > reach or radius > (1.0 + _BESIDE) * widest:
            raise ValueError(
                f"position: needs a place on the mesh, got {placed.position.tolist()} m, "
                f"{placed.distance:.3g} m from the next node; a wheel that is not meshed has its "
                "mass by add_disc, and its unbalance by Unbalance(…) at an interface, or by a mass "
                "on the shaft's surface that is larger as its radius is smaller"
            )

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
        added = _interface(self._new_name(name), self.nodes, nodes, weights)
        return replace(self, interfaces={**self.interfaces, name: added})

    def interface_at(self: Rotor, name: str, position: float, width: float) -> Rotor:
        """Return the rotor with one more interface, on its outer surface in a band.

        The weights are area shares. The reference point is on the spin axis in the middle of the
        band, wherever the mesh has its nodes.

        Parameters
        ----------
        name : str
        position : float
            Middle of the band along the axis, from :attr:`SpinAxis.point` [m].
        width : float
            Width of the band along the axis [m]; it must hold nodes, corner or mid ones.

        Raises
        ------
        TypeError
            If the name is no text, or a length no number.
        ValueError
            If the name is taken, the rotor has no surface, or no node of it is in the band.
        """
        added = self._section(name, position, width)
        return replace(self, interfaces={**self.interfaces, name: added})

    def _new_name(self, name: str) -> str:
        if checks.label(name, "name") in self.interfaces:
            raise ValueError(f"interface {name!r} exists already; choose another name")
        return name

    def _section(self, name: str, position: float, width: float) -> Interface:
        name = self._new_name(name)
        position = checks.number(position, "position", "m")
        width = checks.number(width, "width", "m", above=0.0)
        numbers, weights = outer_section(self.nodes, self.triangles, self.axis, position, width)
        center = self.axis.point + position * self.axis.direction
        return _interface(name, self.nodes, numbers, weights).centered_on(center)

    def add_disc(
        self: Rotor,
        position: float,
        mass: float,
        inertia: ArrayLike,
        width: float,
        *,
        name: str | None = None,
    ) -> Rotor:
        """Return the rotor with a rigid disc that is not meshed, e.g. a wheel on a shaft.

        The disc holds the outer surface rigid in a band, as a wheel that is shrunk on; its mass
        and inertia have all gyroscopic and centrifugal terms. It carries its own centrifugal load
        and stresses the rotor by its motion alone. Its centre is on the spin axis in the middle of
        the band; its unbalance is an :class:`Unbalance` at `name`.

        Parameters
        ----------
        position : float
            Middle of the band along the axis, from :attr:`SpinAxis.point` [m].
        mass : float
            [kg]
        inertia : array_like, shape (2,)
            Polar and transverse moment of inertia about its centre [kg m²].
        width : float
            Width of the band [m].
        name : str, optional
            Makes the section an interface, see :meth:`interface_at`.

        Raises
        ------
        TypeError
            If an argument is of another kind.
        ValueError
            If the mass is not positive, the inertia none of a body, the name is taken, the band
            holds too few nodes, it touches another disc, or the rotor carries a prestress.
        """
        check_unstressed(self)
        section = self._section("disc" if name is None else name, position, width)
        center, nodes = section.reference, section.nodes
        if any(np.isin(disc.nodes, nodes).any() for disc in self.discs):
            raise ValueError(
                f"position: the section at {position:g} m shares nodes with another disc; add one "
                "disc with the inertia of both, or use narrower bands"
            )
        count = self.node_count
        spring = STIFF * self.stiffness.diagonal().reshape(-1, 3)[nodes].max()
        try:
            polar, transverse = checks.vector(inertia, "inertia", size=2)
        except (TypeError, ValueError) as error:
            needed = "the polar and the transverse moment, two finite numbers [kg m²]"
            raise type(error)(checks.told("inertia", needed, inertia)) from error
        along = np.outer(self.axis.direction, self.axis.direction)
        tensor = polar * along + transverse * (np.eye(3) - along)
        disc = RigidDisc(center, mass, tensor, nodes, self.nodes[nodes], spring)
        added = {} if name is None else {name: section}
        return replace(
            self,
            mass=matrices.frozen(sp.csr_array(self.mass + disc.mass_matrix(count))),
            stiffness=matrices.frozen(sp.csr_array(self.stiffness + disc.stiffness_matrix(count))),
            interfaces={**self.interfaces, **added},
            discs=(*self.discs, disc),
        )

    def center_interfaces(self: Rotor) -> Rotor:
        """Return the rotor with the reference points of its interfaces moved onto the spin axis.

        This removes the false eccentricity that an uneven mesh gives a round face.
        """
        moved = {
            name: interface.centered_on(self.axis.project(interface.center))
            for name, interface in self.interfaces.items()
        }
        return replace(self, interfaces=moved)

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
            If an interface is unknown, none is given, all nodes are on one line, or the rotor
            carries a prestress.
        """
        check_unstressed(self)
        names = checks.labels(names, "names", self.interfaces)
        held = np.unique(np.concatenate([self.interfaces[name].nodes for name in names]))
        if rigid_basis(self.nodes[held]).shape[1] < 6:
            raise ValueError(
                f"clamped: the {held.size} nodes of {list(names)} lie on one line and cannot hold "
                "rotations about it; clamp three nodes or more that do not"
            )
        moves = np.ones(self.nodes.shape)
        moves[held] = 0.0
        free = sp.diags_array(moves.ravel(), format="csr")
        springs = sp.diags_array((1.0 - moves.ravel()) * holding_spring(self.stiffness))
        stiffness = matrices.frozen(sp.csr_array(free @ self.stiffness @ free + springs))
        return replace(self, stiffness=stiffness, rigid_motions=0)

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
    return Interface(name, numbers, weights, nodes[numbers])
