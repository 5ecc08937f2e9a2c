"""Pairs of modes in two planes, which a number of modes may cut in two.

A round rotor bends in all planes alike; an uneven mesh splits the two frequencies by little. With
one mode of a pair it is an asymmetric shaft, and where no others bend it has no backward whirl.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable

import numpy as np

from exudyn_rotor.calls import user_level
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers.lanczos import Modes
from exudyn_rotor.theory.rotating_axes import axes_of

_APART = 3e-2  # relative distance of the frequencies of a pair, at most
_ALIKE = 0.7  # share of their kinetic energy in the same places and directions, at least
_SLICES = 12  # of the rotor's length


def lowest_with_pairs(
    rotor: FiniteElementRotor,
    solve: Callable[[int], Modes],
    count: int,
    available: int,
    rows: np.ndarray | slice = slice(None),
) -> Modes:
    """Return the `count` lowest modes; with a warning where the next one is the last one's pair.

    Parameters
    ----------
    rotor : FiniteElementRotor
    solve : callable
        Squared frequencies, ascending, and modes by their number.
    count, available : int
    rows : ndarray of int or slice
        Coordinates of the rotor in which the modes are; they are zero in the others.
    """
    asked = min(count + count % 2, available)
    values, modes = solve(asked)
    last = count - 1
    if 0 < count < available and not _paired(rotor, rows, values, modes, last, range(last)):
        if asked == count:
            values, modes = solve(count + 1)
        if _paired(rotor, rows, values, modes, last, [count]):
            first, second = np.sqrt(values[last : count + 1]) / (2.0 * np.pi)
            warnings.warn(
                f"count: mode {count} ({first:.4g} Hz) is one of a pair in two planes, and mode "
                f"{count + 1} ({second:.4g} Hz) is left out: the rotor bends as an asymmetric "
                f"shaft does, or in one plane alone; ask for {count + 1} modes",
                UserWarning,
                stacklevel=user_level(),
            )
    return values[:count], modes[:, :count]


def _paired(
    rotor: FiniteElementRotor,
    rows: np.ndarray | slice,
    values: np.ndarray,
    modes: np.ndarray,
    mode: int,
    others: Iterable[int],
) -> bool:
    """Return whether one of `others` bends as `mode` does, at nearly the same frequency."""
    frequencies = np.sqrt(np.maximum(values, 0.0))
    near = [
        i for i in others if abs(frequencies[i] - frequencies[mode]) <= _APART * frequencies[mode]
    ]
    if not near:
        return False
    energy = _energies(rotor, rows, modes[:, [mode, *near]])
    return bool((np.minimum(energy[:, :1], energy[:, 1:]).sum(axis=0) >= _ALIKE).any())


def _energies(rotor: FiniteElementRotor, rows: np.ndarray | slice, modes: np.ndarray) -> np.ndarray:
    """Return shares of kinetic energy (places and directions, k).

    Slices of the rotor, by radial, tangential and axial motion: equal for a pair, and others for
    bending, torsion and motion along the axis.
    """
    fields = np.zeros((3 * rotor.node_count, modes.shape[1]))
    fields[rows] = modes
    fields = np.einsum("ab,nak->bnk", axes_of(rotor.axis), fields.reshape(rotor.node_count, 3, -1))
    x, y, height = ((rotor.nodes - rotor.axis.point) @ axes_of(rotor.axis)).T
    angle = np.arctan2(y, x)[:, None]
    fields[0], fields[1] = (
        np.cos(angle) * fields[0] + np.sin(angle) * fields[1],
        np.cos(angle) * fields[1] - np.sin(angle) * fields[0],
    )
    place = (height - height.min()) / max(np.ptp(height), np.finfo(float).tiny)
    place = np.minimum((_SLICES * place).astype(int), _SLICES - 1)
    energy = np.zeros((_SLICES, 3, modes.shape[1]))
    weighted = rotor.mass.diagonal()[::3, None, None] * fields.transpose(1, 0, 2) ** 2
    np.add.at(energy, place, weighted)
    energy = energy.reshape(-1, modes.shape[1])
    return energy / energy.sum(axis=0)
