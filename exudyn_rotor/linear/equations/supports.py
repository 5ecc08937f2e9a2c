"""Linear supports of a rotor: bearings and springs at interfaces, in either frame."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import skew

FRAMES = ("inertial", "rotor")
SpeedTable = tuple[ArrayLike, ArrayLike]
Coefficient = float | ArrayLike | SpeedTable | Callable[[float], ArrayLike]


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
        :attr:`SpinAxis.plane` [N/m], [N s/m]. A pair (speeds (s,), values (s,), (s, 2, 2) or
        (s, 3, 3)) is interpolated linearly over the spin speed [rad/s]; a callable takes the spin
        speed.
    tilt_stiffness, tilt_damping : same, optional
        Against the mean rotation of the interface about (n1, n2[, e]) [N m/rad], [N m s/rad].
    frame : {'inertial', 'rotor'}
        Whether the support stands still or turns with the rotor.

    Raises
    ------
    ValueError
        For an unknown frame, or coefficients of the wrong shape or not finite.
    """

    interface: str
    stiffness: Coefficient = 0.0
    damping: Coefficient = 0.0
    tilt_stiffness: Coefficient = 0.0
    tilt_damping: Coefficient = 0.0
    frame: str = "inertial"

    def __post_init__(self) -> None:
        if self.frame not in FRAMES:
            raise ValueError(f"support frame {self.frame!r} is unknown; use 'inertial' or 'rotor'")
        for name in ("stiffness", "damping", "tilt_stiffness", "tilt_damping"):
            if not callable(getattr(self, name)):
                self._matrix(name, 0.0)

    def matrices(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness and damping at a spin speed [rad/s], each (6, 6).

        Rows: displacement along n1, n2, e, then rotation about them.
        """
        stiffness, damping = np.zeros((6, 6)), np.zeros((6, 6))
        stiffness[:3, :3] = self._matrix("stiffness", speed)
        stiffness[3:, 3:] = self._matrix("tilt_stiffness", speed)
        damping[:3, :3] = self._matrix("damping", speed)
        damping[3:, 3:] = self._matrix("tilt_damping", speed)
        return stiffness, damping

    def terms(self, speed: float) -> tuple[dict[int, np.ndarray], dict[int, np.ndarray]]:
        """Return Fourier terms in θ of damping and stiffness seen from the rotor, each (6, 6).

        A support that stands still damps the inertial velocity: the rotor sees u_inertial =
        R(θ) u, whose rate is R(u̇ + Ω ẽ u), so part of the damping becomes a stiffness.
        """
        stiffness, damping = self.matrices(speed)
        if self.frame == "rotor":
            return {0: damping}, {0: stiffness}
        carried = stiffness + speed * damping @ np.kron(np.eye(2), skew([0.0, 0.0, 1.0]))
        return turned_harmonics(damping), turned_harmonics(carried)

    def _matrix(self, name: str, speed: float) -> np.ndarray:
        """Return one coefficient as a 3 × 3 matrix in the axes (n1, n2, e)."""
        value = getattr(self, name)
        if callable(value):
            value = value(speed)
        elif isinstance(value, tuple):
            value = _interpolate(*value, speed)
        array = np.asarray(value, dtype=float)
        full = np.zeros((3, 3))
        if array.shape == ():
            full[0, 0] = full[1, 1] = array
        elif array.shape in ((2, 2), (3, 3)):
            full[: len(array), : len(array)] = array
        else:
            raise ValueError(
                f"support at {self.interface!r}: {name} needs a number, a 2 × 2 or a 3 × 3 "
                f"matrix, got shape {array.shape}"
            )
        if not np.all(np.isfinite(full)):
            raise ValueError(f"support at {self.interface!r}: {name} {value!r} is not finite")
        return full


def check_interfaces(supports: Iterable[Support], known: Iterable[str]) -> None:
    """Refuse a support at an interface that the rotor does not have.

    Raises
    ------
    ValueError
    """
    for support in supports:
        if support.interface not in known:
            raise ValueError(
                f"support at {support.interface!r}: no such interface; the rotor has: "
                f"{', '.join(known) or 'none'}"
            )


def _interpolate(speeds: ArrayLike, values: ArrayLike, speed: float) -> np.ndarray:
    """Interpolate a table over the spin speed; constant beyond its ends."""
    speeds, values = np.asarray(speeds, dtype=float), np.asarray(values, dtype=float)
    if not (np.all(np.isfinite(speeds)) and np.all(np.isfinite(values))):
        raise ValueError("support table: speeds and values must be finite numbers")
    if speeds.ndim != 1 or len(speeds) != len(values) or np.any(np.diff(speeds) <= 0.0):
        raise ValueError(
            f"support table: needs ascending speeds (s,) and as many values, got shapes "
            f"{speeds.shape} and {values.shape}"
        )
    flat = values.reshape(len(values), -1)
    columns = [np.interp(speed, speeds, column) for column in flat.T]
    return np.array(columns).reshape(values.shape[1:])


def axes_of(axis: SpinAxis) -> np.ndarray:
    """Return (n1, n2, e) as columns, shape (3, 3)."""
    return np.column_stack([axis.plane, axis.direction])


def turned_harmonics(matrix: np.ndarray) -> dict[int, np.ndarray]:
    """Return the Fourier terms of ``Rᵀ(θ) X R(θ)`` for a support seen from the rotor.

    R turns both triples of a (6, 6) matrix X about e by θ; the result holds the harmonics
    −2 … 2 of ``Σ X_n exp(i n θ)`` that are not zero.
    """
    angles = 2.0 * np.pi * np.arange(5) / 5.0
    turn = SpinAxis((0.0, 0.0, 1.0)).rotation
    samples = []
    for angle in angles:
        R = np.kron(np.eye(2), turn(angle))
        samples.append(R.T @ matrix @ R)
    spectrum = np.fft.fft(np.array(samples), axis=0) / 5.0
    largest = np.abs(matrix).max(initial=0.0)
    terms = {n: spectrum[n % 5] for n in range(-2, 3)}
    return {n: X for n, X in terms.items() if np.abs(X).max() > 1e-14 * largest}
