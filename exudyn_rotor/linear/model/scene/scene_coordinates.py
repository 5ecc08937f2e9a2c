"""The unknowns of a scene with a rotor, and how they turn."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import exudyn
import numpy as np
import scipy.linalg

from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.multibody.rotor.plan import turned_origin
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, StartState
from exudyn_rotor.theory.axis import SpinAxis, skew
from exudyn_rotor.theory.rotating_axes import axes_of, axial_rotation, axial_skew

# objects without forces: grounds and constraints
_FORCELESS = ("Ground", "ConnectorCoordinate", "ConnectorCoordinateVector", "ConnectorDistance")
Motion = tuple[np.ndarray, np.ndarray]  # orders (h,) and harmonics (h, k)
UNHELD = 1e-6  # m/s² by which loads may accelerate what nothing holds: round-off


@dataclass(frozen=True, eq=False)
class SceneCoordinates:
    """The unknowns: the rotor's in axes that turn with it, those of everything else as they are.

    Pairs of a magnetic bearing's controller turn, too: with control axes that are alike, all
    coefficients are constant then.

    Attributes
    ----------
    body : RotorBody
    free : ndarray of int
        Coordinates of the scene that are unknowns: the rotor's first.
    N : ndarray, shape (len(free), k)
        Motions that the scene's constraints allow.
    rest : ndarray
        All coordinates of the given state.
    """

    body: RotorBody
    free: np.ndarray
    N: np.ndarray
    rest: np.ndarray

    @classmethod
    def of(cls, body: RotorBody) -> SceneCoordinates:
        """Return the unknowns of the rotor alone, everything else as it is now."""
        rotor = np.asarray(body.mbs.systemData.GetObjectLTGODE2(body.objects["physics"]), dtype=int)
        rest = np.array(body.mbs.systemData.GetODE2Coordinates(), dtype=float)
        free = rotor[without_spin(body)]
        made = cls(body, free, np.eye(len(free)), rest)
        rest[free[made.count :]] = 0.0
        # where the rotor is when it has turned back
        angle = rest[made.spin_coordinate]
        turned = turned_origin(body.selection, body.placement.rotation, angle)
        rest[free[: made.count]] -= body.motion.free_directions.T @ turned
        return made

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return self.N.shape[1]

    @property
    def mass(self) -> float:
        """Mass of the rotor [kg]."""
        return self.body.motion.invariants.mass

    @property
    def length(self) -> float:
        """Size of the rotor: √(tr J / m) about the origin of its frame [m]."""
        inertia = self.body.motion.invariants
        return float(np.sqrt(np.trace(inertia.J) / inertia.mass))

    @property
    def modal(self) -> slice:
        """Where the rotor's modal coordinates stand among the free ones."""
        return slice(self.count, self.count + self.body.motion.invariants.size)

    @property
    def count(self) -> int:
        """Number of the rotor's translations."""
        return self.body.motion.formulation.translation_count

    @property
    def spin_coordinate(self) -> int:
        """The scene's coordinate θ."""
        body = self.body
        places = body.mbs.systemData.GetObjectLTGODE2(body.objects["physics"])
        return int(places[body.locks.spin])

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
    def axes(self) -> np.ndarray:
        """``(n1, n2, e)`` in mesh axes."""
        return axes_of(SpinAxis(self.body.motion.invariants.direction))

    @cached_property
    def native(self) -> list[exudyn.ObjectIndex]:
        """Connectors of linear supports that Exudyn evaluates."""
        mbs, numbers = self.body.mbs, [n for one in self.body.supports for n in one.objects]
        return [n for n in numbers if "activeConnector" in mbs.GetObject(n)]

    @cached_property
    def foreign_items(self) -> list[dict]:
        """Objects and loads that are neither the rotor's own nor its supports, as dictionaries."""
        mbs, body = self.body.mbs, self.body
        objects = set(range(mbs.systemData.NumberOfObjects())) - known_objects(body)
        weight = set() if body.gravity_load is None else {int(body.gravity_load)}
        loads = set(range(mbs.systemData.NumberOfLoads())) - weight
        items = filter(_has_force, map(mbs.GetObject, sorted(objects)))
        return [*items, *map(mbs.GetLoad, sorted(loads))]

    @cached_property
    def pairs(self) -> np.ndarray:
        """Where controllers' coordinates along (n1, n2) stand among the free ones, shape (p, 2)."""
        found = []
        for one in self.body.supports:
            if isinstance(one.support, MagneticBearing):
                found.extend(one.own_coordinates(self.body.mbs))
        places = [np.flatnonzero(self.free == number) for number in found]
        return np.concatenate([*places, np.zeros(0)]).astype(int).reshape(-1, 2)

    @cached_property
    def _most(self) -> np.ndarray:
        """The most of each coordinate that counts as a metre: of a pad's tilt, a metre of its bore.

        A light pad moves as little as its journal.
        """
        most = np.full(len(self.rest), np.inf)
        for one in self.body.supports:
            if isinstance(one.support, TiltingPadBearing):
                most[one.own_coordinates(self.body.mbs)] = 1.0 / one.support.film.radius
        return np.array([most[self.free[column != 0.0]].min() for column in self.N.T])

    def metre(self, mass: np.ndarray) -> np.ndarray:
        """Return how much of each coordinate counts as a metre, from the mass matrix's diagonal.

        What moves as much kinetic energy as the rotor by a metre.
        """
        return np.minimum(np.sqrt(self.mass / np.maximum(mass, 1e-300)), self._most)

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's displacement and rotation along (n1, n2, e), (6, k), rotor frame.

        Raises
        ------
        TypeError, ValueError
            For an interface that is not there.
        """
        columns = self.body.interface_carrier(name).motion  # of modes, in axes of the marker body
        motion = np.zeros((6, len(self.free)))
        motion[: self.count, : self.count] = np.eye(self.count)
        motion[:, self.modal] = np.kron(np.eye(2), self.axes.T @ self.body.frame.B.T) @ columns
        return motion @ self.N

    def turn(self, theta: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return T, T', T'' of the free scene coordinates ``T(θ) y``; ' is the derivative by θ."""
        motion, c = self.body.motion, self.count
        A = motion.orientation @ SpinAxis(motion.invariants.direction).rotation(theta)
        e = skew(motion.invariants.direction)
        R, quarter = axial_rotation(theta)[:2, :2], axial_skew(3)[:2, :2]
        blocks = []
        for full, turned, pair in (
            (1.0, A, R),
            (0.0, A @ e, R @ quarter),
            (0.0, A @ e @ e, -R),
        ):
            T = full * np.eye(len(self.free))
            T[:c, :c] = motion.free_directions.T @ turned @ self.axes[:, :c]
            T[self.pairs[:, :, None], self.pairs[:, None]] = pair
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
        q, q_t = self.rest.copy(), np.zeros(len(self.rest))
        q[self.free] += T @ y
        q_t[self.free] = T @ y_t + speed * T1 @ y
        spin = self.spin_coordinate
        q[spin], q_t[spin] = angle, speed
        return StartState(q, q_t, angle, speed)


def known_objects(body: RotorBody) -> set[int]:
    """Return the numbers of the objects of a rotor and its supports."""
    found = {*map(int, body.objects.values()), *map(int, body.constraints.values())}
    return found | {int(number) for one in body.supports for number in one.objects}


def _has_force(item: dict) -> bool:
    """Return whether an object may have a force: no ground, no constraint, no mere mass."""
    kind = item["objectType"]
    if kind == "GenericODE2":
        names = "stiffnessMatrix", "dampingMatrix", "forceVector", "forceUserFunction"
        return any(np.any(item[name]) for name in names)
    return kind not in _FORCELESS and not kind.startswith("Joint")


def without_spin(body: RotorBody) -> np.ndarray:
    """Return the rotor's unknowns among its node coordinates: translations, then modes."""
    count = body.motion.formulation.translation_count
    return np.delete(body.layout.unknowns, [count] if body.formulation.has_spin else [])


def nullspace(C: np.ndarray) -> np.ndarray:
    """Return orthonormal motions that C allows; coordinates that it leaves alone stay as they are.

    C has shape (constraints, coordinates).
    """
    size = C.shape[1]
    touched = np.flatnonzero(np.abs(C).max(axis=0, initial=0.0) > 1e-14)
    untouched = np.setdiff1d(np.arange(size), touched)
    kernel = scipy.linalg.null_space(C[:, touched]) if touched.size else np.zeros((0, 0))
    N = np.zeros((size, len(untouched) + kernel.shape[1]))
    N[untouched, np.arange(len(untouched))] = 1.0
    N[touched, len(untouched) :] = kernel
    return N
