"""Critical speeds: spin speeds at which an excitation meets a natural frequency.

An excitation of order p turns or vibrates with pΩ in axes that stand still: p = 1 is unbalance. A
motion with the frequency fΩ in the axes of the equations has the undamped dynamic stiffness

    H(Ω) = K(Ω) + i f Ω D(Ω) − f² Ω² M,

a Hermitian matrix; f = p in axes that stand still. Where only the spin itself changes with the
speed, ``H = K0 − Ω² B``: one eigenproblem has all critical speeds. With tables and films a sorted
eigenvalue of H, a continuous function of Ω, changes its sign between two of some 200 speeds; two
zeros of one eigenvalue between neighbours are missed.

In the axes of an uneven rotor a wave n answers at f = p − n. Supports that differ in their two
directions couple f, f ± 2, …: H is a matrix of blocks, of which five are solved, and then more are
added to each motion by itself until its critical speed stands still. Source: Genta, Dynamics of
Rotating Systems (2005).
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.linalg as la
from scipy.optimize import brentq

from exudyn_rotor.bearings.support import NoCoefficientsError
from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.equations import PeriodicSystem, Terms, UnconvergedError
from exudyn_rotor.linear.modal.whirl import Content, signed_diameters
from exudyn_rotor.linear.model.assembly import rotors_of
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.solve.hill import real_waves
from exudyn_rotor.linear.solve.motions import Motions
from exudyn_rotor.solvers.factor import one_thread

NO_EQUATIONS = NoCoefficientsError, UnconvergedError
_SHARE = 0.4  # of a motion's energy that must turn with the excitation
# a motion whose mean order is below minus this share of the order is the conjugate of another
_CONJUGATE = 0.25
_SAME = 1e-7  # relative distance of speeds that are one
_FINE, _DIGITS = 1e-9, 7  # of a place between two speeds, and digits of places that are one
_AT_REST = 1e-8  # rad/s: a rotor runs, and its inertia is below the rounding of any stiffness
_FREE = 1e-13  # share of the largest stiffness that is rounding
_NO_INERTIA = 1e-6  # share of the largest inertia
_BRACKETS = 200  # speeds at which signs of eigenvalues are looked at; half of them for blocks
_SLOW, _RATIO = 12, 2.0**0.25  # speeds on each side of the first of these, and their ratio
_FEW, _MOST = 4, 16  # harmonics on each side of the middle one
_HARMONICS = 1e-6  # relative change of a critical speed by further ones
_ITERATIONS = 12
_STEP = 1e-4  # relative distance of speeds between which H has a slope
_FAR = 0.5  # share of a critical speed by which the same motion may differ
_BEYOND = 0.1  # of the distance of two speeds: a zero between them may come out so far outside

Pair = tuple[float, np.ndarray]  # a speed [rad/s] and a null vector of H there


class Resonance(NamedTuple):
    """A critical speed [rad/s] and its motion, harmonics (h, k) at `multiples` (h,) of it."""

    speed: float
    vectors: np.ndarray
    multiples: np.ndarray


@dataclass(eq=False)
class Stiffness:
    """The dynamic stiffness of an undamped model, whose equations are made once per speed.

    Motions that nothing holds at any speed, like a free spin, are none of its coordinates. Tables
    over the frequency are taken at `order` times the speed. A stiffness with the Fourier terms
    `unit` is added by its `factor`.
    """

    model: LinearModel
    order: float = 1.0
    unit: Terms = field(default_factory=dict)
    factor: float = 0.0
    known: dict[float, PeriodicSystem] = field(default_factory=dict)

    def system(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s]."""
        if speed not in self.known:
            system, basis = self.model.at(speed, self.order * speed), self.model.moving_basis
            self.known[speed] = system if basis is None else system.projected(basis)
        return self.known[speed]

    def __call__(self, speed: float, multiples: np.ndarray) -> np.ndarray:
        """Return H at a speed for frequencies `multiples` (h,) of it, (h·k, h·k)."""
        system, h = self.system(speed), len(multiples)
        H = _blocks(multiples, system.K, system.size)
        for a, f in enumerate(multiples):
            for b, g in enumerate(multiples):
                D = system.D.get(round(f - g))
                # the Hermitian part: what damps and what drives a motion is the other
                if D is not None:
                    H[a, :, b] += 0.5j * speed * (g * D - f * D.T)
            H[a, :, a] -= (f * speed) ** 2 * system.M
        H = H.reshape(h * system.size, -1)
        return H + self.factor * self.added(multiples) if self.factor else H

    def added(self, multiples: np.ndarray) -> np.ndarray:
        """Return what a factor of one adds to H."""
        k = self.model.size - self.model.neutral_motions.shape[1]
        return _blocks(multiples, self.unit, k).reshape(len(multiples) * k, -1)

    def motions(self, vectors: np.ndarray, multiples: np.ndarray) -> np.ndarray:
        """Return vectors (h·k, …) of H as harmonics (h, c, …) in all coordinates of the model."""
        basis = self.model.moving_basis
        harmonics = vectors.reshape(len(multiples), -1, *vectors.shape[1:])
        return harmonics if basis is None else np.einsum("ck,hk...->hc...", basis, harmonics)

    def _solve(self, H: np.ndarray, load: np.ndarray, speed: float) -> np.ndarray:
        """Return ``H⁻¹ load`` at a speed, of blocks of which only near ones are coupled."""
        system = self.system(speed)
        reach = max(abs(n) for terms in (system.D, system.K) for n in terms)
        width = system.size * (1 + reach // (system.step or 1)) - 1
        if 4 * width > len(H):
            return np.linalg.solve(H, load)
        band = np.zeros((2 * width + 1, len(H)), dtype=complex)
        for d in range(-width, width + 1):
            band[width - d, max(d, 0) : len(H) + min(d, 0)] = np.diagonal(H, d)
        return la.solve_banded((width, width), band, load)

    def within(self, vectors: np.ndarray) -> np.ndarray:
        """Return harmonics (h, c) as a vector (h·k,) of H."""
        basis = self.model.moving_basis
        return (vectors if basis is None else vectors @ basis).ravel()

    def refined(self, found: Pair, multiples: np.ndarray, before: float, tolerance: float) -> Pair:
        """Return the zero next to a speed and a vector, by inverse iteration.

        The slope of H is taken between the last two speeds, of which `before` is the first. NaN
        where it does not converge.
        """
        speed, x = found
        last, earlier = before, self(before, multiples)
        for _ in range(_ITERATIONS):
            H = self(speed, multiples)
            if abs(speed - last) > _STEP * speed or last == before:
                slope = (H - earlier) / (speed - last)
                last, earlier = speed, H
            try:
                moved = self._solve(H, slope @ x, speed)
            except np.linalg.LinAlgError:  # there already
                return speed, x
            change = (np.vdot(x, x) / np.vdot(x, moved)).real
            x, speed = moved / np.linalg.norm(moved), speed - change
            if not abs(speed - found[0]) < _FAR * found[0]:
                break
            if abs(change) <= tolerance * speed:
                return float(speed), x
        return np.nan, x


@dataclass(eq=False)
class Search:
    """The search for critical speeds of an undamped model.

    Attributes
    ----------
    model : LinearModel
    order : float
        p ≥ 0.
    diameters : sequence of int
        Nodal diameters that may be excited.
    limit : float or None
        Largest speed [rad/s]; needed where the stiffness varies with it.
    unit : mapping of int to ndarray
        What :class:`Stiffness` adds.
    error : float
        Relative change of a critical speed in the last step, which errs by its square.
    lost, jumps : list of float
        Speeds that did not settle, and at which a film jumps.
    """

    model: LinearModel
    order: float
    diameters: Sequence[int]
    limit: float | None
    unit: Terms = field(default_factory=dict)
    error: float = 1e-7
    lost: list[float] = field(default_factory=list)
    jumps: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.varies = self.model.stiffness_varies
        if self.limit is None and self.varies:
            raise ValueError(
                "max_speed: a system that varies with the speed needs the largest speed of "
                "interest [rad/s]"
            )
        self.stiffness = Stiffness(self.model, self.order, self.unit)
        self.content = Content.of(self.model)

    @one_thread()
    def resonances(self) -> list[Resonance]:
        """Return all critical speeds up to the limit.

        Raises
        ------
        ValueError
            Where a support has a negative stiffness.
        """
        step = self.stiffness.system(self.grid[0][0][1] if self.varies else 1.0).step
        most, found = _FEW // (step or 1), []
        for center in self._centers(step):
            few = center + step * np.arange(-most, most + 1) if step else np.array([center])
            if self.varies:
                pairs = [self._exact(pair, few) for pair in self._bracketed(few)]
            else:
                pairs = _direct(*_quadratic(self.stiffness, few))
            reach = np.inf if self.limit is None else self.limit
            answering = self._answering([pair for pair in pairs if pair[0] <= reach], few)
            settled = (self._settled(one, step) if step else one for one in answering)
            found += [one for one in settled if one is not None]
        return found

    def _centers(self, step: int) -> list[float]:
        """Return the frequencies over Ω at which waves answer; of those that are coupled, one."""
        model = self.model
        ratios = {model.ratios[body.name] for body in rotors_of(model.bodies)}
        shifts = []
        for n in self.diameters:
            for sign in (1, -1) if n and self.order else (1,):  # at order 0 they are conjugates
                # waves of more diameters stay in the axes of their rotor
                shifts += [sign * n * r for r in ratios] if n > 1 else [sign * n * model.turns]
        centers = sorted({self.order - shift for shift in shifts}, key=lambda f: (abs(f), f))
        first: dict[float, float] = {}
        for f in centers:
            first.setdefault(round(f % step, 9) % step if step else f, f)
        return list(first.values())

    # ------------------------------------------------------------------ stiffness over the speed

    @cached_property
    def grid(self) -> tuple[list[tuple[float, float]], dict[float, Exception]]:
        """Neighbouring speeds that both have equations, and speeds from the first on without.

        Slow speeds at which films are too thin are not missed.
        """
        count = _BRACKETS // (1 + self.model.turns)
        first, kinks = self.limit / count, self.model.table_speeds
        slow = first * _RATIO ** np.arange(-_SLOW, _SLOW)
        even = np.linspace(first, self.limit, count)
        wanted = np.unique([*even, *slow, *kinks[(kinks > first) & (kinks < self.limit)]])
        wanted = wanted[np.diff(wanted, prepend=0.0) > _SAME * first].tolist()
        refused: dict[float, Exception] = {}
        for speed in reversed(wanted):
            try:
                self.stiffness.system(speed)
            except NO_EQUATIONS as error:
                refused[speed] = error
                if speed < first:
                    break
        known = self.stiffness.known.keys()
        near = [pair for pair in pairwise(wanted) if known >= set(pair)]
        if not near:
            raise refused[min(refused)]
        return near, {speed: refused[speed] for speed in refused if speed >= first}

    def _bracketed(self, multiples: np.ndarray) -> list[Pair]:
        """Return where H, linear between neighbours of the grid, is singular, and null vectors.

        Only where a part of the motion turns with the excitation.
        """
        basis, place, stack, added = self._sampled(multiples)
        stack = stack + self.stiffness.factor * added
        signs, found = _eigenvalues(stack), []
        for low, high in self.grid[0]:
            A, B = stack[place[low]], stack[place[high]]
            a, b = signs[place[low]], signs[place[high]]
            changes = np.flatnonzero((a < 0.0) != (b < 0.0))
            if not changes.size:
                continue

            def value(at: float, j: int, A: np.ndarray = A, B: np.ndarray = B) -> float:
                return _eigenvalues((1.0 - at) * A + at * B)[j]

            zeros = [brentq(value, 0.0, 1.0, args=(j,), xtol=_FINE) for j in changes]
            zeros = np.round(zeros, _DIGITS)
            for at in np.unique(zeros):
                vectors = basis @ np.linalg.eigh((1.0 - at) * A + at * B)[1]
                for j in changes[zeros == at]:
                    beside = vectors[:, max(j - 1, 0) : j + 2]
                    share, _ = self._shares(self.stiffness.motions(beside, multiples), multiples)
                    if share.max() >= 0.5 * _SHARE:
                        found.append((low + (high - low) * at, vectors[:, j]))
        return found

    def _sampled(self, multiples: np.ndarray) -> tuple:
        """Return a basis, the places of the grid's speeds, H there in the basis, and the unit.

        Real where the frequencies lie on both sides of zero alike.
        """
        key = multiples.tobytes()
        if key not in self._samples:
            speeds = sorted({speed for pair in self.grid[0] for speed in pair})
            plain = replace(self.stiffness, factor=0.0)
            parts = [*(plain(speed, multiples) for speed in speeds), plain.added(multiples)]
            h = len(multiples)
            basis = np.eye(len(parts[0]))
            if h > 1 and np.array_equal(multiples, -multiples[::-1]):
                basis = np.kron(real_waves(h), np.eye(len(basis) // h))
                parts = [(basis.conj().T @ X @ basis).real for X in parts]
            place = {speed: i for i, speed in enumerate(speeds)}
            self._samples[key] = basis, place, np.array(parts[:-1]), parts[-1]
        return self._samples[key]

    @cached_property
    def _samples(self) -> dict[bytes, tuple]:
        """H over the grid for given frequencies, made once for all factors."""
        return {}

    def _exact(self, found: Pair, multiples: np.ndarray) -> Pair:
        """Return a zero with the equations that are there; NaN where they jump."""
        low, high = next(pair for pair in self.grid[0] if pair[1] >= found[0])
        slack = _BEYOND * (high - low)
        try:
            speed, x = self.stiffness.refined(found, multiples, self._before(found[0]), self.error)
        except NO_EQUATIONS:  # beyond the end of a table, by rounding
            return found
        if low - slack < speed < high + slack:
            return speed, x
        self.jumps.append(found[0])
        return np.nan, x

    def _before(self, speed: float) -> float:
        """Return a slower speed, for the slope of H."""
        if not self.varies:
            return (1.0 - _STEP) * speed
        lower = [low for low, _ in self.grid[0] if low < (1.0 - _STEP) * speed]
        return max(lower, default=self.grid[0][0][1])

    def _settled(self, found: Resonance, step: int) -> Resonance | None:
        """Add harmonics to a motion until its critical speed does not change; None if it does."""
        speed, vectors, multiples = found
        beyond = step * np.array([1, 2])
        for _ in range(_FEW, _MOST, 2 * step):
            last, vectors = speed, np.pad(vectors, ((2, 2), (0, 0)))
            multiples = np.r_[multiples[0] - beyond[::-1], multiples, multiples[-1] + beyond]
            pair = last, self.stiffness.within(vectors)
            # what is left is the square of a change
            allowed = 0.1 * np.sqrt(_HARMONICS)
            speed, x = self.stiffness.refined(pair, multiples, self._before(last), allowed)
            vectors = self.stiffness.motions(x, multiples)
            if abs(speed - last) <= _HARMONICS * last:
                return Resonance(speed, vectors, multiples)
            if np.isnan(speed):
                break
        self.lost.append(found.speed)
        return None

    # ------------------------------------------------------------------ which motions answer

    def _shares(self, vectors: np.ndarray, multiples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the share of energy of motions (h, c, n) that turns so, and the mean order, (n,).

        The mean order is over p; it is negative of the conjugate of another motion.
        """
        content, p = self.content, self.order
        energies = content.energies(vectors[None])[0]
        energy, standing = energies[:, :-5], energies[:, -1]
        total = np.maximum(energies[:, -2].sum(axis=0), 1e-300)
        seen = multiples[:, None] + content.shifts  # from outside, over Ω
        meets = np.isin(np.abs(content.waves), self.diameters) & _is_order(seen, p)
        turning = np.sum(energy * meets[..., None], axis=(0, 1))
        # what stands still beside the rotor answers to all
        turning += _is_order(multiples, p) @ standing
        mean = np.einsum("hw,hwn->n", seen, energy)
        return turning / total, mean / (total * (p or 1.0))

    def _answering(self, pairs: list[Pair], multiples: np.ndarray) -> list[Resonance]:
        """Return the motions that turn with the excitation; of one and its conjugate, one."""
        if not pairs:
            return []
        pairs = sorted(pairs, key=lambda pair: pair[0])
        speeds = np.array([speed for speed, _ in pairs])
        vectors = np.array([vector for _, vector in pairs], dtype=complex).T
        vectors = self.stiffness.motions(vectors, multiples)
        vectors = vectors / np.linalg.norm(vectors, axis=(0, 1))
        # each motion of one speed turns one way in time, or in space
        seen = multiples[:, None] + self.content.shifts
        senses = 10.0 * np.sign(np.where(np.abs(seen) < 1e-9, 0.0, seen)) + self.content.waves
        groups = _groups(speeds)
        for group in np.flatnonzero(np.bincount(groups) > 1):
            chosen = groups == group
            vectors[..., chosen] = self.content.extremal(vectors[None][..., chosen], senses)[0]
        share, mean = self._shares(vectors, multiples)
        kept = np.flatnonzero((share >= _SHARE) & (mean >= -_CONJUGATE))
        return [Resonance(speeds[i], vectors[:, :, i], multiples) for i in kept]

    # ------------------------------------------------------------------ what is left out

    def warn(self) -> None:
        """Warn of critical speeds that are left out, once of all kinds."""
        told = []
        if self.varies and self.grid[1]:
            near, refused = self.grid
            first, last = min(refused), max(refused)
            told.append(
                f"none are looked for at {len(refused)} of {len(near) + len(refused)} speeds "
                f"from {first:.4g} to {last:.4g} rad/s: {refused[first]}"
            )
        if self.lost:
            told.append(
                f"near {_shown(self.lost)} rad/s they still change with harmonics up to the "
                f"{_MOST}th, and are left out"
            )
        if self.jumps:
            told.append(
                f"near {_shown(self.jumps)} rad/s the stiffness of a film jumps where one would "
                "be, and it is left out; a film with more nodes jumps by less"
            )
        if told:
            what = "; ".join(told)
            warnings.warn(f"critical speeds: {what}", UserWarning, stacklevel=user_level())


def _shown(speeds: Sequence[float]) -> str:
    known = np.unique(np.round(speeds, 6))
    return ", ".join(f"{speed:.5g}" for speed in known[:5]) + " …" * (len(known) > 5)


def _is_order(frequencies: np.ndarray, order: float) -> np.ndarray:
    return np.abs(np.abs(frequencies) - order) < 1e-9


def _groups(speeds: np.ndarray) -> np.ndarray:
    """Return the number of each of ascending speeds, the same where they are one."""
    return np.cumsum(np.diff(speeds, prepend=speeds[:1]) > _SAME * speeds)


def _eigenvalues(H: np.ndarray) -> np.ndarray:
    """Return the eigenvalues of H, or of a stack, zero where they are rounding."""
    values = np.linalg.eigvalsh(H)
    rounding = _FREE * np.abs(values).max(axis=-1, initial=0.0, keepdims=True)
    return np.where(np.abs(values) <= rounding, 0.0, values)


def _blocks(multiples: np.ndarray, terms: Terms, k: int) -> np.ndarray:
    """Return the symmetric part of Fourier terms (k, k) between frequencies, (h, k, h, k)."""
    H = np.zeros((len(multiples), k, len(multiples), k), dtype=complex)
    for a, f in enumerate(multiples):
        for b, g in enumerate(multiples):
            X = terms.get(round(f - g))
            if X is not None:
                H[a, :, b] = 0.5 * (X + X.T)
    return H


def _quadratic(stiffness: Stiffness, multiples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return K0 and B of ``H = K0 − Ω² B``."""
    K0 = stiffness(_AT_REST, multiples)
    M = stiffness.system(_AT_REST).M
    speed = float(np.sqrt(np.abs(K0).max() / np.abs(M).max())) if len(M) else 0.0
    speed = speed or 1.0
    return K0, (K0 - stiffness(speed, multiples)) / speed**2


def _direct(A: np.ndarray, B: np.ndarray) -> list[Pair]:
    """Solve ``A φ = Ω² B φ`` for positive Ω²; A Hermitian, not negative, B Hermitian.

    Free motions, the null space R of A, follow the others by their inertia: ``Rᴴ B φ = 0``. Those
    without any stay at rest.
    """
    if not len(A):
        return []
    values, vectors = np.linalg.eigh(A)
    if values[0] < -1e-9 * values[-1]:
        raise ValueError("critical speeds: a support has a negative stiffness; see campbell")
    held = values > _FREE * len(A) * values[-1]
    R, W = vectors[:, ~held], vectors[:, held] / np.sqrt(values[held])
    if R.shape[1]:
        inertia, turn = np.linalg.eigh(R.conj().T @ B @ R)
        moving = np.abs(inertia) > _NO_INERTIA * np.abs(B).max()
        R = R @ turn[:, moving]
        W = W - R @ ((R.conj().T @ B @ W) / inertia[moving, None])
    inverse, shapes = np.linalg.eigh(W.conj().T @ B @ W)
    positive = inverse > 1e-12 * np.abs(inverse).max(initial=0.0)
    speeds = 1.0 / np.sqrt(inverse[positive])
    return list(zip(speeds.tolist(), (W @ shapes[:, positive]).T, strict=True))


def named(
    found: Sequence[Resonance], content: Content
) -> tuple[list[Resonance], np.ndarray, np.ndarray, np.ndarray]:
    """Return critical speeds, ascending, those of one speed from backward to forward waves.

    With their frequencies in the frame of the rotor over Ω, whirl codes and nodal diameters.
    """
    found = sorted(found, key=lambda one: one.speed)
    rotor, codes, diameters = [np.zeros(len(found), dtype=kind) for kind in (float, int, int)]
    for i, (_, vectors, multiples) in enumerate(found):
        center = multiples[len(multiples) // 2]
        orders = np.round(multiples - center).astype(int)
        shape = vectors[None, :, :, None] / np.linalg.norm(vectors)
        # all frequencies go with the speed, so that one speed stands for all
        motion = Motions(np.ones(1), np.array([[1j * center]]), shape, orders, np.zeros(1))
        name = content.named(motion, apart=True)
        codes[i], diameters[i] = name.codes[0, 0], name.diameters[0, 0]
        rotor[i] = name.rotor[0, 0]
    groups = _groups(np.array([one.speed for one in found]))
    row = np.lexsort((signed_diameters(codes, diameters), groups))
    return [found[i] for i in row], rotor[row], codes[row], diameters[row]
