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
added to each motion by itself. Source: Genta, Dynamics of Rotating Systems (2005).
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy.linalg as la
from scipy.optimize import brentq

from exudyn_rotor import checks
from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.equations import PeriodicSystem
from exudyn_rotor.linear.modal.whirl import Content
from exudyn_rotor.linear.model.assembly import NO_EQUATIONS, rotors_of
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.solve.hill import in_real_waves, real_waves
from exudyn_rotor.linear.solve.motions import Motions, joined_motions
from exudyn_rotor.solvers.factor import one_thread

_SHARE = 0.4  # of a motion's energy that must turn with the excitation
# a motion whose mean order is below minus this share of the order is the conjugate of another
_CONJUGATE = 0.25
SAME = 1e-7  # relative distance of speeds that are one
_FINE, _DIGITS = 1e-6, 7  # of a place between two speeds, and digits of places that are one
_AT_REST = 1e-8  # rad/s: a rotor runs, and its inertia is below the rounding of any stiffness
_FREE = 1e-13  # share of the largest stiffness that is rounding
_UNHELD = 1e-12  # rad²/s²: stiffness over inertia where nothing is held
_NO_INERTIA = 1e-6  # share of the largest inertia
_BRACKETS = 200  # speeds at which signs of eigenvalues are looked at; half of them for blocks
_SLOW, _RATIO = 24, 8.0  # more speeds around the first of these, and how far apart they reach
_FEW, _MORE = 4, (8, 12, 16)  # harmonics on each side of the middle one
_EDGE = 1e-10  # energy of the last ones that is none
_CLOSE = 1e-5  # last relative change of a critical speed, which errs by its square
_ITERATIONS = 12
_BESIDE = 0.97  # of a critical speed: from where its slope is told at first
_STEP = 1e-6  # relative distance of speeds between which H has a slope
_FAR = 0.5  # share of a critical speed by which the same motion may differ
_BEYOND = 0.1  # of the distance of two speeds: a zero between them may come out so far outside

Zero = tuple[float, np.ndarray]  # a speed at which H is singular [rad/s], and a motion (h, c)


@dataclass(eq=False)
class Stiffness:
    """The dynamic stiffness of an undamped model, whose equations are made once per speed.

    Motions that nothing holds at any speed, like a free spin, are none of its coordinates. Tables
    over the frequency are taken at `order` times the speed.
    """

    model: LinearModel
    order: float
    known: dict[float, PeriodicSystem] = field(default_factory=dict)

    def __post_init__(self) -> None:
        basis = self.model.moving_basis
        self.basis = np.eye(self.model.size) if basis is None else basis

    def system(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s]."""
        if speed not in self.known:
            system = self.model.at(speed, self.order * speed)
            self.known[speed] = system.projected(self.basis)
        return self.known[speed]

    def __call__(self, speed: float, multiples: np.ndarray) -> np.ndarray:
        """Return H at a speed for frequencies `multiples` (h,) of it, (h·k, h·k)."""
        return dynamic_stiffness(self.system(speed), multiples)

    def reach(self, multiples: np.ndarray) -> int:
        """Return how far from its diagonal H has entries."""
        system = next(iter(self.known.values()))
        return system.size * np.count_nonzero(multiples - multiples[0] < system.highest + 0.5) - 1

    def motions(self, vectors: np.ndarray, multiples: np.ndarray) -> np.ndarray:
        """Return vectors (h·k, n) of H as harmonics (h, c, n) in all coordinates of the model."""
        return self.basis @ vectors.reshape(len(multiples), -1, vectors.shape[1])

    def refined(
        self,
        speed: float,
        motion: np.ndarray,
        multiples: np.ndarray,
        before: float | None = None,
    ) -> tuple[float, np.ndarray]:
        """Return the zero next to a speed and a motion (h, c), and its motion.

        By inverse iteration, with the slope of H between the last two speeds, of which `before` is
        the first, a slower one by default. NaN where it does not converge.
        """
        x, begin = (motion @ self.basis).ravel(), speed
        last = _BESIDE * speed if before is None else before
        earlier = self(last, multiples)
        for _ in range(_ITERATIONS):
            H = self(speed, multiples)
            if abs(speed - last) > _STEP * speed or speed == begin:
                slope = (H - earlier) / (speed - last)
                last, earlier = speed, H
            try:
                moved = _solved(H, slope @ x, self.reach(multiples))
            except np.linalg.LinAlgError:  # there already
                return speed, motion
            change = (np.vdot(x, x) / np.vdot(x, moved)).real
            x, speed = moved / np.linalg.norm(moved), float(speed - change)
            if not abs(speed - begin) < _FAR * begin:
                break
            if abs(change) <= _CLOSE * speed:
                return speed, self.motions(x[:, None], multiples)[..., 0]
        return np.nan, motion


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
    where the stiffness varies with it. What is left out stands in `lost`, speeds that did not
    settle, in `jumps`, where a film jumps, and in `refused`, speeds without equations.
    """

    model: LinearModel
    order: float
    diameters: Sequence[int]
    limit: float | None
    lost: list[float] = field(default_factory=list)
    jumps: list[float] = field(default_factory=list)
    refused: dict[float, Exception] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.order = checks.number(self.order, "order", least=0.0)
        if self.limit is not None:
            self.limit = checks.number(self.limit, "max_speed", "rad/s", above=0.0)
        self.diameters = checks.whole_numbers(self.diameters, "nodal_diameters", most=4)
        if not self.diameters.size:
            raise ValueError(
                "nodal_diameters: needs at least one whole number from 0 to 4, got none"
            )
        self.varies = self.model.stiffness_varies
        if self.limit is None and self.varies:
            raise ValueError(
                "max_speed: a system that varies with the speed needs the largest speed of "
                "interest [rad/s]"
            )
        self.stiffness = Stiffness(self.model, self.order)
        self.content = Content.of(self.model)

    @one_thread()
    def motions(self) -> Motions:
        """Return the motions at all critical speeds up to the limit, one at each, ascending.

        Raises
        ------
        ValueError
            Where a support has a negative stiffness.
        """
        step = self.grid.step if self.varies else self.stiffness.system(1.0).step
        found = [one for center in self._centers(step) for one in self._around(center, step)]
        if not found:
            shape = 0, 1, self.model.size, 1
            return Motions(
                np.zeros(0), np.zeros((0, 1)), np.zeros(shape), np.arange(1), np.zeros(0)
            )
        found.sort(key=lambda one: one.speeds[0])
        rows = [(np.array([row]), one) for row, one in enumerate(found)]
        return joined_motions(np.concatenate([one.speeds for one in found]), rows)

    def _centers(self, step: int) -> list[float]:
        """Return the frequencies over Ω at which waves answer; of those that are coupled, one."""
        model = self.model
        ratios = {model.ratios[body.name] for body in rotors_of(model.bodies)}
        shifts = []
        for n in np.unique(self.diameters).tolist():
            for sign in (1, -1) if n and self.order else (1,):  # at order 0 they are conjugates
                # waves of more diameters stay in the axes of their rotor
                shifts += [sign * n * r for r in ratios] if n > 1 else [sign * n * model.turns]
        centers = sorted({self.order - shift for shift in shifts}, key=lambda f: (abs(f), f))
        first: dict[float, float] = {}
        for f in centers:
            first.setdefault(round(f % step, 9) % step if step else f, f)
        return list(first.values())

    def _around(self, center: float, step: int) -> list[Motions]:
        """Return the motions that answer at a frequency over Ω, with harmonics beside it."""
        few = _FEW // step if step else 0
        orders = step * np.arange(-few, few + 1)
        given = self.stiffness, center + orders
        zeros = self._bracketed(given[1]) if self.varies else _direct(*given)
        zeros = [zero for zero in zeros if self.limit is None or zero[0] <= self.limit]
        if not zeros:
            return []
        zeros.sort(key=lambda zero: zero[0])
        speeds, vectors = np.array([zero[0] for zero in zeros]), np.array([x for _, x in zeros])
        vectors = self._apart(speeds, np.moveaxis(vectors, 0, 2), center + orders)
        found = []
        for i in np.flatnonzero(self._answers(vectors, center + orders)):
            one = speeds[i], vectors[..., i], center
            found.append(self._settled(*one, step) if step else _motion(*one, orders))
        return [one for one in found if one is not None]

    def _settled(
        self, speed: float, motion: np.ndarray, center: float, step: int
    ) -> Motions | None:
        """Return a motion with as many harmonics as it needs; None where there are too few."""
        last = speed
        slower = self.grid.speed[self.grid.speed < _BESIDE * speed] if self.varies else np.zeros(0)
        before = float(slower[-1]) if slower.size else None  # where a film is solved already
        for most in _MORE:
            orders = step * np.arange(-(most // step), most // step + 1)
            room = (len(orders) - len(motion)) // 2
            motion = np.pad(motion, ((room, room), (0, 0)))
            try:
                last, motion = self.stiffness.refined(last, motion, center + orders, before)
            except NO_EQUATIONS:  # beside the end of a table
                break
            energy = np.sum(np.abs(motion) ** 2, axis=1)
            if np.isnan(last):
                break
            if energy[0] + energy[-1] <= _EDGE * energy.sum():
                return _motion(last, motion, center, orders)
        self.lost.append(speed)
        return None

    # ------------------------------------------------------------------ stiffness over the speed

    @cached_property
    def grid(self) -> PeriodicSystem:
        """The equations at the speeds that are looked at, ascending, where there are any.

        Slow speeds at which films are too thin are not missed.
        """
        count = _BRACKETS // (1 + self.model.turns)
        first, kinks = self.limit / count, self.model.table_speeds
        slow = np.geomspace(first / _RATIO, first * _RATIO, _SLOW)
        even = np.linspace(first, self.limit, count)
        wanted = np.unique(np.r_[even, slow, kinks[(kinks > first) & (kinks < self.limit)]])
        wanted = wanted[np.diff(wanted, prepend=0.0) > SAME * first]
        stack, errors = self.model.systems(wanted, self.order * wanted)
        if stack is None or np.count_nonzero(stack.known) < 2:
            raise errors[min(errors)]
        self.refused = {float(wanted[i]): errors[i] for i in errors if wanted[i] >= first}
        return stack[stack.known].projected(self.stiffness.basis)

    def _bracketed(self, multiples: np.ndarray) -> list[Zero]:
        """Return where H is singular, by its eigenvalues over the grid."""
        speeds, stack = self.grid.speed, dynamic_stiffness(self.grid, multiples)
        h, basis = len(multiples), np.eye(stack.shape[-1])
        if h > 1 and np.array_equal(multiples, -multiples[::-1]):  # real in cosines and sines
            basis = np.kron(real_waves(h), np.eye(len(basis) // h))
            stack = in_real_waves(stack, h)
        values = _eigenvalues(stack)
        signs = values < 0.0
        gaps = np.diff(np.searchsorted(sorted(self.refused), speeds)) > 0
        found = []
        for row, j in np.argwhere((signs[:-1] != signs[1:]) & ~gaps[:, None]):
            A, change = stack[row], stack[row + 1] - stack[row]
            width = speeds[row + 1] - speeds[row]
            at = _zero_between(A, change, values[row : row + 2, j], j)
            at = np.round(at, _DIGITS)  # of zeros that are one, orthogonal vectors
            guess, vectors = speeds[row] + at * width, basis @ np.linalg.eigh(A + at * change)[1]
            exact = guess, self.stiffness.motions(vectors[:, [j]], multiples)[..., 0]
            try:
                before = float(speeds[row + (at < 0.5)])
                exact = self.stiffness.refined(*exact, multiples, before)
            except NO_EQUATIONS:  # beyond the end of a table, by rounding
                pass
            if abs(exact[0] - speeds[row] - 0.5 * width) < (0.5 + _BEYOND) * width:
                found.append(exact)
            else:
                self.jumps.append(float(guess))
        return found

    # ------------------------------------------------------------------ which motions answer

    def _apart(self, speeds: np.ndarray, vectors: np.ndarray, multiples: np.ndarray) -> np.ndarray:
        """Return motions (h, c, n), of which those of one speed turn one way in time, or space."""
        vectors = vectors / np.linalg.norm(vectors, axis=(0, 1))
        seen = multiples[:, None] + self.content.shifts
        senses = 10.0 * np.sign(np.where(np.abs(seen) < 1e-9, 0.0, seen)) + self.content.waves
        groups = groups_of(speeds)
        for group in np.flatnonzero(np.bincount(groups) > 1):
            chosen = groups == group
            vectors[..., chosen] = self.content.extremal(vectors[None][..., chosen], senses)[0]
        return vectors

    def _answers(self, vectors: np.ndarray, multiples: np.ndarray) -> np.ndarray:
        """Return which motions (h, c, n) turn with the excitation; of one and its conjugate, one.

        By the share of energy that turns so, and by the mean order, which is negative of the
        conjugate of another motion.
        """
        content, p = self.content, self.order
        energy, directions, beside = content.parts(content.energies(vectors[None])[:, 0])
        total = np.maximum(directions[3].sum(axis=0), 1e-300)
        seen = multiples[:, None] + content.shifts  # from outside, over Ω
        meets = np.isin(np.abs(content.waves), self.diameters) & _is_order(seen, p)
        turning = np.einsum("hw,whn->n", meets, energy)
        # what stands still beside the rotor answers to all
        answers = _is_order(np.add.outer(content.beside, multiples), p)
        turning += np.einsum("ph,phn->n", answers, beside)
        mean = np.einsum("hw,whn->n", seen, energy)
        return (turning >= _SHARE * total) & (mean >= -_CONJUGATE * (p or 1.0) * total)

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
        reasons = {
            f"they still change with harmonics up to the {_MORE[-1]}th": self.lost,
            "the stiffness of a film jumps, by less with more nodes": self.jumps,
        }
        for why, speeds in reasons.items():
            if speeds:
                near = ", ".join(f"{speed:.5g}" for speed in np.unique(np.round(speeds, 6))[:5])
                told.append(f"near {near} rad/s {why}, and they are left out")
        if told:
            what = "critical speeds: " + "; ".join(told)
            warnings.warn(what, UserWarning, stacklevel=user_level())


def _motion(speed: float, motion: np.ndarray, center: float, orders: np.ndarray) -> Motions:
    """Return the motion (h, c) at a critical speed, its harmonics beside a frequency over Ω."""
    values = np.array([[1j * center * speed]])
    return Motions(np.array([speed]), values, motion[None, :, :, None], orders, np.zeros(1))


def _is_order(frequencies: np.ndarray, order: float) -> np.ndarray:
    return np.abs(np.abs(frequencies) - order) < 1e-9


def groups_of(speeds: np.ndarray) -> np.ndarray:
    """Return the number of each of ascending speeds, the same where they are one."""
    return np.cumsum(np.diff(speeds, prepend=speeds[:1]) > SAME * speeds)


def _eigenvalues(H: np.ndarray) -> np.ndarray:
    """Return the eigenvalues of H, or of a stack, zero where they are rounding."""
    values = np.linalg.eigvalsh(H)
    rounding = _FREE * np.abs(values).max(axis=-1, initial=0.0, keepdims=True)
    return np.where(np.abs(values) <= rounding, 0.0, values)


def _zero_between(A: np.ndarray, change: np.ndarray, ends: np.ndarray, j: int) -> float:
    """Return the share of a change, from 0 to 1, at which an eigenvalue of A is zero.

    The values at both `ends` (2,) are known; rounding would else give a zero there another sign.
    """
    known = {0.0: ends[0], 1.0: ends[1]}

    def value(at: float) -> float:
        return known[at] if at in known else _eigenvalues(A + at * change)[j]

    return brentq(value, 0.0, 1.0, xtol=_FINE)


def _solved(H: np.ndarray, load: np.ndarray, reach: int) -> np.ndarray:
    """Return the solution of equations whose matrix has entries so near to its diagonal alone."""
    size = len(H)
    if 4 * reach > size:
        return np.linalg.solve(H, load)
    bands = np.zeros((2 * reach + 1, size), dtype=H.dtype)
    for n in range(-reach, reach + 1):  # column j of row reach − n is H[j − n, j]
        bands[reach - n, max(n, 0) : size + min(n, 0)] = np.diagonal(H, n)
    return la.solve_banded((reach, reach), bands, load, check_finite=False)


def _direct(stiffness: Stiffness, multiples: np.ndarray) -> list[Zero]:
    """Return all zeros of ``H = A − Ω² B``, A not negative, with null vectors.

    Free motions, the null space R of A, follow the others by their inertia: ``Rᴴ B φ = 0``. Those
    without any stay at rest.
    """
    A, M = stiffness(_AT_REST, multiples), stiffness.system(_AT_REST).M
    if np.abs(A).max(initial=0.0) <= _UNHELD * np.abs(M).max(initial=0.0):
        return []
    speed = float(np.sqrt(np.abs(A).max() / np.abs(M).max()))
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
    motions = stiffness.motions(W @ shapes[:, positive], multiples)
    return list(zip(speeds.tolist(), np.moveaxis(motions, 2, 0), strict=True))
