"""Harmonic balance of nonlinear laws on a linear rest, alternating between frequency and time.

With the motion q of the journals by harmonics up to K and N of the two phases of :mod:`.rest`, and
springs k₀ and dampers d₀ of the rest in place of the laws f,

    R(q) = q − q⁰ − H g = 0,    g = f(q, q̇, θ) + k₀ q + d₀ q̇,                               (1)

whose solutions do not depend on k₀ and d₀. Harmonics of g are taken from its values at the points
of a grid over both phases (T. M. Cameron, J. H. Griffin, J. Appl. Mech. 56 (1989), 149), and so is
its derivative,

    ∂g_m = Σ_n (Ĝ_{m−n} + iν_n Ĝ'_{m−n}) ∂q_n,

with the harmonics Ĝ, Ĝ' of ``k₀ + ∂f/∂q``, ``d₀ + ∂f/∂q̇``: Newton's method is exact. Harmonics
beyond K and N are ``H g``, too, with the mean of the derivative: they tell what is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.nonlinear.rest import Coupling, Rest, Waves

_PER_WAVE = 8  # points of the grid in the shortest wave
_FEWEST = 32  # points over a phase
_MOST_ITERATIONS = 30
_LEAST_SHARE = 1.0 / 64.0  # of a step of Newton's method
_MOST_STUCK = 4  # steps whose smallest share is no gain
_FREE = 1e-9  # share of the springs k₀ that counts as no stiffness
_STILL = 1e-12  # of the size of a motion: none


@dataclass(frozen=True, eq=False)
class Laws:
    """The nonlinear laws, and springs k₀ and dampers d₀ of the rest in their place."""

    bearings: Sequence[Bearing]
    names: Sequence[str]  # their interfaces, of trains with the rotor's name
    ratios: Sequence[float]  # spin speeds of their rotors over Ω
    springs: np.ndarray  # (d,)
    dampers: np.ndarray
    # elements that pass the load in a revolution: angles of the cage per second phase; 0 where laws
    # do not depend on it
    passes: float = 0.0

    def along(
        self, motion: np.ndarray, phi: np.ndarray, theta: np.ndarray, speed: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return forces f (t, b, 2) along a motion (t, b, 4), and ∂g (t, b, 2, 4).

        Cages of rolling bearings stand where the second phase φ says.
        """
        found = []
        for b, (bearing, ratio) in enumerate(zip(self.bearings, self.ratios, strict=True)):
            turns = self.passes and isinstance(bearing, RollingBearing)
            angles = ratio * (phi / self.passes if turns else theta)
            found.append(bearing.law_along(motion[:, b], angles, ratio * speed))
        forces, slopes = zip(*found, strict=True)
        k, d = (each.reshape(-1, 2)[..., None] * np.eye(2) for each in (self.springs, self.dampers))
        both = np.concatenate([k, d], axis=-1)
        return np.stack(forces, axis=1), both - np.stack(slopes, axis=1)


@dataclass(frozen=True, eq=False)
class Balance:
    """The equations (1) for the harmonics up to K and N, at one speed."""

    laws: Laws
    rest: Rest
    reach: tuple[int, int]  # K and N

    # ------------------------------------------------------------ harmonics and values

    @cached_property
    def orders(self) -> np.ndarray:
        """All (k, n), shape (h, 2), so that the reverse are the negatives."""
        return orders_of(self.reach)

    @cached_property
    def nu(self) -> np.ndarray:
        """Their frequencies (h,) [rad/s]."""
        return self.orders @ np.array(self.rest.rates)

    @cached_property
    def points(self) -> tuple[int, int]:
        """Of the grid over φ and θ/r."""
        acts = self.reach[0] or self.laws.passes, self.reach[1]
        each = zip(self.reach, acts, strict=True)
        return tuple(max(_PER_WAVE * top, _FEWEST) if any_ else 1 for top, any_ in each)

    @cached_property
    def phases(self) -> tuple[np.ndarray, np.ndarray]:
        """φ and θ at the points of the grid, (t,) each."""
        A, B = self.points
        phi, part = np.meshgrid(np.arange(A) / A, np.arange(B) / B, indexing="ij")
        turn = 2.0 * np.pi
        return turn * phi.ravel(), turn * self.rest.revolutions * part.ravel()

    @cached_property
    def _places(self) -> tuple[np.ndarray, np.ndarray]:
        return tuple(self.orders.T % np.array(self.points)[:, None])

    def values(self, c: np.ndarray) -> np.ndarray:
        """Return values (t, d) at the points of harmonics (h, d)."""
        spectrum = np.zeros((*self.points, c.shape[1]), dtype=complex)
        spectrum[self._places] = c
        values = np.fft.ifft2(spectrum, axes=(0, 1)).real * np.prod(self.points)
        return values.reshape(-1, c.shape[1])

    def spectrum(self, values: np.ndarray) -> np.ndarray:
        """Return all harmonics (A, B, …) of values (t, …)."""
        grid = values.reshape(*self.points, *values.shape[1:])
        return np.fft.fft2(grid, axes=(0, 1)) / np.prod(self.points)

    def harmonics(self, values: np.ndarray) -> np.ndarray:
        """Return the harmonics (h, …) up to K and N of values (t, …)."""
        return self.spectrum(values)[self._places]

    def motion(self, c: np.ndarray) -> np.ndarray:
        """Return displacements and velocities (t, b, 4) at the points of harmonics (h, d)."""
        q, v = self.values(c), self.values(1j * self.nu[:, None] * c)
        return np.concatenate([q.reshape(len(q), -1, 2), v.reshape(len(v), -1, 2)], axis=-1)

    def forces(self, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return g (t, d) at the points, and its derivative by motions (t, b, 2, 4)."""
        motion = self.motion(c)
        f, slopes = self.laws.along(motion, *self.phases, self.rest.speed)
        k, d = (each.reshape(-1, 2) for each in (self.laws.springs, self.laws.dampers))
        g = f + k * motion[..., :2] + d * motion[..., 2:]
        return g.reshape(len(g), -1), slopes

    @cached_property
    def given(self) -> np.ndarray:
        """q⁰ (h, d)."""
        found = np.zeros((len(self.orders), len(self.laws.springs)), dtype=complex)
        K, N = self.reach
        for (k, n), x in self.rest.motion().items():
            for m, C in self.rest.unloaded.journals.items():
                order = n + self.rest.revolutions * m
                if abs(order) <= N:
                    found[(k + K) * (2 * N + 1) + order + N] += C @ x
        return found

    @cached_property
    def receptances(self) -> dict[int, Coupling]:
        """H^p, with their places."""
        rest = self.rest
        return rest.unloaded.receptances(rest.rates, rest.revolutions, self.reach)

    def answered(self, g: np.ndarray) -> np.ndarray:
        """Return ``H g`` (h, d, …) for harmonics (h, d, …)."""
        found = np.zeros(g.shape, dtype=complex)
        for rows, columns, H in self.receptances.values():
            size = (len(columns), g.shape[1], -1)
            found[rows] += (H @ g[columns].reshape(size)).reshape(len(rows), *g.shape[1:])
        return found

    # ------------------------------------------------------------ equations

    def residual(self, c: np.ndarray) -> np.ndarray:
        """Return R (h, d)."""
        return c - self.given - self.answered(self.harmonics(self.forces(c)[0]))

    def linearised(self, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return R (h, d) and its derivative (hd, hd)."""
        h, d = c.shape
        g, slopes = self.forces(c)
        spectrum = self.spectrum(slopes)
        k, n = self.orders.T
        A, B = self.points
        across = (k[:, None] - k) % A, (n[:, None] - n) % B
        G = _by_displacement(spectrum[across], self.nu)
        J = np.eye(h * d) - self.answered(G).reshape(h * d, h * d)
        left = c - self.given - self.answered(self.harmonics(g))
        return left, J

    def solved(self, c: np.ndarray, tolerance: float = 1e-10) -> np.ndarray:
        """Return the solution of (1) near harmonics c (h, d), by Newton's method."""
        stuck = 0
        for _ in range(_MOST_ITERATIONS):
            left, J = self.linearised(c)
            try:
                step = real_part_of(np.linalg.solve(J, left.ravel()).reshape(c.shape))
            except np.linalg.LinAlgError:
                break
            size, share = np.linalg.norm(left), 1.0
            while share >= _LEAST_SHARE and np.linalg.norm(self.residual(c - share * step)) > size:
                share *= 0.5
            stuck += share < _LEAST_SHARE
            if stuck > _MOST_STUCK:
                break
            c = c - share * step
            if np.abs(step).max() <= tolerance * np.abs(c).max() + 1e-300:
                return c
        raise UnconvergedError("no steady motion of these frequencies was found")

    def coordinates(self, c: np.ndarray) -> Waves:
        """Return the harmonics (k,) of all coordinates of the rest, of both signs."""
        moved = self.rest.motion(self.orders.tolist(), self.harmonics(self.forces(c)[0]))
        return {order: self.rest.unloaded.basis @ x for order, x in moved.items()}

    def holds(self, c: np.ndarray) -> bool:
        """Return whether laws and rest hold the mean place of a motion: not in a clearance."""
        mean = _by_displacement(self.forces(c)[1].mean(axis=0), np.zeros(1))[:, 0]
        rows, _, H = self.receptances[0]
        H = H[list(rows).index(len(c) // 2)]
        return bool(np.linalg.norm(np.eye(len(mean)) - H @ mean, -2) > _FREE)

    # ------------------------------------------------------------ errors

    def left_out(self, c: np.ndarray) -> tuple[float, float]:
        """Return the size of harmonics beyond K, and beyond N, relative to the motion.

        First order in what is left out, on laws with their mean derivative. Contacts that turn
        against the spin may skip harmonics: those up to 15 are looked at.
        """
        g, slopes = self.forces(c)
        K, N = self.reach
        wide = tuple(max(2 * top, _FEWEST // 2 - 1) if top else 0 for top in (K, N))
        beyond = Balance(self.laws, self.rest, wide)
        k, n = beyond.orders.T
        out = (np.abs(k) > K) | (np.abs(n) > N)
        A, B = self.points
        spectrum = np.where(out[:, None], self.spectrum(g)[k % A, n % B], 0.0)
        moved = np.where(out[:, None], beyond.answered(spectrum) + beyond.given, 0.0)
        G = _by_displacement(slopes.mean(axis=0), beyond.nu).swapaxes(0, 1)
        rows, _, H = beyond.receptances[0]
        J = np.eye(c.shape[1]) - H @ G[rows]
        moved = np.linalg.solve(J, moved[rows][..., None])[..., 0]
        whirls = np.any(self.orders, axis=1)
        size = max(np.linalg.norm(c[whirls]), _STILL * np.linalg.norm(c), 1e-300)
        by_spin = np.abs(n) > N
        return tuple(float(np.linalg.norm(moved[one]) / size) for one in (~by_spin, by_spin))


def _by_displacement(slopes: np.ndarray, nu: np.ndarray) -> np.ndarray:
    """Return derivatives (…, d, h, d) by harmonics of displacements, of slopes (…, h, b, 2, 4)."""
    each = slopes[..., :2] + 1j * nu[:, None, None, None] * slopes[..., 2:]
    *rest, h, count, _, _ = each.shape
    found = np.zeros((*rest, count, 2, h, count, 2), dtype=complex)
    for b in range(count):
        found[..., b, :, :, b, :] = each[..., b, :, :].swapaxes(-3, -2)
    return found.reshape(*rest, 2 * count, h, 2 * count)


def orders_of(reach: tuple[int, int]) -> np.ndarray:
    """Return all (k, n) up to K and N, shape (h, 2)."""
    K, N = reach
    return np.array([(k, n) for k in range(-K, K + 1) for n in range(-N, N + 1)])


def padded(c: np.ndarray, reach: tuple[int, int], wanted: tuple[int, int]) -> np.ndarray:
    """Return harmonics (h, …) of one reach as those of another."""
    (K, N), (K2, N2) = reach, wanted
    grid = c.reshape(2 * K + 1, 2 * N + 1, *c.shape[1:])
    found = np.zeros((2 * K2 + 1, 2 * N2 + 1, *c.shape[1:]), dtype=complex)
    k, n = min(K, K2), min(N, N2)
    found[K2 - k : K2 + k + 1, N2 - n : N2 + n + 1] = grid[K - k : K + k + 1, N - n : N + n + 1]
    return found.reshape(-1, *c.shape[1:])


def real_part_of(c: np.ndarray) -> np.ndarray:
    """Return harmonics (h, …) of a real motion: rounding that is not real would grow."""
    return 0.5 * (c + c[::-1].conj())
