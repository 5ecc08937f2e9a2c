"""What bearings take from a rotor in a scene: balances of energy, and free spins they brake."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import SKEW_AXIS, ring_rotor
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    ClearanceStop,
    JournalBearing,
    OilFilm,
    RollingBearing,
    ShortJournalBearing,
    SolidRotor,
    SqueezeFilmDamper,
    StartState,
    Support,
    add_rotor,
    add_supports,
    grooved_pads,
    recommended_settings,
)
from exudyn_rotor.theory.axis import SpinAxis

RADIUS, MASS = 0.1, 20.0  # of the rotor, whose spin has the inertia M r²
INERTIA = MASS * RADIUS**2
OIL = {"radius": 0.05, "length": 0.02, "viscosity": 0.02}
PADS = grooved_pads(1e-4, [0.0, np.pi], 0.3)
ENDS = ("left", "right")


def stop(interface, **changes):
    sizes = {"radius": 0.05, "clearance": 1e-4, "stiffness": 4e6, "damping": 2e3, "friction": 0.2}
    return ClearanceStop(interface=interface, **(sizes | changes))


def rolling(interface):
    return RollingBearing(
        interface=interface,
        count=8,
        pitch_radius=0.03,
        element_radius=0.006,
        stiffness=7e9,
        clearance=5e-6,
        damping=200.0,
    )


KINDS = {
    "linear": lambda name: Support(name, [[2e6, 4e5], [-3e5, 1e6]], [[500.0, 40.0], [9.0, 300.0]]),
    "squeeze film": lambda name: SqueezeFilmDamper(
        interface=name, clearance=1e-4, centring_stiffness=2e6, **OIL
    ),
    "short film": lambda name: ShortJournalBearing(interface=name, clearance=1e-4, **OIL),
    "finite film": lambda name: JournalBearing(
        interface=name, film=OilFilm(**OIL, pads=PADS, nodes=36, axial_nodes=0)
    ),
    "stop": stop,
    "rolling": rolling,
}


def turned_rings(axis):
    """Return a rigid rotor about any axis, with interfaces at both ends."""
    upright = ring_rotor(RADIUS, 0.15, MASS)
    turn = Rotation.align_vectors([axis], [[0.0, 0.0, 1.0]])[0].as_matrix()
    whole = np.kron(np.eye(10), turn)
    rotor = SolidRotor.from_matrices(
        upright.mass, whole @ upright.stiffness @ whole.T, upright.nodes @ turn.T, axis
    )
    return rotor.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)


def run(make, step, end_time, axis=(0.0, 0.0, 1.0), place=(0.0, 0.0), rate=(0.0, 0.0), **options):
    """Run a rotor on two bearings; return these, motion and energy over the steps.

    `place` and `rate` are the start across the axis. Motion: time, spin angle, speed, and
    displacement and velocity (s, 2) along n1 and n2 of each bearing.
    """
    radius = options.pop("radius", 1.0)
    mbs = exu.SystemContainer().AddSystem()
    plane = SpinAxis(axis).plane
    if "load" in options:
        options["gravity"] = plane @ options.pop("load") / MASS
    body = add_rotor(mbs, turned_rings(np.array(axis)), markers="position", **options)
    bearings = [make(name) for name in ENDS]
    add_supports(body, bearings)
    kinds = exu.OutputVariableType
    sensors = [
        [body.add_interface_sensor(name, kind) for kind in (kinds.Displacement, kinds.Velocity)]
        for name in ENDS
    ]
    spin, energy = body.add_spin_sensor(), body.add_energy_sensor()
    mbs.Assemble()
    data = mbs.systemData
    q, q_t = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
    q[:3], q_t[:3] = plane @ place, plane @ rate
    body.start_from(StartState(q, q_t, 0.0, options["initial_speed"]))
    settings = recommended_settings(end_time, step, accuracy=1e-8)
    settings.timeIntegration.generalizedAlpha.spectralRadius = radius
    settings.timeIntegration.newton.useModifiedNewton = False
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    mbs.SolveDynamic(settings)
    time, angle, speed = mbs.GetSensorStoredData(spin).T[:3]
    across = [[mbs.GetSensorStoredData(each)[:, 1:] @ plane for each in group] for group in sensors]
    total = mbs.GetSensorStoredData(energy)[:, 1:].sum(axis=1)
    return bearings, (time, angle, speed, across), total


def force_of(bearing, u, v, angle, speed):
    """Return force [N] and torque [N m] on the journal by the bearing's law."""
    if isinstance(bearing, Support):
        K, D = (X[:2, :2] for X in bearing.matrices(0.0))
        return *(-K @ u - D @ v), 0.0
    if bearing.law_with_torque is None:
        return *bearing.law(*u, *v, angle, speed), 0.0
    return bearing.law_with_torque(*u, *v, angle, speed)


def work(bearings, motion):
    """Return the work on the rotor by the mean force of each step, exact for the trapezoidal rule.

    M Δv = h f̄ and Δu = h v̄ make M v̄·Δv = f̄·Δu.
    """
    _, angle, speed, across = motion
    total = 0.0
    for bearing, (u, v) in zip(bearings, across, strict=True):
        forces = np.array(
            [force_of(bearing, *each) for each in zip(u, v, angle, speed, strict=True)]
        )
        moves = np.diff(np.column_stack([u, angle]), axis=0)
        total += 0.5 * np.sum((forces[1:] + forces[:-1]) * moves)
    return total


SWING = {"rate": (0.05, 0.02), "initial_speed": 80.0}


@pytest.mark.parametrize("kind", KINDS)
def test_energy_lost_is_what_the_bearing_takes(kind):
    """To the tolerance of Newton's method, 1e-9, with the trapezoidal rule; the spin is free."""
    end_time = 0.0012 if kind == "finite film" else 0.006
    bearings, motion, energy = run(KINDS[kind], 2e-5, end_time, **SWING)
    lost = energy[0] - energy[-1]
    assert lost > 1e-3
    assert -work(bearings, motion) == pytest.approx(lost, abs=1e-8 * np.ptp(energy))
    if kind not in ("linear", "squeeze film"):
        assert np.ptp(motion[2]) > 1e-6


def test_what_is_left_with_damping_of_the_integrator_falls_with_the_square_of_the_step():
    """Generalised alpha at a spectral radius of 0.9 takes energy itself, of second order."""
    left = []
    for step in (4e-5, 2e-5):
        bearings, motion, energy = run(KINDS["short film"], step, 0.004, radius=0.9, **SWING)
        left.append(abs(energy[0] - energy[-1] + work(bearings, motion)) / np.ptp(energy))
    assert left[0] > 1e-8
    assert left[1] == pytest.approx(left[0] / 4.0, rel=0.2)


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), tuple(SKEW_AXIS), (-1.0, 0.0, 0.0)])
@pytest.mark.parametrize("kind", ["short film", "finite film"])
def test_films_brake_a_free_spin_as_petroff_says(kind, axis):
    """Centred journals, no load: Ω falls with exp(−t 2 b/I), b = μ R³ L/c by the covered angle."""
    h, end, speed = 2e-2, 0.5, 80.0
    _, motion, _ = run(KINDS[kind], h, end, axis=axis, initial_speed=speed)
    covered = sum(pad.arc for pad in PADS) if kind == "finite film" else 2.0 * np.pi
    b = covered * OIL["viscosity"] * OIL["radius"] ** 3 * OIL["length"] / 1e-4
    rate = 2.0 * b / INERTIA
    error = (rate * h) ** 2 / 12.0 * rate * end  # of the trapezoidal rule
    expected = speed * np.exp(-rate * end)
    assert motion[2][-1] == pytest.approx(expected, rel=2.0 * error + 1e-9)
    assert expected < 0.99 * speed


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), tuple(SKEW_AXIS)])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_stop_brakes_a_free_spin_by_coulombs_friction(axis, sense):
    """A rotor that lies in its stops, beside their lowest points: Ω falls by μ N R t/I.

    Force and friction carry the weight W: N = W/√(1 + μ²), at the angle arctan μ.
    """
    weight, friction, k = 200.0, 0.2, 4e6
    normal = weight / np.hypot(1.0, friction)
    at = (1e-4 + 0.5 * normal / k) * np.array([-sense * friction, -1.0]) / np.hypot(1.0, friction)
    _, motion, _ = run(
        stop, 2e-4, 0.05, axis=axis, place=at, initial_speed=80.0 * sense, load=[0.0, -weight]
    )
    time, _, speed, across = motion
    np.testing.assert_allclose(across[0][0][-1], at, rtol=1e-6)
    expected = sense * (80.0 - friction * normal * 0.05 / INERTIA * time[-1])
    assert speed[-1] == pytest.approx(expected, rel=1e-9)
    assert abs(speed[-1]) < 79.6
