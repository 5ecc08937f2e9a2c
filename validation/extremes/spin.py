"""Spin speeds from next to nothing to far beyond the bending frequency, in both senses."""

from __future__ import annotations

import numpy as np

from exudyn_rotor import LinearModel, Support, campbell, linear_model, stability
from exudyn_rotor.theory.stiffening import stiffening
from validation.extremes.rotors import held, shaft_frequencies, shaft_rotor, two_rings
from validation.extremes.rows import EPS, Row, breaking_point
from validation.extremes.runs import bare_rotor, run

BEARING = 2e5  # N/m at each end of the shaft
TILT = 2e3  # N m/rad of a rigid rotor's support


# ------------------------------------------------------------------ linear analyses


def campbell_error(ratios: np.ndarray) -> float:
    """Return the largest error of the bending frequencies in the rotor frame, |ω ± Ω|.

    Speeds are `ratios` of the first bending frequency on bearings. Bending without tilt has the
    same inertial frequency at every speed. Errors are relative to the larger of Ω and the rotor's
    highest frequency.
    """
    exact = shaft_frequencies(10.0, 1.0, 4e5, BEARING)
    speeds = exact[0] * np.asarray(ratios)
    found = campbell(shaft_rotor().reduce(2), speeds, supports=held(BEARING, "left", "right"))
    worst = 0.0
    for speed, row in zip(speeds, found.frequencies_rotor, strict=True):
        expected = np.abs(np.concatenate([exact + speed, exact - speed]))
        distance = np.abs(row[:, None] - expected).min(axis=0)
        worst = max(worst, distance.max() / max(speed, exact[-1]))
    return worst


def speeds_of_campbell(quick: bool = False) -> Row:
    """Push the spin of a bending rotor from 1e-9 rad/s to ten times its first frequency."""
    first, _ = shaft_frequencies(10.0, 1.0, 4e5, BEARING)
    ratios = np.concatenate([[1e-9 / first], np.geomspace(1e-6, 10.0, 8 if quick else 80)])
    # the reduction finds the bending modes with an error of eps times the stiffest ω² of the free
    # rotor over theirs; 10 for the sums of 18 terms in it
    condition = 1e4 * 4e5 / (4e5 * (1.0 / 10.0 + 1.0 / 2.0))
    return Row(
        "spin speed, Campbell",
        "1e-9 rad/s to 10 × first bending frequency",
        "bending frequencies against |ω ± Ω|; limit: 10 × round-off × stiffest over bending ω²",
        campbell_error(ratios),
        10.0 * EPS * condition,
    )


def smallest_stiffness(level: str, speed: float) -> float:
    """Return the smallest eigenvalue of ``K − Ω²Ĉ`` of a rigid rotor, its spin held [1/s²]."""
    rotor = rigid_on_support(level)
    moving, K = rotor.held_basis, rotor.at(speed).K[0]
    return float(np.linalg.eigvalsh(moving.T @ K @ moving)[0])


def rigid_on_support(level: str) -> LinearModel:
    """Return a rigid rotor, its middle held by springs; nothing resists the spin."""
    support = Support("all", np.diag([BEARING] * 3), tilt_stiffness=TILT)
    return linear_model(two_rings().reduce(0), supports=[support], stiffening=level, axes="rotor")


def rigid_speeds() -> dict[str, float]:
    """Return closed forms [rad/s]: definiteness lost by translation and tilt; false instability."""
    polar, transverse = 2.0 * 0.1**2, 2.0 * (0.1**2 / 2 + 0.06**2)
    return {
        "translation": float(np.sqrt(BEARING / 2.0)),
        "tilt at 'none'": float(np.sqrt(TILT / (transverse - polar / 2))),
        "unstable at 'none'": float(
            np.sqrt(4 * transverse * TILT / (polar * (2 * transverse - polar)))
        ),
    }


def definiteness(quick: bool = False) -> Row:
    """Find the speed where ``K − Ω²Ĉ`` stops being positive definite."""
    exact, factor = rigid_speeds()["translation"], 1.0 + 1e-12
    found = breaking_point(
        lambda speed: smallest_stiffness("tilt", speed) > 0.0, 0.2 * exact, 9.0 * exact, factor
    )
    beyond = stability(rigid_on_support("tilt"), [1.001 * exact, 10.0 * exact])
    verdict = "stable" if beyond.stable.all() else "unstable"
    lowest = np.sort(campbell(rigid_on_support("tilt"), [exact]).frequencies_rotor[0])[1]
    return Row(
        "spin speed, K − Ω²C, level 'tilt'",
        "to 10 × the speed where definiteness is lost",
        "that speed against √(k/m); limit: the bisection's 1e-12 and 100 × round-off",
        abs(found / exact - 1.0),
        1e-12 + 100.0 * EPS,
        f"definite to {found:.6g} rad/s, the critical speed",
        "physics",
        f"stability: {verdict} beyond (gyroscopic), growth {beyond.growth.max():.1e} 1/s; "
        f"Campbell, rotor frame: {lowest:.1g} rad/s there",
    )


def false_instability(quick: bool = False) -> Row:
    """Find the speed where the paper's own equations turn a rigid rotor falsely unstable."""
    exact = rigid_speeds()["unstable at 'none'"]
    rotor = rigid_on_support("none")

    def stable(speed: float) -> bool:
        return bool(stability(rotor, [speed], accuracy=None).stable[0])

    found = breaking_point(stable, 0.6 * exact, 2.1 * exact, 1.0 + 1e-9)
    held_up = bool(
        stability(rigid_on_support("tilt"), exact * np.array([1.01, 10.0, 1000.0])).stable.all()
    )
    return Row(
        "spin speed, stability at 'none' and 'tilt'",
        "to 1000 × the false threshold",
        "threshold against √(4 I_t k / (I_p (2 I_t − I_p))); limit: 1e-6",
        abs(found / exact - 1.0) if held_up else np.inf,
        1e-6,
        f"'none' at {found:.6g} rad/s; 'tilt' not reached",
        "physics",
        "'none': unstable, without a word that the terms are missing; 'tilt' (default): stable",
    )


# ------------------------------------------------------------------ runs


def invariant_drift(ratio: float, level: str = "tilt", steps: int = 400) -> float:
    """Return the drift of the Jacobi integral of a bending rotor at a constant speed.

    ``½ζ̇² + ½ζᵀ(K − Ω²C)ζ`` is quadratic, so the trapezoidal rule keeps it but for round-off;
    relative to ``½ζ̇² + ½ζᵀKζ`` plus the centrifugal part.
    """
    reduced = shaft_rotor().reduce(2)
    highest = reduced.frequencies[-1]
    speed = ratio * highest
    # free tilts, the first two modes, grow without bound at 'none'
    start = np.array([1e-3 * (level == "tilt")] * 2 + [1e-3] * 2)
    body = bare_rotor(
        reduced,
        spin=speed,
        stiffening=level,
        modal_coordinates=start,
        modal_velocities=start,
    )
    invariants, frame = body.motion.invariants, slice(3, None)
    softening = speed**2 * (invariants.C - stiffening(invariants, level).K2)

    def parts(zeta: np.ndarray, zeta_t: np.ndarray) -> tuple[float, float]:
        rest = 0.5 * (zeta_t @ zeta_t + zeta @ invariants.K @ zeta)
        return rest - 0.5 * zeta @ softening @ zeta, rest + 0.5 * zeta @ softening @ zeta

    q, q_t = run(body, 0.3 / (highest + abs(speed)), steps)
    (before, _), (after, scale) = parts(start, start), parts(q[frame], q_t[frame])
    return abs(after - before) / scale


def speeds_of_runs(quick: bool = False) -> Row:
    """Push the constant spin of a run from 1e-9 to 10 times the bending frequency."""
    ratios = (1e-9, 1.0, 10.0) if quick else (1e-9, 1e-6, 1e-3, 0.1, 0.999, 1.0, 1.001, 3.0, 10.0)
    steps = 400
    return Row(
        "spin speed, implicit run",
        "1e-9 to 10 × bending frequency, 'none' and 'tilt', 400 steps",
        "drift of the Jacobi integral, which the rule keeps; limit: 10 × round-off × steps",
        max(invariant_drift(r, level, steps) for r in ratios for level in ("none", "tilt")),
        10.0 * EPS * steps,
    )
