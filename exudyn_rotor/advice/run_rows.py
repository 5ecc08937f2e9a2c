"""The rows of a check of a run: each is a measure with its limit, its meaning and what to do."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import exudyn
import numpy as np

from exudyn_rotor.advice.axial_force import axial_share
from exudyn_rotor.advice.left_out import residual_deflection
from exudyn_rotor.advice.recorded_run import RecordedRun, squares
from exudyn_rotor.advice.request import PERIOD_ERROR
from exudyn_rotor.advice.run_loads import external_force
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.multibody.rotor.connections import lost_items
from exudyn_rotor.multibody.rotor.record import last_solver
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.theory.invariants import inertia_tensor
from exudyn_rotor.theory.stiffening import stiffening

_FORCE = exudyn.OutputVariableType.Force
_TURNS = (3, 4, 5)  # coordinates of a node that are angles
_TOP = 0.2  # share of the flexible modes, from the top, that shows what lies beyond
_RINGING = 1.5  # energy about the static stretch over that of a start without it, with a margin
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


def accuracy_itself(accuracy: float) -> float:
    """Return the limit of an error that the accuracy is about."""
    return accuracy


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
    inv, turned = run.invariants, run.mean_rotation
    bent = squares(inv.M, run.zeta) - inv.mass * (run.mean_translation**2).sum(axis=1)
    bent -= squares(inertia_tensor(inv), turned)
    return np.sqrt(max(bent.max(), 0.0) / inv.mass) / run.size


@_row(
    "adrift",
    1.0,
    "centre of mass off its place in the frame, over the size",
    "support the rotor against the centrifugal force of its eccentricity, or let the frame "
    "follow: translation='free'",
)
def _adrift(run: RecordedRun) -> float:
    return np.linalg.norm(run.mean_translation, axis=1).max() / run.size


@_row(
    "locked",
    1e-5,
    "locked coordinates off their place [rad], [size]",
    "use locking='constraints', or a smaller step",
)
def _locked(run: RecordedRun) -> float:
    if "marker_body" not in run.body.objects:
        return 0.0
    locks, record = run.body.locks, run.record
    unit, off = np.repeat([run.size, 1.0], 3), [0.0]
    for index in locks.fixed:
        off.append(np.abs(record.q[:, index]).max() / unit[index])
    for index, motion in locks.prescribed.items():
        wanted = np.array([float(motion.value(t)) for t in record.time])
        off.append(np.abs(record.q[:, index] - wanted).max() / unit[index])
    return max(off)


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
    accuracy_itself,
    "relative error of every period; free vibrations go out of phase by 2π times that in each",
    "take smaller steps, whose square the error follows, or start without a jump if it rings",
)
def _step(run: RecordedRun) -> float:
    """``κh²`` times ``q̈/q``, κ = 0.0844, of root mean squares about the mean, by mass.

    Of vibrations of amplitudes A and frequencies ω: ``κh² √Σ(Aω²)² / √ΣA²``, for one alone the
    error of its period. Motion of the rigid rotor that is slow in space, ``ω_s``, errs by
    ``κ(ωh)² ω/ω_s`` where it is integrated in the rotor frame.
    """
    solver, record = last_solver(run.body), run.record
    if solver is None or solver.explicit or len(record.time) < 3:
        return 0.0
    moved, rate, acceleration = (
        _spread(run, rows) for rows in (record.q, record.q_t, record.q_tt[1:])
    )
    if not moved:
        return 0.0
    worst = max((rate / moved) ** 2, acceleration / moved, _slow_in_space(run))
    return PERIOD_ERROR * solver.step**2 * worst


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
    "film",
    1.0,
    "displacement of a journal at the end over that to which it has a film",
    "the journal touches, or the start was too sudden for the step: begin with smaller steps, "
    "above all with a full body, or in the steady state",
)
def _film(run: RecordedRun) -> float | None:
    bearings = [one for one in run.body.supports if isinstance(one.support, Bearing)]
    shares = [one.support.film_use(one.values()[0][:2]) for one in bearings]
    return max((share for share in shares if share is not None), default=None)


@_row(
    "frozen spin",
    accuracy_itself,
    "angular momentum left out, over the whole",
    "add the rotor with spin_coupling='full'",
)
def _frozen(run: RecordedRun) -> float | None:
    """``½ωc + ζ̇ᵀWζ`` over Θ times the highest speed, c the change of the moment of inertia."""
    if not run.body.formulation.has_frozen_spin:
        return None
    terms, zeta = run.body.motion.spin_terms, run.zeta
    left = 0.5 * run.record.speed * (2.0 * zeta @ terms.h + squares(terms.C_hat, zeta))
    left += np.einsum("si,is->s", run.zeta_t, terms.W @ zeta.T)
    momentum = run.invariants.Theta * run.fastest
    return np.abs(left).max() / momentum if momentum else 0.0


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
    largest = max(sizes)
    return largest / max(largest, external_force(run.body, run.record)) if largest else 0.0


@_row(
    "stiffening",
    accuracy_itself,
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
    accuracy_itself,
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
    of_modes=True,
)
def _axial(run: RecordedRun) -> float | None:
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
    # the stress is a + ω²b and its von Mises stress convex in ω²: largest at an end
    ends = (static.stress_at(speed) for speed in (0.0, run.fastest))
    return max(von_mises(stress).max() for stress in ends) / static.yield_stress
