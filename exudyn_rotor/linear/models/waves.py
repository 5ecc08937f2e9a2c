"""Circumferential waves of motions that are known at points of a rotor.

The wave n of a motion turns in the rotor frame as ``exp(i(νt − nα))``, see
:mod:`exudyn_rotor.linear.modal.whirl`.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

HIGHEST = 4  # largest |n| that is looked at
_AXIAL_TERMS = 6
_RADIAL_TERMS = 2
# share of a field that others must leave over to count as new
_NEW_SHARE = 1e-2


def wave_amplitudes(
    fits: Mapping[int, np.ndarray], motion: np.ndarray
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the waves n from −4 to 4, and the amplitudes (p, c) of each per coordinate.

    Parameters
    ----------
    fits : mapping of int to ndarray
        Of :func:`wave_fits`, up to |l| = 5.
    motion : ndarray, shape (3s, c)
        Displacement of the points along (n1, n2, e) per coordinate.
    """
    u1, u2, ue = motion.reshape(motion.shape[0] // 3, 3, -1).transpose(1, 0, 2)
    a, b = np.sqrt(0.5) * (u1 + 1j * u2), np.sqrt(0.5) * (u1 - 1j * u2)
    orders = np.arange(-HIGHEST, HIGHEST + 1)
    # in Cartesian components the wave n has the angular dependence n − 1, n + 1 and n
    return orders, [np.vstack([fits[1 - n] @ a, fits[-1 - n] @ b, fits[-n] @ ue]) for n in orders]


def wave_fits(points: np.ndarray, highest: int) -> dict[int, np.ndarray]:
    """Return the operators (p, s) that fit waves ``exp(ilα)`` to values at points, per l.

    Least squares with the smooth fields ``r^|l| (1, r²) T_q(z) exp(ilα)``, all l together; the
    squared norm of a wave's amplitudes is its energy, summed over the points. Where the points are
    too few to tell waves apart, those of low |l| are taken.

    Parameters
    ----------
    points : ndarray, shape (s, 3)
        Coordinates along (n1, n2, e) from a point of the axis [m].
    highest : int
        Largest |l|.
    """
    x, y, z = points.T
    radius = np.hypot(x, y)
    length, widest = np.ptp(z), radius.max(initial=0.0)
    # points that are on the axis to rounding have no angle
    radius = np.where(radius <= 1e-9 * max(length, widest), 0.0, radius)
    scaled = radius / (radius.max(initial=0.0) or 1.0)
    along = np.polynomial.chebyshev.chebvander(
        2.0 * (z - z.min()) / length - 1.0 if length > 0.0 else np.zeros_like(z), _AXIAL_TERMS - 1
    )
    direction = scaled * np.exp(1j * np.arctan2(y, x))
    fields = np.hstack([along * scaled[:, None] ** (2 * p) for p in range(_RADIAL_TERMS)])
    spaces, known = [], np.zeros((len(points), 0))
    for count in range(highest + 1):
        forward = _new_fields(direction[:, None] ** count * fields, known)
        # both senses at once, so that neither is preferred: one has the conjugate fields
        both = np.hstack([forward.real, forward.imag]) * np.sqrt(2.0) if count else forward.real
        spaces.append(both)
        if count < highest:
            known = np.linalg.qr(np.hstack([known, both]))[0]
    ends = np.cumsum([space.shape[1] for space in spaces])
    # in cosines and sines, which is real; exp(±ilα) is a unitary combination of them
    fits = np.split(np.linalg.pinv(np.hstack(spaces), rcond=1e-6), ends[:-1])
    result = {0: fits[0].astype(complex)}
    for count, fit in enumerate(fits[1:], start=1):
        cosine, sine = np.split(fit, 2)
        forward = np.sqrt(0.5) * (cosine - 1j * sine)
        result |= {count: forward, -count: forward.conj()}
    return result


def _new_fields(fields: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Return an orthonormal basis of those `fields` that the columns `known` do not hold yet."""
    scale = np.linalg.norm(fields, 2)
    rest = fields - known @ (known.conj().T @ fields)
    _, lengths, turn = np.linalg.svd(rest, full_matrices=False)
    directions = turn[lengths > max(_NEW_SHARE * scale, 1e-300)].conj().T
    return np.linalg.qr(fields @ directions)[0]
