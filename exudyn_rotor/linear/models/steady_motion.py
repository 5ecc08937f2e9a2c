"""Steady motion of a scene over one revolution, and the equations about it.

Newton's method on the motion's harmonics y_n of ``y(θ) = Re Σ y_n exp(inθ)``: the scene is
linearised at several angles of a revolution, and Hill's matrix of these equations turns what the
forces leave unbalanced into a change of all harmonics.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.linalg

from exudyn_rotor.linear.models.journal_start import journal_start
from exudyn_rotor.linear.models.own_spin import OwnSpin
from exudyn_rotor.linear.models.probe import LinearPoint, Probe, linearised
from exudyn_rotor.linear.models.scene_coordinates import SceneCoordinates
from exudyn_rotor.linear.periodic.harmonics import hill_matrices
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms, UnconvergedError

_FIRST_SAMPLES, _MOST_SAMPLES = 12, 192
_MOST_UNRESOLVED = 48  # samples for motions whose equations stay unresolved
_MOST_ITERATIONS = 40
_RISE = 2.0  # of the residual, beyond which a step of Newton's method is halved
_LEAST_SHARE = 2e-3  # of a step
_NOISE = 1e-10  # share of the largest entry below which a Fourier term is round-off
_AT_REST = 1e-4  # share of a motion, or of a difference step, that does not matter
_UNHELD = 1e-6  # m/s² by which loads may accelerate what nothing holds: round-off
_PERIODIC = 1e-6  # share of the forces that may change from one revolution to the next: round-off
_FAR = 10.0  # lengths of the rotor that only round-off keeps it from leaving
_SMALLEST = 1e-5  # m: the tolerance of smaller motions, for Exudyn rounds positions of order 1 m
_CONVERGED = 1e-8  # share of the largest entry that the highest harmonics may have


class Scene(Protocol):
    """What the search needs of a scene beside the members of :class:`SceneCoordinates`."""

    about: str

    @property
    def interfaces(self) -> tuple[str, ...]: ...
    @property
    def structural_damping(self) -> np.ndarray | None: ...
    def interface_motion(self, name: str) -> np.ndarray: ...


def equations_about(scene: Scene, probe: Probe) -> PeriodicSystem:
    """Return the equations about the steady motion; raises as :func:`steady_motion`."""
    return steady_motion(scene, probe, _AT_REST)[0]


def steady_motion(
    scene: Scene, probe: Probe, tolerance: float
) -> tuple[PeriodicSystem, np.ndarray, np.ndarray]:
    """Return equations, orders (h,) and harmonics (h, k), at as many angles as needed.

    Raises
    ------
    UnconvergedError
        Where no steady motion is found, or 192 angles do not resolve the coefficients.
    """
    samples, found = _FIRST_SAMPLES, None
    while samples <= _MOST_SAMPLES:
        search = _Search(scene, probe, samples, tolerance)
        system, found = search.found(found)
        if system is not None:
            return system, search.orders, found
        samples *= 2
    raise UnconvergedError(
        f"linear scene at {probe.speed:g} rad/s: {_MOST_SAMPLES} angles of a revolution do not "
        "resolve the coefficients; is there a stop, contact or friction, or an oil film whose edge "
        "moves from node to node? linear_model(rotor, supports=…) takes bearings in equilibrium; "
        "a damped run from rest shows the motion"
    )


def check_period(scene: SceneCoordinates, probe: Probe) -> None:
    """Refuse loads that are others after a revolution, as those that vary in time by themselves."""
    still = np.zeros(len(scene.free))
    for theta in (0.5, 2.5, 4.5):
        first = probe.force(theta, still, still)
        loads = max(np.abs(first).max(), np.abs(probe.rotor_terms(theta)[3]).max())
        for turns in (1.0, 2.0):
            later = probe.force(theta + 2.0 * np.pi * turns, still, still)
            if np.abs(later - first).max() > _PERIODIC * loads + _UNHELD * scene.mass:
                raise UnconvergedError(
                    f"linear scene at {probe.speed:g} rad/s: a load does not repeat with every "
                    "revolution of the rotor, so there is no steady motion; leave out loads and "
                    "motions that vary in time"
                )


@dataclass(frozen=True, eq=False)
class _Search:
    """The steady motion by its values at `samples` angles.

    `tolerance` counts relative to the motion, but for a step of differences in the equations. The
    motion alone does not need resolved equations: Newton's method then takes more steps.
    """

    scene: Scene
    probe: Probe
    samples: int
    tolerance: float

    @property
    def for_equations(self) -> bool:
        return self.tolerance == _AT_REST

    @cached_property
    def angles(self) -> np.ndarray:
        return 2.0 * np.pi * np.arange(self.samples) / self.samples

    @cached_property
    def orders(self) -> np.ndarray:
        return np.arange(-self.samples // 2 + 2, self.samples // 2 - 1)

    @cached_property
    def waves(self) -> np.ndarray:
        return np.exp(1j * np.outer(self.angles, self.orders))

    @cached_property
    def spin(self) -> OwnSpin | None:
        names = self.scene.interfaces
        return OwnSpin.of(self.scene, [self.scene.interface_motion(name) for name in names])

    def found(self, start: np.ndarray | None) -> tuple[PeriodicSystem | None, np.ndarray]:
        """Return the equations, None where more samples are needed, and the harmonics.

        It begins with those of fewer samples.
        """
        Y = self._start(start)
        change, share, before = np.zeros_like(Y), 1.0, np.inf
        for iteration in range(_MOST_ITERATIONS):
            points = self._points(Y)
            system = self._system(points)
            if system is None or self.scene.about == "given":
                return system, Y
            metres = 1.0 / self.scene.metre(np.diag(system.M[0]))
            residual = self.waves.conj().T @ np.array([point.residual for point in points])
            residual = residual / self.samples
            size = np.linalg.norm(residual / metres)
            if size > _RISE * before and share > _LEAST_SHARE:
                change, share = 0.5 * change, 0.5 * share
                Y = Y - change
                continue
            before, share = size, 1.0
            K = hill_matrices(system, self.orders)[2]
            change, left = (X.reshape(Y.shape) for X in _solved(K, -residual.ravel()))
            # there are no forces before the first step
            torque, twist = self._own_spin(system, points if iteration else None, K, Y + change)
            change = change - torque * twist
            Y = Y + change
            sizes = np.abs(Y * metres).max(axis=1)
            unheld = np.abs(left / metres).max() > _UNHELD * self.scene.mass
            if unheld or sizes.max() > _FAR * self.scene.length:
                break
            if np.abs(change * metres).max() < self.tolerance * self._counts(sizes):
                self._check_spin(torque)
                limit = self.tolerance * max(sizes.max(), self._counts(sizes))
                return system if sizes[[0, 1, -2, -1]].max() <= limit else None, Y
        raise UnconvergedError(
            f"linear scene at {self.probe.speed:g} rad/s: no steady motion found; is there a load "
            "that nothing holds, a resonance without damping, or a stop or a bearing with "
            "clearance that the rotor leaves and hits? A damped run from rest shows what it does "
            "there; about='given' needs no steady motion"
        )

    def _start(self, found: np.ndarray | None) -> np.ndarray:
        if found is None:
            return journal_start(self.scene, self.probe.speed, self.orders)
        more = (len(self.orders) - len(found)) // 2
        return np.pad(found, ((more, more), (0, 0)))

    def _points(self, Y: np.ndarray) -> list[LinearPoint]:
        """Return the scene linearised at all angles of the motion."""
        rates = 1j * self.orders[:, None] * self.probe.speed
        motion = [(self.waves @ (Y * rates**n)).real for n in range(3)]
        return [linearised(self.probe, *at) for at in zip(self.angles, *motion, strict=True)]

    def _system(self, points: list[LinearPoint]) -> PeriodicSystem | None:
        """Return the equations; None where they need more samples."""
        terms, resolved = zip(*(_terms(*entry) for entry in _scaled(points)), strict=True)
        if not all(resolved) and (self.for_equations or self.samples > _MOST_UNRESOLVED):
            return None
        speed, rounding = self.probe.speed, self.probe.rounding
        return PeriodicSystem(speed, *terms, self.scene.structural_damping, rounding)

    def _own_spin(
        self, system: PeriodicSystem, points: list[LinearPoint] | None, K: np.ndarray, Y: np.ndarray
    ) -> tuple[float, np.ndarray]:
        """Return the drive's torque, and the change of harmonics that a unit of it takes back."""
        if self.spin is None:
            return 0.0, np.zeros_like(Y)
        least = np.inf
        if points is not None:
            forces = np.mean([point.forces for point in points], axis=0)
            least = self.spin.least_stiffness(system.K[0], forces, self.probe.rounding)
        middle = np.flatnonzero(self.orders == 0)[0]
        twist = _solved(K, self.spin.torque(self.orders))[0].reshape(Y.shape)
        return self.spin.drive_torque(twist[middle], Y[middle], least), twist

    def _counts(self, sizes: np.ndarray) -> float:
        """Return the motion of which the tolerance is a share."""
        # what the equations need is the motion to a share of their step of differences
        return self.probe.step if self.for_equations else max(sizes.max(), _SMALLEST)

    def _check_spin(self, torque: float) -> None:
        if self.spin is not None and not self.for_equations:
            most = _UNHELD * np.sqrt(self.scene.mass)
            self.spin.check_held(torque, most, self.probe.speed)


def _solved(K: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve with motions that nothing holds left at rest; return what remains of the load, too."""
    rows = np.abs(K).max(axis=1)
    # a row of round-off is not blown up to the size of the others
    scale = 1.0 / np.sqrt(np.maximum(rows, max(_NOISE * rows.max(), 1e-300)))
    scaled = scale[:, None] * K * scale
    solution = scipy.linalg.lstsq(scaled, scale * load, cond=1e-12, lapack_driver="gelsy")
    answer = scale * solution[0]
    return answer, load - K @ answer


def _scaled(points: list[LinearPoint]) -> Iterator[tuple[np.ndarray, np.ndarray, float]]:
    """Yield samples of M, D, K (n, k, k), the scale of coordinates, and what counts as zero."""
    M, D, K = (np.array([point[i] for point in points]) for i in range(3))
    scale = 1.0 / np.sqrt(np.maximum(np.diag(M[0]), 1e-300))
    largest = [np.abs(X * np.outer(scale, scale)).max() for X in (M, D, K)]
    largest[1] = max(largest[1], np.sqrt(largest[2]))
    for X, size in zip((M, D, K), largest, strict=True):
        yield X, scale, size


def _terms(samples: np.ndarray, scale: np.ndarray, largest: float) -> tuple[Terms, bool]:
    """Return the Fourier terms of samples over a revolution, and whether these resolve it."""
    count = len(samples)
    spectrum = np.fft.fft(samples, axis=0) / count
    sizes = np.abs(spectrum * np.outer(scale, scale)).max(axis=(1, 2))
    top = count // 2
    resolved = bool(sizes[top - 1 : top + 2].max() <= _CONVERGED * largest)
    terms = {0: spectrum[0].real}
    for n in range(1, top - 1):
        if sizes[n] > _NOISE * largest:
            terms[n], terms[-n] = spectrum[n], spectrum[n].conj()
    return terms, resolved
