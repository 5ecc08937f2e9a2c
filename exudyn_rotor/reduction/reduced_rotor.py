"""The reduced rotor and its fields: small, immutable, independent of mesh objects, storable."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property, partial
from os import PathLike

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.checks import Checked, numbers
from exudyn_rotor.reduction.reduced_file import load_reduced, save_reduced
from exudyn_rotor.solid.matrices import as_triangles
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants


class ModeKind(Enum):
    """What a column of a reduced basis is; the value names it for people.

    The translations and tilts 1 and 2 are along and about n1 and n2 of
    :attr:`exudyn_rotor.SpinAxis.plane`, rotations about an axis through the centre of mass.

    Examples
    --------
    >>> ModeKind.TILT_1.value
    'tilt 1'
    """

    TRANSLATION_1 = "translation 1"
    TRANSLATION_2 = "translation 2"
    AXIAL = "translation along axis"
    SPIN = "spin"
    TILT_1 = "tilt 1"
    TILT_2 = "tilt 2"
    FREE = "free motion"  # any rigid motion that a grounded rotor still has
    ELASTIC = "mode"


# in the order of the columns of every rotor that nothing holds
RIGID_KINDS = tuple(kind for kind in ModeKind if kind not in (ModeKind.FREE, ModeKind.ELASTIC))


def rigid_names(kinds: Sequence[ModeKind]) -> tuple[str, ...]:
    """Return the names of rigid motions; those of a grounded rotor are numbered."""
    return tuple(
        f"{kind.value} {number}" if kind is ModeKind.FREE else kind.value
        for number, kind in enumerate(kinds, start=1)
    )


@dataclass(frozen=True, eq=False)
class ReducedInterface(Checked):
    """Mean motion of an interface in the reduced basis.

    Attributes
    ----------
    reference, center : ndarray, shape (3,)
        Point whose motion is reported, and weighted centre of the nodes, mesh coordinates [m].
    radius : float
        Root mean square radius of the nodes [m].
    motion : ndarray, shape (6, k)
        Displacement of the reference point and rotation vector per column, mesh axes.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, or an entry is not finite.
    """

    reference: np.ndarray = numbers(3)
    center: np.ndarray = numbers(3)
    radius: float
    motion: np.ndarray = numbers(6, "columns")


@dataclass(frozen=True, eq=False)
class ModeShapes(Checked):
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

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, an entry is not finite, or a triangle names a node that is not there.
    """

    nodes: np.ndarray = numbers("nodes", 3)
    matrix: np.ndarray = numbers("coordinates", "columns")
    triangles: np.ndarray = numbers("triangles", "corners", dtype=int)
    stress: np.ndarray | None = numbers("nodes", 6, "columns", optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        as_triangles(self.triangles, len(self.nodes))
        if len(self.matrix) != self.nodes.size:
            raise ValueError(f"matrix: needs {self.nodes.size} rows, got {len(self.matrix)}")


@dataclass(frozen=True, eq=False)
class Centrifugal(Checked):
    """Static fields about which the rotor vibrates; all of them, not modes only.

    Attributes
    ----------
    displacement : ndarray or None, shape (3n,)
        Per ω², mesh axes [m s²].
    stress : ndarray or None, shape (n, 6)
        Per ω² at the nodes, components xx, yy, zz, yz, xz, xy, mesh axes [Pa s²].
    yield_stress : float or None
        Yield stress of the material [Pa].

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, or an entry is not finite.
    """

    displacement: np.ndarray | None = numbers("coordinates", optional=True)
    stress: np.ndarray | None = numbers("nodes", 6, optional=True)
    yield_stress: float | None = None


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
    rigid_kinds : tuple of ModeKind
        What the leading rigid columns are; empty for a grounded rotor. All others are elastic.
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
    attached : callable or None
        Returns the same rotor with static responses beside the modes, and the columns of this one
        in it, (l, k); called when :attr:`with_attachments` is first asked for, as it takes some
        solutions of the full model. None where there are no static responses.

    Raises
    ------
    TypeError, ValueError
        If something is of another kind, shapes do not fit, an entry is not finite, or a matrix that
        must be symmetric is not. With the checks of :class:`Invariants` that makes sure of a file,
        too.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor
    >>> spring = 1e6 * np.kron([[1, -1], [-1, 1]], np.diag([0, 0, 1]))
    >>> ends = [[0, 0, 0], [0, 0, 1]]
    >>> rotor = SolidRotor.from_matrices(np.eye(6), spring, ends, "z")
    >>> reduced = rotor.reduce(1)
    >>> reduced
    ReducedRotor(5 rigid + 1 flexible modes, 2 kg, interfaces: none)
    >>> reduced.labels[-1], reduced.dropped
    ('mode 1 (225.1 Hz)', ('spin',))
    >>> damped = reduced.with_damping(stiffness=1e-5)
    >>> print(np.round(np.diag(damped.invariants.D), 6))
    [ 0.  0.  0.  0.  0. 20.]
    """

    axis: SpinAxis
    center_of_mass: np.ndarray
    invariants: Invariants
    rigid_kinds: tuple[ModeKind, ...]
    interfaces: Mapping[str, ReducedInterface]
    mode_mass: np.ndarray
    dropped: tuple[str, ...] = ()
    grounded: bool = False
    shapes: ModeShapes | None = None
    centrifugal: Centrifugal | None = None
    attached: Callable[[], tuple[ReducedRotor, np.ndarray] | None] | None = None

    def __post_init__(self) -> None:
        checks.instance(self.axis, "axis", SpinAxis)
        size = checks.instance(self.invariants, "invariants", Invariants).size
        checks.mapping(self.interfaces, "interfaces", "ReducedInterface")
        for name, interface in self.interfaces.items():
            checks.instance(interface, f"interfaces[{name!r}]", ReducedInterface)
            _check_columns(interface.motion, f"interfaces[{name!r}]: motion", size)
        kinds = checks.instances(self.rigid_kinds, "rigid_kinds", ModeKind)
        repeated = len(set(kinds)) < len(kinds) and set(kinds) != {ModeKind.FREE}
        if len(kinds) > size or ModeKind.ELASTIC in kinds or repeated:
            raise ValueError(
                f"rigid_kinds: needs at most {size} rigid motions, each once, got "
                f"{[kind.name for kind in kinds]}"
            )
        checks.keep(
            self,
            center_of_mass=checks.vector(self.center_of_mass, "center_of_mass", "m"),
            rigid_kinds=kinds,
            interfaces=checks.read_only_mapping(self.interfaces),
            mode_mass=checks.symmetric(self.mode_mass, "mode_mass", size=size),
            dropped=checks.labels(self.dropped, "dropped"),
            grounded=checks.flag(self.grounded, "grounded"),
        )
        self._check_fields()

    def _check_fields(self) -> None:
        """Check fields that may be None."""
        if self.shapes is not None:
            checks.instance(self.shapes, "shapes", ModeShapes)
            _check_columns(self.shapes.matrix, "shapes: matrix", self.size)
        if self.centrifugal is not None:
            checks.instance(self.centrifugal, "centrifugal", Centrifugal)
            nodes = 0 if self.shapes is None else len(self.shapes.nodes)
            for name, width in (("displacement", 3), ("stress", 6)):
                field = getattr(self.centrifugal, name)
                if field is not None and field.size != width * nodes:
                    raise ValueError(f"centrifugal: {name}: needs the {nodes} nodes of the shapes")
        if self.attached is not None:
            checks.function(self.attached, "attached")

    @cached_property
    def _finer(self) -> tuple[ReducedRotor | None, np.ndarray | None]:
        """The finer rotor and the columns of this one in it; the full model is let go then."""
        found = None if self.attached is None else self.attached()
        known = None if found is None else partial(tuple, found)
        object.__setattr__(self, "attached", known)
        return (None, None) if found is None else found

    def __getstate__(self) -> dict[str, object]:
        """Send to other processes what is known of the finer rotor, not the full model."""
        self._finer  # noqa: B018
        return vars(self)

    @property
    def with_attachments(self) -> ReducedRotor | None:
        """The same rotor with more columns, without shapes: how much the modes leave out.

        Beside the modes it has static responses to loads at the interfaces. None where they are
        not known.
        """
        return self._finer[0]

    @property
    def in_attached(self) -> np.ndarray | None:
        """The columns of this rotor in the basis of :attr:`with_attachments`, shape (l, k).

        Orthonormal. None where that is not known.
        """
        return self._finer[1]

    @property
    def size(self) -> int:
        """Number of columns k, rigid motions included."""
        return self.invariants.S.shape[1]

    @cached_property
    def frequencies(self) -> np.ndarray:
        """Eigenfrequencies at rest of the columns [rad/s], shape (k,); zero for rigid motions."""
        return checks.read_only(np.sqrt(np.maximum(np.diag(self.invariants.K), 0.0)))

    @property
    def kinds(self) -> tuple[ModeKind, ...]:
        """What each column is."""
        elastic = self.size - len(self.rigid_kinds)
        return (*self.rigid_kinds, *(ModeKind.ELASTIC,) * elastic)

    @property
    def rigid(self) -> tuple[str, ...]:
        """Names of the leading rigid columns."""
        return rigid_names(self.rigid_kinds)

    @property
    def labels(self) -> tuple[str, ...]:
        """Readable names of the columns, with frequencies in Hz."""
        hertz = self.frequencies[len(self.rigid) :] / (2.0 * np.pi)
        return self.rigid + tuple(f"mode {i + 1} ({f:.4g} Hz)" for i, f in enumerate(hertz))

    def without_shapes(self) -> ReducedRotor:
        """Return the rotor without fields at mesh nodes: the least to store and to simulate."""
        return replace(self, shapes=None, centrifugal=None)

    def with_damping(
        self, *, mass: float = 0.0, stiffness: float = 0.0, loss: float = 0.0
    ) -> ReducedRotor:
        """Return the rotor with damping of its own material added to what it has.

        It acts in the rotor frame, where it makes a rotor unstable above a critical speed. Scenes
        and all linear analyses take Rayleigh damping by `mass` and `stiffness`; ``add_rotor`` has
        the same as ``mass_damping`` and ``stiffness_damping`` for one body. Structural damping by
        `loss` is only for :func:`harmonic_response` and :func:`unbalance_response`, see
        :meth:`exudyn_rotor.SolidRotor.with_damping`.

        Parameters
        ----------
        mass : float, optional
            Damping per modal mass [1/s]; rigid motions are not damped (:attr:`mode_mass`).
        stiffness : float, optional
            Damping per modal stiffness [s].
        loss : float, optional
            Loss factor η of structural damping: its part of the modal stiffness.

        Raises
        ------
        TypeError, ValueError
            If a factor is no number, or negative.
        """
        mass = checks.number(mass, "mass", "1/s", least=0.0)
        stiffness = checks.number(stiffness, "stiffness", "s", least=0.0)
        loss = checks.number(loss, "loss", least=0.0)
        if mass == 0.0 and stiffness == 0.0 and loss == 0.0:
            return self
        inv = self.invariants
        structural = inv.H
        if loss:
            structural = loss * inv.K + (0.0 if inv.H is None else inv.H)
        damping = inv.D + mass * self.mode_mass + stiffness * inv.K
        factors = {"mass": mass, "stiffness": stiffness, "loss": loss}
        return replace(
            self,
            invariants=replace(inv, D=damping, H=structural),
            attached=attached_by(self, lambda rotor, T: (rotor.with_damping(**factors), T)),
        )

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
        speed = checks.number(speed, "speed", "rad/s")
        return speed**2 * self._static("displacement").reshape(-1, 3)

    def static_stress(self, speed: float) -> np.ndarray:
        """Return the static stress by the rotation at a spin speed ω [rad/s], shape (n, 6) [Pa].

        Components xx, yy, zz, yz, xz, xy at the nodes in mesh axes; accuracy and errors as
        :meth:`static_displacement`.
        """
        speed = checks.number(speed, "speed", "rad/s")
        return speed**2 * self._static("stress")

    @cached_property
    def unshown_stress(self) -> np.ndarray:
        """Static stress per ω² that the columns do not show, (n, 6) [Pa s²]; zero if not known.

        The columns show the stress of their static coordinates ``ζ₀ = K⁻¹h`` per ω².
        """
        columns = getattr(self.shapes, "stress", None)
        if columns is None:
            raise ValueError(
                "stress: the rotor was reduced without stress modes; use reduce(…, stress=True) "
                "with a model from NGSolve, and keep the shapes"
            )
        static = getattr(self.centrifugal, "stress", None)
        if static is None:
            return np.zeros(columns.shape[:2])
        offset = self.axis.project(self.center_of_mass) - self.center_of_mass
        rigid, share = len(self.rigid), np.zeros(self.size)
        load = self.invariants.moved(offset).h
        share[rigid:] = load[rigid:] / np.diag(self.invariants.K)[rigid:]
        return static - columns @ share

    def _static(self, name: str) -> np.ndarray:
        field = getattr(self.centrifugal, name, None)
        if field is None:
            raise ValueError(
                f"static_{name}: the rotor was reduced without the static centrifugal field; use "
                "reduce(..., prestress=True) with an NGSolve model, and keep the shapes"
            )
        return field

    def save(self, path: str | PathLike) -> None:
        """Write the rotor to an ``.npz`` file, lossless and without pickle.

        A file of that name is replaced only by a complete one.

        Raises
        ------
        TypeError
            If `path` is no path.
        OSError
            If the folder does not exist, `path` is a folder or read-only, or the disk is full.
        """
        save_reduced(self, path)

    @classmethod
    def load(cls, path: str | PathLike) -> ReducedRotor:
        """Read a rotor written by :meth:`save`; never executes code from the file.

        Raises
        ------
        TypeError
            If `path` is no path.
        OSError
            If there is no such file.
        ValueError
            If the file holds no reduced rotor, is damaged, or was written by another version.
        """
        classes = (cls, ModeKind, ReducedInterface, ModeShapes, Centrifugal)
        return load_reduced(path, classes)

    def __repr__(self) -> str:
        return (
            f"ReducedRotor({len(self.rigid)} rigid + {self.size - len(self.rigid)} flexible modes, "
            f"{self.invariants.mass:.4g} kg, interfaces: {', '.join(self.interfaces) or 'none'})"
        )


def _check_columns(matrix: np.ndarray, name: str, size: int) -> None:
    if matrix.shape[1] != size:
        raise ValueError(f"{name}: needs one column for each of {size}, got {matrix.shape[1]}")


def attached_by(reduced: ReducedRotor, change: Callable) -> Callable | None:
    """Return ``attached`` of another rotor: `change` of the finer rotor and its columns."""
    if reduced.attached is None:
        return None

    def finer() -> tuple[ReducedRotor, np.ndarray] | None:
        rotor, columns = reduced.with_attachments, reduced.in_attached
        return None if rotor is None else change(rotor, columns)

    return finer
