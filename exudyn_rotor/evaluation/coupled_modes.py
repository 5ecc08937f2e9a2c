"""Modes of a rotor over an applied cross-coupling, each followed from none of it."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.modal.campbell import campbell
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

ROUNDING = 1e-9  # of log decrements: a mode with its node at the cross-coupling is not changed
_STILL = 1e-6  # of the speed: a rotor that nothing holds has the frequency 0


@dataclass(frozen=True, eq=False)
class Modes:
    """Modes under one cross-coupling; eigenvalues (k,) and shapes (c, k) are of the rotor frame.

    Shapes have a modal mass of one; `momenta` are the mass matrix times the shapes.
    """

    decrements: np.ndarray
    frequencies: np.ndarray
    eigenvalues: np.ndarray
    shapes: np.ndarray
    momenta: np.ndarray
    lateral: np.ndarray

    def continued(self, found: Modes) -> Modes:
        """Return other modes in the order of these, each one once.

        By shape and eigenvalue: above their frequency, forward and backward modes have one shape in
        the rotor frame, and several modes may have one eigenvalue.
        """
        unlike = 1.0 - np.abs(self.momenta.conj().T @ found.shapes) ** 2
        a, b = self.eigenvalues[:, None], found.eigenvalues[None, :]
        away = np.abs(a - b) / np.maximum(np.maximum(np.abs(a), np.abs(b)), np.finfo(float).tiny)
        _, order = linear_sum_assignment(unlike + away)
        return Modes(*(getattr(found, item.name)[..., order] for item in fields(found)))


def first_forward(followed: list[Modes], speed: float) -> int:
    """Return the lowest lateral mode that the cross-coupling makes less stable.

    That is the first forward mode: the work of cross-coupling on an orbit has the sign of its
    sense. In bearings that differ in their two directions modes may have none, until it is applied.
    """
    start, end = followed[0], followed[-1]
    fed = start.lateral & (end.decrements < start.decrements - ROUNDING)
    fed &= (start.frequencies > _STILL * speed) & np.isfinite(start.decrements)
    if not np.any(fed):
        raise ValueError(f"supports: no mode at {speed:g} rad/s is fed by the cross-coupling")
    return int(np.argmin(np.where(fed, start.frequencies, np.inf)))


@dataclass(frozen=True, eq=False)
class Coupled:
    """The rotor on its supports, under multiples of the anticipated cross-coupling."""

    target: ReducedRotor
    speed: float
    amounts: dict[str, float]
    supports: tuple[Support, ...]
    stiffening: str

    def modes(self, multiple: float) -> Modes:
        """Return all modes."""
        coupled = [
            Support(name, [[0.0, multiple * q], [-multiple * q, 0.0]])
            for name, q in self.amounts.items()
        ]
        given = {"supports": (*self.supports, *coupled), "stiffening": self.stiffening}
        if multiple > 0.0:  # the basis is the same
            given["accuracy"] = None
        diagram = campbell(self.target, self.speed, **given)
        momenta = self._mass_matrix @ diagram.vectors[0]
        size = np.sqrt(np.sum(diagram.vectors[0].conj() * momenta, axis=0).real)
        return Modes(
            decrements=diagram.log_decrement[0],
            frequencies=diagram.frequencies_inertial[0],
            eigenvalues=diagram.growth[0] + 1j * diagram.frequencies_rotor[0],
            shapes=diagram.vectors[0] / size,
            momenta=momenta / size,
            lateral=(diagram.nodal_diameters[0] == 1) & (diagram.damping_ratio[0] < 1.0),
        )

    @cached_property
    def _mass_matrix(self) -> np.ndarray:
        return linear_model(self.target, supports=self.supports).at(self.speed).M
