"""The first forward mode of a rotor over an applied cross-coupling, as one curve.

On supports that differ in two directions modes move in planes. Cross-coupling joins two planes to a
forward and a backward whirl, at Q = Δk/2 in a rotor of one mass. Below, the sense of whirl of
neither mode tells which one will grow. The first forward mode is chosen where it grows, therefore.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import accumulate

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor.linear.modal.whirl import FORWARD, Content, Named, damping_of, matched
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import motions_in, motions_over
from exudyn_rotor.linear.solve.motions import Motions, joined_motions

MULTIPLES = np.linspace(0.0, 10.0, 11)  # of the anticipated cross-coupling
# where modes are followed; beyond 10 they show which one grows at last
_STEPS = np.union1d(MULTIPLES, np.geomspace(1e-3, 1e3, 61).round(6))
_SPREAD = 0.2  # share of a frequency by which it may change in a step
_STILL = 1e-3  # of the speed: a frequency below is that of a motion that does not whirl
_RESONANT = np.sqrt(0.5)  # damping ratio above which a mode has no resonance


def first_forward(
    model_at: Callable[[float], LinearModel], speed: float
) -> tuple[np.ndarray, float | None]:
    """Return the first forward mode at :data:`MULTIPLES`, and where it becomes unstable.

    Growth and frequency as one complex number each, NaN where they are not known; None for a mode
    that is stable at all of them. `model_at` returns the model under a multiple; the speed is in
    rad/s.
    """
    model = model_at(1.0)
    content, motions_under = Content.of(model), _motions_under(model, model_at, speed)

    def margin(multiple: float) -> float:
        """Return the growth of the mode that grows most, beyond rounding [1/s]."""
        modes = content.named(motions_under([multiple]))
        growth = modes.motions.values.real - modes.motions.bounds[:, None]
        return float(np.max(growth[_swings(modes)], initial=-speed))

    modes = content.named(motions_under(_STEPS))
    modes = _followed(modes, model.mass_matrix)
    growth, swings = modes.motions.values.real, _swings(modes)
    unstable = swings & (growth > modes.motions.bounds[:, None])
    wanted = np.searchsorted(_STEPS, MULTIPLES)
    row = np.argmax(np.any(unstable, axis=1)) if np.any(unstable) else wanted[-1]
    limit, chosen = None, unstable[row]
    if row > wanted[-1] or not np.any(chosen):
        chosen = chosen | (swings[row] & (modes.codes[row] == FORWARD))
    else:
        limit = float(brentq(margin, _STEPS[row - 1], _STEPS[row])) if row else 0.0
    kinds = chosen, swings[row], modes.diameters[row] == 1
    chosen = next((kind for kind in kinds if np.any(kind)), None)
    if chosen is None:
        raise ValueError(f"target: has no lateral mode at {speed:g} rad/s")
    mode = np.argmin(np.where(chosen, modes.inertial[row], np.inf))
    return (growth + 1j * modes.inertial)[wanted, mode], limit


def _motions_under(
    model: LinearModel, model_at: Callable[[float], LinearModel], speed: float
) -> Callable[[Sequence[float]], Motions]:
    """Return the motions under multiples, in which the stiffness is linear, as a function.

    The `model` is that under the multiple one.
    """
    ends = model_at(0.0).coefficients(speed), model.coefficients(speed)

    def under(multiple: float) -> list[tuple[np.ndarray, np.ndarray]]:
        return [(K + multiple * (more - K), D) for (K, D), (more, _) in zip(*ends, strict=True)]

    def motions(multiples: Sequence[float]) -> Motions:
        speeds = np.full(len(multiples), speed)
        if model.over_frequency:
            found = [motions_over(model_at(each), [speed], held=True) for each in multiples]
            return joined_motions(speeds, [(np.array([i]), each) for i, each in enumerate(found)])
        stack = model.at_points(speeds, [under(each) for each in multiples])
        return motions_in(model, stack, "auto", 1e-6, held=True)

    return motions


def _followed(modes: Named, M: np.ndarray) -> Named:
    """Return the modes with columns that follow each one from row to row."""
    rows = np.arange(len(modes.codes))
    steps, _ = matched(modes.rows(rows[:-1]), modes.rows(rows[1:]), M, _SPREAD)
    first = np.arange(modes.codes.shape[1])
    return modes.columns(np.array([*accumulate(steps, lambda at, step: step[at], initial=first)]))


def _swings(modes: Named) -> np.ndarray:
    """Return which modes are lateral, whirl, and have a resonance."""
    ratio, _ = damping_of(modes.motions.values.real, modes.inertial)
    whirls = modes.inertial > _STILL * np.abs(modes.motions.speeds[:, None])
    return whirls & (modes.diameters == 1) & (ratio < _RESONANT)
