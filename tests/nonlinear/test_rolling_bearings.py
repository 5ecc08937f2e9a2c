"""Steady motion on rolling bearings against runs, an integration in time, and earlier values."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor
from scipy.integrate import solve_ivp

import exudyn_rotor as er
from exudyn_rotor.nonlinear import continuation

BALLS = {"count": 8, "pitch_radius": 0.0326, "element_radius": 0.006, "stiffness": 7e9}
DOWN, UPRIGHT, MASS = [0.0, -9.81, 0.0], [0.0, 0.0, -9.81], 20.0


def bearing(interface="seat", **changes):
    return er.RollingBearing(interface=interface, **(BALLS | {"damping": 1500.0} | changes))


def point(axis="z"):
    solid = er.SolidRotor.from_matrices(MASS * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], axis)
    return solid.with_interface("seat", [0]).reduce(0)


def response(one, speeds, amount=0.0, gravity=DOWN, rotor=None, **options):
    given = [er.Unbalance("seat", amount)] if amount else ()
    options = {"tolerance": 1e-2, "follow": False, "supports": one} | options
    return er.periodic_response(rotor or point(), speeds, given, gravity=gravity, **options)


def integrated(one, speed, amount, length, kept, gravity):
    """Return times and places of a mass on one bearing, after its transient."""
    phases = 2.0 * np.pi / one.count * np.arange(one.count)

    def rates(t, y):
        angle = phases + 0.5 * (1.0 - one.element_radius / one.pitch_radius) * speed * t
        normals = np.array([np.cos(angle), np.sin(angle)])
        loads = one.stiffness * np.maximum(y[:2] @ normals - one.clearance, 0.0) ** 1.5
        spin = amount * speed**2 * np.array([np.cos(speed * t), np.sin(speed * t)])
        force = spin - normals @ loads - one.damping * y[2:] + MASS * np.array(gravity[:2])
        return np.r_[y[2:], force / MASS]

    times = np.linspace(length - kept, length, 300)
    run = solve_ivp(rates, (0.0, length), [0.0, -1e-5, 0.0, 0.0], t_eval=times, rtol=1e-6,
                    atol=1e-11, max_step=5e-4)  # fmt: skip
    return times, run.y[:2].T


@pytest.mark.parametrize(
    ("speed", "changes", "amount", "gravity"),
    [
        (280.0, {"clearance": 5e-6}, 0.0, DOWN),  # at the resonance of the ball pass
        (100.0, {"clearance": 2e-5}, 1e-3, DOWN),  # swaying by unbalance
        (600.0, {"clearance": 2e-5}, 3e-3, DOWN),  # orbiting, elements lifting off
    ],
)
def test_motion_is_that_of_an_integration_in_time(speed, changes, amount, gravity):
    one = bearing(damping=4000.0, **changes)
    found = response(one, [speed], amount, gravity)
    times, expected = integrated(one, speed, amount, 0.12, 0.03, gravity)  # m/c = 5 ms
    away = np.abs(found.displacement(0, times) - expected).max()
    assert found.errors[0] <= 1e-2
    assert away < 1e-2 * np.ptp(expected, axis=0).max()


def test_upright_rotor_whirls_by_a_small_unbalance():
    """Newton's method comes there from larger unbalances alone."""
    one = bearing(clearance=1e-6, damping=4000.0)
    found = response(one, [100.0], 1e-4, UPRIGHT)
    times, path = integrated(one, 100.0, 1e-4, 0.15, 0.05, [0.0, 0.0])  # m/c = 5 ms
    assert np.abs(found.displacement(0, times) - path).max() < 1e-2 * np.ptp(path)


def test_vertical_rotor_circles_with_the_unbalance():
    """With many balls a circle of radius r: Q(r) = mΩ²r + √((U Ω²)² − (c Ω r)²)."""
    one, speed, amount = bearing(count=60, element_radius=1e-3, clearance=1e-5), 400.0, 1e-3
    found = response(one, [speed], amount, UPRIGHT)
    radius = np.abs(found.phasor("seat", "n1")[0])
    drag = one.damping * speed * radius
    force = MASS * speed**2 * radius + np.sqrt((amount * speed**2) ** 2 - drag**2)
    assert radius == pytest.approx(one.equilibrium(0.0, [force, 0.0])[0], rel=1e-3)


@pytest.mark.parametrize("founded", [True, False])
def test_a_run_from_it_stays_on_it(founded):
    """With clearance on a block on mounts; or with unbalance and a spring that turns."""
    spin, places = 300.0, {"left": [0.0, 0.0, -0.15], "right": [0.0, 0.0, 0.15]}
    rings = ring_rotor(0.1, 0.15, MASS).with_interface("left", range(5))
    rings = rings.with_interface("right", range(5, 10))
    given = {"supports": [er.Support("left", np.diag([0.0, 0.0, 1e6]))]}
    if founded:
        mounts = [er.Mount([x, -0.2, z], 2e6, 2e3) for x in (-0.2, 0.2) for z in (-0.2, 0.2)]
        block = er.Foundation.rigid(10.0, [0.4, 0.4, 0.4], [0.0, -0.1, 0.0], mounts, places)
        given["foundation"] = block
    else:
        rings = rings.add_point_mass([0.1, 0.0, 0.15], 2e-4)
        given["supports"].append(er.Support("right", [[5e6, 0.0], [0.0, 0.0]], frame="rotor"))
    clearance = 5e-6 if founded else 0.0
    given["supports"] += [bearing(name, clearance=clearance) for name in places]
    reduced = rings.reduce(0)
    options = {"gravity": DOWN, "tolerance": 1e-2, "follow": False}
    found = er.periodic_response(reduced, [spin], **given, **options)
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, reduced, spin=spin, gravity=DOWN, translation="none")
    base = er.add_foundation(mbs, block, gravity=DOWN) if founded else None
    er.add_supports(body, given["supports"], base)
    sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    body.start_from(found.state(0, body))
    settings = er.recommended_settings(end_time=0.01, step=2e-5)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 2e-5
    mbs.SolveDynamic(settings)
    path = mbs.GetSensorStoredData(sensor)
    moved = path[:, 1:] @ body.standing_axes[:, :2]
    away = np.abs(moved - found.displacement(0, path[:, 0], "left")).max()
    assert away < 1e-2 * np.ptp(moved, axis=0).max()


def test_lacking_harmonics_are_told(monkeypatch):
    monkeypatch.setattr(continuation, "_MOST_UNKNOWNS", 40)
    with pytest.warns(UserWarning, match="at 0 harmonics that are left out have"):
        response(bearing(), [0.0], tolerance=1e-6)


def test_a_speed_without_a_motion_costs_no_other():
    """A table that ends: beyond it there are no coefficients."""
    table = er.Support("seat", ([0.0, 250.0], [np.diag([1e5, 1e5, 1e6])] * 2))
    with pytest.warns(UserWarning, match="no steady motion was found at, .* 300"):
        found = response([table, bearing()], [100.0, 200.0, 300.0])
    assert found.values.tolist() == [100.0, 200.0]
