"""The equations of motion of component modes, in few numpy calls per step.

A time step of a small system is not made of floating-point work but of calls, so this module stacks
the invariants. With the deformed rotor's
unbalance ``u = mχ* + S*ζ`` (65), one matrix product gives the rows

    centrifugal     h + Ĉζ     −ẽu
    Euler           g + Wζ      u
    Coriolis        2Gζ̇         2S*ζ̇

of mass matrix and forces, and ``(ω², −ω̇, −ω)`` times these rows the inertia forces on the modes
(87) and, turned by A, on the translations (66); a static displacement adds ``−ω⁴K4ζ``. What
depends on the angle is linear in ``(1, cosθ, sinθ)``: one more product. What is linear with
constant coefficients is not here at all: :func:`constant_part` hands it to the host as matrices.
Tests hold the module to the energy of the nodes, and to the blocks of
:mod:`exudyn_rotor.theory.terms`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.formulation import FloatingFrame


@dataclass(frozen=True, eq=False)
class ConstantPart:
    """What needs no evaluation in a time step, on the unknowns of a motion."""

    stiffness: np.ndarray  # (size, size) With the spin terms (109) where the speed is constant
    damping: np.ndarray
    force: np.ndarray  # (size,) Gravity on unknown translations and, at constant speed, ``ω²h``


def constant_part(motion: FloatingFrame) -> ConstantPart:
    """Return the linear terms with constant coefficients of `motion`."""
    inv, modes = motion.invariants, motion.modes
    stiffness, damping = np.zeros((2, motion.size, motion.size))
    stiffness[modes, modes], damping[modes, modes] = inv.K, inv.D
    if motion.formulation.is_constant_speed:
        speed, terms = motion.formulation.spin.speed, motion.spin_terms
        stiffness[modes, modes] += terms.stiffness(speed)
        damping[modes, modes] += terms.damping(speed)
    return ConstantPart(stiffness, damping, motion.constant_force())


class Kernel:
    """Mass matrix, forces and Jacobian of a dense motion, less the constant part.

    `unknowns` are the places of the motion's unknowns among `size` coordinates; the modes come
    last, in a row. The entries of the mass matrix that vary stand at `rows` and `columns`, on or
    above the diagonal, or in its mirror image; the inertia (85) of a free spin is the first.
    """

    def __init__(self, motion: FloatingFrame, unknowns: Sequence[int], size: int) -> None:
        count, form = motion.invariants.size, motion.formulation
        if motion.invariants.is_sparse:
            raise ValueError("motion: needs dense invariants")
        self._motion, self._count, self._first = motion, count, size - count
        self._translations = np.array(unknowns[motion.translations], dtype=int)
        self._spin = int(unknowns[form.translation_count]) if form.has_spin else None
        self._varies = form.has_spin and not form.has_frozen_spin  # the spin's own inertia
        # whether the constant part leaves out inertia forces on the modes
        self.has_modal_forces = not form.is_constant_speed
        self._force, self._jacobian = np.zeros(size), np.zeros((size, size))
        self._modal_force = self._force[self._first :]
        self._stack(motion)
        self._turning = _Turning(motion)
        self._place_mass(np.arange(size - count, size))
        self._factors = np.zeros(3)
        self._last: list | None = None
        self._time = math.nan

    def _stack(self, motion: FloatingFrame) -> None:
        """Arrange the invariants for the three rows of the docstring."""
        inv, terms, count = motion.invariants, motion.spin_terms, self._count
        e, S1, u = skew(inv.direction), motion.S1, motion.static_unbalance[:, None]
        h, g = inv.h[:, None], inv.g[:, None]
        # the last column of (85) makes Θ + hᵀζ, so that (ζ, 1) times this row is (85)
        centrifugal = [np.hstack([terms.C_hat, h]), np.hstack([h.T, [[inv.Theta]]])]
        euler = [np.hstack([terms.W, g]), np.zeros((1, count + 1))]
        coriolis = [2.0 * terms.G, np.zeros((1, count))]
        if motion.is_coupled:
            centrifugal.append(np.hstack([-e @ S1, -e @ u]))
            euler.append(np.hstack([S1, u]))
            coriolis.append(2.0 * S1)
        self._by_position = np.vstack([*centrifugal, *euler])
        frozen = motion.formulation.has_frozen_spin
        self._B = terms.B if np.any(terms.B) and not frozen else None
        self._by_rate = np.vstack([*coriolis, *([] if self._B is None else [self._B])])
        width = sum(map(len, coriolis))
        # the three rows, and behind them Bζ̇
        places = np.zeros(2 * width + len(self._by_rate))
        self._products = places[: 3 * width].reshape(3, width)
        self._of_position, self._of_rate = places[: 2 * width], places[2 * width :]
        self._euler_torque = places[3 * width :]
        # inertia forces on the modes, (87), and behind them those on coupled translations; where
        # there are none of these, they are written where they belong
        self._loads, self._loading = np.zeros(width), self._products
        self._in_place = self.has_modal_forces and not motion.is_coupled
        if self._in_place:
            self._loads, self._loading = self._modal_force, self._products[:, :count]
        self._state = np.ones(count + 1)
        self._zeta, self._rate = self._state[:count], np.zeros(count)
        self._spin_inertia_row = self._products[0, : count + 1]
        self._centrifugal, self._spin_coupling = self._products[:2, :count]
        self._unbalance = self._products[1, count + 1 :]
        self._K4, self._displaced = terms.K4, np.zeros(count)
        self._share = 1.0 if frozen else 2.0  # of ω(h + Ĉζ)ᵀζ̇ in the torque (86)
        self._by_state = np.stack([terms.C_hat, terms.W, 2.0 * terms.G]).reshape(3, -1)
        # −ẽS*, S* and 2S*
        self._frame_by_state = -e @ S1, S1, 2.0 * S1

    def _place_mass(self, modes: np.ndarray) -> None:
        """Say where the entries of the mass matrix stand that vary, and cut their values."""
        moved, turning = self._translations, self._turning
        blocks = []
        if self._spin is not None:
            if self._varies:
                blocks += [([self._spin], [self._spin]), ([self._spin], modes)]
            if self._motion.is_coupled:
                blocks.append((moved, [self._spin]))
        if self._motion.is_coupled:
            blocks.append((moved, modes[turning.coupled]))
        grids = [[part.ravel() for part in np.meshgrid(*block, indexing="ij")] for block in blocks]
        empty = np.zeros(0, dtype=int)
        self.rows, self.columns = (
            np.concatenate([empty, *(grid[side] for grid in grids)]).astype(int) for side in (0, 1)
        )
        self._mass = np.zeros(len(self.rows))
        ends = np.cumsum([0, *(len(grid[0]) for grid in grids)])
        self._mass_parts = [self._mass[a:b] for a, b in pairwise(ends)]

    def mass_entries(self, t: float, q: list) -> np.ndarray:
        """Return the entries at :attr:`rows` and :attr:`columns`; valid until the next call."""
        self._update(t, q)
        parts = self._mass_parts
        if self._varies:
            parts[0][0] = self._state.dot(self._spin_inertia_row)
            parts[1][:] = self._spin_coupling
        if self._motion.is_coupled:
            if self._spin is not None:
                np.dot(self._turning.A, self._unbalance, out=parts[-2])
            parts[-1][:] = self._turning.coupling
        return self._mass

    def forces(self, t: float, q: list, q_t: list) -> np.ndarray:
        """Return what the motion has beside the constant part, shape (size,).

        (66), (86), (87) and the prescribed accelerations of (108); valid until the next call.
        """
        omega, loads = self._update_with_rates(t, q, q_t), self._loads
        if self.has_modal_forces and not self._in_place:
            self._modal_force[:] = loads[: self._count]
        turning, torque = self._turning, 0.0
        if self._spin is not None:
            torque = -self._share * omega * float(self._centrifugal.dot(self._rate))
            if self._B is not None:
                torque -= self._rate.dot(self._euler_torque)
        if turning.has_body_force:
            if self.has_modal_forces:
                self._modal_force += turning.modal
            else:
                self._modal_force[:] = turning.modal
            if self._spin is not None:
                torque += turning.torque + self._zeta.dot(turning.by_deflection)
        if self._motion.is_coupled:
            self._force[self._translations] = turning.A.dot(loads[self._count + 1 :])
        if self._spin is not None:
            self._force[self._spin] = torque
        return self._force

    def jacobian(
        self, t: float, q: list, q_t: list, factor_q: float, factor_v: float
    ) -> np.ndarray:
        """Return ``−factor_q ∂f/∂q − factor_v ∂f/∂q̇`` of :meth:`forces`, shape (size, size).

        Valid until the next call.
        """
        omega = self._update_with_rates(t, q, q_t)
        matrix, first = self._jacobian, self._first
        if self.has_modal_forces:
            squared, euler, _ = self._factors  # ω², −ω̇
            by = (-factor_q * squared, -factor_q * euler, factor_v * omega)
            block = np.dot(by, self._by_state)
            matrix[first:, first:] = block.reshape(self._count, self._count)
            if self._K4 is not None:
                matrix[first:, first:] += factor_q * squared**2 * self._K4
        if self._spin is not None:
            self._add_spin_columns(omega, factor_q, factor_v)
        if self._motion.is_coupled:
            self._add_translations(omega, factor_q, factor_v)
        return matrix

    def _add_spin_columns(self, omega: float, factor_q: float, factor_v: float) -> None:
        terms, turning = self._motion.spin_terms, self._turning
        matrix, spin, first = self._jacobian, self._spin, self._first
        centrifugal, rate = self._centrifugal, self._rate
        column = factor_v * (self._products[2, : self._count] - 2.0 * omega * centrifugal)
        share = self._share
        row = (share * omega * factor_q) * terms.C_hat.dot(rate)
        row += (share * omega * factor_v) * centrifugal
        if self._B is not None:
            row += (2.0 * factor_v) * self._euler_torque
        corner = share * factor_v * centrifugal.dot(rate)
        if turning.has_body_force:
            modal, by_deflection, torque = turning.slope()
            column -= factor_q * modal
            row -= factor_q * turning.by_deflection
            corner -= factor_q * (torque + self._zeta.dot(by_deflection))
        matrix[first:, spin], matrix[spin, first:], matrix[spin, spin] = column, row, corner

    def _add_translations(self, omega: float, factor_q: float, factor_v: float) -> None:
        squared, euler, _ = self._factors
        turning, matrix = self._turning, self._jacobian
        turned_twice, turned, twice = self._frame_by_state
        by_zeta = (-factor_q * squared) * turned_twice
        by_zeta -= (factor_q * euler) * turned
        by_zeta += (factor_v * omega) * twice
        matrix[self._translations, self._first :] = turning.A.dot(by_zeta)
        if self._spin is not None:
            loads, products = self._loads[self._count + 1 :], self._products[:, self._count + 1 :]
            by_rate = products[2] - 2.0 * omega * products[0]
            by_angle = turning.e.dot(loads)
            column = turning.A.dot(factor_v * by_rate - factor_q * by_angle)
            matrix[self._translations, self._spin] = column

    def _update(self, t: float, q: list) -> None:
        """Evaluate what depends on q and t; free where that is known already."""
        if q == self._last and t == self._time:
            return
        self._last, self._time = q, t
        self._zeta[:] = q[self._first :]
        np.dot(self._by_position, self._state, out=self._of_position)
        if self._K4 is not None:
            np.dot(self._K4, self._zeta, out=self._displaced)
        if self._turning.is_needed:
            spin = self._motion.formulation.spin
            self._turning.turn(t, spin.value(t) if self._spin is None else q[self._spin])

    def _update_with_rates(self, t: float, q: list, q_t: list) -> float:
        """Evaluate everything, and return ω."""
        self._update(t, q)
        self._rate[:] = q_t[self._first :]
        np.dot(self._by_rate, self._rate, out=self._of_rate)
        factors = self._factors
        if self._spin is not None:
            omega = q_t[self._spin]
        else:
            spin = self._motion.formulation.spin
            omega = spin.rate(t)
            factors[1] = -spin.acceleration(t)
        factors[0], factors[2] = omega * omega, -omega
        np.dot(factors, self._loading, out=self._loads)
        if self._K4 is not None:
            self._loads[: self._count] -= factors[0] ** 2 * self._displaced
        return omega


class _Turning:
    """What depends on the angle: NᵀA, NᵀAS, and gravity less the frame's acceleration.

    With ``A = eeᵀ + cosθ (I − eeᵀ) + sinθ ẽ`` (55), all of it is linear in ``(1, cosθ, sinθ)``.
    """

    def __init__(self, motion: FloatingFrame) -> None:
        inv, form = motion.invariants, motion.formulation
        self.e, self._count = skew(inv.direction), inv.size
        self.has_body_force = motion.has_body_force
        self.is_needed = motion.has_body_force or motion.is_coupled
        along = np.outer(inv.direction, inv.direction)
        # A, with the coefficients of 1, cosθ and sinθ last
        turns = np.stack([along, np.eye(3) - along, self.e], axis=2)
        N = motion.free_directions.T @ motion.orientation
        A = np.einsum("ab,bcv->acv", N, turns)
        coupling = np.einsum("abv,bk->akv", A, inv.S)
        self.coupled = np.flatnonzero(np.any(coupling, axis=(0, 2)))
        coupling = coupling[:, self.coupled]
        self._angles = np.ones(3)
        self._table = np.vstack([A.reshape(-1, 3), coupling.reshape(-1, 3)])
        self._flat = np.zeros(len(self._table))
        self.A = self._flat[: A.shape[0] * 3].reshape(-1, 3)  # NᵀA
        self.coupling = self._flat[A.shape[0] * 3 :]  # NᵀAS of the coupled modes, row by row
        self._is_coupled = motion.is_coupled
        self._acceleration = form.translation.acceleration if form.moves_origin else None
        self._gravity = motion.gravity
        rows = np.vstack([inv.S.T, motion.S1.T, motion.static_unbalance[None, :]])
        # rows · Aᵀ · orientationᵀ · a
        self._rows = np.einsum("rb,abv,ca->rcv", rows, turns, motion.orientation)
        self._loads = np.einsum("rcv,c->rv", self._rows, motion.gravity)
        self._body = np.zeros(len(rows))  # Sᵀa, S*ᵀa and (mχ*)ᵀa
        self.modal, self.by_deflection = self._body[: inv.size], self._body[inv.size : -1]

    @property
    def torque(self) -> float:
        """On the undeformed rotor's static unbalance, about the axis."""
        return self._body[-1]

    def turn(self, t: float, theta: float) -> None:
        """Evaluate everything at an angle, and at a time where the frame is accelerated."""
        self._angles[1], self._angles[2] = math.cos(theta), math.sin(theta)
        if self._is_coupled:
            np.dot(self._table, self._angles, out=self._flat)
        if self.has_body_force:
            if self._acceleration is not None:
                body = self._gravity - np.asarray(self._acceleration(t), dtype=float)
                self._loads = np.einsum("rcv,c->rv", self._rows, body)
            np.dot(self._loads, self._angles, out=self._body)

    def slope(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Return the derivatives of modal, by_deflection and torque by the angle."""
        _, cosine, sine = self._angles
        slopes = self._loads.dot((0.0, -sine, cosine))
        return slopes[: self._count], slopes[self._count : -1], slopes[-1]
