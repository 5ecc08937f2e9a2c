"""Decks rotor.inp and rotor2.inp of CalculiX's test suite against the frequencies that it prints.

A slender disc on a hollow shaft turns at 17565 rad/s, held at its ends: at all nodes (rotor), or at
the mean of a ring (rotor2, by equations). CalculiX finds the frequencies in the rotating frame in
the space of the 10 or 20 modes without Coriolis forces, about the large static deflection. Column
"same space" does that with the rotor's matrices; column "rotor" is what the package gives.

    python -m validation calculix FOLDER

FOLDER holds the decks and the files .dat.ref of the test suite.
"""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as spl

from exudyn_rotor import SolidRotor, Support, campbell, craig_bampton_modes
from validation.rows import print_rows

SPEED = float(np.sqrt(3.0853e8))  # rad/s
RING = 0.5e-3  # radius of the nodes that are held on the mean [m]


def printed(path: Path) -> np.ndarray:
    """Return the frequencies of the last table of a .dat file [rad/s]."""
    table = path.read_text().split("E I G E N V A L U E   O U T P U T")[-1]
    found = []
    for line in table.splitlines():
        fields = line.split()
        if len(fields) == 4 and fields[0] == str(len(found) + 1):
            found.append(float(fields[1]))
        elif len(found) and not fields:
            break
    return np.array(found)


def clamped(path: Path) -> SolidRotor:
    """Return the rotor whose end nodes are held, with the stress by the rotation."""
    rotor = SolidRotor.from_mesh(path, None, "z", length_unit="mm").clamped("Nfix")
    return rotor.with_prestress(rotor.prestress(initial_displacement=True))


def in_same_space(rotor: SolidRotor, modes: int, shift: float) -> np.ndarray:
    """Return the frequencies with Coriolis forces in the modes without them [rad/s]."""
    count, prestress = rotor.node_count, rotor.carried_prestress
    across = sp.kron(sp.eye_array(count), np.diag([1.0, 1.0, 0.0]))
    turn = sp.kron(sp.eye_array(count), np.array([[0, -1, 0], [1, 0, 0], [0, 0, 0.0]]))
    stiffness = rotor.stiffness + SPEED**2 * (prestress.per_square - rotor.mass @ across)
    stiffness = stiffness + SPEED**4 * prestress.per_fourth_power
    free = np.setdiff1d(
        np.arange(3 * count), 3 * rotor.interfaces["Nfix"].nodes[:, None] + np.arange(3)
    )
    matrices = [A[free][:, free] for A in (rotor.mass, 2 * SPEED * rotor.mass @ turn, stiffness)]
    matrices = [sp.csc_array(matrix) for matrix in matrices]
    V = spl.eigsh(matrices[2], modes, matrices[0], sigma=shift)[1]
    M, G, K = (V.T @ matrix @ V for matrix in matrices)
    lower = np.hstack([-np.linalg.solve(M, K), -np.linalg.solve(M, G)])
    state = np.vstack([np.hstack([np.zeros_like(M), np.eye(modes)]), lower])
    return np.sort(scipy.linalg.eigvals(state).imag)[modes:]


def on_rings(path: Path) -> tuple[SolidRotor, list[Support]]:
    """Return the rotor whose rings of corner nodes are held on the mean by stiff springs."""
    rotor = SolidRotor.from_mesh(path, None, "z", length_unit="mm", leave_out=["*EQUATION"])
    x, y, z = rotor.nodes.T
    is_corner = np.abs(np.sin(8.0 * np.arctan2(y, x))) < 1e-3
    ring = is_corner & (np.abs(np.hypot(x, y) - RING) < 1e-8)
    for name, end in (("low", z.min()), ("high", z.max())):
        rotor = rotor.with_interface(name, np.flatnonzero(ring & (np.abs(z - end) < 1e-8)))
    return rotor, [Support(name, 1e12 * np.eye(3)) for name in ("low", "high")]


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, nargs="?", help="with the decks and their results")
    folder = parser.parse_args().folder
    if folder is None:
        print("calculix: needs the folder of CalculiX's decks; nothing was compared")
        return
    warnings.simplefilter("ignore", UserWarning)

    rotor = clamped(folder / "rotor.inp")
    expected = printed(folder / "rotor.dat.ref")
    same = in_same_space(rotor, len(expected), -1e9)
    found = np.sort(campbell(rotor.reduce(60), [SPEED]).frequencies_rotor[0])
    print_rows("rotor.inp [rad/s]", rows(expected, found, same))

    rotor, supports = on_rings(folder / "rotor2.inp")
    expected = printed(folder / "rotor2.dat.ref")[1:]  # the first is the free spin
    basis = craig_bampton_modes(rotor, 60, ["low", "high"], coupling="RBE3")
    reduced = rotor.reduce(basis, prestress=rotor.prestress(supports=supports))
    result = campbell(reduced, [SPEED], supports=supports)
    print_rows("rotor2.inp [rad/s]", rows(expected, np.sort(result.frequencies_rotor[0])[1:]))


def rows(expected: np.ndarray, found: np.ndarray, same: np.ndarray | None = None) -> list[dict]:
    """Return the printed frequencies and relative deviations."""
    table = []
    for i, value in enumerate(expected):
        row = {"printed": f"{value:.7g}", "rotor": f"{found[i]:.7g}"}
        row["deviation"] = found[i] / value - 1.0
        if same is not None:
            row["in the same space"] = f"{same[i]:.7g}"
            row["its deviation"] = same[i] / value - 1.0
        table.append(row)
    return table


if __name__ == "__main__":
    main()
