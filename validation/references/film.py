"""Oil films of finite length against closed forms, tables of coefficients, ROSS and finer grids.

The tables and their sources are in ``film_tables.py``. ROSS 2.3.0 cuts negative pressures
(``film_ross.json``, by ``film_ross.py`` beside it). Its perturbation divides differences of
dimensionless forces by the size of that force, for the force across the load (in its code k_yx and
k_yy) by |(F_y, F_y)| instead of |(F_x, F_y)|: those two are 1/√2 of what they should be, and
compared times √2.

    python -m validation film
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from exudyn_rotor import OilFilm, grooved_pads
from validation.references import film_tables
from validation.references.film_tables import rows

RADIUS, CLEARANCE, VISCOSITY, SPEED, LOAD = 0.05, 1e-4, 0.02, 300.0, 1e3
SIDES = [np.pi / 2, 3 * np.pi / 2]


def film(length: float = RADIUS, width: float = 20.0, preload: float = 0.0, **options) -> OilFilm:
    """Return a film with two grooves beside the load."""
    pads = grooved_pads(CLEARANCE, SIDES, np.radians(width), preload)
    return OilFilm(RADIUS, length, VISCOSITY, pads, **{"nodes": 240, **options})


def carried(bearing: OilFilm, sommerfeld: float):
    """Return the equilibrium at a Sommerfeld number, the load along n1."""
    area = 2.0 * RADIUS * bearing.length
    turns = sommerfeld * LOAD / (VISCOSITY * area) * (CLEARANCE / RADIUS) ** 2
    return bearing.equilibrium(2.0 * np.pi * turns, [LOAD, 0.0])


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
            full.force(*at)[1] / exact_long - 1.0,
            np.linalg.norm(cut.force(*at) - exact_short) / np.linalg.norm(exact_short),
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


def lund() -> list[str]:
    """Return deviations from Lund's tables, matrices in parts of their largest entry."""
    lines = ["Lund                  S     ε: table   here   attitude: table  here    K       C"]
    for title, bearing, table in lund_cases():
        for s, ratio, attitude, *rest in table:
            state = carried(bearing, s)
            worst = [
                np.max(np.abs(a - b)) / np.max(b)
                for a, b in zip(coefficients(state), (rest[:4], rest[4:]), strict=True)
            ]
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
    moved = state.film.force(
        state.position, velocity * CLEARANCE * state.speed * outward, state.speed
    )
    return -float((moved - state.force) @ outward) / (velocity * LOAD)


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

    C11/S of his is one number near the middle, where a film is linear.
    """
    lines = [
        "two lobes     S        ε: table  here   attitude      flow          K       C    his C11/S"
    ]
    for title, bearing, table in lobed_cases():
        for row in table:
            state = carried(bearing, row[0])
            worst = [
                np.abs(a - b).max() / np.abs(b).max()
                for a, b in zip(coefficients(state), (row[5:9], row[9:]), strict=True)
            ]
            unit = CLEARANCE * RADIUS * state.speed * bearing.length
            lines.append(
                f"{title:9} {row[0]:8.4f} {row[1]:8.4f} {state.eccentricity_ratio:7.4f} "
                f"{row[2]:6.1f} {np.degrees(state.attitude):5.1f} {row[3]:7.3f} "
                f"{state.side_flow / unit:6.3f} {worst[0]:8.1%} {worst[1]:7.1%} "
                f"{row[9] / row[0]:9.1f}"
            )
    return lines


def ross_cases() -> list[dict]:
    """Return ROSS's cases; its perturbation's k_yx and k_yy times √2 (see above)."""
    cases = json.loads(Path(__file__).with_name("film_ross.json").read_text())
    for case in cases:
        if case["method"] == "perturbation":
            case["stiffness"][2:] = (np.sqrt(2.0) * np.array(case["stiffness"][2:])).tolist()
    return cases


def ross_state(case: dict):
    """Return our equilibrium of a case of ROSS."""
    clearance = CLEARANCE / (1.0 - case["preload"])
    pads = grooved_pads(clearance, [0.0, np.pi], np.radians(20.0), case["preload"])
    bearing = OilFilm(RADIUS, RADIUS, VISCOSITY, pads, "half-sommerfeld", nodes=240)
    return bearing.equilibrium(SPEED, [0.0, -case["load"]])


def ross() -> list[str]:
    """Return ROSS's rows beside ours, and what its stiffness says of its own equilibria."""
    lines = ["ROSS            load   ε: ROSS  here   angle: ROSS  here   K (11, 12, 21, 22)   C"]
    places = {}
    for case in ross_cases():
        state = ross_state(case)
        ours = np.array([m.ravel() for m in state.coefficients()])
        theirs = np.array([case["stiffness"], case["damping"]])
        angle = np.arctan2(state.position[1], state.position[0])
        lines.append(
            f"{case['geometry']:8} {case['method'][:7]:7} {case['load']:5.0f} {case['ratio']:7.4f} "
            f"{state.eccentricity_ratio:7.4f} {np.degrees(case['angle']):8.2f} "
            f"{np.degrees(angle):7.2f}   "
            + " ".join(f"{d:6.1%}" for d in (theirs - ours)[0] / np.max(np.abs(ours[0])))
            + "  "
            + " ".join(f"{d:6.1%}" for d in (theirs - ours)[1] / np.max(np.abs(ours[1])))
        )
        if case["geometry"] == "circular":
            place = case["ratio"] * np.exp(1j * case["angle"]) * CLEARANCE
            places[case["load"], case["method"]] = np.array([place.real, place.imag]), ours, theirs
    few, mid, many = (places[load, "perturbation"] for load in (4500.0, 5000.0, 5500.0))
    moved = many[0] - few[0]
    for name, matrix in (
        ("ours", mid[1][0]),
        ("ROSS, perturbation", mid[2][0]),
        ("ROSS, lund", places[5000.0, "lund"][2][0]),
    ):
        force = matrix.reshape(2, 2) @ moved
        lines.append(f"{name:20} K · (step of ROSS's equilibrium by 1000 N) = {force.round()} N")
    return lines


def grids() -> list[str]:
    """Return changes with the grid and the error and cost of one axial profile."""
    lines = [
        "L/D   ε     deviation from 480 × 24 nodes: 120 × 12   240 × 12   one profile, 120   cost"
    ]
    for length in (0.5, 1.0):
        for ratio in (0.3, 0.6, 0.8, 0.9):
            place = ratio * CLEARANCE * np.array([0.8, 0.6])
            found, seconds = [], []
            for nodes, axial in ((480, 24), (120, 12), (240, 12), (120, 0)):
                bearing = film(2.0 * RADIUS * length, nodes=nodes, axial_nodes=axial)
                start = time.perf_counter()
                found.append(bearing.force(place, [0.0, 0.0], SPEED))
                seconds.append(time.perf_counter() - start)
            errors = [np.linalg.norm(f - found[0]) / np.linalg.norm(found[0]) for f in found[1:]]
            lines.append(
                f"{length:3} {ratio:5} {'':30}"
                + "".join(f"{e:12.2%}" for e in errors)
                + "   "
                + " ".join(f"{1e3 * t:.2f}" for t in seconds[1:])
                + " ms"
            )
    return lines


def main(arguments: list[str] | None = None) -> int:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.parse_args(arguments)
    for table in (closed_forms, lund, someya, lobed, ross, grids):
        print("\n".join([*table(), ""]))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
