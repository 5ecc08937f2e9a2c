"""Inertia invariants of a rotor in one basis: everything the formulations need, computed once.

With a single fixed axis only products with ``ẽ`` occur, so the 3n × 3m tilde bases of the 3D
theory (30, 35–40) are never formed. Centre of mass, moment of inertia and the mode moments follow
from three small arrays (J, S, P), which also move to another origin in closed form.

Equation numbers: Zwölfer, Rasmussen, Santos, SSRN 4830498.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.theory.axis import skew, translations, turned

Matrix = np.ndarray | sp.csr_array

_OPTIONAL = ("K2", "K4", "K2_estimated", "H", "K0")
_UNIT = 1e-9  # a direction may differ from unit length by this much
EPSILON = np.array([skew(unit) for unit in np.eye(3)])  # ε_aik of (a × b)_i = ε_aik a_a b_k


@dataclass(frozen=True, eq=False)
class Invariants:
    """Inertia, stiffness and damping of a rotor in a basis Ψ of k displacement columns.

    All arrays are read-only and refer to rotor-fixed axes; the matrices of size k are dense for
    component modes and sparse for the full model (Ψ = I).

    Attributes
    ----------
    direction : ndarray, shape (3,)
        Unit spin axis ``e``.
    mass : float
        Total mass m (31) [kg].
    center : ndarray, shape (3,)
        Centre of mass ``χ`` from the origin (32) [m].
    J : ndarray, shape (3, 3)
        Second moments of mass ``Σ M x xᵀ`` about the origin [kg m²].
    S : ndarray, shape (3, k)
        ``ΦᵀMΨ`` (37).
    P : ndarray, shape (3, 3, k)
        Mixed moments ``Σ M x ψᵀ`` about the origin; (39) and (40) contracted with e follow.
    M, K, D : shape (k, k)
        ``ΨᵀMΨ, ΨᵀKΨ, ΨᵀDΨ`` (34, 19, 20).
    G : shape (k, k)
        ``M*_ψ̃ψ = ΨᵀMẽ_bdΨ`` (80), skew-symmetric.
    C : shape (k, k)
        ``M*_ψ̃ψ̃ = (ẽ_bdΨ)ᵀM(ẽ_bdΨ)`` (81), symmetric and non-negative.
    K2 : shape (k, k), optional
        Stiffness per ω² of a static prestress, see
        :class:`exudyn_rotor.theory.stiffening.Stiffening`; None where none was computed.
    K4 : shape (k, k), optional
        Stiffness per ω⁴ of a static displacement, as there.
    K2_estimated : shape (k, k), optional
        Rough K2 where none was computed, see :mod:`exudyn_rotor.prestress.carrying`. It is in no
        equation.
    H : shape (k, k), optional
        Structural damping: a motion ``e^{iνt}`` in the rotor frame has the stiffness
        ``K + i sign(ν) H``. Only analyses in the frequency domain can use it.
    K0 : shape (k, k), optional
        Geometric stiffness of given static loads, which adds to K: see :attr:`loaded`.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, an entry is not finite, the mass is not positive or M not positive
        definite, the direction is no unit vector, M, K, C, J or a matrix that is given of K2,
        K4, K2_estimated, H and K0 is not symmetric, or G not skew-symmetric. Sparse matrices are
        taken as they come from a solid rotor, which has checked them: of them only shape and
        entries are looked at.

    Examples
    --------
    A unit mass at x = 2 that can move in its three directions:

    >>> import numpy as np
    >>> from exudyn_rotor import Invariants
    >>> unit = np.eye(3)
    >>> point = Invariants.of([[2.0, 0, 0]], unit, 9.0 * unit, None, unit, [0, 0, 1])
    >>> point.mass, point.Theta
    (1.0, 4.0)
    >>> print(point.h, point.moved([1, 0, 0]).h)
    [2. 0. 0.] [1. 0. 0.]
    """

    direction: np.ndarray
    mass: float
    center: np.ndarray
    J: np.ndarray
    S: np.ndarray
    P: np.ndarray
    M: Matrix
    K: Matrix
    D: Matrix
    G: Matrix
    C: Matrix
    K2: Matrix | None = None
    K4: Matrix | None = None
    K2_estimated: Matrix | None = None
    H: Matrix | None = None
    K0: Matrix | None = None

    __repr__ = checks.Checked.__repr__  # arrays by their shapes

    def __post_init__(self) -> None:
        direction = checks.vector(self.direction, "direction")
        if abs(np.linalg.norm(direction) - 1.0) > _UNIT:
            raise ValueError(f"direction: needs a unit vector, got {checks.shown(direction)}")
        S = checks.array(self.S, "S", "kg", shape=(3, None))
        size = S.shape[1]
        checked = {
            "direction": direction,
            "mass": checks.number(self.mass, "mass", "kg", above=0.0),
            "center": checks.vector(self.center, "center", "m"),
            "J": checks.symmetric(checks.array(self.J, "J"), "J", "kg m²", size=3),
            "S": S,
            "P": checks.array(self.P, "P", "kg m", shape=(3, 3, size)),
            "D": checks.matrix(self.D, "D", shape=(size, size)),
            "G": checks.symmetric(self.G, "G", size=size, sign=-1),
        }
        for name in ("M", "K", "C", *_OPTIONAL):
            matrix = getattr(self, name)
            if matrix is not None or name in "MKC":
                checked[name] = checks.symmetric(matrix, name, size=size)
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        if not self.is_sparse:
            _check_definite(self.M)

    @classmethod
    def of(
        cls,
        nodes: np.ndarray,
        mass: sp.csr_array,
        stiffness: sp.csr_array | None,
        damping: sp.csr_array | None,
        basis: Matrix,
        direction: np.ndarray,
        momenta: np.ndarray | None = None,
    ) -> Invariants:
        """Compute the invariants from nodes (n, 3), FE matrices and a basis (3n, k).

        The basis is a dense array of component modes or a sparse matrix; the identity gives the
        full formulations. The origin is that of `nodes`. A stiffness or damping of None is zero.
        `momenta` are ``MΨ``, if they are known.

        Raises
        ------
        TypeError, ValueError
            If shapes do not fit, an entry is not finite, a dense matrix is not symmetric, or the
            columns of the basis depend on each other.
        """
        nodes = checks.array(nodes, "nodes", "m", shape=(None, 3))
        mass = checks.symmetric(mass, "mass", "kg", size=nodes.size)
        basis = checks.matrix(basis, "basis", shape=(nodes.size, None))
        direction = checks.vector(direction, "direction")
        if stiffness is not None:
            stiffness = checks.symmetric(stiffness, "stiffness", "N/m", size=nodes.size)
        if damping is not None:
            damping = checks.matrix(damping, "damping", "N s/m", shape=mass.shape)
        scalar_mass = mass[::3, ::3]
        mass_x = scalar_mass @ nodes
        if momenta is None:
            momenta = mass @ basis
        else:
            momenta = checks.array(momenta, "momenta", shape=basis.shape)
        tilted = turned(direction, basis)
        total = float(scalar_mass.sum())
        return cls(
            direction=direction,
            mass=total,
            center=mass_x.sum(axis=0) / total,
            J=nodes.T @ mass_x,
            S=translations(len(nodes)).T @ momenta,
            P=np.stack([mass_x.T @ basis[b::3] for b in range(3)], axis=1),
            M=_mean(basis.T @ momenta),
            K=_mean(_projected(stiffness, basis)),
            D=_projected(damping, basis),
            G=_mean(momenta.T @ tilted, -1),
            C=_mean(tilted.T @ turned(direction, momenta)),  # Mẽ = ẽM, as (24) says
        )

    @property
    def size(self) -> int:
        """Number of columns k."""
        return self.S.shape[1]

    @property
    def is_sparse(self) -> bool:
        """True for the full model, whose matrices are sparse."""
        return sp.issparse(self.M)

    @cached_property
    def _across(self) -> np.ndarray:
        """Projector onto the plane of rotation, ``−ẽẽ = I − eeᵀ``."""
        return np.eye(3) - np.outer(self.direction, self.direction)

    @cached_property
    def Theta(self) -> float:
        """Moment of inertia about the axis, ``Θ*_u`` (79) [kg m²]."""
        return float(np.sum(self._across * self.J))

    @cached_property
    def g(self) -> np.ndarray:
        """``−M*_x̃ψ = ΨᵀM X_e`` (82), shape (k,): zero in a Tisserand frame."""
        return checks.read_only(np.einsum("ba,abk->k", skew(self.direction), self.P))

    @cached_property
    def h(self) -> np.ndarray:
        """``M*_x̃ψ̃ = Ψ_eᵀM X_e`` (83), shape (k,): centrifugal load per ω²."""
        return checks.read_only(np.einsum("ab,abk->k", self._across, self.P))

    @cached_property
    def mean_rotation(self) -> np.ndarray:
        """Rotation vector of every column in the mean (Tisserand), shape (3, k).

        ``I⁻¹ Σ M y × ψ`` with y from the centre of mass and I the tensor of inertia about it. What
        has no inertia does not turn.
        """
        _, P = moments_about(self, self.center)
        momentum = np.einsum("aib,abk->ik", EPSILON, P)
        return checks.read_only(inverse_inertia(self) @ momentum)

    def moved(self, origin: np.ndarray) -> Invariants:
        """Return the invariants about another origin, given from the present one [m]."""
        shift = checks.vector(origin, "origin", "m")
        J, P = moments_about(self, shift)
        return replace(self, center=self.center - shift, J=J, P=P)

    @property
    def loaded(self) -> Invariants:
        """The invariants whose stiffness K holds that of given static loads."""
        return self if self.K0 is None else replace(self, K=self.K + self.K0, K0=None)

    def in_basis(self, T: np.ndarray) -> Invariants:
        """Return the invariants for the basis ``Ψ T``, T of shape (k, l)."""
        T = checks.matrix(T, "T", shape=(self.size, None))
        projected = {"D": T.T @ (self.D @ T), "G": _mean(T.T @ (self.G @ T), -1)}
        for name in ("M", "K", "C", *_OPTIONAL):
            if getattr(self, name) is not None:
                projected[name] = _mean(T.T @ (getattr(self, name) @ T))
        return replace(self, S=self.S @ T, P=self.P @ T, **projected)


def inertia_tensor(invariants: Invariants) -> np.ndarray:
    """Return the tensor of inertia about the centre of mass, shape (3, 3) [kg m²]."""
    J = invariants.J - invariants.mass * np.outer(invariants.center, invariants.center)
    return np.trace(J) * np.eye(3) - J


def inverse_inertia(invariants: Invariants) -> np.ndarray:
    """Return the inverse of that tensor (3, 3), zero about axes without inertia."""
    return np.linalg.pinv(inertia_tensor(invariants), rcond=1e-12, hermitian=True)


def moments_about(invariants: Invariants, shift: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return J and P about another origin, given from the present one [m]."""
    mass, S = invariants.mass, invariants.S
    cross = mass * np.outer(invariants.center, shift)
    J = invariants.J - cross - cross.T + mass * np.outer(shift, shift)
    return J, invariants.P - shift[:, None, None] * S[None, :, :]


def _projected(matrix: sp.csr_array | None, basis: Matrix) -> Matrix:
    """Return ``ΨᵀAΨ``, zero for None."""
    if matrix is not None:
        return basis.T @ (matrix @ basis)
    none = (basis.shape[1], basis.shape[1])
    return sp.csr_array(none) if sp.issparse(basis) else np.zeros(none)


def _mean(matrix: Matrix, sign: int = 1) -> Matrix:
    """Return the (skew-)symmetric part of a dense product, which has rounding beside it."""
    return matrix if sp.issparse(matrix) else 0.5 * (matrix + sign * matrix.T)


def _check_definite(M: np.ndarray) -> None:
    try:
        np.linalg.cholesky(M)
    except np.linalg.LinAlgError as error:
        raise ValueError(
            "M: needs a positive definite mass matrix; columns of the basis depend on each other, "
            "or masses are negative"
        ) from error
