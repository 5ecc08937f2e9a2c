"""Hill's equations of many motions at once, solved harmonic by harmonic.

Coefficients with harmonics up to r couple a harmonic with r others to each side. In groups of r
harmonics, beside one in the middle, ``H(λ)`` is block tridiagonal, and what is outside a group i
acts on it through

    S_i = H_ii − H_i,i+1 S_i+1⁻¹ H_i+1,i

which begins at the outermost harmonics on both sides and ends in the middle, where a motion is
strongest. Only the motions B at places with periodic coefficients are coupled,
``H_i,i+1 = B c_i,i+1 Bᵀ``: of an inverse, ``S_i+1⁻¹ B`` is all that is needed. Source: matrix
continued fractions, Risken, The Fokker-Planck Equation (1989), Sect. 9.3.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import zgetrf, zgetrs

from exudyn_rotor.linear.periodic.harmonics import spacing
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem


def solved(
    system: PeriodicSystem,
    orders: np.ndarray,
    values: np.ndarray,
    loads: np.ndarray,
    forces: np.ndarray,
) -> np.ndarray:
    """Return ``H(λ)⁻¹ F`` and ``H(λ)⁻ᴴ G`` of harmonics F and G (h, k, j), shape (2, h, k, j).

    The harmonics `orders` (h,) go from −N to N; of each motion λ is one of `values` (j,). NaN where
    a matrix is singular.
    """
    # axes: H and Hᴴ, sides above and below the middle, motions, rows, columns
    given = np.stack([loads, forces])
    groups = _groups(len(orders), system.order // spacing(orders))
    at = [orders[group] for group in groups]
    parts = [_part(given, group) for group in groups]
    ports = [_repeated(system.ports, group.shape[1]) for group in groups]
    outer, answers, outwards = None, [], []
    for i in reversed(range(len(groups))):
        own = _blocks(system, values, at[i], at[i])
        if outer is not None:
            own = own - ports[i] @ outer[0] @ ports[i].T
        loads = parts[i]
        if i > 0:  # further in, the answers to forces at the ports are needed too
            forced = np.broadcast_to(ports[i], (*loads.shape[:3], *ports[i].shape))
            loads = np.concatenate([forced, loads], axis=-1)
        answers.append(_all_on_both_sides(own, loads))
        if i > 0:
            inward = _blocks(system.between_ports, values, at[i - 1], at[i])
            outward = _blocks(system.between_ports, values, at[i], at[i - 1])
            outwards.append(_with_adjoint(outward, inward))
            carried = _with_adjoint(inward, outward) @ (ports[i].T @ answers[-1])
            outer, load = carried[..., :-1] @ outwards[-1], ports[i - 1] @ carried[..., -1:]
            if i == 1:  # the middle has both sides
                outer, load = (X.sum(axis=1, keepdims=True) for X in (outer, load))
            parts[i - 1] = parts[i - 1] - load
    result, seen = np.empty_like(given), None
    for group, port, answer in zip(groups, ports, reversed(answers), strict=True):
        part = answer[..., -1:]
        if seen is not None:
            part = part - answer[..., :-1] @ (outwards.pop() @ seen)
        seen = port.T @ part
        shaped = part.reshape(*part.shape[:3], group.shape[1], -1)
        result[:, group] = shaped.transpose(0, 1, 3, 4, 2)
    return result


def _all_on_both_sides(matrices: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Return ``S⁻¹ F`` and ``S⁻ᴴ G`` of matrices S (…, n, n) and loads F, G (2, …, n, r)."""
    each = loads.reshape(2, -1, *loads.shape[-2:]).swapaxes(0, 1)
    found = on_both_sides(matrices.reshape(-1, *matrices.shape[-2:]), each)
    return found.swapaxes(0, 1).reshape(loads.shape)


def on_both_sides(matrices: np.ndarray, loads: np.ndarray) -> np.ndarray:
    """Return ``S⁻¹ F`` and ``S⁻ᴴ G`` of matrices S (m, n, n) and loads F, G (m, 2, n, r).

    NaN where S is singular. Complex matrices in C order are overwritten.
    """
    result = np.full(loads.shape, np.nan, dtype=complex)
    given = zip(matrices, loads[:, 0], loads[:, 1].conj(), result, strict=True)
    for matrix, load, force, answers in given:
        # LAPACK itself: one factor, of Sᵀ in its order, for both, and scipy's checks take longer
        lu, pivots, singular = zgetrf(matrix.T, overwrite_a=True)
        if not singular:
            answers[0] = zgetrs(lu, pivots, load, trans=1)[0]
            answers[1] = zgetrs(lu, pivots, force)[0]
    np.conjugate(result[:, 1], out=result[:, 1])
    return result


def _groups(count: int, reach: int) -> list[np.ndarray]:
    """Return the places of harmonics in groups (sides, g), of which only neighbours are coupled.

    The middle comes first, with one side.
    """
    middle, reach = count // 2, max(reach, 1)
    first = min(middle, reach // 2) + 1
    groups = [middle + np.arange(1 - first, first)[None]]
    for start in range(first, middle + 1, reach):
        beside = np.arange(start, min(start + reach, middle + 1))
        groups.append(np.array([middle + beside, middle - beside]))
    return groups


def _blocks(
    system: PeriodicSystem, values: np.ndarray, rows: np.ndarray, columns: np.ndarray
) -> np.ndarray:
    """Return H(λ) between harmonics, rows (s, a) and columns (t, b), shape (…, j, a k, b k)."""
    counts, size, speeds = (rows.shape[1], columns.shape[1]), system.size, 1j * system.speed
    sides = max(len(rows), len(columns))
    rows, columns = (X if len(X) > 1 else X.repeat(sides, 0) for X in (rows, columns))
    if counts == (1, 1) and np.array_equal(rows, columns):
        rates = (values + speeds * columns).ravel()
        return system.dynamic(0, rates).reshape(sides, len(values), size, size)
    shape = sides, len(values), counts[0], size, counts[1], size
    result = np.zeros(shape, dtype=complex)
    for side, row, column in np.ndindex(sides, *counts):
        m = columns[side, column]
        block = system.dynamic(int(rows[side, row] - m), values + speeds * m)
        if block is not None:
            result[side, :, row, :, column] = block
    return result.reshape(sides, len(values), *(count * size for count in counts))


def _repeated(ports: np.ndarray, count: int) -> np.ndarray:
    """Return the motions (k, p) in each of some harmonics, shape (count k, count p)."""
    blocks = np.zeros((count, len(ports), count, ports.shape[1]))
    blocks[range(count), :, range(count)] = ports
    return blocks.reshape(count * len(ports), -1)


def _part(motions: np.ndarray, group: np.ndarray) -> np.ndarray:
    """Return harmonics of motions (2, h, k, j) in one group, shape (2, sides, j, g k, 1)."""
    parts = motions[:, group].transpose(0, 1, 4, 2, 3)
    return parts.reshape(*parts.shape[:3], -1, 1)


def _with_adjoint(X: np.ndarray, Y: np.ndarray) -> np.ndarray:
    """Return blocks of H and those of Hᴴ at the same place, from the mirrored ones of H."""
    return np.stack([X, Y.conj().swapaxes(-1, -2)])
