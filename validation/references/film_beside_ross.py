"""Films of ROSS 2.3.0 beside ours: at its equilibria, and with the journal held on many grids.

ROSS cuts negative pressures (``film_ross.json``, by ``film_ross.py``). Its perturbation divides
differences of dimensionless forces by the size of that force, for the force across the load (in its
code k_yx and k_yy) by |(F_y, F_y)| instead of |(F_x, F_y)|: those two are 1/√2 of what they should
be, and compared times √2.
"""

import json
from pathlib import Path

import numpy as np

from exudyn_rotor import OilFilm, grooved_pads
from validation.references.film_tables import CLEARANCE, RADIUS, SPEED, VISCOSITY


def ross_cases(key: str = "equilibria") -> list[dict]:
    """Return ROSS's cases; its perturbation's k_yx and k_yy times √2 (see above)."""
    cases = json.loads(Path(__file__).with_name("film_ross.json").read_text())[key]
    for case in cases:
        if case.get("method") != "lund":
            case["stiffness"][2:] = (np.sqrt(2.0) * np.array(case["stiffness"][2:])).tolist()
    return cases


def ross_film(case: dict, **grid) -> OilFilm:
    """Return our film of a case of ROSS."""
    clearance = CLEARANCE / (1.0 - case["preload"])
    pads = grooved_pads(clearance, [0.0, np.pi], np.radians(20.0), case["preload"])
    return OilFilm(RADIUS, RADIUS, VISCOSITY, pads, "half-sommerfeld", nodes=240, **grid)


def ross_state(case: dict):
    """Return our equilibrium of a case of ROSS."""
    return ross_film(case).equilibrium(SPEED, [0.0, -case["load"]])


def held(case: dict) -> tuple[float, np.ndarray]:
    """Return what ROSS's force at a place has over ours, and its coefficients.

    Those, (2, 4), over the force and less ours, in parts of the largest stiffness and damping.
    """
    ratio, angle = case["place"]
    place = ratio * CLEARANCE * np.array([np.cos(angle), np.sin(angle)])
    state = ross_film(case, axial_nodes=24).state(place, [0.0, 0.0], SPEED)
    load = np.linalg.norm(state.force)
    ours = np.array([m.ravel() for m in state.coefficients()]) / load
    theirs = np.array([case["stiffness"], case["damping"]]) / 5000.0
    largest = np.abs(ours).max(axis=1, keepdims=True)
    return np.linalg.norm(case["force"]) / load - 1.0, (theirs - ours) / largest


def ross_grids() -> list[str]:
    """Return ROSS less ours with the journal held: single places and means over two elements."""
    lines = [
        "ROSS, held    elements    force    worst of K      C   worst of their means, K      C"
    ]
    for case in ross_cases("grids"):
        force, parts = held(case)
        worst = np.abs(parts).max(axis=1)
        lines.append(
            f"{case['geometry']:10} {case['elements'][0]:6} × {case['elements'][1]} "
            f"{force:10.2%} {worst[0]:10.1%} {worst[1]:8.1%}"
        )
    turned = {}
    for case in ross_cases("turned"):
        turned.setdefault((case["geometry"], *case["elements"]), []).append(held(case)[1])
    for (geometry, around, along), parts in turned.items():
        single, mean = (np.abs(x).max(axis=-1) for x in (parts, np.mean(parts, axis=0)))
        lines.append(
            f"{geometry:10} {around:6} × {along} {'':10} {single.max(axis=0)[0]:10.1%} "
            f"{single.max(axis=0)[1]:8.1%} {mean[0]:22.1%} {mean[1]:8.1%}"
        )
    return lines


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
