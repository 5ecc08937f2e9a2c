"""Harmonic balance of rolling bearings on a linear rest, in two frequencies.

With ψ the angle of a ball pass, ``ψ̇ = ZκΩ``, and the spin angle θ, the bearings move by

    q(ψ, θ) = Σ q_kn exp i(kψ + nθ),    |k| ≤ K, |n| ≤ N,                                   (1)

whether the two frequencies have a common period or not. The rest, rotor and all other supports
with springs k₀ in place of the contacts, answers harmonic by harmonic with its receptances H,
so that

    q_kn = q⁰_kn + Σ_p H^p_{k, n−p} g_{k, n−p},    g = f(q, ψ) + k₀ q,                       (2)

with q⁰ under weight and unbalance, f the force of the contacts on the inner rings, and p ≠ 0 where
the rotor is uneven. Harmonics of g are taken from values at the points of a grid over ψ and θ
(alternating frequency and time: T. M. Cameron, J. H. Griffin, J. Appl. Mech. 56 (1989), 149), and
Newton's method has the exact derivative at these points. Harmonics beyond K and N are
``H g``, too: one more step of Newton's method, with the mean of the derivative, tells how large
they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg

from exudyn_rotor.bearings.rolling import RollingBearing, contacts, depth_under
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.response.contact_rest import Harmonics, Rest

_MOST_ITERATIONS = 30
_LEAST_SHARE = 1.0 / 64.0  # of a step of Newton's method
_DAMPING = (1.0, 0.1)  # of k₀ over the highest frequency, with which a search begins
_ROUGH = 1e-3  # relative change by the last step there
_LOST = (
    "no steady motion with the ball pass and the spin as its only frequencies was found; try "
    "speeds in smaller steps, or the other way (downwards=…); a damped run of a scene shows what "
    "the rotor does"
)
_ROUNDING = 1e-14  # share of the clearance, or interference
_FREE = 1e-9  # share of the springs k₀ that counts as no stiffness
_STILL = 1e-10  # share of the mean place that is no motion: rounding, or solved no better
_UNSEEN = 0.03  # of the tolerance: harmonics that the force cannot make larger do not count


def unknowns(reach: tuple[int, int], bearings: int) -> int:
    """Return the number of unknowns of (2)."""
    K, N = reach
    return (2 * K + 1) * (2 * N + 1) * 2 * bearings


@dataclass(frozen=True, eq=False)
class ContactBalance:
    """The equations (2) for the harmonics up to K and N.

    Attributes
    ----------
    bearings : sequence of RollingBearing
    rest : Rest
    springs : ndarray, shape (d,)
        k₀ [N/m].
    given : mapping of (int, int) to ndarray (d,)
        q⁰.
    reach : (int, int)
        K and N.
    points : (int, int)
        Of the grid over ψ and θ.
    """

    bearings: Sequence[RollingBearing]
    rest: Rest
    springs: np.ndarray
    given: Harmonics
    reach: tuple[int, int]
    points: tuple[int, int]

    @classmethod
    def of(
        cls, bearings: Sequence[RollingBearing], rest: Rest, springs: np.ndarray,
        given: Harmonics, reach: tuple[int, int],
    ) -> ContactBalance:  # fmt: skip
        """Return the equations with a grid of eight points to the shortest wave."""
        K, N = reach
        return cls(bearings, rest, springs, given, reach, (max(8 * K, 32), 8 * N if N else 1))

    # ------------------------------------------------------------ harmonics and values

    @cached_property
    def orders(self) -> list[tuple[int, int]]:
        """All (k, n)."""
        K, N = self.reach
        return [(k, n) for k in range(-K, K + 1) for n in range(-N, N + 1)]

    @cached_property
    def _places(self) -> tuple[np.ndarray, np.ndarray]:
        return tuple(np.array(self.orders).T % np.array(self.points)[:, None])

    def values(self, c: np.ndarray) -> np.ndarray:
        """Return q (…, B, 2) at the points of harmonics (h, d)."""
        spectrum = np.zeros((*self.points, c.shape[1]), dtype=complex)
        spectrum[self._places] = c
        q = np.fft.ifft2(spectrum, axes=(0, 1)).real * np.prod(self.points)
        return q.reshape(*self.points, -1, 2)

    def _spectrum(self, values: np.ndarray) -> np.ndarray:
        return np.fft.fft2(values, axes=(0, 1)) / np.prod(self.points)

    def forces(self, c: np.ndarray) -> Harmonics:
        """Return g of (2) at harmonics c (h, d)."""
        g = self._spectrum(self.contacts(self.values(c))[1])[self._places]
        return dict(zip(self.orders, g, strict=True))

    def contacts(
        self, q: np.ndarray, psi: np.ndarray | None = None
    ) -> tuple[list[np.ndarray], np.ndarray, np.ndarray]:
        """Return loads of the elements, and g (…, d) with its derivative (…, B, 2, 2), at q.

        At angles ψ (…); those of the grid by default.
        """
        if psi is None:
            psi = 2.0 * np.pi * np.arange(self.points[0])[:, None] / self.points[0]
        found = [
            contacts(one, q[..., b, :], psi / (one.count * one.cage_ratio))
            for b, one in enumerate(self.bearings)
        ]
        loads, forces, tangents = (list(each) for each in zip(*found, strict=True))
        springs = self.springs.reshape(-1, 2)
        g = np.stack(forces, axis=-2) + springs * q
        slopes = springs[:, :, None] * np.eye(2) - np.stack(tangents, axis=-3)
        return loads, g.reshape(*q.shape[:-2], -1), slopes

    def answered(self, g: np.ndarray) -> np.ndarray:
        """Return ``H g`` of (2) (h, …) for harmonics (h, d, …), without those beyond K and N."""
        found = np.zeros(g.shape, dtype=complex)
        for rows, columns, H in self._receptances.values():
            found[rows] += np.einsum("hij,hj...->hi...", H, g[columns])
        return found

    @cached_property
    def _receptances(self) -> dict[int, tuple[list[int], list[int], np.ndarray]]:
        """Return H^p by p, with the rows and columns of (2)."""
        index = {order: row for row, order in enumerate(self.orders)}
        parts: dict[int, list[tuple[int, int, np.ndarray]]] = {}
        for (k, n), column in index.items():
            for p, H in self.rest.receptance(k, n).items():
                if (k, n + p) in index:
                    parts.setdefault(p, []).append((index[k, n + p], column, H))
        return {
            p: ([r for r, _, _ in part], [c for _, c, _ in part], np.array([H for *_, H in part]))
            for p, part in parts.items()
        }

    @cached_property
    def start(self) -> np.ndarray:
        """q⁰ as an array (h, d)."""
        zero = np.zeros(len(self.springs), dtype=complex)
        return np.array([self.given.get(order, zero) for order in self.orders])

    def padded(self, c: np.ndarray, reach: tuple[int, int]) -> np.ndarray:
        """Return harmonics (h, d) of another reach with these."""
        K, N = reach
        known = {
            (k, n): c[(k + K) * (2 * N + 1) + n + N]
            for k in range(-K, K + 1) for n in range(-N, N + 1)
        }  # fmt: skip
        zero = np.zeros(c.shape[1], dtype=complex)
        return np.array([known.get(order, zero) for order in self.orders])

    # ------------------------------------------------------------ solution

    def quasi_static(self) -> np.ndarray:
        """Return harmonics of a motion in which each load is on one element, wherever it is."""
        loads = self.springs.reshape(-1, 2) * self.values(self.start)
        sizes = np.linalg.norm(loads, axis=-1, keepdims=True)
        places = np.zeros_like(loads)
        for b, one in enumerate(self.bearings):
            size = sizes[..., b, :]
            far = np.maximum(one.clearance + depth_under(one, size), 0.0)
            places[..., b, :] = far * loads[..., b, :] / np.maximum(size, 1e-300)
        return self._spectrum(places.reshape(*self.points, -1))[self._places]

    def linear(self, c: np.ndarray) -> np.ndarray:
        """Return the motion by the mean stiffness at c, and by all forces there."""
        return c - self._step(*self._parts(c), mean=True)

    def _parts(self, c: np.ndarray, damper: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Return what (2) leaves at harmonics c (h, d), and the derivative of g at the points."""
        _, g, slopes = self.contacts(self.values(c))
        g = self._spectrum(g)[self._places] - damper * self._rates[:, None] * c
        return c - self.start - self.answered(g), slopes

    @cached_property
    def _rates(self) -> np.ndarray:
        """i times the frequencies of the harmonics (h,)."""
        return 1j * np.array(self.orders) @ [self.rest.passing, self.rest.speed]

    def _step(
        self, residual: np.ndarray, slopes: np.ndarray, damper: float = 0.0, mean: bool = False
    ) -> np.ndarray:
        """Return Newton's step (h, d); by the mean of the derivative alone, if `mean`."""
        h, d = residual.shape
        spectrum = self._spectrum(slopes)
        if mean:
            spectrum[1:], spectrum[:, 1:] = 0.0, 0.0
        k, n = np.array(self.orders).T
        A, B = self.points
        each = spectrum[(k[:, None] - k) % A, (n[:, None] - n) % B]  # (h, h, bearings, 2, 2)
        J = np.zeros((h, d, h, d), dtype=complex)
        for b in range(d // 2):
            pair = slice(2 * b, 2 * b + 2)
            J[:, pair, :, pair] = each[:, :, b].transpose(0, 2, 1, 3)
        places = np.arange(h)
        for i in range(d):
            J[places, i, places, i] -= damper * self._rates
        J = np.eye(h * d) - self.answered(J).reshape(h * d, h * d)
        try:
            step = np.linalg.solve(J, residual.ravel()).reshape(h, d)
        except np.linalg.LinAlgError:
            raise UnconvergedError(_LOST) from None
        return 0.5 * (step + step[::-1].conj())  # rounding that is not real would grow

    def damped(self) -> np.ndarray:
        """Return harmonics reached from those of more damping, which is taken away in steps.

        Raises
        ------
        UnconvergedError
        """
        c, fastest = self.quasi_static(), max(np.abs(self._rates).max(), 1.0)
        for share in _DAMPING:
            c = self.solved(c, _ROUGH, share * self.springs.max() / fastest)
        return c

    def solved(self, c: np.ndarray, tolerance: float, damper: float = 0.0) -> np.ndarray:
        """Return harmonics whose last change was less than `tolerance` of them, beginning at c.

        With a damper [N s/m] more in each bearing.

        Raises
        ------
        UnconvergedError
        """
        rounding = _ROUNDING * max(abs(one.clearance) for one in self.bearings)
        for _ in range(_MOST_ITERATIONS):
            residual, slopes = self._parts(c, damper)
            step = self._step(residual, slopes, damper)
            size, share = np.linalg.norm(residual), 1.0
            while np.linalg.norm(self._parts(c - share * step, damper)[0]) > size:
                share *= 0.5
                if share < _LEAST_SHARE:
                    break
            c = c - share * step
            if np.abs(step).max() <= tolerance * np.abs(c).max() + rounding:
                return c
        raise UnconvergedError(_LOST)

    def holds(self, c: np.ndarray) -> bool:
        """Return whether contacts and rest hold the mean place of a motion: not in a clearance."""
        mean = scipy.linalg.block_diag(*self.contacts(self.values(c))[2].mean(axis=(0, 1)))
        H = self.rest.receptance(0, 0)[0]
        return bool(np.linalg.norm(np.eye(len(mean)) - H @ mean, -2) > _FREE)

    # ------------------------------------------------------------ errors

    def distance(self, c: np.ndarray, right: np.ndarray) -> float:
        """Return how far apart two motions get, relative to how far the right one gets."""
        away = np.linalg.norm(self.values(c) - self.values(right), axis=-1).max()
        q = self.values(right)
        way = np.linalg.norm(q - q.mean(axis=(0, 1)), axis=-1).max()
        still = _STILL * np.linalg.norm(q, axis=-1).max()
        return float(away / way) if way > still else 0.0

    def left_out(self, c: np.ndarray, tolerance: float) -> tuple[float, float]:
        """Return the root of the mean square of harmonics beyond K and of those beyond N.

        Relative to that of the motion without its mean; first order in what is left out, on
        contacts with their mean stiffness.
        """
        _, g, slopes = self.contacts(self.values(c))
        mean = scipy.linalg.block_diag(*slopes.mean(axis=(0, 1)))
        size = np.linalg.norm(c[[order != (0, 0) for order in self.orders]])
        size = max(size, _STILL * np.linalg.norm(c))
        if size == 0.0:
            return 0.0, 0.0
        largest = max(np.abs(_on(mean, H, H)).max() for *_, H in self._receptances.values())
        squares = [0.0, 0.0]
        beyond = self._beyond(self._spectrum(g), _UNSEEN * tolerance * size / largest)
        for (k, n), q in beyond.items():
            moved = _on(mean, self.rest.receptance(k, n)[0], q)
            squares[int(abs(n) > self.reach[1])] += np.linalg.norm(moved) ** 2
        return tuple(np.sqrt(squares) / size)

    def _beyond(self, spectrum: np.ndarray, least: float) -> dict[tuple[int, int], np.ndarray]:
        """Return the motions (d,) beyond K and N by g; by its harmonics there above the least."""
        (A, B), inside = self.points, set(self.orders)
        beyond = {order: q for order, q in self.given.items() if order not in inside}
        sizes = np.abs(spectrum).max(axis=-1)
        for k in range(-(A // 2 - 1), A // 2):
            for n in range(-((B - 1) // 2), (B - 1) // 2 + 1):
                if (k, n) not in inside and sizes[k % A, n % B] <= least:
                    continue
                for p, H in self.rest.receptance(k, n).items():
                    if (k, n + p) not in inside:
                        more = H @ spectrum[k % A, n % B]
                        beyond[k, n + p] = beyond.get((k, n + p), 0.0) + more
        return beyond


def _on(slopes: np.ndarray, H: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return motions q (…, d) by springs k₀ as they are by the contacts, of ``k₀ − k`` (d, d)."""
    return np.linalg.solve(np.eye(len(slopes)) - H @ slopes, q)
