"""Growth of the motions of a rotor at one speed, and what of it is rounding."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear import options
from exudyn_rotor.linear.modal.listing import ranks, signed_diameters
from exudyn_rotor.linear.modal.whirl import WhirlContent
from exudyn_rotor.linear.models.linear_model import (
    warn_of_left_out_stiffening,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.models.protocol import LinearModel, Space
from exudyn_rotor.linear.models.whole_space import WholeSpace
from exudyn_rotor.linear.periodic.exponents import METHODS
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.linear.periodic.inverse_iteration import moved, settled
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, fold
from exudyn_rotor.threads import in_turns, one_thread

_MODES = 10  # of a large SolidRotor
_DRIFT = 3.0  # times its estimate that a motion may drift by what the equations neglect
# secants: share of the range that is their first step, how many there are, and the relative step
# of λ after which inverse iteration ends
_FIRST, _SECANTS, _FOLLOWED = 0.02, 12, 1e-6
_FASTEST = 100.0  # revolutions' rate beyond which decay does not count for it


class Growth(NamedTuple):
    """Exponents at one speed, descending in their real parts.

    `bounds` (n,) are spurious real parts by rounding and truncation [1/s]; `names` are inertial
    frequencies [rad/s], whirl codes and nodal diameters, each (n,), or empty. `critical` is the
    least stable motion, None by Floquet's method; `motions` are all, where they are kept.
    """

    values: np.ndarray
    bounds: np.ndarray
    base: float
    names: tuple[np.ndarray, ...]
    critical: FloquetModes | None = None
    motions: FloquetModes | None = None

    @property
    def excess(self) -> float:
        """Largest real part above its bound.

        Neutral motions, which never exceed it, count only where there are no others: as the largest
        they would hide how stable the others are, and root finding would be slow.
        """
        real = self.values.real
        moving, excess = np.abs(real) > self.bounds, real - self.bounds
        return float(np.max(excess[moving] if np.any(moving) else excess))

    @property
    def least_stable(self) -> int:
        """Which motion that is not neutral is the least stable."""
        moving = np.abs(self.values.real) > self.bounds
        return int(np.argmax(moving)) if np.any(moving) else 0


@dataclass(frozen=True, eq=False)
class GrowthAt:
    """Growth at a speed; picklable where the space is. Without `content` it has no names.

    Periodic motions are kept if `keeps`, for :meth:`rates`.
    """

    space: Space
    method: str
    tolerance: float
    content: WhirlContent | None = None
    keeps: bool = False

    @one_thread()
    def __call__(self, speed: float) -> Growth:
        shapes = self.content is not None
        modes, system = self.space.motions(speed, self.method, self.tolerance, shapes)
        names = () if self.content is None else self.content.named(modes, speed)[1:]
        return _growth(modes, system, names, self.keeps and len(modes.orders) > 1)

    def system(self, speed: float) -> PeriodicSystem | None:
        """Return the equations; None of a large rotor."""
        return self.space.at(speed) if isinstance(self.space, WholeSpace) else None

    def at_all(self, speeds: Sequence[float]) -> list[Growth]:
        """Return the growth at speeds; eigenproblems in threads where any may make equations."""
        if isinstance(self.space, WholeSpace) and self.space.can_be_sent:
            return in_turns(self, speeds)
        return [self(speed) for speed in speeds]

    @one_thread()
    def rates(self, growth: Growth, speed: float, step: float) -> np.ndarray | None:
        """Return the change of periodic exponents per unit of the speed; None where not known.

        By inverse iterations at the speed and a step beside it, which cost less than the exponents.
        """
        modes = growth.motions
        if modes is None or not isinstance(self.space, WholeSpace):
            return None
        others, shapes = self.space.others, modes.vectors
        shapes = shapes if others is None else others.T @ shapes
        systems = (self.space.at(value) for value in (speed, speed + step))
        with np.errstate(divide="ignore", invalid="ignore"):
            here, beside = (moved(each, modes.orders, modes.values, shapes)[0] for each in systems)
        rates = np.where(modes.values == 0.0, 0.0, (beside - here) / step)
        # folded ones are other copies, which are off by a multiple of the speed
        rates = rates - 1j * (modes.values - growth.values).imag / speed
        return rates if np.all(np.isfinite(rates)) else None

    @one_thread()
    def limit(self, growth: Growth, ends: tuple[float, float], accuracy: float) -> float | None:
        """Return where a motion that grows at the second of two speeds no longer does.

        NaN where that is not found, None where it cannot be, as of constant equations. By secants,
        and inverse iterations of that motion alone: others may still grow there.
        """
        if growth.motions is None or not isinstance(self.space, WholeSpace):
            return None
        which = int(np.argmax(growth.values.real - growth.bounds))
        one, others = growth.motions.columns(np.array([which])), self.space.others
        value, shape = one.values, one.vectors if others is None else others.T @ one.vectors
        here, change = ends[1], np.zeros(1)
        speed = here + _FIRST * (ends[0] - here)
        for _ in range(_SECANTS):
            system, guess = self.space.at(speed), value + change * (speed - here)
            least = _FOLLOWED * np.maximum(np.abs(guess), abs(system.base))
            found = settled(system, one.orders, guess, shape, least)
            if found is None:  # too far
                speed = 0.5 * (here + speed)
                continue
            change, here, shape = (found[0] - value) / (speed - here), speed, found[1]
            value = found[0]
            rise, excess = change[0].real, value[0].real - growth.bounds[which]
            speed = here - excess / rise if rise else np.nan
            if not min(ends) < speed < max(ends):
                speed = 0.5 * (here + ends[0])
            if abs(speed - here) <= accuracy:
                return speed
        return np.nan


def growth_of(
    modes: FloquetModes,
    system: PeriodicSystem,
    content: WhirlContent | None = None,
) -> Growth:
    """Return the growth of all motions of a system, in order."""
    names = () if content is None else content.named(modes, system.speed)[1:]
    return _growth(modes, system, names)


@one_thread()
def constant_growths(
    space: Space, speeds: Sequence[float], content: Callable[[], WhirlContent]
) -> list[Growth] | None:
    """Return the growth at all speeds at once; None where that cannot be, or is not faster."""
    try:
        found = space.constant_motions(speeds)
    except ValueError:  # solved one by one, the error names its speed
        return None
    if found is None:
        return None
    modes, systems = zip(*found, strict=True)
    named = content().named_at(modes, speeds)
    return [
        _growth(entry, system, names)
        for entry, system, (_, *names) in zip(modes, systems, named, strict=True)
    ]


def _growth(
    modes: FloquetModes, system: PeriodicSystem, names: Sequence[np.ndarray], keeps: bool = False
) -> Growth:
    """Return the growth of all motions, whose names are given in their order."""
    bounds = np.maximum(modes.bounds, _drifts(modes.values, system))
    folded = fold(modes.values, abs(system.base))
    order = _order(folded, bounds, names)
    names = tuple(name[order] for name in names)
    growth = Growth(folded[order], bounds[order], abs(system.base), names)
    if keeps:
        growth = growth._replace(motions=modes.columns(order))
    if not (system.stands_still or len(modes.orders) > 1):
        return growth
    return growth._replace(critical=modes.columns(order[[growth.least_stable]]))


def _order(values: np.ndarray, bounds: np.ndarray, names: Sequence[np.ndarray]) -> np.ndarray:
    """Return the order of descending real parts.

    Where they are one but for their bounds, by frequency and from backward to forward waves.
    """
    keys = [-values.imag]
    if names:
        inertial, codes, diameters = names
        keys += [signed_diameters(codes, diameters), ranks(inertial, bounds)]
    return np.lexsort([*keys, ranks(-values.real, bounds)])


def _drifts(values: np.ndarray, system: PeriodicSystem) -> np.ndarray:
    """Return the drift of motions that stand still in space by what the equations neglect [1/s]."""
    speed = abs(system.speed)
    decay = min(np.abs(values.real).max(initial=0.0), _FASTEST * speed)
    drift = _DRIFT * system.drift * (speed + decay)
    turning = [fold(values - 1j * sense * speed, abs(system.base)) for sense in (1, -1)]
    return np.where(np.min(np.abs(turning), axis=0) <= drift, drift, 0.0)


def held_space(model: LinearModel, fastest: float, modes: int | None, residual: float) -> Space:
    """Return where exponents are found: a spin that nothing holds follows θ = Ωt.

    It is neutral, and would be unstable by round-off.

    Raises
    ------
    ValueError
        For a number of modes where all are found, or of more than a quarter of the coordinates.
    """
    warn_of_structural_damping(model, "stability finds exponents")
    warn_of_left_out_stiffening(model, fastest)
    if model.gives_all and modes is not None:
        raise ValueError("modes: is only for a large SolidRotor; this target gives all exponents")
    count = _MODES if modes is None else modes
    if not model.gives_all and count > model.size // 4:
        raise ValueError(
            f"modes: {count} is not between 1 and {model.size // 4}, a quarter of the coordinates"
        )
    return model.space(count, fastest, held=True, residual=residual)


def check_method(method: str, tolerance: float) -> None:
    """Refuse an unknown method and an impossible tolerance."""
    checks.choice(method, "method", METHODS)
    options.accuracy(tolerance, "tolerance")


def check_options(method: str, tolerance: float, modes: int | None, residual: float) -> None:
    """Refuse impossible options of :func:`exudyn_rotor.stability`."""
    check_method(method, tolerance)
    options.accuracy(residual, "residual")
    if modes is not None:
        checks.count(modes, "modes", least=1)
