"""Static solutions of scenes with a spinning rotor, which may mean nothing.

In the rotating frame, gravity and what else stands still in space turns, so that a static solution
answers it at one angle of the spin only, and without the inertia of the motion that it causes.
Whether that is so shows in the solution itself: at another angle the same state is no equilibrium.
Importing this module lets ``mbs.SolveStatic()`` look, for the rotors of this package in the
``mbs``; a static solution that holds at every angle (centrifugal load, a force along the axis,
supports that are alike in all directions) is left as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import exudyn
import numpy as np

from exudyn_rotor.multibody.calls.sparse_solver import check_solver
from exudyn_rotor.multibody.evaluation import (
    constraint_rows,
    evaluating,
    restore_states,
    saved_states,
)
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.mark import Mark, mark_of
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.wrapping import wraps_method
from exudyn_rotor.theory.formulation import start_values

Body = TypeVar("Body", bound=RotorItems)

_ROTORS = "exudyn_rotor: rotors whose static solutions are checked"  # key in mbs.sys
_TURNS = (1.0, 2.5)  # rad by which the rotor is turned
_SHARE = 1e-3  # of the loads by which forces may change with the angle
_SLACK = 1e3  # by which forces left may be larger than asked of those at the start
_NO_LOAD = 1e-6  # N, N m or N/√kg: below is round-off


@dataclass(frozen=True)
class _Spinning:
    """What the check needs of a rotor, as numbers: the ``mbs`` must not hold a body that holds it.

    Attributes
    ----------
    name : str or None
    mark : tuple or None
        By which the rotor is known again.
    spin : int or None
        θ among the coordinates of the rotor's object, None where it is none.
    unknowns : tuple of int
        The formulation's unknowns among these coordinates, but for θ.
    speed : float or None
        Prescribed rate of the coordinate of θ at the start [rad/s]; None for a free spin.
    full : bool
        Whether it has all nodes, of which there is no steady state.
    """

    name: str | None
    mark: Mark | None
    spin: int | None
    unknowns: tuple[int, ...]
    speed: float | None
    full: bool


def watched(body: Body) -> Body:
    """Let ``mbs.SolveStatic()`` check this rotor, and return it."""
    form, unknowns = body.formulation, list(body.layout.unknowns)
    spin = body.locks.spin if "marker_body" in body.objects else None
    if form.has_spin:
        spin = unknowns.pop(body.motion.formulation.translation_count)
    sign = 1 if spin is None else body.locks.sign
    speed = None if form.has_spin else sign * start_values(form.spin, "spin")[1]
    known = body.mbs.sys.setdefault(_ROTORS, {})
    known[int(body.objects["physics"])] = _Spinning(
        body.name,
        body.mark,
        spin,
        tuple(int(i) for i in unknowns),
        speed,
        isinstance(body, FullRotorBody),
    )
    return body


def check_static(mbs: exudyn.MainSystem) -> None:
    """Raise ValueError where the current state is in equilibrium at one angle of a rotor only."""
    for number, rotor in mbs.sys.get(_ROTORS, {}).items():
        if rotor.mark is None or mark_of(mbs, exudyn.ObjectIndex(number)) != rotor.mark:
            continue
        share = _change_with_angle(mbs, number, rotor)
        if share > _SHARE:
            before = (
                "with the reduced rotor, add_rotor(mbs, rotor.reduce(…)), " if rotor.full else ""
            )
            raise ValueError(
                f"mbs.SolveStatic: rotor {rotor.name!r} spins, and {100.0 * share:.2g} % of the "
                "loads on it change with its angle (gravity across the axis, forces that stand "
                "still, supports that are not alike in all directions), so that this static "
                f"solution would hold at one angle only; {before}steady_state(body) finds the "
                "motion, body.start_from(steady.state()) starts a run from it; for the rotor at "
                "rest, use spin=0"
            )


def _loads_at_start(mbs: exudyn.MainSystem) -> float:
    """Return the size of the forces at the start of a static solution [N]."""
    with evaluating(mbs) as solver:
        solver.ComputeODE2RHS(mbs)
        return float(np.linalg.norm(solver.GetSystemResidual()))


def _refuse_unbalanced(
    mbs: exudyn.MainSystem, loads: float, settings: exudyn.SimulationSettings
) -> None:
    """Raise ValueError where forces are left that are no error of Newton's method.

    Its relative tolerance is a share of the forces after its first iteration, where these are
    larger than those at the start: where next to nothing holds a coordinate they may be by 1e6.
    """
    newton, left = settings.staticSolver.newton, mbs.sys["staticSolver"].conv.residual
    reactions = float(np.linalg.norm(mbs.systemData.GetAECoordinates()))
    loads = max(loads, reactions)  # where constraints move the rotor, these are its loads
    asked = max(newton.relativeTolerance * loads, newton.absoluteTolerance)
    if not left <= _SLACK * asked:
        raise ValueError(
            f"mbs.SolveStatic: forces of {left:.2g} N are left of {loads:.2g} N, so that this is "
            "no equilibrium: the first iteration went far off, as where next to nothing holds the "
            "angle of a free spin (use spin=0 then), or the loads are too large for one step "
            "(staticSolver.numberOfLoadSteps)"
        )


def _change_with_angle(mbs: exudyn.MainSystem, number: int, rotor: _Spinning) -> float:
    """Return the largest change of the forces with the angle over the largest load."""
    data = mbs.systemData
    q, q_t = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
    places = np.asarray(data.GetObjectLTGODE2(number), dtype=int)
    spin = None if rotor.spin is None else places[rotor.spin]
    speed = q_t[spin] if rotor.speed is None else rotor.speed
    if speed == 0.0:
        return 0.0
    undeformed = q.copy()
    undeformed[places[list(rotor.unknowns)]] = 0.0
    unknowns = np.setdiff1d(np.arange(len(q)), np.setdiff1d(places, places[list(rotor.unknowns)]))
    time = data.GetTime()
    with evaluating(mbs) as solver:

        def forces(state: np.ndarray, turn: float) -> np.ndarray:
            moved = state.copy()
            if spin is not None:
                moved[spin] = q[spin] + turn
            data.SetODE2Coordinates(moved)
            data.SetODE2Coordinates_t(q_t)
            data.SetTime(time + turn / speed)
            if solver.GetAEsize():
                solver.ComputeAlgebraicEquations(mbs, False)
            solver.ComputeODE2RHS(mbs)
            return np.array(solver.GetSystemResidual())[: len(q)][unknowns]

        held = forces(q, 0.0)
        loads = max(np.abs(forces(undeformed, 0.0)).max(), _NO_LOAD)
        changes = [
            _unheld(mbs, solver, forces(q, turn) - held, unknowns, len(q)) for turn in _TURNS
        ]
    return max(np.abs(change).max() for change in changes) / loads


def _unheld(
    mbs: exudyn.MainSystem,
    solver: exudyn.MainSolverStatic,
    force: np.ndarray,
    kept: np.ndarray,
    size: int,
) -> np.ndarray:
    """Return a force less what the scene's constraints take up."""
    directions = constraint_rows(mbs, solver, size)[:, kept].T
    if not directions.size:
        return force
    return force - directions @ np.linalg.lstsq(directions, force, rcond=1e-12)[0]


@wraps_method("SolveStatic")
def _solve_static(
    solve: Callable, mbs: exudyn.MainSystem, *given: object, **options: object
) -> bool:
    """Solve as Exudyn does, then refuse what holds at one angle only."""
    check_solver(mbs, given, options)
    if _ROTORS not in mbs.sys:
        return solve(mbs, *given, **options)
    if not mbs.systemIsConsistent and options.get("autoAssemble", True):
        mbs.Assemble()
    saved, loads = saved_states(mbs), _loads_at_start(mbs)
    settings = given[0] if given else options.get("simulationSettings")
    known = mbs.sys.get("staticSolver")
    solved = solve(mbs, *given, **options)
    try:
        if solved:
            if mbs.sys.get("staticSolver") is not known:  # it was stored
                _refuse_unbalanced(mbs, loads, settings or exudyn.SimulationSettings())
            check_static(mbs)
    except ValueError:
        restore_states(mbs, saved)
        raise
    return solved
