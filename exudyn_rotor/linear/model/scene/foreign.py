"""What of Exudyn is neither the rotor nor attached to it, linearised at the angles of a revolution.

Differences of Exudyn's forces are taken by the unknowns. Springs and dampers have the same
derivatives at every speed, which one direction tells: then they are not taken again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.linear.equations import Terms, UnconvergedError
from exudyn_rotor.linear.model.scene.probe import Probe
from exudyn_rotor.linear.model.scene.seen import Seen

_FEW, _MOST = 7, 112  # angles of a revolution
_SAME = 1e-5  # share of a force by which its change may miss what derivatives tell
_SKEW = 1e-9  # share of a matrix of differences whose skew part is rounding
_LEAST = 1e-9  # share of Fourier terms that is
_NOISE = 1e-9  # of what laws resist, which Exudyn's forces have and which is taken from these
_BETWEEN = 1.2345  # rad, an angle between those of samples


@dataclass(frozen=True, eq=False)
class Foreign:
    """Less the derivatives by y and its rate held along T(θ), as Fourier terms (n, k, k)."""

    K: np.ndarray
    D: np.ndarray
    steps: tuple[float, float] = (1.0, 1.0)  # of the differences [m], [m/s]

    @classmethod
    def of(cls, probe: Probe, seen: Seen, z: np.ndarray) -> Foreign:
        """Return the derivatives about a motion that stands still, by coordinates z (l,).

        Raises
        ------
        UnconvergedError
            Where 112 angles of a revolution do not resolve them.
        """
        count = _FEW
        while count <= _MOST:
            angles = 2.0 * np.pi * np.arange(count) / count
            points = [_slopes(probe, seen, theta, z) for theta in angles]
            K, D = (np.fft.fft(X, axis=0) / count for X in zip(*points, strict=True))
            found = cls(K, D, (probe.step or 1.0, probe.velocity_step or 1.0))
            if found.holds(probe, seen, z):
                return found
            count *= 2
        raise UnconvergedError(
            f"linear scene at {probe.speed:g} rad/s: {_MOST} angles of a revolution do not resolve "
            "the coefficients; is there a stop, contact or friction?"
        )

    def at(self, theta: float) -> tuple[np.ndarray, np.ndarray]:
        """Return K and D (k, k) at an angle."""
        orders = np.fft.fftfreq(len(self.K), 1.0 / len(self.K))
        waves = np.exp(1j * orders * theta)
        return tuple(np.tensordot(waves, X, 1).real for X in (self.K, self.D))

    def holds(self, probe: Probe, seen: Seen, z: np.ndarray) -> bool:
        """Return whether the force at the speed of a probe changes as the derivatives tell.

        At one angle along one direction, by motion and rate.
        """
        T, x, v = _state(probe, seen, _BETWEEN, z)
        d = np.cos(1.0 + np.arange(len(probe.masses))) * probe.scene.metre(probe.masses)
        for along, step, X in zip((0, 1), self.steps, self.at(_BETWEEN), strict=True):
            moves = np.zeros((2, len(x)))
            moves[along] = step * T @ d
            ends = [_force(probe, _BETWEEN, x + s * moves[0], v + s * moves[1]) for s in (1, -1)]
            told, found = 2.0 * step * X @ d, T.T @ (ends[1] - ends[0])
            most = np.maximum(np.abs(told).max(), np.abs(found).max())
            rounding = _NOISE * step * probe.resisting[along] * np.abs(d).max()
            if np.abs(found - told).max() > _SAME * most + rounding:
                return False
        return True

    def terms(
        self, probe: Probe, seen: Seen, speed: float, undamped: np.ndarray | None
    ) -> tuple[Terms, Terms]:
        """Return the Fourier terms of damping and stiffness by the coordinates z, (l, l).

        Without damping `undamped` are their rates over Ω as seen from outside, (l, l).
        """
        count = len(self.K) if speed else 1
        samples = [
            self._acting(probe, seen, 2.0 * np.pi * i / count, undamped) for i in range(count)
        ]
        found = []
        for X in zip(*samples, strict=True):
            spectrum = np.fft.fft(np.array(X), axis=0) / count
            most = np.abs(spectrum).max(initial=0.0)
            terms = {0: spectrum[0].real}
            for n in range(1, (count + 1) // 2):
                if np.abs(spectrum[n]).max(initial=0.0) > _LEAST * most:
                    terms[n], terms[-n] = spectrum[n], spectrum[n].conj()
            found.append(terms)
        return tuple(found)

    def _acting(
        self, probe: Probe, seen: Seen, theta: float, undamped: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray]:
        D, K = acting(probe, seen, theta, *self.at(theta))
        if undamped is not None:
            K = K - seen.speed * D @ undamped  # by rates alone
            D, K = 0.5 * (D - D.T), 0.5 * (K + K.T)
        return D, K


def between(known: Sequence[tuple[float, Foreign]], speed: float) -> Foreign:
    """Return derivatives on the straight line through those at up to two speeds [rad/s]."""
    (first, one), (second, other) = known[0], known[-1]
    if first == second or one.K.shape != other.K.shape:
        return other
    share = (speed - first) / (second - first)
    K, D = (X + share * (Y - X) for X, Y in ((one.K, other.K), (one.D, other.D)))
    return Foreign(K, D, other.steps)


def acting(
    probe: Probe, seen: Seen, theta: float, K: np.ndarray, D: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return damping and stiffness by z (l, l) of those by y at one angle."""
    T, T1, _ = probe.turn(theta)
    W, W1, _ = seen.at(theta)
    D = without_noise(D)
    K = without_noise(K) @ W + D @ (T.T @ (seen.speed * T1 @ W + T @ W1))
    return W.T @ D @ W, W.T @ K


def without_noise(X: np.ndarray) -> np.ndarray:
    """Return a matrix of differences without a skew part that is their rounding."""
    symmetric = 0.5 * (X + X.T)
    noise = np.abs(X - symmetric).max(initial=0.0) <= _SKEW * np.abs(X).max(initial=0.0)
    return symmetric if noise else X


def _state(
    probe: Probe, seen: Seen, theta: float, z: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return T, and the free coordinates and rates of a motion by constant coordinates z."""
    T, T1, _ = probe.turn(theta)
    W, W1, _ = seen.at(theta)
    return T, T @ W @ z, (probe.speed * T1 @ W + T @ W1) @ z


def _force(probe: Probe, theta: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
    return probe.foreign(theta, x, v) + probe.known(theta, x, v, probe.drives)[0]


def _slopes(probe: Probe, seen: Seen, theta: float, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    T, x, v = _state(probe, seen, theta, z)
    _, K, D = probe.known(theta, x, v, probe.drives)
    more = probe.slopes_along(theta, x, v)
    return T.T @ (K @ T + more[0]), T.T @ (D @ T + more[1])
