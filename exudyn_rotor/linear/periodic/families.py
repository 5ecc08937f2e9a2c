"""Families of motions of periodic equations: copies ``λ + i n pΩ`` of one, and its conjugate."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.periodic.harmonics import shifted

# distance of the exponents of two members of a family, as a share of their step
_SAME_FAMILY = 1e-3
Mode = tuple[complex, np.ndarray]


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
    size, step = shapes.shape[1], abs(base)
    accepted: list[int] = []
    alone: list[bool] = []  # where a family is its own conjugate
    # those accepted, and their conjugates where these are other families
    known_values = np.zeros(2 * size + 1, dtype=complex)
    known_shapes = np.zeros((2 * size + 1, *shapes.shape[:2]), dtype=complex)
    weight = 0
    for index in order:
        if weight >= 2 * size:
            break
        mode = values[index], shapes[:, :, index]
        if _is_known(mode, known_values[:weight], known_shapes[:weight], base, _SAME_FAMILY * step):
            continue
        other = _conjugate(mode)
        own_pair = (
            mode[0].imag == 0.0
            or (own is not None and own[index])
            or _is_known(other, mode[0], mode[1][None], base, min(resolution, _SAME_FAMILY * step))
        )
        for value, shape in [mode] if own_pair else [mode, other]:
            known_values[weight], known_shapes[weight] = value, shape
            weight += 1
        accepted.append(int(index))
        alone.append(own_pair)
    return np.array(accepted) if weight == 2 * size else None, np.array(alone, dtype=bool)


def _conjugate(mode: Mode) -> Mode:
    """Return the conjugate motion: λ̄ with the harmonics conj(X_−m)."""
    return np.conj(mode[0]), mode[1][::-1].conj()


def _is_known(
    mode: Mode, values: np.ndarray, shapes: np.ndarray, base: float, distance: float
) -> bool:
    """Return whether a motion is in the span of known ones with shifted harmonics.

    Their exponents may be `distance` apart. At the same eigenvalue, without a shift, it is another
    motion: a repeated eigenvalue.
    """
    value, vector = mode
    apart = np.atleast_1d(value - values)
    steps = np.rint(apart.imag / base)
    near = (steps != 0.0) & (np.abs(apart - 1j * steps * base) <= distance)
    copies = [shifted(shapes[i], int(steps[i])).ravel() for i in np.flatnonzero(near)]
    basis = [copy for copy in copies if np.linalg.norm(copy) > 0.5]
    if not basis:
        return False
    span, lengths, _ = np.linalg.svd(np.array(basis).T, full_matrices=False)
    span = span[:, lengths > 0.1]
    return np.linalg.norm(span.conj().T @ vector.ravel()) ** 2 > 0.5
