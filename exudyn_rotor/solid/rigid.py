"""The rigid motions that a stiffness matrix leaves free."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.theory.nodal import rotations, translations

# Limits of the relative residual ‖K r‖ / ‖ |K| |r| ‖ of a rigid motion r. Measured on meshes from
# 15 000 to 108 000 coordinates, the same in SI and in mm and tonnes: a free motion leaves 1e-16;
# rounding K to d digits gives 0.4·10⁻ᵈ in nearly all rows (4e-9 for 8 digits); springs of
# 1e4 N/m at one node or on one face give 1e-9 to 1e-8, bearings of 1e8 N/m 1e-6 to 1e-4, but in
# their own rows only. Where most rows cancel far better than the whole, the residual comes from
# such supports and not from lost digits.
FREE_BELOW = 1e-9
HELD_ABOVE = 1e-5
LOCALLY_HELD_ABOVE = 1e-12
LOCAL_RATIO = 1e-3
# the same ratio in the rows of one node, from which a support counts as acting there: for certain,
# with full precision, and in terms of rounding, which is much the same at all nodes
_SUPPORTED_ABOVE = 1e-6
_SOFTLY_SUPPORTED_ABOVE = 1e-12
_ABOVE_ROUNDING = 10.0
# median cosine of forces with the motion that they resist: 0 of rounding, 1 of springs on all nodes
# and 0.58 of springs along one direction
_RESISTING = 0.3


def rigid_basis(nodes: np.ndarray) -> np.ndarray:
    """Return orthonormal columns (3n, r) spanning the rigid motions that displace any node.

    r is 6, but 5 for nodes on one line and 3 for a single node.
    """
    center = nodes.mean(axis=0)
    radius = np.sqrt(np.mean(np.sum((nodes - center) ** 2, axis=1))) or 1.0
    motions = np.hstack([translations(len(nodes)), rotations(nodes, center) / radius])
    basis, lengths, _ = np.linalg.svd(motions, full_matrices=False)
    return basis[:, : np.count_nonzero(lengths > 1e-9 * lengths[0])]


def rigid_residuals(nodes: np.ndarray, stiffness: sp.csr_array) -> tuple[np.ndarray, np.ndarray]:
    """Return how strongly `stiffness` resists the rigid motions, as a whole and in most rows.

    The motions are combined such that each is held or free by itself (singular vectors of K R).
    Forces K r are taken relative to |K| |r|, the terms that have to cancel, so that units and
    mesh size do not matter.

    Returns
    -------
    residuals, typical : ndarray, shape (r,)
        ‖K r‖ / ‖ |K| |r| ‖, and the median over the rows of |K r| / (|K| |r|).
    """
    basis = rigid_basis(nodes)
    _, _, combinations = np.linalg.svd(stiffness @ basis, full_matrices=False)
    motions = basis @ combinations.T
    forces = np.abs(stiffness @ motions)
    terms = abs(stiffness) @ np.abs(motions)
    residuals = _ratio(np.linalg.norm(forces, axis=0), np.linalg.norm(terms, axis=0))
    return residuals, np.median(_ratio(forces, terms), axis=0)


def leaves_free(nodes: np.ndarray, stiffness: sp.csr_array) -> bool:
    """Return whether `stiffness` clearly leaves a rigid motion of these nodes free."""
    residuals, typical = rigid_residuals(nodes, stiffness)
    return bool(np.any((residuals < FREE_BELOW) & ~_locally_held(residuals, typical)))


def _locally_held(residuals: np.ndarray, typical: np.ndarray) -> np.ndarray:
    return (typical < LOCAL_RATIO * residuals) & (residuals > LOCALLY_HELD_ABOVE)


def unsupported_nodes(nodes: np.ndarray, stiffness: sp.csr_array) -> np.ndarray:
    """Return at which nodes `stiffness` balances all rigid motions, shape (n,), bool.

    The others are held, or next to held ones, or carry springs to the ground: however soft, these
    take up the whole net load.
    """
    residuals, cosines = _nodal_residuals(nodes, stiffness)
    limit = max(_SOFTLY_SUPPORTED_ABOVE, _ABOVE_ROUNDING * _rounding(residuals, cosines))
    return residuals <= min(_SUPPORTED_ABOVE, limit)


def lost_digits(nodes: np.ndarray, stiffness: sp.csr_array) -> float:
    """Return the relative rounding of a stiffness matrix.

    This is 1e-16, or about 0.4·10⁻ᵈ where an export wrote d digits.
    """
    return _rounding(*_nodal_residuals(nodes, stiffness))


def _nodal_residuals(nodes: np.ndarray, stiffness: sp.csr_array) -> tuple[np.ndarray, np.ndarray]:
    """Return ‖K R‖ / ‖ |K| |R| ‖ at every node, R the rigid motions, and the cosine of K R and R.

    Both have the shape (n,).
    """
    basis = rigid_basis(nodes)
    rows = len(nodes), -1
    forces, motions = (stiffness @ basis).reshape(rows), basis.reshape(rows)
    size = np.linalg.norm(forces, axis=1)
    terms = np.linalg.norm((abs(stiffness) @ np.abs(basis)).reshape(rows), axis=1)
    work = np.sum(forces * motions, axis=1)
    return _ratio(size, terms), _ratio(work, size * np.linalg.norm(motions, axis=1))


def _rounding(residuals: np.ndarray, cosines: np.ndarray) -> float:
    """Return what rounding leaves at most nodes that are not held; there may be few of them."""
    loose = residuals <= _SUPPORTED_ABOVE
    # else springs act on most nodes, and rounding does not show
    if not loose.any() or np.median(cosines[loose]) > _RESISTING:
        return 0.0
    return float(np.median(residuals[loose]))


def count_rigid_motions(
    nodes: np.ndarray, stiffness: sp.csr_array, grounded: bool | None = None
) -> int:
    """Return how many of the six rigid motions `stiffness` leaves free.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions [m].
    stiffness : scipy.sparse.csr_array, shape (3n, 3n)
    grounded : bool, optional
        What the user knows: True if springs to the ground are inside the matrix, False if not.
        Needed only if the matrix itself does not tell.

    Returns
    -------
    int
        The dimension of the null space of K R, R the six rigid motions. A rotation that displaces
        no node (about a line that holds all nodes) counts as free.

    Raises
    ------
    ValueError
        If a motion is neither clearly free nor clearly held and `grounded` is None, or if
        `grounded` contradicts the matrix.
    """
    residuals, typical = rigid_residuals(nodes, stiffness)
    held = (residuals > HELD_ABOVE) | _locally_held(residuals, typical)
    doubtful = (residuals >= FREE_BELOW) & ~held
    if grounded is None and np.any(doubtful):
        raise ValueError(_doubt(residuals[doubtful]))
    if grounded is False and np.any(held):
        raise ValueError(
            f"stiffness matrix: grounded=False, but {np.count_nonzero(held)} rigid motions are "
            f"held (relative residual {residuals[held].max():.2g}); remove the supports from the "
            "matrix or leave grounded out"
        )
    if grounded is True and not np.any(held | doubtful):
        raise ValueError(
            "stiffness matrix: grounded=True, but all six rigid motions are free; leave grounded "
            "out or add the supports"
        )
    return 6 - int(np.count_nonzero(held | doubtful if grounded else held))


def _doubt(residuals: np.ndarray) -> str:
    return (
        f"stiffness matrix: {residuals.size} rigid motions are neither free nor held (relative "
        f"residual {residuals.max():.2g}, free is below {FREE_BELOW:g}, held above "
        f"{HELD_ABOVE:g}). Either the matrix lost digits in an export: write all 16 digits, or "
        "pass grounded=False to take it as free. Or very soft springs to the ground act on most "
        "nodes: pass grounded=True"
    )


def _ratio(values: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    return np.divide(values, sizes, out=np.zeros_like(values), where=sizes > 0.0)
