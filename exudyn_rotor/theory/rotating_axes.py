"""Vectors and matrices seen from axes that turn with the rotor, as harmonics of its angle.

Axes are (n1, n2, e) of :attr:`SpinAxis.plane` and the spin axis.
"""

from __future__ import annotations

from functools import cache
from math import cos, sin

import numpy as np

from exudyn_rotor.checks import read_only
from exudyn_rotor.theory.axis import SpinAxis, skew

FRAMES = ("inertial", "rotor")
# of a vector: products, axes and a gravity along one leave 20 units of the last place, 2e-15, and
# nothing stands as upright as this
_ROUNDING = 1e-12


def axes_of(axis: SpinAxis) -> np.ndarray:
    """Return (n1, n2, e) as columns, shape (3, 3)."""
    return np.column_stack([axis.plane, axis.direction])


def parts_across(axes: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Return the parts (2,) of a vector along the first two of the axes (3, 3), columns.

    Of a vector along a skew axis rounding leaves some: these are zero.
    """
    parts = axes.T @ vector
    return np.where(np.abs(parts) > _ROUNDING * np.linalg.norm(vector), parts, 0.0)[:2]


@cache
def axial_skew(size: int) -> np.ndarray:
    """Return ``ẽ`` on whole triples along (n1, n2, e), shape (size, size)."""
    return read_only(np.kron(np.eye(size // 3), skew([0.0, 0.0, 1.0])))


def axial_rotation(angle: float, size: int = 3) -> np.ndarray:
    """Return ``R(θ)``, which turns rotor axes into inertial axes, on triples along (n1, n2, e)."""
    c, s = cos(angle), sin(angle)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    if size == 3:
        return R
    whole = np.zeros((size, size))
    for i in range(0, size, 3):  # np.kron takes ten times as long
        whole[i : i + 3, i : i + 3] = R
    return whole


@cache
def turning_harmonics(size: int) -> dict[int, np.ndarray]:
    """Return R_n of ``R(θ) = Σ R_n exp(i n θ)``, of whole triples of rows, axes (n1, n2, e).

    ``Rᵀ(θ) = R(−θ)`` has the term R_{−n} at n.
    """
    forward = 0.5 * np.array([[1.0, 1j, 0.0], [-1j, 1.0, 0.0], [0.0, 0.0, 0.0]])
    terms = {-1: forward.conj(), 0: np.diag([0.0, 0.0, 1.0]).astype(complex), 1: forward}
    return {n: read_only(np.kron(np.eye(size // 3), term), complex) for n, term in terms.items()}


def into_rotor_frame(vector: np.ndarray) -> dict[int, np.ndarray]:
    """Return the harmonics of ``Rᵀ(θ) v`` for triples v (3n,) fixed in space; none that is zero."""
    turned = {-n: R @ vector for n, R in turning_harmonics(len(vector)).items()}
    return {n: term for n, term in turned.items() if np.any(term)}
