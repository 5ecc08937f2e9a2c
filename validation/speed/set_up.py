"""Time of the set-up, mesh to free modes: Exudyn's FEMinterface and SolidRotor side by side.

Then what each part of our own set-up takes, with what ``stiffening='full'`` and stress add.

python -m validation set_up [--quick | --large]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np
from exudyn.FEM import FEMinterface

from exudyn_rotor import SolidRotor, free_modes
from exudyn_rotor.demo.scene import BEARINGS, STEEL, disc_on_shaft
from validation.rows import verdict

MODES = 20
# lengths of the elements [m], and how much shorter they are than the radius of curves
Size = tuple[float, float]
SIZES: tuple[Size, ...] = ((0.0155, 2.0), (0.0085, 2.0))
QUICK_SIZES: tuple[Size, ...] = ((0.05, 2.0),)
LARGE_SIZES: tuple[Size, ...] = ((0.0056, 2.8),)


def by_fem_interface(size: Size) -> np.ndarray:
    """Return the eigenfrequencies [rad/s] that FEMinterface computes."""
    fem = FEMinterface()
    fem.ImportMeshFromNGsolve(
        disc_on_shaft(*size),
        materials=STEEL,
        boundaryNamesList=list(BEARINGS),
        meshOrder=2,
    )
    fem.ComputeEigenmodes(MODES, excludeRigidBodyModes=6)
    return np.sqrt(fem.eigenValues)


def by_solid_rotor(size: Size) -> np.ndarray:
    """Return the eigenfrequencies [rad/s] of the same rotor from SolidRotor."""
    rotor = SolidRotor.from_ngsolve(disc_on_shaft(*size), STEEL, axis="x")
    return free_modes(rotor, MODES).frequencies


def timed(compute: Callable[[Size], np.ndarray], size: Size) -> tuple[np.ndarray, float]:
    """Return the result and the seconds it took."""
    start = time.perf_counter()
    return compute(size), time.perf_counter() - start


def parts(size: Size) -> dict[str, float]:
    """Return the seconds of each part of a set-up, one after the other on one rotor."""
    rotor, model = timed(
        lambda size: SolidRotor.from_ngsolve(disc_on_shaft(*size), STEEL, axis="x"), size
    )
    modes, found = timed(lambda _: free_modes(rotor, MODES), size)
    _, reduction = timed(lambda _: rotor.reduce(modes), size)
    prestress, static = timed(lambda _: rotor.prestress(), size)
    _, full = timed(lambda _: rotor.reduce(modes, prestress=prestress), size)
    _, stress = timed(lambda _: rotor.reduce(modes, stress=True), size)
    return {
        "mesh, mass and stiffness": model,
        f"{MODES} free modes": found,
        "reduction": reduction,
        "prestress for 'full'": static + max(full - reduction, 0.0),
        "stress of the modes": max(stress - reduction, 0.0),
    }


def compare(size: Size) -> dict:
    """Return degrees of freedom, seconds of both, their ratio, and how far the results differ."""
    mesh = disc_on_shaft(*size)
    mesh.ngmesh.SecondOrder()
    theirs, slow = timed(by_fem_interface, size)
    ours, fast = timed(by_solid_rotor, size)
    return {
        "degrees_of_freedom": 3 * len(mesh.ngmesh.Points()),
        "fem_interface": slow,
        "solid_rotor": fast,
        "ratio": slow / fast,
        "deviation": float(np.abs(np.sort(ours) / np.sort(theirs) - 1.0).max()),
        "parts": parts(size),
    }


def main() -> int:
    """Compare, print a table and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--quick", action="store_true", help="a coarse mesh")
    which.add_argument("--large", action="store_true", help="200 000 degrees of freedom")
    options = parser.parse_args()
    sizes = QUICK_SIZES if options.quick else LARGE_SIZES if options.large else SIZES
    rows = [compare(size) for size in sizes]
    print("  dofs   FEMinterface [s]   SolidRotor [s]   ratio   deviation")
    for row in rows:
        print(
            f"{row['degrees_of_freedom']:6d}{row['fem_interface']:19.1f}{row['solid_rotor']:17.1f}"
            f"{row['ratio']:8.1f}{row['deviation']:12.1e}"
        )
    for row in rows:
        print(f"\nSolidRotor, {row['degrees_of_freedom']} degrees of freedom [s]")
        for name, seconds in row["parts"].items():
            print(f"  {name:26s}{seconds:7.2f}")
    return verdict(
        {
            "deviation of the frequencies": (max(row["deviation"] for row in rows), 1e-5),
            "time over that of FEMinterface": (1.0 / min(row["ratio"] for row in rows), 1.0),
        }
    )
