"""After a run: whether the assumptions of the model held, each with a number."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.advice.check_result import CheckRow, RunCheck
from exudyn_rotor.advice.proposal import Proposal
from exudyn_rotor.advice.request import PERIOD_ERROR
from exudyn_rotor.advice.residual import residual_deflection
from exudyn_rotor.advice.run_measures import Measures
from exudyn_rotor.advice.unresisted import unresisted_load
from exudyn_rotor.advice.warning import AssumptionWarning
from exudyn_rotor.multibody.full_body import reduced_body
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.tensor import von_mises

_SAME = 1e-6  # relative difference of masses and moments of one rotor


def default_limits(accuracy: float) -> dict[str, float]:
    """Return the limits of all checks for an accuracy; see :func:`check_run`."""
    root = float(np.sqrt(accuracy))
    return {
        "finite": 0.0,
        "tilt": root,
        "deflection": root,
        "travel": 0.1,
        "adrift": 1.0,
        "locked": 1e-6,
        "frozen spin": accuracy,
        "connections": 0.0,
        "unresisted load": 0.01,
        "top modes": 0.01,
        "residual": accuracy,
        "strain": accuracy,
        "stiffening": accuracy,
        "divergence": 0.5,
        "step": accuracy,
        "spin step": float(np.sqrt(accuracy / PERIOD_ERROR)),
        "explicit": 1.0,
        "yield": 1.0,
        "speed": 1.0 + accuracy,
    }


def check_run(
    body: RotorBody,
    *,
    reduced: ReducedRotor | None = None,
    proposal: Proposal | None = None,
    accuracy: float | None = None,
    limits: Mapping[str, float] | None = None,
    warn: bool = True,
) -> RunCheck:
    """Check after a run whether the model's assumptions held.

    Parameters
    ----------
    body : RotorBody
        After the solution; ``body.start_recording()`` before ``mbs.Assemble()`` records the run at
        the instants of ``solution.sensors.writePeriod``. Before a run this checks the initial
        state.
    reduced : ReducedRotor, optional
        The rotor; adds the check of yielding where it was reduced with a yield stress.
    proposal : Proposal, optional
        Adds the check of the speed range, and gives the accuracy.
    accuracy : float, optional
        Relative error of the motion; the proposal's, or 1e-3.
    limits : mapping of str to float, optional
        Limits by name of a check in place of the defaults.
    warn : bool
        Whether there is an :class:`AssumptionWarning` for every row that fails, and for a run that
        was recorded at less than 20 instants.

    Returns
    -------
    RunCheck

    Raises
    ------
    TypeError, ValueError
        For bad input, or a system that is not assembled.

    Notes
    -----
    Checks, with a for the accuracy; "size" is the rotor's radius of gyration.

    ===================  =======  ==================================================================
    name                 limit    meaning
    ===================  =======  ==================================================================
    ``tilt``             √a       largest rigid tilt [rad]; terms of its second order are left out
    ``deflection``       √a       root mean square flexible displacement over the size, likewise
    ``travel``           0.1      the centre of mass off a frame that does not follow, over the
                                  size; exact, but with a free spin the mass matrix then changes
                                  much in every step
    ``adrift``           1        the same distance where the spin is prescribed, too: nothing holds
                                  the rotor in its place
    ``locked``           1e-6     locked coordinates off their place [rad], [size]
    ``frozen spin``      a        angular momentum of the changing moment of inertia over the whole,
                                  left out by ``spin_coupling='frozen'``; the error of spin speeds
    ``connections``      0        connectors, joints and loads that the rotor cannot carry:
                                  ``body.check_connections()`` names them
    ``unresisted load``  0.01     load on a locked coordinate, or moment by a second-order arm, that
                                  no equation resists, over the largest load
    ``top modes``        0.01     elastic energy in the highest fifth of the flexible modes over the
                                  energy of the motion: how much the modes beyond may hold
    ``residual``         a        static deflection of interfaces against the mean motion of the
                                  rotor, by loads at interfaces and the centrifugal load, that the
                                  modes leave out, over their displacement; stiff supports let the
                                  interfaces themselves err by less; not for other loads elsewhere
    ``strain``           a        mean centrifugal strain as the modes show it; the relative error
                                  of linear elasticity
    ``stiffening``       a        stiffening that the level leaves out, as relative change of
                                  frequency of the recorded motion; estimated without a prestress
    ``divergence``       0.5      Ω²/Ω_d²; Ω_d is the speed at which flexible modes begin to grow
    ``step``             a        relative period error 0.0844 (ωh)² of the recorded motion, larger
                                  for slow motion in space that is integrated in the rotor frame;
                                  next to a resonance amplitudes err by more, by the amplification
    ``spin step``        √(a/…)   spin angle per step [rad]: the same error at the spin speed
    ``explicit``         1        explicit solvers: step over that at which undamped motion grows
                                  (by e in the run, with Euler's method and the midpoint rule)
    ``yield``            1        static von Mises stress, by rotation and at rest, over the yield
                                  stress; the larger of those at rest and at the highest speed
    ``speed``            1 + a    highest speed over that of the proposal
    ===================  =======  ==================================================================

    Examples
    --------
    >>> import exudyn, numpy as np
    >>> from exudyn_rotor import SolidRotor, add_rotor, check_run, recommended_settings
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(6), 1e6 * np.eye(6), [[0.1, 0, 0], [-0.1, 0, 0]], "z", interfaces={"top": [0]}
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(6), spin=10.0, translation="none")
    >>> body.start_recording()
    >>> mbs.Assemble()
    >>> settings = recommended_settings(end_time=0.01, step=2e-5)
    >>> settings.solution.sensors.writePeriod = 1e-4
    >>> settings.solution.file.write = False
    >>> settings.timeIntegration.verboseMode = 0
    >>> mbs.SolveDynamic(settings)
    True
    >>> check_run(body).ok
    True
    """
    reduced_body(body, how="add_rotor returns one")
    body.check_assembled()
    if reduced is not None:
        _check_same(body, checks.instance(reduced, "reduced", ReducedRotor))
    if proposal is not None:
        checks.instance(proposal, "proposal", Proposal, "propose makes one")
    if accuracy is None:
        accuracy = proposal.accuracy if proposal is not None else 1e-3
    checks.flag(warn, "warn")
    known = _limits(checks.tolerance(accuracy, "accuracy"), limits)
    record = body.recorded()
    measures = Measures(body, record)
    if np.all(np.isfinite(record.q)) and np.all(np.isfinite(record.q_t)):
        made = _rows(measures, reduced, proposal)
    else:
        made = [("finite", "coordinates that are not finite", np.inf, "the solution failed")]
    rows = tuple(CheckRow(name, what, v, known[name], then) for name, what, v, then in made)
    result = RunCheck(rows, len(record.time))
    for message in _messages(result, ran=record.time[-1] > 0.0) if warn else ():
        warnings.warn(f"rotor {body.name!r}: {message}", AssumptionWarning, stacklevel=2)
    return result


def _messages(result: RunCheck, ran: bool) -> Iterator[str]:
    if ran and not result.complete:
        yield result.gap()
    for row in result.failed:
        yield (f"{row.name} {row.value:.3g} exceeds {row.limit:.3g} ({row.meaning}): {row.advice}")


def _check_same(body: RotorBody, reduced: ReducedRotor) -> None:
    """Refuse another rotor; one with other modes of the same is all right."""
    added, given = body.selection.source.invariants, reduced.invariants
    change = np.abs(added.J - given.J).max() / np.abs(added.J).max()
    if abs(added.mass - given.mass) > _SAME * added.mass or change > _SAME:
        raise ValueError(
            f"reduced: of {given.mass:.6g} kg is another rotor than the body's, "
            f"{added.mass:.6g} kg or other moments of inertia; give the one that was added"
        )


def _limits(accuracy: float, limits: Mapping[str, float] | None) -> dict[str, float]:
    known = default_limits(accuracy)
    if limits is not None:
        checks.mapping(limits, "limits", "limit of a check", known)
        for name, value in limits.items():
            known[name] = checks.number(value, f"limits: {name!r}", least=0.0)
    return known


_Row = tuple[str, str, float, str]
# name, measure of Measures, meaning, what to do
_ALWAYS: tuple[tuple[str, Callable[[Measures], float], str, str], ...] = (
    (
        "tilt",
        Measures.tilt,
        "largest tilt [rad]",
        "the error grows with its square; use Exudyn's 3D body for wide tilts",
    ),
    (
        "deflection",
        Measures.deflection,
        "flexible displacement over the size",
        "small deformations are assumed; check loads and supports",
    ),
    (
        "travel",
        Measures.travel,
        "centre of mass off the frame, over the size",
        "let the frame follow: translation='free'",
    ),
    (
        "adrift",
        Measures.adrift,
        "centre of mass off its place in the frame, over the size",
        "support the rotor against the centrifugal force of its eccentricity, or let the frame "
        "follow: translation='free'",
    ),
    (
        "locked",
        Measures.locked,
        "locked coordinates off their place [rad], [size]",
        "use locking='constraints', a smaller step, or load an interface instead of the frame",
    ),
    (
        "connections",
        lambda m: len(m.body.check_connections(warn=False)),
        "connections, joints and loads that the rotor cannot carry",
        "body.check_connections() names them; use markers at interfaces or mesh nodes",
    ),
    (
        "unresisted load",
        lambda m: unresisted_load(m.body, m.record, m.size),
        "load that no equation resists, over the largest",
        "put loads on rigid markers; coordinates of the frame's node carry spin and translation "
        "only, and loads get no moment arm by deflection",
    ),
    (
        "top modes",
        Measures.top_share,
        "energy in the highest fifth of the modes",
        "keep more modes, or use craig_bampton_modes",
    ),
    (
        "strain",
        Measures.strain,
        "mean centrifugal strain shown by the modes",
        "linear elasticity errs by about this; a nonlinear model is needed at this speed",
    ),
    (
        "stiffening",
        Measures.missing_stiffness,
        "stiffening left out, relative change of frequency",
        "reduce with prestress=True and use stiffening='full', or 'tilt' in place of 'none'",
    ),
    (
        "divergence",
        Measures.divergence,
        "Ω²/Ω_d², Ω_d where flexible modes grow",
        "stay below that speed, or use stiffening='full'; without it the growth may be false",
    ),
    (
        "spin step",
        Measures.spin_step,
        "spin angle per step [rad]",
        "take smaller steps; the error falls with their square",
    ),
)


def _rows(
    measures: Measures, reduced: ReducedRotor | None, proposal: Proposal | None
) -> Iterator[_Row]:
    for name, measure, meaning, advice in _ALWAYS:
        yield name, meaning, float(measure(measures)), advice
    yield (
        "step",
        "relative error of the motion's period",
        measures.step_error(),
        f"the motion has {measures.frequency:.4g} rad/s on average, in its own coordinates; take "
        "smaller steps, whose square the error follows, or start without a jump if it rings",
    )
    left_out = measures.frozen()
    if left_out is not None:
        yield (
            "frozen spin",
            "angular momentum left out, over the whole",
            left_out,
            "add the rotor with spin_coupling='full'",
        )
    missing = residual_deflection(measures.body, measures.record, measures.size)
    if missing is not None:
        yield (
            "residual",
            "deflection at interfaces that the modes leave out",
            missing,
            "reduce with more modes, or with craig_bampton_modes",
        )
    explicit = measures.explicit_step()
    if explicit:
        yield (
            "explicit",
            "step over the stable one",
            explicit,
            "take smaller steps, keep fewer modes, or use an implicit solver",
        )
    static = None if reduced is None else reduced.centrifugal
    if static is not None and static.stress is not None and static.yield_stress:
        # the stress is a + ω²b and its von Mises stress convex in ω²: largest at an end
        ends = (static.stress_at(speed) for speed in (0.0, measures.fastest))
        peak = max(float(von_mises(stress).max()) for stress in ends)
        advice = "the elastic prestress holds below the yield stress only"
        yield "yield", "static stress over yield stress", peak / static.yield_stress, advice
    if proposal is not None:
        ratio = measures.fastest / proposal.speeds[1] if proposal.speeds[1] else np.inf
        yield (
            "speed",
            "highest speed over that of the proposal",
            ratio if measures.fastest else 0.0,
            f"{measures.fastest:.6g} rad/s were reached; propose again with that",
        )
