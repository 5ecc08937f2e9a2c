"""Runs beside an equilibrium grow and decay as `stability` says.

On tilting pads, beside a seal, with cross-coupled bearings and a shaft of two bending stiffnesses.
"""

import exudyn as exu
import numpy as np
import pytest
from asymmetric import asymmetric_shaft
from point_rotors import SKEW_AXIS
from test_tilting_pad import SPEED, on_pads, scene

from exudyn_rotor import (
    AnnularSeal,
    Support,
    linear_model,
    recommended_settings,
    stability,
    steady_state,
)
from exudyn_rotor.linear.over import motions_over
from exudyn_rotor.multibody.rotor.start_state import StartState

STEPS, SIZE = 80, 5e-7  # SIZE in m, below 1 % of the clearance


def settings(end_time, step):
    made = recommended_settings(end_time, step, accuracy=1e-10)
    made.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    made.timeIntegration.newton.useModifiedNewton = False
    made.timeIntegration.verboseMode = 0
    made.solution.file.write = False
    made.solution.sensors.writePeriod = step
    return made


def on_seals():
    """Return the rotor of `on_pads` on soft springs, with a seal instead of the pads."""
    rotor, _, gravity = on_pads((1.0, 0.0, 0.0))
    seal = AnnularSeal(
        interface="left", radius=0.1, length=0.05, clearance=3e-4, pressure_drop=1.2e6,
        density=1000.0, viscosity=1e-3,
    )  # fmt: skip
    soft = Support("left", np.diag([5e4, 6e4, 0.0]))
    soft_right = Support("right", np.diag([5e6, 6e6, 1e7]), 100.0)
    return rotor, [seal, soft, soft_right], 0.0 * gravity


def on_springs(stiffness, coupled, damping):
    """Return the shaft of two bending stiffnesses on two bearings, and no weight."""
    matrix = np.diag([*stiffness, 1e6]) + coupled * np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 0]])
    springs = [Support(end, matrix, damping * np.eye(3)) for end in ("left", "right")]
    return asymmetric_shaft(), springs, np.zeros(3)


# rotor, supports, gravity, speed [rad/s], and revolutions of the run
CASES = {
    "pads, skew": lambda: (*on_pads(tuple(SKEW_AXIS)), SPEED, 0.25),
    "seal, x": lambda: (*on_seals(), SPEED, 1.0),
    "uneven bearings, growing": lambda: (*on_springs((4e5, 8e5), 0.0, 2.0), 182.0, 2.0),
    "cross-coupling, growing": lambda: (*on_springs((4e5, 4e5), 4e4, 10.0), 250.0, 1.0),
}


def measured(case, steps):
    """Return the growth [1/s] of the least stable lateral motion in a run, and λ of the scene."""
    rotor, supports, gravity, speed, revolutions = CASES[case]()
    mbs, body, _ = scene(rotor, supports, gravity, spin=speed)
    sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    model, steady = linear_model(mbs, body=body), steady_state(body)
    linear, start = model.scene, steady.state()
    [modes] = motions_over(model, [speed])
    in_scene = [
        model.unknowns(dict(zip(modes.orders.tolist(), one, strict=True)), speed)
        for one in np.moveaxis(modes.vectors, 2, 0)
    ]
    orders = np.array(sorted(in_scene[0]))
    vectors = np.array([np.column_stack([one[n] for one in in_scene]) for n in orders])
    shapes = vectors.sum(axis=0)
    rows = linear.interface_motion("left")[:2]
    moves = np.linalg.norm(rows @ shapes, axis=0)
    lateral = moves > 0.01 * np.linalg.norm(shapes, axis=0) * np.linalg.norm(rows)
    chosen = np.argmax(np.where(lateral, modes.values.real, -np.inf))
    rates = modes.values[chosen] + 1j * orders[:, None] * speed
    amplitudes = SIZE / moves[chosen] * vectors[:, :, chosen]
    y, y_t = amplitudes.sum(axis=0), (rates * amplitudes).sum(axis=0)
    T, T1, _ = linear.turn(0.0)
    still = steady.interface_motion("left", 0.0)[:3] @ linear.axes.T
    q, q_t = start.q.copy(), start.q_t.copy()
    q[linear.free] += (T @ y).real
    q_t[linear.free] += (T @ y_t + speed * T1 @ y).real
    period = 2.0 * np.pi / speed
    body.start_from(StartState(q, q_t, start.angle, speed))
    mbs.SolveDynamic(settings(revolutions * period, period / steps))
    path = mbs.GetSensorStoredData(sensor)
    sizes, weights = [], []
    for time, *place in path:
        theta = speed * time
        turn = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
        shape = turn @ rows @ (np.exp(1j * orders * theta) @ amplitudes)
        away = (np.array(place) - still) @ linear.axes[:, :2]
        columns = np.column_stack([shape.real, -shape.imag])
        sizes.append(np.hypot(*np.linalg.lstsq(columns, away, rcond=None)[0]))
        weights.append(np.linalg.svd(columns, compute_uv=False)[-1])  # small on flat orbits
    return np.polyfit(path[:, 0], np.log(sizes), 1, w=weights)[0], modes.values[chosen]


@pytest.mark.parametrize("case", CASES)
def test_a_run_grows_as_stability_says(case):
    """Within 1 % of the list of supports.

    The trapezoidal rule errs by (νh)²/12 of the rate ν in the rotor's axes, whose difference with Ω
    dampers see; its second order is extrapolated.
    """
    rotor, supports, _, speed, _ = CASES[case]()
    coarse, fine = (measured(case, steps)[0] for steps in (STEPS, 2 * STEPS))
    expected = stability(rotor, [speed], supports=supports, accuracy=None).growth_of("lateral")[0]
    assert (expected > 0.0) == ("growing" in case)
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(expected, rel=0.01)
