"""What a proposal is asked for, checked, and the warning where an assumption does not hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks

# relative period error per (ωh)² of generalised alpha with Exudyn's spectral radius 0.9; 1/12 at 1
PERIOD_ERROR = 0.0844
_SPEEDS = 5  # within a range


class AssumptionWarning(UserWarning):
    """An assumption of the model does not hold, or its error exceeds what was asked for.

    Examples
    --------
    An error instead:

    >>> import warnings
    >>> from exudyn_rotor import AssumptionWarning
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", AssumptionWarning)
    """


@dataclass(frozen=True)
class Request:
    """Speeds, loads and accuracy."""

    low: float  # range of the spin speed [rad/s]
    high: float
    loads: float  # highest frequency in the inertial frame [rad/s]
    accuracy: float
    banded: bool  # any frequency up to `loads` may occur, not those of weight and unbalance alone

    @classmethod
    def of(cls, speeds: ArrayLike, load_frequencies: ArrayLike | None, accuracy: float) -> Request:
        """Check the values; without load frequencies everything happens at the spin speed."""
        values = _frequencies(speeds, "speeds")
        if len(values) > 2 or np.any(np.diff(values) < 0.0):
            raise ValueError(
                f"speeds: needs one speed or (low, high) [rad/s], got {checks.shown(speeds)}"
            )
        given = speeds if load_frequencies is None else load_frequencies
        loads = _frequencies(given, "load_frequencies")
        if values.max() + loads.max() == 0.0:
            raise ValueError(
                "speeds, load_frequencies: all are zero, so nothing moves; give the highest "
                "frequency of the loads [rad/s]"
            )
        ends = float(values[0]), float(values[-1]), float(loads.max())
        banded = load_frequencies is not None
        return cls(*ends, checks.tolerance(accuracy, "accuracy"), banded)

    @property
    def highest(self) -> float:
        """Highest frequency in the rotor frame [rad/s]: f fixed in space appears at f ± Ω."""
        return self.loads + self.high

    @property
    def speeds(self) -> np.ndarray:
        """Speeds to look at, unbalance may meet a resonance between [rad/s]."""
        return np.unique(np.linspace(self.low, self.high, _SPEEDS))

    @property
    def allowed(self) -> float:
        """Error that modes and step may each make: half the accuracy."""
        return 0.5 * self.accuracy

    @property
    def step(self) -> float:
        """Step size [s] with the allowed period error at :attr:`highest`; an upper bound."""
        return float(np.sqrt(self.allowed / PERIOD_ERROR) / self.highest)


def _frequencies(values: ArrayLike, name: str) -> np.ndarray:
    array = np.atleast_1d(checks.array(values, name, "rad/s"))
    if array.ndim != 1 or array.size == 0 or np.any(array < 0.0):
        raise ValueError(
            f"{name}: needs one or more numbers ≥ 0 [rad/s], got {checks.shown(values)}"
        )
    return array
