"""Critical speeds: spin speeds at which an excitation meets a natural frequency.

An excitation of order p turns or vibrates with pΩ in axes that stand still: p = 1 is unbalance. A
motion with the frequency fΩ in the axes of the equations has the undamped dynamic stiffness

    H(Ω) = K(Ω) + i f Ω D(Ω) − f² Ω² M,

a Hermitian matrix; f = p in axes that stand still. Where only the spin itself changes with the
speed, ``H = K0 − Ω² B``: one eigenproblem has all critical speeds. Tables and films leave the zeros
of the sorted eigenvalues of H, which are continuous functions of Ω: between neighbours of some 200
speeds the equations are taken as linear, and a zero found there is refined with those of its own
speed. Two zeros of one eigenvalue between neighbours are missed.

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
from exudyn_rotor.linear.equations import PeriodicSystem, Terms, UnconvergedError, add
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
_AT_REST = 1e-8  # rad/s: a rotor runs, and its inertia is below the rounding of any stiffness
_FREE = 1e-13  # share of the largest stiffness that is rounding
_NO_INERTIA = 1e-6  # share of the largest inertia
_BRACKETS = 200  # speeds at which signs of eigenvalues are looked at; half of them for blocks
_SLOW, _RATIO = 12, 2.0**0.25  # speeds on each side of the first of these, and their ratio
_FINE = 1e-10  # of the largest speed, to which zeros are refined
_FEW, _MOST = 4, 16  # harmonics on each side of the middle one
_ITERATIONS = 8
_OFF = 0.03  # by which films that are linear between speeds may err
_FAR = 0.5  # share of a critical speed by which the same motion may differ
_STEP = 1e-5  # of the speed, for the derivative of H

Pair = tuple[float, np.ndarray]  # a speed [rad/s] and the motion there


class Resonance(NamedTuple):
    """A critical speed [rad/s] and its motion, harmonics (h, k) at `multiples` (h,) of it."""

    speed: float
    vectors: np.ndarray
    multiples: np.ndarray


class Line(NamedTuple):
    """Equations that change linearly with the speed, as from `low` to `high`; those of `at`."""

    low: PeriodicSystem
    high: PeriodicSystem
    at: PeriodicSystem

    def __call__(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s]."""
        share = (speed - self.at.speed) / (self.high.speed - self.low.speed)
        D, K = {}, {}
        for name, terms in (("D", D), ("K", K)):
            for part, factor in ((self.at, 1.0), (self.high, share), (self.low, -share)):
                add(terms, getattr(part, name), factor)
        return PeriodicSystem(speed, self.at.M, D, K)


@dataclass(frozen=True, eq=False)
class Stiffness:
    """The dynamic stiffness of an undamped model, whose equations are made once per speed.

    Motions that nothing holds at any speed, like a free spin, are none of its coordinates.

    Attributes
    ----------
    model : LinearModel
    unit : Terms
        Fourier terms of a stiffness that is added by its `factor`.
    factor : float
    line : Line, optional
        What gives the equations in the place of the model.
    order : float
        Frequency over the speed, for coefficients over the frequency.
    """

    model: LinearModel
    unit: Terms = field(default_factory=dict)
    factor: float = 0.0
    line: Line | None = None
    order: float = 1.0
    known: dict[float, PeriodicSystem] = field(default_factory=dict)

    def system(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s], without what is added."""
        if self.line is not None:
            return self.line(speed)
        if speed not in self.known:
            system, basis = self.model.at(speed, self.order * speed), self.model.moving_basis
            self.known[speed] = system if basis is None else system.projected(basis)
        return self.known[speed]

    def along(self, low: float, high: float, at: float) -> Stiffness:
        """Return what has the equations of a speed, and changes as between two others."""
        return replace(self, line=Line(*map(self.system, (low, high, at))))

    def __call__(self, speed: float, multiples: np.ndarray) -> np.ndarray:
        """Return H at a speed for frequencies `multiples` (h,) of it, (h·k, h·k)."""
        system, h = self.system(speed), len(multiples)
        K = dict(system.K)
        if self.factor:
            add(K, self.unit, self.factor)
        # the Hermitian part: what damps and what drives a motion is the other
        H = _blocks(multiples, {n: 0.5 * (X + X.T) for n, X in K.items()})
        for (a, b), n in np.ndenumerate(_orders(multiples)):
            if n in system.D:
                D, rate = system.D[n], 0.5j * speed
                H[a, :, b] += rate * (multiples[b] * D - multiples[a] * D.T)
        for a, f in enumerate(multiples):
            H[a, :, a] -= (f * speed) ** 2 * system.M
        return H.reshape(h * system.size, -1)

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

    def motions(self, vector: np.ndarray, multiples: np.ndarray) -> np.ndarray:
        """Return vectors (h·k, …) of H as harmonics (h, c, …) in all coordinates of the model."""
        basis = self.model.moving_basis
        harmonics = vector.reshape(len(multiples), -1, *vector.shape[1:])
        return harmonics if basis is None else np.einsum("ck,hk...->hc...", basis, harmonics)

    def refined(
        self, found: Resonance, slope: Stiffness | None = None, tolerance: float = 1e-9
    ) -> Resonance:
        """Return the critical speed next to one, and its motion, by inverse iteration.

        `slope` tells how H changes with the speed. NaN where it does not converge.
        """
        speed, multiples, basis = found.speed, found.multiples, self.model.moving_basis
        x = (found.vectors if basis is None else found.vectors @ basis).ravel()
        for _ in range(_ITERATIONS):
            H = self(speed, multiples)
            later = H if slope is None else slope(speed, multiples)
            earlier = (slope or self)(speed * (1.0 - _STEP), multiples)
            try:
                moved = self._solve(H, (later - earlier) @ x / (speed * _STEP), speed)
            except np.linalg.LinAlgError:  # there already
                break
            change = (np.vdot(x, x) / np.vdot(x, moved)).real
            x, speed = moved / np.linalg.norm(moved), speed - change
            if not abs(change) < _FAR * found.speed or speed <= 0.0:
                return found._replace(speed=np.nan)
            if abs(change) <= tolerance * speed:
                break
        else:
            speed = np.nan
        return Resonance(float(speed), self.motions(x, multiples), multiples)


def _orders(multiples: np.ndarray) -> np.ndarray:
    """Return the differences (h, h) of frequencies, whole numbers."""
    return np.subtract.outer(multiples, multiples).round().astype(int)


def _blocks(multiples: np.ndarray, terms: Terms) -> np.ndarray:
    """Return Fourier terms (k, k) as the matrix that couples frequencies, (h, k, h, k)."""
    orders, k = _orders(multiples), len(terms[0])
    H = np.zeros((len(orders), k, len(orders), k), dtype=complex)
    for (a, b), n in np.ndenumerate(orders):
        if n in terms:
            H[a, :, b] = terms[n]
    return H


@dataclass(eq=False)
class Search:
    """The search for critical speeds of an undamped model.

    Attributes
    ----------
    stiffness : Stiffness
    content : Content
    order : float
        p ≥ 0.
    diameters : sequence of int
        Nodal diameters that may be excited.
    limit : float or None
        Largest speed [rad/s]; needed where the stiffness varies with it.
    tolerance : float
        Largest relative change of a speed by further harmonics.
    error : float
        Largest relative change of a speed in the last step with the films that are there.
    lost, jumps : list of float
        Speeds that did not settle, and at which a film jumps.
    """

    stiffness: Stiffness
    content: Content
    order: float
    diameters: Sequence[int]
    limit: float | None
    tolerance: float
    error: float = 1e-9
    lost: list[float] = field(default_factory=list)
    jumps: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.limit is None and self.stiffness.model.stiffness_varies:
            raise ValueError(
                "max_speed: a system that varies with the speed needs the largest speed of "
                "interest [rad/s]"
            )

    @one_thread()
    def resonances(self, factor: float = 0.0) -> list[Resonance]:
        """Return all critical speeds up to the limit, with `factor` times what is added.

        Raises
        ------
        ValueError
            Where a support has a negative stiffness.
        """
        varies, step = self.stiffness.model.stiffness_varies, self._step
        stiffness, most = replace(self.stiffness, factor=factor), _FEW // (step or 1)
        found: list[Resonance] = []
        for center in self._centers(step):
            few = center + step * np.arange(-most, most + 1) if step else np.array([center])
            met = Excitation(self.content, self.order, self.diameters, few)
            pairs = self._zeros(stiffness, met) if varies else _direct(*_quadratic(stiffness, few))
            pairs = [
                (speed, stiffness.motions(x, few))
                for speed, x in pairs
                if self.limit is None or speed <= self.limit
            ]
            for one in met.answering(pairs):
                beside = stiffness
                if varies:
                    one, beside = self._exact(stiffness, one)
                    if one is None:
                        continue
                if step:
                    one = self._settled(beside, one)
                if one is not None:
                    found.append(one)
        return found

    def _exact(self, stiffness: Stiffness, found: Resonance) -> tuple[Resonance | None, Stiffness]:
        """Return a critical speed with the equations that are there, and those beside it.

        None where they jump across zero.
        """
        grid, speed = self.known[0], found.speed
        place = min(max(np.searchsorted(grid, speed), 1), len(grid) - 1)
        ends = grid[place - 1], grid[place]
        try:
            near = stiffness.along(*ends, ends[0])
            better = stiffness.refined(found, near, self.error)
            if not abs(better.speed - speed) < _OFF * speed:
                self.jumps.append(speed)
                return None, near
            return better, stiffness.along(*ends, better.speed)
        except NO_EQUATIONS:  # beyond the end of a table, by rounding
            return found, near

    def _settled(self, stiffness: Stiffness, found: Resonance) -> Resonance | None:
        """Add harmonics to a motion until its critical speed does not change; None if it does."""
        change, begin = np.inf, found.speed
        for _ in range(_FEW, _MOST, 2 * self._step):
            last, multiples, before = found.speed, found.multiples, change
            beyond = self._step * np.array([1, 2])
            multiples = np.r_[multiples[0] - beyond[::-1], multiples, multiples[-1] + beyond]
            wider = Resonance(last, np.pad(found.vectors, ((2, 2), (0, 0))), multiples)
            # what is left is the square of a change
            found = stiffness.refined(wider, tolerance=0.1 * np.sqrt(self.tolerance))
            change = abs(found.speed - last)
            if change <= self.tolerance * last:
                return found
            if not change < 0.3 * before:
                break
        self.lost.append(begin)
        return None

    @cached_property
    def _step(self) -> int:
        varies = self.stiffness.model.stiffness_varies
        return self.stiffness.system(self.known[0][-1] if varies else 1.0).step

    def _centers(self, step: int) -> list[float]:
        """Return the frequencies over Ω at which waves answer; of those that are coupled, one."""
        model = self.stiffness.model
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

    @cached_property
    def known(self) -> tuple[list[float], list[tuple[float, float]], dict[float, Exception]]:
        """Speeds with equations, those of them that are neighbours, and speeds without.

        Slow speeds at which films are too thin are not missed.
        """
        model = self.stiffness.model
        count = _BRACKETS // (1 + model.turns)
        first = self.limit / count
        kinks = model.table_speeds[model.table_speeds < self.limit]
        slow = first * _RATIO ** np.arange(-_SLOW, _SLOW)
        wanted = np.unique([*np.linspace(first, self.limit, count), *slow, *kinks[kinks > first]])
        wanted = wanted[np.diff(wanted, prepend=0.0) > _SAME * first]
        refused = {}
        for speed in wanted[::-1].tolist():
            try:
                self.stiffness.system(speed)
            except NO_EQUATIONS as error:
                refused[speed] = error
                if speed < first:
                    break
        if len(refused) >= np.sum(wanted >= first):
            raise refused[min(refused)]
        slowest = max((speed for speed in refused if speed < first), default=0.0)
        wanted = wanted[wanted > slowest].tolist()
        near = [pair for pair in pairwise(wanted) if refused.keys().isdisjoint(pair)]
        told = {speed: error for speed, error in refused.items() if speed >= first}
        return [speed for speed in wanted if speed not in refused], near, told

    @cached_property
    def _samples(self) -> dict[bytes, tuple]:
        """H over the grid for given frequencies."""
        return {}

    def _sampled(self, multiples: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return a basis without motions that are free at every speed, H in it, and the unit.

        Their signs are rounding. Real where the frequencies lie on both sides of zero alike.
        """
        key = multiples.tobytes()
        if key not in self._samples:
            plain, grid, h = self.stiffness, self.known[0], len(multiples)
            H = np.array([plain(speed, multiples) for speed in grid])
            unit = _blocks(multiples, plain.unit or {0: 0.0 * plain.system(grid[0]).M})
            unit = unit.reshape(H[0].shape)
            basis, is_real = np.eye(len(unit)), False
            if h % 2 and np.array_equal(multiples, -multiples[::-1]):
                basis, is_real = np.kron(real_waves(h), np.eye(len(unit) // h)), True
            within, unit = (basis.conj().T @ X @ basis for X in (H, unit))
            if is_real:
                within, unit = within.real, unit.real
            looked = [within[i] for i in (0, len(grid) // 2, -1)] + [unit]
            stack = np.vstack([X / (np.linalg.norm(X) or 1.0) for X in looked])
            _, sizes, rows = np.linalg.svd(stack, full_matrices=False)
            held = rows[sizes > _FREE * len(rows)].conj().T
            within, unit = (held.conj().T @ X @ held for X in (within, unit))
            self._samples[key] = basis @ held, within, unit
        return self._samples[key]

    def _zeros(self, stiffness: Stiffness, met: Excitation) -> list[Pair]:
        """Return the speeds at which H is singular, each with its null vector.

        Between two speeds H is taken as linear. Only those with a part that the excitation meets,
        as far as is seen close to them.
        """
        multiples, (grid, near, _) = met.multiples, self.known
        held, within, unit = self._sampled(multiples)
        within = within + stiffness.factor * unit
        place = {speed: i for i, speed in enumerate(grid)}
        signs = np.linalg.eigvalsh(within)
        zeros: list[tuple[float, int, np.ndarray]] = []
        for low, high in near:
            a, b = place[low], place[high]
            for j in np.flatnonzero((signs[a] < 0.0) != (signs[b] < 0.0)).tolist():

                def matrix(share: float, a: int = a, b: int = b) -> np.ndarray:
                    return (1.0 - share) * within[a] + share * within[b]

                def value(share: float, a: int = a, b: int = b, j: int = j) -> float:
                    if share in (0.0, 1.0):
                        return signs[b if share else a][j]
                    return np.linalg.eigvalsh(matrix(share, a, b))[j]

                at = signs[a][j] / (signs[a][j] - signs[b][j])
                beside = np.linalg.eigh(matrix(at))[1][:, max(j - 1, 0) : j + 2]
                share, _ = met.shares(stiffness.motions(held @ beside, multiples))
                if share.max() >= 0.5 * _SHARE:
                    at = brentq(value, 0.0, 1.0, xtol=_FINE)
                    zeros.append((low + (high - low) * at, j, matrix(at)))
        zeros.sort(key=lambda zero: zero[:2])
        found: list[Pair] = []
        for group in same_speed([zero[0] for zero in zeros]):
            _, vectors = np.linalg.eigh(zeros[group[0]][2])
            found += [(zeros[i][0], held @ vectors[:, zeros[i][1]]) for i in group]
        return found

    def warn(self) -> None:
        """Warn of critical speeds that are left out, once of all kinds."""
        told = []
        if self.limit is not None and self.stiffness.model.stiffness_varies:
            grid, _, refused = self.known
            if refused:
                told.append(
                    f"none are looked for at {len(refused)} of {len(grid) + len(refused)} speeds "
                    f"from {min(refused):.4g} to {max(refused):.4g} rad/s: "
                    f"{refused[min(refused)]}"
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


def same_speed(speeds: Sequence[float]) -> list[list[int]]:
    """Return places of ascending speeds in groups of one speed."""
    groups: list[list[int]] = []
    for i, speed in enumerate(speeds):
        if groups and speed - speeds[groups[-1][-1]] <= _SAME * speed:
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


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


# ------------------------------------------------------------------ which motions answer


@dataclass(frozen=True, eq=False)
class Excitation:
    """Which motions an excitation of the order p meets, at frequencies `multiples` (h,) of Ω."""

    content: Content
    order: float
    diameters: Sequence[int]
    multiples: np.ndarray

    @property
    def seen(self) -> np.ndarray:
        """Frequencies over Ω with which harmonics of each wave are seen from outside, (h, w)."""
        return self.multiples[:, None] + self.content.shifts[None, :]

    def shares(self, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the share of energy of motions (h, k, n) that turns so, and the mean order, (n,).

        The mean order is over p; it is negative of the conjugate of another motion.
        """
        content, p = self.content, self.order
        energies = content.energies(vectors[None])[0]
        energy, standing = energies[:, :-5], energies[:, -1]
        total = np.maximum(energies[:, -2].sum(axis=0), 1e-300)
        meets = (np.abs(np.abs(self.seen) - p) < 1e-9) & np.isin(
            np.abs(content.waves), self.diameters
        )
        turning = np.sum(energy * meets[..., None], axis=(0, 1))
        # what stands still beside the rotor answers to all
        turning += (np.abs(np.abs(self.multiples) - p) < 1e-9) @ standing
        mean = np.einsum("hw,hwn->n", self.seen, energy)
        return turning / total, mean / (total * (p or 1.0))

    def answering(self, pairs: list[Pair]) -> list[Resonance]:
        """Return those of speeds and harmonics (h, k) whose motions turn with the excitation.

        Of a motion and its conjugate, one.
        """
        if not pairs:
            return []
        pairs = sorted(pairs, key=lambda pair: pair[0])
        speeds = [speed for speed, _ in pairs]
        vectors = np.stack([vector for _, vector in pairs], axis=2).astype(complex)
        vectors = vectors / np.linalg.norm(vectors, axis=(0, 1))
        for group in same_speed(speeds):
            if len(group) > 1:
                vectors[:, :, group] = self._one_sense(vectors[:, :, group])
        share, mean = self.shares(vectors)
        kept = np.flatnonzero((share >= _SHARE) & (mean >= -_CONJUGATE))
        return [Resonance(speeds[i], vectors[:, :, i], self.multiples) for i in kept]

    def _one_sense(self, vectors: np.ndarray) -> np.ndarray:
        """Return motions (h, k, g) of one speed so that each turns one way in time, or in space."""
        seen = np.where(np.abs(self.seen) < 1e-9, 0.0, self.seen)
        return self.content.extremal(vectors[None], 10.0 * np.sign(seen) + self.content.waves)[0]


def named(
    found: Sequence[Resonance], content: Content
) -> tuple[list[Resonance], np.ndarray, np.ndarray, np.ndarray]:
    """Return critical speeds, ascending, those of one speed from backward to forward waves.

    With their frequencies in the frame of the rotor over Ω, whirl codes and nodal diameters.
    """
    rotor = np.zeros(len(found))
    codes, diameters = np.zeros((2, len(found)), dtype=np.int64)
    alike: dict[tuple, list[int]] = {}
    for i, one in enumerate(found):
        alike.setdefault(tuple(one.multiples), []).append(i)
    for multiples, places in alike.items():
        center = multiples[len(multiples) // 2]
        orders = np.round(np.array(multiples) - center).astype(int)
        vectors = np.stack([found[i].vectors for i in places], axis=2)
        vectors = vectors / np.linalg.norm(vectors, axis=(0, 1))
        # all frequencies go with the speed, so that one speed stands for all
        values = np.full(len(places), 1j * center)
        given = values[None], vectors[None], orders, np.zeros(1)
        names = content.named(Motions(np.ones(1), *given), apart=True)
        codes[places], diameters[places] = names.codes[0], names.diameters[0]
        rotor[places] = names.rotor[0]
    ascending = np.argsort([one.speed for one in found], kind="stable")
    senses = signed_diameters(codes, diameters)[ascending]
    groups = same_speed([found[i].speed for i in ascending])
    row = [ascending[i] for group in groups for i in sorted(group, key=senses.__getitem__)]
    return [found[i] for i in row], rotor[row], codes[row], diameters[row]
