"""Steady motion of a scene over one revolution, and the equations about it.

Newton's method on the motion's harmonics y_n of ``y(θ) = Re Σ y_n exp(inθ)``: the scene is
linearised at several angles of a revolution, and Hill's matrix of these equations turns what the
forces leave unbalanced into a change of all harmonics.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.linalg

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.along_axis import held_along_axis
from exudyn_rotor.linear.model.scene.equilibrium import (
    BALANCED,
    FAR,
    SMALLEST,
    motion_at_rest,
    solved_in,
)
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.own_spin import OwnSpin
from exudyn_rotor.linear.model.scene.probe import (
    LinearPoint,
    Probe,
    linearised,
    unbalanced,
)
from exudyn_rotor.linear.model.scene.sampled_terms import hill_stiffness, is_resolved
from exudyn_rotor.linear.model.scene.scene_coordinates import UNHELD, Motion, SceneCoordinates
from exudyn_rotor.linear.model.scene.unloaded import check_elements, check_films, loose_bearing

_FIRST_SAMPLES, _MOST_SAMPLES = 12, 192
_LEFT_OUT = 3  # harmonics fewer than samples
_MOST_UNRESOLVED = 48  # samples for motions whose equations stay unresolved
_ROUGH = 1e-3  # share of such a motion that its highest harmonics may have
_SOLVED = 0.01  # of what the harmonics leave out, beyond which more iterations are of no use
_FIRST_STRIDE, _MOST_STRIDES = 0.25, 12  # shares of what is unbalanced at the start
_ON_THE_WAY = 1e-3  # tolerance before the last stride
_FEW_STRIDES = 5  # with many samples
_HOPELESS = 2.0**10  # of UNHELD: a share of this that counts as held leaves too many strides
_MOST_FOLLOWED = 12  # iterations for each
_MOST_ITERATIONS = 40
_MOST_FREE = 20  # with a journal that nothing presses
_FEW_ITERATIONS = 4  # after which what is balanced to rounding is found, with free motions by it
_RISE = 2.0  # of the residual, beyond which a step of Newton's method is halved
_MOST_HALVINGS = 9  # of a step
_MOTION = 1e-7  # tolerance of a motion about which films have coefficients of another kind
_BESIDE_REST = 1e-5  # one of which the mean force alone counts
_AT_REST = 1e-4  # share of a motion, or of a difference step, that does not matter


def points_about(scene: SceneCoordinates, probe: Probe) -> list[LinearPoint]:
    """Return the scene linearised at the angles of its steady motion, as many as resolve it.

    Without the rotor's own unbalance films are those of journals at rest, as in lists of supports.
    Films that conserve mass have a force in them, but no stiffness and no damping:
    :mod:`.films` adds what they have, which depends on the frequency.
    """
    check_films(scene, probe)
    rest = scene.about == "equilibrium"
    with probe.as_in_lists(rest):
        return _points_about(scene, probe, rest)


def _points_about(scene: SceneCoordinates, probe: Probe, rest: bool) -> list[LinearPoint]:
    tolerance = None
    if probe.remembering:
        tolerance = _MOTION
    elif rest and probe.films:
        tolerance = _BESIDE_REST
    try:
        points, orders, found = steady_motion(scene, probe, tolerance)
    except _UnresolvedError:  # on the way; about the motion itself a film may be smooth
        if tolerance is not None or scene.about == "given":
            raise
        tolerance = _MOTION
        points, orders, found = steady_motion(scene, probe, tolerance)
    samples, settling = len(orders) + _LEFT_OUT, []
    if rest:
        _Search(scene, probe, samples, _MOTION, True).see(found)
        settling = probe.settling
    if tolerance is None and not settling:
        return points
    with probe.settled(settling), probe.without_tangents():
        while samples <= _MOST_SAMPLES:
            points = _Search(scene, probe, samples, _MOTION, True).points(found)
            if is_resolved(points):
                return points
            samples *= 2
    raise _unresolved(probe.speed)


def steady_motion(
    scene: SceneCoordinates, probe: Probe, tolerance: float | None, begin: Motion | None = None
) -> tuple[list[LinearPoint], np.ndarray, np.ndarray]:
    """Return the linearised scene, orders (h,) and harmonics (h, k), at as many angles as needed.

    Without a `tolerance` the motion is as good as the equations need it. The search begins with the
    motion `begin` where one is given.

    Raises
    ------
    UnconvergedError
        Where no steady motion is found, or 192 angles do not resolve the coefficients.
    """
    samples, found, mean = _FIRST_SAMPLES, None, None
    if begin is not None:
        found = _same_harmonics(*begin)
        samples = max(samples, len(found) + _LEFT_OUT)
    if scene.about != "given":
        mean = held_along_axis(scene, probe)
    while samples <= _MOST_SAMPLES:
        search = _Search(scene, probe, samples, tolerance or _AT_REST, tolerance is None, mean)
        try:
            points, found = search.found(found)
        except UnconvergedError as error:
            if not probe.speed or samples > _MOST_UNRESOLVED or begin is not None:
                raise
            check_elements(scene, probe, error)
            search, points, found = _followed(search)
            samples = search.samples
        if points is not None:
            return points, search.orders, found
        samples *= 2
    raise _unresolved(probe.speed)


def _same_harmonics(orders: np.ndarray, harmonics: np.ndarray) -> np.ndarray:
    """Return harmonics from −n to n of a motion by some of its harmonics."""
    most = np.abs(orders).max()
    found = np.zeros((2 * most + 1, harmonics.shape[1]), dtype=complex)
    found[orders + most] = harmonics
    return found


class _UnresolvedError(UnconvergedError):
    """Too few angles for the coefficients over a revolution."""


class _UnheldError(UnconvergedError):
    """Where the search begins, nothing holds a load."""


def _unresolved(speed: float) -> UnconvergedError:
    return _UnresolvedError(
        f"linear scene at {speed:g} rad/s: {_MOST_SAMPLES} angles of a revolution do not "
        "resolve the coefficients; is there a stop, contact or friction, or an oil film whose edge "
        "moves from node to node? about='equilibrium' leaves the rotor's own unbalance out, as "
        "linear_model(rotor, supports=…) does; a damped run from rest shows the motion"
    )


def _followed(search: _Search) -> tuple[_Search, list[LinearPoint] | None, np.ndarray]:
    """Return the search that found the motion, its equations, and the harmonics.

    A film that is all but closed somewhere is unlike itself at few angles: then it takes more.
    """
    try:
        return search, *search.followed()
    except UnconvergedError:
        if search.samples == _MOST_UNRESOLVED:
            raise
        finer = replace(search, samples=_MOST_UNRESOLVED)
        return finer, *finer.followed(_FEW_STRIDES)


@dataclass(frozen=True, eq=False)
class _Search:
    """The steady motion by its values at `samples` angles.

    `tolerance` counts relative to the motion, but for a step of differences in the equations. The
    motion alone does not need resolved equations: Newton's method then takes more steps. `mean`
    are the motions (k, r) whose mean is looked for.
    """

    scene: SceneCoordinates
    probe: Probe
    samples: int
    tolerance: float
    for_equations: bool
    mean: np.ndarray | None = None

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
    def kept(self) -> np.ndarray:
        """Motions (h k, r) in which harmonics are looked for."""
        every = np.eye(self.scene.size)
        return scipy.linalg.block_diag(*(every if n else self.mean for n in self.orders))

    @cached_property
    def spin(self) -> OwnSpin | None:
        names = self.scene.interfaces
        return OwnSpin.of(self.scene, [self.scene.interface_motion(name) for name in names])

    @cached_property
    def is_free(self) -> bool:
        """Whether nothing presses the elements of a rolling bearing."""
        return loose_bearing(self.scene, self.probe) is not None

    def found(self, start: np.ndarray | None) -> tuple[list[LinearPoint] | None, np.ndarray]:
        """Return the linearised scene, None where more samples are needed, and the harmonics.

        It begins with those of fewer samples.
        """
        most = _MOST_FREE if self.is_free else _MOST_ITERATIONS
        return self._newton(self._start(start), 0.0, most)

    def points(self, found: np.ndarray) -> list[LinearPoint]:
        """Return the scene linearised about a motion by its harmonics."""
        return self._points(self._start(found))

    def followed(self, most: int = _MOST_STRIDES) -> tuple[list[LinearPoint] | None, np.ndarray]:
        """Return as :meth:`found`, beginning with the equilibria at rest where there are any.

        What is unbalanced there at the speed is taken away in up to so many steps.
        """
        Y = self._start(None)
        try:
            orders, still = motion_at_rest(self.scene, self.probe.at_rest(), _AT_REST, 0.0)
        except UnconvergedError:
            pass  # films carry nothing at rest
        else:
            common = np.intersect1d(orders, self.orders)
            Y[np.isin(self.orders, common)] = still[np.isin(orders, common)]
        first, rough = self._left(Y), replace(self, tolerance=max(self.tolerance, _ON_THE_WAY))
        left, stride = 1.0, _FIRST_STRIDE
        for tries in range(most, 0, -1):
            if stride * (2.0**tries - 1.0) < left:
                break  # too far, though each were to succeed and the next twice as long
            goal = max(left - stride, 0.0)
            try:
                search = rough if goal else self
                points, Y = search._newton(Y, goal * first, _MOST_FOLLOWED)
            except _UnheldError:  # a share of the load is not held either
                raise
            except UnconvergedError:
                stride *= 0.5
                continue
            left, stride = goal, 2.0 * stride
            if not left:
                return points, Y
        raise self._lost()

    def _newton(
        self, Y: np.ndarray, wanted: np.ndarray | float, most: int
    ) -> tuple[list[LinearPoint] | None, np.ndarray]:
        """Return linearised scene and harmonics with the residual wanted, beginning at Y."""
        change, before, shortened = np.zeros_like(Y), np.inf, False
        iteration = -1
        while (iteration := iteration + 1) < most:
            points = self._points(Y)
            resolved = is_resolved(points)
            if self.scene.about == "given":
                return points if resolved else None, Y
            if not resolved and (self.for_equations or self.samples > _MOST_UNRESOLVED):
                return None, Y
            metres = 1.0 / self.scene.metre(np.diag(points[0].M))
            residual = self._residual([point.residual for point in points], Y) - wanted
            size = float(np.linalg.norm(residual / metres))
            if size > _RISE * before and not shortened:
                Y, halvings = self._shortened(Y, change, wanted, metres, before)
                # among elements that nothing presses each counts: few motions repeat there
                iteration, shortened = iteration + (halvings - 1) * self.is_free, True
                continue
            before, shortened = size, False
            K = hill_stiffness(points, self.orders, self.probe.speed)
            change, left = (X.reshape(Y.shape) for X in solved_in(self.kept, K, -residual.ravel()))
            # there are no forces before the first step
            torque, twist = self._own_spin(points if iteration else None, K, Y + change)
            change = change - torque * twist
            Y = Y + change
            sizes = np.abs(Y * metres).max(axis=1)
            unheld = np.abs(left / metres).max() / (UNHELD * self.scene.mass)
            if unheld > _HOPELESS and not iteration:
                raise _UnheldError(str(self._lost()))
            if unheld > 1.0 or sizes.max() > FAR * self.scene.length:
                break
            tail = sizes[[0, 1, -2, -1]].max()  # as much as the harmonics leave out
            limit = self.tolerance * max(sizes.max(), self._counts(sizes))
            goal = max(self.tolerance * self._counts(sizes), _SOLVED * (tail - limit))
            balanced = np.abs(residual / metres).max() <= BALANCED * self.scene.mass
            if np.abs(change * metres).max() < goal or (balanced and iteration > _FEW_ITERATIONS):
                self._check_spin(torque)
                if not resolved and self.samples == _MOST_UNRESOLVED:
                    limit = max(limit, _ROUGH * sizes.max())
                return points if tail <= limit else None, Y
        raise self._lost()

    def _shortened(
        self,
        Y: np.ndarray,
        change: np.ndarray,
        wanted: np.ndarray | float,
        metres: np.ndarray,
        before: float,
    ) -> tuple[np.ndarray, int]:
        """Return harmonics on the way back to those before a change, and how often it is halved.

        The measure is what is unbalanced. The forces alone cost a fortieth of what their slopes do.
        """
        halvings = 0
        while halvings < _MOST_HALVINGS:
            change, halvings = 0.5 * change, halvings + 1
            Y = Y - change
            if np.linalg.norm((self._left(Y) - wanted) / metres) <= _RISE * before:
                break
        return Y, halvings

    def _left(self, Y: np.ndarray) -> np.ndarray:
        return self._residual([unbalanced(self.probe, *at) for at in self._motion(Y)], Y)

    def _lost(self) -> UnconvergedError:
        return UnconvergedError(
            f"linear scene at {self.probe.speed:g} rad/s: no steady motion found; is there a load "
            "that nothing holds, a resonance without damping, a stop or a bearing with clearance "
            "that the rotor leaves and hits, or an oil film that unbalance all but closes, or that "
            "whirls at half the speed? A run shows what the rotor does there: a damped one from "
            "rest, or one from the steady_state with less unbalance; periodic_response "
            "shows its motion on rolling bearings; about='given' needs no steady motion"
        )

    def _residual(self, left: list[np.ndarray], Y: np.ndarray) -> np.ndarray:
        """Return the harmonics (h, k) of what the forces leave unbalanced at the angles."""
        found = self.waves.conj().T @ np.array(left) / self.samples
        if self.scene.about == "equilibrium":
            found[self.orders == 0] += self.probe.speed**2 * self.scene.unit_unbalance
        return found

    def _start(self, found: np.ndarray | None) -> np.ndarray:
        if found is None:
            return journal_start(self.scene, self.probe.speed, self.orders)
        more = (len(self.orders) - len(found)) // 2
        return np.pad(found, ((more, more), (0, 0)))

    def _points(self, Y: np.ndarray) -> list[LinearPoint]:
        """Return the scene linearised at all angles of the motion, by steps that are for it."""
        self.probe.step = self.probe.velocity_step = None
        self.probe.forget()
        return [linearised(self.probe, *at) for at in self._motion(Y)]

    def _motion(self, Y: np.ndarray) -> Iterator[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
        """Return every angle with the motion there, its rate and acceleration."""
        rates = 1j * self.orders[:, None] * self.probe.speed
        motion = ((self.waves @ (Y * rates**n)).real for n in range(3))
        return zip(self.angles, *motion, strict=True)

    def see(self, found: np.ndarray) -> None:
        """See where bearings are in a motion by its harmonics."""
        self.probe.forget()
        for theta, y, y_t, _ in self._motion(self._start(found)):
            self.probe.see(theta, y, y_t)

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
        twist = solved_in(self.kept, K, self.spin.torque(self.orders))[0].reshape(Y.shape)
        return self.spin.drive_torque(twist[middle], Y[middle], least), twist

    def _counts(self, sizes: np.ndarray) -> float:
        """Return the motion of which the tolerance is a share."""
        # what the equations need is the motion to a share of their step of differences
        return self.probe.straight if self.for_equations else max(sizes.max(), SMALLEST)

    def _check_spin(self, torque: float) -> None:
        if self.spin is not None and not self.for_equations:
            most = UNHELD * np.sqrt(self.scene.mass)
            self.spin.check_held(torque, most, self.probe.speed)
