"""Materials, and units that cannot be SI."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.calls import user_level

Material = Mapping[str, float]
MATERIAL_KEYS = ("youngsModulus", "poissonsRatio", "density")

# Bar wave speed √(E/ρ) [m/s] from soft foam (about 30) to diamond (18 000), with a wide margin.
WAVE_SPEED_RANGE = (10.0, 1e5)
# Solids from aerogel (about 1) to osmium (22 600) [kg/m³].
DENSITY_RANGE = (1.0, 1e5)
# Mass over bounding box [kg/m³]; a bladed wheel may fill a thousandth of its box.
MEAN_DENSITY_RANGE = (1e-2, 1e5)
# Ten thousand tonnes [kg]; the heaviest turbine-generator rotors have about two thousand.
LARGEST_MASS = 1e7
# Few rotors but those of large hydroelectric generators are heavier [kg].
USUAL_MASS = 5e5

_ADVICE = (
    "convert to SI (m, kg, s, N, Pa), or pass check_units=False if the units of all inputs agree"
)


def materials_by_region(
    regions: Sequence[str], materials: Mapping[str, Any], check_units: bool
) -> dict[str, Material]:
    """Return one checked material for every region name; `materials` as of ``from_ngsolve``."""
    checks.mapping(materials, "materials", "material")
    names = sorted(set(regions))
    if any(key in materials for key in MATERIAL_KEYS):
        if len(names) > 1:
            raise ValueError(
                f"materials: one material was given, but the mesh has {len(names)} regions "
                f"{names}; give a dictionary by region name"
            )
        materials = {names[0]: materials}
    missing = [name for name in names if name not in materials]
    if missing:
        raise ValueError(
            f"materials: the mesh regions {missing} have no material; "
            f"given are {sorted(materials)}, the mesh has {names}"
        )
    checked = {name: _checked_material(name, materials[name]) for name in names}
    for name, material in checked.items() if check_units else ():
        _check_material_units(name, material)
    return checked


def _check_material_units(name: str, material: Material) -> None:
    """Raise ValueError if the material `name` cannot be in SI units."""
    density = material["density"]
    speed = np.sqrt(material["youngsModulus"] / density)
    if not _inside(density, DENSITY_RANGE):
        raise ValueError(
            f"materials: {name!r}: a density of {density:g} kg/m³ cannot be; "
            f"{_guess(density)} {_ADVICE}"
        )
    if not _inside(speed, WAVE_SPEED_RANGE):
        raise ValueError(
            f"materials: {name!r}: Young's modulus and density give a wave speed of "
            f"{speed:.3g} m/s (steel: 5200), which cannot be; {_ADVICE}"
        )


def check_model_units(nodes: np.ndarray, total_mass: float) -> None:
    """Raise ValueError if size [m] and mass [kg] of a model cannot be in SI, warn if hardly."""
    extent = np.ptp(nodes, axis=0)
    size = f"{total_mass:.3g} kg in a box of {' × '.join(f'{side:.3g}' for side in extent)} m"
    if total_mass > LARGEST_MASS:
        raise ValueError(
            f"units: {size} cannot be a rotor; lengths in mm, as Netgen reads all STEP files? "
            f"shape.Scale(Pnt(0, 0, 0), 1e-3) has metres; {_ADVICE}"
        )
    if total_mass > USUAL_MASS:
        warnings.warn(
            f"units: {size}: few rotors are that heavy; lengths in mm? Arrays are in m, kg, s; "
            "check_units=False takes them as they are",
            stacklevel=user_level(),
        )
    volume = float(np.prod(extent))
    if volume <= 1e-12 * np.max(extent) ** 3:
        return
    density = total_mass / volume
    if not _inside(density, MEAN_DENSITY_RANGE):
        raise ValueError(
            f"units: {size}, {density:.3g} kg/m³, cannot be; {_guess(density)} {_ADVICE}"
        )


def _checked_material(name: str, material: Any) -> Material:
    label = f"materials: {name!r}"
    checks.mapping(material, label, "number")
    if set(material) != set(MATERIAL_KEYS):
        raise ValueError(
            f"{label}: needs exactly the keys {list(MATERIAL_KEYS)}, got {sorted(material)}"
        )
    modulus, ratio, density = (material[key] for key in MATERIAL_KEYS)
    return {
        "youngsModulus": checks.number(modulus, f"{label}: youngsModulus", "Pa", above=0.0),
        "poissonsRatio": checks.number(ratio, f"{label}: poissonsRatio", above=-1.0, below=0.5),
        "density": checks.number(density, f"{label}: density", "kg/m³", above=0.0),
    }


def _inside(value: float, limits: tuple[float, float]) -> bool:
    return limits[0] <= value <= limits[1]


def _guess(density: float) -> str:
    return (
        "mm and tonnes?" if density < 1e-7 else "mm and kg?" if density < 1e-3 else "mixed units?"
    )
