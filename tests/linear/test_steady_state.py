"""The steady motion of a scene: closed forms, runs that start from it, and static solutions."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import LoadForceVector
from point_rotors import ring_rotor
from scipy.optimize import brentq

from exudyn_rotor import (
    SqueezeFilmDamper,
    Support,
    add_rotor,
    add_supports,
    recommended_settings,
    steady_state,
)
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.probe import Probe

RADIUS, LENGTH, MASS, ADDED = 0.1, 0.2, 8.0, 0.01
TOTAL = MASS + 2 * ADDED  # kg
UNBALANCE = 2 * ADDED * RADIUS  # kg m
STIFFNESS, DAMPING = 2e4, 40.0  # N/m, N s/m, of each of the two bearings
GRAVITY = 9.81
CRITICAL = np.sqrt(2 * STIFFNESS / TOTAL)  # rad/s
DISPLACEMENT = exu.OutputVariableType.Displacement
ENDS = {"left": -LENGTH, "right": LENGTH}


@pytest.fixture(scope="module")
def reduced():
    """Return two rings, each with the same excess mass, so that the rotor whirls without tilt.

    The elastic modes do not move the mean of a ring but by differences of the two rings.
    """
    rotor = ring_rotor(RADIUS, LENGTH, MASS)
    for name, z in ENDS.items():
        rotor = rotor.add_point_mass([RADIUS, 0.0, z], ADDED)
        rotor = rotor.with_interface(name, np.flatnonzero(np.isclose(rotor.nodes[:, 2], z)))
    return rotor.reduce(2)


def build(reduced, spin, translation="none", stiffness=(STIFFNESS,) * 3, **options):
    """Return the rotor on two bearings, not assembled."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(
        mbs, reduced, spin=spin, translation=translation, markers="position", **options
    )
    for name, z in ENDS.items():
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[mbs.CreateGround(), body.marker(name)],
            localPosition0=[0.0, 0.0, z],
            stiffness=list(stiffness),
            damping=[DAMPING] * 3,
        )
    return mbs, body


def simulated(mbs, end, step):
    settings = recommended_settings(end, step, accuracy=1e-7)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)


# ------------------------------------------------------------------ closed forms


@pytest.mark.parametrize("translation", ["none", "free", "in-plane"])
@pytest.mark.parametrize("ratio", [0.5, 0.9, 1.5])
def test_whirl_of_a_jeffcott_rotor(reduced, translation, ratio):
    """The whirl is ``m e Ω²/(k − mΩ² + icΩ)``, and lags by its phase.

    The mean of a ring is the shaft's centre but for the elastic modes, which supports move by
    their stiffness over that of the rings, 1e8 N/m: 2e-4.
    """
    speed = ratio * CRITICAL
    mbs, body = build(reduced, speed, translation)
    mbs.Assemble()
    steady = steady_state(body)
    phasor = UNBALANCE * speed**2 / (2 * STIFFNESS - TOTAL * speed**2 + 2j * DAMPING * speed)
    for angle in (0.0, 1.0):
        motion = steady.interface_motion("left", angle)
        expected = phasor * np.exp(1j * angle)
        assert motion[0] + 1j * motion[1] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("translation", ["none", "free"])
@pytest.mark.parametrize("spin", [0.0, 30.0, "free"])
def test_sag_under_gravity(reduced, translation, spin):
    """``m g/k`` whatever the speed, in the mean of a revolution, and m g/k along the axis, too."""
    mbs, body = build(reduced, spin, translation, gravity=[0.0, -GRAVITY, 0.5 * GRAVITY])
    mbs.Assemble()
    motion = steady_state(body, 45.0 if spin == "free" else None).interface_motion("left")
    sag = TOTAL * GRAVITY / (2 * STIFFNESS)
    assert motion[:3] == pytest.approx([0.0, -sag, 0.5 * sag], rel=1e-3, abs=1e-3 * sag)


# ------------------------------------------------------------------ runs from there


@pytest.mark.parametrize("translation", ["none", "free"])
def test_run_from_the_steady_state_stays_on_it(reduced, translation):
    """Gravity, unbalance, supports that differ: the error is that of the step, of second order."""
    speed, turns = 0.7 * CRITICAL, 0.75

    def distance(steps):
        mbs, body = build(
            reduced,
            speed,
            translation,
            (STIFFNESS, 1.3 * STIFFNESS, STIFFNESS),
            gravity=[0.0, -GRAVITY, 0.0],
        )
        mbs.Assemble()
        steady = steady_state(body)
        body.start_from(steady.state())
        again = steady_state(body).interface_motion("right", 0.3)  # the scene is in this state
        assert again == pytest.approx(steady.interface_motion("right", 0.3), rel=1e-6, abs=1e-12)
        mbs.Assemble()  # the nodes keep it
        end = turns * 2 * np.pi / speed
        simulated(mbs, end, end / steps)
        found = mbs.GetMarkerOutput(body.marker("right"), DISPLACEMENT)
        expected = steady.interface_motion("right", speed * end)
        return np.abs(found - expected[:3]).max() / np.abs(expected[:3]).max()

    coarse, fine = distance(50), distance(100)
    # (Ωh)²/12 of the phase per radian, over 4.7 rad, in the oscillating part
    assert coarse < 4.7 * (4.7 / 50) ** 2 / 12
    assert fine == pytest.approx(coarse / 4.0, rel=0.2)


# ------------------------------------------------------------------ refusals


def test_load_that_varies_by_itself_is_refused(reduced):
    mbs, body = build(reduced, 40.0)
    mbs.AddLoad(
        LoadForceVector(
            markerNumber=body.marker("left"),
            loadVectorUserFunction=lambda mbs, t, load: [np.sin(55.0 * t), 0.0, 0.0],
        )
    )
    mbs.Assemble()
    with pytest.raises(UnconvergedError, match="does not repeat with every revolution"):
        steady_state(body)


@pytest.mark.parametrize("held", [[], ["left"]])
def test_load_that_nothing_holds_is_refused(reduced, held, monkeypatch):
    """Without smaller and smaller shares of it: at 12 angles, three times, and at 48, twice."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=40.0, translation="none", gravity=[0.0, -GRAVITY, 0.0])
    add_supports(body, [Support(name, STIFFNESS, DAMPING) for name in held])
    mbs.Assemble()
    angles, linearised = [], Probe.linearised
    counted = lambda *at: angles.append(at[1]) or linearised(*at)  # noqa: E731
    monkeypatch.setattr(Probe, "linearised", counted)
    with pytest.raises(UnconvergedError, match="nothing holds"):
        steady_state(body)
    assert len(angles) <= 3 * 12 + 2 * 48


# ------------------------------------------------------------------ where the search begins


def in_dampers(speed):
    """Return a balanced rotor with 5 g at its rim, in squeeze film dampers on centring springs."""
    rotor = ring_rotor(RADIUS, LENGTH, MASS)
    for name, z in ENDS.items():
        rotor = rotor.add_point_mass([RADIUS, 0.0, z], 0.0025)
        rotor = rotor.with_interface(name, np.flatnonzero(np.isclose(rotor.nodes[:, 2], z)))
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor.reduce(0), spin=speed, translation="none", markers="position")
    film = {"radius": 0.06, "length": 0.02, "clearance": 1.5e-4, "viscosity": 0.002}
    dampers = [SqueezeFilmDamper(interface=name, centring_stiffness=1e6, **film) for name in ENDS]
    add_supports(body, [*dampers, Support("right", np.diag([0.0, 0.0, 1e6]), 10.0)])
    mbs.Assemble()
    return body


def test_a_second_branch_is_found_from_a_motion_on_it():
    """Circles in short films of 180°: L. San Andrés, Modern Lubrication Theory, Notes 13."""
    c, mass, stiffness, unbalance = 1.5e-4, MASS + 0.005, 2e6, 5e-4
    critical = np.sqrt(stiffness / mass)
    speed = 2.5 * critical
    size = 2.0 * 0.002 * 0.06 * 0.02**3 / c**2 * speed

    def left(e):
        radial = (stiffness - mass * speed**2) * e * c + 2.0 * size * e**2 / (1.0 - e**2) ** 2
        return np.hypot(radial, 0.5 * np.pi * size * e / (1.0 - e**2) ** 1.5) - unbalance * speed**2

    grid = np.linspace(0.01, 0.95, 2000)
    ends = np.flatnonzero(np.diff(np.sign([left(e) for e in grid])))
    small, _, large = (brentq(left, grid[i], grid[i + 1]) for i in ends)
    near = steady_state(in_dampers(1.5 * critical))
    for ratio in (2.0, 2.3):
        near = steady_state(in_dampers(ratio * critical), start=near)
    body = in_dampers(speed)
    for start, expected in ((None, small), (near, large), (near.state(), large)):
        motion = steady_state(body, start=start).interface_motion("left", 0.0)
        assert np.hypot(*motion[:2]) / c == pytest.approx(expected, rel=1e-3)
