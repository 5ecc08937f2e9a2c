"""Linear supports of a rotor: bearings and springs at interfaces, in either frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.theory.rotating_axes import FRAMES, axial_skew, turned_harmonics

COEFFICIENTS = ("stiffness", "damping", "tilt_stiffness", "tilt_damping")
_GIVEN = (*COEFFICIENTS, "mass")
_SHAPES = ((), (2, 2), (3, 3))
_ROUNDING = 1e-6  # of the largest speed of a table: differences by the speed leave its end
Harmonics = dict[int, np.ndarray]
SpeedTable = tuple[ArrayLike, ArrayLike]
Coefficient = float | ArrayLike | SpeedTable | Callable[[float], ArrayLike]


class NoCoefficientsError(ValueError):
    """A support has no coefficients at a speed."""


class OutsideTableError(NoCoefficientsError):
    """A speed is beyond the end of a table."""


@dataclass(frozen=True, eq=False)
class Support:
    """Linear spring and damper between an interface and the ground.

    Parameters
    ----------
    interface : str
        Name of the interface whose mean displacement is supported.
    stiffness, damping : float, array_like, (speeds, values), or callable
        A number k stands for k in both directions across the axis; a 2 × 2 matrix acts across the
        axis, a 3 × 3 matrix also along it, both in the axes (n1, n2[, e]) of
        :attr:`SpinAxis.plane` [N/m], [N s/m]. A tuple of two, the speeds (s,) and the values
        (s,), (s, 2, 2) or (s, 3, 3), is a table: interpolated linearly over the spin speed
        [rad/s]. A callable takes the spin speed. Arrays are copied.
    tilt_stiffness, tilt_damping : same, optional
        Against the mean rotation of the interface about (n1, n2[, e]) [N m/rad], [N m s/rad].
    frame : {'inertial', 'rotor'}
        Whether the support stands still or turns with the rotor.
    extrapolate : bool, optional
        Whether analyses may use tables beyond their ends, with the value there; an error by
        default.
    mass : float, (speeds, values), or callable, optional
        Of a fluid that goes with the interface across the axis, alike in all directions [kg]; of
        supports that stand still.

    Raises
    ------
    TypeError
        If the interface is no name, the frame no word, or a coefficient not of these kinds.
    ValueError
        For an unknown frame, coefficients of the wrong shape or not finite, speeds of a table that
        do not ascend, and ``((a, b), (c, d))``, which may mean a matrix or a table: write a matrix
        as ``[[a, b], [c, d]]`` and a table as ``([a, b], [c, d])``.

    Examples
    --------
    A bearing that is softer along n1, and one whose stiffness grows with the speed:

    >>> from exudyn_rotor import Support
    >>> Support("left", [[1e7, 0.0], [0.0, 2e7]], damping=500.0).matrices(0.0)[0][:2, :2]
    array([[10000000.,        0.],
           [       0., 20000000.]])
    >>> float(Support("right", ([0.0, 1000.0], [1e7, 3e7])).matrices(500.0)[0][0, 0])
    20000000.0
    """

    interface: str
    stiffness: Coefficient = 0.0
    damping: Coefficient = 0.0
    tilt_stiffness: Coefficient = 0.0
    tilt_damping: Coefficient = 0.0
    frame: str = "inertial"
    extrapolate: bool = False
    mass: float | SpeedTable | Callable[[float], float] = 0.0

    def __post_init__(self) -> None:
        checks.label(self.interface, "interface")
        checks.flag(self.extrapolate, "extrapolate")
        checks.choice(self.frame, "frame", FRAMES)
        for name in _GIVEN:
            value = _kept(getattr(self, name), f"support at {self.interface!r}: {name}")
            object.__setattr__(self, name, value)
        _check_mass(self)

    def matrices(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness and damping at a spin speed [rad/s], each (6, 6).

        Rows: displacement along n1, n2, e, then rotation about them. A table keeps its last value
        beyond its end.
        """
        checks.number(speed, "speed", "rad/s")
        # the last speed with its matrices as one object, as threads share supports
        at, found = self.__dict__.get("_found", (None, None))
        if found is None or (at != speed and self.varies):
            found = self._matrices(speed)
            object.__setattr__(self, "_found", (speed, found))
        return found[0].copy(), found[1].copy()

    def _matrices(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        stiffness, damping = np.zeros((6, 6)), np.zeros((6, 6))
        stiffness[:3, :3] = self._matrix("stiffness", speed)
        stiffness[3:, 3:] = self._matrix("tilt_stiffness", speed)
        damping[:3, :3] = self._matrix("damping", speed)
        damping[3:, 3:] = self._matrix("tilt_damping", speed)
        return stiffness, damping

    def mass_at(self, speed: float) -> float:
        """Return the mass that goes with the interface at a spin speed [rad/s], in kg."""
        return float(self._matrix("mass", speed)[0, 0])

    def terms(self, speed: float) -> tuple[Harmonics, Harmonics]:
        """Return Fourier terms in θ of damping and stiffness seen from the rotor, each (6, 6).

        Raises
        ------
        NoCoefficientsError
            If the speed is beyond a table that may not be extrapolated, or a bearing has no
            equilibrium there.
        """
        damping, stiffness, carried = self.parts(speed)
        both = {n: speed * X for n, X in carried.items()}
        for n, X in stiffness.items():
            both[n] = both[n] + X if n in both else X
        return damping, both

    def parts(self, speed: float) -> tuple[Harmonics, Harmonics, Harmonics]:
        """Return what :meth:`terms` does, without Ω: of damping, stiffness, and stiffness per Ω.

        A support that stands still damps the inertial velocity: the rotor sees u_inertial =
        R(θ) u, whose rate is R(u̇ + Ω ẽ u), so part of the damping becomes a stiffness.
        """
        self.check_range(speed)
        stiffness, damping = self.matrices(speed)
        if self.frame == "rotor":
            return {0: damping}, {0: stiffness}, {}
        return tuple(turned_harmonics(X) for X in (damping, stiffness, damping @ axial_skew(6)))

    def undamped(self) -> Support:
        """Return the support without damping and without the skew part of its stiffness."""
        parts = {name: _symmetric(getattr(self, name)) for name in ("stiffness", "tilt_stiffness")}
        return replace(self, **parts, damping=0.0, tilt_damping=0.0)

    @property
    def stiffness_varies(self) -> bool:
        """True when a stiffness depends on the spin speed."""
        return varies(self.stiffness) or varies(self.tilt_stiffness)

    @property
    def varies(self) -> bool:
        """True when any coefficient depends on the spin speed."""
        return any(varies(getattr(self, name)) for name in _GIVEN)

    @property
    def pattern(self) -> tuple | None:
        """What supports have in common that differ in their numbers alone; None of others.

        Interface, frame, and which of their constant coefficients are zero, or the same in all
        directions.
        """
        if self.varies or acts(self.mass):
            return None
        told = [self.interface, self.frame]
        for X in self.matrices(0.0):
            told.append((X != 0.0).tobytes())
            for i in (0, 3):
                alike = X[i, i] == X[i + 1, i + 1] and X[i, i + 1] == -X[i + 1, i]
                told.append(bool(alike))
        return tuple(told)

    @property
    def table_speeds(self) -> np.ndarray:
        """Spin speeds of its tables [rad/s], at which its coefficients have kinks."""
        given = [getattr(self, name) for name in _GIVEN]
        return np.concatenate(
            [np.zeros(0), *(each[0] for each in given if isinstance(each, tuple))]
        )

    def check_range(self, speed: float) -> None:
        """Refuse a speed [rad/s] beyond the end of a table; rounding at the end is none.

        Raises
        ------
        TypeError, NoCoefficientsError
        """
        checks.number(speed, "speed", "rad/s")
        for name in () if self.extrapolate else _GIVEN:
            value = getattr(self, name)
            if hasattr(value, "check_range"):  # a bearing's
                value.check_range(speed)
            if not isinstance(value, tuple):
                continue
            slack = _ROUNDING * np.abs(value[0]).max()
            least, most = value[0][0] - slack, value[0][-1] + slack
            if not least <= speed <= most:
                raise OutsideTableError(
                    f"support at {self.interface!r}: the table of its {name} holds "
                    f"{value[0][0]:g} to {value[0][-1]:g} rad/s, not {speed:g} rad/s: give more of "
                    "it, or extrapolate=True to keep the value at its end"
                )

    def _matrix(self, name: str, speed: float) -> np.ndarray:
        """Return one coefficient as a 3 × 3 matrix in the axes (n1, n2, e)."""
        value = getattr(self, name)
        if callable(value):
            where = f"support at {self.interface!r}: {name} at {speed:g} rad/s"
            value = _coefficient(value(speed), where)
        elif isinstance(value, tuple):
            value = _interpolate(*value, speed)
        return _in_three_axes(value)


def _check_mass(support: Support) -> None:
    where = f"support at {support.interface!r}: mass"
    given = support.mass[1] if isinstance(support.mass, tuple) else support.mass
    if not callable(given) and np.ndim(given) != isinstance(support.mass, tuple):
        raise ValueError(f"{where} needs a number, alike in all directions, got a matrix")
    if acts(support.mass) and support.frame == "rotor":
        raise ValueError(f"{where} is of supports that stand still; give frame='inertial'")


def _symmetric(value: Coefficient) -> Coefficient:
    """Return a coefficient without its skew part."""
    if callable(value):
        return _SymmetricPart(value)
    if isinstance(value, tuple):
        return value[0], _symmetric_matrix(value[1])
    return _symmetric_matrix(value)


@dataclass(frozen=True, eq=False)
class _SymmetricPart:
    """Symmetric part of a coefficient by the speed; of a bearing's, where that is."""

    function: Callable[[float], ArrayLike]

    def __call__(self, speed: float) -> float | np.ndarray:
        return _symmetric_matrix(np.asarray(self.function(speed), dtype=float))

    def check_range(self, speed: float) -> None:
        if hasattr(self.function, "check_range"):
            self.function.check_range(speed)


def _symmetric_matrix(values: float | np.ndarray) -> float | np.ndarray:
    """Return the symmetric part of a matrix or a stack of them; numbers as they are."""
    if np.ndim(values) < 2:
        return values
    return 0.5 * (values + np.swapaxes(values, -1, -2))


def _kept(value: Coefficient, name: str) -> Coefficient:
    """Return a coefficient as it is kept: a function, a table, a number or a matrix."""
    if callable(value):
        return value
    if not isinstance(value, tuple) or len(value) != 2:
        return _coefficient(value, name, "; a table over the speed is a tuple, (speeds, values)")
    if all(isinstance(row, tuple) and len(row) == 2 for row in value):
        raise ValueError(
            f"{name}: {checks.shown(value)} may be a matrix or a table over the speed; write a "
            "matrix as [[a, b], [c, d]] and a table as ([speed, speed], [value, value])"
        )
    speeds = checks.ascending(value[0], f"{name}: the speeds of its table", "rad/s", of_table=True)
    values = checks.array(value[1], f"{name}: the values of its table")
    if values.shape[:1] != speeds.shape or values.shape[1:] not in _SHAPES:
        raise ValueError(
            f"{name}: the values of its table need {len(speeds)} numbers, 2 × 2 or 3 × 3 matrices, "
            f"as many as speeds, got shape {values.shape}"
        )
    return speeds, values


def _coefficient(value: ArrayLike, name: str, other: str = "") -> float | np.ndarray:
    """Return a number, or a matrix as a read-only array; refusals name what `other` there is."""
    if type(value) is float:
        return checks.number(value, name)
    try:
        array = checks.array(value, name)
    except TypeError as error:  # of lists that are no array, the speeds and values of a table
        raise TypeError(f"{error}{other}" if isinstance(value, list) else str(error)) from None
    if array.shape not in _SHAPES:
        raise ValueError(
            f"{name} needs a number, a 2 × 2 or a 3 × 3 matrix, got shape {array.shape}{other}"
        )
    return array if array.ndim else float(array)


def _in_three_axes(value: float | np.ndarray) -> np.ndarray:
    """Return a number or a matrix across the axis as a 3 × 3 matrix."""
    full = np.zeros((3, 3))
    if np.ndim(value) == 0:
        full[0, 0] = full[1, 1] = value
    else:
        full[: len(value), : len(value)] = value
    return full


def acts(value: Coefficient) -> bool:
    """Return whether a coefficient is not zero; a function is taken for one that is not."""
    if isinstance(value, float):
        return value != 0.0
    return callable(value) or bool(np.any(value[1] if isinstance(value, tuple) else value))


def varies(value: Coefficient) -> bool:
    """Return whether a coefficient depends on the speed."""
    return callable(value) or isinstance(value, tuple)


def _interpolate(speeds: np.ndarray, values: np.ndarray, speed: float) -> np.ndarray:
    """Interpolate a table over the spin speed; constant beyond its ends."""
    if len(speeds) == 1:
        return values[0]
    above = min(max(int(np.searchsorted(speeds, speed)), 1), len(speeds) - 1)
    low, high = speeds[above - 1], speeds[above]
    share = (speed - low) / (high - low)
    share = min(max(share, 0.0), 1.0)
    return (1.0 - share) * values[above - 1] + share * values[above]
