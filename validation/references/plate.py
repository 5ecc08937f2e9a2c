"""Bending of a thin annular disc, clamped at its bore, at rest and rotating; and disc stresses.

- At rest, Kirchhoff's plate: ``w = W(r) cos nθ`` with ``W`` from Bessel functions J, Y, I, K; the
  frequency is a zero of the determinant of the four edge conditions. Source: S. M. Vogel,
  D. W. Skinner, J. Appl. Mech. 32 (1965) 926–931; A. W. Leissa, "Vibration of Plates", NASA SP-160
  (1969), chapter 2.
- Rotating: plane stress σ_r, σ_θ of the disc acts as a membrane. Ritz's method in r, converged,
  for plate and membrane together, and for each alone. Lamb and Southwell (Proc. R. Soc. A 99
  (1921) 272–280): the sum ``ω_plate² + λΩ²`` of the lowest values of both is a lower bound.
- With shear and rotary inertia: R. D. Mindlin, J. Appl. Mech. 18 (1951) 31–38, with what the
  rotation does to the fibres.
- Stresses: S. P. Timoshenko, J. N. Goodier, "Theory of Elasticity", rotating disc.

The rotor frame is used throughout.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, yv, yvp

from validation.references.beam import gyroscopic_frequencies, lowest_frequencies, shapes

# Frequencies ``ωb²√(ρh/D)``, no nodal circle, over (bore/rim radius, n), three digits as tabulated;
# reproduced with ν = 0.3 (Vogel and Skinner; Leissa)
PUBLISHED = {
    (0.3, 0): 6.66, (0.3, 2): 7.96, (0.3, 3): 13.3,
    (0.5, 0): 13.0, (0.5, 1): 13.3, (0.5, 2): 14.7,
    (0.7, 0): 37.0, (0.7, 1): 37.5, (0.7, 2): 39.3,
}  # fmt: skip

Weight = float | np.ndarray
Fields = np.ndarray  # (shapes, points)


@dataclass(frozen=True)
class Annulus:
    """A disc of constant thickness.

    Attributes
    ----------
    inner, outer, thickness : float
        Bore and rim radius, thickness [m]; `inner` is zero for a solid disc (stresses only).
    modulus, ratio, density : float
        Young's modulus [Pa], Poisson's ratio, density [kg/m³].
    """

    inner: float
    outer: float
    thickness: float
    modulus: float
    ratio: float
    density: float

    @property
    def rigidity(self) -> float:
        """``D = Eh³/(12(1 − ν²))`` [N m]."""
        return self.modulus * self.thickness**3 / 12.0 / (1.0 - self.ratio**2)

    @property
    def area_density(self) -> float:
        """ρh [kg/m²]."""
        return self.density * self.thickness


# ------------------------------------------------------------------ plane stress


@dataclass(frozen=True)
class PlaneStress:
    """Static state of a rotating disc per Ω²: ``σ = A ∓ B/r² − C r²``.

    Attributes
    ----------
    disc : Annulus
    constant, inverse : float
        A [Pa s²] and B [N s²].
    """

    disc: Annulus
    constant: float
    inverse: float

    @classmethod
    def free(cls, disc: Annulus) -> PlaneStress:
        """Return the state of a disc whose bore and rim are free."""
        a, b = disc.inner, disc.outer
        factor = (3.0 + disc.ratio) / 8.0 * disc.density
        return cls(disc, factor * (a**2 + b**2), factor * a**2 * b**2)

    @classmethod
    def clamped(cls, disc: Annulus) -> PlaneStress:
        """Return the state of a disc whose bore does not move, and whose rim is free."""
        a, b, nu = disc.inner, disc.outer, disc.ratio
        radial, hoop = (3.0 + nu) / 8.0 * disc.density, (1.0 + 3.0 * nu) / 8.0 * disc.density
        # σ_r(b) = 0 and σ_θ − ν σ_r = 0 at the bore
        matrix = [[1.0, -1.0 / b**2], [1.0 - nu, (1.0 + nu) / a**2]]
        return cls(disc, *np.linalg.solve(matrix, [radial * b**2, (hoop - nu * radial) * a**2]))

    def radial(self, r: np.ndarray) -> np.ndarray:
        """Return σ_r per Ω² at radii r [Pa s²]."""
        factor = (3.0 + self.disc.ratio) / 8.0 * self.disc.density
        return self.constant - self._inverse(r) - factor * r**2

    def hoop(self, r: np.ndarray) -> np.ndarray:
        """Return σ_θ per Ω² at radii r [Pa s²]."""
        factor = (1.0 + 3.0 * self.disc.ratio) / 8.0 * self.disc.density
        return self.constant + self._inverse(r) - factor * r**2

    def growth(self, r: np.ndarray) -> np.ndarray:
        """Return the radial displacement per Ω² at radii r [m s²]."""
        return r / self.disc.modulus * (self.hoop(r) - self.disc.ratio * self.radial(r))

    def work(self) -> float:
        """Return ``∫ ρ r u dV`` per Ω⁴, twice the strain energy [J s⁴]."""
        r, weights = _radii(self.disc, 20)
        line = 2.0 * np.pi * self.disc.area_density * r**2 * self.growth(r)
        return float(weights @ line)

    def _inverse(self, r: np.ndarray) -> np.ndarray:
        r = np.asarray(r, dtype=float)
        return self.inverse / r**2 if self.inverse else np.zeros_like(r)


# ------------------------------------------------------------------ plate at rest


def plate_frequency(disc: Annulus, n: int) -> float:
    """Return the lowest frequency with n nodal diameters, clamped at the bore [rad/s]."""
    a, b, nu = disc.inner, disc.outer, disc.ratio
    families = ((jv, jvp, -1.0), (yv, yvp, -1.0), (iv, ivp, 1.0), (kv, kvp, 1.0))

    def determinant(k: float) -> float:
        columns = []
        for value, slope, sign in families:
            # Laplacian of every function is ± k² times itself; lengths over b
            w, w1 = value(n, k), k * slope(n, k)
            laplacian = sign * k**2 * w
            moment = laplacian - (1.0 - nu) * (w1 - n**2 * w)
            shear = sign * k**2 * w1 - (1.0 - nu) * n**2 * (w1 - w)
            scale = 1.0 / max(abs(value(n, k)), abs(value(n, k * a / b)))
            edge = (value(n, k * a / b), k * slope(n, k * a / b), moment, shear)
            columns.append(scale * np.array(edge))
        return float(np.linalg.det(np.array(columns).T))

    grid = np.linspace(0.5, 30.0, 400)
    values = np.array([determinant(k) for k in grid])
    first = int(np.flatnonzero(values[1:] * values[:-1] < 0)[0])
    k = brentq(determinant, grid[first], grid[first + 1], xtol=1e-13)
    return float(k**2 / b**2 * np.sqrt(disc.rigidity / disc.area_density))


# ------------------------------------------------------------------ plate and membrane


def _radii(disc: Annulus, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points and weights between bore and rim."""
    points, weights = np.polynomial.legendre.leggauss(count)
    width = disc.outer - disc.inner
    return disc.inner + 0.5 * width * (points + 1.0), 0.5 * width * weights


def _form(
    disc: Annulus, n: int, count: int
) -> tuple[np.ndarray, np.ndarray, Callable[[np.ndarray, Weight, np.ndarray], np.ndarray]]:
    """Return radii, positions 0 … 1, and ``∫ left weight right r dr`` times the mean over θ / π."""
    r, weights = _radii(disc, count + 25)
    # a wave without nodal diameters has twice the mean square
    weights = weights * r * (2.0 if n == 0 else 1.0)

    def form(left: np.ndarray, weight: Weight, right: np.ndarray) -> np.ndarray:
        return (left * weights * weight) @ right.T

    return r, (r - disc.inner) / (disc.outer - disc.inner), form


def _bent(
    disc: Annulus, form: Callable[..., np.ndarray], radial: Fields, around: Fields, twist: Fields
) -> np.ndarray:
    """Return the plate stiffness of curvatures κ_r, κ_θ and κ_rθ."""
    nu = disc.ratio
    mixed = form(radial, nu, around)
    bending = form(radial, 1.0, radial) + form(around, 1.0, around) + mixed + mixed.T
    return disc.rigidity * (bending + 0.5 * (1.0 - nu) * form(twist, 1.0, twist))


def thin_matrices(
    disc: Annulus, n: int, power: int = 2, count: int = 14
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return mass, plate stiffness, and membrane stiffness per Ω², of ``w = W(r) cos nθ``.

    The shapes of W start with (r − a)^power: 2 for a clamped bore, 1 for a membrane.
    """
    r, x, form = _form(disc, n, count)
    width = disc.outer - disc.inner
    W, W1, W2 = (shapes(power, count, x, order) / width**order for order in range(3))
    around, twist = W1 / r - n**2 * W / r**2, 2.0 * n * (W1 / r - W / r**2)
    stress = PlaneStress.clamped(disc)
    radial, hoop = disc.thickness * stress.radial(r), disc.thickness * stress.hoop(r)
    membrane = form(W1, radial, W1) + form(W, n**2 * hoop / r**2, W)
    return form(W, disc.area_density, W), _bent(disc, form, W2, around, twist), membrane


def rotating_frequency(disc: Annulus, n: int, speed: float) -> float:
    """Return the lowest frequency of Kirchhoff's plate with membrane stress [rad/s]."""
    mass, bending, membrane = thin_matrices(disc, n)
    return float(lowest_frequencies(bending + speed**2 * membrane, mass, 1)[0])


def membrane_value(disc: Annulus, n: int, count: int = 14) -> float:
    """Return the lowest ``λ = ω²/Ω²`` of the rotating membrane, held at the bore."""
    mass, _, membrane = thin_matrices(disc, n, power=1, count=count)
    return float(lowest_frequencies(membrane, mass, 1)[0] ** 2)


def shear_coefficient(ratio: float) -> float:
    """Return ``5/(6 − ν)``, which fits thickness-shear and long waves of a plate."""
    return 5.0 / (6.0 - ratio)


def thick_frequencies(disc: Annulus, n: int, speed: float, count: int = 14) -> np.ndarray:
    """Return the two lowest frequencies of Mindlin's plate with membrane stress [rad/s].

    In the rotor frame, ascending. ``w = W cos nθ``, and the fibres move by ``−z(ψ_r cos nθ,
    ψ_θ sin nθ)``. That motion has inertia, spin softening, Coriolis force and stress. For n ≥ 1 the
    Coriolis force parts the two waves that travel with the spin and against it.
    """
    r, x, form = _form(disc, n, count)
    value, slope = (
        shapes(1, count, x, order) / (disc.outer - disc.inner) ** order for order in range(2)
    )
    none = np.zeros_like(value)
    W, W1 = (np.vstack([one, none, none]) for one in (value, slope))
    R, R1 = (np.vstack([none, one, none]) for one in (value, slope))
    T, T1 = (np.vstack([none, none, one]) for one in (value, slope))
    around, across = (R + n * T) / r, (T + n * R) / r
    h, nu, stress = disc.thickness, disc.ratio, PlaneStress.clamped(disc)
    shear = shear_coefficient(nu) * h * disc.modulus / (2.0 * (1.0 + nu))
    K = _bent(disc, form, R1, around, T1 - across)
    for angle in (W1 - R, n * W / r + T):
        K = K + shear * form(angle, 1.0, angle)
    rotary = disc.area_density * h**2 / 12.0
    fibres = rotary * (form(R, 1.0, R) + form(T, 1.0, T))
    M = form(W, disc.area_density, W) + fibres
    radial, hoop = (speed**2 * h * one for one in (stress.radial(r), stress.hoop(r)))
    K = K + form(W1, radial, W1) + form(W, n**2 * hoop / r**2, W) - speed**2 * fibres
    for factor, one in ((radial, R1), (radial, T1), (hoop, around), (hoop, across)):
        K = K + h**2 / 12.0 * form(one, factor, one)
    if n == 0:  # without the torsion that n = 0 leaves to ψ_θ
        K, M = K[: 2 * count, : 2 * count], M[: 2 * count, : 2 * count]
        return np.repeat(lowest_frequencies(K, M, 1), 2)
    coupling = -2.0 * speed * rotary * (form(R, 1.0, T) + form(T, 1.0, R))
    G = np.kron([[0.0, 1.0], [-1.0, 0.0]], coupling)
    return gyroscopic_frequencies(np.kron(np.eye(2), M), G, np.kron(np.eye(2), K))[:2]
