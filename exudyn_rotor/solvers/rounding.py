"""What rounding leaves of forces that should cancel."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

# multiple of eps ‖K‖∞ ‖u‖, which was 1 to 5 times that for 15 000 to 200 000 coordinates
_MULTIPLE = 100.0
_EPS = np.finfo(float).eps


def row_norm(matrix: sp.csr_array) -> float:
    """Return the largest row sum of absolute values, ``‖A‖∞``."""
    sizes = sp.csr_array((np.abs(matrix.data), matrix.indices, matrix.indptr), shape=matrix.shape)
    return float((sizes @ np.ones(matrix.shape[1])).max(initial=0.0))


def rounding_unit(stiffness: sp.csr_array, precision: float = _EPS) -> float:
    """Return the rounding error to allow in ``K u`` for a displacement of norm 1 [N]."""
    return _MULTIPLE * precision * row_norm(stiffness)


def rounding(
    stiffness: sp.csr_array, displacement: np.ndarray, precision: float = _EPS
) -> np.ndarray:
    """Return the rounding error to allow in ``K u``, one force norm per column [N]."""
    return rounding_unit(stiffness, precision) * np.linalg.norm(displacement, axis=0)
