"""Rotating solid discs beside plane stress and thin plates.

1. Growth and stress of a free annulus and of a disc without a bore, over meshes of order 1 and 2.
   Twice the strain energy and the mean growth of the rim converge like h² and h⁴; their limit is
   plane stress, which holds for means over the thickness.
2. Bending modes with n nodal diameters of an annulus clamped at its bore, at rest, over thickness:
   Kirchhoff's plate, then with rotary inertia; shear and the elastic edge are what is left.
3. The same at speed: rotor-frame frequencies beside plate and membrane together, the bound of Lamb
   and Southwell, and the slope of ω² over Ω²; waves in the inertial frame at ``ν ± nΩ``.

Annuli have meshes of cyclic symmetry: waves with and against the spin stay pairs. The mid nodes of
second-order elements lie on circles.

Run ``python -m validation disc``, with ``--quick`` for coarser meshes.
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Sequence
from dataclasses import replace

import ngsolve as ngs
import numpy as np
from netgen.meshing import FaceDescriptor, Mesh
from scipy.integrate import simpson
from tqdm import tqdm

from exudyn_rotor import SolidRotor, campbell
from exudyn_rotor.linear.modal.campbell import Campbell
from validation.references import plate
from validation.references.plate import Annulus, PlaneStress
from validation.rows import Row, print_rows, verdict
from validation.stiffening.blade import STEEL

MATERIAL = {"modulus": 2.1e11, "ratio": 0.3, "density": 7850.0}
RING = Annulus(0.05, 0.2, 0.02, **MATERIAL)
ROUND = Annulus(0.0, 0.2, 0.04, **MATERIAL)
PLATE = Annulus(0.05, 0.2, 0.01, **MATERIAL)
SPEED = 1000.0  # [rad/s]
DIAMETERS = range(5)
_EDGES = np.array([(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)])


# ------------------------------------------------------------------ meshes


def disc_mesh(disc: Annulus, cells: Sequence[int], order: int) -> ngs.Mesh:
    """Return a disc of bricks that are cut into six tetrahedra each, all in the same way.

    Without a bore, the innermost bricks have one edge on the axis.

    Parameters
    ----------
    disc : Annulus
    cells : sequence of int
        Bricks along radius, circumference and thickness.
    order : int
        With 2, mid nodes lie halfway in r and θ, on circles.
    """
    along, around, across = cells
    # in geometric progression: bricks of one shape, small where stress changes most
    space = np.geomspace if disc.inner > 0.0 else np.linspace
    r = space(disc.inner, disc.outer, along + 1)
    angle = 2.0 * np.pi * np.arange(around) / around
    z = disc.thickness * (np.arange(across + 1) / across - 0.5)
    grid = np.meshgrid(r, angle, z, indexing="ij")
    points = np.stack([grid[0] * np.cos(grid[1]), grid[0] * np.sin(grid[1]), grid[2]], axis=-1)
    tetrahedra = _cut(along, around, across)
    if disc.inner == 0.0:
        tetrahedra = _joined(tetrahedra, around, across)
    used, tetrahedra = np.unique(tetrahedra, return_inverse=True)
    tetrahedra = tetrahedra.reshape(-1, 4)
    triangles = _outside(tetrahedra)
    positions = points.reshape(-1, 3)[used]
    radius = np.linalg.norm(positions[triangles][..., :2], axis=2)
    mesh = Mesh(dim=3)
    mesh.AddPoints(positions)
    on_bore, on_rim = (
        np.ptp(radius, axis=1) + abs(radius[:, 0] - edge) < 1e-9 for edge in r[[0, -1]]
    )
    faces = {"bore": on_bore, "rim": on_rim, "default": ~(on_bore | on_rim)}
    present = {name: chosen for name, chosen in faces.items() if chosen.any()}
    for number, (name, chosen) in enumerate(present.items(), 1):
        index = mesh.Add(FaceDescriptor(surfnr=number, domin=1, bc=number))
        mesh.SetBCName(number - 1, name)
        mesh.AddElements(dim=2, index=index, data=triangles[chosen].astype(np.int32), base=0)
    mesh.AddElements(dim=3, index=1, data=tetrahedra.astype(np.int32), base=0)
    mesh.SetMaterial(1, "steel")
    if order == 2:
        mesh.SecondOrder()
        _bend_edges(mesh)
    return ngs.Mesh(mesh)


def _cut(along: int, around: int, across: int) -> np.ndarray:
    """Return tetrahedra (t, 4) of all bricks: a path along the three edges in every order."""
    start = np.stack(np.meshgrid(*map(np.arange, (along, around, across)), indexing="ij"), axis=-1)
    found = []
    for path in itertools.permutations(range(3)):
        corners = [start.reshape(-1, 3)]
        for direction in path:
            corners.append(corners[-1] + np.eye(3, dtype=int)[direction])
        i, j, k = np.moveaxis(np.array(corners), 2, 0)
        numbers = ((i * around + j % around) * (across + 1) + k).T
        # Netgen wants the fourth corner on the other side than a right-handed triple has it
        odd = np.linalg.det(np.eye(3)[list(path)]) > 0
        found.append(numbers[:, [0, 2, 1, 3]] if odd else numbers)
    return np.concatenate(found)


def _joined(tetrahedra: np.ndarray, around: int, across: int) -> np.ndarray:
    """Return the tetrahedra (t, 4) with one point for all on the axis, without the flat ones."""
    on_axis = tetrahedra < around * (across + 1)
    joined = np.where(on_axis, tetrahedra % (across + 1), tetrahedra)
    ordered = np.sort(joined, axis=1)
    return joined[np.all(ordered[:, 1:] > ordered[:, :-1], axis=1)]


def _outside(tetrahedra: np.ndarray) -> np.ndarray:
    """Return the triangles (s, 3) that belong to one tetrahedron only, normals outwards."""
    sides = tetrahedra[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
    _, first, counts = np.unique(
        np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True
    )
    return sides[first[counts == 1]]


def _bend_edges(mesh: Mesh) -> None:
    """Move mid nodes to the mean radius and angle of the ends of their edge."""
    numbers = mesh.Elements3D().NumPy()["nodes"].astype(np.int64) - 1
    positions = mesh.Coordinates()
    ends = numbers[:, _EDGES].reshape(-1, 2)
    flat = positions[ends][..., :2]
    radius = np.linalg.norm(flat, axis=2, keepdims=True)
    direction = (flat / np.maximum(radius, 1e-12)).sum(axis=1)
    direction /= np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), 1e-12)
    positions[numbers[:, 4:10].ravel(), :2] = direction * radius.mean(axis=1)


def disc_rotor(disc: Annulus, cells: Sequence[int], order: int = 2) -> SolidRotor:
    """Return a free disc that spins about z, with the interfaces 'rim' and, if any, 'bore'."""
    material = STEEL | {"poissonsRatio": disc.ratio}
    return SolidRotor.from_ngsolve(disc_mesh(disc, cells, order), material, "z", order=order)


# ------------------------------------------------------------------ growth and stress


def thickness_mean(z: np.ndarray, values: np.ndarray) -> float:
    """Return the mean of nodal values on a round face: around it, then by Simpson's rule over z.

    Growth and stress are parabolas over the thickness. Mean nodal values of order 1 have two
    levels on the coarsest mesh, where this is the trapezoidal rule.
    """
    levels, where = np.unique(np.round(z, 9), return_inverse=True)
    means = np.bincount(where, values) / np.bincount(where)
    return float(simpson(means, x=levels) / np.ptp(levels))


def static_values(rotor: SolidRotor, disc: Annulus) -> dict[str, float]:
    """Return means of the static field per Ω², each over its plane-stress value.

    Twice the strain energy, growth and hoop stress of rim and bore; without a bore, the stress at
    the centre.
    """
    reduced = rotor.reduce(0, stress=True, prestress=True)
    moved, stress = reduced.static_displacement(1.0).reshape(-1, 3), reduced.static_stress(1.0)
    radius = np.linalg.norm(rotor.nodes[:, :2], axis=1)
    outward = rotor.nodes[:, :2] / np.maximum(radius, 1e-12)[:, None]
    growth = (moved[:, :2] * outward).sum(axis=1)
    radial = (stress[:, [0, 5]] * outward).sum(axis=1) * outward[:, 0]
    radial = radial + (stress[:, [5, 1]] * outward).sum(axis=1) * outward[:, 1]
    hoop = stress[:, 0] + stress[:, 1] - radial
    theory = PlaneStress.free(disc)
    load = (rotor.mass @ rotor.axis.radial(rotor.nodes).ravel()).reshape(-1, 3)
    values = {"work": float((load * moved).sum() / theory.work())}
    for name, place in (("bore", disc.inner), ("rim", disc.outer)):
        if name in rotor.interfaces:
            face = rotor.interfaces[name].nodes
            z = rotor.nodes[face, 2]
            values[f"{name} growth"] = thickness_mean(z, growth[face]) / theory.growth(place)
            values[f"{name} hoop"] = thickness_mean(z, hoop[face]) / theory.hoop(place)
    if disc.inner == 0.0:
        centre = stress[radius < 1e-9, :2]
        values["centre stress"] = centre.mean() / theory.hoop(0.0)
    return {name: float(value) for name, value in values.items()}


def static_table(disc: Annulus, levels: dict[int, Sequence[int]]) -> list[Row]:
    """Return what remains to plane stress, and orders of convergence, over meshes.

    `levels` are factors on a coarsest mesh, each the double of the last, for the orders of the
    elements. The order of a quantity is ``log₂`` of the ratio of its last two changes: no limit is
    assumed.
    """
    rows: list[Row] = []
    for order, factors in levels.items():
        series = [disc_rotor(disc, (2 * k, 12 * k, k), order) for k in factors]
        values = [static_values(rotor, disc) for rotor in tqdm(series, desc=f"order {order}")]
        for i, (rotor, one) in enumerate(zip(series, values, strict=True)):
            row: Row = {"order": order, "nodes": rotor.node_count}
            row |= {f"{name} / plane stress": value - 1.0 for name, value in one.items()}
            for name in ("work", "rim growth"):
                last = np.array([value[name] for value in values[max(i - 2, 0) : i + 1]])
                steps = np.abs(np.diff(last))
                row[f"order of {name}"] = np.log2(steps[0] / steps[1]) if i > 1 else np.nan
            rows.append(row)
    return rows


# ------------------------------------------------------------------ bending modes


def bending_modes(rotor: SolidRotor, speed: float, modes: int = 12) -> Campbell:
    """Return the lowest modes of the unreduced plate, clamped at its bore, level 'full'."""
    held = rotor.clamped("bore")
    carrying = held.with_prestress(held.prestress())
    return campbell(carrying, [speed], stiffening="full", modes=modes, frame="rotor")


def pair(found: Campbell, n: int) -> np.ndarray:
    """Return the rotor-frame frequencies of the first two modes with n nodal diameters [rad/s]."""
    chosen = found.frequencies_rotor[0][found.nodal_diameters[0] == n]
    return np.repeat(chosen[:1], 2) if n == 0 else chosen[:2]


def rest_table(cases: Sequence[tuple[Annulus, Sequence[int]]]) -> list[Row]:
    """Return frequencies at rest of plates, each with the cells of its mesh."""
    rows = []
    for disc, cells in tqdm(cases, desc="bending at rest"):
        found = bending_modes(disc_rotor(disc, cells), 0.0)
        for n in DIAMETERS:
            kirchhoff, solid = plate.plate_frequency(disc, n), pair(found, n)
            mindlin = plate.thick_frequencies(disc, n, 0.0)[0]
            rows.append(
                {
                    "Poisson's ratio": disc.ratio,
                    "h [m]": disc.thickness,
                    "cells": " × ".join(map(str, cells)),
                    "n": n,
                    "Kirchhoff [rad/s]": kirchhoff,
                    "Ritz / Bessel": plate.rotating_frequency(disc, n, 0.0) / kirchhoff - 1,
                    "Mindlin / Kirchhoff": mindlin / kirchhoff - 1,
                    "solid / Kirchhoff": solid[0] / kirchhoff - 1,
                    "solid / Mindlin": solid[0] / mindlin - 1,
                    "pair, second / first": solid[1] / solid[0] - 1,
                }
            )
    return rows


def speed_table(disc: Annulus, cells: Sequence[int], speed: float = SPEED) -> list[Row]:
    """Return the growth of ω² over Ω² of the solid, of plates and of the membrane.

    What the mesh adds to ω² at rest it adds at speed, too, and drops out. The mean of the squares
    of a pair is free of the Coriolis force to first order. The last column is the bound of Lamb and
    Southwell, ``ω² ≥ ω₀² + λΩ²``, with ω₀ of the solid at rest: never below zero.
    """
    rotor, rows = disc_rotor(disc, cells), []
    rest, moving = (bending_modes(rotor, one) for one in tqdm((0.0, speed), desc="bending waves"))
    for n in DIAMETERS:
        still, waves = pair(rest, n), pair(moving, n)
        thin = [plate.rotating_frequency(disc, n, one) for one in (0.0, speed)]
        thick = [plate.thick_frequencies(disc, n, one) for one in (0.0, speed)]
        slopes = [
            (np.mean(np.square(after)) - np.mean(np.square(before))) / speed**2
            for before, after in ((still, waves), thin, thick)
        ]
        membrane = plate.membrane_value(disc, n)
        rows.append(
            {
                "n": n,
                "slope, solid": slopes[0],
                "membrane λ": membrane,
                "solid / Kirchhoff": slopes[0] / slopes[1] - 1,
                "solid / Mindlin": slopes[0] / slopes[2] - 1,
                "pair [rad/s]": waves[1] - waves[0],
                "pair, Mindlin [rad/s]": thick[1][1] - thick[1][0],
                "over the bound / ω²": ((slopes[0] - membrane) * speed**2) / np.mean(waves**2),
                "ω / Mindlin": np.mean(waves) / np.mean(thick[1]) - 1,
            }
        )
    return rows


def wave_table(disc: Annulus, cells: Sequence[int], speed: float = SPEED) -> list[Row]:
    """Return waves in the inertial frame beside ``|ν ± nΩ|`` of Mindlin's plate [rad/s].

    Frequencies ν in the rotor frame; a forward wave turns with the spin.
    """
    rows = []
    found = bending_modes(disc_rotor(disc, cells), speed)
    for n in DIAMETERS[1:]:
        slow, fast = plate.thick_frequencies(disc, n, speed)
        chosen = np.flatnonzero(found.nodal_diameters[0] == n)[:2]
        nu, seen = found.frequencies_rotor[0][chosen], found.frequencies_inertial[0][chosen]
        ahead = np.argmin(np.abs(seen - nu - n * speed))
        rows.append(
            {
                "n": n,
                "forward": seen[ahead],
                "backward": seen[1 - ahead],
                "forward / Mindlin": seen[ahead] / (slow + n * speed) - 1,
                "backward less Mindlin [rad/s]": seen[1 - ahead] - abs(fast - n * speed),
                "forward less (ν + nΩ)": seen[ahead] - nu[ahead] - n * speed,
                "backward less |ν − nΩ|": seen[1 - ahead] - abs(nu[1 - ahead] - n * speed),
                "forward wave": str(found.whirl[0][chosen[ahead]]),
                "backward wave": str(found.whirl[0][chosen[1 - ahead]]),
            }
        )
    return rows


# ------------------------------------------------------------------ script


def rest_cases(quick: bool) -> list[tuple[Annulus, Sequence[int]]]:
    """Return plates and meshes: over the mesh, over the thickness, without lateral contraction."""
    coarse, fine = ((4, 24, 1), (6, 36, 1)) if quick else ((8, 48, 1), (12, 72, 1))
    plain = replace(PLATE, ratio=0.0)
    double = replace(PLATE, thickness=2.0 * PLATE.thickness)
    return [(PLATE, coarse), (PLATE, fine), (double, coarse), (plain, coarse), (plain, fine)]


def main(argv: Sequence[str] | None = None) -> int:
    """Print the tables and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarser meshes")
    options = parser.parse_args(argv)
    levels = {1: (1, 2, 4), 2: (1, 2)} if options.quick else {1: (1, 2, 4), 2: (1, 2, 4)}
    cells = (6, 36, 1) if options.quick else (8, 48, 1)
    tables = {
        "1a. Free annulus: means over plane stress, less 1": static_table(RING, levels),
        "1b. Disc without a bore": static_table(ROUND, levels),
        "2. Bending at rest, clamped bore": rest_table(rest_cases(options.quick)),
        f"3a. At {SPEED:g} rad/s: slopes of ω² over Ω²": speed_table(PLATE, cells),
        "3b. Waves in the inertial frame [rad/s]": wave_table(PLATE, cells),
    }
    for title, rows in tables.items():
        print_rows(title, rows)
    speeds = tables[f"3a. At {SPEED:g} rad/s: slopes of ω² over Ω²"]
    return verdict(
        {
            "slopes over Mindlin's, less 1": (
                max(abs(row["solid / Mindlin"]) for row in speeds),
                2e-2,
            ),
        }
    )
