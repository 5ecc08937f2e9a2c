"""How far linear analyses of a reduced rotor are from those of its full model: check and warning.

The estimates are those of :mod:`exudyn_rotor.linear.models.basis.left_out`.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.models.basis.critical_shift import CriticalMotion, critical_shifts
from exudyn_rotor.linear.models.basis.left_out import LeftOut
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.threads import one_thread

NOT_KNOWN = "error of the basis: not known"
# share of the frequency that growth counts as at least: its error is then that of the damping ratio
_DAMPED = 0.01
_SLOW = 0.1  # share of the spin speed that a frequency counts as at least
# times the fastest speed: modes below are judged where no number of modes is asked for
_RANGE = 2.0
_LOWEST = 6  # modes that are judged in any case


@dataclass(frozen=True, eq=False)
class BasisError:
    """The check of the basis in one analysis.

    Attributes
    ----------
    model : LinearModel
    accuracy : float or None
        Relative error above which a warning is given; None for no check.
    left_out : LeftOut or None
        None where nothing is left out or it is not known what.
    """

    model: LinearModel
    accuracy: float | None
    left_out: LeftOut | None

    @classmethod
    def of(cls, model: LinearModel, accuracy: float | None, held: bool = False) -> BasisError:
        """Prepare the check of a model; `held` where a free spin is no coordinate."""
        looked_at = accuracy is not None and not model.is_full
        return cls(model, accuracy, LeftOut.of(model, held) if looked_at else None)

    @property
    def is_known(self) -> bool:
        """True where an estimate can be given."""
        return self.accuracy is not None and (self.model.is_full or self.left_out is not None)

    @one_thread()
    def shifts(
        self, speeds: np.ndarray, modes: Sequence[FloquetModes], chosen: np.ndarray
    ) -> np.ndarray | None:
        """Return ``λ_full − λ`` of modes at speeds, shape (s, k); None where that is not known.

        NaN of those that are not `chosen` (s, k).
        """
        if not self.is_known:
            return None
        if self.left_out is None:
            return np.array([0j * entry.values for entry in modes])
        shifts = np.full(chosen.shape, np.nan, dtype=complex)
        judged = [entry.columns(used) for entry, used in zip(modes, chosen, strict=True)]
        shifts[chosen] = np.concatenate(self.left_out.shifts(speeds, judged))
        return shifts

    @one_thread()
    def shifts_of(
        self, speeds: np.ndarray, modes: Sequence[FloquetModes | None]
    ) -> np.ndarray | None:
        """Return ``λ_full − λ`` of one mode at each speed, shape (s,).

        NaN where it is None, 0 where the basis leaves nothing out.
        """
        if not self.is_known:
            return None
        if self.left_out is None:
            return np.zeros(len(speeds), dtype=complex)
        shifts = np.full(len(speeds), np.nan, dtype=complex)
        known = [index for index, mode in enumerate(modes) if mode is not None]
        given = [speeds[index] for index in known], [modes[index] for index in known]
        shifts[known] = [found[0] for found in self.left_out.shifts(*given)]
        return shifts

    @one_thread()
    def critical_errors(
        self, critical: Sequence[tuple[CriticalMotion, CriticalMotion | None]]
    ) -> np.ndarray:
        """Return relative errors of critical speeds, shape (c,), where they are known.

        Each with the upper one of a pair that is listed by its lower one. The larger error of the
        two counts then, the lower speed compared with the lower one without what is left out.
        """
        if self.left_out is None:
            return np.zeros(len(critical))
        every = [motion for pair in critical for motion in pair if motion is not None]
        moved, errors = map(iter, critical_shifts(self.left_out, every))
        result = []
        for lower, upper in critical:
            new, error = [next(moved)], next(errors)
            if upper is not None:
                new, _ = sorted([*new, next(moved)]), next(errors)
                error = max(abs(new[0] - lower.speed), abs(new[1] - upper.speed))
            result.append(error / lower.speed)
        return np.array(result)

    def warn(self, errors: np.ndarray, what: str) -> None:
        """Warn where an estimate exceeds the accuracy; `what` names the worst."""
        worst = np.max(np.nan_to_num(errors), initial=0.0)
        if self.left_out is None or worst <= self.accuracy:
            return
        bases = " and ".join(map(str, self.left_out.finer.bases))
        warnings.warn(
            f"{what} errs by about {worst:.2g} of its value, for {bases} are too few for the "
            f"accuracy of {self.accuracy:g}: {self._advice()}, give another accuracy=…, or None "
            "for no check",
            UserWarning,
            stacklevel=user_level(),
        )

    def _advice(self) -> str:
        if any(basis.lacks_flexibility for basis in self.left_out.finer.bases):
            return (
                "they lack flexibility at the interfaces; reduce the rotor with "
                "craig_bampton_modes(rotor, …), whose static modes have it"
            )
        return "reduce the rotor with more, up to twice as many"


def in_table(error: float, digits: int = 1) -> str:
    """Return an error as tables show it: '-' where it was not estimated."""
    return "-" if np.isnan(error) else f"{error:.{digits}e}"


def relative_errors(
    shifts: np.ndarray, growth: np.ndarray, frequencies: np.ndarray, speeds: np.ndarray
) -> np.ndarray:
    """Return the larger of the relative errors of frequency and growth, shape (s, k).

    Parameters
    ----------
    shifts : ndarray, shape (s, k)
        ``λ_full − λ`` [1/s].
    growth, frequencies : ndarray, shape (s, k)
        The latter in the inertial frame. A frequency counts as at least a tenth of the spin speed,
        a growth as at least a hundredth of the frequency. At rest, what neither oscillates nor
        grows has no relative error, NaN.
    speeds : ndarray, shape (s,)
        [rad/s]
    """
    least = np.maximum(np.abs(frequencies), _SLOW * np.abs(speeds)[:, None])
    sizes = np.maximum(np.abs(growth), _DAMPED * least)
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = np.abs(shifts.imag) / least, np.abs(shifts.real) / sizes
    errors = np.where(shifts == 0.0, 0.0, np.maximum(*parts))
    return np.where(np.isinf(errors), np.nan, errors)


def judged(
    frequencies: np.ndarray, growth: np.ndarray, speeds: np.ndarray, every: bool = False
) -> np.ndarray:
    """Return which modes (s, k) an analysis of all modes is judged by.

    Those up to twice the fastest speed in the inertial frame, and the lowest six that move, or all
    if these are fewer; the highest modes of a larger basis are always wrong. If `every`, all that
    move. Overdamped ones count up to decays of that size: a faster one is that of a damper on the
    mass next to it, of which a mesh has less, the finer it is.
    """
    moving = np.where(frequencies > 0.0, frequencies, np.inf)
    lowest = np.sort(moving, axis=1)[:, :_LOWEST][:, -1:]
    lowest = np.where(np.isfinite(lowest), lowest, frequencies.max(axis=1, keepdims=True))
    limit = np.maximum(lowest, _RANGE * np.abs(speeds).max(initial=0.0))
    overdamped = (frequencies == 0.0) & (-growth > limit)
    return ((frequencies <= limit) | every) & ~overdamped
