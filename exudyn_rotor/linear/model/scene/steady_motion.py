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
from exudyn_rotor.linear.model.scene.equilibrium import BALANCED, FAR, SMALLEST, solved
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.probe import LinearPoint, Probe, linearised, unbalanced
from exudyn_rotor.linear.model.scene.scene_coordinates import UNHELD, Motion, SceneCoordinates
from exudyn_rotor.linear.model.spin import ARM
from exudyn_rotor.reduction.reduced_rotor import RIGID_KINDS, ModeKind

_FIRST_SAMPLES, _MOST_SAMPLES = 12, 192
_LEFT_OUT = 3  # harmonics fewer than samples
_ROUGH_SAMPLES = 48  # from which on the harmonics of a contact count as enough:
_ROUGH = 1e-3  # share of the motion that the highest may have,
_SLOWLY = 0.01  # where twice the samples leave more of them than this share
_SOLVED = 0.01  # of what the harmonics leave out, beyond which more iterations are of no use
_MOST_ITERATIONS = 24
_FEW_ITERATIONS = 4  # after which what is balanced to rounding is found, with free motions by it
_MOST_HALVINGS = 9  # of a step
_STALLED, _LESS = 6, 0.998  # iterations in a row that leave not even this share less unbalanced


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
    samples, start, before = _FIRST_SAMPLES, None, np.inf
    if begin is not None:
        start = begin[1]
        samples = max(samples, len(start) + _LEFT_OUT)
    while samples <= _MOST_SAMPLES:
        search = _Search(scene, probe, samples, tolerance)
        try:
            start, tail = search.found(start)
        except UnconvergedError as error:  # a film that is all but closed is unlike itself at few
            if isinstance(error, _UnheldError) or samples >= _ROUGH_SAMPLES or begin is not None:
                raise
            start, tail = None, np.inf
        is_rough = samples >= _ROUGH_SAMPLES and _SLOWLY * before < tail <= _ROUGH
        if tail <= tolerance or is_rough:
            return search.orders, start
        samples, before = 2 * samples, tail
    raise UnconvergedError(
        f"linear scene at {probe.speed:g} rad/s: {_MOST_SAMPLES} angles of a revolution do not "
        "resolve the motion; is there a stop, contact or friction, or an oil film whose edge moves "
        "from node to node? A damped run from rest shows the motion"
    )


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

    def found(self, start: np.ndarray | None) -> tuple[np.ndarray, float]:
        """Return the harmonics of the motion, and the share of it that the highest have.

        By Newton's method from the harmonics of fewer samples; no step leaves more unbalanced.
        """
        Y = journal_start(self.scene, self.probe.speed, self.orders)
        if start is not None:
            more = (len(self.orders) - len(start)) // 2
            Y = np.pad(start, ((more, more), (0, 0)))
        metres = 1.0 / self.scene.metre(self.probe.masses)
        least, stalled = np.inf, 0
        for iteration in range(_MOST_ITERATIONS):
            points = [linearised(self.probe, *at) for at in self._motion(Y)]
            if iteration == 0:
                self._check_own_spin(np.mean([point.K for point in points], axis=0))
            residual = self._residual([point.residual for point in points])
            K = hill_stiffness(points, self.orders, self.probe.speed)
            change, left = (_complex(X, Y.shape) for X in solved(_real(K), -_parts(residual)))
            if np.abs(left / metres).max() > UNHELD * self.scene.mass:
                raise self._lost(UnconvergedError if iteration else _UnheldError)
            most = np.linalg.norm(residual / metres)
            stalled = stalled + 1 if most > _LESS * least else 0
            least = min(least, most)
            Y = self._ahead(Y, change, most, metres)
            sizes = np.abs(Y * metres).max(axis=1)
            if sizes.max() > FAR * self.scene.length or stalled == _STALLED:
                break
            tail = sizes[[0, 1, -2, -1]].max()  # as much as the harmonics leave out
            counts = max(sizes.max(), SMALLEST)
            limit = self.tolerance * counts
            goal = max(limit, _SOLVED * (tail - limit))
            balanced = np.abs(residual / metres).max() <= BALANCED * self.scene.mass
            is_last = np.abs(change * metres).max() < goal
            if is_last or (balanced and iteration > _FEW_ITERATIONS):
                return Y, float(tail / counts)
        raise self._lost(UnconvergedError, change)

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

    def _lost(
        self, kind: type[UnconvergedError], change: np.ndarray | None = None
    ) -> UnconvergedError:
        """Return the error, with the support whose journal an iteration last changed most."""
        where = ""
        names = sorted({one.support.interface for one in self.scene.body.supports})
        if change is not None and names:
            rows = (self.scene.interface_motion(name)[:2] for name in names)
            moved = [np.abs(U @ change.T).max() for U in rows]
            where = f", the motion at {names[int(np.argmax(moved))]!r} does not settle"
        return kind(
            f"linear scene at {self.probe.speed:g} rad/s: no steady motion found{where}; is there "
            "a load that nothing holds, a resonance without damping, a stop or a bearing with "
            "clearance that the rotor leaves and hits, or an oil film that unbalance all but "
            "closes, or that whirls at half the speed? A run shows what the rotor does there: a "
            "damped one from rest, or one from the steady_state with less unbalance; "
            "periodic_response shows its motion on rolling bearings"
        )

    def _residual(self, left: list[np.ndarray]) -> np.ndarray:
        """Return the harmonics (h, k) of what the forces leave unbalanced at the angles."""
        return self.waves.conj().T @ np.array(left) / self.samples

    def _motion(self, Y: np.ndarray) -> Iterator[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
        """Return every angle with the motion there, its rate and acceleration."""
        rates = 1j * self.orders[:, None] * self.probe.speed
        motion = ((self.waves @ (Y * rates**n)).real for n in range(3))
        return zip(self.angles, *motion, strict=True)

    def _check_own_spin(self, K: np.ndarray) -> None:
        """Refuse an own spin, of an elastic drive, that bearings alone hold by their small arms."""
        kinds, scene = self.scene.body.selection.kinds, self.scene
        if ModeKind.SPIN not in kinds:
            return
        rigid = [scene.count + i for i, kind in enumerate(kinds) if kind in RIGID_KINDS]
        spin = scene.N[scene.count + kinds.index(ModeKind.SPIN)]
        held = np.abs(np.einsum("ri,ij,rj->r", scene.N[rigid], K, scene.N[rigid])).max()
        if abs(spin @ K @ spin) <= ARM * held:
            raise _UnheldError(
                f"linear scene at {self.probe.speed:g} rad/s: drive='elastic' leaves the rotor's "
                "own spin to the scene, where nothing holds it; add a torsional spring, or take "
                "drive='rigid'"
            )


def hill_stiffness(points: Sequence[LinearPoint], orders: np.ndarray, speed: float) -> np.ndarray:
    """Return ``K + iΩmD − Ω²m²M`` between harmonics m, (h, k, h, k), as the sampled angles see it.

    The Fourier terms n and n + samples are the same there.
    """
    h, count, k = len(orders), len(points), len(points[0].M)
    apart = np.subtract.outer(orders, orders) % count
    rates = 1j * speed * orders
    total = np.zeros((h, k, h, k), dtype=complex)
    for power, samples in zip((2, 1, 0), zip(*points, strict=True), strict=False):
        spectrum = np.fft.fft(np.array(samples), axis=0) / count
        total += np.einsum("abij,b->aibj", spectrum[apart], rates**power)
    return total


def _parts(harmonics: np.ndarray) -> np.ndarray:
    """Return real parts of harmonics (h, k) n ≥ 0, then imaginary ones n > 0, of a real motion."""
    zero = len(harmonics) // 2
    return np.concatenate([harmonics[zero:].real, harmonics[zero + 1 :].imag], axis=None)


def _complex(parts: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return harmonics (h, k) of their parts."""
    zero = shape[0] // 2
    parts = parts.reshape(shape)
    upper = parts[: zero + 1].astype(complex)
    upper[1:] += 1j * parts[zero + 1 :]
    return np.concatenate([upper[:0:-1].conj(), upper])


def _real(K: np.ndarray) -> np.ndarray:
    """Return the stiffness between the parts of harmonics, of that between harmonics."""
    h, k = K.shape[:2]
    zero = h // 2
    rows, mirrored = K[zero:, :, zero:], K[zero:, :, zero::-1]
    even, odd = (rows + mirrored).reshape(-1, (zero + 1) * k), (rows - mirrored)[:, :, 1:]
    even[:, :k] *= 0.5  # the mean has no mirror image
    odd = odd.reshape(-1, zero * k)
    return np.block([[even.real, -odd.imag], [even.imag[k:], odd.real[k:]]])
