"""The same scene in another size runs along the same path: lengths by s, masses by s³, equal times.

Then stiffness and damping grow with s³, and forces with s⁴.
"""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor

from exudyn_rotor import (
    ClearanceStop,
    SolidRotor,
    Support,
    add_rotor,
    add_supports,
    recommended_settings,
)

GAP, STEPS, TIME = 2e-5, 600, 0.012


def path(s, accuracy):
    """Return the path of an unbalanced rotor in stops, over the clearance."""
    rings = ring_rotor(0.1, 0.15, 5.0)
    scaled = SolidRotor.from_matrices(
        s**3 * rings.mass, s**3 * rings.stiffness, s * rings.nodes, "z", check_units=False
    )
    rotor = scaled.with_interface("left", range(5)).with_interface("right", range(5, 10))
    rotor = rotor.add_point_mass([0.1 * s, 0.0, 0.15 * s], 2e-3 * s**3)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(
        mbs, rotor.reduce(2), spin=400.0, gravity=[0.0, -9.81 * s, 0.0], translation="none"
    )
    for name in ("left", "right"):
        stop = ClearanceStop(
            interface=name, radius=0.02 * s, clearance=GAP * s, stiffness=4e6 * s**3,
            damping=2e3 * s**3, friction=0.1, slip_speed=0.01 * s,
        )  # fmt: skip
        add_supports(body, [Support(name, 2e5 * s**3, 600.0 * s**3), stop])
    sensor = body.add_interface_sensor("right", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    settings = recommended_settings(TIME, TIME / STEPS, accuracy=accuracy, body=body)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = TIME / STEPS
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)[:, 1:3] / (GAP * s)


@pytest.mark.parametrize("s", [1e-3, 0.04, 10.0])
def test_scaled_contacts_have_the_same_path(s):
    """To the accuracy that was asked for; 1 is a rotor of 0.3 m, 1e-3 one of 0.3 mm."""
    expected = path(1.0, 1e-8)
    size = np.linalg.norm(expected, axis=1).max()
    assert size > 1.5  # in contact
    assert np.abs(path(s, 1e-4) - expected).max() < 1e-4 * size
    assert np.abs(path(s, 1e-8) - expected).max() < 1e-6
