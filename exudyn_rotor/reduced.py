"""The reduced rotor: small, immutable, independent of mesh objects, storable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike

import numpy as np

from exudyn_rotor.axis import SpinAxis, read_only
from exudyn_rotor.invariants import Invariants


@dataclass(frozen=True, eq=False)
class ReducedInterface:
    """Mean motion of an interface in the reduced basis.

    Attributes
    ----------
    reference, center : ndarray, shape (3,)
        Point whose motion is reported, and weighted centre of the nodes, mesh coordinates [m].
    radius : float
        Root mean square radius of the nodes [m].
    motion : ndarray, shape (6, k)
        Displacement of the reference point and rotation vector per column, mesh axes.
    """

    reference: np.ndarray
    center: np.ndarray
    radius: float
    motion: np.ndarray

    def __post_init__(self) -> None:
        _freeze(self, "reference", "center", "motion")


@dataclass(frozen=True, eq=False)
class ModeShapes:
    """Mode shapes at mesh nodes, for sensors and drawing.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions, mesh coordinates [m].
    matrix : ndarray, shape (3n, k)
        Displacement columns, mesh axes.
    triangles : ndarray of int, shape (t, 3) or (t, 6)
    stress : ndarray or None, shape (n, 6, k)
        Stress columns xx, yy, zz, yz, xz, xy, mesh axes [Pa].
    """

    nodes: np.ndarray
    matrix: np.ndarray
    triangles: np.ndarray
    stress: np.ndarray | None = None

    def __post_init__(self) -> None:
        _freeze(self, "nodes", "matrix", "stress")
        object.__setattr__(self, "triangles", read_only(self.triangles, np.int64))


@dataclass(frozen=True, eq=False)
class ReducedRotor:
    """Rotor in a mass-orthonormal basis: the rigid motions, then the flexible modes.

    One reduced rotor serves every formulation; each picks the columns that its frame does not
    hold (:mod:`exudyn_rotor.modes.selection`). Made by :meth:`exudyn_rotor.SolidRotor.reduce`.

    Attributes
    ----------
    axis : SpinAxis
        Spin axis, mesh coordinates.
    center_of_mass : ndarray, shape (3,)
        Mesh coordinates [m].
    invariants : Invariants
        In the basis of k columns, about the centre of mass, mesh axes.
    rigid : tuple of str
        Names of the leading rigid columns; empty for a grounded rotor.
    interfaces : mapping of str to ReducedInterface
    mode_mass : ndarray, shape (k, k)
        Mass matrix of the component modes alone, the base of mass-proportional damping.
    dropped : tuple of str
        Dependent columns that were left out.
    grounded : bool
        True when the stiffness matrix holds the rotor in its own frame.
    shapes : ModeShapes or None
        None when the rotor was reduced without them: then no mesh nodes, no drawing.
    """

    axis: SpinAxis
    center_of_mass: np.ndarray
    invariants: Invariants
    rigid: tuple[str, ...]
    interfaces: Mapping[str, ReducedInterface]
    mode_mass: np.ndarray
    dropped: tuple[str, ...] = ()
    grounded: bool = False
    shapes: ModeShapes | None = None

    def __post_init__(self) -> None:
        _freeze(self, "center_of_mass", "mode_mass")

    @property
    def size(self) -> int:
        """Number of columns k, rigid motions included."""
        return self.invariants.size

    @cached_property
    def frequencies(self) -> np.ndarray:
        """Eigenfrequencies at rest of the columns [rad/s], shape (k,); zero for rigid motions."""
        return np.sqrt(np.maximum(np.diag(self.invariants.K), 0.0))

    @property
    def labels(self) -> tuple[str, ...]:
        """Readable names of the columns, with frequencies in Hz."""
        hertz = self.frequencies[len(self.rigid) :] / (2.0 * np.pi)
        return self.rigid + tuple(f"mode {i + 1} ({f:.4g} Hz)" for i, f in enumerate(hertz))

    def without_shapes(self) -> ReducedRotor:
        """Return the rotor without mode shapes: the least to store and to simulate."""
        return replace(self, shapes=None)

    def save(self, path: str | PathLike) -> None:
        """Write the rotor to an ``.npz`` file, lossless and without pickle."""
        from exudyn_rotor.storage import save_reduced

        save_reduced(self, path)

    @classmethod
    def load(cls, path: str | PathLike) -> ReducedRotor:
        """Read a rotor written by :meth:`save`; never executes code from the file."""
        from exudyn_rotor.storage import load_reduced

        return load_reduced(path)

    def __repr__(self) -> str:
        return (
            f"ReducedRotor({len(self.rigid)} rigid + {self.size - len(self.rigid)} flexible modes, "
            f"{self.invariants.mass:.4g} kg, interfaces: {', '.join(self.interfaces) or 'none'})"
        )


def _freeze(owner: object, *names: str) -> None:
    """Make arrays of a frozen dataclass read-only; None stays."""
    for name in names:
        if getattr(owner, name) is not None:
            object.__setattr__(owner, name, read_only(getattr(owner, name)))
