"""A scene with a rotor, linearised over one revolution of its steady state.

The unknowns are the rotor's translations in axes that turn with it, its modal coordinates, and the
coordinates of everything else as they are in the scene: foundations stay inertial. The spin is
prescribed, θ = Ωt. What is beside the rotor comes from central differences of Exudyn's forces, with
the state turning at Ω, taken at several angles of a revolution, so that no angle is frozen.

Neglected: the change of mass matrices and constraint directions along small steady motions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.journal_bearing import JournalBearing
from exudyn_rotor.linear.model.scene.equilibrium import motion_at_rest
from exudyn_rotor.linear.model.scene.probe import LinearPoint, Probe, probing
from exudyn_rotor.linear.model.scene.scene_checks import check_period, check_scene
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates, nullspace
from exudyn_rotor.linear.model.scene.steady_motion import points_about, steady_motion
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.start_state import spin_at_start
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.reduction.fields import ModeKind

Journal = Sequence[tuple[np.ndarray, np.ndarray] | None]
_ANGLES = 12  # of a revolution, for the mean mass
ABOUT = ("steady", "equilibrium", "given")


@dataclass(frozen=True, eq=False)
class LinearScene(SceneCoordinates):
    """An assembled scene around one rotor, ready for any spin speed; made by :meth:`of`.

    Attributes
    ----------
    body, free, N, rest, about
        See :class:`SceneCoordinates`.
    """

    @classmethod
    def of(cls, mbs: exudyn.MainSystem, body: RotorBody, *, about: str = "steady") -> LinearScene:
        """Prepare the linearisation of an assembled scene; `mbs` is left as it is.

        Whether and at which speed the rotor spins in `mbs` plays no part.

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

    @cached_property
    def mass_matrix(self) -> np.ndarray:
        """Mean mass matrix of the given state, shape (k, k); films need no equilibrium for it."""
        with self._probing(0.0) as probe:
            return probe.mean_mass(_ANGLES)

    def points(self, speed: float) -> tuple[list[LinearPoint], list[Journal]]:
        """Return the scene linearised at the angles of its steady motion, and journals of films.

        Of :attr:`remembering` films place [m] and force [N] of the journal along (n1, n2) at these
        angles, None outside the film. Cages of rolling bearings stand where they are when the rotor
        starts.

        Raises
        ------
        UnconvergedError
            Where no steady motion is found, or 192 angles do not resolve the coefficients.
        """
        with self._probing(checks.number(speed, "speed", "rad/s")) as probe:
            return points_about(self, probe), [one.seen[0] for one in probe.remembering]

    @property
    def remembering(self) -> list[SceneSupport]:
        """Journal bearings whose films conserve mass."""
        journals = [one for one in self.body.supports if isinstance(one.support, JournalBearing)]
        return [one for one in journals if one.support.remembers]

    def base_motion(self, support: SceneSupport) -> np.ndarray:
        """Return the displacement (3, k) along (n1, n2, e) of what carries a support, inertial."""
        made, motion = support.connector, np.zeros((3, len(self.rest)))
        read = self.body.mbs.systemData.GetNodeLTGODE2
        places = np.concatenate([read(node) for node in made.base.nodes]).astype(int)
        made.base.read(*np.zeros((2, len(places))).tolist())
        motion[:, places] = made.base.rows()[:3]
        return motion[:, self.free] @ self.N

    def steady_motion(
        self, speed: float, tolerance: float, start: tuple | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the steady motion at a spin speed [rad/s] by its harmonics of the revolution.

        Cages of rolling bearings stand where they are when the rotor starts.

        Parameters
        ----------
        speed : float
        tolerance : float
            Largest last change of Newton's method, and largest share of the highest harmonics,
            relative to the motion.
        start : (ndarray, ndarray), optional
            Orders and harmonics of a motion to begin with.

        Returns
        -------
        orders : ndarray of int, shape (h,)
        harmonics : ndarray of complex, shape (h, k)
            ``y(θ) = Re Σ y_n exp(inθ)``, as deviations from :attr:`rest`.

        Raises
        ------
        UnconvergedError
            As :meth:`points`, where loads do not repeat with every revolution, and where nothing
            holds the own spin of a rotor with an elastic drive against a torque.
        """
        with self._probing(checks.number(speed, "speed", "rad/s")) as probe:
            check_period(self, probe)
            if speed == 0.0 and ModeKind.SPIN not in self.body.selection.kinds:
                return motion_at_rest(self, probe, tolerance, spin_at_start(self.body)[0], start)
            return steady_motion(self, probe, tolerance, start)[1:]

    @contextmanager
    def _probing(self, speed: float) -> Iterator[Probe]:
        """Open the scene for probing, its cages as they are when the rotor starts."""
        with probing(self, speed, cage=spin_at_start(self.body)[0]) as probe:
            yield probe
