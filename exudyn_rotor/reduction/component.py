"""Component modes of a rotor: the columns of ``Ψ`` in ``c_f = Ψ ζ`` (16)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.reduction.mode_pairs import lowest_with_pairs
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers import lanczos
from exudyn_rotor.solvers.inertia_relief import (
    free_motions_of,
    inertia_relief,
    relative_rounding,
)
from exudyn_rotor.solvers.modes import lowest_modes

# of the median: beside stiffer springs dense eigenvalues of the rest lose digits
_GRADED = 1e4


@dataclass(frozen=True, eq=False)
class ModeBasis:
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

    matrix: np.ndarray
    labels: tuple[str, ...]
    nodes: np.ndarray
    frequencies: np.ndarray | None = None
    stress: np.ndarray | None = None

    def __post_init__(self) -> None:
        labels = checks.labels(self.labels, "mode basis: labels")
        nodes = checks.array(self.nodes, "mode basis: nodes", "m", shape=(None, 3))
        modes, frequencies = len(labels), self.frequencies
        frequencies = np.full(modes, np.nan) if frequencies is None else frequencies
        checked = {
            "labels": labels,
            "nodes": nodes,
            "matrix": checks.array(self.matrix, "mode basis: matrix", shape=(nodes.size, modes)),
            "frequencies": checks.array(
                frequencies, "mode basis: frequencies", "rad/s", shape=(modes,), finite=False
            ),
        }
        if self.stress is not None:
            shape = (len(nodes), 6, modes)
            checked["stress"] = checks.array(self.stress, "mode basis: stress", shape=shape)
        for name, value in checked.items():
            object.__setattr__(self, name, value)


def free_modes(rotor: FiniteElementRotor, count: int, *, tolerance: float = 1e-10) -> ModeBasis:
    """Return the lowest flexible eigenmodes of the rotor at rest, without bearings.

    Rigid motions that the stiffness leaves free are not among them (``rotor.rigid_motions`` says
    how many there are).

    Parameters
    ----------
    rotor : SolidRotor
    count : int
        Number of modes.
    tolerance : float, optional
        Relative accuracy of the iteration (not used for small models, which are solved directly).

    Returns
    -------
    ModeBasis
        Mass-normalised, ascending frequencies, largest component of each mode positive.

    Raises
    ------
    TypeError, ValueError
        If there are not that many modes, parts are loose, or the iteration misses the tolerance.

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
    >>> rotor = SolidRotor.from_matrices(np.eye(6), spring, ends, "z", grounded=False)
    >>> modes = free_modes(rotor, 1)
    >>> print(modes.labels, np.round(modes.frequencies**2))
    ('eigenmode 1',) [2000000.]
    """
    check_rotor(rotor)
    checks.tolerance(tolerance)
    stiffness, mass = rotor.stiffness, rotor.mass
    rigid = free_motions_of(rotor)
    size, rigid_count = rigid.shape
    check_count(count, size - rigid_count, smallest=1)
    graded = stiffness.diagonal().max() > _GRADED * np.median(stiffness.diagonal())

    def solve(number: int) -> lanczos.Modes:
        if lanczos.is_small(size, number) and not (graded and 4 * number <= size):
            dense = stiffness.toarray(), mass.toarray()
            return lanczos.dense_modes(*dense, number, skip=rigid_count)
        inverse = inertia_relief(rotor, rigid)
        return lowest_modes(stiffness, mass, inverse, number, tolerance)

    values, modes = lowest_with_pairs(rotor, solve, count, size - rigid_count)
    precision = relative_rounding(stiffness, rigid)
    lanczos.check_modes(stiffness, mass, values, modes, precision=precision)
    return ModeBasis(
        lanczos.with_fixed_sign(modes), eigenmode_labels(count), rotor.nodes, np.sqrt(values)
    )


def eigenmode_labels(count: int) -> tuple[str, ...]:
    """Return 'eigenmode 1', 'eigenmode 2', …"""
    return tuple(f"eigenmode {number}" for number in range(1, count + 1))


def check_count(count: int, available: int, *, smallest: int) -> None:
    """Refuse a number of eigenmodes that the model cannot have."""
    if not smallest <= checks.count(count, "count", least=smallest) <= available:
        raise ValueError(
            f"count: {count} eigenmodes asked for; this model has between {smallest} and "
            f"{available}"
        )


def check_rotor(rotor: FiniteElementRotor) -> None:
    """Refuse anything that is not a solid rotor."""
    checks.instance(rotor, "rotor", FiniteElementRotor, "SolidRotor.from_ngsolve(…) makes one")
