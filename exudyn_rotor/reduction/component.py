"""Component modes of a rotor: the columns of ``Ψ`` in ``c_f = Ψ ζ`` (16)."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from exudyn.FEM import FEMinterface

from exudyn_rotor import checks
from exudyn_rotor.calls import user_level
from exudyn_rotor.checks import Checked, numbers, words
from exudyn_rotor.reduction.reduced_rotor import RIGID_KINDS, ModeKind, rigid_names
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers import modes as eigen
from exudyn_rotor.solvers.inertia_relief import free_motions_of, inertia_relief
from exudyn_rotor.theory.axis import SpinAxis, rotations, translations

# share of a column that is new, and length of a column, of the largest, that is rounding
NEW, _NOTHING = 1e-7, 1e-12
_APART = 2e-2  # relative distance of the frequencies of a pair, at most


@dataclass(frozen=True, eq=False)
class ModeBasis(Checked):
    """Displacement modes of one mesh.

    Parameters
    ----------
    matrix : ndarray, shape (3n, k)
        One displacement field per column, mesh axes, ordered x0 y0 z0 x1 …
    labels : tuple of str
        What each column is: 'eigenmode 1', 'left translation x', …
    nodes : ndarray, shape (n, 3)
        Node positions of the mesh that the modes belong to [m].
    frequencies : ndarray, shape (k,), optional
        Angular eigenfrequency of each column [rad/s]; NaN where it is not an eigenmode.
    stress : ndarray, shape (n, 6, k), optional
        Nodal stress of each column per unit modal coordinate, components xx, yy, zz, yz, xz, xy
        in mesh axes.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit or a number that must be finite is not.

    Examples
    --------
    >>> from exudyn_rotor import ModeBasis
    >>> basis = ModeBasis([[1.0], [0], [0]], ["sideways"], nodes=[[0, 0, 0]])
    >>> print(basis.labels, basis.frequencies)
    ('sideways',) [nan]
    """

    matrix: np.ndarray = numbers("coordinates", "modes")
    labels: tuple[str, ...] = words("modes")
    nodes: np.ndarray = numbers("nodes", 3)
    frequencies: np.ndarray | None = numbers("modes", finite=False, optional=True)
    stress: np.ndarray | None = numbers("nodes", 6, "modes", optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(self.matrix) != self.nodes.size:
            raise ValueError(f"matrix: needs {self.nodes.size} rows, got {len(self.matrix)}")
        if self.frequencies is None:
            checks.keep(self, frequencies=checks.read_only(np.full(len(self.labels), np.nan)))


def free_modes(rotor: FiniteElementRotor, count: int) -> ModeBasis:
    """Return the lowest flexible eigenmodes of the rotor at rest, without bearings.

    Rigid motions that the stiffness leaves free are not among them (``rotor.rigid_motions`` says
    how many there are).

    Parameters
    ----------
    rotor : SolidRotor
    count : int
        Number of modes.

    Returns
    -------
    ModeBasis
        Mass-normalised, ascending frequencies, largest component of each mode positive.

    Raises
    ------
    TypeError, ValueError
        If there are not that many modes, parts are loose, or the iteration does not converge.

    Warns
    -----
    UserWarning
        Where the last mode is one of a pair, and the other is left out.

    Notes
    -----
    The iteration needs ``K⁻¹`` on the motions without a rigid part. Inertia relief gives it with
    no shift, so that nothing depends on a guess of the lowest frequency.

    Examples
    --------
    Two unit masses on the axis with a spring between them, ``ω² = 2k/m``:

    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, free_modes
    >>> spring = 1e6 * np.kron([[1, -1], [-1, 1]], np.diag([0, 0, 1]))
    >>> ends = [[0, 0, 0], [0, 0, 1]]
    >>> rotor = SolidRotor.from_matrices(np.eye(6), spring, ends, "z")
    >>> modes = free_modes(rotor, 1)
    >>> print(modes.labels, np.round(modes.frequencies**2))
    ('eigenmode 1',) [2000000.]
    """
    check_rotor(rotor)
    checks.count(count, "count", least=1)
    inverse = inertia_relief(rotor)
    values, modes = lowest_with_pairs(rotor.stiffness, rotor.mass, inverse, count)
    return ModeBasis(modes, numbered("eigenmode", count), rotor.nodes, frequencies=np.sqrt(values))


def lowest_with_pairs(
    stiffness: sp.csr_array,
    mass: sp.csr_array,
    inverse: eigen.Inverse,
    count: int,
    warns: bool = True,
) -> eigen.Modes:
    """Return the `count` lowest modes; it `warns` where the next one is the last one's pair.

    A round rotor bends in all planes alike; an uneven mesh splits the two frequencies by little.
    With one mode of a pair it is an asymmetric shaft.
    """
    available = mass.shape[0] - inverse.left_out
    checks.count(count, "count", most=available)
    if count == 0:
        return np.zeros(0), np.zeros((mass.shape[0], 0))
    values, modes = eigen.lowest_modes(stiffness, mass, inverse, min(count + 1, available))
    frequencies = np.sqrt(np.maximum(values, 0.0))
    apart = np.diff(frequencies)
    # where both neighbours of the last mode are near, its pair is the nearer one
    nearer = count < len(values) and (count == 1 or apart[count - 1] < apart[count - 2])
    if warns and nearer and apart[count - 1] <= _APART * frequencies[count]:
        first, second = frequencies[count - 1 : count + 1] / (2.0 * np.pi)
        warnings.warn(
            f"mode {count} ({first:.4g} Hz) is one of a pair in two planes, and mode "
            f"{count + 1} ({second:.4g} Hz) is left out: the rotor bends as an asymmetric shaft "
            f"does, or in one plane alone; ask for {count + 1} modes, of a SolidRotor by "
            f"rotor.reduce({count + 1})",
            UserWarning,
            stacklevel=user_level(),
        )
    values, modes = values[:count], modes[:, :count]
    eigen.check_modes(stiffness, mass, inverse, values, modes)
    largest = np.argmax(np.abs(modes), axis=0)
    return values, modes * np.sign(modes[largest, np.arange(count)])


def component_modes(
    rotor: FiniteElementRotor, modes: int | ModeBasis | FEMinterface | np.ndarray
) -> ModeBasis:
    """Return what ``SolidRotor.reduce`` is given as a basis of this rotor."""
    if isinstance(modes, ModeBasis):
        matrices.check_same_mesh(rotor.nodes, modes.nodes)
        return modes
    if isinstance(modes, FEMinterface):
        return fem_interface_modes(rotor, modes)
    if isinstance(modes, np.ndarray) and modes.ndim:
        columns = checks.array(modes, "modes", shape=(rotor.nodes.size, None))
        return ModeBasis(columns, numbered("column", columns.shape[1]), nodes=rotor.nodes)
    if isinstance(modes, int | np.integer) and not isinstance(modes, bool):
        count = checks.count(modes, "modes")
        if count == 0:  # a rigid rotor
            return ModeBasis(np.zeros((rotor.nodes.size, 0)), (), nodes=rotor.nodes)
        return free_modes(rotor, count)
    raise TypeError(
        f"modes: expected a number of free eigenmodes, a ModeBasis, a FEMinterface with modes, or "
        f"an array of displacement columns, got {checks.shown(modes)}"
    )


def fem_interface_modes(rotor: FiniteElementRotor, fem: FEMinterface) -> ModeBasis:
    """Return the modes that a ``FEMinterface`` of the rotor's mesh has computed.

    With stress where it has ``postProcessingModes`` of type StressLocal. Frequencies are NaN,
    because a ``FEMinterface`` does not say which modes are static.
    """
    matrix = modes_of(fem, rotor.nodes)
    stress = None
    recovered = fem.postProcessingModes
    if str(recovered.get("outputVariableType", "")).endswith("StressLocal"):
        nodes, count = len(rotor.nodes), matrix.shape[1]
        # six columns for every mode
        stress = checks.array(recovered["matrix"], "fem: its stress", shape=(nodes, 6 * count))
        stress = stress.reshape(nodes, count, 6).transpose(0, 2, 1)
    labels = numbered("FEMinterface mode", matrix.shape[1])
    return ModeBasis(matrix, labels, rotor.nodes, stress=stress)


def modes_of(fem: FEMinterface, nodes: np.ndarray) -> np.ndarray:
    """Return the modes (3n, k) of a ``FEMinterface`` with the mesh nodes (n, 3)."""
    if "matrix" not in fem.modeBasis:
        raise ValueError(
            "the FEMinterface holds no modes; call fem.ComputeEigenmodes(…) or "
            "fem.ComputeHurtyCraigBamptonModes(…) first"
        )
    matrices.check_same_mesh(nodes, np.asarray(fem.nodes.get("Position", ()), dtype=float))
    return checks.array(fem.modeBasis["matrix"], "fem: its modes", shape=(nodes.size, None))


def numbered(name: str, count: int) -> tuple[str, ...]:
    """Return 'name 1', 'name 2', …"""
    return tuple(f"{name} {number}" for number in range(1, count + 1))


def unit_columns(rotor: FiniteElementRotor, columns: np.ndarray) -> np.ndarray:
    """Return columns (3n, k) mass-normalised, without those that move nothing."""
    sizes = np.sqrt(np.einsum("ik,ik->k", columns, rotor.mass @ columns))
    return columns[:, sizes > 0.0] / sizes[sizes > 0.0]


def check_rotor(rotor: FiniteElementRotor) -> None:
    """Refuse anything that is not a solid rotor."""
    checks.instance(rotor, "rotor", FiniteElementRotor, "SolidRotor.from_ngsolve(…) makes one")


@dataclass(frozen=True, eq=False)
class OrthonormalBasis:
    """Mass-orthonormal basis of a rotor: the rigid motions first, then flexible columns.

    Columns Q (3n, k), mesh axes, ``MQ``, the diagonal (k,) of ``QᵀKQ``, which has no other entries,
    the share of every component mode in every column (r, k), zero for the rigid motions, and the
    names of component modes and rigid motions that added nothing.
    """

    matrix: np.ndarray
    momenta: np.ndarray
    stiffness: np.ndarray
    rigid_kinds: tuple[ModeKind, ...]
    from_modes: np.ndarray
    dropped: tuple[str, ...]

    @classmethod
    def of(cls, rotor: FiniteElementRotor, modes: ModeBasis) -> OrthonormalBasis:
        """Return the basis of a rotor's free rigid motions and component modes.

        A column is dropped when what is left of it, once the columns before it are taken out, is
        smaller than 1e-7 of its own norm. The flexible columns are turned so that M
        and K become diagonal on them, ascending in frequency.
        """
        motions, kinds = _rigid_motions(rotor)
        names = rigid_names(kinds) + modes.labels
        matrix, momenta, used = gram_schmidt(np.hstack([motions, modes.matrix]), rotor.mass)
        kept = tuple(kinds[i] for i in used if i < len(kinds))
        held, flexible = np.split(matrix, [len(kept)], axis=1)
        values, turn = scipy.linalg.eigh(flexible.T @ (rotor.stiffness @ flexible))
        flexible, flexible_momenta = flexible @ turn, momenta[:, len(kept) :] @ turn
        # the flexible columns are G⁺ times what the modes have beside the rigid motions
        shares = np.linalg.pinv(flexible_momenta.T @ modes.matrix)
        return cls(
            matrix=np.hstack([held, flexible]),
            momenta=np.hstack([momenta[:, : len(kept)], flexible_momenta]),
            stiffness=np.r_[np.zeros(len(kept)), values],
            rigid_kinds=kept,
            from_modes=np.hstack([np.zeros((len(shares), len(kept))), shares]),
            dropped=tuple(name for i, name in enumerate(names) if i not in used),
        )


def _rigid_motions(rotor: FiniteElementRotor) -> tuple[np.ndarray, tuple[ModeKind, ...]]:
    """Return the rigid motions that the stiffness matrix leaves free, and what they are."""
    if not rotor.grounded:
        return rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass), RIGID_KINDS
    free = free_motions_of(rotor)
    return free, (ModeKind.FREE,) * free.shape[1]


def rigid_columns(nodes: np.ndarray, axis: SpinAxis, center: np.ndarray) -> np.ndarray:
    """Return the six rigid motions (3n × 6) in the order of ``RIGID_KINDS``.

    Translations along n1, n2, e, then rotations about e, n1, n2 through `center`.
    """
    first, second = axis.plane.T
    e = axis.direction
    shifts = translations(len(nodes)) @ np.column_stack([first, second, e])
    turns = rotations(nodes, center) @ np.column_stack([e, first, second])
    return np.hstack([shifts, turns])


def gram_schmidt(
    columns: np.ndarray, mass: sp.csr_array
) -> tuple[np.ndarray, np.ndarray, list[int]]:
    """Return mass-orthonormal columns Q, ``MQ``, and which of the given columns they come from.

    Of a column that is used more than 1e-7 is new.
    """
    basis, momenta = (np.empty(columns.shape, order="F") for _ in range(2))
    lengths = np.sqrt(np.maximum(np.einsum("ik,ik->k", columns, mass @ columns), 0.0))
    used: list[int] = []
    for index, length in enumerate(lengths):
        column, count = np.array(columns[:, index], dtype=float), len(used)
        for _ in range(2):  # one pass loses orthogonality
            column -= basis[:, :count] @ (momenta[:, :count].T @ column)
        momentum = mass @ column
        norm = np.sqrt(max(column @ momentum, 0.0))
        if norm > NEW * length and length > _NOTHING * lengths.max():
            basis[:, count], momenta[:, count] = column / norm, momentum / norm
            used.append(index)
    return basis[:, : len(used)], momenta[:, : len(used)], used
