"""A proposal in sentences: the reasons for it, and where it does not meet the accuracy."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.mode_choice import GROWTH, Truncation
from exudyn_rotor.advice.request import Request
from exudyn_rotor.advice.step_size import Step
from exudyn_rotor.advice.stiffening_level import Level
from exudyn_rotor.units import IN_HERTZ


def mode_reasons(given: Candidate, request: Request, chosen: Truncation) -> list[str]:
    """Return why these modes, in sentences."""
    held = "on its supports" if given.supported else "by its own flexibility, supports not known"
    lines = [
        f"modes: {chosen.in_band} lie in the band up to (f + Ω)/2π = "
        f"{IN_HERTZ * request.highest:.4g} Hz of the rotor frame",
        f"modes: the {given.frequencies.size - chosen.kept.size} left out change the response "
        f"of interfaces {held} by {chosen.error:.2g}, resonances damped by {GROWTH:.0%} at least",
    ]
    if chosen.missing is not None:
        lines.append(
            "modes: static responses to loads at the interfaces, which those given do not hold, "
            f"change the largest of it by {chosen.missing:.2g}"
        )
    elif chosen.top > request.allowed:
        lines.append(
            f"modes: the highest fifth of those given adds {chosen.top:.2g}; with free modes, what "
            "lies beyond them is of that order: give more, or craig_bampton_modes"
        )
    return lines


def level_reasons(request: Request, level: Level) -> list[str]:
    """Return why this level of stiffening."""
    estimate = "by" if level.known else "by about"
    return [
        f"stiffening: beyond 'tilt' frequencies change {estimate} {level.full:.2g}, of "
        f"{request.accuracy:g}; no level costs time in a step"
    ]


def step_reason(request: Request, step: Step) -> str:
    """Return why this step."""
    if np.isnan(step.speed):
        return (
            f"step: ωh = {request.highest * step.size:.3g} at the end of the band, so periods are "
            f"too long by {request.allowed:g} of themselves there"
        )
    return (
        f"step: changes the response at {step.speed:.4g} rad/s, to a load at {step.frequency:.4g} "
        f"rad/s in the rotor frame, by {request.allowed:g}; a resonance is near, or a motion that "
        "is slow in space"
    )


def unmet(
    given: Candidate, request: Request, chosen: Truncation, level: Level, tilt: float | None
) -> list[str]:
    """Return where the accuracy is not met, each with what to do."""
    messages = []
    missing = chosen.missing if given.supported else None
    if missing is not None and missing > request.allowed:
        messages.append(
            f"the {given.frequencies.size} flexible modes given miss {missing:.2g} of the "
            f"response, above half the accuracy {request.accuracy:g}: reduce the rotor with more "
            "modes, or with craig_bampton_modes, and ask again"
        )
    if given.frequencies.size and given.frequencies.max() < request.highest:
        messages.append(
            f"all {given.frequencies.size} flexible modes given lie in the band up to "
            f"{IN_HERTZ * request.highest:.4g} Hz of the rotor frame, and more may: reduce the "
            "rotor with more modes and ask again"
        )
    if tilt is not None and tilt**2 > request.accuracy:
        messages.append(
            f"a tilt of {tilt:.3g} rad makes an error of its square, {tilt**2:.2g}, above the "
            f"accuracy {request.accuracy:g}: one fixed axis does not suffice, use Exudyn's 3D body"
        )
    if level.missing:
        messages.append(
            f"flexible modes soften falsely: frequencies change by about {level.full:.2g}, above "
            f"the accuracy {request.accuracy:g}; reduce the rotor with prestress=True and ask "
            "again, which allows stiffening='full'"
        )
    return messages
