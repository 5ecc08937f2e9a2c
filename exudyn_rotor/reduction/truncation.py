"""A reduced rotor with fewer of its flexible modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.reduction.other_basis import in_basis
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
        If `reduced` is not a ReducedRotor, or an index no whole number.
    ValueError
        If an index does not exist or is given twice, or nothing would be left.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, keep_modes
    >>> spring = 1e6 * np.kron([[1, -1], [-1, 1]], np.diag([0, 0, 1]))
    >>> ends = [[0, 0, 0], [0, 0, 1]]
    >>> rotor = SolidRotor.from_matrices(np.eye(6), spring, ends, "z", grounded=False)
    >>> keep_modes(rotor.reduce(1), [])
    ReducedRotor(5 rigid + 0 flexible modes, 2 kg, interfaces: none)
    """
    checks.instance(reduced, "reduced", ReducedRotor, "SolidRotor.reduce(…) makes one")
    rigid = len(reduced.rigid_kinds)
    chosen = _checked(indices, reduced.size - rigid)
    columns = np.r_[np.arange(rigid), rigid + chosen].astype(int)
    if columns.size == 0:
        raise ValueError("keep_modes: this rotor has no rigid motions; keep at least one mode")
    kept = in_basis(reduced, np.eye(reduced.size)[:, columns], reduced.rigid_kinds)
    attached = reduced.attached
    return replace(kept, attached=None if attached is None else attached.of_columns(columns))


def _checked(indices: Sequence[int], count: int) -> np.ndarray:
    chosen = np.sort(checks.whole_numbers(indices, "indices"))
    if chosen.size and chosen[-1] >= count:
        there = f"flexible modes 0 to {count - 1}" if count else "no flexible modes"
        raise ValueError(f"indices: the rotor has {there}, got {chosen[-1]}")
    if len(np.unique(chosen)) < len(chosen):
        raise ValueError(f"indices: a mode is named twice: {chosen.tolist()}")
    return chosen
