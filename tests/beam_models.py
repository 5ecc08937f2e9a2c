"""Rotors of Timoshenko beams, in one plane and as reduced rotors of the package."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor import ReducedRotor, SpinAxis
from exudyn_rotor.reduction.reduced_rotor import RIGID_KINDS, ReducedInterface
from exudyn_rotor.theory.invariants import Invariants

_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


def element(
    length: float, bore: float, diameter: float, young: float, poisson: float, density: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return M, G and K (4, 4) of deflection and slope at both ends (Friedman, Kosmatka 1993).

    Shear coefficient of Cowper (1966).
    """
    area, ratio = 0.25 * np.pi * (diameter**2 - bore**2), (bore / diameter) ** 2
    second = np.pi / 64.0 * (diameter**4 - bore**4)
    full = (1.0 + ratio) ** 2
    kappa = 6.0 * (1.0 + poisson) * full
    kappa /= (7.0 + 6.0 * poisson) * full + (20.0 + 12.0 * poisson) * ratio
    shear = 0.5 * young / (1.0 + poisson)
    p = 12.0 * young * second / (kappa * shear * area * length**2)
    points, weights = np.polynomial.legendre.leggauss(5)
    x, one = 0.5 * (points + 1.0), np.ones(len(points))
    deflection = np.array([
        2 * x**3 - 3 * x**2 - p * x + 1 + p,
        length * (x**3 - (2 + 0.5 * p) * x**2 + (1 + 0.5 * p) * x),
        -2 * x**3 + 3 * x**2 + p * x,
        length * (x**3 - (1 - 0.5 * p) * x**2 - 0.5 * p * x),
    ]) / (1 + p)  # fmt: skip
    slope = np.array([
        6 / length * (x**2 - x),
        3 * x**2 - (4 + p) * x + (1 + p) * one,
        -6 / length * (x**2 - x),
        3 * x**2 - (2 - p) * x,
    ]) / (1 + p)  # fmt: skip
    weights = 0.5 * length * weights
    rotary = density * second * (slope * weights) @ slope.T
    L = length
    K = young * second / (L**3 * (1 + p)) * np.array([
        [12, 6 * L, -12, 6 * L],
        [6 * L, (4 + p) * L**2, -6 * L, (2 - p) * L**2],
        [-12, -6 * L, 12, -6 * L],
        [6 * L, (2 - p) * L**2, -6 * L, (4 + p) * L**2],
    ])  # fmt: skip
    return density * area * (deflection * weights) @ deflection.T + rotary, 2.0 * rotary, K


@dataclass(frozen=True)
class BeamRotor:
    """A shaft of beams between stations z (n,), with discs (station, mass, transverse, polar).

    In one plane, deflection and slope at the stations: ``M z̈ − iΩ G ż + K z`` for z = x + iy.
    """

    stations: tuple[float, ...]
    bore: float
    diameter: float
    material: dict
    discs: tuple[tuple[int, float, float, float], ...]

    @property
    def plane(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M, G and K of a plane, each (2n, 2n)."""
        names = ("youngsModulus", "poissonsRatio", "density")
        count = 2 * len(self.stations)
        total = np.zeros((3, count, count))
        for i, length in enumerate(np.diff(self.stations)):
            given = (self.material[name] for name in names)
            total[:, 2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += element(
                length, self.bore, self.diameter, *given
            )
        for at, mass, transverse, polar in self.discs:
            total[0, 2 * at, 2 * at] += mass
            total[0, 2 * at + 1, 2 * at + 1] += transverse
            total[1, 2 * at + 1, 2 * at + 1] += polar
        return tuple(total)

    @property
    def along(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """M and K of the stretch, then of the twist, each (n, n)."""
        count = len(self.stations)
        young, density = (self.material[name] for name in ("youngsModulus", "density"))
        shear = 0.5 * young / (1.0 + self.material["poissonsRatio"])
        area = 0.25 * np.pi * (self.diameter**2 - self.bore**2)
        polar = np.pi / 32.0 * (self.diameter**4 - self.bore**4)
        total = np.zeros((4, count, count))
        for i, length in enumerate(np.diff(self.stations)):
            M = density * length / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
            K = np.array([[1.0, -1.0], [-1.0, 1.0]]) / length
            each = area * M, young * area * K, polar * M, shear * polar * K
            total[:, i : i + 2, i : i + 2] += each
        for at, mass, _, inertia in self.discs:
            total[0, at, at] += mass
            total[2, at, at] += inertia
        return tuple(total)

    def reduced(self, radius: float = 0.02) -> ReducedRotor:
        """Return all of it as a reduced rotor, stations as interfaces '0', '1', …

        In axes that turn, ``2G → J (2M − G)`` and ``C − K2 = M − G`` of bending. Coordinates are
        (x, β) and (y, −α) of the stations, their stretch and their twist.
        """
        M, G, K = self.plane
        M_a, K_a, M_t, K_t = self.along
        n = len(self.stations)
        z, joined = np.asarray(self.stations), la.block_diag
        parts = {
            "M": joined(M, M, M_a, M_t),
            "K": joined(K, K, K_a, K_t),
            "C": joined(M - 0.5 * G, M - 0.5 * G, np.zeros((2 * n, 2 * n))),
            "K2": joined(0.5 * G, 0.5 * G, np.zeros((2 * n, 2 * n))),
            "G": joined(np.kron(_TURN, M - 0.5 * G), np.zeros((2 * n, 2 * n))),
        }
        zero = np.zeros((6 * n, 6 * n))
        move = np.eye(2 * n)[:, ::2].sum(axis=1)
        tilt = np.column_stack([z, np.ones(n)]).ravel()
        mass, first_moment = move @ M @ move, move @ M @ tilt
        center, one = first_moment / mass, np.ones(n)
        rigid = np.zeros((6 * n, 6))
        rigid[: 2 * n, 0] = rigid[2 * n : 4 * n, 1] = move
        rigid[4 * n : 5 * n, 2] = rigid[5 * n :, 3] = one
        rigid[2 * n : 4 * n, 4], rigid[: 2 * n, 5] = -tilt, tilt
        momenta = rigid.T @ parts["M"]
        P = np.zeros((3, 3, 6 * n))
        P[2, 1], P[2, 0] = -momenta[4], momenta[5]
        P[0, 1], P[1, 0] = 0.5 * momenta[3], -0.5 * momenta[3]
        across = 0.5 * one @ M_t @ one
        inertia = np.diag([across, across, tilt @ M @ tilt - across])
        rigid[:, 4:] -= center * rigid[:, [1, 0]] * [-1.0, 1.0]
        given = (K, M, 2), (K, M, 2), (K_a, M_a, 1), (K_t, M_t, 1)
        flexible = [la.eigh(stiff, inert)[1][:, free:] for stiff, inert, free in given]
        sizes = np.sqrt(np.einsum("ik,ij,jk->k", rigid, parts["M"], rigid))
        T = np.hstack([rigid / sizes, joined(*flexible)])
        inv = Invariants(
            direction=np.array([0.0, 0.0, 1.0]), mass=mass, center=np.array([0.0, 0.0, center]),
            J=inertia, S=momenta[:3], P=P, D=zero, **parts,
        )  # fmt: skip
        inv = inv.moved(inv.center).in_basis(T)
        places = {str(i): self._place(i, radius, T) for i in range(n)}
        axis, foot = SpinAxis(np.array([0.0, 0.0, 1.0])), np.array([0.0, 0.0, center])
        return ReducedRotor(axis, foot, inv, RIGID_KINDS, places, np.eye(len(T)))

    def _place(self, station: int, radius: float, T: np.ndarray) -> ReducedInterface:
        at, n = np.array([0.0, 0.0, self.stations[station]]), len(self.stations)
        x, y = T[2 * station : 2 * station + 2], T[2 * (n + station) : 2 * (n + station) + 2]
        motion = [x[0], y[0], T[4 * n + station], -y[1], x[1], T[5 * n + station]]
        return ReducedInterface(at, at, radius, np.array(motion))
