"""Unbalance response over speed and harmonic response over frequency.

Both are steady motions: they are reached in time only where the rotor is stable.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import exudyn
import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.linear import options
from exudyn_rotor.linear.equations.full import FullRotor
from exudyn_rotor.linear.equations.source import linear_source
from exudyn_rotor.linear.equations.supports import FRAMES, Support
from exudyn_rotor.linear.equations.system import LinearRotor, PeriodicSystem
from exudyn_rotor.linear.response.balance import Unbalance
from exudyn_rotor.linear.response.forced import forced_motion, into_inertial_frame
from exudyn_rotor.linear.response.full import FullSteady
from exudyn_rotor.linear.response.loads import (
    BaseAcceleration,
    HarmonicForce,
    total,
    unbalance_load,
)
from exudyn_rotor.linear.response.places import At, Place, Source, checked_places, places
from exudyn_rotor.linear.response.results import HarmonicResponse, UnbalanceResponse
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.sweep import ascending_from_zero, sweep

Target = ReducedRotor | SolidRotor | exudyn.MainSystem
Motion = Mapping[int, np.ndarray]  # harmonics (p, 6)


def unbalance_response(
    target: Target,
    speeds: ArrayLike,
    unbalances: Sequence[Unbalance] = (),
    *,
    own: bool = True,
    supports: Sequence[Support] = (),
    body: RotorBody | None = None,
    at: Sequence[At] | At | None = None,
    frame: str = "inertial",
    stiffening: str = "tilt",
    tolerance: float = 1e-9,
    residual: float = 1e-9,
    executor: Executor | None = None,
    progress: bool = False,
) -> UnbalanceResponse:
    """Compute the steady motion of an unbalanced rotor over its spin speed.

    The load ``Ω² (h + Σ Uᵀu)`` is constant in the rotor frame; h is the rotor's own (83). So is the
    motion where no coefficient turns with the rotor; on anisotropic supports it is found in
    harmonics of the speed, and how many are needed is found by itself.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor or exudyn.MainSystem
        A rotor with `supports`, or an assembled scene with its `body`. A SolidRotor is solved
        unreduced, each speed checked by the residual of the full equations.
    speeds : array_like, shape (s,)
        Ascending spin speeds ≥ 0 [rad/s].
    unbalances : sequence of Unbalance, optional
        In addition to the rotor's own.
    own : bool, optional
        Whether the rotor's own eccentricity counts: that of added point masses, and of the mesh.
    supports : sequence of Support, optional
        Of a rotor.
    body : RotorBody, optional
        The rotor in a scene.
    at : sequence of str, int or position, optional
        Interfaces and mesh nodes to look at; all interfaces by default.
    frame : {'inertial', 'rotor'}
        Axes of the resulting motion.
    stiffening : {'tilt', 'none', 'full'}
        Centrifugal stiffening; 'full' needs a rotor with prestress.
    tolerance : float, optional
        Largest relative change of the motion by further harmonics; smaller harmonics are left out.
    residual : float, optional
        Largest residual of the equations of a SolidRotor, relative to the loads in the norm of
        their static response.
    executor : concurrent.futures.Executor, optional
        Computes the speeds; see :func:`exudyn_rotor.sweep.sweep`. A SolidRotor does not use
        it: its speeds share one subspace.
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    ValueError
        For speeds that do not ascend or are negative, unknown places, no unbalance at all, a
        speed without a steady motion, or a `residual` that is not reached.
    """
    values = ascending_from_zero(speeds, "speeds")
    unbalances = checks.instances(unbalances, "unbalances", Unbalance)
    checks.flag(own, "own")
    _check(frame, tolerance, residual)
    options.check_sweep(executor, progress)
    at = checked_places(at)
    source = _source(target, body, supports, stiffening)
    found = places(source, at)
    load = unbalance_load(source, unbalances, own)
    rows = np.array([one.motion for one in found])
    watch = _Watch(rows, frame, tolerance, _driven(source))
    if isinstance(source, FullRotor):
        solver, executor = FullSteady(source, [load], values[-1], residual), None
    else:
        solver = _light(source, values[values > 0.0])
    task = _UnbalanceTask(solver, load, watch)
    motions = sweep(task, values, executor=executor, progress=progress, label="unbalance response")
    labels = tuple(one.label for one in found)
    return UnbalanceResponse(
        labels, *_collected(motions, found, tolerance, _length(source)), frame, values
    )


def harmonic_response(
    target: Target,
    frequencies: ArrayLike,
    loads: Sequence[HarmonicForce | BaseAcceleration] | HarmonicForce | BaseAcceleration,
    *,
    speed: float = 0.0,
    supports: Sequence[Support] = (),
    body: RotorBody | None = None,
    at: Sequence[At] | At | None = None,
    frame: str = "inertial",
    stiffening: str = "tilt",
    tolerance: float = 1e-9,
    residual: float = 1e-9,
    executor: Executor | None = None,
    progress: bool = False,
) -> HarmonicResponse:
    """Compute the steady motion under harmonic loads over their frequency, at one spin speed.

    Parameters
    ----------
    frequencies : array_like, shape (s,)
        Ascending angular frequencies ω ≥ 0 of the loads [rad/s].
    loads : sequence of HarmonicForce or BaseAcceleration
        All of one frequency, with their complex amplitudes.
    speed : float, optional
        Spin speed Ω [rad/s].
    target, supports, body, at, frame, stiffening, tolerance, residual, executor, progress
        See :func:`unbalance_response`.

    Raises
    ------
    ValueError
        For frequencies that do not ascend or are negative, unknown places, loads that are all
        zero, a frequency without a steady motion, or a `residual` that is not reached.
    """
    values = ascending_from_zero(
        frequencies, "frequencies", "conjugate the loads: a negative frequency is that"
    )
    speed = checks.number(speed, "speed", "rad/s")
    loads = checks.instances(loads, "loads", (HarmonicForce, BaseAcceleration))
    _check(frame, tolerance, residual)
    options.check_sweep(executor, progress)
    at = checked_places(at)
    source = _source(target, body, supports, stiffening)
    found = places(source, at)
    load = total(loads, source)
    rows = np.array([one.motion for one in found])
    watch = _Watch(rows, frame, tolerance, _driven(source))
    if isinstance(source, FullRotor):
        fastest = max(values[-1], abs(speed))
        solver, executor = FullSteady(source, load.values(), fastest, residual), None
    else:
        solver = _Tabulated({speed: source.at(speed)})
    task = _HarmonicTask(solver, speed, load, watch)
    motions = sweep(task, values, executor=executor, progress=progress, label="harmonic response")
    labels = tuple(one.label for one in found)
    collected = _collected(motions, found, tolerance, _length(source))
    return HarmonicResponse(labels, *collected, frame, values, speed)


@dataclass(frozen=True, eq=False)
class _Watch:
    """What is looked at: rows (p, 6, k) of the places, and how."""

    rows: np.ndarray
    frame: str
    tolerance: float
    driven: tuple[int, ...]

    def motion(
        self, solver: Solver, speed: float, loads: Mapping[int, np.ndarray], rate: float
    ) -> Motion:
        """Return the harmonics (p, 6) of the steady motion."""
        if isinstance(solver, FullSteady):
            seen = solver.seen(self.rows, speed, loads, rate, self.tolerance)
        else:
            solved = forced_motion(solver.at(speed), loads, rate, self.tolerance, self.driven)
            seen = {n: self.rows @ x for n, x in solved.items()}
        if self.frame == "rotor" or speed == 0.0:  # at θ = 0 the axes are the same
            return seen
        return into_inertial_frame(seen)


@dataclass(frozen=True, eq=False)
class _UnbalanceTask:
    """Steady motion at one speed; picklable but for a full model."""

    solver: Solver
    load: np.ndarray
    watch: _Watch

    def __call__(self, speed: float) -> Motion:
        if speed == 0.0:  # no load, and nothing that would have to hold the rotor
            return {0: np.zeros(self.watch.rows.shape[:2])}
        loads = {0: speed**2 * self.load + 0j}
        return _folded(self.watch.motion(self.solver, float(speed), loads, 0.0))


@dataclass(frozen=True, eq=False)
class _HarmonicTask:
    """Steady motion at one frequency; picklable but for a full model."""

    solver: Solver
    speed: float
    loads: Mapping[int, np.ndarray]
    watch: _Watch

    def __call__(self, frequency: float) -> Motion:
        return self.watch.motion(self.solver, self.speed, self.loads, float(frequency))


def _folded(motion: Motion) -> Motion:
    """Return a real periodic motion by its harmonics n ≥ 0: ``Re Σ a_n exp(inΩt)``."""
    folded: dict[int, np.ndarray] = {}
    for n, part in motion.items():
        folded[abs(n)] = folded.get(abs(n), 0.0) + (part if n > 0 else part.conj())
    return folded


def _collected(
    motions: Sequence[Motion], found: Sequence[Place], tolerance: float, length: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the orders (h,) that matter anywhere, and all motions (s, p, h, 6)."""
    orders = sorted({n for motion in motions for n in motion})
    full = np.zeros((len(motions), len(found), len(orders), 6), dtype=complex)
    for row, motion in zip(full, motions, strict=True):
        for n, part in motion.items():
            row[:, orders.index(n)] = part
    if not np.all(np.isfinite(full)):
        raise ValueError("the response left the range of floats; check speeds and loads (SI units)")
    # a rotation counts as the displacement that it makes at the rotor's radius of gyration
    sizes = np.abs(full * np.repeat([1.0, length], 3)).max(axis=(0, 1, 3))
    keep = sizes > tolerance * sizes.max()
    if not np.any(keep):
        keep[np.argmin(np.abs(orders))] = True
    full[:, [one.is_node for one in found], :, 3:] = np.nan
    return np.array(orders)[keep], full[:, :, keep]


def _source(
    target: Target, body: RotorBody | None, supports: Sequence[Support], stiffening: str
) -> Source:
    # a response is looked at in places of the full model
    return linear_source(target, body=body, supports=supports, stiffening=stiffening, dense=False)


def _driven(source: Source) -> tuple[int, ...]:
    """Return the coordinate of the rigid spin where no support resists it: the drive does.

    If the spin were free, a constant torque however small would turn it on and on.
    """
    if not isinstance(source, LinearRotor) or source.free_spin is None:
        return ()
    return (int(np.argmax(source.spin.momentum)),)


def _length(source: Source) -> float:
    """Return the rotor's radius of gyration [m]; one metre where it is unknown."""
    if not isinstance(source, LinearRotor | FullRotor):
        return 1.0
    return float(np.sqrt(np.trace(source.invariants.J) / source.invariants.mass))


@dataclass(frozen=True, eq=False)
class _Tabulated:
    """Equations at the speeds needed; a scene itself cannot leave its process."""

    systems: Mapping[float, PeriodicSystem]

    def at(self, speed: float) -> PeriodicSystem:
        return self.systems[float(speed)]


def _light(source: Source, speeds: np.ndarray) -> LinearRotor | _Tabulated:
    """Return what workers need of a source."""
    if isinstance(source, LinearRotor):
        return replace(source, rotor=source.rotor.without_shapes())
    return _Tabulated({float(speed): source.at(speed) for speed in speeds})


# what solves the equations at a speed
Solver = LinearRotor | _Tabulated | FullSteady


def _check(frame: str, tolerance: float, residual: float) -> None:
    checks.choice(frame, "frame", FRAMES)
    options.accuracy(tolerance, "tolerance")
    options.accuracy(residual, "residual")
