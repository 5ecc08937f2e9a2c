"""A reduced rotor with fewer of its flexible modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from exudyn_rotor.reduction.reduced_rotor import ReducedRotor


def keep_modes(reduced: ReducedRotor, indices: Sequence[int]) -> ReducedRotor:
    """Return the rotor with some of its flexible modes; rigid motions always stay.

    Parameters
    ----------
    reduced : ReducedRotor
    indices : sequence of int
        Flexible modes to keep, counted from 0: index 0 is 'mode 1' of ``reduced.labels``. Empty
        for a rigid rotor. They keep their order in `reduced`; the labels count anew.

    Returns
    -------
    ReducedRotor
        Static centrifugal fields stay complete: they are not sums of modes.

    Raises
    ------
    TypeError
        If `reduced` is not a ReducedRotor.
    ValueError
        If an index is no whole number, does not exist or is given twice, or nothing would be left.
    """
    if not isinstance(reduced, ReducedRotor):
        raise TypeError(f"keep_modes: needs a ReducedRotor, got {type(reduced).__name__}")
    rigid = len(reduced.rigid)
    chosen = _checked(indices, reduced.size - rigid)
    columns = np.r_[np.arange(rigid), rigid + chosen].astype(int)
    if columns.size == 0:
        raise ValueError("keep_modes: this rotor has no rigid motions; keep at least one mode")
    shapes = reduced.shapes
    if shapes is not None:
        stress = None if shapes.stress is None else shapes.stress[:, :, columns]
        shapes = replace(shapes, matrix=shapes.matrix[:, columns], stress=stress)
    return replace(
        reduced,
        invariants=reduced.invariants.in_basis(np.eye(reduced.size)[:, columns]),
        interfaces={
            name: replace(interface, motion=interface.motion[:, columns])
            for name, interface in reduced.interfaces.items()
        },
        mode_mass=reduced.mode_mass[np.ix_(columns, columns)],
        shapes=shapes,
    )


def _checked(indices: Sequence[int], count: int) -> np.ndarray:
    array = np.asarray(indices)
    if array.size == 0 and array.ndim == 1:
        return np.zeros(0, dtype=int)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise ValueError(f"keep_modes: needs a list of whole numbers, got {indices!r}")
    if array.min() < 0 or array.max() >= count:
        raise ValueError(
            f"keep_modes: the rotor has flexible modes 0 to {count - 1}, got {indices!r}"
            if count
            else f"keep_modes: the rotor has no flexible modes, got {indices!r}"
        )
    if len(np.unique(array)) < len(array):
        raise ValueError(f"keep_modes: a mode is named twice: {indices!r}")
    return np.sort(array)
