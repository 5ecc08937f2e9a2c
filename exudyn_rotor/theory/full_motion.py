"""The full formulations: all nodal displacements c_f as unknowns, ``Ψ = I`` (58, 94, 100, 104).

A rigid motion that the frame describes must not be in c_f a second time. Component modes leave it
out of their basis; here linear conditions ``R c_f = 0`` do,

    ΦᵀM c_f / m = 0     along the translations that are unknowns,
    eᵀI⁻¹ Σ M y × c_f = 0   where the frame holds the spin,

the mean translation and the mean rotation about the axis, with y from the centre of mass and I the
tensor of inertia about it. There are 4, 3, 1 and 0 of them in Sections 2.2, 2.3, 2.4 and 2.5; one
in 2.5 as well where the rotor's mean rotation follows θ(t). They neither add nor lose a motion, for
``R`` times the frame's own motions is not singular.

Forces ``Rᵀλ`` of the conditions take up every force in the range of ``Rᵀ``. So of S the part along
the conditions is zero here, and g is ``g − α r``, with r the row of the spin and α such that a
rotor in balance has g = 0: the same accelerations, other λ.

Equation numbers: Zwölfer, Rasmussen, Santos, SSRN 4830498.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.invariants import Invariants, inverse_inertia
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.stiffening import Stiffening, work_factors

_ROUNDING = 1e-13  # of their upper bound: what P leaves of moments that are zero
Factors = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class SumMatrix:
    """A sparse matrix and one of low rank, ``A + VᵀWV``, for products with vectors."""

    sparse: sp.csr_array  # (k, k)
    factors: Factors  # V (r, k) and W (r, r)

    def __matmul__(self, vector: np.ndarray) -> np.ndarray:
        """Return the product with a vector (k,)."""
        V, W = self.factors
        return self.sparse @ vector + V.T @ (W @ (V @ vector))


@dataclass(frozen=True, eq=False)
class FullStiffening:
    """Centrifugal stiffening of a full model."""

    K2: sp.csr_array  # (3n, 3n) Sparse part per ω²
    tilt: Factors  # low-rank parts ``VᵀWV`` per ω² and per ω̇; W is zero where there is none
    euler: Factors
    K4: sp.csr_array | None = None  # stiffness per ω⁴


def full_stiffening(
    invariants: Invariants, level: str, turn: np.ndarray | None = None
) -> FullStiffening:
    """Return the stiffening of a level; the full form of ``theory.stiffening.stiffening``.

    At the level 'full' the sparse invariants have the matrices of a prestress in K2 and K4, and
    `turn` (3,) is the angular acceleration of its inertia relief.
    """
    zero, e = sp.csr_array(invariants.C.shape), skew(invariants.direction)

    def factors(field: np.ndarray, share: float) -> Factors:
        V, W = work_factors(invariants, field)
        return V, share * W

    if level == "full":
        tilt = factors(skew(turn), -1.0)
        return FullStiffening(invariants.K2, tilt, factors(e, 1.0), invariants.K4)
    share = 0.0 if level == "none" else 1.0
    return FullStiffening(zero, factors(-e @ e, -share), factors(e, share))


@dataclass(frozen=True, eq=False)
class Conditions:
    """What keeps the frame's own motions out of the nodal displacements."""

    rows: np.ndarray  # (c, 3n) R in ``R c_f = 0``: mean translations, then the mean rotation
    held: np.ndarray  # (3, 0…3) Directions of the mean translations that are held, rotor axes
    invariants: Invariants  # S and g without what the forces of the conditions take up


def conditions(
    invariants: Invariants, formulation: Formulation, grounded: bool, negligible: float
) -> Conditions:
    """Return the conditions of a formulation, of sparse invariants about the frame's origin.

    There are none where the rotor is `grounded`, held in its frame by its stiffness. Couplings
    below the share `negligible` of their upper bound are taken as zero.
    """
    e = invariants.direction
    held = np.zeros((3, 0))
    if formulation.translation_count == 3:
        held = np.eye(3)
    elif formulation.translation_count == 2:
        held = np.linalg.svd(np.eye(3) - np.outer(e, e))[0][:, :2]
    rows = held.T @ invariants.S / invariants.mass
    S = invariants.S - held @ (held.T @ invariants.S)
    size = np.sqrt(invariants.M.diagonal())
    spread = np.sqrt(np.diag(invariants.J))[:, None, None]
    S = _cut(S, negligible * np.sqrt(invariants.mass) * size)
    center = _cut(invariants.center, negligible * np.linalg.norm(spread) / np.sqrt(invariants.mass))
    P = invariants.P
    turn = e @ invariants.mean_rotation
    if not grounded and np.any(turn) and (formulation.has_spin or formulation.drive == "rigid"):
        rows = np.vstack([rows, turn[None, :]])
        inverse = inverse_inertia(invariants)
        # g = Σ ẽ_ba P_abk; the part of P that is skew about e holds it, h has no share in that
        left = invariants.g - turn / (e @ inverse @ e)
        left = _cut(left, negligible * np.sqrt(2.0 * np.trace(invariants.J)) * size)
        P = P - 0.5 * skew(e).T[:, :, None] * (invariants.g - left)
    return Conditions(rows, held, replace(invariants, S=S, center=center, P=P))


def _cut(values: np.ndarray, bound: np.ndarray | float) -> np.ndarray:
    """Put zeros for all of `values` where each is below its bound."""
    return 0.0 * values if np.all(np.abs(values) <= bound) else values


def principal(V: np.ndarray, W: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return orthonormal rows (r, k) and values (r,) of ``VᵀWV``, without those of rounding.

    Examples
    --------
    >>> rows, values = principal(np.array([[2.0, 0.0], [0.0, 0.0]]), np.eye(2))
    >>> abs(rows), values
    (array([[1., 0.]]), array([4.]))
    """
    Q, R = np.linalg.qr(V.T)
    values, vectors = np.linalg.eigh(R @ W @ R.T)
    kept = np.abs(values) > _ROUNDING * np.abs(values).max(initial=0.0)
    return (Q @ vectors[:, kept]).T, values[kept]


class FullMotion(Motion):
    """Equations of motion in nodal displacements that keep the conditions.

    As :class:`Motion`, whose terms serve it, with matrices for products only where the centrifugal
    stiffening is of low rank. Translations that are unknowns have no coupling: their S is zero.
    """

    def __init__(
        self,
        invariants: Invariants,
        formulation: Formulation,
        second_order: FullStiffening,
        orientation: ArrayLike | None = None,
        plane: ArrayLike | None = None,
        gravity: ArrayLike | None = None,
    ) -> None:
        none = sp.csr_array(second_order.K2.shape)
        sparse = Stiffening(second_order.K2, none, second_order.K4)
        super().__init__(invariants, formulation, sparse, orientation, plane, gravity)
        terms, (V, W), euler = self.spin_terms, second_order.tilt, second_order.euler
        self.second_order, self.sparse_terms = second_order, terms
        self.spin_terms = replace(
            terms,
            C_hat=SumMatrix(terms.C_hat, (V, -W)),
            W=SumMatrix(terms.W, euler),
            B=SumMatrix(terms.B, euler),
        )

    @property
    def is_coupled(self) -> bool:
        """False: the conditions hold the mean translation that the unknowns describe."""
        return False

    @property
    def unbalance_momentum(self) -> np.ndarray:
        """``g`` (82) [kg m]; zero, without rounding, for a rotor in balance."""
        inv = self.invariants
        bound = _ROUNDING * np.sqrt(2.0 * np.trace(inv.J)) * np.sqrt(inv.M.diagonal())
        return _cut(inv.g, bound)

    @property
    def has_varying_inertia(self) -> bool:
        """Whether the mass matrix depends on the displacements."""
        return self.formulation.has_spin and not self.formulation.has_frozen_spin

    @property
    def has_varying_forces(self) -> bool:
        """Whether there are forces beside those of constant matrices."""
        return self.has_body_force or not self.formulation.is_constant_speed

    def constant_matrices(self) -> tuple[sp.csr_array, sp.csr_array, sp.csr_array]:
        """Return mass, damping and stiffness (size, size), with the spin terms of a constant speed.

        Without low-rank stiffening.
        """
        form, inv, terms = self.formulation, self.invariants, self.sparse_terms
        speed = form.spin.speed if form.is_constant_speed else 0.0
        damping, stiffness = inv.D + terms.damping(speed), inv.K + terms.stiffness(speed)
        blocks = {("f", "f"): inv.M}
        if form.translation_count:
            blocks["t", "t"] = inv.mass * np.eye(form.translation_count)
        if form.has_spin:
            blocks["r", "r"] = [[inv.Theta]]
            if np.any(self.unbalance_momentum):
                blocks["r", "f"] = self.unbalance_momentum[None, :]
                blocks["f", "r"] = blocks["r", "f"].T
        empty = sp.csr_array((self.size, self.size))
        of_fields = [self._placed({("f", "f"): matrix}, empty) for matrix in (damping, stiffness)]
        return self._placed(blocks, empty), *of_fields

    def varying_inertia(self, c: np.ndarray) -> tuple[float, np.ndarray]:
        """Return what adds to Θ (85), and ``Wc`` of (84)."""
        terms = self.spin_terms
        return float((2.0 * terms.h + terms.C_hat @ c) @ c), terms.W @ c

    def varying_forces(self, t: float, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
        """Return (86), (87), the accelerations of (108) and App. A without weight, shape (size,).

        The elastic and damping forces are left out, and at constant speed all of (87).
        """
        terms, now = self.spin_terms, self.at(t, q, q_t)
        omega, c, rate = now.omega, now.zeta, now.zeta_t
        force = np.zeros(self.size)
        if not self.formulation.is_constant_speed:
            loads = omega**2 * self._centrifugal(c) - (2.0 * omega) * (terms.G @ rate)
            if now.omega_t:
                loads -= now.omega_t * (terms.g + terms.W @ c)
            if terms.K4 is not None:
                loads -= omega**4 * (terms.K4 @ c)
            force[self.modes] = loads
        if self.has_body_force:
            self._add_body_force(c, self.body_acceleration(t, now.A), force)
        if self.formulation.has_spin:  # (86)
            frozen = self.formulation.has_frozen_spin
            force[self._spin] -= (1.0 if frozen else 2.0) * omega * (self._centrifugal(c) @ rate)
            if not frozen:
                force[self._spin] -= rate @ (terms.B @ rate)
        return force

    def varying_jacobian(
        self, t: float, q: np.ndarray, q_t: np.ndarray, factor_q: float, factor_v: float
    ) -> sp.csr_array:
        """Return ``−factor_q ∂f/∂q − factor_v ∂f/∂q̇`` of :meth:`varying_forces`, for Newton.

        Without what is not sparse and small beside mass and stiffness in a time step: low-rank
        stiffening, and how gravity turns. At constant speed the constant matrices have all of it.
        """
        matrix = sp.csr_array((self.size, self.size))
        terms, sparse, now = self.spin_terms, self.sparse_terms, self.at(t, q, q_t)
        omega = now.omega
        stiffness, damping = sparse.stiffness(omega, now.omega_t), sparse.damping(omega)
        blocks = {("f", "f"): factor_q * stiffness + factor_v * damping}
        if self.formulation.has_spin:
            share = 1.0 if self.formulation.has_frozen_spin else 2.0
            centrifugal = self._centrifugal(now.zeta)
            row = share * omega * (factor_v * centrifugal + factor_q * (terms.C_hat @ now.zeta_t))
            column = 2.0 * factor_v * (terms.G @ now.zeta_t - omega * centrifugal)
            blocks["r", "f"], blocks["f", "r"] = row[None, :], column[:, None]
            blocks["r", "r"] = [[share * factor_v * (centrifugal @ now.zeta_t)]]
        return self._placed(blocks, matrix)

    def _placed(self, blocks: dict, base: sp.csr_array) -> sp.csr_array:
        """Return `base` with the blocks of translations t, spin r and displacements f added."""
        starts = {"t": 0, "r": self.translations.stop, "f": self.modes.start}
        for (row, column), block in blocks.items():
            entries = sp.coo_array(block)
            rows, columns = entries.coords
            place = (rows + starts[row], columns + starts[column])
            base = base + sp.csr_array((entries.data, place), shape=base.shape)
        return base
