"""Oil films of finite length against closed forms, tables of coefficients, and ROSS.

The tables and their sources are in ``film_tables.py``, Butenschön's beside ours in
``film_plain.py``, ROSS's models beside ours in ``film_beside_ross.py``.

    python -m validation film
"""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from exudyn_rotor import OilFilm, TiltingPadBearing, grooved_pads
from validation.references import film_tables
from validation.references.film_beside_ross import ross, ross_grids
from validation.references.film_plain import butenschoen
from validation.references.film_tables import CLEARANCE, RADIUS, SPEED, VISCOSITY, rows
from validation.rows import verdict

LOAD = 1e3
SIDES = [np.pi / 2, 3 * np.pi / 2]


def film(length: float = RADIUS, width: float = 20.0, preload: float = 0.0, **options) -> OilFilm:
    """Return a film with two grooves beside the load."""
    pads = grooved_pads(CLEARANCE, SIDES, np.radians(width), preload)
    return OilFilm(RADIUS, length, VISCOSITY, pads, **{"nodes": 240, **options})


def spin(bearing: OilFilm, sommerfeld: float) -> float:
    """Return the speed [rad/s] of a Sommerfeld number."""
    area = 2.0 * RADIUS * bearing.length
    return 2.0 * np.pi * sommerfeld * LOAD / (VISCOSITY * area) * (CLEARANCE / RADIUS) ** 2


def carried(bearing: OilFilm, sommerfeld: float):
    """Return the equilibrium at a Sommerfeld number, the load along n1."""
    return bearing.equilibrium(spin(bearing, sommerfeld), [LOAD, 0.0])


def coefficients(state) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness over W/c and damping over W/(c Ω)."""
    stiffness, damping = state.coefficients()
    unit = CLEARANCE / np.linalg.norm(state.force)
    return unit * stiffness.ravel(), unit * state.speed * damping.ravel()


def closed_forms() -> list[str]:
    """Return errors against Sommerfeld's long and Ocvirk's short film over the grid."""
    lines = ["relative error of the force    nodes   long, full   short, cut (ε = 0.5)"]
    plain, ratio = grooved_pads(CLEARANCE), 0.5
    for nodes in (60, 120, 240):
        long, short = 2e4 * RADIUS, 0.01 * RADIUS
        options = {"nodes": nodes, "axial_nodes": 0}
        full = OilFilm(RADIUS, long, VISCOSITY, plain, "none", **options)
        cut = OilFilm(RADIUS, short, VISCOSITY, plain, "half-sommerfeld", **options)
        at = ([ratio * CLEARANCE, 0.0], [0.0, 0.0], SPEED)
        left, unit = 1.0 - ratio**2, VISCOSITY * SPEED * RADIUS / CLEARANCE**2
        shape = ratio / ((2.0 + ratio**2) * np.sqrt(left))
        exact_long = unit * 12 * np.pi * long * RADIUS**2 * shape
        shape = np.array([-(ratio**2) / left**2, np.pi * ratio / (4.0 * left**1.5)])
        exact_short = unit * short**3 * shape
        errors = (
            full.state(*at).force[1] / exact_long - 1.0,
            np.linalg.norm(cut.state(*at).force - exact_short) / np.linalg.norm(exact_short),
        )
        lines.append(f"{'':30} {nodes:5} {errors[0]:12.1e} {errors[1]:12.1e}")
    return lines


def lund_cases() -> list[tuple[str, OilFilm, np.ndarray]]:
    """Return Lund's tables: what each is of, the film, the rows."""
    options = {"nodes": 240, "axial_nodes": 12}
    long = 2.0 * RADIUS
    return [
        ("L/D = 0.5", film(**options), rows(film_tables.LUND)),
        ("L/D = 1", film(long, **options), rows(film_tables.LUND_LONG)),
        ("elliptical", film(long, preload=0.5, **options), rows(film_tables.LUND_ELLIPTICAL)),
    ]


def lund_deviations(state, row: np.ndarray) -> list[float]:
    """Return the deviations of (K, C) from a row of Lund's, in parts of their largest entry."""
    tables = zip(coefficients(state), (row[:4], row[4:]), strict=True)
    return [float(np.max(np.abs(a - b)) / np.max(b)) for a, b in tables]


def lund() -> list[str]:
    """Return deviations from Lund's tables, matrices in parts of their largest entry."""
    lines = ["Lund                  S     ε: table   here   attitude: table  here    K       C"]
    for title, bearing, table in lund_cases():
        for s, ratio, attitude, *rest in table:
            state = carried(bearing, s)
            worst = lund_deviations(state, rest)
            lines.append(
                f"{title:12} {s:10.3f} {ratio:11.3f} "
                f"{np.linalg.norm(state.position) / CLEARANCE:6.3f} {attitude:16.2f} "
                f"{np.degrees(state.attitude):6.2f} {worst[0]:7.1%} {worst[1]:7.1%}"
            )
    return lines


def turning(state, stiffness: np.ndarray) -> np.ndarray:
    """Return the stiffness over W/c of a bore that turns with the journal's line of centres.

    A step along that line is that of the bore at rest; one across turns film and force by its
    angle about the bore's centre: K e_t = 1/ε across the load. With that tan φ = K12/K11.
    """
    radial, across = polar_axes(state.attitude).T
    step = np.array([0.0, 1.0 / state.eccentricity_ratio])
    along = stiffness.reshape(2, 2) @ radial
    return (np.outer(along, radial) + np.outer(step, across)).ravel()


def polar_axes(attitude: float) -> np.ndarray:
    """Return the directions along and across the line of centres, columns."""
    c, s = np.cos(attitude), np.sin(attitude)
    return np.array([[c, -s], [s, c]])


def polar(matrix: np.ndarray, attitude: float) -> np.ndarray:
    """Return a matrix (2, 2) along and across the line of centres."""
    axes = polar_axes(attitude)
    return axes.T @ np.reshape(matrix, (2, 2)) @ axes


def someya_cases() -> list[tuple[str, OilFilm, np.ndarray]]:
    """Return Someya's tables: what each is of, the film, the rows."""
    options = {"width": 10.0, "nodes": 360, "axial_nodes": 8}
    return [
        ("L/D = 0.5", film(**options), rows(film_tables.SOMEYA)),
        ("L/D = 1", film(2.0 * RADIUS, **options), rows(film_tables.SOMEYA_LONG)),
    ]


def compared(state, row: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return ours and Someya's (K, C), each (2, 2, 2) along and across the line of centres.

    Over the row's largest entries. Ours is that of a bore which turns with the journal.
    """
    stiffness, damping = coefficients(state)
    ours = [polar(m, state.attitude) for m in (turning(state, stiffness), damping)]
    his = [polar(m, np.radians(row[2])) for m in (row[5:9], row[9:])]
    largest = np.array([np.abs(m).max() for m in (row[5:9], row[9:])])[:, None, None]
    return np.array(ours) / largest, np.array(his) / largest


def own_stiffness(table: np.ndarray) -> np.ndarray:
    """Return the radial stiffness ∂F_r/∂e over W/c that S, ε and attitude of the rows imply.

    By splines of ln F_r over ln(1 − ε). From row to row the grooves turn against the line of
    centres, which does not matter where the film ends before the groove: from ε = 0.5 on.
    """
    s, ratio, attitude = table[:, :3].T
    force = np.cos(np.radians(attitude)) / s
    way = -np.log(1.0 - ratio)
    return CubicSpline(way, np.log(force))(way, 1) / (1.0 - ratio) * np.cos(np.radians(attitude))


def approached(state, velocity: float) -> float:
    """Return the radial damping over W/(c Ω) by one difference, `velocity` c Ω to the bore."""
    outward = state.position / np.linalg.norm(state.position)
    rate = velocity * CLEARANCE * state.speed * outward
    moved = state.film.state(state.position, rate, state.speed)
    return -float((moved.force - state.force) @ outward) / (velocity * LOAD)


def someya() -> list[str]:
    """Return Someya's rows beside ours, coefficients along (r) and across the line of centres.

    `across` is the largest deviation of six of the eight coefficients, in parts of the largest
    entry. The other two are those of the radial force by the radial place and velocity: K_rr as
    printed, by the slope of his own rows and ours; C_rr over ours, and that of a difference with
    an approach at 0.02 c Ω.
    """
    lines = [
        "Someya        S      ε: table here   attitude      flow          torque       across   "
        "K_rr: table, his rows, ours   C_rr over ours  by a step"
    ]
    for title, bearing, table in someya_cases():
        for row, own in zip(table, own_stiffness(table), strict=True):
            state = carried(bearing, row[0])
            ours, his = compared(state, row)
            across = np.abs(ours - his)
            across[:, 0, 0] = 0.0
            largest = np.abs(row[5:9]).max(), np.abs(row[9:]).max()
            unit = CLEARANCE * RADIUS * state.speed * bearing.length
            damping = his[1, 0, 0] * largest[1]
            lines.append(
                f"{title:9} {row[0]:8.4f} {row[1]:6.3f} {state.eccentricity_ratio:6.3f} "
                f"{row[2]:6.1f} {np.degrees(state.attitude):5.1f} {row[3]:7.3f} "
                f"{state.side_flow / unit:6.3f} {row[4]:7.2f} "
                f"{state.torque / (CLEARANCE * LOAD):6.2f} {across.max():8.1%} "
                f"{his[0, 0, 0] * largest[0]:9.3f} {own:7.3f} {ours[0, 0, 0] * largest[0]:7.3f} "
                f"{damping / (ours[1, 0, 0] * largest[1]):12.3f} "
                f"{damping / approached(state, 0.02):8.3f}"
            )
    return lines


def lobed_cases() -> list[tuple[str, OilFilm, np.ndarray]]:
    """Return Someya's tables of two lobes: what each is of, the film, the rows."""
    options = {"width": 10.0, "nodes": 240, "axial_nodes": 12}
    short, long = film_tables.SOMEYA_ELLIPTICAL_SHORT, film_tables.SOMEYA_ELLIPTICAL
    return [
        ("L/D = 0.5", film(preload=0.5, **options), rows(short)),
        ("L/D = 1", film(2.0 * RADIUS, preload=2.0 / 3.0, **options), rows(long)),
    ]


def lobed() -> list[str]:
    """Return Someya's rows of two lobes beside ours, coefficients in parts of the largest entry.

    C11/S of his is one number near the middle, where a film is linear. Last what our lobes carry of
    the load W, along it, with the journal where his stands.
    """
    lines = [
        "two lobes     S        ε: table  here   attitude      flow          K       C    his C11/S"
        "   at his place: lower, upper lobe"
    ]
    for title, bearing, table in lobed_cases():
        for row in table:
            state = carried(bearing, row[0])
            worst = [
                np.abs(a - b).max() / np.abs(b).max()
                for a, b in zip(coefficients(state), (row[5:9], row[9:]), strict=True)
            ]
            unit = CLEARANCE * RADIUS * state.speed * bearing.length
            place = row[1] * bearing.clearance * polar_axes(np.radians(row[2]))[:, 0]
            lobes = [
                -replace(bearing, pads=[pad]).state(place, [0.0, 0.0], state.speed).force[0] / LOAD
                for pad in bearing.pads[::-1]
            ]
            lines.append(
                f"{title:9} {row[0]:8.4f} {row[1]:8.4f} {state.eccentricity_ratio:7.4f} "
                f"{row[2]:6.1f} {np.degrees(state.attitude):5.1f} {row[3]:7.3f} "
                f"{state.side_flow / unit:6.3f} {worst[0]:8.1%} {worst[1]:7.1%} "
                f"{row[9] / row[0]:9.1f} {lobes[0]:18.3f} {lobes[1]:8.3f}"
            )
    return lines


def tilting_cases() -> list[tuple[str, TiltingPadBearing, np.ndarray]]:
    """Return Someya's tilting pads of 80°: what each is of, the loaded pads, the rows.

    That on one pad is called L/D = 0.5 where it was found; the load that the pad carries is that of
    L/D = 1, and 1.4 times that of L/D = 0.5.
    """
    cases = []
    for title, length, first in (("between", 0.5, 0.0), ("on", 1.0, 45.0)):
        gaps = np.radians(first + 90.0 * np.arange(4))
        pads = grooved_pads(CLEARANCE, gaps, np.radians(10.0))
        loaded = [pad for pad in pads if np.cos(pad.start + 0.5 * pad.arc) > 0.1]
        oil = OilFilm(RADIUS, 2.0 * RADIUS * length, VISCOSITY, loaded, nodes=240, axial_nodes=12)
        bearing = TiltingPadBearing(interface="pads", film=oil, load=[LOAD, 0.0])
        cases.append((title, bearing, rows(film_tables.SOMEYA_TILTING[title])))
    return cases


def pads_torque(bearing: TiltingPadBearing, speed: float) -> float:
    """Return the torque over c W of the pads and, beside a single one, of two about the middle."""
    states = [state for state in bearing._state(speed, bearing.load).states if state is not None]
    oil = bearing.film
    beside = VISCOSITY * speed * RADIUS**3 * oil.length * oil.pads[0].arc / CLEARANCE
    idle = 2.0 * beside if len(oil.pads) == 1 else 0.0
    return (sum(state.torque for state in states) + idle) / (CLEARANCE * LOAD)


def tilting() -> list[str]:
    """Return Someya's tilting pads beside ours, whirl at the speed, deviations along the load."""
    lines = ["tilting pads, load      S      ε: table   here    torque   stiffness   damping"]
    for title, bearing, table in tilting_cases():
        for s, ratio, *his in table:
            speed = spin(bearing.film, s)
            place = np.linalg.norm(bearing.equilibrium(speed)) / CLEARANCE
            stiffness, damping = bearing.coefficients(speed)
            unit = CLEARANCE / LOAD
            torque = pads_torque(bearing, speed)
            ours = torque, unit * stiffness[0, 0], unit * speed * damping[0, 0]
            lines.append(
                f"{title:16} {s:10.4f} {ratio:8.2f} {place:9.4f}"
                + "".join(f"{a / b - 1.0:10.1%}" for a, b in zip(ours, his, strict=True))
            )
    return lines


def main(arguments: list[str] | None = None) -> int:
    """Print all tables and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.parse_args(arguments)
    for table in (closed_forms, lund, butenschoen, someya, lobed, tilting, ross, ross_grids):
        print("\n".join([*table(), ""]))
    states = [
        (carried(bearing, row[0]), row[3:]) for _, bearing, table in lund_cases() for row in table
    ]
    worst = np.max([lund_deviations(*one) for one in states], axis=0)
    return verdict({"Lund's stiffness": (worst[0], 2e-2), "Lund's damping": (worst[1], 2e-2)})
