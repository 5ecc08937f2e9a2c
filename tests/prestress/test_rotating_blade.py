"""Blades with level 'full' against rotating beams, and component modes at speed."""

import ngsolve as ngs
import numpy as np
import pytest
import scipy.linalg as la
from models import STEEL
from netgen.occ import Box, OCCGeometry, Pnt, X
from numpy.polynomial import Polynomial

from exudyn_rotor import SolidRotor, SpinAxis, campbell

LENGTH, WIDTH, HEIGHT = 1.0, 0.06, 0.02


def blade(hub: float = 0.0) -> SolidRotor:
    """Return a beam along x, clamped at x = 0; it spins about z at a distance of x = −hub."""
    solid = Box(Pnt(0, -WIDTH / 2, -HEIGHT / 2), Pnt(LENGTH, WIDTH / 2, HEIGHT / 2))
    solid.mat("steel")
    solid.faces.Min(X).name = "root"
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.06))
    axis = SpinAxis((0, 0, 1), (-hub, 0, 0))
    return SolidRotor.from_ngsolve(mesh, STEEL, axis).clamped("root")


# ------------------------------------------------------------------ rotating cantilever


def rotating_beam(speed: float, hub: float, across: bool, count: int = 10) -> float:
    """Return the lowest flap (or, across, lag) frequency of a rotating Euler beam [rad/s].

    Ritz method with xⁱ, i ≥ 2, for ``EI w'''' − (T w')' + ρA ẅ − [lag] ρAΩ² w = 0`` and the
    tension ``T = ρAΩ² ∫_x^L (hub + s) ds``.
    """
    area, sides = WIDTH * HEIGHT, (HEIGHT, WIDTH) if not across else (WIDTH, HEIGHT)
    bending = STEEL["youngsModulus"] * sides[1] * sides[0] ** 3 / 12
    line = STEEL["density"] * area
    x = Polynomial([0, 1])
    tension = line * speed**2 * (hub * (LENGTH - x) + (LENGTH**2 - x**2) / 2)
    shapes = [Polynomial.basis(i) for i in range(2, 2 + count)]

    def form(weight: Polynomial | float, order: int) -> np.ndarray:
        slopes = [shape.deriv(order) if order else shape for shape in shapes]
        integrals = [[(a * b * weight).integ() for b in slopes] for a in slopes]
        return np.array([[F(LENGTH) - F(0) for F in row] for row in integrals])

    M = form(line, 0)
    K = form(bending, 2) + form(tension, 1) - (speed**2 * M if across else 0.0)
    return float(np.sqrt(la.eigh(K, M, eigvals_only=True)[0]))


@pytest.mark.parametrize("hub", [0.0, 1.0])
def test_flap_and_lag_of_a_rotating_blade(hub):
    solid = blade(hub)
    reduced = solid.reduce(8, prestress=True)
    speeds = np.array([0.0, 150.0, 400.0])
    found = campbell(reduced, speeds, stiffening="full").frequencies_rotor
    tilt = campbell(reduced, speeds, stiffening="tilt").frequencies_rotor
    for i, speed in enumerate(speeds):
        flap, lag = (rotating_beam(speed, hub, across) for across in (False, True))
        assert np.abs(found[i] / flap - 1).min() < 0.01
        # shear and the Coriolis coupling with stretching lower the lag mode
        assert np.abs(found[i] / lag - 1).min() < 0.01
        if speed > 0.0:
            assert np.abs(tilt[i] / flap - 1).min() > 0.02
