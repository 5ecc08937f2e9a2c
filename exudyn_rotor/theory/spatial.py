"""The floating frame in three dimensions, Sect. 2.1 of the paper: the reference of the others.

Here the rotation is any, with parameters θ whose local angular velocity is ``ω = G θ̇``. Invariants
are formed as the paper prints them, with 3n × 3m tilde bases, and products as Kronecker's: plain to
read, not fast, and not used by scenes. Contracted with a fixed axis they are the blocks of
:mod:`exudyn_rotor.theory.terms`; with a prescribed ω(t) the equations are linear, (103) and (107).

Equation numbers: Zwölfer, Rasmussen, Santos, SSRN 4830498.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import skew, tilde, tilde_basis, translations
from exudyn_rotor.theory.terms import Term, Terms

Matrix = np.ndarray | sp.csr_array


@dataclass(frozen=True, eq=False)
class SpatialInvariants:
    """Invariants of the floating frame in three dimensions (31–40), in a basis of m columns.

    They are dense for component modes and sparse for the full model (Ψ = I); :meth:`of` makes them.

    Attributes
    ----------
    mass : float
        m (31) [kg].
    chi_tilde : ndarray, shape (3, 3)
        ``χ̃_u = Φᵀ M x̃ / m`` (32) [m].
    Theta : ndarray, shape (3, 3)
        ``Θ_u = x̃ᵀ M x̃`` (33), tensor of inertia about the frame origin [kg m²].
    M, K, D : shape (m, m)
        ``ΨᵀMΨ, ΨᵀKΨ, ΨᵀDΨ`` (34, 19, 20).
    M_tilde : shape (3m, m)
        ``M_ψ̃ψ = Ψ̃ᵀMΨ`` (35).
    M_tilde_tilde : shape (3m, 3m)
        ``M_ψ̃ψ̃ = Ψ̃ᵀMΨ̃`` (36).
    S : shape (3, m)
        ``M_φψ = ΦᵀMΨ`` (37).
    S_tilde : shape (3, 3m)
        ``M_φψ̃ = ΦᵀMΨ̃`` (38).
    X : shape (3, m)
        ``M_x̃ψ = x̃ᵀMΨ`` (39).
    X_tilde : shape (3, 3m)
        ``M_x̃ψ̃ = x̃ᵀMΨ̃`` (40).

    Examples
    --------
    A unit mass at x = 2 that can move in its three directions:

    >>> import numpy as np
    >>> from exudyn_rotor.theory.spatial import SpatialInvariants
    >>> unit = np.eye(3)
    >>> point = SpatialInvariants.of([[2.0, 0, 0]], unit, 9.0 * unit, None, unit)
    >>> print(point.terms()["Θ_u"].value)
    [[0. 0. 0.]
     [0. 4. 0.]
     [0. 0. 4.]]
    """

    mass: float
    chi_tilde: np.ndarray
    Theta: np.ndarray
    M: Matrix
    K: Matrix
    D: Matrix
    M_tilde: Matrix
    M_tilde_tilde: Matrix
    S: Matrix
    S_tilde: Matrix
    X: Matrix
    X_tilde: Matrix

    @classmethod
    def of(
        cls,
        nodes: ArrayLike,
        mass: Matrix,
        stiffness: Matrix,
        damping: Matrix | None,
        basis: Matrix,
    ) -> SpatialInvariants:
        """Compute the invariants from nodes (n, 3), FE matrices and a basis Ψ (3n, m).

        A sparse basis gives sparse invariants. The origin is that of `nodes`.

        Raises
        ------
        TypeError, ValueError
            If shapes do not fit or an entry is not finite.
        """
        nodes = checks.array(nodes, "nodes", "m", shape=(None, 3))
        shape = (nodes.size, nodes.size)
        M = checks.matrix(mass, "mass", "kg", shape=shape)
        K = checks.matrix(stiffness, "stiffness", "N/m", shape=shape)
        psi = checks.matrix(basis, "basis", shape=(nodes.size, None))
        D = sp.csr_array(shape)
        if damping is not None:
            D = checks.matrix(damping, "damping", "N s/m", shape=shape)
        phi, x_tilde = translations(len(nodes)), tilde(nodes)
        psi_tilde = tilde_basis(psi)
        total = float(np.trace(phi.T @ (M @ phi)) / 3.0)
        return cls(
            mass=total,
            chi_tilde=phi.T @ (M @ x_tilde) / total,
            Theta=x_tilde.T @ (M @ x_tilde),
            M=psi.T @ (M @ psi),
            K=psi.T @ (K @ psi),
            D=psi.T @ (D @ psi),
            M_tilde=psi_tilde.T @ (M @ psi),
            M_tilde_tilde=psi_tilde.T @ (M @ psi_tilde),
            S=phi.T @ (M @ psi),
            S_tilde=phi.T @ (M @ psi_tilde),
            X=x_tilde.T @ (M @ psi),
            X_tilde=x_tilde.T @ (M @ psi_tilde),
        )

    @property
    def size(self) -> int:
        """Number of columns m."""
        return self.M.shape[0]

    def terms(self) -> Terms:
        """Return the invariants by their numbers."""
        return Terms(
            [
                Term("mI", "31", self.mass * np.eye(3), "ΦᵀMΦ"),
                Term("χ̃_u", "32", self.chi_tilde, "ΦᵀMx̃ / m"),
                Term("Θ_u", "33", self.Theta, "x̃ᵀMx̃"),
                Term("M_ψψ", "34", self.M, "ΨᵀMΨ"),
                Term("K_ψψ", "19", self.K, "ΨᵀKΨ"),
                Term("D_ψψ", "20", self.D, "ΨᵀDΨ"),
                Term("M_ψ̃ψ", "35", self.M_tilde, "Ψ̃ᵀMΨ"),
                Term("M_ψ̃ψ̃", "36", self.M_tilde_tilde, "Ψ̃ᵀMΨ̃"),
                Term("M_φψ", "37", self.S, "ΦᵀMΨ"),
                Term("M_φψ̃", "38", self.S_tilde, "ΦᵀMΨ̃"),
                Term("M_x̃ψ", "39", self.X, "x̃ᵀMΨ"),
                Term("M_x̃ψ̃", "40", self.X_tilde, "x̃ᵀMΨ̃"),
            ]
        )

    def mass_terms(self, A: ArrayLike, G: ArrayLike, zeta: ArrayLike) -> Terms:
        """Return the blocks of the mass matrix (41–46).

        Parameters
        ----------
        A : array_like, shape (3, 3)
            Rotation, frame → inertial axes.
        G : array_like, shape (3, r)
            Local angular velocity by the rates of the r rotation parameters; the unit matrix gives
            the blocks for the angular velocity itself (51).
        zeta : array_like, shape (m,)
            Modal coordinates.
        """
        A, G = checks.rotation(A, "A"), checks.array(G, "G", shape=(3, None))
        spread = _spread(checks.vector(zeta, "zeta", size=self.size))
        shift, inertia = self._shift(spread), self._inertia(spread)
        return Terms(
            [
                Term("M_tt", "41", self.mass * np.eye(3), "translation"),
                Term("M_ff", "42", self.M, "modal coordinates"),
                Term("M_tf", "43", A @ self.S, "A M_φψ"),
                Term("M_tr", "44", -A @ shift @ G, "−A (mχ̃_u + M_φψ̃ (ζ⊗I)) G"),
                Term("M_rf", "45", -G.T @ (self.X + spread.T @ self.M_tilde), "rotation, modes"),
                Term("M_rr", "46", G.T @ inertia @ G, "rotation"),
            ]
        )

    def velocity_terms(
        self,
        A: ArrayLike,
        G: ArrayLike,
        omega: ArrayLike,
        zeta: ArrayLike,
        zeta_t: ArrayLike,
        remainder: ArrayLike = (0.0, 0.0, 0.0),
    ) -> Terms:
        """Return the quadratic velocity vector, pseudo forces (47–49).

        Parameters
        ----------
        A, G : array_like
            As in :meth:`mass_terms`.
        omega : array_like, shape (3,)
            Angular velocity ``G θ̇``, frame axes [rad/s].
        zeta, zeta_t : array_like, shape (m,)
            Modal coordinates and their rates.
        remainder : array_like, shape (3,)
            ``Ġ θ̇`` [rad/s²], zero for Euler parameters.
        """
        A, G = checks.rotation(A, "A"), checks.array(G, "G", shape=(3, None))
        w = checks.vector(omega, "omega", "rad/s")
        rest = checks.vector(remainder, "remainder", "rad/s²")
        spread = _spread(checks.vector(zeta, "zeta", size=self.size))
        rate = _spread(checks.vector(zeta_t, "zeta_t", size=self.size))
        shift, inertia = self._shift(spread), self._inertia(spread)
        translation = skew(w) @ shift @ w + 2.0 * self.S_tilde @ rate @ w + shift @ rest
        inertia_t = (self.X_tilde + spread.T @ self.M_tilde_tilde) @ rate
        rotation = skew(w) @ inertia @ w + 2.0 * inertia_t @ w + inertia @ rest
        centrifugal = (self.X_tilde.T + self.M_tilde_tilde @ spread) @ w
        modes = _along(w, self.size).T @ centrifugal + 2.0 * self.M_tilde.T @ (rate @ w)
        modes = modes + (self.X.T + self.M_tilde.T @ spread) @ rest
        return Terms(
            [
                Term("Q_t", "47", A @ translation, "translation"),
                Term("Q_r", "48", -G.T @ rotation, "rotation"),
                Term("Q_f", "49", modes, "modal coordinates"),
            ]
        )

    def linear_terms(
        self,
        omega: ArrayLike,
        omega_t: ArrayLike = (0.0, 0.0, 0.0),
        acceleration: ArrayLike = (0.0, 0.0, 0.0),
    ) -> Terms:
        """Return the matrices of a frame whose ω(t) and τ(t) are prescribed (107).

        ``M_ψψ ζ̈ + D(ω) ζ̇ + K(ω) ζ = f_ψ + f(ω)``; with a sparse basis Ψ = I, (103).

        Parameters
        ----------
        omega, omega_t : array_like, shape (3,)
            Angular velocity [rad/s] and its rate [rad/s²], frame axes.
        acceleration : array_like, shape (3,)
            ``Aᵀτ̈``, acceleration of the frame origin in frame axes [m/s²].
        """
        w = checks.vector(omega, "omega", "rad/s")
        w_t = checks.vector(omega_t, "omega_t", "rad/s²")
        shake = checks.vector(acceleration, "acceleration", "m/s²")
        along, along_t = _along(w, self.size), _along(w_t, self.size)
        damping = self.D - 2.0 * (self.M_tilde.T @ along)
        stiffness = self.K - self.M_tilde.T @ along_t - along.T @ (self.M_tilde_tilde @ along)
        load = self.X.T @ w_t + along.T @ (self.X_tilde.T @ w) - self.S.T @ shake
        numbers = "103, 107" if sp.issparse(self.M) else "107"
        return Terms(
            [
                Term("M_ψψ", numbers, self.M, "mass matrix"),
                Term("D(ω)", numbers, damping, "damping and Coriolis forces"),
                Term("K(ω)", numbers, stiffness, "elastic, Euler and centrifugal forces"),
                Term("f(ω)", numbers, load, "centrifugal, Euler and body force"),
            ]
        )

    def contracted(
        self, direction: ArrayLike, speed: float, zeta: ArrayLike, zeta_t: ArrayLike
    ) -> Terms:
        """Return the blocks for a fixed axis, ``ω = ϑ̇ e``, unprojected as in (67–83).

        Parameters
        ----------
        direction : array_like, shape (3,)
            Unit spin axis e.
        speed : float
            ϑ̇ [rad/s].
        zeta, zeta_t : array_like, shape (m,)
            Modal coordinates and their rates.
        """
        e = SpinAxis(direction).direction
        turn, along = skew(e), _along(e, self.size)
        speed = checks.number(speed, "speed", "rad/s")
        zeta = checks.vector(zeta, "zeta", size=self.size)
        zeta_t = checks.vector(zeta_t, "zeta_t", size=self.size)
        chi = np.array([self.chi_tilde[2, 1], self.chi_tilde[0, 2], self.chi_tilde[1, 0]])
        place, rate = along @ zeta, along @ zeta_t
        centrifugal = self.X_tilde.T @ e + self.M_tilde_tilde @ place
        inertia = e @ self.Theta @ e + 2.0 * e @ (self.X_tilde @ place)
        modes = along.T @ centrifugal * speed**2 + 2.0 * speed * (self.M_tilde.T @ rate)
        return Terms(
            [
                Term("χ*", "67", turn @ chi, "ẽχ"),
                Term("χ**", "68", turn @ turn @ chi, "ẽẽχ"),
                Term("M*_φψ", "69", turn @ self.S, "ẽM_φψ"),
                Term("M**_φψ", "70", turn @ turn @ self.S, "ẽẽM_φψ"),
                Term("M_θζ", "74", -(e @ self.X) - self.M_tilde.T @ place, "spin, modes"),
                Term("M_θθ", "75", inertia + place @ (self.M_tilde_tilde @ place), "spin"),
                Term("Q_θ", "76", -2.0 * speed * (centrifugal @ rate), "spin"),
                Term("Q_ζ", "77", modes, "modal coordinates"),
                Term("Θ*_u", "79", e @ self.Theta @ e, "eᵀΘ_u e"),
                Term("M*_ψ̃ψ", "80", along.T @ self.M_tilde, "(I⊗e)ᵀM_ψ̃ψ"),
                Term("M*_ψ̃ψ̃", "81", along.T @ self.M_tilde_tilde @ along, "(I⊗e)ᵀM_ψ̃ψ̃(I⊗e)"),
                Term("M*_x̃ψ", "82", e @ self.X, "eᵀM_x̃ψ"),
                Term("M*_x̃ψ̃", "83", along.T @ (self.X_tilde.T @ e), "eᵀM_x̃ψ̃(I⊗e)"),
            ]
        )

    def _shift(self, spread: np.ndarray) -> np.ndarray:
        """``mχ̃_u + M_φψ̃ (ζ⊗I)``, shape (3, 3)."""
        return self.mass * self.chi_tilde + self.S_tilde @ spread

    def _inertia(self, spread: np.ndarray) -> np.ndarray:
        """Tensor of inertia of the deformed rotor, the bracket of (46)."""
        mixed = self.X_tilde @ spread
        return self.Theta + mixed + mixed.T + spread.T @ (self.M_tilde_tilde @ spread)


def _spread(zeta: np.ndarray) -> np.ndarray:
    """``ζ ⊗ I``, shape (3m, 3): with Ψ̃ it gives c̃_f (29)."""
    return np.kron(zeta[:, None], np.eye(3))


def _along(omega: np.ndarray, size: int) -> sp.csr_array:
    """``I_ζ ⊗ ω``, shape (3m, m), of (28) and (78)."""
    return sp.csr_array(sp.kron(sp.eye_array(size), omega[:, None]))
