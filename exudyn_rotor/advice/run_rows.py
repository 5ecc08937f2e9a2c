"""The rows of a check of a run: each is a measure with its limit, its meaning and what to do."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import exudyn
import numpy as np

from exudyn_rotor.advice.axial_force import axial_share, axial_share_of_full
from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.request import PERIOD_ERROR
from exudyn_rotor.advice.run_loads import instants, interface_loads, residual_deflection
from exudyn_rotor.advice.step_size import GROWTH_CHANGE, growth_by_step
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.connections import lost_items
from exudyn_rotor.multibody.rotor.rotor_body import Record, RotorBody, implicit_step
from exudyn_rotor.reduction.reduced_rotor import ModeKind, ReducedRotor
from exudyn_rotor.solid.elements import von_mises
from exudyn_rotor.theory.invariants import Invariants, inertia_tensor
from exudyn_rotor.theory.stiffening import stiffening

_FORCE = exudyn.OutputVariableType.Force
_TURNS = (3, 4, 5)  # coordinates of a node that are angles
_TOP = 0.2  # share of the flexible modes, from the top, that shows what lies beyond
_STEADY = 1e-9  # relative change of a constant speed
_RESOLVED = 0.5  # ωh up to which the error of a step is that of its series
_TOLD = 1e-6  # growth per radian that is more than rounding
_RINGING = 1.5  # energy about the static stretch over that of a start without it, with a margin


@dataclass(frozen=True, eq=False)
class RecordedRun:
    """What the rows of a check read of a run."""

    body: RotorBody | FullRotorBody
    record: Record
    reduced: ReducedRotor | None = None  # knows the yield stress

    @property
    def invariants(self) -> Invariants:
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

    def unknowns(self, rows: np.ndarray) -> np.ndarray:
        """Return the unknowns of the equations out of recorded coordinates (s, n)."""
        return rows[:, self.body.layout.unknowns]

    @cached_property
    def zeta(self) -> np.ndarray:
        """Modal coordinates (s, m); of a full body the displacements of all nodes."""
        return self.unknowns(self.record.q)[:, self.body.motion.modes]

    @cached_property
    def zeta_t(self) -> np.ndarray:
        """Modal velocities (s, m)."""
        return self.unknowns(self.record.q_t)[:, self.body.motion.modes]

    @cached_property
    def fastest(self) -> float:
        """Highest spin speed, either way round [rad/s]."""
        return float(np.abs(self.record.speed).max())

    @cached_property
    def mean_rotation(self) -> np.ndarray:
        """Rotation vector of the rotor in the mean (s, 3) [rad]."""
        return self.zeta @ self.invariants.mean_rotation.T

    @cached_property
    def energy(self) -> float:
        """Largest elastic and largest kinetic energy of the vibration, together [J]."""
        inv, omega = self.invariants, self.record.speed
        modes = self.flexible
        elastic = 0.5 * self.zeta[:, modes] ** 2 @ np.diag(inv.K)[modes]
        # inertial velocity of the deviation from rigid rotation: ζ̇ + ω ẽ ζ
        kinetic = 0.5 * squares(inv.M, self.zeta_t) + 0.5 * omega**2 * squares(inv.C, self.zeta)
        kinetic += omega * np.einsum("si,ij,sj->s", self.zeta_t, inv.G, self.zeta)
        frame = self.unknowns(self.record.q_t)[:, self.body.motion.translations]
        kinetic += 0.5 * inv.mass * ((frame - frame.mean(axis=0)) ** 2).sum(axis=1)
        return float(elastic.max(initial=0.0) + kinetic.max(initial=0.0))

    @cached_property
    def stretch(self) -> np.ndarray:
        """Static centrifugal deformation (s, m), about which the rotor vibrates."""
        inv, modes = self.invariants, self.flexible
        shape = np.zeros(inv.size)
        shape[modes] = inv.h[modes] / np.diag(inv.K)[modes]
        return self.record.speed[:, None] ** 2 * shape


def squares(matrix, rows: np.ndarray) -> np.ndarray:
    """Return ``uᵀ X u`` of rows (s, n), shape (s,)."""
    return np.einsum("si,is->s", rows, matrix @ rows.T)


Measure = Callable[[RecordedRun], float | None]


class Row(NamedTuple):
    """A row that any run may have; its measure is None where the row does not apply."""

    name: str
    limit: Callable[[float], float]  # of the accuracy
    measure: Measure
    meaning: str
    advice: str
    of_modes: bool


ROWS: list[Row] = []


def _row(
    name: str,
    limit: float | Callable[[float], float],
    meaning: str,
    advice: str,
    of_modes: bool = False,
) -> Callable[[Measure], Measure]:
    """Put a measure into the table; rows `of_modes` do not exist for full bodies."""

    def listed(measure: Measure) -> Measure:
        limit_of = limit if callable(limit) else lambda _: limit
        ROWS.append(Row(name, limit_of, measure, meaning, advice, of_modes))
        return measure

    return listed


@_row(
    "tilt",
    np.sqrt,
    "largest tilt [rad]",
    "the error grows with its square; use Exudyn's 3D body for wide tilts",
)
def _tilt(run: RecordedRun) -> float:
    e, rotation = run.invariants.direction, run.mean_rotation
    return np.linalg.norm(rotation - np.outer(rotation @ e, e), axis=1).max()


@_row(
    "deflection",
    np.sqrt,
    "flexible displacement over the size",
    "small deformations are assumed; check loads and supports",
)
def _deflection(run: RecordedRun) -> float:
    """Of the root mean square of what is neither mean translation nor mean rotation."""
    inv, momentum = run.invariants, run.zeta @ run.invariants.S.T
    bent = squares(inv.M, run.zeta) - (momentum**2).sum(axis=1) / inv.mass
    bent -= squares(inertia_tensor(inv), run.mean_rotation)
    return np.sqrt(max(bent.max(), 0.0) / inv.mass) / run.size


@_row(
    "connections",
    0.0,
    "connections, joints and loads that the rotor cannot carry",
    "body.check_connections() names them; use markers at interfaces or mesh nodes",
)
def _connections(run: RecordedRun) -> float:
    return len(lost_items(run.body))


@_row(
    "step",
    lambda accuracy: accuracy,
    "relative error of every period; free vibrations go out of phase by 2π times that in each",
    "take smaller steps, whose square the error follows, or start without a jump if it rings",
)
def _step(run: RecordedRun) -> float:
    """``κh²`` times ``q̈/q``, κ = 0.0844, of root mean squares about the mean, by mass.

    Of vibrations of amplitudes A and frequencies ω: ``κh² √Σ(Aω²)² / √ΣA²``, for one alone the
    error of its period. Motion of the rigid rotor that is slow in space, ``ω_s``, errs by
    ``κ(ωh)² ω/ω_s`` where it is integrated in the rotor frame.
    """
    step, record = implicit_step(run.body), run.record
    if step is None or len(record.time) < 3:
        return 0.0
    moved, rate, acceleration = (
        _spread(run, rows) for rows in (record.q, record.q_t, record.q_tt[1:])
    )
    if not moved:
        return 0.0
    worst = max((rate / moved) ** 2, acceleration / moved, _slow_in_space(run))
    return PERIOD_ERROR * step**2 * worst


def _spread(run: RecordedRun, rows: np.ndarray) -> float:
    """Return the root mean square of coordinates (s, n) about their mean, by mass."""
    rows, motion = run.unknowns(rows), run.body.motion
    about = rows - rows.mean(axis=0)
    whole = run.invariants.mass * (about[:, motion.translations] ** 2).sum(axis=1)
    return np.sqrt((whole + squares(run.invariants.M, about[:, motion.modes])).mean())


def _slow_in_space(run: RecordedRun) -> float:
    """Return ``ω³/ω_s`` of the rigid rotor's lateral motion [rad²/s²], by its share of it."""
    inv, e, speed = run.invariants, run.invariants.direction, run.record.speed
    steps = 0.5 * np.diff(run.record.time) * (speed[1:] + speed[:-1])
    angle = np.append(0.0, np.cumsum(steps))
    parts = []
    for rows in (inv.S / inv.mass, run.size * inv.mean_rotation):  # moved, and tilted
        across = rows - np.outer(e, e @ rows)
        motion, rate = run.zeta @ across.T, run.zeta_t @ across.T
        in_space = _turned(motion, e, angle)
        rate_in_space = _turned(rate + speed[:, None] * np.cross(e, motion), e, angle)
        parts.append((in_space, _frequency(in_space, rate_in_space), _frequency(motion, rate)))
    size = np.sqrt(sum((in_space**2).sum(axis=1).mean() for in_space, _, _ in parts))
    return max(
        np.sqrt(in_space.var(axis=0).sum()) / size * frequency**3 / slow if slow else 0.0
        for in_space, slow, frequency in parts
    )


def _turned(values: np.ndarray, e: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Return vectors (s, 3) across e, turned about it by angles (s,)."""
    return np.cos(angle)[:, None] * values + np.sin(angle)[:, None] * np.cross(e, values)


def _frequency(values: np.ndarray, rates: np.ndarray) -> float:
    """Return the mean frequency of signals (s, c), weighted with their amplitudes squared."""
    moved = values.var(axis=0).sum()
    return float(np.sqrt(rates.var(axis=0).sum() / moved)) if moved else 0.0


@_row(
    "growth",
    1.5 * GROWTH_CHANGE,
    "change of a growth by the step towards the other sign, over the growth",
    "take smaller steps, such as those that propose tells: at this one motions may grow that decay",
    of_modes=True,
)
def _growth(run: RecordedRun) -> float | None:
    """Of lightly damped motions of the linearised scene, all of which modes have, at one speed."""
    body, step, speed = run.body, implicit_step(run.body), run.record.speed
    is_constant = np.ptp(speed) <= _STEADY * run.fastest
    if step is None or body.formulation.translation_count or not is_constant:
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            model = linear_model(body.mbs, body=body, axes="rotor")
            given = Candidate(body.selection.source, model, axial=False)
            own, found = growth_by_step(given, float(speed[-1]), step, _RESOLVED / step)
    except (ValueError, ArithmeticError, RuntimeError, np.linalg.LinAlgError):
        return None  # a scene without linear equations
    told = np.abs(own.real) > _TOLD * np.abs(own)
    return float(((own - found).real / own.real)[told].max(initial=0.0))


@_row(
    "film",
    1.0,
    "displacement of a journal at the end over that to which it has a film",
    "the journal touches, or the start was too sudden for the step: begin with smaller steps, "
    "above all with a full body, or in the steady state",
)
def _film(run: RecordedRun) -> float | None:
    bearings = [one for one in run.body.supports if isinstance(one.support, Bearing)]
    places = [one.values()[0][:2] for one in bearings]
    edges = [one.support.film_edge(*place) for one, place in zip(bearings, places, strict=True)]
    shares = np.array([np.hypot(*u) for u in places]) / edges
    return max(shares[np.isfinite(edges)], default=None)


@_row(
    "unresisted load",
    0.01,
    "what the rotor cannot carry, over the largest load",
    "put loads on markers at interfaces or mesh nodes; body.check_connections() names them",
    of_modes=True,
)
def _unresisted(run: RecordedRun) -> float:
    """Moments count over the rotor's size; loads and forces are those at the end of the run."""
    mbs, sizes = run.body.mbs, [0.0]
    for is_load, number in lost_items(run.body):
        if not is_load:
            sizes.append(np.linalg.norm(mbs.GetObjectOutput(number, _FORCE)))
            continue
        load = mbs.GetLoad(number)
        marker = mbs.GetMarker(int(load["markerNumber"]))
        is_moment = "Torque" in load["loadType"] or int(marker.get("coordinate", 0)) in _TURNS
        sizes.append(np.linalg.norm(mbs.GetLoadValues(number)) / (run.size if is_moment else 1.0))
    lost = max(sizes)
    if not lost or len(run.record.time) < 2:
        return float(lost > 0.0)
    carried = interface_loads(run.body, run.record, instants(run.record, 50), run.size)
    return lost / max(lost, 0.0 if carried is None else np.linalg.norm(carried, axis=1).max())


@_row(
    "stiffening",
    lambda accuracy: accuracy,
    "stiffening left out, relative change of frequency",
    "use stiffening='full' (modes need reduce with prestress=True), or 'tilt' in place of 'none'",
    of_modes=True,
)
def _missing_stiffness(run: RecordedRun) -> float:
    """Half of the energy of what is left out over the energy of the motion.

    Without a prestress by the estimate of :mod:`exudyn_rotor.prestress.carrying` or, where there
    is none, ω² per unit of modal mass.
    """
    inv, level = run.invariants, run.body.stiffening
    if level == "full" or not run.energy:
        return 0.0
    included, complete = np.asarray(stiffening(inv, level).K2), inv.K2
    if complete is None:
        complete = np.array(stiffening(inv, "tilt").K2)
        places = np.ix_(run.flexible, run.flexible)
        if inv.K2_estimated is None:
            complete[places] += np.eye(run.flexible.size)
        else:
            complete[places] = inv.K2_estimated[places]
    work = run.record.speed**2 * squares(complete - included, run.zeta - run.stretch)
    return 0.25 * np.abs(work).max() / run.energy


@_row(
    "top modes",
    0.01,
    "energy in the highest fifth of the modes",
    "keep more modes, or use craig_bampton_modes",
    of_modes=True,
)
def _top_share(run: RecordedRun) -> float:
    """Without the static centrifugal stretch, and what a start at full speed makes it ring.

    Few modes breathe, wherever they stand, and more modes change nothing about it.
    """
    modes = run.flexible
    if modes.size == 0 or not run.energy:
        return 0.0
    half = 0.5 * np.diag(run.invariants.K)[modes]
    elastic = half * (run.zeta - run.stretch)[:, modes] ** 2
    ringing = _RINGING * half * (run.stretch[:, modes] ** 2).max(axis=0)
    top = slice(-max(1, round(_TOP * modes.size)), None)
    return np.maximum(elastic - ringing, 0.0)[:, top].sum(axis=1).max() / run.energy


@_row(
    "residual",
    lambda accuracy: accuracy,
    "deflection at interfaces that the modes leave out",
    "reduce with more modes, or with craig_bampton_modes",
    of_modes=True,
)
def _residual(run: RecordedRun) -> float | None:
    return residual_deflection(run.body, run.record, run.size)


@_row(
    "axial force",
    lambda accuracy: 2.0 * accuracy,
    "axial force over the buckling load, its stiffness in bending left out",
    "frequencies are off by about half of it; give it to rotor.prestress(loads=…, "
    "supports=…), and the prestress to reduce",
)
def _axial(run: RecordedRun) -> float | None:
    if isinstance(run.body, FullRotorBody):
        return axial_share_of_full(run.body, run.record)
    return axial_share(run.body, run.record, run.size)


@_row(
    "yield",
    1.0,
    "static stress over yield stress",
    "the elastic prestress holds below the yield stress only",
    of_modes=True,
)
def _yielding(run: RecordedRun) -> float | None:
    static = None if run.reduced is None else run.reduced.centrifugal
    if static is None or static.stress is None or not static.yield_stress:
        return None
    return run.fastest**2 * von_mises(static.stress).max() / static.yield_stress
