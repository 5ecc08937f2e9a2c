"""Estimated error of the basis of reduced rotors beside the true one, against the full model.

A shaft with three discs at rest and at 25 000 rpm. Free modes and Craig–Bampton modes, few and
many; soft, stiff and very stiff bearings, about z and x, balanced and with a mass on a rim, levels
'tilt' and 'full'. Of the modes up to 500 Hz in the rotor frame those count whose true error is
above 1e-4 of the eigenvalue. The column 'estimate/true' has the smallest and the largest ratio;
'within 3' the share of modes with a ratio from 1/3 to 3. Interfaces with RBE2 are rigid in the
reduced rotor and not in the full model: that part of the error is not estimated.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator

import ngsolve as ngs
import numpy as np
from netgen.occ import Cylinder, OCCGeometry, Pnt, X, Z

from exudyn_rotor import (
    Campbell,
    ReducedRotor,
    SolidRotor,
    Support,
    campbell,
    craig_bampton_modes,
)

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
SPEEDS = [0.0, 25000.0 * 2.0 * np.pi / 60.0]
HIGHEST = 500.0 * 2.0 * np.pi
MODES = 14  # of the full model
COUNTS = 1e-4
DISCS = ((0.15, 0.12), (0.4, 0.15), (0.6, 0.13))  # place and radius [m]


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one bearing, one axis, few modes")
    quick = parser.parse_args(arguments).quick
    titles = f"{'worst true':>12}{'estimated':>11}{'estimate/true':>17}{'within 3':>10}"
    print(f"{'case':44}{'modes':>7}{titles}")
    for name, rotor, level, supports, bases in cases(quick):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of too few modes, and of the mass on the rim
            given = {"supports": supports, "stiffening": level}
            full = campbell(rotor, SPEEDS, modes=MODES, **given)
            for label, modes in bases:
                reduced = reduce(rotor, modes)
                result = campbell(reduced, SPEEDS, modes=reduced.size, **given)
                print(f"{name + ', ' + label:44}{row(full, result)}", flush=True)


def cases(quick: bool) -> Iterator[tuple[str, SolidRotor, str, list[Support], list]]:
    """Yield name, rotor, level, supports and bases of every case."""
    kinds = {
        "soft": 1e6,
        "stiff": 5e7,
        "very stiff": 1e9,
    }
    few = [("12 free", 12), ("12 Craig–Bampton", ("RBE3", 12))]
    many = [("30 free", 30), ("30 Craig–Bampton", ("RBE3", 30)), ("12 with RBE2", ("RBE2", 12))]
    bases = few if quick else [("6 free", 6), *few, *many]
    plain = rotor_about("z")
    for kind in ("stiff",) if quick else ("soft", "stiff", "very stiff"):
        yield f"z, tilt, {kind}", plain, "tilt", bearings(kinds[kind]), bases
    if quick:
        return
    stressed = plain.with_prestress(plain.prestress())
    yield "z, full, stiff", stressed, "full", bearings(kinds["stiff"]), bases
    yield "x, tilt, stiff", rotor_about("x"), "tilt", bearings(kinds["stiff"]), bases
    eccentric = plain.add_point_mass([0.15, 0.0, 0.415], 0.05)
    yield "z, tilt, stiff, eccentric", eccentric, "tilt", bearings(kinds["stiff"]), bases


def rotor_about(axis: str) -> SolidRotor:
    """Return the rotor with three discs along mesh z or x."""
    direction = {"x": X, "z": Z}[axis]

    def at(place: float) -> Pnt:
        return Pnt(*(place if axis == name else 0.0 for name in "xyz"))

    solid = Cylinder(at(0.0), direction, 0.02, 0.8)
    for place, radius in DISCS:
        solid = solid + Cylinder(at(place), direction, radius, 0.03)
    solid.mat("steel")
    solid.faces.Min(direction).name = "left"
    solid.faces.Max(direction).name = "right"
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.06, curvaturesafety=1.0))
    return SolidRotor.from_ngsolve(mesh, STEEL, axis, order=2).center_interfaces()


def bearings(stiffness: float) -> list[Support]:
    """Return two equal bearings with the same damping."""
    return [Support(name, stiffness, damping=500.0) for name in ("left", "right")]


def reduce(rotor: SolidRotor, modes: int | tuple[str, int]) -> ReducedRotor:
    """Return the rotor with free modes, or with Craig–Bampton modes of a coupling."""
    if isinstance(modes, int):
        return rotor.reduce(modes)
    coupling, count = modes
    return rotor.reduce(craig_bampton_modes(rotor, count, coupling=coupling))


def row(full: Campbell, result: Campbell) -> str:
    """Return number of modes, the worst of them, and how estimates compare, as text."""
    true, estimated = [], []
    for at in range(len(SPEEDS)):
        reference = full.growth[at] + 1j * full.frequencies_rotor[at]
        values = result.growth[at] + 1j * result.frequencies_rotor[at]
        for value, shift in zip(values, result.basis_shifts[at], strict=True):
            if value == 0.0 or abs(value + shift) > HIGHEST:
                continue
            nearest = reference[np.argmin(np.abs(reference - value - shift))]
            true.append(abs(nearest - value) / abs(value))
            estimated.append(abs(shift) / abs(value))
    true, estimated = np.array(true), np.array(estimated)
    worst = np.argmax(true)
    ratios = (estimated / np.maximum(true, 1e-300))[true > COUNTS]
    if not ratios.size:
        return f"{0:7}{true[worst]:12.1e}{estimated[worst]:11.1e}{'-':>17}{'-':>10}"
    close = np.mean((ratios > 1.0 / 3.0) & (ratios < 3.0))
    span = f"{ratios.min():.2f} … {ratios.max():.2f}"
    return f"{ratios.size:7}{true[worst]:12.1e}{estimated[worst]:11.1e}{span:>17}{close:10.0%}"


if __name__ == "__main__":
    main()
