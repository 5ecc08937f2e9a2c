"""Short runs of a rotor without the marker body: its unknowns alone, on one generic node."""

from __future__ import annotations

from collections.abc import Mapping

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerNodeCoordinate,
    NodePointGround,
    SensorNode,
)

from exudyn_rotor import ReducedRotor, RotorBody, add_rotor

SOLVERS = exu.DynamicSolverType


def bare_rotor(
    reduced: ReducedRotor,
    *,
    springs: Mapping[int, float] | None = None,
    forces: Mapping[int, float] | None = None,
    **options,
) -> RotorBody:
    """Return a rotor without markers, with springs to ground and forces on its unknowns."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, markers={}, **options)

    def marker_of(unknown: int) -> exu.MarkerIndex:
        place = int(body.layout.unknowns[unknown])
        node, place = (
            (body.nodes["rigid"], place) if place < 6 else (body.nodes["modes"], place - 6)
        )
        return mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=place))

    if springs:
        fixed = mbs.AddNode(NodePointGround())
        ground = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))
    for coordinate, stiffness in (springs or {}).items():
        ends = [ground, marker_of(coordinate)]
        mbs.AddObject(CoordinateSpringDamper(markerNumbers=ends, stiffness=stiffness))
    for coordinate, force in (forces or {}).items():
        mbs.AddLoad(LoadCoordinate(markerNumber=marker_of(coordinate), load=force))
    return body


def run(
    body: RotorBody,
    step: float,
    steps: int,
    solver: SOLVERS = SOLVERS.TrapezoidalIndex2,
    *,
    adaptive: float | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Integrate; return the unknowns and their rates at the end.

    `adaptive` is the relative tolerance of an automatic step size.
    """
    settings = exu.SimulationSettings()
    integration = settings.timeIntegration
    integration.endTime, integration.numberOfSteps = step * steps, steps
    integration.generalizedAlpha.spectralRadius = 1.0
    integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-12, 1e-14
    integration.verboseMode = 0
    integration.automaticStepSize = adaptive is not None
    if adaptive is not None:
        integration.relativeTolerance, integration.absoluteTolerance = adaptive, 1e-2 * adaptive
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.999999 * step
    body.mbs.Assemble()
    body.mbs.SolveDynamic(settings, solverType=solver)
    q, q_t, _ = body.coordinates()
    return q, q_t


def history(body: RotorBody, step: float, steps: int, **options) -> np.ndarray:
    """Integrate; return time and unknowns at every step, shape (steps + 1, 1 + size)."""
    sensor = body.mbs.AddSensor(
        SensorNode(
            nodeNumber=body.nodes["coordinates"],
            outputVariableType=exu.OutputVariableType.Coordinates,
            storeInternal=True,
            writeToFile=False,
        )
    )
    run(body, step, steps, **options)
    return np.array(body.mbs.GetSensorStoredData(sensor))
