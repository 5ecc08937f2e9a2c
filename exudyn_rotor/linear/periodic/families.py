"""Families of motions of periodic equations: copies ``λ + i n pΩ`` of one, and its conjugate."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.periodic.harmonics import shifted

# distance of the exponents of two members of a family, as a share of their step
_SAME_FAMILY = 1e-3


def one_of_each_pair(
    values: np.ndarray,
    shapes: np.ndarray,
    order: np.ndarray,
    base: float,
    resolution: float,
    own: np.ndarray | None = None,
) -> tuple[np.ndarray | None, np.ndarray]:
    """Return the columns of one motion for each pair of families, and whether it is its own one.

    None for the columns where some are not found. A family that is its own conjugate counts once.
    Two of them may share their shape, as 0 and −c/m of a motion that only a damper resists.

    Parameters
    ----------
    values, shapes : ndarray, shapes (j,), (h, c, j)
        λ and harmonics of unit length.
    order : ndarray of int
        Which motions to look at, the best first.
    base : float
        pΩ [rad/s].
    resolution : float
        Eigenvalues closer than this cannot be told apart [1/s].
    own : ndarray of bool, shape (j,), optional
        Motions known to be of families that are their own conjugates.
    """
    size, count, distance = shapes.shape[1], len(values), _SAME_FAMILY * abs(base)
    # places of motions, and behind them those of their conjugates
    every = np.concatenate([values, values.conj()])
    raised = _steps(values[order][:, None], every, base, distance)
    turned = _steps(values.conj(), values, base, min(resolution, distance))

    def copy(place: int, steps: int) -> np.ndarray:
        shape = shapes[:, :, place % count]
        return shifted(shape if place < count else _conjugate(shape), steps).ravel()

    def is_own(place: int) -> bool:
        if values[place].imag == 0.0 or (own is not None and own[place]):
            return True
        steps = turned[place]
        return bool(steps) and _in_span(copy(count + place, 0), [copy(place, steps)])

    # those accepted, and their conjugates where these are other families
    known = np.zeros(2 * count, dtype=bool)
    accepted: list[int] = []
    alone: list[bool] = []  # where a family is its own conjugate
    for index, steps in zip(order, raised, strict=True):
        if np.count_nonzero(known) >= 2 * size:
            break
        copies = [copy(place, steps[place]) for place in np.flatnonzero(known & (steps != 0))]
        if copies and _in_span(shapes[:, :, index].ravel(), copies):
            continue
        accepted.append(int(index))
        alone.append(is_own(index))
        known[index], known[count + index] = True, not alone[-1]
    found = np.array(accepted) if np.count_nonzero(known) == 2 * size else None
    return found, np.array(alone, dtype=bool)


def _conjugate(shape: np.ndarray) -> np.ndarray:
    """Return the harmonics conj(X_−m) of the conjugate motion, of λ̄."""
    return shape[::-1].conj()


def _steps(values: np.ndarray, others: np.ndarray, base: float, distance: float) -> np.ndarray:
    """Return by how many pΩ exponents are above others, where that is so but for a `distance`.

    0 elsewhere: at the same eigenvalue, without a shift, it is another motion, a repeated one.
    """
    apart = values - others
    steps = np.rint(apart.imag / base)
    return np.where(np.abs(apart - 1j * steps * base) <= distance, steps, 0.0).astype(int)


def _in_span(vector: np.ndarray, copies: list[np.ndarray]) -> bool:
    """Return whether a motion is in the span of copies of known ones, of which much is left."""
    basis = [copy for copy in copies if np.linalg.norm(copy) > 0.5]
    if not basis:
        return False
    if len(basis) == 1:
        return abs(np.vdot(basis[0], vector)) ** 2 > 0.5 * np.vdot(basis[0], basis[0]).real
    span, lengths, _ = np.linalg.svd(np.array(basis).T, full_matrices=False)
    span = span[:, lengths > 0.1]
    return np.linalg.norm(span.conj().T @ vector) ** 2 > 0.5
