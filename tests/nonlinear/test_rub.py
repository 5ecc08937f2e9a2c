"""Rub with friction: annular branches, folds and the onset of dry whip in closed form."""

import numpy as np
import pytest
from scipy.optimize import brentq

from exudyn_rotor import ClearanceStop, SolidRotor, Support, Unbalance, periodic_response

MASS, SPRING, DAMPER, AMOUNT = 20.0, 1e6, 700.0, 2e-3
CONTACT, FRICTION, GAP = 5e6, 0.1, 2e-4


def rubbing():
    """Return what periodic_response takes of a mass on a spring in a stop."""
    solid = SolidRotor.from_matrices(MASS * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], "z")
    stop = ClearanceStop(
        interface="seat", radius=0.05, clearance=GAP, stiffness=CONTACT, friction=FRICTION
    )
    spring = Support("seat", np.diag([SPRING] * 2 + [1e6]), np.diag([DAMPER] * 2 + [100.0]))
    return solid.with_interface("seat", [0]).reduce(0), [spring, stop]


def speeds_of(r):
    """Return Ω at which the radius is r: ``|k + (1 + iμ)k_c(1 − c/r) − mΩ² + idΩ| r = UΩ²``."""
    contact = CONTACT * max(1.0 - GAP / r, 0.0)
    k, drag = SPRING + contact, FRICTION * contact
    quartic = [MASS**2 - (AMOUNT / r) ** 2, 0.0, DAMPER**2 - 2.0 * k * MASS, 2.0 * DAMPER * drag,
               k**2 + drag**2]  # fmt: skip
    found = np.roots(quartic)
    return np.sort(found[(np.abs(found.imag) < 1e-9 * np.abs(found)) & (found.real > 0)].real)


def exponent(r, speed):
    """Return that of the fastest growing motion beside the circle, in axes that turn with it."""
    normal = CONTACT * (r - GAP) / r
    contact = np.array([[CONTACT, -FRICTION * normal], [FRICTION * CONTACT, normal]])
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    K = SPRING * np.eye(2) + contact + DAMPER * speed * turn - MASS * speed**2 * np.eye(2)
    D = DAMPER * np.eye(2) + 2.0 * MASS * speed * turn
    values = np.linalg.eigvals(np.block([[0 * K, np.eye(2)], [-K / MASS, -D / MASS]]))
    return values[np.argmax(values.real)]


def test_annular_rub_and_the_onset_of_dry_whip():
    rotor, supports = rubbing()
    found = periodic_response(
        rotor, np.linspace(100.0, 400.0, 4), Unbalance("seat", AMOUNT), supports=supports
    )
    radius, rubs = found.amplitudes(), found.amplitudes() > GAP
    for r, speed in zip(radius, found.values, strict=True):
        assert np.abs(speeds_of(r) / speed - 1.0).min() < 1e-6
    expected = [
        exponent(r, speed).real for r, speed in zip(radius[rubs], found.values[rubs], strict=True)
    ]
    np.testing.assert_allclose(found.growth[rubs], expected, rtol=1e-3, atol=5e-3)
    onset = brentq(lambda r: exponent(r, speeds_of(r)[0]).real, 1.01 * GAP, 2.0 * GAP)
    marked = {kind: found.values[p] for p, kind in enumerate(found.kinds)}
    assert marked["torus"] == pytest.approx(speeds_of(onset)[0], rel=1e-5)
    assert marked["fold"] == pytest.approx(speeds_of(GAP)[1], rel=1e-4)  # where it touches
