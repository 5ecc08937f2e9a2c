"""Rotors that carry a prestress, their own, a given or an estimated one.

Where no elements are known, a truss stands for the solid. Nodes i and j that the stiffness matrix
couples are joined by a bar of the stiffness ``‖K_ij‖`` along ``d = x_j − x_i``. The forces S of the
bars under the balanced centrifugal load are in equilibrium with it at every node, as the stress of
the solid is, and resist

    vᵀ K_G v ≈ Σ_bars S/|d| |v_j − v_i|².

By equilibrium this is exact for rotations, and for tensions that equilibrium alone decides: blades,
rings, shafts. Elsewhere the stress of the truss is that of a solid with Poisson's ratio 1/4 and the
same distribution of stiffness, roughly. Measured, against the geometric stiffness of the elements,
for the eight lowest modes of shafts, discs, blades, plates and a bladed disc: within 2 % but for
higher modes of discs and torsion of blades, within 40 % always.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.prestress.static_solution import (
    relief_under_stress,
    static_prestress,
)
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.rotor import FiniteElementRotor, Rotor, check_unstressed
from exudyn_rotor.solvers.factor import TooLittleMemoryError
from exudyn_rotor.solvers.inertia_relief import (
    InertiaRelief,
    Way,
    free_motions_of,
    inertia_relief,
)
from exudyn_rotor.theory.axis import coupled, rotations, translations

# share of the load by which an imported matrix may miss it, and a computed one, with the rounding
# of the elastic forces
_IMPORTED, _SAME, _ROUNDING = 0.01, 1e-6, 1e-9
_COMPUTE = "compute the prestress with this rotor: rotor.prestress()"
# force on the ground by a translation, of the largest on a node, that is more than rounding
_GROUNDED = 1e-9
# fewer nodes are lumped masses, and their springs no solid
_FEWEST = 50


def with_prestress(rotor: Rotor, prestress: Prestress) -> Rotor:
    """Return the rotor carrying a prestress; see :meth:`exudyn_rotor.SolidRotor.with_prestress`."""
    checks.instance(prestress, "prestress", Prestress, "rotor.prestress() computes one")
    check_unstressed(rotor)
    matrices.check_same_mesh(rotor.nodes, prestress.nodes, "prestress")
    _check_static_state(rotor, prestress)
    stiffness = rotor.stiffness
    if prestress.constant is not None:
        stiffness = matrices.frozen(sp.csr_array(stiffness + prestress.constant))
        relief_under_stress(stiffness, rotor.mass, free_motions_of(rotor), Way.of(rotor))
    return replace(rotor, stiffness=stiffness, carried_prestress=replace(prestress, constant=None))


def with_chosen_prestress(rotor: Rotor, prestress: Prestress | bool | None) -> Rotor:
    """Return the rotor with what ``reduce(prestress=…)`` asks for; None is the best there is."""
    if isinstance(prestress, bool | np.bool_):
        return replace(rotor, carried_prestress=static_prestress(rotor) if prestress else None)
    if prestress is not None:
        return with_prestress(rotor, prestress)
    if rotor.carried_prestress is not None or rotor.elements is None:
        return rotor
    try:
        inertia_relief(rotor)
    except ValueError:  # parts that nothing connects have no static state
        return rotor
    return replace(rotor, carried_prestress=static_prestress(rotor))


def _check_static_state(rotor: FiniteElementRotor, prestress: Prestress) -> None:
    """Refuse a prestress of another static state than the rotor's own."""
    if prestress.constant is None and prestress.constant_stress is not None:
        raise ValueError(
            "prestress: this is what another rotor carries, whose stiffness holds the stress at "
            f"rest already; {_COMPUTE[:-1]}stress=…)"
        )
    load = rotor.centrifugal_load
    size = max(np.linalg.norm(load), 1e-300)
    balanced = load
    if prestress.balanced:
        free = free_motions_of(rotor)
        balanced = load - rotor.mass @ (free @ (free.T @ load))
    if prestress.load is not None and prestress.displacement is not None:
        _check_computed(rotor, prestress, load, balanced, size)
    elif not rotor.grounded:
        _check_rotations(rotor, prestress, balanced)


def _check_computed(
    rotor: FiniteElementRotor,
    prestress: Prestress,
    load: np.ndarray,
    balanced: np.ndarray,
    size: float,
) -> None:
    """Compare load and elastic forces, but at nodes that are held, whose forces are not known."""
    stiffness = rotor.stiffness
    if prestress.constant is not None:
        stiffness = stiffness + prestress.constant
    compared = coupled(rotor.stiffness).reshape(-1, 3)
    if prestress.hub is not None:
        compared[prestress.hub] = False
    imbalance = np.linalg.norm((stiffness @ prestress.displacement - balanced)[compared.ravel()])
    rounding = _ROUNDING * np.linalg.norm(abs(stiffness) @ np.abs(prestress.displacement))
    change = np.linalg.norm(prestress.load - load)
    if change > _SAME * size or imbalance > _SAME * size + rounding:
        raise ValueError(
            f"prestress: it belongs to another rotor: its centrifugal load differs by "
            f"{change / size:.3g}, and its elastic forces by {imbalance / size:.3g} of this "
            "rotor's load (another density, elastic modulus or axis, other point masses, clamped "
            f"nodes or springs to the ground); {_COMPUTE}"
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
            f"prestress: the matrix couples rotations about mesh axes {'xyz'[i]} and {'xyz'[j]} "
            f"with {resistance[i, j]:.6g} kg m², and the centrifugal load per (rad/s)² of this "
            f"rotor with {expected[i, j]:.6g}; it must hold the geometric stiffness alone (no spin "
            "softening, no elastic stiffness), for 1 rad/s, with this rotor's axis, density and "
            "point masses"
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
    joined = first != K.indices
    i, j = first[joined], K.indices[joined]
    bars = rotor.nodes[j] - rotor.nodes[i]
    lengths = np.linalg.norm(bars, axis=1)
    if np.any(lengths == 0.0):
        return None
    stiffness = np.linalg.norm(K.data[joined], axis=(1, 2)) / lengths**2
    try:
        rigid = inertia_relief(rotor).rigid
        truss = _truss(rotor, i, j, bars, stiffness)
        relief = InertiaRelief(truss, rotor.mass, rigid, Way())
    except (ValueError, TooLittleMemoryError):
        return None
    moved = relief.solve(rotor.centrifugal_load).reshape(-1, 3)
    tension = stiffness * np.einsum("ba,ba->b", bars, moved[j] - moved[i])  # force per length
    network = sp.csr_array((-tension, (i, j)), shape=(count, count))
    network = network - sp.diags_array(np.asarray(network.sum(axis=1)).ravel())
    network = 0.5 * (network + network.T)
    return sp.csr_array(sp.kron(network, sp.eye_array(3), format="csr"))


def _truss(
    rotor: FiniteElementRotor,
    i: np.ndarray,
    j: np.ndarray,
    bars: np.ndarray,
    stiffness: np.ndarray,
) -> sp.csr_array:
    """Return the stiffness (3n, 3n) of the bars, and of springs where the rotor is held."""
    count = rotor.node_count
    blocks = stiffness[:, None, None] * bars[:, :, None] * bars[:, None, :]
    diagonal = np.zeros((count, 3, 3))
    np.add.at(diagonal, i, blocks)
    held = np.linalg.norm((rotor.stiffness @ translations(count)).reshape(-1, 9), axis=1)
    largest = abs(rotor.stiffness).sum(axis=1).reshape(-1, 3).max(axis=1)
    diagonal += np.where(held > _GROUNDED * largest, held, 0.0)[:, None, None] * np.eye(3)
    order = np.argsort(np.concatenate([i, np.arange(count)]), kind="stable")
    data = np.concatenate([-blocks, diagonal])[order]
    columns = np.concatenate([j, np.arange(count)])[order]
    ends = np.cumsum(np.bincount(i, minlength=count) + 1)
    truss = sp.bsr_array((data, columns, np.append(0, ends)), shape=rotor.stiffness.shape)
    return sp.csr_array(truss)
