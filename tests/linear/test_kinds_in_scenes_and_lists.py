"""Every kind of bearing in a scene and in a list: both have the same linear equations.

An uneven mesh, its axis skew in space, under five times its weight.
"""

import exudyn as exu
import numpy as np
import pytest
from apart import apart
from models import disc_with_two_modes
from scipy.spatial.transform import Rotation
from test_magnetic_bearing import DELAYED, LINEAR

import exudyn_rotor as er

ENDS = ("left", "right")
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
SPEED, HEAVY = 300.0, 5.0 * np.array([0.0, -9.81, 0.0])
CORNERS = [[x, -0.3, z] for x in (-0.2, 0.2) for z in (-0.1, 0.6)]
BLOCK = er.Foundation.rigid(
    80.0,
    [4.0, 5.0, 1.0],
    [0.0, -0.2, 0.2],
    [er.Mount(corner, 4e6, 2e3) for corner in CORNERS],
    {"left": [0.0, 0.0, 0.0], "right": [0.0, 0.0, 0.5]},
)
OIL = {"radius": 0.06, "length": 0.02, "clearance": 2e-4, "viscosity": 0.01}
BALLS = {"count": 8, "pitch_radius": 0.033, "element_radius": 0.006, "stiffness": 7e9}
PUMP = {"radius": 0.04, "length": 0.03, "clearance": 3e-4, "pressure_drop": 1e6}
CROSSED = np.array([[5e6, 1e6, 2e5], [-5e5, 8e6, 1e5], [1e5, -2e5, 2e6]])
LOSSES = np.array([[500.0, 80.0, 20.0], [-60.0, 400.0, 30.0], [10.0, -20.0, 200.0]])
TILTS, TILT_LOSSES = np.array([[2e4, 5e3], [-3e3, 1e4]]), np.array([[9.0, 2.0], [1.0, 5.0]])
RISING = ([0.0, 200.0, 900.0], [CROSSED, 1.5 * CROSSED, 2.0 * CROSSED.T])


def springs(name):
    return er.Support(name, 5e6, 500.0)


KINDS = {
    "damper": lambda name, load: [
        er.SqueezeFilmDamper(interface=name, load=load, centring_stiffness=5e6, **OIL)
    ],
    "damper on an orbit": lambda name, load: [
        er.SqueezeFilmDamper(interface=name, load=load, centring_stiffness=5e6, orbit=0.4, **OIL)
    ],
    "balls": lambda name, load: [
        er.RollingBearing(interface=name, load=load, damping=500.0, clearance=1e-6, **BALLS)
    ],
    "preloaded rollers": lambda name, load: [
        er.RollingBearing(
            interface=name, load=load, damping=9e2, clearance=-2e-6, elements="rollers",
            **BALLS | {"stiffness": 2e8},
        )
    ],
    "seal": lambda name, load: [
        er.AnnularSeal(interface=name, density=1000.0, viscosity=1e-3, **PUMP), springs(name)
    ],
    "stop": lambda name, load: [
        er.ClearanceStop(interface=name, radius=0.02, clearance=5e-4, stiffness=1e7, friction=0.2),
        springs(name),
    ],
    "magnets": lambda name, load: [
        er.MagneticBearing(interface=name, load=load, actuator=LINEAR, controller=DELAYED)
    ],
    "table": lambda name, load: [er.Support(name, RISING, ([0.0, 900.0], [LOSSES, 2.0 * LOSSES]))],
    "rotor frame": lambda name, load: [
        er.Support(name, CROSSED, 0.2 * LOSSES, frame="rotor"), er.Support(name, 0.0, LOSSES)
    ],
    "tilts": lambda name, load: [
        er.Support(name, CROSSED, LOSSES, TILTS, TILT_LOSSES), springs(name)
    ],
}  # fmt: skip


THRUST = er.Support("right", np.diag([0.0, 0.0, 1e6]), np.diag([0.0, 0.0, 100.0]))


def models(make, base=None, free=False, gravity=HEAVY, heavy=0.0):
    """Return the scene and the list of a disc on a shaft, as linear models."""
    return on_ends(disc_with_two_modes(heavy), make, base, free, gravity)


def on_ends(reduced, make, base=None, free=False, gravity=HEAVY):
    loads = er.bearing_loads(reduced, list(ENDS), gravity)
    supports = [each for pair in zip(ENDS, loads, strict=True) for each in make(*pair)]
    supports.append(THRUST)
    spin = {"initial_speed": SPEED} if free else {"spin": SPEED, "translation": "none"}
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, gravity=SKEW @ gravity, rotation=SKEW, **spin)
    er.add_supports(body, supports, base and er.add_foundation(mbs, base, rotation=SKEW))
    mbs.Assemble()
    in_list = er.linear_model(reduced, supports=supports, foundation=base)
    return er.linear_model(mbs, body=body), in_list


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_the_exponents_of_its_list(kind):
    """Dampers differed by 0.3 of the speed and more, rolling bearings by 0.2 of it."""
    assert apart(*models(KINDS[kind]), SPEED) < 1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_on_a_block_with_a_free_spin(kind):
    """Supports against tilts differed by 1.7e-6 of the speed."""
    assert apart(*models(KINDS[kind], BLOCK, free=True), SPEED) < 1e-6
