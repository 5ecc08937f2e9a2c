"""Tilting pads against closed forms: plane slider, light loads; and every direction of the load."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from exudyn_rotor import OilFilm, Pad, TiltingPadBearing

RADIUS, CLEARANCE, VISCOSITY, SPEED = 0.05, 1e-4, 0.02, 300.0


def bearing(pads, load, length=0.05, pivot=0.5, **options):
    film = OilFilm(RADIUS, length, VISCOSITY, pads, **{"nodes": 60, "axial_nodes": 0} | options)
    return TiltingPadBearing(interface="left", film=film, pivot=pivot, load=load)


def plane_slider(pivot):
    """Return the ratio K of a plane slider's film, h = h2 (1 + K (1 − x)), and its load.

    Of infinite width, over μ U B²/h2² (A. Cameron, *The Principles of Lubrication*, 1966, ch. 4);
    its centre of pressure is at `pivot`, of the length from the inlet.
    """

    def pressure(x, ratio):
        return 6.0 * ratio * x * (1.0 - x) / ((2.0 + ratio) * (1.0 + ratio * (1.0 - x)) ** 2)

    def load(ratio, power=0):
        return quad(lambda x: x**power * pressure(x, ratio), 0.0, 1.0)[0]

    ratio = brentq(lambda k: load(k, 1) / load(k) - pivot, 1e-3, 20.0)
    return ratio, load(ratio)


@pytest.mark.parametrize("sense", [-1.0, 1.0])
@pytest.mark.parametrize("pivot", [0.55, 0.62])
def test_a_narrow_pad_is_a_plane_slider(pivot, sense):
    """Two of them, from both sides, so that one carries: load and tilt, and stiffness 2 W/h.

    With a fixed pivot the ratio of the film's thicknesses stays, so that W ~ h^(−2). The pad's
    curvature leaves 0.0176 of the stiffness at an arc of 0.2, in proportion to the arc's square.
    """
    arc, sunk = 0.05, 0.3
    share = pivot if sense > 0.0 else 1.0 - pivot
    start = -arc * share
    pads = [Pad(start, arc, CLEARANCE), Pad(np.pi + start, arc, CLEARANCE)]
    ratio, load = plane_slider(pivot)
    at_pivot = (1.0 - sunk) * CLEARANCE
    thin = at_pivot / (1.0 + ratio * (1.0 - pivot))
    length = 100.0
    force = load * VISCOSITY * SPEED * RADIUS * (arc * RADIUS) ** 2 / thin**2 * length
    behind = force * ((1.0 - sunk) / (1.0 + sunk)) ** 2
    slider = bearing(pads, [force - behind, 0.0], length, share, nodes=8000, cavitation="none")
    place = slider.equilibrium(sense * SPEED)
    assert place[0] == pytest.approx(sunk * CLEARANCE, rel=2e-3)
    tilt = slider.tilts(sense * SPEED)[-1]  # pads are kept by their start
    assert abs(tilt) == pytest.approx(ratio * thin / (arc * RADIUS), rel=1e-2)
    stiffness = slider._state(sense * SPEED, slider.load).impedance(0.0).real
    expected = 2.0 * force / at_pivot + 2.0 * behind / ((1.0 + sunk) * CLEARANCE)
    assert stiffness[0, 0] == pytest.approx(expected, rel=2e-3)
