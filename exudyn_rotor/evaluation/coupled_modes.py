"""Modes of a rotor over an applied cross-coupling, and the first forward one as one curve.

On supports that differ in two directions modes move in planes. Cross-coupling joins two planes to a
forward and a backward whirl, at Q = Δk/2 in a rotor of one mass. Below, the sense of whirl of
neither mode tells which one will grow. The first forward mode is chosen where it has grown,
therefore, and is followed back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor.linear.equations import PeriodicSystem, Terms, difference
from exudyn_rotor.linear.modal.whirl import (
    BACKWARD,
    FORWARD,
    Content,
    Named,
    damping_of,
    likenesses,
    matched,
)
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import motions_in, motions_over, warn_of

MULTIPLES = np.linspace(0.0, 10.0, 11)  # of the anticipated cross-coupling
_BEYOND = (100.0, 1000.0)  # where a mode is sought that grows at last
_LITTLE = 1e-4  # that parts modes which are alike without it
_ROUNDING = 1e-9  # growth over the frequency that is none
_NEUTRAL = 1e-7  # growth over the frequency of the mode whose limit it is
_STILL = 1e-3  # of the speed: a frequency below is that of a motion that does not whirl
_RESONANT = np.sqrt(0.5)  # damping ratio above which a mode has no resonance
_FED = 1e-6  # share of the power to a mode that is none: orbits in planes, nodes
_HALVES = 10  # how often a step is halved
_UNLIKE = 0.01  # likeness of shapes below which a mode cannot be the other one
_TIE = 1.5  # ways of two modes over each other that are alike
_JOINED = 0.05  # share of a place by which a mode goes at most in the shortest step
_APART = 4.0  # how much farther than a mode goes in a step another one is at its end


class Modes(NamedTuple):
    """Modes (k,) under one multiple of the anticipated cross-coupling.

    `places` are growth and frequency seen from outside, as one complex number. A mode `swings`
    that is lateral and has a resonance; where cross-coupling acts a `forward` one whirls forward.
    """

    named: Named
    places: np.ndarray
    lateral: np.ndarray
    swings: np.ndarray
    forward: np.ndarray

    @property
    def unstable(self) -> np.ndarray:
        """Modes that swing and grow by more than rounding."""
        return self.swings & (self.places.real > _ROUNDING * self.places.imag)

    @property
    def grows(self) -> np.ndarray:
        """Growth of the forward and the unstable modes that swing [1/s]; −∞ of others."""
        return np.where(self.swings & self.forward | self.unstable, self.places.real, -np.inf)

    def lowest(self, chosen: np.ndarray) -> int:
        """Return the mode of the lowest frequency among some."""
        return int(np.argmin(np.where(chosen, self.places.imag, np.inf)))


@dataclass(eq=False)
class CoupledModes:
    """Modes over multiples of the anticipated cross-coupling, each computed once.

    Attributes
    ----------
    model_at : callable
        Returns the model under a multiple.
    speed : float
        [rad/s]
    coupling : mapping of str to float
        Anticipated cross-coupling at interfaces [N/m].
    known : dict
        Modes by multiples.
    """

    model_at: Callable[[float], LinearModel]
    speed: float
    coupling: Mapping[str, float]
    known: dict[float, Modes] = field(default_factory=dict)

    @cached_property
    def _model(self) -> LinearModel:
        return self.model_at(1.0)

    @cached_property
    def _content(self) -> Content:
        return Content.of(self._model)

    @cached_property
    def _parts(self) -> tuple[PeriodicSystem, Terms]:
        """Equations without cross-coupling, and the stiffness of the anticipated one."""
        without, coupled = (each.at(self.speed) for each in (self.model_at(0.0), self._model))
        return without, difference(coupled.K, without.K)

    def at(self, multiple: float) -> Modes:
        """Return the modes under a multiple."""
        self.solve([multiple])
        return self.known[multiple]

    def solve(self, multiples: Iterable[float]) -> None:
        """Find the modes under multiples together."""
        new = [each for each in multiples if each not in self.known]
        if self._model.over_frequency:
            for each in new:
                motions = motions_over(self.model_at(each), [self.speed], held=True)
                self.known[each] = self._modes(self._content.named(motions))
        elif new:
            alone, K = self._parts
            shape, factor = (len(new), alone.size, alone.size), np.array(new)[:, None, None]
            D = {n: np.broadcast_to(X, shape) for n, X in alone.D.items()}
            K = {n: alone.K.get(n, 0.0) + factor * X for n, X in K.items()}
            stack = PeriodicSystem(np.full(len(new), self.speed), alone.M, D, K, alone.H)
            motions = motions_in(self._model, stack, "auto", 1e-6, held=True)
            if not self.known:
                warn_of(self._model, motions, motions)
            named = self._content.named(motions)
            self.known |= {each: self._modes(named.rows([i])) for i, each in enumerate(new)}

    def _modes(self, named: Named) -> Modes:
        motions, frequencies, fed = named.motions[0], named.inertial[0], 0.0
        growth = motions.values.real
        for name, amount in self.coupling.items():  # power that it feeds to each
            orbits: dict[int, np.ndarray] = {}
            for m, U in self._model.seen(name, self.speed).items():
                for n, X in zip(motions.orders.tolist(), motions.vectors, strict=True):
                    orbits[m + n] = orbits.get(m + n, 0.0) + U[:2] @ X
            for n, (a, b) in orbits.items():
                turns = motions.values.imag + n * self.speed
                fed = fed - amount * turns * (a.conj() * b).imag
        lateral = (named.diameters[0] == 1) & np.isfinite(motions.values)
        if not np.any(lateral):
            raise ValueError(f"target: has no lateral mode at {self.speed:g} rad/s")
        resonant = damping_of(growth, frequencies)[0] < _RESONANT
        swings = lateral & resonant & (frequencies > _STILL * self.speed)
        forward = lateral & (fed > max(_FED * fed[lateral].max(), 0.0))
        return Modes(named, growth + 1j * frequencies, lateral, swings, forward)

    def first_forward(self) -> tuple[np.ndarray, float | None]:
        """Return the first forward mode at :data:`MULTIPLES`, and where it becomes unstable.

        Growth and frequency as one complex number each, NaN where they are not known; None for a
        mode that is stable at all of them.
        """
        limit, start, grows = self._onset()
        if limit is not None and limit <= MULTIPLES[-1]:
            return self._course(start, grows), limit
        modes = self.at(start)
        found = modes.swings & modes.forward & (modes.named.codes[0] == FORWARD)
        if grows is not None:
            found[grows] = True
        if np.any(found):
            return self._course(start, modes.lowest(found)), None
        alone = self.at(0.0)
        for chosen in (alone.forward & alone.swings, alone.swings):
            if np.any(chosen):
                return self._course(0.0, alone.lowest(chosen)), None
        chosen = alone.forward if np.any(alone.forward) else alone.lateral
        return self._course(0.0, int(np.argmax(np.where(chosen, alone.places.real, -np.inf)))), None

    def _onset(self) -> tuple[float | None, float, int | None]:
        """Return from which multiple on a mode is unstable, and the lowest one that is.

        The mode is known at the second multiple, at the limit or little above it.
        """
        self.solve([0.0, _LITTLE, *MULTIPLES[1:]])
        for low, high in pairwise((0.0, _LITTLE, *MULTIPLES[1:], *_BEYOND)):
            modes = self.at(high)
            if not np.any(modes.unstable):
                continue
            if self._margin(low) < -_ROUNDING * self.speed:
                limit = float(brentq(self._margin, low, high))
                modes = self.at(limit)
                near = modes.swings & (np.abs(modes.places.real) <= _NEUTRAL * modes.places.imag)
                found = (near & modes.forward, near, modes.grows == np.max(modes.grows))
                return limit, limit, modes.lowest(next(each for each in found if np.any(each)))
            fed = modes.unstable & modes.forward
            mode = modes.lowest(fed if np.any(fed) else modes.unstable)
            return low if low > _LITTLE else 0.0, high, mode
        return None, MULTIPLES[-1], None

    def _margin(self, multiple: float) -> float:
        """Return the growth of the forward mode that grows most [1/s]."""
        return max(float(np.max(self.at(multiple).grows)), -self.speed)

    def _course(self, start: float, mode: int) -> np.ndarray:
        """Return growth and frequency at :data:`MULTIPLES` of a mode that is known at one."""
        found, points = {}, np.array([0.0, _LITTLE, *MULTIPLES[1:], *_BEYOND])
        for part in (points[points < start][::-1], MULTIPLES[start <= MULTIPLES]):
            last, now = start, mode
            for point in part:
                halves = 0 if (last, point) == (_LITTLE, 0.0) else _HALVES
                later = self._followed(now, last, point, halves)
                found[point] = self.at(point).places[later]
                if np.isfinite(found[point]):
                    last, now = point, later
        return np.array([found[point] for point in MULTIPLES])

    def _followed(self, mode: int, start: float, end: float, halves: int) -> int:
        """Return which of the modes at the end of a step continues one at its start.

        The step is taken in halves where another mode is near at its end.
        """
        first, last, M = self.at(start), self.at(end), self._model.mass_matrix
        later = int(matched(first.named, last.named, M)[0][0, mode])
        shapes = (each.named.motions.main for each in (first, last))
        gone = np.abs(last.places - first.places[mode])
        near = np.abs(last.places - last.places[later])
        opposite = {FORWARD: BACKWARD, BACKWARD: FORWARD}.get(int(first.named.codes[0, mode]))
        rivals = last.lateral & (last.named.codes[0] != opposite)
        rivals &= likenesses(*shapes, M)[0, mode] > _UNLIKE
        is_one, others = bool(rivals[later]), rivals.copy()
        others[later] = False
        is_one = is_one and _APART * gone[later] <= np.min(near[others], initial=np.inf)
        if is_one or np.isnan(gone[later]):
            return later
        if not halves:  # two modes that join: the lower one where they part alike
            joins = rivals[later] and gone[later] <= _JOINED * np.abs(first.places[mode])
            return last.lowest(rivals & (gone <= _TIE * gone[later])) if joins else later
        middle = float(np.sqrt(start * end)) or 0.5 * (start + end)
        return self._followed(
            self._followed(mode, start, middle, halves - 1), middle, end, halves - 1
        )
