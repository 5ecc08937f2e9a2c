"""Modes of several rotors by the constant equations of axes that stand still.

Where all rotors are axisymmetric, and what is not the same in all directions stands still, as
anisotropic bearings and gears do, coefficients are constant in inertial axes. There a motion
``v exp(λt)`` has, in axes that turn with Ω, the harmonics of its waves,
``Σ_n P_n v exp((λ − inΩ)t)``, with the projectors P_n on waves of n nodal diameters
(:mod:`.turning`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.linear.models.trains.turning import Turning
from exudyn_rotor.linear.models.trains.uneven_space import UnevenSpace
from exudyn_rotor.linear.models.waves import HIGHEST
from exudyn_rotor.linear.models.whole_space import Equations
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes, constant_modes
from exudyn_rotor.linear.periodic.periodic_system import ConstantSystems, PeriodicSystem


@dataclass(frozen=True, eq=False, kw_only=True)
class StandingSpace(UnevenSpace):
    """All coordinates of several rotors; modes from inertial axes where only these are constant.

    Attributes
    ----------
    standing : Equations
        In inertial axes, constant.
    turnings : sequence of Turning
        Of the rotors, in the order of the coordinates.
    """

    standing: Equations
    turnings: Sequence[Turning]

    def modes(self, speed: float, tolerance: float) -> FloquetModes:
        """Return all modes."""
        if self.at(speed).stands_still:
            return super().modes(speed, tolerance)
        systems = ConstantSystems.of([self.standing.at(speed)])
        found = self._turned(constant_modes(systems, once=True)[0], speed)
        negative = found.values.imag < 0.0
        values = np.where(negative, found.values.conj(), found.values)
        vectors = np.where(negative, found.vectors[::-1].conj(), found.vectors)
        order = np.argsort(values.imag, kind="stable")
        return replace(found, values=values, vectors=vectors).columns(order)

    def constant_modes(self, speeds: Sequence[float]) -> list[FloquetModes]:
        """Return all modes at all speeds."""
        found = super().constant_modes(speeds)
        return found or [self.modes(float(speed), 0.0) for speed in speeds]

    def motions(
        self, speed: float, method: str, tolerance: float, shapes: bool = True
    ) -> tuple[FloquetModes, PeriodicSystem]:
        """Return all exponents with their motions, and the equations."""
        system = self.at(speed)
        if method != "auto" or system.stands_still:
            return super().motions(speed, method, tolerance, shapes)
        standing = self.standing.at(speed)
        if self.others is not None:
            standing = standing.projected(self.others)
        found = motions(standing, method, tolerance, shapes)
        if self.others is not None:
            found = replace(found, vectors=self.others @ found.vectors)
        return self._turned(found, speed), system

    def turned_harmonics(self, motions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return what motions (k, c) of one frequency are in axes that turn with Ω.

        Harmonics (h, k, c), and by which multiple of Ω the frequency of each differs, (h,).
        """
        parts = self._waves(motions)[::-1]
        orders = np.arange(-HIGHEST, HIGHEST + 1)
        top = int(np.abs(orders[np.any(parts, axis=(1, 2))]).max(initial=0))
        kept = np.abs(orders) <= top
        return parts[kept], orders[kept]

    def _waves(self, motions: np.ndarray) -> np.ndarray:
        """Return the parts of motions (k, c) that are waves of −4 to 4 nodal diameters."""
        parts = np.zeros((2 * HIGHEST + 1, *motions.shape), dtype=complex)
        start = 0
        for turning in self.turnings:
            end = start + len(turning.waves)
            amplitudes = turning.inverse @ motions[start:end]
            for n in np.unique(turning.waves):
                wave = turning.waves == n
                parts[HIGHEST + n, start:end] = turning.T[:, wave] @ amplitudes[wave]
            start = end
        return parts

    def _turned(self, modes: FloquetModes, speed: float) -> FloquetModes:
        """Return motions as seen from axes that turn with Ω, their strongest wave as harmonic 0."""
        central = modes.central
        parts = self._waves(central)
        strongest = np.argmax(np.linalg.norm(parts, axis=1), axis=0) - HIGHEST
        orders = np.arange(-2 * HIGHEST, 2 * HIGHEST + 1)
        vectors = np.zeros((len(orders), *central.shape), dtype=complex)
        columns = np.arange(central.shape[1])
        for n in range(-HIGHEST, HIGHEST + 1):
            vectors[2 * HIGHEST + strongest - n, :, columns] = parts[HIGHEST + n].T
        values = modes.values - 1j * strongest * speed
        used = np.flatnonzero(np.any(vectors, axis=(1, 2)))
        top = int(np.abs(orders[used]).max(initial=0))
        kept = slice(2 * HIGHEST - top, 2 * HIGHEST + top + 1)
        lengths = np.linalg.norm(vectors.reshape(-1, central.shape[1]), axis=0)
        return FloquetModes(
            values, (vectors / lengths)[kept], orders[kept], modes.resolution, modes.bounds
        )
