"""Conjugate gradients for several loads at once, to the precision of a factorisation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from tqdm import tqdm

# residual over load, and multiple of the rounding of K u that a factorisation leaves as well
PRECISE = 1e-12
_ROUNDING_SHARE = 0.1
_MOST_STEPS = 500
_TOGETHER = 16  # loads, for the memory they take
_SHOWN_FROM = 100_000  # coordinates
_TRIED = 12  # steps


def solved(
    stiffness: sp.csr_array,
    precondition: Callable[[np.ndarray], np.ndarray],
    loads: np.ndarray,
    unit: float,
    tolerance: float,
) -> np.ndarray:
    """Return ``K u = f`` by conjugate gradients.

    Parameters
    ----------
    stiffness : scipy.sparse.csr_array, shape (m, m)
        May leave motions free that the loads do not push.
    precondition : callable
        Approximate inverse, for loads of shape (m, k).
    loads : ndarray, shape (m, k)
    unit : float
        Rounding error of ``K u`` for a displacement of norm 1 [N].
    tolerance : float
        Residual over load.

    Returns
    -------
    ndarray, shape (m, k)

    Raises
    ------
    ValueError
        If the iteration does not converge.

    Notes
    -----
    Source: Hestenes, Stiefel, J. Res. Nat. Bur. Stand. 49 (1952); preconditioned as in Saad,
    "Iterative methods for sparse linear systems", Alg. 9.1.
    """
    size, count = loads.shape
    solution = np.empty_like(loads)
    bar = tqdm(total=count, desc="static solutions", disable=size < _SHOWN_FROM, leave=False)
    with bar:
        for start in range(0, count, _TOGETHER):
            part = slice(start, min(start + _TOGETHER, count))
            solution[:, part] = _together(stiffness, precondition, loads[:, part], unit, tolerance)
            bar.update(part.stop - part.start)
    return solution


def rate(
    stiffness: sp.csr_array,
    precondition: Callable[[np.ndarray], np.ndarray],
    load: np.ndarray,
) -> float:
    """Return which share of an error a step leaves, from some steps for a load (m,)."""
    rest = load[:, None]
    works, change = [], 0.0
    for _ in range(_TRIED):
        step = precondition(rest)
        works.append((rest.T @ step).item())
        change = step + (works[-1] / works[-2] if len(works) > 1 else 0.0) * change
        force = stiffness @ change
        rest = rest - works[-1] / (change.T @ force).item() * force
    return float((works[-1] / works[0]) ** (0.5 / (_TRIED - 1)))


def _together(
    stiffness: sp.csr_array,
    precondition: Callable[[np.ndarray], np.ndarray],
    loads: np.ndarray,
    unit: float,
    tolerance: float,
) -> np.ndarray:
    solution = np.zeros_like(loads)
    sizes = np.linalg.norm(loads, axis=0)
    left = np.flatnonzero(sizes > 0.0)
    rest, moved = loads[:, left].copy(), solution[:, left]
    change, work = None, None
    for _ in range(_MOST_STEPS):
        allowed = _ROUNDING_SHARE * unit * np.linalg.norm(moved, axis=0)
        limit = tolerance * sizes[left] + allowed
        open_ = np.linalg.norm(rest, axis=0) > limit
        solution[:, left[~open_]] = moved[:, ~open_]
        left, rest, moved = left[open_], rest[:, open_], moved[:, open_]
        if left.size == 0:
            return solution
        step = precondition(rest)
        earlier, work = work, np.einsum("ik,ik->k", rest, step)
        if change is not None:
            step += (work / earlier[open_]) * change[:, open_]
        change = step
        force = stiffness @ change
        length = work / np.einsum("ik,ik->k", change, force)
        moved += length * change
        rest -= length * force
    raise ValueError(
        f"the iterative solution of {left.size} static loads leaves the relative residual "
        f"{(np.linalg.norm(rest, axis=0) / sizes[left]).max():.1e} after {_MOST_STEPS} steps; "
        "use rotor.with_solver('direct'), or a mesh with less flat elements"
    )
