"""Critical speeds: spin speeds at which an excitation meets a natural frequency.

An excitation of order p turns or vibrates with pΩ in the inertial frame: p = 1 is unbalance. A
mode with the wave n answers at ``ν = (p − n)Ω`` in the rotor frame. There the undamped equations
are Hermitian and quadratic in Ω,

    [K − Ω² (f²M − 2if G + C − K2)] φ = 0,    f = p − n,

one generalised eigenproblem for all critical speeds: for unbalance of an axisymmetric rotor f = 0
and ``det K(Ω) = 0``. Supports that stand still and differ in their two directions couple f, f ± 2
…: the same problem in harmonics. Supports that depend on the speed leave ``H(Ω) φ = 0`` with a
Hermitian H; the zeros of its eigenvalues over Ω are found by bracketing
(:mod:`.hermitian_zeros`). Several axisymmetric rotors are looked at in axes at rest, where uneven
supports couple nothing: one problem of the frequency pΩ. Source: Genta, Dynamics of Rotating
Systems (2005).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.linear.modal.hermitian_zeros import (
    NO_EQUATIONS,
    same_speed,
    zeros_of_eigenvalues,
)
from exudyn_rotor.linear.modal.whirl import WhirlContent
from exudyn_rotor.linear.models.basis.critical_shift import CriticalMotion
from exudyn_rotor.linear.models.protocol import LinearModel, Space
from exudyn_rotor.linear.models.trains.standing_space import StandingSpace
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.linear.periodic.harmonics import dynamic_stiffness
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.threads import one_thread

# share of a mode's energy that must turn with the excitation
_SHARE = 0.4
# a motion whose mean order is below minus this share of the order is the conjugate of another
_CONJUGATE = 0.25
_MOST_STEPS = 8
# share of the largest inertia; an uneven mesh leaves 1e-10 for the spin
_NO_INERTIA = 1e-6
# deviation from K − Ω²B, relative to K, that differences in a scene may leave
_QUADRATIC = 1e-6
# two critical speeds this close are looked at as a pair
PAIR = 1e-2
_MOST_ROUNDS = 20
_VARIES = "a system that varies with the speed"
_MODES = 10  # that the subspace of a full rotor begins with


@dataclass(frozen=True, eq=False)
class Resonance:
    """One critical speed: harmonics (h, c) of its motion at the frequencies `multiples`·Ω.

    `upper` is the other one of a pair that is listed by its lower one.
    """

    speed: float
    multiples: np.ndarray
    vectors: np.ndarray
    upper: Resonance | None = None

    @property
    def split(self) -> float:
        """Distance of the upper one, relative to `speed`; 0 without one."""
        return 0.0 if self.upper is None else self.upper.speed / self.speed - 1.0

    @property
    def motions(self) -> tuple[CriticalMotion, CriticalMotion | None]:
        """This motion and the upper one."""
        own = CriticalMotion(self.speed, self.multiples, self.vectors)
        return own, None if self.upper is None else self.upper.motions[0]


@one_thread()
def resonances(
    model: LinearModel,
    content: WhirlContent,
    order: float,
    waves: Sequence[int],
    limit: float | None,
    tolerance: float,
    residual: float,
) -> list[Resonance]:
    """Return all critical speeds, ascending; motions in the coordinates of the model.

    Raises
    ------
    ValueError
        If the largest speed `limit` is needed and missing, or the search does not converge.
    """
    if not model.gives_all:
        limit = _needed(limit, "a large SolidRotor")
    space = model.space(_MODES, limit or 0.0, residual=residual)
    for _ in range(_MOST_ROUNDS):
        equations = _Equations(space, model.stiffness_varies, {})
        critical = _resonances(
            equations, content.within(space.basis), order, waves, limit, tolerance
        )
        if model.gives_all:
            return _joined(critical, content)
        if space.basis is not None:
            critical = [replace(entry, vectors=entry.vectors @ space.basis.T) for entry in critical]
        if space.holds([(entry.speed, _as_modes(entry)) for entry in critical]):
            return _joined(critical, content)
    raise ValueError("critical speeds: the full model does not converge; give a larger tolerance")


def _as_modes(resonance: Resonance) -> FloquetModes:
    center = len(resonance.multiples) // 2
    orders = np.round(resonance.multiples - resonance.multiples[center]).astype(int)
    value = 1j * resonance.multiples[center] * resonance.speed
    return FloquetModes(np.array([value]), resonance.vectors[:, :, None], orders, 0.0)


def _resonances(
    equations: _Equations,
    content: WhirlContent,
    order: float,
    waves: Sequence[int],
    limit: float | None,
    tolerance: float,
) -> list[Resonance]:
    """Return all critical speeds of dense equations, ascending."""
    step = equations.step(limit)
    critical = []
    if step == 0:
        for n in waves:
            critical += _turning(
                _solved(equations, np.array([order - n]), limit), content, order, waves
            )
    elif isinstance(equations.space, StandingSpace):
        critical = _turning(_standing(equations, order, limit), content, order, waves)
    else:
        # with a step of one all harmonics, those of the conjugate motions too, are in one row
        starts = {n % step: n for n in waves}.values() if step > 1 else [round(order)]
        for start in starts:
            critical += _converged(
                equations, content, order, waves, order - start, step, limit, tolerance
            )
    return sorted(critical, key=lambda entry: entry.speed)


def _standing(equations: _Equations, order: float, limit: float | None) -> list[Resonance]:
    """Return every critical speed by equations that are constant in axes at rest, with its motion.

    There the excitation has the frequency pΩ and no other.
    """
    space = equations.space
    still = replace(equations, space=space.standing, known={})
    found = _solved(still, np.array([order]), limit)
    if not found:
        return []
    vectors, orders = space.turned_harmonics(np.column_stack([entry.vectors[0] for entry in found]))
    return [
        replace(entry, multiples=order + orders, vectors=vectors[..., column])
        for column, entry in enumerate(found)
    ]


def _converged(
    equations: _Equations,
    content: WhirlContent,
    order: float,
    waves: Sequence[int],
    center: float,
    step: int,
    limit: float | None,
    tolerance: float,
) -> list[Resonance]:
    """Add harmonics until the critical speeds do not change any more."""
    last = None
    for count in range(2, _MOST_STEPS):
        multiples = center + step * np.arange(-count, count + 1)
        critical = _turning(_solved(equations, multiples, limit), content, order, waves)
        speeds = np.sort([entry.speed for entry in critical])
        changes = np.full(1, np.inf)
        if last is not None and len(last) == len(speeds):
            changes = np.abs(speeds - last) / speeds
        if np.all(changes <= tolerance):
            return critical
        last = speeds
    remedy = "give a smaller max_speed, or use fewer high modes"
    if np.all(np.isfinite(changes)):
        worst = np.argmax(changes)
        remedy = (
            f"that at {speeds[worst]:.6g} rad/s by {changes[worst]:.1e} of it, which is more than "
            f"the tolerance of {tolerance:.1e}: give a larger one"
        )
    raise ValueError(
        f"critical speeds: with harmonics up to the {step * (_MOST_STEPS - 1)}th they still "
        f"change; {remedy}"
    )


def _solved(equations: _Equations, multiples: np.ndarray, limit: float | None) -> list[Resonance]:
    """Return every speed with a singular dynamic stiffness, with the motion."""
    stiffness = _Stiffness(equations, multiples)
    if equations.vary(stiffness, limit):
        pairs = zeros_of_eigenvalues(stiffness, _needed(limit, _VARIES))
    else:
        at_rest = stiffness(0.0)
        scale = equations.scale(at_rest, limit)
        pairs = _direct(at_rest, (at_rest - stiffness(scale)) / scale**2)
    return [
        Resonance(speed, multiples, vector.reshape(len(multiples), -1))
        for speed, vector in pairs
        if limit is None or speed <= limit
    ]


@dataclass(frozen=True, eq=False)
class _Stiffness:
    """The dynamic stiffness as a function of the speed."""

    equations: _Equations
    multiples: np.ndarray

    def __call__(self, speed: float) -> np.ndarray:
        return dynamic_stiffness(self.equations.at(speed), self.multiples)[0]


@dataclass(frozen=True, eq=False)
class _Equations:
    """The equations of a space, solved for once per speed: linearising a scene is slow.

    Attributes
    ----------
    space : Space
    supports_vary : bool or None
        Whether supports depend on the speed; None where that has to be tried.
    known : dict of float to PeriodicSystem
    """

    space: Space
    supports_vary: bool | None
    known: dict[float, PeriodicSystem]

    def at(self, speed: float) -> PeriodicSystem:
        if speed not in self.known:
            self.known[speed] = self.space.at(speed)
        return self.known[speed]

    def step(self, limit: float | None) -> int:
        """Return how many harmonics apart the equations couple motions; 0 for none."""
        try:
            return self.at(0.0).step
        except NO_EQUATIONS:  # films carry nothing at rest
            what = "a scene" if self.supports_vary is None else _VARIES
            return self.at(_needed(limit, what)).step

    def vary(self, stiffness: _Stiffness, limit: float | None) -> bool:
        """Return whether anything but the spin itself depends on the speed."""
        if self.supports_vary is not None:
            return self.supports_vary
        limit = _needed(limit, "a scene")
        try:
            at_rest = stiffness(0.0)
        except NO_EQUATIONS:  # films carry nothing at rest
            return True
        half, full = stiffness(0.5 * limit), stiffness(limit)
        expected = 0.75 * at_rest + 0.25 * full
        return np.abs(half - expected).max() > _QUADRATIC * np.abs(at_rest).max()

    def scale(self, at_rest: np.ndarray, limit: float | None) -> float:
        """Return a speed at which inertia and stiffness are alike, within a scene's range."""
        if self.supports_vary is None:
            return limit
        return np.sqrt(np.abs(at_rest).max() / np.abs(self.at(0.0).M[0]).max()) or 1.0


def _direct(A: np.ndarray, B: np.ndarray) -> list[tuple[float, np.ndarray]]:
    """Solve ``A φ = Ω² B φ`` for positive Ω²; A Hermitian, not negative, B Hermitian.

    Free motions, the null space R of A, follow the others by their inertia: ``Rᴴ B φ = 0``. Those
    without any, like the spin, stay at rest.
    """
    values, vectors = np.linalg.eigh(A)
    if values[0] < -1e-8 * values[-1]:
        raise ValueError("critical speeds: a support has a negative stiffness; see campbell")
    held = values > 1e-12 * values[-1]
    R, W = vectors[:, ~held], vectors[:, held] / np.sqrt(values[held])
    inertia, turn = np.linalg.eigh(R.conj().T @ B @ R)
    moving = np.abs(inertia) > _NO_INERTIA * np.abs(B).max()
    R = R @ turn[:, moving]
    basis = W - R @ ((R.conj().T @ B @ W) / inertia[moving, None])
    inverse, shapes = np.linalg.eigh(basis.conj().T @ B @ basis)
    positive = inverse > 1e-12 * np.abs(inverse).max(initial=0.0)
    pairs = zip(1.0 / np.sqrt(inverse[positive]), (basis @ shapes[:, positive]).T, strict=True)
    return [(float(speed), vector) for speed, vector in pairs]


def _turning(
    candidates: list[Resonance], content: WhirlContent, order: float, waves: Sequence[int]
) -> list[Resonance]:
    """Keep motions that turn with the excitation; of a motion and its conjugate, one."""
    if not candidates:
        return []
    ascending = sorted(candidates, key=lambda entry: entry.speed)
    multiples = ascending[0].multiples
    vectors = np.stack([entry.vectors for entry in ascending], axis=2).astype(complex)
    vectors = vectors / np.linalg.norm(vectors.reshape(-1, len(ascending)), axis=0)
    for group in same_speed(list(range(len(ascending))), lambda i: ascending[i].speed):
        if len(group) > 1:
            vectors[:, :, group] = content.polarised(vectors[None, :, :, group], multiples)[0]
    seen = multiples[:, None] + content.orders[None, :]
    energy = content.energies(vectors)
    total = np.maximum(content.whole_energy(vectors), 1e-300)
    meets = (np.abs(np.abs(seen) - order) < 1e-9) & np.isin(np.abs(content.orders), np.abs(waves))
    turning = np.sum(energy * meets[..., None], axis=(0, 1))
    if 0 not in waves:  # what stands still beside the rotor answers to all
        answers = np.abs(np.abs(multiples) - order) < 1e-9
        turning += answers @ content.beside(vectors)
    conjugate = np.einsum("ho,hok->k", seen, energy) < -_CONJUGATE * order * total
    return [
        Resonance(ascending[column].speed, multiples, vectors[:, :, column])
        for column in np.flatnonzero((turning >= _SHARE * total) & ~conjugate)
    ]


def _joined(critical: list[Resonance], content: WhirlContent) -> list[Resonance]:
    """Return resonances, of each pair that an asymmetric rotor splits the lower one.

    Those of a pair are two phases of one motion: combined, all that is seen from outside turns one
    way in time, ``exp(ipΩt)``, or the other, which independent motions cannot do.
    """
    joined: list[Resonance] = []
    taken: set[int] = set()
    pairs = _pairs(critical, content)
    for index, entry in enumerate(critical):
        if index in taken:
            continue
        other = next((j for i, j in pairs if i == index and j not in taken), None)
        if other is not None:
            taken.add(other)
            entry = Resonance(entry.speed, entry.multiples, entry.vectors, critical[other])
        joined.append(entry)
    return joined


def _pairs(critical: list[Resonance], content: WhirlContent) -> list[tuple[int, int]]:
    """Return which of them are close and pairs, each the lower one first, ascending."""
    alike: dict[bytes, list[tuple[int, int]]] = {}
    for index, entry in enumerate(critical):
        for other in range(index + 1, len(critical)):
            upper = critical[other]
            if upper.speed > (1.0 + PAIR) * entry.speed:
                break
            if 0.0 in entry.multiples and np.array_equal(entry.multiples, upper.multiples):
                alike.setdefault(entry.multiples.tobytes(), []).append((index, other))
    result = []
    for close in alike.values():
        lower, upper = (
            np.stack([critical[i].vectors for i in side], axis=2)
            for side in zip(*close, strict=True)
        )
        turning = content.turn_both_ways(lower, upper, critical[close[0][0]].multiples)
        result += [pair for pair, turns in zip(close, turning, strict=True) if turns]
    return sorted(result)


def _needed(limit: float | None, what: str) -> float:
    if limit is None:
        raise ValueError(f"max_speed: {what} needs the largest speed of interest [rad/s]")
    return limit
