"""A reduced rotor in combinations of its columns."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from exudyn_rotor.reduction.fields import ModeKind
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor


def in_basis(reduced: ReducedRotor, T: np.ndarray, rigid_kinds: Iterable[ModeKind]) -> ReducedRotor:
    """Return the rotor for the basis ``Ψ T``, T of shape (k, l), without its static responses.

    `rigid_kinds` are what the leading columns of T are.
    """
    shapes = reduced.shapes
    if shapes is not None:
        stress = None if shapes.stress is None else shapes.stress @ T
        shapes = replace(shapes, matrix=shapes.matrix @ T, stress=stress)
    return replace(
        reduced,
        invariants=reduced.invariants.in_basis(T),
        rigid_kinds=tuple(rigid_kinds),
        interfaces={
            name: replace(interface, motion=interface.motion @ T)
            for name, interface in reduced.interfaces.items()
        },
        mode_mass=T.T @ reduced.mode_mass @ T,
        shapes=shapes,
        attached=None,
    )
