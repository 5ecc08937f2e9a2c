"""Steady motion of a scene over one revolution, and its equilibria at rest.

Newton's method on the motion's harmonics y_n of ``y(θ) = Re Σ y_n exp(inθ)``: the scene is
linearised at several angles of a revolution, and Hill's matrix of these equations turns what the
forces leave unbalanced into a change of all harmonics, as much of it as leaves less unbalanced. At
rest nothing couples the angles, of which three tell how an equilibrium turns in the rotor.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg

from exudyn_rotor import checks
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.scene.probe import LinearPoint, Probe, probing
from exudyn_rotor.linear.model.spin import ARM
from exudyn_rotor.linear.model.turning import radius_of_gyration
from exudyn_rotor.reduction.reduced_rotor import RIGID_KINDS, ModeKind

Motion = tuple[np.ndarray, np.ndarray]  # orders (h,) and harmonics (h, k)
_PERIODIC = 1e-6  # share of the forces that may change from one revolution to the next: round-off
_TURN_ROUNDING = 1e-13  # rad, of an angle after some revolutions
_FIRST_SAMPLES, _MOST_SAMPLES = 12, 192
_AT_REST = 3  # angles
_LEFT_OUT = 3  # harmonics fewer than samples
_ROUGH_SAMPLES = 48  # from which on the harmonics of a contact count as enough:
_ROUGH = 1e-3  # share of the motion that the highest may have,
_SLOWLY = 0.01  # where twice the samples leave more of them than this share
_SOLVED = 0.01  # of what the harmonics leave out, beyond which more iterations are of no use

WINDS_UP = (
    "linear scene at {:g} rad/s: a spring of Exudyn about the axis winds up as the rotor turns, "
    "for what it is on stands still here; give a flywheel as a second rotor, "
    "connect_rotors(FlexibleCoupling(…), …), and for a spring to the ground analyse the reduced "
    "rotor with supports=[…, Support(…, tilt_stiffness=…)]; a run shows what they do"
)
_TWISTED = 1e-6  # rad
_WINDING = 1e-3  # mean over a turn as a share of stiffness about the axis, but for the mesh
_UNHELD = 1e-6  # m/s² by which loads may accelerate what nothing holds: round-off
_BALANCED = 1e-8  # m/s² that may be left where a contact resists with the square of its depth,
_FEW_ITERATIONS, _MOST_ITERATIONS = 4, 60  # after these
_SMALLEST = 1e-5  # m: the tolerance of smaller motions, for Exudyn rounds positions of order 1 m
_FAR = 10.0  # lengths of the rotor that only round-off keeps it from leaving
_FIRST_REACH, _FURTHER = 1e-6, 4.0  # m of what nothing holds, and its growth in every step
_MOST_HALVINGS = 9  # of a step
_STALLED, _LESS = 6, 0.998  # iterations in a row that leave not even this share less unbalanced
_AS_MUCH = 1.0 + 1e-9  # times what is unbalanced: the same but for rounding
_ROUNDING = 1e-13  # of the largest stiffness: what turning by a skew axis leaves of none
_NOISE = 1e-10  # share of the largest row below which a row of a stiffness is round-off
_SINGULAR = 1e-12  # reciprocal condition of a stiffness that leaves a motion free


class _UnheldError(UnconvergedError):
    """Where the search begins, nothing holds a load."""


def steady_motion(
    scene: LinearScene, speed: float, tolerance: float, start: Motion | None = None
) -> Motion:
    """Return the steady motion at a spin speed [rad/s] by its harmonics of the revolution.

    Orders (h,) and harmonics (h, k) of ``y(θ) = Re Σ y_n exp(inθ)``, as deviations from
    :attr:`LinearScene.rest`. Newton's last change, and the highest harmonics, are below `tolerance`
    of the motion; the search begins with the motion `start` where one is given.

    Raises
    ------
    UnconvergedError
        Where no steady motion is found, or 192 angles do not resolve it, where loads do not
        repeat with every revolution, where nothing holds the own spin of a rotor with an elastic
        drive against a torque, and where springs on the spin wind up.
    """
    with probing(scene, checks.number(speed, "speed", "rad/s")) as probe:
        _check_period(probe)
        if not speed:
            search = _Search(probe, _AT_REST, tolerance)
            motion = search.orders, search.found(None if start is None else start[1])[0]
            _check_untwisted(probe, *motion)
            return motion
        _check_unwound(probe)
        return _turning(probe, tolerance, start)


def _check_unwound(probe: Probe) -> None:
    """Refuse springs of Exudyn about the axis."""
    angles = 2.0 * np.pi * np.arange(3) / 3.0
    if winds_up([probe.on_spin(angle)[0][-1, -1] for angle in angles]):
        raise UnconvergedError(WINDS_UP.format(probe.speed))


def winds_up(stiffness: Sequence[float]) -> bool:
    """Return whether stiffnesses on the spin, at angles, are those of a spring about the axis.

    One at a point off the axis has none in the mean.
    """
    return abs(sum(stiffness)) > _WINDING * sum(map(abs, stiffness))


def _check_untwisted(probe: Probe, orders: np.ndarray, harmonics: np.ndarray) -> None:
    """Refuse a moment on a free spin at rest that springs of Exudyn hold."""
    angle = probe.scene.body.placement.angle
    stiffness = probe.on_spin(angle)[0][-1, -1] if probe.scene.is_spin_free else 0.0
    x = probe.turn(angle)[0] @ (np.exp(1j * orders * angle) @ harmonics).real
    probe.forces(angle, x, 0.0 * x, slopes=False)
    moment = np.array(probe.solver.GetSystemResidual())[probe.spin]
    if stiffness and abs(moment) > _TWISTED * abs(stiffness):
        raise UnconvergedError(
            f"linear scene at rest: {moment:g} N m twist the spring on the free spin; "
            "mbs.SolveStatic finds this equilibrium"
        )


def _turning(probe: Probe, tolerance: float, start: Motion | None) -> Motion:
    """Return the motion at a speed, of as many angles as needed."""
    samples, harmonics, before = _FIRST_SAMPLES, None, np.inf
    if start is not None:
        harmonics = start[1]
        samples = max(samples, len(harmonics) + _LEFT_OUT)
    while samples <= _MOST_SAMPLES:
        search = _Search(probe, samples, tolerance)
        try:
            harmonics, tail = search.found(harmonics)
        except UnconvergedError as error:  # a film that is all but closed is unlike itself at few
            is_told = isinstance(error, _UnheldError) or samples >= _ROUGH_SAMPLES
            if is_told or start is not None:
                raise
            harmonics, tail = None, np.inf
        is_rough = samples >= _ROUGH_SAMPLES and _SLOWLY * before < tail <= _ROUGH
        if tail <= tolerance or is_rough:
            return search.orders, harmonics
        samples, before = 2 * samples, tail
    raise UnconvergedError(
        f"linear scene at {probe.speed:g} rad/s: {_MOST_SAMPLES} angles of a revolution do not "
        "resolve the motion; is there a stop, contact or friction, or an oil film whose edge moves "
        "from node to node? A damped run from rest shows the motion"
    )


def _check_period(probe: Probe) -> None:
    """Refuse loads that are others after a revolution, as those that vary in time by themselves."""
    still = np.zeros((2, len(probe.scene.free)))

    def force(theta: float) -> np.ndarray:
        return probe.forces(theta, *still, slopes=False).values

    for theta in (0.5, 2.5, 4.5):
        first = force(theta)
        loads = max(np.abs(first).max(), np.abs(probe.rotor_terms(theta)[3]).max())
        # where a journal that is off its axis is all but at the wall, rounding is a force
        rounding = np.abs(force(theta + _TURN_ROUNDING) - first).max()
        least = _PERIODIC * loads + _UNHELD * probe.scene.mass + rounding
        for turns in (1.0, 2.0):
            if np.abs(force(theta + 2.0 * np.pi * turns) - first).max() > least:
                raise UnconvergedError(
                    f"linear scene at {probe.speed:g} rad/s: a load does not repeat with every "
                    "revolution of the rotor, so there is no steady motion; leave out loads and "
                    "motions that vary in time"
                )


@dataclass(frozen=True, eq=False)
class _Search:
    """The motion by its values at `samples` angles, to a relative `tolerance`.

    Unknown are the real parts of its harmonics n ≥ 0, then the imaginary ones of n > 0. Angles
    begin with that of the start at rest.
    """

    probe: Probe
    samples: int
    tolerance: float

    @cached_property
    def angles(self) -> np.ndarray:
        first = 0.0 if self.probe.speed else self.probe.scene.body.placement.angle
        return first + 2.0 * np.pi * np.arange(self.samples) / self.samples

    @cached_property
    def orders(self) -> np.ndarray:
        most = (self.samples - (_LEFT_OUT if self.probe.speed else 0)) // 2
        return np.arange(-most, most + 1)

    @cached_property
    def waves(self) -> np.ndarray:
        return np.exp(1j * np.outer(self.angles, self.orders))

    def found(self, start: np.ndarray | None) -> tuple[np.ndarray, float]:
        """Return the harmonics (h, k) of the motion, and the share of it that the highest have.

        The search begins with the harmonics `start`, of any number.
        """
        probe, count = self.probe, len(self.orders)
        if start is None:
            start = journal_start(probe.scene, probe.speed, self.orders)
        more = (count - len(start)) // 2
        Y = start[-more:more] if more < 0 else np.pad(start, ((more, more), (0, 0)))
        self._check_own_spin(Y)
        parts = newton(
            probe.scene,
            self._linearised,
            self._unbalanced,
            np.concatenate([Y[count // 2 :].real, Y[count // 2 + 1 :].imag], axis=None),
            np.tile(probe.metres, count),
            self._goal,
            self._lost,
            yields=not probe.speed,
        )
        size, tail = self._sizes(parts)
        return self._harmonics(parts), tail / size

    # ------------------------------------------------------------------ equations of the parts

    def _linearised(self, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the stiffness between the parts, and what is unbalanced of each."""
        points = [self.probe.linearised(*at) for at in self._motion(self._harmonics(parts))]
        K = self._stiffness(points)
        h, k = K.shape[:2]
        zero = h // 2
        rows, mirrored = K[zero:, :, zero:], K[zero:, :, zero::-1]
        even, odd = (rows + mirrored).reshape(-1, (zero + 1) * k), (rows - mirrored)[:, :, 1:]
        even[:, :k] *= 0.5  # the mean has no mirror image
        odd = odd.reshape(-1, zero * k)
        K = np.block([[even.real, -odd.imag], [even.imag[k:], odd.real[k:]]])
        return K, self._residual([point.residual for point in points])

    def _unbalanced(self, parts: np.ndarray) -> np.ndarray:
        """Return what is unbalanced of each part."""
        motion = self._motion(self._harmonics(parts))
        return self._residual([self.probe.unbalanced(*at) for at in motion])

    def _stiffness(self, points: Sequence[LinearPoint]) -> np.ndarray:
        """Return ``K + iΩmD − Ω²m²M`` between harmonics m, (h, k, h, k), as the angles see it.

        The Fourier terms n and n + samples are the same there.
        """
        h, k = len(self.orders), len(points[0].M)
        apart = np.subtract.outer(self.orders, self.orders) % self.samples
        rates, turn = 1j * self.probe.speed * self.orders, self.waves[0]
        total = np.zeros((h, k, h, k), dtype=complex)
        for power, X in zip((2, 1, 0), zip(*points, strict=True), strict=False):
            spectrum = np.fft.fft(np.array(X), axis=0) / self.samples
            total += np.einsum("abij,b->aibj", spectrum[apart], turn * rates**power)
        return turn.conj()[:, None, None, None] * total

    def _residual(self, left: list[np.ndarray]) -> np.ndarray:
        """Return the parts of what the forces leave unbalanced at the angles."""
        zero = len(self.orders) // 2
        harmonics = self.waves[:, zero:].conj().T @ np.array(left) / self.samples
        return np.concatenate([harmonics.real, harmonics[1:].imag], axis=None)

    def _harmonics(self, parts: np.ndarray) -> np.ndarray:
        """Return harmonics (h, k) of their parts."""
        zero = len(self.orders) // 2
        parts = parts.reshape(len(self.orders), -1)
        upper = parts[: zero + 1].astype(complex)
        upper[1:] += 1j * parts[zero + 1 :]
        return np.concatenate([upper[:0:-1].conj(), upper])

    def _motion(self, Y: np.ndarray) -> Iterator[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
        """Return every angle with the motion there, its rate and acceleration."""
        rates = 1j * self.orders[:, None] * self.probe.speed
        motion = ((self.waves @ (Y * rates**n)).real for n in range(3))
        return zip(self.angles, *motion, strict=True)

    # ------------------------------------------------------------------ how far the search is

    def _sizes(self, parts: np.ndarray) -> tuple[float, float]:
        """Return the size of a motion [m], and what its harmonics leave out at a speed."""
        sizes = np.abs(self._harmonics(parts) * self.probe.metres).max(axis=1)
        tail = sizes[[0, 1, -2, -1]].max() if self.probe.speed else 0.0
        return float(max(sizes.max(), _SMALLEST)), float(tail)

    def _goal(self, parts: np.ndarray) -> float:
        """Return the change of a motion that is the last [m]."""
        size, tail = self._sizes(parts)
        limit = self.tolerance * size
        return max(limit, _SOLVED * (tail - limit))

    def _lost(self, change: np.ndarray | None) -> str:
        """Return what to say, with the support whose journal an iteration last changed most."""
        scene, where = self.probe.scene, ""
        names = sorted({one.support.interface for one in scene.body.supports})
        if change is not None and names:
            change = change.reshape(-1, scene.size)
            rows = (scene.interface_motion(name)[:2] for name in names)
            moved = [np.abs(U @ change.T).max() for U in rows]
            where = f", the motion at {names[int(np.argmax(moved))]!r} does not settle"
        return (
            f"linear scene at {self.probe.speed:g} rad/s: no steady motion found{where}; is there "
            "a load that nothing holds, a resonance without damping, a stop or a bearing with "
            "clearance that the rotor leaves and hits, or an oil film that unbalance all but "
            "closes, or that whirls at half the speed? A run shows what the rotor does there: a "
            "damped one from rest, or one from the steady_state with less unbalance; "
            "periodic_response shows its motion on rolling bearings"
        )

    def _check_own_spin(self, Y: np.ndarray) -> None:
        """Refuse an own spin, of an elastic drive, that bearings alone hold by their small arms."""
        scene = self.probe.scene
        kinds = scene.body.selection.kinds
        if ModeKind.SPIN not in kinds:
            return
        K = np.mean([self.probe.linearised(*at).K for at in self._motion(Y)], axis=0)
        rigid = [scene.count + i for i, kind in enumerate(kinds) if kind in RIGID_KINDS]
        spin = scene.N[scene.count + kinds.index(ModeKind.SPIN)]
        held = np.abs(np.einsum("ri,ij,rj->r", scene.N[rigid], K, scene.N[rigid])).max()
        if abs(spin @ K @ spin) <= ARM * held:
            raise _UnheldError(
                f"linear scene at {self.probe.speed:g} rad/s: drive='elastic' leaves the rotor's "
                "own spin to the scene, where nothing holds it; add a torsional spring, or take "
                "drive='rigid'"
            )


def newton(
    scene: LinearScene,
    linearised: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]],
    unbalanced: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    metres: np.ndarray,
    goal: Callable[[np.ndarray], float],
    lost: Callable[[np.ndarray | None], str],
    *,
    yields: bool,
) -> np.ndarray:
    """Return coordinates (k,) that leave nothing unbalanced, beside `start`.

    No step leaves more unbalanced. Where the search `yields`, what nothing holds yet is pressed by
    its load against a softness that lets it go farther in every step, until something holds it.

    Parameters
    ----------
    linearised, unbalanced : callable
        Stiffness (k, k) and what is unbalanced (k,), and the latter alone.
    metres : ndarray, shape (k,)
        Per unit of each coordinate.
    goal : callable
        A change up to which is the last [m].
    lost : callable
        What to say of a last change.
    """
    y, reach, least, stalled = start, _FIRST_REACH, np.inf, 0
    enough, far = _BALANCED * scene.mass, _FAR * radius_of_gyration(scene.body.motion.invariants)
    for iteration in range(_MOST_ITERATIONS):
        K, residual = linearised(y)
        step, left = _solved(K, -residual)
        pull = np.abs(left / metres).max(initial=0.0)
        held = pull <= _UNHELD * scene.mass
        if not held and not yields:
            raise (UnconvergedError if iteration else _UnheldError)(lost(None))
        if not held:
            softness = pull / reach * np.diag(metres**2)
            step, reach = _solved(K + softness, -residual)[0], _FURTHER * reach
        most = np.linalg.norm(residual / metres)
        stalled = stalled + 1 if held and most > _LESS * least else 0
        least = min(least, most)
        share, allowed = 1.0, max(_AS_MUCH * most, enough)
        for _ in range(_MOST_HALVINGS):
            if np.linalg.norm(unbalanced(y + share * step) / metres) <= allowed:
                break
            share *= 0.5
        y = y + share * step
        if np.abs(y * metres).max(initial=0.0) > far or stalled == _STALLED:
            break
        is_last = held and np.abs(step * metres).max(initial=0.0) < goal(y)
        balanced = np.abs(residual / metres).max(initial=0.0) <= enough
        if is_last or (balanced and iteration > _FEW_ITERATIONS):
            return y
    raise UnconvergedError(lost(step))


def _solved(K: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve with motions that nothing holds left at rest; return what remains of the load, too.

    So is a rotor along its axis that springs, films and rolling elements across it leave free.
    """
    sizes = np.abs(K)
    held = np.maximum(sizes.max(axis=1), sizes.max(axis=0)) > _ROUNDING * sizes.max()
    among, answer = K[np.ix_(held, held)], np.zeros(len(load))
    if not np.any(held):
        return answer, load
    rows = np.abs(among).max(axis=1)
    # a row of round-off is not blown up to the size of the others
    scale = 1.0 / np.sqrt(np.maximum(rows, _NOISE * rows.max()))
    answer[held] = scale * _least_squares(scale[:, None] * among * scale, scale * load[held])
    return answer, load - K @ answer


def _least_squares(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the solution, of a singular matrix the smallest one that leaves least."""
    factor, condition, solve = scipy.linalg.get_lapack_funcs(("getrf", "gecon", "getrs"), (A, b))
    lu, pivots, info = factor(A)
    if info == 0 and condition(lu, np.abs(A).sum(axis=0).max())[0] > _SINGULAR:
        return solve(lu, pivots, b)[0]
    return scipy.linalg.lstsq(A, b, cond=_SINGULAR, lapack_driver="gelsy")[0]
