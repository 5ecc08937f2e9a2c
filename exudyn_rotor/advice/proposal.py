"""Before a run: the smallest model that a scene requires, with reasons."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.mode_choice import GROWTH, choose_modes
from exudyn_rotor.advice.request import AssumptionWarning, Request
from exudyn_rotor.advice.step_size import Step, choose_step
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import keep_modes
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.stiffening import LEVELS, estimated_error
from exudyn_rotor.units import IN_HERTZ

_NO_INERTIA = 1e-12  # share of all moments of inertia: masses on the axis alone


@dataclass(frozen=True, eq=False)
class Proposal:
    """The smallest model for a scene; made by :func:`propose`.

    Attributes
    ----------
    translation : {'free', 'in-plane', 'none'}
    spin : 'free' or float
        A number is a constant speed [rad/s].
    stiffening : {'tilt', 'full'}
    modes : tuple of int
        Flexible modes to keep, counted from 0; see :func:`exudyn_rotor.keep_modes`.
    total : int
        Number of flexible modes that there were to choose from.
    error : float
        Largest relative change of the response by the modes left out.
    step : float
        Step size [s].
    speeds : tuple of float
        Range of the spin speed that this holds for [rad/s].
    accuracy : float
    reasons : tuple of str

    Examples
    --------
    >>> from exudyn_rotor import Proposal
    >>> numbers = {"error": 0.0, "step": 1e-4, "speeds": (20.0, 20.0), "accuracy": 1e-3}
    >>> Proposal("none", 20.0, "tilt", modes=(0, 1), total=2, **numbers, reasons=()).step
    0.0001
    """

    translation: str
    spin: str | float
    stiffening: str
    modes: tuple[int, ...]
    total: int
    error: float
    step: float
    speeds: tuple[float, float]
    accuracy: float
    reasons: tuple[str, ...]

    def __post_init__(self) -> None:
        Formulation(self.translation, self.spin)  # the rules of add_rotor, where all of this goes
        checks.choice(self.stiffening, "stiffening", LEVELS)
        checks.count(self.total, "total")
        modes = checks.whole_numbers(self.modes, "modes", most=self.total - 1)
        low, high = checks.vector(self.speeds, "speeds", "rad/s", size=2).tolist()
        if not 0.0 <= low <= high:
            raise ValueError(f"speeds: needs 0 ≤ low ≤ high [rad/s], got {low}, {high}")
        checks.number(self.error, "error", least=0.0)
        checks.number(self.step, "step", "s", above=0.0)
        checks.tolerance(self.accuracy, "accuracy")
        reasons = checks.labels(self.reasons, "reasons")
        checks.keep(self, modes=tuple(modes.tolist()), speeds=(low, high), reasons=reasons)

    @property
    def count(self) -> int:
        """Number of flexible modes to keep."""
        return len(self.modes)

    def options(self) -> dict:
        """Return the formulation as arguments of :func:`exudyn_rotor.add_rotor`."""
        names = ("translation", "spin", "stiffening")
        return {name: getattr(self, name) for name in names}

    def truncated(self, reduced: ReducedRotor) -> ReducedRotor:
        """Return the rotor with the proposed modes.

        Raises
        ------
        ValueError
            If `reduced` has another number of flexible modes than the rotor this was made for.
        """
        checks.instance(reduced, "reduced", ReducedRotor)
        count = reduced.size - len(reduced.rigid_kinds)
        if count != self.total:
            raise ValueError(
                f"reduced: this proposal chose from {self.total} flexible modes, and the rotor has "
                f"{count}"
            )
        return keep_modes(reduced, self.modes)

    def __str__(self) -> str:
        spin = f"{self.spin:.6g} rad/s" if isinstance(self.spin, float) else self.spin
        lines = [
            f"proposal for {self.speeds[0]:.6g} … {self.speeds[1]:.6g} rad/s, "
            f"accuracy {self.accuracy:g}",
            f"  translation   {self.translation}",
            f"  spin          {spin}",
            f"  stiffening    {self.stiffening}",
            f"  modes         {self.count} of {self.total}",
            f"  step          {self.step:.3g} s",
            *(f"  - {reason}" for reason in self.reasons),
        ]
        return "\n".join(lines)


def propose(
    reduced: ReducedRotor,
    *,
    speeds: ArrayLike,
    load_frequencies: ArrayLike | None = None,
    supports: Sequence[Support] | Support = (),
    accuracy: float = 1e-3,
) -> Proposal:
    """Propose the smallest model whose error stays below an accuracy.

    Parameters
    ----------
    reduced : ReducedRotor
        A rotor with more modes than will be needed.
    speeds : float or (low, high)
        Range of the spin speed, ≥ 0 [rad/s].
    load_frequencies : array_like, optional
        Frequencies in the inertial frame of what acts on the rotor, ≥ 0 [rad/s]: everything up to
        the highest is taken to occur. None: weight, unbalance and bearings only, so everything up
        to the spin speed.
    supports : sequence of Support or bearings, optional
        What holds the rotor beside its own stiffness; nothing by default.
    accuracy : float
        Relative error of steady motion, between 0 and 1; half of it for the modes, half for the
        step.

    Returns
    -------
    Proposal

    Raises
    ------
    TypeError, ValueError
        For bad input, a rotor without interfaces, or one whose spin cannot be free.

    Warns
    -----
    AssumptionWarning
        Where no proposal meets the accuracy: modes are missing, or flexible modes stiffen with the
        speed and the rotor was reduced without a prestress.

    Notes
    -----
    Formulation: a constant speed leaves the modes alone (Sect. 2.5); else the frame carries the
    lateral translations (2.3), and the axial one, too, where supports act along the axis (2.2). The
    axial motion is never left out: what the frame does not carry is a rigid mode.

    Modes: a load that is fixed in space at frequency f appears in the rotor frame at f ± Ω, so the
    band ends at f + Ω. Modes in the band stay; of the others those whose absence changes the
    response of the interfaces by less than half the accuracy leave, see
    :mod:`exudyn_rotor.advice.mode_choice`. All modes in the band is a warning: more may lie there.
    What the modes given lack of static responses, the row ``residual`` of :func:`check_run` tells.
    Other nodes and the stress err by more.

    Step: generalised alpha makes the period of a motion of frequency ω longer by ``(ωh)²/12`` of
    itself (0.0844 (ωh)² at Exudyn's spectral radius 0.9). Half the accuracy is allowed for that at
    the end of the band, and for the change of the steady response: next to a resonance that is
    larger by the amplification, and where a slow motion in space is integrated in the rotor frame
    by the ratio of frequencies; see :mod:`exudyn_rotor.advice.step_size`. After N periods the phase
    is behind by πN times the accuracy. Faster motions than the band, such as the ringing after a
    sudden start, are not resolved.

    Examples
    --------
    A row of masses of 1 kg, the k-th on springs of ``4ᵏ`` MN/m in the rotor frame:

    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, propose
    >>> nodes = 0.1 * np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    >>> stiffness = np.diag(np.repeat([1e6, 4e6, 1.6e7], 3))
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(9), stiffness, nodes, "z", interfaces={"first": [0], "last": [2]}
    ... )
    >>> proposal = propose(rotor.reduce(9), speeds=20.0)
    >>> proposal.translation, proposal.spin, proposal.total
    ('none', 20.0, 9)
    >>> proposal.modes
    (0, 1, 2, 6, 7, 8)
    >>> proposal.truncated(rotor.reduce(9)).size
    6
    """
    request = Request.of(speeds, load_frequencies, accuracy)
    checks.instance(reduced, "reduced", ReducedRotor)
    if not reduced.interfaces:
        raise ValueError(
            "reduced: has no interfaces, so nothing says where it is loaded; add some with "
            "rotor.with_interface"
        )
    given = Candidate.of(reduced, supports)
    spin, translation, why = _formulation(given, request)
    (kept, error), step = choose_modes(given, request), choose_step(given, request)
    for message in _unmet(given, request):
        warnings.warn(message, AssumptionWarning, stacklevel=2)
    return Proposal(
        translation=translation,
        spin=spin,
        stiffening="full" if given.invariants.K2 is not None else "tilt",
        modes=kept,
        total=given.frequencies.size,
        error=error,
        step=step.size,
        speeds=(request.low, request.high),
        accuracy=request.accuracy,
        reasons=(why, *_reasons(given, request, kept, error, step)),
    )


def _formulation(given: Candidate, request: Request) -> tuple[str | float, str, str]:
    """Return spin and translation for add_rotor, and the reason."""
    if request.low == request.high:
        why = "one speed: all motion is in the modes, and the matrices are constant"
        return request.high, "none", why
    inv = given.invariants
    if given.reduced.grounded or inv.Theta <= _NO_INERTIA * np.trace(inv.J):
        raise ValueError(
            "speeds: this rotor's spin cannot be free (its stiffness holds it, or it has no "
            "moment of inertia); give one speed here, and spin=PrescribedMotion.run_up(…) to "
            "add_rotor"
        )
    if given.axial:
        return "free", "free", "the speed varies, and something may act along the axis"
    return "free", "in-plane", "the speed varies, and nothing acts along the axis"


def _reasons(
    given: Candidate, request: Request, kept: np.ndarray, error: float, step: Step
) -> Iterator[str]:
    """Yield why these modes and this step."""
    frequencies = given.frequencies
    yield (
        f"modes: {np.sum(frequencies <= request.highest)} lie in the band up to (f + Ω)/2π = "
        f"{IN_HERTZ * request.highest:.4g} Hz of the rotor frame; the "
        f"{frequencies.size - kept.size} left out change the response of interfaces "
        f"by {error:.2g}, resonances damped by {GROWTH:.0%} at least"
    )
    if np.isnan(step.speed):
        yield (
            f"step: ωh = {request.highest * step.size:.3g} at the end of the band, so periods are "
            f"too long by {request.allowed:g} of themselves there"
        )
    else:
        yield (
            f"step: changes the response at {step.speed:.4g} rad/s, to a load at "
            f"{step.frequency:.4g} rad/s in the rotor frame, by {request.allowed:g}, or the growth "
            "of a motion there by half; a resonance is near, or a motion that is slow in space"
        )


def _unmet(given: Candidate, request: Request) -> Iterator[str]:
    """Yield where the accuracy is not met, each with what to do."""
    if given.frequencies.size and given.frequencies.max() < request.highest:
        yield (
            f"all {given.frequencies.size} flexible modes given lie in the band up to "
            f"{IN_HERTZ * request.highest:.4g} Hz of the rotor frame, and more may: reduce the "
            "rotor with more modes and ask again"
        )
    softened = estimated_error(given.invariants, request.high)
    if softened > request.accuracy:
        yield (
            f"flexible modes soften falsely: frequencies change by about {softened:.2g}, above "
            f"the accuracy {request.accuracy:g}; reduce the rotor with prestress=True and ask "
            "again, which allows stiffening='full'"
        )
