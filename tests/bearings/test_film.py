"""Oil films of finite length: closed forms, balances, derivatives."""

import numpy as np
import pytest

from exudyn_rotor import OilFilm, Pad, grooved_pads, plot_pressure

RADIUS, CLEARANCE, VISCOSITY, SPEED = 0.05, 1e-4, 0.02, 300.0
STILL = (0.0, 0.0)
SIDES = [np.pi / 2, 3 * np.pi / 2]  # grooves on the horizontal line, n1 up


def film(length=0.05, grooves=SIDES, width=20.0, preload=0.0, **options):
    pads = grooved_pads(CLEARANCE, grooves, np.radians(width) if grooves else 0.0, preload)
    return OilFilm(RADIUS, length, VISCOSITY, pads, **{"axial_nodes": 0, **options})


def carried(bearing, sommerfeld):
    """Return the equilibrium under a load in −n1 of 1 kN at this Sommerfeld number."""
    area = 2.0 * RADIUS * bearing.length
    turns = sommerfeld * 1e3 / (VISCOSITY * area) * (CLEARANCE / RADIUS) ** 2
    return bearing.equilibrium(2.0 * np.pi * turns, [-1e3, 0.0])


def extrapolated(value):
    """Return the limit for a fine grid of what has an error of second order, and its change."""
    coarse, fine = value(60), value(120)
    return fine + (fine - coarse) / 3.0, np.abs(fine - coarse)


# ------------------------------------------------------------------ closed forms


@pytest.mark.parametrize("ratio", [0.2, 0.6])
def test_long_full_film_is_sommerfelds(ratio):
    """W = 12 π μ Ω L R (R/c)² ε/((2 + ε²) √(1 − ε²)), across the eccentricity (Sommerfeld 1904)."""
    length = 2e4 * RADIUS

    def force(nodes):
        full = film(length, grooves=(), cavitation="none", nodes=nodes)
        return full.state([ratio * CLEARANCE, 0.0], STILL, SPEED).force

    found, change = extrapolated(force)
    shape = ratio / ((2.0 + ratio**2) * np.sqrt(1.0 - ratio**2))
    exact = 12 * np.pi * VISCOSITY * SPEED * length * RADIUS**3 / CLEARANCE**2 * shape
    # the ends take 2R/L; the next term of the error is that of fourth order, below a tenth
    assert abs(found[1] / exact - 1.0) < 2e-4 + 0.1 * change[1] / exact
    assert abs(found[0]) < 1e-9 * exact


@pytest.mark.parametrize("ratio", [0.2, 0.6])
def test_short_cut_film_is_ocvirks(ratio):
    """F_r, F_t of a short film between ε = 0 and π (Ocvirk 1952), and its damping across."""
    length = 0.01 * RADIUS

    def values(nodes):
        short = film(length, grooves=(), cavitation="half-sommerfeld", nodes=nodes)
        state = short.state([ratio * CLEARANCE, 0.0], STILL, SPEED)
        return np.append(state.force, state.coefficients()[1][1, 1])

    found, change = extrapolated(values)
    unit = VISCOSITY * RADIUS * length**3 / CLEARANCE**2
    left = 1.0 - ratio**2
    radial, across = ratio**2 / left**2, np.pi * ratio / (4.0 * left**1.5)
    exact = unit * np.array([-SPEED * radial, SPEED * across, 2 * across / (ratio * CLEARANCE)])
    # in the short film's edge layers, R/L below one node, nothing is resolved
    assert np.all(np.abs(found - exact) < 0.1 * change + 1e-3 * np.abs(exact))


# ------------------------------------------------------------------ derivatives, symmetries


@pytest.mark.parametrize("speed", [SPEED, -SPEED])
@pytest.mark.parametrize("cavitation", ["none", "half-sommerfeld", "reynolds"])
def test_coefficients_are_derivatives_of_the_force(cavitation, speed):
    pads = [Pad(0.2, 1.9, 1e-4, [1e-5, 0.0]), Pad(2.3, 3.4, 1.2e-4, [0.0, 2e-5])]
    skew = OilFilm(RADIUS, 0.06, VISCOSITY, pads, cavitation, nodes=60, axial_nodes=3)
    state = skew.state([3e-5, -4e-5], STILL, speed)
    stiffness, damping = state.coefficients()
    moved = 1e-6 * CLEARANCE * np.array([np.eye(2), -np.eye(2)])

    def force(place, rate=STILL):
        return skew.state(place, rate, speed).force

    ahead, behind = ([force(state.position + e) for e in side] for side in moved)
    differences = -(np.array(ahead) - behind).T / (2e-6 * CLEARANCE)
    # round-off 1e-16/1e-6, and the square of the step; a node that changes sides adds its own
    assert stiffness == pytest.approx(differences, abs=1e-5 * np.abs(stiffness).max())
    moved = 1e-7 * CLEARANCE * SPEED * np.eye(2)
    ahead = [force(state.position, e) - state.force for e in moved]
    differences = -np.array(ahead).T / (1e-7 * CLEARANCE * SPEED)
    assert damping == pytest.approx(differences, abs=1e-5 * np.abs(damping).max())


# ------------------------------------------------------------------ what is refused, picture


def test_picture_shows_the_whole_film():
    ax = plot_pressure(carried(film(), 0.5))
    assert ax.get_xlim()[1] - ax.get_xlim()[0] == pytest.approx(340.0, abs=0.1)
    assert ax.get_ylim() == pytest.approx((-25.0, 25.0))
