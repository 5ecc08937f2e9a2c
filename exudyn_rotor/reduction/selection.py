"""A reduced rotor with some of its columns: those of a formulation, or fewer flexible modes.

A formulation needs the rigid modes that its frame does not hold, and no others.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.reduction.reduced_rotor import RIGID_KINDS, ModeKind, ReducedRotor, attached_by
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.invariants import Invariants

# share of their upper bound, by Cauchy and Schwarz, below which couplings and moments of mass are
# round-off, and are not evaluated in a time step; a real unbalance is far above
NEGLIGIBLE = 1e-10
_SAME = 1e-6  # share of the largest entry below which a difference of bases is round-off


@dataclass(frozen=True, eq=False)
class Selection:
    """Basis of one formulation out of a reduced rotor.

    Attributes
    ----------
    T : ndarray, shape (k, m)
        The basis of the formulation is ``Ψ = Q T`` with Q of the reduced rotor; orthonormal.
    origin : ndarray, shape (3,)
        Frame origin, mesh coordinates [m]: the centre of mass where the translation is free, else
        the foot of its perpendicular on the spin axis.
    kinds : tuple of ModeKind
        What each column is.
    labels : tuple of str
        Names of the columns, for people.
    invariants : Invariants
        In the basis Ψ, about the origin, mesh axes.
    source : ReducedRotor
        The rotor that it was taken from; see :meth:`is_of`.
    """

    T: np.ndarray
    origin: np.ndarray
    kinds: tuple[ModeKind, ...]
    labels: tuple[str, ...]
    invariants: Invariants
    source: ReducedRotor

    def is_of(self, reduced: ReducedRotor) -> bool:
        """Return whether `reduced` has the basis Q that this was taken from.

        Stored and loaded, with or without shapes, it is the same rotor. Columns that changed their
        sign are another basis.
        """
        checks.instance(reduced, "reduced", ReducedRotor)
        if self.source.rigid_kinds != reduced.rigid_kinds or self.source.size != reduced.size:
            return False
        # what is linear or bilinear in the columns, and kept without shapes
        one, two = self.source.invariants, reduced.invariants
        pairs = [(getattr(one, x), getattr(two, x)) for x in "PGCK"]
        return all(np.abs(x - y).max() <= _SAME * np.abs(x).max() for x, y in pairs)

    def __repr__(self) -> str:
        return f"Selection({len(self.labels)} of the {self.T.shape[0]} columns of {self.source!r})"


def select_modes(reduced: ReducedRotor, formulation: Formulation) -> Selection:
    """Pick the columns of `reduced` for `formulation`.

    Rigid motions held by the frame leave the basis. What remains is orthogonal to the frame's
    translations, ``S = 0``, and has no mean rotation about the axis where the frame holds the spin:
    θ is the mean rotation of the rotor, that of the node of Exudyn's body, and a torque or a spring
    on it acts as there. g then holds the unbalance, static and dynamic, and is zero in balance.

    Parameters
    ----------
    reduced : ReducedRotor
    formulation : Formulation

    Raises
    ------
    TypeError, ValueError
        When the rotor cannot be used in this formulation.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import Formulation, SolidRotor, select_modes
    >>> spring = 1e6 * np.kron([[1, -1], [-1, 1]], np.diag([0, 0, 1]))
    >>> ends = [[0, 0, 0], [0, 0, 1]]
    >>> rotor = SolidRotor.from_matrices(np.eye(6), spring, ends, "z")
    >>> select_modes(rotor.reduce(1), Formulation("free", 300.0)).labels
    ('tilt 1', 'tilt 2', 'mode 1 (225.1 Hz)')
    """
    checks.instance(reduced, "reduced", ReducedRotor, "SolidRotor.reduce(…) makes one")
    checks.instance(formulation, "formulation", Formulation)
    check_possible(formulation, reduced.grounded, ModeKind.SPIN in reduced.rigid_kinds)
    if formulation.translation_count:
        origin = reduced.center_of_mass
    else:
        origin = reduced.axis.project(reduced.center_of_mass)
    T, columns = _columns(reduced, formulation)
    invariants = reduced.invariants.in_basis(T).moved(origin - reduced.center_of_mass)
    return Selection(
        T=checks.read_only(T),
        origin=checks.read_only(origin),
        kinds=tuple(reduced.kinds[i] for i in columns),
        labels=tuple(reduced.labels[i] for i in columns),
        invariants=_without_noise(invariants),
        source=reduced,
    )


def _without_noise(invariants: Invariants) -> Invariants:
    """Put zeros for what is negligible; the columns are mass-orthonormal."""
    size = np.sqrt(invariants.mass)
    spread = np.sqrt(np.diag(invariants.J))[:, None, None]

    def cut(values: np.ndarray, bound: float | np.ndarray) -> np.ndarray:
        return np.where(np.abs(values) < NEGLIGIBLE * bound, 0.0, values)

    return replace(
        invariants,
        S=cut(invariants.S, size),
        P=cut(invariants.P, spread),
        center=cut(invariants.center, np.linalg.norm(spread) / size),
    )


def check_possible(formulation: Formulation, grounded: bool, turns: bool) -> None:
    """Refuse what a rotor cannot have: held by its stiffness, or without inertia as it `turns`."""
    if grounded and (formulation.translation_count or formulation.has_spin):
        raise ValueError(
            "the stiffness matrix holds this rotor in its own frame (grounded), and a frame "
            "without mass cannot move freely: use translation='none' and a prescribed spin"
        )
    if formulation.has_spin and not turns:
        raise ValueError(
            "the rotor has no moment of inertia about its axis, so its spin cannot be free: "
            "prescribe the spin, or give the rotor mass off the axis"
        )


def _columns(reduced: ReducedRotor, formulation: Formulation) -> tuple[np.ndarray, list[int]]:
    """Return the basis T and which columns of the reduced basis it consists of."""
    identity = np.eye(reduced.size)
    if reduced.grounded:
        return identity, list(range(reduced.size))
    held = RIGID_KINDS[: formulation.translation_count]
    holds_spin = formulation.has_spin or formulation.drive == "rigid"
    if holds_spin:
        held = (*held, ModeKind.SPIN)
    columns = [i for i, kind in enumerate(reduced.kinds) if kind not in held]
    T = identity[:, columns]
    return (without_mean_rotation(reduced, T) if holds_spin else T), columns


def without_mean_rotation(reduced: ReducedRotor, T: np.ndarray) -> np.ndarray:
    """Make columns T of a basis free of mean rotation about the axis, and orthonormal again."""
    held = mean_rotation(reduced)
    overlap = held @ T
    touched = np.abs(overlap) > 1e-14
    # the polar factor is the orthonormal set closest to the columns, so labels keep their meaning
    u, _, vt = np.linalg.svd(T[:, touched] - np.outer(held, overlap[touched]), full_matrices=False)
    result = T.copy()
    result[:, touched] = u @ vt
    return result


def mean_rotation(reduced: ReducedRotor) -> np.ndarray:
    """Return the unit vector (k,) along the columns' mean rotations about the axis."""
    elastic = [kind is ModeKind.ELASTIC for kind in reduced.kinds]
    turns = np.where(elastic, 0.0, reduced.axis.direction @ reduced.invariants.mean_rotation)
    size = np.linalg.norm(turns)
    return turns / size if size else turns


def in_basis(reduced: ReducedRotor, T: np.ndarray, rigid_kinds: Iterable[ModeKind]) -> ReducedRotor:
    """Return the rotor for combinations T (k, l) of its columns, without static responses.

    `rigid_kinds` are what the leading columns of T are.
    """
    shapes = reduced.shapes
    if shapes is not None:
        stress = None if shapes.stress is None else shapes.stress @ T
        shapes = replace(shapes, matrix=shapes.matrix @ T, stress=stress)
    return replace(
        reduced,
        invariants=reduced.invariants.in_basis(T),
        rigid_kinds=tuple(rigid_kinds),
        interfaces={
            name: replace(interface, motion=interface.motion @ T)
            for name, interface in reduced.interfaces.items()
        },
        mode_mass=T.T @ reduced.mode_mass @ T,
        shapes=shapes,
        attached=None,
    )


def without_spin(reduced: ReducedRotor) -> ReducedRotor:
    """Return a rotor none of whose motions has a mean rotation about the axis.

    So that θ(t) is that rotation, as :func:`select_modes` has it. A rotor without the rigid motion
    'spin', a grounded one for instance, is returned as it is.
    """
    if ModeKind.SPIN not in reduced.rigid_kinds:
        return reduced
    T = _beside_spin(reduced)
    kinds = [kind for kind in reduced.rigid_kinds if kind is not ModeKind.SPIN]

    def finer(rotor: ReducedRotor, columns: np.ndarray) -> tuple[ReducedRotor, np.ndarray]:
        U = _beside_spin(rotor)
        return in_basis(rotor, U, kinds), U.T @ columns @ T

    return replace(in_basis(reduced, T, kinds), attached=attached_by(reduced, finer))


def _beside_spin(reduced: ReducedRotor) -> np.ndarray:
    columns = [i for i, kind in enumerate(reduced.kinds) if kind is not ModeKind.SPIN]
    return without_mean_rotation(reduced, np.eye(reduced.size)[:, columns])


def keep_modes(reduced: ReducedRotor, indices: Sequence[int]) -> ReducedRotor:
    """Return the rotor with some of its flexible modes; rigid motions always stay.

    Parameters
    ----------
    reduced : ReducedRotor
    indices : sequence of int
        Flexible modes to keep, counted from 0: index 0 is 'mode 1' of ``reduced.labels``. Empty
        for a rigid rotor. They keep their order in `reduced`; the labels count anew.

    Returns
    -------
    ReducedRotor
        Static centrifugal fields stay complete: they are not sums of modes.

    Raises
    ------
    TypeError
        If `reduced` is not a ReducedRotor, or an index no whole number.
    ValueError
        If an index does not exist or is given twice, or nothing would be left.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, keep_modes
    >>> spring = 1e6 * np.kron([[1, -1], [-1, 1]], np.diag([0, 0, 1]))
    >>> ends = [[0, 0, 0], [0, 0, 1]]
    >>> rotor = SolidRotor.from_matrices(np.eye(6), spring, ends, "z")
    >>> keep_modes(rotor.reduce(1), [])
    ReducedRotor(5 rigid + 0 flexible modes, 2 kg, interfaces: none)
    """
    checks.instance(reduced, "reduced", ReducedRotor, "SolidRotor.reduce(…) makes one")
    rigid = len(reduced.rigid_kinds)
    count = reduced.size - rigid
    chosen = np.sort(checks.whole_numbers(indices, "indices"))
    if chosen.size and chosen[-1] >= count:
        there = f"flexible modes 0 to {count - 1}" if count else "no flexible modes"
        raise ValueError(f"indices: the rotor has {there}, got {chosen[-1]}")
    checks.different(chosen.tolist(), "indices")
    columns = np.r_[np.arange(rigid), rigid + chosen].astype(int)
    if columns.size == 0:
        raise ValueError("keep_modes: this rotor has no rigid motions; keep at least one mode")

    kept = in_basis(reduced, np.eye(reduced.size)[:, columns], reduced.rigid_kinds)
    attached = attached_by(reduced, lambda rotor, shares: (rotor, shares[:, columns]))
    return replace(kept, attached=attached)
