"""Exudyn's forces and masses at chosen states of a scene, and the laws that are attached to it.

Linear equations leave out moments of a static force F₀ by small motions u, on the spin, too: that
it turns with what carries the bearing, and that friction on this changes, by about F₀ u.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property, lru_cache

import exudyn
import numpy as np

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.spin import ARM
from exudyn_rotor.multibody.evaluation import evaluating, without_forces
from exudyn_rotor.multibody.supports.connector import SceneLaw
from exudyn_rotor.theory.formulation import ConstantSpeed
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.stiffening import stiffening

_KEPT = 48  # angles whose terms of the rotor, and whose turned axes, are kept
_LOADS = 2  # Exudyn's word for loads that depend on places and rates
_WINDING = 1e-3  # share of a stiffness on the spin that a point off the axis has in the mean


class Probe:
    """Forces and masses at any state of a scene, spin Ω, beside the rotor's own terms.

    Supports and bearings are known by their laws, with cages of rolling bearings where they are
    when the rotor starts. Exudyn evaluates all else.

    Attributes
    ----------
    scene : LinearScene
    speed : float
    laws : list of Connector
        Of supports and bearings, in their order.
    """

    def __init__(self, scene: LinearScene, speed: float, solver: exudyn.MainSolverStatic) -> None:
        self.scene, self.speed, self.solver = scene, speed, solver
        body = scene.body
        self.mbs, self.spin = body.mbs, scene.spin_coordinate
        self.laws = [one.connector for one in body.supports]
        read = body.mbs.systemData.GetNodeLTGODE2
        self._places = [np.concatenate([read(n) for n in law.nodes]) for law in self.laws]
        self.rotor_terms = lru_cache(_KEPT)(self._rotor_terms)
        self.turn = lru_cache(_KEPT)(self._turn)

    def at_rest(self) -> Probe:
        """Return the same scene without spin."""
        return Probe(self.scene, 0.0, self.solver)

    def _turn(self, theta: float) -> list[np.ndarray]:
        """Return the free coordinates by the unknowns, and two derivatives by the time."""
        return [self.speed**n * X for n, X in enumerate(self.scene.turn(theta))]

    # ------------------------------------------------------------------ masses

    def mass(self) -> np.ndarray:
        """Return the mass matrix of all but the rotor at the present state, free coordinates."""
        self.solver.ComputeMassMatrix(self.mbs)
        mass = self._of_free(np.array(self.solver.GetSystemMassMatrix()))
        rotor = slice(self.scene.modal.stop)
        mass[rotor, rotor] = self._attached_mass()[rotor, rotor]
        return mass

    def _attached_mass(self) -> np.ndarray:
        """Return the mass matrix of laws, where they have been read, by free coordinates."""
        whole = np.zeros((len(self.scene.rest),) * 2)
        for law, places in zip(self.laws, self._places, strict=True):
            if law.has_mass:
                whole[places[:, None], places] += law.mass_matrix()
        return self._of_free(whole)

    @cached_property
    def mass_beside(self) -> np.ndarray:
        """Mass matrix of all but the rotor and laws, without deviations, (k, k)."""
        self.read(0.0, *np.zeros((2, len(self.scene.free))))
        return self.scene.N.T @ (self.mass() - self._attached_mass()) @ self.scene.N

    @cached_property
    def metres(self) -> np.ndarray:
        """How many metres each of the unknowns counts as, (k,).

        What moves as much kinetic energy as the rotor by a metre; beside the rotor at least one.
        """
        T = self.turn(0.0)[0]
        mass = T.T @ self.rotor_terms(0.0)[0] @ T + self.mass_beside
        return self.metres_of(mass, ~self.scene.touching)

    def metres_of(self, mass: np.ndarray, beside: np.ndarray | slice) -> np.ndarray:
        """Return the same of coordinates with a mass matrix (k, k), some `beside` the rotor."""
        metres = np.sqrt(np.maximum(np.diag(mass), 1e-300) / self.scene.mass)
        metres[beside] = np.maximum(metres[beside], 1.0)  # of light pads
        return metres

    def _rotor_terms(self, theta: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return M, D, K of the rotor and the force on it undeformed at Ω, free coordinates."""
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
        full[:, : motion.size, : motion.size] = motion.mass_matrix(0.0, zero), -by_v, -by_q
        constant = np.r_[motion.forces(0.0, zero, zero), np.zeros(size - motion.size)]
        moved = (X @ self.scene.undeformed for X in self.turn(theta)[::-1])
        return *full, constant - sum(X @ x for X, x in zip(full, moved, strict=True))

    # ------------------------------------------------------------------ forces

    def forces(
        self, theta: float, x: np.ndarray, v: np.ndarray, *, slopes: bool = True, laws: bool = True
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the forces of all but the rotor's own equations on the free coordinates.

        Then less their derivatives by these and by their rates, zero without `slopes`. Without
        `laws` the forces are what Exudyn has beside them.
        """
        q, q_t = self._set(theta, x, v)
        size = len(q)
        self.solver.ComputeODE2RHS(self.mbs)  # the rotor's own object has none while it is probed
        force = np.array(self.solver.GetSystemResidual())[:size]
        K, D = self._exudyn_slopes() if slopes else np.zeros((2, size, size))
        for law, places in zip(self.laws, self._places, strict=True) if laws else ():
            law.read(q[places].tolist(), q_t[places].tolist())
            force[places] += law.forces(self._time(theta))
            if slopes:
                by_place, by_rate = law.slopes(self._time(theta))
                K[places[:, None], places] += by_place
                D[places[:, None], places] += by_rate
        return force[self.scene.free], self._of_free(K), self._of_free(D)

    def check_free_spin(self, angles: Iterable[float], *, dampers: bool) -> None:
        """Refuse what Exudyn has about the axis of a free spin, in the mean of angles.

        Springs, and `dampers` where these count, but no drives of this package. By the undeformed
        state without loads: what remains is no moment of a static force.
        """
        scene, found = self.scene, []
        if not scene.is_spin_free:
            return
        places = np.r_[scene.free, self.spin]
        still = np.zeros((2, len(scene.free)))
        with _without(scene, scene.body.drives):
            for theta in angles:
                T, T1, _ = scene.turn(theta)
                self._set(theta, *still)
                slopes = np.array(self._exudyn_slopes(loads=0))[:, places[:, None], places]
                lateral = T[:, scene.touching] / self.metres[scene.touching]
                across = np.einsum("ij,nik,kj->nj", lateral, slopes[:, :-1, :-1], lateral)
                about_axis = np.r_[T1 @ scene.undeformed, 1.0]
                found.append(about_axis @ slopes @ about_axis)
        held, most = np.abs(np.mean(found, axis=0)), np.abs(across).max(axis=1, initial=0.0)
        least = ARM * np.maximum(most / scene.mass, 1.0) * scene.body.motion.invariants.Theta
        counts = held > np.maximum(least, _WINDING * np.abs(found).max(axis=0))
        if counts[0]:
            raise UnconvergedError(
                f"linear scene at {self.speed:g} rad/s: a spring of Exudyn holds the free spin, "
                f"{held[0]:.3g} N m/rad; give a flywheel as a second rotor, "
                "connect_rotors(FlexibleCoupling(…), …), a spring to the ground as "
                "Support(…, tilt_stiffness=…), or analyse the reduced rotor with these in a list"
            )
        if counts[1] and dampers:
            raise UnconvergedError(
                f"linear scene at {self.speed:g} rad/s: a damper of Exudyn brakes the free spin, "
                f"{held[1]:.3g} N m s/rad; give it as Support(…, tilt_damping=…), as drag that "
                "leaves the speed constant, add_drive(body, Drag(linear=…)), or prescribe the spin"
            )

    def _exudyn_slopes(self, loads: int = _LOADS) -> tuple[np.ndarray, np.ndarray]:
        """Return less the derivatives of Exudyn's forces at the present state.

        Without those of `loads` where these are 0.
        """
        size = len(self.scene.rest)
        whole, found = np.zeros((size + self.solver.GetAEsize(),) * 2), []
        for by_place, by_rate in ((-1.0, 0.0), (0.0, -1.0)):
            self.solver.SetSystemJacobian(whole)
            self.solver.ComputeJacobianODE2RHS(self.mbs, by_place, by_rate, 0.0, loads)
            found.append(np.array(self.solver.GetSystemJacobian())[:size, :size])
        return tuple(found)

    def _of_free(self, X: np.ndarray) -> np.ndarray:
        return X[np.ix_(self.scene.free, self.scene.free)]

    # ------------------------------------------------------------------ states

    def read(self, theta: float, x: np.ndarray, v: np.ndarray) -> None:
        """Let the laws see a state."""
        q, q_t = self._set(theta, x, v)
        for law, places in zip(self.laws, self._places, strict=True):
            law.read(q[places].tolist(), q_t[places].tolist())

    def _time(self, theta: float) -> float:
        return theta / self.speed if self.speed else 0.0

    def _set(self, theta: float, x: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Put the undeformed rotor, deviations x of free coordinates and their rates v there."""
        data, q, q_t = self.mbs.systemData, self.scene.rest.copy(), 0.0 * self.scene.rest
        T, T1, _ = self.turn(theta)
        q[self.scene.free] += x + T @ self.scene.undeformed
        q_t[self.scene.free] = v + T1 @ self.scene.undeformed
        q[self.spin], q_t[self.spin] = theta, self.speed
        data.SetODE2Coordinates(q)
        data.SetODE2Coordinates_t(q_t)
        data.SetTime(self._time(theta))
        if self.solver.GetAEsize():  # as every implicit solver does: some forces rely on it
            self.solver.ComputeAlgebraicEquations(self.mbs, False)
        return q, q_t

    # ------------------------------------------------------------------ equations of the unknowns

    def unbalanced(self, theta: float, *state: np.ndarray) -> np.ndarray:
        """Return the residual of y, with its rate and acceleration, at one angle (k,)."""
        return self._balance(theta, *state, slopes=False)[-1]

    def linearised(self, theta: float, *state: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return M, D, K (k, k) about y, its rate and acceleration at one angle, and residual (k,).

        The residual is what the motion leaves unbalanced.
        """
        M, D, K, residual = self._balance(theta, *state, slopes=True)
        T, T1, T2 = self.turn(theta)
        by_rate, by_place = 2.0 * M @ T1 + D @ T, M @ T2 + D @ T1 + K @ T
        return T.T @ M @ T, T.T @ by_rate, T.T @ by_place, residual

    def _balance(
        self, theta: float, y: np.ndarray, y_t: np.ndarray, y_tt: np.ndarray, slopes: bool
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return M, D, K of the free coordinates, and the residual of y."""
        T, T1, T2 = self.turn(theta)
        x, v, a = T @ y, T @ y_t + T1 @ y, T @ y_tt + 2.0 * T1 @ y_t + T2 @ y
        M, D, K, constant = self.rotor_terms(theta)
        force, more_K, more_D = self.forces(theta, x, v, slopes=slopes)
        M = M + self.mass()
        residual = T.T @ (M @ a + D @ v + K @ x - constant - force)
        return M, D + more_D, K + more_K, residual


@contextmanager
def probing(scene: LinearScene, speed: float) -> Iterator[Probe]:
    """Open a scene for probing, its laws without force, and leave it as it was."""
    body, mbs = scene.body, scene.body.mbs
    silent = _without(scene, body.supports)
    with silent, without_forces(mbs, body.objects["physics"]), evaluating(mbs) as solver:
        yield Probe(scene, speed, solver)


@contextmanager
def _without(scene: LinearScene, laws: Sequence[SceneLaw]) -> Iterator[None]:
    """Let the objects of laws be without force, and those that Exudyn evaluates inactive."""
    mbs, name = scene.body.mbs, "activeConnector"
    items = {number: mbs.GetObject(number) for one in laws for number in one.objects}
    active = {number: item[name] for number, item in items.items() if name in item}

    def probe(angle: float | None) -> None:
        for one in laws:
            if one.connector is not None:
                one.connector.probed = angle
        for number, given in active.items():
            mbs.SetObjectParameter(number, name, given and angle is None)

    probe(scene.body.placement.angle)
    try:
        yield
    finally:
        probe(None)
