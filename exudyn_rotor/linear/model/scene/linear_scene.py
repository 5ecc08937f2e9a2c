"""A scene around one rotor: its unknowns, and how they turn.

The unknowns are the rotor's translations in axes that turn with it, its modal coordinates, and the
coordinates of everything else as they are in the scene: foundations stay inertial. The spin is
θ = Ωt; deviations of a free spin are in the rotor's columns alone.

Neglected: the change of mass matrices and constraint directions along small steady motions.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import exudyn
import numpy as np
import scipy.linalg as la

from exudyn_rotor import checks
from exudyn_rotor.calls import kept
from exudyn_rotor.linear.equations import others
from exudyn_rotor.linear.model.body import RotorAlone
from exudyn_rotor.multibody.evaluation import constraint_rows, evaluating
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, StartState
from exudyn_rotor.multibody.rotor.rotor_items import known_rotors
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.multibody.supports.ends import BaseEnd
from exudyn_rotor.theory.axis import SpinAxis, skew
from exudyn_rotor.theory.rotating_axes import axes_of

_HELD = 1e-8  # share of a motion of the rotor that is none of the scene
_TOUCHED = 1e-14  # entry of a constraint below which it is none of a coordinate
_TURNED = 1e-3  # share of a constraint by which it is one of the spin


@dataclass(frozen=True, eq=False)
class LinearScene:
    """The unknowns y of a scene: the rotor's turn with it, those of everything else do not.

    They are zero where the rotor turns about its axis undeformed, and all else is as it was given.

    Attributes
    ----------
    body : RotorBody
    free : ndarray of int
        Coordinates of the scene that are unknowns: the rotor's first.
    N : ndarray, shape (len(free), k)
        Motions that the scene's constraints allow.
    rest : ndarray
        All coordinates of the given state, the rotor's where its origin is on the axis.
    is_spin_free : bool
        Whether the spin is a coordinate of linear equations.
    """

    body: RotorBody
    free: np.ndarray
    N: np.ndarray
    rest: np.ndarray
    is_spin_free: bool

    @classmethod
    def of_rotor(cls, body: RotorBody) -> LinearScene:
        """Return the unknowns of the rotor alone, everything else as it is now."""
        rest = np.array(body.mbs.systemData.GetODE2Coordinates(), dtype=float)
        count = body.motion.formulation.translation_count
        # translations, then modes
        own = np.delete(body.layout.unknowns, [count] if body.formulation.has_spin else [])
        free = np.asarray(body.mbs.systemData.GetObjectLTGODE2(body.objects["physics"]))[own]
        made = cls(body, free, np.eye(len(free)), rest, body.formulation.has_spin)
        rest[free] = -made.turn(0.0)[0] @ made.undeformed
        return made

    @classmethod
    def of(cls, mbs: exudyn.MainSystem, body: RotorBody) -> LinearScene:
        """Return the unknowns of an assembled scene; `mbs` is left as it is.

        Whether and at which speed the rotor spins in `mbs` plays no part.
        """
        check_scene(mbs, body)
        alone = cls.of_rotor(body)
        rotor = mbs.systemData.GetObjectLTGODE2(body.objects["physics"])
        free = np.r_[alone.free, np.setdiff1d(np.arange(len(alone.rest)), rotor)]
        scene = cls(body, free, np.eye(len(free)), alone.rest, alone.is_spin_free)
        with evaluating(mbs) as solver:
            C, *later = [scene._constraints(solver, angle) for angle in (0.0, 1.0, 2.5)]
        rows, on_spin = C[:, :-1], C[:, -1]
        if any(np.abs(X[:, :-1] - rows).max(initial=0.0) > 1e-6 for X in later):
            raise ValueError(
                "linear scene: a constraint turns with the rotor; hold the rotor by springs "
                "(bearings) instead of joints, and give a part that turns with it to the rotor, "
                "add_disc(…) or add_point_mass(…) of SolidRotor"
            )
        sizes = np.abs(rows).max(axis=1, initial=0.0)
        holds_spin = np.any(np.abs(on_spin) > _TURNED * sizes)
        rows = rows[sizes > _TOUCHED]
        # coordinates that no constraint touches stay as they are
        N = others(rows.T) if len(rows) else scene.N
        return cls(body, free, N, scene.rest, scene.is_spin_free and not holds_spin)

    def _constraints(self, solver: exudyn.MainSolverStatic, theta: float) -> np.ndarray:
        """Return the constraints' Jacobian by the free coordinates as unknowns, and the spin."""
        q, mbs = self.rest.copy(), self.body.mbs
        q[self.spin_coordinate] = theta
        mbs.systemData.SetODE2Coordinates(q)
        mbs.systemData.SetODE2Coordinates_t(0.0 * q)
        C = constraint_rows(mbs, solver, len(q))
        return np.column_stack([C[:, self.free] @ self.turn(theta)[0], C[:, self.spin_coordinate]])

    # ------------------------------------------------------------------ the rotor

    @property
    def size(self) -> int:
        """Number of unknowns k."""
        return self.N.shape[1]

    @property
    def mass(self) -> float:
        """Mass of the rotor [kg]."""
        return self.body.motion.invariants.mass

    @property
    def count(self) -> int:
        """Number of the rotor's translations."""
        return self.body.motion.formulation.translation_count

    @property
    def modal(self) -> slice:
        """Where the rotor's modal coordinates stand among the free ones."""
        return slice(self.count, self.count + self.body.motion.invariants.size)

    @property
    def spin_coordinate(self) -> int:
        """The scene's coordinate θ."""
        body = self.body
        places = body.mbs.systemData.GetObjectLTGODE2(body.objects["physics"])
        return int(places[body.locks.spin])

    @cached_property
    def axes(self) -> np.ndarray:
        """``(n1, n2, e)`` in mesh axes."""
        return axes_of(SpinAxis(self.body.motion.invariants.direction))

    @cached_property
    def undeformed(self) -> np.ndarray:
        """The rotor's origin off the axis as unknowns (k,), which ``T(θ)`` turns about the axis."""
        apart = self.axes.T @ self.body.axis.radial(self.body.frame.origin)
        return self.N[: self.count].T @ apart[: self.count]

    @cached_property
    def touching(self) -> np.ndarray:
        """Which of the unknowns move the rotor, (k,)."""
        return np.any(self.N[: self.modal.stop] != 0.0, axis=0)

    @cached_property
    def columns(self) -> np.ndarray:
        """Columns of the reduced rotor by the unknowns that move it, (n, r)."""
        selection = self.body.selection
        moved = selection.source.invariants.S.T @ self.axes[:, : self.count]
        return np.hstack([moved, selection.T]) @ self.N[: self.modal.stop, self.touching]

    @cached_property
    def _with_spin(self) -> np.ndarray:
        """The :attr:`columns`, then that of a free spin."""
        if not self.is_spin_free:
            return self.columns
        source = self.body.selection.source
        center = source.center_of_mass
        about_axis = source.invariants.moved(source.axis.project(center) - center).g
        return np.column_stack([self.columns, about_axis])

    def of_coordinates(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return unknowns (…, r) that move the rotor, and the turn of a free spin (…).

        By the coordinates (…, n) of the reduced rotor.
        """
        found = x @ np.linalg.pinv(self._with_spin).T
        count = self.columns.shape[1]
        return found[..., :count], found[..., count:].sum(axis=-1)

    @kept
    def held(self, alone: RotorAlone) -> np.ndarray:
        """Return motions of a rotor that it does not have in the scene, orthonormal (k, f)."""
        columns = self._with_spin
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

    def interface_motion(self, name: str) -> np.ndarray:
        """Return displacement and rotation of an interface along (n1, n2, e) that turn, (6, k)."""
        columns = self.body.interface_carrier(name).motion  # of modes, in axes of the marker body
        motion = np.zeros((6, len(self.free)))
        motion[: self.count, : self.count] = np.eye(self.count)
        motion[:, self.modal] = np.kron(np.eye(2), self.axes.T @ self.body.frame.B.T) @ columns
        return motion @ self.N

    def turn(self, theta: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return T, T', T'' by θ: the free coordinates are ``rest + T(θ) (y + undeformed)``."""
        motion, c = self.body.motion, self.count
        A = motion.orientation @ SpinAxis(motion.invariants.direction).rotation(theta)
        e = skew(motion.invariants.direction)
        blocks = []
        for rest, turned in ((1.0, A), (0.0, A @ e), (0.0, A @ e @ e)):
            T = rest * np.eye(len(self.free))
            T[:c, :c] = motion.free_directions.T @ turned @ self.axes[:, :c]
            blocks.append(T @ self.N)
        return tuple(blocks)

    def state(self, y: np.ndarray, y_t: np.ndarray, angle: float, speed: float) -> StartState:
        """Return the state of the whole scene; what is no unknown is at rest.

        Parameters
        ----------
        y, y_t : ndarray, shape (k,)
            The unknowns and their rates.
        angle, speed : float
            Of the spin [rad], [rad/s].
        """
        T, T1, _ = self.turn(angle)
        y = y + self.undeformed
        q, q_t = self.rest.copy(), np.zeros(len(self.rest))
        q[self.free] += T @ y
        q_t[self.free] = T @ y_t + speed * T1 @ y
        spin = self.spin_coordinate
        q[spin], q_t[spin] = angle, speed
        return StartState(q, q_t, angle, speed)

    # ------------------------------------------------------------------ what is beside it

    @cached_property
    def foreign_items(self) -> list[dict]:
        """Objects and loads that are neither the rotor's own nor its supports, as dictionaries."""
        mbs, body = self.body.mbs, self.body
        weight = set() if body.gravity_load is None else {int(body.gravity_load)}
        loads = set(range(mbs.systemData.NumberOfLoads())) - weight
        return [*objects_beside(mbs, known_objects(body)), *map(mbs.GetLoad, sorted(loads))]

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

    def base_motion(self, base: BaseEnd) -> np.ndarray:
        """Return the motion (6, o) along (n1, n2, e) of what carries a support, by the others."""
        motion = np.zeros((6, len(self.rest)))
        read = self.body.mbs.systemData.GetNodeLTGODE2
        places = np.concatenate([read(node) for node in base.nodes]).astype(int)
        base.read(self.rest[places].tolist(), [0.0] * len(places))
        motion[:, places] = base.rows()
        return motion[:, self.free] @ self.N[:, self.others]


def known_objects(body: RotorBody) -> set[int]:
    """Return the numbers of the objects of a rotor and its supports."""
    found = {*map(int, body.objects.values()), *map(int, body.constraints.values())}
    return found | {int(number) for one in body.supports for number in one.objects}


def objects_beside(mbs: exudyn.MainSystem, known: set[int]) -> list[dict]:
    """Return all objects but known ones and grounds, as dictionaries."""
    numbers = sorted(set(range(mbs.systemData.NumberOfObjects())) - known)
    return [item for item in map(mbs.GetObject, numbers) if item["objectType"] != "Ground"]


def check_body(mbs: exudyn.MainSystem, body: RotorBody) -> None:
    """Refuse a system not assembled, another one's rotor, and coordinates of first order."""
    checks.instance(mbs, "mbs", exudyn.MainSystem)
    reduced_body(body, how="exudyn_rotor.add_rotor returned it for the rotor in this system")
    if body.mbs is not mbs:
        raise ValueError(f"rotor {body.name!r} belongs to another mbs")
    body.check_present()
    for one in (*body.supports, *body.drives):
        one.check_present()
    if not mbs.systemIsConsistent:
        raise ValueError("the system is not assembled: call mbs.Assemble() first")
    if mbs.systemData.ODE1Size():
        raise ValueError("linear scene: coordinates of first order (ODE1) are not supported")


def check_scene(mbs: exudyn.MainSystem, body: RotorBody) -> None:
    """Refuse what :func:`check_body` does, and a second rotor."""
    check_body(mbs, body)
    second = [one.name for one in known_rotors(mbs) if one.script is not body.script]
    if second:
        raise ValueError(
            f"linear scene: a second rotor in this system, {second[0]!r}; one revolution is a "
            "period for one spin speed only, which steady_state needs. Linear analyses take "
            "body=[…] with all rotors, on supports of add_supports and linked by connect_rotors, "
            "or a RotorTrain of the reduced rotors"
        )
