"""Wrong input of scenes: every error names the value and what to do, and adds nothing."""

from types import SimpleNamespace

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import MarkerBodyMass, MarkerBodyRigid
from rings import rings
from run_scenes import item_counts

import exudyn_rotor as er

OUTPUTS, STATES = exu.OutputVariableType, exu.ConfigurationType
UNIT = np.eye(6)
BLOCK = er.Foundation(UNIT, UNIT, UNIT, {"left": UNIT, "far": UNIT}, {"left": [0.0, 0.0, -0.15]})
SHAKEN = er.BaseRecord([0.0, 0.1, 0.2, 0.3], np.ones((4, 3)))
LEFT, POINT = er.Support("left", 1e6), er.Support("point", 1e6)
STOP = er.ClearanceStop(interface="point", radius=0.1, clearance=1e-4, stiffness=1e6, friction=0.1)
STATE = er.StartState(np.zeros(3), np.zeros(3), 0.0, 60.0)


@pytest.fixture(scope="module")
def s():
    """Rotors in one system, and items in it and in another; refusals leave them as they are."""
    mbs, other = exu.SystemContainer().AddSystem(), exu.SystemContainer().AddSystem()
    solid = rings().with_interface("point", [0])
    few = solid.reduce(2)
    held = er.add_rotor(mbs, few, name="held", spin=60.0, translation="none")
    free = er.add_rotor(mbs, few, name="free", markers={"left": "rigid"})
    bare = er.add_rotor(mbs, few.without_shapes(), name="bare")
    full = er.add_rotor(mbs, solid, name="full", spin=60.0)
    gone = exu.SystemContainer().AddSystem()
    lost = er.add_rotor(gone, few, name="lost", spin=60.0)
    gone.DeleteObject(lost.objects["physics"])
    block = er.add_foundation(other, BLOCK)
    beside = er.add_rotor(other, few, name="beside", spin=60.0)
    other.Assemble()
    ground = mbs.CreateGround(referencePosition=[1.0, 0.0, 0.0])
    far = mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground))
    weight = mbs.AddMarker(MarkerBodyMass(bodyNumber=held.objects["marker_body"]))
    point_mass = mbs.CreateMassPoint(referencePosition=[0.0, 0.0, -0.15], mass=1.0)
    spring = mbs.CreateCartesianSpringDamper(itemNumbers=[ground, point_mass])
    turn = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]
    place = [-0.15, 0.0, -0.15]
    skew = er.add_rotor(mbs, few, name="skew", rotation=turn, position=place)
    across = skew.marker("right")
    free.add_spin_sensor(name="speed")
    return SimpleNamespace(**locals())


def add(rotor="few", **options):
    return lambda s: er.add_rotor(s.mbs, getattr(s, rotor), **options)


def put(one, body="held", base=None):
    return lambda s: er.add_supports(getattr(s, body), one, base and getattr(s, base))


CALLS = [
    (add("solid", mass_damping=1.0), "mass_damping: a full body"),
    (add("solid", modal_coordinates=np.ones(30)), "modal_coordinates: .* a mean motion of"),
    (add(translation="none", initial_velocity=[1.0, 0.0, 0.0]), "no such motion, 1 m/s of"),
    (add(spin=60.0, initial_speed=60.0), "spin given twice: .* leave these out"),
    (add("solid", stiffening="full"), "needs the static .* prestress=True"),
    (add(spin_coupling="frozen", spin=10.0), "needs spin='free'"),
    # wrong by 2 % of the motion under a torque of 50 N m
    (add(spin_coupling="frozen", translation="none"), "translation='free' or"),
    (add(spin_coupling="half"), "spin_coupling: .*'half'"),
    (add(stiffening="full"), "needs the static .* prestress=True"),
    (add(color=[0.0, 0.0, 2.0, 1.0]), r"color: needs 4 numbers from 0 to 1 .* got \[0.0, 0.0, 2"),
    (add(name="held"), "already has a marker 'held:left'"),
    (lambda s: er.add_drive(s.held, er.Drag(linear=1.0)), "'held' has a prescribed spin, which"),
    (lambda s: er.add_drive(s.free, er.Drag(linear=1.0), base=s.far), "give at='…', an interface"),
    (lambda s: er.add_drive(s.free, er.Drag(linear=1.0), at="point"), "'point' is a single node"),
    (
        lambda s: er.connect_rotors(
            er.GearMesh(radii=[1, 1], stiffness=1.0), *2 * [s.free, "left"]
        ),
        "other: needs another rotor",
    ),
    (lambda s: s.full.stress(), "rotor 'full' has no elements .* SolidRotor.from_ngsolve"),
    (lambda s: er.linear_model(s.mbs, body=s.full), "'full' is a full body, .* rotor.reduce"),
    (lambda s: s.held.add_energy_sensor(names="a"), "names: is no option .* takes name, store"),
    (lambda s: s.held.add_energy_sensor(name="speed"), "already has a sensor 'speed'; choose"),
    (lambda s: s.free.add_drive_torque_sensor(), "'free' spins freely and has no drive"),
    (lambda s: s.beside.start_recording(), "'beside' is assembled already; call this before"),
    (lambda s: s.bare.add_marker([0, 1, 2]), "'bare' has no shapes .* name an interface, got"),
    (lambda s: s.bare.add_node_sensor(0, OUTPUTS.Position), "no shapes, so no mesh nodes, got 0"),
    (lambda s: s.held.add_marker([0, 0, 1]), r"needs different nodes, got \[0, 0, 1\]"),
    (lambda s: s.held.add_marker([0, 1]), r"the nodes \[0, 1\] lie on a line .* kind='position'"),
    (lambda s: s.beside.coordinates(STATES.Reference), "one of Initial, .* got Reference"),
    (lambda s: s.held.coordinates(), "'held' has no state; call mbs.Assemble"),
    (lambda s: s.lost.coordinates(), "no longer holds rotor 'lost'"),
    (lambda s: s.free.marker("right"), "'free' has no marker for 'right'; markers: left"),
    (lambda s: s.beside.start_from(STATE), "state: has 3 coordinates, this system has"),
    (
        lambda s: s.beside.start_from(er.StartState(np.zeros(22), np.zeros(22), 0.0, 50.0)),
        "state: is one at 0 rad and 50 rad/s, .* starts at 0 rad and 60 rad/s",
    ),
    (lambda s: er.recommended_settings(1.0, 2.0), "step: 2.0 s is longer than end_time, 1.0 s"),
    (lambda s: er.recommended_settings(1.0, 1e-15), r"step: 1e-15 s makes 1e\+15 steps"),
    (
        put(er.SeriesSupport(interface="left", inner=LEFT, outer=LEFT, mass=1.0)),
        "has a ring, .* add the ring as a rotor",
    ),
    (put(STOP, "free"), "its torque would not brake .* 'point'|single node"),
    (put(er.Support("left", 1e6, mass=np.diag([1.0, 2.0]))), "mass: a scene takes one number"),
    (put(er.Support("left", 1e6, 0.0, np.eye(3)), "free"), "stiffness about the spin axis"),
    (put(LEFT, base="far"), "marker .* is 1.01 m off the interface 'left', .* put it there"),
    (put(LEFT, base="weight"), "a rigid marker with a frame of its own, got marker 23"),
    (
        lambda s: er.add_supports(s.held, LEFT, s.held.marker("left")),
        "'held' itself, .* stands beside it",
    ),
    (lambda s: er.add_supports(s.held, LEFT, exu.MarkerIndex(99)), "this system has no marker 99"),
    (lambda s: er.add_supports(s.held, LEFT, s.point_mass), "base: needs a rigid body with a node"),
    (put(LEFT, base="spring"), "the object .* has no place and orientation; give a rigid"),
    (put(LEFT, base="block"), "base: this foundation is in another mbs"),
    (put(STOP, base="across"), "another rotor, which has an axis .* not parallel .* 'held'; turn"),
    (lambda s: s.block.marker("far"), "place of the point 'far' is not known; give places="),
    (lambda s: er.add_foundation(s.mbs, BLOCK, gravity=[0, 0, 9.8]), "with its participation"),
    (lambda s: er.add_base_motion(s.mbs, SHAKEN, s.beside), "bodies: one is in another mbs"),
]


@pytest.mark.parametrize(("call", "message"), CALLS)
def test_what_scenes_refuse(s, call, message):
    before = item_counts(s.mbs), item_counts(s.other)
    with pytest.raises((ValueError, TypeError), match=message):
        call(s)
    assert (item_counts(s.mbs), item_counts(s.other)) == before
