"""Exudyn's forces and masses at chosen states of a scene, linearised at one angle of the spin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import exudyn
import numpy as np

from exudyn_rotor.bearings.journal_bearing import JournalBearing
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.linear.equations import EPSILON, UnconvergedError
from exudyn_rotor.linear.model.scene.attached import Attached, AttachedBearing, attached_to
from exudyn_rotor.linear.model.scene.differences import (
    CURVATURE,
    chosen_step,
    differences,
    slopes,
)
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.multibody.evaluation import constraint_rows, evaluating
from exudyn_rotor.multibody.rotor.equations import without_forces
from exudyn_rotor.multibody.supports.connector import SupportConnector
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
    """

    def __init__(
        self,
        scene: SceneCoordinates,
        speed: float,
        solver: exudyn.MainSolverStatic,
        attached: list[Attached],
    ) -> None:
        self.scene, self.speed, self.solver, self.attached = scene, speed, solver, attached
        self.mbs = scene.body.mbs
        self.bearings = [one for one in attached if isinstance(one, AttachedBearing)]
        self.spin = scene.spin_coordinate
        self.is_constrained = bool(solver.GetAEsize())
        self.has_foreign = bool(scene.foreign)
        self.rotor = np.arange(scene.modal.stop)
        self.step = self.velocity_step = None
        self.rotor_terms = lru_cache(_KEPT)(self._rotor_terms)
        self.turn = lru_cache(_KEPT)(scene.turn)

    @property
    def rounding(self) -> float:
        """Relative error of derivatives: of positions of order 1 m, and of the curvature left."""
        return EPSILON / self.step + CURVATURE**2

    @property
    def straight(self) -> float:
        """Motion [m] along which the forces are straight enough for their derivatives."""
        known = [one for one in self.attached if not isinstance(one.connector, SupportConnector)]
        return min(self.step, _STEPS[-1]) if known else self.step

    @property
    def films(self) -> list[AttachedBearing]:
        """Bearings with films of finite length."""
        kinds = JournalBearing | TiltingPadBearing
        return [one for one in self.bearings if isinstance(one.bearing, kinds)]

    @property
    def remembering(self) -> list[AttachedBearing]:
        """Bearings whose films conserve mass."""
        journals = [one for one in self.films if isinstance(one.bearing, JournalBearing)]
        return [one for one in journals if one.bearing.remembers]

    @contextmanager
    def without_tangents(self) -> Iterator[None]:
        """Let films that conserve mass have the same force at all states, and note it."""
        for one in self.remembering:
            one.stiff = False
            one.forget()
        try:
            yield
        finally:
            for one in self.remembering:
                one.stiff = True

    @contextmanager
    def as_in_lists(self, wanted: bool) -> Iterator[None]:
        """Let bearings be without torque, dampers with the force of small harmonic motions."""
        try:
            for one in self.attached:
                one.rest(wanted)
            yield
        finally:
            for one in self.attached:
                one.rest(False)

    def at_rest(self) -> Probe:
        """Return the same at the speed 0."""
        return Probe(self.scene, 0.0, self.solver, self.attached)

    def forget(self) -> None:
        """Forget where bearings have been seen."""
        for one in self.attached:
            one.forget()

    def see(self, theta: float, y: np.ndarray, y_t: np.ndarray) -> None:
        """See where bearings are in a motion y (k,) of the rate y_t, at one angle."""
        T, T1, _ = self.turn(theta)
        self.force(theta, T @ y, T @ y_t + self.speed * T1 @ y)

    @property
    def settling(self) -> list[Attached]:
        """Bearings that lists take otherwise than where they have been seen."""
        return [one for one in self.attached if one.settles]

    @contextmanager
    def settled(self, bearings: Sequence[Attached]) -> Iterator[None]:
        """Take bearings as lists do under the mean of the forces seen.

        Raises
        ------
        UnconvergedError
            Where there is no equilibrium.
        """
        try:
            for one in bearings:
                self._settle(one)
            yield
        finally:
            for one in bearings:
                one.release()

    def _settle(self, bearing: Attached) -> None:
        try:
            bearing.settle(self.speed)
        except (ValueError, ArithmeticError) as error:
            where = f"linear scene at {self.speed:g} rad/s"
            raise UnconvergedError(f"{where}: {error}") from error

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
        mass = full[np.ix_(self.scene.free, self.scene.free)]
        mass[np.ix_(self.rotor, self.rotor)] = 0.0
        for one in self.attached:
            if one.connector.has_mass:  # where the laws have been read
                whole = np.zeros_like(full)
                whole[np.ix_(one.places, one.places)] = one.connector.inertia()[0]
                rotor = self.scene.free[self.rotor]
                mass[np.ix_(self.rotor, self.rotor)] += whole[np.ix_(rotor, rotor)]
        return mass

    def mean_mass(self, count: int) -> np.ndarray:
        """Return the mass matrix (k, k) without deviations, its mean over so many angles."""
        still, total = np.zeros(len(self.scene.free)), 0.0
        for theta in 2.0 * np.pi * np.arange(count) / count:
            q, q_t = self._set(theta, still, still)
            for one in self.attached:
                if one.connector.has_mass:
                    one.read(q, q_t)
            T = self.turn(theta)[0]
            total = total + T.T @ (self.rotor_terms(theta)[0] + self.mass()) @ T
        return total / count

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
        return self.foreign(theta, x, v) + self.laws(theta, x, v)[0]

    def foreign(self, theta: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the forces of what is neither the rotor nor attached to it."""
        q, q_t = self._set(theta, x, v)
        self.solver.ComputeODE2RHS(self.mbs)  # the rotor's own object has none while it is probed
        total = np.array(self.solver.GetSystemResidual())[: len(q)]
        for one in self.attached:
            for matrix, state in zip(one.connector.native, (q, q_t), strict=True):
                if matrix is not None:
                    total[one.places] += matrix @ state[one.places]
        return total[self.scene.free]

    def laws(
        self, theta: float, x: np.ndarray, v: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the forces of what is attached, and less their derivatives by x and v."""
        q, q_t = self._state(theta, x, v)
        size = len(self.scene.rest)
        force, (K, D) = np.zeros(size), np.zeros((2, size, size))
        for one in self.attached:
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

    def unbalanced(self, theta: float, y: np.ndarray) -> np.ndarray:
        """Return what the forces lack for an equilibrium at rest (k,), as the residual of y."""
        _, _, K, constant = self.rotor_terms(theta)
        T = self.turn(theta)[0]
        x = T @ y
        return T.T @ (K @ x - constant - self.force(theta, x, np.zeros_like(x)))

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
def probing(scene: SceneCoordinates, speed: float, cage: float | None = None) -> Iterator[Probe]:
    """Open a scene for probing and leave it as it was.

    With an angle [rad], cages of rolling bearings stand where they are when the spin has it.
    """
    body = scene.body
    attached = attached_to(body.mbs, body.supports, body.drives, cage)
    with (
        _muted(body.mbs, attached, scene.native),
        without_forces(body.mbs, body.objects["physics"]),
        evaluating(body.mbs) as solver,
    ):
        yield Probe(scene, speed, solver, attached)


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


class Rest(NamedTuple):
    """What is beside the rotor at one angle θ, by the free coordinates x = T y and their rates.

    The mass matrix of x, and ``−TᵀF`` as D and K (k, k) by motions T y with T held.
    """

    theta: float
    turns: tuple[np.ndarray, np.ndarray, np.ndarray]
    mass: np.ndarray
    D: np.ndarray
    K: np.ndarray


class LinearPoint(NamedTuple):
    """M, D, K (k, k) at one angle, the residual of y, and the forces of all but the rotor (k,)."""

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    residual: np.ndarray
    forces: np.ndarray
    rest: Rest


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
    rotor_M, rotor_D, rotor_K, constant = probe.rotor_terms(theta)
    foreign = probe.foreign(theta, x, v)
    law, law_K, law_D = probe.laws(theta, x, v)
    M = rotor_M + probe.mass()
    foreign_D, foreign_K = _foreign_slopes(probe, theta, x, v, T, M)
    force = foreign + law
    rest_D, rest_K = T.T @ (law_D @ T + foreign_D), T.T @ (law_K @ T + foreign_K)
    inertia = M @ (T @ y_tt + 2.0 * T1 @ y_t + T2 @ y)
    residual = inertia + rotor_D @ v + rotor_K @ x - constant - force
    rest = Rest(theta, (T, T1, T2), M - rotor_M, rest_D, rest_K)
    carried = rest_D @ (T.T @ T1)  # the columns of rest_D are derivatives along T
    return LinearPoint(
        T.T @ M @ T,
        T.T @ (2.0 * M @ T1 + rotor_D @ T) + rest_D,
        T.T @ (M @ T2 + rotor_D @ T1 + rotor_K @ T) + rest_K + carried,
        T.T @ residual,
        T.T @ force,
        rest,
    )


def _foreign_slopes(
    probe: Probe, theta: float, x: np.ndarray, v: np.ndarray, T: np.ndarray, M: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return less the derivatives by rates and motions along T of what is not attached."""
    if not probe.has_foreign:
        probe.step, probe.velocity_step = _STEPS[0], _VELOCITY_STEPS[0]
        return np.zeros((2, *T.shape))
    sizes = probe.scene.metre(np.diag(T.T @ M @ T))

    def moved(x_i: np.ndarray) -> np.ndarray:
        return probe.foreign(theta, x + x_i, v)

    def sped_up(v_i: np.ndarray) -> np.ndarray:
        return probe.foreign(theta, x, v + v_i)

    if probe.step is None:
        probe.step = chosen_step(moved, T * sizes, _STEPS)
        probe.velocity_step = chosen_step(sped_up, T * sizes, _VELOCITY_STEPS)
    faster = probe.velocity_step
    K = -slopes(moved, probe.step * T * sizes) / (probe.step * sizes)
    D = -differences(sped_up, faster * T * sizes)[0] / (faster * sizes)
    return D, K
