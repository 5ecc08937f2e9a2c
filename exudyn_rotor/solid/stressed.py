"""What a solid rotor does about static stress: prestress, and nodes that are clamped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.modes.component import check_same_mesh
from exudyn_rotor.modes.relief import free_rigid_motions
from exudyn_rotor.nodal import rotations
from exudyn_rotor.solid import checks, prestress
from exudyn_rotor.solid.prestress import Prestress
from exudyn_rotor.solid.rigid import count_rigid_motions

if TYPE_CHECKING:
    from exudyn_rotor.solid.rotor import SolidRotor

# of the largest diagonal entry: clamped nodes move by less than 1e-10 of the others, and dense
# eigenvalues, whose error is relative to the stiffest spring, keep four digits
_CLAMP = 1e6
# share of the moment of inertia by which an imported matrix may miss its action on rotations
_ROTATION_TOLERANCE = 0.01


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
            Interfaces whose nodes are held fixed for the static solution, e.g. a bore on a rigid
            shaft.
        initial_displacement : bool, optional
            Also the stiffness from the change of shape by u⁰: the rest of what is linear in u⁰ in
            St. Venant–Kirchhoff elasticity. Of the order of the static strain.
        euler : bool, optional
            Also the stiffness from the stress of an angular acceleration. Without it the
            rigid-body part of that is used, which is all of it for a rotor that nothing holds.
        stress : array_like, shape (n, 6), optional
            Stress at rest, from an interference fit or temperature: xx, yy, zz, yz, xz, xy at the
            nodes in mesh axes [Pa]. It must be in equilibrium without load; what averaging at
            nodes lost of that is put right by one elastic solution.
        yield_stress : float, optional
            Yield stress [Pa].
        speed : float, optional
            Highest speed [rad/s]; warns if the von Mises stress is above `yield_stress` there.

        Raises
        ------
        ValueError
            If the rotor has no elements (not made by :meth:`from_ngsolve`) or carries a prestress
            already, an interface is unknown, or `stress` belongs to another mesh.

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
            If it belongs to another mesh, the rotor carries one already, or the matrix acts on
            rotations of the rotor in another way than the centrifugal load does.
        """
        if not isinstance(prestress, Prestress):
            raise TypeError(f"prestress: expected a Prestress, got {type(prestress).__name__}")
        check_unstressed(self)
        check_same_mesh(self.nodes, prestress.nodes)
        _check_rotations(self, prestress)
        stiffness = self.stiffness
        if prestress.constant is not None:
            stiffness = checks.frozen(sp.csr_array(stiffness + prestress.constant))
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
            If an interface is unknown, none is given, or the rotor carries a prestress.
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
        kept = np.ones((self.node_count, 3))
        kept[held] = 0.0
        mask = sp.diags_array(kept.ravel())
        springs = sp.diags_array(_CLAMP * self.stiffness.diagonal().max() * (1 - kept.ravel()))
        stiffness = checks.frozen(sp.csr_array(mask @ self.stiffness @ mask + springs))
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


def _check_rotations(rotor: SolidRotor, given: Prestress) -> None:
    """Refuse a matrix that does not act on rotations of a free rotor as the load does.

    By equilibrium ``(a×x)ᵀ K_G (b×x) = (a×x) · (b×f)`` with f the balanced load.
    """
    if rotor.grounded or not given.balanced:
        return
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    free = free_rigid_motions(rotor.nodes, rotor.mass, rotor.stiffness, 6)
    load = prestress.centrifugal_load(rotor)
    load = (load - rotor.mass @ (free @ (free.T @ load))).reshape(-1, 3)
    turned = np.stack([np.cross(axis, load).ravel() for axis in np.eye(3)], axis=1)
    expected, found = turns.T @ turned, turns.T @ (given.matrix @ turns)
    e = rotor.axis.direction
    if np.abs(found - expected).max() > _ROTATION_TOLERANCE * abs(e @ expected @ e):
        raise ValueError(
            f"prestress: the matrix resists a spin about the axis with {e @ found @ e:.6g} kg m², "
            f"and the centrifugal load per (rad/s)² of this rotor with {e @ expected @ e:.6g}; "
            "it must hold the geometric stiffness alone (no spin softening, no elastic "
            "stiffness), for 1 rad/s; if nodes were fixed in its static solution, say "
            "balanced=False"
        )
