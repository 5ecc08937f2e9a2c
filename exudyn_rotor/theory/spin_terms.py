"""What a spin adds to the linear equations of the modal coordinates; every term stands here once.

    M ζ̈ + (D + 2ωG) ζ̇ + (K − ω²Ĉ + ω⁴K4 + ω̇W) ζ = f + ω²h − ω̇g        (105), (109)

With centrifugal stiffening (:mod:`exudyn_rotor.theory.stiffening`) ``Ĉ = C − K2`` and
``W = G + B``; the paper's equations are K2 = B = K4 = 0.

Equation numbers: Zwölfer, Rasmussen, Santos, SSRN 4830498.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.theory.invariants import Invariants, Matrix
from exudyn_rotor.theory.stiffening import Stiffening


@dataclass(frozen=True, eq=False)
class SpinTerms:
    """Matrices and loads that a spin adds, in a basis of k columns.

    Attributes
    ----------
    G : shape (k, k)
        Gyroscopic matrix (80).
    C_hat : shape (k, k)
        Spin softening less stiffening per ω², ``Ĉ = C − K2``.
    W, B : shape (k, k)
        ``G + B``, and the stiffness of the Euler field per ω̇.
    h, g : ndarray, shape (k,)
        Centrifugal load per ω² (83), and mass moment of the Euler load per −ω̇ (82).
    K4 : shape (k, k) or None
        Stiffness per ω⁴ of a static displacement; None where it is left out.

    Examples
    --------
    A unit mass at x = 2 in the plane of rotation, without stiffening:

    >>> import numpy as np
    >>> from exudyn_rotor import Invariants
    >>> from exudyn_rotor.theory.stiffening import stiffening
    >>> unit = np.eye(3)
    >>> point = Invariants.of([[2.0, 0, 0]], unit, 9.0 * unit, None, unit, [0, 0, 1])
    >>> terms = SpinTerms.of(point, stiffening(point, "none"))
    >>> print(np.diag(terms.stiffness(10.0)), terms.load(10.0))
    [-100. -100.   -0.] [200.   0.   0.]
    """

    G: Matrix
    C_hat: Matrix
    W: Matrix
    B: Matrix
    h: np.ndarray
    g: np.ndarray
    K4: Matrix | None = None

    @classmethod
    def of(cls, invariants: Invariants, second_order: Stiffening) -> SpinTerms:
        """Return the terms of a basis with its second-order terms, origin on the spin axis.

        Raises
        ------
        TypeError, ValueError
            For other kinds of objects, or matrices of another size.
        """
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
