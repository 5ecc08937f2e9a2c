"""Steady motions close to the wall of an oil film."""

import exudyn as exu
import numpy as np
from scipy.integrate import solve_ivp

from exudyn_rotor import ShortJournalBearing, SolidRotor, add_rotor, add_supports, steady_state

MASS, SPEED, UNBALANCE, CLEARANCE = 25.0, 1000.0, 1e-3, 1e-4


def test_a_film_that_is_all_but_closed_in_every_revolution():
    """The motion comes back in an integration of the law alone.

    The equations at a few angles know nothing of it: it is found with many.
    """
    place = [[UNBALANCE / MASS, 0.0, 0.0]]
    mass = SolidRotor.from_matrices(MASS * np.eye(3), np.zeros((3, 3)), place, "z")
    bearing = ShortJournalBearing(
        interface="seat", radius=0.05, length=0.01, clearance=CLEARANCE, viscosity=0.005
    )
    mbs = exu.SystemContainer().AddSystem()
    rotor = mass.with_interface("seat", [0]).reduce(0)
    body = add_rotor(mbs, rotor, spin=SPEED, gravity=[0.0, -9.81, 0.0], translation="none")
    add_supports(body, [bearing])
    mbs.Assemble()
    found = steady_state(body, tolerance=1e-4)

    def rates(t, y):
        u = UNBALANCE * SPEED**2 * np.array([np.cos(SPEED * t), np.sin(SPEED * t)])
        force = u + np.array(bearing.law(*y, SPEED * t, SPEED)) - [0.0, 9.81 * MASS]
        return [*y[2:], *force / MASS]

    angles = np.linspace(0.0, 2.0 * np.pi, 25)
    places = np.array([found.interface_motion("seat", theta)[:2] for theta in angles])
    h = 1e-3
    ahead, behind = (found.interface_motion("seat", theta)[:2] for theta in (h, -h))
    start = [*places[0], *(ahead - behind) * SPEED / (2.0 * h)]
    run = solve_ivp(rates, (0.0, angles[-1] / SPEED), start, t_eval=angles / SPEED, rtol=1e-9,
                    atol=1e-13)  # fmt: skip
    away = np.abs(run.y[:2].T - places).max()
    assert np.linalg.norm(places, axis=1).max() > 0.9 * CLEARANCE
    assert away < 2e-3 * CLEARANCE
