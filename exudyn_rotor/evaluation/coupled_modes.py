"""The first forward mode of a rotor under an applied cross-coupling, followed from none of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_rotor.bearings.given import Given
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.modal.whirl import FORWARD, Content, Named, damping_of
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import motions_over
from exudyn_rotor.linear.solve.motions import Motions
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

ROUNDING = 1e-9  # of log decrements: a mode with its node at the cross-coupling is not changed
_STILL = 1e-3  # of the speed: a frequency below is that of a motion that does not whirl
_RESONANT = np.sqrt(0.5)  # damping ratio above which a mode has no resonance
# of the anticipated cross-coupling: the first that feeds a mode tells which ones; motions in
# planes, as in unequal bearings, gain by its square
_LITTLE = (1e-3, 0.1, 1.0)
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
        """Return the modes without and with little cross-coupling, and the first forward one.

        That is the lowest lateral mode that the cross-coupling makes less stable, for its work on
        an orbit has the sign of the orbit's sense: in bearings that differ in their two directions
        modes may have no sense until it is applied. A mode that is damped so much that it has no
        resonance is passed over; where all are, it is the least damped one.

        Raises
        ------
        ValueError
            Where it feeds no lateral mode.
        """
        start = self.modes(0.0)
        named, growth = start.named, start.named.motions.values.real
        for multiple in _LITTLE:
            little, found = self.modes(multiple), {}
            for i in np.flatnonzero(start.lateral & np.isfinite(growth)):
                mode, _ = start.continued(i, little)
                gained = little.named.motions.values.real[mode] - growth[i]
                if gained > ROUNDING * max(named.inertial[i], abs(growth[i])):
                    found[i] = mode
            if found:
                break
        else:
            return self._forward_of_overdamped(start, little)
        resonant = [
            i
            for i in found
            if start.ratios[i] < _RESONANT and named.inertial[i] > _STILL * self.speed
        ]
        first = min(resonant, key=lambda i: named.inertial[i], default=None)
        if first is None:
            first = max(found, key=lambda i: growth[i])
        return (start, first), (little, found[first])

    def _forward_of_overdamped(
        self, start: Modes, coupled: Modes
    ) -> tuple[tuple[Modes, int], tuple[Modes, int]]:
        """Return the motion that begins to whirl forward under cross-coupling, and what it was.

        Overdamped motions of both directions are one λ, whose shapes are arbitrary.
        """
        growth = coupled.named.motions.values.real
        forward = np.flatnonzero(coupled.lateral & (coupled.named.codes == FORWARD))
        before = np.flatnonzero(start.lateral & ~np.isfinite(start.decrements))
        if not forward.size or not before.size:
            raise ValueError(
                f"supports: no mode at {self.speed:g} rad/s is fed by the cross-coupling"
            )
        mode = max(forward, key=lambda i: growth[i])
        away = np.abs(start.named.motions.values.real[before] - growth[mode])
        return (start, before[np.argmin(away)]), (coupled, mode)

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
    def decrements(self) -> np.ndarray:
        """Logarithmic decrements; infinite where a mode decays or grows without oscillating."""
        growth = self.named.motions.values.real
        found = damping_of(growth, self.named.inertial)[1]
        return np.where(np.isnan(found), np.copysign(np.inf, -growth), found)

    @property
    def ratios(self) -> np.ndarray:
        """Damping ratios."""
        return damping_of(self.named.motions.values.real, self.named.inertial)[0]

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
