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

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.mode_choice import GROWTH, band, critical, ends, largest_share
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
    for speed, frequency, growth in _points(given, request):
        change = _change(given, speed, 1j * frequency + growth, trial, follows, first)
        size = trial * np.sqrt(request.allowed / max(change, 1e-300))
        if size < chosen.size:
            chosen = Step(float(size), float(speed), float(frequency))
    for speed in request.speeds:
        chosen = _with_right_growth(given, request, float(speed), follows, chosen)
    return chosen


def _with_right_growth(
    given: Candidate, request: Request, speed: float, follows: bool, chosen: Step
) -> Step:
    """Return a step, the same or a smaller one, by which growth changes by less than half."""
    M, D, K, _count = given.hill(speed)
    n, step = len(M), chosen.size
    zero, unit = np.zeros((n, n)), np.eye(n)
    A = np.block([[zero, unit], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
    exponents, shapes = np.linalg.eig(A)
    if np.linalg.cond(shapes) > _DEFECTIVE:
        return chosen
    left = np.linalg.inv(shapes)[:, n:] @ np.linalg.inv(M)
    light = np.abs(exponents.real) < _LIGHT * np.abs(exponents.imag)
    light &= (exponents.imag > 0.0) & (exponents.imag <= request.highest)
    light &= np.abs(exponents.real) > _UNDAMPED * np.abs(exponents.imag)
    for _ in range(_HALVINGS):
        worst, frequency = 0.0, np.nan
        for number in np.flatnonzero(light):
            own = exponents[number]
            near = np.abs(exponents - own) < _NEAR * abs(own)
            dynamic = _of_step(given, speed, own, step)
            if follows:
                dynamic = dynamic + _of_frame(given, speed, own, step)
            moved = np.diag(exponents[near]) - left[near] @ dynamic @ shapes[:n, near]
            found = np.linalg.eigvals(moved)
            change = found[np.argmin(np.abs(found - own))] - own
            share = abs(np.real(change) / own.real)
            if share > worst:
                worst, frequency = share, float(own.imag)
        if worst <= _GROWTH_CHANGE:
            break
        step *= max(np.sqrt(_GROWTH_CHANGE / worst), 0.5)
        chosen = Step(float(step), speed, frequency)
    return chosen


def _points(given: Candidate, request: Request) -> Iterator[tuple[float, float, float]]:
    """Yield speeds, frequencies in the rotor frame, and growth rates [rad/s] to look at."""
    one_speed = request.low == request.high
    for speed in request.speeds:
        steady = [0.0, speed] if speed else []  # unbalance, and weight
        for nu in band(given, request, speed) if request.banded else steady:
            damped = GROWTH if request.banded or not one_speed else _STEADY
            yield speed, nu, damped * max(nu, speed, 0.1 * request.highest)
    for speed in critical(given, request):
        yield speed, 0.0, GROWTH * speed


def _change(
    given: Candidate, speed: float, s: complex, step: float, follows: bool, first: int
) -> float:
    """Return the largest relative change of the response to any load from `first` by a step."""
    M, D, K, count = given.hill(speed)
    size = len(M) // count
    rows, loads = ends(given, size, count)
    loads = loads[:, first:]
    exact = s**2 * M + s * D + K
    integrated = exact + _of_step(given, speed, s, step)
    if follows:
        integrated = integrated + _of_frame(given, speed, s, step)
    response = rows @ np.linalg.solve(exact, loads)
    change = rows @ np.linalg.solve(integrated, loads) - response
    return largest_share(change, np.linalg.norm(response, axis=0), _UNMOVED)


def _of_step(given: Candidate, speed: float, s: complex, step: float) -> np.ndarray:
    """Return what a step adds to the dynamic stiffness, harmonic by harmonic."""
    M, D, _, count = given.hill(speed)
    size = len(M) // count
    rate = np.repeat(1j * speed * given.orders(speed), size)
    damping = D - 2.0 * M * rate  # D of the equations, which Hill's method has shifted
    first, second = _rates(s + rate, step)
    return M * second + damping * first


def _of_frame(given: Candidate, speed: float, s: complex, step: float) -> np.ndarray:
    """Return the difference where translations across the axis are integrated in space.

    Their forward part ``x + iy`` has the rate ``s + iΩ`` in space, the backward one ``s − iΩ``.
    """
    M, _, _, count = given.hill(speed)
    size = len(M) // count
    orders = given.orders(speed)
    moved = given.translations[:2] / given.invariants.mass  # of the centre of mass, (n1, n2)
    change = np.zeros_like(M)
    for index, order in enumerate(orders):
        rate = s + 1j * order * speed
        forward, backward = (_rates(rate + 1j * sign * speed, step)[1] for sign in (1, -1))
        mean, half = 0.5 * (forward + backward), 0.5j * (forward - backward)
        in_space = given.invariants.mass * np.array([[mean, half], [-half, mean]])
        first, second = _rates(rate, step)
        turning = 2.0 * speed * first * axial_skew(3)[:2, :2]
        in_rotor = given.invariants.mass * (second * np.eye(2) + turning)
        place = slice(index * size, (index + 1) * size)
        change[place, place] = moved.T @ (in_space - in_rotor) @ moved
    return change


def _rates(s: np.ndarray | complex, step: float):
    """Return ``ŝ − s`` and ``ŝ² − s²``."""
    integrated = s * (1.0 - PERIOD_ERROR * (s * step) ** 2 + _DAMPING * (s * step) ** 3)
    return integrated - s, integrated**2 - s**2
