"""Evaluating the equations of an ``mbs`` at any state, and leaving it as it was."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import exudyn
import numpy as np

# configurations that hold coordinates
_KIND = exudyn.ConfigurationType
STATES = (_KIND.Initial, _KIND.Current, _KIND.StartOfStep, _KIND.Visualization)
_NO_FORCES = {
    "stiffnessMatrix": np.zeros((0, 0)),
    "dampingMatrix": np.zeros((0, 0)),
    "forceVector": np.zeros(0),
    "forceUserFunction": 0,
    "jacobianUserFunction": 0,
}


@contextmanager
def evaluating(mbs: exudyn.MainSystem) -> Iterator[exudyn.MainSolverStatic]:
    """Give a solver that evaluates forces and masses; states are put back afterwards."""
    settings = exudyn.SimulationSettings()
    settings.staticSolver.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    data, solver = mbs.systemData, exudyn.MainSolverStatic()
    saved = [(state, data.GetSystemState(state), data.GetTime(state)) for state in STATES]
    try:
        solver.InitializeSolver(mbs, settings)
        yield solver
    finally:
        solver.FinalizeSolver(mbs, settings)
        for state, values, time in saved:
            data.SetSystemState(values, state)
            data.SetTime(time, state)


@contextmanager
def without_forces(mbs: exudyn.MainSystem, number: exudyn.ObjectIndex) -> Iterator[None]:
    """Let the object of a rotor's equations have its mass matrix alone, but no forces."""
    given = {name: mbs.GetObjectParameter(number, name) for name in _NO_FORCES}
    for name, nothing in _NO_FORCES.items():
        mbs.SetObjectParameter(number, name, nothing)
    try:
        yield
    finally:
        for name, value in given.items():
            mbs.SetObjectParameter(number, name, value)


def constraint_rows(
    mbs: exudyn.MainSystem, solver: exudyn.MainSolverStatic, size: int
) -> np.ndarray:
    """Return the constraints' Jacobian by the `size` coordinates, shape (c, size)."""
    # cleared by hand: Exudyn's own way evaluates forces, which this state may lie out of range of
    total = size + solver.GetAEsize()
    solver.SetSystemJacobian(np.zeros((total, total)))
    solver.ComputeJacobianAE(mbs, 1.0, 1.0, 0.0, False)  # of places or of rates
    return np.array(solver.GetSystemJacobian())[size:, :size]
