"""Oil films of any size, groove and load: what holds for all of them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exudyn_rotor import OilFilm, Pad, grooved_pads

examples = settings(max_examples=25, deadline=None, derandomize=True)
angles = st.floats(0.0, 2.0 * np.pi)
senses = st.sampled_from([-1.0, 1.0])
powers = st.floats(-1.0, 1.0)
QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])


def turned(angle):
    return np.cos(angle) * np.eye(2) + np.sin(angle) * QUARTER


def bore(
    grooves, first, preload, cavitation, ratio=0.5, radius=0.05, clearance=1e-4, viscosity=0.02
):
    """Return a film of equal pads, the first groove at an angle."""
    middles = np.sort((first + 2.0 * np.pi * np.arange(grooves) / grooves) % (2.0 * np.pi))
    pads = grooved_pads(clearance / (1.0 - preload), middles, 0.3, preload)
    length = 2.0 * ratio * radius
    return OilFilm(radius, length, viscosity, pads, cavitation, nodes=60, axial_nodes=0)


def load_of(film, sommerfeld, speed, angle):
    """Return the load of a Sommerfeld number, (2,) [N]."""
    area = 2.0 * film.radius * film.length * (film.radius / film.clearance) ** 2
    size = film.viscosity * abs(speed) / (2.0 * np.pi) * area / sommerfeld
    return size * np.array([np.cos(angle), np.sin(angle)])


@examples
@given(
    preload=st.floats(0.0, 0.8),
    sommerfeld=st.floats(0.2, 10.0),
    sizes=st.tuples(powers, powers, powers, powers),
    angle=angles,
    turn=angles,
    sense=senses,
)
def test_films_of_one_sommerfeld_number_are_alike(preload, sommerfeld, sizes, angle, turn, sense):
    """ε, attitude, K c/W and C c Ω/W, of any size, viscosity and speed, turned and mirrored."""
    radius, clearance, viscosity, speed = (10.0 ** np.array(sizes)).tolist()
    one = bore(2, 0.3, preload, "reynolds")
    other = bore(
        2, sense * 0.3 + turn, preload, "reynolds", radius=0.05 * radius,
        clearance=1e-4 * clearance, viscosity=0.02 * viscosity,
    )  # fmt: skip
    speeds = 300.0, sense * 300.0 * speed
    loads = (
        load_of(one, sommerfeld, speeds[0], angle),
        load_of(other, sommerfeld, speeds[1], sense * angle + turn),
    )
    states = [
        film.equilibrium(speed, load)
        for film, speed, load in zip((one, other), speeds, loads, strict=True)
    ]
    assert states[1].eccentricity_ratio == pytest.approx(states[0].eccentricity_ratio, rel=1e-7)
    assert states[1].attitude == pytest.approx(states[0].attitude, abs=1e-7)
    mirror = turned(turn) @ np.diag([1.0, sense])
    found = []
    for state, load, axes in zip(states, loads, (np.eye(2), mirror), strict=True):
        stiffness, damping = (axes.T @ X @ axes for X in state.coefficients())
        unit = state.film.clearance / np.linalg.norm(load)
        found.append(unit * np.array([stiffness, abs(state.speed) * damping]))
    # the equilibria differ by 1e-9 of the load
    np.testing.assert_allclose(found[1], found[0], rtol=0.0, atol=1e-6 * np.abs(found[0]).max())


@examples
@given(start=angles, arc=st.floats(0.5, 6.0), ratio=st.floats(0.05, 3.0), sense=senses)
def test_a_full_film_about_the_middle_rests_in_whirl_at_half_the_speed(start, arc, ratio, sense):
    """There Reynolds' equation has Ω/2 ∂h/∂φ + ∂h/∂t = 0: K x + C (Ω/2) n × x = 0.

    On the grid the slope of h is sin(Δφ/2)/(Δφ/2) of itself.
    """
    film = OilFilm(
        0.05, 0.1 * ratio, 0.02, [Pad(start, arc, 1e-4)], "none", nodes=90, axial_nodes=4
    )
    speed = sense * 300.0
    stiffness, damping = film.state([0.0, 0.0], [0.0, 0.0], speed).coefficients()
    half = 0.5 * film.grid.step[0]
    expected = -0.5 * speed * np.sin(half) / half * damping @ QUARTER
    np.testing.assert_allclose(stiffness, expected, rtol=0.0, atol=1e-9 * np.abs(expected).max())
