"""Reference numbers of a dual spool and of geared rotors, by the package ROSS.

Run it in an environment with ``ross-rotordynamics`` (not needed by anything else here); it writes
``rotor_trains_ross.json``, which the tests read:

    python validation/references/rotor_trains_ross.py

Steel shafts of Timoshenko elements with rotatory inertia and gyroscopics; discs are rigid, and so
is the shaft inside them. The spools are hollow about solid, with a bearing between them; ROSS gives
the matrices of each, and here their gyroscopic matrices are multiplied by speeds of their own. The
same spools side by side are geared by ROSS's ``MultiRotor`` with spur gears: with a helix its
direction of the mesh has ``sin α sin β`` along the axis, and is not of unit length.

A published dual spool is beside them: M. I. Friswell, J. E. T. Penny, S. D. Garvey, A. W. Lees,
Dynamics of Rotating Machines, Cambridge 2010, Example 6.6.1. Its data are those of
``examples/chapter06/example_06_06_01.py`` in github.com/alegrettiLeonardo/RotorStudio (34caca6),
which repeats the book's script; results are ROSS's, one element from station to station as there.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import ross
import scipy.linalg as la

YOUNG, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
ELEMENT = 0.02
RATIOS = [1.5, -1.3]  # of the outer spool
SPEEDS = [0.0, 300.0, 700.0]  # of the inner one
MODES, GEARED_MODES = 8, 12
SPOOLS = {
    "inner": {
        "start": 0.0, "length": 0.8, "bore": 0.0, "diameter": 0.04,
        "discs": [
            {"position": 0.1, "width": 0.04, "mass": 8.0, "polar": 0.06, "transverse": 0.032},
            {"position": 0.7, "width": 0.04, "mass": 6.0, "polar": 0.04, "transverse": 0.022},
        ],
    },
    "outer": {
        "start": 0.24, "length": 0.36, "bore": 0.06, "diameter": 0.08,
        "discs": [
            {"position": 0.32, "width": 0.04, "mass": 5.0, "polar": 0.04, "transverse": 0.022},
            {"position": 0.52, "width": 0.04, "mass": 5.0, "polar": 0.04, "transverse": 0.022},
        ],
    },
}  # fmt: skip
# from position to position along z; the last is between the spools
SPRINGS = [("inner", 0.0, 2e7), ("inner", 0.8, 1e7), ("outer", 0.24, 1.5e7)]
BETWEEN = {"position": 0.6, "stiffness": 2e7, "damping": 800.0}
GEARS = {
    "teeth": [20, 30], "base_radii": [0.06, 0.09], "pressure_angle": 0.38, "line_angle": 0.3,
    "stiffness": 1e8, "position": 0.6,
    # position along z, stiffness and damping across the axis, stiffness along it
    "bearings": {
        "inner": [(0.0, 2e7, 200.0, 2e7), (0.8, 1e7, 200.0, 0.0)],
        "outer": [(0.24, 2e7, 200.0, 2e7), (0.6, 3e7, 200.0, 0.0)],
    },
}  # fmt: skip

PUBLISHED = {
    "material": {"youngsModulus": 2.07e11, "poissonsRatio": 0.3, "density": 8300.0},
    "ratios": {"inner": 1.0, "outer": 1.5},
    # discs: station, mass, transverse and polar moment; bearings: station, k and c along x and y
    "rotors": {
        "inner": {
            "stations": [0.0, 0.076, 0.159, 0.254, 0.324, 0.406, 0.457, 0.508],
            "bore": 0.0, "diameter": 0.03,
            "discs": [[1, 10.5, 0.043, 0.086], [6, 7.0, 0.034, 0.068]],
            "bearings": [[0, 26e6, 52e6, 20.0, 20.0], [7, 18e6, 36e6, 20.0, 20.0]],
        },
        "outer": {
            "stations": [0.152, 0.203, 0.279, 0.356, 0.406], "bore": 0.05, "diameter": 0.06,
            "discs": [[1, 7.0, 0.021, 0.042], [3, 3.5, 0.013, 0.026]],
            "bearings": [[0, 18e6, 36e6, 20.0, 20.0]],
        },
    },
    "between": {"inner": 5, "outer": 4, "stiffness": 9e6, "damping": 20.0},
    "rpm": [0.0, 3000.0, 9000.0, 15000.0],  # of the inner one
}  # fmt: skip

AXIAL = 1e7  # of the bearings at station 0 of the published rotors, where they are geared


def shaft(length: float, bore: float, diameter: float, discs: list[dict], start: float) -> list:
    """Return elements, those inside discs stiffened."""
    elements = []
    for index in range(round(length / ELEMENT)):
        middle = start + (index + 0.5) * ELEMENT
        inside = any(abs(middle - d["position"]) < 0.5 * d["width"] for d in discs)
        young = (1e3 if inside else 1.0) * YOUNG
        material = ross.Material(
            name="steel", rho=DENSITY, E=young, G_s=young / (2.0 * (1.0 + POISSON))
        )
        elements.append(
            ross.ShaftElement(
                L=ELEMENT, idl=bore, odl=diameter, material=material,
                shear_effects=True, rotary_inertia=True, gyroscopic=True,
            )
        )  # fmt: skip
    return elements


def parts(data: dict) -> tuple[list, list]:
    """Return elements and discs of a spool."""
    names = ("length", "bore", "diameter", "discs", "start")
    elements = shaft(*(data[name] for name in names))
    discs = [
        ross.DiskElement(
            n=node(data, d["position"]), m=d["mass"], Id=d["transverse"], Ip=d["polar"]
        )
        for d in data["discs"]
    ]
    return elements, discs


def spool(data: dict) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return M, G per speed and K of the lateral coordinates of one spool without bearings."""
    made = ross.Rotor(*parts(data), [ross.BearingElement(n=0, kxx=0.0, cxx=0.0)])
    count = made.number_dof
    lateral = [count * n + i for n in range(len(made.nodes)) for i in (0, 1, 3, 4)]
    cut = np.ix_(lateral, lateral)
    return made.M(0.0)[cut], made.G()[cut], made.K(0.0)[cut]


def node(data: dict, position: float) -> int:
    """Return the node of a spool at a position."""
    return round((position - data["start"]) / ELEMENT)


def dual(ratio: float, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return M, damping with gyroscopics, and K of both spools."""
    each = [spool(data) for data in SPOOLS.values()]
    rates = [speed, ratio * speed]
    M = la.block_diag(*(one[0] for one in each))
    D = la.block_diag(*(rate * one[1] for rate, one in zip(rates, each, strict=True)))
    K = la.block_diag(*(one[2] for one in each))
    first = {"inner": 0, "outer": len(each[0][0])}

    def row(name: str, position: float) -> int:
        return first[name] + 4 * node(SPOOLS[name], position)

    for name, position, stiffness in SPRINGS:
        for i in range(2):
            K[row(name, position) + i, row(name, position) + i] += stiffness
    for i in range(2):
        ends = [row(name, BETWEEN["position"]) + i for name in SPOOLS]
        between = np.array([[1.0, -1.0], [-1.0, 1.0]])
        K[np.ix_(ends, ends)] += BETWEEN["stiffness"] * between
        D[np.ix_(ends, ends)] += BETWEEN["damping"] * between
    return M, D, K


def exponents(
    M: np.ndarray, D: np.ndarray, K: np.ndarray, count: int = MODES
) -> dict[str, list[float]]:
    """Return the lowest frequencies [rad/s] and their growth [1/s]."""
    zero, one = np.zeros_like(M), np.eye(len(M))
    values = la.eigvals(np.block([[zero, one], [-la.solve(M, K), -la.solve(M, D)]]))
    values = values[values.imag > 1.0]
    values = values[np.argsort(values.imag)][:count]
    return {"frequencies": values.imag.tolist(), "growth": values.real.tolist()}


def critical(ratio: float, order: float) -> list[float]:
    """Return the undamped speeds [rad/s] of the inner spool that an order of it excites forward.

    ``(K − Ω²(p²M + p i G′)) x = 0`` with the gyroscopic matrix G′ per speed, for x e^{ipΩt}.
    """
    M, D, K = dual(ratio, 1.0)
    G = 0.5 * (D - D.T)
    values, vectors = la.eig(K, order**2 * M - 1j * order * G)
    found = []
    for value, x in zip(values, vectors.T, strict=True):
        circling = np.sum(np.imag(np.conj(x[0::4]) * x[1::4]))  # < 0 for x = (1, −i): forward
        if (
            value.real > 0.0
            and abs(value.imag) < 1e-6 * value.real
            and np.sign(order) * circling < 0
        ):
            found.append(float(np.sqrt(value.real)))
    return sorted(found)[:4]


def geared() -> ross.MultiRotor:
    """Return the spools side by side."""
    given = []
    for name, data in SPOOLS.items():
        bearings = [
            ross.BearingElement(n=node(data, z), kxx=k, cxx=c, kzz=along)
            for z, k, c, along in GEARS["bearings"][name]
        ]
        given.append((*parts(data), bearings, node(data, GEARS["position"])))
    return meshing(given)


def meshing(given: list[tuple[list, list, list, int]]) -> ross.MultiRotor:
    """Return two rotors of elements, discs and bearings, with gears that weigh nothing."""
    rotors = []
    for index, (elements, discs, bearings, at) in enumerate(given):
        gear = ross.GearElement(
            n=at, m=1e-9, Id=1e-12, Ip=1e-12, n_teeth=GEARS["teeth"][index],
            base_diameter=2.0 * GEARS["base_radii"][index], pr_angle=GEARS["pressure_angle"],
        )  # fmt: skip
        rotors.append(ross.Rotor(elements, [*discs, gear], bearings))
    return ross.MultiRotor(
        *rotors, coupled_nodes=tuple(one[3] for one in given),
        gear_mesh_stiffness=GEARS["stiffness"], orientation_angle=GEARS["line_angle"],
    )  # fmt: skip


def of_pair(pair: ross.MultiRotor, speed: float) -> dict[str, list[float]]:
    """Return the lowest exponents of geared rotors."""
    return exponents(pair.M(), pair.C(speed) + speed * pair.G(), pair.K(speed), GEARED_MODES)


def geared_results() -> dict:
    """Return the coupling matrix, and modes with the gears meshing and apart."""
    pair = geared()
    gears = [*pair.mesh.driving_gear.dof_global_index.values()]
    gears += pair.mesh.driven_gear.dof_global_index.values()
    coupling, apart = pair.coupling_matrix(), []
    for speed in SPEEDS:
        M, D, K = pair.M(), pair.C(speed) + speed * pair.G(), pair.K(speed)
        K[np.ix_(gears, gears)] -= pair.mesh.stiffness * coupling
        apart.append(exponents(M, D, K, GEARED_MODES))
    M, K = pair.M(), pair.K(0.0)
    squares, shapes = la.eigh(K, M)
    shapes = shapes[gears][:, squares > 1.0][:, :GEARED_MODES]
    return {
        **GEARS,
        "meshing": [of_pair(pair, speed) for speed in SPEEDS],
        "apart": apart,
        "coupling": coupling.tolist(),
        "shapes": shapes.T.tolist(),
    }


def published_parts() -> dict[str, tuple[list, list, list]]:
    """Return elements, discs and bearings of the published rotors."""
    data = PUBLISHED["material"]
    young, poisson = data["youngsModulus"], data["poissonsRatio"]
    material = ross.Material(
        name="published", rho=data["density"], E=young, G_s=young / (2.0 * (1.0 + poisson))
    )
    made = {}
    for name, one in PUBLISHED["rotors"].items():
        size = {"idl": one["bore"], "odl": one["diameter"], "material": material}
        elements = [ross.ShaftElement(L=length, **size) for length in np.diff(one["stations"])]
        discs = [ross.DiskElement(n=n, m=m, Id=Id, Ip=Ip) for n, m, Id, Ip in one["discs"]]
        bearings = [
            ross.BearingElement(n=n, kxx=kx, kyy=ky, cxx=cx, cyy=cy, kzz=AXIAL if n == 0 else 0.0)
            for n, kx, ky, cx, cy in one["bearings"]
        ]
        made[name] = elements, discs, bearings
    return made


def published(speed: float) -> dict[str, list[float]]:
    """Return the lowest exponents of the published dual spool at a speed of the inner one."""
    blocks, first = [], {}
    for name, given in published_parts().items():
        made = ross.Rotor(*given)
        first[name] = sum(len(block[0]) for block in blocks)
        lateral = [made.number_dof * n + i for n in range(len(made.nodes)) for i in (0, 1, 3, 4)]
        cut, rate = np.ix_(lateral, lateral), PUBLISHED["ratios"][name] * speed
        damping = made.C(speed) + rate * made.G()
        blocks.append((made.M(speed)[cut], damping[cut], made.K(speed)[cut]))
    M, D, K = (la.block_diag(*each) for each in zip(*blocks, strict=True))
    between, pair = PUBLISHED["between"], np.array([[1.0, -1.0], [-1.0, 1.0]])
    for i in range(2):
        ends = [first[name] + 4 * between[name] + i for name in first]
        K[np.ix_(ends, ends)] += between["stiffness"] * pair
        D[np.ix_(ends, ends)] += between["damping"] * pair
    return exponents(M, D, K)


def published_geared() -> list[dict[str, list[float]]]:
    """Return exponents of the published rotors side by side, geared where the bearing was."""
    at = PUBLISHED["between"]
    pair = meshing([(*given, at[name]) for name, given in published_parts().items()])
    return [of_pair(pair, np.pi / 30.0 * rpm) for rpm in PUBLISHED["rpm"]]


def main() -> None:
    """Write the reference file."""
    data = {
        "source": f"ross-rotordynamics {ross.__version__}, "
        "validation/references/rotor_trains_ross.py",
        "material": {"youngsModulus": YOUNG, "poissonsRatio": POISSON, "density": DENSITY},
        "spools": SPOOLS,
        "springs": SPRINGS,
        "between": BETWEEN,
        "speeds": SPEEDS,
        "dual": {
            str(ratio): [exponents(*dual(ratio, speed)) for speed in SPEEDS] for ratio in RATIOS
        },
        "critical": {"inner": critical(1.5, 1.0), "outer": critical(1.5, 1.5)},
        "geared": geared_results(),
        "published": {
            **PUBLISHED,
            "axial": AXIAL,
            "geared": published_geared(),
            "exponents": [published(np.pi / 30.0 * rpm) for rpm in PUBLISHED["rpm"]],
        },
    }
    target = Path(__file__).with_suffix(".json")
    target.write_text(json.dumps(data, indent=1) + "\n")
    print(target.read_text())


if __name__ == "__main__":
    main()
