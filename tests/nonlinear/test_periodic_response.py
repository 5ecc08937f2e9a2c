"""Nonlinear steady motions and their branches, against closed forms."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from exudyn_rotor import SolidRotor, SqueezeFilmDamper, Unbalance, periodic_response
from exudyn_rotor.bearings.bearing import Bearing

MASS, AMOUNT = 20.0, 2e-4


def point():
    solid = SolidRotor.from_matrices(MASS * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], "z")
    return solid.with_interface("seat", [0]).reduce(0)


@dataclass(frozen=True, eq=False, kw_only=True)
class Cubic(Bearing):
    """``f = −(k + k₃ r²) q − c q̇``: circles of a radius r, as those of a Duffing oscillator."""

    k: float = 1e6
    k3: float = 2e13
    c: float = 200.0

    def law(self, x, y, vx, vy, angle, speed):
        k = self.k + self.k3 * (x * x + y * y)
        return -k * x - self.c * vx, -k * y - self.c * vy

    def _rest(self, speed, load):
        return np.zeros(2)

    def _matrices(self, speed, load):
        return self.k * np.eye(2), self.c * np.eye(2)

    def speeds(self, r):
        """Return Ω at which the radius is r: ``|k + k₃r² − mΩ² + icΩ| r = U Ω²``, ascending."""
        k = self.k + self.k3 * r * r
        squares = np.roots(
            [(MASS * r) ** 2 - AMOUNT**2, (self.c**2 - 2 * k * MASS) * r * r, (k * r) ** 2]
        )
        return np.sqrt(np.sort(squares[squares.real > 0].real))


def test_duffing_rotor():
    """All points on the closed form; the fold where its speed is lowest; unstable between folds."""
    one, speeds = Cubic(interface="seat"), np.linspace(100.0, 400.0, 7)
    found = periodic_response(point(), speeds, Unbalance("seat", AMOUNT), supports=one)
    radius = found.amplitudes()
    residual = np.abs(
        one.k + one.k3 * radius**2 - MASS * found.values**2 + 1j * one.c * found.values
    )
    np.testing.assert_allclose(residual * radius, AMOUNT * found.values**2, rtol=1e-6)
    fold = [found.values[p] for p, kind in enumerate(found.kinds) if kind == "fold"]
    lowest = minimize_scalar(
        lambda r: one.speeds(r)[1], bounds=(5e-5, 9e-5), method="bounded", options={"xatol": 1e-12}
    )
    assert fold == [pytest.approx(lowest.fun, rel=1e-6)]
    assert len(found.at(400.0)) == 3
    assert np.sort(radius[found.at(400.0)])[[0, 2]] == pytest.approx(
        np.sort(radius[found.at(400.0)][found.stable[found.at(400.0)]])
    )
    # beside a circle of the radius r, motions that turn with it: Hill's determinant in closed form
    top, speed = found.at(400.0)[0], 400.0
    k, dk = one.k + one.k3 * radius[top] ** 2, 2.0 * one.k3 * radius[top] ** 2
    stiffness = np.array(
        [[k + dk - MASS * speed**2, -one.c * speed], [one.c * speed, k - MASS * speed**2]]
    )
    turning = np.array([[one.c, -2.0 * MASS * speed], [2.0 * MASS * speed, one.c]])
    rates = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness / MASS, -turning / MASS]])
    assert found.growth[top] == pytest.approx(np.linalg.eigvals(rates).real.max(), rel=1e-4)


def test_folds_of_a_centred_squeeze_film():
    """U Ω² holds the film, the spring and the inertia of a circle in balance."""
    speed, clearance = 500.0, 1.5e-4
    damper = SqueezeFilmDamper(
        interface="seat", radius=0.06, length=0.02, clearance=clearance, viscosity=0.003,
        centring_stiffness=1e6,
    )  # fmt: skip

    def unbalance(ratio):
        r = ratio * clearance
        fx, fy = damper.law(r, 0.0, 0.0, r * speed, 0.0, speed)
        return np.hypot(fx + MASS * speed**2 * r, fy) / speed**2

    found = periodic_response(
        point(), [0.0, 1.1, 6.0], Unbalance("seat", 1e-3), supports=damper, over="unbalance",
        speed=speed,
    )  # fmt: skip
    folds = sorted(found.values[p] for p, kind in enumerate(found.kinds) if kind == "fold")
    options = {"method": "bounded", "options": {"xatol": 1e-9}}
    upper = minimize_scalar(lambda e: -unbalance(e), bounds=(0.5, 0.75), **options).x
    lower = minimize_scalar(unbalance, bounds=(0.75, 0.9), **options).x
    expected = sorted(1e3 * unbalance(each) for each in (upper, lower))
    np.testing.assert_allclose(folds, expected, rtol=1e-6)
    ratios = [
        brentq(lambda e: unbalance(e) - 1.1e-3, *ends)
        for ends in ((0.1, upper), (upper, lower), (lower, 0.95))
    ]
    at = found.at(1.1)
    np.testing.assert_allclose(found.amplitudes()[at] / clearance, ratios, rtol=1e-6)
    assert found.stable[at].tolist() == [True, False, True]
    np.testing.assert_allclose(found.gaps[at, 0], clearance * (1.0 - np.array(ratios)), rtol=1e-5)
    assert found.table().count("fold") == 2
    assert found.plot().get_ylabel() == "amplitude [µm]"
