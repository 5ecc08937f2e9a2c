"""Supports from next to nothing to rigid, damping past critical, shafts far from round."""

from __future__ import annotations

import numpy as np

from exudyn_rotor import Support, campbell, stability, stability_threshold
from validation.extremes.rotors import held, two_rings
from validation.extremes.rows import EPS, Row
from validation.extremes.runs import bare_rotor, history, run

MASS = 2.0  # of the rigid rotor of two rings [kg]


# ------------------------------------------------------------------ stiffness of supports


def support_error(stiffness: float, speed: float) -> float:
    """Return the error of √(k/m) of a rigid rotor on one spring, seen from the turning rotor.

    Relative to the larger of spin and frequency, because that is what round-off scales with.
    """
    exact = np.sqrt(stiffness / MASS)
    found = stability(two_rings().reduce(0), [speed], supports=held(stiffness)).exponents[0].imag
    expected = np.abs(np.array([exact + speed, exact - speed]))
    distance = np.abs(np.abs(found)[:, None] - expected).min(axis=0)
    return float(distance.max() / max(exact, speed))


def supports_linear(quick: bool = False) -> Row:
    """Put a rigid rotor on supports from 1e-3 to 1e14 N/m."""
    decades = np.arange(-3, 15, 4 if quick else 1)
    return Row(
        "support stiffness, linear",
        "1e-3 to 1e14 N/m, at 0 and 100 rad/s",
        "|√(k/m) ± Ω|; limit: a double zero (the free tilts) keeps half the digits",
        max(support_error(10.0**d, speed) for d in decades for speed in (0.0, 100.0)),
        np.sqrt(EPS),
        "none at all: frequency zero",
        "physics",
        "campbell lists free_motions: "
        + ", ".join(campbell(two_rings().reduce(0), [50.0]).free_motions),
    )


def transient_error(stiffness: float, speed: float = 100.0) -> float:
    """Return the error of the frequency of a run on springs against what the rule makes of it.

    The trapezoidal rule turns a frequency ω into ``(2/h) atan(ωh/2)``; 50 steps a period.
    """
    exact = np.sqrt(stiffness / MASS)
    step, steps = 2.0 * np.pi / exact / 50, 200
    body = bare_rotor(
        two_rings().reduce(0),
        spin=speed,
        springs={0: stiffness, 1: stiffness},
        initial_velocity=[1e-3 * exact, 0.0, 0.0],
    )
    x = history(body, step, steps)[:, 1]
    # of a single frequency, x(t+h) + x(t−h) = 2 cos(ωh) x(t)
    cosine = x[1:-1] @ (x[2:] + x[:-2]) / (2.0 * (x[1:-1] @ x[1:-1]))
    numerical = 2.0 * np.arctan(0.5 * exact * step)
    return float(abs(np.arccos(cosine) / numerical - 1.0))


def supports_run(quick: bool = False) -> Row:
    """Run a turning rotor on supports from 1e-3 to 1e14 N/m, 50 steps a period."""
    decades = np.arange(-3, 15, 4 if quick else 1)
    return Row(
        "support stiffness, implicit run",
        "1e-3 to 1e14 N/m, 50 steps a period, 100 rad/s",
        "frequency against tan(ω'h/2) = ωh/2; limit: the Newton tolerance 1e-12 over (ωh)²",
        max(transient_error(10.0**d) for d in decades),
        1e-12 / (2.0 * np.pi / 50) ** 2,
    )


def stiff_energy(stiffness: float, step: float = 1e-3, steps: int = 200) -> float:
    """Return the relative drift of the energy on springs far too stiff for the step."""
    reduced = two_rings().reduce(0)
    start = 1e-3 * np.sqrt(stiffness / MASS)
    body = bare_rotor(reduced, spin=0.0, springs={0: stiffness}, initial_velocity=[start, 0.0, 0.0])
    q, q_t = run(body, step, steps)
    return abs((MASS * q_t[0] ** 2 + stiffness * q[0] ** 2) / (MASS * start**2) - 1.0)


def supports_unresolved(quick: bool = False) -> Row:
    """Keep the step at 1 ms while the supports get so stiff that it sees nothing of them."""
    decades = np.array([6, 14]) if quick else np.arange(6, 15)
    return Row(
        "support stiffness, step far too large",
        "1e6 to 1e14 N/m at a step of 1 ms (ωh from 0.7 to 7000)",
        "energy, which the rule keeps; limit: round-off of the accelerations, times "
        "(ωh)²/4, in each of 200 steps",
        max(stiff_energy(10.0**d) for d in decades),
        200 * EPS * 1e14 / MASS * 1e-3**2 / 4.0,
        "ωh > 1: the frequency is that of the step, not of the support",
        "numerics",
        "by Exudyn nothing: it stays stable (explicit solvers do not, see the steps); check_run: "
        "'step'",
    )


# ------------------------------------------------------------------ damping


def rotating_damping(share: float) -> tuple[float, float]:
    """Return the errors of threshold and growth past it, with rotating damping `share` of outer.

    Jeffcott: unstable above ``ω(1 + c_outer/c_rotating)``; ``mλ² + (c_o + c_r)λ + k = iΩc_r``.
    """
    stiffness, outer = 2e5, 20.0
    inner = share * outer
    supports = [
        Support("all", np.diag([stiffness] * 3), outer, tilt_stiffness=1e4),
        Support("all", damping=inner, frame="rotor"),
    ]
    rotor = two_rings().reduce(0)
    exact = np.sqrt(stiffness / MASS) * (1.0 + 1.0 / share)
    # a point mass by intent: what flexible modes would change is not the question
    options = {"supports": supports, "accuracy": None}
    found = stability_threshold(rotor, 0.3 * exact, 2.5 * exact, **options).values[0]
    beyond = 3.0 * exact
    roots = np.roots([MASS, outer + inner, stiffness - 1j * beyond * inner])
    growth = stability(rotor, [beyond], **options).growth[0]
    return abs(found / exact - 1.0), abs(growth / roots.real.max() - 1.0)


def internal_damping(quick: bool = False) -> Row:
    """Turn damping with the rotor, from a thousandth to a thousand times that of the supports."""
    shares = (1e-3, 1e3) if quick else (1e-3, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e3)
    errors = np.array([rotating_damping(share) for share in shares])
    # past the threshold the growth rises by c_r/2mω per rad/s; its tolerance is 1e-9 of the speed
    slope = shares[0] * 20.0 / (2.0 * MASS * np.sqrt(2e5 / MASS))
    return Row(
        "rotating damping, past its threshold",
        "c_r/c_o from 1e-3 to 1e3, to 3 × threshold",
        "threshold against ω(1 + c_o/c_r), growth against the closed form; limit: the "
        "tolerance 1e-9 Ω of the growth over its slope, and 10 % of it",
        errors.max(),
        1.1e-9 / slope,
        "Ω = ω(1 + c_o/c_r)",
        "physics",
        "stability: unstable, with the growth rate",
    )


# ------------------------------------------------------------------ asymmetry of the shaft
