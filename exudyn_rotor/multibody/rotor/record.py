"""A rotor's motion over a run, and a state of the whole scene from which a run can start."""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import SensorNode

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.theory.formulation import start_values

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


_VELOCITIES = ("initialVelocities", "initialCoordinates_t")  # by the kind of the node
_SAME = 1e-9  # share of the speed, and rad, by which start and prescribed spin may differ


@dataclass(frozen=True, eq=False)
class StartState:
    """Coordinates and velocities of a scene at one angle of a rotor.

    Attributes
    ----------
    q, q_t : ndarray, shape (n,)
        All coordinates of second order of the ``mbs``, and their velocities.
    angle : float
        Spin angle of the rotor [rad].
    speed : float
        Its spin speed [rad/s].

    Examples
    --------
    :func:`exudyn_rotor.steady_state` makes one, and so do the responses of linear analyses
    (:meth:`UnbalanceResponse.state`); :meth:`RotorBody.start_from` takes it.

    >>> from exudyn_rotor import StartState
    >>> StartState([0.0, 1e-3], [0.0, 0.1], angle=0.0, speed=100.0).q_t
    array([0. , 0.1])
    """

    q: np.ndarray
    q_t: np.ndarray
    angle: float
    speed: float

    def __post_init__(self) -> None:
        q = checks.array(self.q, "q", "m, rad")
        q_t = checks.array(self.q_t, "q_t", "m/s, rad/s")
        if q.ndim != 1 or q.shape != q_t.shape:
            raise ValueError(
                f"q, q_t: need one velocity for each coordinate, got the shapes {q.shape} and "
                f"{q_t.shape}"
            )
        object.__setattr__(self, "q", checks.read_only(q))
        object.__setattr__(self, "q_t", checks.read_only(q_t))
        object.__setattr__(self, "angle", checks.number(self.angle, "angle", "rad"))
        object.__setattr__(self, "speed", checks.number(self.speed, "speed", "rad/s"))


def spin_at_start(body: RotorItems) -> tuple[float, float]:
    """Return angle [rad] and speed [rad/s] with which the rotor starts."""
    if body.formulation.has_spin:
        return body.plan.setup.placement.angle, body.plan.setup.placement.speed
    angle, speed, _ = start_values(body.formulation.spin, "spin")
    return angle, speed


def start_from(body: RotorItems, state: StartState) -> None:
    """Make a state the initial state of the system, and of its nodes for a later assembly."""
    checks.instance(state, "state", StartState, "steady_state(body).state() makes one")
    body.check_assembled()
    data = body.mbs.systemData
    size = len(np.atleast_1d(data.GetODE2Coordinates()))
    if len(state.q) != size:
        raise ValueError(
            f"state: has {len(state.q)} coordinates, this system has {size}; it belongs to "
            "another system, or items were added since"
        )
    if not body.formulation.has_spin:
        angle, speed = spin_at_start(body)
        if abs(state.angle - angle) > _SAME or abs(state.speed - speed) > _SAME * abs(speed):
            raise ValueError(
                f"state: is one at {state.angle:g} rad and {state.speed:g} rad/s, the prescribed "
                f"spin starts at {angle:g} rad and {speed:g} rad/s"
            )
    for configuration in (exudyn.ConfigurationType.Initial, exudyn.ConfigurationType.Current):
        data.SetODE2Coordinates(state.q, configuration)
        data.SetODE2Coordinates_t(state.q_t, configuration)
    for number in range(data.NumberOfNodes()):
        _keep(body.mbs, number, state)


def _keep(mbs: exudyn.MainSystem, number: int, state: StartState) -> None:
    """Write the state into a node, so that it outlives ``mbs.Assemble()``."""
    node = mbs.GetNode(number)
    velocities = next((name for name in _VELOCITIES if name in node), None)
    if velocities is None:  # a node of the ground, or of data
        return
    first = mbs.GetNodeODE2Index(number)
    place = slice(first, first + len(node[velocities]))
    mbs.SetNodeParameter(number, "initialCoordinates", state.q[place].tolist())
    mbs.SetNodeParameter(number, velocities, state.q_t[place].tolist())
