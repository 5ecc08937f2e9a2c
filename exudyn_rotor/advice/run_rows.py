"""The rows of a check of a run: each is a measure with its limit, its meaning and what to do."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import NamedTuple

import exudyn
import numpy as np

from exudyn_rotor.advice.axial_force import axial_share
from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.recorded_run import RecordedRun, squares
from exudyn_rotor.advice.request import PERIOD_ERROR
from exudyn_rotor.advice.step_size import GROWTH_CHANGE, growth_by_step
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.multibody.rotor.connections import lost_items
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.elements import von_mises
from exudyn_rotor.theory.invariants import inertia_tensor
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.theory.stiffening import stiffening

_FORCE = exudyn.OutputVariableType.Force
_TURNS = (3, 4, 5)  # coordinates of a node that are angles
_TOP = 0.2  # share of the flexible modes, from the top, that shows what lies beyond
_STEADY = 1e-9  # relative change of a constant speed
_RESOLVED = 0.5  # ωh up to which the error of a step is that of its series
_TOLD = 1e-6  # growth per radian that is more than rounding
_RINGING = 1.5  # energy about the static stretch over that of a start without it, with a margin
_ROUNDING = 1e-15  # of the rotor's size: motion of which nothing is known
_STILL = 1e-5  # of the rotor's size: motion that counts as none

Measure = Callable[[RecordedRun], float | None]


class Row(NamedTuple):
    """A row that any run may have; it stands above its measure, None where it does not apply."""

    name: str
    limit: float | Callable[[float], float]  # or by the accuracy
    meaning: str
    advice: str
    of_modes: bool = False  # not of full bodies

    def __call__(self, measure: Measure) -> Measure:
        """Put a measure into the table."""
        ROWS[self] = measure
        return measure


ROWS: dict[Row, Measure] = {}


@Row(
    "tilt",
    np.sqrt,
    "largest tilt [rad]",
    "the error grows with its square; use Exudyn's 3D body for wide tilts",
)
def _tilt(run: RecordedRun) -> float:
    e, rotation = run.invariants.direction, run.mean_rotation
    return np.linalg.norm(rotation - np.outer(rotation @ e, e), axis=1).max()


@Row(
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


@Row(
    "connections",
    0.0,
    "connections, joints and loads that the rotor cannot carry",
    "body.check_connections() names them; use markers at interfaces or mesh nodes",
)
def _connections(run: RecordedRun) -> float:
    return len(list(lost_items(run.body)))


@Row(
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
    step, record = run.step, run.record
    if step is None or len(record.time) < 3:
        return 0.0
    moved, rate, acceleration = (
        _spread(run, rows) for rows in (record.q, record.q_t, record.q_tt[1:])
    )
    if moved <= _ROUNDING * run.size * np.sqrt(run.invariants.mass):
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
    inv, speed = run.invariants, run.record.speed
    n1, n2, _ = axes_of(run.body.axis).T
    steps = 0.5 * np.diff(run.record.time) * (speed[1:] + speed[:-1])
    turn = np.exp(1j * np.append(0.0, np.cumsum(steps)))
    parts = []
    for rows in (inv.S / inv.mass, run.size * inv.mean_rotation):  # moved, and tilted
        across = (n1 + 1j * n2) @ rows
        motion, rate = run.zeta @ across, run.zeta_t @ across
        in_space, rate_in_space = turn * motion, turn * (rate + 1j * speed * motion)
        parts.append((in_space, _frequency(in_space, rate_in_space), _frequency(motion, rate)))
    size = np.sqrt(sum((np.abs(in_space) ** 2).mean() for in_space, _, _ in parts))
    return max(
        in_space.std() / size * frequency**3 / slow if slow else 0.0
        for in_space, slow, frequency in parts
    )


def _frequency(values: np.ndarray, rates: np.ndarray) -> float:
    """Return the mean frequency of a signal (s,), weighted with its amplitudes squared."""
    moved = values.std()
    return float(rates.std() / moved) if moved else 0.0


@Row(
    "growth",
    1.5 * GROWTH_CHANGE,
    "change of a growth by the step towards the other sign, over the growth",
    "take smaller steps, such as those that propose tells: at this one motions may grow that decay",
    of_modes=True,
)
def _growth(run: RecordedRun) -> float | None:
    """Of lightly damped motions of the linearised scene, all of which modes have, at one speed."""
    body, step, speed = run.body, run.step, run.record.speed
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


@Row(
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


@Row(
    "unresisted load",
    0.01,
    "what the rotor cannot carry, over the largest load",
    "put loads on markers at interfaces or mesh nodes; body.check_connections() names them",
    of_modes=True,
)
def _unresisted(run: RecordedRun) -> float:
    """Moments count over the rotor's size; loads and forces are those at the end of the run."""
    mbs, sizes = run.body.mbs, [0.0]
    for number, item, _ in lost_items(run.body):
        if "loadType" not in item:
            sizes.append(np.linalg.norm(mbs.GetObjectOutput(number, _FORCE)))
            continue
        marker = mbs.GetMarker(int(item["markerNumber"]))
        is_moment = "Torque" in item["loadType"] or int(marker.get("coordinate", 0)) in _TURNS
        sizes.append(np.linalg.norm(mbs.GetLoadValues(number)) / (run.size if is_moment else 1.0))
    lost = max(sizes)
    if not lost or run.loads is None:
        return float(lost > 0.0)
    return lost / max(lost, np.linalg.norm(run.loads, axis=1).max())


@Row(
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


@Row(
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


@Row(
    "residual",
    lambda accuracy: accuracy,
    "deflection at interfaces that the modes leave out",
    "reduce with more modes, or with craig_bampton_modes",
    of_modes=True,
)
def _residual(run: RecordedRun) -> float | None:
    """By static response to the loads of the run, and to the centrifugal one.

    What the response of attachment modes has beyond that of the modes, over the displacement of the
    interfaces; where stiff supports let them move less than the rotor bends, over its bending
    there. Inertia of modes that are left out does not count: next to a resonance, and after a
    sudden start, their motion is larger.
    """
    body, rotor, picked = run.body, run.body.selection.source, run.instants
    if rotor.with_attachments is None or not rotor.interfaces:
        return None
    if run.loads is None:
        return 0.0
    columns = body.selection.T @ run.zeta[picked].T
    moved = np.vstack([one.motion for one in rotor.interfaces.values()])
    (all_, stretch), (own, own_stretch) = (
        _static(each, body.selection.origin) for each in (rotor.with_attachments, rotor)
    )
    missing = (all_ - own) @ run.loads.reshape(-1, len(picked))
    missing += np.outer(stretch - own_stretch, run.record.speed[picked] ** 2)
    rigid = len(rotor.rigid_kinds)
    bent = moved[:, rigid:] @ columns[rigid:]
    frame = np.column_stack([_of_frame(run, index) for index in picked])
    whole = moved @ columns + np.tile(frame, (len(rotor.interfaces), 1))
    return _largest(missing) / max(_largest(whole), _largest(bent), _STILL * run.size)


def _static(rotor: ReducedRotor, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return static motions of the interfaces by the flexible modes.

    By loads there, ``Σ φ φᵀ/ω²`` (6p, 6p), and by the centrifugal load per ω², (6p,).
    """
    flexible = slice(len(rotor.rigid_kinds), None)
    frequencies = rotor.frequencies[flexible]
    motion = np.vstack([one.motion[:, flexible] for one in rotor.interfaces.values()])
    scaled = motion / frequencies
    h = rotor.invariants.moved(origin - rotor.center_of_mass).h
    return scaled @ scaled.T, scaled @ (h[flexible] / frequencies)


def _of_frame(run: RecordedRun, index: int) -> np.ndarray:
    """Return how far the frame's axis has moved, in its own axes, without rotation (6,)."""
    motion, t = run.body.motion, float(run.record.time[index])
    q, q_t = (rows[index][run.body.layout.unknowns] for rows in (run.record.q, run.record.q_t))
    turn = motion.at(t, q, q_t).A
    # the frame may stand in a centre of mass off the axis, and that circles about it
    arm = run.body.axis.radial(run.body.selection.origin)
    shift = motion.free_directions @ q[motion.translations]
    return np.concatenate([turn.T @ (shift + motion.orientation @ arm) - arm, np.zeros(3)])


def _largest(motion: np.ndarray) -> float:
    """Return the largest displacement of all interfaces together, of motions (6p, s) [m]."""
    displacements = motion.reshape(-1, 6, motion.shape[1])[:, :3]
    return float(np.sqrt((displacements**2).sum(axis=(0, 1))).max())


Row(
    "axial force",
    lambda accuracy: 2.0 * accuracy,
    "axial force over the buckling load, its stiffness in bending left out",
    "frequencies are off by about half of it; give it to rotor.prestress(loads=…, "
    "supports=…), and the prestress to reduce",
)(axial_share)


@Row(
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


@Row(
    "speed",
    lambda accuracy: 1.0 + accuracy,
    "highest speed over that of the proposal",
    "propose again with the speeds that were reached",
)
def _speed(run: RecordedRun) -> float | None:
    if run.proposed is None or not run.fastest:
        return None if run.proposed is None else 0.0
    return run.fastest / run.proposed if run.proposed else np.inf
