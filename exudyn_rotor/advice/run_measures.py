"""Numbers that say how well the assumptions of a run held, from its record."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import exudyn
import numpy as np
import scipy.linalg

from exudyn_rotor.advice.request import PERIOD_ERROR
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.multibody.rotor.record import Record, Solver, last_solver
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.fields import ModeKind
from exudyn_rotor.theory.stiffening import stiffening, tilt_factors

_TOP = 0.2  # share of the flexible modes, from the top, that shows what lies beyond
_RINGING = 1.5  # energy about the static stretch over that of a start without it, with a margin
_SPEEDS = np.linspace(0.1, 2.0, 20)  # looked at for growth, over the highest speed reached
_KINDS = exudyn.OutputVariableType

_HALVES = (slice(0, 3), slice(3, 6))  # translation, and tilt times the size
_EXPLICIT = {"RK33": np.sqrt(3.0), "VelocityVerlet": 2.0}  # ωh that undamped motion bears
_RK44 = np.sqrt(8.0)  # likewise; those with step control keep below it themselves


@dataclass(frozen=True, eq=False)
class Measures:
    """Numbers of one run.

    Attributes
    ----------
    body : RotorBody
    record : Record
    """

    body: RotorBody
    record: Record

    @cached_property
    def invariants(self):
        """Invariants in the basis of the run."""
        return self.body.motion.invariants

    @cached_property
    def flexible(self) -> np.ndarray:
        """Which modal coordinates are flexible modes, ascending in frequency."""
        stiff = np.diag(self.invariants.K) > 0.0
        elastic = [kind is ModeKind.ELASTIC for kind in self.body.selection.kinds]
        return np.flatnonzero(stiff & elastic)

    @cached_property
    def size(self) -> float:
        """Radius of gyration of the whole rotor [m]."""
        inv = self.invariants.moved(self.invariants.center)
        return float(np.sqrt(np.trace(inv.J) / inv.mass))

    @cached_property
    def _q(self) -> np.ndarray:
        return self.record.q[:, self.body.layout.unknowns]

    @cached_property
    def _q_t(self) -> np.ndarray:
        return self.record.q_t[:, self.body.layout.unknowns]

    @cached_property
    def zeta(self) -> np.ndarray:
        """Modal coordinates (s, m)."""
        return self._q[:, self.body.motion.modes]

    @cached_property
    def zeta_t(self) -> np.ndarray:
        """Modal velocities (s, m)."""
        return self._q_t[:, self.body.motion.modes]

    @cached_property
    def fastest(self) -> float:
        """Highest spin speed, either way round [rad/s]."""
        return float(np.abs(self.record.speed).max())

    def tilt(self) -> float:
        """Return the largest rigid tilt out of the axis [rad]."""
        e = self.invariants.direction
        rotation = self.zeta @ tilt_factors(self.invariants)[0][:3].T
        across = rotation - np.outer(rotation @ e, e)
        return float(np.linalg.norm(across, axis=1).max())

    def deflection(self) -> float:
        """Return the largest root mean square flexible displacement over the rotor's size."""
        moved = np.linalg.norm(self.zeta[:, self.flexible], axis=1) / np.sqrt(self.invariants.mass)
        return float(moved.max() / self.size)

    def travel(self) -> float:
        """Return how far the centre of mass leaves a frame that does not follow, over the size.

        Zero where the spin is prescribed: the mass matrix is constant there.
        """
        return self.adrift() if self.body.formulation.has_spin else 0.0

    def adrift(self) -> float:
        """Return how far the centre of mass leaves its place in the frame, over the size."""
        moved = np.linalg.norm(self.zeta @ self.invariants.S.T, axis=1) / self.invariants.mass
        return float(moved.max() / self.size)

    def frozen(self) -> float | None:
        """Return the share of the angular momentum that a frozen spin leaves out.

        That of ``½ωc + ζ̇ᵀWζ``, c the change of the moment of inertia about the axis, in Θ times the
        highest speed: the error of spin speeds. None for a spin that is not frozen.
        """
        if not self.body.formulation.has_frozen_spin:
            return None
        terms, zeta = self.body.motion.spin_terms, self.zeta
        change = 2.0 * zeta @ terms.h + np.einsum("si,is->s", zeta, terms.C_hat @ zeta.T)
        left = 0.5 * self.record.speed * change
        left += np.einsum("si,is->s", self.zeta_t, terms.W @ zeta.T)
        momentum_scale = self.invariants.Theta * self.fastest
        return float(np.abs(left).max() / momentum_scale) if momentum_scale else 0.0

    def locked(self) -> float:
        """Return how far locked coordinates are off: angles [rad], lengths over the size."""
        if "marker_body" not in self.body.objects:
            return 0.0
        unit = np.array([self.size] * 3 + [1.0] * 3)
        worst = 0.0
        for index in self.body.locks.fixed:
            worst = max(worst, np.abs(self.record.q[:, index]).max() / unit[index])
        for index, motion in self.body.locks.prescribed.items():
            wanted = np.array([float(motion.value(t)) for t in self.record.time])
            worst = max(worst, np.abs(self.record.q[:, index] - wanted).max() / unit[index])
        return float(worst)

    @cached_property
    def _energies(self) -> tuple[np.ndarray, float]:
        """Elastic energies (s, flexible modes), and the energy of the whole vibration [J]."""
        modes = self.flexible
        stiffness = np.diag(self.invariants.K)[modes]
        elastic = 0.5 * stiffness * self.zeta[:, modes] ** 2
        inv, omega = self.invariants, self.record.speed
        # inertial velocity of the deviation from rigid rotation: ζ̇ + ω ẽ ζ
        kinetic = 0.5 * np.einsum("si,ij,sj->s", self.zeta_t, inv.M, self.zeta_t)
        kinetic += omega * np.einsum("si,ij,sj->s", self.zeta_t, inv.G, self.zeta)
        kinetic += 0.5 * omega**2 * np.einsum("si,ij,sj->s", self.zeta, inv.C, self.zeta)
        kinetic += self._drift
        return elastic, float(elastic.sum(axis=1).max(initial=0.0) + kinetic.max(initial=0.0))

    @cached_property
    def _drift(self) -> np.ndarray:
        """Kinetic energy (s,) of the frame's translation about its mean velocity [J]."""
        count = self.body.motion.formulation.translation_count
        drift = self._q_t[:, :count] - self._q_t[:, :count].mean(axis=0)
        return 0.5 * self.invariants.mass * (drift**2).sum(axis=1)

    def top_share(self) -> float:
        """Return the elastic energy in the highest fifth of the modes over that of all motion.

        The static centrifugal stretch is left out, and as much again as a start at full speed
        without it makes ring: few modes breathe, wherever they stand, and more modes change
        nothing about it.
        """
        modes, energy = self.flexible, self._energies[1]
        if modes.size == 0 or energy == 0.0:
            return 0.0
        half = 0.5 * np.diag(self.invariants.K)[modes]
        elastic = half * (self.zeta - self._stretch)[:, modes] ** 2
        ringing = _RINGING * half * (self._stretch[:, modes] ** 2).max(axis=0)
        top = slice(-max(1, round(_TOP * modes.size)), None)
        return float(np.maximum(elastic - ringing, 0.0)[:, top].sum(axis=1).max() / energy)

    def strain(self) -> float:
        """Return the mean centrifugal strain ``ω² hᵀK⁻¹h / Θ`` that the modes show.

        The moment of inertia grows by ``2 hᵀζ₀`` under the static deformation ``ζ₀ = ω² K⁻¹h``,
        and with the square of radii.
        """
        inv, modes = self.invariants, self.flexible
        if modes.size == 0 or inv.Theta == 0.0:
            return 0.0
        growth = np.sum(inv.h[modes] ** 2 / np.diag(inv.K)[modes])
        return float(self.fastest**2 * growth / inv.Theta)

    def missing_stiffness(self) -> float:
        """Return the share of the stiffening that is left out, as a relative change of frequency.

        Half of its energy over that of the motion. Without a prestress the stiffening of flexible
        modes is that of a truss (:mod:`exudyn_rotor.prestress.estimate`) or, where there is none,
        ω² per unit of modal mass.
        """
        inv, level = self.invariants, self.body.stiffening
        if level == "full":
            return 0.0
        included = np.asarray(stiffening(inv, level).K2)
        if inv.K2 is not None:
            complete = np.asarray(inv.K2)
        else:
            complete = np.array(stiffening(inv, "tilt").K2)
            if inv.K2_estimated is None:
                complete[self.flexible, self.flexible] += 1.0
            else:
                places = np.ix_(self.flexible, self.flexible)
                complete[places] = inv.K2_estimated[places]
        zeta = self.zeta - self._stretch
        work = np.einsum("si,ij,sj->s", zeta, complete - included, zeta) * self.record.speed**2
        energy = self._energies[1]
        return float(0.25 * np.abs(work).max() / energy) if energy else 0.0

    @cached_property
    def _stretch(self) -> np.ndarray:
        """Static centrifugal deformation (s, m), about which the rotor vibrates."""
        inv, modes = self.invariants, self.flexible
        shape = np.zeros(inv.size)
        shape[modes] = inv.h[modes] / np.diag(inv.K)[modes]
        return self.record.speed[:, None] ** 2 * shape

    def divergence(self) -> float:
        """Return ``Ω²/Ω_d²`` of the flexible modes, Ω_d the speed at which they would diverge.

        They diverge where ``K − Ω²(C − K2)`` has a growing motion in spite of gyroscopic forces;
        a stiffness that is not definite alone does not count. Zero where nothing grows.
        """
        modes = np.ix_(self.flexible, self.flexible)
        K, G = self.invariants.K[modes], self.invariants.G[modes]
        C = np.asarray(self.body.motion.spin_terms.C_hat)[modes]
        if self.flexible.size == 0 or self.fastest == 0.0:
            return 0.0
        lowest = np.sqrt(np.diag(K).min())
        for factor in _SPEEDS:
            speed = factor * self.fastest
            if _grows(K - speed**2 * C, 2.0 * speed * G, 1e-6 * lowest):
                return float(1.0 / factor**2)
        return 0.0

    def step_error(self) -> float:
        """Return the relative period error of the recorded motion, ``κ(ωh)²`` with κ = 0.0844.

        ω is :attr:`frequency`. Motion of the rigid rotor that is slow in space, ``ω_s``, errs by
        ``κ(ωh)² ω/ω_s`` where it is integrated in the rotor frame.
        """
        solver = last_solver(self.body)
        if solver is None or solver.explicit or len(self.record.time) < 3:
            return 0.0
        return float(PERIOD_ERROR * solver.step**2 * max(self.frequency**2, self._slow()))

    @cached_property
    def frequency(self) -> float:
        """Mean frequency of the coordinates, weighted with their amplitudes squared [rad/s]."""
        vibrating = np.ones(self.body.motion.size, dtype=bool)
        if self.body.formulation.has_spin:
            vibrating[self.body.motion.formulation.translation_count] = False
        weight = np.ones(vibrating.sum())
        weight[: self.body.motion.formulation.translation_count] = np.sqrt(self.invariants.mass)
        return _frequency(weight * self._q[:, vibrating], weight * self._q_t[:, vibrating])

    def _slow(self) -> float:
        """Return ``ω³/ω_s`` of the rigid rotor's lateral motion [rad²/s²], by its share of it."""
        inv, e = self.invariants, self.invariants.direction
        rows = np.vstack([inv.S / inv.mass, self.size * tilt_factors(inv)[0][:3]])
        across = np.kron(np.eye(2), np.eye(3) - np.outer(e, e)) @ rows
        time, speed = self.record.time, self.record.speed
        angle = np.append(0.0, np.cumsum(0.5 * np.diff(time) * (speed[1:] + speed[:-1])))
        motion, rate = self.zeta @ across.T, self.zeta_t @ across.T
        inertial_rate = rate + speed[:, None] * np.hstack(
            [np.cross(e, motion[:, :3]), np.cross(e, motion[:, 3:])]
        )
        spatial = np.hstack([_turned(motion[:, half], e, angle) for half in _HALVES])
        spatial_rate = np.hstack([_turned(inertial_rate[:, half], e, angle) for half in _HALVES])
        size = np.sqrt((spatial**2).sum(axis=1).mean())
        worst = 0.0
        for half in _HALVES:
            slow = _frequency(spatial[:, half], spatial_rate[:, half])
            if slow > 0.0:
                share = np.sqrt(spatial[:, half].var(axis=0).sum()) / size
                worst = max(worst, share * _frequency(motion[:, half], rate[:, half]) ** 3 / slow)
        return worst

    def spin_step(self) -> float:
        """Return the largest spin angle per step [rad]."""
        solver = last_solver(self.body)
        return 0.0 if solver is None else solver.step * self.fastest

    def film_use(self) -> float | None:
        """Return the largest displacement of a journal now, over the way to the end of its film.

        None without films.
        """
        bearings = [one for one in self.body.supports if isinstance(one.support, Bearing)]
        shares = [one.support.film_use(one.values()[0][:2]) for one in bearings]
        return max((share for share in shares if share is not None), default=None)

    def explicit_step(self) -> float:
        """Return ``ω_max h`` over what an explicit solver bears; 0 for an implicit one."""
        solver = last_solver(self.body)
        if solver is None or not solver.explicit or self.flexible.size == 0:
            return 0.0
        highest = np.sqrt(np.diag(self.invariants.K)[self.flexible].max()) + self.fastest
        return float(solver.step * highest / _explicit_limit(solver))


def _explicit_limit(solver: Solver) -> float:
    """Return the ωh up to which undamped motion stays, or grows by e in the whole run at most.

    Euler's method multiplies it by ``√(1 + (ωh)²)`` a step, the midpoint rule by
    ``√(1 + (ωh)⁴/4)``.
    """
    if solver.method == "ExplicitEuler":
        return (2.0 / solver.steps) ** 0.5
    if solver.method == "ExplicitMidpoint":
        return (8.0 / solver.steps) ** 0.25
    return _EXPLICIT.get(solver.method, _RK44)


def _frequency(values: np.ndarray, rates: np.ndarray) -> float:
    """Return the mean frequency of signals (s, c), weighted with their amplitudes squared."""
    moved = values.var(axis=0).sum()
    return float(np.sqrt(rates.var(axis=0).sum() / moved)) if moved else 0.0


def _turned(values: np.ndarray, e: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return vectors (s, 3) across e, turned about it by angles (s,)."""
    return np.cos(angle)[:, None] * values + np.sin(angle)[:, None] * np.cross(e, values)


def _grows(K: np.ndarray, D: np.ndarray, smallest: float) -> bool:
    """Return True if ``ẍ + Dẋ + Kx = 0`` has a growing solution."""
    size = len(K)
    if np.linalg.eigvalsh(0.5 * (K + K.T)).min() > 0.0:
        return False
    companion = np.block([[np.zeros((size, size)), np.eye(size)], [-K, -D]])
    return bool(scipy.linalg.eigvals(companion).real.max() > smallest)
