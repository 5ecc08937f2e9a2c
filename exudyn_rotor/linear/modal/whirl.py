"""Modes over the speed: how each turns, what it is called, and which one continues it.

In cylindrical coordinates about the axis every motion ``Re(φ exp(iνt))`` of a rotor is a sum of
waves ``exp(i(νt − nα))``; n > 0 travels with a positive spin, n < 0 against it. Rigid translation,
tilt and bending are n = ±1, axial motion and torsion n = 0. Coordinates that stand still show a
wave at the frequency ν with which it is seen from outside; in the frame of the rotor the wave n is
seen at ``ν + nΩ``. A foundation stands still; a motion is the foundation's where that has most of
the energy. Source: Genta, Dynamics of Rotating Systems (2005).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.calls import kept
from exudyn_rotor.linear.model.assembly import OwnBody
from exudyn_rotor.linear.model.body import RotorAlone, RotorBody, StandingBody
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.turning import compressed, rotor_points, wave_amplitudes
from exudyn_rotor.linear.solve.motions import Motions

WHIRLS = (
    "forward", "backward", "mixed", "axial", "torsional", "radial", "static", "unknown",
    "foundation", "overdamped",
)  # fmt: skip
FORWARD, BACKWARD, MIXED, AXIAL, TORSIONAL, RADIAL, STATIC, UNKNOWN, FOUNDATION, OVERDAMPED = range(
    len(WHIRLS)
)
# kinds of motion: 'lateral' has one nodal diameter, 'disc' more; 'other' are radial ones and those
# that neither shapes nor interfaces show; 'foundation' moves more mass beside the rotor than in it
FAMILIES = ("lateral", "torsional", "axial", "disc", "other", "foundation")
# a mode is mixed when the weaker sense has more than this share of the energy of the stronger
MIXED_SHARE = 0.25
# a mode has n nodal diameters when ±n hold this share of its energy, or, where the waves along a
# shaft are too many for the fit, the second share of what is fitted
_DIAMETER_SHARE, _PURE_SHARE = 0.7, 0.9
_FITTED, _NOT_FITTED = 0.1, 0.05  # least fitted share for that, and share that tells nothing
_STATIC = 1e-7  # share of the speed: a frequency seen from outside that is round-off
_SAME = 1e-8  # relative distance of λ of repeated motions
_NO_OSCILLATION = 1e-6  # share of |λ| below which a frequency is that of critical damping
_SWINGS = 0.1  # frequency over growth below which a motion on an integral is the integral's
_GONE = 30.0  # decay over Ω of a motion that is over before the rotor turns
_GONE_FREQUENCY = 5e-2  # share of such a decay: of periodic equations below it a multiple of Ω
_DIGITS = 9  # of energies, and of what is sorted: beyond them numbers are equal
_NO_ENERGY = 1e-12  # share of the energy of a unit motion that is none
_SAMPLES = 8000  # nodes of the mesh
# how strongly jumps of the frequency seen from outside and of the growth, and another sense of
# whirl, count against a likeness of shapes
_JUMP_WEIGHT, _GROWTH_WEIGHT, _SENSE_WEIGHT = 0.5, 0.25, 0.25
_STEEPEST = 2.0  # change of a frequency over that of the speed: a thin disc's forward mode
_SPREAD = 1e-2  # share of a frequency by which it may change in any step
# a match is another mode below this likeness, or beyond this many steepest changes
_LEAST_LIKENESS, _MOST_CHANGES = 0.25, 3.0
_ALIKE = 1e-6  # relative distance of λ of motions whose shapes are arbitrary


class OfMotions:
    """Base of results that hold whirl codes and nodal diameters of motions."""

    @property
    def whirl(self) -> np.ndarray:
        """Sense of every motion, shape as `whirl_codes`.

        'forward' and 'backward' are seen from outside, relative to the spin; 'mixed' where the
        weaker sense has more than half the amplitude of the stronger; 'axial', 'torsional' and
        'radial' for n = 0; 'static' for a wave that stands still in space, like a free rotor that
        is displaced; 'overdamped' for a lateral motion that decays without oscillating;
        'unknown' where neither shapes nor interfaces show the mode, or where it has more than four
        nodal diameters: its inertial frequency is that of the rotor frame then.
        """
        return np.array(WHIRLS)[self.whirl_codes]

    @property
    def families(self) -> np.ndarray:
        """Kind of every motion, shape as `whirl_codes`.

        'lateral', 'torsional', 'axial', 'disc' (two nodal diameters and more), 'foundation', or
        'other'.
        """
        special = {TORSIONAL: 1, AXIAL: 2, RADIAL: 4, UNKNOWN: 4, FOUNDATION: 5}
        kinds = np.where(self.nodal_diameters >= 2, 3, 0)
        for code, kind in special.items():
            kinds = np.where(self.whirl_codes == code, kind, kinds)
        return np.array(FAMILIES)[kinds]


class Named(NamedTuple):
    """Motions at s speeds with their names.

    Attributes
    ----------
    motions : Motions
        Repeated ones as waves of one sense.
    inertial, rotor : ndarray, shape (s, k)
        Frequencies seen from outside, and in the frame of the rotor, of the strongest wave [rad/s].
    codes, diameters : ndarray of int, shape (s, k)
        Index into :data:`WHIRLS`, and nodal diameters, −1 where they are not known.
    """

    motions: Motions
    inertial: np.ndarray
    rotor: np.ndarray
    codes: np.ndarray
    diameters: np.ndarray

    def columns(self, chosen: np.ndarray) -> Named:
        """Return at each speed some of the motions, `chosen` (s, j)."""
        rest = (np.take_along_axis(each, chosen, 1) for each in self[1:])
        return Named(self.motions.columns(chosen), *rest)

    def rows(self, chosen: np.ndarray) -> Named:
        """Return the motions at some of the speeds."""
        return Named(self.motions[chosen], *(each[chosen] for each in self[1:]))


@dataclass(frozen=True, eq=False)
class Content:
    """Energy of the waves in the motions of a model, and along each direction.

    The energy of a wave in a motion x is ``|R x|²`` with some rows of R.

    Attributes
    ----------
    waves : ndarray of int, shape (w,)
        The number n of each wave.
    shifts : ndarray of float, shape (w,)
        By how many Ω its frequency seen from outside is above the harmonic's.
    spins : ndarray of float, shape (w,)
        n times the speed ratio of its rotor: how many Ω lie between both frames.
    beside : ndarray of float, shape (p,)
        By how many Ω the frequency of what is beside the rotors is above the harmonic's: 0 of
        coordinates that stand still, ±1 of the two senses in which a pair turns in turning axes.
    rows : sequence of ndarray, shape (r, k)
        R of each wave, then of the motion along the axis, along the circumference, along the
        radius, of all motion of the rotors, and of each part of what is beside them.
    integrating : ndarray, shape (k,)
        Of coordinates of controllers, :attr:`OwnBody.integrating`; 0 for others.
    """

    waves: np.ndarray
    shifts: np.ndarray
    spins: np.ndarray
    beside: np.ndarray
    rows: Sequence[np.ndarray]
    integrating: np.ndarray

    @classmethod
    def of(cls, model: LinearModel) -> Content:
        """Build the content of a model from mode shapes, or from its interfaces."""
        assembly = model.assembly(1.0)
        k, found, share = assembly.size, [], 0.0
        directions: list[list[np.ndarray]] = [[] for _ in range(4)]
        beside: dict[int, list[np.ndarray]] = {}
        integrating = np.zeros(k)
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, RotorBody):
                waves, seen, per_mass = _seen(body.alone, body.mean)
                share = max(share, per_mass)
                for n, turned, rows in waves:
                    shift, spin = n * body.ratio - turned * body.drift, n * body.ratio
                    found.append((n, shift, spin, assembly.wide({0: rows}, place)[0]))
                for wide, rows in zip(directions, seen, strict=False):
                    wide.append(assembly.wide({0: rows}, place)[0])
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if not isinstance(body, RotorBody) and body.size:  # as heavy as the rotor where alike
                rows = np.sqrt(share) * np.linalg.cholesky(body.M).T
                for sense, part in _senses(body).items():
                    wide = assembly.wide({0: part @ rows}, place)[0]
                    beside.setdefault(sense, []).append(wide)
            if isinstance(body, OwnBody):
                integrating[place] = body.integrating
        found = found or [(0, 0.0, 0.0, np.zeros((1, k)))]  # no point that moves: no whirl
        waves, shifts, spins, rows = zip(*found, strict=True)
        beside = beside or {0: [np.zeros((1, k))]}
        rows = [*rows, *map(np.vstack, (*directions, *beside.values()))]
        numbers = (np.array(each) for each in (waves, shifts, spins, list(beside)))
        return cls(*numbers, rows, integrating)

    def parts(self, energy: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return of energies or forms, by the first axis, waves, directions and what is beside."""
        return tuple(np.split(energy, [len(self.waves), len(self.waves) + 4]))

    @cached_property
    def _forms(self) -> np.ndarray:
        """Energy ``xᴴ F x`` of each part, in the order of the rows, (w + 4 + p, k, k)."""
        return np.array([R.conj().T @ R for R in self.rows])

    def energies(self, vectors: np.ndarray) -> np.ndarray:
        """Return the energies (w + 4 + p, s, h, k) of harmonics (s, h, c, k)."""
        begins = np.cumsum([0, *map(len, self.rows[:-1])])
        used = np.any(vectors, axis=(2, 3))  # at most speeds far fewer than at the slowest
        moved = np.vstack(self.rows) @ vectors[used]
        energies = np.zeros((len(begins), *used.shape, vectors.shape[3]))
        squares = np.add.reduceat(moved.real**2 + moved.imag**2, begins, axis=1)
        energies[:, used] = np.swapaxes(squares, 0, 1)
        return energies

    def named(self, motions: Motions, *, apart: bool = False) -> Named:
        """Return motions with their names; repeated ones are waves of one sense where `apart`."""
        motions = motions if apart else self._as_waves(motions)
        values, speeds, orders = motions.values, motions.speeds[:, None], motions.orders
        nu, vectors = np.abs(values.imag), motions.vectors
        if np.any(np.isnan(values)):
            nu, vectors = np.nan_to_num(nu), np.nan_to_num(vectors)
        mirrored = values.imag < 0.0
        if np.any(mirrored):
            vectors = np.where(mirrored[:, None, None], vectors[:, ::-1].conj(), vectors)
        if np.any(self.integrating):  # the integral of a slow oscillation is large anyway
            rate = np.multiply.outer(np.abs(values), self.integrating).swapaxes(1, 2)
            swings = (rate > 0.0) & (nu > _SWINGS * np.abs(values.real))[:, None]
            vectors = np.where(swings, rate, 1.0)[:, None] * vectors
        energy, directions, beside = self.parts(self.energies(vectors))
        *directions, whole = directions.sum(axis=2)  # (s, k) each
        energy = np.moveaxis(energy, 0, 2) / np.maximum(whole, 1e-300)[:, None, None]
        above = (orders[:, None] + self.shifts).ravel()  # of all waves in all harmonics
        by_wave = energy.sum(axis=1)
        energy = energy.reshape(len(values), len(above), values.shape[1])
        best = _strongest(energy, above)
        still = _STATIC * np.abs(speeds) + motions.bounds[:, None]
        seen = nu[:, None, :] + above[:, None] * speeds[:, :, None]
        wave = np.tile(self.waves, len(orders))[:, None]
        turns = np.sign(wave * seen) * np.where(speeds < 0.0, -1.0, 1.0)[:, :, None]
        turns = np.where(np.abs(seen) <= still[:, None], 0.0, turns)
        forward, backward = (np.sum(energy * (turns == sense), axis=1) for sense in (1.0, -1.0))
        codes = np.where(forward >= backward, FORWARD, BACKWARD)
        weaker, stronger = np.minimum(forward, backward), np.maximum(forward, backward)
        codes[weaker > MIXED_SHARE * stronger] = MIXED
        heard, turning = (np.take_along_axis(X, best[:, None], 1)[:, 0] for X in (seen, turns))
        place = best % len(self.waves)
        rotor, wave = np.abs(heard - self.spins[place] * speeds), self.waves[place]
        codes = np.where((turning == 0.0) & (wave != 0), STATIC, codes)
        named = np.array([AXIAL, TORSIONAL, RADIAL])[np.argmax(directions, axis=0)]
        codes = np.where(wave == 0, named, codes)
        fitted = by_wave.sum(axis=1)
        unseen = whole <= 1e-12 * np.max(whole, axis=1, keepdims=True, initial=0.0)
        unseen |= (fitted < _NOT_FITTED) & (np.max(directions, axis=0) < 0.5 * whole)
        other = nu[:, None] + np.add.outer(self.beside, orders)[:, None, :, None] * speeds[:, None]
        stands = beside.sum(axis=(0, 2)) > whole
        other = _of_most(np.abs(other), beside)
        codes = np.where(stands, FOUNDATION, np.where(unseen, UNKNOWN, codes))
        main = orders[np.argmax(np.sum(np.abs(vectors) ** 2, axis=2), axis=1)]
        inertial = np.where(unseen, np.abs(nu + main * speeds), np.abs(heard))
        inertial = np.where(stands, other, inertial)
        rotor = np.where(unseen | stands, nu, rotor)
        diameters = np.where(stands, 0, self._diameters(by_wave))
        lost = np.isnan(motions.bounds)[:, None] | np.isnan(motions.values)
        inertial, rotor = (np.where(lost, np.nan, each) for each in (inertial, rotor))
        codes, diameters = np.where(lost, UNKNOWN, codes), np.where(lost, -1, diameters)
        return _still(Named(motions, inertial, rotor, codes.astype(np.int64), diameters))

    def _diameters(self, energy: np.ndarray) -> np.ndarray:
        """Return n where ±n hold most of the energy (s, w, k), of which 1 is all; −1 elsewhere."""
        counts = np.arange(np.abs(self.waves).max() + 1)
        pairs = (np.abs(self.waves) == counts[:, None]).astype(float) @ energy
        fitted, most = pairs.sum(axis=1), pairs.max(axis=1)
        clear = most >= _DIAMETER_SHARE * np.maximum(1.0, fitted)
        clear |= (fitted >= _FITTED) & (most >= _PURE_SHARE * fitted)
        return np.where(clear, np.argmax(pairs, axis=1), -1)

    def _as_waves(self, motions: Motions) -> Motions:
        """Return repeated motions, whose shapes are arbitrary, as waves of one sense each."""
        values, vectors, alike = motions.values, motions.vectors, {}
        scale = _SAME * np.maximum(np.abs(values), np.abs(motions.speeds[:, None]))
        allowed = (scale + motions.bounds[:, None])[:, 1:]
        near = np.abs(np.diff(values, axis=1)) <= allowed  # they stand side by side
        for row in np.flatnonzero(near.any(axis=1)):
            for group in np.split(np.arange(values.shape[1]), np.flatnonzero(~near[row]) + 1):
                if group.size > 1:
                    alike.setdefault(tuple(group), []).append(row)
        if not alike:
            return motions
        changed = vectors.copy()
        for group, rows in alike.items():
            at = np.ix_(rows, range(vectors.shape[1]), range(vectors.shape[2]), group)
            changed[at] = self.extremal(vectors[at])
        return replace(motions, vectors=changed)

    def extremal(self, vectors: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
        """Return combinations of motions (s, h, c, g) whose mean wave number is extremal.

        Or the mean of other `weights` (h, w) of the waves in each harmonic; 0.4 of axial motion
        parts it from torsion.
        """
        flat = vectors.reshape(len(vectors), -1, vectors.shape[3])
        flat = flat / np.abs(flat).max(axis=1, keepdims=True)
        span, lengths, _ = np.linalg.svd(flat, full_matrices=False)
        span = span.reshape(vectors.shape)
        across = np.swapaxes(span.conj(), 2, 3)
        waves, (axial, *_, whole), beside = self.parts(self._forms)
        every, weights = whole + beside.sum(axis=0), self.waves if weights is None else weights
        mean = np.tensordot(weights, waves, 1) + 0.4 * axial
        form, whole = (np.sum(across @ F @ span, axis=1) for F in (mean, every))
        # what moves nothing that has waves has the mean zero
        floor = 1e-9 * np.abs(whole).max(axis=(1, 2), keepdims=True)
        floor = floor + 1e-12 * np.abs(every).max() + 1e-200
        unit = np.linalg.inv(np.linalg.cholesky(whole + floor * np.eye(len(whole[0]))))
        across = np.swapaxes(unit.conj(), 1, 2)
        turn = across @ np.linalg.eigh(unit @ form @ across)[1]
        turned = span @ (turn / np.abs(turn).max(axis=1, keepdims=True))[:, None]
        turned = turned / np.linalg.norm(turned, axis=(1, 2), keepdims=True)
        # a defective eigenvalue has one shape only
        defective = lengths[:, -1] < 1e-3 * lengths[:, 0]
        return np.where(defective[:, None, None, None], vectors, turned)


def _senses(body: StandingBody | OwnBody) -> dict[int, np.ndarray]:
    """Return the parts of a body that is no rotor by which sense they turn in, (r, k) each.

    Seen from outside, a pair ``(1, −i) exp(iνt)`` in turning axes has the frequency ν + Ω.
    """
    if not body.turns:
        return {0: np.eye(body.size)}
    pair = {sense: np.array([[1.0, 1j * sense]]) / np.sqrt(2.0) for sense in (1, -1)}
    return {sense: np.kron(np.eye(body.size // 2), row) for sense, row in pair.items()}


@kept
def _seen(alone: RotorAlone, mean: bool) -> tuple[list, list[np.ndarray], float]:
    """Return what is seen of a rotor, and its number of points over the mass.

    Rows of each wave n, of coordinates that turn alike; then rows along the axis, the circumference
    and the radius, and of all motion.
    """
    points, motion = rotor_points(alone.rotor, _SAMPLES)
    motion = motion @ alone.Q
    orders, amplitudes, axial = wave_amplitudes(points, motion)
    u1, u2, _ = motion.reshape(len(points), 3, -1).transpose(1, 0, 2)
    angle = np.arctan2(points[:, 1], points[:, 0])[:, None]
    around, outwards = (
        np.cos(angle) * u2 - np.sin(angle) * u1,
        np.cos(angle) * u1 + np.sin(angle) * u2,
    )
    directions = [compressed(rows) for rows in (axial, around, outwards, motion)]
    least, waves = _NO_ENERGY * np.linalg.norm(directions[3]) ** 2, []
    for n, W in zip(orders.tolist(), amplitudes, strict=True):
        parts = alone.turning.parts(W) if mean else {0: W}
        for turned, rows in parts.items():
            rows = compressed(rows, least)
            if len(rows):
                waves.append((n, turned, rows))
    return waves, directions, len(points) / alone.invariants.mass


def _strongest(energy: np.ndarray, multiples: np.ndarray) -> np.ndarray:
    """Return which wave (n,) is the strongest one of the strongest frequency, (s, k).

    Waves (s, n, k) of one of the `multiples` (n,) of Ω have one frequency seen from outside.
    """
    known, place = np.unique(np.round(multiples, 6), return_inverse=True)
    alike = (place == np.arange(known.size)[:, None]).astype(float)
    first = np.argmax(np.round(alike @ energy, _DIGITS), axis=1)
    return np.argmax(np.where(place[:, None] == first[:, None], energy, -1.0), axis=1)


def _of_most(values: np.ndarray, energy: np.ndarray) -> np.ndarray:
    """Return of values (p, s, h, k) the one with the most energy in each motion, (s, k)."""
    p, s, h, k = energy.shape
    values, energy = (np.moveaxis(X, 0, 1).reshape(s, p * h, k) for X in (values, energy))
    return np.take_along_axis(values, np.argmax(energy, axis=1)[:, None], 1)[:, 0]


def _still(found: Named) -> Named:
    """Return names of which motions that do not oscillate have the frequency 0."""
    growth, bounds = found.motions.values.real, found.motions.bounds[:, None]
    moves = oscillates(growth, found.inertial, bounds)
    # what is over before the rotor turns has no frequency of its own
    gone = -growth > _GONE * np.abs(found.motions.speeds[:, None])
    least = _GONE_FREQUENCY if len(found.motions.orders) > 1 else _NO_OSCILLATION
    moves &= (found.rotor > least * np.abs(growth)) | ~gone
    lateral = np.isin(found.codes, (FORWARD, BACKWARD, MIXED, STATIC))
    overdamped = np.where(growth < -bounds, OVERDAMPED, STATIC)
    codes = np.where(lateral & ~moves, overdamped, found.codes)
    inertial = np.where(moves | np.isnan(found.inertial), found.inertial, 0.0)
    return found._replace(inertial=inertial, codes=codes)


def oscillates(
    growth: np.ndarray, frequency: np.ndarray, bound: float | np.ndarray = 0.0
) -> np.ndarray:
    """Return where motions oscillate seen from outside: neither overdamped nor free."""
    return frequency > np.maximum(_NO_OSCILLATION * np.abs(growth), bound)


def damping_of(growth: np.ndarray, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return damping ratio and logarithmic decrement at inertial frequencies [rad/s].

    The ratio lies from −1 to 1. The decrement is NaN where a motion decays or grows without
    oscillating.
    """
    size = np.hypot(growth, frequency)
    still = ~oscillates(growth, frequency)
    ratio = np.where(still, -np.sign(growth), -growth / np.where(size > 0.0, size, 1.0))
    decrement = -2.0 * np.pi * growth / np.where(still, np.nan, frequency)
    return ratio + 0.0, np.where(growth == 0.0, 0.0, decrement) + 0.0


def signed_diameters(codes: np.ndarray, diameters: np.ndarray) -> np.ndarray:
    """Return the signed nodal diameters, ascending from backward to forward waves."""
    signs = np.where(codes == FORWARD, 1, np.where(codes == BACKWARD, -1, 0))
    return signs * diameters


def rounded(values: np.ndarray, nan: float = 2.0) -> np.ndarray:
    """Return numbers (s, k) over the largest of their row, rounded so that equal ones are equal.

    They are what tables are sorted by; `nan` takes the place of what is not known.
    """
    largest = np.nanmax(np.abs(values), axis=1, keepdims=True, initial=0.0)
    shares = values / np.where(largest > 0.0, largest, 1.0)
    return np.round(np.nan_to_num(shares, nan=nan), _DIGITS)


def track(named: Named, M: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which column continues each mode of the first speed, and whether it is the same mode.

    Both (s, k), by the mass matrix (k, k). Speeds without values are passed over; a mode that is
    NaN is taken for the same one.
    """
    known, (s, k) = named.motions.known, named.inertial.shape
    columns, continued = np.tile(np.arange(k), (s, 1)), np.ones((s, k), dtype=bool)
    following, same = matched(named.rows(known[:-1]), named.rows(known[1:]), M)
    lost = np.isnan(named.motions.values[known])
    same |= lost[:-1] | np.take_along_axis(lost[1:], following, 1)
    for step, (before, after) in enumerate(itertools.pairwise(known)):
        last = columns[before]
        columns[after], continued[after] = following[step][last], same[step][last]
        columns[before + 1 : after] = last
    return columns, continued


def first_known(named: Named) -> Named:
    """Return each motion (k) at the first speed at which it is known, in one row."""
    motions = named.motions
    row, column = np.argmax(~np.isnan(motions.values), axis=0), np.arange(motions.values.shape[1])
    first = replace(motions[motions.known[:1]], values=motions.values[row, column][None])
    return Named(first, *(each[row, column][None] for each in named[1:]))


def matched(
    before: Named, after: Named, M: np.ndarray, spread: float = _SPREAD
) -> tuple[np.ndarray, np.ndarray]:
    """Return which of later motions (s, l) each motion is, (s, k), and whether it is the same one.

    Each row is matched as a whole (assignment problem) by the mass-weighted modal assurance
    criterion ``|φᴴMψ|² / (φᴴMφ ψᴴMψ)``, the frequency seen from outside, which may change by a
    share `spread` of itself, the growth and the sense. A motion and its conjugate are one.
    """
    first, second = before.motions, after.motions
    likeness, bounds = likenesses(first.main, second.main, M), first.bounds[:, None, None]
    heard = before.inertial[:, :, None], after.inertial[:, None]
    jump, turned = np.abs(heard[1] - heard[0]), np.abs(second.speeds - first.speeds)
    allowed = _STEEPEST * turned[:, None, None] + spread * np.maximum(*heard) + bounds
    growth = first.values.real[:, :, None], second.values.real[:, None]
    size = np.abs(growth[0]) + np.abs(growth[1]) + bounds
    apart = np.abs(growth[1] - growth[0]) / np.maximum(size, 1e-300)
    senses = [(each.codes == FORWARD) * 1 - (each.codes == BACKWARD) for each in (before, after)]
    cost = 1.0 - likeness + _JUMP_WEIGHT * np.minimum(jump / allowed, 4.0)
    cost += _GROWTH_WEIGHT * np.minimum(apart, 1.0)
    cost += _SENSE_WEIGHT * (senses[0][:, :, None] * senses[1][:, None] < 0)
    cost = np.round(np.nan_to_num(cost, nan=10.0), _DIGITS)
    found = [linear_sum_assignment(each)[1] for each in cost]
    chosen = np.array(found, dtype=int).reshape(first.values.shape)

    def of_match(X: np.ndarray) -> np.ndarray:
        return np.take_along_axis(X, chosen[:, :, None], 2)[:, :, 0]

    later = second.values
    near = np.abs(later[:, :, None] - later[:, None])
    alike = near <= _ALIKE * np.abs(later[:, None]) + bounds
    together = of_match(likeness @ np.swapaxes(alike, 1, 2))
    same = (together >= _LEAST_LIKENESS) & (of_match(jump) <= _MOST_CHANGES * of_match(allowed))
    return chosen, same | ((first.values == 0.0) & (np.take_along_axis(later, chosen, 1) == 0.0))


def likenesses(before: np.ndarray, after: np.ndarray, M: np.ndarray) -> np.ndarray:
    """Return the criterion of all pairs of shapes (s, c, k) and (s, c, l), or their conjugates."""
    before, after = np.nan_to_num(before), np.nan_to_num(after)
    norms = [np.sum(x.conj() * (M @ x), axis=1).real for x in (before, after)]
    left, weighted = np.swapaxes(before, 1, 2), M @ after
    best = np.maximum(np.abs(left.conj() @ weighted), np.abs(left @ weighted)) ** 2
    return best / np.maximum(norms[0][:, :, None] * norms[1][:, None], 1e-300)
