"""The dual spool of ROSS's reference as a train of solids."""

import itertools
import json
from functools import cache
from pathlib import Path

from netgen import occ

from exudyn_rotor import Link, ReducedRotor, RotorTrain, SolidRotor, Support, craig_bampton_modes
from validation.references.benchmark_rotors import meshed

ROSS = json.loads(
    (Path(__file__).parents[1] / "validation/references/rotor_trains_ross.json").read_text()
)


@cache
def solid(name: str) -> SolidRotor:
    """Return a spool of the reference as a solid, its discs rigid."""
    data, cut = ROSS["spools"][name], ROSS["between"]["position"]
    start, end = data["start"], data["start"] + data["length"]
    ends = [start, cut, end] if cut < end - 1e-9 else [start, end]
    parts = []
    for low, high in itertools.pairwise(ends):
        tube = [
            occ.Cylinder(occ.Pnt(0, 0, low), occ.Z, 0.5 * data[d], high - low)
            for d in ("diameter", "bore")
            if data[d] > 0.0
        ]
        parts.append(tube[0] - tube[1] if len(tube) == 2 else tube[0])
    parts[0].faces.Max(occ.Z).name = "middle"
    parts[0].faces.Min(occ.Z).name, parts[-1].faces.Max(occ.Z).name = "front", "rear"
    size = 0.06 if len(parts) == 2 else 0.03
    rotor = meshed(occ.Glue(parts), size, ROSS["material"], 1.0)
    for disc in data["discs"]:
        inertia = disc["polar"], disc["transverse"]
        rotor = rotor.add_disc(disc["position"], disc["mass"], inertia, disc["width"])
    return rotor


@cache
def spool(name: str, modes: int = 8, free: bool = False) -> ReducedRotor:
    """Return it with modes of Craig and Bampton, or with `free` ones."""
    rotor = solid(name)
    if free:
        return rotor.reduce(modes, prestress=True)
    return rotor.reduce(craig_bampton_modes(rotor, modes, coupling="RBE3"), prestress=True)


def dual_spool(ratio: float, modes: int = 8, free: bool = False) -> RotorTrain:
    """Return the dual spool of the reference."""
    (_, _, front), (_, _, rear), (_, _, outer) = ROSS["springs"]
    between = Support("middle", ROSS["between"]["stiffness"], ROSS["between"]["damping"])
    return RotorTrain(
        {name: spool(name, modes, free) for name in ("inner", "outer")},
        {"inner": 1.0, "outer": ratio},
        {"inner": [Support("front", front), Support("rear", rear)],
         "outer": [Support("front", outer)]},
        [Link("inner:middle", "outer:rear", between)],
    )  # fmt: skip
