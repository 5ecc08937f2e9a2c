"""Following modes over spin speed by their shape and their signed frequency."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.linear.periodic.eigenvalues import repeated
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.threads import one_thread

# how strongly a jump in frequency counts against a likeness of shapes
_JUMP_WEIGHT = 0.5
# a frequency in the rotor frame moves by nΩ at most; waves up to four nodal diameters are allowed
_STEEPEST = 4.0
# a match is another mode below this likeness, or beyond this many steepest changes of frequency
_LEAST_LIKENESS, _MOST_CHANGES = 0.25, 2.0
_NO_FREQUENCY = 1e-7  # of the highest: a free motion


@dataclass(frozen=True, eq=False)
class Tracks:
    """Modes followed over the speeds.

    Attributes
    ----------
    columns : ndarray of int, shape (s, k)
        Which column continues each mode of the first speed.
    continued : ndarray of bool, shape (s, k)
        Whether it is the same mode as at the speed before.
    """

    columns: np.ndarray
    continued: np.ndarray


@one_thread()
def track(
    modes: Sequence[FloquetModes],
    speeds: np.ndarray,
    weigh: Callable[[np.ndarray], np.ndarray],
) -> Tracks:
    """Return which column continues each mode of the first speed.

    Neighbouring speeds are matched as a whole (assignment problem) by the mass-weighted modal
    assurance criterion ``|φᴴMψ|² / (φᴴMφ ψᴴMψ)`` and the distance of the signed frequencies. A
    frequency that passes zero in the rotor frame goes on as the conjugate motion; copies
    ``λ + ipΩ`` of a Floquet exponent count as one motion.

    Parameters
    ----------
    modes : sequence of FloquetModes
        One for each speed.
    speeds : ndarray, shape (s,)
        [rad/s]
    weigh : callable
        Multiplies vectors (c, k) by the mass matrix.
    """
    count = modes[0].values.size
    columns = np.empty((len(modes), count), dtype=np.int64)
    columns[0] = np.arange(count)
    continued = np.ones((len(modes), count), dtype=bool)
    signed = modes[0].values.imag.copy()
    last = _Motions.of(modes[0], weigh)
    for step in range(1, len(modes)):
        change = abs(speeds[step] - speeds[step - 1])
        frequencies, copies = zip(*_copies(modes[step], speeds[step], weigh), strict=True)
        frequencies, together = np.array(frequencies), _of_one_value(modes[step])
        before, after = last, copies
        if 0.0 in (speeds[step - 1], speeds[step]):
            # at rest nothing turns, and all harmonics are one motion
            before, after = last.together(), [copy.together() for copy in copies]
        likeness = np.array([before.likeness(copy) for copy in after])
        jump = np.abs(frequencies[:, None, :] - signed[:, None])
        allowed = _STEEPEST * change + 1e-3 * np.abs(signed[:, None]) + modes[step].resolution
        cost = 1.0 - likeness + _JUMP_WEIGHT * np.minimum(jump / allowed, 4.0)
        choice = np.argmin(cost, axis=0)
        rows, matched = linear_sum_assignment(np.min(cost, axis=0))
        columns[step, rows] = matched
        used = choice[rows, matched]
        same = (likeness if together is None else likeness @ together) >= _LEAST_LIKENESS
        same &= jump <= _MOST_CHANGES * allowed
        same |= _at_rest(signed)[:, None] & _at_rest(frequencies)[:, None, :]
        continued[step, rows] = same[used, rows, matched]
        signed = frequencies[used, matched]
        last = _Motions.chosen(copies, used, matched)
    return Tracks(columns, continued)


def _at_rest(frequencies: np.ndarray) -> np.ndarray:
    """Return True for free motions, whose shapes are arbitrary."""
    return np.abs(frequencies) <= _NO_FREQUENCY * np.abs(frequencies).max(axis=-1, keepdims=True)


def _of_one_value(modes: FloquetModes) -> np.ndarray | None:
    """Return 1 where two modes have one eigenvalue, so that their shapes are arbitrary, (k, k).

    None where all differ.
    """
    groups = repeated(modes.values, modes.resolution)
    if not groups:
        return None
    result = np.eye(modes.values.size)
    for group in groups:
        result[np.ix_(group, group)] = 1.0
    return result


@dataclass(frozen=True, eq=False)
class _Motions:
    """Harmonics of motions by their number: X (c, k), M X, and ``Σ XᴴMX`` (k,)."""

    vectors: dict[int, np.ndarray]
    weighed: dict[int, np.ndarray]
    norms: np.ndarray

    @classmethod
    def of(cls, modes: FloquetModes, weigh: Callable[[np.ndarray], np.ndarray]) -> _Motions:
        vectors = {int(m): X for m, X in zip(modes.orders, modes.vectors, strict=True)}
        return cls._of(vectors, {m: weigh(X) for m, X in vectors.items()})

    @classmethod
    def _of(cls, vectors: dict[int, np.ndarray], weighed: dict[int, np.ndarray]) -> _Motions:
        return cls(vectors, weighed, sum(_products(X, weighed[m]) for m, X in vectors.items()))

    @classmethod
    def chosen(cls, copies: Sequence[_Motions], used: np.ndarray, columns: np.ndarray) -> _Motions:
        """Return motions of which number i is column ``columns[i]`` of copy ``used[i]``."""
        parts: tuple[dict[int, np.ndarray], ...] = {}, {}
        for number, copy in enumerate(copies):
            if np.any(used == number):
                for part, given in zip(parts, (copy.vectors, copy.weighed), strict=True):
                    for m, X in given.items():
                        part[m] = part.get(m, 0.0) + X[:, columns] * (used == number)
        return cls(*parts, copies[0].norms[columns])

    def moved(self, shift: int) -> _Motions:
        """Return the same motions with a frequency ``shift·Ω`` higher."""
        parts = ({m - shift: X for m, X in part.items()} for part in (self.vectors, self.weighed))
        return _Motions(*parts, self.norms)

    def conjugate(self) -> _Motions:
        """Return the conjugate motions."""
        parts = ({-m: X.conj() for m, X in part.items()} for part in (self.vectors, self.weighed))
        return _Motions(*parts, self.norms)

    def together(self) -> _Motions:
        """Return the sum of all harmonics as one."""
        return _Motions._of({0: sum(self.vectors.values())}, {0: sum(self.weighed.values())})

    def likeness(self, other: _Motions) -> np.ndarray:
        """Return the modal assurance criterion of all pairs, shape (k, k)."""
        product = np.zeros((len(self.norms), len(other.norms)), dtype=complex)
        for m, X in self.vectors.items():
            if m in other.weighed:
                product += X.conj().T @ other.weighed[m]
        sizes = np.maximum(self.norms[:, None] * other.norms, 1e-300)
        return (product.real**2 + product.imag**2) / sizes


def _copies(
    modes: FloquetModes, speed: float, weigh: Callable[[np.ndarray], np.ndarray]
) -> Iterator[tuple[np.ndarray, _Motions]]:
    """Yield signed frequencies and harmonics of the same motions in their other forms."""
    motions = _Motions.of(modes, weigh)
    step = int(modes.orders[1] - modes.orders[0]) if len(modes.orders) > 1 else 0
    for shift in (-step, 0, step) if step else (0,):
        moved = motions.moved(shift)
        frequency = modes.values.imag + shift * speed
        yield frequency, moved
        yield -frequency, moved.conjugate()


def _products(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return ``Re Σ X̄Y`` of each column."""
    return np.sum(first.real * second.real + first.imag * second.imag, axis=0)
