"""Steady motion of a scene over one revolution.

Newton's method on the motion's harmonics y_n of ``y(θ) = Re Σ y_n exp(inθ)``: the scene is
linearised at several angles of a revolution, and Hill's matrix of these equations turns what the
forces leave unbalanced into a change of all harmonics, as much of it as leaves less unbalanced.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.equilibrium import BALANCED, FAR, NOISE, SMALLEST, solved
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.own_spin import OwnSpin
from exudyn_rotor.linear.model.scene.probe import LinearPoint, Probe, linearised, unbalanced
from exudyn_rotor.linear.model.scene.scene_coordinates import UNHELD, Motion, SceneCoordinates

_FIRST_SAMPLES, _MOST_SAMPLES = 12, 192
_LEFT_OUT = 3  # harmonics fewer than samples
_MOST_UNRESOLVED = 48  # samples for motions whose equations stay unresolved
_ROUGH = 1e-3  # share of such a motion that its highest harmonics may have
_RESOLVED = 1e-8  # share of the largest entry that the highest harmonics of coefficients may have
_SOLVED = 0.01  # of what the harmonics leave out, beyond which more iterations are of no use
_MOST_ITERATIONS = 30
_FEW_ITERATIONS = 4  # after which what is balanced to rounding is found, with free motions by it
_MOST_HALVINGS = 9  # of a step
_RISES = (2.0, 1.0)  # of what is unbalanced, in a step


def steady_motion(
    scene: SceneCoordinates, probe: Probe, tolerance: float, begin: Motion | None = None
) -> Motion:
    """Return orders (h,) and harmonics (h, k) of the motion, of as many angles as needed.

    The search begins with the motion `begin` where one is given.

    Raises
    ------
    UnconvergedError
        Where no steady motion is found, or 192 angles do not resolve it.
    """
    samples, start = _FIRST_SAMPLES, None
    if begin is not None:
        start = _same_harmonics(*begin)
        samples = max(samples, len(start) + _LEFT_OUT)
    while samples <= _MOST_SAMPLES:
        search = _Search(scene, probe, samples, tolerance)
        is_found, start = _by_rises(search, start, samples < _MOST_UNRESOLVED and begin is None)
        if is_found:
            return search.orders, start
        samples *= 2
    raise UnconvergedError(
        f"linear scene at {probe.speed:g} rad/s: {_MOST_SAMPLES} angles of a revolution do not "
        "resolve the motion; is there a stop, contact or friction, or an oil film whose edge moves "
        "from node to node? A damped run from rest shows the motion"
    )


def _by_rises(
    search: _Search, start: np.ndarray | None, tries_finer: bool
) -> tuple[bool, np.ndarray | None]:
    """Return as :meth:`_Search.found`, of steps that may leave more unbalanced, or may not.

    Where contacts open and close the former converge, far from the motion the latter.
    """
    for rise in _RISES:
        try:
            return search.found(start, rise)
        except _UnheldError:
            raise
        except UnconvergedError as error:
            lost = error
    if not tries_finer:  # a film that is all but closed is unlike itself at few angles
        raise lost
    return False, None


def _same_harmonics(orders: np.ndarray, harmonics: np.ndarray) -> np.ndarray:
    """Return harmonics from −n to n of a motion by some of its harmonics."""
    most = np.abs(orders).max()
    found = np.zeros((2 * most + 1, harmonics.shape[1]), dtype=complex)
    found[orders + most] = harmonics
    return found


class _UnheldError(UnconvergedError):
    """Where the search begins, nothing holds a load."""


@dataclass(frozen=True, eq=False)
class _Search:
    """The steady motion by its values at `samples` angles, to a relative `tolerance`."""

    scene: SceneCoordinates
    probe: Probe
    samples: int
    tolerance: float

    @cached_property
    def angles(self) -> np.ndarray:
        return 2.0 * np.pi * np.arange(self.samples) / self.samples

    @cached_property
    def orders(self) -> np.ndarray:
        most = (self.samples - _LEFT_OUT) // 2
        return np.arange(-most, most + 1)

    @cached_property
    def waves(self) -> np.ndarray:
        return np.exp(1j * np.outer(self.angles, self.orders))

    @cached_property
    def spin(self) -> OwnSpin | None:
        names = self.scene.interfaces
        return OwnSpin.of(self.scene, [self.scene.interface_motion(name) for name in names])

    def found(self, start: np.ndarray | None, rise: float) -> tuple[bool, np.ndarray]:
        """Return whether the samples resolve the motion, and its harmonics.

        By Newton's method from the harmonics of fewer samples; no step leaves more than `rise`
        times as much unbalanced.
        """
        Y = journal_start(self.scene, self.probe.speed, self.orders)
        if start is not None:
            more = (len(self.orders) - len(start)) // 2
            Y = np.pad(start, ((more, more), (0, 0)))
        metres = 1.0 / self.scene.metre(self.probe.masses)
        for iteration in range(_MOST_ITERATIONS):
            self.probe.step = self.probe.velocity_step = None  # steps that are for this motion
            points = [linearised(self.probe, *at) for at in self._motion(Y)]
            resolved = is_resolved(points)
            if not resolved and self.samples > _MOST_UNRESOLVED:
                return False, Y
            residual = self._residual([point.residual for point in points])
            K = hill_stiffness(points, self.orders, self.probe.speed)
            change, left = (X.reshape(Y.shape) for X in solved(K, -residual.ravel()))
            if np.abs(left / metres).max() > UNHELD * self.scene.mass:
                raise self._lost(UnconvergedError if iteration else _UnheldError)
            # there are no forces before the first step
            torque, twist = self._own_spin(points if iteration else None, K, Y + change)
            change = change - torque * twist
            Y = self._ahead(Y, change, rise * np.linalg.norm(residual / metres), metres)
            sizes = np.abs(Y * metres).max(axis=1)
            if sizes.max() > FAR * self.scene.length:
                break
            tail = sizes[[0, 1, -2, -1]].max()  # as much as the harmonics leave out
            counts = max(sizes.max(), SMALLEST)
            limit = self.tolerance * counts
            goal = max(limit, _SOLVED * (tail - limit))
            balanced = np.abs(residual / metres).max() <= BALANCED * self.scene.mass
            is_last = np.abs(change * metres).max() < goal
            if is_last or (balanced and iteration > _FEW_ITERATIONS):
                self._check_spin(torque)
                if not resolved and self.samples == _MOST_UNRESOLVED:
                    limit = max(limit, _ROUGH * sizes.max())
                return bool(tail <= limit), Y
        raise self._lost(UnconvergedError)

    def _ahead(
        self, Y: np.ndarray, change: np.ndarray, most: float, metres: np.ndarray
    ) -> np.ndarray:
        """Return harmonics as far along a change as leaves at `most` so much unbalanced."""
        most = max(most, BALANCED * self.scene.mass)
        for halvings in range(_MOST_HALVINGS + 1):
            tried = Y + 0.5**halvings * change
            left = self._residual([unbalanced(self.probe, *at) for at in self._motion(tried)])
            if np.linalg.norm(left / metres) <= most:
                break
        return tried

    def _lost(self, kind: type[UnconvergedError]) -> UnconvergedError:
        return kind(
            f"linear scene at {self.probe.speed:g} rad/s: no steady motion found; is there a load "
            "that nothing holds, a resonance without damping, a stop or a bearing with clearance "
            "that the rotor leaves and hits, or an oil film that unbalance all but closes, or that "
            "whirls at half the speed? A run shows what the rotor does there: a damped one from "
            "rest, or one from the steady_state with less unbalance; periodic_response "
            "shows its motion on rolling bearings"
        )

    def _residual(self, left: list[np.ndarray]) -> np.ndarray:
        """Return the harmonics (h, k) of what the forces leave unbalanced at the angles."""
        return self.waves.conj().T @ np.array(left) / self.samples

    def _motion(self, Y: np.ndarray) -> Iterator[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
        """Return every angle with the motion there, its rate and acceleration."""
        rates = 1j * self.orders[:, None] * self.probe.speed
        motion = ((self.waves @ (Y * rates**n)).real for n in range(3))
        return zip(self.angles, *motion, strict=True)

    def _own_spin(
        self, points: list[LinearPoint] | None, K: np.ndarray, Y: np.ndarray
    ) -> tuple[float, np.ndarray]:
        """Return the drive's torque, and the change of harmonics that a unit of it takes back."""
        if self.spin is None:
            return 0.0, np.zeros_like(Y)
        least = np.inf
        if points is not None:
            forces = np.mean([point.forces for point in points], axis=0)
            mean = np.mean([point.K for point in points], axis=0)
            least = self.spin.least_stiffness(mean, forces, self.probe.rounding)
        middle = np.flatnonzero(self.orders == 0)[0]
        twist = solved(K, self.spin.torque(self.orders))[0].reshape(Y.shape)
        return self.spin.drive_torque(twist[middle], Y[middle], least), twist

    def _check_spin(self, torque: float) -> None:
        if self.spin is not None:
            most = UNHELD * np.sqrt(self.scene.mass)
            self.spin.check_held(torque, most, self.probe.speed)


def _scaled_samples(points: Sequence[LinearPoint]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the Fourier terms n of M, D, K, (n, k, k), and their largest entries as shares."""
    M, D, K = (np.array([point[i] for point in points]) for i in range(3))
    scale = 1.0 / np.sqrt(np.maximum(np.diag(M[0]), 1e-300))
    scale = np.outer(scale, scale)
    largest = [np.abs(X * scale).max() for X in (M, D, K)]
    largest[1] = max(largest[1], np.sqrt(largest[2]))
    for X, size in zip((M, D, K), largest, strict=True):
        spectrum = np.fft.fft(X, axis=0) / len(points)
        yield spectrum, np.abs(spectrum * scale).max(axis=(1, 2)) / size


def is_resolved(points: Sequence[LinearPoint]) -> bool:
    """Return whether the angles resolve the coefficients."""
    top = len(points) // 2
    return all(s[top - 1 : top + 2].max() <= _RESOLVED for _, s in _scaled_samples(points))


def hill_stiffness(points: Sequence[LinearPoint], orders: np.ndarray, speed: float) -> np.ndarray:
    """Return ``K + iΩmD − Ω²m²M`` between harmonics m, (h k, h k), as the sampled angles see it.

    The Fourier terms n and n + samples are the same there.
    """
    h, count, k = len(orders), len(points), len(points[0].M)
    apart = np.subtract.outer(orders, orders) % count
    rates = 1j * speed * orders
    total = np.zeros((h, k, h, k), dtype=complex)
    for power, (spectrum, shares) in zip((2, 1, 0), _scaled_samples(points), strict=True):
        spectrum[1:][shares[1:] <= NOISE] = 0.0
        total += np.einsum("abij,b->aibj", spectrum[apart], rates**power)
    return total.reshape(h * k, h * k)
