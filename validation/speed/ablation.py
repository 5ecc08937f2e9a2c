"""What each ingredient of a scene costs per step, so that a user sees what to leave out.

One rotor on two bearings; every row changes one thing of the row it names.

python -m validation ablation [--json FILE] [--quick]
"""

from __future__ import annotations

import argparse
import json
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import exudyn
from tqdm import tqdm

from exudyn_rotor import (
    PrescribedMotion,
    ReducedRotor,
    RotorBody,
    SolidRotor,
    add_rotor,
    keep_modes,
    recommended_settings,
)
from exudyn_rotor.demo.scene import BEARINGS, STEEL, disc_on_shaft
from validation.speed.scenes import STEP, default_settings, seconds

SPEED = 180.0  # rad/s
KINDS = exudyn.OutputVariableType
MODES, MORE_MODES = 10, (20, 30, 40)
REPEATS = 5


@dataclass(frozen=True)
class Variant:
    """One scene.

    Attributes
    ----------
    options : dict
        For :func:`exudyn_rotor.add_rotor`.
    modes : int
        Flexible modes.
    extra : callable
        Adds sensors and the like to the scene.
    stress, shapes : bool
        What the reduced rotor holds.
    settings : callable
        Solver settings for a number of steps.
    """

    options: dict = field(default_factory=dict)
    modes: int = MODES
    extra: Callable[[RotorBody], object] = lambda body: None
    stress: bool = False
    shapes: bool = True
    settings: Callable[[int], exudyn.SimulationSettings] = lambda steps: recommended_settings(
        steps * STEP, STEP, settings=default_settings(steps)
    )


FREE = {"initial_speed": SPEED, "translation": "free"}
CONSTANT = {"spin": SPEED, "translation": "none"}
GRAVITY = {"gravity": [0.0, 0.0, -9.81]}
RIGID = {"markers": "rigid"}


def full_newton(steps: int) -> exudyn.SimulationSettings:
    """Return the recommended settings, but with a new Jacobian in every iteration."""
    settings = Variant().settings(steps)
    settings.timeIntegration.newton.useModifiedNewton = False
    return settings


def _node_sensor(kind: exudyn.OutputVariableType) -> Callable[[RotorBody], object]:
    def add(body: RotorBody) -> object:
        with warnings.catch_warnings():  # what it costs is the same without the static stress
            warnings.filterwarnings("ignore", message=".*stress of the modes alone")
            return body.add_node_sensor(0, kind)

    return add


VARIANTS: dict[tuple[str, str], tuple[Variant, Variant]] = {
    ("constant speed, translation none", "translation free"): (
        Variant(CONSTANT),
        Variant(CONSTANT | {"translation": "free"}),
    ),
    ("constant speed, translation none", "θ(t) prescribed, not constant"): (
        Variant(CONSTANT),
        Variant(CONSTANT | {"spin": PrescribedMotion.run_up(SPEED, 1.1 * SPEED, 1.0)}),
    ),
    ("constant speed, translation none", "free spin"): (
        Variant(CONSTANT),
        Variant({"initial_speed": SPEED, "translation": "none"}),
    ),
    ("free spin, translation free", "translation in-plane"): (
        Variant(FREE),
        Variant(FREE | {"translation": "in-plane"}),
    ),
    ("free spin, translation free", "translation none"): (
        Variant(FREE),
        Variant(FREE | {"translation": "none"}),
    ),
    ("free spin, translation free", "gravity"): (Variant(FREE), Variant(FREE | GRAVITY)),
    ("free spin, translation none", "gravity"): (
        Variant(FREE | {"translation": "none"}),
        Variant(FREE | GRAVITY | {"translation": "none"}),
    ),
    ("constant speed, translation none", "gravity"): (
        Variant(CONSTANT),
        Variant(CONSTANT | GRAVITY),
    ),
    ("constant speed, translation none", "rigid bearing markers instead of position"): (
        Variant(CONSTANT),
        Variant(CONSTANT | RIGID),
    ),
    ("constant speed, translation none", "sensor at an interface"): (
        Variant(CONSTANT),
        Variant(
            CONSTANT,
            extra=lambda body: body.add_interface_sensor("left", KINDS.Displacement),
        ),
    ),
    ("constant speed, translation none", "sensor at a mesh node"): (
        Variant(CONSTANT),
        Variant(CONSTANT, extra=_node_sensor(KINDS.Displacement)),
    ),
    ("constant speed, translation none", "stress modes, no sensor"): (
        Variant(CONSTANT),
        Variant(CONSTANT, stress=True),
    ),
    ("constant speed, translation none", "stress modes and a stress sensor"): (
        Variant(CONSTANT),
        Variant(CONSTANT, stress=True, extra=_node_sensor(KINDS.StressLocal)),
    ),
    ("constant speed, translation none", "no drawing data (without_shapes)"): (
        Variant(CONSTANT),
        Variant(CONSTANT, shapes=False),
    ),
    ("constant speed, translation none", "sensor of the drive torque (Python)"): (
        Variant(CONSTANT),
        Variant(CONSTANT, extra=lambda body: body.add_drive_torque_sensor()),
    ),
    ("free spin, translation free", "stiffening none instead of tilt"): (
        Variant(FREE),
        Variant(FREE | {"stiffening": "none"}),
    ),
    ("free spin, translation free", "stiffening full instead of tilt"): (
        Variant(FREE),
        Variant(FREE | {"stiffening": "full"}),
    ),
    ("free spin, translation free", "Exudyn's default tolerances"): (
        Variant(FREE),
        Variant(FREE, settings=default_settings),
    ),
    ("free spin, translation free", "full Newton"): (
        Variant(FREE),
        Variant(FREE, settings=full_newton),
    ),
    **{
        (base, f"{count} modes instead of {count - 10}"): (
            Variant(options, count - 10),
            Variant(options, count),
        )
        for count in MORE_MODES
        for base, options in (
            ("constant speed, translation none", CONSTANT),
            ("free spin, translation free", FREE),
        )
    },
}


class Rotors:
    """Reduced rotors of one mesh: the lowest of the same modes.

    `safety` is the radius of the curves over the length of the elements there.
    """

    def __init__(self, element_size: float, safety: float = 2.0) -> None:
        mesh = disc_on_shaft(element_size, safety)
        rotor = SolidRotor.from_ngsolve(mesh, STEEL, axis="x").center_interfaces()
        rotor = rotor.add_point_mass([0.05, 0.0, 0.12], 0.008)
        self._most = rotor.reduce(max(MORE_MODES), prestress=True)
        self._with_stress = rotor.reduce(MODES, stress=True, prestress=True)

    def get(self, variant: Variant) -> ReducedRotor:
        """Return the rotor with the variant's modes."""
        if variant.stress:
            reduced = self._with_stress
        else:
            reduced = keep_modes(self._most, range(variant.modes))
        return reduced if variant.shapes else reduced.without_shapes()


def cost(rotors: Rotors, variant: Variant, steps: int) -> float:
    """Return the time of one step [µs]."""
    mbs = exudyn.SystemContainer().AddSystem()
    options = {"markers": "position"} | variant.options
    body = add_rotor(mbs, rotors.get(variant), **options)
    ground = mbs.CreateGround()
    for interface, x in BEARINGS.items():
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(interface)],
            localPosition0=[x, 0, 0],
            stiffness=[2e6, 1.2e6, 1.6e6],
            damping=[200.0, 200.0, 200.0],
        )
    variant.extra(body)
    mbs.Assemble()
    settings = variant.settings(steps)
    settings.solution.sensors.writePeriod = STEP
    return 1e6 * seconds(mbs, settings) / steps


def measure(rotors: Rotors, steps: int) -> list[dict]:
    """Return one row per variant; both scenes of a row are run in turn, the shortest counts."""
    rows = []
    for (base, change), pair in tqdm(VARIANTS.items(), unit="row"):
        runs = [[cost(rotors, variant, steps) for variant in pair] for _ in range(REPEATS)]
        before, after = (min(values) for values in zip(*runs, strict=True))
        rows.append({"scene": base, "change": change, "before": before, "after": after})
    return rows


def main(argv: list[str] | None = None) -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    parser.add_argument("--quick", action="store_true", help="a coarse mesh and few steps")
    options = parser.parse_args(argv)
    steps = 300 if options.quick else 3000
    rows = measure(Rotors(0.05 if options.quick else 0.0145), steps)
    print(f"{'scene':34}{'change':44}{'µs/step':>9}{'change':>9}{'ratio':>7}")
    for row in rows:
        difference, ratio = row["after"] - row["before"], row["after"] / row["before"]
        print(
            f"{row['scene']:34}{row['change']:44}{row['after']:9.1f}{difference:+9.1f}{ratio:7.2f}"
        )
    if options.json:
        options.json.write_text(json.dumps({"steps": steps, "rows": rows}, indent=1) + "\n")
