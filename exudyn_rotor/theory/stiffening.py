"""Centrifugal stiffening: the work of the centrifugal field on second-order displacements.

The paper's equations (84–87, 103–109) hold the softening ``−ω²C`` only; the level ``'none'`` is
theirs. ``'tilt'`` is exact for the rigid rotations in the basis, from M and x alone: a displacement
is split by mass-orthogonality into translation, rotation φ about the centre of mass and a flexible
rest ψ, whose second-order part is ``u₂ = ½ φ × (φ × y) + φ × ψ`` with y from the centre of mass.
``'full'`` has the geometric stiffness of the static stress, which contains ``'tilt'``, and with an
initial displacement a stiffness per ω⁴. The derivation is in ``docs/theory/stiffening.md``.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.invariants import EPSILON, Invariants, Matrix, moments_about

LEVELS = ("none", "tilt", "full")
CHOICES = ("auto", *LEVELS)
_WORTH_A_WARNING = 0.01  # relative change of a frequency
_FREE = 1e-9  # of the largest stiffness: what rounding leaves of a free motion
NO_PRESTRESS = (
    "stiffening='full' needs the static centrifugal stress: reduce the rotor with prestress=True "
    "(NGSolve model) or with Prestress(matrix, nodes) (imported model), carry it in a full model "
    "with rotor.with_prestress, or use stiffening='tilt'"
)


@dataclass(frozen=True, eq=False)
class Stiffening:
    """Second-order inertia terms in a basis of k columns.

    Attributes
    ----------
    K2 : ndarray, shape (k, k)
        Stiffness per ω² from the centrifugal field; C − K2 replaces C in (85–87).
    B : ndarray, shape (k, k)
        Symmetric matrix of the Euler field: stiffness ``ω̇ B`` and, where θ is a coordinate,
        ``(Bζ)ᵀ`` added to ``M_θζ``. Zero for the tilts of an axisymmetric rotor.
    K4 : ndarray, shape (k, k), optional
        Stiffness per ω⁴ of the static displacement, ``ΨᵀK_uuΨ``.

    Raises
    ------
    TypeError, ValueError
        If they are not symmetric, finite and of one size.

    Examples
    --------
    The tilts of a thin ring of four unit masses, whose polar moment of inertia is 4 and whose
    transverse one 2: with ``C = I_t − I_p/2`` and ``K2 = I_p/2`` the softening is ``I_t − I_p``.

    >>> import numpy as np
    >>> from exudyn_rotor import Invariants
    >>> from exudyn_rotor.theory.axis import rotations
    >>> from exudyn_rotor.theory.stiffening import stiffening
    >>> ring = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
    >>> tilts = rotations(ring, [0, 0, 0])[:, :2]
    >>> free = np.zeros((12, 12))
    >>> invariants = Invariants.of(ring, np.eye(12), free, None, tilts, [0, 0, 1])
    >>> print(np.diag(invariants.C), np.diag(stiffening(invariants, "tilt").K2))
    [0. 0.] [2. 2.]
    """

    K2: np.ndarray
    B: np.ndarray
    K4: np.ndarray | None = None

    def __post_init__(self) -> None:
        K2 = checks.matrix(self.K2, "K2")
        for name in ("K2", "B", "K4"):
            if name != "K4" or self.K4 is not None:
                matrix = checks.symmetric(getattr(self, name), name, size=K2.shape[0])
                object.__setattr__(self, name, matrix)


@dataclass(frozen=True, eq=False)
class SpinTerms:
    """Matrices and loads that a spin adds to the linear equations; every term stands here once.

        M ζ̈ + (D + 2ωG) ζ̇ + (K − ω²Ĉ + ω⁴K4 + ω̇W) ζ = f + ω²h − ω̇g        (105), (109)

    The paper's equations are K2 = B = K4 = 0.
    """

    G: Matrix  # (k, k) Gyroscopic matrix (80)
    C_hat: Matrix  # spin softening less stiffening per ω², ``C − K2``
    W: Matrix  # ``G + B``
    B: Matrix  # stiffness of the Euler field per ω̇
    h: np.ndarray  # (k,) Centrifugal load per ω² (83)
    g: np.ndarray  # (k,) Mass moment of the Euler load per −ω̇ (82)
    K4: Matrix | None = None  # stiffness per ω⁴ of a static displacement

    @classmethod
    def of(cls, invariants: Invariants, second_order: Stiffening) -> SpinTerms:
        """Return the terms of a basis with its second-order terms, origin on the spin axis."""
        checks.instance(invariants, "invariants", Invariants)
        checks.instance(second_order, "second_order", Stiffening, "stiffening(…) makes one")
        K2 = checks.matrix(second_order.K2, "second_order: K2", shape=invariants.C.shape)
        return cls(
            G=invariants.G,
            C_hat=invariants.C - K2,
            W=invariants.G + second_order.B,
            B=second_order.B,
            h=invariants.h,
            g=invariants.g,
            K4=second_order.K4,
        )

    def damping(self, speed: float) -> Matrix:
        """Return the Coriolis matrix ``2ωG`` at a spin speed [rad/s]."""
        return 2.0 * speed * self.G

    def stiffness(self, speed: float, acceleration: float = 0.0) -> Matrix:
        """Return ``−ω²Ĉ + ω⁴K4 + ω̇W`` at a spin speed [rad/s] and acceleration [rad/s²]."""
        centrifugal = -(speed**2) * self.C_hat
        if self.K4 is not None:
            centrifugal = centrifugal + speed**4 * self.K4
        return centrifugal + acceleration * self.W if acceleration else centrifugal

    def load(self, speed: float, acceleration: float = 0.0) -> np.ndarray:
        """Return ``ω²h − ω̇g``, shape (k,), of the rotor's own eccentricity."""
        return speed**2 * self.h - acceleration * self.g


def chosen_level(choice: str, stress_is_known: bool) -> str:
    """Return the level of a choice, which may be ``'auto'``."""
    if checks.choice(choice, "stiffening", CHOICES) != "auto":
        return choice
    return "full" if stress_is_known else "tilt"


def warn_of_left_out(invariants: Invariants, speed: float, level: int) -> None:
    """Warn where ``'tilt'`` errs much at a spin speed [rad/s] by an estimate of the rest.

    Invariants are of flexible modes at rest, beside rigid motions; `level` is that of the stack
    whose caller is warned.
    """
    error = estimated_error(invariants, speed)
    if error > _WORTH_A_WARNING:
        warnings.warn(
            "stiffening: the static centrifugal stress is not known; what it changes beyond 'tilt' "
            f"is left out, an estimated {error:.0%} of a mode's frequency at {abs(speed):.6g} "
            "rad/s. Make the rotor with SolidRotor.from_ngsolve, or give the stress with "
            "Prestress(matrix, nodes); stiffening='tilt' accepts the error",
            UserWarning,
            stacklevel=level,
        )


def estimated_error(invariants: Invariants, speed: float) -> float:
    """Return the largest relative change of a mode's frequency by what ``'tilt'`` leaves out.

    ``½ω² |K2 − K2_tilt|_kk / K_kk`` of the flexible modes with the estimate of K2; 0 without one.
    """
    if invariants.K2_estimated is None:
        return 0.0
    stiffness = np.diag(invariants.K)
    flexible = stiffness > _FREE * stiffness.max(initial=0.0)
    left_out = np.diag(invariants.K2_estimated - stiffening(invariants, "tilt").K2)
    shares = np.abs(left_out[flexible]) / stiffness[flexible]
    return float(0.5 * speed**2 * shares.max(initial=0.0))


def stiffening(invariants: Invariants, level: str) -> Stiffening:
    """Return the second-order terms of `level` for a basis.

    Parameters
    ----------
    invariants : Invariants
        With the origin on the spin axis.
    level : {'none', 'tilt', 'full'}

    Raises
    ------
    TypeError, ValueError
        For an unknown level, or 'full' without a prestress.
    """
    checks.instance(invariants, "invariants", Invariants)
    checks.choice(level, "stiffening", LEVELS)
    if level == "none":
        shape = (invariants.size, invariants.size)
        zero = sp.csr_array(shape) if invariants.is_sparse else np.zeros(shape)
        return Stiffening(zero, zero)
    e = skew(invariants.direction)
    if level == "tilt":
        return Stiffening(K2=-_work_hessian(invariants, -e @ e), B=_work_hessian(invariants, e))
    if invariants.K2 is None:
        raise ValueError(NO_PRESTRESS)
    # of the Euler field what rigid rotations feel, which is all of it where nothing holds the rotor
    return Stiffening(invariants.K2, _work_hessian(invariants, e), invariants.K4)


def with_prestress(
    invariants: Invariants, K2: np.ndarray, relief: np.ndarray, K4: np.ndarray | None = None
) -> Invariants:
    """Return dense invariants with the stiffness of a static prestress.

    K2 and K4 are ``Ψᵀ(K_G + K_u)Ψ`` per ω² and ``ΨᵀK_uuΨ`` per ω⁴. `relief` (3,) is the angular
    acceleration per ω² whose inertia balanced the load. That part of the load strains nothing, and
    does the work on rigid rotations that ``'tilt'`` gives it.
    """
    return replace(
        invariants,
        K2=0.5 * (K2 + K2.T) - _work_hessian(invariants, skew(relief)),
        K4=None if K4 is None else 0.5 * (K4 + K4.T),
    )


def work_factors(invariants: Invariants, field: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return V (6, k) and W (6, 6) of the Hessian ``VᵀWV`` of the work of ``M F x`` on u₂.

    ``f·(φ×(φ×y)) = φᵀ(H − tr(H) I)φ`` with ``H = Σ f yᵀ``, and ``f·(φ×ψ) = −φ·Σ f×ψ``. The field F
    (3, 3) is ``−ẽẽ`` for the centrifugal and ``ẽ`` for the Euler field.
    """
    (J, P), rotation = moments_about(invariants, invariants.center), invariants.mean_rotation
    P_flexible = P - np.einsum("cbd,ck,ad->abk", EPSILON, rotation, J)
    H = field @ J
    by_rotation = 0.5 * (H + H.T) - np.trace(H) * np.eye(3)
    mixed = -np.einsum("aib,ac,cbk->ik", EPSILON, field, P_flexible)
    W = np.block([[by_rotation, np.eye(3)], [np.eye(3), np.zeros((3, 3))]])
    return np.vstack([rotation, mixed]), W


def _work_hessian(invariants: Invariants, field: np.ndarray) -> np.ndarray:
    """Hessian of the work of the nodal forces ``M F x`` on u₂, shape (k, k)."""
    V, W = work_factors(invariants, field)
    hessian = V.T @ W @ V
    return 0.5 * (hessian + hessian.T)
