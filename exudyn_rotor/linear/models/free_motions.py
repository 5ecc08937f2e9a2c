"""Rigid motions of a rotor that neither its supports nor its own stiffness hold."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.reduction.basis import rigid_columns
from exudyn_rotor.reduction.mode_kind import RIGID_KINDS, ModeKind, rigid_names
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.rotating_axes import axes_of

# share of the largest rigid-body stiffness, per unit mass, that counts as none
_HELD = 1e-10
_ALONE = 1.0 - 1e-6  # share of a free motion's energy in one rigid motion, but for rounding


def free_motions_of_reduced(
    rotor: ReducedRotor, supports: Sequence[Support], decoupled: bool
) -> tuple[str, ...]:
    """Name the rigid motions of a reduced rotor that no spring holds at rest.

    A motion that is free only together with others is named 'combination of …'. A `decoupled` spin
    displaces no support, see :class:`Spin`.
    """
    # the rigid columns of the basis have unit mass
    kinds = rotor.rigid_kinds
    turn = np.kron(np.eye(2), axes_of(rotor.axis).T)
    motions = [turn @ rotor.interfaces[s.interface].motion[:, : len(kinds)] for s in supports]
    return named_motions(rigid_names(kinds), _stiffness(supports, motions, kinds, decoupled))


def free_motions_of_solid(
    rotor: SolidRotor, supports: Sequence[Support], decoupled: bool
) -> tuple[str, ...]:
    """Name those of a solid rotor; see :func:`free_motions_of_reduced`."""
    columns = rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass)
    mass = np.einsum("ck,ck->k", columns, rotor.mass @ columns)
    # beyond rounding, where all nodes are in one point
    least = max(1e-6 * np.ptp(rotor.nodes, axis=0).max(), 1e-12 * np.abs(rotor.nodes).max())
    moving = mass > rotor.total_mass * least**2
    moving[:3] = True
    columns = columns[:, moving] / np.sqrt(mass[moving])
    turn = np.kron(np.eye(2), axes_of(rotor.axis).T)
    motions = [
        turn @ (rotor.interfaces[s.interface].mean_motion(rotor.node_count) @ columns)
        for s in supports
    ]
    kinds = tuple(kind for kind, moves in zip(RIGID_KINDS, moving, strict=True) if moves)
    K = _stiffness(supports, motions, kinds, decoupled)
    if rotor.grounded:
        K = K + columns.T @ (rotor.stiffness @ columns)
    return named_motions(rigid_names(kinds), K)


def named_motions(names: Sequence[str], K: np.ndarray) -> tuple[str, ...]:
    """Name the rigid motions that the stiffness K per unit mass leaves free."""
    values, vectors = np.linalg.eigh(0.5 * (K + K.T))
    free = vectors[:, values <= _HELD * max(values.max(initial=0.0), 0.0)]
    share = np.sum(free**2, axis=1)
    alone = [name for name, s in zip(names, share, strict=True) if s > _ALONE]
    partly = [name for name, s in zip(names, share, strict=True) if 1.0 - _ALONE < s <= _ALONE]
    combination = "combination of " + ", ".join(partly)
    return (*alone, *(combination,) * (free.shape[1] - len(alone)))


def _stiffness(
    supports: Sequence[Support],
    motions: Sequence[np.ndarray],
    kinds: tuple[ModeKind, ...],
    decoupled: bool,
) -> np.ndarray:
    if decoupled and ModeKind.SPIN in kinds:  # else it moves nothing but rounding
        for U in motions:
            U[:3, kinds.index(ModeKind.SPIN)] = 0.0
    parts = (
        U.T @ support.matrices(0.0)[0] @ U for support, U in zip(supports, motions, strict=True)
    )
    return sum(parts, np.zeros((len(kinds), len(kinds))))
