"""Friction between a rotor and what carries its bearings: balance of momentum, Petroff's torque."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import SensorNode
from point_rotors import ring_rotor
from rings import run

import exudyn_rotor as er

RADIUS, LENGTH, CLEARANCE, VISCOSITY, SPEED = 0.05, 0.02, 2e-4, 0.02, 80.0
ENDS = {"left": [0.0, 0.0, -0.15], "right": [0.0, 0.0, 0.15]}
PADS = er.grooved_pads(CLEARANCE, np.radians([10.0, 130.0, 250.0]), 0.2, 0.5)
FILM = er.OilFilm(RADIUS, LENGTH, VISCOSITY, PADS, "none", nodes=24, axial_nodes=0)
KINDS = {
    "short": lambda name: er.ShortJournalBearing(
        interface=name, radius=RADIUS, length=LENGTH, clearance=CLEARANCE, viscosity=VISCOSITY
    ),
    "finite": lambda name: er.JournalBearing(interface=name, film=FILM),
    "pads": lambda name: er.TiltingPadBearing(interface=name, film=FILM, pad_inertia=3e-4),
}


def states(mbs, node):
    """Add sensors of a node's coordinates and their rates."""
    kinds = exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t
    return [
        mbs.AddSensor(SensorNode(nodeNumber=node, outputVariableType=one, storeInternal=True))
        for one in kinds
    ]


def rotor_in_a_scene():
    rings = ring_rotor(0.1, 0.15, 5.0).with_interface("left", range(5))
    reduced = rings.with_interface("right", range(5, 10)).reduce(0)
    mbs = exu.SystemContainer().AddSystem()
    return mbs, er.add_rotor(mbs, reduced, initial_speed=SPEED, translation="none"), reduced


@pytest.mark.parametrize("kind", KINDS)
def test_what_the_rotor_loses_of_its_momentum_the_block_gains(kind):
    """About the axis: I ΔΩ of the rotor, and of the block its own with the moments of its mounts.

    The journal is in the middle of its bearing; to the error of the trapezoidal rule.
    """
    mbs, body, reduced = rotor_in_a_scene()
    mounts = [er.Mount([x, -0.3, z], 2e5, 2e2) for x in (-0.2, 0.2) for z in (-0.2, 0.2)]
    block = er.Foundation.rigid(3.0, [0.05, 0.05, 0.02], [0.0, 0.0, 0.0], mounts, ENDS)
    base = er.add_foundation(mbs, block)
    er.add_supports(body, [KINDS[kind](name) for name in ENDS], base)
    block_motion, spin = states(mbs, base.node), body.add_spin_sensor()
    run(mbs, 5e-3, 25, accuracy=1e-8)
    time, _, speed = mbs.GetSensorStoredData(spin).T[:3]
    y, y_t = (mbs.GetSensorStoredData(number)[:, 1:] for number in block_motion)
    lost = reduced.invariants.Theta * (speed[-1] - speed[0])
    moments = (y @ block.stiffness + y_t @ block.damping)[:, 5]
    gained = (y_t @ block.mass)[-1, 5] + np.trapezoid(moments, time)
    assert lost < 0.0
    assert abs(lost + gained) < 1e-6 * abs(lost)


@pytest.mark.parametrize("kind", KINDS)
def test_the_drive_of_a_prescribed_spin_gives_the_friction(kind):
    """N. Petroff (1883), with the journal in the middle of two bearings."""
    _, _, reduced = rotor_in_a_scene()
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, spin=SPEED, translation="none")
    er.add_supports(body, [KINDS[kind](name) for name in ENDS])
    drive = body.add_drive_torque_sensor()
    run(mbs, 1e-4, 2, accuracy=1e-8)
    torque = mbs.GetSensorStoredData(drive)[0, 1]  # before pads tilt
    bearing = KINDS[kind]("left")
    parts = bearing.pad_bearings if kind == "pads" else [bearing]
    laws = [part.law_with_torque(0.0, 0.0, 0.0, 0.0, 0.0, SPEED)[2] for part in parts]
    assert torque == pytest.approx(-2.0 * sum(laws), rel=1e-9)
    if kind == "short":
        petroff = 2.0 * np.pi * VISCOSITY * RADIUS**3 * LENGTH * SPEED / CLEARANCE
        assert torque == pytest.approx(2.0 * petroff, rel=1e-9)
