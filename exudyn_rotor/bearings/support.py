"""Linear supports of a rotor: bearings and springs at interfaces, in either frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.coefficient_table import CoefficientTable, outside, read_columns, rows_of
from exudyn_rotor.theory.rotating_axes import FRAMES

COEFFICIENTS = ("stiffness", "damping", "tilt_stiffness", "tilt_damping")
_GIVEN = (*COEFFICIENTS, "mass")
_SHAPES = ((), (2, 2), (3, 3))
_WITH_TILTS = (*_SHAPES, (6, 6))  # of displacement and rotation
SpeedTable = tuple[ArrayLike, ArrayLike]
Coefficient = float | ArrayLike | SpeedTable | CoefficientTable | Callable[[float], ArrayLike]


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
        :attr:`SpinAxis.plane` [N/m], [N s/m]; a 6 × 6 matrix couples displacement and rotation.
        A tuple of two, the speeds (s,) and the values (s,), (s, 2, 2), (s, 3, 3) or (s, 6, 6), is
        a table over the spin speed [rad/s], interpolated smoothly without overshoot. A callable
        takes the spin speed. Arrays are copied. :meth:`from_table` has tables over the frequency.
    tilt_stiffness, tilt_damping : same but for 6 × 6, optional
        Against the mean rotation of the interface about (n1, n2[, e]) [N m/rad], [N m s/rad].
    frame : {'inertial', 'rotor'}
        Whether the support stands still or turns with the rotor.
    extrapolate : bool, optional
        Whether analyses may use tables beyond their ends, with the value there; an error by
        default.
    mass : same as stiffness, optional
        Of a fluid that goes with the interface [kg]; of supports that stand still.

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
    mass: Coefficient = 0.0
    _symmetric: ClassVar[bool] = False  # whether skew parts are left out

    def __post_init__(self) -> None:
        checks.label(self.interface, "interface")
        checks.flag(self.extrapolate, "extrapolate")
        checks.choice(self.frame, "frame", FRAMES)
        for name in _GIVEN:
            shapes = _SHAPES if name.startswith("tilt") else _WITH_TILTS
            value = _kept(getattr(self, name), f"support at {self.interface!r}: {name}", shapes)
            object.__setattr__(self, name, value)
        if self.frame == "rotor" and (acts(self.mass) or self.over_frequency):
            what = "mass" if acts(self.mass) else "coefficients over the frequency"
            raise ValueError(
                f"support at {self.interface!r}: {what}: is for supports that stand still; give "
                "frame='inertial'"
            )

    @classmethod
    def from_table(
        cls,
        interface: str,
        *,
        speeds: ArrayLike | None = None,
        frequencies: ArrayLike | None = None,
        stiffness: ArrayLike | None = None,
        damping: ArrayLike | None = None,
        mass: ArrayLike | None = None,
        extrapolate: bool = False,
    ) -> Support:
        """Return a support with coefficients over the spin speed, the frequency, or both.

        Linear analyses take each motion's own pair: of unbalance and of critical speeds the
        frequency is the spin speed, of a harmonic load it is the load's, of a free motion the
        imaginary part of its eigenvalue. Between the points the coefficients are smooth and do not
        overshoot (PCHIP). Beyond the frequencies they keep the value at the end, with a warning;
        beyond the speeds there are none.

        Parameters
        ----------
        interface : str
            Name of the interface whose mean displacement is supported.
        speeds : array_like, shape (s,), optional
            Ascending spin speeds [rad/s].
        frequencies : array_like, shape (f,), optional
            Ascending frequencies ≥ 0 of the motion [rad/s], seen from outside.
        stiffness, damping, mass : array_like, shape (s, f, k, k), optional
            K, D and M of the force ``−K x − D ẋ − M ẍ`` [N/m], [N s/m], [kg], with k = 2 across the
            axis, 3 also along it, or 6 with the rotations, along and about (n1, n2, e). Without
            speeds or without frequencies that axis is missing.
        extrapolate : bool, optional
            Whether analyses may use values at the ends beyond them, without warning or error.

        Raises
        ------
        TypeError, ValueError
            For points that do not ascend, negative frequencies, and matrices of other shapes.

        Examples
        --------
        >>> import numpy as np
        >>> from exudyn_rotor import Support
        >>> stiffness = [[[1e7, 2e6], [-2e6, 1e7]], [[3e7, 0.0], [0.0, 3e7]]]
        >>> seal = Support.from_table("disc", frequencies=[0.0, 100.0], stiffness=stiffness)
        >>> seal.matrices(speed=300.0, frequency=50.0)[0][:2, :2]
        array([[20000000.,  1000000.],
               [-1000000., 20000000.]])
        """
        where = f"support at {checks.label(interface, 'interface')!r}"
        tables = {
            name: CoefficientTable.of(
                f"{where}: {name}", speeds, frequencies, values, _WITH_TILTS[1:]
            )
            for name, values in (("stiffness", stiffness), ("damping", damping), ("mass", mass))
            if values is not None
        }
        return cls(interface, **tables, extrapolate=extrapolate)

    @classmethod
    def from_columns(
        cls, interface: str, source: str | Path | Any, *, extrapolate: bool = False
    ) -> Support:
        """Return a support with the coefficients of a text file or a pandas table, by columns.

        Columns are ``speed``, ``frequency`` or both, with a unit in brackets, as in
        ``speed [rpm]`` or ``frequency (Hz)``, rad/s by default, and coefficients, SI by default:
        ``kxx``, ``kxy``, …, ``cxx``, … and ``mxx``, …, with x, y, z along (n1, n2, e) and a, b, c
        about them. ``rpm`` and ``w`` are speeds, too. Units in brackets, as in ``Kxx [kN/mm]``, are
        read as well; other ones are refused. Without a column are zero: all of one kind, both
        cross terms, what acts along the axis or on tilts; ``kxx`` without ``kyy`` is refused.
        Files of ROSS and of XLTRC are such tables; of ROSS's ``BearingElement`` the array
        ``frequency`` is the spin speed in synchronous analyses: name its column ``speed``.

        Parameters
        ----------
        interface : str
        source : str, Path, pandas.DataFrame or mapping
            A file has one line of headers, and values between commas, semicolons, tabs or spaces.
        extrapolate : bool, optional
            See :meth:`from_table`.

        Raises
        ------
        TypeError, ValueError, OSError
            For unknown headers and units, what is no number, rows that do not make a grid of
            speeds and frequencies, and a file that is not there.

        Examples
        --------
        >>> from exudyn_rotor import Support
        >>> table = {"speed [rpm]": [3e3, 6e3], "kxx": [1e7, 2e7], "kyy": [1e7, 2e7]}
        >>> bearing = Support.from_columns("left", table)
        >>> bearing.stiffness.speeds.round(2)
        array([314.16, 628.32])
        """
        return cls.from_table(interface, **read_columns(source), extrapolate=extrapolate)

    def at_frequency(self, frequency: float) -> Support:
        """Return the support with the coefficients of one frequency [rad/s], as scenes take it."""
        checks.number(frequency, "frequency", "rad/s", least=0.0)
        parts = {
            name: value.at_frequency(frequency)
            for name in _GIVEN
            if isinstance(value := getattr(self, name), CoefficientTable)
        }
        return replace(self, **parts)

    def matrices(
        self, speed: ArrayLike, frequency: ArrayLike | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness and damping at a spin speed and a frequency [rad/s], each (6, 6).

        At speeds (s,), with frequencies (s,), it returns stacks (s, 6, 6). Rows: displacement along
        n1, n2, e, then rotation about them. A table keeps its last value beyond its end. The
        frequency is the size of the spin speed by default.
        """
        pair = _pair(speed, frequency)
        found = []
        for name, tilts in (("stiffness", "tilt_stiffness"), ("damping", "tilt_damping")):
            found.append(self._matrix(name, *pair))
            if acts(getattr(self, tilts)):
                found[-1][..., 3:, 3:] += self._matrix(tilts, *pair)[..., :3, :3]
        return found[0], found[1]

    def mass_matrix(self, speed: ArrayLike, frequency: ArrayLike | None = None) -> np.ndarray:
        """Return the mass that goes with the interface, (6, 6), as :meth:`matrices` does."""
        return self._matrix("mass", *_pair(speed, frequency))

    def undamped(self) -> Support:
        """Return the support without damping and without the skew part of its stiffness."""
        made = replace(self, damping=0.0, tilt_damping=0.0)
        checks.keep(made, _symmetric=True)
        return made

    @property
    def stiffness_varies(self) -> bool:
        """True when a stiffness depends on the spin speed."""
        return varies(self.stiffness) or varies(self.tilt_stiffness)

    @property
    def varies(self) -> bool:
        """True when any coefficient depends on the spin speed."""
        return any(varies(getattr(self, name)) for name in _GIVEN)

    @property
    def over_frequency(self) -> bool:
        """True when a coefficient depends on the frequency of a motion."""
        return any(table.frequencies is not None for table in self._tables)

    @property
    def tilts(self) -> bool:
        """True when anything acts on or by the rotation of the interface."""
        return acts(self.tilt_stiffness) or acts(self.tilt_damping) or self.couples

    @property
    def couples(self) -> bool:
        """True when a 6 × 6 matrix couples displacement and rotation."""
        given = (getattr(self, name) for name in _GIVEN)
        return any(np.shape(getattr(one, "values", one))[-2:] == (6, 6) for one in given)

    @property
    def _tables(self) -> list[CoefficientTable]:
        given = (getattr(self, name) for name in _GIVEN)
        return [each for each in given if isinstance(each, CoefficientTable)]

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
        """Spin speeds of its tables [rad/s], at which the curvature of coefficients jumps."""
        given = [each.speeds for each in self._tables if each.speeds is not None]
        return np.concatenate([np.zeros(0), *given])

    @property
    def table_frequencies(self) -> np.ndarray:
        """Frequencies of its tables [rad/s]."""
        given = [each.frequencies for each in self._tables if each.frequencies is not None]
        return np.concatenate([np.zeros(0), *given])

    def check_range(self, speed: float) -> None:
        """Refuse a speed [rad/s] beyond the end of a table; rounding at the end is none.

        Raises
        ------
        TypeError, NoCoefficientsError
        """
        checks.number(speed, "speed", "rad/s")
        for name in () if self.extrapolate else _GIVEN:
            value = getattr(self, name)
            check = getattr(value, "check_range", None)  # a bearing's
            if check is not None:
                check(speed)
            speeds = value.speeds if isinstance(value, CoefficientTable) else None
            wrong = "" if speeds is None else outside(speeds, speed)
            if wrong:
                raise OutsideTableError(
                    f"support at {self.interface!r}: the table of its {name} {wrong}"
                )

    def _matrix(self, name: str, speed: ArrayLike, frequency: ArrayLike) -> np.ndarray:
        """Return one coefficient as a 6 × 6 matrix; rotations of tilts stand in its first block."""
        value = getattr(self, name)
        if callable(value) and np.ndim(speed):
            return np.array([self._matrix(name, each, 0.0) for each in speed.tolist()])
        if callable(value):
            where = f"support at {self.interface!r}: {name} at {speed:g} rad/s"
            value = _coefficient(value(speed), where, shapes=_SHAPES)
        elif isinstance(value, CoefficientTable):
            value = value.at(speed, frequency)
        value = np.asarray(value)
        full = np.zeros((*np.shape(speed), 6, 6))
        if value.ndim > full.ndim - 2:
            size = value.shape[-1]
            full[..., :size, :size] = value
        else:
            full[..., 0, 0] = full[..., 1, 1] = value
        return 0.5 * (full + np.swapaxes(full, -1, -2)) if self._symmetric else full


def _pair(speed: ArrayLike, frequency: ArrayLike | None) -> tuple[Any, Any]:
    """Return spin speeds and frequencies, by default those of unbalance, checked."""
    if np.ndim(speed):
        speed = checks.vector(speed, "speed", "rad/s", None)
        if frequency is None:
            return speed, np.abs(speed)
        return speed, checks.vector(frequency, "frequency", "rad/s", len(speed))
    checks.number(speed, "speed", "rad/s")
    if frequency is None:
        return speed, abs(speed)
    return speed, checks.number(frequency, "frequency", "rad/s")


def _kept(value: Coefficient, name: str, shapes: tuple) -> Coefficient:
    """Return a coefficient as it is kept: a function, a table, a number or a matrix."""
    if callable(value) or isinstance(value, CoefficientTable):
        return value
    if not isinstance(value, tuple) or len(value) != 2:
        return _coefficient(value, name, "; a table over the speed is (speeds, values)", shapes)
    if all(isinstance(row, tuple) and len(row) == 2 for row in value):
        raise ValueError(
            f"{name}: {checks.shown(value)} may be a matrix or a table over the speed; write a "
            "matrix as [[a, b], [c, d]] and a table as ([speed, speed], [value, value])"
        )
    return CoefficientTable.of(name, value[0], None, value[1], shapes)


def _coefficient(
    value: ArrayLike, name: str, other: str = "", shapes: tuple = _WITH_TILTS
) -> float | np.ndarray:
    """Return a number, or a matrix as a read-only array; refusals name what `other` there is."""
    if type(value) is float:
        return checks.number(value, name)
    try:
        array = checks.array(value, name)
    except TypeError as error:
        raise TypeError(f"{error}{other}" if isinstance(value, list) else str(error)) from None
    if array.shape not in shapes:
        raise ValueError(
            f"{name} needs a number or a matrix of {rows_of(shapes)} rows, got shape "
            f"{array.shape}{other}"
        )
    return array if array.ndim else float(array)


def acts(value: Coefficient) -> bool:
    """Return whether a coefficient is not zero; a function is taken for one that is not."""
    if isinstance(value, float):  # asked for at every instant of a table over the speed
        return value != 0.0
    return callable(value) or bool(np.any(getattr(value, "values", value)))


def varies(value: Coefficient) -> bool:
    """Return whether a coefficient depends on the speed."""
    return callable(value) or isinstance(value, CoefficientTable)
