"""Rotors that carry a prestress, their own, a given or an estimated one.

Where no elements are known, a truss stands for the solid. Nodes i and j that the stiffness matrix
couples are joined by a bar of the stiffness ``‖K_ij‖`` along ``d = x_j − x_i``. The forces S of the
bars under the balanced centrifugal load are in equilibrium with it at every node, as the stress of
the solid is, and resist ``vᵀ K_G v ≈ Σ S/|d| |v_j − v_i|²``. That is exact for rotations, and for
tensions that equilibrium alone decides: blades, rings, shafts. Measured, against the geometric
stiffness of the elements, for the eight lowest modes of shafts, discs, blades, plates and a bladed
disc: within 2 % but for higher modes of discs and torsion of blades, within 40 % always.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.prestress import static_solution
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.rotor import FiniteElementRotor, Rotor, check_unstressed
from exudyn_rotor.solvers.factor import TooLittleMemoryError
from exudyn_rotor.solvers.inertia_relief import InertiaRelief, free_motions_of, inertia_relief
from exudyn_rotor.theory.axis import coordinates, coupled, rotations, translations

# share of the load by which an imported matrix may miss it, and a computed one, with the rounding
# of the elastic forces
_IMPORTED, _SAME, _ROUNDING = 0.01, 1e-6, 1e-9
# force on the ground by a translation, of the largest on a node, that is more than rounding
_GROUNDED = 1e-9
# fewer nodes are lumped masses, and their springs no solid
_FEWEST = 50


def with_prestress(self: Rotor, prestress: Prestress) -> Rotor:
    """Return the rotor carrying a prestress, for full models and as default of `reduce`.

    Point masses and clamped nodes change the static state: add them before.

    Raises
    ------
    TypeError, ValueError
        If `prestress` is of another kind, belongs to another mesh or another static state (other
        axis, mass, elasticity, springs or held nodes), or the rotor carries one already.
    """
    checks.instance(prestress, "prestress", Prestress, "rotor.prestress() computes one")
    check_unstressed(self)
    matrices.check_same_mesh(self.nodes, prestress.nodes, "prestress")
    load, free = self.centrifugal_load, free_motions_of(self)
    balanced = load - self.mass @ (free @ (free.T @ load))
    if prestress.displacement is not None:
        _check_equilibrium(self, prestress.displacement, balanced)
    elif not self.grounded:
        _check_rotations(self, prestress, balanced)
    return replace(self, carried_prestress=prestress)


def with_chosen_prestress(rotor: Rotor, prestress: Prestress | bool | None) -> Rotor:
    """Return the rotor with what ``reduce(prestress=…)`` asks for; None is the best there is."""
    if isinstance(prestress, bool | np.bool_):
        computed = static_solution.prestress(rotor) if prestress else None
        return replace(rotor, carried_prestress=computed)
    if prestress is not None:
        return with_prestress(rotor, prestress)
    if rotor.carried_prestress is not None or rotor.elements is None:
        return rotor
    return replace(rotor, carried_prestress=static_solution.prestress(rotor))


def _check_equilibrium(
    rotor: FiniteElementRotor, displacement: np.ndarray, load: np.ndarray
) -> None:
    """Refuse a static displacement whose elastic forces are not the load, both (3n,)."""
    left = (rotor.stiffness @ displacement - load)[coupled(rotor.stiffness)]
    rounding = _ROUNDING * np.linalg.norm(abs(rotor.stiffness) @ np.abs(displacement))
    size = np.linalg.norm(load)
    if np.linalg.norm(left) > _SAME * size + rounding:
        raise ValueError(
            "prestress: it belongs to another rotor: its elastic forces differ by "
            f"{np.linalg.norm(left) / max(size, 1e-300):.3g} of this rotor's centrifugal load "
            "(another density, elastic modulus or axis, other point masses, clamped nodes or "
            "springs to the ground); compute the prestress with this rotor: rotor.prestress()"
        )


def _check_rotations(rotor: FiniteElementRotor, prestress: Prestress, load: np.ndarray) -> None:
    """Refuse a matrix that does not act on rotations of a free rotor as the load does.

    By equilibrium ``(a×x)ᵀ K_G (b×x) = (a×x) · (b×f)`` with f the balanced load.
    """
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    turned = np.stack([np.cross(axis, load.reshape(-1, 3)).ravel() for axis in np.eye(3)], axis=1)
    expected, resistance = turns.T @ turned, turns.T @ (prestress.matrix @ turns)
    expected = 0.5 * (expected + expected.T)
    e = rotor.axis.direction
    error = np.abs(resistance - expected)
    i, j = np.unravel_index(np.argmax(error), error.shape)
    if error[i, j] > _IMPORTED * abs(e @ expected @ e):
        raise ValueError(
            f"prestress: the matrix couples rotations with {resistance[i, j]:.6g} kg m², and the "
            f"centrifugal load per (rad/s)² of this rotor with {expected[i, j]:.6g}; it must be "
            "geometric stiffness alone (no spin softening, nothing elastic), for 1 rad/s, with "
            "this rotor's axis, density and point masses"
        )


def estimated_stiffness(rotor: FiniteElementRotor) -> sp.csr_array | None:
    """Return the geometric stiffness (3n, 3n) per ω² of a truss [N s²/m].

    None where the truss is a mechanism or memory is too little, and for less than 50 nodes: those
    are no mesh of a solid.
    """
    count = rotor.node_count
    if count < _FEWEST:
        return None
    K = sp.bsr_array(rotor.stiffness, blocksize=(3, 3))
    first = np.repeat(np.arange(count), np.diff(K.indptr))
    joined = first < K.indices
    ends = np.column_stack([first[joined], K.indices[joined]])
    bars = rotor.nodes[ends[:, 1]] - rotor.nodes[ends[:, 0]]
    squares = np.sum(bars**2, axis=1)
    if np.any(squares == 0.0):
        return None
    stiffness = np.linalg.norm(K.data[joined], axis=(1, 2)) / squares
    numbers = np.arange(len(bars))
    signs, rows = np.tile([-1.0, 1.0], len(bars)), np.repeat(numbers, 2)
    parted = sp.csr_array((signs, (rows, ends.ravel())), shape=(len(bars), count))
    entries = np.hstack([-bars, bars]).ravel(), (np.repeat(numbers, 6), coordinates(ends.ravel()))
    stretched = sp.csr_array(entries, shape=(len(bars), 3 * count))
    held = np.linalg.norm((rotor.stiffness @ translations(count)).reshape(-1, 9), axis=1)
    largest = abs(rotor.stiffness).sum(axis=1).reshape(-1, 3).max(axis=1)
    springs = np.repeat(np.where(held > _GROUNDED * largest, held, 0.0), 3)
    truss = stretched.T @ sp.diags_array(stiffness) @ stretched + sp.diags_array(springs)
    try:
        rigid = inertia_relief(rotor).rigid
        relief = InertiaRelief(sp.csr_array(truss), rotor.mass, rigid)
    except (ValueError, TooLittleMemoryError):
        return None
    tension = stiffness * (stretched @ relief.solve(rotor.centrifugal_load))  # force per length
    return matrices.in_all_directions(parted.T @ sp.diags_array(tension) @ parted)
