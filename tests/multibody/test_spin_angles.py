"""Which angle of the marker body's node is the spin angle."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import random_arrays
from scipy.spatial.transform import Rotation

import exudyn_rotor as er

KINDS = exu.OutputVariableType
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()


# in-plane, the plane is skew in space and held by a constraint


@pytest.fixture
def skew_scene():
    arrays = random_arrays(3)
    solid = er.SolidRotor.from_matrices(
        **arrays | {"stiffness": 3e5 * arrays["stiffness"]},
        axis=[1.0, 2.0, 2.0],
        interfaces={"a": [0, 1, 2, 3]},
    )
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, solid.reduce(3), rotation=SKEW, initial_speed=20.0)
    return solid, mbs, body


OFFSET = np.array([0.3, -0.2, 0.5])


def test_added_markers_have_mesh_axes_and_their_offset(skew_scene):
    solid, mbs, body = skew_scene
    interface = solid.interfaces["a"]
    markers = [
        body.add_marker("a", OFFSET),
        body.add_marker([0, 1, 2, 3], OFFSET, name="own"),
        body.add_marker("a", OFFSET, kind="position"),
    ]
    expected = solid.nodes[:4].T @ interface.weights + OFFSET
    mbs.Assemble()
    for marker in markers:
        place = mbs.GetMarkerOutput(marker, KINDS.Position, exu.ConfigurationType.Initial)
        np.testing.assert_allclose(place, SKEW @ expected, atol=1e-12)
    for marker in markers[:2]:
        turn = mbs.GetMarkerOutput(marker, KINDS.RotationMatrix, exu.ConfigurationType.Initial)
        np.testing.assert_allclose(np.reshape(turn, (3, 3)), SKEW, atol=1e-12)
    assert int(mbs.GetMarkerNumber("own")) == int(markers[1])


def test_force_at_an_added_marker_has_its_lever(skew_scene):
    """A force at the offset moves the rotor like a force and a moment at the interface."""
    force = np.array([3.0, -1.0, 2.0])
    ends = []
    for where, offset, kind in (
        ("a", OFFSET, "rigid"),
        ([0, 1, 2, 3], OFFSET, "rigid"),
        ("a", OFFSET, "position"),
        (None, np.zeros(3), "rigid"),
    ):
        solid, _, _ = skew_scene
        mbs = exu.SystemContainer().AddSystem()
        body = er.add_rotor(mbs, solid.reduce(3), spin=0.0, translation="none")
        marker = body.add_marker(where, offset, kind=kind) if where else body.marker("a")
        mbs.CreateForce(itemNumber=marker, loadVector=force.tolist())
        if not where:
            mbs.CreateTorque(itemNumber=marker, loadVector=np.cross(OFFSET, force).tolist())
        mbs.Assemble()
        settings = er.recommended_settings(end_time=1e-3, step=1e-4)
        settings.solution.file.write = False
        settings.timeIntegration.verboseMode = 0
        mbs.SolveDynamic(settings)
        ends.append(body.coordinates()[0])
    for end in ends[1:]:
        # levers change with the deflection, 1e-6 here
        np.testing.assert_allclose(end, ends[0], atol=1e-5 * abs(ends[0]).max())
