"""The equations of :class:`~exudyn_rotor.theory.motion.Motion` in few numpy calls per step.

Motion states every term once and serves every case. A time step of a small system is not made of
floating-point work but of calls, so this module stacks the invariants: one matrix product gives

    [h + Ĉζ; g + Wζ] = [[Ĉ, h], [W, g]] [ζ; 1]

for mass matrix and forces at once, into memory that is reused. What is linear with constant
coefficients is not here at all: :func:`constant_part` hands it to the host as matrices. Tests hold
both modules together to round-off.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.nodal import skew


@dataclass(frozen=True, eq=False)
class ConstantPart:
    """What needs no evaluation in a time step, on the unknowns of a motion.

    Attributes
    ----------
    stiffness, damping : ndarray, shape (size, size)
        With the spin terms (109) where the speed is constant.
    force : ndarray, shape (size,)
        Gravity on unknown translations and, at constant speed, ``ω²h``.
    """

    stiffness: np.ndarray
    damping: np.ndarray
    force: np.ndarray


def constant_part(motion: Motion) -> ConstantPart:
    """Return the linear terms with constant coefficients of `motion`."""
    checks.instance(motion, "motion", Motion)
    inv, modes = motion.invariants, motion.modes
    stiffness, damping = np.zeros((2, motion.size, motion.size))
    force = np.zeros(motion.size)
    stiffness[modes, modes], damping[modes, modes] = inv.K, inv.D
    force[motion.translations] = motion.weight
    if motion.formulation.is_constant_speed:
        speed, terms = motion.formulation.spin.speed, motion.spin_terms
        stiffness[modes, modes] += terms.stiffness(speed)
        damping[modes, modes] += terms.damping(speed)
        force[modes] = terms.load(speed)
    return ConstantPart(stiffness, damping, force)


class Kernel:
    """Mass matrix and forces of a motion without translational coupling, less the constant part.

    Parameters
    ----------
    motion : Motion
        Dense, and with ``motion.is_coupled`` False.
    unknowns : sequence of int
        Places of the motion's unknowns among `size` coordinates; the modes come last, in a row.
    size : int

    Raises
    ------
    TypeError, ValueError
        For another motion, or places that do not fit.

    Attributes
    ----------
    spin : int
        Place of an unknown θ.
    spin_inertia : float
        (85) of the last :meth:`update`.
    spin_coupling : ndarray, shape (m,)
        (84) of the last :meth:`update`.
    """

    def __init__(self, motion: Motion, unknowns: Sequence[int], size: int) -> None:
        checks.instance(motion, "motion", Motion)
        inv, count = motion.invariants, motion.invariants.size
        if inv.is_sparse or motion.is_coupled:
            raise ValueError("motion: needs dense invariants and translations without coupling")
        size = checks.count(size, "size", least=motion.size)
        places = checks.whole_numbers(unknowns, "unknowns", most=size - 1)
        modes = np.arange(size - count, size)
        if len(places) != motion.size or np.any(places[motion.size - count :] != modes):
            raise ValueError(
                f"unknowns: need {motion.size} places, the last {count} of {size} for the modes, "
                f"got {checks.shown(places.tolist())}"
            )
        self._motion = motion
        self._first = size - count
        self.spin = int(unknowns[motion.formulation.translation_count])
        terms = motion.spin_terms
        self._table = np.block([[terms.C_hat, inv.h[:, None]], [terms.W, inv.g[:, None]]])
        self._state = np.ones(count + 1)
        self._zeta = self._state[:count]
        self._products = np.empty(2 * count)
        self._centrifugal, self.spin_coupling = self._products[:count], self._products[count:]
        self._h = inv.h
        self._rate = np.empty(count)
        self._coriolis, self._twice_G = np.empty(count), terms.damping(1.0)
        self._B = terms.B if np.any(terms.B) else None
        self._force = np.zeros(size)
        self._modal_force = self._force[self._first :]
        self._last: list | None = None
        self._body_force = _BodyForce(motion) if motion.has_body_force else None
        self.spin_inertia = inv.Theta

    def update(self, q: list) -> None:
        """Evaluate the products of the modal coordinates; free where they are known already."""
        if q == self._last:
            return
        self._last = q
        self._zeta[:] = q[self._first :]
        np.dot(self._table, self._state, out=self._products)
        # (85): Θ + 2hᵀζ + ζᵀĈζ
        change = self._zeta.dot(self._centrifugal) + self._zeta.dot(self._h)
        self.spin_inertia = self._motion.invariants.Theta + change

    def forces_of_free_spin(self, t: float, q: list, q_t: list) -> np.ndarray:
        """Return (86) and (87) for an unknown θ, shape (size,); valid until the next call."""
        self.update(q)
        omega, rate = q_t[self.spin], self._rate
        rate[:] = q_t[self._first :]
        np.dot(self._twice_G, rate, out=self._coriolis)
        torque = -2.0 * omega * self._centrifugal.dot(rate)
        if self._B is not None:
            torque -= rate.dot(self._B.dot(rate))
        np.multiply(self._centrifugal, omega * omega, out=self._modal_force)
        self._coriolis *= omega
        self._modal_force -= self._coriolis
        if self._body_force is not None:
            modal, by_deflection = self._body_force.at(t, q[self.spin])
            self._modal_force += modal
            torque += self._body_force.torque + self._zeta.dot(by_deflection)
        self._force[self.spin] = torque
        return self._force

    def forces_of_driven_spin(self, t: float, q: list, q_t: list) -> np.ndarray:
        """Return (108) for a prescribed θ(t), shape (size,); valid until the next call."""
        self.update(q)
        spin = self._motion.formulation.spin
        omega, acceleration = spin.rate(t), spin.acceleration(t)
        self._rate[:] = q_t[self._first :]
        np.dot(self._twice_G, self._rate, out=self._coriolis)
        np.multiply(self._centrifugal, omega * omega, out=self._modal_force)
        self._coriolis *= omega
        self._modal_force -= self._coriolis
        self._modal_force -= acceleration * self.spin_coupling
        if self._body_force is not None:
            self._modal_force += self._body_force.at(t, spin.value(t))[0]
        return self._force

    def body_force_at_constant_speed(self, t: float, q: list, q_t: list) -> np.ndarray:
        """Return gravity and the frame's acceleration of (108), shape (size,), as above."""
        self._modal_force[:] = self._body_force.at(t, self._motion.formulation.spin.value(t))[0]
        return self._force


class _BodyForce:
    """Gravity less the frame's acceleration on the modes and, by their deflection, on the spin.

    With ``Aᵀv = (e·v)e + cosθ (v − (e·v)e) − sinθ ẽv`` (55), all of it is linear in
    ``(1, cosθ, sinθ)``.
    """

    def __init__(self, motion: Motion) -> None:
        inv = motion.invariants
        e = inv.direction
        along = np.outer(e, e)
        turns = np.stack([along, np.eye(3) - along, -skew(e)], axis=1) @ motion.orientation.T
        rows = np.vstack([inv.S.T, motion.S1.T, motion.static_unbalance[None, :]])
        self._table = np.einsum("ra,akv->rkv", rows, turns)
        self._gravity = motion.gravity
        form = motion.formulation
        self._acceleration = form.translation.acceleration if form.moves_origin else None
        self._constant = self._table @ motion.gravity
        self._count = inv.size
        self.torque = 0.0  # on the undeformed rotor's static unbalance

    def at(self, t: float, theta: float) -> tuple[np.ndarray, np.ndarray]:
        """Return ``Sᵀ a`` and ``S*ᵀ a`` of the body acceleration a in rotor axes, each (m,)."""
        table = self._constant
        if self._acceleration is not None:
            table = self._table @ (self._gravity - np.asarray(self._acceleration(t), dtype=float))
        products = table @ (1.0, math.cos(theta), math.sin(theta))
        self.torque = products[-1]
        return products[: self._count], products[self._count : -1]
