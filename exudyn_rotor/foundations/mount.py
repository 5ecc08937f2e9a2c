"""Springs and dampers between a foundation and the ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks


@dataclass(frozen=True, eq=False)
class Mount:
    """Spring and damper between a foundation and the ground.

    Parameters
    ----------
    at : str or array_like, shape (3,)
        Interface of a solid foundation, or the place on a rigid one [m].
    stiffness, damping : float or array_like, shape (3,) or (3, 3)
        A number acts alike in x, y and z, three numbers along each of them, a symmetric matrix in
        these axes [N/m], [N s/m].

    Raises
    ------
    TypeError, ValueError
        For another shape, or a matrix that is not symmetric or takes energy from nowhere.

    Examples
    --------
    >>> from exudyn_rotor import Mount
    >>> Mount([0.2, 0.0, -0.1], [1e6, 1e6, 4e6], 200.0).damping
    array([[200.,   0.,   0.],
           [  0., 200.,   0.],
           [  0.,   0., 200.]])
    """

    at: str | ArrayLike
    stiffness: float | ArrayLike
    damping: float | ArrayLike = 0.0

    def __post_init__(self) -> None:
        at = self.at
        at = checks.label(at, "at") if isinstance(at, str) else checks.vector(at, "at", "m")
        object.__setattr__(self, "at", at)
        for name, unit in (("stiffness", "N/m"), ("damping", "N s/m")):
            object.__setattr__(self, name, _in_three_axes(getattr(self, name), name, unit))


def _in_three_axes(value: float | ArrayLike, name: str, unit: str) -> np.ndarray:
    given = checks.array(value, name, unit)
    if given.shape not in ((), (3,), (3, 3)):
        raise ValueError(
            f"{name}: needs a number, three numbers or a 3 × 3 matrix [{unit}], got shape "
            f"{given.shape}"
        )
    matrix = given if given.ndim == 2 else np.diag(np.broadcast_to(given, 3))
    matrix = checks.symmetric(matrix, name, unit, size=3)
    if np.linalg.eigvalsh(matrix)[0] < -1e-9 * np.abs(matrix).max():
        raise ValueError(f"{name}: needs values ≥ 0 [{unit}], got {checks.shown(given)}")
    return matrix
