"""Records of the ground's acceleration: earthquakes, vehicles, shocks."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline, make_interp_spline

from exudyn_rotor import checks
from exudyn_rotor.storage import read_rows

UNITS = {"m/s²": 1.0, "g": 9.80665, "gal": 1e-2, "mm/s²": 1e-3}
_UNEVEN = 1e-3  # of a step: records print their times with some digits


@dataclass(frozen=True, eq=False)
class BaseRecord:
    """Acceleration of the whole ground over time; linear in between, zero before and after.

    The same for scenes (:func:`exudyn_rotor.add_base_motion`) and linear analyses
    (:func:`exudyn_rotor.base_response`). Motions are then those relative to the ground, so an
    acceleration whose velocity does not end at zero does no harm; see :attr:`end_velocity`.

    Parameters
    ----------
    times : array_like, shape (n,)
        Ascending in even steps [s].
    accelerations : array_like, shape (n, 3)
        Along x, y, z of the rotor's mesh at the spin angle 0 [m/s²].

    Raises
    ------
    TypeError, ValueError
        For times that run backwards or unevenly, fewer than two of them, and other shapes.

    Examples
    --------
    A half-sine shock of 5 g along x in 11 ms:

    >>> import numpy as np
    >>> from exudyn_rotor import BaseRecord
    >>> t = np.linspace(0.0, 0.011, 111)
    >>> pulse = 5.0 * 9.80665 * np.sin(np.pi * t / 0.011)
    >>> BaseRecord(t, np.outer(pulse, [1.0, 0.0, 0.0]))
    BaseRecord(111 samples in 0.011 s, peak 49.03 m/s², the ground ends at 0.3433 m/s)
    """

    times: np.ndarray
    accelerations: np.ndarray

    def __post_init__(self) -> None:
        times = checks.vector(self.times, "times", "s", size=None)
        if times.size < 2:
            raise ValueError(f"times: needs two or more [s], got {checks.shown(times)}")
        steps = np.diff(checks.ascending(times, "times", "s"))
        uneven = np.abs(steps - steps.mean()).max()
        if uneven > _UNEVEN * steps.mean():
            raise ValueError(
                f"times: needs even steps [s], got {steps.min():g} to {steps.max():g}; resample "
                "the record"
            )
        shape = (times.size, 3)
        given = checks.array(self.accelerations, "accelerations", "m/s²", shape=shape)
        even = checks.read_only(np.linspace(times[0], times[-1], times.size))
        checks.keep(self, times=even, accelerations=given)

    @classmethod
    def from_csv(cls, path: str | PathLike, unit: str) -> BaseRecord:
        """Read lines of time [s] and three accelerations, parted by comma, semicolon or space.

        In lines with semicolons a comma is that of decimals. Lines that begin with ``#``, and lines
        of names at the beginning, are left out.

        Parameters
        ----------
        path : path-like
        unit : {'m/s²', 'g', 'gal', 'mm/s²'}
            Of the accelerations.

        Raises
        ------
        TypeError, ValueError, OSError
            For bad input, other lines, and a file that is not there.
        """
        factor, rows = UNITS[checks.choice(unit, "unit", UNITS)], []
        for number, words in read_rows(path):
            try:
                rows.append([float(word) for word in words])
            except ValueError as error:
                if rows or words[0][:1] in "+-.0123456789":
                    raise ValueError(f"{path}, line {number}: {error}") from error
                continue  # names
            if len(words) != 4:
                raise ValueError(
                    f"{path}, line {number}: needs time and three accelerations, got "
                    f"{len(words)} numbers"
                )
        table = np.array(rows).reshape(-1, 4)
        return cls(table[:, 0], factor * table[:, 1:])

    def __repr__(self) -> str:
        """Return length, peak and where the velocity ends."""
        end = np.linalg.norm(self.end_velocity)
        return (
            f"BaseRecord({len(self.times)} samples in {np.ptp(self.times):.4g} s, peak "
            f"{self.peak:.4g} m/s², the ground ends at {end:.4g} m/s)"
        )

    @property
    def step(self) -> float:
        """Time between samples [s]."""
        return float(np.ptp(self.times) / (len(self.times) - 1))

    @property
    def peak(self) -> float:
        """Largest size of the acceleration [m/s²]."""
        return float(np.linalg.norm(self.accelerations, axis=1).max())

    @property
    def end_velocity(self) -> np.ndarray:
        """Velocity of the ground at the end, from rest, shape (3,) [m/s]."""
        return np.trapezoid(self.accelerations, self.times, axis=0)

    def with_baseline(self) -> BaseRecord:
        """Return the record less a constant and a slope, with which the ground ends at rest.

        They are those of least squares in the velocity.
        """
        t = self.times - self.times[0]
        velocity = self._curve.antiderivative()(self.times)
        drift = np.linalg.lstsq(np.column_stack([t, t**2]), velocity, rcond=None)[0]
        smooth = self.accelerations - drift[0] - 2.0 * np.outer(t, drift[1])
        corrected = BaseRecord(self.times, smooth)
        return BaseRecord(self.times, smooth - corrected.end_velocity / t[-1])

    def turned(self, rotation: ArrayLike) -> BaseRecord:
        """Return the record in other axes, into which `rotation` (3, 3) leads."""
        return BaseRecord(self.times, self.accelerations @ checks.rotation(rotation).T)

    def integrals(self, times: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Return velocity and displacement of the ground, from rest, each (t, 3)."""
        times = checks.vector(times, "times", "s", size=None)
        inside = np.clip(times, *self.times[[0, -1]])
        velocity, place = (self._curve.antiderivative(n)(inside) for n in (1, 2))
        return velocity, place + (times - inside)[:, None] * velocity

    @property
    def _curve(self) -> BSpline:
        """The acceleration over time, linear between the samples."""
        return make_interp_spline(self.times, self.accelerations, k=1)
