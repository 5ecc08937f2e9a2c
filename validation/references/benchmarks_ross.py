"""Reference numbers of a stepped rotor with two discs and a seal, computed by the package ROSS.

Run it in an environment with ``ross-rotordynamics`` (not needed by anything else here); it writes
``benchmarks_ross.json``, which the benchmarks read:

    python validation/references/benchmarks_ross.py

A steel shaft with two steps in diameter, Timoshenko elements with rotatory inertia and gyroscopics.
The discs are rigid, and so is the shaft inside them. Bearings are at both ends, a seal is in the
middle; its cross-coupled stiffness q drives forward whirl.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import ross
import scipy.linalg as la

YOUNG, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
ELEMENT = 0.02
STEPS = [[0.3, 0.04], [0.6, 0.05], [0.3, 0.04]]  # length, diameter
DISCS = [
    {"position": 0.42, "width": 0.04, "mass": 12.0, "polar": 0.09, "transverse": 0.05},
    {"position": 0.78, "width": 0.04, "mass": 8.0, "polar": 0.05, "transverse": 0.03},
]
BEARING = {"kxx": 2e7, "kyy": 2e7, "cxx": 0.0, "cyy": 0.0}
UNEQUAL = {"kxx": 2e7, "kyy": 1e7, "cxx": 3e3, "cyy": 2e3}
SEAL = {"stiffness": 1e5, "damping": 400.0}
UNBALANCE = 1e-4  # kg m, on the first disc
SPEEDS = [0.0, 200.0, 400.0, 600.0]
RESPONSE_SPEEDS = [80.0, 120.0, 200.0, 300.0, 400.0]
MODES = 6
# H. D. Nelson, J. M. McVaugh, "The dynamics of rotor-bearing systems using finite elements", ASME
# J. Eng. Ind. 98 (1976) 593–600: rotor, and critical speeds on isotropic bearings; the paper has
# Rayleigh beams (no shear) and reduced its coordinates
NELSON_MCVAUGH = {
    "places": [
        0.0, 0.0127, 0.0508, 0.0762, 0.0889, 0.1016, 0.1067, 0.1143, 0.127, 0.1346,
        0.1651, 0.1905, 0.2286, 0.2667, 0.287, 0.3048, 0.315, 0.3454, 0.3581,
    ],
    "inner radii": [
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0152, 0.0178, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
        0.0152,
    ],
    "outer radii": [
        0.0051, 0.0102, 0.0076, 0.0203, 0.0203, 0.033, 0.033, 0.0254, 0.0254, 0.0127, 0.0127,
        0.0152, 0.0152, 0.0127, 0.0127, 0.0381, 0.0203, 0.0203,
    ],
    "disc": {"position": 0.0889, "mass": 1.401, "polar": 0.00203, "transverse": 0.00136},
    "bearings": [0.1651, 0.287],
    "bearing stiffness": 4.378e7,
    "published": [15470.0, 17159.0, 46612.0, 49983.0, 64752.0, 96457.0],
}  # fmt: skip


def steel(stiffening: float = 1.0) -> ross.Material:
    """Return steel, its moduli multiplied by a factor."""
    young = stiffening * YOUNG
    return ross.Material(name="steel", rho=DENSITY, E=young, G_s=young / (2.0 * (1.0 + POISSON)))


def rotor(bearing: dict, cross: float | None = None) -> ross.Rotor:
    """Return the rotor, with the seal where a cross-coupled stiffness is given."""
    elements = []
    for length, diameter in STEPS:
        for _ in range(round(length / ELEMENT)):
            middle = (len(elements) + 0.5) * ELEMENT
            inside = any(abs(middle - d["position"]) < 0.5 * d["width"] for d in DISCS)
            options = {"shear_effects": True, "rotary_inertia": True, "gyroscopic": True}
            material = steel(1e3 if inside else 1.0)
            elements.append(
                ross.ShaftElement(L=ELEMENT, idl=0.0, odl=diameter, material=material, **options)
            )
    discs = [
        ross.DiskElement(
            n=round(d["position"] / ELEMENT), m=d["mass"], Id=d["transverse"], Ip=d["polar"]
        )
        for d in DISCS
    ]
    supports = [ross.BearingElement(n=node, **bearing) for node in (0, len(elements))]
    if cross is not None:
        k, c = SEAL["stiffness"], SEAL["damping"]
        supports.append(
            ross.BearingElement(
                n=len(elements) // 2, kxx=k, kyy=k, kxy=cross, kyx=-cross, cxx=c, cyy=c
            )
        )
    return ross.Rotor(elements, discs, supports)


def matrices(made: ross.Rotor, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return M, damping with gyroscopics, and K of the lateral coordinates."""
    count = made.number_dof
    lateral = [count * node + i for node in range(len(made.nodes)) for i in (0, 1, 3, 4)]
    cut = np.ix_(lateral, lateral)
    damping = made.C(speed) + made.G() * speed
    return made.M(speed)[cut], damping[cut], made.K(speed)[cut]


def lateral(made: ross.Rotor, speed: float) -> tuple[list[float], list[float]]:
    """Return the lowest lateral frequencies [rad/s] and their growth [1/s]."""
    M, D, K = matrices(made, speed)
    zero, one = np.zeros_like(M), np.eye(len(M))
    values = la.eigvals(np.block([[zero, one], [-la.solve(M, K), -la.solve(M, D)]]))
    values = values[values.imag > 1.0]
    values = values[np.argsort(values.imag)][:MODES]
    return values.imag.tolist(), values.real.tolist()


def threshold(speed: float) -> float:
    """Return the cross-coupled stiffness at which a whirl starts to grow [N/m]."""
    low, high = 0.0, 1e7
    for _ in range(24):
        middle = 0.5 * (low + high)
        if max(lateral(rotor(BEARING, middle), speed)[1]) > 0.0:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def response(made: ross.Rotor) -> list[float]:
    """Return the amplitudes of an unbalance at the first disc along x [m]."""
    row = 4 * round(DISCS[0]["position"] / ELEMENT)
    sizes = []
    for speed in RESPONSE_SPEEDS:
        M, D, K = matrices(made, speed)
        load = np.zeros(len(M), dtype=complex)
        load[row : row + 2] = UNBALANCE * speed**2 * np.array([1.0, -1.0j])
        sizes.append(float(abs(la.solve(K - speed**2 * M + 1j * speed * D, load)[row])))
    return sizes


def cones(
    places: np.ndarray, inner: np.ndarray, outer: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return radii that carry load where force flows around steps along cones of 45 degrees.

    ``min (R(z') + |z - z'|)`` over all places, and the same inside a bore.
    """
    middles = 0.5 * (places[1:] + places[:-1])
    away = np.abs(middles[:, None] - np.clip(middles[:, None], places[:-1], places[1:]))
    return np.max(inner - away, axis=1), np.min(outer + away, axis=1)


def stepped(places: np.ndarray, inner: np.ndarray, outer: np.ndarray, shear: bool) -> ross.Rotor:
    """Return Nelson and McVaugh's rotor with an element between every two places."""
    data = NELSON_MCVAUGH
    material = ross.Material(name="steel", rho=7806.0, E=2.078e11, G_s=2.078e11 / 2.6)
    elements = [
        ross.ShaftElement(
            L=length, idl=2.0 * low, odl=2.0 * high, material=material,
            shear_effects=shear, rotary_inertia=True, gyroscopic=True,
        )
        for length, low, high in zip(np.diff(places), inner, outer, strict=True)
    ]  # fmt: skip

    def node(place: float) -> int:
        return int(np.argmin(np.abs(places - place)))

    disc = data["disc"]
    inertia = {"m": disc["mass"], "Id": disc["transverse"], "Ip": disc["polar"]}
    discs = [ross.DiskElement(n=node(disc["position"]), **inertia)]
    bearings = [
        ross.BearingElement(n=node(z), kxx=data["bearing stiffness"], cxx=0.0)
        for z in data["bearings"]
    ]
    return ross.Rotor(elements, discs, bearings)


def nelson_mcvaugh(shear: bool, pieces: int = 2, around_steps: bool = False) -> list[float]:
    """Return the six lowest critical speeds of the rotor below [rpm], ascending.

    With `pieces` elements to a section; `around_steps` gives stiffness to the material within
    cones of 45 degrees alone, and mass to all.
    """
    data = NELSON_MCVAUGH
    sections = np.array(data["places"])
    shares = np.arange(pieces) / pieces
    places = np.append(
        (sections[:-1, None] + np.diff(sections)[:, None] * shares).ravel(), sections[-1]
    )
    radii = [np.repeat(data[f"{side} radii"], pieces) for side in ("inner", "outer")]
    M, G, K = matrices(stepped(places, *radii, shear), 1.0)
    if around_steps:
        K = matrices(stepped(places, *cones(places, *radii), shear), 1.0)[2]
    # whirl at the speed itself: K x = ω² (M − iG) x, forward and backward by conjugation
    found = 1.0 / la.eigvals(la.solve(K, M - 1j * G)).real
    return (np.sqrt(np.sort(found[found > 0.0])[:6]) * 30.0 / np.pi).tolist()


def main() -> None:
    """Write the reference file."""
    plain, unequal = rotor(BEARING), rotor(UNEQUAL)
    script = "validation/references/benchmarks_ross.py"
    data = {
        "source": f"ross-rotordynamics {ross.__version__}, {script}",
        "material": {"youngsModulus": YOUNG, "poissonsRatio": POISSON, "density": DENSITY},
        "steps": STEPS,
        "discs": DISCS,
        "bearing": BEARING,
        "unequal bearing": UNEQUAL,
        "seal": SEAL,
        "unbalance": UNBALANCE,
        "speeds": SPEEDS,
        "frequencies": [lateral(plain, speed)[0] for speed in SPEEDS],
        "unequal": [lateral(unequal, speed) for speed in SPEEDS],
        "threshold": [threshold(speed) for speed in SPEEDS[1:3]],
        "response speeds": RESPONSE_SPEEDS,
        "cross": 1.5e5,
        "response": response(rotor(UNEQUAL, 1.5e5)),
    }
    beams = {
        "rayleigh": nelson_mcvaugh(False),
        "timoshenko": nelson_mcvaugh(True),
        "cones": nelson_mcvaugh(True, 16, around_steps=True),
    }
    data["nelson mcvaugh"] = {**NELSON_MCVAUGH, **beams}
    target = Path(__file__).with_suffix(".json")
    target.write_text(json.dumps(data, indent=1) + "\n")
    print(target.read_text())


if __name__ == "__main__":
    main()
