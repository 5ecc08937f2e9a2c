"""Slender solid shafts against Timoshenko beams: frequencies over speed and critical speeds.

The beam numbers come from the open package ROSS (``timoshenko_ross.json``, written by
``timoshenko_ross.py`` beside it). The solid rotors are meshed with second-order tetrahedra and
reduced by Craig–Bampton modes with averaged interfaces, so that supports act on the mean of an end
face. A beam's gyroscopic matrix is that of discs which tilt with the bending shaft: level 'full' of
centrifugal stiffening holds that, level 'tilt' for rigid tilts of the whole rotor only.

    python -m validation timoshenko [--quick]
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Collection
from pathlib import Path

import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import (
    LinearModel,
    ReducedRotor,
    SolidRotor,
    Support,
    campbell,
    craig_bampton_modes,
    critical_speeds,
    linear_model,
)
from validation.rows import verdict

REFERENCE = Path(__file__).with_name("timoshenko_ross.json")
LATERAL = ("forward", "backward", "mixed")


def solid_shaft(
    shaft: dict, material: dict, element_size: float, safety: float = 2.0
) -> ReducedRotor:
    """Return the solid rotor of a beam description, along z, reduced."""
    radius, length = 0.5 * shaft["diameter"], shaft["length"]
    solid = occ.Cylinder(occ.Pnt(0, 0, 0), occ.Z, radius, length)
    for z in shaft["discs"]:
        disc = shaft["disc"]
        corner = occ.Pnt(0, 0, z - 0.5 * disc["width"])
        solid += occ.Cylinder(corner, occ.Z, 0.5 * disc["diameter"], disc["width"])
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
    geometry = occ.OCCGeometry(solid)
    mesh = ngsolve.Mesh(geometry.GenerateMesh(maxh=element_size, curvaturesafety=safety))
    rotor = SolidRotor.from_ngsolve(mesh, material, axis="z").center_interfaces()
    return rotor.reduce(craig_bampton_modes(rotor, 12, coupling="RBE3"), prestress=True)


def supports(shaft: dict) -> list[Support]:
    """Return the two bearings."""
    return [Support(name, shaft["bearing_stiffness"]) for name in ("left", "right")]


def lateral_frequencies(system: LinearModel, speeds: list[float]) -> np.ndarray:
    """Return the six lowest lateral frequencies in the inertial frame, shape (speeds, 6)."""
    result = campbell(system, speeds, accuracy=None)
    rows = []
    for row, words in zip(result.frequencies_inertial, result.whirl, strict=True):
        rows.append(np.sort(row[np.isin(words, LATERAL)])[:6])
    return np.array(rows)


def forward_criticals(system: LinearModel, count: int) -> np.ndarray:
    """Return the lowest forward critical speeds."""
    found = critical_speeds(system, max_speed=4000.0, accuracy=None)
    forward = found.speeds[np.array(found.whirl) == "forward"]
    return forward[np.append(True, np.diff(forward) > 1e-2 * forward[1:])][:count]


def compare(system: LinearModel, beam: dict, speeds: list[float]) -> dict:
    """Return relative deviations of a solid rotor from beam numbers."""
    ours = lateral_frequencies(system, speeds)
    theirs = np.sort(np.array(beam["frequencies"]), axis=1)
    criticals = beam["forward_critical_speeds"]
    # with discs the third forward mode rises with the spin far beyond the range of speeds
    criticals = [speed for speed in criticals if speed < 2400.0]
    found = forward_criticals(system, len(criticals))
    return {
        "frequencies": (ours / theirs - 1.0).tolist(),
        "critical_speeds": (found / criticals - 1.0).tolist(),
    }


def compare_all(
    element_size: float, safety: float = 2.0, wanted: Collection[str] = ()
) -> tuple[dict, dict]:
    """Return the beam data and the deviations of the solid rotors, all or those `wanted`.

    `safety` is the radius of shaft and discs over the length of the elements there.
    """
    data = json.loads(REFERENCE.read_text())
    uniform, discs = data["uniform"], data["two discs, points"]
    hubs, speeds = data["two discs, rigid hubs"], data["speeds"]
    plain = solid_shaft(uniform["shaft"], data["material"], element_size, safety)
    with_discs = solid_shaft(discs["shaft"], data["material"], element_size, safety)
    results = {}
    for level in ("tilt", "full"):
        for name, rotor, beam in (
            ("uniform", plain, uniform),
            ("two discs against points", with_discs, discs),
            ("two discs against rigid hubs", with_discs, hubs),
        ):
            title = f"{name}, '{level}'"
            if title in wanted or not wanted:
                system = linear_model(rotor, supports=supports(beam["shaft"]), stiffening=level)
                results[title] = compare(system, beam, speeds)
    return data, results


def table(title: str, speeds: list[float], result: dict) -> str:
    """Return deviations in per cent as text."""
    lines = [f"{title}: deviation from the beam [%]", "  rad/s   mode 1 … 6"]
    for speed, row in zip(speeds, result["frequencies"], strict=True):
        lines.append(f"{speed:7.0f}   " + " ".join(f"{100 * value:8.3f}" for value in row))
    values = " ".join(f"{100 * value:8.3f}" for value in result["critical_speeds"])
    return "\n".join([*lines, f"forward critical speeds  {values}", ""])


def main() -> int:
    """Compare all shafts, print the tables and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarse meshes")
    options = parser.parse_args()
    data, results = compare_all(0.04 if options.quick else 0.025)
    print(f"beam numbers: {data['source']}\n")
    for name, result in results.items():
        print(table(name, data["speeds"], result))
    uniform = results["uniform, 'full'"]
    return verdict(
        {
            "frequencies of the uniform shaft": (np.abs(uniform["frequencies"]).max(), 1e-3),
            "its critical speeds": (np.abs(uniform["critical_speeds"]).max(), 1e-3),
        }
    )
