"""Motions of periodic equations by Floquet's method: the monodromy matrix of one period.

The second way beside Hill's method, with nothing in common but the equations. The state is followed
over a period by exponentials of a Magnus series of fourth order; the multipliers μ = exp(λT) are
the eigenvalues of the result, and the motion over the period tells which of the frequencies
``Im λ + n·2π/T`` is the one whose harmonics lie around zero. Steps are halved until slow motions
stand still; motions that do not, as those that are over within a period, are NaN. Source of the
series: Blanes, Casas, Oteo, Ros, Phys. Rep. 470 (2009), Sect. 5.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.equations import PeriodicSystem, States
from exudyn_rotor.linear.solve.harmonics import shares
from exudyn_rotor.linear.solve.hill import SLOW, Exponents, lost_of, one_of_each_family

_GAUSS_POINTS = 0.5 + np.array([-1.0, 1.0]) * np.sqrt(3.0) / 6.0
_STEPS = (64, 128, 256, 512, 1024)  # of a period
_STILL = 1e-6  # relative change of an exponent by twice the steps
_LEAST = 1e-10  # of the largest multiplier: one below is rounding


def _followed(system: PeriodicSystem, made: States, steps: int) -> list[np.ndarray]:
    """Return the matrices that take the state to the ends of so many steps of a period."""
    period = 2.0 * np.pi / (system.step * abs(system.speed))
    angles = period * system.speed * (np.arange(steps)[:, None] + _GAUSS_POINTS) / steps
    first, second = (
        period / steps
        * sum(
            np.real(np.multiply.outer(np.exp(1j * n * at), A)) if n else A
            for n, A in made.A.items()
        )
        for at in angles.T
    )  # fmt: skip
    followed = [np.eye(len(made.A[0]))]
    with np.errstate(over="ignore", invalid="ignore"):
        commutator = second @ first - first @ second
        exponents = 0.5 * (first + second) + np.sqrt(3.0) / 12.0 * commutator
        for step in la.expm(exponents) if np.all(np.isfinite(exponents)) else np.nan * exponents:
            followed.append(step @ followed[-1])
    return followed


def floquet_motions(system: PeriodicSystem, made: States) -> Exponents:
    """Return the motions of a system."""
    before, still = np.zeros(0, dtype=complex), None
    for steps in _STEPS:
        try:
            values, states, orders, upper = _with_steps(system, made, steps)
        except np.linalg.LinAlgError:  # steps that are too long for stiff supports overflow
            continue
        # a negative multiplier has ± Im λ alike, and rounding chooses
        away = np.abs(values[:, None] - np.r_[before, before.conj()])
        least = np.maximum(np.abs(values), abs(system.speed))
        still = np.fmin.reduce(away, axis=1, initial=np.inf) <= _STILL * least
        still[upper + 1] = still[upper]
        fast = np.isnan(values) | (np.abs(values) > SLOW * abs(system.speed))
        if before.size and np.all(still | fast):
            break
        before = values
    if still is None:
        k = system.size
        none = np.full(k, np.nan + 0j), np.full((1, 2 * k, k), np.nan + 0j)
        return Exponents(*none, np.array([0]), np.zeros(1, dtype=complex))
    found, lost = np.flatnonzero(still), np.flatnonzero(~still)
    given = values[found], states[:, :, found], orders, system, made
    chosen = np.r_[found[one_of_each_family(*given)[0]], lost][: system.size]
    lost = lost_of(values[lost[~np.isnan(values[lost])]], system)
    values = np.where(still, values, np.nan)
    return Exponents(values[chosen], states[:, :, chosen], orders, lost)


def _with_steps(
    system: PeriodicSystem, made: States, steps: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return exponents, states and harmonics with so many steps of a period.

    And which multipliers are the upper ones of conjugate pairs, whose lower ones follow them.
    """
    period = 2.0 * np.pi / (system.step * abs(system.speed))
    h, followed = period / steps, _followed(system, made, steps)
    multipliers, vectors = np.linalg.eig(followed[-1])
    size = np.abs(multipliers)
    upper = np.flatnonzero(multipliers.imag > 0.0)
    with np.errstate(divide="ignore"):
        values = np.log(multipliers.astype(complex)) / period
    values = np.where(size > _LEAST * size.max(), values, np.nan)
    times = h * np.arange(steps)
    courses = np.array(followed[:-1]) @ vectors  # (steps, 2k, 2k)
    periodic = courses * np.exp(-np.outer(times, np.nan_to_num(values)))[:, None, :]
    top = steps // 4
    spectrum = np.fft.fft(periodic, axis=0) / steps
    spectrum = np.concatenate([spectrum[-top:], spectrum[: top + 1]])
    numbers = np.arange(-top, top + 1)
    shift = np.round(numbers @ shares(spectrum)).astype(int)
    shift[upper + 1] = -shift[upper]
    states = np.zeros_like(spectrum)
    for column, by in enumerate(shift):
        states[:, :, column] = np.roll(spectrum[:, :, column], -by, axis=0)
    sense = int(np.sign(system.speed))
    values = values + 1j * shift * 2.0 * np.pi / period
    return values, states[::sense], system.step * numbers, upper
