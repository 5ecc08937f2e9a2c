"""Recording a rotor's coordinates during a run, and reading them back."""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import SensorNode, SensorObject

from exudyn_rotor.multibody.rotor.frame import LOCKS, MODES
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

_KINDS = exudyn.OutputVariableType
_RATES = (_KINDS.Coordinates, _KINDS.Coordinates_t, _KINDS.Coordinates_tt)


@dataclass(frozen=True, eq=False)
class Solver:
    """What Exudyn's last dynamic solution used.

    Attributes
    ----------
    step : float
        Step size [s]; the last one where it is controlled.
    explicit : bool
    method : str
        Name of the explicit method, as in ``exudyn.DynamicSolverType``; empty for an implicit one.
    steps : int
        Nominal number of steps.
    """

    step: float
    explicit: bool
    method: str = ""
    steps: int = 1


@dataclass(frozen=True, eq=False)
class Record:
    """Motion of a rotor at the recorded instants.

    Attributes
    ----------
    time : ndarray, shape (s,)
        [s]
    q, q_t, q_tt : ndarray, shape (s, n)
        Coordinates of the body's nodes, those that are locked included.
    held : ndarray, shape (s, n)
        Forces of locking constraints on these coordinates.
    speed : ndarray, shape (s,)
        Spin speed [rad/s].
    complete : bool
        False if only the end state is known, because nothing was recorded.
    """

    time: np.ndarray
    q: np.ndarray
    q_t: np.ndarray
    q_tt: np.ndarray
    held: np.ndarray
    speed: np.ndarray
    complete: bool


def add_recording(body: RotorItems) -> None:
    """Add native sensors of all coordinates and of the forces of locking constraints."""
    body.check_present()
    if body.record_sensors:
        return
    if body.mbs.systemIsConsistent:
        raise ValueError(
            f"start_recording: the system of rotor {body.name!r} is assembled already; call this "
            "before mbs.Assemble()"
        )
    options = {"storeInternal": True, "writeToFile": False}
    for name, node in body.nodes.items():
        for kind in _RATES:
            body.record_sensors[name, kind] = body.mbs.AddSensor(
                SensorNode(nodeNumber=node, outputVariableType=kind, **options)
            )
    for name, constraint in body.constraints.items():
        body.record_sensors[name, _KINDS.Force] = body.mbs.AddSensor(
            SensorObject(objectNumber=constraint, outputVariableType=_KINDS.Force, **options)
        )


def read_record(body: RotorItems) -> Record:
    """Return what was recorded; the current state where that is nothing."""
    body.check_assembled()
    first = next(iter(body.record_sensors.values()), None)
    stored = None if first is None else np.atleast_2d(body.mbs.GetSensorStoredData(first))
    complete = stored is not None and len(stored) > 1
    if complete:
        time = stored[:, 0]
        read = _stored
    else:
        time = np.array([body.mbs.systemData.GetTime()])
        read = _current
    parts = [
        np.hstack([read(body, name, node, kind) for name, node in body.nodes.items()])
        for kind in _RATES
    ]
    held = np.zeros_like(parts[0])
    for name, constraint in body.constraints.items():
        force = read(body, name, constraint, _KINDS.Force)
        if name == LOCKS:
            rows, _ = body.locks.rows
            held[:, :MODES] += force @ rows
        else:
            held[:, body.locks.names.index(name)] = force[:, 0]
    return Record(time, *parts, held, spin_speeds(body, time, parts[1]), complete)


def last_solver(body: RotorItems) -> Solver | None:
    """Return what the last dynamic solution used; None before one."""
    settings = body.mbs.sys.get("simulationSettings")
    solver = body.mbs.sys.get("dynamicSolver")
    if settings is None or solver is None:
        return None
    integration = settings.timeIntegration
    duration = integration.endTime - integration.startTime
    step = duration / integration.numberOfSteps
    if "Explicit" not in type(solver).__name__:
        return Solver(step, explicit=False)
    # solvers with step control take shorter steps than the nominal one
    method = solver.GetSolverName().partition("(")[2].rstrip(")")
    step = min(step, solver.it.currentStepSize)
    return Solver(step, explicit=True, method=method, steps=integration.numberOfSteps)


def _stored(body: RotorItems, name: str, item: int, kind) -> np.ndarray:
    return np.atleast_2d(body.mbs.GetSensorStoredData(body.record_sensors[name, kind]))[:, 1:]


def _current(body: RotorItems, name: str, item: int, kind) -> np.ndarray:
    read = body.mbs.GetObjectOutput if kind == _KINDS.Force else body.mbs.GetNodeOutput
    return np.atleast_2d(read(item, kind))


def spin_speeds(body: RotorItems, time: np.ndarray, q_t: np.ndarray) -> np.ndarray:
    """Return the spin speeds (s,) [rad/s] at times, with the rates (s, n) of the coordinates."""
    if not body.formulation.has_spin:
        return np.array([float(body.formulation.spin.rate(t)) for t in time])
    return q_t[:, body.locks.spin]
