"""Eccentric rotors that start at another angle than zero: they turn about their axis."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    PrescribedMotion,
    ShortJournalBearing,
    Support,
    add_rotor,
    add_supports,
    bearing_loads,
    linear_model,
    recommended_settings,
    stability,
)
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates

SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
DISPLACEMENT = exu.OutputVariableType.Displacement
STARTS = {
    "free": {"initial_angle": 2.0},
    "in-plane": {"initial_angle": 2.0, "translation": "in-plane"},
    "none": {"initial_angle": 2.0, "translation": "none"},
    "node in the mesh origin": {"initial_angle": 2.0, "frame_node": "mesh_origin"},
    "run-up": {"spin": PrescribedMotion.run_up(0.0, 20.0, 0.1, angle=2.0)},
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
    mbs, bare = exu.SystemContainer().AddSystem(), exu.SystemContainer().AddSystem()
    placed = {"rotation": SKEW, "position": [0.3, -0.1, 0.2]} | STARTS[start]
    body = add_rotor(mbs, rotor, **placed)
    sensor = body.add_interface_sensor("all", DISPLACEMENT)
    mbs.Assemble()
    assert np.abs(mbs.GetSensorValues(sensor)).max() < 1e-12 * off
    alone = add_rotor(bare, rotor, marker_body=False, **placed)
    bare.Assemble()
    count = alone.formulation.translation_count
    moved = np.linalg.norm(alone.coordinates()[0][:count])
    assert moved == pytest.approx(2.0 * np.sin(1.0) * off if count else 0.0)


@pytest.mark.parametrize("about", ["given", "equilibrium", "steady"])
def test_linear_model_of_a_scene_does_not_depend_on_where_the_rotor_starts(about):
    """Films feel it if the journal is off its place by a share of the clearance."""
    reduced, gravity, growth = eccentric(1e-3).reduce(0), [0.0, -9.81, 0.0], []
    loads = bearing_loads(reduced, ["left", "right"], gravity)
    films = [
        ShortJournalBearing(
            interface=name, radius=0.02, length=0.01, clearance=8e-5, viscosity=0.02, load=load
        )
        for name, load in zip(("left", "right"), loads, strict=True)
    ]
    for angle in (0.0, 2.5):
        mbs = exu.SystemContainer().AddSystem()
        body = add_rotor(mbs, reduced, gravity=gravity, initial_speed=50.0, initial_angle=angle)
        add_supports(body, [*films, Support("left", np.diag([0.0, 0.0, 1e5]), 10.0)])
        mbs.Assemble()
        model = linear_model(mbs, body=body, about=about)
        growth.append(np.sort(stability(model, [50.0], accuracy=None).exponents[0].real))
    np.testing.assert_allclose(growth[1], growth[0], rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("axis", [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]], ids=str)
def test_rotor_that_has_run_on_is_where_it_is_when_turned_back(axis):
    """Its axis has not moved, wherever the rotor stops, and whatever way its node counts."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, eccentric(0.1, axis).reduce(0), spin=50.0)
    add_supports(body, Support("all", 1e9, 1e5, tilt_stiffness=1e7, tilt_damping=1e3))
    mbs.Assemble()
    settings = recommended_settings(end_time=0.05, step=1e-4)
    settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
    mbs.SolveDynamic(settings)
    coordinates = SceneCoordinates.of(body)
    off = np.linalg.norm(body.axis.radial(body.selection.origin))
    assert np.abs(coordinates.rest[coordinates.free[:3]]).max() < 1e-4 * off
