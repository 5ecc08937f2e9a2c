"""Which rigid modes a formulation needs: those its frame does not hold, and no others."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.formulation import Formulation
from exudyn_rotor.invariants import Invariants
from exudyn_rotor.modes.basis import RIGID
from exudyn_rotor.reduced import ReducedRotor

_ROUND_OFF = 1e-10


@dataclass(frozen=True, eq=False)
class Selection:
    """Basis of one formulation out of a reduced rotor.

    Attributes
    ----------
    T : ndarray, shape (k, m)
        The basis of the formulation is ``Ψ = Q T`` with Q of the reduced rotor; orthonormal.
    origin : ndarray, shape (3,)
        Frame origin, mesh coordinates [m]: the centre of mass where the translation is free, else
        the foot of its perpendicular on the spin axis.
    labels : tuple of str
    invariants : Invariants
        In the basis Ψ, about the origin, mesh axes.
    """

    T: np.ndarray
    origin: np.ndarray
    labels: tuple[str, ...]
    invariants: Invariants


def select_modes(reduced: ReducedRotor, formulation: Formulation) -> Selection:
    """Pick the columns of `reduced` for `formulation`.

    Rigid motions held by the frame leave the basis; the others become orthogonal to them, so that
    ``S = 0`` for the frame's translations and ``g = 0`` for its spin.

    Raises
    ------
    ValueError
        When the rotor cannot be used in this formulation.
    """
    _check_possible(reduced, formulation)
    if formulation.translation_count:
        origin = reduced.center_of_mass
    else:
        origin = reduced.axis.project(reduced.center_of_mass)
    T, labels = _columns(reduced, formulation, origin)
    invariants = reduced.invariants.in_basis(T).moved(origin - reduced.center_of_mass)
    limit = _ROUND_OFF * np.sqrt(invariants.mass)
    coupling = np.where(np.abs(invariants.S) < limit, 0.0, invariants.S)
    return Selection(T, origin, labels, replace(invariants, S=coupling))


def _check_possible(reduced: ReducedRotor, formulation: Formulation) -> None:
    if reduced.grounded and (formulation.translation_count or formulation.has_spin):
        raise ValueError(
            "the stiffness matrix holds this rotor in its own frame (grounded), and a frame "
            "without mass cannot move freely: use translation='none' and a prescribed spin"
        )
    if formulation.has_spin and "spin" not in reduced.rigid:
        raise ValueError(
            "the rotor has no moment of inertia about its axis, so its spin cannot be free: "
            "prescribe the spin, or give the rotor mass off the axis"
        )


def _columns(
    reduced: ReducedRotor, formulation: Formulation, origin: np.ndarray
) -> tuple[np.ndarray, tuple[str, ...]]:
    identity = np.eye(reduced.size)
    holds_spin = formulation.has_spin or formulation.drive == "rigid"
    held = RIGID[: formulation.translation_count]
    if reduced.grounded:
        return identity, reduced.labels
    if holds_spin:
        held = (*held, "spin")
    keep = [i for i, name in enumerate(reduced.labels) if name not in held]
    T = identity[:, keep]
    if holds_spin and not formulation.translation_count:
        T = _orthogonal_to(_spin_about(reduced, origin), T)
    return T, tuple(reduced.labels[i] for i in keep)


def _spin_about(reduced: ReducedRotor, origin: np.ndarray) -> np.ndarray:
    """Unit vector of the spin ``X_e`` about the axis through `origin`, in the reduced basis."""
    arm = reduced.center_of_mass - origin
    spin = reduced.invariants.moved(-arm).g
    return spin / np.linalg.norm(spin) if np.any(spin) else spin


def _orthogonal_to(held: np.ndarray, T: np.ndarray) -> np.ndarray:
    """Make the columns T orthogonal to the unit vector `held`, and orthonormal again."""
    overlap = held @ T
    touched = np.abs(overlap) > 1e-14
    if not np.any(touched):
        return T
    columns = T[:, touched] - np.outer(held, overlap[touched])
    # the polar factor is the orthonormal set closest to the columns, so labels keep their meaning
    u, _, vt = np.linalg.svd(columns, full_matrices=False)
    result = T.copy()
    result[:, touched] = u @ vt
    return result
