"""Static solutions of scenes with a spinning rotor, which may hold at one angle only.

In the rotating frame, gravity and what else stands still in space turns, so that a static solution
answers it at one angle of the spin only, and without the inertia of the motion that it causes. That
shows in the solution itself: at another angle the same state is no equilibrium.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.multibody.evaluation import constraint_rows, evaluating
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.theory.formulation import start_values

_TURNS = (1.0, 2.5)  # rad by which the rotor is turned
_NO_LOAD = 1e-6  # N, N m or N/√kg: below is round-off


def change_with_angle(body: RotorItems) -> float | None:
    """Return the largest change of the forces with the angle over the largest load.

    None where the state is not that of a static solution, or the rotor stands still.
    """
    mbs, form = body.mbs, body.formulation
    if (
        "staticSolver" not in mbs.sys
        or "dynamicSolver" in mbs.sys
        or "marker_body" not in body.objects
    ):
        return None
    data = mbs.systemData
    q, q_t = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
    places = np.asarray(data.GetObjectLTGODE2(body.objects["physics"]), dtype=int)
    spin, own = places[body.locks.spin], places[body.layout.unknowns]
    speed = q_t[spin] if form.has_spin else start_values(form.spin, "spin")[1]
    if speed == 0.0:
        return None
    undeformed, moving = q.copy(), np.setdiff1d(own, spin)
    undeformed[moving] = 0.0
    free = np.setdiff1d(np.arange(len(q)), np.setdiff1d(places, moving))
    time = data.GetTime()
    with evaluating(mbs) as evaluation:

        def forces(state: np.ndarray, turn: float) -> np.ndarray:
            moved = state.copy()
            moved[spin] = q[spin] + turn
            data.SetODE2Coordinates(moved)
            data.SetODE2Coordinates_t(q_t)
            data.SetTime(time + turn / speed)
            if evaluation.GetAEsize():
                evaluation.ComputeAlgebraicEquations(mbs, False)
            evaluation.ComputeODE2RHS(mbs)
            return np.array(evaluation.GetSystemResidual())[: len(q)][free]

        held = forces(q, 0.0)
        load = max(np.abs(forces(undeformed, 0.0)).max(), _NO_LOAD)
        changes = [forces(q, turn) - held for turn in _TURNS]
        directions = constraint_rows(mbs, evaluation, len(q))[:, free].T
    if directions.size:  # what the scene's constraints take up
        changes = [
            each - directions @ np.linalg.lstsq(directions, each, rcond=1e-12)[0]
            for each in changes
        ]
    return float(max(np.abs(each).max() for each in changes) / load)
