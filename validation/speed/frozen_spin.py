"""Error and cost of ``spin_coupling='frozen'`` over unbalance and drive.

The disc on its shaft of the peer scenes spins freely on two soft bearings, with and without a drive
torque and gravity, both ways with the same steps. Errors are those of the frozen against the full
spin: of the angle over the angle turned, of the speed, and of the lateral motion of a bearing seat
over its size; "reported" is the row of ``check_run``.

    python -m validation frozen_spin [--quick] [--json FILE]
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import exudyn
import numpy as np

from exudyn_rotor import ReducedRotor, RotorBody, SolidRotor, add_rotor, check_run
from validation.peer import parts

SPEED, END, STEP = 100.0, 0.5, 1e-4  # rad/s, s, s
QUICK_END = 0.01
UNBALANCES = (0.0, 0.01, 0.1, 1.0)  # kg at the rim beyond the part's own 0.01 kg
DRIVES = (0.0, 50.0)  # N m
STIFFNESS, DAMPING = 1e6, 1e3  # N/m, N s/m


def unbalanced(extra: float) -> ReducedRotor:
    """Return the rotor with an extra mass at the rim."""
    rotor = SolidRotor.from_fem_interface(parts.rotor(), "z")
    if extra:
        rim = [0.0, parts.DISC_RADIUS, parts.DISC_START + parts.DISC_WIDTH]
        rotor = rotor.add_point_mass(rim, extra)
    return rotor.reduce(8)


def run(rotor: ReducedRotor, torque: float, coupling: str, end: float) -> tuple[RotorBody, float]:
    """Return the rotor after a run that was recorded, and the time of a step [µs]."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(
        mbs,
        rotor,
        initial_speed=SPEED,
        spin_coupling=coupling,
        stiffening="tilt",  # as much as Exudyn's body has
        gravity=[0.0, -9.81, 0.0],
        markers="position" if not torque else None,
    )
    for name, z in zip(parts.ENDS, (0.0, parts.SHAFT_LENGTH), strict=True):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[mbs.CreateGround(), body.marker(name)],
            localPosition0=[0.0, 0.0, z],
            stiffness=[STIFFNESS] * 3,
            damping=[DAMPING] * 3,
        )
    if torque:
        mbs.CreateTorque(itemNumber=body.marker("left"), loadVector=[0.0, 0.0, torque])
    body.start_recording()
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 10 * STEP
    settings.timeIntegration.numberOfSteps = round(end / STEP)
    settings.timeIntegration.endTime = end
    settings.timeIntegration.verboseMode = 0
    start = time.perf_counter()
    mbs.SolveDynamic(settings)
    return body, 1e6 * (time.perf_counter() - start) * STEP / end


def compare(extra: float, torque: float, end: float, repeats: int) -> dict:
    """Return a row: what the frozen spin errs by, what is reported, and the cost of both."""
    rotor = unbalanced(extra)
    runs = [
        [run(rotor, torque, coupling, end) for coupling in ("full", "frozen")]
        for _ in range(repeats)
    ]
    full, frozen = (body for body, _ in runs[-1])
    before, after = full.recorded(), frozen.recorded()
    place = full.layout.unknowns
    count = full.formulation.translation_count
    angle = np.abs(after.q[:, place[count]] - before.q[:, place[count]]).max()
    lateral = before.q[:, place[:2]]
    off = np.linalg.norm(after.q[:, place[:2]] - lateral, axis=1).max()
    return {
        "unbalance": extra,
        "torque": torque,
        "reported": check_run(frozen, warn=False)["frozen spin"].value,
        "speed": float(np.abs(after.speed / before.speed - 1.0).max()),
        "angle": float(angle / np.abs(before.q[:, place[count]]).max()),
        "lateral": float(off / np.linalg.norm(lateral, axis=1).max()),
        "microseconds": np.min([[cost for _, cost in pair] for pair in runs], axis=0).tolist(),
    }


def main(argv: list[str] | None = None) -> None:
    """Compare and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a short run, one unbalance")
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    options = parser.parse_args(argv)
    end, repeats = (QUICK_END, 1) if options.quick else (END, 3)
    print("unbalance [kg]  torque [N m]  reported     speed     angle   lateral  µs full   frozen")
    rows = []
    for extra in UNBALANCES[1:2] if options.quick else UNBALANCES:
        for torque in DRIVES:
            row = compare(extra, torque, end, repeats)
            rows.append(row)
            errors = "".join(f"{row[key]:10.1e}" for key in ("reported", "speed", "angle"))
            costs = "".join(f"{cost:9.0f}" for cost in row["microseconds"])
            print(f"{extra:14g}{torque:14g}{errors}{row['lateral']:10.1e}{costs}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n")
