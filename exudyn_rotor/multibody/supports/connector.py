"""What is attached to a rotor in a scene: one object of forces on the coordinates of its ends.

A law has forces by the motion x of ports, with the rows J of the coordinates: displacement and
rotation of an interface against what carries it, and coordinates of the law's own, of a controller
or of pads. Exudyn gets ``Jᵀf`` and the tangent ``Jᵀ(K, D)J``; a law may have a mass matrix.

Newton's method may try states in which a journal is outside its clearance, where forces go on by a
tangent; a step that has been accepted there means nothing. A connector that is evaluated outside
looks at the beginning of its step, the state accepted last, and ends the run by an error where that
was outside, too. Where a :class:`ClearanceStop` acts at the same interface, contact is meant.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import cos, hypot, sin
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import ObjectGenericODE2, SensorUserFunction, VObjectGenericODE2
from scipy.linalg import block_diag

from exudyn_rotor import checks
from exudyn_rotor.bearings.annular_seal import AnnularSeal
from exudyn_rotor.bearings.bearing import Bearing, differences
from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.support import Support, acts
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.plan import generic_node
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, add_sensor
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems, entry
from exudyn_rotor.multibody.supports.ends import QUARTER, BaseEnd, FoundationEnd, RotorEnd
from exudyn_rotor.theory.rotating_axes import axial_rotation, axial_skew

_KINDS = exudyn.OutputVariableType
CURRENT, START = exudyn.ConfigurationType.Current, exudyn.ConfigurationType.StartOfStep
NATIVE, SYMBOLIC, PYTHON = "Exudyn", "symbolic function", "Python function"
_MATRICES = "massMatrix", "dampingMatrix", "stiffnessMatrix"
Body = RotorBody | FullRotorBody
# rows J and L of ports, L the derivative of their rate by the coordinates, and less the derivatives
# K and D of the forces on them by motion and rate
Tangent = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


class Between:
    """The motion of the end of a rotor against that of its base, by the coordinates of both."""

    _read: tuple[list[float], list[float]] | None = None  # the last coordinates and rates

    def __init__(self, end: RotorEnd, base: BaseEnd) -> None:
        self.end, self.base = end, base
        self._first, self._second = end.size, end.size + base.size
        self.size = self._second

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion of the ends from coordinates and their rates."""
        first, second = self._first, self._second
        self.end.read(q[:first], q_t[:first])
        self.base.read(q[first:second], q_t[first:second])
        self._read = q, q_t

    @property
    def relative(self) -> tuple[float, float, float, float, float, float]:
        """Place x, y [m] and velocity of the rotor against the base, spin angle and speed."""
        end, base = self.end, self.base
        (x, y, _), (vx, vy, _) = end.place, end.rate
        (a, b, _), (a_t, b_t, _) = base.place, base.rate
        return x - a, y - b, vx - a_t, vy - b_t, end.angle, end.speed

    @property
    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Motion (6,) and rate (6,) against the base, the spin in the last rate alone."""
        end, base = self.end, self.base
        x = np.array([*end.place, *end.tilt]) - [*base.place, *base.tilt]
        x_t = np.array([*end.rate, *end.tilt_rate]) - [*base.rate, *base.tilt_rate]
        x_t[5] += end.speed
        return x, x_t

    def rows(self, count: int = 6) -> np.ndarray:
        """Return the first rows J (count, size) of the rotor's motion against the base."""
        J = np.zeros((count, self.size))
        J[:, : self._first] = self.end.rows(count)
        J[:, self._first : self._second] = -self.base.rows()[:count]
        return J

    def rate_rows(self) -> np.ndarray:
        """Return the derivative (6, size) of the rotor's rate by the coordinates."""
        L = np.zeros((6, self.size))
        L[:, : self._first] = self.end.rate_rows()
        return L


class Connector(Between, ABC):
    """A law between the end of a rotor and that of its base.

    Its coordinates are those of the `nodes` of both, and `own` more of the law, on a node in `mbs`.
    """

    has_mass = False  # whether a mass, added_mass(), goes with the rotor across the axis
    constant: Sequence[np.ndarray] = ()  # mass, damping and stiffness of own coordinates
    outside = False  # whether it was evaluated beyond a clearance
    guard: Callable[[exudyn.MainSystem], None] | None = None  # looks at the accepted state then
    # spin angle of cages where linear equations take the law itself: its object has no force then
    probed: float | None = None

    def __init__(
        self,
        end: RotorEnd,
        base: BaseEnd,
        mbs: exudyn.MainSystem | None = None,
        own: int = 0,
    ) -> None:
        super().__init__(end, base)
        nodes = [mbs.AddNode(generic_node(*np.zeros((2, own))))] if own else []
        self.nodes, self.own = (*end.nodes, *base.nodes, *nodes), own
        self.size += own

    def state(
        self, mbs: exudyn.MainSystem, configuration: exudyn.ConfigurationType = CURRENT
    ) -> tuple[list[float], list[float]]:
        """Return coordinates and rates in a configuration."""
        return tuple(
            np.hstack(
                [mbs.GetNodeOutput(node, kind, configuration) for node in self.nodes]
            ).tolist()
            for kind in (_KINDS.Coordinates, _KINDS.Coordinates_t)
        )

    # ------------------------------------------------------------------ law

    @abstractmethod
    def wrench(self, t: float) -> tuple:
        """Return force and moment on the rotor, and forces on own coordinates, as :meth:`pull`."""

    @abstractmethod
    def tangent(self, t: float) -> Tangent:
        """Return the law's tangent where the ends have been read."""

    def friction(self) -> float:
        """Return the torque on the rotor that a prescribed spin does not feel [N m]."""
        return 0.0

    # ------------------------------------------------------------------ by the coordinates

    def pull(
        self,
        fx: float,
        fy: float,
        fz: float = 0.0,
        moment: Sequence[float] = (0.0, 0.0, 0.0),
        own: np.ndarray | None = None,
    ) -> list[float]:
        """Return the forces on all coordinates by a force and a moment on the rotor."""
        if fx == fy == fz == 0.0 and own is None and not any(moment):  # as of an open stop
            return [0.0] * self.size
        found = self.end.pull(fx, fy, fz, moment).tolist()
        if self.base.size:
            load = [-fx, -fy, -fz, *(-m for m in moment)]
            found += (load @ self.base.rows()).tolist()
        return found if own is None else found + own.tolist()

    def forces(self, t: float) -> list[float]:
        """Return the forces on all coordinates where the ends have been read."""
        fx, fy, *others = self.wrench(t)
        if self.has_mass:  # and of the mass, what its acceleration has by the rates alone
            mass, (ax, ay) = self.added_mass(), self.end.turning
            fx, fy = fx - mass * ax, fy - mass * ay
        return self.pull(fx, fy, *others)

    def slopes(self, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Return less the derivatives of the forces, by the coordinates and by their rates."""
        J, L, K, D = self.tangent(t)
        damping = J.T @ D
        K, D = J.T @ (K @ J) + damping @ L, damping @ J
        if self.has_mass:
            L, momentum = self.rate_rows()[:2], self.added_mass() * self.rows(2).T
            K, D = K + momentum @ (self.end.speed * QUARTER[:2, :2] @ L), D + 2.0 * momentum @ L
        return K, D

    def mass_matrix(self) -> np.ndarray:
        """Return the mass matrix (size, size) of what goes with the rotor."""
        J = self.rows(2)
        return self.added_mass() * J.T @ J

    def item(self, whole: Connector | None = None) -> ObjectGenericODE2:
        """Return the object; without force while `whole` is probed."""
        whole, outer = whole or self, np.zeros((self._second, self._second))
        given = {"massMatrix": np.zeros((self.size, self.size))}
        for name, own in zip(_MATRICES, self.constant, strict=False):
            given[name] = block_diag(outer, own)
        none, resists_nothing = [0.0] * self.size, np.zeros((self.size, self.size))

        def see(*state):
            if state != self._read:  # Exudyn asks for mass and forces of one state
                self.read(*state)

        def force(mbs, t, item, q, q_t):
            if whole.probed is not None:
                return none
            see(q, q_t)
            found = self.forces(t)
            if self.outside and self.guard is not None:
                self.guard(mbs)
            return found

        def jacobian(mbs, t, item, q, q_t, factor_q, factor_v):
            if whole.probed is not None:
                return resists_nothing
            see(q, q_t)
            K, D = self.slopes(t)
            return factor_q * K + factor_v * D

        def mass(mbs, t, item, q, q_t):
            see(q, q_t)
            return self.mass_matrix()

        if self.has_mass:
            given["massMatrixUserFunction"] = mass
        return ObjectGenericODE2(
            nodeNumbers=list(self.nodes),
            forceUserFunction=force,
            jacobianUserFunction=jacobian,
            visualization=VObjectGenericODE2(show=False),
            **given,
        )


class SupportConnector(Connector):
    """A linear support: stiffness and damping in axes that stand still or turn with the rotor.

    About the axis a spring acts on the twist, a damper that stands still on the whole spin. What
    turns with the rotor is driven there: the reaction of its moments does not act on the spin.
    """

    def __init__(self, support: Support, end: RotorEnd, base: BaseEnd, on_rotor: bool) -> None:
        super().__init__(end, base)
        self.support, self._turns = support, support.frame == "rotor"
        self.has_mass, self._varies = acts(support.mass), support.varies
        self._between = on_rotor  # tables are over the difference of both speeds
        self._known = None, None  # the last speed, and matrices
        self._mass = lru_cache(maxsize=1)(support.mass_matrix)

    @property
    def _speed(self) -> float:
        """Speed that coefficients are over; zero of constant ones."""
        if not self._varies:
            return 0.0
        return self.end.speed - (self.base.speed if self._between else 0.0)

    def _matrices(self) -> tuple[np.ndarray, np.ndarray]:
        speed = self._speed
        if speed != self._known[0]:
            self.support.check_range(speed)
            self._known = speed, self.support.matrices(speed)
        K, D = self._known[1]
        if self._turns:
            R = axial_rotation(self.end.angle, 6)
            K, D = R @ K @ R.T, R @ D @ R.T
        return K, D

    def added_mass(self) -> float:
        """Return the mass that goes with the rotor at its speed [kg]."""
        return float(self._mass(self._speed)[0, 0])

    def wrench(self, t: float) -> tuple:
        """Return force and moment on the rotor."""
        (K, D), (x, x_t), speed = self._matrices(), self.motion, self.end.speed
        if self._turns:
            x_t = x_t - speed * (axial_skew(6) @ x)
            x_t[5] -= speed
        fx, fy, fz, *moment = (-K @ x - D @ x_t).tolist()
        if self._turns:
            a, b, _ = self.end.tilt
            moment[2] += b * moment[0] - a * moment[1]
        return fx, fy, fz, moment

    def tangent(self, t: float) -> Tangent:
        """Return the tangent of force and moment, with rows (6, size)."""
        K, D = self._matrices()
        if self._turns:
            K = K - self.end.speed * D @ axial_skew(6)
        return self.rows(), self.rate_rows(), K, D


class MagneticConnector(Connector):
    """Magnets that pull by the controller's coordinates, which follow what the sensors show.

    The coordinates are pairs along (n1, n2), with the equations of
    :mod:`exudyn_rotor.bearings.pid_controller` times a stiffness, as in linear analyses.
    """

    def __init__(
        self,
        bearing: MagneticBearing,
        ends: tuple[RotorEnd, BaseEnd],
        sensors: tuple[RotorEnd, BaseEnd],
        mbs: exudyn.MainSystem,
    ) -> None:
        self._law = law = bearing.realisation
        super().__init__(*ends, mbs, len(law.inertia))
        self.bearing, self.parts = bearing, [bearing]
        self.seen = Between(*sensors)
        self._turn = bearing.control_axes
        parts = law.by_place, law.by_rate
        self._by_place, self._by_rate = (np.kron(part, self._turn) for part in parts)
        self.constant = np.diag(law.inertia), law.damping, law.stiffness
        self._least = bearing.clearance_along() ** 2

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion of magnets, sensors and controller."""
        super().read(q, q_t)
        second = self._second
        if self.seen.end is not self.end:
            self.seen.read(q, q_t)
        currents = -self._by_place.dot(q[second:]) - self._by_rate.dot(q_t[second:])
        places = self._turn.dot(self.relative[:2])
        self._axes = list(zip(currents.tolist(), places.tolist(), strict=True))

    def motions(self) -> list[tuple[float, ...]]:
        """Return x, y, ẋ, ẏ, θ and Ω of the journal, as one of a list."""
        return [self.relative]

    def wrench(self, t: float) -> tuple:
        """Return the force on the rotor, and what drives the controller's coordinates."""
        x, y = self.relative[:2]
        self.outside = x * x + y * y >= self._least
        law = self.bearing.actuator.law
        force = self._turn.T @ [law(*state) for state in self._axes]
        own = self._law.place.dot(self.seen.relative[:2])
        return float(force[0]), float(force[1]), 0.0, (0.0, 0.0, 0.0), own

    def tangent(self, t: float) -> Tangent:
        """Return the tangent, with rows of magnets, sensors and own coordinates."""
        slopes = [self.bearing.actuator.slopes(*state) for state in self._axes]
        D, K = self.bearing.coupling(np.array(slopes))
        D[4:, 4:] = K[4:, 4:] = 0.0  # what own coordinates have among themselves is constant
        J, L = np.zeros((2, 4 + self.own, self.size))
        J[:2], L[:2] = self.rows()[:2], self.rate_rows()[:2]
        J[2:4, : self._second] = self.seen.rows()[:2]
        J[4:, self._second :] = np.eye(self.own)
        return J, L, K, D


SPEED_STEP = 1e-6  # of the speed, or of 1 rad/s: differences of torques by it


class BearingConnector(Connector):
    """A bearing across the axis, or the films of pads, whose tilts are own coordinates.

    A law holds in axes of the bore. One that turns about the axis at the rate w sees the rotor turn
    at Ω − w, and move by ``v − w e × u``: a film drags by what the two turn against each other. On
    another rotor the bore turns by its spin angle, too: grooves turn with it, and so does the outer
    ring whose elements an inner ring takes along. Forces act along the axes at rest, also where the
    base tilts, and pull at the middles of journal and bore: about the axis the base lacks the
    moment ``u × F`` of their distance u. Its `parts` are the bearing, or the films of its pads.
    Torques brake a spin that is free; of a prescribed one they take along what carries the bearing,
    but for foundations.
    """

    def __init__(
        self,
        bearing: Bearing,
        end: RotorEnd,
        base: BaseEnd,
        mbs: exudyn.MainSystem,
        is_free: bool,
    ) -> None:
        pads = isinstance(bearing, TiltingPadBearing)
        self.parts = bearing.pad_bearings if pads else [bearing]
        super().__init__(end, base, mbs, len(self.parts) if pads else 0)
        self.bearing = bearing
        # a foundation hardly turns, which a prescribed spin leaves out as linear analyses do
        self.feels = base.size > 0 and (is_free or not isinstance(base, FoundationEnd))
        self.has_mass = isinstance(bearing, AnnularSeal)  # that of the leakage
        self.levers = -bearing.film.radius * bearing.tangents if pads else None
        if pads:
            self.constant = (bearing.pad_inertia * np.eye(self.own),)
        # of a prescribed spin the base alone feels the torque
        self.brakes = (is_free or self.feels) and has_torque(bearing)
        self._drags = self.brakes and not is_free
        self.laws = [one.law_with_torque if self.brakes else one.law for one in self.parts]
        self._least = self.parts[0].clearance_along() ** 2

    def motions(self) -> list[tuple[float, ...]]:
        """Return x, y, ẋ, ẏ, θ and Ω of the journal as each film sees it."""
        motion = self.relative
        self._turn = None
        if self.feels:
            motion = self._from_bore(*motion)
        if self.probed is not None:
            motion = *motion[:4], self.probed, motion[5]
        if self.levers is None:
            return [motion]
        x, y, vx, vy, angle, speed = motion
        own = (np.array(each[self._second :]) for each in self._read)
        moved, rates = ((self.levers * each[:, None]).tolist() for each in own)
        return [
            (x - a, y - b, vx - c, vy - d, angle, speed)
            for (a, b), (c, d) in zip(moved, rates, strict=True)
        ]

    def _from_bore(
        self, x: float, y: float, vx: float, vy: float, angle: float, speed: float
    ) -> tuple[float, ...]:
        turn, w = self.base.turn, self.base.speed
        vx, vy = vx + w * y, vy - w * x
        if turn:
            c, s = self._turn = cos(turn), sin(turn)
            x, y, vx, vy = c * x + s * y, c * y - s * x, c * vx + s * vy, c * vy - s * vx
        return x, y, vx, vy, angle - turn, speed - w

    def wrench(self, t: float) -> tuple:
        """Return force and torque on the rotor, and moments on pads."""
        motions = self.motions()
        if self.levers is None:
            motion = motions[0]
            self.outside = motion[0] ** 2 + motion[1] ** 2 >= self._least
            force = self.laws[0](*motion)
            fx, fy = force[:2]
            if self._turn is not None:
                c, s = self._turn
                fx, fy = c * fx - s * fy, s * fx + c * fy
            return (fx, fy, 0.0, (0.0, 0.0, force[2])) if self.brakes else (fx, fy, 0.0)
        self.outside = any(m[0] ** 2 + m[1] ** 2 >= self._least for m in motions)
        forces = np.array([law(*m) for law, m in zip(self.laws, motions, strict=True)])
        total, own = forces.sum(axis=0).tolist(), -(forces[:, :2] * self.levers).sum(axis=1)
        return *total[:2], 0.0, (0.0, 0.0, total[2] if self.brakes else 0.0), own

    def tangent(self, t: float) -> Tangent:
        """Return the tangent, with rows across the axis, of the spin, and of pads.

        Linear equations leave out how forces change with the spin speed. A step needs that where
        friction begins to slide.
        """
        count = 3 + self.own
        K, D = np.zeros((2, count, count))
        parts = zip(self.parts, self.laws, self.motions(), strict=True)
        for number, (part, law, motion) in enumerate(parts):
            k, d = part.slopes(*motion)
            if self._drags:
                by_place, by_rate = differences(law, *motion)
                k, d = np.vstack([k, by_place[2:]]), np.vstack([d, by_rate[2:]])
            if self.feels:
                k = k + self.base.speed * d @ np.array([[0.0, 1.0], [-1.0, 0.0]])
                if self._turn is not None:
                    R = axial_rotation(self.base.turn)
                    rows = len(k)
                    k, d = R[:rows, :rows] @ k @ R[:2, :2].T, R[:rows, :rows] @ d @ R[:2, :2].T
            S = np.eye(3, count)  # of what this film sees, by the ports
            if self.levers is not None:
                S[:2, 3 + number] = -self.levers[number]
            K += S[: len(k)].T @ k @ S[:2]
            D += S[: len(d)].T @ d @ S[:2]
            if self.brakes and self.probed is None:
                step = SPEED_STEP * max(abs(motion[5]), 1.0)
                faster = law(*motion[:5], motion[5] + step)
                D[:, 2] += np.subtract(law(*motion), faster) / step @ S
        J, L = np.zeros((2, count, self.size))
        J[:3], L[:3] = self.rows()[[0, 1, 5]], self.rate_rows()[[0, 1, 5]]
        J[3:, self._second :] = np.eye(self.own)
        return J, L, K, D

    def added_mass(self) -> float:
        """Return the mass that goes with the rotor at its speed [kg]."""
        speed = self.end.speed - (self.base.speed if self.feels else 0.0)
        return self.bearing.added_mass(speed)

    def friction(self) -> float:
        """Return the torque on the journal that a prescribed spin does not feel [N m]."""
        if self.brakes or not has_torque(self.bearing):
            return 0.0
        pairs = zip(self.parts, self.motions(), strict=True)
        return sum(part.law_with_torque(*motion)[2] for part, motion in pairs)


def has_torque(bearing: Bearing) -> bool:
    """Return whether a bearing has a torque about the axis in scenes."""
    with_torque = bearing.law_with_torque is not None and getattr(bearing, "friction", None) != 0.0
    return with_torque or isinstance(bearing, TiltingPadBearing)


def watch_clearance(body: RotorItems, connector: BearingConnector | MagneticConnector) -> None:
    """Let runs of the scene stop where the journal of a connector leaves its bearing."""
    bearing, name = connector.bearing, body.name
    stops = entry(body.mbs).setdefault("clearance stops", set())
    place = body.script, bearing.interface
    if isinstance(bearing, ClearanceStop):
        stops.add(place)
    advice = "take smaller steps, begin from steady_state(body), reduce the load, or add a"
    if isinstance(bearing, MagneticBearing):
        advice = (
            "is the loop of controller and magnets unstable? stability(reduced, speeds, "
            "supports=…) tells; else reduce the load, or add a"
        )

    def guard(mbs: exudyn.MainSystem) -> None:
        time = mbs.systemData.GetTime(START)
        if time <= 0.0 or place in stops:  # nothing has been accepted yet, or a rub is meant
            return
        connector.read(*connector.state(mbs, START))
        for part, motion in zip(connector.parts, connector.motions(), strict=True):
            distance = hypot(*motion[:2])
            beyond = distance - part.clearance_along(np.array(motion[:2]) / distance)
            if beyond >= 0.0:
                raise ValueError(
                    f"rotor {name!r} left its bearing at {bearing.interface!r} at t = {time:g} s: "
                    f"its journal is {distance:.3g} m from the centre, {beyond:.2g} m beyond the "
                    f"clearance that way; {advice} ClearanceStop at that interface for a rub"
                )

    connector.guard = guard


@dataclass(frozen=True, eq=False)
class SceneLaw(ABC):
    """What a call has attached to a rotor of a scene.

    Attributes
    ----------
    body : RotorBody or FullRotorBody
    objects : tuple of ObjectIndex
        Its connectors.
    evaluation : tuple of str
        Who evaluates each of them in a time step.
    connector : Connector or None
        Its law by the coordinates of the rotor, of the base, and of its own.
    """

    body: Body
    objects: tuple[exudyn.ObjectIndex, ...]
    evaluation: tuple[str, ...]
    connector: Connector | None

    def __post_init__(self) -> None:
        checks.keep(self, _kinds=[_kind(self.body.mbs, number) for number in self.objects])

    @property
    def uses_python(self) -> bool:
        """True when a time step calls Python for it."""
        return PYTHON in self.evaluation

    def check_present(self) -> None:
        """Raise ValueError where the system no longer holds it under its numbers."""
        if [_kind(self.body.mbs, number) for number in self.objects] != self._kinds:
            raise ValueError(
                f"mbs: no longer holds what acts on rotor {self.body.name!r} under its numbers: "
                f"{self}: objects were deleted; build the scene anew without them"
            )

    @abstractmethod
    def values(self, configuration: exudyn.ConfigurationType = CURRENT) -> tuple:
        """Return what :meth:`add_sensor` records."""

    def add_sensor(self, **options: Any) -> exudyn.SensorIndex:
        """Add a sensor of what :meth:`values` returns, one after the other.

        Parameters
        ----------
        **options
            Of ``SensorUserFunction``: name, storeInternal, writeToFile, fileName.

        Raises
        ------
        TypeError, ValueError
            For other options.
        """

        def output(mbs, t, sensors, factors, configuration):
            return np.hstack(self.values(configuration)).tolist()

        return add_sensor(self.body, SensorUserFunction, options, sensorUserFunction=output)


def _kind(mbs: exudyn.MainSystem, number: exudyn.ObjectIndex) -> tuple:
    """Return the type of an object, and its nodes or markers; nothing where there is none."""
    if int(number) >= mbs.systemData.NumberOfObjects():
        return ()
    item = mbs.GetObject(number)
    ends = item.get("nodeNumbers", item.get("markerNumbers", ()))
    return item["objectType"], *map(int, ends)


def check_body(body: Body, argument: str) -> None:
    """Refuse what is no rotor of a scene."""
    checks.instance(body, argument, (RotorBody, FullRotorBody), "add_rotor returns one")
    body.check_present()
