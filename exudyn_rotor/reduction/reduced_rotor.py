"""The reduced rotor: small, immutable, independent of mesh objects, storable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike

import numpy as np

from exudyn_rotor.checks import read_only
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants


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
class Centrifugal:
    """Static fields about which the rotor vibrates; all of them, not modes only.

    Attributes
    ----------
    displacement : ndarray or None, shape (3n,)
        Per ω², mesh axes [m s²].
    stress : ndarray or None, shape (n, 6)
        Per ω² at the nodes, components xx, yy, zz, yz, xz, xy, mesh axes [Pa s²].
    yield_stress : float or None
        Yield stress of the material [Pa].
    constant_stress : ndarray or None, shape (n, 6)
        Stress at rest, which does not depend on the speed, components as in `stress` [Pa].
    """

    displacement: np.ndarray | None = None
    stress: np.ndarray | None = None
    yield_stress: float | None = None
    constant_stress: np.ndarray | None = None

    def __post_init__(self) -> None:
        _freeze(self, "displacement", "stress", "constant_stress")

    def stress_at(self, speed: float) -> np.ndarray | None:
        """Return the static stress at a spin speed [rad/s], with that at rest, (n, 6) [Pa]."""
        if self.stress is None:
            return None
        by_spin = speed**2 * self.stress
        return by_spin if self.constant_stress is None else self.constant_stress + by_spin


@dataclass(frozen=True, eq=False)
class ReducedRotor:
    """Rotor in a mass-orthonormal basis: the rigid motions, then the flexible modes.

    One reduced rotor serves every formulation; each picks the columns that its frame does not
    hold (:mod:`exudyn_rotor.reduction.selection`). Made by :meth:`exudyn_rotor.SolidRotor.reduce`.

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
    centrifugal : Centrifugal or None
        None when the rotor was reduced without a computed prestress, or without shapes.
    with_attachments : ReducedRotor or None
        The same rotor with static responses to loads at its interfaces beside the modes, without
        shapes: what says how much the modes leave out. None where that is not known.
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
    centrifugal: Centrifugal | None = None
    with_attachments: ReducedRotor | None = None

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
        """Return the rotor without fields at mesh nodes: the least to store and to simulate."""
        return replace(self, shapes=None, centrifugal=None)

    def static_displacement(self, speed: float) -> np.ndarray:
        """Return the static centrifugal displacement at a spin speed.

        Linear elasticity, so it grows with ω². What that leaves out is, relative to it, of the
        order of the centrifugal strain, divided by ``1 − ω²/ω_d²`` where ω_d is the speed at which
        the elastic rotor would diverge.

        Parameters
        ----------
        speed : float
            Spin speed ω [rad/s].

        Returns
        -------
        ndarray, shape (n, 3)
            Mesh axes [m], balanced by inertia relief where nothing holds the rotor.

        Raises
        ------
        TypeError
            If the speed is not one number.
        ValueError
            If the speed is not finite, or the rotor was reduced without a computed prestress.
        """
        return _speed(speed) ** 2 * self._static("displacement").reshape(-1, 3)

    def static_stress(self, speed: float) -> np.ndarray:
        """Return the static stress at a spin speed ω [rad/s], shape (n, 6) [Pa].

        That of the rotation, and the stress at rest if the prestress was given one. Components
        xx, yy, zz, yz, xz, xy at the nodes in mesh axes; accuracy and errors as
        :meth:`static_displacement`.
        """
        speed = _speed(speed)
        self._static("stress")
        return self.centrifugal.stress_at(speed)

    def _static(self, name: str) -> np.ndarray:
        field = getattr(self.centrifugal, name, None)
        if field is None:
            raise ValueError(
                f"static_{name}: the rotor was reduced without the static centrifugal field; use "
                "reduce(..., prestress=True) with an NGSolve model, and keep the shapes"
            )
        return field

    def save(self, path: str | PathLike) -> None:
        """Write the rotor to an ``.npz`` file, lossless and without pickle."""
        from exudyn_rotor.reduction.reduced_file import save_reduced

        save_reduced(self, path)

    @classmethod
    def load(cls, path: str | PathLike) -> ReducedRotor:
        """Read a rotor written by :meth:`save`; never executes code from the file."""
        from exudyn_rotor.reduction.reduced_file import load_reduced

        return load_reduced(path)

    def __repr__(self) -> str:
        return (
            f"ReducedRotor({len(self.rigid)} rigid + {self.size - len(self.rigid)} flexible modes, "
            f"{self.invariants.mass:.4g} kg, interfaces: {', '.join(self.interfaces) or 'none'})"
        )


def _speed(value: object) -> float:
    """Return a spin speed that is one finite number."""
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise TypeError(f"speed: needs one number [rad/s], got {value!r}")
    if not np.isfinite(value):
        raise ValueError(f"speed: needs a finite number [rad/s], got {value!r}")
    return float(value)


def _freeze(owner: object, *names: str) -> None:
    """Make arrays of a frozen dataclass read-only; None stays."""
    for name in names:
        if getattr(owner, name) is not None:
            object.__setattr__(owner, name, read_only(getattr(owner, name)))
