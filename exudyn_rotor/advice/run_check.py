"""After a run: whether the assumptions of the model held, each with a number."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.advice.proposal import Proposal
from exudyn_rotor.advice.recorded_run import RecordedRun
from exudyn_rotor.advice.request import AssumptionWarning
from exudyn_rotor.advice.run_rows import ROWS
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

_ENOUGH = 20  # instants


@dataclass(frozen=True)
class CheckRow:
    """One assumption.

    Attributes
    ----------
    name : str
    meaning : str
        What the number is, with its unit.
    value, limit : float
    advice : str
        What to do where the limit is exceeded.
    """

    name: str
    meaning: str
    value: float
    limit: float
    advice: str

    @property
    def ok(self) -> bool:
        """True if the value is finite and not above the limit."""
        return bool(np.isfinite(self.value) and self.value <= self.limit)

    def __str__(self) -> str:
        verdict = "ok" if self.ok else "FAILS"
        return f"{self.name:15s} {self.value:9.2e}  {self.limit:9.2e}  {verdict:5s}  {self.meaning}"


@dataclass(frozen=True)
class RunCheck:
    """What held in a run; made by :func:`exudyn_rotor.check_run`.

    Attributes
    ----------
    rows : tuple of CheckRow
    instants : int
        How many instants were looked at; 1 if ``body.start_recording()`` was not called before the
        run, so that only the end state is known.

    Examples
    --------
    >>> from exudyn_rotor import RunCheck
    >>> from exudyn_rotor.advice.run_check import CheckRow
    >>> row = CheckRow("tilt", "largest tilt [rad]", 0.02, 0.01, "use a smaller unbalance")
    >>> check = RunCheck((row,), instants=100)
    >>> check.ok, check.failed[0].name
    (False, 'tilt')
    """

    rows: tuple[CheckRow, ...]
    instants: int

    def __post_init__(self) -> None:
        rows = checks.instances(self.rows, "rows", CheckRow, "check_run makes them")
        object.__setattr__(self, "rows", rows)
        checks.count(self.instants, "instants", least=1)

    @property
    def complete(self) -> bool:
        """True if enough instants are known to see the largest motion of a run."""
        return self.instants >= _ENOUGH

    @property
    def ok(self) -> bool:
        """True if no row fails."""
        return not self.failed

    @property
    def failed(self) -> tuple[CheckRow, ...]:
        """Rows that fail."""
        return tuple(row for row in self.rows if not row.ok)

    def __getitem__(self, name: str) -> CheckRow:
        """Return a row by its name."""
        for row in self.rows:
            if row.name == name:
                return row
        raise KeyError(f"no check {name!r} here; there are: {', '.join(r.name for r in self.rows)}")

    @property
    def gap(self) -> str:
        """What a record of few instants lacks; empty for a complete one."""
        return (
            ""
            if self.complete
            else (
                f"only {self.instants} of at least {_ENOUGH} instants are known: call "
                "body.start_recording() before mbs.Assemble(), and lower "
                "solution.sensors.writePeriod of the settings"
            )
        )

    def __str__(self) -> str:
        lines = ["check               value      limit  verdict"]
        lines += [str(row) for row in self.rows]
        lines += [f"  {row.name}: {row.advice}" for row in self.failed]
        return "\n".join([*lines, *([f"  {self.gap}"] if self.gap else [])])


def check_run(
    body: RotorBody | FullRotorBody,
    *,
    reduced: ReducedRotor | None = None,
    proposal: Proposal | None = None,
    accuracy: float | None = None,
    warn: bool = True,
) -> RunCheck:
    """Check after a run whether the model's assumptions held.

    Parameters
    ----------
    body : RotorBody or FullRotorBody
        After the solution; ``body.start_recording()`` before ``mbs.Assemble()`` records the run at
        the instants of ``solution.sensors.writePeriod``. Before a run this checks the initial
        state.
    reduced : ReducedRotor, optional
        The rotor; adds the check of yielding where it was reduced with a yield stress.
    proposal : Proposal, optional
        Adds the check of the speed range, and gives the accuracy.
    accuracy : float, optional
        Relative error of periods, and of motion that repeats itself; the proposal's, or 1e-3. Free
        vibrations go out of phase by more, see the notes.
    warn : bool
        Whether there is an :class:`AssumptionWarning` for every row that fails, and for a run that
        was recorded at less than 20 instants.

    Returns
    -------
    RunCheck

    Raises
    ------
    TypeError, ValueError
        For bad input, or a system that is not assembled.

    Notes
    -----
    Checks, with a for the accuracy; "size" is the rotor's radius of gyration. A full body has the
    rows up to ``film``.

    No row adds up errors over a run. A free vibration, such as a sudden start leaves where damping
    is weak, goes out of phase in every period: by about 2π times the row ``step``, and by about π
    times ``residual``, for its frequency errs by half of that. Its instants then err by this
    phase times its amplitude; motion forced by the spin or by loads does not. To compare instants,
    begin in the steady state (``body.start_from(steady_state(body).state())``), wait for the start
    to die down, or ask for an accuracy better by 2π times the number of periods.

    ===================  =======  ==================================================================
    name                 limit    meaning
    ===================  =======  ==================================================================
    ``tilt``             √a       largest rigid tilt [rad]; terms of its second order are left out
    ``deflection``       √a       root mean square flexible displacement over the size, likewise
    ``connections``      0        connectors, joints and loads that the rotor cannot carry:
                                  ``body.check_connections()`` names them
    ``step``             a        error by the step, 0.0844 h² times the accelerations of the
                                  vibrations over their displacements; larger for slow motion in
                                  space that is integrated in the rotor frame; next to a resonance
                                  amplitudes err by more, by the amplification
    ``growth``           0.75     change of the growth of a lightly damped motion by the step,
                                  towards the other sign, over the growth: above 1 the sign is
                                  wrong; of scenes at constant speed with translation 'none'
    ``film``             1        displacement of a journal at the end over that beyond which its
                                  film is too thin and the law goes on by its tangent
    ``unresisted load``  0.01     what ``connections`` counts, as a share of the largest load
    ``stiffening``       a        stiffening that the level leaves out, as relative change of
                                  frequency of the recorded motion; estimated without a prestress
    ``top modes``        0.01     elastic energy in the highest fifth of the flexible modes over the
                                  energy of the motion: how much the modes beyond may hold
    ``residual``         a        static deflection of interfaces against the mean motion of the
                                  rotor, by loads at interfaces and the centrifugal load, that the
                                  modes leave out, over their displacement
    ``axial force``      2a       axial force between interfaces over the load at which the shaft
                                  buckles, hinged where the force acts, less what the prestress
                                  holds; frequencies err by half of it
    ``yield``            1        static von Mises stress at the highest speed over the yield stress
    ``speed``            1 + a    highest speed over that of the proposal
    ===================  =======  ==================================================================

    Examples
    --------
    >>> import exudyn, numpy as np
    >>> from exudyn_rotor import SolidRotor, add_rotor, check_run, recommended_settings
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(6), 1e6 * np.eye(6), [[0.1, 0, 0], [-0.1, 0, 0]], "z", interfaces={"top": [0]}
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(6), spin=10.0, translation="none")
    >>> body.start_recording()
    >>> mbs.Assemble()
    >>> settings = recommended_settings(end_time=0.01, step=2e-5)
    >>> settings.solution.sensors.writePeriod = 1e-4
    >>> settings.solution.file.write = False
    >>> settings.timeIntegration.verboseMode = 0
    >>> mbs.SolveDynamic(settings)
    True
    >>> check_run(body).ok
    True
    """
    checks.instance(body, "body", (RotorBody, FullRotorBody), "add_rotor returns one")
    body.check_assembled()
    if reduced is not None:
        checks.instance(reduced, "reduced", ReducedRotor)
    if proposal is not None:
        checks.instance(proposal, "proposal", Proposal, "propose makes one")
    if accuracy is None:
        accuracy = proposal.accuracy if proposal is not None else 1e-3
    checks.tolerance(accuracy, "accuracy")
    checks.flag(warn, "warn")
    record = body.recorded()
    run = RecordedRun(body, record, reduced, None if proposal is None else proposal.speeds[1])
    result = RunCheck(tuple(_rows(run, accuracy)), len(record.time))
    told = [
        f"{row.name} {row.value:.3g} exceeds {row.limit:.3g} ({row.meaning}): {row.advice}"
        for row in result.failed
    ]
    if result.gap and record.time[-1] > 0.0:
        told.insert(0, result.gap)
    for message in told if warn else ():
        warnings.warn(f"rotor {body.name!r}: {message}", AssumptionWarning, stacklevel=2)
    return result


def _rows(run: RecordedRun, accuracy: float) -> Iterator[CheckRow]:
    """Yield the rows that a run has."""
    if not (np.all(np.isfinite(run.record.q)) and np.all(np.isfinite(run.record.q_t))):
        what = "coordinates that are not finite"
        yield CheckRow("finite", what, np.inf, 0.0, "the solution failed")
        return
    for row, measure in ROWS.items():
        if row.of_modes and isinstance(run.body, FullRotorBody):
            continue
        value = measure(run)
        if value is not None:
            limit = row.limit(accuracy) if callable(row.limit) else row.limit
            yield CheckRow(row.name, row.meaning, float(value), float(limit), row.advice)
