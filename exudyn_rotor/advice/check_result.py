"""What the check of a run returns: one row per assumption."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks

_ENOUGH = 20  # instants


@dataclass(frozen=True)
class CheckRow:
    """One assumption.

    Attributes
    ----------
    name : str
        Key of its limit.
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

    def __post_init__(self) -> None:
        for name in ("name", "meaning", "advice"):
            checks.label(getattr(self, name), name)
        # a run that failed has no finite value
        for name in ("value", "limit"):
            checks.array(getattr(self, name), name, shape=(), finite=False)

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
    >>> from exudyn_rotor.advice.check_result import CheckRow
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
        return all(row.ok for row in self.rows)

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

    def gap(self) -> str:
        """Return what a record of few instants lacks."""
        if self.instants == 1:
            return (
                "only the end state is known: call body.start_recording(), for a full body with "
                "instants, before mbs.Assemble()"
            )
        return (
            f"only {self.instants} instants are known: lower solution.sensors.writePeriod of the "
            "simulation settings, or give a full body's start_recording more"
        )

    def __str__(self) -> str:
        lines = ["check               value      limit  verdict"]
        lines += [str(row) for row in self.rows]
        lines += [f"  {row.name}: {row.advice}" for row in self.failed]
        if not self.complete:
            lines.append(f"  {self.gap()}")
        return "\n".join(lines)
