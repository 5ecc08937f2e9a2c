"""Numbers that say how well the assumptions of a run held, from its record."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import exudyn
import numpy as np

from exudyn_rotor.advice.request import PERIOD_ERROR
from exudyn_rotor.advice.run_loads import external_force
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.multibody.rotor.connections import lost_items
from exudyn_rotor.multibody.rotor.record import Record, Solver, last_solver
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.fields import ModeKind
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.theory.invariants import inertia_tensor
from exudyn_rotor.theory.stiffening import stiffening

_FORCE = exudyn.OutputVariableType.Force
_TOP = 0.2  # share of the flexible modes, from the top, that shows what lies beyond
_RINGING = 1.5  # energy about the static stretch over that of a start without it, with a margin
_EXPLICIT = {"RK33": np.sqrt(3.0), "VelocityVerlet": 2.0}  # ωh that undamped motion bears
_RK44 = np.sqrt(8.0)  # likewise; those with step control keep below it themselves


@dataclass(frozen=True, eq=False)
class Measures:
    """Numbers of one run.

    Attributes
    ----------
    body : RotorBody
        Reduced or full.
    record : Record
    reduced : ReducedRotor, optional
        Knows the yield stress.
    """

    body: RotorBody
    record: Record
    reduced: ReducedRotor | None = None

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

    def _coordinates(self, rows: np.ndarray) -> np.ndarray:
        return rows[:, self.body.layout.unknowns]

    @cached_property
    def zeta(self) -> np.ndarray:
        """Modal coordinates (s, m); of a full body the displacements of all nodes."""
        return self._coordinates(self.record.q)[:, self.body.motion.modes]

    @cached_property
    def zeta_t(self) -> np.ndarray:
        """Modal velocities (s, m)."""
        return self._coordinates(self.record.q_t)[:, self.body.motion.modes]

    @cached_property
    def fastest(self) -> float:
        """Highest spin speed, either way round [rad/s]."""
        return float(np.abs(self.record.speed).max())

    @cached_property
    def _mean_rotation(self) -> np.ndarray:
        return self.zeta @ self.invariants.mean_rotation.T

    @cached_property
    def _mean_translation(self) -> np.ndarray:
        return self.zeta @ self.invariants.S.T / self.invariants.mass

    def tilt(self) -> float:
        """Return the largest rigid tilt out of the axis [rad]."""
        e, rotation = self.invariants.direction, self._mean_rotation
        return float(np.linalg.norm(rotation - np.outer(rotation @ e, e), axis=1).max())

    def deflection(self) -> float:
        """Return the largest root mean square flexible displacement over the rotor's size."""
        inv = self.invariants
        theta, turned = inertia_tensor(inv), self._mean_rotation
        bent = _squares(inv.M, self.zeta) - inv.mass * (self._mean_translation**2).sum(axis=1)
        bent -= np.einsum("si,ij,sj->s", turned, theta, turned)
        return float(np.sqrt(max(bent.max(), 0.0) / inv.mass) / self.size)

    def adrift(self) -> float:
        """Return how far the centre of mass leaves its place in the frame, over the size."""
        return float(np.linalg.norm(self._mean_translation, axis=1).max() / self.size)

    def unresisted(self) -> float:
        """Return the largest load or force that the rotor cannot carry, over the largest load.

        Moments count over the rotor's size. Values are those at the end of the run.
        """
        mbs, largest = self.body.mbs, 0.0
        for is_load, number in lost_items(self.body):
            if is_load:
                load = mbs.GetLoad(number)
                size = float(np.linalg.norm(mbs.GetLoadValues(number)))
                marker = mbs.GetMarker(int(load["markerNumber"]))
                turns = "Torque" in load["loadType"] or int(marker.get("coordinate", 0)) in (
                    3,
                    4,
                    5,
                )
                largest = max(largest, size / self.size if turns else size)
            else:
                force = mbs.GetObjectOutput(number, _FORCE)
                largest = max(largest, float(np.linalg.norm(force)))
        if not largest:
            return 0.0
        return largest / max(largest, external_force(self.body, self.record))

    def frozen(self) -> float | None:
        """Return the share of the angular momentum that a frozen spin leaves out.

        It is ``½ωc + ζ̇ᵀWζ``, c the change of the moment of inertia about the axis, over Θ times
        the highest speed: the error of spin speeds. None for a spin that is not frozen.
        """
        if not self.body.formulation.has_frozen_spin:
            return None
        terms, zeta = self.body.motion.spin_terms, self.zeta
        change = 2.0 * zeta @ terms.h + _squares(terms.C_hat, zeta)
        left = 0.5 * self.record.speed * change
        left += np.einsum("si,is->s", self.zeta_t, terms.W @ zeta.T)
        momentum = self.invariants.Theta * self.fastest
        return float(np.abs(left).max() / momentum) if momentum else 0.0

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
        modes, inv, omega = self.flexible, self.invariants, self.record.speed
        elastic = 0.5 * np.diag(inv.K)[modes] * self.zeta[:, modes] ** 2
        # inertial velocity of the deviation from rigid rotation: ζ̇ + ω ẽ ζ
        kinetic = 0.5 * _squares(inv.M, self.zeta_t) + 0.5 * omega**2 * _squares(inv.C, self.zeta)
        kinetic += omega * np.einsum("si,ij,sj->s", self.zeta_t, inv.G, self.zeta)
        frame = self._coordinates(self.record.q_t)[:, self.body.motion.translations]
        kinetic += 0.5 * inv.mass * ((frame - frame.mean(axis=0)) ** 2).sum(axis=1)
        return elastic, float(elastic.sum(axis=1).max(initial=0.0) + kinetic.max(initial=0.0))

    @cached_property
    def _stretch(self) -> np.ndarray:
        """Static centrifugal deformation (s, m), about which the rotor vibrates."""
        inv, modes = self.invariants, self.flexible
        shape = np.zeros(inv.size)
        shape[modes] = inv.h[modes] / np.diag(inv.K)[modes]
        return self.record.speed[:, None] ** 2 * shape

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

    def missing_stiffness(self) -> float:
        """Return the share of the stiffening that is left out, as a relative change of frequency.

        Half of its energy over that of the motion; without a prestress by the estimate of
        :mod:`exudyn_rotor.prestress.carrying` or, where there is none, ω² per unit of modal mass.
        """
        inv, level = self.invariants, self.body.stiffening
        if level == "full":
            return 0.0
        included, complete = np.asarray(stiffening(inv, level).K2), inv.K2
        if complete is None:
            complete = np.array(stiffening(inv, "tilt").K2)
            places = np.ix_(self.flexible, self.flexible)
            if inv.K2_estimated is None:
                complete[places] += np.eye(self.flexible.size)
            else:
                complete[places] = inv.K2_estimated[places]
        work = self.record.speed**2 * _squares(complete - included, self.zeta - self._stretch)
        energy = self._energies[1]
        return float(0.25 * np.abs(work).max() / energy) if energy else 0.0

    def step_error(self) -> float:
        """Return the error of the recorded motion by the step, ``κh²`` times its ``q̈/q``.

        Root mean squares about the mean of all coordinates by mass: of vibrations of amplitudes A
        and frequencies ω, ``κh² √Σ(Aω²)² / √ΣA²``, κ = 0.0844; for one alone the error of its
        period. Motion of the rigid rotor that is slow in space, ``ω_s``, errs by
        ``κ(ωh)² ω/ω_s`` where it is integrated in the rotor frame.
        """
        solver = last_solver(self.body)
        if solver is None or solver.explicit or len(self.record.time) < 3:
            return 0.0
        record = self.record
        moved, rate, acceleration = map(self._spread, (record.q, record.q_t, record.q_tt[1:]))
        if not moved:
            return 0.0
        squares = max((rate / moved) ** 2, acceleration / moved, self._slow())
        return float(PERIOD_ERROR * solver.step**2 * squares)

    def _spread(self, rows: np.ndarray) -> float:
        """Return the root mean square of coordinates (s, n) about their mean, by mass."""
        rows, motion = self._coordinates(rows), self.body.motion
        about = rows - rows.mean(axis=0)
        squares = self.invariants.mass * (about[:, motion.translations] ** 2).sum(axis=1)
        return float(
            np.sqrt((squares + _squares(self.invariants.M, about[:, motion.modes])).mean())
        )

    def _slow(self) -> float:
        """Return ``ω³/ω_s`` of the rigid rotor's lateral motion [rad²/s²], by its share of it."""
        inv, e, speed = self.invariants, self.invariants.direction, self.record.speed
        steps = 0.5 * np.diff(self.record.time) * (speed[1:] + speed[:-1])
        angle = np.append(0.0, np.cumsum(steps))
        parts = []
        for rows in (inv.S / inv.mass, self.size * inv.mean_rotation):  # moved, and tilted
            motion, rate = (x @ (rows - np.outer(e, e @ rows)).T for x in (self.zeta, self.zeta_t))
            in_space = _turned(motion, e, angle)
            rate_in_space = _turned(rate + speed[:, None] * np.cross(e, motion), e, angle)
            parts.append((in_space, rate_in_space, _frequency(motion, rate)))
        size = np.sqrt(sum((each[0] ** 2).sum(axis=1).mean() for each in parts))
        worst = 0.0
        for in_space, rate_in_space, frequency in parts:
            slow = _frequency(in_space, rate_in_space)
            if slow > 0.0:
                share = np.sqrt(in_space.var(axis=0).sum()) / size
                worst = max(worst, share * frequency**3 / slow)
        return float(worst)

    def film_use(self) -> float | None:
        """Return the largest displacement of a journal now, over the way to the end of its film.

        None without films.
        """
        bearings = [one for one in self.body.supports if isinstance(one.support, Bearing)]
        shares = [one.support.film_use(one.values()[0][:2]) for one in bearings]
        return max((share for share in shares if share is not None), default=None)

    def explicit_step(self) -> float | None:
        """Return ``ω_max h`` over what an explicit solver bears; None for an implicit one."""
        solver = last_solver(self.body)
        if solver is None or not solver.explicit or self.flexible.size == 0:
            return None
        highest = np.sqrt(np.diag(self.invariants.K)[self.flexible].max()) + self.fastest
        return float(solver.step * highest / _explicit_limit(solver))

    def yielding(self) -> float | None:
        """Return the largest static stress over the yield stress; None where one is not known."""
        static = None if self.reduced is None else self.reduced.centrifugal
        if static is None or static.stress is None or not static.yield_stress:
            return None
        # the stress is a + ω²b and its von Mises stress convex in ω²: largest at an end
        ends = (static.stress_at(speed) for speed in (0.0, self.fastest))
        return max(float(von_mises(stress).max()) for stress in ends) / static.yield_stress


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


def _squares(matrix, rows: np.ndarray) -> np.ndarray:
    """Return ``uᵀ X u`` of rows (s, n), shape (s,)."""
    return np.einsum("si,is->s", rows, matrix @ rows.T)


def _frequency(values: np.ndarray, rates: np.ndarray) -> float:
    """Return the mean frequency of signals (s, c), weighted with their amplitudes squared."""
    moved = values.var(axis=0).sum()
    return float(np.sqrt(rates.var(axis=0).sum() / moved)) if moved else 0.0


def _turned(values: np.ndarray, e: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return vectors (s, 3) across e, turned about it by angles (s,)."""
    return np.cos(angle)[:, None] * values + np.sin(angle)[:, None] * np.cross(e, values)
