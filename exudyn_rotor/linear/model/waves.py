"""Circumferential waves of motions that are known at points of a rotor.

The wave n of a motion turns in the rotor frame as ``exp(i(νt − nα))``, see
:mod:`exudyn_rotor.linear.modal.whirl`.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

HIGHEST = 4  # largest |n| that is looked at
# how many T_q(z) with each of 1, r², r⁴: shafts bend in many waves, discs have nodal circles
_AXIAL_TERMS = (10, 6, 2)
# share of a field that others must leave over to count as new: what less is left tells noise
_NEW_SHARE = 3e-2
# share of a field, squared, that those of lower waves must leave over in the points: of less the
# fit makes large fields of two waves that cancel each other
_DEPENDENT = 1e-2


def wave_amplitudes(
    points: np.ndarray, motion: np.ndarray
) -> tuple[np.ndarray, list[np.ndarray], np.ndarray]:
    """Return the waves n from −4 to 4, the amplitudes of each, and the axial ones of n = 0.

    Amplitudes (p, c) per coordinate are those of smooth fields, fitted by least squares; their
    squared norm is the energy of a wave, summed over the points.

    Parameters
    ----------
    points : ndarray, shape (s, 3)
        Coordinates along (n1, n2, e) from a point of the axis [m].
    motion : ndarray, shape (3s, c)
        Displacement of the points along (n1, n2, e) per coordinate.
    """
    spaces, told = _wave_fields(points, HIGHEST + 1)
    basis = np.hstack([space @ chosen for space, chosen in zip(spaces, told, strict=True)])
    ends = np.cumsum([space.shape[1] for space in spaces])
    fitted = la.block_diag(*told) @ np.linalg.solve(
        basis.T @ basis, basis.T @ motion.reshape(len(points), -1)
    )
    steady, *others = np.split(fitted.reshape(len(fitted), 3, -1).transpose(1, 0, 2), ends[:-1], 1)
    waves = {0: steady.astype(complex)}
    # in cosines and sines, which is real; exp(±ilα) is a unitary combination of them
    for count, fit in enumerate(others, start=1):
        cosine, sine = np.split(fit, 2, axis=1)
        forward = np.sqrt(0.5) * (cosine - 1j * sine)
        waves |= {count: forward, -count: forward.conj()}
    orders = np.arange(-HIGHEST, HIGHEST + 1)
    amplitudes = []
    for n in orders:
        # in Cartesian components the wave n has the angular dependence n − 1, n + 1 and n
        (u1, u2, _), (v1, v2, _) = waves[1 - n], waves[-1 - n]
        a, b = np.sqrt(0.5) * (u1 + 1j * u2), np.sqrt(0.5) * (v1 - 1j * v2)
        amplitudes.append(np.vstack([a, b, waves[-n][2]]))
    return orders, amplitudes, steady[2]


def _wave_fields(points: np.ndarray, highest: int) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return cosines, then sines of the fields of the waves ``exp(ilα)`` at points, (s, p) per l.

    Those of ``r^|l| (1, r², r⁴) T_q(z) exp(ilα)`` that the waves of lower |l| do not hold yet, and
    their combinations (p, q) that the points tell from these: where the points are too few to tell
    waves apart, as on the edges of a bar, they are of low |l|.
    """
    x, y, z = points.T
    radius = np.hypot(x, y)
    length, widest = np.ptp(z), radius.max(initial=0.0)
    # points that are on the axis to rounding have no angle
    radius = np.where(radius <= 1e-9 * max(length, widest), 0.0, radius)
    scaled = radius / (radius.max(initial=0.0) or 1.0)
    along = np.polynomial.chebyshev.chebvander(
        2.0 * (z - z.min()) / length - 1.0 if length > 0.0 else np.zeros_like(z),
        max(_AXIAL_TERMS) - 1,
    )
    steady = np.hstack(
        [along[:, :count] * scaled[:, None] ** (2 * p) for p, count in enumerate(_AXIAL_TERMS)]
    )
    turning = np.vander(scaled * np.exp(1j * np.arctan2(y, x)), highest + 1, increasing=True)
    fields = turning[:, :, None] * steady[:, None, :]
    parts = fields.reshape(len(points), -1).view(float)  # real beside imaginary ones
    gram = parts.T @ parts
    spaces, told, known = [], [], np.zeros((len(gram), 0))
    width = len(gram) // (highest + 1)
    for count in range(highest + 1):
        here = slice(count * width, (count + 1) * width)
        products = np.ascontiguousarray(gram[:, here]).view(complex)
        within = products[here][::2] - 1j * products[here][1::2]
        forward = _new_fields(within, known.T @ products)
        # both senses at once, so that neither is preferred: one has the conjugate fields
        both = np.sqrt(2.0) * np.vstack([forward, 1j * forward]) if count else forward
        columns = np.zeros((len(gram), len(both)))
        columns[here] = both.view(float).T
        spaces.append(parts[:, here] @ columns[here])
        columns = columns - known @ (known.T @ (gram @ columns))
        lengths, turn = np.linalg.eigh(columns.T @ gram @ columns)
        new = lengths > _DEPENDENT
        told.append(turn[:, new])
        known = np.hstack([known, columns @ turn[:, new] / np.sqrt(lengths[new])])
    return spaces, told


def _new_fields(within: np.ndarray, shared: np.ndarray) -> np.ndarray:
    """Return ``Tᴴ`` of orthonormal fields ``F T`` that others do not hold yet.

    From the Gram matrix of the fields F and their products with an orthonormal basis of the others.
    """
    lengths, turn = np.linalg.eigh(within - shared.conj().T @ shared)
    least = max(_NEW_SHARE**2 * np.linalg.eigvalsh(within)[-1], 1e-300)
    directions = turn[:, lengths > least].conj().T
    return np.linalg.solve(
        np.linalg.cholesky(directions @ within @ directions.conj().T), directions
    )


def compressed(rows: np.ndarray, least: float = 0.0) -> np.ndarray:
    """Return fewest rows of the same energy ``|R x|²``, without those of `least` or less."""
    squares, turn = np.linalg.eigh(rows.conj().T @ rows)
    chosen = squares > least
    return np.sqrt(squares[chosen])[:, None] * turn[:, chosen].conj().T
