"""The floating frame in three dimensions, Sect. 2.1 of the paper: the reference of the others.

Here the rotation is any, with parameters θ whose local angular velocity is ``ω = G θ̇``. Invariants
are formed as the paper prints them, with 3n × 3m tilde bases, and products as Kronecker's: plain to
read, not fast, and not used by scenes. Contracted with a fixed axis they are the blocks of
``Motion.terms``; with a prescribed ω(t) the equations are linear, (103) and (107).

Equation numbers: Zwölfer, Rasmussen, Santos, SSRN 4830498.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.theory.axis import skew, translations
from exudyn_rotor.theory.terms import Term, Terms

Matrix = np.ndarray | sp.csr_array
Vector = np.ndarray


def tilde(nodal: np.ndarray) -> np.ndarray:
    """Return ``x̃`` (3n × 3): the skew matrices of all nodal vectors, stacked (9)."""
    return np.vstack([skew(vector) for vector in np.asarray(nodal, float).reshape(-1, 3)])


def tilde_basis(modes: np.ndarray | sp.csr_array) -> np.ndarray | sp.csr_array:
    """Return ``Ψ̃`` (3n × 3m): the tilde matrix of every mode, side by side (30).

    Sparse where the modes are.
    """
    kron = sp.kron if sp.issparse(modes) else np.kron
    units = np.eye(3)
    whole = sum(kron(modes[axis::3], skew(units[axis])) for axis in range(3))
    return sp.csr_array(whole) if sp.issparse(modes) else whole


class SpatialFrame:
    """Equations of the floating frame in three dimensions, in a basis Ψ (3n, m).

    Blocks are :class:`~exudyn_rotor.theory.terms.Terms`; `invariants` are (31–40), (19), (20).
    In what follows A (3, 3) rotates frame axes into inertial axes, G (3, r) gives the local angular
    velocity by the rates of the r rotation parameters (the unit matrix gives the blocks for the
    angular velocity itself, 51), ζ (m,) are modal coordinates.
    """

    def __init__(
        self, nodes: Vector, mass: Matrix, stiffness: Matrix, damping: Matrix | None, basis: Matrix
    ) -> None:
        M, K, psi = mass, stiffness, basis
        D = sp.csr_array(M.shape) if damping is None else damping
        phi, x_tilde, psi_tilde = translations(len(nodes)), tilde(nodes), tilde_basis(psi)
        total = float(np.trace(phi.T @ (M @ phi)) / 3.0)
        self.size = psi.shape[1]
        self.invariants = Terms(
            [
                Term("mI", "31", total * np.eye(3), "ΦᵀMΦ"),
                Term("χ̃_u", "32", phi.T @ (M @ x_tilde) / total, "ΦᵀMx̃ / m"),
                Term("Θ_u", "33", x_tilde.T @ (M @ x_tilde), "x̃ᵀMx̃"),
                Term("M_ψψ", "34", psi.T @ (M @ psi), "ΨᵀMΨ"),
                Term("K_ψψ", "19", psi.T @ (K @ psi), "ΨᵀKΨ"),
                Term("D_ψψ", "20", psi.T @ (D @ psi), "ΨᵀDΨ"),
                Term("M_ψ̃ψ", "35", psi_tilde.T @ (M @ psi), "Ψ̃ᵀMΨ"),
                Term("M_ψ̃ψ̃", "36", psi_tilde.T @ (M @ psi_tilde), "Ψ̃ᵀMΨ̃"),
                Term("M_φψ", "37", phi.T @ (M @ psi), "ΦᵀMΨ"),
                Term("M_φψ̃", "38", phi.T @ (M @ psi_tilde), "ΦᵀMΨ̃"),
                Term("M_x̃ψ", "39", x_tilde.T @ (M @ psi), "x̃ᵀMΨ"),
                Term("M_x̃ψ̃", "40", x_tilde.T @ (M @ psi_tilde), "x̃ᵀMΨ̃"),
            ]
        )

    def mass_terms(self, A: Matrix, G: Matrix, zeta: Vector) -> Terms:
        """Return the blocks of the mass matrix (41–46)."""
        spread, M_tilde, X = self._spread(zeta), self._at("M_ψ̃ψ"), self._at("M_x̃ψ")
        return Terms(
            [
                Term("M_tt", "41", self._at("mI"), "translation"),
                Term("M_ff", "42", self._at("M_ψψ"), "modal coordinates"),
                Term("M_tf", "43", A @ self._at("M_φψ"), "A M_φψ"),
                Term("M_tr", "44", -A @ self._shift(spread) @ G, "−A (mχ̃_u + M_φψ̃ (ζ⊗I)) G"),
                Term("M_rf", "45", -G.T @ (X + spread.T @ M_tilde), "rotation, modes"),
                Term("M_rr", "46", G.T @ self._inertia(spread) @ G, "rotation"),
            ]
        )

    def velocity_terms(
        self, A: Matrix, G: Matrix, omega: Vector, zeta: Vector, zeta_t: Vector
    ) -> Terms:
        """Return the quadratic velocity vector, pseudo forces (47–49), where ``Ġθ̇`` is zero.

        It is for Euler parameters. `omega` (3,) is the angular velocity ``G θ̇`` in frame axes
        [rad/s].
        """
        spread, rate = self._spread(zeta), self._spread(zeta_t)
        X_tilde, M_tilde, both = (self._at(name) for name in ("M_x̃ψ̃", "M_ψ̃ψ", "M_ψ̃ψ̃"))
        turn = skew(omega)
        translation = turn @ self._shift(spread) @ omega
        translation = translation + 2.0 * self._at("M_φψ̃") @ rate @ omega
        inertia_t = (X_tilde + spread.T @ both) @ rate
        rotation = turn @ self._inertia(spread) @ omega + 2.0 * inertia_t @ omega
        centrifugal = (X_tilde.T + both @ spread) @ omega
        modes = self._along(omega).T @ centrifugal + 2.0 * M_tilde.T @ (rate @ omega)
        return Terms(
            [
                Term("Q_t", "47", A @ translation, "translation"),
                Term("Q_r", "48", -G.T @ rotation, "rotation"),
                Term("Q_f", "49", modes, "modal coordinates"),
            ]
        )

    def linear_terms(self, omega: Vector, omega_t: Vector, acceleration: Vector) -> Terms:
        """Return the matrices of a frame whose ω(t) and τ(t) are prescribed (107).

        ``M_ψψ ζ̈ + D(ω) ζ̇ + K(ω) ζ = f_ψ + f(ω)``; with a sparse basis Ψ = I, (103).

        With `omega` [rad/s] and `omega_t` [rad/s²] in frame axes, and `acceleration` ``Aᵀτ̈`` of the
        frame origin [m/s²].
        """
        along, along_t = self._along(omega), self._along(omega_t)
        M_tilde, both, X = (self._at(name) for name in ("M_ψ̃ψ", "M_ψ̃ψ̃", "M_x̃ψ"))
        damping = self._at("D_ψψ") - 2.0 * (M_tilde.T @ along)
        stiffness = self._at("K_ψψ") - M_tilde.T @ along_t - along.T @ (both @ along)
        load = X.T @ omega_t + along.T @ (self._at("M_x̃ψ̃").T @ omega)
        load = load - self._at("M_φψ").T @ acceleration
        numbers = "103, 107" if sp.issparse(self._at("M_ψψ")) else "107"
        return Terms(
            [
                Term("M_ψψ", numbers, self._at("M_ψψ"), "mass matrix"),
                Term("D(ω)", numbers, damping, "damping and Coriolis forces"),
                Term("K(ω)", numbers, stiffness, "elastic, Euler and centrifugal forces"),
                Term("f(ω)", numbers, load, "centrifugal, Euler and body force"),
            ]
        )

    def _at(self, name: str) -> Matrix:
        return self.invariants[name].value

    def _shift(self, spread: np.ndarray) -> np.ndarray:
        """``mχ̃_u + M_φψ̃ (ζ⊗I)``, shape (3, 3)."""
        return self._at("mI") @ self._at("χ̃_u") + self._at("M_φψ̃") @ spread

    def _inertia(self, spread: np.ndarray) -> np.ndarray:
        """Tensor of inertia of the deformed rotor, the bracket of (46)."""
        mixed = self._at("M_x̃ψ̃") @ spread
        return self._at("Θ_u") + mixed + mixed.T + spread.T @ (self._at("M_ψ̃ψ̃") @ spread)

    def _spread(self, zeta: Vector) -> np.ndarray:
        """``ζ ⊗ I``, shape (3m, 3): with Ψ̃ it gives c̃_f (29)."""
        return np.kron(zeta[:, None], np.eye(3))

    def _along(self, omega: Vector) -> sp.csr_array:
        """``I_ζ ⊗ ω``, shape (3m, m), of (28) and (78)."""
        return sp.csr_array(sp.kron(sp.eye_array(self.size), omega[:, None]))
