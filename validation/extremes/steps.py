"""Step sizes from 1e-7 s to beyond what every integrator can stand."""

from __future__ import annotations

import numpy as np

from validation.extremes.rotors import shaft_rotor, two_rings
from validation.extremes.rows import EPS, Row, breaking_point
from validation.extremes.runs import SOLVERS, bare_rotor, history, run

# stability polynomials, ascending
POLYNOMIALS = {
    "RK33": [1.0, 1.0, 1 / 2, 1 / 6],
    "RK44": [1.0, 1.0, 1 / 2, 1 / 6, 1 / 24],
}
UNSTABLE = {"ExplicitEuler": [1.0, 1.0], "ExplicitMidpoint": [1.0, 1.0, 1 / 2]}
IMPLICIT = ("GeneralizedAlpha", "TrapezoidalIndex2")
STEPS = 2000
GROWN = 1e3  # a motion that has grown by this factor is called unstable


def theoretical_limit(polynomial: list[float], factor: float = GROWN) -> float:
    """Return the hω at which an undamped motion grows by `factor` in STEPS steps."""
    y = np.linspace(0.0, 5.0, 500001)[1:]
    size = np.abs(np.polyval(polynomial[::-1], 1j * y))
    return float(y[np.argmax(size > factor ** (1.0 / STEPS))])


def growth(solver: str, ratio: float, speed: float = 0.0, steps: int = STEPS) -> float:
    """Return by which factor a bending motion grows in a run at hω = `ratio`.

    ω is the highest frequency in the rotor frame, that of bending plus the spin; the elastic
    rotor turns at a constant speed.
    """
    reduced = shaft_rotor().reduce(2)
    highest = reduced.frequencies[-1] + speed
    tilts = len(reduced.labels) - 4 - 2
    start = np.array([0.0] * tilts + [1e-3, 0.0])
    body = bare_rotor(reduced, spin=speed, modal_coordinates=start)
    q, _ = run(body, ratio / highest, steps, getattr(SOLVERS, solver))
    size = np.abs(q).max()
    return float(size / 1e-3) if np.isfinite(size) else np.inf


def measured_limit(solver: str, expected: float, speed: float) -> float:
    """Return the largest hω at which a run stays bounded."""
    return breaking_point(
        lambda ratio: growth(solver, ratio, speed) < GROWN, 0.7 * expected, 1.6 * expected, 1.0003
    )


def explicit_row(solver: str, quick: bool = False) -> Row:
    """Find the largest step of an explicit integrator."""
    expected = theoretical_limit(POLYNOMIALS[solver])
    # the fastest mode has a share of the start only, and its phase at the end is any
    spread = theoretical_limit(POLYNOMIALS[solver], 30.0 * GROWN) / expected - 1.0
    speeds = (200.0,) if quick else (0.0, 200.0, 2000.0)
    found = np.array([measured_limit(solver, expected, speed) for speed in speeds])
    end = growth(solver, 10.0 * expected, steps=400)
    return Row(
        f"step of {solver}",
        f"hω to 10 × the limit, spin {speeds[0]:g} to {speeds[-1]:g} rad/s",
        f"hω at which it grows by {GROWN:g} in {STEPS} steps, against |R(ihω)|ⁿ: {expected:.4g}; "
        "limit: growth known to a factor of 30 (share of the start, phase), bisection 0.03 %",
        np.abs(found / expected - 1.0).max(),
        spread + 3e-4,
        f"hω = {found[-1]:.4g}, ω the highest frequency plus the spin",
        "numerics",
        f"by Exudyn nothing: the run goes on and ends at {end:g} times the start; check_run: "
        "'explicit'",
    )


def unstable_row(solver: str, quick: bool = False) -> Row:
    """Show that low-order explicit integrators let every undamped motion grow."""
    ratio, steps = 0.3, 300
    expected = np.abs(np.polyval(UNSTABLE[solver][::-1], 1j * ratio)) ** steps
    reduced = shaft_rotor().reduce(2)
    body = bare_rotor(reduced, spin=0.0, modal_coordinates=[0.0, 0.0, 1e-3, 0.0])
    highest = reduced.frequencies[-1]
    q, q_t = run(body, ratio / highest, steps, getattr(SOLVERS, solver))
    size = np.hypot(q[-2:], q_t[-2:] / highest).max() / 1e-3
    return Row(
        f"step of {solver}",
        f"hω = {ratio}, {steps} steps, no damping",
        "growth of the amplitude against |R(ihω)|ⁿ; limit: 1e-6, far below what another method "
        "would make",
        abs(size / expected - 1.0),
        1e-6,
        "every step: an undamped motion grows",
        "numerics",
        f"by Exudyn nothing: grown by {size:.3g} here; check_run: 'explicit'",
    )


def verlet_row(quick: bool = False) -> Row:
    """Find the largest step of the velocity Verlet method at rest."""
    found = measured_limit("VelocityVerlet", 2.0, 0.0)
    spinning = growth("VelocityVerlet", 0.1, 200.0)
    return Row(
        "step of VelocityVerlet",
        "hω to 1.6 × the limit at rest; hω = 0.1 at 200 rad/s",
        "largest hω against 2 at rest; limit: 0.3 %",
        abs(found / 2.0 - 1.0),
        3e-3,
        f"hω = {found:.4g} at rest; with a spin it grows {spinning:.2g} times in {STEPS} steps at "
        "hω = 0.1",
        "numerics",
        "Exudyn warns that this solver is under development",
    )


def implicit_error(solver: str, ratio: float) -> float:
    """Return the frequency error of an implicit run against ``(2/h) atan(ωh/2)``."""
    omega = 100.0
    step = ratio / omega
    body = bare_rotor(
        two_rings().reduce(0),
        spin=50.0,
        springs={0: 2.0 * omega**2},
        initial_velocity=[0.1, 0.0, 0.0],
    )
    x = history(body, step, 200, solver=getattr(SOLVERS, solver))[:, 1]
    cosine = x[1:-1] @ (x[2:] + x[:-2]) / (2.0 * (x[1:-1] @ x[1:-1]))
    return float(abs(np.arccos(np.clip(cosine, -1.0, 1.0)) / (2.0 * np.arctan(0.5 * ratio)) - 1.0))


def implicit_row(solver: str, quick: bool = False) -> Row:
    """Push the step of an implicit integrator without numerical damping."""
    ratios = (1e-2, 1e3) if quick else (1e-2, 0.1, 1.0, 10.0, 1e2, 1e3)
    one_percent = breaking_point(lambda y: 1.0 - 2.0 * np.arctan(0.5 * y) / y < 0.01, 1e-3, 10.0)
    grown = growth(solver, 1e4)
    return Row(
        f"step of {solver}",
        "hω from 0.01 to 1000, grown at 10⁴",
        "frequency against tan(ω'h/2) = ωh/2; limit: Newton's tolerance 1e-12 over the smallest "
        "(hω)²",
        max(implicit_error(solver, ratio) for ratio in ratios) if grown < GROWN else np.inf,
        1e-12 / ratios[0] ** 2,
        f"hω = {one_percent:.3g}: frequency wrong by 1 %; never unstable ({grown:.2g} at 10⁴)",
        "numerics",
        "by Exudyn nothing: it stays bounded and gets inaccurate; check_run: 'step'",
    )


def adaptive_error(ratio: float, tolerance: float = 1e-8) -> tuple[float, int]:
    """Return the error of DOPRI5 after ten periods, relative to the amplitude, and its steps."""
    reduced = shaft_rotor().reduce(2)
    body = bare_rotor(reduced, spin=0.0, modal_coordinates=[0.0, 0.0, 1.0, 0.0])
    highest = reduced.frequencies[-1]
    steps = int(np.ceil(20.0 * np.pi / ratio))
    step = ratio / highest
    q, _ = run(body, step, steps, SOLVERS.DOPRI5, adaptive=tolerance)
    taken = body.mbs.sys["dynamicSolver"].it.currentStepIndex
    return abs(q[-2] - np.cos(highest * step * steps)), int(taken)


def adaptive_row(quick: bool = False) -> Row:
    """Ask DOPRI5 for steps far too large."""
    tolerance, ratios = 1e-8, (1.0, 30.0) if quick else (0.01, 1.0, 10.0, 30.0)
    found = [adaptive_error(ratio, tolerance) for ratio in ratios]
    return Row(
        "step of DOPRI5",
        f"hω from {ratios[0]} to {ratios[-1]}",
        "displacement after ten periods; limit: the tolerance 1e-8 in each of the steps taken",
        max(error / taken for error, taken in found),
        tolerance,
        told=f"need not be: it takes {found[-1][1]} steps of its own, also with "
        "automaticStepSize=False",
    )


def tiny_step_error(solver: str, step: float = 1e-7, steps: int = 2000) -> float:
    """Return the error of a bending motion after tiny steps, relative to its way until then.

    From rest the motion goes ``½ω²t²``, so few digits of it are left in the displacement.
    """
    reduced = shaft_rotor().reduce(2)
    omega, t = reduced.frequencies[-1], step * steps
    body = bare_rotor(reduced, spin=0.0, modal_velocities=[0.0, 0.0, 1.0, 0.0])
    q, _ = run(body, step, steps, getattr(SOLVERS, solver))
    return abs(q[-2] / (np.sin(omega * t) / omega) - 1.0)


def tiny_steps(quick: bool = False) -> Row:
    """Take steps of 1e-7 s."""
    steps = 500 if quick else 5000
    solvers = (*POLYNOMIALS, *IMPLICIT, "DOPRI5")
    return Row(
        "tiny steps, all integrators",
        f"h = 1e-7 s, {steps} steps",
        "displacement against sin(ωt)/ω; limit: second order's (hω)²/6 and round-off × steps",
        max(tiny_step_error(solver, steps=steps) for solver in solvers),
        (1e-7 * 490.0) ** 2 / 6.0 + EPS * steps,
    )


def rows(quick: bool = False) -> list[Row]:
    """Return the rows of all integrators."""
    found = [explicit_row(solver, quick) for solver in POLYNOMIALS]
    found += [unstable_row(solver, quick) for solver in UNSTABLE]
    found += [adaptive_row(quick)]
    found += [implicit_row(solver, quick) for solver in IMPLICIT]
    return [*found, verlet_row(quick), tiny_steps(quick)]
