"""Exudyn's forces and masses at chosen states of a scene, and the laws that are attached to it.

Linear equations have a prescribed spin, and leave out moments of a static force F₀ by small motions
u: that it turns with what carries the bearing, and that friction on this changes, by about F₀ u.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import exudyn
import numpy as np

from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.multibody.evaluation import constraint_rows, evaluating, without_forces
from exudyn_rotor.multibody.rotor.rotor_body import spin_at_start
from exudyn_rotor.multibody.supports.connector import Connector
from exudyn_rotor.theory.formulation import ConstantSpeed
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.stiffening import stiffening

_KEPT = 48  # angles whose terms of the rotor, and whose turned axes, are kept
_LOADS = 2  # Exudyn's word for loads that depend on places and rates


class Attached(NamedTuple):
    """A law that is attached to the rotor, and its coordinates among those of the scene."""

    connector: Connector
    places: np.ndarray

    def read(self, q: np.ndarray, q_t: np.ndarray) -> None:
        """Take the state of the scene."""
        self.connector.read(q[self.places].tolist(), q_t[self.places].tolist())


class Forces(NamedTuple):
    """Forces on the free coordinates, and less their derivatives by these and by their rates."""

    values: np.ndarray
    K: np.ndarray
    D: np.ndarray


class Probe:
    """Forces and masses at any state of a scene, spin Ω, beside the rotor's own terms.

    Supports and bearings are known by their laws. Exudyn evaluates all else.

    Attributes
    ----------
    scene : SceneCoordinates
    speed : float
    laws : list of Attached
        Of supports and bearings, in their order.
    """

    def __init__(
        self,
        scene: SceneCoordinates,
        speed: float,
        solver: exudyn.MainSolverStatic,
        laws: list[Attached],
    ) -> None:
        self.scene, self.speed, self.solver, self.laws = scene, speed, solver, laws
        self.mbs, self.spin = scene.body.mbs, scene.spin_coordinate
        self.rotor = np.arange(scene.modal.stop)
        self.rotor_terms = lru_cache(_KEPT)(self._rotor_terms)
        self.turn = lru_cache(_KEPT)(scene.turn)

    def at_rest(self) -> Probe:
        """Return the same scene without spin."""
        return Probe(self.scene, 0.0, self.solver, self.laws)

    # ------------------------------------------------------------------ constraints and masses

    def constraints(self, theta: float) -> np.ndarray:
        """Return the constraints' Jacobian by the free coordinates, rows that are zero left out."""
        self._set(theta, *np.zeros((2, len(self.scene.free))))
        rows = constraint_rows(self.mbs, self.solver, len(self.scene.rest))
        if not len(rows):
            return np.zeros((0, len(self.scene.free)))
        C = rows[:, self.scene.free] @ self.turn(theta)[0]
        return C[np.abs(C).max(axis=1) > 1e-14]

    def mass(self) -> np.ndarray:
        """Return the mass matrix of all but the rotor at the present state, free coordinates."""
        self.solver.ComputeMassMatrix(self.mbs)
        mass = self._of_free(np.array(self.solver.GetSystemMassMatrix()))
        attached, rotor = self._attached_mass(), np.ix_(self.rotor, self.rotor)
        mass[rotor] = attached[rotor]
        return mass

    def _attached_mass(self) -> np.ndarray:
        """Return the mass matrix of laws, where they have been read, by free coordinates."""
        whole = np.zeros((len(self.scene.rest),) * 2)
        for one in self.laws:
            if one.connector.has_mass:
                whole[one.places[:, None], one.places] += one.connector.mass_matrix()
        return self._of_free(whole)

    def mass_beside(self) -> np.ndarray:
        """Return the mass matrix of all but the rotor and laws, without deviations, (k, k)."""
        self.read(0.0, *np.zeros((2, len(self.scene.free))))
        return self.scene.N.T @ (self.mass() - self._attached_mass()) @ self.scene.N

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
            stiffening(body.motion.invariants, body.stiffening),
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

    # ------------------------------------------------------------------ forces

    def force(self, theta: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return the forces of all but the rotor's own equations, free coordinates."""
        return self._exudyn(theta, x, v) + self._laws(theta, x, v, has_slopes=False).values

    def forces(self, theta: float, x: np.ndarray, v: np.ndarray) -> Forces:
        """Return the forces of all but the rotor's own equations, with their derivatives."""
        pairs = zip(self.foreign(theta, x, v), self._laws(theta, x, v), strict=True)
        return Forces(*(X + Y for X, Y in pairs))

    def foreign(self, theta: float, x: np.ndarray, v: np.ndarray) -> Forces:
        """Return the forces of what is neither the rotor nor a law, with their derivatives."""
        values, slopes = self._exudyn(theta, x, v), []
        size = len(self.scene.rest) + self.solver.GetAEsize()
        for by_place, by_rate in ((-1.0, 0.0), (0.0, -1.0)):
            self.solver.SetSystemJacobian(np.zeros((size, size)))
            self.solver.ComputeJacobianODE2RHS(self.mbs, by_place, by_rate, 0.0, _LOADS)
            slopes.append(self._of_free(np.array(self.solver.GetSystemJacobian())))
        return Forces(values, *slopes)

    def _of_free(self, X: np.ndarray) -> np.ndarray:
        return X[np.ix_(self.scene.free, self.scene.free)]

    def _exudyn(self, theta: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        self._set(theta, x, v)
        self.solver.ComputeODE2RHS(self.mbs)  # the rotor's own object has none while it is probed
        return np.array(self.solver.GetSystemResidual())[self.scene.free]

    def read(self, theta: float, x: np.ndarray, v: np.ndarray) -> None:
        """Let the laws see a state."""
        q, q_t = self._set(theta, x, v)
        for one in self.laws:
            one.read(q, q_t)

    def _laws(self, theta: float, x: np.ndarray, v: np.ndarray, has_slopes: bool = True) -> Forces:
        """Return the forces of the laws; without slopes their derivatives are zero."""
        q, q_t = self._state(theta, x, v)
        size = len(self.scene.rest)
        force, (K, D) = np.zeros(size), np.zeros((2, size, size))
        for one in self.laws:
            one.read(q, q_t)
            force[one.places] += one.connector.forces(self._time(theta))
            slopes = one.connector.slopes(self._time(theta)) if has_slopes else ()
            for total, block in zip((K, D), slopes, strict=False):
                total[one.places[:, None], one.places] += block
        return Forces(force[self.scene.free], self._of_free(K), self._of_free(D))

    # ------------------------------------------------------------------ states

    def _time(self, theta: float) -> float:
        return theta / self.speed if self.speed else 0.0

    def _state(self, theta: float, x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return all coordinates and rates by a deviation x of the free ones, and their rates v."""
        q, q_t = self.scene.rest.copy(), np.zeros(len(self.scene.rest))
        q[self.scene.free] += x
        q_t[self.scene.free] = v
        q[self.spin], q_t[self.spin] = theta, self.speed
        return q, q_t

    def _set(self, theta: float, x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Put a deviation x of the free coordinates and their velocity v into the scene."""
        data, (q, q_t) = self.mbs.systemData, self._state(theta, x, v)
        data.SetODE2Coordinates(q)
        data.SetODE2Coordinates_t(q_t)
        data.SetTime(self._time(theta))
        if self.solver.GetAEsize():  # as every implicit solver does: some forces rely on it
            self.solver.ComputeAlgebraicEquations(self.mbs, False)
        return q, q_t


@contextmanager
def probing(scene: SceneCoordinates, speed: float) -> Iterator[Probe]:
    """Open a scene for probing and leave it as it was.

    Cages of rolling bearings stand where they are when the rotor starts.
    """
    body = scene.body
    cage = spin_at_start(body)[0]
    read = body.mbs.systemData.GetNodeLTGODE2
    laws = [
        Attached(made, np.concatenate([read(node) for node in made.nodes]).astype(int))
        for made in (one.connector for one in body.supports)
    ]
    with (
        _muted(body.mbs, laws, scene.native, cage),
        without_forces(body.mbs, body.objects["physics"]),
        evaluating(body.mbs) as solver,
    ):
        yield Probe(scene, speed, solver, laws)


@contextmanager
def _muted(
    mbs: exudyn.MainSystem,
    laws: Sequence[Attached],
    native: Sequence[exudyn.ObjectIndex],
    cage: float,
) -> Iterator[None]:
    """Let objects of the laws be without force, the `native` ones inactive."""

    def let(probed: float | None) -> None:
        for one in laws:
            one.connector.probed = probed
        for number in native:
            mbs.SetObjectParameter(number, "activeConnector", probed is None)

    let(cage)
    try:
        yield
    finally:
        let(None)


class LinearPoint(NamedTuple):
    """M, D, K (k, k) at one angle, and the residual of y (k,)."""

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    residual: np.ndarray


def unbalanced(probe: Probe, theta: float, *state: np.ndarray) -> np.ndarray:
    """Return the residual of y at one angle (k,), as :func:`linearised` has it."""
    force = probe.force(theta, *_moved(probe, theta, *state)[:2])
    return _residual(probe, theta, state, force)


def linearised(probe: Probe, theta: float, *state: np.ndarray) -> LinearPoint:
    """Return the scene linearised about y, with its rate and acceleration, at one angle."""
    T, T1, T2 = (probe.speed**n * X for n, X in enumerate(probe.turn(theta)))
    M, D, K, _ = probe.rotor_terms(theta)
    force, more_K, more_D = probe.forces(theta, *_moved(probe, theta, *state)[:2])
    residual = _residual(probe, theta, state, force)
    M, D, K = M + probe.mass(), D + more_D, K + more_K
    return LinearPoint(
        T.T @ M @ T,
        T.T @ (2.0 * M @ T1 + D @ T),
        T.T @ (M @ T2 + D @ T1 + K @ T),
        residual,
    )


def _moved(
    probe: Probe, theta: float, y: np.ndarray, y_t: np.ndarray, y_tt: np.ndarray
) -> list[np.ndarray]:
    """Return free coordinates with their rates and accelerations."""
    T, T1, T2 = (probe.speed**n * X for n, X in enumerate(probe.turn(theta)))
    return [T @ y, T @ y_t + T1 @ y, T @ y_tt + 2.0 * T1 @ y_t + T2 @ y]


def _residual(
    probe: Probe, theta: float, state: Sequence[np.ndarray], force: np.ndarray
) -> np.ndarray:
    x, v, a = _moved(probe, theta, *state)
    M, D, K, constant = probe.rotor_terms(theta)
    return probe.turn(theta)[0].T @ ((M + probe.mass()) @ a + D @ v + K @ x - constant - force)
