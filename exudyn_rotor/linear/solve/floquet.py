"""Motions of periodic equations by Floquet's method: the monodromy matrix of one period.

The second way beside Hill's method, with nothing in common but the equations. The state is followed
over a period by exponentials of a Magnus series of fourth order; the multipliers μ = exp(λT) are
the eigenvalues of the result, and the motion over the period tells which of the frequencies
``Im λ + n·2π/T`` is the one whose harmonics lie around zero. Source of the series: Blanes, Casas,
Oteo, Ros, Phys. Rep. 470 (2009), Sect. 5.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.equations import PeriodicSystem, at_angle
from exudyn_rotor.linear.solve.hill import Exponents, one_of_each_family
from exudyn_rotor.linear.solve.state import States

GAUSS_POINTS = 0.5 + np.array([-1.0, 1.0]) * np.sqrt(3.0) / 6.0
_STEPS = 64  # of a period


def magnus_exponent(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return the exponent of a step from h times the matrix at its two Gauss points."""
    commutator = second @ first - first @ second
    return 0.5 * (first + second) + np.sqrt(3.0) / 12.0 * commutator


def floquet_motions(
    system: PeriodicSystem, made: States, steps: int = _STEPS
) -> Exponents:
    """Return the motions of a system."""
    period = 2.0 * np.pi / (system.step * abs(system.speed))
    h, turn = period / steps, 2.0 * np.pi / system.step * np.sign(system.speed)
    size = len(made.A[0])
    followed = [np.eye(size)]
    for number in range(steps):
        angles = turn * (number + GAUSS_POINTS) / steps
        first, second = (h * at_angle(made.A, angle) for angle in angles)
        followed.append(la.expm(magnus_exponent(first, second)) @ followed[-1])
    multipliers, vectors = np.linalg.eig(followed[-1])
    values = np.log(multipliers.astype(complex)) / period
    times = h * np.arange(steps)
    courses = np.array(followed[:-1]) @ vectors  # (steps, 2k, 2k)
    periodic = courses * np.exp(-np.outer(times, values))[:, None, :]
    spectrum = np.fft.fft(periodic, axis=0) / steps
    top = steps // 4
    spectrum = np.concatenate([spectrum[-top:], spectrum[: top + 1]])
    orders = system.step * np.arange(-top, top + 1)
    energy = np.sum(np.abs(spectrum) ** 2, axis=1)
    energy = energy / energy.sum(axis=0)
    shift = np.round((np.arange(-top, top + 1) @ energy)).astype(int)
    states = np.zeros_like(spectrum)
    for column, by in enumerate(shift):
        states[:, :, column] = np.roll(spectrum[:, :, column], -by, axis=0)
    values = values + 1j * shift * 2.0 * np.pi / period
    if system.speed < 0.0:
        states, orders = states[::-1], -orders[::-1]
    chosen = one_of_each_family(values, states, orders, system, made)
    return Exponents(values[chosen], states[:, :, chosen], orders)
