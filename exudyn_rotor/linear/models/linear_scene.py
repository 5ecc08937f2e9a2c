"""A scene with a rotor, linearised over one revolution of its steady state.

The unknowns are the rotor's translations in axes that turn with it, its modal coordinates, and the
coordinates of everything else as they are in the scene: foundations stay inertial. The spin is
prescribed, θ = Ωt. The rotor's own terms are exact (:class:`exudyn_rotor.Motion` at Ω); those of
the rest are central differences of Exudyn's forces, with the state turning at Ω, taken at several
angles of a revolution, so that no angle is frozen.

Neglected: the change of mass matrices and constraint directions along small steady motions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import exudyn
import numpy as np
import scipy.linalg

from exudyn_rotor import checks
from exudyn_rotor.linear.models.journal_start import journal_start
from exudyn_rotor.linear.models.own_spin import OwnSpin
from exudyn_rotor.linear.models.points import Ring, ring_motions, ring_size, with_pairs
from exudyn_rotor.linear.models.probe import Probe, linearised, probing
from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.linear.models.scene_checks import check_scene
from exudyn_rotor.linear.models.scene_coordinates import SceneCoordinates, nullspace
from exudyn_rotor.linear.models.whole_space import InAllCoordinates
from exudyn_rotor.linear.periodic.harmonics import hill_matrices
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms, UnconvergedError
from exudyn_rotor.multibody.marker_body import around
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.multibody.start_state import spin_at_start
from exudyn_rotor.multibody.support_connectors import held_cages
from exudyn_rotor.theory.nodal import skew

ABOUT = ("steady", "given")
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


@dataclass(frozen=True, eq=False)
class LinearScene(SceneCoordinates, InAllCoordinates):
    """An assembled scene around one rotor, ready for any spin speed; made by :meth:`of`.

    Attributes
    ----------
    body, free, N, rest
        See :class:`SceneCoordinates`.
    about : {'steady', 'given'}
        Motion about which the scene is linearised.
    """

    gives_all: ClassVar[bool] = True
    is_full: ClassVar[bool] = False
    free_motions: ClassVar[tuple[str, ...]] = ()
    mesh: ClassVar[None] = None
    base_loads: ClassVar[None] = None
    radius: ClassVar[float] = 1.0
    stiffness_varies: ClassVar[None] = None
    standing_interfaces: ClassVar[tuple[str, ...]] = ()

    about: str = "steady"

    @classmethod
    def of(cls, mbs: exudyn.MainSystem, body: RotorBody, *, about: str = "steady") -> LinearScene:
        """Prepare the linearisation of an assembled scene; `mbs` is left as it is.

        Whether and at which speed the rotor spins in `mbs` plays no part.

        Parameters
        ----------
        mbs : exudyn.MainSystem
        body : RotorBody
            From :func:`exudyn_rotor.add_rotor`.
        about : {'steady', 'given'}
            ``'steady'``: for every speed the periodic motion under the scene's loads and the
            rotor's own unbalance is found first, beginning from the current state, e.g. a static
            solution; it matters where bearings are nonlinear. ``'given'``: the current state of
            everything but the rotor, and the rotor undeformed.

        Raises
        ------
        TypeError, ValueError
            For a system that is not assembled, a body of another system, a second rotor,
            coordinates of first order, and constraints that turn with the rotor.
        """
        check_scene(mbs, body)
        checks.choice(about, "about", ABOUT)
        rotor = np.asarray(mbs.systemData.GetObjectLTGODE2(body.objects["physics"]), dtype=int)
        alone = SceneCoordinates.of(body)
        rest = alone.rest
        free = np.r_[alone.free, np.setdiff1d(np.arange(len(rest)), rotor)]
        with probing(SceneCoordinates(body, free, np.eye(len(free)), rest), 0.0) as probe:
            C = [probe.constraints(angle) for angle in (0.0, 1.0, 2.5)]
        if any(X.shape != C[0].shape or np.abs(X - C[0]).max(initial=0.0) > 1e-6 for X in C):
            raise ValueError(
                "linear scene: a constraint turns with the rotor; hold the rotor by springs "
                "(bearings) instead of joints"
            )
        return cls(body, free, nullspace(C[0]), rest, about)

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the interfaces that have a marker."""
        return tuple(self.body.markers)

    @cached_property
    def standing(self) -> np.ndarray:
        """Coordinates of everything but the rotor and what turns with it."""
        turning = [*range(self.modal.stop), *self.pairs.ravel()]
        return np.flatnonzero(~np.any(self.N[turning], axis=0))

    @property
    def mass_matrix(self) -> np.ndarray:
        """Mean mass matrix at rest, shape (k, k)."""
        return self.at(0.0).M[0]

    @cached_property
    def unit_unbalance(self) -> np.ndarray:
        """Load of the rotor's own eccentricity per Ω², (66) and (87), shape (k,), rotor frame.

        A moving frame has its origin in the centre of mass, which then carries the unbalance.
        """
        inv, body = self.body.motion.invariants, self.body
        load = np.zeros(len(self.free))
        across = body.axis.radial(body.frame.origin)
        load[: self.count] = self.axes[:, : self.count].T @ (inv.mass * across)
        load[self.modal] = inv.h
        return self.N.T @ load

    @property
    def is_balanced(self) -> bool:
        """True where the rotor has no unbalance at all."""
        return not np.any(self.unit_unbalance)

    @property
    def has_structural_damping(self) -> bool:
        """True where steady motions have structural damping, which other analyses leave out."""
        return self.structural_damping is not None

    @cached_property
    def structural_damping(self) -> np.ndarray | None:
        """H of the rotor's own modes, shape (k, k); the steady motion is found without it."""
        H = self.body.motion.invariants.H
        return None if H is None else self.N[self.modal].T @ H @ self.N[self.modal]

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's motion (6, k): displacement and rotation along (n1, n2, e).

        In the rotor frame, as its marker moves, the marker's offset included.

        Raises
        ------
        KeyError
            For an interface without a marker.
        """
        motion = np.zeros((6, len(self.free)))
        motion[: self.count, : self.count] = np.eye(self.count)
        turn = np.kron(np.eye(2), self.axes.T @ self.body.frame.B.T)
        motion[:, self.modal] = turn @ _marker_motion(self.body, name)
        return motion @ self.N

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s], about the steady motion there.

        Raises
        ------
        UnconvergedError
            Where no steady motion is found, or 192 angles do not resolve the coefficients.
        """
        with probing(self, checks.number(speed, "speed", "rad/s")) as probe:
            return _resolved(self, probe, _AT_REST)[0]

    def steady_motion(self, speed: float, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the steady motion at a spin speed [rad/s] by its harmonics of the revolution.

        Cages of rolling bearings stand where they are when the rotor starts.

        Parameters
        ----------
        speed : float
        tolerance : float
            Largest last change of Newton's method, and largest share of the highest harmonics,
            relative to the motion.

        Returns
        -------
        orders : ndarray of int, shape (h,)
        harmonics : ndarray of complex, shape (h, k)
            ``y(θ) = Re Σ y_n exp(inθ)``, as deviations from :attr:`rest`.

        Raises
        ------
        UnconvergedError
            As :meth:`at`, where loads do not repeat with every revolution, and where nothing holds
            the own spin of a rotor with an elastic drive against a torque.
        """
        checks.number(speed, "speed", "rad/s")
        with held_cages(self.body, spin_at_start(self.body)[0]), probing(self, speed) as probe:
            _check_period(self, probe)
            _, orders, harmonics = _resolved(self, probe, tolerance)
        return orders, harmonics

    def undamped(self) -> LinearScene:
        """Return the scene itself: its damping does not enter the Hermitian part of equations."""
        return self

    def point_motions(self, most: int) -> PointMotions:
        """Return rings of the rotor's radius of gyration, one for every marker, side by side.

        And points for the coordinates of magnetic bearings.
        """
        inertia = self.body.motion.invariants
        radius = np.sqrt(inertia.Theta / inertia.mass)
        rings = [
            Ring(np.array([0.0, 0.0, float(i)]), radius, self.interface_motion(name))
            for i, name in enumerate(self.interfaces)
        ]
        given = replace(ring_motions(rings, self.size), standing=self._standing_amplitudes(rings))
        return with_pairs(given, self.N[self.pairs.ravel()])

    def _standing_amplitudes(self, rings: Sequence[Ring]) -> np.ndarray:
        """Return the motion of everything but the rotor, mass for mass as large as the rings'."""
        with probing(self, 0.0) as probe:
            mass = self.N.T @ probe.mass() @ self.N
        values, vectors = np.linalg.eigh(mass[np.ix_(self.standing, self.standing)])
        share = np.sqrt(ring_size(rings) / self.mass)
        amplitudes = np.zeros((len(values), self.size))
        amplitudes[:, self.standing] = share * (vectors * np.sqrt(np.maximum(values, 0.0))).T
        return amplitudes


def _resolved(
    scene: LinearScene, probe: Probe, tolerance: float
) -> tuple[PeriodicSystem, np.ndarray, np.ndarray]:
    """Return equations, orders and harmonics of the steady motion, at as many angles as needed."""
    samples, found = _FIRST_SAMPLES, None
    while samples <= _MOST_SAMPLES:
        system, *found = _about_steady_motion(scene, probe, samples, tolerance, found)
        if system is not None:
            return system, *found
        samples *= 2
    raise UnconvergedError(
        f"linear scene at {probe.speed:g} rad/s: {_MOST_SAMPLES} angles of a revolution do not "
        "resolve the coefficients; is there a stop, contact or friction, or an oil film whose edge "
        "moves from node to node? linear_model(rotor, supports=…) takes bearings in equilibrium; "
        "a damped run from rest shows the motion"
    )


def _check_period(scene: LinearScene, probe: Probe) -> None:
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


def _about_steady_motion(
    scene: LinearScene,
    probe: Probe,
    samples: int,
    tolerance: float,
    found: Sequence[np.ndarray] | None,
) -> tuple[PeriodicSystem | None, np.ndarray, np.ndarray]:
    """Linearise about the steady motion, found by Newton's method on its harmonics.

    Returned are the equations, None where more samples are needed, the orders and the harmonics;
    it begins with those `found` at fewer samples.
    `tolerance` counts relative to the motion, but for a step of differences in the equations. The
    motion alone does not need resolved equations: Newton's method then takes more steps.
    """
    speed, equations = probe.speed, tolerance == _AT_REST
    angles = 2.0 * np.pi * np.arange(samples) / samples
    orders = np.arange(-samples // 2 + 2, samples // 2 - 1)
    waves = np.exp(1j * np.outer(angles, orders))
    Y, middle = journal_start(scene, speed, orders), np.flatnonzero(orders == 0)[0]
    if found is not None:
        Y = np.zeros_like(Y)
        Y[np.isin(orders, found[0])] = found[1]
    spin = OwnSpin.of(scene, [scene.interface_motion(name) for name in scene.interfaces])
    change, share, before = np.zeros_like(Y), 1.0, np.inf
    for iteration in range(_MOST_ITERATIONS):
        motion = [(waves @ (Y * (1j * orders[:, None] * speed) ** n)).real for n in range(3)]
        points = [linearised(probe, *point) for point in zip(angles, *motion, strict=True)]
        terms, resolved = zip(*(_terms(*entry) for entry in _scaled(points)), strict=True)
        if not all(resolved) and (equations or samples > _MOST_UNRESOLVED):
            return None, orders, Y
        system = PeriodicSystem(speed, *terms, scene.structural_damping, probe.rounding)
        if scene.about == "given":
            return system, orders, Y
        residual = waves.conj().T @ np.array([point[3] for point in points]) / samples
        metres = 1.0 / scene.metre(np.diag(system.M[0]))
        size = np.linalg.norm(residual / metres)
        if size > _RISE * before and share > _LEAST_SHARE:
            change, share = 0.5 * change, 0.5 * share
            Y = Y - change
            continue
        before, share = size, 1.0
        K = hill_matrices(system, orders)[2]
        change, left = (X.reshape(Y.shape) for X in _solved(K, -residual.ravel()))
        if spin is not None:
            forces = np.mean([point[4] for point in points], axis=0)
            least = spin.least_stiffness(system.K[0], forces, probe.rounding)
            least = np.inf if iteration == 0 else least  # there are no forces before
            twist = _solved(K, spin.torque(orders))[0].reshape(Y.shape)
            torque = spin.drive_torque(twist[middle], (Y + change)[middle], least)
            change = change - torque * twist
        Y = Y + change
        if np.abs(left / metres).max() > _UNHELD * scene.mass:
            break
        moved = np.abs(change * metres)
        sizes = np.abs(Y * metres).max(axis=1)
        if sizes.max() > _FAR * scene.length:
            break
        # what the equations need is the motion to a share of their step of differences
        counts = probe.step if equations else max(sizes.max(), _SMALLEST)
        if moved.max() < tolerance * counts:
            if spin is not None and not equations:
                spin.check_held(torque, _UNHELD * np.sqrt(scene.mass), speed)
            limit = tolerance * max(sizes.max(), counts)
            return system if sizes[[0, 1, -2, -1]].max() <= limit else None, orders, Y
    raise UnconvergedError(
        f"linear scene at {speed:g} rad/s: no steady motion found; is there a load that nothing "
        "holds, a resonance without damping, or a stop or a bearing with clearance that the rotor "
        "leaves and hits? A damped run from rest shows what it does there; about='given' needs no "
        "steady motion"
    )


def _solved(K: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve with motions that nothing holds left at rest; return what remains of the load, too."""
    rows = np.abs(K).max(axis=1)
    # a row of round-off is not blown up to the size of the others
    scale = 1.0 / np.sqrt(np.maximum(rows, max(_NOISE * rows.max(), 1e-300)))
    scaled = scale[:, None] * K * scale
    solution = scipy.linalg.lstsq(scaled, scale * load, cond=1e-12, lapack_driver="gelsy")
    answer = scale * solution[0]
    return answer, load - K @ answer


def _scaled(points: list[tuple]) -> Iterator[tuple[np.ndarray, np.ndarray, float]]:
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


def _marker_motion(body: RotorBody, name: str) -> np.ndarray:
    """Return displacement and rotation (6, m) of an interface, axes of the marker body."""
    nodes = around(list(body.mbs.GetMarker(body.marker(name))["meshNodeNumbers"]))
    marker_body = body.mbs.GetObject(body.objects["marker_body"])
    columns = np.asarray(marker_body["modeBasis"])
    points = np.reshape(marker_body["referencePositions"], (-1, 3))[nodes]
    columns = columns.reshape(len(columns) // 3, 3, -1)[nodes]
    mean = columns.mean(axis=0)
    turning = np.vstack([-skew(arm) for arm in points - points.mean(axis=0)])  # φ × a = −ã φ
    rotation = np.linalg.lstsq(turning, (columns - mean).reshape(9, -1), rcond=None)[0]
    return np.vstack([mean, rotation])
