"""Rotors of Timoshenko beams, in one plane and as reduced rotors of the package."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor import ReducedRotor, SpinAxis
from exudyn_rotor.reduction.fields import ReducedInterface
from exudyn_rotor.reduction.mode_kind import ModeKind
from exudyn_rotor.theory.invariants import Invariants

_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])
_KINDS = (ModeKind.TRANSLATION_1, ModeKind.TRANSLATION_2, ModeKind.TILT_1, ModeKind.TILT_2)


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

    def reduced(self, radius: float = 0.02) -> ReducedRotor:
        """Return all of it as a reduced rotor, stations as interfaces '0', '1', …

        In axes that turn, ``2G → J (2M − G)`` and ``C − K2 = M − G``.
        """
        M, G, K = self.plane
        z, one = np.asarray(self.stations), np.ones(len(self.stations))
        move = np.kron(one, [1.0, 0.0])
        mass = move @ M @ move
        tilt = np.column_stack([z, one]).ravel()
        center = move @ M @ tilt / mass
        about = tilt - center * move
        rigid = [q / np.sqrt(q @ M @ q) for q in (move, about)]
        flexible = la.eigh(K, M)[1][:, 2:]
        none = np.zeros(len(M))
        # q = (x, β) in the first plane, (y, −α) in the second
        T = np.column_stack([
            np.r_[rigid[0], none], np.r_[none, rigid[0]],
            np.r_[none, -rigid[1]], np.r_[rigid[1], none],
            la.block_diag(flexible, flexible),
        ])  # fmt: skip
        both = [np.kron(np.eye(2), X) for X in (M, K, M - 0.5 * G, 0.5 * G)]
        first, second = (np.r_[move, none] @ both[0], np.r_[none, move] @ both[0])
        P = np.zeros((3, 3, len(T)))
        P[2, :2] = np.r_[tilt, none] @ both[0], np.r_[none, tilt] @ both[0]
        across = 0.5 * (tilt - np.kron(z, [1.0, 0.0])) @ G @ tilt
        J = np.diag([across, across, tilt @ M @ tilt - across])
        given = {"M": both[0], "K": both[1], "C": both[2], "K2": both[3]}
        inv = Invariants(
            direction=np.array([0.0, 0.0, 1.0]), mass=mass, center=np.array([0.0, 0.0, center]),
            J=J, S=np.vstack([first, second, 0.0 * first]), P=P, D=0.0 * both[0],
            G=np.kron(_TURN, M - 0.5 * G), B=0.0 * both[0], **given,
        )  # fmt: skip
        inv = inv.moved(inv.center).in_basis(T)
        places = {str(i): self._place(i, radius, T) for i in range(len(z))}
        axis, foot = SpinAxis(np.array([0.0, 0.0, 1.0])), np.array([0.0, 0.0, center])
        return ReducedRotor(axis, foot, inv, _KINDS, places, np.eye(len(T)))

    def _place(self, station: int, radius: float, T: np.ndarray) -> ReducedInterface:
        at, count = np.array([0.0, 0.0, self.stations[station]]), 2 * len(self.stations)
        motion = np.zeros((6, len(T)))
        motion[0], motion[4] = T[2 * station], T[2 * station + 1]
        motion[1], motion[3] = T[count + 2 * station], -T[count + 2 * station + 1]
        return ReducedInterface(at, at, radius, motion)
