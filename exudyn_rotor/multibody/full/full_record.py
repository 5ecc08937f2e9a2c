"""Displacements of a full body at chosen instants of a run, for its stress and checks of the run.

All displacements at all steps would fill the memory; a sensor keeps those of the instants, their
rates and accelerations. Exudyn calls it whenever sensors are stored, and at all other times it
reads nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.itemInterface import SensorUserFunction
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.record import Record, read_record, spin_speeds
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

_KINDS = exudyn.OutputVariableType
_ROUNDING = 1e-9  # of an instant, which a sum of steps may miss


@dataclass(frozen=True, eq=False)
class FullRecord:
    """Displacements of a full body at the instants of its record.

    Attributes
    ----------
    time : ndarray, shape (s,)
        When they were stored: at the instants, or when sensors were stored next [s].
    displacement : ndarray, shape (s, n, 3)
        Of all nodes, rotor frame, mesh axes [m].
    stress : ndarray, shape (s, n, 6), or None
        xx, yy, zz, yz, xz, xy at all nodes, mesh axes [Pa], as :meth:`FullRotorBody.stress`; None
        for a rotor without elements.
    """

    time: np.ndarray
    displacement: np.ndarray
    stress: np.ndarray | None


class Stored:
    """Which instants are wanted, and what has been stored."""

    def __init__(self, instants: np.ndarray) -> None:
        self.instants = instants
        self.latest = np.inf
        self.time: list[float] = []
        self.states: list[tuple[np.ndarray, ...]] = []

    def is_due(self, t: float) -> bool:
        """Return whether `t` is the next instant; a run that begins anew forgets the last one."""
        if t < self.latest:
            self.time, self.states = [], []
        self.latest = t
        done = len(self.time)
        return done < len(self.instants) and t >= self.instants[done] * (1.0 - _ROUNDING)


def start_recording(body: RotorItems, instants: ArrayLike) -> None:
    """Add the sensor that stores the displacements at ascending instants [s]."""
    body.check_present()
    wanted = checks.ascending(instants, "instants", "s")
    if wanted[0] < 0.0:
        raise ValueError(f"instants: needs none before the start at 0 s, got {wanted[0]:.6g} s")
    if body.mbs.systemIsConsistent:
        raise ValueError(
            f"start_recording: the system of rotor {body.name!r} is assembled already; call this "
            "before mbs.Assemble()"
        )
    if body.stored:
        raise ValueError(f"start_recording: rotor {body.name!r} has its instants already")
    body.stored.append(stored := Stored(wanted))
    body.mbs.AddSensor(
        SensorUserFunction(
            sensorUserFunction=_storing(stored, tuple(body.nodes.values())),
            storeInternal=True,
            writeToFile=False,
        )
    )


def _storing(stored: Stored, nodes: tuple[exudyn.NodeIndex, ...]) -> Callable:
    def store(mbs, t, sensors, factors, configuration):
        if configuration == exudyn.ConfigurationType.Current and stored.is_due(t):
            values = (
                np.hstack([mbs.GetNodeOutput(node, kind, configuration) for node in nodes])
                for kind in (_KINDS.Coordinates, _KINDS.Coordinates_t, _KINDS.Coordinates_tt)
            )
            stored.time.append(t)
            stored.states.append(tuple(values))
        return [float(len(stored.time))]

    return store


def recorded(body: RotorItems) -> FullRecord:
    """Return what was stored at all the instants."""
    body.check_assembled()
    stored = body.stored[0] if body.stored else None
    if stored is None:
        raise ValueError(
            f"rotor {body.name!r} stores nothing; call body.start_recording(instants) before "
            "mbs.Assemble()"
        )
    done = len(stored.time)
    if done < len(stored.instants):
        raise ValueError(
            f"rotor {body.name!r} stored {done} of {len(stored.instants)} instants, and nothing "
            f"for {stored.instants[done]:.6g} s: the run ended before, or sensors were stored too "
            "seldom; let solution.sensors.writePeriod be the step"
        )
    fields = body.layout.unknowns[body.motion.modes]
    displacement = np.array([q[fields] for q, *_ in stored.states]).reshape(done, -1, 3)
    recover, stress = body.selection.source.stress_recovery, None
    if recover is not None:
        columns = displacement.reshape(done, -1).T
        stress = np.moveaxis(recover(columns), -1, 0)
    return FullRecord(np.array(stored.time), displacement, stress)


def recorded_states(body: RotorItems) -> Record:
    """Return all coordinates, rates and accelerations at the instants that were stored.

    The current state where nothing was stored.
    """
    body.check_assembled()
    stored = body.stored[0] if body.stored else None
    if stored is None or not stored.time:
        return read_record(body)
    time = np.array(stored.time)
    q, q_t, q_tt = (np.array(rows) for rows in zip(*stored.states, strict=True))
    speed = spin_speeds(body, time, q_t)
    return Record(time, q, q_t, q_tt, np.zeros_like(q), speed, len(time) > 1)
