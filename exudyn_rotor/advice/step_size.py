"""Which step size a scene requires: how much the response changes by what a step does to it.

Generalised alpha replaces the rate s of a motion ``exp(st)`` by ``ŝ = s(1 − κ(sh)² + δ(sh)³)``,
κ = 0.0844 and δ = 7.3e-5, which damps: the response with ŝ in place of s is that of the simulation.
The rates are those of the rotor frame, where a motion that is slow in space is fast.

Free motions have ŝ in place of their exponents, too. Where a forward and a backward whirl nearly
meet, their growth depends on the distance of their frequencies, by the shares of bearings and of
damping that turns with the rotor in them, and a step that is right for the response may show a
stable rotor grow. The step keeps the change of each growth below half of it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_rotor.advice.candidate import Candidate, Hill
from exudyn_rotor.advice.mode_choice import GROWTH, exponents, largest_share
from exudyn_rotor.advice.request import PERIOD_ERROR, Request

_TRIAL = 1e-2  # ωh of the trial step at the end of the band; the error grows with its square
_UNMOVED = 1e-9  # share of the largest response
_DAMPING = 7.3e-5  # δ of generalised alpha with Exudyn's spectral radius 0.9
_LIGHT, _UNDAMPED = 0.05, 1e-9  # growth per radian of motions whose growth is looked at
_NEAR = 0.1  # relative distance of exponents that a step may mix
GROWTH_CHANGE = 0.5  # share of a growth by which a step may change it
_HALVINGS, _DEFECTIVE = 8, 1e10
_STEADY = 1e-3  # growth per radian at one speed, where motion is steady: undamped resonances


class Step(NamedTuple):
    """A step size, and spin speed and frequency in the rotor frame that ask for it.

    Those are NaN where the end of the band does.
    """

    size: float  # s
    speed: float = np.nan  # rad/s
    frequency: float = np.nan


def choose_step(given: Candidate, request: Request) -> Step:
    """Return the step with half the accuracy, for the response and for periods in the band.

    The same or a smaller one, by which growth changes by less than half.
    """
    chosen, trial = Step(request.step), _TRIAL / request.highest
    # acceleration and unbalance stand behind loads at interfaces
    first = 0 if request.banded else len(given.ends[0])
    steady = _STEADY if request.low == request.high else GROWTH
    for speed, s in exponents(given, request, None if request.banded else steady):
        change = _change(given, speed, s, trial, first)
        size = trial * np.sqrt(request.allowed / max(change, 1e-300))
        chosen = min(chosen, Step(float(size), speed, float(s.imag)), key=lambda each: each.size)
    for speed in request.speeds.tolist():
        for _ in range(_HALVINGS):
            own, found = growth_by_step(given, speed, chosen.size, request.highest)
            shares = np.abs((found - own).real / own.real)
            if shares.max(initial=0.0) <= GROWTH_CHANGE:
                break
            worst = int(np.argmax(shares))
            size = chosen.size * max((GROWTH_CHANGE / shares[worst]) ** 0.5, 0.5)
            chosen = Step(size, speed, float(own[worst].imag))
    return chosen


def _change(given: Candidate, speed: float, s: complex, step: float, first: int) -> float:
    """Return the largest relative change of the response to any load from `first` by a step."""
    made = given.hill(speed)
    rows, loads = given.ends_of_harmonics(made.orders)
    loads, exact = loads[:, first:], made.stiffness(s)
    response = rows @ np.linalg.solve(exact, loads)
    change = rows @ np.linalg.solve(exact + _of_step(made, s, step), loads) - response
    return largest_share(change, np.linalg.norm(response, axis=0), _UNMOVED)


def _of_step(made: Hill, s: complex, step: float) -> np.ndarray:
    """Return what a step adds to the dynamic stiffness, harmonic by harmonic."""
    rates = s + made.rates
    integrated = rates * (1.0 - PERIOD_ERROR * (rates * step) ** 2 + _DAMPING * (rates * step) ** 3)
    damping = made.D - 2.0 * made.M * made.rates  # D of the equations, which harmonics have shifted
    return made.M * (integrated**2 - rates**2) + damping * (integrated - rates)


def growth_by_step(
    given: Candidate, speed: float, step: float, highest: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return exponents (m,) of lightly damped motions up to a frequency, and as a step has them."""
    (values, shapes), made = given.motions(speed), given.hill(speed)
    n, growth, frequencies = len(values) // 2, np.abs(values.real), values.imag
    light = (growth < _LIGHT * np.abs(frequencies)) & (growth > _UNDAMPED * np.abs(frequencies))
    light &= (frequencies > 0.0) & (frequencies <= highest)
    light &= np.linalg.cond(shapes) < _DEFECTIVE
    left, found = np.linalg.inv(shapes)[:, n:] @ np.linalg.inv(made.M), []
    for own in values[light]:
        near = np.abs(values - own) < _NEAR * abs(own)
        change = left[near] @ _of_step(made, own, step) @ shapes[:n, near]
        moved = np.linalg.eigvals(np.diag(values[near]) - change)
        found.append(moved[np.argmin(np.abs(moved - own))])
    return values[light], np.array(found, dtype=complex)
