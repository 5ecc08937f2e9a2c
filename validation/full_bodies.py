"""Full bodies in scenes: cost of a step over the size, convergence with the mesh.

``python -m validation full_bodies`` prints two tables; ``--sizes`` takes the mesh sizes [m] of
the first, ``--steps`` its number of steps, and ``--thousand`` adds 1,000 steps of one run with a
larger disc and 51,000 coordinates. Times are of the processor, one thread.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence

import exudyn
import netgen.occ as occ
import ngsolve
import numpy as np
import scipy.sparse as sp
from ngsolve.meshes import MakeStructured3DMesh
from scipy.sparse.linalg import splu

from exudyn_rotor import (
    FullRotorBody,
    PrescribedMotion,
    SolidRotor,
    add_rotor,
    recommended_settings,
)

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
SPEED, STEP = 300.0, 1e-4
THOUSAND = (0.012, 0.17, 999)  # mesh size, radius of the disc, steps after the first
Row = dict[str, float]


def disc_on_shaft(maxh: float, radius: float = 0.12) -> SolidRotor:
    """Return a disc on a shaft between two bearings, with an unbalance of 5 g at 0.12 m."""
    solid = occ.Cylinder((0, 0, -0.3), occ.Z, 0.03, 0.6)
    solid += occ.Cylinder((0, 0, -0.02), occ.Z, radius, 0.04)
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
    mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=maxh))
    rotor = SolidRotor.from_ngsolve(mesh, STEEL, "z").center_interfaces()
    return rotor.add_point_mass([0.12, 0.0, 0.0], 0.005)


def beam(pieces: int) -> SolidRotor:
    """Return a beam of 0.3 × 0.05 × 0.06 m along x, turning about z through its middle.

    Tetrahedra of second order, `pieces` cubes over each edge across and three times as many along.
    """
    mesh = MakeStructured3DMesh(
        hexes=False,
        nx=3 * pieces,
        ny=pieces,
        nz=pieces,
        mapping=lambda x, y, z: (0.3 * x - 0.15, 0.05 * y - 0.025, 0.06 * z - 0.03),
    )
    return SolidRotor.from_ngsolve(mesh, STEEL, "z", interfaces=())


def settings(steps: int, step: float, body: FullRotorBody | None) -> exudyn.SimulationSettings:
    """Return quiet settings that store sensors at every step."""
    made = recommended_settings(steps * step, step, body=body)
    made.timeIntegration.verboseMode = 0
    made.solution.file.write = False
    made.solution.sensors.writePeriod = step
    return made


# ------------------------------------------------------------------ cost


def cost(maxh: float, radius: float, steps: int) -> Row:
    """Return what a run at constant speed with gravity costs on one mesh."""
    rotor = disc_on_shaft(maxh, radius)
    mbs = exudyn.SystemContainer().AddSystem()
    start = time.process_time()
    body = add_rotor(
        mbs, rotor, spin=SPEED, translation="none", gravity=[0.0, -9.81, 0.0], stiffening="tilt"
    )
    for name, z in (("left", -0.3), ("right", 0.3)):
        ground = mbs.CreateGround(referencePosition=[0.0, 0.0, z])
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)], stiffness=[1e6] * 3, damping=[500.0] * 3
        )
    mbs.Assemble()
    set_up = time.process_time() - start
    times = []
    for count in (1, 1, 1 + steps):  # the first allocates
        start = time.process_time()
        mbs.SolveDynamic(settings(count, STEP, body))
        times.append(time.process_time() - start)
    _, *times = times
    per_step = (times[1] - times[0]) / steps
    nonzeros = factor_size(body)
    return {
        "coordinates": mbs.systemData.ODE2Size(),
        "nonzeros of the factor": nonzeros,
        "set-up s": set_up,
        "first step s": times[0],
        "ms a step": 1e3 * per_step,
        "ns a step and nonzero": 1e9 * per_step / nonzeros,
        "1000 steps s": times[0] + 999.0 * per_step,
    }


def factor_size(body: FullRotorBody) -> int:
    """Return the nonzeros of the factor of the rotor's own matrices in a step."""
    mass, damping, stiffness = body.motion.constant_matrices()
    matrix = mass + 0.5 * STEP * damping + 0.25 * STEP**2 * stiffness
    return int(splu(sp.csc_array(matrix), permc_spec="COLAMD").nnz)


# ------------------------------------------------------------------ mesh


def spun_up_tip(pieces: int, steps: int = 40) -> float:
    """Return how far the tip of a beam has bent while it was spun up within 4 ms [m]."""
    rotor = beam(pieces)
    mbs = exudyn.SystemContainer().AddSystem()
    spin = PrescribedMotion.run_up(0.0, SPEED, steps * STEP)
    body = add_rotor(mbs, rotor, spin=spin, translation="none", stiffening="none")
    mbs.Assemble()
    made = settings(3 * steps // 4, STEP, body)
    made.timeIntegration.newton.relativeTolerance = 1e-8
    mbs.SolveDynamic(made)
    return float(body.displacement()[rotor.nearest_node([0.15, 0.025, 0.03]), 1])


def convergence(finest: int) -> list[Row]:
    """Return a transient displacement over meshes of halved size, and the order it converges at."""
    rows: list[Row] = []
    for pieces in 2 ** np.arange(finest + 1):
        row = {"pieces": pieces, "displacement µm": 1e6 * spun_up_tip(int(pieces))}
        if rows:
            row["change µm"] = row["displacement µm"] - rows[-1]["displacement µm"]
        if len(rows) > 1:
            row["order"] = float(np.log2(abs(rows[-1]["change µm"] / row["change µm"])))
        rows.append(row)
    return rows


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=float, nargs="*", default=[0.03, 0.015, 0.012])
    parser.add_argument("--steps", type=int, default=50)
    parser.add_argument("--thousand", action="store_true")
    parser.add_argument("--refinements", type=int, default=2)
    options = parser.parse_args(arguments)
    runs = [(size, 0.12, options.steps) for size in options.sizes]
    if options.thousand:
        runs.append(THOUSAND)
    for rows in ((cost(*run) for run in runs), convergence(options.refinements)):
        for row in rows:
            print("  ".join(f"{name} {value:.6g}" for name, value in row.items()), flush=True)


if __name__ == "__main__":
    main()
