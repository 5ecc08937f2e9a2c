"""Balances of energy of what takes energy in a scene.

A rotor on two elements of one kind, eccentric, about a skew axis, with a motor and drag: what it
has lost, what the elements store and have lost, less what is fed in, is the error of trapezoidal
rules. Half of the step leaves a quarter, but for the next order, two percent here; a force that
is not what its loss says leaves a remainder that stays.
"""

from inspect import isabstract

import exudyn as exu
import numpy as np
import pytest
from element_losses import KINDS, MASS, Motion, around
from exudyn.itemInterface import SensorNode
from point_rotors import SKEW_AXIS
from rings import rings, run
from scipy.spatial.transform import Rotation

import exudyn_rotor as er
from exudyn_rotor.bearings.bearing import LoadedBearing

ENDS = ("left", "right")
TURN = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
HEAVY, SPEED = MASS - 5.0, 80.0
OUTPUTS = exu.OutputVariableType
ACROSS = OUTPUTS.Displacement, OUTPUTS.Velocity
STATES = OUTPUTS.Coordinates, OUTPUTS.Coordinates_t


def states(mbs, node):
    """Add sensors of a node's coordinates and their rates."""
    return [
        mbs.AddSensor(SensorNode(nodeNumber=node, outputVariableType=one, storeInternal=True))
        for one in STATES
    ]


def watched(mbs, body, added, axes):
    """Add sensors; return a function that gives the motion at both ends and the rotor's energy."""
    ends = [[body.add_interface_sensor(name, output) for output in ACROSS] for name in ENDS]
    spin, energy, own = body.add_spin_sensor(), body.add_energy_sensor(), []
    for one in added:
        made = one.connector
        own.append(states(mbs, made.nodes[-1]) if made is not None and made.own else [])

    def read():
        time, angle, speed = mbs.GetSensorStoredData(spin).T[:3]
        across = [[mbs.GetSensorStoredData(n)[:, 1:] @ axes for n in each] for each in ends]
        # the rotor is rigid: its ends tell the tilts
        tilts = [around(right - left)[:, :2] / 0.3 for left, right in zip(*across, strict=True)]
        parts = [[mbs.GetSensorStoredData(n)[:, 1:] for n in each] or [None] * 2 for each in own]
        return [
            Motion(angle, speed, *moves, *tilts, time, *each)
            for moves, each in zip(across, parts, strict=True)
        ], mbs.GetSensorStoredData(energy)[:, 1:].sum(axis=1)

    return read


def rotor_in_a_scene(**options):
    """Return system, rotor, axes (n1, n2, e), and the same as the rotor is mounted."""
    mbs, reduced = exu.SystemContainer().AddSystem(), rings(SKEW_AXIS, HEAVY).reduce(0)
    axes = np.column_stack([reduced.axis.plane, reduced.axis.direction])
    for name in ("gravity", "initial_velocity"):
        options[name] = TURN @ axes @ options.get(name, np.zeros(3))
    if "spin" not in options:
        options["initial_speed"] = SPEED
    body = er.add_rotor(mbs, reduced, rotation=TURN, **options)
    return mbs, body, axes, TURN @ axes


def start(mbs, body, place=0.0, tilts=True):
    """Start beside the middle [m], and with rates of tilts."""
    mbs.Assemble()
    q, q_t = mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()
    q[:3] += place
    q_t[6:8] += tilts * np.array([0.3, -0.2])
    body.start_from(er.StartState(q, q_t, 0.0, SPEED))


def remainder(m, energy, lost, fed, first=0):
    """Return what is left of the balance from an instant on [J]."""
    return energy[-1] - energy[first] + np.trapezoid((lost - fed)[first:], m.time[first:])


def totals(kind, ends):
    """Return stored energy, power lost and fed in of the elements at both ends."""
    shares = [kind.shares(m) for m in ends]
    return [sum(getattr(each, name) for each in shares) for name in ("stored", "lost", "fed")]


def left_over(kind, step, steps):
    move = [0.0] * 3 if kind.weight else [0.02, 0.05, 0.01]
    mbs, body, _, axes = rotor_in_a_scene(
        initial_velocity=move, gravity=[0.0, -kind.weight / MASS, 0.0]
    )
    added = er.add_supports(body, [kind.make(name) for name in ENDS])
    er.add_drive(body, er.DirectCurrentMotor(stall_torque=5.0, no_load_speed=100.0))
    er.add_drive(body, er.Drag(linear=0.01))
    read = watched(mbs, body, added, axes)
    start(mbs, body, axes[:, :2] @ kind.start, not kind.weight)
    run(mbs, step * steps, steps, accuracy=1e-8)
    ends, energy = read()
    stored, lost, fed = totals(kind, ends)
    speed = ends[0].speed
    lost, fed = lost + 0.01 * speed**2, fed + 5.0 * (1.0 - speed / 100.0) * speed
    return remainder(ends[0], energy + stored, lost, fed)


@pytest.mark.filterwarnings("ignore:rotor 'rotor'. no node of Exudyn turns")
@pytest.mark.parametrize("name", KINDS)
def test_balance_errs_by_the_square_of_the_step(name):
    kind = KINDS[name]
    left = [left_over(kind, kind.step / f, kind.steps * f) for f in (1, 2)]
    assert left[0] / left[1] == pytest.approx(4.0, rel=0.02)


def driven(kind, step, steps):
    mbs, body, _, axes = rotor_in_a_scene(spin=SPEED, initial_velocity=[0.02, 0.05, 0.01])
    added = er.add_supports(body, [kind.make(name) for name in ENDS])
    drive, read = body.add_drive_torque_sensor(), watched(mbs, body, added, axes)
    start(mbs, body)
    run(mbs, step * steps, steps, accuracy=1e-8)
    ends, energy = read()
    stored, lost, fed = totals(kind, ends)
    power = SPEED * mbs.GetSensorStoredData(drive)[:, 1]
    # the torque at the start is not recorded, and that of the first steps swings about it
    return remainder(ends[0], energy + stored, lost, fed + power, 6 * steps // kind.steps)


@pytest.mark.filterwarnings("ignore:rotor 'rotor'. no node of Exudyn turns")
@pytest.mark.parametrize("name", ["linear", "tilt-springs", "squeeze-film"])
def test_drive_of_a_constant_speed_makes_up_for_supports(name):
    """Uneven springs against tilts take from it and give back."""
    kind = KINDS[name]
    left = [driven(kind, kind.step / f, kind.steps * f) for f in (1, 2)]
    assert left[0] / left[1] == pytest.approx(4.0, rel=0.1)


def test_every_bearing_has_its_balance():
    found, kinds = {er.Support}, [LoadedBearing]
    while kinds:
        kind = kinds.pop()
        kinds += kind.__subclasses__()
        if kind.__module__.startswith("exudyn_rotor") and not isabstract(kind):
            found.add(kind)
    assert found == {type(kind.make("left")) for kind in KINDS.values()}
