"""The fixed-axis body against Exudyn's own 3D body, from tilts of 1e-2 rad down to 1e-4 rad.

The story in four parts:

1. Both bodies get the same modes, bearings and initial state. A formulation that is right to
   first order deviates by the square of the tilt or less, so its *relative* deviation falls with
   the tilt. With centrifugal stiffening it does; with the paper's terms alone it stays.
2. The paper's terms make rigid discs and shafts unstable above a certain speed. The 3D body, and
   the fixed-axis body with stiffening, stay where they are.
3. The 3D body's motion depends on where its mode basis puts the floating frame; the fixed-axis
   body moves every basis to the mean motion, so its motion does not.
4. The members of the formulation family are one physics in different coordinates.

Run ``python against_3d.py``, with ``--quick`` for a short version, ``--json FILE`` to keep the
numbers.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from exudyn.FEM import HCBstaticModeSelection
from scenes import (
    ENDS,
    Bearings,
    Model,
    Orbits,
    Start,
    cylinder,
    deviation,
    disc_on_shaft,
    extrapolated,
    fixed_axis_orbits,
    three_d_orbits,
)
from tqdm import tqdm

SPEED = 314.0  # rad/s
SUPPORTS = {
    "isotropic": Bearings((1e6, 1e6, 1e6), 200.0),
    "anisotropic": Bearings((1e6, 2e6, 1e6), 200.0),
}
LEVELS = ("tilt", "none")

Row = dict[str, str | float]


# 1. The deviation falls with the tilt


def start_with_tilt(model: Model, bearings: Bearings, tilt: float) -> Start:
    """Return a spinning start whose tilting impulse swings the rotor to about `tilt` [rad]."""
    _, transverse = model.inertia
    return Start(SPEED, tilt * np.sqrt(bearings.tilt_stiffness(model.rotor) / transverse))


def refined(simulate, step: float, **options) -> tuple[Orbits, Orbits]:
    """Return the motion with half the step, and extrapolated from both steps to zero."""
    coarse, fine = (simulate(step=h, **options) for h in (step, step / 2))
    return fine, extrapolated(coarse, fine)


def compare(
    model: Model, bearings: Bearings, tilt: float, duration: float, step: float, samples: int
) -> list[Row]:
    """Return one row per stiffening level: deviations from the 3D body relative to the motion.

    The step error of the deviation is small although that of either body is not: both use the
    same integrator on motions that are nearly the same.
    """
    common = {
        "model": model,
        "start": start_with_tilt(model, bearings, tilt),
        "bearings": bearings,
        "duration": duration,
        "samples": samples,
    }
    fine, reference = refined(three_d_orbits, step, **common)
    size = reference.excursion
    scale = {"lateral": size["lateral"], "axial": size["lateral"], "rim": size["rim"]}
    own_error = deviation(fine, reference)["lateral"] / size["lateral"]
    rows = []
    for level in LEVELS:
        body_fine, body = refined(fixed_axis_orbits, step, **common, stiffening=level)
        limit, at_step = deviation(body, reference), deviation(body_fine, fine)
        row = {"stiffening": level, "tilt": float(np.abs(reference.tilt).max())}
        row |= {name: limit[name] / scale[name] for name in scale}
        row["step error"] = max(abs(limit[n] - at_step[n]) / scale[n] for n in scale)
        row["3D step error"] = own_error
        rows.append(row)
    return rows


def deviations_by_tilt(
    model: Model, tilts: Sequence[float], duration: float, step: float, samples: int = 400
) -> list[Row]:
    """Return the rows of :func:`compare` for both supports, with the observed orders."""
    rows = []
    cases = [(name, tilt) for name in SUPPORTS for tilt in tilts]
    for name, tilt in tqdm(cases, desc="1. deviation by tilt"):
        found = compare(model, SUPPORTS[name], tilt, duration, step, samples)
        rows += [{"bearings": name} | row for row in found]
    rows.sort(key=lambda row: (row["bearings"] != "isotropic", row["stiffening"] != "tilt"))
    return with_orders(rows, ("lateral", "axial", "rim"))


def with_orders(rows: list[Row], names: Sequence[str]) -> list[Row]:
    """Add ``d log(deviation) / d log(tilt)`` from one row to the next of the same kind."""
    done = []
    for last, row in zip([None, *rows], rows, strict=False):
        same = last is not None and last["stiffening"] == row["stiffening"]
        same = same and last["bearings"] == row["bearings"]
        orders = {
            f"{name} order": float(
                np.log(row[name] / last[name]) / np.log(row["tilt"] / last["tilt"])
            )
            if same
            else np.nan
            for name in names
        }
        done.append(row | orders)
    return done


# 2. The false instability


def false_threshold(polar: float, transverse: float, stiffness: float) -> float:
    """Speed above which the paper's terms make a rigid rotor unstable [rad/s]."""
    return float(np.sqrt(4 * transverse * stiffness / (polar * (2 * transverse - polar))))


def false_growth(polar: float, transverse: float, stiffness: float, speed: float) -> float:
    """Growth rate [1/s] of the paper's equations of a rigid rotor above that speed.

    Rotating frame, complex tilt, ``g = I_t − I_p/2``:
    ``I_t λ² + 2iωg λ + k − ω²g = 0``.
    """
    g = transverse - polar / 2
    roots = np.roots([transverse, 2j * speed * g, stiffness - speed**2 * g])
    return float(roots.real.max())


def measured_growth(orbits: Orbits) -> float:
    """Slope of log|tilt| over the second half of the motion [1/s]."""
    late = orbits.time > orbits.time[-1] / 2
    return float(np.polyfit(orbits.time[late], np.log(np.abs(orbits.tilt[late])), 1)[0])


def instability(
    radius: float, length: float, speed_ratio: float, folds: float = 9.0, steps: int = 6000
) -> Row:
    """Return growth rates and the growth of a tilt that starts at 1e-6 rad.

    `speed_ratio` is the speed over the false threshold, and the motion lasts until the paper's
    tilt should have grown by `folds` powers of e.
    """
    model = Model.of(cylinder(radius, length), 6)
    bearings = Bearings((1e5, 1e5, 1e5))
    polar, transverse = model.inertia
    stiffness = bearings.tilt_stiffness(model.rotor)
    speed = speed_ratio * false_threshold(polar, transverse, stiffness)
    expected = false_growth(polar, transverse, stiffness, speed)
    duration = folds / expected
    start = Start(speed, 1e-6 * np.sqrt(stiffness / transverse))
    common = (model, start, bearings, duration, duration / steps, 600)
    none = fixed_axis_orbits(*common, stiffening="none", constant_speed=True)
    peaks = {
        "none": none,
        "tilt": fixed_axis_orbits(*common, constant_speed=True),
        "tilt, free spin": fixed_axis_orbits(*common),
        "3D": three_d_orbits(*common),
    }
    return {
        "radius/m": radius,
        "I_p/I_t": polar / transverse,
        "speed": speed,
        "expected growth": expected,
        "measured growth": measured_growth(none),
        **{f"peak {name}": float(np.abs(orbits.tilt).max()) for name, orbits in peaks.items()},
    }


def instabilities(ratios: Sequence[float]) -> list[Row]:
    """Return the rows of :func:`instability` for a shaft and a disc."""
    shapes = [(0.05, 0.3), (0.15, 0.1)]
    cases = [(*shape, ratio) for shape in shapes for ratio in ratios]
    return [instability(*case) for case in tqdm(cases, desc="2. false instability")]


# 3. The frame that a mode basis brings along


def craig_bampton_model(model: Model, mode_count: int) -> Model:
    """Give the 3D body Exudyn's own Craig–Bampton modes: the frame is fixed to the first end."""
    nodes, weights = model.fem.GetBoundaryNodeSetsAsLists()
    model.fem.ComputeHurtyCraigBamptonModes(
        boundaryNodesList=nodes,
        nEigenModes=mode_count,
        computationMode=HCBstaticModeSelection.RBE2,
        boundaryNodesWeights=weights,
    )
    return replace(model, reduced=model.rotor.reduce(model.fem))


def basis_effect(tilts: Sequence[float], duration: float, step: float) -> list[Row]:
    """Compare the 3D body in two bases of one space, both with the fixed-axis body."""
    model = craig_bampton_model(Model.of(disc_on_shaft(), 1), 6)
    bearings = SUPPORTS["isotropic"]
    rows = []
    for tilt in tqdm(tilts, desc="3. mode basis"):
        common = {
            "model": model,
            "start": start_with_tilt(model, bearings, tilt),
            "bearings": bearings,
            "duration": duration,
            "samples": 400,
        }
        boundary_modes = dict(model.fem.modeBasis)
        first_end, _ = refined(three_d_orbits, step, **common)
        _, first_end = refined(three_d_orbits, step, **common)
        model.share_modes()
        _, mean = refined(three_d_orbits, step, **common)
        model.fem.modeBasis = boundary_modes
        _, body = refined(fixed_axis_orbits, step, **common)
        size = mean.excursion["lateral"]
        pairs = {
            "3D first-end : 3D mean": (first_end, mean),
            "body : 3D mean": (body, mean),
            "body : 3D first-end": (body, first_end),
        }
        for name, pair in pairs.items():
            found = deviation(*pair)
            rows.append(
                {"pair": name, "tilt": float(np.abs(mean.tilt).max())}
                | {key: found[key] / size for key in ("lateral", "axial")}
            )
    return sorted(rows, key=lambda row: row["pair"])


# 4. The family


def family(model: Model, stiffnesses: Sequence[float], duration: float, step: float) -> list[Row]:
    """Return deviations of the members from 'free' at two steps, relative to the motion."""
    members = {
        "in-plane": {"translation": "in-plane"},
        "none": {"translation": "none"},
        "none, constant speed": {"translation": "none", "constant_speed": True},
    }
    rows = []
    for stiffness in tqdm(stiffnesses, desc="4. family"):
        bearings = Bearings((stiffness,) * 3, 200.0)
        start = start_with_tilt(model, bearings, 1e-3)
        for h in (step, step / 2):
            common = (model, start, bearings, duration, h, 200)
            free = fixed_axis_orbits(*common)
            size = free.excursion["lateral"]
            row = {"bearing stiffness": stiffness, "step": h, "excursion/m": size}
            for name, options in members.items():
                found = deviation(fixed_axis_orbits(*common, **options), free)
                row[name] = found["lateral"] / size
            rows.append(row)
    return rows


def print_table(title: str, rows: list[Row]) -> None:
    """Print rows as aligned columns."""
    names = list(rows[0])
    cells = [names, *([_cell(row[name]) for name in names] for row in rows)]
    widths = [max(len(line[i]) for line in cells) for i in range(len(names))]
    print(f"\n{title}")
    for line in cells:
        print("  ".join(text.rjust(width) for text, width in zip(line, widths, strict=True)))


def _cell(value: str | float) -> str:
    if isinstance(value, str):
        return value
    return "-" if np.isnan(value) else f"{value:.3g}"


def main() -> None:
    """Run all parts and print their tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer cases, shorter motions")
    parser.add_argument("--json", metavar="FILE", help="write the tables to FILE")
    options = parser.parse_args()
    quick = options.quick
    duration, step = (0.02, 2e-5) if quick else (0.08, 2e-5)
    model = Model.of(disc_on_shaft(), 8)
    tables = {
        "1. Deviation from the 3D body, relative to the motion": deviations_by_tilt(
            model, (1e-2, 1e-3, 1e-4), duration, step
        ),
        "2. Tilt started at 1e-6 rad: growth rates [1/s] and largest tilts [rad]": instabilities(
            (1.2,) if quick else (0.9, 1.2, 2.0)
        ),
        "3. The 3D body in two bases of one space: relative deviations": basis_effect(
            (1e-2, 1e-3), duration, step
        ),
        "4. Members of the family against 'free': relative deviations": family(
            model, (1e6, 1e8) if quick else (1e6, 1e7, 1e8), duration, step
        ),
    }
    for title, rows in tables.items():
        print_table(title, rows)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(tables, file, indent=1)


if __name__ == "__main__":
    main()
