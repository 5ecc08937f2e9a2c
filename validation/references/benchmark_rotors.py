"""Solid rotors of the benchmarks, and the closed forms that stand beside them."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import ngsolve
import numpy as np
from netgen import occ
from scipy.integrate import solve_ivp

from exudyn_rotor import ReducedRotor, SolidRotor, Support, craig_bampton_modes

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
LATERAL = ("forward", "backward", "mixed")
RIGID = 1e11  # stiffness of a bearing that does not give way [N/m]


def turned_solid(pieces: Sequence[tuple[float, float, float]]) -> occ.TopoDS_Shape:
    """Return cylinders in a row along z: lengths, inner and outer radii; ends 'left', 'right'."""
    parts, z = [], 0.0
    for length, inner, outer in pieces:
        part = occ.Cylinder(occ.Pnt(0, 0, z), occ.Z, outer, length)
        if inner > 0.0:
            part = part - occ.Cylinder(occ.Pnt(0, 0, z), occ.Z, inner, length)
        parts.append(part)
        z += length
    parts[0].faces.Min(occ.Z).name, parts[-1].faces.Max(occ.Z).name = "left", "right"
    return occ.Glue(parts)


def meshed(shape: occ.TopoDS_Shape, size: float, material: dict, safety: float = 1.5) -> SolidRotor:
    """Return the rotor of a solid about z, its interfaces on the axis."""
    mesh = occ.OCCGeometry(shape).GenerateMesh(maxh=size, curvaturesafety=safety)
    rotor = SolidRotor.from_ngsolve(ngsolve.Mesh(mesh), material, "z", check_units=False)
    return rotor.center_interfaces()


def reduced(rotor: SolidRotor, modes: int = 8) -> ReducedRotor:
    """Return the rotor in Craig–Bampton modes, whose interfaces move in the mean, prestressed."""
    return rotor.reduce(craig_bampton_modes(rotor, modes, coupling="RBE3"), prestress=True)


@dataclass(frozen=True)
class Jeffcott:
    """A bar with a rigid disc in the middle, on two bearings.

    Attributes
    ----------
    sides : tuple of float
        Sides of the bar's rectangular section along x and y [m], or one diameter.
    mass : float
        Of the disc [kg].
    length, width : float
        Of the bar and of the disc [m].
    """

    sides: tuple[float, ...]
    mass: float
    length: float = 0.8
    width: float = 0.02

    @property
    def inertia(self) -> tuple[float, float]:
        """Polar and transverse moment of the disc, radius 0.1 m [kg m²]."""
        polar = 0.5 * self.mass * 0.1**2
        return polar, 0.5 * polar + self.mass * self.width**2 / 12.0

    def solid(self) -> SolidRotor:
        """Return the solid rotor, with the disc as the interface 'disc'."""
        low = 0.5 * (self.length - self.width)
        lengths = (low, self.width, low)
        if len(self.sides) == 1:
            shape = turned_solid([(length, 0.0, 0.5 * self.sides[0]) for length in lengths])
        else:
            a, b = 0.5 * np.array(self.sides)
            ends = np.cumsum((0.0, *lengths))
            parts = [
                occ.Box(occ.Pnt(-a, -b, z), occ.Pnt(a, b, end))
                for z, end in itertools.pairwise(ends)
            ]
            parts[0].faces.Min(occ.Z).name, parts[-1].faces.Max(occ.Z).name = "left", "right"
            shape = occ.Glue(parts)
        rotor = meshed(shape, 0.012, STEEL, 2.0)
        middle = 0.5 * self.length
        return rotor.add_disc(middle, self.mass, self.inertia, self.width, name="disc")

    @property
    def stiffness(self) -> np.ndarray:
        """``1/k = l³/(48EI) + l/(4κGA)``, l = length less the rigid width; along x and y [N/m]."""
        E, ratio = STEEL["youngsModulus"], STEEL["poissonsRatio"]
        if len(self.sides) == 1:
            area = 0.25 * np.pi * self.sides[0] ** 2
            moments = np.full(2, np.pi * self.sides[0] ** 4 / 64.0)
            kappa = 6.0 * (1.0 + ratio) / (7.0 + 6.0 * ratio)  # Cowper 1966
        else:
            a, b = self.sides
            area, moments = a * b, np.array([a**3 * b, a * b**3]) / 12.0
            kappa = 10.0 * (1.0 + ratio) / (12.0 + 11.0 * ratio)
        free, shear = self.length - self.width, 0.5 * E / (1.0 + ratio)
        return 1.0 / (free**3 / (48.0 * E * moments) + free / (4.0 * kappa * shear * area))

    @property
    def moving_mass(self) -> float:
        """Mass of the disc and 17/35 of the bar's (Rayleigh) [kg]."""
        area = np.prod(self.sides) if len(self.sides) == 2 else 0.25 * np.pi * self.sides[0] ** 2
        return self.mass + 17.0 / 35.0 * STEEL["density"] * area * self.length

    @property
    def frequencies(self) -> np.ndarray:
        """``√(k/m)`` along x and y [rad/s]."""
        return np.sqrt(self.stiffness / self.moving_mass)


def bearings(stiffness: float | Sequence[float] = RIGID) -> list[Support]:
    """Return two equal bearings at the ends; two numbers are those along x and y."""
    matrix = np.diag(np.broadcast_to(stiffness, 2)).tolist()
    return [Support(name, matrix) for name in ("left", "right")]


def seal(damping: float, cross: float = 0.0, stiffness: float = 0.0, at: str = "disc") -> Support:
    """Return an isotropic support with cross-coupled stiffness, which drives forward whirl."""
    return Support(at, [[stiffness, cross], [-cross, stiffness]], damping)


def parametric_growth(
    rotor: Jeffcott, bearing: Sequence[float], damping: float, speed: float
) -> float:
    """Return the growth of a mass on an asymmetric shaft on unequal bearings [1/s].

    ``m z̈ + c ż + (K_s(t)⁻¹ + K_b⁻¹)⁻¹ z = 0``, the shaft's K_s turning with the spin: from the
    monodromy matrix over half a revolution, by Runge and Kutta's method of order 8.
    """
    shaft, soft = np.diag(1.0 / rotor.stiffness), np.diag(0.5 / np.asarray(bearing))
    period = np.pi / speed

    def rate(time: float, state: np.ndarray) -> np.ndarray:
        cos, sin = np.cos(speed * time), np.sin(speed * time)
        turn = np.array([[cos, -sin], [sin, cos]])
        place, velocity = state.reshape(2, 2, 4)
        force = np.linalg.solve(turn @ shaft @ turn.T + soft, place) + damping * velocity
        return np.concatenate([velocity, -force / rotor.moving_mass]).ravel()

    options = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-12}
    end = solve_ivp(rate, (0.0, period), np.eye(4).ravel(), **options).y[:, -1]
    multipliers = np.linalg.eigvals(end.reshape(4, 4))
    return float(np.log(np.abs(multipliers).max()) / period)
