"""Runs end where a journal leaves its clearance in an accepted step, not in a trial."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import LoadForceVector
from exudyn.utilities import InertiaCuboid
from point_rotors import ring_rotor

import exudyn_rotor as er

CLEARANCE, SPEED = 1e-4, 300.0
TO_X = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
SHORT = {"radius": 0.05, "length": 0.03, "clearance": CLEARANCE, "viscosity": 0.02}


def film(preload=0.0, grooves=(0.0, np.pi)):
    pads = er.grooved_pads(CLEARANCE, grooves, 0.3, preload)
    return er.OilFilm(0.05, 0.05, 0.02, pads, nodes=36, axial_nodes=0)


KINDS = {
    "short journal": er.ShortJournalBearing(interface="left", **SHORT),
    "film": er.JournalBearing(interface="left", film=film()),
    "lemon bore": er.JournalBearing(interface="left", film=film(0.5)),
    "upright lemon bore": er.JournalBearing(  # half of the clearance along x, 0.87 along y
        interface="left", film=film(0.5, (0.5 * np.pi, 1.5 * np.pi))
    ),
    "squeeze film": er.SqueezeFilmDamper(interface="left", centring_stiffness=1e6, **SHORT),
    "seal": er.AnnularSeal(
        interface="left", radius=0.1, length=0.04, clearance=CLEARANCE, pressure_drop=1e6,
        density=1000.0, viscosity=1e-3,
    ),
    "tilting pads": er.TiltingPadBearing(
        interface="left", film=film(0.3, np.radians([30.0, 150.0, 270.0])), pad_inertia=1e-4
    ),
    "magnets": er.MagneticBearing(
        interface="left",
        actuator=er.SaturatingActuator(
            constant=1e-5, bias_current=2.0, gap=CLEARANCE, current_limit=3.0
        ),
        controller=er.PIDController(
            proportional=3e5, derivative=50.0, filter_frequency=6e4, amplifier_frequency=3e4
        ),
    ),
}  # fmt: skip


def sled(mbs):
    """Return a base that moves."""
    block = InertiaCuboid(density=1e6, sideLengths=[1.0, 1.0, 1.0])
    return mbs.CreateRigidBody(inertia=block, initialVelocity=[0.0, 2.0, 0.0])


def scene(bearings, load=0.0, base=None, **options):
    rotor = ring_rotor(0.1, 0.15, 20.0)
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, **(options or {"spin": SPEED}))
    held = er.Support("right", 1e7, 1e3)
    added = er.add_supports(body, [*bearings, held], base and base(mbs))
    if load:
        mbs.AddLoad(LoadForceVector(markerNumber=body.marker("left"), loadVector=[0.0, load, 0.0]))
    mbs.Assemble()
    return mbs, body, added


def start(mbs, body, rate=0.0, place=0.0):
    """Let the rotor begin with a rate [m/s] and a place [m] along y."""
    initial, system = exu.ConfigurationType.Initial, mbs.systemData
    second = mbs.GetNodeODE2Index(body.nodes["rigid"]) + 1
    rates, places = (
        np.array(read(initial)) for read in (system.GetODE2Coordinates_t, system.GetODE2Coordinates)
    )
    rates[second], places[second] = rate, place
    system.SetODE2Coordinates_t(rates, initial)
    system.SetODE2Coordinates(places, initial)


def run(mbs, end_time=4e-3, step=1e-4, change=None, **how):
    settings = er.recommended_settings(end_time=end_time, step=step)
    settings.solution.file.write = False
    if change is not None:
        change(settings.timeIntegration)
    return mbs.SolveDynamic(settings, **how)


def adaptive_steps(integration):
    integration.adaptiveStep, integration.numberOfSteps = True, 4
    integration.newton.maxIterations = 5  # takes a sixteenth of the first step


CASES = {  # kind, options of the scene, start, and of the run
    "slowly": ("seal", {"load": -3e4}, {}, {}),
    "through a film": ("short journal", {"load": -3e6}, {}, {}),
    "braked": ("film", {"load": -3e5, "initial_speed": 1.0}, {"place": -0.98 * CLEARANCE}, {}),
    "another axis": ("seal", {"load": -3e4, "spin": SPEED, "rotation": TO_X}, {}, {}),
    "explicit steps": (
        "seal",
        {"load": -3e4, "spin": SPEED, "locking": "mass"},
        {},
        {"solverType": exu.DynamicSolverType.DOPRI5},
    ),
    "adaptive steps": ("short journal", {"load": -3e5}, {}, {"change": adaptive_steps}),
    "a base that leaves": ("seal", {"base": sled}, {}, {}),
    "across in a step": ("seal", {}, {"rate": -30.0, "place": 0.9 * CLEARANCE}, {}),
    "magnets": ("magnets", {"load": -6e4}, {}, {}),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_a_run_ends_at_the_first_step_outside(case):
    """That is the first of a run that is not looked at, by places of markers; twice."""
    kind, options, beginning, how = CASES[case]
    mbs, body, added = scene([KINDS[kind]], **options)
    start(mbs, body, **beginning)
    distances = {}

    def own(mbs, t):
        distances[t] = np.hypot(*added[0].values()[0][:2])
        return distances[t] < CLEARANCE

    made = added[0].connector
    guard, made.guard = made.guard, None
    mbs.SetPostStepUserFunction(own)
    run(mbs, **how)
    made.guard = guard
    mbs.SetPostStepUserFunction(0)
    time, distance = distances.popitem()
    assert distance >= CLEARANCE
    assert all(each < CLEARANCE for each in distances.values())
    for _ in range(2):
        with pytest.raises(ValueError, match="left its bearing") as error:
            run(mbs, **how)
        assert f" at t = {time:g} s: its journal is {distance:.3g} m from" in str(error.value)
