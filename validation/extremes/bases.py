"""Mode bases: very many modes, and columns that hardly differ."""

from __future__ import annotations

import time
import warnings
from functools import cache

import netgen.occ as occ
import ngsolve as ngs
import numpy as np

from exudyn_rotor import ReducedRotor, SolidRotor, free_modes
from exudyn_rotor.solvers.lanczos import check_modes
from validation.extremes.rotors import cloud
from validation.extremes.rows import EPS, Row, message

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}


@cache
def small_mesh_rotor() -> SolidRotor:
    """Return a steel disc on a shaft with some hundred nodes."""
    shaft = occ.Cylinder((0, 0, 0), occ.Z, 0.02, 0.5)
    solid = shaft + occ.Cylinder((0, 0, 0.2), occ.Z, 0.15, 0.03)
    solid.mat("steel")
    mesh = ngs.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.1, curvaturesafety=1.5))
    return SolidRotor.from_ngsolve(mesh, {"steel": STEEL}, "z", order=1)


def orthonormality(rotor: SolidRotor, reduced: ReducedRotor) -> float:
    """Return the largest entry of ``ΨᵀMΨ − I``; the invariants hold I by construction."""
    columns = reduced.shapes.matrix
    return float(np.abs(columns.T @ (rotor.mass @ columns) - np.eye(reduced.size)).max())


def many_modes(quick: bool = False) -> Row:
    """Reduce one small mesh to 2 … 200 modes."""
    rotor = small_mesh_rotor()
    counts = (2, 50) if quick else (2, 10, 50, 100, 200)
    worst, seconds = 0.0, []
    for count in counts:
        begin = time.perf_counter()
        reduced = rotor.reduce(count)
        seconds.append(time.perf_counter() - begin)
        worst = max(worst, orthonormality(rotor, reduced))
    available = 3 * rotor.node_count - 6
    text = message(lambda: rotor.reduce(available + 1))
    return Row(
        "number of modes",
        f"{counts[0]} to {counts[-1]} of {available} ({seconds[0]:.2g} s to {seconds[-1]:.2g} s)",
        "largest entry of ΨᵀMΨ − I; limit: round-off × coordinates",
        worst,
        EPS * 3 * rotor.node_count,
        f"{available + 1} modes",
        "input" if text else "",
        text,
    )


def eigen_residual(quick: bool = False) -> Row:
    """Check every flexible mode of a large basis by its residual."""
    rotor = small_mesh_rotor()
    modes = free_modes(rotor, 20 if quick else 150)
    flaw = message(
        lambda: check_modes(rotor.stiffness, rotor.mass, modes.frequencies**2, modes.matrix)
    )
    K, M, values = rotor.stiffness, rotor.mass, modes.frequencies**2
    residual = np.linalg.norm(K @ modes.matrix - M @ modes.matrix * values, axis=0)
    terms = np.linalg.norm(abs(K) @ np.abs(modes.matrix), axis=0)
    return Row(
        "highest modes of a large basis",
        f"{len(values)} modes",
        "residual of Kφ = ω²Mφ over |K||φ|; limit: round-off × coordinates",
        np.inf if flaw else (residual / terms).max(),
        EPS * K.shape[0],
        told=flaw,
    )


def near_copies(delta: float, copies: int = 3) -> tuple[SolidRotor, ReducedRotor]:
    """Return a cloud of masses reduced to columns and copies of them that differ by `delta`."""
    rotor = SolidRotor.from_matrices(**cloud(11, 12), axis="z", check_units=False)
    columns = free_modes(rotor, 8).matrix
    rng = np.random.default_rng(5)
    noise = rng.normal(size=(len(columns), copies))
    noise *= np.linalg.norm(columns[:, :copies], axis=0) / np.linalg.norm(noise, axis=0)
    return rotor, rotor.reduce(np.hstack([columns, columns[:, :copies] + delta * noise]))


def dependent_columns(quick: bool = False) -> Row:
    """Give columns that are copies of others but for 1e-3 … 1e-14 of their size."""
    exponents = (3, 6, 8, 14) if quick else range(3, 15)
    worst, dropped = 0.0, {}
    for exponent in exponents:
        rotor, reduced = near_copies(10.0**-exponent)
        worst = max(worst, orthonormality(rotor, reduced))
        dropped[exponent] = len(reduced.dropped)
    first = min((e for e, count in dropped.items() if count == 3), default=0)
    split = all(count in (0, 3) for count in dropped.values())
    return Row(
        "nearly dependent columns",
        "copies that differ by 1e-3 … 1e-14",
        "largest entry of ΨᵀMΨ − I; limit: round-off × coordinates, for two passes of "
        "Gram–Schmidt keep full precision",
        worst if split and first else np.inf,
        EPS * 36 * 2,
        f"copies that differ by 1e-{first} are dropped (rank_tolerance=1e-7)",
        "numerics",
        "ReducedRotor.dropped names them",
    )


def nothing_left(quick: bool = False) -> Row:
    """Give columns that are all zero, or not finite."""
    rotor = SolidRotor.from_matrices(**cloud(11, 12), axis="z", check_units=False)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        zero = message(lambda: rotor.reduce(np.zeros((36, 2))))
    bad = message(lambda: rotor.reduce(np.full((36, 2), np.nan)))
    return Row(
        "columns of zeros, of NaN",
        "two each",
        "1 where zeros are not dropped or NaN is not refused; limit: 0",
        0.0 if not zero and bad.startswith("ValueError") else 1.0,
        0.0,
        "NaN",
        "input",
        bad,
    )
