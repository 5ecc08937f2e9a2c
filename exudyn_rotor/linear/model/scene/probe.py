"""Exudyn's forces and masses at chosen states of a scene, linearised at one angle of the spin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import exudyn
import numpy as np

from exudyn_rotor.bearings.held_law import (
    HeldBearing,
    MovingJournalError,
    TangentContacts,
    TangentFilm,
    TangentShortFilm,
)
from exudyn_rotor.bearings.support import BelowTableError
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.differences import (
    CURVATURE,
    chosen_step,
    differences,
    slopes,
)
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.linear.solve.state import EPSILON
from exudyn_rotor.multibody.evaluation import constraint_rows, evaluating
from exudyn_rotor.multibody.rotor.equations import without_forces
from exudyn_rotor.multibody.supports.held_tilts import HeldTilts, held_tilts
from exudyn_rotor.multibody.supports.linear_laws import linear_laws
from exudyn_rotor.multibody.supports.magnetic_connectors import TangentMagnets, tangent_magnets
from exudyn_rotor.theory.formulation import ConstantSpeed
from exudyn_rotor.theory.motion import Motion

# root mean square displacement [m] of a difference step: as large as nonlinearity allows, because
# Exudyn's forces are differences of positions of order 1 m
_STEPS = (1e-4, 1e-5, 1e-6, 1e-7)
_VELOCITY_STEPS = (1e-3, 1e-4, 1e-5, 1e-6)  # m/s
_MOVED, _POSITION = 1e-4, exudyn.OutputVariableType.Position  # of a coordinate
_KEPT = 48  # angles whose terms of the rotor, and whose turned axes, are kept


class Probe:
    """Exudyn's forces and masses at any state of a scene, spin Ω, beside the rotor's own terms."""

    def __init__(
        self,
        scene: SceneCoordinates,
        speed: float,
        solver: exudyn.MainSolverStatic,
        bearings: tuple[HeldBearing, ...],
        magnets: tuple[TangentMagnets, ...],
        tilts: tuple[HeldTilts, ...],
    ) -> None:
        self.scene, self.speed, self.solver = scene, speed, solver
        self.bearings, self.magnets, self.tilts = bearings, magnets, tilts
        self.mbs = scene.body.mbs
        self.laws = [law for bearing in bearings for law in bearing.laws]
        self.films = [law for law in self.laws if isinstance(law, TangentFilm)]
        self.carriers = _carriers_of_pads(scene)
        self._held, self._carried = False, None
        self.spin = scene.spin_coordinate
        self.is_constrained = bool(solver.GetAEsize())
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
        by_tangent = TangentFilm | TangentShortFilm | TangentContacts
        known = any(isinstance(law, by_tangent) for law in self.laws)
        return min(self.step, _STEPS[-1]) if known or self.magnets else self.step

    @property
    def remembering(self) -> list[TangentFilm]:
        """Films that conserve mass."""
        return [film for film in self.films if film.bearing.remembers]

    @contextmanager
    def without_tangents(self) -> Iterator[None]:
        """Let films that conserve mass have the same force at all states, and note it."""
        for film in self.remembering:
            film.stiff, film.seen = False, []
        try:
            yield
        finally:
            for film in self.remembering:
                film.stiff = True

    @contextmanager
    def as_in_lists(self, wanted: bool) -> Iterator[None]:
        """Let bearings be without torque, dampers with the force of small harmonic motions."""
        try:
            for law in self.laws:
                law.rest(wanted)
            yield
        finally:
            for law in self.laws:
                law.rest(False)

    def at_rest(self) -> Probe:
        """Return the same at the speed 0."""
        return Probe(self.scene, 0.0, self.solver, self.bearings, self.magnets, self.tilts)

    def forget(self) -> None:
        """Forget where bearings have been seen."""
        for law in (*self.laws, *self.magnets):
            law.seen = []

    def see(self, theta: float, y: np.ndarray, y_t: np.ndarray) -> None:
        """See where bearings are in a motion y (k,) of the rate y_t, at one angle."""
        T, T1, _ = self.turn(theta)
        with self.held():
            self.force(theta, T @ y, T @ y_t + self.speed * T1 @ y)

    @property
    def settling(self) -> list[HeldBearing | TangentMagnets]:
        """Bearings that lists take otherwise than where they have been seen."""
        return [one for one in (*self.bearings, *self.magnets) if one.settles]

    @contextmanager
    def settled(self, bearings: Sequence[HeldBearing | TangentMagnets]) -> Iterator[None]:
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

    def _settle(self, bearing: HeldBearing | TangentMagnets) -> None:
        try:
            bearing.settle(self.speed)
        except (ValueError, ArithmeticError) as error:
            where = f"linear scene at {self.speed:g} rad/s"
            raise UnconvergedError(f"{where}: {error}") from error

    @contextmanager
    def held(self) -> Iterator[None]:
        """Hold laws of bearings and supports, and what carries pads, from the next state on."""
        self._hold(True)
        try:
            yield
        finally:
            self._hold(False)

    def _hold(self, held: bool) -> None:
        self._held, self._carried = held, None
        for law in (*self.laws, *self.magnets, *self.tilts):
            law.hold(held)

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
        return mass

    def mean_mass(self, count: int) -> np.ndarray:
        """Return the mass matrix (k, k) without deviations, its mean over so many angles."""
        still, total = np.zeros(len(self.scene.free)), 0.0
        for theta in 2.0 * np.pi * np.arange(count) / count:
            self._set(theta, still, still)
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

    def motion_of(self, marker: exudyn.MarkerIndex) -> np.ndarray:
        """Return the displacement (3, free coordinates) of a marker beside the rotor."""
        motion, still = np.zeros((3, len(self.scene.free))), np.zeros(len(self.scene.free))
        for column in range(self.scene.modal.stop, len(self.scene.free)):
            ends = []
            for step in (_MOVED, -_MOVED):
                moved = still.copy()
                moved[column] = step
                self._set(0.0, moved, still)
                ends.append(self.mbs.GetMarkerOutput(marker, _POSITION))
            motion[:, column] = (ends[0] - ends[1]) / (2.0 * _MOVED)
        return motion

    def force(self, theta: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the forces of all but the rotor's own equations, free coordinates."""
        q, q_t = self._set(theta, x, v)
        try:  # the rotor's own object has none while it is probed
            self.solver.ComputeODE2RHS(self.mbs)
        except ValueError as error:  # Exudyn's, from what a support's function raised
            if isinstance(error.__cause__, BelowTableError | MovingJournalError):
                raise error.__cause__ from None
            raise
        total = np.array(self.solver.GetSystemResidual())[: len(q)]
        if self._carried is not None:
            total[self.carriers] = self._carried[2]
        elif self._held:
            self._carried = tuple(each[self.carriers] for each in (q, q_t, total))
        return total[self.scene.free]

    def unbalanced(self, theta: float, y: np.ndarray) -> np.ndarray:
        """Return what the forces lack for an equilibrium at rest (k,), as the residual of y."""
        _, _, K, constant = self.rotor_terms(theta)
        T = self.turn(theta)[0]
        x = T @ y
        return T.T @ (K @ x - constant - self.force(theta, x, np.zeros_like(x)))

    def _set(self, theta: float, x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Put a deviation x of the free coordinates and their velocity v into the scene."""
        data = self.mbs.systemData
        q, q_t = self.scene.rest.copy(), np.zeros(len(self.scene.rest))
        q[self.scene.free] += x
        q_t[self.scene.free] = v
        if self.spin is not None:
            q[self.spin], q_t[self.spin] = theta, self.speed
        if self._carried is not None:
            q[self.carriers], q_t[self.carriers], _ = self._carried
        data.SetODE2Coordinates(q)
        data.SetODE2Coordinates_t(q_t)
        data.SetTime(theta / self.speed if self.speed else 0.0)
        if self.is_constrained:  # as every implicit solver does: some forces rely on it
            self.solver.ComputeAlgebraicEquations(self.mbs, False)
        return q, q_t


@contextmanager
def probing(scene: SceneCoordinates, speed: float, cage: float | None = None) -> Iterator[Probe]:
    """Open a scene for probing and leave it as it was.

    With an angle [rad], cages of rolling bearings stand where they are when the spin has it.
    """
    body = scene.body
    with (
        linear_laws(body, cage) as bearings,
        tangent_magnets(body) as magnets,
        held_tilts(body) as tilts,
        without_forces(body.mbs, body.objects["physics"]),
        evaluating(body.mbs) as solver,
    ):
        yield Probe(scene, speed, solver, bearings, magnets, tilts)


def _carriers_of_pads(scene: SceneCoordinates) -> np.ndarray:
    """Return the coordinates by which what carries tilting pads turns with a base.

    Static tilts that turn with it are left out as static forces that do.
    """
    found = (one.carrier_rotations(scene.body.mbs) for one in scene.body.supports)
    return np.concatenate([np.zeros(0, dtype=int), *found])


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


def linearised(
    probe: Probe, theta: float, y: np.ndarray, y_t: np.ndarray, y_tt: np.ndarray
) -> LinearPoint:
    """Return the scene linearised about y at one angle."""
    with probe.held():
        return _linearised(probe, theta, y, y_t, y_tt)


def unbalanced(
    probe: Probe, theta: float, y: np.ndarray, y_t: np.ndarray, y_tt: np.ndarray
) -> np.ndarray:
    """Return the residual of y at one angle (k,), as :func:`linearised` has it."""
    with probe.held():
        return probe.turn(theta)[0].T @ _state(probe, theta, y, y_t, y_tt).residual


class _State(NamedTuple):
    """Free coordinates and velocities at one angle, the rotor's D and K, all M, and forces."""

    x: np.ndarray
    v: np.ndarray
    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    force: np.ndarray
    residual: np.ndarray


def _state(probe: Probe, theta: float, y: np.ndarray, y_t: np.ndarray, y_tt: np.ndarray) -> _State:
    T, T1, T2 = (probe.speed**n * X for n, X in enumerate(probe.turn(theta)))
    x, v = T @ y, T @ y_t + T1 @ y
    M, D, K, constant = probe.rotor_terms(theta)
    force = probe.force(theta, x, v)
    M = M + probe.mass()
    inertia = M @ (T @ y_tt + 2.0 * T1 @ y_t + T2 @ y)
    return _State(x, v, M, D, K, force, inertia + D @ v + K @ x - constant - force)


def _linearised(
    probe: Probe, theta: float, y: np.ndarray, y_t: np.ndarray, y_tt: np.ndarray
) -> LinearPoint:
    T, T1, T2 = (probe.speed**n * X for n, X in enumerate(probe.turn(theta)))
    x, v, M, rotor_D, rotor_K, force, residual = _state(probe, theta, y, y_t, y_tt)
    sizes = probe.scene.metre(np.diag(T.T @ M @ T))

    def moved(x_i: np.ndarray) -> np.ndarray:
        return probe.force(theta, x + x_i, v)

    def sped_up(v_i: np.ndarray) -> np.ndarray:
        return probe.force(theta, x, v + v_i)

    if probe.step is None:
        probe.step = chosen_step(moved, T * sizes, _STEPS)
        probe.velocity_step = chosen_step(sped_up, T * sizes, _VELOCITY_STEPS)
    rest_K = -slopes(moved, probe.step * T * sizes) / (probe.step * sizes)
    faster = probe.velocity_step
    rest_D = -differences(sped_up, faster * T * sizes)[0] / (faster * sizes)
    rest = Rest(theta, (T, T1, T2), M - probe.rotor_terms(theta)[0], T.T @ rest_D, T.T @ rest_K)
    carried = rest.D @ (T.T @ T1)  # the columns of rest_D are derivatives along T
    return LinearPoint(
        T.T @ M @ T,
        T.T @ (2.0 * M @ T1 + rotor_D @ T) + rest.D,
        T.T @ (M @ T2 + rotor_D @ T1 + rotor_K @ T) + rest.K + carried,
        T.T @ residual,
        T.T @ force,
        rest,
    )
