"""A film whose voids remember, as linear equations with a few states.

Moved by small x exp(st) from rest, a film that conserves mass has the force −Z(s) x on its journal,

    Z(s) = K + s C + G(s),   G(s) = C_v (s I − A_v)⁻¹ B_v,                                  (1)

A_v with one state for every empty cell: what left the film with the journal's motion comes back to
it late. K and C are those of a motion so fast that nothing comes back in time. Balanced truncation
keeps the states that matter, of those that are driven and felt most at whirls of the speed's order:
Gramians with the weight ``1/(1 + (ν/Ω)²)²`` on the motion, by the values of Z alone at iν (I. V.
Gosea, S. Gugercin, C. Beattie, *Data-driven balancing of linear dynamical systems*, SIAM J. Sci.
Comput. 44, 2022; weights: D. F. Enns, *Model reduction with balanced realizations*, CDC 1984).

Coordinates q are every other state η of a Schur form, q = T η, in units of the speed: so q and
``q̇ = T A η + T B x`` tell all states, ``η = S⁻¹ (q, q̇ − T B x)`` with S of the rows T and T A, and

    q̈ = T A² η + T A B x + T B ẋ.                                                         (2)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

COUNT = 6  # coordinates
_SAMPLES = 32  # frequencies on each side of the Gramians
_FAST = 1e6  # of the speed, where nothing comes back in time
_NOTHING = 1e-7  # of Z: states of rounding
_LOOKED_AT, MOST_ERROR = 2.0, 1e-2  # whirl ratio up to which (1) is held to that share of Z
_IDLE = 3.0  # of the speed: decay of states that are not needed

Transfer = Callable[[complex], np.ndarray]


@dataclass(frozen=True, eq=False)
class VoidStates:
    """Equations ``M p̈ + D ṗ + K p = 0`` of ports p: the journal along n1 and n2, then q.

    Attributes
    ----------
    damping, stiffness : numpy.ndarray, (2 + COUNT, 2 + COUNT)
        [N s/m], [N/m]; the rows of q for the inertia of 1 kg.
    error : float
        Largest error of Z relative to it, up to twice the speed.
    """

    damping: np.ndarray
    stiffness: np.ndarray
    error: float

    @classmethod
    def of(cls, transfer: Transfer, fast_damping: np.ndarray, speed: float) -> VoidStates:
        """Return the equations of a film with Z(s) and C, at a speed [rad/s].

        Raises
        ------
        ArithmeticError
            If so few states do not tell Z to 1 % up to twice the speed.
        """
        unit = abs(speed)
        at_once = [transfer(s * unit) - s * unit * fast_damping for s in (_FAST, 2.0 * _FAST)]
        fast = 2.0 * at_once[1] - at_once[0], fast_damping
        # ν = Ω tan(θ/2) with even steps of θ; both sides take every other one
        nu = unit * np.tan((np.arange(2 * _SAMPLES) + 0.5) * np.pi / (4 * _SAMPLES))
        Z = np.array([transfer(1j * v) for v in nu])
        late = Z - fast[0] - 1j * nu[:, None, None] * fast[1]
        size = np.linalg.norm(Z, 2, axis=(1, 2))
        count = 2 * COUNT
        while True:
            states = _balanced(nu / unit, late, count, _NOTHING * size.min())
            if np.all(np.linalg.eigvals(states[0]).real < 0.0):
                break
            count -= 2
        made = _second_order(*_paired(*states), fast, unit)
        looked_at = nu <= _LOOKED_AT * unit
        found = np.array([_impedance(*made, 1j * v) for v in nu[looked_at]])
        error = np.linalg.norm(found - Z[looked_at], 2, axis=(1, 2)) / size[looked_at]
        if error.max() > MOST_ERROR:
            raise ArithmeticError(
                f"film: {2 * COUNT} states do not tell what its voids remember at {speed:g} rad/s: "
                f"the force errs by {error.max():.1%}; give fewer nodes around the circle"
            )
        return cls(*made, float(error.max()))

    def matrices(self, mass: float) -> tuple[np.ndarray, np.ndarray]:
        """Return damping and stiffness where every q has an inertia [kg].

        With q of such a length that film and journal feel each other alike.
        """
        driven = mass * np.linalg.norm(self.stiffness[2:, :2], axis=1)
        felt = np.linalg.norm(self.stiffness[:2, 2:], axis=0)
        needed = (driven > 0.0) & (felt > 0.0)
        longer = np.sqrt(np.where(needed, driven, 1.0) / np.where(needed, felt, 1.0))
        columns, rows = np.r_[1.0, 1.0, longer], np.r_[1.0, 1.0, mass / longer][:, None]
        return rows * self.damping * columns, rows * self.stiffness * columns


def _balanced(
    nu: np.ndarray, late: np.ndarray, count: int, nothing: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return A, B, C of `count` states, or fewer, for values (n, 2, 2) at iν; Ω is 1.

    The weighed states ``(iζ − A)⁻¹B`` and ``C(iω − A)⁻¹`` are not at hand, but their products are:
    ``C(iω − A)⁻¹(iζ − A)⁻¹B = −(G(iω) − G(iζ))/(iω − iζ)``, and with A between them likewise.
    """
    both = _real(len(nu) // 2)
    weight = np.sqrt((1.0 + nu**2) / (2.0 * len(nu)))  # of ∫ dν/2π over θ
    left, right = (np.r_[1j * nu[side::2], -1j * nu[side::2]] for side in (0, 1))
    felt, driven = (
        np.concatenate([values, values.conj()])
        for values in (weight[side::2, None, None] * late[side::2] for side in (0, 1))
    )
    w_left, w_right = (np.tile(weight[side::2], 2)[:, None, None] for side in (0, 1))
    w_cut = 1.0 / (1.0 + np.abs(right[:, None, None]) ** 2) ** 2
    driven, w_right = w_cut * driven, w_cut * w_right
    apart = (left[:, None] - right)[..., None, None]
    ahead, behind = felt[:, None] * w_right, w_left[:, None] * driven
    pairs = -(ahead - behind) / apart
    between = -(left[:, None, None, None] * ahead - right[:, None, None] * behind) / apart
    size = 2 * len(left)
    L, A = (
        (both @ X.transpose(0, 2, 1, 3).reshape(size, size) @ both.conj().T).real
        for X in (pairs, between)
    )
    B = (both @ felt.reshape(size, 2)).real
    C = (driven.transpose(1, 0, 2).reshape(2, size) @ both.conj().T).real
    U, sizes, Vt = la.svd(L)
    kept = slice(0, min(count, int(np.sum(sizes > nothing))))
    root = np.sqrt(sizes[kept])
    U, V = U[:, kept] / root, Vt[kept].T / root
    return U.T @ A @ V, U.T @ B, C @ V


def _real(count: int) -> np.ndarray:
    """Return the unitary matrix that makes pairs of values, then their conjugates, real."""
    one = np.array([[1.0, 1.0], [-1j, 1j]]) / np.sqrt(2.0)
    return np.kron(np.kron(one, np.eye(count)), np.eye(2))


def _paired(
    A: np.ndarray, B: np.ndarray, C: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return A, B, C with 2 COUNT states and T; those side by side belong together.

    First come states that are not needed, which decay and which nothing drives, then those of real
    poles, then pairs.
    """
    if len(A):
        A, turn, still = la.schur(A, sort=lambda real, imaginary: imaginary == 0.0)
        B, C = turn.T @ B, C @ turn
    else:
        still = 0
    missing = 2 * COUNT - len(A)
    idle = np.diag(-_IDLE * (1.0 + np.arange(missing) / (2.0 * COUNT)))
    A, B, C = (
        la.block_diag(idle, A),
        np.pad(B, ((missing, 0), (0, 0))),
        np.pad(C, ((0, 0), (missing, 0))),
    )
    T = np.kron(np.eye(COUNT), [1.0, 0.0])
    for row in range((missing + still) // 2):
        # of two real poles the share of each that tells them apart best
        one, other = 2 * row, 2 * row + 1
        beside, apart = A[one, other], A[other, other] - A[one, one]
        angle = 0.5 * np.arctan2(np.copysign(1.0, beside) * apart, abs(beside))
        T[row, [one, other]] = np.cos(angle), np.sin(angle)
    sense = np.copysign(1.0, (T @ B)[:, :1])
    return A, B, C, sense * T


def _second_order(
    A: np.ndarray,
    B: np.ndarray,
    C: np.ndarray,
    T: np.ndarray,
    fast: tuple[np.ndarray, np.ndarray],
    unit: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return damping and stiffness of :class:`VoidStates` by Eq. (2)."""
    K, D = (np.pad(X, (0, COUNT)).astype(float) for X in fast)
    inverse = np.linalg.inv(np.vstack([T, T @ A]))
    (slow, rate), (by_place, by_rate) = (np.split(X @ inverse, 2, axis=1) for X in (C, T @ A @ A))
    driven = T @ B
    K[:2, :2] -= rate @ driven
    K[:2, 2:], D[:2, 2:] = slow, rate / unit
    K[2:, :2], D[2:, :2] = unit**2 * (by_rate @ driven - T @ A @ B), -unit * driven
    K[2:, 2:], D[2:, 2:] = -(unit**2) * by_place, -unit * by_rate
    return D, K


def _impedance(damping: np.ndarray, stiffness: np.ndarray, s: complex) -> np.ndarray:
    """Return Z(s) of :class:`VoidStates`, (2, 2)."""
    X = stiffness + s * damping
    X[2:, 2:] += s**2 * np.eye(COUNT)
    return X[:2, :2] - X[:2, 2:] @ np.linalg.solve(X[2:, 2:], X[2:, :2])
