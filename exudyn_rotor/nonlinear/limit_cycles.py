"""Limit cycles of rotors on films: whirl and whip, which no drive frequency gives.

Where an equilibrium turns unstable (Hopf), a motion ``Re φ exp(iωt)`` neither grows nor decays,

    [I − H(iω) (G + iω G')] φ = 0,                                                          (1)

with the derivatives G, G' of :mod:`.balance` at the equilibrium. There begins a branch of periodic
motions of small size. It is followed with ω as an unknown, and a phase condition, which keeps φ in
phase.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.build import Target
from exudyn_rotor.linear.response.loads import At, HarmonicForce, checked_places
from exudyn_rotor.linear.stability.thresholds import StabilityThresholds
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.nonlinear.balance import Balance, padded
from exudyn_rotor.nonlinear.collect import collected
from exudyn_rotor.nonlinear.continuation import Family, Point
from exudyn_rotor.nonlinear.periodic_response import warn_of
from exudyn_rotor.nonlinear.periodic_result import PeriodicResponse
from exudyn_rotor.nonlinear.problem import Problem
from exudyn_rotor.nonlinear.scene import as_lists
from exudyn_rotor.solvers.factor import one_thread

_NEUTRAL = 1e-2  # share of (1) that a tolerance of the limit of stability leaves
_FIRST = 0.02  # of a clearance: size of the first motion
_BELOW = 0.3  # of the onset, down to which a branch is followed that turns back
_BEGIN, _MOST = (3, 0), (48, 0)  # harmonics


def limit_cycles(
    target: Target,
    speeds: ArrayLike,
    onset: StabilityThresholds,
    *,
    supports: Sequence[Given] | Given = (),
    gravity: ArrayLike = (0.0, 0.0, 0.0),
    loads: Sequence[HarmonicForce] | HarmonicForce = (),
    foundation: Foundation | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    at: Sequence[At] | At | None = None,
    stiffening: str = "auto",
    tolerance: float = 1e-3,
) -> PeriodicResponse:
    """Compute the whirl of a rotor on films without unbalance, from where it begins.

    The branch of whirling motions is followed from the first onset of instability, at which the
    whirl is small, up to the last speed, whether it leads to higher or to lower speeds first.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, LinearModel or exudyn.MainSystem
        As of :func:`periodic_response`; round.
    speeds : array_like, shape (v,)
        Ascending spin speeds [rad/s] at which all solutions that are met are wanted.
    onset : StabilityThresholds
        Of :func:`stability_threshold`, with the same supports.
    supports, gravity, loads, foundation, body, at, stiffening, tolerance
        See :func:`periodic_response`.

    Returns
    -------
    PeriodicResponse
        Its second phase is that of the whirl: ``found.rates[:, 0]`` is the frequency.

    Raises
    ------
    TypeError, ValueError
        As :func:`periodic_response`; where the rotor is stable in the whole range of `onset`, and
        for an uneven rotor or rolling bearings, whose spin is a second frequency.

    Examples
    --------
    A mass of 20 kg on a film that carries it whirls at about half of its spin speed:

    >>> import numpy as np
    >>> from exudyn_rotor import (
    ...     ShortJournalBearing, SolidRotor, limit_cycles, stability_threshold
    ... )
    >>> mass = SolidRotor.from_matrices(20.0 * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], "z")
    >>> rotor, weight = mass.with_interface("seat", [0]).reduce(0), [0.0, -9.81, 0.0]
    >>> film = ShortJournalBearing(
    ...     interface="seat", radius=0.03, length=0.02, clearance=6e-5, viscosity=0.02,
    ...     load=[0.0, -196.2],
    ... )
    >>> onset = stability_threshold(rotor, 100.0, 2000.0, supports=film)
    >>> whirl = limit_cycles(rotor, [1200.0], onset, supports=film, gravity=weight)
    >>> point = whirl.at(1200.0)[-1]
    >>> print(round(whirl.rates[point, 0] / 1200.0, 2))
    0.5
    """
    speeds = checks.ascending_from_zero(speeds, "speeds")
    checks.instance(onset, "onset", StabilityThresholds, "stability_threshold(…) makes one")
    tolerance = checks.tolerance(tolerance)
    asked = checked_places(at)
    begins = np.flatnonzero(onset.onset)
    if not begins.size:
        raise ValueError("onset: the rotor does not turn unstable in its range; give a wider one")
    speed = float(onset.values[begins[0]])
    frequency = float(onset.frequencies_inertial[begins[0]])
    given = as_lists(target, body, supports, foundation, gravity, loads, stiffening)
    problem = Problem.of(given, unbalances=(), own=False, speed=speed, highest=speed)
    if problem.standing is None or problem.laws.passes:
        raise ValueError(
            "target, supports: need a round rotor without rolling bearings, whose spin would be a "
            "second frequency"
        )

    def balance(p: np.ndarray, reach: tuple[int, int]) -> Balance:
        return problem.balance(float(p[1]), reach, whirl=float(p[0]))

    with one_thread():
        mean, phi = _hopf(problem, frequency, speed)
        p = np.array([frequency, speed])
        spans = np.array([p[0], max(np.ptp(speeds), 0.1 * p[1])])
        wave, turned = (
            padded(np.array([one.conj(), 0.0 * one, one]), (1, 0), _BEGIN)
            for one in (phi, 1j * phi)
        )
        family = Family(balance, spans, problem.size, tolerance, _MOST, (turned, _BEGIN))
        c = _FIRST * family.size / np.linalg.norm(phi) * wave + padded(mean, (0, 0), _BEGIN)
        row = wave / np.linalg.norm(wave), np.zeros(2)
        try:
            start = family.corrected(Point(c, p, balance(p, _BEGIN)), row)[0]
        except UnconvergedError as error:
            raise ValueError("onset: no whirl of small size was found at it") from error
        limits = min(speeds[0], _BELOW * p[1]), speeds[-1]
        found = list(family.followed(start, speeds, limits=limits))
        warn_of(family, found)
        return collected([found], "spin speed [rad/s]", asked)


def _hopf(problem: Problem, frequency: float, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean place (1, d) and φ (d,) of (1) at a limit of stability."""
    mean = problem.at_rest(speed)
    balance = problem.balance(speed, (1, 0), whirl=frequency)
    J = balance.linearised(padded(mean, (0, 0), (1, 0)))[1]
    d = mean.size
    _, sizes, V = np.linalg.svd(J[2 * d :, 2 * d :])  # of the harmonic 1
    if sizes[-1] > _NEUTRAL * sizes[0]:
        raise ValueError(f"onset: at {speed:g} rad/s no whirl begins; are the supports the same?")
    return mean, V[-1].conj()
