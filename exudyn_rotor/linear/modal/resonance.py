"""Critical speeds: spin speeds at which an excitation meets a natural frequency.

An excitation of order p turns or vibrates with pΩ in axes that stand still: p = 1 is unbalance. A
motion with the frequency fΩ in the axes of the equations has the undamped dynamic stiffness

    H(Ω) = K(Ω) + i f Ω D(Ω) − f² Ω² M,

a Hermitian matrix; f = p in axes that stand still. Where only the spin itself changes with the
speed, ``H = K0 − Ω² B``: one eigenproblem has all critical speeds. Tables and films leave the zeros
of the sorted eigenvalues of H, which are continuous functions of Ω: each change of a sign between
neighbours of some 200 speeds is refined. Two zeros of one eigenvalue between neighbours are missed.

In the axes of an uneven rotor a wave n answers at f = p − n. Supports that differ in their two
directions couple f, f ± 2, …: H is a matrix of blocks, of which five are solved, and then more are
added to each motion by itself until its critical speed stands still. Source: Genta, Dynamics of
Rotating Systems (2005).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.linalg as la
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from exudyn_rotor.bearings.support import NoCoefficientsError
from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.equations import PeriodicSystem, Terms, UnconvergedError, add
from exudyn_rotor.linear.modal.whirl import Content, signed_diameters
from exudyn_rotor.linear.model.assembly import rotors_of
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.solve.hill import real_waves
from exudyn_rotor.linear.solve.motions import Motions
from exudyn_rotor.threads import one_thread

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
_FEW, _MOST = 2, 8  # blocks on each side of the middle one
_ITERATIONS = 8
_OFF = 0.03  # by which films that are smooth between speeds may err
_FAR = 0.5  # share of a critical speed by which the same motion may differ
_STEP = 1e-5  # of the speed, for the derivative of H

Pair = tuple[float, np.ndarray]  # a speed [rad/s] and the motion there


class Resonance(NamedTuple):
    """A critical speed [rad/s] and its motion, harmonics (h, k) at `multiples` (h,) of it."""

    speed: float
    vectors: np.ndarray
    multiples: np.ndarray


class Names(NamedTuple):
    """Of critical speeds the frequency in the frame of the rotor over Ω, whirl and diameters."""

    rotor: np.ndarray
    codes: np.ndarray
    diameters: np.ndarray


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
    between : callable, optional
        Gives equations between the speeds at which films are solved.
    """

    model: LinearModel
    unit: Terms = field(default_factory=dict)
    factor: float = 0.0
    between: Callable[[float], PeriodicSystem] | None = None
    known: dict[float, PeriodicSystem] = field(default_factory=dict)

    def system(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s], without what is added."""
        if speed not in self.known:
            if self.between is not None:
                return self.between(speed)
            system, basis = self.model.at(speed), self.model.moving_basis
            self.known[speed] = system if basis is None else system.projected(basis)
        return self.known[speed]

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

    def motions(self, vector: np.ndarray, multiples: np.ndarray) -> np.ndarray:
        """Return vectors (h·k, …) of H as harmonics (h, c, …) in all coordinates of the model."""
        basis = self.model.moving_basis
        harmonics = vector.reshape(len(multiples), -1, *vector.shape[1:])
        return harmonics if basis is None else np.einsum("ck,hk...->hc...", basis, harmonics)

    def coordinates(self, vectors: np.ndarray) -> np.ndarray:
        """Return harmonics (h, c) in the coordinates of H, (h, k)."""
        basis = self.model.moving_basis
        return vectors if basis is None else vectors @ basis


def _orders(multiples: np.ndarray) -> np.ndarray:
    """Return the differences (h, h) of frequencies, whole numbers."""
    return np.subtract.outer(multiples, multiples).round().astype(int)


def _blocks(multiples: np.ndarray, terms: Terms) -> np.ndarray:
    """Return Fourier terms (k, k) as the matrix that couples frequencies, (h, k, h, k)."""
    orders, k = _orders(multiples), len(terms[0])
    H = np.zeros((len(orders), k, len(orders), k), dtype=complex)
    for a, row in enumerate(orders):
        for b, n in enumerate(row):
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
    is_exact : bool
        Whether films are solved at each critical speed, too, not at some 200 speeds only.
    lost : list of float
        Speeds that did not settle.
    """

    stiffness: Stiffness
    content: Content
    order: float
    diameters: Sequence[int]
    limit: float | None
    tolerance: float
    is_exact: bool = True
    lost: list[float] = field(default_factory=list)

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
        exact = replace(self.stiffness, factor=factor)
        stiffness = replace(exact, between=self._between) if varies else exact
        found: list[Resonance] = []
        for center in self._centers(step):
            few = center + step * np.arange(-_FEW, _FEW + 1) if step else np.array([center])
            met = Excitation(self.content, self.order, self.diameters, few)
            pairs = self._zeros(stiffness, met) if varies else _direct(*_quadratic(stiffness, few))
            pairs = [
                (speed, stiffness.motions(x, few))
                for speed, x in pairs
                if self.limit is None or speed <= self.limit
            ]
            answers = [Resonance(speed, x, few) for speed, x in met.answering(pairs)]
            if step:
                settled = [_settled(stiffness, one, step, self.tolerance) for one in answers]
                self.lost += [a.speed for a, b in zip(answers, settled, strict=True) if b is None]
                answers = [one for one in settled if one is not None]
            found += answers
        if stiffness.between is not None and self.is_exact:
            found = [_polished(exact, stiffness, one) for one in found]
        return found

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
    def known(self) -> tuple[list[float], list[Pair]]:
        """Speeds with equations, and those of them that are neighbours. Others cost a warning."""
        model = self.stiffness.model
        count = _BRACKETS // (1 + model.turns)
        first = self.limit / count
        kinks = model.table_speeds
        kinks = kinks[(kinks > first) & (kinks < self.limit)]
        slow = first * _RATIO ** np.arange(-_SLOW, _SLOW)
        wanted = np.unique([*np.linspace(first, self.limit, count), *slow[slow > first], *kinks])
        wanted = wanted[np.diff(wanted, prepend=0.0) > _SAME * first]
        refused = self._refused(wanted)
        if len(refused) == len(wanted):
            raise refused[wanted[0]]
        if refused:
            _warn(
                f"none are looked for at {len(refused)} of {len(wanted)} speeds from "
                f"{min(refused):.4g} to {max(refused):.4g} rad/s: {next(iter(refused.values()))}"
            )
        else:  # as far down as there are equations
            lower = slow[slow < first]
            wanted = np.r_[lower[lower > max(self._refused(lower), default=0.0)], wanted]
        near = [pair for pair in pairwise(wanted.tolist()) if refused.keys().isdisjoint(pair)]
        return [speed for speed in wanted.tolist() if speed not in refused], near

    def _refused(self, speeds: np.ndarray) -> dict[float, Exception]:
        """Return the speeds without equations, and why they have none."""
        refused = {}
        for speed in speeds.tolist():
            try:
                self.stiffness.system(speed)
            except NO_EQUATIONS as error:
                refused[speed] = error
        return refused

    @cached_property
    def _between(self) -> Callable[[float], PeriodicSystem] | None:
        """Equations between the speeds at which films are solved, which are smooth over the speed.

        None for tables, which have kinks.
        """
        grid, near = self.known
        if self.stiffness.model.table_speeds.size or len(near) + 1 < max(len(grid), 4):
            return None
        systems = [self.stiffness.system(speed) for speed in grid]

        def curves(given: list[Terms]) -> dict[int, CubicSpline]:
            orders = {n for terms in given for n in terms}
            none = np.zeros_like(systems[0].M)
            return {
                n: CubicSpline(np.log(grid), [terms.get(n, none) for terms in given])
                for n in orders
            }

        D, K = curves([s.D for s in systems]), curves([s.K for s in systems])

        def between(speed: float) -> PeriodicSystem:
            at = np.log(speed)
            terms = ({n: curve(at) for n, curve in X.items()} for X in (D, K))
            return PeriodicSystem(speed, systems[0].M, *terms)

        return between

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
            plain, grid = self.stiffness, self.known[0]
            H = np.array([plain(speed, multiples) for speed in grid])
            unit = _blocks(multiples, plain.unit or {0: 0.0 * plain.system(grid[0]).M})
            unit, h = unit.reshape(H[0].shape), len(multiples)
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

        Only those with a part that the excitation meets, as far as is seen close to them.
        """
        multiples, (grid, near) = met.multiples, self.known
        held, within, unit = self._sampled(multiples)
        within = within + stiffness.factor * unit
        place = {speed: i for i, speed in enumerate(grid)}
        signs = np.linalg.eigvalsh(within)

        def matrix(speed: float) -> np.ndarray:
            H = held.conj().T @ stiffness(speed, multiples) @ held
            return H if np.iscomplexobj(within) else H.real

        places = []
        for low, high in near:
            before, after = signs[place[low]], signs[place[high]]
            for j in np.flatnonzero((before < 0.0) != (after < 0.0)).tolist():
                ends = {low: before[j], high: after[j]}
                at = low + (high - low) * before[j] / (before[j] - after[j])
                beside = np.linalg.eigh(matrix(at))[1][:, max(j - 1, 0) : j + 2]
                share, _ = met.shares(stiffness.motions(held @ beside, multiples))
                if share.max() < 0.5 * _SHARE:
                    continue

                def value(speed: float, ends: dict = ends, j: int = j) -> float:
                    return ends[speed] if speed in ends else np.linalg.eigvalsh(matrix(speed))[j]

                places.append((brentq(value, low, high, xtol=_FINE * self.limit, rtol=_FINE), j))
        places.sort()
        found: list[Pair] = []
        for group in same_speed([speed for speed, _ in places]):
            _, vectors = np.linalg.eigh(matrix(places[group[0]][0]))
            found += [(places[i][0], held @ vectors[:, places[i][1]]) for i in group]
        return found

    def warn(self) -> None:
        """Warn of critical speeds that are left out."""
        if self.lost:
            shown = ", ".join(f"{speed:.5g}" for speed in sorted(self.lost)[:5])
            _warn(
                f"near {shown}{' …' * (len(self.lost) > 5)} rad/s they still change with harmonics "
                f"up to the {_MOST * self._step}th, and are left out"
            )


def _warn(what: str) -> None:
    warnings.warn(f"critical speeds: {what}", UserWarning, stacklevel=user_level())


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
        energy = _energy(content.forms, vectors)
        standing, total = (
            _energy(F[None], vectors)[:, 0] for F in (content.standing, content.whole)
        )
        total = np.maximum(total.sum(axis=0), 1e-300)
        meets = (np.abs(np.abs(self.seen) - p) < 1e-9) & np.isin(
            np.abs(content.waves), self.diameters
        )
        turning = np.sum(energy * meets[..., None], axis=(0, 1))
        # what stands still beside the rotor answers to all
        turning += (np.abs(np.abs(self.multiples) - p) < 1e-9) @ standing
        mean = np.einsum("hw,hwn->n", self.seen, energy)
        return turning / total, mean / (total * (p or 1.0))

    def answering(self, pairs: list[tuple[float, np.ndarray]]) -> list[tuple[float, np.ndarray]]:
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
                vectors[:, :, group] = _one_sense(vectors[:, :, group], self.seen, self.content)
        share, mean = self.shares(vectors)
        kept = np.flatnonzero((share >= _SHARE) & (mean >= -_CONJUGATE))
        return [(speeds[i], vectors[:, :, i]) for i in kept]


def _energy(forms: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return the energies (h, w, n) of harmonics (h, k, n) in forms (w, k, k)."""
    moved = forms[None] @ vectors[:, None]
    return np.sum((vectors[:, None].conj() * moved).real, axis=2)


def _one_sense(vectors: np.ndarray, seen: np.ndarray, content: Content) -> np.ndarray:
    """Return motions (h, k, g) of one speed so that each turns one way in time, then in space."""
    flat = vectors.reshape(-1, vectors.shape[2])
    span, lengths, _ = np.linalg.svd(flat, full_matrices=False)
    if lengths[-1] < 1e-3 * lengths[0]:
        return vectors
    span = span.reshape(vectors.shape)
    weights = 10.0 * np.sign(np.where(np.abs(seen) < 1e-9, 0.0, seen)) + content.waves
    mean = np.tensordot(weights, content.forms, axes=(1, 0)) + 0.4 * content.axial
    whole = content.whole + content.standing
    form, size = (
        sum(x.conj().T @ (F @ x) for F, x in zip(forms, span, strict=True))
        for forms in (mean, [whole] * len(span))
    )
    floor = 1e-12 * max(np.trace(size).real, 1e-300)
    form, size = (0.5 * (F + F.conj().T) for F in (form, size))
    _, turn = la.eigh(form, size + floor * np.eye(len(size)))
    turned = span @ turn
    return turned / np.linalg.norm(turned, axis=(0, 1))


# ------------------------------------------------------------------ one motion by itself


def refined(
    stiffness: Stiffness,
    found: Resonance,
    smooth: Stiffness | None = None,
    tolerance: float = 1e-9,
) -> Resonance:
    """Return the critical speed next to one, and its motion, by inverse iteration.

    The slope of H may be that of a `smooth` one. The speed is NaN where it does not converge.
    """
    speed, multiples, smooth = found.speed, found.multiples, smooth or stiffness
    x = stiffness.coordinates(found.vectors).ravel()
    for _ in range(_ITERATIONS):
        H = stiffness(speed, multiples)
        later = H if smooth is stiffness else smooth(speed, multiples)
        earlier = smooth(speed * (1.0 - _STEP), multiples)
        try:
            moved = np.linalg.solve(H, (later - earlier) @ x / (speed * _STEP))
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
    return Resonance(float(speed), stiffness.motions(x, multiples), multiples)


def _settled(
    stiffness: Stiffness, found: Resonance, step: int, tolerance: float
) -> Resonance | None:
    """Add harmonics to a motion until its critical speed does not change; None where it does."""
    change = np.inf
    for _ in range(_FEW, _MOST, 2):
        last, multiples, before = found.speed, found.multiples, change
        beyond = step * np.array([1, 2])
        multiples = np.r_[multiples[0] - beyond[::-1], multiples, multiples[-1] + beyond]
        wider = Resonance(last, np.pad(found.vectors, ((2, 2), (0, 0))), multiples)
        try:  # what is left is the square of a change
            found = refined(stiffness, wider, tolerance=0.1 * np.sqrt(tolerance))
        except NO_EQUATIONS:
            return None
        change = abs(found.speed - last)
        if change <= tolerance * last:
            return found
        if not change < 0.3 * before:
            return None
    return None


def _polished(stiffness: Stiffness, smooth: Stiffness, found: Resonance) -> Resonance:
    """Return a critical speed with the films that are there."""
    try:
        better = refined(stiffness, found, smooth, 1e-7)
    except NO_EQUATIONS:
        return found
    return better if abs(better.speed - found.speed) < _OFF * found.speed else found


def named(found: Sequence[Resonance], content: Content) -> tuple[list[Resonance], Names]:
    """Return critical speeds, ascending, those of one speed from backward to forward waves."""
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
    return [found[i] for i in row], Names(*(each[row] for each in (rotor, codes, diameters)))
