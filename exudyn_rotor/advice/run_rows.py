"""The rows of a check of a run: measures of Measures with their meaning and what to do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from operator import methodcaller

import numpy as np

from exudyn_rotor.advice.axial_force import axial_share
from exudyn_rotor.advice.full_measures import FullMeasures
from exudyn_rotor.advice.left_out_fields import left_out_at_nodes
from exudyn_rotor.advice.proposal import Proposal
from exudyn_rotor.advice.residual import residual_deflection
from exudyn_rotor.advice.run_measures import Measures
from exudyn_rotor.advice.static_angle import change_with_angle
from exudyn_rotor.advice.unresisted import unresisted_load
from exudyn_rotor.multibody.rotor.connections import lost_loads
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.solid_rotor import SolidRotor

_UNKNOWN = (
    "not seen are errors of the mesh, loads elsewhere than at interfaces and markers of "
    "body.add_marker, what a resonance makes of the modes' error, and the ringing of missing modes "
    "after a sudden start"
)
Row = tuple[str, str, float, str]  # name, meaning, value, what to do
# name, measure of Measures, meaning, what to do
_ALWAYS: tuple[tuple[str, Callable[[Measures], float], str, str], ...] = (
    (
        "tilt",
        methodcaller("tilt"),
        "largest tilt [rad]",
        "the error grows with its square; use Exudyn's 3D body for wide tilts",
    ),
    (
        "deflection",
        methodcaller("deflection"),
        "flexible displacement over the size",
        "small deformations are assumed; check loads and supports",
    ),
    (
        "travel",
        methodcaller("travel"),
        "centre of mass off the frame, over the size",
        "let the frame follow: translation='free'",
    ),
    (
        "adrift",
        methodcaller("adrift"),
        "centre of mass off its place in the frame, over the size",
        "support the rotor against the centrifugal force of its eccentricity, or let the frame "
        "follow: translation='free'",
    ),
    (
        "locked",
        methodcaller("locked"),
        "locked coordinates off their place [rad], [size]",
        "use locking='constraints', or a smaller step",
    ),
    (
        "connections",
        lambda m: lost_loads(m.body),
        "connections, joints and loads that the rotor cannot carry",
        "body.check_connections() names them; use markers at interfaces or mesh nodes",
    ),
    (
        "strain",
        methodcaller("strain"),
        "mean centrifugal strain",
        "linear elasticity errs by about this; a nonlinear model is needed at this speed",
    ),
    (
        "stiffening",
        methodcaller("missing_stiffness"),
        "stiffening left out, relative change of frequency",
        "use stiffening='full' (modes need reduce with prestress=True), or 'tilt' in place of "
        "'none'",
    ),
    (
        "spin step",
        methodcaller("spin_step"),
        "spin angle per step [rad]",
        "take smaller steps; the error falls with their square",
    ),
)
_OF_MODES: tuple[tuple[str, Callable[[Measures], float | None], str, str], ...] = (
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
        "divergence",
        Measures.divergence,
        "Ω²/Ω_d², Ω_d where flexible modes grow",
        "stay below that speed, or use stiffening='full'; without it the growth may be false",
    ),
)


def rows(
    measures: Measures, reduced: ReducedRotor | None, proposal: Proposal | None
) -> Iterator[Row]:
    """Yield the rows that a run of a reduced or of a full body has."""
    for name, measure, meaning, advice in _ALWAYS:
        yield name, meaning, float(measure(measures)), advice
    yield (
        "step",
        "relative error of every period; free vibrations go out of phase by 2π times that in each",
        measures.step_error(),
        f"the motion has {measures.frequency:.4g} rad/s on average, in its own coordinates; take "
        "smaller steps, whose square the error follows, or start without a jump if it rings",
    )
    film = measures.film_use()
    if film is not None:
        yield (
            "film",
            "displacement of a journal at the end over that to which it has a film",
            film,
            "the journal touches, or the start was too sudden for the step: begin with smaller "
            "steps, above all with a full body, or in the steady state",
        )
    left_out = measures.frozen()
    if left_out is not None:
        yield (
            "frozen spin",
            "angular momentum left out, over the whole",
            left_out,
            "add the rotor with spin_coupling='full'",
        )
    share = change_with_angle(measures.body)
    if share is not None:
        yield (
            "any angle",
            "forces of a static solution that change with the rotor's angle, over the loads",
            share,
            "gravity across the axis, forces that stand still and supports that are not alike in "
            "all directions have no static solution of a rotor that spins: steady_state(body) "
            "finds the motion, body.start_from(steady.state()) starts a run from it; for the rotor "
            "at rest, use spin=0",
        )
    if isinstance(measures, FullMeasures):
        yield from _rows_of_nodes(measures)
    else:
        yield from _rows_of_modes(measures, reduced)
    if proposal is not None:
        ratio = measures.fastest / proposal.speeds[1] if proposal.speeds[1] else np.inf
        yield (
            "speed",
            "highest speed over that of the proposal",
            ratio if measures.fastest else 0.0,
            f"{measures.fastest:.6g} rad/s were reached; propose again with that",
        )


def _rows_of_nodes(measures: FullMeasures) -> Iterator[Row]:
    stress = measures.yielding()
    if stress is not None:
        yield "yield", "stress over yield stress", stress, "linear elasticity holds below it only"


def _rows_of_modes(measures: Measures, reduced: ReducedRotor | None) -> Iterator[Row]:
    for name, measure, meaning, advice in _OF_MODES:
        value = measure(measures)
        if value is not None:
            yield name, meaning, float(value), advice
    missing = residual_deflection(measures.body, measures.record, measures.size)
    if missing is not None:
        yield (
            "residual",
            "deflection at interfaces that the modes leave out",
            missing,
            "reduce with more modes, or with craig_bampton_modes",
        )
    axial = axial_share(measures.body, measures.record, measures.size)
    if axial is not None:
        yield (
            "axial force",
            "axial force over the buckling load, its stiffness in bending left out",
            axial,
            "frequencies are off by about half of it; give it to rotor.prestress(loads=…, "
            "supports=…), and the prestress to reduce",
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


def rows_at_nodes(
    measures: Measures, reduced: ReducedRotor, solid: SolidRotor, nodes: np.ndarray
) -> Iterator[Row]:
    """Yield the errors of a reduced run at nodes."""
    found = left_out_at_nodes(measures.body, measures.record, measures.size, reduced, solid, nodes)
    beside = f"; {_UNKNOWN}"
    yield _row_at_nodes(
        "displacement",
        "displacement that the modes leave out",
        "m",
        (found.displacement, found.moved),
        nodes,
        "reduce with more modes of the frequencies or loads that are missing: craig_bampton_modes "
        f"for loads at interfaces, spinning_modes for the stretch by the spin{beside}",
    )
    if found.stress is not None:
        yield _row_at_nodes(
            "stress",
            "stress that the modes leave out",
            "Pa",
            (found.stress, found.stressed),
            nodes,
            f"reduce with more modes, or with craig_bampton_modes, and a prestress{beside}",
        )


def _row_at_nodes(
    name: str,
    what: str,
    unit: str,
    values: tuple[np.ndarray, np.ndarray],
    nodes: np.ndarray,
    advice: str,
) -> Row:
    missing, size = (np.max(each) for each in values)
    worst = nodes[np.argmax(values[0].max(axis=0))]
    meaning = f"{what}, over the largest; {missing:.3g} {unit} at node {worst}"
    return name, meaning, float(missing / size) if size else 0.0, advice
