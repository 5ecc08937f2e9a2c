"""Runs of rotors with magnetic bearings and on foundations begin in their steady motion."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from test_run_start import CRITICAL, ENDS, distances, rotor, to_axis

from exudyn_rotor import (
    Foundation,
    LinearActuator,
    MagneticBearing,
    Mount,
    PIDController,
    Support,
    add_foundation,
    add_rotor,
    add_supports,
    linear_model,
    unbalance_response,
)

SPEED = 0.7 * CRITICAL
CONTROLLER = PIDController(
    proportional=2e4,
    derivative=50.0,
    integral=2e5,
    delay=1e-4,
    filter_frequency=4e3,
    amplifier_frequency=2e3,
)
LEVITATED = [
    MagneticBearing(
        interface=name, actuator=LinearActuator(2.0, 2e4), controller=CONTROLLER, angle=0.4
    )
    for name in ENDS
]
SPRINGS = [Support(name, [[2e4, 0.0], [0.0, 3e4]], 40.0) for name in ENDS]
AXIAL = Support("left", np.diag([0.0, 0.0, 2e4]), 10.0)
BLOCK = Foundation.rigid(
    9.0,
    [0.4, 0.5, 0.1],
    [0.01, -0.1, 0.02],
    [Mount([x, -0.15, z], [3e4, 5e4, 4e4], 20.0) for x in (-0.1, 0.1) for z in (-0.2, 0.25)],
    {name: [0.0, 0.0, z] for name, z in ENDS.items()},
).with_damping_ratio(0.05)
KINDS = {
    "levitated": ([*LEVITATED, AXIAL], None),
    "on a block": ([*SPRINGS, AXIAL], BLOCK),
    "levitated above a block": ([LEVITATED[0], SPRINGS[1], AXIAL], BLOCK),
}


def model(kind, axis="z"):
    supports, foundation = KINDS[kind]
    foundation = foundation and foundation.turned(to_axis(axis))
    return linear_model(rotor(axis), supports=supports, foundation=foundation, stiffening="tilt")


def scene(kind, axis="z", supports=None, **options):
    given, foundation = KINDS[kind]
    mbs = exu.SystemContainer().AddSystem()
    options = {"spin": SPEED, "stiffening": "tilt"} | options
    body = add_rotor(mbs, rotor(axis), **options)
    base = None
    if foundation is not None:
        base = add_foundation(mbs, foundation.turned(to_axis(axis)))
    add_supports(body, given if supports is None else supports, base)
    mbs.Assemble()
    return mbs, body


def left(found, build):
    """Return by how much a run leaves the motion, extrapolated to small steps."""
    runs = []
    for steps in (50, 100):
        mbs, body = build()
        body.start_from(found.state(SPEED, body))
        runs.append(distances(mbs, body, found, SPEED, steps))
    assert np.abs(runs[0]).max() < 0.05
    return np.abs(4.0 * runs[1] - runs[0]).max() / 3.0


# share of the motion: what is left of the step's error in the fourth order
NO_TRANSIENT = 5e-5


@pytest.mark.parametrize(
    ("kind", "translation"), [*((kind, "none") for kind in KINDS), ("levitated", "free")]
)
def test_run_begins_in_steady_whirl(kind, translation):
    found = unbalance_response(model(kind), [0.5 * SPEED, SPEED], accuracy=None)
    assert left(found, lambda: scene(kind, translation=translation)) < NO_TRANSIENT


def test_response_of_a_scene_starts_its_controllers():
    mbs, body = scene("levitated above a block")
    found = unbalance_response(linear_model(mbs, body=body, about="given"), [SPEED])
    assert left(found, lambda: scene("levitated above a block")) < NO_TRANSIENT


def test_other_scenes_are_refused():
    kind = "levitated above a block"
    found = unbalance_response(model(kind), [SPEED], accuracy=None)
    levitated, spring, _ = KINDS[kind][0]
    for supports in ([spring], [replace(levitated, interface="right"), spring]):
        with pytest.raises(ValueError, match="give both the same supports"):
            found.state(SPEED, scene(kind, supports=supports)[1])
    with pytest.raises(ValueError, match="give both the same supports"):
        found.state(SPEED, scene("levitated")[1])
    mbs, body = scene(kind, supports=[])
    add_supports(body, [levitated], add_foundation(mbs, BLOCK))
    add_supports(body, [spring], add_foundation(mbs, BLOCK))
    mbs.Assemble()
    with pytest.raises(ValueError, match="stands on several foundations"):
        found.state(SPEED, body)
    mbs, body = scene("levitated", supports=[])
    add_supports(
        body, [levitated, spring], add_foundation(mbs, replace(BLOCK, mass=2.0 * BLOCK.mass))
    )
    mbs.Assemble()
    with pytest.raises(ValueError, match="another rotor than that"):
        found.state(SPEED, body)
