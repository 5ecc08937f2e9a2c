"""Supports from next to nothing to rigid, damping past critical, shafts far from round."""

from __future__ import annotations

import numpy as np

from exudyn_rotor import (
    Support,
    campbell,
    stability,
    stability_threshold,
    unstable_ranges,
)
from validation.extremes.rotors import held, shaft_frequencies, shaft_rotor, two_rings
from validation.extremes.rows import EPS, Row, breaking_point, message
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


def contrast_error(contrast: float) -> float:
    """Return the error of the lower of two support frequencies, their stiffness far apart.

    The stiff direction lies across both axis and plane of rotation, so that every entry of the
    matrix holds some of it.
    """
    stiff = np.array([0.0, np.cos(0.5), np.sin(0.5)])
    matrix = np.eye(3) + (contrast - 1.0) * np.outer(stiff, stiff)
    support = Support("all", matrix, tilt_stiffness=np.eye(3) * contrast)
    found = campbell(two_rings().reduce(0), [0.0], supports=[support]).frequencies_rotor[0]
    exact = np.sqrt(1.0 / MASS)
    # the other soft direction is an axis of its own, and exact
    return float(np.sort(np.abs(found / exact - 1.0))[1])


def contrast(quick: bool = False) -> Row:
    """Hold one rotor by springs that are ever farther apart in stiffness."""
    found = breaking_point(lambda c: contrast_error(c) < 1e-3, 1e2, 1e18, 1.1)
    lost = campbell(
        two_rings().reduce(0),
        [0.0],
        supports=[Support("all", np.diag([1.0, 1.0, 1e15]), tilt_stiffness=np.eye(3))],
    )
    return Row(
        "contrast of support stiffnesses, Campbell",
        "1e8 within one rotor",
        "the low frequency; limit: ω² is known but for round-off × contrast, and 10 × of it",
        contrast_error(1e8),
        10.0 * EPS * 1e8,
        f"contrast {found:.1g}: low frequency wrong by 0.1 %",
        "numerics",
        f"nothing; at 1e15 {np.count_nonzero(lost.frequencies_rotor == 0.0)} of 6 frequencies "
        "are given as 0",
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


def asymmetric_range(ratio: float, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the found and the exact unstable speeds of a shaft with stiffness k and `ratio` k.

    A deflection along either direction is in equilibrium with the centrifugal load at the lateral
    frequency of that direction; the shaft is unstable between the two.
    """
    stiffness, bearing = (4e5, 4e5 * ratio), 1e6
    exact = np.array([shaft_frequencies(10.0, 1.0, k, bearing)[0] for k in stiffness])
    speeds = np.arange(0.5 * exact[0], 1.5 * exact[1], spacing * exact[0])
    rotor = shaft_rotor(bending=stiffness).reduce(2)
    return unstable_ranges(rotor, speeds, supports=held(bearing, "left", "right")), exact


def asymmetry(quick: bool = False) -> Row:
    """Make a shaft stiffer in one direction, from a twentieth more to ten thousand times."""
    ratios = (1.05, 1e4) if quick else (1.05, 1.5, 10.0, 1e2, 1e4)
    worst = 0.0
    for ratio in ratios:
        found, exact = asymmetric_range(ratio, 0.003 if ratio < 1.1 else 0.1)
        worst = max(worst, np.abs(found / exact - 1.0).max() if len(found) == 1 else np.inf)
    missed = len(asymmetric_range(1.0001, 0.003)[0]) == 0
    return Row(
        "asymmetry of the shaft",
        "bending stiffness 1.05 : 1 to 10000 : 1",
        "one unstable range between both lateral frequencies; limit: the promised 1e-8 of the "
        "highest speed (4.2 × the lower limit)",
        worst,
        5e-8,
        "1.0001 : 1: " + ("missed" if missed else "found"),
        "input",
        "documented: up to 1 % of unevenness is averaged; LinearModel.unevenness tells it",
    )


def no_interface(quick: bool = False) -> Row:
    """Hold a rotor where it has no interface."""
    text = message(lambda: stability(two_rings().reduce(0), [1.0], supports=held(1.0, "left")))
    return Row(
        "support at an unknown place",
        "one",
        "share of calls that pass without an error; limit: 0",
        0.0 if text.startswith("ValueError") else 1.0,
        0.0,
        "always",
        "input",
        text,
    )
