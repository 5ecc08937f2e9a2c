"""Static prestress of a spinning rotor, and the stiffness that it gives.

The centrifugal load per ω², ``f_c = M x_⊥``, deforms the rotor statically by u⁰ and stresses it by
σ⁰; vibrations about this state have the stiffness ``K + ω² K_G``,
``vᵀ K_G u = ∫ σ⁰ : (∇uᵀ∇v) dV``. Inertia relief balances the load where nothing holds the rotor.
A stress at rest has a K_G of its own, part of the K that the centrifugal load deforms.

The tangent of a St. Venant–Kirchhoff solid with ``W = ½ E : C : E``, ``E = ε + ½ ∇uᵀ∇u``, at the
displacement ω²u⁰ with the stress ω²σ⁰ is ``K + ω² (K_G + K_u) + ω⁴ K_uu``,

    vᵀ K_u u = ∫ ε(v) : C : E₁(u) + E₁(v) : C : ε(u) dV,    E₁(v) = sym(∇u⁰ᵀ ∇v),
    vᵀ K_uu u = ∫ E₁(v) : C : E₁(u) dV.

Where u⁰ turns a part by the angle θ without straining it, ``E₁`` is of the order of θ; what K_u
changes is then the strain of the turned part, and K_uu takes most of that back: one without the
other errs more than K_G alone. With both, frequencies err by the second-order part of the static
state itself, stress and displacement.

Nodes held by a massless rigid hub feel its forces R, which turn with the hub. K_G takes them for
dead loads; by equilibrium ``K_G (a×x) = a×(f_c + R)``, a false stiffness of rotations. With the
mean translation t and rotation ``φ = Φu`` of these nodes, ``u = t + φ×y + ψ``, y from the centre of
mass, R works on the second-order displacements ``½ φ×(φ×y) + φ×ψ``, which takes that out again:
``K_hub = Φᵀ (sym H − tr(H) I) Φ − Φᵀ N − Nᵀ Φ``, ``H = Σ R yᵀ``, ``N u = Σ R×ψ``. Rotations of the
rotor then feel f_c alone, as at the level 'tilt'; a net force of the hub does no work on them.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.prestress.given_loads import (
    Loads,
    Spring,
    check_balanced,
    checked_supports,
    nodal_loads,
    support_forces,
)
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.elements import von_mises
from exudyn_rotor.solid.rotor import FiniteElementRotor, Interface, check_unstressed
from exudyn_rotor.solvers.inertia_relief import (
    InertiaRelief,
    Way,
    free_motions_of,
    inertia_relief,
)
from exudyn_rotor.theory.axis import rotations, skew

# a stress field in equilibrium loses a few per cent where it was averaged at nodes
_OUT_OF_BALANCE = 0.3
# nodes that stand for the rotation of a hub
_HUB_NODES = 100


def static_prestress(
    rotor: FiniteElementRotor,
    *,
    clamped: Sequence[str] = (),
    initial_displacement: bool = False,
    euler: bool = False,
    stress: ArrayLike | None = None,
    yield_stress: float | None = None,
    speed: float | None = None,
    loads: Loads | None = None,
    supports: Sequence[Spring] | Spring = (),
) -> Prestress:
    """Return the prestress; parameters as :meth:`exudyn_rotor.SolidRotor.prestress`."""
    check_unstressed(rotor)
    clamped = checks.labels(clamped, "clamped", rotor.interfaces)
    checks.flag(initial_displacement, "initial_displacement")
    checks.flag(euler, "euler")
    _check_yield(yield_stress, speed)
    supports = checked_supports(supports)
    if (loads is not None or supports) and (clamped or initial_displacement):
        raise ValueError(
            "loads, supports: have no solution with clamped interfaces or an initial displacement; "
            "hold a rotor by stiff supports, and leave initial_displacement out"
        )
    shape = (rotor.node_count, 6)
    rest_stress = None if stress is None else checks.array(stress, "stress", "Pa", shape=shape)
    if rotor.elements is None:
        raise ValueError(
            "prestress: this rotor has no elements to assemble a geometric stiffness on; make it "
            "with SolidRotor.from_ngsolve, give the matrix of another program with "
            "Prestress.from_matrix, or use stiffening='tilt'"
        )
    elements = rotor.elements
    residual = None if rest_stress is None else elements.load_of_stress(rest_stress)
    supported = rotor.clamped(clamped) if clamped else rotor
    nodes = [rotor.interfaces[name].nodes for name in clamped]
    hub = np.unique(np.concatenate([np.zeros(0, dtype=int), *nodes]))
    state = _StaticState(rotor, supported, hub, rotor.stiffness, inertia_relief(supported))
    constant = None
    if rest_stress is not None:
        springback = state.solve(residual)
        constant = elements.geometric_stiffness_of_stress(rest_stress)
        constant = constant - elements.geometric_stiffness(springback)
        reactions = residual - rotor.stiffness @ springback
        constant = constant + _hub_stiffness(rotor, state.hub, reactions)
        # where all of the stress springs back, rounding is left
        constant = sp.csr_array(0.5 * (constant + constant.T))
        rest_stress = _in_equilibrium(rotor, rest_stress, springback)
        state = state.stressed(constant)

    load = rotor.centrifugal_load
    displacement, matrix = state.stiffening(load)
    initial = None
    if initial_displacement:
        initial = (
            elements.initial_displacement_stiffness(displacement),
            elements.squared_displacement_stiffness(displacement),
        )
    held = None
    if supports:
        held = support_forces(rotor, supports, state.relief, load)
        matrix = state.stiffening(load + held)[1]
    by_loads, loaded = None, 0.0
    if loads is not None:
        given = nodal_loads(rotor, loads)
        taken_up = support_forces(rotor, supports, state.relief, given)
        check_balanced(rotor, state.relief, given, taken_up)
        moved, by_loads = state.stiffening(given + taken_up)
        loaded = rotor.stress_recovery(moved[:, None])[:, :, 0]
    by_spin = rotor.stress_recovery(displacement[:, None])[:, :, 0]
    if speed is not None:
        total = speed**2 * by_spin + (0.0 if rest_stress is None else rest_stress) + loaded
        _warn_of_yield(rotor.nodes, total, yield_stress, speed)
    return Prestress(
        matrix=matrix,
        nodes=rotor.nodes,
        euler=state.stiffening(rotor.euler_load)[1] if euler else None,
        displacement=displacement,
        stress=by_spin,
        constant=constant,
        initial_displacement=initial,
        balanced=not clamped,
        yield_stress=yield_stress,
        constant_stress=rest_stress,
        load=load,
        hub=state.rigid,
        by_loads=by_loads,
        reactions=held,
    )


def relief_rotations(rotor: FiniteElementRotor) -> np.ndarray:
    """Return the angular accelerations of inertia relief per ω² and per ω̇, shape (2, 3).

    What balances the load on the free rigid motions is the inertia of such an acceleration; it
    strains nothing, and its work on second-order displacements is no part of K_G.
    """
    carried = rotor.carried_prestress
    if not carried.balanced:
        return np.zeros((2, 3))
    free = free_motions_of(rotor)
    by_spin = rotor.centrifugal_load
    if carried.reactions is not None:
        by_spin = by_spin + carried.reactions
    loads = np.stack([by_spin, rotor.euler_load])
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    inertia = turns.T @ (rotor.mass @ turns)
    momentum = turns.T @ (rotor.mass @ (free @ (free.T @ loads.T)))
    return (np.linalg.pinv(inertia, rcond=1e-12, hermitian=True) @ momentum).T


def relief_under_stress(
    stiffness: sp.csr_array, mass: sp.csr_array, free: np.ndarray, way: Way
) -> InertiaRelief:
    """Return the elastic inverse of a stiffness with a stress at rest in it.

    ValueError if it is not positive definite but for the `free` rigid motions: the rotor buckles.
    """
    try:
        return InertiaRelief(stiffness, mass, free, way)
    except ValueError as error:
        raise ValueError(
            "prestress: the rotor buckles under its stress at rest; check sign and unit of "
            "prestress(stress=…) [Pa, tension positive]"
        ) from error


@dataclass(frozen=True, eq=False)
class _StaticState:
    """What takes up static loads: the rotor, with a hub, and with a stress at rest or none.

    `supported` is the rotor with the nodes `hub` held, `stiffness` that of the rotor itself.
    """

    rotor: FiniteElementRotor
    supported: FiniteElementRotor
    hub: np.ndarray
    stiffness: sp.csr_array
    relief: InertiaRelief

    @property
    def rigid(self) -> np.ndarray:
        """Nodes that feel forces of the hub or of rigid discs."""
        return np.unique(np.concatenate([self.hub, *(disc.nodes for disc in self.rotor.discs)]))

    def stressed(self, constant: sp.csr_array) -> _StaticState:
        """Return the state with the stiffness of a stress at rest, which acts on every load."""
        free = self.supported.elements.free
        added = constant if free is None else free @ constant @ free
        held = sp.csr_array(self.supported.stiffness + added)
        relief = relief_under_stress(held, self.rotor.mass, self.relief.rigid, Way.of(self.rotor))
        return replace(self, stiffness=self.stiffness + constant, relief=relief)

    def solve(self, load: np.ndarray) -> np.ndarray:
        """Return the static displacement (3n,)."""
        displacement, free = self.relief.solve(load), self.supported.elements.free
        # the stiff springs of `clamped` give way a little
        return displacement if free is None else free @ displacement

    def stiffening(self, load: np.ndarray) -> tuple[np.ndarray, sp.csr_array]:
        """Return the displacement (3n,) of a load, and K_G with what the hub's forces add."""
        displacement = self.solve(load)
        matrix = self.rotor.elements.geometric_stiffness(displacement)
        forces = self.stiffness @ displacement - load
        matrix = matrix + _hub_stiffness(self.rotor, self.hub, forces)
        for disc in self.rotor.discs:
            springs = disc.stiffness_matrix(self.rotor.node_count)
            matrix = matrix + _hub_stiffness(self.rotor, disc.nodes, -(springs @ displacement))
        return displacement, matrix


def _hub_stiffness(rotor: FiniteElementRotor, hub: np.ndarray, forces: np.ndarray) -> sp.csr_array:
    """Return ``K_hub`` (3n, 3n) of the nodal forces (3n,) by which a rigid hub holds its nodes."""
    if hub.size == 0:
        return sp.csr_array((rotor.nodes.size, rotor.nodes.size))
    forces, arms = forces.reshape(-1, 3)[hub], rotor.nodes[hub] - rotor.center_of_mass
    moments = forces.T @ arms
    direct = np.trace(moments) * np.eye(3) - 0.5 * (moments + moments.T)
    # any of its nodes tell how a rigid hub moves, and the matrix is dense on those
    some = hub[:: -(-hub.size // _HUB_NODES)]
    mean = Interface("hub", some, np.ones(some.size), rotor.nodes[some], rotor.center_of_mass)
    motion = mean.mean_motion(rotor.node_count)
    shift, turn = motion[:3], motion[3:]
    # N with ψ = u − t − φ×y put in; its part with φ×y is in `direct`
    columns = (3 * hub[:, None] + np.arange(3)).ravel()
    couple = sp.csr_array(np.hstack([skew(force) for force in forces]))
    couple = couple @ sp.eye_array(rotor.nodes.size, format="csr")[columns]
    couple = couple - sp.csr_array(skew(forces.sum(axis=0))) @ shift
    mixed = turn.T @ couple
    return sp.csr_array(turn.T @ sp.csr_array(direct) @ turn - mixed - mixed.T)


def _check_yield(yield_stress: float | None, speed: float | None) -> None:
    if yield_stress is not None:
        checks.number(yield_stress, "yield_stress", "Pa", above=0.0)
    if speed is not None:
        checks.number(speed, "speed", "rad/s", above=0.0)
        if yield_stress is None:
            raise ValueError("speed: only serves the check of yielding; give yield_stress=, too")


def _in_equilibrium(
    rotor: FiniteElementRotor, stress: np.ndarray, springback: np.ndarray
) -> np.ndarray:
    """Return a stress (n, 6) less the part that no load balances; warn if that is much of it."""
    unbalanced = rotor.stress_recovery(springback[:, None])[:, :, 0]
    share = np.linalg.norm(unbalanced) / max(np.linalg.norm(stress), 1e-300)
    if share > _OUT_OF_BALANCE:
        warnings.warn(
            f"stress: {share:.0%} of it is not in equilibrium without external load and was left "
            "out; a thermal stress must have the thermal strain taken off, C : (ε − ε_T)",
            UserWarning,
            stacklevel=4,
        )
    return stress - unbalanced


def _warn_of_yield(
    nodes: np.ndarray, stress: np.ndarray, yield_stress: float, speed: float
) -> None:
    values = von_mises(stress)
    worst = int(np.argmax(values))
    if values[worst] > yield_stress:
        place = ", ".join(f"{x:.4g}" for x in nodes[worst])
        warnings.warn(
            f"at {speed:.6g} rad/s the static von Mises stress is {values[worst]:.4g} Pa at node "
            f"{worst} ({place}) m, above yield_stress={yield_stress:.4g} Pa; the prestress is "
            "elastic and holds below that only",
            UserWarning,
            stacklevel=4,
        )
