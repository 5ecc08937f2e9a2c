"""Very many revolutions, and sudden torques from next to nothing to huge."""

from __future__ import annotations

from fractions import Fraction

import exudyn as exu
import numpy as np

from exudyn_rotor import ConstantSpeed, add_rotor
from validation.extremes.rotors import shaft_rotor, two_rings
from validation.extremes.rows import EPS, Row, breaking_point
from validation.extremes.runs import SOLVERS, bare_rotor, run

# 2π to 50 digits: exact beside the 16 digits of a double
_TURN = 2 * Fraction(31415926535897932384626433832795028841971693993751, 10**49)
_LEAST_PHASE = 1e-6  # rad: a micrometre at a radius of a metre


def phase_error(revolutions: float, samples: int = 50) -> float:
    """Return the largest error of the phase of a constant spin near a number of turns [rad].

    Against the exact product of speed and time modulo 2π, in rational arithmetic.
    """
    spin = ConstantSpeed(314.15)
    worst = 0.0
    for part in range(samples):
        t = (revolutions - part / samples) * 2.0 * np.pi / spin.speed
        exact = float(Fraction(spin.speed) * Fraction(t) % _TURN)
        angle = spin.value(t)
        worst = max(worst, abs(np.angle(np.exp(1j * angle) * np.exp(-1j * exact))))
    return worst


def phase(quick: bool = False) -> Row:
    """Evaluate the phase of a constant spin after more and more revolutions."""
    found = breaking_point(lambda n: phase_error(n) < _LEAST_PHASE, 1e3, 1e14, 1.1)
    return Row(
        "revolutions at constant speed, θ(t)",
        "10⁶ revolutions",
        "phase against exact arithmetic [rad]; limit: round-off of θ = 6·10⁶ rad",
        phase_error(1e6),
        2.0 * np.pi * 1e6 * EPS,
        f"{found:.1g} revolutions: phase error {_LEAST_PHASE:g} rad",
        "numerics",
        "nothing; the phase gets coarse like every double",
    )


def node_phase_error(steps: int, revolutions: float = 1e6) -> float:
    """Return the error of the marker body's θ after very many turns at a constant speed [rad]."""
    speed = 314.15
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, two_rings().reduce(0), spin=speed)
    body.mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = revolutions * 2.0 * np.pi / speed
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    angle = mbs.GetNodeOutput(body.nodes["rigid"], exu.OutputVariableType.Coordinates)[5]
    return abs(angle - speed * settings.timeIntegration.endTime)


def node_phase(quick: bool = False) -> Row:
    """Run a rotor of constant speed over 10⁶ revolutions in a few large steps."""
    steps = 1000 if quick else 10000
    return Row(
        "revolutions at constant speed, run",
        f"10⁶ revolutions in {steps} steps",
        "θ of the node against Ωt [rad]; limit: round-off of θ in every step",
        node_phase_error(steps),
        2.0 * np.pi * 1e6 * EPS * steps,
    )


def free_phase_error(steps: int, revolutions: float = 1e6) -> float:
    """Return the error of θ of a free, torque-free, balanced spin after very many turns [rad]."""
    speed = 314.15
    body = bare_rotor(two_rings().reduce(0), translation="none", initial_speed=speed)
    step = revolutions * 2.0 * np.pi / speed / steps
    q, _ = run(body, step, steps)
    return abs(q[0] - speed * step * steps)


def free_phase(quick: bool = False) -> Row:
    """Let a balanced rotor spin freely over 10⁶ revolutions."""
    steps = 1000 if quick else 10000
    return Row(
        "revolutions of a free spin, run",
        f"10⁶ revolutions in {steps} steps",
        "θ against ω₀t [rad]; limit: round-off of θ in every step",
        free_phase_error(steps),
        2.0 * np.pi * 1e6 * EPS * steps,
        "an unbalanced or flexible rotor: 20 steps a revolution",
        "numerics",
        "check_run: 'spin step'; only the balanced rigid rotor allows steps of many turns",
    )


def rigid_angle_error(acceleration: float, steps: int = 100) -> float:
    """Return the relative error of θ of a rigid rotor after a sudden torque for a second."""
    reduced = two_rings().reduce(0)
    body = bare_rotor(reduced, translation="none", forces={0: acceleration * 2.0 * 0.1**2})
    q, _ = run(body, 1.0 / steps, steps)
    return abs(q[0] / (0.5 * acceleration) - 1.0)


def rigid_torque(quick: bool = False) -> Row:
    """Accelerate a rigid rotor by 10⁻⁶ to 10⁶ rad/s²."""
    steps = 100
    decades = np.arange(-6, 7, 4 if quick else 1)
    return Row(
        "sudden torque, rigid rotor",
        "10⁻⁶ to 10⁶ rad/s²",
        "θ against ½αt², which the rule meets exactly; limit: 10 × round-off × steps",
        max(rigid_angle_error(10.0**d, steps) for d in decades),
        10.0 * EPS * steps,
    )


def energy_error(acceleration: float, steps: int, solver: SOLVERS) -> float:
    """Return |energy − work of the torque| over the work, for a bending rotor with unbalance.

    Five revolutions of the rotor if it were rigid.
    """
    reduced = shaft_rotor().add_point_mass([0.1, 0.0, 0.0], 0.01).reduce(2)
    torque = acceleration * 10.01 * 0.1**2
    body = bare_rotor(reduced, forces={3: torque}, translation="free")
    step = np.sqrt(2.0 * 10.0 * np.pi / acceleration) / steps
    q, q_t = run(body, step, steps, solver)
    return abs(body.motion.energy(0.0, q, q_t) / (torque * q[3]) - 1.0)


def flexible_torque(quick: bool = False) -> Row:
    """Accelerate a bending, unbalanced rotor by 10⁻⁶ to 10⁶ rad/s², through its bending speed."""
    steps = 1000
    decades = np.array([-6, 2, 6]) if quick else np.arange(-6, 7)
    worst = 0.0
    for decade in decades:
        coarse, fine = (
            energy_error(10.0**decade, n, SOLVERS.TrapezoidalIndex2) for n in (steps, 2 * steps)
        )
        worst = max(worst, fine / max(coarse, 40.0 * EPS * steps))
    return Row(
        "sudden torque, bending rotor with unbalance",
        "10⁻⁶ to 10⁶ rad/s², five revolutions",
        "energy error of half the step over that of the step, round-off aside; limit: 1/4 for "
        "order two, and a tenth of it",
        worst,
        0.275,
    )
