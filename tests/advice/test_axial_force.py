"""The row of check_run that compares axial forces with the buckling load."""

import exudyn
import numpy as np
import pytest
from beam_models import BeamRotor
from models import STEEL

import exudyn_rotor as er

LENGTH, DIAMETER = 1.0, 0.02
EULER = np.pi**2 * STEEL["youngsModulus"] * np.pi * DIAMETER**4 / 64.0 / LENGTH**2


@pytest.mark.parametrize(("end", "share"), [("4", -0.2), ("4", 0.0005), ("2", -0.05)])
def test_a_thrust_in_a_scene_is_compared_with_the_buckling_load(end, share):
    """Hinged where it acts, at one end and at the end or the middle."""
    rotor = BeamRotor(tuple(np.linspace(0.0, LENGTH, 5)), 0.0, DIAMETER, STEEL, ()).reduced()
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, spin=100.0, translation="none", gravity=[0.0, -9.81, 0.0])
    held = [er.Support("0", 1e7 * np.eye(3), 1e4 * np.eye(3)), er.Support("4", 1e7, 1e4)]
    er.add_supports(body, held)
    force = [0.0, 0.0, share * EULER]
    mbs.AddLoad({"loadType": "ForceVector", "markerNumber": body.marker(end), "loadVector": force})
    body.start_recording()
    mbs.Assemble()
    settings = er.recommended_settings(0.02, 1e-4)
    settings.timeIntegration.verboseMode = 0
    mbs.SolveDynamic(settings)
    check = er.check_run(body, warn=False)
    length = float(rotor.interfaces[end].reference[2])
    row = check["axial force"]
    # the thrust begins at once and rings, to twice its size
    expected = abs(share) * (length / LENGTH) ** 2
    assert 0.8 * expected < row.value < 2.5 * expected
    assert row.ok == (expected < 1e-3)
