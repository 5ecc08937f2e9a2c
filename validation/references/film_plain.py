"""Butenschön's tables of plain bores: the load of a journal that turns, of one that moves.

His film begins where the gap is widest, as behind a groove there. A journal that circles the bore's
middle at the rate ν feels the film of Ω − 2ν, for the bore is round: so the load by the turning
alone gives the damping across the line of centres, 2F/(Ω e), and its slope the stiffness along it.
Those are four of the eight coefficients; the groove, which follows the journal in his tables, gives
the two stiffnesses across.
"""

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from exudyn_rotor import OilFilm, grooved_pads
from validation.references.film_tables import BUTENSCHOEN, CLEARANCE, RADIUS, SPEED, VISCOSITY, rows

RELATIVE = CLEARANCE / RADIUS
NAMES = ("load", "flow", "stiffness", "damping", "squeeze", "away")


def bores(**grid) -> list[tuple[OilFilm, np.ndarray]]:
    """Return films and rows, the widest gap opposite to n1."""
    pads = grooved_pads(CLEARANCE, [np.pi], np.radians(0.05))
    grid = {"nodes": 360, "axial_nodes": 12, **grid}
    return [
        (OilFilm(RADIUS, 2.0 * RADIUS * ratio, VISCOSITY, pads, **grid), rows(table))
        for ratio, table in BUTENSCHOEN.items()
    ]


def slopes(table: np.ndarray) -> np.ndarray:
    """Return ∂F/∂ε of the rows, along and across the line of centres, (2, n).

    By splines over ln(1 − ε) of ln F less the powers of ε and 1 − ε by which it begins and grows.
    """
    ratio, load, attitude = table[:, :3].T
    way = -np.log(1.0 - ratio)
    parts = load * np.array([np.cos(np.radians(attitude)), np.sin(np.radians(attitude))])
    found = []
    for part, first, last in zip(parts, (2.0, 1.0), (2.0, 1.5), strict=True):
        smooth = CubicSpline(way, np.log(part * (1.0 - ratio) ** last / ratio**first))
        found.append(part * ((smooth(way, 1) + last) / (1.0 - ratio) + first / ratio))
    return np.array(found)


def compared(bearing: OilFilm, row: np.ndarray, slope: np.ndarray) -> tuple[dict, float]:
    """Return deviations of `NAMES`, those of coefficients over the largest, and the attitude."""
    ratio, load, attitude, flow, squeeze, away = row
    attitude = np.radians(attitude)
    place = [ratio * CLEARANCE, 0.0]
    unit = VISCOSITY * SPEED * bearing.length * 2.0 * RADIUS / RELATIVE**2
    state = bearing.state(place, [0.0, 0.0], SPEED)
    stiffness, damping = (m / unit * CLEARANCE for m in state.coefficients())
    damping = SPEED * damping
    across = 2.0 * load / ratio * np.array([-np.cos(attitude), np.sin(attitude)])
    closed = replace(bearing, pads=grooved_pads(CLEARANCE))
    found = [
        np.linalg.norm(closed.state(place, [sign * CLEARANCE * SPEED, 0.0], 0.0).force) / unit
        for sign in (1.0, -1.0)
    ]
    side = state.side_flow / (CLEARANCE * RADIUS * SPEED * RADIUS)
    along = np.array([slope[0], -slope[1]])
    deviations = (
        np.linalg.norm(state.force) / unit / load - 1.0,
        side / flow - 1.0,
        np.abs(stiffness[:, 0] - along).max() / np.abs(stiffness).max(),
        np.abs(damping[:, 1] - across).max() / np.abs(damping).max(),
        found[0] / squeeze - 1.0,
        found[1] / away - 1.0,
    )
    return dict(zip(NAMES, deviations, strict=True)), state.attitude


def butenschoen() -> list[str]:
    """Return rows beside ours: his values, deviations in percent."""
    lines = ["Butenschön  L/D     ε    attitude: his   here" + "".join(f"{n:>11}" for n in NAMES)]
    for bearing, table in bores():
        for row, slope in zip(table, slopes(table).T, strict=True):
            ours, attitude = compared(bearing, row, slope)
            lines.append(
                f"{bearing.length / (2 * RADIUS):15.2f} {row[0]:5.2f} {row[2]:15.3f} "
                f"{np.degrees(attitude):6.3f}" + "".join(f"{ours[n]:11.2%}" for n in NAMES)
            )
    return lines
