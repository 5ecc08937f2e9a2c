"""A rotor's motion over a run, and a state of the whole scene from which a run can start."""

from __future__ import annotations

from dataclasses import dataclass

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.theory.formulation import start_values

_KINDS = exudyn.OutputVariableType
RATES = (_KINDS.Coordinates, _KINDS.Coordinates_t, _KINDS.Coordinates_tt)


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


def implicit_step(body: RotorItems) -> float | None:
    """Return the step [s] of the last dynamic solution; None before one, or of an explicit one."""
    settings = body.mbs.sys.get("simulationSettings")
    solver = body.mbs.sys.get("dynamicSolver")
    if settings is None or solver is None or "Explicit" in type(solver).__name__:
        return None
    integration = settings.timeIntegration
    return (integration.endTime - integration.startTime) / integration.numberOfSteps


_VELOCITIES = ("initialVelocities", "initialCoordinates_t")  # by the kind of the node
SAME = 1e-9  # share of the speed, and rad, by which start and prescribed spin may differ


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
        return body.placement.angle, body.placement.speed
    angle, speed, _ = start_values(body.formulation.spin, "spin")
    return angle, speed


def keep_in_node(mbs: exudyn.MainSystem, number: int, state: StartState) -> None:
    """Write the state into a node, so that it outlives ``mbs.Assemble()``."""
    node = mbs.GetNode(number)
    velocities = next((name for name in _VELOCITIES if name in node), None)
    if velocities is None:  # a node of the ground, or of data
        return
    first = mbs.GetNodeODE2Index(number)
    place = slice(first, first + len(node[velocities]))
    mbs.SetNodeParameter(number, "initialCoordinates", state.q[place].tolist())
    mbs.SetNodeParameter(number, velocities, state.q_t[place].tolist())
