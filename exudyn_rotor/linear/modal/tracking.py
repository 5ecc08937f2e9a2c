"""Following modes over spin speed by their shape and their signed frequency."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.threads import one_thread

# how strongly a jump in frequency counts against a likeness of shapes, in the rotor frame and seen
# from outside
_JUMP_WEIGHT, _SEEN_WEIGHT = 0.5, 0.5
# a frequency in the rotor frame moves by nΩ at most; waves up to four nodal diameters are allowed
_STEEPEST = 4.0
# a match is another mode below this likeness, or beyond this many steepest changes of frequency
_LEAST_LIKENESS, _MOST_CHANGES = 0.25, 2.0
_NO_FREQUENCY = 1e-7  # of the highest: a free motion
_ROUGH = 1e-6  # of a frequency
_TELLING = 0.1  # of the spin: roughness by which whole numbers of it are told
_MOST_ENTRIES = 1_000_000  # of the arrays of speeds that are matched at once


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


def joined_in_space(
    speeds: np.ndarray,
    rotor: np.ndarray,
    inertial: np.ndarray,
    diameters: np.ndarray,
    continued: np.ndarray,
) -> np.ndarray:
    """Return where the same wave of a mode is seen as at the speed before, shape (s, k).

    A mode that stands in the rotor frame is seen at ``ν + nΩ`` and ``ν − nΩ``. Where the stronger
    of the two becomes the weaker, its frequency seen from outside jumps by ``2nΩ``, while that of
    one wave changes by ``|Δν| + n|ΔΩ|`` at most. Where n is not known, or there are several, the
    whole number p of the frequency ``ν + pΩ`` must stay.

    Parameters
    ----------
    speeds : ndarray, shape (s,)
        Ω [rad/s].
    rotor, inertial : ndarray, shape (s, k)
        Frequencies ν ≥ 0 in the rotor frame and those seen from outside [rad/s].
    diameters : ndarray of int, shape (s, k)
        n, −1 where it is not known.
    continued : ndarray of bool, shape (s, k)
        Where a column is the same mode as at the speed before.
    """
    known = np.where(diameters < 0, _STEEPEST, np.maximum(diameters, 1))
    steepest = np.maximum(known[1:], known[:-1]) * np.abs(np.diff(speeds))[:, None]
    change, together = np.abs(np.diff(rotor, axis=0)), rotor[1:] + rotor[:-1]
    # where ν may pass zero, it goes on as the conjugate motion
    passes = together <= 2.0 * steepest
    change = np.where(passes, together, change)
    jump = np.abs(np.diff(inertial, axis=0))
    joined = continued.copy()
    joined[1:] &= jump <= change + steepest + _ROUGH * inertial[1:]
    unknown = (diameters[1:] < 0) | (diameters[:-1] < 0)
    joined[1:] &= ~unknown | _stays(speeds, rotor, inertial, passes)
    return joined


def _stays(
    speeds: np.ndarray, rotor: np.ndarray, inertial: np.ndarray, passes: np.ndarray
) -> np.ndarray:
    """Return where p of a frequency ``±(ν + pΩ)`` is that of the speed before, or not told.

    It changes its sign where ν passes zero.
    """
    spin = speeds[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        rough = _ROUGH * (1.0 + (inertial + rotor) / np.abs(spin))
        orders = (np.stack([inertial, -inertial]) - rotor) / spin
        whole = np.round(orders)
        told = (np.abs(orders - whole) <= rough) & (rough < _TELLING)
    first, second = whole[:, None, :-1], whole[None, :, 1:]
    same = (first == second) | (passes & (first == -second))
    same &= told[:, None, :-1] & told[None, :, 1:]
    every = told.any(axis=0)
    return same.any(axis=(0, 1)) | ~(every[1:] & every[:-1])


@one_thread()
def track(
    modes: Sequence[FloquetModes],
    speeds: np.ndarray,
    weigh: Callable[[np.ndarray], np.ndarray],
    waves: Callable[[np.ndarray], np.ndarray] | None = None,
    static: np.ndarray | None = None,
) -> Tracks:
    """Return which column continues each mode of the first speed.

    Neighbouring speeds are matched as a whole (assignment problem) by the mass-weighted modal
    assurance criterion ``|φᴴMψ|² / (φᴴMφ ψᴴMψ)`` and the distance of the signed frequencies. A
    frequency that passes zero in the rotor frame goes on as the conjugate motion; copies
    ``λ + ipΩ`` of a Floquet exponent count as one motion. Above its frequency a forward whirl turns
    backward in the rotor frame, in the shape of the backward one: what tells them apart in large
    steps is that frequencies seen from outside change little.

    Parameters
    ----------
    modes : sequence of FloquetModes
        One for each speed.
    speeds : ndarray, shape (s,)
        [rad/s]
    weigh : callable
        Multiplies vectors (c, k) by the mass matrix.
    waves : callable, optional
        Gives the mean wave numbers n (s, k) of motions (s, c, k): a wave that is seen at one
        frequency changes it by ``−nΔΩ`` in the rotor frame. Asked for only where equations do not
        change in time.
    static : ndarray of bool, shape (s, k), optional
        Which motions stand still in space: any of them goes on as another.
    """
    count = modes[0].values.size
    columns = np.empty((len(modes), count), dtype=np.int64)
    columns[0] = np.arange(count)
    continued = np.ones((len(modes), count), dtype=bool)
    constant = all(len(entry.orders) == 1 for entry in modes)
    steps = (
        _steps_of_constant(modes, speeds, weigh, waves)
        if constant
        else _steps_of_periodic(modes, speeds, weigh)
    )
    for step, (matched, same) in enumerate(steps, start=1):
        last = columns[step - 1]
        if static is not None:
            same = same | static[step - 1] & static[step][matched]
        columns[step], continued[step] = matched[last], same[last]
    return Tracks(columns, continued)


Steps = Iterator[tuple[np.ndarray, np.ndarray]]


def _steps_of_constant(
    modes: Sequence[FloquetModes],
    speeds: np.ndarray,
    weigh: Callable[[np.ndarray], np.ndarray],
    waves: Callable[[np.ndarray], np.ndarray] | None,
) -> Steps:
    """Yield which column continues each, and whether as the same mode, each (k,), step by step.

    Of equations that do not change in time. Only the relative sense of two motions matters.
    """
    size, count = modes[0].vectors.shape[1:]
    at_once = max(1, _MOST_ENTRIES // (count * max(size, count)))
    for first in range(0, len(modes) - 1, at_once):
        few = slice(first, first + at_once + 1)
        vectors = np.stack([entry.vectors[0] for entry in modes[few]])
        weighed = weigh(vectors.transpose(1, 0, 2).reshape(size, -1))
        weighed = weighed.reshape(size, -1, count).transpose(1, 0, 2)
        products = [X.swapaxes(1, 2) @ weighed[1:] for X in (vectors[:-1].conj(), vectors[:-1])]
        norms = _products(vectors, weighed)
        likeness = _criterion(np.stack(products, axis=1), norms[:-1, None], norms[1:, None])
        frequencies = np.array([entry.values.imag for entry in modes[few]])
        forms = np.stack([frequencies[1:], -frequencies[1:]], axis=1)
        changes, after = np.diff(speeds[few]), modes[few][1:]
        shifts = None if waves is None else -waves(vectors[:-1]) * changes[:, None]
        matched, _, same = _matched(likeness, frequencies[:-1], forms, changes, after, shifts)
        yield from zip(matched, same, strict=True)


def _steps_of_periodic(
    modes: Sequence[FloquetModes], speeds: np.ndarray, weigh: Callable[[np.ndarray], np.ndarray]
) -> Steps:
    """Yield what :func:`_steps_of_constant` does, for equations that repeat every revolution."""
    signed, last = modes[0].values.imag, _Motions.of(modes[0], weigh)
    for step in range(1, len(modes)):
        frequencies, copies = zip(*_copies(modes[step], speeds[step], weigh), strict=True)
        frequencies, before, after = np.array(frequencies), last, copies
        if 0.0 in (speeds[step - 1], speeds[step]):
            # at rest nothing turns, and all harmonics are one motion
            before, after = last.together(), [copy.together() for copy in copies]
        likeness = np.array([before.likeness(copy) for copy in after])
        change = speeds[step] - speeds[step - 1]
        given = likeness[None], signed[None], frequencies[None], np.array([change])
        matched, used, same = (each[0] for each in _matched(*given, [modes[step]]))
        yield matched, same
        forms = used[np.argsort(matched)]  # of each column here
        signed = np.take_along_axis(frequencies, forms[None], axis=0)[0]
        last = _Motions.chosen(copies, forms)


def _matched(
    likeness: np.ndarray,
    before: np.ndarray,
    frequencies: np.ndarray,
    changes: np.ndarray,
    modes: Sequence[FloquetModes],
    shifts: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return which columns continue those before, in which form, and whether as the same mode.

    Parameters
    ----------
    likeness : ndarray, shape (s, n, k, k)
        Of motions to n forms of those at the next speed.
    before, frequencies : ndarray, shapes (s, k) and (s, n, k)
        Signed, of the motions and of the forms [rad/s].
    changes : ndarray, shape (s,)
        Of the speed [rad/s].
    modes : sequence of FloquetModes
        Those at the next speeds.
    shifts : ndarray, shape (s, k), optional
        By which frequencies change that are seen from outside as before [rad/s].
    """
    values, resolution = (np.array([getattr(entry, name) for entry in modes])
                          for name in ("values", "resolution"))  # fmt: skip
    jump = np.abs(frequencies[:, :, None, :] - before[:, None, :, None])
    allowed = _STEEPEST * np.abs(changes)[:, None] + 1e-3 * np.abs(before) + resolution[:, None]
    cost = 1.0 - likeness + _JUMP_WEIGHT * np.minimum(jump / allowed[:, None, :, None], 4.0)
    if shifts is not None:
        seen = np.abs(frequencies[:, :, None, :] - (before + shifts)[:, None, :, None])
        steps = np.maximum(np.abs(changes), 1e-300)[:, None, None, None]
        cost += _SEEN_WEIGHT * np.minimum(seen / steps, 1.0)
    matched = np.array([linear_sum_assignment(each)[1] for each in cost.min(axis=1)])
    steps, rows = np.ogrid[: matched.shape[0], : matched.shape[1]]
    used = cost.argmin(axis=1)[steps, rows, matched]
    # shapes of modes with one eigenvalue are arbitrary
    alike = np.abs(values[:, :, None] - values[:, None]) <= resolution[:, None, None]
    alike = np.sum(likeness[steps, used, rows] * alike[steps, matched], axis=2)
    same = (alike >= _LEAST_LIKENESS) & (
        jump[steps, used, rows, matched] <= _MOST_CHANGES * allowed
    )
    return matched, used, same | _at_rest(before) & _at_rest(frequencies)[steps, used, matched]


def _at_rest(frequencies: np.ndarray) -> np.ndarray:
    """Return True for free motions, whose shapes are arbitrary."""
    return np.abs(frequencies) <= _NO_FREQUENCY * np.abs(frequencies).max(axis=-1, keepdims=True)


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
    def chosen(cls, copies: Sequence[_Motions], used: np.ndarray) -> _Motions:
        """Return motions of which number i is that of copy ``used[i]``."""
        parts: tuple[dict[int, np.ndarray], ...] = {}, {}
        for number, copy in enumerate(copies):
            if np.any(used == number):
                for part, given in zip(parts, (copy.vectors, copy.weighed), strict=True):
                    for m, X in given.items():
                        part[m] = part.get(m, 0.0) + X * (used == number)
        return cls(*parts, copies[0].norms)

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
        return _criterion(product, self.norms, other.norms)


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
    return np.sum(first.real * second.real + first.imag * second.imag, axis=-2)


def _criterion(products: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return the modal assurance criterion from ``XᴴMY`` (…, k, k) and both norms (…, k)."""
    sizes = np.maximum(first[..., :, None] * second[..., None, :], 1e-300)
    return (products.real**2 + products.imag**2) / sizes
