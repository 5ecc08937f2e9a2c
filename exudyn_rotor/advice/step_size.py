"""Which step size a scene requires: how much the response changes by what a step does to it.

Generalised alpha replaces the rate s of a motion ``exp(st)`` by ``ŝ = s(1 − κ(sh)² + δ(sh)³)``,
κ = 0.0844 and δ = 7.3e-5, which damps. The response with ŝ in place of s is that of the simulation.
The rates are those of the coordinates that are integrated: a motion that is slow in space is fast
in a rotor frame, and ``κ(sh)²`` of its fast rate is a large share of its slow one. A frame that
carries the translations avoids that.

Free motions have ŝ in place of their exponents, too. Where a forward and a backward whirl nearly
meet, that changes the distance of their frequencies, on which their growth depends, by the shares
of bearings and of damping that turns with the rotor in them: a step that is right for the response
may show a stable rotor grow. The step keeps the change of each growth below half of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.mode_choice import GROWTH, ends, exponents, largest_share
from exudyn_rotor.advice.request import PERIOD_ERROR, Request
from exudyn_rotor.theory.rotating_axes import axial_skew

_TRIAL = 1e-2  # ωh of the trial step at the end of the band; the error grows with its square
_UNMOVED = 1e-9  # share of the largest response
_DAMPING = 7.3e-5  # δ of generalised alpha with Exudyn's spectral radius 0.9
_LIGHT, _UNDAMPED = 0.05, 1e-9  # growth per radian of motions whose growth is looked at
_NEAR = 0.1  # relative distance of exponents that a step may mix
_GROWTH_CHANGE = 0.5  # share of a growth by which a step may change it
_HALVINGS, _DEFECTIVE = 8, 1e10
_STEADY = 1e-3  # growth per radian at one speed, where motion is steady: undamped resonances


@dataclass(frozen=True)
class Step:
    """A step size and where it comes from.

    Attributes
    ----------
    size : float
        [s]
    speed, frequency : float
        Spin speed, and frequency in the rotor frame, that ask for the smallest step [rad/s]; NaN
        where the end of the band does.
    """

    size: float
    speed: float = np.nan
    frequency: float = np.nan


def choose_step(given: Candidate, request: Request, follows: bool) -> Step:
    """Return the step with half the accuracy, for the response and for periods in the band.

    Parameters
    ----------
    given : Candidate
    request : Request
    follows : bool
        Whether the frame carries the translations across the axis.
    """
    chosen = Step(request.step)
    if not given.supported:
        return chosen
    trial = _TRIAL / request.highest
    # acceleration and unbalance stand behind loads at interfaces
    first = 0 if request.banded else len(given.motion())
    steady = _STEADY if request.low == request.high else GROWTH
    for speed, s in exponents(given, request, None if request.banded else steady):
        change = _change(given, speed, s, trial, follows, first)
        size = trial * np.sqrt(request.allowed / max(change, 1e-300))
        if size < chosen.size:
            chosen = Step(float(size), speed, float(s.imag))
    for speed in request.speeds:
        chosen = _with_right_growth(given, request, float(speed), follows, chosen)
    return chosen


def _with_right_growth(
    given: Candidate, request: Request, speed: float, follows: bool, chosen: Step
) -> Step:
    """Return a step, the same or a smaller one, by which growth changes by less than half."""
    values, shapes = given.motions(speed)
    n = len(values) // 2
    if np.linalg.cond(shapes) > _DEFECTIVE:
        return chosen
    left = np.linalg.inv(shapes)[:, n:] @ np.linalg.inv(given.hill(speed).M)
    light = np.abs(values.real) < _LIGHT * np.abs(values.imag)
    light &= (values.imag > 0.0) & (values.imag <= request.highest)
    light &= np.abs(values.real) > _UNDAMPED * np.abs(values.imag)
    step = chosen.size
    for _ in range(_HALVINGS):
        worst, frequency = 0.0, np.nan
        for own in values[light]:
            near = np.abs(values - own) < _NEAR * abs(own)
            dynamic = _of_step(given, speed, own, step, follows)
            found = np.linalg.eigvals(
                np.diag(values[near]) - left[near] @ dynamic @ shapes[:n, near]
            )
            share = abs((found[np.argmin(np.abs(found - own))] - own).real / own.real)
            if share > worst:
                worst, frequency = share, float(own.imag)
        if worst <= _GROWTH_CHANGE:
            break
        step *= max(np.sqrt(_GROWTH_CHANGE / worst), 0.5)
        chosen = Step(float(step), speed, frequency)
    return chosen


def _change(
    given: Candidate, speed: float, s: complex, step: float, follows: bool, first: int
) -> float:
    """Return the largest relative change of the response to any load from `first` by a step."""
    made = given.hill(speed)
    rows, loads = ends(given, made)
    exact = s**2 * made.M + s * made.D + made.K
    integrated = exact + _of_step(given, speed, s, step, follows)
    response = rows @ np.linalg.solve(exact, loads[:, first:])
    change = rows @ np.linalg.solve(integrated, loads[:, first:]) - response
    return largest_share(change, np.linalg.norm(response, axis=0), _UNMOVED)


def _of_step(given: Candidate, speed: float, s: complex, step: float, follows: bool) -> np.ndarray:
    """Return what a step adds to the dynamic stiffness, harmonic by harmonic."""
    made = given.hill(speed)
    damping = made.D - 2.0 * made.M * made.rates  # D of the equations, which harmonics have shifted
    first, second = _rates(s + made.rates, step)
    change = made.M * second + damping * first
    return change + _of_frame(given, speed, s, step) if follows else change


def _of_frame(given: Candidate, speed: float, s: complex, step: float) -> np.ndarray:
    """Return the difference where translations across the axis are integrated in space.

    Their forward part ``x + iy`` has the rate ``s + iΩ`` in space, the backward one ``s − iΩ``.
    """
    made, mass = given.hill(speed), given.invariants.mass
    moved = given.translations[:2] / mass  # of the centre of mass, (n1, n2)
    change = np.zeros(made.M.shape, dtype=complex)
    for index, order in enumerate(made.orders):
        rate = s + 1j * order * speed
        forward, backward = (_rates(rate + 1j * sign * speed, step)[1] for sign in (1, -1))
        mean, half = 0.5 * (forward + backward), 0.5j * (forward - backward)
        in_space = mass * np.array([[mean, half], [-half, mean]])
        first, second = _rates(rate, step)
        turning = 2.0 * speed * first * axial_skew(3)[:2, :2]
        in_rotor = mass * (second * np.eye(2) + turning)
        place = slice(index * made.count, (index + 1) * made.count)
        change[place, place] = moved.T @ (in_space - in_rotor) @ moved
    return change


def _rates(s: np.ndarray | complex, step: float):
    """Return ``ŝ − s`` and ``ŝ² − s²``."""
    integrated = s * (1.0 - PERIOD_ERROR * (s * step) ** 2 + _DAMPING * (s * step) ** 3)
    return integrated - s, integrated**2 - s**2
