"""Reduction of a solid rotor: component modes plus rigid motions → :class:`ReducedRotor`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache, partial

import numpy as np
import scipy.sparse as sp
from exudyn.FEM import FEMinterface

from exudyn_rotor import checks
from exudyn_rotor.prestress.carrying import estimated_stiffness, with_chosen_prestress
from exudyn_rotor.prestress.static_solution import relief_rotation
from exudyn_rotor.reduction.attachment import attachment_modes
from exudyn_rotor.reduction.component import (
    ModeBasis,
    OrthonormalBasis,
    component_modes,
    lowest_with_pairs,
    numbered,
    unit_columns,
)
from exudyn_rotor.reduction.reduced_rotor import (
    RIGID_KINDS,
    Centrifugal,
    ModeShapes,
    ReducedInterface,
    ReducedRotor,
)
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.solvers.inertia_relief import free_motions_of, inertia_relief
from exudyn_rotor.theory.axis import translations
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.stiffening import with_prestress

_FREE_MODES = 12  # beside static ones, for what a spin adds

ModeSource = int | ModeBasis | FEMinterface | np.ndarray


def reduce(
    self: FiniteElementRotor,
    modes: ModeSource,
    *,
    stress: bool = False,
    prestress: Prestress | bool | None = None,
) -> ReducedRotor:
    """Reduce the rotor to component modes and its rigid motions.

    Parameters
    ----------
    modes : int, ModeBasis, FEMinterface or ndarray, shape (3n, r)
        A number of free eigenmodes (0 for a rigid rotor), a basis made by a function of
        :mod:`exudyn_rotor.reduction`, a FEMinterface whose modes have been computed, or
        displacement columns in mesh axes [m].
    stress : bool, optional
        Also recover stress modes, for stress sensors and contour pictures.
    prestress : Prestress or bool, optional
        Static stress for ``stiffening='full'``; True for :meth:`prestress` with its defaults,
        False for none. By default that which the rotor carries or, where it has elements and
        no loose parts, :meth:`prestress` with its defaults.

    Raises
    ------
    TypeError, ValueError
        If the modes are of another kind or of another mesh, or nothing is left of them.
    """
    checks.flag(stress, "stress")
    with one_thread():  # waking others for products of thin matrices costs more than it gains
        rotor = with_chosen_prestress(self, prestress)
        unknown = prestress is None and rotor.carried_prestress is None
        network = estimated_stiffness(rotor) if unknown else None
    component = component_modes(rotor, modes)
    with one_thread():
        component = _with_turned_displacement(rotor, component)
        basis = OrthonormalBasis.of(rotor, component)
        if basis.matrix.shape[1] == 0:
            raise ValueError("the reduced basis is empty: ask for at least one component mode")
        attached = cache(partial(_with_attachments, rotor, component, basis))
        reduced = _reduced(rotor, component, basis, network)
        shapes = _shapes(rotor, component, basis, stress)
    static, carried = None, rotor.carried_prestress
    if carried is not None and carried.displacement is not None:
        names = ("displacement", "stress", "yield_stress")
        static = Centrifugal(**{name: getattr(carried, name) for name in names})
    return replace(reduced, shapes=shapes, centrifugal=static, attached=attached)


def reduced_for_loads(
    rotor: FiniteElementRotor, nodes: Sequence[int], *, spins: bool, stress: bool
) -> ReducedRotor:
    """Return the rotor with its static responses to loads at interfaces and `nodes`.

    Its deflection under these loads is that of the solid model. One that `spins` has free modes,
    too, and the static centrifugal displacement. ValueError if it has loose parts.
    """
    columns = [attachment_modes(rotor, np.zeros((rotor.nodes.size, 0)))]
    loads = [np.eye(1, rotor.nodes.size, 3 * n + i)[0] for n in nodes for i in range(3)]
    if rotor.grounded:
        loads += list((rotor.mass @ translations(rotor.node_count)).T)
    if spins:
        loads.append(rotor.centrifugal_load)
    if loads:
        columns.append(inertia_relief(rotor).solve(np.column_stack(loads)))
    if spins:
        most = rotor.nodes.size - free_motions_of(rotor).shape[1]
        matrices, count = (rotor.stiffness, rotor.mass), min(_FREE_MODES, most)
        # one of a pair alone makes no asymmetric shaft: static modes have its flexibility
        found = lowest_with_pairs(*matrices, inertia_relief(rotor), count, warns=False)
        columns.append(found[1])
    matrix = unit_columns(rotor, np.hstack(columns))
    known = None if spins or rotor.carried_prestress is not None else False
    basis = ModeBasis(matrix, numbered("static mode", matrix.shape[1]), rotor.nodes)
    return reduce(rotor, basis, stress=stress, prestress=known)


def _reduced(
    rotor: FiniteElementRotor,
    component: ModeBasis,
    basis: OrthonormalBasis,
    network: sp.csr_array | None = None,
) -> ReducedRotor:
    """Return the rotor in a basis, without shapes."""
    center = rotor.center_of_mass
    invariants = Invariants.of(
        rotor.nodes - center,
        rotor.mass,
        None,  # the basis knows
        rotor.damping,
        basis.matrix,
        rotor.axis.direction,
        basis.momenta,
    )
    # exactly what holds by construction, so that round-off excites nothing
    stiffness = np.diag(np.maximum(basis.stiffness, 0.0))
    size = invariants.size
    invariants = replace(invariants, M=np.eye(size), K=stiffness, center=np.zeros(3))
    if network is not None:
        estimate = basis.matrix.T @ (network @ basis.matrix)
        invariants = replace(invariants, K2_estimated=0.5 * (estimate + estimate.T))
    reduced = ReducedRotor(
        axis=rotor.axis,
        center_of_mass=center,
        invariants=_stiffened(rotor, invariants, basis.matrix),
        rigid_kinds=basis.rigid_kinds,
        interfaces=_interfaces(rotor, basis.matrix),
        mode_mass=_mode_mass(component, basis),
        dropped=basis.dropped,
        grounded=rotor.grounded,
    )
    return reduced.with_damping(mass=rotor.mass_damping, loss=rotor.structural_damping)


def _with_attachments(
    rotor: FiniteElementRotor,
    component: ModeBasis,
    basis: OrthonormalBasis,
) -> tuple[ReducedRotor, np.ndarray] | None:
    """Return the rotor with static responses beside its modes, and where its own columns are there.

    None if its static response is unknown, or if nothing is known of what the modes leave out.
    """
    with one_thread():
        try:
            static = attachment_modes(rotor, component.matrix)
        except ValueError:  # loose parts; the given modes may do without them
            return None
        if not static.shape[1] and basis.matrix.shape[1] < rotor.nodes.size:
            return None
        matrix = np.hstack([component.matrix, static])
        every = ModeBasis(matrix, numbered("column", matrix.shape[1]), rotor.nodes)
        finer = OrthonormalBasis.of(rotor, every)
        reduced = _reduced(rotor, every, finer)
        return reduced, finer.matrix.T @ basis.momenta


def _with_turned_displacement(rotor: FiniteElementRotor, component: ModeBasis) -> ModeBasis:
    """Add ``a × u⁰`` for rotations a about the mesh axes, where K_u and K_uu are carried.

    A rotor that turns takes its static deformation along. ``a × (x + ω²u⁰)`` strains nothing, but
    K_uu resists ``a × x`` alone, like a stress of the order of the local rotation by u⁰.
    """
    carried = rotor.carried_prestress
    known = carried is not None and carried.initial_displacement is not None
    if not known or carried.displacement is None or not rotor.rigid_motions:
        return component
    static = carried.displacement.reshape(-1, 3)
    columns = np.stack([np.cross(turn, static).ravel() for turn in np.eye(3)], axis=1)
    columns = unit_columns(rotor, columns)
    labels = numbered("static displacement turned", columns.shape[1])
    stress = component.stress
    if stress is not None:
        stress = np.concatenate([stress, rotor.elements.nodal_stress(columns)], axis=2)
    matrix = np.hstack([component.matrix, columns])
    return ModeBasis(matrix, component.labels + labels, rotor.nodes, stress=stress)


def _mode_mass(component: ModeBasis, basis: OrthonormalBasis) -> np.ndarray:
    """Return the mass matrix (k, k) of the columns' shares in the component modes.

    A flexible column is that share U less what it has of the rigid motions R, ``U − R(RᵀMU)``.
    """
    rigid = len(basis.rigid_kinds)
    share = (basis.momenta[:, :rigid].T @ component.matrix) @ basis.from_modes
    own = np.eye(basis.matrix.shape[1])
    own[:rigid] = 0.0
    return own + share.T @ share


def _stiffened(rotor: FiniteElementRotor, invariants: Invariants, basis: np.ndarray) -> Invariants:
    """Add what the carried prestress gives to the invariants of the basis."""
    carried = rotor.carried_prestress
    if carried is None:
        return invariants
    K2, K4 = (
        None if matrix is None else basis.T @ (matrix @ basis)
        for matrix in (carried.per_square, carried.per_fourth_power)
    )
    if carried.by_loads is not None:
        invariants = replace(invariants, K0=_of_loads(rotor, invariants, basis))
    return with_prestress(invariants, K2, relief_rotation(rotor), K4)


def _of_loads(rotor: FiniteElementRotor, invariants: Invariants, basis: np.ndarray) -> np.ndarray:
    """Return the stiffness of given loads, which resist neither translations nor the spin.

    They turn with the rotor.
    """
    matrix = basis.T @ (rotor.carried_prestress.by_loads @ basis)
    if rotor.grounded:
        return 0.5 * (matrix + matrix.T)
    others = np.eye(len(matrix))
    others[:, :3] = 0.0  # translations are the first of RIGID_KINDS
    turns = others @ (rotor.axis.direction @ invariants.mean_rotation)
    turns[len(RIGID_KINDS) :] = 0.0
    turns /= np.linalg.norm(turns) or 1.0
    others -= np.outer(turns, turns)
    return others @ (0.5 * (matrix + matrix.T)) @ others


def _interfaces(rotor: FiniteElementRotor, basis: np.ndarray) -> dict[str, ReducedInterface]:
    return {
        name: ReducedInterface(
            reference=interface.reference,
            center=interface.center,
            radius=interface.radius,
            motion=interface.mean_motion(rotor.node_count) @ basis,
        )
        for name, interface in rotor.interfaces.items()
    }


def _shapes(
    rotor: FiniteElementRotor, component: ModeBasis, basis: OrthonormalBasis, stress: bool
) -> ModeShapes:
    columns = None
    if component.stress is not None:
        columns = component.stress @ basis.from_modes
    elif stress:
        if rotor.elements is None:
            raise ValueError(
                "stress=True: this rotor has no stress recovery; make it with from_ngsolve, or "
                "give a FEMinterface with post-processing modes"
            )
        columns = rotor.elements.nodal_stress(basis.matrix)
    return ModeShapes(rotor.nodes, basis.matrix, rotor.triangles, stress=columns)
