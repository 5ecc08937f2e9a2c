"""Small meshes under Exudyn's default settings: speed of the swapped call over Exudyn's own.

A rotor in Exudyn's own manner (a disc on a shaft, free spin, two bearings at the script's own
markers), with several meshes and numbers of modes, and peer scenes of other kinds. Both calls run
in turns in one process; the ratio is taken pair by pair. The settings are Exudyn's defaults, and
with full Newton in place of the modified one.

    python -m validation small_models [--quick] [--repeats 5] [--json FILE]
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

import exudyn
import numpy as np

from validation.peer import parts, table
from validation.peer.bearings import SPEED, on_springs
from validation.peer.scene import ORIGINAL, SWAPPED, Scene, Script, run

MESHES = ((0.1, 6), (0.1, 8), (0.025, 8), (0.1, 20), (0.025, 20))  # element size [m], modes
QUICK_MESHES = MESHES[:1]
OTHERS = ("two rotors, torsional coupling", "piston engine, crank and rod swapped", "pendulum")
STIFF = 2e8  # N/m, as in Exudyn's TestModels/perfObjectFFRFreducedOrder
END, STEP = 0.02, 1e-4  # s
QUICK = 0.05  # share of the steps


def rotor_scene(element_size: float, modes: int, kind: str, stiffness: float) -> Scene:
    """Return the rotor on springs at its own markers of a kind, 'rigid' or 'position'."""

    def build(script: Script) -> None:
        body = script.flexible(
            parts.rotor("z", modes, element_size),
            axis="z",
            initialAngularVelocity=[0.0, 0.0, SPEED],
        )
        make = body.rigid_marker if kind == "rigid" else body.position_marker
        on_springs(script, body, {end: make(end) for end in parts.ENDS}, stiffness)

    return Scene(f"rotor, {kind} markers, {stiffness:.0e} N/m", build, END, STEP)


def scenes(quick: bool) -> list[Scene]:
    """Return the rotors of all meshes, and other peer scenes."""
    rotors = [
        rotor_scene(size, modes, kind, stiffness)
        for size, modes in (QUICK_MESHES if quick else MESHES)
        for kind, stiffness in (("position", STIFF), ("rigid", 1e6))
    ]
    others = [scene for scene in table.SCENES if scene.name in OTHERS]
    return [*rotors, *(replace(scene, end=200 * scene.step) for scene in others)]


def full_newton(settings: exudyn.SimulationSettings) -> None:
    """Renew the Jacobian in every iteration."""
    settings.timeIntegration.newton.useModifiedNewton = False


SETTINGS = {"default": None, "full Newton": full_newton}


def compare(scene: Scene, repeats: int, share: float) -> list[dict]:
    """Return a row of the scene for each kind of settings."""
    rows = []
    for name, change in SETTINGS.items():
        pairs = [
            [run(scene, call, share, change=change) for call in (ORIGINAL, SWAPPED)]
            for _ in range(repeats)
        ]
        times = np.array([[one.seconds for one in pair] for pair in pairs])
        ratios = times[:, 0] / times[:, 1]
        steps = round(share * scene.end / scene.step)
        rows.append(
            {
                "scene": scene.name,
                "settings": name,
                "nodes": pairs[0][0].nodes,
                "modes": pairs[0][0].modes,
                "microseconds": (1e6 * times.min(axis=0) / steps).tolist(),
                "median": float(np.median(ratios)),
                "least": float(ratios.min()),
            }
        )
    return rows


def text(row: dict) -> str:
    """Return a row of the table."""
    own, swapped = row["microseconds"]
    return (
        f"{row['scene']:38}{row['settings']:13}{row['nodes']:6}{row['modes']:6}"
        f"{own:9.0f}{swapped:9.0f}{row['median']:8.2f}{row['least']:8.2f}"
    )


def main(argv: list[str] | None = None) -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one mesh, few steps")
    parser.add_argument("--repeats", type=int, default=5, help="pairs of runs")
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    options = parser.parse_args(argv)
    print(
        f"{'scene':38}{'settings':13}{'nodes':>6}{'modes':>6}{'µs/step':>9}{'swapped':>9}"
        f"{'median':>8}{'least':>8}"
    )
    rows = []
    for scene in scenes(options.quick):
        found = compare(scene, options.repeats, QUICK if options.quick else 1.0)
        rows += found
        print("\n".join(text(row) for row in found), flush=True)
    for name in SETTINGS:
        ratios = [row["median"] for row in rows if row["settings"] == name]
        print(f"{name}: median of all scenes {np.median(ratios):.2f}, least {min(ratios):.2f}")
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n")
