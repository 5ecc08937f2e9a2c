"""Steady motion of a scene over one revolution, and its equilibria at rest.

Newton's method on the harmonics of the motion: the scene is linearised at several angles of a
revolution, and these equations, times the waves of the harmonics, in the mean over the angles, are
the linear system of the harmonics (Galerkin's method). Of its solution as large a share is taken as
leaves less unbalanced. At rest nothing couples the angles, of which three tell how an equilibrium
turns in the rotor.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg

from exudyn_rotor import checks
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.scene.probe import Probe, probing
from exudyn_rotor.linear.model.spin import ARM
from exudyn_rotor.linear.model.turning import radius_of_gyration
from exudyn_rotor.reduction.reduced_rotor import RIGID_KINDS, ModeKind

Motion = tuple[np.ndarray, np.ndarray]  # orders (h,) and harmonics (h, k)
_PERIODIC = 1e-6  # share of the forces that may change from one revolution to the next: round-off
_FIRST_SAMPLES, _MOST_SAMPLES = 12, 192
_AT_REST = 3  # angles
_LEFT_OUT = 3  # harmonics fewer than samples
_ROUGH_SAMPLES = 48  # from which on the harmonics of a contact count as enough:
_ROUGH = 1e-3  # share of the motion that the highest may have,
_SLOWLY = 0.01  # where twice the samples leave more of them than this share
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


def steady_motion(
    scene: LinearScene, speed: float, tolerance: float, start: Motion | None = None
) -> Motion:
    """Return the steady motion at a spin speed [rad/s] by its harmonics of the revolution.

    Orders (h,) and harmonics (h, k) of ``y(θ) = Re Σ y_n exp(inθ)``, the unknowns of the scene.
    Newton's last change, and the highest harmonics, are below `tolerance` of the motion; the search
    begins with the motion `start` where one is given.

    Raises
    ------
    UnconvergedError
        Where no steady motion is found, or 192 angles do not resolve it, where loads do not
        repeat with every revolution, where a spring holds a free spin at a speed, and where nothing
        holds the own spin that drive='elastic' leaves to the rotor.
    """
    with probing(scene, checks.number(speed, "speed", "rad/s")) as probe:
        if speed:
            probe.check_free_spin(2.0 * np.pi * np.arange(3) / 3.0, dampers=False)
        _check_period(probe)
        _check_own_spin(probe)
        if not speed:
            return _Search(probe, _AT_REST, tolerance).found(start)[0]
        return _turning(probe, tolerance, start)


def _turning(probe: Probe, tolerance: float, start: Motion | None) -> Motion:
    """Return the motion at a speed, of as many angles as needed."""
    samples, motion, before = _FIRST_SAMPLES, start, np.inf
    if start is not None:
        samples = max(samples, len(start[0]) + _LEFT_OUT)
    while samples <= _MOST_SAMPLES:
        try:
            motion, tail = _Search(probe, samples, tolerance).found(motion)
        except UnconvergedError:  # a film that is all but closed is unlike itself at few
            if samples >= _ROUGH_SAMPLES or start is not None:
                raise
            motion, tail = None, np.inf
        is_rough = samples >= _ROUGH_SAMPLES and _SLOWLY * before < tail <= _ROUGH
        if tail <= tolerance or is_rough:
            return motion
        samples, before = 2 * samples, tail
    raise UnconvergedError(
        f"linear scene at {probe.speed:g} rad/s: {_MOST_SAMPLES} angles of a revolution do not "
        "resolve the motion; is there a stop, contact or friction, or an oil film whose edge moves "
        "from node to node? A damped run from rest shows the motion"
    )


def _check_period(probe: Probe) -> None:
    """Refuse loads that are others after a revolution, as those that vary in time by themselves."""
    still = np.zeros((2, len(probe.scene.free)))
    for theta in (0.5, 2.5, 4.5):
        first, again = (
            probe.forces(angle, *still, slopes=False)[0] for angle in (theta, theta + 2.0 * np.pi)
        )
        loads = max(np.abs(first).max(), np.abs(probe.rotor_terms(theta)[3]).max())
        if np.abs(again - first).max() > _PERIODIC * loads + _UNHELD * probe.scene.mass:
            raise UnconvergedError(
                f"linear scene at {probe.speed:g} rad/s: a load does not repeat with every "
                "revolution of the rotor, so there is no steady motion; leave out loads and "
                "motions that vary in time"
            )


def _check_own_spin(probe: Probe) -> None:
    """Refuse an own spin, of an elastic drive, that bearings alone hold by their small arms."""
    scene = probe.scene
    kinds = scene.body.selection.kinds
    if ModeKind.SPIN not in kinds:
        return
    _, _, K, _ = probe.linearised(0.0, *np.zeros((3, scene.size)))
    rigid = [scene.count + i for i, kind in enumerate(kinds) if kind in RIGID_KINDS]
    held = np.diag(scene.N[rigid] @ K @ scene.N[rigid].T)
    own_spin = held[[kinds[row - scene.count] == ModeKind.SPIN for row in rigid]]
    if np.abs(own_spin).max() <= ARM * np.abs(held).max():
        raise UnconvergedError(
            f"linear scene at {probe.speed:g} rad/s: drive='elastic' leaves the rotor's own spin "
            "to the scene, where nothing holds it; add a torsional spring, as "
            "Support(…, tilt_stiffness=…), or take drive='rigid'"
        )


@dataclass(frozen=True, eq=False)
class _Search:
    """The motion by its values at `samples` angles, to a relative `tolerance`.

    ``y = a_0 + √2 Σ a_n cos nθ + b_n sin nθ``; unknown are the parts a_0, a_1, …, then b_1, ….
    Angles begin with that of the start at rest.
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
        """Orders 1, … of the harmonics beside the mean."""
        return np.arange(1, (self.samples - (_LEFT_OUT if self.probe.speed else 0)) // 2 + 1)

    @cached_property
    def waves(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The motion at the angles by its parts, (s, h), its rate and acceleration."""
        rates = 1j * self.orders * self.probe.speed
        turned = np.sqrt(2.0) * np.exp(1j * np.outer(self.angles, self.orders))
        found = []
        for power in range(3):
            mean, wave = np.full((self.samples, 1), float(power == 0)), rates**power * turned
            found.append(np.hstack([mean, wave.real, wave.imag]))
        return tuple(found)

    def found(self, start: Motion | None) -> tuple[Motion, float]:
        """Return the motion, and the share of it that the highest harmonics have.

        The search begins with the motion `start`, of any orders.
        """
        probe, count = self.probe, len(self.orders)
        orders, Y = journal_start(probe.scene, probe.speed) if start is None else start
        values = (np.exp(1j * np.outer(self.angles, orders)) @ Y).real
        parts = newton(
            probe.scene,
            self._balance,
            self._parts(values),
            np.tile(probe.metres, 2 * count + 1),
            self.tolerance,
            f"linear scene at {probe.speed:g} rad/s: no steady motion found; is there a load that "
            "nothing holds, a resonance without damping, a stop or a bearing with clearance that "
            "the rotor leaves and hits, or an oil film that unbalance all but closes, or that "
            "whirls at half the speed? A run shows what the rotor does there: a damped one from "
            "rest, or one from the steady_state with less unbalance; periodic_response shows its "
            "motion on rolling bearings",
            yields=not probe.speed,
        )
        parts = parts.reshape(2 * count + 1, -1)
        upper = (parts[1 : count + 1] - 1j * parts[count + 1 :]) / np.sqrt(2.0)
        motion = np.concatenate([upper[::-1].conj(), parts[:1], upper])
        sizes = np.abs(motion * probe.metres).max(axis=1)
        return (np.arange(-count, count + 1), motion), sizes[:2].max() / max(sizes.max(), _SMALLEST)

    # ------------------------------------------------------------------ equations of the parts

    def _balance(self, parts: np.ndarray, slopes: bool) -> tuple[np.ndarray | None, np.ndarray]:
        """Return the stiffness between the parts with `slopes`, and what is unbalanced of each."""
        parts = parts.reshape(2 * len(self.orders) + 1, -1)
        motion = zip(self.angles, *(wave @ parts for wave in self.waves), strict=True)
        if not slopes:
            return None, self._parts(np.array([self.probe.unbalanced(*at) for at in motion]))
        points = [self.probe.linearised(*at) for at in motion]
        M, D, K, left = (np.array(each) for each in zip(*points, strict=True))
        h, k = self.waves[0].shape[1], left.shape[1]
        total = np.zeros((h * h, k * k))
        for X, wave in zip((K, D, M), self.waves, strict=True):
            pairs = self.waves[0][:, :, None] * wave[:, None, :]
            total += pairs.reshape(-1, h * h).T @ X.reshape(-1, k * k) / self.samples
        return total.reshape(h, h, k, k).swapaxes(1, 2).reshape(h * k, h * k), self._parts(left)

    def _parts(self, values: np.ndarray) -> np.ndarray:
        """Return the parts of values (s, k) at the angles."""
        return (self.waves[0].T @ values).ravel() / self.samples


def newton(
    scene: LinearScene,
    balance: Callable[[np.ndarray, bool], tuple[np.ndarray | None, np.ndarray]],
    start: np.ndarray,
    metres: np.ndarray,
    tolerance: float,
    lost: str,
    *,
    yields: bool,
) -> np.ndarray:
    """Return coordinates (k,) that leave nothing unbalanced, beside `start`.

    No step leaves more unbalanced. Where the search `yields`, what nothing holds yet is pressed by
    its load against a softness that lets it go farther in every step, until something holds it.

    Parameters
    ----------
    balance : callable
        Takes coordinates, and whether their stiffness is wanted; gives the stiffness (k, k) and
        what is unbalanced (k,).
    metres : ndarray, shape (k,)
        Per unit of each coordinate.
    tolerance : float
        Size of the last change relative to the coordinates.
    lost : str
        What to say where there are none.
    """
    y, reach, least, stalled = start, _FIRST_REACH, np.inf, 0
    enough, far = _BALANCED * scene.mass, _FAR * radius_of_gyration(scene.body.motion.invariants)
    for iteration in range(_MOST_ITERATIONS):
        K, residual = balance(y, True)
        step, left = _solved(K, -residual)
        pull = np.abs(left / metres).max(initial=0.0)
        held = pull <= _UNHELD * scene.mass
        if not held and not yields:
            raise UnconvergedError(lost)
        if not held:
            softness = pull / reach * np.diag(metres**2)
            step, reach = _solved(K + softness, -residual)[0], _FURTHER * reach
        most = np.linalg.norm(residual / metres)
        stalled = stalled + 1 if held and most > _LESS * least else 0
        least = min(least, most)
        share, allowed = 1.0, max(_AS_MUCH * most, enough)
        for _ in range(_MOST_HALVINGS):
            if np.linalg.norm(balance(y + share * step, False)[1] / metres) <= allowed:
                break
            share *= 0.5
        y = y + share * step
        if np.abs(y * metres).max(initial=0.0) > far or stalled == _STALLED:
            break
        goal = tolerance * np.abs(y * metres).max(initial=_SMALLEST)
        is_last = held and np.abs(step * metres).max(initial=0.0) < goal
        balanced = np.abs(residual / metres).max(initial=0.0) <= enough
        if is_last or (balanced and iteration > _FEW_ITERATIONS):
            return y
    raise UnconvergedError(lost)


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
