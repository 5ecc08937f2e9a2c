"""After a run: whether the assumptions of the model held, each with a number."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.advice.check_result import CheckRow, RunCheck
from exudyn_rotor.advice.left_out import check_model
from exudyn_rotor.advice.proposal import Proposal
from exudyn_rotor.advice.run_measures import Measures
from exudyn_rotor.advice.run_rows import ALWAYS, LIMITS, OF_MODES, rows_at_nodes
from exudyn_rotor.advice.warning import AssumptionWarning
from exudyn_rotor.multibody.full.full_body import FullRotorBody, recorded_states
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor

_SAME = 1e-6  # relative difference of masses and moments of one rotor


def check_run(
    body: RotorBody | FullRotorBody,
    *,
    reduced: ReducedRotor | None = None,
    solid: SolidRotor | None = None,
    nodes: ArrayLike | None = None,
    proposal: Proposal | None = None,
    accuracy: float | None = None,
    limits: Mapping[str, float] | None = None,
    warn: bool = True,
) -> RunCheck:
    """Check after a run whether the model's assumptions held.

    Parameters
    ----------
    body : RotorBody or FullRotorBody
        After the solution; ``body.start_recording()`` before ``mbs.Assemble()`` records the run at
        the instants of ``solution.sensors.writePeriod``, that of a full body at instants that it is
        given. Before a run this checks the initial state.
    reduced : ReducedRotor, optional
        The rotor; adds the check of yielding where it was reduced with a yield stress.
    solid : SolidRotor, optional
        The full model of `reduced`, which must be the rotor in the scene, with shapes. Adds the
        errors at nodes: the static response of the full model to the loads at 60 instants. Takes a
        factor of the stiffness and as many solutions.
    nodes : array_like of int, optional
        Nodes to look at in these, as of ``solid.nearest_node(…)``; all by default.
    proposal : Proposal, optional
        Adds the check of the speed range, and gives the accuracy.
    accuracy : float, optional
        Relative error of periods, and of motion that repeats itself; the proposal's, or 1e-3. Free
        vibrations go out of phase by more, see the notes.
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
    Checks, with a for the accuracy; "size" is the rotor's radius of gyration. A full body has the
    rows up to ``any angle``.

    ``displacement`` and ``stress`` are the first correction of the modes' motion. They do not see
    the error of the mesh, loads elsewhere than at interfaces and markers of ``body.add_marker``,
    what a resonance makes of the modes' error, and how missing modes ring after a sudden start.

    No row adds up errors over a run. A free vibration, such as a sudden start leaves where damping
    is weak, goes out of phase in every period: by about 2π times the row ``step``, and by about π
    times ``displacement``, for its frequency errs by half of that. Its instants then err by this
    phase times its amplitude; motion forced by the spin or by loads does not. To compare instants,
    begin in the steady state (``body.start_from(steady_state(body).state())``), wait for the start
    to die down, or ask for an accuracy better by 2π times the number of periods.

    ===================  =======  ==================================================================
    name                 limit    meaning
    ===================  =======  ==================================================================
    ``tilt``             √a       largest rigid tilt [rad]; terms of its second order are left out
    ``deflection``       √a       root mean square flexible displacement over the size, likewise
    ``adrift``           1        the centre of mass off its place in the frame, over the size
    ``locked``           1e-5     locked coordinates off their place [rad], [size]
    ``connections``      0        connectors, joints and loads that the rotor cannot carry:
                                  ``body.check_connections()`` names them
    ``step``             a        error by the step, 0.0844 h² times the accelerations of the
                                  vibrations over their displacements; larger for slow motion in
                                  space that is integrated in the rotor frame; next to a resonance
                                  amplitudes err by more, by the amplification
    ``film``             1        displacement of a journal at the end over that beyond which its
                                  film is too thin and the law goes on by its tangent
    ``frozen spin``      a        angular momentum of the changing moment of inertia over the whole,
                                  left out by ``spin_coupling='frozen'``; the error of spin speeds
    ``any angle``        1e-3     after ``mbs.SolveStatic()`` of a rotor that spins: forces that
                                  change with its angle, over the loads
    ``unresisted load``  0.01     what ``connections`` counts, as a share of the largest load
    ``stiffening``       a        stiffening that the level leaves out, as relative change of
                                  frequency of the recorded motion; estimated without a prestress
    ``top modes``        0.01     elastic energy in the highest fifth of the flexible modes over the
                                  energy of the motion: how much the modes beyond may hold
    ``residual``         a        static deflection of interfaces against the mean motion of the
                                  rotor, by loads at interfaces and the centrifugal load, that the
                                  modes leave out, over their displacement
    ``axial force``      2a       axial force between interfaces over the load at which the shaft
                                  buckles, hinged where the force acts, less what the prestress
                                  holds; frequencies err by half of it
    ``explicit``         1        explicit solvers: step over that at which undamped motion grows
                                  (by e in the run, with Euler's method and the midpoint rule)
    ``yield``            1        static von Mises stress, by rotation and at rest, over the yield
                                  stress; the larger of those at rest and at the highest speed
    ``displacement``     a        what the modes leave out at nodes, likewise, over the largest
                                  displacement there; with `solid`
    ``stress``           √a       von Mises stress of that, over the largest there, the static
                                  stress by the spin added as by :class:`StressField`; with `solid`
                                  and stress modes. Not the error of the mesh
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
    checks.instance(body, "body", (RotorBody, FullRotorBody), "add_rotor returns one")
    body.check_assembled()
    if isinstance(body, FullRotorBody):
        _check_no_modes(body, (reduced, solid, nodes))
    if reduced is not None:
        _check_same(body, checks.instance(reduced, "reduced", ReducedRotor))
    if proposal is not None:
        checks.instance(proposal, "proposal", Proposal, "propose makes one")
    if accuracy is None:
        accuracy = proposal.accuracy if proposal is not None else 1e-3
    checks.flag(warn, "warn")
    known = _limits(checks.tolerance(accuracy, "accuracy"), limits)
    at_nodes = _nodes(body, reduced, solid, nodes)
    record = recorded_states(body) if isinstance(body, FullRotorBody) else body.recorded()
    if np.all(np.isfinite(record.q)) and np.all(np.isfinite(record.q_t)):
        made = list(_rows(Measures(body, record, reduced), proposal))
        if at_nodes is not None and len(record.time) > 1:
            made += rows_at_nodes(Measures(body, record, reduced), solid, at_nodes)
    else:
        made = [("finite", "coordinates that are not finite", np.inf, "the solution failed")]
    checked = tuple(CheckRow(name, what, v, known[name], then) for name, what, v, then in made)
    result = RunCheck(checked, len(record.time))
    for message in _messages(result, ran=record.time[-1] > 0.0) if warn else ():
        warnings.warn(f"rotor {body.name!r}: {message}", AssumptionWarning, stacklevel=2)
    return result


def _rows(measures: Measures, proposal: Proposal | None) -> Iterator[tuple[str, str, float, str]]:
    """Yield name, meaning, value and advice of the rows that a run has."""
    full = isinstance(measures.body, FullRotorBody)
    for row in ALWAYS if full else (*ALWAYS, *OF_MODES):
        value = row.measure(measures)
        if value is not None:
            yield row.name, row.meaning, float(value), row.advice
    if proposal is not None:
        fastest, most = measures.fastest, proposal.speeds[1]
        ratio = fastest / most if most else np.inf
        yield (
            "speed",
            "highest speed over that of the proposal",
            ratio if fastest else 0.0,
            f"{fastest:.6g} rad/s were reached; propose again with that",
        )


def _messages(result: RunCheck, ran: bool) -> Iterator[str]:
    if ran and not result.complete:
        yield result.gap()
    for row in result.failed:
        yield (f"{row.name} {row.value:.3g} exceeds {row.limit:.3g} ({row.meaning}): {row.advice}")


def _check_no_modes(body: FullRotorBody, given: Sequence[object]) -> None:
    """Refuse what is for the error of modes."""
    if any(each is not None for each in given):
        raise ValueError(
            f"body: rotor {body.name!r} is a full body, without an error of modes; leave reduced, "
            "solid and nodes out"
        )


def _check_same(body: RotorBody, reduced: ReducedRotor) -> None:
    """Refuse another rotor; one with other modes of the same is all right."""
    added, given = body.selection.source.invariants, reduced.invariants
    change = np.abs(added.J - given.J).max() / np.abs(added.J).max()
    if abs(added.mass - given.mass) > _SAME * added.mass or change > _SAME:
        raise ValueError(
            f"reduced: of {given.mass:.6g} kg is another rotor than the body's, "
            f"{added.mass:.6g} kg or other moments of inertia; give the one that was added"
        )


def _nodes(
    body: RotorBody, reduced: ReducedRotor | None, solid: SolidRotor | None, nodes: ArrayLike | None
) -> np.ndarray | None:
    """Return the nodes whose errors are asked for; None for none."""
    if solid is None:
        if nodes is not None:
            raise ValueError("nodes: the error at nodes needs the full model; give solid, too")
        return None
    checks.instance(solid, "solid", SolidRotor, "the one that was reduced")
    if reduced is None:
        raise ValueError("solid: the error at nodes needs the modes; give reduced, too")
    check_model(body, reduced, solid)
    if nodes is None:
        return np.arange(solid.node_count)
    chosen = checks.whole_numbers(nodes, "nodes", most=solid.node_count - 1)
    if chosen.size == 0:
        raise ValueError("nodes: needs one or more, got none; leave it out for all")
    return chosen


def _limits(accuracy: float, limits: Mapping[str, float] | None) -> dict[str, float]:
    known = {name: float(limit(accuracy)) for name, limit in LIMITS.items()}
    if limits is not None:
        checks.mapping(limits, "limits", "limit of a check", known)
        for name, value in limits.items():
            known[name] = checks.number(value, f"limits: {name!r}", least=0.0)
    return known
