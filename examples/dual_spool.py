"""Two coaxial spools with a bearing between them: Campbell diagram and critical speeds of both.

The inner shaft of low pressure (LP) runs in two bearings of its own; the outer spool of high
pressure (HP) turns 1.6 times as fast, in one bearing on the ground and one on the inner shaft. All
is seen over the speed of the LP spool; its unbalance excites with Ω, that of the HP spool with
1.6 Ω. A counter-rotating HP spool shifts the critical speeds by its gyroscopic moments.
"""

import ngsolve
import numpy as np
from netgen import occ

from exudyn_rotor import (
    Link,
    ReducedRotor,
    RotorTrain,
    SolidRotor,
    Support,
    Unbalance,
    campbell,
    craig_bampton_modes,
    critical_speeds,
    plotting,
    stability,
    unbalance_response,
)

HERTZ = 2.0 * np.pi
RATIO = 1.6
STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}


def reduced(solid: occ.TopoDS_Shape) -> ReducedRotor:
    """Return a spool in Craig–Bampton modes with its centrifugal prestress."""
    mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.06, curvaturesafety=1.0))
    rotor = SolidRotor.from_ngsolve(mesh, STEEL, axis="z").center_interfaces()
    return rotor.reduce(craig_bampton_modes(rotor, 16, coupling="RBE3"), prestress=True)


def tube(start: float, end: float, radius: float, bore: float = 0.0) -> occ.TopoDS_Shape:
    """Return a cylinder about z, hollow with a bore."""
    solid = occ.Cylinder(occ.Pnt(0, 0, start), occ.Z, radius, end - start)
    return solid - occ.Cylinder(occ.Pnt(0, 0, start), occ.Z, bore, end - start) if bore else solid


# ------------------------------------------------------------------ the spools
front, rear = tube(0.0, 0.56, 0.02), tube(0.56, 0.8, 0.02)
front.faces.Min(occ.Z).name, front.faces.Max(occ.Z).name = "front", "under HP"
rear.faces.Max(occ.Z).name = "rear"
discs = tube(0.06, 0.10, 0.13, 0.02), tube(0.68, 0.72, 0.11, 0.02)
lp = reduced(occ.Glue([front, rear, *discs]))
drum = tube(0.24, 0.56, 0.04, 0.028)
drum.faces.Min(occ.Z).name, drum.faces.Max(occ.Z).name = "front", "rear"
hp = reduced(occ.Glue([drum, tube(0.30, 0.34, 0.12, 0.04), tube(0.46, 0.50, 0.12, 0.04)]))

supports = {
    "LP": [Support("front", 2e7, 400.0), Support("rear", 1e7, 400.0)],
    "HP": [Support("front", 1.5e7, 400.0)],
}
between = Link("LP:under HP", "HP:rear", Support("under HP", 2e7, 200.0))


def train(ratio: float) -> RotorTrain:
    """Return both spools, the outer one at a ratio to the speed of the inner one."""
    return RotorTrain({"LP": lp, "HP": hp}, {"LP": 1.0, "HP": ratio}, supports, [between])


# ------------------------------------------------------------------ Campbell diagram
speeds = HERTZ * np.linspace(0.0, 300.0, 21)
diagrams = {ratio: campbell(train(ratio), speeds) for ratio in (RATIO, -RATIO)}
made, axes = plotting.figure(1, 2, size=(15.0, 6.0))
for ax, (ratio, diagram) in zip(axes, diagrams.items(), strict=True):
    diagram.plot(ax, orders=[1.0, RATIO])
    ax.set_ylim(0.0, 500.0)
    ax.set_xlabel(f"speed of the LP spool [Hz]; HP spool at {ratio:g} times")
plotting.save(made, "dual_spool.png")

# ------------------------------------------------------------------ critical speeds
given = {"nodal_diameters": [1], "max_speed": speeds[-1]}
critical = {}
for name, order in (("LP", 1.0), ("HP", RATIO)):
    found = critical_speeds(train(RATIO), order=order, **given)
    critical[name] = found.speeds[np.array(found.whirl) == "forward"] / HERTZ
    shown = ", ".join(f"{speed:.1f}" for speed in critical[name])
    print(f"critical speeds by unbalance of the {name} spool, LP at: {shown} Hz")
assert stability(train(RATIO), speeds[[-1]]).stable[0]

# ------------------------------------------------------------------ unbalance of the HP spool
hp_speeds = HERTZ * RATIO * np.linspace(20.0, 60.0, 41)
seen = train(RATIO).relative_to("HP")
response = unbalance_response(seen, hp_speeds, Unbalance("HP:rear", 1e-4), own=False, refine=True)
peak = response.peak("LP:under HP")[0] / RATIO / HERTZ
print(f"unbalance of the HP spool moves the LP shaft most with LP at {peak:.1f} Hz")
assert abs(peak / critical["HP"][0] - 1.0) < 0.01
