"""A reduced rotor whose spin a drive prescribes: without the motion that its frame holds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_rotor.reduction.attached import Attached
from exudyn_rotor.reduction.fields import ModeKind
from exudyn_rotor.reduction.other_basis import in_basis
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import without_mean_rotation


def without_spin(reduced: ReducedRotor) -> ReducedRotor:
    """Return a rotor none of whose motions has a mean rotation about the axis.

    So that θ(t) is that rotation, as :func:`select_modes` has it. A rotor without the rigid motion
    'spin', a grounded one for instance, is returned as it is.
    """
    if ModeKind.SPIN not in reduced.rigid_kinds:
        return reduced
    T = _others(reduced)
    given = reduced.attached
    attached = None if given is None else Attached(lambda: _finer(given, T))
    return replace(_in_basis(reduced, T), attached=attached)


def _others(reduced: ReducedRotor) -> np.ndarray:
    columns = [i for i, kind in enumerate(reduced.kinds) if kind is not ModeKind.SPIN]
    return without_mean_rotation(reduced, np.eye(reduced.size)[:, columns])


def _in_basis(reduced: ReducedRotor, T: np.ndarray) -> ReducedRotor:
    kinds = (kind for kind in reduced.rigid_kinds if kind is not ModeKind.SPIN)
    return in_basis(reduced, T, kinds)


def _finer(attached: Attached, T: np.ndarray) -> tuple[ReducedRotor | None, np.ndarray | None]:
    """Return the rotor with static responses likewise, and the columns of T in it."""
    if attached.columns is None:
        return None, None
    U = _others(attached.rotor)
    return _in_basis(attached.rotor, U), U.T @ attached.columns @ T
