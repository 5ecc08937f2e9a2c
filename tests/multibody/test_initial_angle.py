"""Eccentric rotors that start at another angle than zero: they turn about their axis."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor
from scipy.spatial.transform import Rotation

import exudyn_rotor as er

SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
DISPLACEMENT = exu.OutputVariableType.Displacement
STARTS = {
    "free": {"initial_angle": 2.0},
    "in-plane": {"initial_angle": 2.0, "translation": "in-plane"},
    "none": {"initial_angle": 2.0, "translation": "none"},
    "run-up": {"spin": er.PrescribedMotion.run_up(0.0, 20.0, 0.1, angle=2.0)},
}


def eccentric(mass, axis="z"):
    """Return rings with a mass at their rim, and interfaces at both and everywhere."""
    rotor = ring_rotor(0.1, 0.1, 2.0, axis).add_point_mass([0.1, 0.0, 0.0], mass)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.with_interface("all", range(10))


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("full", [False, True])
def test_rotor_starts_on_its_axis(start, full):
    """Bearings are not deflected, and the centre of mass is at 2 d sin(θ/2) from its place at 0."""
    rotor = eccentric(0.1)
    off = np.linalg.norm(rotor.center_of_mass[:2])
    rotor = rotor if full else rotor.reduce(0)
    mbs = exu.SystemContainer().AddSystem()
    placed = {"rotation": SKEW, "position": [0.3, -0.1, 0.2]} | STARTS[start]
    body = er.add_rotor(mbs, rotor, **placed)
    sensor = body.add_interface_sensor("all", DISPLACEMENT)
    mbs.Assemble()
    assert np.abs(mbs.GetSensorValues(sensor)).max() < 1e-12 * off
    count = body.motion.translations.stop
    moved = np.linalg.norm(body.coordinates()[0][:count])
    assert moved == pytest.approx(2.0 * np.sin(1.0) * off if count else 0.0)
