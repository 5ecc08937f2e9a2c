"""A rotor from plain matrices: nodes, M and K in Matrix Market files, as other FE codes write them.

The files are made here with NGSolve; read back, the rotor must have the same eigenfrequencies.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import ngsolve
import numpy as np
import scipy.io
from netgen import occ

from exudyn_rotor import ReducedRotor, SolidRotor


def write_model(folder: Path) -> SolidRotor:
    """Write nodes, mass and stiffness of a stepped shaft to `folder`; return the original."""
    solid = occ.Cylinder(occ.Pnt(0, 0, 0), occ.Z, 0.02, 0.3)
    solid += occ.Cylinder(occ.Pnt(0, 0, 0.1), occ.Z, 0.05, 0.05)
    mesh = ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.08, curvaturesafety=1.0))
    steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
    rotor = SolidRotor.from_ngsolve(mesh, steel, axis="z")
    np.savetxt(folder / "nodes.txt", rotor.nodes, fmt="%.17g")
    scipy.io.mmwrite(folder / "mass.mtx", rotor.mass, precision=17)
    scipy.io.mmwrite(folder / "stiffness.mtx", rotor.stiffness, precision=17)
    return rotor


with TemporaryDirectory() as name:
    folder = Path(name)
    original = write_model(folder)
    nodes = np.loadtxt(folder / "nodes.txt")
    end = np.flatnonzero(np.isclose(nodes[:, 2], 0.0))  # the nodes of the left end face
    rotor = SolidRotor.from_matrices(
        scipy.io.mmread(folder / "mass.mtx", spmatrix=False),
        scipy.io.mmread(folder / "stiffness.mtx", spmatrix=False),
        nodes,
        axis="z",
        interfaces={"left": end},
    )
    print(rotor.summary())

    reduced = rotor.reduce(7)
    reduced.save(folder / "rotor.npz")
    loaded = ReducedRotor.load(folder / "rotor.npz")

frequencies = loaded.frequencies[6:] / (2.0 * np.pi)
expected = original.reduce(7).frequencies[6:] / (2.0 * np.pi)
print("free eigenfrequencies [Hz]:", np.round(frequencies, 2))
assert np.allclose(frequencies, expected, rtol=1e-8)
assert np.array_equal(loaded.invariants.K, reduced.invariants.K)
