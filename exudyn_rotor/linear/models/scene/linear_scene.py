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
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import ClassVar

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.journal_bearing import JournalBearing
from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.points import Ring, ring_motions, ring_size, with_pairs
from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.linear.models.scene.journal_start import across
from exudyn_rotor.linear.models.scene.motion_at_rest import motion_at_rest
from exudyn_rotor.linear.models.scene.probe import Probe, probing
from exudyn_rotor.linear.models.scene.scene_checks import check_period, check_scene
from exudyn_rotor.linear.models.scene.scene_coordinates import SceneCoordinates, nullspace
from exudyn_rotor.linear.models.scene.steady_motion import equations_about, steady_motion
from exudyn_rotor.linear.models.whole_space import InAllCoordinates
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.multibody.rotor.marker_body import around
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.start_state import spin_at_start
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.reduction.mode_kind import ModeKind
from exudyn_rotor.theory.nodal import skew

Journal = Sequence[tuple[np.ndarray, np.ndarray] | None]
_ANGLES = 12  # of a revolution, for the mean mass
ABOUT = ("steady", "equilibrium", "given")


@dataclass(frozen=True, eq=False)
class LinearScene(SceneCoordinates, InAllCoordinates):
    """An assembled scene around one rotor, ready for any spin speed; made by :meth:`of`.

    Attributes
    ----------
    body, free, N, rest
        See :class:`SceneCoordinates`.
    about : {'steady', 'equilibrium', 'given'}
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
        about : {'steady', 'equilibrium', 'given'}
            ``'steady'``: for every speed the periodic motion under the scene's loads and the
            rotor's own unbalance is found first, beginning from the current state, e.g. a static
            solution; it matters where bearings are nonlinear. ``'equilibrium'``: the same without
            the rotor's own unbalance, and films about rest under their mean force, dampers on
            their `orbit` and rolling bearings by their mean stiffness, as bearings in a list of
            supports are linearised.
            ``'given'``: the current state of everything but the rotor, and the rotor undeformed,
            journals in their equilibria under the weight or the load of their bearings.

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

    @cached_property
    def mass_matrix(self) -> np.ndarray:
        """Mean mass matrix of the given state, shape (k, k); films need no equilibrium for it."""
        with self._probing(0.0) as probe:
            return probe.mean_mass(_ANGLES)

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

        Cages of rolling bearings stand where they are when the rotor starts.

        Raises
        ------
        UnconvergedError
            Where no steady motion is found, or 192 angles do not resolve the coefficients.
        """
        with self._probing(checks.number(speed, "speed", "rad/s")) as probe:
            system = equations_about(self, probe)
            self._journals[float(speed)] = [film.seen for film in probe.remembering]
        return system

    @cached_property
    def _journals(self) -> dict[float, list[Journal]]:
        return {}

    def journals(self, speed: float) -> list[Journal]:
        """Return how :meth:`at` found the journals of :attr:`remembering` films.

        Place [m] and force [N] along (n1, n2) at the angles of a revolution, None outside the film.
        """
        return self._journals[float(speed)]

    @property
    def remembering(self) -> list[SceneSupport]:
        """Journal bearings whose films conserve mass."""
        journals = [one for one in self.body.supports if isinstance(one.support, JournalBearing)]
        return [one for one in journals if one.support.remembers]

    def journal_motion(self, name: str) -> np.ndarray:
        """Return the displacement (3, k) of a journal along (n1, n2), rotor frame."""
        return np.vstack([across(self, name), np.zeros(len(self.free))]) @ self.N

    def base_motion(self, support: SceneSupport) -> np.ndarray:
        """Return the displacement (3, k) along (n1, n2, e) of what carries a support, inertial."""
        marker = self.body.mbs.GetObject(support.objects[0])["markerNumbers"][0]
        with probing(self, 0.0) as probe:
            return self.body.standing_axes.T @ probe.motion_of(marker) @ self.N

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
        with self._probing(checks.number(speed, "speed", "rad/s")) as probe:
            check_period(self, probe)
            if speed == 0.0 and ModeKind.SPIN not in self.body.selection.kinds:
                return motion_at_rest(self, probe, tolerance, spin_at_start(self.body)[0])
            _, orders, harmonics = steady_motion(self, probe, tolerance)
        return orders, harmonics

    @contextmanager
    def _probing(self, speed: float) -> Iterator[Probe]:
        """Open the scene for probing, its cages as they are when the rotor starts."""
        with probing(self, speed, cage=spin_at_start(self.body)[0]) as probe:
            yield probe

    def undamped(self) -> LinearScene:
        """Return the scene itself: of damping only the skew part is in Hermitian equations."""
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
