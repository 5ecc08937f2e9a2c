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

Run ``python -m validation against_3d``, with ``--quick`` for a short version.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from exudyn.FEM import HCBstaticModeSelection
from tqdm import tqdm

from validation.exudyn_3d.scenes import (
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
from validation.rows import Row, print_rows, verdict

SPEED = 314.0  # rad/s
SUPPORTS = {
    "isotropic": Bearings((1e6, 1e6, 1e6), 200.0),
    "anisotropic": Bearings((1e6, 2e6, 1e6), 200.0),
}
LEVELS = ("tilt", "none")


# 1. The deviation falls with the tilt


def start_with_tilt(model: Model, bearings: Bearings, tilt: float, speed: float = SPEED) -> Start:
    """Return a spinning start whose tilting impulse swings the rotor to about `tilt` [rad]."""
    _, transverse = model.inertia
    return Start(speed, tilt * np.sqrt(bearings.tilt_stiffness(model.rotor) / transverse))


def refined(simulate, step: float, **options) -> tuple[Orbits, Orbits]:
    """Return the motion with half the step, and extrapolated from both steps to zero."""
    coarse, fine = (simulate(step=h, **options) for h in (step, step / 2))
    return fine, extrapolated(coarse, fine)


def compare(
    model: Model,
    bearings: Bearings,
    tilt: float,
    duration: float,
    step: float,
    samples: int,
    levels: Sequence[str] = LEVELS,
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
    scale = dict.fromkeys(("lateral", "radius", "axial"), size["lateral"]) | {"rim": size["rim"]}
    own_error = deviation(fine, reference)["lateral"] / size["lateral"]
    rows = []
    for level in levels:
        body_fine, body = refined(fixed_axis_orbits, step, **common, stiffening=level)
        limit, at_step = deviation(body, reference), deviation(body_fine, fine)
        row = {"stiffening": level, "tilt": float(np.abs(reference.tilt).max())}
        row |= {name: limit[name] / scale[name] for name in scale}
        row["step error"] = max(abs(limit[n] - at_step[n]) / scale[n] for n in scale)
        row["3D step error"] = own_error
        rows.append(row)
    return rows


def deviations_by_tilt(
    model: Model, tilts: Sequence[float], duration: float, step: float, samples: int = 200
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


def instability(model: Model, ratio: float, folds: float = 7.0, steps: int = 4000) -> Row:
    """Return growth rates [1/s] and the largest tilts [rad] after a start with about 1e-4 rad.

    Parameters
    ----------
    model : Model
    ratio : float
        Speed over the false threshold.
    folds : float
        How many powers of e the tilt should grow by, according to the paper's equations at 1.2
        times the threshold or more.
    steps : int
        Time steps.
    """
    bearings = Bearings((1e5, 1e5, 1e5))
    rigid = (*model.inertia, bearings.tilt_stiffness(model.rotor))
    threshold = false_threshold(*rigid)
    duration = folds / false_growth(*rigid, max(ratio, 1.2) * threshold)
    start = Start(ratio * threshold, 1e-4 * np.sqrt(rigid[2] / rigid[1]))
    common = (model, start, bearings, duration, duration / steps, 400)
    motions = {
        "none": fixed_axis_orbits(*common, stiffening="none", constant_speed=True),
        "tilt": fixed_axis_orbits(*common, constant_speed=True),
        "tilt, free spin": fixed_axis_orbits(*common),
        "3D": three_d_orbits(*common),
    }
    return {
        "I_p/I_t": rigid[0] / rigid[1],
        "speed": start.speed,
        "speed/threshold": ratio,
        "expected growth": false_growth(*rigid, start.speed) if ratio > 1.0 else 0.0,
        "growth": measured_growth(motions["none"]) if ratio > 1.0 else np.nan,
        **{f"peak {name}": float(np.abs(o.tilt).max()) for name, o in motions.items()},
    }


def instabilities(ratios: Sequence[float]) -> list[Row]:
    """Return the rows of :func:`instability` for a shaft and a disc."""
    shapes = cylinder(0.05, 0.3, 0.03), cylinder(0.15, 0.1, 0.04)
    models = [Model.of(shape, 6) for shape in shapes]
    cases = [(model, ratio) for model in models for ratio in ratios]
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


def basis_effect(cases: Sequence[tuple[float, float]], duration: float, step: float) -> list[Row]:
    """Compare the 3D body in two bases of one space, and the fixed-axis body with both.

    `cases` are pairs of speed [rad/s] and tilt [rad].
    """
    model = craig_bampton_model(Model.of(disc_on_shaft(), 1), 6)
    boundary_modes, bearings = dict(model.fem.modeBasis), SUPPORTS["isotropic"]
    rows = []
    for speed, tilt in tqdm(cases, desc="3. mode basis"):
        common = {
            "model": model,
            "start": start_with_tilt(model, bearings, tilt, speed),
            "bearings": bearings,
            "duration": duration,
            "samples": 100,
        }
        model.fem.modeBasis = boundary_modes
        _, first_end = refined(three_d_orbits, step, **common)
        model.share_modes()
        _, mean = refined(three_d_orbits, step, **common)
        _, body = refined(fixed_axis_orbits, step, **common)
        size = mean.excursion["lateral"]
        pairs = {"3D first end": (first_end, mean), "fixed axis": (body, mean)}
        row = {"speed": speed, "tilt": float(np.abs(mean.tilt).max())}
        for name, pair in pairs.items():
            found = deviation(*pair)
            row |= {f"{name}, {key}": found[key] / size for key in ("lateral", "axial")}
        rows.append(row)
    return rows


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
            common = (model, start, bearings, duration, h, 100)
            free = fixed_axis_orbits(*common)
            size = free.excursion["lateral"]
            row = {"bearing stiffness": stiffness, "step": h, "excursion/m": size}
            for name, options in members.items():
                found = deviation(fixed_axis_orbits(*common, **options), free)
                row[name] = found["lateral"] / size
            rows.append(row)
    return rows


def main() -> int:
    """Run all parts, print their tables and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer cases, shorter motions")
    options = parser.parse_args()
    quick = options.quick
    duration, step = (0.02, 2e-5) if quick else (0.06, 2e-5)
    model = Model.of(disc_on_shaft(roundness=1.0 if quick else 2.0), 8)
    tables = {
        "1. Deviation from the 3D body, relative to the motion": deviations_by_tilt(
            model, (1e-2, 1e-3, 1e-4), duration, step
        ),
        "2. Tilt started at 1e-4 rad: growth rates [1/s] and largest tilts [rad]": instabilities(
            (1.2,) if quick else (0.9, 1.2, 2.0)
        ),
        "3. Deviation from the 3D body with a frame in the mean motion": basis_effect(
            [(0.0, 1e-3), (SPEED, 1e-2), (SPEED, 1e-3)], duration, step
        ),
        "4. Members of the family against 'free': relative deviations": family(
            model, (1e6, 1e8) if quick else (1e6, 1e7, 1e8), duration, step
        ),
    }
    for title, rows in tables.items():
        print_rows(title, rows)
    first = next(iter(tables.values()))
    least = [row for row in first if row["stiffening"] == "tilt" and row["tilt"] < 1.5e-4]
    return verdict(
        {
            "lateral deviation, tilt 1e-4 rad": (max(row["lateral"] for row in least), 2e-6),
            "axial deviation, tilt 1e-4 rad": (max(row["axial"] for row in least), 1e-4),
        }
    )
