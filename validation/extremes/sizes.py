"""Sizes, units and materials far from those of a steel rotor of half a metre."""

from __future__ import annotations

from functools import cache

import netgen.occ as occ
import ngsolve as ngs
import numpy as np

from exudyn_rotor import Formulation, SolidRotor, Support, campbell, select_modes, stability
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from validation.extremes.rotors import held, two_rings
from validation.extremes.rows import EPS, Row, breaking_point, message

MODES = 6
STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}


def block(scale: float = 1.0) -> ngs.Mesh:
    """Return a mesh of a block of 0.04 × 0.06 × 0.3 m times `scale`, always of the same shape."""
    solid = occ.Box((-0.02, -0.03, 0), (0.02, 0.03, 0.3))
    solid.mat("steel")
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
    netgen_mesh = occ.OCCGeometry(solid).GenerateMesh(maxh=0.05)
    netgen_mesh.Scale(scale)
    return ngs.Mesh(netgen_mesh)


@cache
def block_rotor(length: float, stress: float, density: float) -> ReducedRotor:
    """Return the block with lengths, stresses and densities that are multiples of those in SI."""
    steel = {
        "youngsModulus": stress * STEEL["youngsModulus"],
        "poissonsRatio": 0.3,
        "density": density * STEEL["density"],
    }
    rotor = SolidRotor.from_ngsolve(
        block(length), {"steel": steel}, "z", order=1, check_units=False
    )
    return rotor.center_interfaces().reduce(MODES)


@cache
def dimensionless(length: float, stress: float = 1.0, density: float = 1.0) -> np.ndarray:
    """Return the frequencies of a turning block, in units of ``√(E/ρ) / L``.

    Lengths, stresses and densities are multiples of those in SI. The block turns at a fixed
    dimensionless speed on springs of a fixed dimensionless stiffness.
    """
    reduced = block_rotor(length, stress, density)
    unit = np.sqrt(stress / density) / length
    springs = held(1e8 * stress * length, "left", "right")
    return campbell(reduced, [300.0 * unit], supports=springs).frequencies_rotor[0] / unit


def mismatch(length: float, stress: float = 1.0, density: float = 1.0) -> float:
    """Return the largest relative difference from the block in SI."""
    expected, found = dimensionless(1.0), dimensionless(length, stress, density)
    turning = expected > 0.0  # nothing holds the spin
    return float(np.abs(found[turning] / expected[turning] - 1.0).max())


def lengths(quick: bool = False) -> Row:
    """Scale a block of 0.3 m to 10 µm and to 100 m."""
    scales = (1e-5 / 0.3, 100.0 / 0.3) if quick else np.geomspace(1e-5, 100.0, 8) / 0.3
    found = [mismatch(scale) for scale in scales]
    steel = {"steel": STEEL}
    text = message(lambda: SolidRotor.from_ngsolve(block(100.0 / 0.3), steel, "z", order=1))
    return Row(
        "length of the rotor",
        "10 µm to 100 m",
        "frequencies × length on springs while turning, against those of 0.3 m; limit: 1e-9",
        max(found),
        1e-9,
        "100 m: 5·10⁷ kg" if text else "not reached",
        "input" if text else "",
        text,
    )


def units(quick: bool = False) -> Row:
    """Give everything in mm, t, s and MPa."""
    found = mismatch(1e3, 1e-6, 1e-12)
    steel = {"youngsModulus": 2.1e5, "poissonsRatio": 0.3, "density": 7.85e-9}
    text = message(lambda: SolidRotor.from_ngsolve(block(1e3), {"steel": steel}, "z", order=1))
    return Row(
        "units",
        "mm, t, s with check_units=False",
        "frequencies against SI; limit: 1e-9",
        found if text.startswith("ValueError") else np.inf,
        1e-9,
        "without check_units=False",
        "input",
        text,
    )


def cylinder_modes(poissons_ratio: float, order: int, safety: float = 2.0) -> np.ndarray:
    """Return the flexible frequencies of a free cylinder [rad/s].

    `safety` is the radius over the length of the elements there.
    """
    solid = occ.Cylinder((0, 0, 0), occ.Z, 0.03, 0.3)
    solid.mat("steel")
    mesh = ngs.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.04, curvaturesafety=safety))
    steel = STEEL | {"poissonsRatio": poissons_ratio}
    rotor = SolidRotor.from_ngsolve(mesh, {"steel": steel}, "z", order=order)
    return rotor.reduce(8).frequencies[6:]


def poisson(quick: bool = False) -> Row:
    """Bring Poisson's ratio to 0.4999."""
    safety = 1.5 if quick else 2.0
    reference, near = (cylinder_modes(ratio, 2, safety)[0] for ratio in (0.3, 0.4999))
    linear = [cylinder_modes(ratio, 1, safety)[0] for ratio in (0.3, 0.4999)]
    return Row(
        "Poisson's ratio",
        "0.4999 on quadratic elements",
        "first bending frequency against that at 0.3, both of one Young's modulus; limit: the "
        "share of shear, (r/L)² = 1 %, and the mesh's 1 %",
        abs(near / reference - 1.0),
        0.02,
        f"linear elements lock: {100 * (linear[1] / reference - 1):.0f} % too high at 0.4999, "
        f"{100 * (linear[0] / reference - 1):.0f} % at 0.3",
        "physics",
        "at 0.5: " + message(lambda: cylinder_modes(0.5, 1, safety)),
    )


def far_axis_error(distance: float) -> float:
    """Return the error of frequencies with the spin axis far outside of the body.

    `distance` in radii of the body. Around whatever axis it is carried, a body on isotropic
    springs has the same small motions in the rotor frame.
    """
    try:
        rotors = _carried(0.0), _carried(distance)
    except ValueError:  # rigid motions lost in the rounding of the stiffness
        return np.inf
    near, far = (
        np.sort(np.abs(stability(rotor.reduce(0), [150.0], supports=CARRIER).exponents[0]))
        for rotor in rotors
    )
    count = min(len(near), len(far))  # free motions may stand apart
    return float(np.abs(near[-count:] - far[-count:]).max() / near.max())


def eccentric_error(distance: float) -> float:
    """Return the error of Campbell frequencies at rest against the closed form of a free spin.

    The centre of mass is `distance` radii off the axis, where springs hold a point of the body;
    ``ω² = k/m`` and, across the eccentricity, ``k (1/m + e²/I_p)``.
    """
    rotor, inertia = _carried(distance).center_interfaces(), 2.0 * 0.1**2
    exact = np.sqrt(1e5 * np.array([1.0 / 2.0, 1.0 / 2.0 + (0.1 * distance) ** 2 / inertia]))
    found = campbell(rotor.reduce(0), [0.0], supports=CARRIER).frequencies_rotor[0]
    return float(max(np.abs(found / one - 1.0).min() for one in exact))


CARRIER = [Support("all", np.diag([1e5] * 3), tilt_stiffness=2e3)]


def _carried(distance: float) -> SolidRotor:
    return two_rings(offset=[0.1 * distance, 0.0, 0.0])


def eccentricity(quick: bool = False) -> Row:
    """Move the centre of mass off the axis, and compare the reduced rotor with the full one."""
    found = breaking_point(lambda d: eccentric_error(d) < 0.01, 1e-4, 10.0)
    return Row(
        "eccentric rotor with a free spin, Campbell",
        "eccentricity of 1e-3 radii of gyration",
        "closed form without a drive; limit: the square of the eccentricity, and √eps",
        eccentric_error(1e-3),
        1e-6 + np.sqrt(EPS),
        f"1 % at {found:.2g} radii" if np.isfinite(found) else "not reached",
        "physics" if np.isfinite(found) else "",
        "a warning from an error of 0.1 % on, with the eccentricity and the error to expect",
    )


def far_inertia_error(distance: float) -> float:
    """Return the error of ``Θ = I_p + m d²`` and of ``g = √m d`` for a spin about a far axis."""
    rotor = two_rings(offset=[0.1 * distance, 0.0, 0.0])
    chosen = select_modes(rotor.reduce(0), Formulation("none")).invariants
    exact = 2.0 * 0.1**2 * (1.0 + distance**2)
    coupling = np.sqrt(2.0) * 0.1 * distance
    return float(
        max(abs(chosen.Theta / exact - 1.0), abs(np.linalg.norm(chosen.g) / coupling - 1.0))
    )


def far_axis(quick: bool = False) -> Row:
    """Put the spin axis 1000 sizes of the body outside of it."""
    found = breaking_point(lambda d: far_axis_error(d) < 1e-6, 10.0, 1e9, 1.1)
    text = message(lambda: select_modes(_carried(2.0 * found).reduce(0), Formulation("none")))
    return Row(
        "axis far outside of the body",
        "1000 × the radius",
        "frequencies, Θ = I_p + md², g = √m d; limit: round-off × squared distance, I_p beside md²",
        max(far_axis_error(1e3), far_inertia_error(1e3)),
        EPS * 1e3**2,
        f"{found:.1g} radii: rotations are no longer seen to be free, or frequencies are wrong by "
        "1e-6",
        "numerics",
        f"SolidRotor.summary: rigid motions held; with a free spin {text}",
    )
