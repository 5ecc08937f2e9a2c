"""A scene with a rotor, ready to be linearised about its equilibrium or searched for its motion.

The unknowns are the rotor's translations in axes that turn with it, its modal coordinates, and the
coordinates of everything else as they are in the scene: foundations stay inertial. The spin is
prescribed, θ = Ωt.

Neglected: the change of mass matrices and constraint directions along small steady motions.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import exudyn
import numpy as np
import scipy.linalg as la

from exudyn_rotor import checks
from exudyn_rotor.bearings.actuator import SaturatingActuator
from exudyn_rotor.bearings.annular_seal import AnnularSeal
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.calls import kept
from exudyn_rotor.linear.equations import others
from exudyn_rotor.linear.model.body import RotorAlone
from exudyn_rotor.linear.model.scene.equilibrium import motion_at_rest
from exudyn_rotor.linear.model.scene.probe import probing
from exudyn_rotor.linear.model.scene.scene_checks import check_period, check_scene
from exudyn_rotor.linear.model.scene.scene_coordinates import Motion, SceneCoordinates, nullspace
from exudyn_rotor.linear.model.scene.steady_motion import steady_motion
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.multibody.supports.ends import BaseEnd
from exudyn_rotor.reduction.reduced_rotor import ModeKind

_HELD = 1e-8  # share of a motion of the rotor that is none of the scene


@dataclass(frozen=True, eq=False)
class LinearScene(SceneCoordinates):
    """An assembled scene around one rotor, ready for any spin speed; made by :meth:`of`."""

    @classmethod
    def of(cls, mbs: exudyn.MainSystem, body: RotorBody) -> LinearScene:
        """Prepare the linearisation of an assembled scene; `mbs` is left as it is.

        Whether and at which speed the rotor spins in `mbs` plays no part.

        Raises
        ------
        TypeError, ValueError
            For a system that is not assembled, a body of another system, a second rotor,
            coordinates of first order, and constraints that turn with the rotor.
        """
        check_scene(mbs, body)
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
        return cls(body, free, nullspace(C[0]), rest)

    # ------------------------------------------------------------------ the rotor

    @cached_property
    def spin_column(self) -> np.ndarray:
        """Columns of the reduced rotor by a free spin, (n, 1); (n, 0) where it is prescribed."""
        source = self.body.selection.source
        if not self.body.formulation.has_spin:
            return np.zeros((source.size, 0))
        center = source.center_of_mass
        return source.invariants.moved(source.axis.project(center) - center).g[:, None]

    @cached_property
    def by_columns(self) -> np.ndarray:
        """Unknowns that move the rotor by the coordinates of the reduced rotor, (r, n)."""
        both = np.hstack([self.columns, self.spin_column])
        return np.linalg.pinv(both)[: self.columns.shape[1]]

    @kept
    def held(self, alone: RotorAlone) -> np.ndarray:
        """Return motions of a rotor that it does not have in the scene, orthonormal (k, f)."""
        columns = np.hstack([self.columns, self.spin_column])
        if len(alone.Q) > len(columns):  # in a richer basis
            inner = self.body.selection.source.in_attached
            columns = np.hstack([inner @ columns, la.null_space(inner.T)])
        return la.null_space((columns / np.linalg.norm(columns, axis=0)).T @ alone.Q, rcond=_HELD)

    @kept
    def rotor(self, alone: RotorAlone, whole: bool) -> RotorAlone:
        """Return a rotor without motions that it does not have in the scene."""
        held = self.held(alone)
        if not held.shape[1]:
            return alone
        return alone.within(others(held if whole else la.orth(alone.turning.still @ held)))

    # ------------------------------------------------------------------ what is beside it

    @cached_property
    def others(self) -> np.ndarray:
        """Unknowns of what is neither the rotor nor a support, shape (o,)."""
        own = [self.own_unknowns(one) for one in self.body.supports]
        return np.setdiff1d(np.flatnonzero(~self.touching), np.concatenate([[], *own]))

    def own_unknowns(self, support: SceneSupport) -> np.ndarray:
        """Return the unknowns that a support brings with it: of a controller or pads, (p,)."""
        places = [np.flatnonzero(self.free == n) for n in support.own_coordinates(self.body.mbs)]
        rows = self.N[np.concatenate([[], *places]).astype(int)]
        return np.argmax(rows != 0.0, axis=1).astype(int)

    @cached_property
    def mass_beside(self) -> np.ndarray:
        """Mass matrix of the :attr:`others`, shape (o, o)."""
        with probing(self, 0.0) as probe:
            return probe.mass_beside()[np.ix_(self.others, self.others)]

    def base_motion(self, base: BaseEnd) -> np.ndarray:
        """Return the motion (6, o) along (n1, n2, e) of what carries a support, by the others."""
        motion = np.zeros((6, len(self.rest)))
        read = self.body.mbs.systemData.GetNodeLTGODE2
        places = np.concatenate([read(node) for node in base.nodes]).astype(int)
        base.read(self.rest[places].tolist(), [0.0] * len(places))
        motion[:, places] = base.rows()
        return motion[:, self.free] @ self.N[:, self.others]

    # ------------------------------------------------------------------ steady motion

    def steady_motion(self, speed: float, tolerance: float, start: Motion | None = None) -> Motion:
        """Return the steady motion at a spin speed [rad/s] by its harmonics of the revolution.

        Orders (h,) and harmonics (h, k) of ``y(θ) = Re Σ y_n exp(inθ)``, as deviations from
        :attr:`rest`. Newton's last change, and the highest harmonics, are below `tolerance` of the
        motion; the search begins with the motion `start` where one is given. Cages of rolling
        bearings stand where they are when the rotor starts.

        Raises
        ------
        UnconvergedError
            Where no steady motion is found, or 192 angles do not resolve it, where loads do not
            repeat with every revolution, and where nothing holds the own spin of a rotor with an
            elastic drive against a torque.
        """
        with probing(self, checks.number(speed, "speed", "rad/s")) as probe:
            check_period(self, probe)
            if speed == 0.0 and ModeKind.SPIN not in self.body.selection.kinds:
                return motion_at_rest(self, probe, tolerance, self.body.placement.angle, start)
            return steady_motion(self, probe, tolerance, start)


def follows_load(one: Given) -> bool:
    """Return whether the coefficients of a support depend on its static load."""
    if isinstance(one, MagneticBearing):
        return isinstance(one.actuator, SaturatingActuator)
    return isinstance(one, Bearing) and not isinstance(one, AnnularSeal)
