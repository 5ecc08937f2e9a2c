"""In which order motions stand where rounding alone would tell them apart."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.modal.whirl import BACKWARD, FORWARD

_SAME = 1e-9  # relative distance of frequencies that is none


def ranks(values: np.ndarray, errors: float | np.ndarray = 0.0) -> np.ndarray:
    """Return the rank of each value in its row (…, k), one where rounding tells some apart.

    Next to each other they are one below 1e-9 of the larger, or below the sum of twice the smaller
    of their `errors` (…, k).
    """
    order = np.argsort(values, axis=-1, kind="stable")
    ascending = np.take_along_axis(values, order, axis=-1)
    errors = np.take_along_axis(np.broadcast_to(errors, values.shape), order, axis=-1)
    near = 2.0 * np.minimum(errors[..., 1:], errors[..., :-1])
    larger = np.diff(ascending, axis=-1) > near + _SAME * np.abs(ascending[..., 1:])
    result = np.zeros_like(order)
    np.put_along_axis(result, order[..., 1:], np.cumsum(larger, axis=-1), axis=-1)
    return result


def signed_diameters(codes: np.ndarray, diameters: np.ndarray) -> np.ndarray:
    """Return the signed nodal diameters, ascending from backward to forward waves."""
    signs = np.where(codes == FORWARD, 1, np.where(codes == BACKWARD, -1, 0))
    return signs * diameters


def listed(
    values: np.ndarray,
    bounds: np.ndarray,
    inertial: np.ndarray,
    codes: np.ndarray,
    diameters: np.ndarray,
    *,
    last: np.ndarray,
    seen: bool,
) -> np.ndarray:
    """Return in which order modes stand at each speed, each (s, k): ascending in one of the frames.

    Where frequencies are one in both frames, from backward to forward waves, and by their decay.

    Parameters
    ----------
    values, bounds : ndarray
        Eigenvalues λ in the rotor frame, and how far rounding changes them [1/s].
    inertial, codes, diameters : ndarray
        Frequencies seen from outside [rad/s], whirl codes and nodal diameters.
    last : ndarray of bool
        Modes that stand behind all others.
    seen : bool
        Whether they ascend as they are seen from outside.
    """
    rotor, decay = ranks(np.abs(values.imag), bounds), ranks(-values.real, bounds)
    keys = [rotor, ranks(inertial)] if seen else [rotor]
    return np.lexsort((decay, signed_diameters(codes, diameters), *keys, last))
