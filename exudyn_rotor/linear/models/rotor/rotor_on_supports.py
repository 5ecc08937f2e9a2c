"""A reduced rotor with linear supports: dense equations at any spin speed.

The coordinates are those of its basis in the rotor frame, rigid motions included: Eqs. (105) and
(109) with centrifugal stiffening.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import check_interfaces
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.cached import cached_property, kept
from exudyn_rotor.linear.models.free_motions import free_motions_of_reduced, free_motions_of_solid
from exudyn_rotor.linear.models.points import Ring, ring_motions, spread
from exudyn_rotor.linear.models.protocol import Mesh, PointMotions
from exudyn_rotor.linear.models.rotor.eccentricity import decoupling, warn_of_eccentricity
from exudyn_rotor.linear.models.rotor.identity_basis import as_reduced
from exudyn_rotor.linear.models.rotor.spin import (
    Rotations,
    Spin,
    rotations_of,
    rotations_of_reduced,
)
from exudyn_rotor.linear.models.rotor.supported_rotor import SupportedRotor
from exudyn_rotor.linear.models.whole_space import InAllCoordinates, WholeSpace
from exudyn_rotor.linear.periodic.periodic_system import ConstantSystems, PeriodicSystem, Terms
from exudyn_rotor.reduction.fields import ModeShapes
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.theory.spin_terms import SpinTerms
from exudyn_rotor.theory.stiffening import chosen_level
from exudyn_rotor.theory.stiffening import stiffening as second_order
from exudyn_rotor.threads import one_thread

_SINGULAR = 1e-12  # of a stiffness that leaves motions free


@dataclass(frozen=True, eq=False)
class LinearRotor(SupportedRotor, InAllCoordinates):
    """A reduced rotor with linear supports, ready for any spin speed.

    Attributes
    ----------
    rotor : ReducedRotor
    supports : tuple of Support
    invariants : Invariants
        In the reduced basis, about the foot of the centre of mass on the axis.
    terms : SpinTerms
        What the spin adds to the equations.
    spin : Spin, optional
        The spin as a coordinate.
    free_motions : tuple of str
        Rigid motions that no spring holds.
    stiffening : str, optional
        Level of the centrifugal stiffening.
    is_full : bool, optional
        Whether the basis leaves nothing out.
    """

    gives_all: ClassVar[bool] = True

    rotor: ReducedRotor
    supports: tuple[Support, ...]
    invariants: Invariants
    terms: SpinTerms
    spin: Spin | None = None
    free_motions: tuple[str, ...] = ()
    stiffening: str = "tilt"
    is_full: bool = False

    @classmethod
    def of(
        cls,
        rotor: ReducedRotor,
        supports: Sequence[Support] = (),
        stiffening: str = "auto",
        rotations: Rotations | None = None,
        *,
        twisted: bool = False,
    ) -> LinearRotor:
        """Put a rotor on supports; `rotations` where its spin is no column of the basis.

        `twisted` where more than the supports may hold its torsion.

        Raises
        ------
        ValueError
            If a support is at an unknown interface; the message lists the known ones.
        """
        check_interfaces(supports, rotor.interfaces)
        with one_thread():
            invariants, terms, level = without_supports(rotor, stiffening)
            linear = cls(rotor, tuple(supports), invariants, terms, stiffening=level)
            rotations = rotations or rotations_of_reduced(rotor)
            if rotations is not None:
                linear = replace(linear, spin=linear._on_supports(rotations, twisted))
            free = free_motions_of_reduced(rotor, supports, linear.free_spin is not None)
        return replace(linear, free_motions=free)

    @classmethod
    def of_solid(
        cls, rotor: SolidRotor, supports: Sequence[Support] = (), stiffening: str = "auto"
    ) -> LinearRotor:
        """Put a small solid rotor on supports, in all its nodal displacements.

        Raises
        ------
        ValueError
            If a support is at an unknown interface; the message lists the known ones.
        """
        linear = cls.of(as_reduced(rotor), supports, stiffening, rotations_of(rotor))
        free = free_motions_of_solid(rotor, supports, linear.free_spin is not None)
        return replace(linear, free_motions=free, is_full=True)

    def _on_supports(self, rotations: Rotations, twisted: bool) -> Spin:
        """Return the spin on the supports; with a warning where the rotor is eccentric."""
        motions = [self.interface_motion(support.interface) for support in self.supports]
        inv, axis = self.invariants, self.rotor.axis
        spin = Spin.of(rotations, self.supports, motions, inv, axis, twisted)
        warn_of_eccentricity(inv, spin)
        return spin

    @property
    def mesh(self) -> Mesh | None:
        """Nodes of the mesh; None where the rotor was stored without mode shapes."""
        shapes = self.rotor.shapes
        if shapes is None:
            return None
        return Mesh(shapes.nodes, shapes.matrix, self.rotor.axis, shapes.triangles)

    def interface_motion(self, name: str) -> np.ndarray:
        """Return the interface's motion (6, k): displacement and rotation along (n1, n2, e)."""
        if name not in self._interface_motions:
            motion = self.rotor.interfaces[name].motion.reshape(2, 3, -1)
            turned = axes_of(self.rotor.axis).T @ motion
            self._interface_motions[name] = checks.read_only(turned.reshape(6, -1))
        return self._interface_motions[name]

    @cached_property
    def _interface_motions(self) -> dict[str, np.ndarray]:
        """Those asked for so far."""
        return {}

    @cached_property
    def spin_terms(self) -> SpinTerms:
        """The terms, of whose stiffness the spin feels nothing, nor rigid motions if it is free."""
        if self.spin is None:
            return self.terms
        given = {"C_hat": self.terms.C_hat, "K4": self.terms.K4}
        return replace(
            self.terms,
            G=self.terms.G - self.spin.unturned(np.eye(self.size)),
            **{
                name: self.spin.uncoupled(matrix.__matmul__, np.eye(self.size))
                for name, matrix in given.items()
                if matrix is not None
            },
        )

    @cached_property
    def supported_motions(self) -> list[np.ndarray]:
        """The motions (6, k) at the supports, which a free spin does not displace."""
        motions = [self.interface_motion(support.interface) for support in self.supports]
        if self.spin is None:
            return motions
        shifts = zip(motions, self.spin.shifts, strict=True)
        return [U + np.outer(shift, self.spin.momentum) for U, shift in shifts]

    def supported_motion(self, index: int) -> Terms:
        """Return the motion (6, k) that a support acts on, as one Fourier term."""
        return {0: self.supported_motions[index]}

    def with_supports(self, supports: tuple[Support, ...]) -> LinearRotor:
        """Return the rotor with other supports at the same interfaces; its spin stays as it is."""
        return replace(self, supports=supports)

    @cached_property
    def _constant(self) -> tuple[Terms, Terms, Terms]:
        """Damping, stiffness and stiffness per Ω of the supports that do not vary with the speed.

        With those of the rotor itself, but for its gyroscopic and centrifugal terms.
        """
        D, K, carried = {0: self.invariants.D}, {0: self.invariants.K}, {}
        for support, U in zip(self.supports, self.supported_motions, strict=True):
            if not support.varies:
                for terms, harmonics in zip((D, K, carried), support.parts(0.0), strict=True):
                    add_terms(terms, harmonics, U)
        return D, K, carried

    @cached_property
    def _varying(self) -> list[tuple[Support, np.ndarray]]:
        """The supports that vary with the speed, with what they act on."""
        both = zip(self.supports, self.supported_motions, strict=True)
        return [(support, U) for support, U in both if support.varies]

    def constant_at(self, speeds: Sequence[float]) -> ConstantSystems | None:
        """Return the equations at spin speeds [rad/s].

        None where they change in time, or have to be made one by one.
        """
        coupled = self.spin is not None and self.spin.coupled
        if coupled or self._varying or any(set(terms) > {0} for terms in self._constant):
            return None
        D, K, carried = (terms.get(0, 0.0) for terms in self._constant)
        speed = np.asarray(speeds)[:, None, None]
        D = D + self.spin_terms.damping(speed)
        K = K + carried * speed + self.spin_terms.stiffness(speed)
        return ConstantSystems(self.invariants.M[None], D, K)

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        D, K, carried = (dict(terms) for terms in self._constant)
        for n, X in carried.items():
            K[n] = K.get(n, 0.0) + speed * X
        D[0] = D[0] + self.spin_terms.damping(speed)
        K[0] = K[0] + self.spin_terms.stiffness(speed)
        for support, U in self._varying:
            for terms, harmonics in zip((D, K), support.terms(speed), strict=True):
                add_terms(terms, harmonics, U)
        if self.spin is not None and self.spin.coupled:
            torsion = self.steady_torsion(speed)
            K[0] = K[0] + torsion * np.outer(self.spin.momentum, self.spin.momentum)
        system = PeriodicSystem(float(speed), {0: self.invariants.M}, D, K, self.invariants.H)
        return system if self.spin is None else replace(system, drift=self._drift)

    @cached_property
    def _drift(self) -> float:
        return 0.0 if self.spin.free else decoupling(self.invariants)

    def steady_torsion(self, speed: float) -> float:
        """Return the stiffness of a coupled spin by the steady forces of the supports [rad²/s²].

        ``F·ρ``, see :mod:`exudyn_rotor.linear.models.rotor.spin`; F is the mean over a revolution
        of what the rotor's own unbalance causes.
        """
        motions = self.supported_motions
        pulls = [s.terms(speed)[1].get(0, np.zeros((6, 6))).real for s in self.supports]
        K = self.invariants.K + self.spin_terms.stiffness(speed)
        for U, pull in zip(motions, pulls, strict=True):
            K = K + U.T @ pull @ U
        rest = self.spin.rest()
        load = speed**2 * (rest.T @ self.unit_unbalance)
        steady = rest @ np.linalg.lstsq(rest.T @ K @ rest, load, rcond=_SINGULAR)[0]
        forces = [(pull @ (U @ steady))[:3] for U, pull in zip(motions, pulls, strict=True)]
        return float(sum(f @ bend for f, bend in zip(forces, self.spin.bends, strict=True)))

    def point_motions(self, most: int) -> PointMotions:
        """Return points of the mesh, or of rings that move with the interfaces."""
        rotor = self.rotor
        axes = axes_of(rotor.axis)
        if rotor.shapes is None:
            rings = [
                Ring((entry.reference - rotor.axis.point) @ axes, entry.radius,
                     self.interface_motion(name))
                for name, entry in rotor.interfaces.items()
            ]  # fmt: skip
            return ring_motions(rings, self.size)
        return _mesh_motions(rotor.shapes, rotor.axis, most)

    def whole_space(self, held: bool) -> WholeSpace:
        """Return all coordinates, `held` without a spin that nothing holds."""
        light = replace(self, rotor=self.rotor.without_shapes())
        if self.free_spin is None:
            return WholeSpace(light, can_be_sent=True)
        if held:
            return WholeSpace(light, can_be_sent=True, others=self.spin.rest())
        # if the spin were free, a constant torque however small would turn it on and on
        motions = np.column_stack([self.spin.motion, self.spin.rest()])
        given = {"can_be_sent": True, "driven": (0,), "motions_beside_spin": motions}
        return WholeSpace(light, **given)


@kept
def without_supports(rotor: ReducedRotor, stiffening: str) -> tuple[Invariants, SpinTerms, str]:
    """Return what supports do not change: invariants, terms and level; made once for each level."""
    origin = rotor.axis.project(rotor.center_of_mass)
    invariants = rotor.invariants.moved(origin - rotor.center_of_mass)
    level = chosen_level(stiffening, invariants.K2 is not None)
    terms = SpinTerms.of(invariants, second_order(invariants, level))
    estimate = invariants.K2_estimated if stiffening == "auto" else None
    if terms.K4 is not invariants.K4 or estimate is not invariants.K2_estimated:
        invariants = replace(invariants, K4=terms.K4, K2_estimated=estimate)
    return invariants, terms, level


def add_terms(terms: dict[int, np.ndarray], harmonics: Terms, U: np.ndarray) -> None:
    """Add Fourier terms that act on the motion U."""
    for n, X in harmonics.items():
        block = congruent(X.real, U) if n == 0 else U.T @ X @ U
        terms[n] = terms.get(n, 0.0) + block


def congruent(X: np.ndarray, U: np.ndarray) -> np.ndarray:
    """Return ``UᵀXU`` with exactly symmetric and skew parts.

    The rounding of a stiff support would else be a circulatory force.
    """
    result = np.zeros((U.shape[1], U.shape[1]))
    for sign in (1.0, -1.0):
        part = 0.5 * (X + sign * X.T)
        if np.any(part):
            block = U.T @ part @ U
            result += 0.5 * (block + sign * block.T)
    return result


@kept
def _mesh_motions(shapes: ModeShapes, axis: SpinAxis, most: int) -> PointMotions:
    """Return up to `most` nodes along (n1, n2, e) from a point of the axis."""
    axes, nodes = axes_of(axis), spread(len(shapes.nodes), most)
    points = (shapes.nodes[nodes] - axis.point) @ axes
    motion = shapes.matrix.reshape(len(shapes.nodes), 3, -1)[nodes]
    motion = np.einsum("ab,sak->sbk", axes, motion).reshape(3 * len(nodes), -1)
    return PointMotions(points, motion, None, True)
