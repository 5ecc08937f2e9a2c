"""A solid blade on a rigid hub beside the rotating cantilever beam.

A rectangular steel bar is meshed with second-order tetrahedra and clamped at its root face; the
spin axis stands across, in the root face (δ = 0) or one length away (δ = 1). Its flap and lag
frequencies, from the unreduced model, are compared with Ritz solutions of the Euler–Bernoulli beam
(Wright, Smith, Thresher, Wang 1982) and of a Timoshenko beam with Coriolis coupling:

1. At rest, over meshes: what is left on the finest is shear and rotary inertia (gone with the
   Timoshenko beam) and the root face that cannot contract (gone with Poisson's ratio zero).
2. Over speed, for the levels 'none', 'tilt', 'full', and 'full' with the initial displacement.
3. Over speed without lateral contraction (ν = 0), where solid and Timoshenko beam are the same
   mechanics: 'full', and what the initial displacement changes.
4. Southwell's coefficient, the slope of ω² over Ω².
5. Component modes: how many modes at rest give the four lowest frequencies of the unreduced blade
   at the highest speed.

The level 'none' loses the lag mode (NaN or −1) where the spin softening exceeds its stiffness.

Run ``python -m validation blade``, with ``--quick`` for one mesh and fewer speeds.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import ngsolve as ngs
import numpy as np
from netgen.occ import Box, OCCGeometry, Pnt, X
from tqdm import tqdm

from exudyn_rotor import SolidRotor, SpinAxis, campbell, free_modes
from validation.references.beam import Section, flap_frequencies, lag_frequencies, thick_frequencies
from validation.rows import Row, print_rows, verdict

LENGTH, WIDTH, HEIGHT = 0.5, 0.02, 0.01  # along x, in the plane of rotation, across it [m]
STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
# axial wave speed times radius of gyration over L²: the unit of the flap frequencies [rad/s]
UNIT = np.sqrt(STEEL["youngsModulus"] / STEEL["density"] / 12.0) * HEIGHT / LENGTH**2
LEVELS = {"none": "none", "tilt": "tilt", "full": "full", "full, displaced": "full"}
MODES = ("flap 1", "lag 1", "flap 2", "lag 2")


def blade(maxh: float, hub: float = 0.0, ratio: float = STEEL["poissonsRatio"]) -> SolidRotor:
    """Return the clamped bar.

    Parameters
    ----------
    maxh : float
        Element size [m].
    hub : float, optional
        Distance of the root face from the spin axis over the length, δ.
    ratio : float, optional
        Poisson's ratio.
    """
    solid = Box(Pnt(0, -WIDTH / 2, -HEIGHT / 2), Pnt(LENGTH, WIDTH / 2, HEIGHT / 2))
    solid.mat("steel")
    solid.faces.Min(X).name = "root"
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=maxh))
    axis = SpinAxis((0, 0, 1), (-hub * LENGTH, 0, 0))
    material = STEEL | {"poissonsRatio": ratio}
    return SolidRotor.from_ngsolve(mesh, material, axis).clamped("root")


def solid_frequencies(
    rotor: SolidRotor, etas: Sequence[float], level: str, modes: int = 6
) -> dict[str, np.ndarray]:
    """Return flap and lag frequencies of the unreduced blade over :data:`UNIT`.

    Parameters
    ----------
    rotor : SolidRotor
        Without prestress.
    etas : sequence of float
        Spin speeds over :data:`UNIT`.
    level : str
        A key of :data:`LEVELS`.
    modes : int, optional
        How many of the lowest modes to sort; a mode that is not among them is left out.

    Returns
    -------
    dict
        Entry of :data:`MODES` → ndarray, shape (speeds,).
    """
    if level.startswith("full"):
        displaced = level == "full, displaced"
        rotor = rotor.with_prestress(rotor.prestress(initial_displacement=displaced))
    speeds = UNIT * np.asarray(etas)
    reduced = rotor.reduce(max(150, 2 * modes))
    found = campbell(
        reduced, speeds, stiffening=LEVELS[level], modes=modes, frame="rotor", accuracy=None
    )
    rows = []
    for few, values in zip(found.vectors, found.frequencies_rotor, strict=True):
        vectors = reduced.shapes.matrix @ few
        energy = (np.abs(vectors.reshape(rotor.node_count, 3, -1)) ** 2).sum(axis=0)
        share = energy / energy.sum(axis=0)
        kinds = {"flap": values[share[2] > 0.8], "lag": values[share[1] > 0.8]}
        rows.append({f"{kind} {i + 1}": f for kind, fs in kinds.items() for i, f in enumerate(fs)})
    common = [mode for mode in MODES if all(mode in row for row in rows)]
    return {mode: np.array([row[mode] for row in rows]) / UNIT for mode in common}


def beam_frequency(
    mode: str, eta: float, hub: float, ratio: float | None = None, displaced: bool = False
) -> float:
    """Return the beam's frequency of an entry of :data:`MODES` over :data:`UNIT`.

    Parameters
    ----------
    mode : str
    eta : float
        Spin speed over :data:`UNIT`.
    hub : float
        δ.
    ratio : float, optional
        Poisson's ratio of a Timoshenko beam; an Euler–Bernoulli beam by default.
    displaced : bool, optional
        Of a Timoshenko beam: with the initial displacement.
    """
    kind, number = mode.split()
    index = int(number) - 1
    # numbers of the in-plane beam are in the unit of its own bending stiffness
    height = WIDTH if kind == "lag" else HEIGHT
    scale = height / HEIGHT
    if ratio is None:
        function = lag_frequencies if kind == "lag" else flap_frequencies
        return float(scale * function(eta / scale, hub, index + 1)[index])
    section, lag = Section.rectangle(height, LENGTH, ratio), kind == "lag"
    values = thick_frequencies(eta / scale, hub, section, lag, index + 1, displaced=displaced)
    return float(scale * values[index])


def rest_table(sizes: Sequence[float]) -> list[Row]:
    """Return differences from both beams at rest, over element sizes."""
    rows = []
    cases = [(ratio, size) for ratio in (STEEL["poissonsRatio"], 0.0) for size in sizes]
    for ratio, size in tqdm(cases, desc="at rest"):
        rotor = blade(size, ratio=ratio)
        found = solid_frequencies(rotor, [0.0], "none")
        row: Row = {"Poisson's ratio": ratio, "maxh [m]": size, "nodes": rotor.node_count}
        for mode in MODES[:3]:
            row[f"{mode} / Euler"] = found[mode][0] / beam_frequency(mode, 0.0, 0.0) - 1
            row[f"{mode} / Timoshenko"] = found[mode][0] / beam_frequency(mode, 0.0, 0.0, ratio) - 1
        rows.append(row)
    return rows


def speed_table(
    size: float, etas: Sequence[float], hubs: Sequence[float], levels: Sequence[str]
) -> list[Row]:
    """Return frequencies over speed: beams, and every level of the solid less the Euler beam.

    The last two columns compare growth: frequency over its value at rest, solid over beam. `etas`
    must begin with zero.
    """
    rows, ratio = [], STEEL["poissonsRatio"]
    for hub in hubs:
        rotor = blade(size, hub)
        cases = tqdm(levels, desc=f"over speed, hub ratio {hub:g}")
        found = {level: solid_frequencies(rotor, etas, level) for level in cases}
        for mode in [mode for mode in MODES if all(mode in one for one in found.values())]:
            euler = np.array([beam_frequency(mode, eta, hub) for eta in etas])
            thick = np.array([beam_frequency(mode, eta, hub, ratio) for eta in etas])
            for i, eta in enumerate(etas):
                row: Row = {"hub": hub, "mode": mode, "eta": eta, "Euler": euler[i]}
                for level in levels:
                    row[f"'{level}' / Euler"] = found[level][mode][i] / euler[i] - 1
                growth = found["full"][mode][i] / found["full"][mode][0]
                row["growth / Euler"] = growth / (euler[i] / euler[0]) - 1
                row["growth / Timoshenko"] = growth / (thick[i] / thick[0]) - 1
                rows.append(row)
    return rows


def plain_table(size: float, etas: Sequence[float], hubs: Sequence[float]) -> list[Row]:
    """Return the solid of ν = 0 beside the Timoshenko beam, and the effect of the displacement.

    What the initial displacement changes is relative to 'full'. It is of the order of the static
    strain, and terms in ω⁴ of that order are in neither solid nor beam.
    """
    rows: list[Row] = []
    for hub in tqdm(hubs, desc="no lateral contraction"):
        rotor = blade(size, hub, 0.0)
        full, moved = (solid_frequencies(rotor, etas, one) for one in ("full", "full, displaced"))
        for mode in MODES[:3]:
            beam, other = (
                np.array([beam_frequency(mode, eta, hub, 0.0, one) for eta in etas])
                for one in (False, True)
            )
            growth = full[mode] / full[mode][0] / (beam / beam[0]) - 1
            rows += [
                {
                    "hub": hub,
                    "mode": mode,
                    "eta": eta,
                    "Timoshenko": beam[i],
                    "'full' / Timoshenko": full[mode][i] / beam[i] - 1,
                    "growth / Timoshenko": growth[i],
                    "displaced / full, solid": moved[mode][i] / full[mode][i] - 1,
                    "displaced / full, beam": other[i] / beam[i] - 1,
                }
                for i, eta in enumerate(etas)
            ]
    return rows


def southwell(values: np.ndarray, etas: Sequence[float]) -> float:
    """Return the slope of ω² over Ω² between the first two speeds."""
    return float((values[1] ** 2 - values[0] ** 2) / (etas[1] ** 2 - etas[0] ** 2))


def southwell_table(size: float, hubs: Sequence[float], eta: float = 1.0) -> list[Row]:
    """Return Southwell coefficients of beams and solid, secants from rest to `eta`."""
    rows, etas = [], (0.0, eta)
    for hub in tqdm(hubs, desc="Southwell coefficients"):
        rotor = blade(size, hub)
        found = {level: solid_frequencies(rotor, etas, level) for level in ("full", "tilt", "none")}
        for mode in MODES[:3]:
            row: Row = {"hub": hub, "mode": mode}
            for name, ratio in (("Euler", None), ("Timoshenko", STEEL["poissonsRatio"])):
                beam = np.array([beam_frequency(mode, one, hub, ratio) for one in etas])
                row[name] = southwell(beam, etas)
            row |= {f"'{level}'": southwell(one[mode], etas) for level, one in found.items()}
            row["'full' less Euler"] = row["'full'"] - row["Euler"]
            row["'full' less Timoshenko"] = row["'full'"] - row["Timoshenko"]
            rows.append(row)
    return rows


def basis_table(size: float, eta: float, hubs: Sequence[float]) -> list[Row]:
    """Return errors of the four lowest frequencies at a speed by reduced blades."""
    rows, speed = [], UNIT * eta
    for hub in tqdm(hubs, desc="component modes"):
        rotor = blade(size, hub)
        rotor = rotor.with_prestress(rotor.prestress())
        given = {"stiffening": "full", "frame": "rotor"}
        exact = campbell(rotor, speed, modes=4, **given).frequencies_rotor[0, :4]
        bases = {f"{n} at rest": free_modes(rotor, n) for n in (4, 8, 12, 20, 40)}
        for name, modes in bases.items():
            reduced = rotor.reduce(modes)
            found = campbell(reduced, speed, accuracy=None, **given).frequencies_rotor[0, :4]
            row: Row = {"hub": hub, "eta": eta, "modes": name, "columns": reduced.size}
            errors = np.abs(found / exact - 1.0)
            rows.append(row | {f"frequency {i + 1} / full": e for i, e in enumerate(errors)})
    return rows


def main(argv: Sequence[str] | None = None) -> int:
    """Print the tables and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a coarse mesh, fewer speeds")
    options = parser.parse_args(argv)
    sizes = (0.03, 0.02) if options.quick else (0.03, 0.02, 0.01, 0.007)
    etas = (0.0, 4.0, 8.0) if options.quick else (0.0, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0)
    size, hubs = sizes[min(2, len(sizes) - 1)], (0.0, 1.0)
    tables = {
        "1. At rest: frequency of the solid over the beam's, less 1": rest_table(sizes),
        "2. Over speed: frequencies over √(EI/ρAL⁴), relative differences": speed_table(
            size, etas, hubs, tuple(LEVELS)
        ),
        "3. Over speed, Poisson's ratio zero": plain_table(size, etas, hubs),
        "4. Southwell coefficients, slope of ω² over Ω²": southwell_table(size, hubs),
        "5. Component modes: errors of the lowest frequencies": basis_table(size, etas[-1], hubs),
    }
    for title, rows in tables.items():
        print_rows(title, rows)
    plain = tables["3. Over speed, Poisson's ratio zero"]
    return verdict(
        {
            "without lateral contraction, at rest": (
                max(abs(row["'full' / Timoshenko"]) for row in plain if row["eta"] == 0.0),
                1e-3,
            ),
            "its growth over the speed": (
                max(abs(row["growth / Timoshenko"]) for row in plain),
                5e-4,
            ),
        }
    )
