"""What a solid rotor does about static stress: prestress, and nodes that are clamped."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.prestress import prestress
from exudyn_rotor.prestress.prestress import Prestress, relief_under_stress
from exudyn_rotor.reduction.component import check_same_mesh
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.rigid import (
    count_rigid_motions,
    lost_digits,
    rigid_basis,
    unsupported_nodes,
)
from exudyn_rotor.solvers.inertia_relief import free_rigid_motions
from exudyn_rotor.theory.nodal import coupled, rotations

if TYPE_CHECKING:
    from exudyn_rotor.solid.rotor import SolidRotor

# of the largest diagonal entry: clamped nodes move by less than 1e-10 of the others, and dense
# eigenvalues, whose error is relative to the stiffest spring, keep four digits
_CLAMP = 1e6
# share of the load by which an imported matrix may miss it, on positions and on rotations
_IMPORT_TOLERANCE = 0.01
# the same of a computed prestress, and how far rounding of the elastic forces goes: with full
# precision, and in terms of the digits that an export lost
_SAME = 1e-6
_ROUNDING = 1e-12
_LOST = 10.0
_COMPUTE = "compute the prestress with this rotor: rotor.prestress()"
_ALONE = (
    "it must hold the geometric stiffness alone (no spin softening, no elastic stiffness), for "
    "1 rad/s or 1 rad/s²"
)


class StressedRotor:
    """Methods of :class:`exudyn_rotor.SolidRotor` for static stress."""

    def prestress(
        self: SolidRotor,
        *,
        clamped: Sequence[str] = (),
        initial_displacement: bool = False,
        euler: bool = False,
        stress: ArrayLike | None = None,
        yield_stress: float | None = None,
        speed: float | None = None,
    ) -> Prestress:
        """Return the static prestress by the rotation, for ``stiffening='full'``.

        Solves ``K u⁰ = M x_⊥`` for ω = 1 rad/s, with inertia relief on the motions that the
        stiffness leaves free, and assembles the geometric stiffness of its stress.

        Parameters
        ----------
        clamped : sequence of str, optional
            Interfaces whose nodes a massless rigid hub holds fixed for the static solution, e.g. a
            bore on a rigid shaft. The hub moves with the rotor afterwards; a rotor that is held
            in its frame needs :meth:`clamped`.
        initial_displacement : bool, optional
            Also the stiffness from the change of shape by u⁰: the rest of what is linear in u⁰ in
            St. Venant–Kirchhoff elasticity. Of the order of the static strain.
        euler : bool, optional
            Also the stiffness from the stress of an angular acceleration. Without it the
            rigid-body part of that is used, which is all of it for a rotor that nothing holds.
        stress : array_like, shape (n, 6), optional
            Stress at rest, from an interference fit or temperature: xx, yy, zz, yz, xz, xy at the
            nodes in mesh axes [Pa]. It must be in equilibrium without load; what averaging at
            nodes lost of that is put right by one elastic solution. Its stiffness takes part in
            the static solution for the rotation.
        yield_stress : float, optional
            Yield stress [Pa].
        speed : float, optional
            Highest speed [rad/s]; warns if the von Mises stress is above `yield_stress` there.

        Raises
        ------
        TypeError
            If `stress`, `yield_stress` or `speed` hold no numbers.
        ValueError
            If the rotor has no elements (not made by :meth:`from_ngsolve`) or carries a prestress
            already, an interface is unknown, or `stress` belongs to another mesh or makes the
            rotor buckle.

        Warns
        -----
        UserWarning
            When the material yields, or `stress` is far from equilibrium.
        """
        check_unstressed(self)
        if isinstance(clamped, str):
            clamped = (clamped,)
        return prestress.static_prestress(
            self, clamped, initial_displacement, euler, stress, yield_stress, speed
        )

    def with_prestress(self: SolidRotor, prestress: Prestress) -> SolidRotor:
        """Return the rotor carrying a prestress, for full models and as default of `reduce`.

        A constant stress becomes part of the stiffness. Point masses and clamped nodes change the
        static state: add them before.

        Raises
        ------
        TypeError
            If `prestress` is of another kind.
        ValueError
            If the rotor carries one already, or it belongs to another mesh or another static
            state: other axis, mass, elasticity, springs or held nodes; or if its stress at rest
            makes the rotor buckle.
        """
        if not isinstance(prestress, Prestress):
            raise TypeError(f"prestress: expected a Prestress, got {type(prestress).__name__}")
        check_unstressed(self)
        check_same_mesh(self.nodes, prestress.nodes, "prestress")
        _check_static_state(self, prestress)
        stiffness = self.stiffness
        if prestress.constant is not None:
            stiffness = matrices.frozen(sp.csr_array(stiffness + prestress.constant))
            free = free_rigid_motions(self.nodes, self.mass, self.stiffness, self.rigid_motions)
            relief_under_stress(stiffness, self.mass, free)
        return replace(
            self, stiffness=stiffness, carried_prestress=replace(prestress, constant=None)
        )

    def clamped(self: SolidRotor, names: str | Sequence[str]) -> SolidRotor:
        """Return the rotor with all nodes of interfaces held fixed, e.g. a blade at its root.

        The rotor is then grounded in its own frame: it needs a frame whose motion is prescribed.
        The held coordinates keep one stiff spring each and no other stiffness.

        Parameters
        ----------
        names : str or sequence of str

        Raises
        ------
        ValueError
            If an interface is unknown, none is given, all its nodes are on one line, or the rotor
            carries a prestress.
        """
        check_unstressed(self)
        names = [names] if isinstance(names, str) else list(names)
        unknown = [name for name in names if name not in self.interfaces]
        if unknown or not names:
            raise ValueError(
                f"clamped: interfaces {unknown or names} are unknown; there are "
                f"{list(self.interfaces)}"
            )
        held = np.unique(np.concatenate([self.interfaces[name].nodes for name in names]))
        if rigid_basis(self.nodes[held]).shape[1] < 6:
            raise ValueError(
                f"clamped: the {held.size} nodes of {names} lie on one line and cannot hold "
                "rotations about it; clamp three nodes or more that do not"
            )
        kept = np.ones((self.node_count, 3))
        kept[held] = 0.0
        mask = sp.diags_array(kept.ravel())
        springs = sp.diags_array(_CLAMP * self.stiffness.diagonal().max() * (1 - kept.ravel()))
        stiffness = matrices.frozen(sp.csr_array(mask @ self.stiffness @ mask + springs))
        return replace(
            self,
            stiffness=stiffness,
            rigid_motions=count_rigid_motions(self.nodes, stiffness),
            elements=None if self.elements is None else self.elements.holding(held),
        )


def check_unstressed(rotor: SolidRotor) -> None:
    """Raise ValueError if the rotor carries a prestress."""
    if rotor.carried_prestress is not None:
        raise ValueError(
            "the rotor carries a prestress already; do this with the rotor before with_prestress"
        )


def stressed(rotor: SolidRotor, prestress: Prestress | bool | None) -> SolidRotor:
    """Return the rotor with what ``reduce(prestress=…)`` asks for."""
    if prestress is None:
        return rotor
    if prestress is False:
        return replace(rotor, carried_prestress=None)
    return rotor.with_prestress(rotor.prestress() if prestress is True else prestress)


def relief_rotations(rotor: SolidRotor) -> np.ndarray:
    """Return the angular accelerations of inertia relief per ω² and per ω̇, shape (2, 3).

    What balances the load on the free rigid motions is the inertia of such an acceleration; it
    strains nothing, and its work on second-order displacements is no part of K_G.
    """
    carried = rotor.carried_prestress
    if not carried.balanced:
        return np.zeros((2, 3))
    free = free_rigid_motions(rotor.nodes, rotor.mass, rotor.stiffness, rotor.rigid_motions)
    loads = np.stack([prestress.centrifugal_load(rotor), prestress.euler_load(rotor)])
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    inertia = turns.T @ (rotor.mass @ turns)
    momentum = turns.T @ (rotor.mass @ (free @ (free.T @ loads.T)))
    return (np.linalg.pinv(inertia, rcond=1e-12, hermitian=True) @ momentum).T


def _check_static_state(rotor: SolidRotor, given: Prestress) -> None:
    """Refuse a prestress of another static state than the rotor's own."""
    if given.constant is None and given.constant_stress is not None:
        raise ValueError(
            "prestress: this is what another rotor carries, whose stiffness holds the stress at "
            f"rest already; {_COMPUTE[:-1]}stress=…)"
        )
    if given.load is None or given.displacement is None:
        _check_imported(rotor, given)
    else:
        _check_computed(rotor, given)
    _check_loads(rotor, given)
    if not rotor.grounded:
        _check_rotations(rotor, given)
        if given.hub is None or given.hub.size == 0:
            _check_strains(rotor, given)


def _check_computed(rotor: SolidRotor, given: Prestress) -> None:
    """Compare load and displacement; forces of clamped nodes, which are alone, are not known."""
    load = prestress.centrifugal_load(rotor)
    change = np.linalg.norm(given.load - load)
    if change > _SAME * np.linalg.norm(load):
        raise ValueError(
            "prestress: it was computed for another centrifugal load, which differs by "
            f"{change / max(np.linalg.norm(load), 1e-300):.3g} of this rotor's own: another "
            f"density or axis, or point masses that were added or taken off; {_COMPUTE}"
        )
    if given.balanced:
        load = _balanced(rotor, load)
    stiffness, strength = rotor.stiffness, abs(rotor.stiffness)
    kept = coupled(stiffness).reshape(-1, 3)
    if given.hub is not None:
        kept[given.hub] = False
    if given.constant is not None:
        stiffness = stiffness + given.constant
    left = np.linalg.norm((stiffness @ given.displacement - load)[kept.ravel()])
    precision = max(_ROUNDING, _LOST * lost_digits(rotor.nodes, rotor.stiffness))
    rounding = precision * np.linalg.norm(strength @ np.abs(given.displacement))
    size = np.linalg.norm(load)
    if left > _SAME * size + rounding:
        raise ValueError(
            "prestress: its static displacement is none of this rotor, the elastic forces differ "
            f"from its load by {left / max(size, 1e-300):.3g} of it (rounding of an exported "
            f"matrix explains {rounding / max(size, 1e-300):.1g}): another elastic modulus, other "
            f"clamped nodes, or other springs to the ground; {_COMPUTE}"
        )


def _check_imported(rotor: SolidRotor, given: Prestress) -> None:
    """Refuse reactions of held nodes where the rotor can move."""
    if not given.balanced and rotor.rigid_motions:
        raise ValueError(
            "prestress: balanced=False says that held nodes take up the load, but the stiffness "
            f"of this rotor leaves {rotor.rigid_motions} rigid motions free, which their forces "
            "would resist falsely; hold them with rotor.clamped(...), or use a matrix computed "
            "with inertia relief"
        )


def _check_loads(rotor: SolidRotor, given: Prestress) -> None:
    """Check ``K_G x = f``, which holds by ``∇x = I`` at nodes that no support or hub touches."""
    away = np.ones(rotor.node_count, dtype=bool)
    if rotor.grounded:
        away = unsupported_nodes(rotor.nodes, rotor.stiffness)
    if given.hub is not None:
        away[given.hub] = False
    positions = (rotor.nodes - rotor.center_of_mass).ravel()
    for name, matrix, load, resisted in _known_loads(rotor, given):
        expected = (_balanced(rotor, load) if given.balanced else load) - resisted
        left = (matrix @ positions - expected).reshape(-1, 3)[away]
        error, size = np.linalg.norm(left), np.linalg.norm(expected.reshape(-1, 3)[away])
        if error > _IMPORT_TOLERANCE * size + _SAME * np.linalg.norm(load):
            raise ValueError(
                f"prestress: the {name} times the nodal positions gives the load of its stress, "
                f"which is {error / max(size, 1e-300):.3g} times this rotor's own load off it at "
                f"nodes away from supports; {_ALONE}, with this rotor's axis, density, point "
                "masses and held nodes"
            )


def _known_loads(
    rotor: SolidRotor, given: Prestress
) -> Iterator[tuple[str, sp.csr_array, np.ndarray, np.ndarray | float]]:
    """Yield name and matrix, the load behind it, and what a stress at rest resists of that.

    Of a free rotor the centrifugal load is left to :func:`_check_strains`: elements of other
    programs may balance it as a whole, and not at every node.
    """
    resists, displacement = given.constant, given.displacement
    if rotor.grounded and not given.initial_displacement:
        load = prestress.centrifugal_load(rotor)
        if resists is None:
            yield "matrix", given.matrix, load, 0.0
        elif displacement is not None:
            yield "matrix", given.matrix, load, resists @ displacement
    if given.euler is not None and resists is None:
        yield "Euler matrix", given.euler, prestress.euler_load(rotor), 0.0


def _check_strains(rotor: SolidRotor, given: Prestress) -> None:
    """Refuse a matrix that resists uniform strains of a free rotor otherwise than its load does.

    K_G acts on each direction alike and ``K_G x = f``, so that ``(A x)ᵀ K_G (B x) = (A x) · (B f)``
    for all A and B; rotations are the part of this that the elastic stiffness does not resist.
    """
    if given.initial_displacement:
        return
    positions = rotor.nodes - rotor.center_of_mass
    virial = positions.T @ _balanced(rotor, prestress.centrifugal_load(rotor)).reshape(-1, 3)
    fields = np.kron(positions, np.eye(3))
    found, expected = fields.T @ (given.matrix @ fields), np.kron(virial, np.eye(3))
    e = rotor.axis.direction
    error = np.abs(found - expected)
    worst = np.unravel_index(np.argmax(error), error.shape)
    if error[worst] > _IMPORT_TOLERANCE * abs(np.trace(virial) - e @ virial @ e):
        raise ValueError(
            "prestress: the matrix resists uniform strains of the whole rotor with "
            f"{found[worst]:.6g} kg m², and its centrifugal load per (rad/s)² with "
            f"{expected[worst]:.6g}; {_ALONE}, and no initial-displacement stiffness"
        )


def _check_rotations(rotor: SolidRotor, given: Prestress) -> None:
    """Refuse a matrix that does not act on rotations of a free rotor as the load does.

    By equilibrium ``(a×x)ᵀ K_G (b×x) = (a×x) · (b×f)`` with f the balanced load.
    """
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    load = prestress.centrifugal_load(rotor)
    load = (_balanced(rotor, load) if given.balanced else load).reshape(-1, 3)
    turned = np.stack([np.cross(axis, load).ravel() for axis in np.eye(3)], axis=1)
    expected, found = turns.T @ turned, turns.T @ (given.matrix @ turns)
    expected = 0.5 * (expected + expected.T)
    e = rotor.axis.direction
    error = np.abs(found - expected)
    i, j = np.unravel_index(np.argmax(error), error.shape)
    if error[i, j] > _IMPORT_TOLERANCE * abs(e @ expected @ e):
        raise ValueError(
            f"prestress: the matrix couples rotations about mesh axes {'xyz'[i]} and {'xyz'[j]} "
            f"with {found[i, j]:.6g} kg m², and the centrifugal load per (rad/s)² of this rotor "
            f"with {expected[i, j]:.6g}; {_ALONE}, and with this rotor's axis, density and point "
            "masses"
        )


def _balanced(rotor: SolidRotor, load: np.ndarray) -> np.ndarray:
    """Return a load (3n,) less the inertia forces of the rigid motions that it causes."""
    free = free_rigid_motions(rotor.nodes, rotor.mass, rotor.stiffness, rotor.rigid_motions)
    return load - rotor.mass @ (free @ (free.T @ load))
