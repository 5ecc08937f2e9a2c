"""The fixed spin axis, and algebra of block-nodal vectors: x0 y0 z0 x1 y1 z1 …

The functions write out the matrices that the paper prints (Φ, ẽ_bd). Source of the equation
numbers: Zwölfer, Rasmussen, Santos, "Rotordynamics Local Frame Formulations for 3D Continuum Finite
Elements", SSRN 4830498.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks

Array = np.ndarray


def skew(vector: Array) -> Array:
    """Return the 3 × 3 matrix ``ṽ`` with ``ṽ u = v × u``."""
    x, y, z = np.asarray(vector, dtype=float)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def block_diagonal(block: Array, node_count: int) -> sp.csr_array:
    """Return the block-diagonal matrix ``I_n ⊗ B`` (3n × 3n), e.g. ``ẽ_bd`` (73)."""
    return sp.csr_array(sp.kron(sp.eye_array(node_count), sp.csr_array(block)))


def turned(axis: Array, columns: Array | sp.csr_array) -> Array | sp.csr_array:
    """Return ``ẽ_bd Ψ``, ``e ×`` every nodal vector of (3n × k); sparse where Ψ is."""
    block = skew(axis)
    if sp.issparse(columns):
        return block_diagonal(block, columns.shape[0] // 3) @ columns
    nodal = columns.reshape(-1, 3, columns.shape[1])
    result = np.zeros_like(nodal)
    for i, j in np.argwhere(block):
        result[:, i] += block[i, j] * nodal[:, j]
    return result.reshape(columns.shape)


def translations(node_count: int) -> Array:
    """Return ``Φ`` (3n × 3), the unit rigid translations along x, y, z (2)."""
    return np.tile(np.eye(3), (node_count, 1))


def rotations(nodes: Array, center: Array) -> Array:
    """Return the linearised unit rotations about x, y, z through `center` (3n × 3).

    Column i is the displacement ``a_i × (x − center)`` of every node.
    """
    arms = np.asarray(nodes, dtype=float) - np.asarray(center, dtype=float)
    columns = np.cross(np.eye(3)[:, None, :], arms[None, :, :])
    return columns.reshape(3, -1).T


def rigid_motions(nodes: Array, center: Array) -> Array:
    """Return the :func:`translations`, then the :func:`rotations` about `center` (3n × 6)."""
    return np.hstack([translations(len(nodes)), rotations(nodes, center)])


def coordinates(nodes: ArrayLike) -> Array:
    """Return the numbers of the coordinates x, y, z of nodes."""
    return (3 * np.asarray(nodes)[:, None] + np.arange(3)).ravel()


def coupled(matrix: sp.csr_array) -> np.ndarray:
    """Return which coordinates have entries off the diagonal, (3n,); clamped nodes have none."""
    strength = abs(matrix)
    return strength.sum(axis=1) > strength.diagonal()


_NAMED_DIRECTIONS = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


@dataclass(frozen=True, eq=False)
class SpinAxis:
    """Spin axis of a rotor in its mesh coordinates.

    Parameters
    ----------
    direction : array_like, shape (3,)
        Any non-zero vector along the axis; stored as the unit vector ``e``. The spin angle is
        positive about it (right-hand rule).
    point : array_like, shape (3,), optional
        Any point on the axis [m].

    Raises
    ------
    TypeError, ValueError
        If the direction has no length, or they are not three finite numbers each.

    Examples
    --------
    >>> from exudyn_rotor import SpinAxis
    >>> axis = SpinAxis([0, 0, 2], point=[0.1, 0, 0])
    >>> print(axis.direction, axis.radial([0.3, 0, 5]))
    [0. 0. 1.] [0.2 0.  0. ]
    >>> print(SpinAxis.of("x").plane.T)
    [[0. 1. 0.]
     [0. 0. 1.]]
    """

    direction: np.ndarray
    point: np.ndarray = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        direction = checks.vector(self.direction, "spin axis: direction")
        point = checks.vector(self.point, "spin axis: point", "m")
        length = np.linalg.norm(direction)
        if length == 0.0:
            raise ValueError(
                "spin axis: the direction [0, 0, 0] has no length; "
                "give a vector along the axis, e.g. [0, 0, 1] or 'z'"
            )
        checks.keep(self, direction=checks.read_only(direction / length), point=point)

    @classmethod
    def of(cls, axis: SpinAxis | str | ArrayLike) -> SpinAxis:
        """Read an axis: a SpinAxis, 'x', 'y', 'z', a direction, or (one of these, a point).

        Raises
        ------
        TypeError, ValueError
            If it is none of these.
        """
        if isinstance(axis, SpinAxis):
            return axis
        if isinstance(axis, tuple | list) and len(axis) == 2 and isinstance(axis[0], str):
            return cls(cls.of(axis[0]).direction, axis[1])
        if isinstance(axis, str):
            if axis not in _NAMED_DIRECTIONS:
                raise ValueError(f"spin axis {axis!r} is unknown; use 'x', 'y', 'z' or a vector")
            return cls(_NAMED_DIRECTIONS[axis])
        values = checks.array(axis, "axis: a direction, or (direction, point)")
        return cls(*values) if values.shape == (2, 3) else cls(values)

    @cached_property
    def skew(self) -> np.ndarray:
        """``ẽ``, shape (3, 3)."""
        return checks.read_only(skew(self.direction))

    @cached_property
    def plane(self) -> np.ndarray:
        """``N = null(eᵀ)`` (89), shape (3, 2): unit vectors with n1 × n2 = e.

        For the axes x, y, z these are the next two coordinate axes in cyclic order (121).
        """
        e = self.direction
        if np.count_nonzero(e) == 1:
            first = np.roll(np.abs(e), 1)
        else:
            first = np.eye(3)[np.argmin(np.abs(e))]
            first = first - e * (e @ first)
            first = first / np.linalg.norm(first)
        return checks.read_only(np.column_stack([first, np.cross(e, first)]))

    def rotation(self, angle: float) -> np.ndarray:
        """``A(θ) = I + ẽ sin θ + ẽẽ (1 − cos θ)`` (55), shape (3, 3); θ in rad."""
        angle, e = checks.number(angle, "angle", "rad"), self.skew
        return np.eye(3) + np.sin(angle) * e + (1.0 - np.cos(angle)) * (e @ e)

    def project(self, points: ArrayLike) -> np.ndarray:
        """Return the feet of the perpendiculars from `points` (…, 3) to the axis [m]."""
        values = checks.array(points, "points", "m")
        if values.ndim == 0 or values.shape[-1] != 3:
            raise ValueError(f"points: need three coordinates each, got the shape {values.shape}")
        arms = values - self.point
        return self.point + (arms @ self.direction)[..., None] * self.direction

    def radial(self, points: ArrayLike) -> np.ndarray:
        """Return the offsets (…, 3) of `points` from the axis, ``x_⊥ = −ẽẽ(x − p)`` [m]."""
        return points - self.project(points)
