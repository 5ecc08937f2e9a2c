"""Published and independently computed rotors: deviation of solid models, and its cause.

Closed forms, a critical-speed table of Nelson and McVaugh (1976), an integration in time, and beam
numbers of the open package ROSS (``benchmarks_ross.json``, by ``benchmarks_ross.py`` beside it).
The solids have rigid discs (``add_disc``), so that solid and reference mean the same discs; what
remains is said in the last column.

    python -m validation benchmarks [--case TEXT]
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from exudyn_rotor import (
    ReducedRotor,
    Support,
    Unbalance,
    campbell,
    critical_speeds,
    unbalance_response,
    unstable_ranges,
)
from validation.references.benchmark_rotors import (
    LATERAL,
    STEEL,
    Jeffcott,
    bearings,
    meshed,
    parametric_growth,
    reduced,
    seal,
    turned_solid,
)
from validation.rows import verdict

REFERENCE = Path(__file__).with_name("benchmarks_ross.json")
ROUND, FLAT = Jeffcott((0.02,), 20.0), Jeffcott((0.024, 0.02), 60.0)
LEVEL = "full"
# what a basis leaves out belongs to the deviation here
GIVEN = {"stiffening": LEVEL, "accuracy": None}


class Row(NamedTuple):
    """One compared number."""

    quantity: str
    reference: float
    ours: float
    cause: str

    @property
    def deviation(self) -> float:
        """Relative deviation."""
        return self.ours / self.reference - 1.0


@cache
def jeffcott(kind: Jeffcott = ROUND, material_damping: float = 0.0) -> ReducedRotor:
    """Return a reduced Jeffcott rotor."""
    return reduced(kind.solid().with_damping(stiffness=material_damping), 4)


def lateral(rotor: ReducedRotor, supports: list[Support], speed: float) -> np.ndarray:
    """Return λ of the lateral modes, by inertial frequency: growth + i frequency."""
    result = campbell(rotor, [speed], supports=supports, **GIVEN)
    chosen = np.isin(result.whirl[0], LATERAL)
    values = result.growth[0, chosen] + 1j * result.frequencies_inertial[0, chosen]
    return values[np.argsort(values.imag)]


def rigid_rotor() -> Iterator[Row]:
    """``I_t ω² ∓ I_p Ω ω − ½ k L² = 0``: tilting of a rigid rotor on two springs k."""
    rotor, k, speed = ROUND.solid().reduce(0, prestress=True), 1e6, 400.0
    shaft = 0.25 * np.pi * ROUND.sides[0] ** 2 * ROUND.length * STEEL["density"]
    polar, transverse = ROUND.inertia
    polar += shaft * ROUND.sides[0] ** 2 / 8.0
    transverse += shaft * (ROUND.sides[0] ** 2 / 16.0 + ROUND.length**2 / 12.0)
    root = np.sqrt((polar * speed) ** 2 + 2.0 * transverse * k * ROUND.length**2)
    found = lateral(rotor, bearings(k), speed).imag
    for name, sign in (("backward", -1.0), ("forward", 1.0)):
        exact = (sign * polar * speed + root) / (2.0 * transverse)
        ours = found[np.argmin(np.abs(found - exact))]
        yield Row(f"conical {name} at {speed:g} rad/s", exact, ours, "volume of the mesh")


def internal_damping() -> Iterator[Row]:
    """``Ω = ω (1 + c_e/c_i)``: unstable above, internal damping c_i = β k, external c_e."""
    rate = 6e-4
    inner = rate * ROUND.stiffness[0]
    for outer in (0.25 * inner, 0.5 * inner):
        exact = ROUND.frequencies[0] * (1.0 + outer / inner)
        supports = [*bearings(), seal(outer)]
        speeds = exact * np.array([0.8, 1.2])
        rotor = jeffcott(ROUND, rate)
        edges = unstable_ranges(rotor, speeds, supports=supports, **GIVEN)
        yield Row(f"threshold, c_e/c_i = {outer / inner:g}", exact, edges[0, 0], MASSLESS)


# meshes of 2 700, 7 400 and 12 300 nodes give the first frequency 0.5 % above √(k/m), then 0.24 %
# and 0.33 % below: the shaft bends as if it were longer by 0.04 diameters at each edge of the disc
MASSLESS = "strain beside the disc (0.04 diameters); mass of the shaft by one shape"


def cross_coupled_seal() -> Iterator[Row]:
    """``q = c ω``: a seal with damping c drives whirl above this cross-coupled stiffness."""
    damping, speed = 40.0, 50.0
    exact = damping * ROUND.frequencies[0]

    def growth(cross: float) -> float:
        first = lateral(jeffcott(), [*bearings(), seal(damping, cross)], speed)[:2]
        return first.real.max()

    yield Row("threshold q", exact, brentq(growth, 0.5 * exact, 2.0 * exact, rtol=1e-8), MASSLESS)


def unbalance_with_seal() -> Iterator[Row]:
    """``|u Ω² / (k − mΩ² + i(cΩ − q))|``: forward whirl by an unbalance u at the seal."""
    damping, cross, amount = 60.0, 2e3, 1e-3
    supports = [*bearings(), seal(damping, cross)]
    speeds = np.array([0.5, 0.9, 1.5, 3.0]) * ROUND.frequencies[0]
    response = unbalance_response(
        jeffcott(), speeds, [Unbalance("disc", amount)], own=False, supports=supports,
        at=["disc"], stiffening=LEVEL,
    )  # fmt: skip
    sizes = np.abs(response.phasor("disc", "n1"))
    for speed, ours in zip(speeds, sizes, strict=True):
        stiff = ROUND.stiffness[0] - ROUND.moving_mass * speed**2
        exact = amount * speed**2 / abs(stiff + 1j * (damping * speed - cross))
        label = f"amplitude at {speed / ROUND.frequencies[0]:.1f} ω"
        cause = MASSLESS if speed != speeds[1] else MASSLESS + "; tenfold near the resonance"
        yield Row(label, exact, ours, cause)


def asymmetric_shaft() -> Iterator[Row]:
    """``√(k_1/m) < Ω < √(k_2/m)``: where a shaft with two stiffnesses is unstable."""
    low, high = np.sort(FLAT.frequencies)
    speeds = [0.8 * low, 0.5 * (low + high), 1.2 * high]
    found = unstable_ranges(jeffcott(FLAT), speeds, supports=bearings(), **GIVEN)
    for name, exact, ours in zip(("from", "to"), (low, high), found[0], strict=True):
        yield Row(f"unstable {name}", exact, ours, MASSLESS)


def asymmetric_on_unequal_bearings() -> Iterator[Row]:
    """Growth of a two-stiffness shaft on unequal bearings: periodic equations, in time."""
    bearing, damping = (4e5, 2e5), 20.0
    supports = [*bearings(bearing), seal(damping)]
    series = 1.0 / (1.0 / FLAT.stiffness.mean() + 0.5 / np.array(bearing))
    middle = float(np.sqrt(series / FLAT.moving_mass).mean())
    # below, inside and above each range: at both critical speeds, and at their mean
    speeds = middle * np.array([0.86, 0.92, 0.96, 0.99, 1.03, 1.08, 1.12])

    def growth(speed: float) -> float:
        return parametric_growth(FLAT, bearing, damping, speed)

    found = unstable_ranges(jeffcott(FLAT), speeds, supports=supports, **GIVEN).ravel()
    for low, high, ours in zip(speeds[:-1], speeds[1:], found, strict=True):
        exact = brentq(growth, low, high, rtol=1e-7)
        yield Row("edge of an unstable range", exact, ours, MASSLESS + "; ends that move")


@cache
def stepped() -> tuple[dict, ReducedRotor]:
    """Return the data of the stepped rotor, and the solid one."""
    data = json.loads(REFERENCE.read_text())
    edges = np.cumsum([0.0, *(length for length, _ in data["steps"])])
    for disc in data["discs"]:
        half = 0.5 * disc["width"]
        edges = np.union1d(edges, [disc["position"] - half, disc["position"] + half])
    edges = np.union1d(np.round(edges, 9), [0.59, 0.61])
    ends = np.cumsum([length for length, _ in data["steps"]])
    radii = [
        0.5 * data["steps"][int(np.searchsorted(ends, z))][1]
        for z in 0.5 * (edges[1:] + edges[:-1])
    ]
    pieces = [(length, 0.0, radius) for length, radius in zip(np.diff(edges), radii, strict=True)]
    rotor = meshed(turned_solid(pieces), 0.03, data["material"]).interface_at("seal", 0.6, 0.02)
    for index, disc in enumerate(data["discs"]):
        inertia = disc["polar"], disc["transverse"]
        rotor = rotor.add_disc(
            disc["position"], disc["mass"], inertia, disc["width"], name=f"disc {index}"
        )
    return data, reduced(rotor)


def ross_bearings(given: dict) -> list[Support]:
    """Return a bearing of the reference at both ends."""
    stiffness, damping = ([[given[f"{x}xx"], 0.0], [0.0, given[f"{x}yy"]]] for x in "kc")
    return [Support(name, stiffness, damping) for name in ("left", "right")]


STEP = "force flow at the steps and edges of discs"


def stepped_rotor() -> Iterator[Row]:
    """Whirl speeds of a stepped shaft with two discs: Timoshenko beams of ROSS."""
    data, rotor = stepped()
    for speed, beam in zip(data["speeds"], data["frequencies"], strict=True):
        found = lateral(rotor, ross_bearings(data["bearing"]), speed).imag
        for index, exact in enumerate(beam):
            yield Row(f"mode {index + 1} at {speed:g} rad/s", exact, found[index], STEP)


def unequal_bearings() -> Iterator[Row]:
    """Decay on unequal damped bearings: the same rotor, ROSS."""
    data, rotor = stepped()
    speed = data["speeds"][2]
    frequencies, growth = data["unequal"][2]
    found = lateral(rotor, ross_bearings(data["unequal bearing"]), speed)
    for index, exact in enumerate(frequencies):
        near = found[np.argmin(np.abs(found.imag - exact))]
        yield Row(f"frequency {index + 1} at {speed:g} rad/s", exact, near.imag, STEP)
        yield Row(f"growth {index + 1}", growth[index], near.real, STEP + ", to the 4th power")


def stepped_with_seal() -> Iterator[Row]:
    """Cross-coupled stiffness that makes the stepped rotor unstable: ROSS."""
    data, rotor = stepped()
    given = data["seal"]
    for speed, exact in zip(data["speeds"][1:3], data["threshold"], strict=True):

        def growth(cross: float, speed: float = speed) -> float:
            leak = seal(given["damping"], cross, given["stiffness"], "seal")
            first = lateral(rotor, [*ross_bearings(data["bearing"]), leak], speed)[:2]
            return first.real.max()

        found = brentq(growth, 0.7 * exact, 1.4 * exact, rtol=1e-7)
        yield Row(f"threshold q at {speed:g} rad/s", exact, found, STEP)


def stepped_unbalance() -> Iterator[Row]:
    """Unbalance of the stepped rotor on unequal bearings with the cross-coupled seal: ROSS."""
    data, rotor = stepped()
    given, speeds = data["seal"], data["response speeds"]
    leak = seal(given["damping"], data["cross"], given["stiffness"], "seal")
    response = unbalance_response(
        rotor, speeds, [Unbalance("disc 0", data["unbalance"])], own=False,
        supports=[*ross_bearings(data["unequal bearing"]), leak], at=["disc 0"], stiffening=LEVEL,
    )  # fmt: skip
    found = np.abs(response.phasor("disc 0", "n1", order=1))
    for speed, exact, ours in zip(speeds, data["response"], found, strict=True):
        yield Row(f"amplitude at {speed:g} rad/s", exact, ours, STEP)


def nelson_mcvaugh() -> Iterator[Row]:
    """Critical speeds of Nelson and McVaugh's rotor: published, and Timoshenko beams of ROSS.

    Also beams whose stiffness lies within cones of 45 degrees at steps, their mass in all of it.
    """
    data = json.loads(REFERENCE.read_text())["nelson mcvaugh"]
    material = {"youngsModulus": 2.078e11, "poissonsRatio": 0.3, "density": 7806.0}
    half = 0.006
    places = np.array(data["places"])
    band = data["disc"]["position"] + half * np.array([-1.0, 1.0])
    edges = np.union1d(places, band)
    within = np.searchsorted(places, 0.5 * (edges[1:] + edges[:-1])) - 1
    radii = (np.array(data[f"{side} radii"])[within] for side in ("inner", "outer"))
    pieces = list(zip(np.diff(edges), *radii, strict=True))
    rotor = meshed(turned_solid(pieces), 0.012, material, 1.0)
    for name, z in zip(("first", "second"), data["bearings"], strict=True):
        rotor = rotor.interface_at(name, z, 2.0 * half)
    disc = data["disc"]
    inertia = disc["polar"], disc["transverse"]
    rotor = rotor.add_disc(disc["position"], disc["mass"], inertia, 2.0 * half, name="disc")
    supports = [Support(name, data["bearing stiffness"]) for name in ("first", "second")]
    found = critical_speeds(reduced(rotor), supports=supports, max_speed=9e3, stiffening=LEVEL)
    kept = found.speeds[np.isin(found.whirl, ("forward", "backward"))] * 30.0 / np.pi
    for index in range(4):
        published, plain, cones = (data[key][index] for key in ("published", "timoshenko", "cones"))
        steps = f"no force flow into corners of steps: {cones / plain - 1.0:.1%} by cones"
        paper = f"{steps}; shear, few coordinates: {plain / published - 1.0:.1%}"
        causes = {
            "published": (published, paper),
            "beams": (plain, steps),
            "beams, cones": (cones, "45 degrees are a rule"),
        }
        for source, (exact, cause) in causes.items():
            near = kept[np.argmin(np.abs(kept - exact))]
            yield Row(f"critical speed {index + 1} [rpm], {source}", exact, near, cause)


CASES: dict[str, Callable[[], Iterator[Row]]] = {
    made.__name__: made
    for made in (
        rigid_rotor,
        internal_damping,
        cross_coupled_seal,
        unbalance_with_seal,
        asymmetric_shaft,
        asymmetric_on_unequal_bearings,
        stepped_rotor,
        unequal_bearings,
        stepped_with_seal,
        stepped_unbalance,
        nelson_mcvaugh,
    )
}


def table(name: str, rows: list[Row]) -> str:
    """Return the rows of a case as text."""
    lines = [f"{name}: {CASES[name].__doc__.splitlines()[0]}"]
    for row in rows:
        lines.append(
            f"  {row.quantity:38}{row.reference:14.7g}{row.ours:14.7g}{row.deviation:11.1e}  "
            f"{row.cause}"
        )
    return "\n".join(lines)


LARGEST = 4e-2  # deviation beside a resonance, where an amplitude follows a frequency


def main() -> int:
    """Print the tables and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", default="", help="only cases with this in their name")
    options = parser.parse_args()
    print(f"beam numbers: {json.loads(REFERENCE.read_text())['source']}")
    print(f"  {'quantity':38}{'reference':>14}{'solid':>14}{'deviation':>11}  cause")
    worst = {}
    for name, made in CASES.items():
        if options.case in name:
            rows = list(made())
            print(table(name, rows), flush=True)
            worst[name] = (max(abs(row.deviation) for row in rows), LARGEST)
    return verdict(worst)
