"""Bearings and the films of tilting pads in a scene."""

from __future__ import annotations

from math import cos, sin

import exudyn
import numpy as np

from exudyn_rotor.bearings.annular_seal import AnnularSeal
from exudyn_rotor.bearings.bearing import Bearing, Law, LawWithTorque
from exudyn_rotor.bearings.journal_bearing import FilmLaw, JournalBearing, RememberingLaw
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.multibody.supports.connector import START, Connector, Force
from exudyn_rotor.multibody.supports.ends import BaseEnd, RotorEnd

_SPEED_STEP = 1e-6  # of the speed, or of 1 rad/s: differences of friction by it
FilmPoint = tuple[tuple[float, ...], np.ndarray, np.ndarray, np.ndarray | None]


class BearingConnector(Connector):
    """A bearing across the axis, or the films of pads, whose tilts are own coordinates.

    A law holds in axes of the bore. One that turns about the axis at the rate w sees the rotor turn
    at Ω − w, and move by ``v − w e × u``: a film drags by what the two turn against each other. On
    another rotor the bore turns by its spin angle, too: grooves turn with it, and so does the outer
    ring whose elements an inner ring takes along. Forces act along the axes at rest, also where the
    base tilts, and pull at the middles of journal and bore: about the axis the base lacks the
    moment ``u × F`` of their distance u.

    Attributes
    ----------
    bearing : Bearing
    parts : list of Bearing
        The bearing, or the films of pads.
    outside : bool
        Whether it was evaluated beyond the least clearance.
    """

    def __init__(
        self,
        bearing: Bearing,
        end: RotorEnd,
        base: BaseEnd | None,
        brakes: bool,
        feels: bool,
        own: exudyn.NodeIndex | None = None,
    ) -> None:
        pads = isinstance(bearing, TiltingPadBearing)
        self.parts = bearing.pad_bearings if pads else [bearing]
        super().__init__(end, base, own, len(self.parts) if pads else 0)
        self.bearing, self.outside, self.feels = bearing, False, feels
        self.levers = -bearing.film.radius * bearing.tangents if pads else None
        self.brakes = self.whole = brakes and has_torque(bearing)
        self.laws = [_law_of(one, self.brakes) for one in self.parts]
        self._remembers = isinstance(bearing, JournalBearing) and bearing.remembers
        self._least = self.parts[0].clearance_along() ** 2
        self._begun: tuple[float, float] | None = None

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion of the ends, and of the pads."""
        super().read(q, q_t)
        if self.own:
            self._tilts = np.array([q[self._second :], q_t[self._second :]])

    def motions(self) -> list[tuple[float, ...]]:
        """Return x, y, ẋ, ẏ, θ and Ω of the journal as each film sees it."""
        motion = self.relative
        self._turn = None
        if self.feels:
            motion = self._from_bore(*motion)
        if self.levers is None:
            return [motion]
        x, y, vx, vy, angle, speed = motion
        moved = (self.levers.T * self._tilts[0]).T.tolist()
        rates = (self.levers.T * self._tilts[1]).T.tolist()
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
        x, y = motions[0][:2]
        if x * x + y * y >= self._least:
            self.outside = True
        if self.levers is None:
            force = self.laws[0](*motions[0])
            fx, fy = force[:2]
            if self._turn is not None:
                c, s = self._turn
                fx, fy = c * fx - s * fy, s * fx + c * fy
            return (fx, fy, 0.0, (0.0, 0.0, force[2])) if self.brakes else (fx, fy)
        self.outside |= any(m[0] ** 2 + m[1] ** 2 >= self._least for m in motions)
        forces = np.array([law(*m) for law, m in zip(self.laws, motions, strict=True)])
        total, own = forces.sum(axis=0).tolist(), -(forces[:, :2] * self.levers).sum(axis=1)
        return *total[:2], 0.0, (0.0, 0.0, total[2]) if self.brakes else None, own

    def tangent(self, t: float) -> Force:
        """Return the force, its tangent, and rows: across the axis, of the spin, and of pads."""
        parts = zip(self.parts, self.laws, self.motions(), strict=True)
        return self.assembled([_tangent(*each) for each in parts])

    def assembled(self, parts: list[FilmPoint]) -> Force:
        """Return force and tangent on the ports, from the values and K, D (2, 2) of each film.

        A third value is a torque, with less its derivative, and that of the force, by the speed.
        """
        count = 3 + self.own
        force, (K, D) = np.zeros(count), np.zeros((2, count, count))
        for number, (values, k, d, by_speed) in enumerate(parts):
            B = np.zeros((2, count))
            B[:, :2] = np.eye(2)
            if self.levers is not None:
                B[:, 3 + number] = -self.levers[number]
            if self.feels:
                w = self.base.speed
                k = k + w * d @ np.array([[0.0, 1.0], [-1.0, 0.0]])
                if self._turn is not None:
                    c, s = self._turn
                    R = np.array([[c, -s], [s, c]])
                    k, d, values = R @ k @ R.T, R @ d @ R.T, [*(R @ values[:2]), *values[2:]]
            force += B.T @ values[:2]
            K += B.T @ k @ B
            D += B.T @ d @ B
            if len(values) > 2:
                force[2] += values[2]
                D[:, 2] += B.T @ by_speed[:2]
                D[2, 2] += by_speed[2]
        J, L = np.zeros((2, count, self.size))
        J[:3], L[:3] = self.rows()[[0, 1, 5]], self.rate_rows()[[0, 1, 5]]
        J[3:, self._second :] = np.eye(self.own)
        return Force(force, J, L, K, D)

    @property
    def has_mass(self) -> bool:
        """Whether a mass goes with the rotor: that of the leakage in a seal."""
        return isinstance(self.bearing, AnnularSeal)

    def added_mass(self) -> float:
        """Return the mass that goes with the rotor at its speed [kg]."""
        speed = self.end.speed - (self.base.speed if self.feels else 0.0)
        return self.bearing.added_mass(speed)

    def friction(self) -> float:
        """Return the torque on the journal that a prescribed spin does not feel [N m]."""
        if self.brakes or not has_torque(self.bearing):
            return 0.0
        pairs = zip(self.parts, self.laws, self.motions(), strict=True)
        return sum(_torque(*each) for each in pairs)

    def begin(self, mbs: exudyn.MainSystem, t: float) -> None:
        """Give a film with a memory the state at the beginning of the step.

        Exudyn repeats steps and evaluates forces at trial states; the configuration of the
        beginning of the step alone holds what has been accepted.
        """
        if not self._remembers:
            return
        time = mbs.systemData.GetTime(START)
        if self._begun != (time, t):
            self._begun = time, t
            self.read(*self.state(mbs, START))
            *moved, _, speed = self.motions()[0]
            self.laws[0].begin(time, *moved, speed, t)


def has_torque(bearing: Bearing) -> bool:
    """Return whether a bearing has a torque about the axis in scenes."""
    if isinstance(bearing, JournalBearing | TiltingPadBearing):
        return True
    return bearing.law_with_torque is not None


def _law_of(bearing: Bearing, torque: bool) -> Law | LawWithTorque:
    """Return the law of a bearing, or of one pad's film, by x, y, ẋ, ẏ, θ and Ω."""
    if isinstance(bearing, JournalBearing) and bearing.remembers:
        return RememberingLaw(bearing.film, torque=torque)
    return bearing.law_with_torque if torque else bearing.law


def _tangent(bearing: Bearing, law: Law | LawWithTorque, motion: tuple[float, ...]) -> FilmPoint:
    """Return values of a law, K and D (2, 2), and with a torque less the slopes by the speed."""
    values, faster = law(*motion), None
    if len(values) > 2:
        step = _SPEED_STEP * max(abs(motion[5]), 1.0)
        ahead = law(*motion[:5], motion[5] + step)
        faster = (np.array(values) - ahead) / step
        values = law(*motion)  # films know the tangent of their last call
    slopes = law.slopes if isinstance(law, FilmLaw) else bearing.slopes
    return values, *slopes(*motion), faster


def _torque(bearing: Bearing, law: Law | LawWithTorque, motion: tuple[float, ...]) -> float:
    """Return the torque of a law that is asked for its force alone [N m]."""
    if isinstance(law, FilmLaw):
        return law.torque(*motion)
    return bearing.law_with_torque(*motion)[2]
