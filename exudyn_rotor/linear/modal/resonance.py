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
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor.bearings.support import NoCoefficientsError
from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.equations import PeriodicSystem, UnconvergedError
from exudyn_rotor.linear.modal.whirl import Content
from exudyn_rotor.linear.model.assembly import rotors_of
from exudyn_rotor.linear.model.body import EVEN
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.solve.hill import real_waves
from exudyn_rotor.solvers.factor import one_thread

NO_EQUATIONS = NoCoefficientsError, UnconvergedError
_SHARE = 0.4  # of a motion's energy that must turn with the excitation
# a motion whose mean order is below minus this share of the order is the conjugate of another
_CONJUGATE = 0.25
_SAME = 1e-7  # relative distance of speeds that are one
# relative distance of the speeds of one motion in the two planes of a rotor that counts as round,
# and likeness of the two motions
_PLANES, _ALIKE = 0.5 * EVEN, 0.975
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
    over the frequency are taken at `order` times the speed.
    """

    model: LinearModel
    order: float
    known: dict[float, PeriodicSystem] = field(default_factory=dict)

    def system(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s]."""
        if speed not in self.known:
            system, basis = self.model.at(speed, self.order * speed), self.model.moving_basis
            self.known[speed] = system if basis is None else system.projected(basis)
        return self.known[speed]

    def stacked(self, speeds: np.ndarray) -> tuple[PeriodicSystem | None, dict[int, Exception]]:
        """Return the equations at speeds (s,) where there are any, and why there are none else."""
        basis = self.model.moving_basis
        stack, refused = self.model.systems(speeds, self.order * speeds)
        projects = basis is not None and stack is not None
        return stack.projected(basis) if projects else stack, refused

    def __call__(self, speed: float, multiples: np.ndarray) -> np.ndarray:
        """Return H at a speed for frequencies `multiples` (h,) of it, (h·k, h·k)."""
        return dynamic_stiffness(self.system(speed), multiples)

    def motions(self, vectors: np.ndarray, multiples: np.ndarray) -> np.ndarray:
        """Return vectors (h·k, …) of H as harmonics (h, c, …) in all coordinates of the model."""
        basis = self.model.moving_basis
        harmonics = vectors.reshape(len(multiples), -1, *vectors.shape[1:])
        return harmonics if basis is None else np.einsum("ck,hk...->hc...", basis, harmonics)

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
                moved = np.linalg.solve(H, slope @ x)
            except np.linalg.LinAlgError:  # there already
                return speed, x
            change = (np.vdot(x, x) / np.vdot(x, moved)).real
            x, speed = moved / np.linalg.norm(moved), speed - change
            if not abs(speed - found[0]) < _FAR * found[0]:
                break
            if abs(change) <= tolerance * speed:
                return float(speed), x
        return np.nan, x


def dynamic_stiffness(system: PeriodicSystem, multiples: np.ndarray) -> np.ndarray:
    """Return H of equations, or of a stack, for frequencies `multiples` (h,) of the speed.

    Its shape is (…, h·k, h·k). Of K the symmetric part, of D the skew one of a Hermitian matrix:
    what damps and what drives a motion is the other.
    """
    h, k = len(multiples), system.size
    speed = np.asarray(system.speed)[..., None, None]
    H = np.zeros((*np.shape(system.speed), h, k, h, k), dtype=complex)
    apart = np.round(multiples[:, None] - multiples)
    for n, K in system.K.items():
        for a, b in np.argwhere(apart == n):
            H[..., a, :, b, :] += 0.5 * (K + np.swapaxes(K, -1, -2))
    for n, D in system.D.items():
        for a, b in np.argwhere(apart == n):
            f, g = multiples[a], multiples[b]
            H[..., a, :, b, :] += 0.5j * speed * (g * D - f * np.swapaxes(D, -1, -2))
    for a, f in enumerate(multiples):
        H[..., a, :, a, :] -= (f * speed) ** 2 * system.M
    return H.reshape(*H.shape[:-4], h * k, h * k)


@dataclass(eq=False)
class Search:
    """The search for critical speeds of an undamped model.

    Of order p ≥ 0 and nodal `diameters`, up to the speed `limit` [rad/s], which has to be given
    where the stiffness varies with it. The `error` is the relative change of a critical speed in
    the last step, which errs by its square. What is left out stands in `lost`, speeds that did not
    settle, in `jumps`, where a film jumps, and in `refused`, speeds without equations.
    """

    model: LinearModel
    order: float
    diameters: Sequence[int]
    limit: float | None
    error: float = 1e-7
    lost: list[float] = field(default_factory=list)
    jumps: list[float] = field(default_factory=list)
    refused: dict[float, Exception] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.varies = self.model.stiffness_varies
        if self.limit is None and self.varies:
            raise ValueError(
                "max_speed: a system that varies with the speed needs the largest speed of "
                "interest [rad/s]"
            )
        self.stiffness = Stiffness(self.model, self.order)
        self.content = Content.of(self.model)

    @one_thread()
    def resonances(self) -> list[Resonance]:
        """Return all critical speeds up to the limit, ascending.

        Raises
        ------
        ValueError
            Where a support has a negative stiffness.
        """
        step = self.grid.step if self.varies else self.stiffness.system(1.0).step
        most, found = _FEW // (step or 1), []
        for center in self._centers(step):
            few = center + step * np.arange(-most, most + 1) if step else np.array([center])
            pairs = self._bracketed(few) if self.varies else _direct(self.stiffness, few)
            reach = np.inf if self.limit is None else self.limit
            answering = self._answering([pair for pair in pairs if pair[0] <= reach], few)
            settled = (self._settled(one, step) if step else one for one in answering)
            found += [one for one in settled if one is not None]
        return self._of_one_plane(sorted(found, key=lambda one: one.speed))

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
    def grid(self) -> PeriodicSystem:
        """The equations at the speeds that are looked at, ascending, where there are any.

        Slow speeds at which films are too thin are not missed.
        """
        count = _BRACKETS // (1 + self.model.turns)
        first, kinks = self.limit / count, self.model.table_speeds
        slow = first * _RATIO ** np.arange(-_SLOW, _SLOW)
        even = np.linspace(first, self.limit, count)
        wanted = np.unique([*even, *slow, *kinks[(kinks > first) & (kinks < self.limit)]])
        wanted = wanted[np.diff(wanted, prepend=0.0) > _SAME * first]
        stack, errors = self.stiffness.stacked(wanted)
        if stack is None or len(stack.speed) < 2:
            raise errors[min(errors)]
        self.refused = {float(wanted[i]): errors[i] for i in errors if wanted[i] >= first}
        return stack

    def _bracketed(self, multiples: np.ndarray) -> list[Pair]:
        """Return where H is singular, by its eigenvalues over the grid, and null vectors."""
        stack, found = dynamic_stiffness(self.grid, multiples), []
        h, basis = len(multiples), np.eye(stack.shape[-1])
        is_even = h > 1 and h % 2 and np.array_equal(multiples, -multiples[::-1])
        if is_even:  # H is real in cosines and sines
            basis = np.kron(real_waves(h), np.eye(len(basis) // h))
            stack = (basis.conj().T @ stack @ basis).real
        lost, signs = np.array(list(self.refused)), _eigenvalues(stack) < 0.0
        for row, (low, high) in enumerate(pairwise(self.grid.speed.tolist())):
            if np.any((low < lost) & (lost < high)):
                continue
            A, B = stack[row], stack[row + 1]
            for j in np.flatnonzero(signs[row] != signs[row + 1]):
                at = brentq(_between, 0.0, 1.0, args=(A, B, j), xtol=_FINE)
                at = np.round(at, _DIGITS)  # of zeros that are one, orthogonal vectors
                vectors = np.linalg.eigh((1.0 - at) * A + at * B)[1]
                guess = low + (high - low) * at, basis @ vectors[:, j]
                exact, slack = self._exact(guess, multiples), _BEYOND * (high - low)
                if low - slack < exact[0] < high + slack:
                    found.append(exact)
                else:
                    self.jumps.append(guess[0])
        return found

    def _exact(self, found: Pair, multiples: np.ndarray) -> Pair:
        """Return a zero with the equations that are there."""
        try:
            return self.stiffness.refined(found, multiples, self._before(found[0]), self.error)
        except NO_EQUATIONS:  # beyond the end of a table, by rounding
            return found

    def _before(self, speed: float) -> float:
        """Return a slower speed, for the slope of H."""
        if not self.varies:
            return (1.0 - _STEP) * speed
        lower = self.grid.speed[self.grid.speed < (1.0 - _STEP) * speed]
        return float(lower[-1] if lower.size else self.grid.speed[1])

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
        groups = groups_of(speeds)
        for group in np.flatnonzero(np.bincount(groups) > 1):
            chosen = groups == group
            vectors[..., chosen] = self.content.extremal(vectors[None][..., chosen], senses)[0]
        share, mean = self._shares(vectors, multiples)
        kept = np.flatnonzero((share >= _SHARE) & (mean >= -_CONJUGATE))
        return [Resonance(speeds[i], vectors[:, :, i], multiples) for i in kept]

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

    def _of_one_plane(self, found: list[Resonance]) -> list[Resonance]:
        """Return critical speeds without those of the same motion in the other plane of a rotor.

        Bending modes of which a basis holds one half alone make both planes of a round rotor
        differ. The motion seen from outside is the same in both; the softer plane has more modes.
        """
        kept: list[tuple[Resonance, np.ndarray]] = []
        for one in found:
            seen = self._seen(one)
            for other, before in kept if self.model.turns else ():
                near = _SAME < 1.0 - other.speed / one.speed < _PLANES
                if near and abs(np.vdot(before, seen)) > _ALIKE:
                    break
            else:
                kept.append((one, seen))
        return [one for one, _ in kept]

    def _seen(self, one: Resonance) -> np.ndarray:
        """Return the amplitudes of all waves that turn with the excitation, of unit length."""
        content, parts = self.content, []
        shifts, rows = [*content.shifts, 0.0], [*content.rows[:-5], content.rows[-1]]
        for shift, R in zip(shifts, rows, strict=True):
            at = np.isclose(one.multiples + shift, self.order, rtol=0.0, atol=1e-9)
            parts.append(R @ one.vectors[at].sum(axis=0))
        seen = np.concatenate(parts)
        return seen / max(np.linalg.norm(seen), 1e-300)

    # ------------------------------------------------------------------ what is left out

    def warn(self) -> None:
        """Warn of critical speeds that are left out, once of all kinds."""
        told = []
        if self.refused:
            first, last, count = min(self.refused), max(self.refused), len(self.refused)
            told.append(
                f"none are looked for at {count} of {len(self.grid.speed) + count - 1} speeds "
                f"from {first:.4g} to {last:.4g} rad/s: {self.refused[first]}"
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


def groups_of(speeds: np.ndarray) -> np.ndarray:
    """Return the number of each of ascending speeds, the same where they are one."""
    return np.cumsum(np.diff(speeds, prepend=speeds[:1]) > _SAME * speeds)


def _eigenvalues(H: np.ndarray) -> np.ndarray:
    """Return the eigenvalues of H, or of a stack, zero where they are rounding."""
    values = np.linalg.eigvalsh(H)
    rounding = _FREE * np.abs(values).max(axis=-1, initial=0.0, keepdims=True)
    return np.where(np.abs(values) <= rounding, 0.0, values)


def _between(at: float, A: np.ndarray, B: np.ndarray, j: int) -> float:
    """Return an eigenvalue of what lies between two matrices, at a share from 0 to 1."""
    return _eigenvalues((1.0 - at) * A + at * B)[j]


def _direct(stiffness: Stiffness, multiples: np.ndarray) -> list[Pair]:
    """Return all zeros of ``H = A − Ω² B``, A not negative, with null vectors.

    Free motions, the null space R of A, follow the others by their inertia: ``Rᴴ B φ = 0``. Those
    without any stay at rest.
    """
    A, M = stiffness(_AT_REST, multiples), stiffness.system(_AT_REST).M
    if not len(A):
        return []
    speed = float(np.sqrt(np.abs(A).max() / np.abs(M).max())) or 1.0
    B = (A - stiffness(speed, multiples)) / speed**2
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
