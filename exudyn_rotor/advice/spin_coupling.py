"""Whether a free spin may be frozen: what that would leave out, before a run."""

from __future__ import annotations

from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.request import Request
from exudyn_rotor.theory.formulation import PrescribedMotion

_SMALL = 0.1  # of the accuracy, since whirl comes on top


def static_share(given: Candidate, speed: float) -> float:
    """Return the share of the angular momentum that the static stretch at a speed [rad/s] makes.

    With ``ζ = ω²h/ω_k²`` of the flexible modes this is half the change of the moment of inertia,
    ``hᵀζ``, over Θ: the part of it that a frozen spin leaves out.
    """
    load = given.invariants.h[given.flexible] * speed / given.frequencies
    return float(load @ load / given.invariants.Theta)


def spin_coupling_reasons(
    given: Candidate, request: Request, spin: str | float | PrescribedMotion
) -> list[str]:
    """Return a sentence about ``spin_coupling='frozen'`` for a free spin, none for another."""
    if spin != "free" or not given.frequencies.size:
        return []
    share = static_share(given, request.high)
    if share < _SMALL * request.accuracy:
        verdict = "saves half the Python calls, and check_run says by how much it errs"
    else:
        verdict = "errs by too much"
    return [
        f"spin coupling: 'frozen' {verdict}; of the angular momentum it leaves out {share:.2g} by "
        "the static stretch, and by whirl about the square of the orbit over the rotor's size"
    ]
