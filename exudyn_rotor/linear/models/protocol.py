"""What every linear model offers to the analyses, and where its equations are solved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.rotating_axes import axes_of


@dataclass(frozen=True, eq=False)
class Mesh:
    """Mesh nodes of a rotor and how they move.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Mesh coordinates [m].
    columns : ndarray or scipy.sparse.csr_array, shape (3n, k)
        Displacement of the nodes per coordinate, mesh axes.
    axis : SpinAxis
    triangles : ndarray of int, shape (t, 3) or (t, 6)
        Surface for drawing.
    """

    nodes: np.ndarray
    columns: np.ndarray | sp.csr_array
    axis: SpinAxis
    triangles: np.ndarray

    def motion(self, number: int) -> np.ndarray:
        """Return a node's displacement along (n1, n2, e), shape (6, k); no rotation."""
        rows = self.columns[3 * number : 3 * number + 3]
        rows = axes_of(self.axis).T @ (rows.toarray() if sp.issparse(rows) else rows)
        return np.vstack([rows, 0.0 * rows])


@dataclass(frozen=True, eq=False)
class PointMotions:
    """Points spread over a rotor, and how they move.

    Attributes
    ----------
    points : ndarray, shape (s, 3)
        Along (n1, n2, e) from a point of the axis [m].
    motion : ndarray, shape (3s, c)
        Displacement along (n1, n2, e) per coordinate.
    rows : ndarray of int or None
        Which coordinates these are; all by default.
    is_mesh : bool
        False where rings that move with the interfaces stand for the mesh.
    standing : ndarray, shape (p, c), or None
        Amplitudes of what stands still beside the rotor; their squares count as those of points.
    ends : tuple of int, optional
        Where the points of each of several rotors end; one rotor by default.
    """

    points: np.ndarray
    motion: np.ndarray
    rows: np.ndarray | None
    is_mesh: bool
    standing: np.ndarray | None = None
    ends: tuple[int, ...] = ()

    def share(self, mass: float) -> float:
        """Return the points that move per mass [1/kg] of a rotor."""
        return (len(self.points) - (not self.is_mesh)) / mass  # rings have one at rest


class Space(Protocol):
    """Where the equations of a model are solved: in all its coordinates, or in a subspace.

    Attributes
    ----------
    basis : ndarray, shape (k, r), or None
        The subspace as it is now; None for all coordinates.
    is_shared : bool
        True where all speeds need one and the same space: executors cannot be used.
    """

    basis: np.ndarray | None
    is_shared: bool

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations in this space at a spin speed [rad/s]."""

    def prepared(self, speeds: Sequence[float]) -> Space:
        """Return what can be sent to other processes, for these speeds [rad/s]."""

    def modes(self, speed: float, tolerance: float) -> FloquetModes:
        """Return at least the modes asked for; `tolerance` is that of :func:`floquet_modes`."""

    def modes_at(self, speeds: Sequence[float], tolerance: float) -> list[FloquetModes] | None:
        """Return the modes at all speeds at once, which is faster; None where that is not so."""

    def constant_motions(
        self, speeds: Sequence[float]
    ) -> list[tuple[FloquetModes, PeriodicSystem]] | None:
        """Return what :meth:`motions` does at all speeds of equations that do not change in time.

        None where that cannot be, or is not faster.
        """

    def motions(
        self, speed: float, method: str, tolerance: float, shapes: bool = True
    ) -> tuple[FloquetModes, PeriodicSystem]:
        """Return exponents in any order, not folded, and the equations in this space.

        With their motions in all coordinates, unless `shapes` is False.
        """

    def steady_motion(
        self, speed: float, loads: Mapping[int, np.ndarray], rate: float, tolerance: float
    ) -> dict[int, np.ndarray]:
        """Return the harmonics (k,) of the steady motion under harmonics of a load."""

    def steady_motions(
        self, speed: float, loads: Sequence[Mapping[int, np.ndarray]], rate: float, tolerance: float
    ) -> list[dict[int, np.ndarray]]:
        """Return the steady motion under each of several loads."""

    def holds(self, motions: Sequence[tuple[float, FloquetModes]]) -> bool:
        """Return whether motions at speeds meet the model's equations; if not, a subspace grows."""


class LinearModel(Protocol):
    """Linear equations of a rotor on supports or of a scene, made by :func:`linear_model`.

    Attributes
    ----------
    size : int
        Number of coordinates k.
    interfaces : tuple of str
        What can be loaded and looked at by name.
    standing : ndarray of int
        Coordinates in inertial axes, of what stands still beside the rotor.
    standing_interfaces : tuple of str
        Interfaces of that, whose motion is in inertial axes.
    voids : ndarray of int
        Coordinates of what films that conserve mass remember.
    mesh : Mesh or None
        Nodes that can be loaded and looked at.
    free_motions : tuple of str
        Rigid motions that no spring holds.
    mass_matrix : ndarray or sparse array, shape (k, k)
    unit_unbalance : ndarray, shape (k,)
        Load of the rotor's own eccentricity per Ω², rotor frame.
    is_balanced : bool
        True where that is rounding.
    has_structural_damping : bool
        True where steady motions have structural damping, which other analyses leave out.
    base_loads : ndarray, shape (3, k), or None
        Loads of unit accelerations of the ground along (n1, n2, e); None where they are not known.
    radius : float
        By which a rotation counts as a displacement [m].
    gives_all : bool
        True where analyses give all modes, False where only the lowest ones.
    is_full : bool
        True where no basis leaves anything out.
    stiffening : {'none', 'tilt', 'full'}
        Level of centrifugal stiffening.
    stiffness_varies : bool or None
        Whether the stiffness depends on the speed other than by Ω²; None where that is not known.
    table_speeds : ndarray
        Speeds of supports' tables [rad/s], at which the equations have kinks.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, linear_model
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> model = linear_model(rotor, supports=supports)
    >>> model.size, model.interfaces, model.free_motions
    (6, ('left', 'right'), ('translation along axis',))
    """

    @property
    def size(self) -> int: ...
    @property
    def interfaces(self) -> tuple[str, ...]: ...
    @property
    def standing(self) -> np.ndarray: ...
    @property
    def standing_interfaces(self) -> tuple[str, ...]: ...
    @property
    def voids(self) -> np.ndarray: ...
    @property
    def mesh(self) -> Mesh | None: ...
    @property
    def free_motions(self) -> tuple[str, ...]: ...
    @property
    def mass_matrix(self) -> np.ndarray | sp.csr_array: ...
    @property
    def unit_unbalance(self) -> np.ndarray: ...
    @property
    def is_balanced(self) -> bool: ...
    @property
    def has_structural_damping(self) -> bool: ...
    @property
    def base_loads(self) -> np.ndarray | None: ...
    @property
    def radius(self) -> float: ...
    @property
    def gives_all(self) -> bool: ...
    @property
    def is_full(self) -> bool: ...
    @property
    def stiffening(self) -> str: ...
    @property
    def stiffness_varies(self) -> bool | None: ...
    @property
    def table_speeds(self) -> np.ndarray: ...

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's motion (6, k): displacement and rotation along (n1, n2, e).

        In the rotor frame, or in inertial axes where it is one of :attr:`standing_interfaces`.
        """

    def undamped(self) -> LinearModel:
        """Return a model whose critical speeds are those without damping."""

    def point_motions(self, most: int) -> PointMotions:
        """Return up to `most` points spread over the rotor, and how they move."""

    def space(
        self,
        count: int,
        fastest: float,
        *,
        loads: Sequence[np.ndarray] = (),
        held: bool = False,
        residual: float = 1e-7,
    ) -> Space:
        """Return where to solve the equations.

        Parameters
        ----------
        count : int
            Number of modes that will be asked for.
        fastest : float
            Largest spin speed or frequency [rad/s].
        loads : sequence of ndarray, each (k,)
            Loads that will be applied.
        held : bool, optional
            Whether a spin that nothing holds follows θ = Ωt and is no coordinate.
        residual : float, optional
            Largest relative residual of the equations of the model.
        """
