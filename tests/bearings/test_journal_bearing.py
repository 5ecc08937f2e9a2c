"""Journal bearings: film, equilibrium, coefficients, in scenes and in linear analyses."""

import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    JournalBearing,
    OilFilm,
    ShortJournalBearing,
    bearing_loads,
    grooved_pads,
    stability,
    stability_threshold,
)
from exudyn_rotor.bearings.support import NoCoefficientsError

SIZE = {"radius": 0.05, "length": 0.03, "clearance": 1e-4, "viscosity": 0.1}
SPEED = 1500.0 * np.pi / 30.0


def bearing(load=(0.0, -525.0), interface="left", **changes):
    return ShortJournalBearing(interface=interface, load=load, **(SIZE | changes))


def test_equilibrium_and_coefficients_of_a_published_bearing():
    """Friswell, Penny, Garvey, Lees: Dynamics of Rotating Machines (2010), Example 5.5.1."""
    K, D = bearing().coefficients(SPEED)
    assert bearing().eccentricity_ratio(SPEED) == pytest.approx(0.2663, abs=5e-5)
    np.testing.assert_allclose(K / 1e6, [[12.81, 16.39], [-25.06, 8.815]], atol=6e-3)
    np.testing.assert_allclose(D / 1e3, [[232.9, -81.92], [-81.92, 294.9]], atol=6e-2)


@pytest.mark.parametrize("speed", [SPEED, -SPEED])
@pytest.mark.parametrize("load", [(0.0, -525.0), (3e4, 1e4), (1.0, 0.0)])
def test_coefficients_are_the_derivatives_of_the_force(speed, load):
    one = bearing(load)
    rest = one.equilibrium(speed)
    np.testing.assert_allclose(one.law(*rest, 0.0, 0.0, 0.0, speed), np.negative(load), rtol=0.0,
                               atol=1e-9 * np.hypot(*load))  # fmt: skip
    K, D = one.coefficients(speed)
    step = 1e-5 * (SIZE["clearance"] - np.hypot(*rest))
    for matrix, move in ((K, (step, 0.0)), (D, (0.0, step * abs(speed)))):
        columns = [
            [
                np.array(one.law(*(rest + sign * move[0] * n), *(sign * move[1] * n), 0.0, speed))
                for sign in (1, -1)
            ]
            for n in np.eye(2)
        ]
        found = -np.array([a - b for a, b in columns]).T / (2.0 * max(move))
        np.testing.assert_allclose(found, matrix, atol=1e-6 * np.abs(matrix).max())


def test_friction_of_a_light_load_is_petroffs():
    """2π μ Ω R³ L/c for a centred journal; H. Petroff 1883."""
    petroff = 2.0 * np.pi * 0.1 * SPEED * 0.05**3 * 0.03 / 1e-4
    light, loaded = bearing((0.0, 0.0)), bearing()
    for one, least, most in ((light, 1.0 - 1e-12, 1.0 + 1e-12), (loaded, 1.02, np.inf)):
        place = one.equilibrium(SPEED)
        torque = -one.law_with_torque(*place, 0.0, 0.0, 0.0, SPEED)[2]
        assert least * petroff <= torque <= most * petroff


GRAVITY = [0.0, -9.81, 0.0]


def rigid_rotor(mass=107.0):
    """Return a rigid rotor with journals at z = ±0.15 m."""
    rotor = ring_rotor(0.1, 0.15, mass)
    return rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)


def journals(rotor, **changes):
    loads = bearing_loads(rotor, ["left", "right"], GRAVITY)
    return [
        bearing(load, name, **changes) for name, load in zip(("left", "right"), loads, strict=True)
    ]


def limit_of_a_rigid_rotor(ratio):
    """Return c Ω² m/W at the limit of stability of a mass on one short bearing.

    By the Routh criterion (J. W. Lund 1966) with the dimensionless coefficients a, b of Friswell
    et al., Eqs. (5.85): ``κ = (a_xx b_yy + a_yy b_xx − a_xy b_yx − a_yx b_xy)/(b_xx + b_yy)``,
    whirl ratio ``ν² = ((a_xx − κ)(a_yy − κ) − a_xy a_yx)/(b_xx b_yy − b_xy b_yx)``, ``κ/ν²``.
    """
    e2, p2 = ratio**2, np.pi**2
    root = np.sqrt(1.0 - e2)
    size = (p2 * (1.0 - e2) + 16.0 * e2) ** -1.5
    a = size * np.array([
        [4 * (p2 * (2 - e2) + 16 * e2), np.pi * (p2 * (1 - e2) ** 2 - 16 * e2**2) / (ratio * root)],
        [-np.pi * (p2 * (1 - e2) * (1 + 2 * e2) + 32 * e2 * (1 + e2)) / (ratio * root),
         4 * (p2 * (1 + 2 * e2) + 32 * e2 * (1 + e2) / (1 - e2))],
    ])  # fmt: skip
    cross = -8 * (p2 * (1 + 2 * e2) - 16 * e2)
    b = size * np.array([
        [2 * np.pi * root * (p2 * (1 + 2 * e2) - 16 * e2) / ratio, cross],
        [cross, 2 * np.pi * (p2 * (1 - e2) ** 2 + 48 * e2) / (ratio * root)],
    ])  # fmt: skip
    k = (a[0, 0] * b[1, 1] + a[1, 1] * b[0, 0] - a[0, 1] * b[1, 0] - a[1, 0] * b[0, 1]) / np.trace(
        b
    )
    return k * np.linalg.det(b) / np.linalg.det(a - k * np.eye(2))


def test_stability_limit_of_a_rigid_rotor_is_the_published_one():
    rotor = rigid_rotor()
    supports = journals(rotor)
    found = stability_threshold(rotor, 50.0, 1500.0, supports=supports)
    limit = found.values[0]
    ratio = supports[0].eccentricity_ratio(limit)
    expected = np.sqrt(limit_of_a_rigid_rotor(ratio) * 9.81 / SIZE["clearance"])
    assert limit == pytest.approx(expected, rel=1e-5)
    # stable at any speed above an eccentricity of 0.756 (A. G. Holmes 1960)
    assert limit_of_a_rigid_rotor(0.7555) > 0.0 > limit_of_a_rigid_rotor(0.7565)


def test_refused_input():
    rotor = rigid_rotor()
    with pytest.raises(ValueError, match="'left': linear analyses need its static load"):
        stability(rotor, [SPEED], supports=[bearing(load=None)])
    nothing = "bearing at 'left': at 0 rad/s its film carries nothing"
    with pytest.raises(NoCoefficientsError, match=nothing):
        journals(rotor)[0].linearised().check_range(0.0)
    with pytest.raises(ValueError, match=nothing):
        stability(rotor, [0.0], supports=journals(rotor))


def film_bearing(interface="left", load=(0.0, -525.0), **changes):
    pads = grooved_pads(SIZE["clearance"], [], 0.0)
    options = {"cavitation": "half-sommerfeld", "nodes": 240, "axial_nodes": 0}
    sizes = {name: SIZE[name] for name in ("radius", "length", "viscosity")}
    return JournalBearing(
        interface=interface, load=load, film=OilFilm(pads=pads, **(sizes | options | changes))
    )


def test_a_narrow_film_of_finite_length_is_the_short_bearing():
    """L/D = 0.05; what the short bearing leaves out falls with (L/D)²."""
    long, short = film_bearing(length=0.005, load=(0.0, -1.0)), bearing((0.0, -1.0), length=0.005)
    np.testing.assert_allclose(
        long.equilibrium(SPEED), short.equilibrium(SPEED), atol=5e-3 * SIZE["clearance"]
    )
    for found, expected in zip(long.coefficients(SPEED), short.coefficients(SPEED), strict=True):
        np.testing.assert_allclose(found, expected, atol=0.02 * np.abs(expected).max())
