"""Which level of centrifugal stiffening a scene needs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.mode_choice import resonances
from exudyn_rotor.advice.request import Request
from exudyn_rotor.theory.stiffening import stiffening

SOUTHWELL = 1.0  # stiffness by rotation per Ω² and modal mass, where it is not known
_DEFECTIVE = 1e-3  # a motion that nothing holds has no frequency to change


@dataclass(frozen=True)
class Level:
    """A level of stiffening.

    Attributes
    ----------
    name : {'tilt', 'full'}
    full : float
        Largest relative change of a frequency in the band by ``'full'`` beyond ``'tilt'``; an
        estimate without a prestress.
    known : bool
        Whether `full` comes from a prestress.
    missing : bool
        True where ``'full'`` would be needed and the rotor has no prestress.
    """

    name: str
    full: float
    known: bool
    missing: bool


def choose_level(given: Candidate, request: Request, kept: np.ndarray) -> Level:
    """Take the best level there is, for none costs time in a step; say whether one is missing.

    With known supports the frequencies are those of the rotor on them, and a level δK changes
    them by ``δν = xᴴδK x / xᴴ(2νM − G)x``, to first order. Without supports it is the modes' own
    ``½ Ω² δK_kk / ω_k²``. A mode that is seen near zero in the rotor frame is judged by the spin
    speed. Without a prestress the missing stiffness is that of a truss in place of the solid
    (:mod:`exudyn_rotor.prestress.estimate`) or, where there is none, Ω² for every mode of unit
    mass: the order of a blade or a disc that flaps. Bending of a slender shaft misses far less.
    """
    inv = given.invariants
    tilt = _K2(given, "tilt")
    known = inv.K2 is not None
    flexible = given.flexible[kept]
    if known:
        beyond = _K2(given, "full") - tilt
    else:
        beyond = np.zeros_like(tilt)
        places = np.ix_(flexible, flexible)
        estimate = inv.K2_estimated
        estimate = SOUTHWELL * np.eye(len(tilt)) if estimate is None else estimate
        beyond[places] = estimate[places] - tilt[places]
    by_full = 0.0
    for speed in request.speeds[request.speeds > 0.0]:
        by_full = max(by_full, _shift(given, request, speed, beyond, flexible))
    missing = by_full > request.accuracy and not known
    return Level("full" if known else "tilt", by_full, known, missing)


def _K2(given: Candidate, level: str) -> np.ndarray:
    return np.asarray(stiffening(given.invariants, level).K2)


def _shift(
    given: Candidate, request: Request, speed: float, change: np.ndarray, flexible: np.ndarray
) -> float:
    """Return the largest relative change of a frequency by ``Ω² change``."""
    if not given.supported:
        stiffness = np.diag(given.invariants.K)[flexible]
        shift = 0.5 * speed**2 * np.abs(np.diag(change)[flexible]) / stiffness
        return float(np.max(shift, initial=0.0))
    frequencies, vectors, (M, G) = resonances(given, speed, request.loads + speed)
    if frequencies.size == 0:
        return _static_shift(given, speed, change)
    size = given.resonating.size
    work = np.zeros(frequencies.size)
    for start in range(0, len(M), size):  # every harmonic of the speed
        modal = vectors[start + given.modal]
        work = work + np.einsum("ir,ij,jr->r", modal.conj(), change, modal).real
    norm = np.einsum("ir,ij,jr->r", vectors.conj(), M, vectors).real * 2.0 * frequencies
    norm -= np.einsum("ir,ij,jr->r", vectors.conj(), G, vectors).real
    mass = np.einsum("ir,ij,jr->r", vectors.conj(), M, vectors).real
    middle = slice(size * (len(M) // size // 2), size * (len(M) // size // 2 + 1))
    middle_mass = np.einsum(
        "ir,ij,jr->r", vectors[middle].conj(), M[middle, middle], vectors[middle]
    ).real
    held = (np.abs(norm) > _DEFECTIVE * (frequencies + speed) * mass) & (middle_mass > 0.3 * mass)
    shift = speed**2 * np.abs(work[held] / norm[held]) / np.maximum(frequencies, speed)[held]
    return float(np.max(shift, initial=0.0))


def _static_shift(given: Candidate, speed: float, change: np.ndarray) -> float:
    """Return the relative change of the lowest stiffnesses where no frequency is in the band."""
    *_, K, count = given.conservative(speed)
    size = given.resonating.size
    places = size * (count // 2) + given.modal
    H = np.linalg.pinv(K[np.ix_(places, places)], rcond=1e-10, hermitian=True)
    return float(0.5 * speed**2 * np.abs(np.linalg.eigvals(H @ change)).max())
