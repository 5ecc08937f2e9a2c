"""The rows of a check of a run: measures with their limits, meanings and what to do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from exudyn_rotor.advice.axial_force import axial_share
from exudyn_rotor.advice.left_out import left_out_at_nodes, residual_deflection
from exudyn_rotor.advice.run_measures import Measures
from exudyn_rotor.advice.static_angle import change_with_angle
from exudyn_rotor.multibody.rotor.connections import lost_items
from exudyn_rotor.solid_rotor import SolidRotor

_UNKNOWN = (
    "; not seen are errors of the mesh, loads elsewhere than at interfaces and markers of "
    "body.add_marker, what a resonance makes of the modes' error, and the ringing of missing modes "
    "after a sudden start"
)


class Row(NamedTuple):
    """A row that any run may have; its measure is None where the row does not apply."""

    name: str
    limit: Callable[[float], float]  # of the accuracy
    measure: Callable[[Measures], float | None]
    meaning: str
    advice: str


def _same(accuracy: float) -> float:
    return accuracy


def _fixed(limit: float) -> Callable[[float], float]:
    return lambda _: limit


ALWAYS = (
    Row(
        "tilt",
        np.sqrt,
        Measures.tilt,
        "largest tilt [rad]",
        "the error grows with its square; use Exudyn's 3D body for wide tilts",
    ),
    Row(
        "deflection",
        np.sqrt,
        Measures.deflection,
        "flexible displacement over the size",
        "small deformations are assumed; check loads and supports",
    ),
    Row(
        "adrift",
        _fixed(1.0),
        Measures.adrift,
        "centre of mass off its place in the frame, over the size",
        "support the rotor against the centrifugal force of its eccentricity, or let the frame "
        "follow: translation='free'",
    ),
    Row(
        "locked",
        _fixed(1e-5),
        Measures.locked,
        "locked coordinates off their place [rad], [size]",
        "use locking='constraints', or a smaller step",
    ),
    Row(
        "connections",
        _fixed(0.0),
        lambda m: len(lost_items(m.body)),
        "connections, joints and loads that the rotor cannot carry",
        "body.check_connections() names them; use markers at interfaces or mesh nodes",
    ),
    Row(
        "step",
        _same,
        Measures.step_error,
        "relative error of every period; free vibrations go out of phase by 2π times that in each",
        "take smaller steps, whose square the error follows, or start without a jump if it rings",
    ),
    Row(
        "film",
        _fixed(1.0),
        Measures.film_use,
        "displacement of a journal at the end over that to which it has a film",
        "the journal touches, or the start was too sudden for the step: begin with smaller steps, "
        "above all with a full body, or in the steady state",
    ),
    Row(
        "frozen spin",
        _same,
        Measures.frozen,
        "angular momentum left out, over the whole",
        "add the rotor with spin_coupling='full'",
    ),
    Row(
        "any angle",
        _fixed(1e-3),
        lambda m: change_with_angle(m.body),
        "forces of a static solution that change with the rotor's angle, over the loads",
        "gravity across the axis, forces that stand still and supports that are not alike in all "
        "directions have no static solution of a rotor that spins: steady_state(body) finds the "
        "motion, body.start_from(steady.state()) starts a run from it; for the rotor at rest, use "
        "spin=0",
    ),
)
OF_MODES = (
    Row(
        "unresisted load",
        _fixed(0.01),
        Measures.unresisted,
        "what the rotor cannot carry, over the largest load",
        "put loads on markers at interfaces or mesh nodes; body.check_connections() names them",
    ),
    Row(
        "stiffening",
        _same,
        Measures.missing_stiffness,
        "stiffening left out, relative change of frequency",
        "use stiffening='full' (modes need reduce with prestress=True), or 'tilt' in place of "
        "'none'",
    ),
    Row(
        "top modes",
        _fixed(0.01),
        Measures.top_share,
        "energy in the highest fifth of the modes",
        "keep more modes, or use craig_bampton_modes",
    ),
    Row(
        "residual",
        _same,
        lambda m: residual_deflection(m.body, m.record, m.size),
        "deflection at interfaces that the modes leave out",
        "reduce with more modes, or with craig_bampton_modes",
    ),
    Row(
        "axial force",
        lambda accuracy: 2.0 * accuracy,
        lambda m: axial_share(m.body, m.record, m.size),
        "axial force over the buckling load, its stiffness in bending left out",
        "frequencies are off by about half of it; give it to rotor.prestress(loads=…, "
        "supports=…), and the prestress to reduce",
    ),
    Row(
        "explicit",
        _fixed(1.0),
        Measures.explicit_step,
        "step over the stable one",
        "take smaller steps, keep fewer modes, or use an implicit solver",
    ),
    Row(
        "yield",
        _fixed(1.0),
        Measures.yielding,
        "static stress over yield stress",
        "the elastic prestress holds below the yield stress only",
    ),
)
LIMITS = {row.name: row.limit for row in (*ALWAYS, *OF_MODES)} | {
    "finite": _fixed(0.0),
    "displacement": _same,
    "stress": np.sqrt,
    "speed": lambda accuracy: 1.0 + accuracy,
}


def rows_at_nodes(
    measures: Measures, solid: SolidRotor, nodes: np.ndarray
) -> Iterator[tuple[str, str, float, str]]:
    """Yield name, meaning, value and advice of the errors of a reduced run at nodes."""
    found = left_out_at_nodes(measures, solid, nodes)
    more = "reduce with more modes, or with craig_bampton_modes"
    for name, unit, advice in (
        ("displacement", "m", more),
        ("stress", "Pa", more + ", a prestress"),
    ):
        if name in found:
            values, whole = found[name]
            missing, size = float(values.max()), float(whole.max())
            worst = nodes[np.argmax(values.max(axis=0))]
            meaning = f"{name} that the modes leave out, over the largest; {missing:.3g} {unit}"
            share = missing / size if size else 0.0
            yield name, f"{meaning} at node {worst}", share, advice + _UNKNOWN
