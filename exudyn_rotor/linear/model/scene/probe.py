"""Exudyn's forces and masses at chosen states of a scene, linearised at one angle of the spin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import exudyn
import numpy as np

from exudyn_rotor.linear.equations import EPSILON
from exudyn_rotor.linear.model.scene.attached import Attached
from exudyn_rotor.linear.model.scene.differences import (
    CURVATURE,
    chosen_step,
    differences,
    slopes,
)
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.multibody.evaluation import constraint_rows, evaluating
from exudyn_rotor.multibody.rotor.equations import without_forces
from exudyn_rotor.multibody.rotor.start_state import spin_at_start
from exudyn_rotor.theory.formulation import ConstantSpeed
from exudyn_rotor.theory.motion import Motion

# root mean square displacement [m] of a difference step: as large as nonlinearity allows, because
# Exudyn's forces are differences of positions of order 1 m
_STEPS = (1e-4, 1e-5, 1e-6, 1e-7)
_VELOCITY_STEPS = (1e-3, 1e-4, 1e-5, 1e-6)  # m/s
_KEPT = 48  # angles whose terms of the rotor, and whose turned axes, are kept


class Probe:
    """Forces and masses at any state of a scene, spin Ω, beside the rotor's own terms.

    What is attached to the rotor is known by its laws; differences are taken of what else Exudyn
    has in the scene.

    Attributes
    ----------
    scene : SceneCoordinates
    speed : float
    laws : list of Attached
        Of supports and bearings, in their order.
    drives : list of Attached
    """

    def __init__(
        self,
        scene: SceneCoordinates,
        speed: float,
        solver: exudyn.MainSolverStatic,
        laws: list[Attached],
        drives: list[Attached],
    ) -> None:
        self.scene, self.speed, self.solver = scene, speed, solver
        self.laws, self.drives = laws, drives
        self.mbs = scene.body.mbs
        self.spin = scene.spin_coordinate
        self.is_constrained = bool(solver.GetAEsize())
        self.rotor = np.arange(scene.modal.stop)
        self.step = self.velocity_step = None
        self.rotor_terms = lru_cache(_KEPT)(self._rotor_terms)
        self.turn = lru_cache(_KEPT)(scene.turn)

    @property
    def rounding(self) -> float:
        """Relative error of derivatives: of positions of order 1 m, and of the curvature left."""
        return EPSILON / (self.step or _STEPS[0]) + CURVATURE**2

    @property
    def attached(self) -> list[Attached]:
        """All that is attached to the rotor."""
        return self.laws + self.drives

    def at_rest(self) -> Probe:
        """Return the same at the speed 0."""
        return Probe(self.scene, 0.0, self.solver, self.laws, self.drives)

    def constraints(self, theta: float) -> np.ndarray:
        """Return the constraints' Jacobian by the free coordinates, rows that are zero left out."""
        self._set(theta, np.zeros(len(self.scene.free)), np.zeros(len(self.scene.free)))
        rows = constraint_rows(self.mbs, self.solver, len(self.scene.rest))
        if not len(rows):
            return np.zeros((0, len(self.scene.free)))
        C = rows[:, self.scene.free] @ self.turn(theta)[0]
        return C[np.abs(C).max(axis=1) > 1e-14]

    def mass(self) -> np.ndarray:
        """Return the mass matrix of all but the rotor at the present state, free coordinates."""
        self.solver.ComputeMassMatrix(self.mbs)
        full = np.array(self.solver.GetSystemMassMatrix())
        free, attached = self.scene.free, self.attached_mass(full.shape)
        mass = full[np.ix_(free, free)]
        rotor = free[self.rotor]
        mass[np.ix_(self.rotor, self.rotor)] = attached[np.ix_(rotor, rotor)]
        return mass

    def attached_mass(self, shape: tuple[int, int]) -> np.ndarray:
        """Return the mass matrix of laws, where they have been read, by all coordinates."""
        whole = np.zeros(shape)
        for one in self.attached:
            if one.connector.has_mass:
                whole[np.ix_(one.places, one.places)] += one.connector.inertia()[0]
        return whole

    def mass_beside(self) -> np.ndarray:
        """Return the mass matrix of all but the rotor and laws, without deviations, (k, k)."""
        self.read(0.0, *np.zeros((2, len(self.scene.free))))
        free, N = self.scene.free, self.scene.N
        mass = self.mass() - self.attached_mass((len(self.scene.rest),) * 2)[np.ix_(free, free)]
        return N.T @ mass @ N

    @cached_property
    def resisting(self) -> tuple[float, float]:
        """Largest stiffness and damping of what Exudyn evaluates, though it is known."""
        given = [self.scene.foundation_matrices, *(one.connector.native for one in self.attached)]
        sizes = [[0.0 if X is None else np.abs(X).max(initial=0.0) for X in pair] for pair in given]
        return tuple(np.max(sizes, axis=0).tolist())

    @cached_property
    def masses(self) -> np.ndarray:
        """Diagonal of the mass matrix of all without deviations, (k,)."""
        T = self.turn(0.0)[0]
        return np.diag(T.T @ self.rotor_terms(0.0)[0] @ T + self.mass_beside())

    def _rotor_terms(self, theta: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return the rotor's M, D, K and constant force at Ω, in the free coordinates."""
        body, size = self.scene.body, len(self.scene.free)
        form = replace(
            body.motion.formulation, spin=ConstantSpeed(self.speed, theta), spin_coupling="full"
        )
        if form.moves_origin:
            form = replace(form, translation="none")
        motion = Motion(
            body.motion.invariants,
            form,
            self.scene.second_order,
            orientation=body.motion.orientation,
            plane=body.motion.free_directions,
            gravity=body.motion.gravity,
        )
        zero = np.zeros(motion.size)
        by_q, by_v = motion.jacobian(0.0, zero, zero)
        full = np.zeros((3, size, size))
        matrices = motion.mass_matrix(0.0, zero), -by_v, -by_q
        full[(slice(None), *np.ix_(self.rotor, self.rotor))] = matrices
        return *full, np.r_[motion.forces(0.0, zero, zero), np.zeros(size - motion.size)]

    def force(self, theta: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the forces of all but the rotor's own equations, free coordinates."""
        return self.foreign(theta, x, v) + self.all_known(theta, x, v)[0]

    def all_known(
        self, theta: float, x: np.ndarray, v: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return as :meth:`known`, of all that is attached and of foundations."""
        force, K, D = self.known(theta, x, v, self.attached)
        q, q_t = self._state(theta, x, v)
        free, matrices = self.scene.free, self.scene.foundation_matrices
        resisted = matrices[0] @ q + matrices[1] @ q_t
        more = (X[np.ix_(free, free)] for X in matrices)
        return force - resisted[free], *(X + Y for X, Y in zip((K, D), more, strict=True))

    def foreign(self, theta: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the forces of what is neither the rotor nor attached to it."""
        q, q_t = self._set(theta, x, v)
        self.solver.ComputeODE2RHS(self.mbs)  # the rotor's own object has none while it is probed
        total = np.array(self.solver.GetSystemResidual())[: len(q)]
        K, D = self.scene.foundation_matrices
        total += K @ q + D @ q_t
        for one in self.attached:
            for matrix, state in zip(one.connector.native, (q, q_t), strict=True):
                if matrix is not None:
                    total[one.places] += matrix @ state[one.places]
        return total[self.scene.free]

    def read(self, theta: float, x: np.ndarray, v: np.ndarray) -> None:
        """Let what is attached see a state."""
        q, q_t = self._set(theta, x, v)
        for one in self.attached:
            one.read(q, q_t)

    def known(
        self, theta: float, x: np.ndarray, v: np.ndarray, attached: Sequence[Attached]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the forces of what is attached, and less their derivatives by x and v."""
        q, q_t = self._state(theta, x, v)
        size = len(self.scene.rest)
        force, (K, D) = np.zeros(size), np.zeros((2, size, size))
        for one in attached:
            one.read(q, q_t)
            found, places = one.force(self._time(theta)), one.places
            force[places] += found.values @ found.J
            slopes = found.slopes()
            if one.connector.has_mass:
                _, turning, *more = one.connector.inertia()
                force[places] += turning
                slopes = [X + Y for X, Y in zip(slopes, more, strict=True)]
            parts = zip((K, D), slopes, one.connector.native, (q, q_t), strict=True)
            for total, block, native, state in parts:
                if native is not None:
                    block += native
                    force[places] -= native @ state[places]
                total[np.ix_(places, places)] += block
        free = self.scene.free
        return force[free], *(X[np.ix_(free, free)] for X in (K, D))

    def slopes_along(
        self, theta: float, x: np.ndarray, v: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return less the derivatives by motions and rates along T of what is not attached."""
        T = self.turn(theta)[0]
        if not self.scene.foreign:
            return np.zeros((2, *T.shape))
        sizes = self.scene.metre(self.masses)

        def moved(x_i: np.ndarray) -> np.ndarray:
            return self.foreign(theta, x + x_i, v)

        def sped_up(v_i: np.ndarray) -> np.ndarray:
            return self.foreign(theta, x, v + v_i)

        if self.step is None:
            self.step = chosen_step(moved, T * sizes, _STEPS)
            self.velocity_step = chosen_step(sped_up, T * sizes, _VELOCITY_STEPS)
        faster = self.velocity_step
        K = -slopes(moved, self.step * T * sizes) / (self.step * sizes)
        D = -differences(sped_up, faster * T * sizes)[0] / (faster * sizes)
        return K, D

    def unbalanced(self, theta: float, y: np.ndarray) -> np.ndarray:
        """Return what the forces lack for an equilibrium at rest (k,), as the residual of y."""
        none = np.zeros_like(y)
        return unbalanced(self, theta, y, none, none)

    def _time(self, theta: float) -> float:
        return theta / self.speed if self.speed else 0.0

    def _state(self, theta: float, x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return all coordinates and rates by a deviation x of the free ones, and their rates v."""
        q, q_t = self.scene.rest.copy(), np.zeros(len(self.scene.rest))
        q[self.scene.free] += x
        q_t[self.scene.free] = v
        if self.spin is not None:
            q[self.spin], q_t[self.spin] = theta, self.speed
        return q, q_t

    def _set(self, theta: float, x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Put a deviation x of the free coordinates and their velocity v into the scene."""
        data, (q, q_t) = self.mbs.systemData, self._state(theta, x, v)
        data.SetODE2Coordinates(q)
        data.SetODE2Coordinates_t(q_t)
        data.SetTime(self._time(theta))
        if self.is_constrained:  # as every implicit solver does: some forces rely on it
            self.solver.ComputeAlgebraicEquations(self.mbs, False)
        return q, q_t


@contextmanager
def probing(scene: SceneCoordinates, speed: float) -> Iterator[Probe]:
    """Open a scene for probing and leave it as it was.

    Cages of rolling bearings stand where they are when the rotor starts.
    """
    body = scene.body
    made = [one.connector for one in body.drives if getattr(one, "connector", None) is not None]
    cage = spin_at_start(body)[0]
    laws = [Attached(body.mbs, one.connector, cage) for one in body.supports]
    drives = [Attached(body.mbs, connector, cage) for connector in made]
    with (
        _muted(body.mbs, laws + drives, scene.native),
        without_forces(body.mbs, body.objects["physics"]),
        evaluating(body.mbs) as solver,
    ):
        yield Probe(scene, speed, solver, laws, drives)


@contextmanager
def _muted(
    mbs: exudyn.MainSystem, attached: Sequence[Attached], native: Sequence[exudyn.ObjectIndex]
) -> Iterator[None]:
    """Let objects of what is attached be without force, the `native` ones inactive."""

    def let(muted: bool) -> None:
        for one in attached:
            one.connector.muted = muted
        for number in native:
            mbs.SetObjectParameter(number, "activeConnector", not muted)

    let(True)
    try:
        yield
    finally:
        let(False)


class LinearPoint(NamedTuple):
    """M, D, K (k, k) at one angle, the residual of y, and the forces of all but the rotor (k,)."""

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    residual: np.ndarray
    forces: np.ndarray


def unbalanced(
    probe: Probe, theta: float, y: np.ndarray, y_t: np.ndarray, y_tt: np.ndarray
) -> np.ndarray:
    """Return the residual of y at one angle (k,), as :func:`linearised` has it."""
    T, T1, T2 = (probe.speed**n * X for n, X in enumerate(probe.turn(theta)))
    x, v = T @ y, T @ y_t + T1 @ y
    M, D, K, constant = probe.rotor_terms(theta)
    force = probe.force(theta, x, v)
    inertia = (M + probe.mass()) @ (T @ y_tt + 2.0 * T1 @ y_t + T2 @ y)
    return T.T @ (inertia + D @ v + K @ x - constant - force)


def linearised(
    probe: Probe, theta: float, y: np.ndarray, y_t: np.ndarray, y_tt: np.ndarray
) -> LinearPoint:
    """Return the scene linearised about y at one angle."""
    T, T1, T2 = (probe.speed**n * X for n, X in enumerate(probe.turn(theta)))
    x, v = T @ y, T @ y_t + T1 @ y
    M, rotor_D, rotor_K, constant = probe.rotor_terms(theta)
    force, law_K, law_D = probe.all_known(theta, x, v)
    force = force + probe.foreign(theta, x, v)
    M = M + probe.mass()
    K, D = probe.slopes_along(theta, x, v)
    K, D = T.T @ (law_K @ T + K), T.T @ (law_D @ T + D)
    inertia = M @ (T @ y_tt + 2.0 * T1 @ y_t + T2 @ y)
    residual = inertia + rotor_D @ v + rotor_K @ x - constant - force
    return LinearPoint(
        T.T @ M @ T,
        T.T @ (2.0 * M @ T1 + rotor_D @ T) + D,
        # the columns of D are derivatives along T
        T.T @ (M @ T2 + rotor_D @ T1 + rotor_K @ T) + K + D @ (T.T @ T1),
        T.T @ residual,
        T.T @ force,
    )
