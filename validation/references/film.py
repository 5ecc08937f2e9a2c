"""Oil films of finite length against closed forms, tables of coefficients, ROSS and finer grids.

Two axial grooves beside the load. The tables are those of J. W. Lund and K. K. Thomsen (in *Topics
in Fluid Film Bearing and Rotor Bearing System Design*, ASME 1978, table 1a: grooves of 20°), as the
course 41524 of DTU holds it (I. F. Santos, 2023), and of T. Someya (*Journal-Bearing Databook*,
1989, p. 14 and 17: grooves of 10°). ROSS 2.3.0 cuts negative pressures (``film_ross.json``, by
``film_ross.py`` beside it). Its perturbation divides differences of dimensionless forces by the
size of that force, for the force across the load (in its code k_yx and k_yy) by |(F_y, F_y)|
instead of |(F_x, F_y)|: those two are 1/√2 of what they should be, and compared times √2.

    python -m validation film
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from exudyn_rotor import OilFilm, grooved_pads

RADIUS, CLEARANCE, VISCOSITY, SPEED, LOAD = 0.05, 1e-4, 0.02, 300.0, 1e3
SIDES = [np.pi / 2, 3 * np.pi / 2]

# S, ε, attitude [°], stiffness over W/c (11, 12, 21, 22; 1 along the load), damping over W/(c Ω)
LUND = """
6.430 0.071 81.89  1.55 14.41 -6.60 1.88 28.75 1.89 1.89 13.31
3.937 0.114 77.32  1.57  9.27 -4.20 1.89 18.44 1.93 1.93  8.58
2.634 0.165 72.36  1.61  6.74 -3.01 1.91 13.36 2.00 2.00  6.28
2.030 0.207 68.75  1.65  5.67 -2.50 1.93 11.18 2.07 2.07  5.33
1.656 0.244 65.85  1.69  5.06 -2.20 1.95  9.93 2.15 2.15  4.80
0.917 0.372 57.45  2.12  4.01 -1.30 1.85  7.70 2.06 2.06  3.23
0.580 0.477 51.01  2.67  3.70 -0.78 1.75  6.96 1.94 1.94  2.40
0.378 0.570 45.43  3.33  3.64 -0.43 1.68  6.76 1.87 1.87  1.89
0.244 0.655 40.25  4.21  3.74 -0.13 1.64  6.87 1.82 1.82  1.54
0.151 0.734 35.20  5.48  3.98  0.15 1.61  7.26 1.79 1.79  1.27
0.086 0.809 30.04  7.51  4.42  0.47 1.59  8.03 1.79 1.79  1.03
0.042 0.879 24.41 11.45  5.23  0.92 1.60  9.48 1.80 1.80  0.82
"""
# S, ε, attitude [°], side flow over c R Ω L, torque over c W, stiffness, damping; L/D = 0.5
SOMEYA = """
4.43   0.10 80.4 0.0880 83.0   1.75 10.3 -9.66  2.70 20.6 2.08 2.08 11.4
2.07   0.20 71.6 0.170  39.5   1.88 5.63 -4.41  2.56 11.2 2.22 2.22 6.43
1.24   0.30 64.1 0.243  24.4   2.07 4.27 -2.56  2.34 8.50 2.32 2.32 4.73
0.517  0.50 51.1 0.366  11.3   2.89 3.57 -0.924 2.03 6.81 2.10 2.10 2.60
0.187  0.70 38.2 0.459  5.13   4.92 3.88 0.0235 1.83 7.32 2.16 2.16 1.70
0.0926 0.80 31.2 0.496  3.13   7.35 4.46 0.527  1.78 8.17 2.05 2.05 1.24
0.0315 0.90 22.7 0.524  1.56   13.8 5.76 1.24   1.72 10.6 2.03 2.03 0.846
"""


def film(length: float = RADIUS, width: float = 20.0, **options) -> OilFilm:
    """Return a film with two grooves beside the load."""
    pads = grooved_pads(CLEARANCE, SIDES, np.radians(width))
    return OilFilm(RADIUS, length, VISCOSITY, pads, **{"nodes": 240, **options})


def rows(text: str) -> np.ndarray:
    """Return the numbers of a table."""
    return np.array([line.split() for line in text.strip().splitlines()], dtype=float)


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


def lund() -> list[str]:
    """Return deviations from Lund's table, matrices in parts of their largest entry."""
    bearing = film(axial_nodes=12)
    lines = ["Lund, L/D = 0.5       S     ε: table   here   attitude: table  here    K       C"]
    for s, ratio, attitude, *rest in rows(LUND):
        state = carried(bearing, s)
        found = coefficients(state)
        worst = [
            np.max(np.abs(a - b)) / np.max(b)
            for a, b in zip(found, (rest[:4], rest[4:]), strict=True)
        ]
        lines.append(
            f"{s:23.3f} {ratio:11.3f} {state.eccentricity_ratio:6.3f} {attitude:16.2f} "
            f"{np.degrees(state.attitude):6.2f} {worst[0]:7.1%} {worst[1]:7.1%}"
        )
    return lines


def turning(state, stiffness: np.ndarray) -> np.ndarray:
    """Return the stiffness over W/c of a bore that turns with the journal's line of centres.

    A step along that line is that of the bore at rest; one across turns film and force by its
    angle about the bore's centre: K e_t = 1/ε across the load.
    """
    radial, across = polar_axes(state.attitude).T
    step = np.array([0.0, 1.0 / state.eccentricity_ratio])
    along = stiffness.reshape(2, 2) @ radial
    return (np.outer(along, radial) + np.outer(step, across)).ravel()


def polar_axes(attitude: float) -> np.ndarray:
    """Return the directions along and across the line of centres, columns."""
    c, s = np.cos(attitude), np.sin(attitude)
    return np.array([[c, -s], [s, c]])


def reaching(state, angle: float):
    """Return a state whose change of pressure reaches beyond the film's end by an angle [rad].

    Only :meth:`FilmState.coefficients` differ: there the change is zero where the film is broken.
    """
    grid, empty = state.film.grid, state.solution.empty
    for _ in range(round(angle / grid.step.max())):
        empty = empty & np.where(grid.at_left[:, None], empty[grid.left], False)
    return replace(state, solution=replace(state.solution, empty=empty))


def someya() -> list[str]:
    """Return Someya's rows beside ours, matrices in parts of their largest entry.

    His stiffness is that of a bore that turns with the journal (`turning`): so compared, and in
    the form of ours, whose bore stands still. His damping along the line of centres is larger:
    that of films whose change of pressure reaches beyond their end, by 0.5° to 1.5°.
    """
    bearing = film(width=10.0, axial_nodes=12, nodes=720)
    lines = [
        "Someya, L/D = 0.5  S     ε: table here   attitude      flow          torque       "
        "K, turning  at rest  C   by 0.5°  1°  1.5° beyond"
    ]
    for s, ratio, attitude, flow, torque, *rest in rows(SOMEYA):
        state = carried(bearing, s)
        stiffness, damping = coefficients(state)
        unit = CLEARANCE * RADIUS * state.speed * bearing.length
        farther = [coefficients(reaching(state, np.radians(a)))[1] for a in (0.5, 1.0, 1.5)]
        compared = [(turning(state, stiffness), rest[:4]), (stiffness, rest[:4])]
        compared += [(each, rest[4:]) for each in (damping, *farther)]
        lines.append(
            f"{s:21.4f} {ratio:6.2f} {state.eccentricity_ratio:6.3f} {attitude:6.1f} "
            f"{np.degrees(state.attitude):5.1f} {flow:7.3f} {state.side_flow / unit:6.3f} "
            f"{torque:7.2f} {state.torque / (CLEARANCE * LOAD):6.2f}    "
            + " ".join(f"{np.max(np.abs(a - b)) / np.max(np.abs(b)):7.1%}" for a, b in compared)
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
    for table in (closed_forms, lund, someya, ross, grids):
        print("\n".join([*table(), ""]))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
