"""The first forward mode of a rotor under an applied cross-coupling, followed from none of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.bearings.given import Given
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.modal.whirl import Content, Named, damping_of
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import motions_over
from exudyn_rotor.linear.solve.motions import Motions
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

ROUNDING = 1e-9  # of log decrements: a mode with its node at the cross-coupling is not changed
_STILL = 1e-3  # of the speed: a frequency below is that of a motion that does not whirl
_RESONANT = np.sqrt(0.5)  # damping ratio above which a mode has no resonance
# of the anticipated cross-coupling: the first that feeds a mode tells which ones; motions in
# planes, as in unequal bearings, gain by its square, or not before their frequencies meet
_FEEDING = (1e-3, 0.1, 1.0, 3.0, 10.0)
_ALIKE = 0.6  # likeness of two shapes below which a step is taken in halves
_HALVES = 6


@dataclass(frozen=True, eq=False)
class Coupled:
    """The rotor on its supports, under multiples of the anticipated cross-coupling.

    Attributes
    ----------
    target : ReducedRotor
    speed : float
        [rad/s]
    amounts : dict of str to float
        Anticipated cross-coupling at interfaces [N/m].
    supports : tuple of Support or bearings
    stiffening : str
    """

    target: ReducedRotor
    speed: float
    amounts: dict[str, float]
    supports: tuple[Given, ...]
    stiffening: str

    @cached_property
    def _content(self) -> Content:
        return Content.of(self._model(0.0))

    def _model(self, multiple: float) -> LinearModel:
        coupled = [
            Support(name, [[0.0, multiple * q], [-multiple * q, 0.0]])
            for name, q in self.amounts.items()
        ]
        supports = (*self.supports, *coupled)
        return linear_model(self.target, supports=supports, stiffening=self.stiffening)

    def modes(self, multiple: float) -> Modes:
        """Return all modes under a multiple of the anticipated cross-coupling."""
        motions = motions_over(self._model(multiple), [self.speed], held=True)
        return Modes(multiple, self._content.named(motions).rows(0))

    def first_forward(self) -> tuple[tuple[Modes, int], tuple[Modes, int]]:
        """Return the first forward mode without cross-coupling, and as it is first fed by it.

        That is the lowest lateral mode that the cross-coupling makes less stable, for its work on
        an orbit has the sign of the orbit's sense: in bearings that differ in their two directions
        modes move in planes, and have no sense until enough of it joins them. A mode that is damped
        so much that it has no resonance is passed over; where all are, it is the least damped one.
        Where none is fed, as by a cross-coupling at the nodes of all, it is the lowest one.

        Raises
        ------
        ValueError
            Where no mode is lateral.
        """
        start = self.modes(0.0)
        growth, found, fed = start.growth, {}, start
        for multiple in _FEEDING:
            fed = self.modes(multiple)
            # from the fed modes back: of two planes that join, both are like each of these
            for mode in np.flatnonzero(fed.lateral & np.isfinite(fed.growth)):
                i, _ = fed.continued(mode, start)
                least = ROUNDING * max(start.named.inertial[i], abs(growth[i]))
                if start.lateral[i] and fed.growth[mode] - growth[i] > least:
                    found[i] = mode
            if found:
                break
        else:
            fed, found = start, {i: i for i in np.flatnonzero(start.lateral)}
        if not found:
            raise ValueError(f"target: has no lateral mode at {self.speed:g} rad/s")
        swings = start.named.inertial > _STILL * self.speed
        resonant = [i for i in found if start.ratios[i] < _RESONANT and swings[i]]
        first = min(resonant, key=lambda i: start.named.inertial[i], default=None)
        if first is None:
            first = max(found, key=lambda i: growth[i])
        return (start, first), (fed, found[first])

    def over(self, multiples: np.ndarray) -> list[tuple[Modes, int]]:
        """Return the modes under ascending multiples, from zero, and which is the first forward."""
        first, fed = self.first_forward()
        found = {0.0: first}
        below = [m for m in multiples[1:] if m < fed[0].multiple]
        for part in (below[::-1], multiples[len(below) + 1 :]):
            last = fed
            for multiple in part:
                found[multiple] = last = self.followed(*last, multiple)
        return [found[multiple] for multiple in multiples]

    def followed(self, start: Modes, mode: int, multiple: float) -> tuple[Modes, int]:
        """Return the modes under another multiple, and which of them continues a mode.

        In steps that are small enough for the shape to change little.
        """
        for _ in range(_HALVES):
            step = multiple - start.multiple
            for _ in range(_HALVES):
                found = self.modes(start.multiple + step)
                which, likeness = start.continued(mode, found)
                if likeness >= _ALIKE:
                    break
                step *= 0.5
            start, mode = found, which
            if start.multiple == multiple:
                return start, mode
        found = self.modes(multiple)
        return found, start.continued(mode, found)[0]


@dataclass(frozen=True, eq=False)
class Modes:
    """Modes under one multiple of the anticipated cross-coupling."""

    multiple: float
    named: Named

    @property
    def growth(self) -> np.ndarray:
        """Growth [1/s]."""
        return self.named.motions.values.real

    @property
    def decrements(self) -> np.ndarray:
        """Logarithmic decrements; infinite where a mode decays or grows without oscillating."""
        found = damping_of(self.growth, self.named.inertial)[1]
        return np.where(np.isnan(found), np.copysign(np.inf, -self.growth), found)

    @property
    def ratios(self) -> np.ndarray:
        """Damping ratios."""
        return damping_of(self.growth, self.named.inertial)[0]

    @property
    def lateral(self) -> np.ndarray:
        """Whether modes have one nodal diameter."""
        return self.named.diameters == 1

    def continued(self, mode: int, found: Modes) -> tuple[int, float]:
        """Return which of other modes continues one of these, and the likeness of their shapes.

        By shape and eigenvalue, as several modes may have one eigenvalue, or nearly one shape.
        """
        likeness = _likeness(self.named.motions, mode, found.named.motions)
        before, after = self.named.motions.values[mode], found.named.motions.values
        sizes = np.maximum(np.maximum(np.abs(before), np.abs(after)), np.finfo(float).tiny)
        best = int(np.nanargmin(1.0 - likeness + np.abs(after - before) / sizes))
        return best, float(likeness[best])


def _likeness(motions: Motions, mode: int, found: Motions) -> np.ndarray:
    """Return ``|xᴴy|²`` of one of some motions and all others, over the harmonics of both."""
    known = dict(zip(found.orders.tolist(), found.vectors, strict=True))
    products = [
        x[:, mode].conj() @ known[order]
        for order, x in zip(motions.orders.tolist(), motions.vectors, strict=True)
        if order in known
    ]
    return np.abs(np.sum(products, axis=0)) ** 2
