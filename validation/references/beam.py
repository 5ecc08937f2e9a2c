"""Frequencies of a uniform cantilever beam that turns with a rigid hub, by Ritz's method.

All is non-dimensional: lengths over L, frequencies and the spin speed over ``√(EI/(ρAL⁴))``. The
beam lies along x, its root at the distance δL from the spin axis. In unit speed η its tension is
``η² T(x)`` with ``T = δ(1 − x) + (1 − x²)/2``, and a bending w has

- out of the plane of rotation (flap):  ``∫w''² + η² ∫T w'² = μ² ∫w²``,
- in the plane (lag): the same, and ``μ_lag² = μ_flap² − η²``, each with its own stiffness.

The shapes are ``x²`` (or x) times Legendre polynomials, integrated exactly by Gauss's rule, so that
the frequencies converge exponentially and from above.

Sources: A. D. Wright, C. E. Smith, R. W. Thresher, J. L. C. Wang, "Vibration modes of centrifugally
stiffened beams", J. Appl. Mech. 49 (1982) 197–202; D. H. Hodges, M. J. Rutkowski, "Free-vibration
analysis of rotating beams by a variable-order finite-element method", AIAA J. 19 (1981) 1459–1466.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
from numpy.polynomial import Legendre

# uniform beam, hub radius zero, clamped: flap frequencies over η = 0, 1 … 10 (Wright et al.)
PUBLISHED = {
    0: (3.5160, 3.6816, 4.1373, 4.7973, 5.5850, 6.4495, 7.3604, 8.2996, 9.2568, 10.2257, 11.2023),
    1: (22.0345, 22.1810, 22.6149, 23.3203, 24.2733, 25.4461,
        26.8091, 28.3341, 29.9954, 31.7705, 33.6404),
}  # fmt: skip


def shapes(power: int, count: int, points: np.ndarray, order: int) -> np.ndarray:
    """Return derivatives of ``x^power P_k(2x − 1)``, k < `count`, at `points`, shape (count, p)."""
    factor = Legendre([0.5, 0.5], domain=[0, 1]) ** power
    rows = [(factor * Legendre.basis(k, domain=[0, 1])).deriv(order) for k in range(count)]
    return np.array([row(points) for row in rows])


def tension(x: np.ndarray, hub: float) -> np.ndarray:
    """Return the tension over ``ρAΩ²L²`` at x over L; `hub` is δ."""
    return hub * (1.0 - x) + 0.5 * (1.0 - x**2)


def lowest_frequencies(K: np.ndarray, M: np.ndarray, modes: int) -> np.ndarray:
    """Return the lowest frequencies of a pencil, from the largest values of its inverse.

    Rounding is relative to the largest value: this way round it does not hurt the lowest modes.
    """
    return 1.0 / np.sqrt(la.eigh(M, K, eigvals_only=True)[::-1][:modes])


def _rule(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points and weights on 0 … 1 that integrate all products here exactly."""
    points, weights = np.polynomial.legendre.leggauss(count + 5)
    return 0.5 * (points + 1.0), 0.5 * weights


def flap_frequencies(eta: float, hub: float = 0.0, modes: int = 2, count: int = 16) -> np.ndarray:
    """Return the lowest flap frequencies of an Euler–Bernoulli beam.

    Parameters
    ----------
    eta : float
        Spin speed over ``√(EI/(ρAL⁴))``.
    hub : float, optional
        Hub radius over length, δ.
    modes : int, optional
        How many to return.
    count : int, optional
        Number of shapes.

    Returns
    -------
    ndarray, shape (modes,)
        μ, frequencies over ``√(EI/(ρAL⁴))``.
    """
    x, weights = _rule(count)
    w, slope, bend = (shapes(2, count, x, order) for order in range(3))
    K = (bend * weights) @ bend.T
    K = K + eta**2 * (slope * weights * tension(x, hub)) @ slope.T
    return lowest_frequencies(K, (w * weights) @ w.T, modes)


def lag_frequencies(eta: float, hub: float = 0.0, modes: int = 2, count: int = 16) -> np.ndarray:
    """Return ``√(μ_flap² − η²)``, shape (modes,); all numbers in units of the in-plane bending."""
    return np.sqrt(flap_frequencies(eta, hub, modes, count) ** 2 - eta**2)


@dataclass(frozen=True)
class Section:
    """What a thick beam has beside its bending stiffness.

    Attributes
    ----------
    gyration : float
        ``I/(AL²)``, square of the radius of gyration over the length.
    modulus : float
        ``E/G``.
    kappa : float
        Shear coefficient κ.
    """

    gyration: float
    modulus: float
    kappa: float

    @classmethod
    def rectangle(cls, height: float, length: float, ratio: float) -> Section:
        """Return a rectangle of `height` across the bending axis; κ = 10(1 + ν)/(12 + 11ν).

        Source of κ: G. R. Cowper, J. Appl. Mech. 33 (1966) 335–340.
        """
        kappa = 10.0 * (1.0 + ratio) / (12.0 + 11.0 * ratio)
        return cls(height**2 / (12.0 * length**2), 2.0 * (1.0 + ratio), kappa)


def thick_frequencies(
    eta: float,
    hub: float,
    section: Section,
    lag: bool,
    modes: int = 2,
    *,
    displaced: bool = False,
    count: int = 16,
) -> np.ndarray:
    """Return the lowest frequencies of a Timoshenko beam with tension.

    Deflection w, rotation φ of the section and stretching u; ``ρI`` and shear as Timoshenko has
    them. The tension acts on the rotation too (``η² T I/(AL²) φ'²``). A section that turns in flap
    moves its fibres along x and loses ``η² ρI φ²``; in lag the stress across the blade gives this
    back. In lag the Coriolis force couples w and u: ``2η(ẇu − u̇w)``.

    Parameters
    ----------
    eta, hub, modes, count
        As in :func:`flap_frequencies`; `count` shapes for each of w, φ, u.
    section : Section
    lag : bool
        In the plane of rotation, else across.
    displaced : bool, optional
        Also the static strain ``ε = η² T I/(AL²)`` of St. Venant–Kirchhoff elasticity without
        lateral contraction: ``(1 + ε)²`` at bending and stretching, and the shear strain
        ``w' − (1 + ε)φ``.

    Returns
    -------
    ndarray, shape (modes,)
    """
    x, weights = _rule(count)
    value, slope = (shapes(1, count, x, order) for order in range(2))
    r2 = section.gyration
    stiff = section.kappa / (section.gyration * section.modulus)
    pull = eta**2 * tension(x, hub)
    strain = r2 * pull if displaced else 0.0 * x

    def form(left: np.ndarray, weight: np.ndarray | float, right: np.ndarray) -> np.ndarray:
        return (left * weights * weight) @ right.T

    mass = form(value, 1.0, value)
    turn = form(slope, (1.0 + strain) ** 2 + r2 * pull, slope)
    turn = turn + form(value, stiff * (1.0 + strain) ** 2, value)
    turn = turn - (0.0 if lag else eta**2 * r2) * mass
    bend = form(slope, stiff + pull, slope) - (eta**2 if lag else 0.0) * mass
    mixed = -stiff * form(slope, 1.0 + strain, value)
    K = np.block([[bend, mixed], [mixed.T, turn]])
    M = la.block_diag(mass, r2 * mass)
    if not lag:  # stretching is a motion of its own
        return lowest_frequencies(K, M, modes)
    stretch = form(slope, (1.0 + strain) ** 2 / r2 + pull, slope) - eta**2 * mass
    K, M = la.block_diag(K, stretch), la.block_diag(M, mass)
    G = np.zeros_like(M)
    G[:count, 2 * count :], G[2 * count :, :count] = 2 * eta * mass, -2 * eta * mass
    return gyroscopic_frequencies(M, G, K)[:modes]


def gyroscopic_frequencies(M: np.ndarray, G: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return the frequencies of ``Mẍ + Gẋ + Kx = 0``, ascending; G skew, M and K positive.

    With ``A = [[K, 0], [0, M]]`` and ``B = [[0, −K], [K, G]]`` the system is ``Aẏ + By = 0`` of
    ``y = (x, ẋ)``; ``i L⁻¹BL⁻ᵀ``, L the Cholesky factor of A, is Hermitian. Its inverse is solved.
    """
    zero = np.zeros_like(K)
    L = la.block_diag(np.linalg.cholesky(K), np.linalg.cholesky(M))
    inverse = np.linalg.inv(np.block([[zero, -K], [K, G]]))
    reciprocal = la.eigvalsh(1j * (L.T @ inverse @ L))
    return 1.0 / reciprocal[reciprocal > 0.0][::-1]
