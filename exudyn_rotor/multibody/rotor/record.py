"""Recording a rotor's coordinates during a run, and reading them back."""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import SensorNode

from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

_KINDS = exudyn.OutputVariableType
_RATES = (_KINDS.Coordinates, _KINDS.Coordinates_t, _KINDS.Coordinates_tt)


@dataclass(frozen=True, eq=False)
class Record:
    """Motion of a rotor at the recorded instants.

    Attributes
    ----------
    time : ndarray, shape (s,)
        [s]
    q, q_t, q_tt : ndarray, shape (s, n)
        Coordinates of the body's nodes, those that are locked included.
    speed : ndarray, shape (s,)
        Spin speed [rad/s].
    complete : bool
        False if only the end state is known, because nothing was recorded.
    """

    time: np.ndarray
    q: np.ndarray
    q_t: np.ndarray
    q_tt: np.ndarray
    speed: np.ndarray
    complete: bool


def add_recording(body: RotorItems) -> None:
    """Add native sensors of all coordinates."""
    body.check_present()
    if body.record_sensors:
        return
    if body.mbs.systemIsConsistent:
        raise ValueError(
            f"start_recording: the system of rotor {body.name!r} is assembled already; call this "
            "before mbs.Assemble()"
        )
    for node in body.nodes.values():
        for kind in _RATES:
            item = SensorNode(
                nodeNumber=node, outputVariableType=kind, storeInternal=True, writeToFile=False
            )
            body.record_sensors[int(node), kind] = body.mbs.AddSensor(item)


def read_record(body: RotorItems) -> Record:
    """Return what was recorded; the current state where that is nothing."""
    body.check_assembled()
    mbs, sensors = body.mbs, body.record_sensors
    stored = {key: np.atleast_2d(mbs.GetSensorStoredData(one)) for key, one in sensors.items()}
    complete = bool(stored) and len(next(iter(stored.values()))) > 1

    def values(node: exudyn.NodeIndex, kind: exudyn.OutputVariableType) -> np.ndarray:
        if complete:
            return stored[int(node), kind][:, 1:]
        return np.atleast_2d(mbs.GetNodeOutput(node, kind))

    time = np.array([mbs.systemData.GetTime()])
    if complete:
        time = next(iter(stored.values()))[:, 0]
    parts = [np.hstack([values(node, kind) for node in body.nodes.values()]) for kind in _RATES]
    if body.formulation.has_spin:
        speed = parts[1][:, body.locks.spin]
    else:
        speed = np.array([float(body.formulation.spin.rate(t)) for t in time])
    return Record(time, *parts, speed, complete)


def implicit_step(body: RotorItems) -> float | None:
    """Return the step [s] of the last dynamic solution; None before one, or of an explicit one."""
    settings = body.mbs.sys.get("simulationSettings")
    solver = body.mbs.sys.get("dynamicSolver")
    if settings is None or solver is None or "Explicit" in type(solver).__name__:
        return None
    integration = settings.timeIntegration
    return (integration.endTime - integration.startTime) / integration.numberOfSteps
