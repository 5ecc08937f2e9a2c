"""Scalars of a stress tensor given by components xx, yy, zz, yz, xz, xy."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

# where the six components stand in the 3 × 3 tensor
_PLACES = ((0, 5, 4), (5, 1, 3), (4, 3, 2))


def von_mises(stress: ArrayLike) -> np.ndarray:
    """Return the von Mises stress of components (…, 6), shape (…)."""
    xx, yy, zz, yz, xz, xy = np.moveaxis(np.asarray(stress, dtype=float), -1, 0)
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(normal / 2.0 + 3.0 * (yz**2 + xz**2 + xy**2))


def principal(stress: ArrayLike) -> np.ndarray:
    """Return the principal stresses of components (…, 6), largest first, shape (…, 3)."""
    tensor = np.asarray(stress, dtype=float)[..., np.array(_PLACES)]
    return np.linalg.eigvalsh(tensor)[..., ::-1]
