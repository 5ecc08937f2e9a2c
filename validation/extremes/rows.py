"""One row of the table: what is pushed, by which criterion it holds, and where it breaks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Row:
    """Outcome of pushing one input.

    Attributes
    ----------
    pushed : str
        What is pushed.
    reach : str
        How far, or over which range.
    criterion : str
        What is measured, and where its limit comes from.
    measured, limit : float
        The row passes while the first is not above the second.
    breaks_at : str
        Where it ends; 'not reached' if it does not within the range.
    reason : {'physics', 'numerics', 'input', ''}
        Why it ends there.
    told : str
        What the user is told there.
    """

    pushed: str
    reach: str
    criterion: str
    measured: float
    limit: float
    breaks_at: str = "not reached"
    reason: str = ""
    told: str = ""

    @property
    def passed(self) -> bool:
        """True while the criterion holds; a NaN never passes."""
        return self.measured <= self.limit


def breaking_point(
    holds: Callable[[float], bool], good: float, bad: float, factor: float = 1.001
) -> float:
    """Return the value between `good` and `bad` at which `holds` turns false, by bisection.

    In the logarithm, to the ratio `factor`; NaN where it holds at `bad`, too, or not at `good`.
    """
    if not holds(good) or holds(bad):
        return float("nan")
    while max(good / bad, bad / good) > factor:
        middle = float(np.sqrt(good) * np.sqrt(bad))
        good, bad = (middle, bad) if holds(middle) else (good, middle)
    return bad


def message(action: Callable[[], object]) -> str:
    """Return the message of the error that `action` raises, cut short; '' if it raises none."""
    try:
        action()
    except Exception as error:
        text = str(error).strip()
        return f"{type(error).__name__}: {text[:160]}"
    return ""
