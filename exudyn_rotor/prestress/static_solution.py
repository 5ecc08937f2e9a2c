"""Static prestress of a spinning rotor, and the stiffness that it gives.

The centrifugal load per ω², ``f_c = M x_⊥``, deforms the rotor statically by u⁰ and stresses it by
σ⁰; vibrations about this state have the stiffness ``K + ω² K_G``,
``vᵀ K_G u = ∫ σ⁰ : (∇uᵀ∇v) dV``. Inertia relief balances the load where nothing holds the rotor.

The tangent of a St. Venant–Kirchhoff solid at the displacement ω²u⁰ with the stress ω²σ⁰ is
``K + ω² (K_G + K_u) + ω⁴ K_uu`` (:mod:`exudyn_rotor.solid.elements`).
Where u⁰ turns a part by the angle θ without straining it, ``E₁`` is of the order of θ; what K_u
changes is then the strain of the turned part, and K_uu takes most of that back: one without the
other errs more than K_G alone. With both, frequencies err by the second-order part of the static
state itself, stress and displacement.

Nodes that a rigid disc holds feel its forces R, which turn with the disc. K_G takes them for
dead loads; by equilibrium ``K_G (a×x) = a×(f_c + R)``, a false stiffness of rotations. With the
mean translation t and rotation ``φ = Φu`` of these nodes, ``u = t + φ×y + ψ``, y from the centre of
mass, R works on the second-order displacements ``½ φ×(φ×y) + φ×ψ``, which takes that out again:
``K_disc = Φᵀ (sym H − tr(H) I) Φ − Φᵀ N − Nᵀ Φ``, ``H = Σ R yᵀ``, ``N u = Σ R×ψ``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.prestress.given_loads import HeldRotor, Loads, Spring, nodal_loads
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.rotor import FiniteElementRotor, Interface, check_unstressed
from exudyn_rotor.solvers.inertia_relief import free_motions_of, inertia_relief
from exudyn_rotor.theory.axis import coordinates, rotations, skew

# nodes that stand for the rotation of a disc
_DISC_NODES = 100


def prestress(
    self: FiniteElementRotor,
    *,
    initial_displacement: bool = False,
    yield_stress: float | None = None,
    loads: Loads | None = None,
    supports: Sequence[Spring] | Spring | None = None,
) -> Prestress:
    """Return the static prestress by the rotation and by loads, for ``stiffening='full'``.

    Solves ``K u⁰ = M x_⊥`` for ω = 1 rad/s, with inertia relief on the motions that the
    stiffness leaves free, and assembles the geometric stiffness of its stress; likewise, once
    for all speeds, of the stress by given loads: a thrust softens bending, a preload or a
    tension stiffens it.

    Parameters
    ----------
    initial_displacement : bool, optional
        Also the stiffness from the change of shape by u⁰, per ω² and per ω⁴: the tangent of
        St. Venant–Kirchhoff elasticity about the linear static state, which K_G alone misses
        by the order of the static strain or, where parts turn with the static deflection
        (blades), of that rotation. What is left is the second-order part of the static state.
    yield_stress : float, optional
        Yield stress [Pa], for the row 'yield' of :func:`exudyn_rotor.check_run`.
    loads : mapping or array_like, shape (n, 3), optional
        Loads that turn with the rotor and do not depend on the speed: interface or node number
        → force (3,) [N], or at an interface force and moment (6,), in mesh axes; or a force at
        every node, as of pressure. Where the rotor tilts they keep their direction. A moment
        must be a torque about the axis; it counts as semi-tangential, see
        :mod:`exudyn_rotor.prestress.given_loads`. This is their stiffness alone: a scene or
        an analysis has the loads themselves only where they are given there.
    supports : sequence of Support, optional
        What holds the rotor in the static solutions, along the axis above all: the loads must
        balance each other or be taken up, and the centrifugal load pulls on supports that
        resist the contraction of the shaft. Where they hold it across the axis, too, they decide
        how much thrust it bears; otherwise that is what it bears hinged where the loads act.

    Raises
    ------
    TypeError, ValueError
        For values of the wrong kind, if the rotor has no elements (not made by
        :meth:`from_ngsolve`) or carries a prestress already, an interface is unknown, nothing
        takes up a load, a moment is none about the axis, or the rotor buckles under the loads.
    """
    check_unstressed(self)
    checks.flag(initial_displacement, "initial_displacement")
    is_held = supports is not None
    if initial_displacement and (loads is not None or is_held):
        raise ValueError(
            "loads, supports: have no solution with initial_displacement; leave it out"
        )
    if self.elements is None:
        raise ValueError(
            "prestress: this rotor has no elements to assemble a geometric stiffness on; make it "
            "with SolidRotor.from_ngsolve, give the matrix of another program with "
            "Prestress(matrix, nodes), or use stiffening='tilt'"
        )
    relief, load = inertia_relief(self), self.centrifugal_load
    displacement = relief.solve(load)
    matrix = stress_stiffness(self, displacement)
    initial = reactions = by_loads = factor = None
    if initial_displacement:
        initial = self.elements.displacement_stiffness(displacement)
    if loads is not None or is_held:
        held = HeldRotor(self, supports or (), relief)
    if is_held:
        reactions = held.reactions(load)
        matrix = stress_stiffness(self, relief.solve(load + reactions))
    if loads is not None:
        given = nodal_loads(self, loads)
        taken_up = held.reactions(given)
        held.check_balanced(given, taken_up)
        by_loads = stress_stiffness(self, relief.solve(given + taken_up))
        factor = _buckling_factor(held, by_loads)
    return Prestress(
        matrix=matrix,
        nodes=self.nodes,
        displacement=displacement,
        stress=self.elements.nodal_stress(displacement[:, None])[:, :, 0],
        initial_displacement=initial,
        yield_stress=yield_stress,
        by_loads=by_loads,
        buckling_factor=factor,
        reactions=reactions,
    )


def _buckling_factor(held: HeldRotor, geometric: sp.csr_array) -> float | None:
    """Return by what loads may grow, None without end; ValueError if the rotor buckles."""
    share = held.buckling_shares(geometric)[-1]
    if share >= 1.0:
        how = ""
        if held.free.shape[1] > 1:
            how = " (hinged where they act; supports=[…] that hold it across the axis decide)"
        raise ValueError(f"loads: the rotor buckles at {1.0 / share:.4g} of them{how}")
    return 1.0 / share if share > 0.0 else None


def relief_rotation(rotor: FiniteElementRotor) -> np.ndarray:
    """Return the angular acceleration of inertia relief per ω², shape (3,).

    What balances the load on the free rigid motions is the inertia of such an acceleration; it
    strains nothing, and its work on second-order displacements is no part of K_G.
    """
    load, reactions = rotor.centrifugal_load, rotor.carried_prestress.reactions
    if reactions is not None:
        load = load + reactions
    free = free_motions_of(rotor)
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    inertia = turns.T @ (rotor.mass @ turns)
    momentum = turns.T @ (rotor.mass @ (free @ (free.T @ load)))
    return np.linalg.pinv(inertia, rcond=1e-12, hermitian=True) @ momentum


def stress_stiffness(rotor: FiniteElementRotor, displacement: np.ndarray) -> sp.csr_array:
    """Return K_G of a displacement (3n,), with what the forces of rigid discs add."""
    matrix = rotor.elements.geometric_stiffness(displacement)
    for disc in rotor.discs:
        springs = disc.stiffness_matrix(rotor.node_count)
        matrix = matrix + _disc_stiffness(rotor, disc.nodes, -(springs @ displacement))
    return matrix


def _disc_stiffness(
    rotor: FiniteElementRotor, nodes: np.ndarray, forces: np.ndarray
) -> sp.csr_array:
    """Return ``K_disc`` (3n, 3n) of the forces (3n,) by which a rigid disc holds its nodes."""
    forces, arms = forces.reshape(-1, 3)[nodes], rotor.nodes[nodes] - rotor.center_of_mass
    moments = forces.T @ arms
    direct = np.trace(moments) * np.eye(3) - 0.5 * (moments + moments.T)
    # any of its nodes tell how a rigid disc moves, and the matrix is dense on those
    some = nodes[:: -(-nodes.size // _DISC_NODES)]
    mean = Interface("disc", some, np.ones(some.size), rotor.nodes[some], rotor.center_of_mass)
    motion = mean.mean_motion(rotor.node_count)
    shift, turn = motion[:3], motion[3:]
    # N with ψ = u − t − φ×y put in; its part with φ×y is in `direct`
    couple = sp.csr_array(np.hstack([skew(force) for force in forces]))
    couple = couple @ sp.eye_array(rotor.nodes.size, format="csr")[coordinates(nodes)]
    couple = couple - sp.csr_array(skew(forces.sum(axis=0))) @ shift
    mixed = turn.T @ couple
    return sp.csr_array(turn.T @ sp.csr_array(direct) @ turn - mixed - mixed.T)
