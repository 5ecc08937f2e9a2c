"""Magnetic bearings on foundations, against a state space written here and against scenes."""

from dataclasses import replace

import apart as models
import exudyn as exu
import numpy as np
import pytest
import scipy.linalg as la
from scipy.interpolate import CubicSpline
from test_base_motion import SHAKEN
from test_foundations import BLOCK, POINTS, two_masses
from test_magnetic_bearing import (
    DELAYED,
    K_I,
    K_S,
    MAGNETS,
    PD,
    PID,
    apart,
    bearing,
    closed_loop,
    pair,
    rigid,
)
from test_supports_in_scenes import SKEW, SPEED, TO_X, rings

from exudyn_rotor import (
    Support,
    Unbalance,
    add_base_motion,
    add_foundation,
    add_rotor,
    add_supports,
    base_response,
    campbell,
    critical_speed_map,
    critical_speeds,
    linear_model,
    recommended_settings,
    sensitivity,
    stability,
    stability_map,
    unbalance_response,
)
from exudyn_rotor.reduction.driven import without_spin
from exudyn_rotor.theory.rotating_axes import axes_of

AXIAL = Support("right", np.diag([0.0, 0.0, 5e5]), 0.0, np.diag([0.0, 0.0, 4e3]))
OWN = (1.5e6, 4e6)
FAST = 800.0


def levitated(one, own, speed):
    """Return the state space of a rigid rotor of 5 kg above a foundation of 5 kg, as x + iy.

    Coordinates: translation and tilt of the rotor, translation of the foundation on the stiffness
    `own`.
    """
    m, r, half = 5.0, 0.1, 0.15
    inertia = np.diag([m, m * (0.5 * r**2 + half**2), m])
    places = [np.array([1.0, side * half, -1.0]) for side in (-1.0, 1.0)]
    gyroscopic = np.diag([0.0, speed * m * r**2, 0.0])
    return closed_loop(inertia, gyroscopic, np.diag([0.0, 0.0, own]), places, places, one)


def on_foundation(one, own):
    """Return the rotor and what it stands on, without damping but that of the controllers."""
    rotor, _, foundation = two_masses(own=(own, own))
    on = {"supports": [*pair(controller=one), AXIAL], "foundation": foundation.undamped()}
    return rotor, on


def test_exponents_at_rest_are_those_of_the_state_space():
    rotor, on = on_foundation(DELAYED, OWN[0])
    values = la.eigvals(levitated(DELAYED, OWN[0], 0.0)[0])
    found = stability(linear_model(rotor, **on), [0.0], accuracy=None).exponents[0]
    values = values[np.abs(values.imag) > 1.0]
    assert apart(np.r_[found, found.conj()], values) < 1e-7


def test_sensitivity_is_that_of_the_state_space():
    """Of the rotor that spins: the mean of forward and backward whirl."""
    frequencies = np.array([300.0, 310.0])
    rotor, on = on_foundation(PD, OWN[0])
    found = sensitivity(rotor, frequencies, **on, speed=FAST)
    A, drive, seen = levitated(PD, OWN[0], FAST)
    for w, values in zip(frequencies, found.values[:, [0, -1]].T, strict=True):
        sides = [seen @ la.solve(1j * w * np.eye(len(A)) - X, drive) for X in (A, A.conj())]
        np.testing.assert_allclose(values, 1.0 + 0.5 * sum(sides), rtol=1e-8)


def in_scene(rotor, supports, block=BLOCK, rotation=None, **options):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, rotation=rotation, **options)
    add_supports(body, supports, add_foundation(mbs, block, rotation=rotation))
    mbs.Assemble()
    return linear_model(mbs, body=body, about="given")


KINDS = {
    "elsewhere, turned": [bearing(angle=0.5, sensor="right"), bearing("right", angle=9.0)],
    "magnets and a spring": [
        bearing(actuator=MAGNETS, controller=PD),
        Support("right", [[2e6, 5e5], [-5e5, 1e6]], 400.0),
    ],
    "in both frames": [
        bearing(controller=PID),
        Support("right", [[2e6, 0.0], [0.0, 1e6]], frame="rotor"),
    ],
}


@pytest.mark.parametrize(("turn", "rotation"), [(TO_X, None), (SKEW, TO_X)], ids=["x", "skew"])
@pytest.mark.parametrize("kind", KINDS)
def test_scene_and_list_have_the_same_exponents(kind, turn, rotation):
    rotor, supports = rings(turn, heavy=0.0), [*KINDS[kind], AXIAL]
    block = (BLOCK if turn is None else BLOCK.turned(turn)).modal()
    options = {"spin": SPEED, "translation": "none"}
    found = in_scene(rotor, supports, block, rotation, **options)
    in_list = linear_model(without_spin(rotor), supports=supports, foundation=block)
    assert models.apart(found, in_list, SPEED) < 1e-6


def test_public_analyses_take_scene_and_list_alike():
    """Supports, and a foundation, that differ along n1 and n2."""
    rotor, _, block = two_masses(own=OWN)
    block = replace(block, places=POINTS)
    soft = Support("right", [[2e6, 0.0], [0.0, 3e6]], 2e3)
    supports = [bearing(controller=PD, sensor="right"), soft, AXIAL]
    model = linear_model(rotor, supports=supports, foundation=block)
    targets = model, in_scene(rotor, supports, block, spin=0.0, drive="elastic")
    unbalance, at = Unbalance("left", 1e-4), ["left", "right"]
    ours, theirs = (
        unbalance_response(each, [SPEED], unbalance, at=at, accuracy=None).motion[..., :5]
        for each in targets
    )
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-7 * np.abs(ours).max())
    lowest = [campbell(e, [SPEED], modes=6, accuracy=None).frequencies_inertial for e in targets]
    np.testing.assert_allclose(*map(np.sort, lowest), rtol=1e-7, atol=1e-5)
    growth = [stability(each, [SPEED], accuracy=None).growth.max() for each in targets]
    assert growth[0] == pytest.approx(growth[1], rel=1e-6)


def test_maps():
    """Over the stiffness of the springs, and over that of the foundation and the speed."""
    rotor, _, block = two_masses(own=(3e6, 3e6))
    magnets, axial = pair(controller=PD)[:1], [AXIAL]
    on = {"supports": [*magnets, *axial], "foundation": block}
    speeds = critical_speed_map(rotor, "right", [1e6, 3e6], **on, accuracy=None)
    for stiffness, found in zip(speeds.stiffnesses, speeds.speeds, strict=True):
        static = Support("left", K_I * PD.proportional - K_S)
        supports = [static, Support("right", stiffness), *axial]
        model = linear_model(rotor, supports=supports, foundation=block)
        expected = critical_speeds(model, nodal_diameters=[1], accuracy=None).speeds
        np.testing.assert_allclose(found[np.isfinite(found)], expected, rtol=1e-9)

    def build(stiffness, speed):
        ground = replace(block, stiffness=np.diag([stiffness, stiffness, 1e6]))
        supports = [*pair(controller=PD), *axial]
        return linear_model(rotor, supports=supports, foundation=ground), speed

    found = stability_map(build, [3e6], [SPEED], accuracy=None)
    expected = stability(build(3e6, 0.0)[0], [SPEED], accuracy=None)
    assert found.growth[0, 0] == pytest.approx(expected.growth.max(), rel=1e-9)


def test_shaken_ground_moves_scene_and_list_alike():
    """By the integrator's second order."""
    supports = [*pair(controller=PD), Support("left", np.diag([1e5, 2e5, 1e6]), 50.0)]
    model = linear_model(rigid(), supports=supports, foundation=BLOCK)
    found = base_response(model, SHAKEN, speed=SPEED, end_time=0.02, tolerance=1e-4, at="left")
    exact = CubicSpline(found.time, found.displacement("left") @ axes_of(rigid().axis).T)
    errors = []
    for step in (1e-4, 5e-5):
        mbs = exu.SystemContainer().AddSystem()
        body, base = add_rotor(mbs, rigid(), spin=SPEED), add_foundation(mbs, BLOCK)
        add_base_motion(mbs, SHAKEN, [body, base])
        add_supports(body, supports, base)
        sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
        mbs.Assemble()
        settings = recommended_settings(end_time=0.018, step=step)
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = 1e-3
        mbs.SolveDynamic(settings)
        stored = mbs.GetSensorStoredData(sensor)
        expected = exact(stored[:, 0])
        errors.append(np.abs(stored[:, 1:4] - expected).max() / np.abs(expected).max())
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] < 3e-4
