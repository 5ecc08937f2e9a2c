"""Where the energy of a rotor went in a run: loads and supports, drive, damping, integrator.

With the generalised external forces f = M q̈ − Q(q, q̇), Q the rotor's own (66), (86), (87), and the
torque T of a prescribed spin,

    kinetic + elastic + weight = start + ∫ fᵀq̇ dt + ∫ T ω dt − ∫ ζ̇ᵀD ζ̇ dt,

the weight's own work being its potential. What is left over is what the integrator adds or takes.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor import plotting
from exudyn_rotor.advice.run_loads import external_load
from exudyn_rotor.calls import user_level
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.frame import driving_force
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.energy import energy_of
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_LEAST = 3  # instants: the first has no accelerations
# error by the spacing of the instants that is told: of what goes from one share to another, and of
# the energy, which rounds
_COARSE, _ROUNDING = 0.01, 1e-9
_NAMES = ("kinetic", "elastic", "weight", "loads", "drive", "damping", "error")


@storable
@dataclass(frozen=True, eq=False)
class EnergyBalance(Result):
    """Energy of a rotor over a run, and where it came from, made by :func:`energy_balance`.

    Attributes
    ----------
    time : ndarray, shape (s,)
        [s]
    kinetic, elastic, weight : ndarray, shape (s,)
        Kinetic energy in the inertial frame, elastic energy, potential of the weight [J].
    loads : ndarray, shape (s,)
        Work of all that is attached to the rotor since the first instant: loads, supports, joints,
        less the weight's [J].
    drive : ndarray, shape (s,)
        Work of the drive of a prescribed spin [J]; zero for a free one.
    damping : ndarray, shape (s,)
        What the rotor's own damping has taken [J].

    Examples
    --------
    >>> from exudyn_rotor import EnergyBalance
    >>> balance = EnergyBalance(
    ...     time=[0.0, 1.0], kinetic=[0.0, 5.0], elastic=[0.0, 1.0], weight=[0.0, -2.0],
    ...     loads=[0.0, 5.0], drive=[0.0, 0.0], damping=[0.0, 0.9],
    ... )
    >>> balance.error.round(3)
    array([ 0. , -0.1])
    """

    time: np.ndarray = numbers("instants")
    kinetic: np.ndarray = numbers("instants")
    elastic: np.ndarray = numbers("instants")
    weight: np.ndarray = numbers("instants")
    loads: np.ndarray = numbers("instants")
    drive: np.ndarray = numbers("instants")
    damping: np.ndarray = numbers("instants")

    @property
    def total(self) -> np.ndarray:
        """Energy of the rotor, shape (s,) [J]."""
        return self.kinetic + self.elastic + self.weight

    @property
    def error(self) -> np.ndarray:
        """What the integrator has added, with the error of the record's instants, (s,) [J]."""
        return self.total - self.total[0] - self.loads - self.drive + self.damping

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each instant; `units` change nothing."""
        Units.of(units)
        return {"time [s]": self.time, **{f"{name} [J]": getattr(self, name) for name in _NAMES}}

    def table(self) -> str:
        """Return start, end and largest of every share [J] as lines of text."""
        lines = [f"{'[J]':10}{'start':>12}{'end':>12}{'largest':>12}"]
        for name in _NAMES:
            values = getattr(self, name)
            lines.append(
                f"{name:10}{values[0]:12.4e}{values[-1]:12.4e}{np.abs(values).max():12.4e}"
            )
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw all shares over the time."""
        ax = plotting.axes_or_new(ax)
        for name in _NAMES:
            ax.plot(self.time, getattr(self, name), label=name)
        ax.set_xlabel("time [s]")
        ax.set_ylabel("energy [J]")
        ax.legend()
        return ax


def energy_balance(body: RotorBody) -> EnergyBalance:
    """Return where the energy of a rotor went in the last run.

    It costs nothing in the run: all of it follows from the recorded coordinates and the equations.
    The first recorded instant has no accelerations and does not count. Works are integrals over the
    recorded instants, so record every step (``solution.sensors.writePeriod``).

    Parameters
    ----------
    body : RotorBody
        After a run for which ``body.start_recording()`` was called before ``mbs.Assemble()``.

    Raises
    ------
    TypeError, ValueError
        Without a record, or for a rotor whose translation is prescribed.

    Warns
    -----
    UserWarning
        If the instants are so far apart that the works err by more than 1 % of the largest change;
        by the difference to the works over every other instant.

    Examples
    --------
    A ring of 2 kg and radius 0.1 m that falls, 0.2 s long, while it spins:

    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, add_rotor, energy_balance, recommended_settings
    >>> angles = 2.0 * np.pi * np.arange(4) / 4
    >>> nodes = 0.1 * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(4)])
    >>> ring = SolidRotor.from_matrices(0.5 * np.eye(12), np.zeros((12, 12)), nodes, "z",
    ...                                 allow_parts=True)
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, ring.reduce(0), initial_speed=50.0, gravity=[0.0, -9.81, 0.0])
    >>> body.start_recording()
    >>> mbs.Assemble()
    >>> settings = recommended_settings(end_time=0.2, step=0.01)
    >>> settings.timeIntegration.verboseMode = 0
    >>> settings.solution.file.write = False
    >>> mbs.SolveDynamic(settings)
    True
    >>> balance = energy_balance(body)
    >>> float(np.ptp(balance.weight).round(3)), bool(np.abs(balance.error).max() < 1e-8)
    (3.84, True)
    """
    reduced_body(body)
    if body.formulation.moves_origin:
        raise ValueError(
            f"body: rotor {body.name!r} follows a prescribed translation, whose work is not known"
        )
    record = body.recorded()
    if len(record.time) < _LEAST:
        raise ValueError(
            f"body: {len(record.time)} instants of rotor {body.name!r} are recorded; call "
            "body.start_recording() before mbs.Assemble(), and record every step"
        )
    rows = np.array([_instant(body, record, i) for i in range(1, len(record.time))])
    time, energies, powers = record.time[1:], rows[:, :3], rows[:, 3:]
    steps = 0.5 * np.diff(time)[:, None] * (powers[1:] + powers[:-1])
    works = np.vstack([np.zeros(3), np.cumsum(steps, axis=0)])
    _warn_of_coarse_record(body.name, time, energies, powers)
    weight = energies[:, 2]
    # gravity is a load of Exudyn, or in the equations
    by_weight = weight - weight[0] if body.gravity_load is not None else 0.0
    return EnergyBalance(time, *energies.T, works[:, 0] + by_weight, *works[:, 1:].T)


def _warn_of_coarse_record(
    name: str, time: np.ndarray, energies: np.ndarray, powers: np.ndarray
) -> None:
    """Warn where the trapezoidal rule over every other instant gives other works."""
    odd = slice(0, len(time) - (len(time) + 1) % 2)  # both end at one instant
    fine = np.trapezoid(powers[odd], time[odd], axis=0)
    coarse = np.trapezoid(powers[odd][::2], time[odd][::2], axis=0)
    error = np.abs(fine - coarse).max() / 3.0  # of second order
    moved = max(np.abs(fine).max(), np.ptp(energies, axis=0).max())
    if len(time) < _LEAST or error > _COARSE * moved + _ROUNDING * np.abs(energies).max():
        warnings.warn(
            f"energy balance of rotor {name!r}: {len(time)} recorded instants are too far apart "
            "for works; its error is not the integrator's. Record every step: lower "
            "solution.sensors.writePeriod of the simulation settings",
            UserWarning,
            stacklevel=user_level(),
        )


def _instant(body: RotorBody, record: Record, index: int) -> tuple[float, ...]:
    """Return the three energies [J], and the powers of loads, drive and damping [W]."""
    motion, place = body.motion, body.layout
    t, omega = float(record.time[index]), float(record.speed[index])
    q, q_t, q_tt = (rows[index][place.unknowns] for rows in (record.q, record.q_t, record.q_tt))
    gravity = body.plan.setup.gravity
    if body.gravity_load is not None:  # a script may change it
        gravity = np.asarray(body.mbs.GetLoadParameter(body.gravity_load, "loadVector"))
    energy = energy_of(motion, t, q, q_t, gravity)
    power, drive = external_load(body, record, index) @ q_t, 0.0
    if not body.formulation.has_spin:
        moment = _moment_on_spin(body, record, index)
        if body.gravity_load is not None:
            # by the deflection Sζ, which Exudyn's load leaves out
            axis = SpinAxis(motion.invariants.direction)
            turn = motion.orientation @ axis.rotation(body.formulation.spin.value(t))
            moment += turn @ axis.skew @ (motion.invariants.S @ q[motion.modes]) @ gravity
        power += moment * omega
        drive = (motion.drive_torque(t, q, q_t, q_tt[motion.modes]) - moment) * omega
    zeta_t = q_t[motion.modes]
    damped = zeta_t @ (motion.invariants.D @ zeta_t)
    return energy.kinetic, energy.elastic, energy.weight, float(power), drive, float(damped)


def _moment_on_spin(body: RotorBody, record: Record, index: int) -> float:
    """Return the external moment about e, which the locked spin holds [N m]."""
    if "marker_body" not in body.objects:
        return 0.0
    mass, spin = body.layout.lock_mass, body.locks.spin
    held = mass[spin] * record.q_tt[index, spin]
    if body.plan.setup.locking == "mass" and spin in body.locks.varying:
        held -= driving_force(body.locks, mass)(float(record.time[index]))[spin]
    return float(held + record.held[index, spin])
