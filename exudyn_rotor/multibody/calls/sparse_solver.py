"""Full bodies need a sparse linear solver, which is not Exudyn's default.

``mbs.SolveDynamic()`` refuses a dense one where it would take the memory of the machine, or hours.
"""

from __future__ import annotations

import exudyn

_BODIES = "exudyn_rotor: full bodies"  # key in mbs.sys
_MOST = 3000  # coordinates of a system that a dense solver may have
_SPARSE = exudyn.LinearSolverType.EigenSparse


def needs_sparse_solver(mbs: exudyn.MainSystem) -> None:
    """Let the solvers of `mbs` look at their linear solver."""
    mbs.sys[_BODIES] = True


def check_solver(mbs: exudyn.MainSystem, given: tuple, options: dict) -> None:
    """Raise ValueError where a large system with a full body would be solved densely."""
    if not mbs.sys.get(_BODIES):
        return
    settings = given[0] if given else options.get("simulationSettings")
    if not mbs.systemIsConsistent and options.get("autoAssemble", True):
        mbs.Assemble()
    size = mbs.systemData.ODE2Size()
    kind = (settings or exudyn.SimulationSettings()).linearSolver.solverType
    if size > _MOST and kind != _SPARSE:
        raise ValueError(
            f"linearSolver.solverType: {kind.name} cannot solve a scene with full rotor bodies of "
            f"{size} coordinates; use exudyn.LinearSolverType.EigenSparse, which "
            "recommended_settings(end_time, step, body=body) sets"
        )
