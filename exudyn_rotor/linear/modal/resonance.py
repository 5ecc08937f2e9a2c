"""Critical speeds: spin speeds at which an excitation meets a natural frequency.

An excitation of order p turns or vibrates with pΩ in axes that stand still: p = 1 is unbalance. A
motion with the frequency fΩ in the axes of the equations has the undamped dynamic stiffness

    H(Ω) = K(Ω) + i f Ω D(Ω) − f² Ω² M,

a Hermitian matrix; f = p in axes that stand still. Where only the spin itself changes with the
speed, ``H = K0 − Ω² B``: one eigenproblem has all critical speeds. Tables and films leave the zeros
of the sorted eigenvalues of H, which are continuous functions of Ω; each change of a sign between
neighbours of some 200 speeds is refined. Two zeros between neighbours, of one eigenvalue, are
missed.

In the axes of an uneven rotor a wave n answers at f = p − n. Supports that differ in their two
directions couple f, f ± 2, …: H is a matrix of blocks, of which five are solved, and then more are
added to each motion by itself until its critical speed stands still. Source: Genta, Dynamics of
Rotating Systems (2005).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import scipy.linalg as la
from scipy.optimize import brentq

from exudyn_rotor.bearings.bearing import NoEquilibriumError
from exudyn_rotor.bearings.support import NoCoefficientsError
from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.equations import PeriodicSystem, UnconvergedError
from exudyn_rotor.linear.modal.whirl_new import Content, signed_diameters
from exudyn_rotor.linear.model.assembly import rotors_of
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.solve.motions import Motions
from exudyn_rotor.threads import one_thread

NO_EQUATIONS = NoCoefficientsError, NoEquilibriumError, UnconvergedError
_SHARE = 0.4  # of a motion's energy that must turn with the excitation
# a motion whose mean order is below minus this share of the order is the conjugate of another
_CONJUGATE = 0.25
_SAME = 1e-7  # relative distance of speeds that are one
_AT_REST = 1e-8  # rad/s: a rotor runs, and its inertia is below the rounding of any stiffness
_FREE = 1e-13  # share of the largest stiffness that is rounding
_NO_INERTIA = 1e-6  # share of the largest inertia
_BRACKETS = 200  # speeds at which signs of eigenvalues are looked at
_HALVES = 6  # of the first of these
_FINE = 1e-11  # of the largest speed, to which zeros are refined
_FEW, _MOST = 2, 7  # blocks on each side of the middle one
_ITERATIONS = 8
_STEP = 1e-5  # of the speed, for the derivative of H


class Resonances(NamedTuple):
    """Critical speeds, ascending, of one speed from backward to forward waves.

    Attributes
    ----------
    speeds : ndarray, shape (c,)
        [rad/s]
    rotor : ndarray, shape (c,)
        Frequency in the frame of the rotor over the speed.
    codes, diameters : ndarray of int, shape (c,)
        Index into :data:`WHIRLS`, and nodal diameters.
    vectors : tuple of ndarray, shape (h, k)
        Harmonics of each motion at `multiples` of the speed.
    multiples : tuple of ndarray, shape (h,)
    """

    speeds: np.ndarray
    rotor: np.ndarray
    codes: np.ndarray
    diameters: np.ndarray
    vectors: tuple[np.ndarray, ...]
    multiples: tuple[np.ndarray, ...]


@dataclass(frozen=True, eq=False)
class Stiffness:
    """The dynamic stiffness of an undamped model, whose equations are made once per speed.

    Motions that nothing holds at any speed, like a free spin, are none of its coordinates.
    """

    model: LinearModel
    known: dict[float, PeriodicSystem] = field(default_factory=dict)

    def system(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s]."""
        if speed not in self.known:
            system = self.model.at(speed)
            basis = self.model.moving_basis
            self.known[speed] = system if basis is None else system.projected(basis)
        return self.known[speed]

    def __call__(self, speed: float, multiples: np.ndarray) -> np.ndarray:
        """Return H at a speed for frequencies `multiples` (h,) of it, (h·k, h·k)."""
        system, h = self.system(speed), len(multiples)
        H = np.zeros((h, system.size, h, system.size), dtype=complex)
        for a, first in enumerate(multiples):
            H[a, :, a] -= (first * speed) ** 2 * system.M
            for b, second in enumerate(multiples):
                n = round(first - second)
                if n in system.K:
                    H[a, :, b] += system.K[n]
                if n in system.D and second:
                    H[a, :, b] += 1j * second * speed * system.D[n]
        H = H.reshape(h * system.size, -1)
        # what damps and what drives a motion is the other part
        return 0.5 * (H + H.conj().T)

    def motions(self, vectors: np.ndarray) -> np.ndarray:
        """Return harmonics (h, c, n) in all coordinates of the model."""
        basis = self.model.moving_basis
        return vectors if basis is None else np.einsum("ck,hkn->hcn", basis, vectors)

    def coordinates(self, vectors: np.ndarray) -> np.ndarray:
        """Return harmonics (h, k) in the coordinates of H."""
        basis = self.model.moving_basis
        return vectors if basis is None else vectors @ basis


@one_thread()
def resonances(
    model: LinearModel,
    content: Content,
    order: float,
    diameters: Sequence[int],
    limit: float | None,
    tolerance: float,
) -> Resonances:
    """Return all critical speeds of an undamped model up to a limit.

    Parameters
    ----------
    model : LinearModel
    content : Content
    order : float
        p ≥ 0.
    diameters : sequence of int
        Nodal diameters that may be excited.
    limit : float or None
        Largest speed [rad/s]; needed where the stiffness varies with it.
    tolerance : float
        Largest relative change of a speed by further harmonics.

    Raises
    ------
    ValueError
        Where the limit is needed and missing, or a support has a negative stiffness.
    """
    if limit is None and model.stiffness_varies:
        raise ValueError(
            "max_speed: a system that varies with the speed needs the largest speed of interest "
            "[rad/s]"
        )
    stiffness = Stiffness(model)
    sampled = _Sampled(stiffness, limit) if model.stiffness_varies else None
    step = stiffness.system(sampled.grid[-1] if sampled else 1.0).step
    found: list[tuple[float, np.ndarray, np.ndarray]] = []
    lost: list[float] = []
    for center in _centers(model, order, diameters, step):
        few = center + step * np.arange(-_FEW, _FEW + 1) if step else np.array([center])
        if sampled is not None:
            pairs = sampled.zeros(few)
        else:
            pairs = _direct(*_quadratic(stiffness, few))
        pairs = [pair for pair in pairs if limit is None or pair[0] <= limit]
        speeds, vectors = _turning(pairs, few, stiffness, content, order, diameters)
        for speed, x in zip(speeds, vectors, strict=True):
            multiples = few
            if step:
                speed, x, multiples = _settled(stiffness, speed, x, few, step, tolerance)
                if x is None:
                    lost.append(speed)
                    continue
            found.append((speed, x, multiples))
    if lost:
        shown = ", ".join(f"{speed:.5g}" for speed in sorted(lost))
        warnings.warn(
            f"critical speeds: near {shown} rad/s they still change with harmonics up to the "
            f"{_MOST * step}th, and are left out",
            UserWarning,
            stacklevel=user_level(),
        )
    return _named(found, stiffness, content)


def _centers(
    model: LinearModel, order: float, diameters: Sequence[int], step: int
) -> list[float]:
    """Return the frequencies over Ω at which waves answer; of those that are coupled, one."""
    ratios = {model.ratios[body.name] for body in rotors_of(model.bodies)}
    shifts = []
    for n in diameters:
        for sign in (1, -1) if n and order else (1,):  # at order 0 a motion and its conjugate
            # waves of more diameters stay in the axes of their rotor
            shifts += [sign * n * r for r in ratios] if n > 1 else [sign * n * model.turns]
    centers = sorted({order - shift for shift in shifts}, key=lambda f: (abs(f), f))
    if not step:
        return centers
    first = {}
    for f in centers:
        first.setdefault(round(f % step, 9) % step, f)
    return list(first.values())


# ------------------------------------------------------------------ singular stiffness


def _quadratic(stiffness: Stiffness, multiples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return K0 and B of ``H = K0 − Ω² B``."""
    K0 = stiffness(_AT_REST, multiples)
    M = stiffness.system(_AT_REST).M
    speed = float(np.sqrt(np.abs(K0).max() / max(np.abs(M).max(initial=0.0), 1e-300))) or 1.0
    return K0, (K0 - stiffness(speed, multiples)) / speed**2


def _direct(A: np.ndarray, B: np.ndarray) -> list[tuple[float, np.ndarray]]:
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


@dataclass(frozen=True, eq=False)
class _Sampled:
    """Zeros of the eigenvalues of H over the speed, between speeds that have equations."""

    stiffness: Stiffness
    limit: float
    grid: list[float] = field(init=False)
    neighbours: list[tuple[float, float]] = field(init=False)

    def __post_init__(self) -> None:
        model, first = self.stiffness.model, self.limit / _BRACKETS
        even = np.linspace(first, self.limit, _BRACKETS)
        kinks = model.table_speeds
        kinks = kinks[(kinks > first) & (kinks < self.limit)]
        wanted = np.unique([*even, *kinks])
        refused, error = self._refused(wanted)
        if len(refused) == len(wanted):
            raise error
        if not refused:  # as far down as there are equations
            lower = first * 0.5 ** np.arange(_HALVES, 0, -1)
            failed, _ = self._refused(lower)
            lower = lower[lower > max(failed, default=0.0)]
            wanted = np.r_[lower, wanted]
        known = [speed for speed in wanted.tolist() if speed not in refused]
        place = {speed: i for i, speed in enumerate(wanted.tolist())}
        near = [(a, b) for a, b in pairwise(known) if place[b] == place[a] + 1]
        object.__setattr__(self, "grid", known)
        object.__setattr__(self, "neighbours", near)
        if refused:
            _warn_of_refused(wanted, refused, error)

    def _refused(self, speeds: np.ndarray) -> tuple[set[float], Exception | None]:
        """Return the speeds without equations, and why the first of them has none."""
        refused, first = set(), None
        for speed in speeds.tolist():
            try:
                self.stiffness.system(speed)
            except NO_EQUATIONS as error:
                refused.add(speed)
                first = first or error
        return refused, first

    def zeros(self, multiples: np.ndarray) -> list[tuple[float, np.ndarray]]:
        """Return the speeds at which H is singular, each with its null vector."""
        held = self._held(multiples)

        def values(speed: float) -> np.ndarray:
            H = self.stiffness(speed, multiples)
            return np.linalg.eigvalsh(held.conj().T @ H @ held)

        signs = {speed: values(speed) for speed in self.grid}
        places = []
        for low, high in self.neighbours:
            for j in np.flatnonzero((signs[low] < 0.0) != (signs[high] < 0.0)):
                def value(speed: float, j: int = j) -> float:
                    return signs[speed][j] if speed in signs else values(speed)[j]

                at = brentq(value, low, high, xtol=_FINE * self.limit, rtol=_FINE)
                places.append((at, int(j)))
        places.sort()
        found = []
        for group in same_speed([speed for speed, _ in places]):
            H = self.stiffness(places[group[0]][0], multiples)
            _, vectors = np.linalg.eigh(held.conj().T @ H @ held)
            found += [(places[i][0], held @ vectors[:, places[i][1]]) for i in group]
        return found

    def _held(self, multiples: np.ndarray) -> np.ndarray:
        """Return a basis without motions that are free at every speed: rounding has their signs."""
        chosen = {self.grid[0], self.grid[len(self.grid) // 2], self.grid[-1]}
        parts = [self.stiffness(speed, multiples) for speed in sorted(chosen)]
        stack = np.vstack([H / max(np.linalg.norm(H), 1e-300) for H in parts])
        _, sizes, rows = np.linalg.svd(stack, full_matrices=False)
        return rows[sizes > _FREE * len(rows)].conj().T


def _warn_of_refused(wanted: np.ndarray, refused: set[float], error: Exception) -> None:
    """Warn of ranges in which no critical speeds are looked for."""
    ranges: list[list[float]] = []
    for i, speed in enumerate(wanted.tolist()):
        if speed in refused:
            if not (i and wanted[i - 1] in refused):
                ranges.append([speed, speed] if i else [0.0, speed])
            ranges[-1][1] = speed
    shown = " and ".join(f"from {low:.4g} to {high:.4g} rad/s" for low, high in ranges[:3])
    warnings.warn(
        f"critical speeds: {shown}{' …' if len(ranges) > 3 else ''} none are looked for: {error}",
        UserWarning,
        stacklevel=user_level(),
    )


def same_speed(speeds: Sequence[float]) -> list[list[int]]:
    """Return places of ascending speeds in groups of one speed."""
    groups: list[list[int]] = []
    for i, speed in enumerate(speeds):
        if groups and speed - speeds[groups[-1][-1]] <= _SAME * speed:
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


# ------------------------------------------------------------------ which motions answer


def _turning(
    pairs: list[tuple[float, np.ndarray]],
    multiples: np.ndarray,
    stiffness: Stiffness,
    content: Content,
    order: float,
    diameters: Sequence[int],
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return speeds and harmonics (h, k) of the motions that turn with the excitation.

    Of a motion and its conjugate, one.
    """
    if not pairs:
        return np.zeros(0), []
    pairs = sorted(pairs, key=lambda pair: pair[0])
    speeds = np.array([speed for speed, _ in pairs])
    vectors = np.column_stack([vector for _, vector in pairs])
    vectors = stiffness.motions(vectors.reshape(len(multiples), -1, len(pairs)).astype(complex))
    vectors = vectors / np.linalg.norm(vectors, axis=(0, 1))
    seen = multiples[:, None] + content.shifts[None, :]
    for group in same_speed(speeds.tolist()):
        if len(group) > 1:
            vectors[:, :, group] = _one_sense(vectors[:, :, group], seen, content)
    energy = _energy(content.forms, vectors)
    standing, total = (_energy(F[None], vectors)[:, 0] for F in (content.standing, content.whole))
    total = np.maximum(total.sum(axis=0), 1e-300)
    meets = (np.abs(np.abs(seen) - order) < 1e-9) & np.isin(np.abs(content.waves), diameters)
    turning = np.sum(energy * meets[..., None], axis=(0, 1))
    # what stands still beside the rotor answers to all
    turning += (np.abs(np.abs(multiples) - order) < 1e-9) @ standing
    conjugate = np.einsum("hw,hwn->n", seen, energy) < -_CONJUGATE * order * total
    kept = np.flatnonzero((turning >= _SHARE * total) & ~conjugate)
    return speeds[kept], [vectors[:, :, column] for column in kept]


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
    H: Callable[[float], np.ndarray], speed: float, vector: np.ndarray
) -> tuple[float, np.ndarray]:
    """Return the zero of H and its vector next to given ones, by inverse iteration.

    The speed is NaN where it does not converge.
    """
    for _ in range(_ITERATIONS):
        here = H(speed)
        slope = (here - H(speed * (1.0 - _STEP))) / (speed * _STEP)
        try:
            moved = np.linalg.solve(here, slope @ vector)
        except np.linalg.LinAlgError:  # there already
            return speed, vector
        change = np.vdot(vector, vector) / np.vdot(vector, moved)
        vector = moved / np.linalg.norm(moved)
        speed = speed - change.real
        if not 0.0 < speed < np.inf:
            break
        if abs(change.real) <= 1e-9 * speed:
            return float(speed), vector
    return np.nan, vector


def _settled(
    stiffness: Stiffness,
    speed: float,
    x: np.ndarray,
    multiples: np.ndarray,
    step: int,
    tolerance: float,
) -> tuple[float, np.ndarray | None, np.ndarray]:
    """Add harmonics to a motion until its critical speed does not change; None where it does."""
    x, last = stiffness.coordinates(x), speed
    for _ in range(_FEW, _MOST):
        multiples = np.r_[multiples[0] - step, multiples, multiples[-1] + step]
        given = np.pad(x, ((1, 1), (0, 0)))
        try:
            new, vector = refined(
                lambda s, f=multiples: stiffness(s, f), last, given.ravel()
            )
        except NO_EQUATIONS:
            break
        if np.isnan(new):
            break
        x, change, last = vector.reshape(given.shape), abs(new - last), new
        if change <= tolerance * new:
            return new, stiffness.motions(x[:, :, None])[:, :, 0], multiples
    return speed, None, multiples


# ------------------------------------------------------------------ names


def _named(
    found: list[tuple[float, np.ndarray, np.ndarray]], stiffness: Stiffness, content: Content
) -> Resonances:
    """Return critical speeds in order, with the names of their motions."""
    speeds = np.array([speed for speed, _, _ in found])
    rotor = np.zeros(len(found))
    codes, diameters = np.zeros((2, len(found)), dtype=np.int64)
    alike: dict[tuple, list[int]] = {}
    for i, (_, _, multiples) in enumerate(found):
        alike.setdefault(tuple(multiples), []).append(i)
    for multiples, places in alike.items():
        center = multiples[len(multiples) // 2]
        orders = np.round(np.array(multiples) - center).astype(int)
        vectors = np.stack([found[i][1] for i in places], axis=2)
        vectors = vectors / np.linalg.norm(vectors, axis=(0, 1))
        # all frequencies go with the speed, so that one speed stands for all
        values = np.full(len(places), 1j * center)
        named = content.named(Motions(1.0, values, vectors, orders, 0.0), apart=True)
        codes[places], diameters[places] = named.codes, named.diameters
        rotor[places] = named.rotor
    ascending = np.argsort(speeds, kind="stable")
    senses = signed_diameters(codes, diameters)
    row = [
        ascending[i]
        for group in same_speed(speeds[ascending].tolist())
        for i in sorted(group, key=lambda i: senses[ascending[i]])
    ]
    row = np.array(row, dtype=int)
    return Resonances(
        np.sort(speeds), rotor[row], codes[row], diameters[row],
        tuple(found[i][1] for i in row), tuple(found[i][2] for i in row),
    )  # fmt: skip
