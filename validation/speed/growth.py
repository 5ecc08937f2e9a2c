"""Time and memory of a set-up over the size of the mesh, each in a process of its own.

The rotor is the demonstration's disc on a shaft. Stages: mesh, mass and stiffness, prestress, 20
free modes, attachment modes of both interfaces (12 static responses), reduction. Memory is the peak
of the process so far, libraries included (0.25 GB).

python -m validation growth [--million] [--solvers auto direct iterative] [--json FILE]
    [--picture FILE]
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

MODES = 20
ELEMENT_SIZES, LARGEST = (0.011, 0.0085, 0.0062, 0.0048), 0.0034  # m
PICTURE = Path("growth.png")


def set_up(element_size: float, solver: str) -> dict:
    """Return degrees of freedom, seconds and peak GB of each stage, and residuals of the modes."""
    from exudyn_rotor import SolidRotor, free_modes
    from exudyn_rotor.demo.scene import STEEL, disc_on_shaft
    from exudyn_rotor.reduction.attachment import attachment_modes

    stages = {}

    def timed(name: str, compute):
        start, busy = time.perf_counter(), time.process_time()
        result = compute()
        stages[name] = {
            "seconds": time.perf_counter() - start,
            "processor": time.process_time() - busy,
            "peak": peak_memory(),
        }
        return result

    mesh = timed("mesh", lambda: disc_on_shaft(element_size))
    rotor = timed("mass and stiffness", lambda: SolidRotor.from_ngsolve(mesh, STEEL, axis="x"))
    rotor = rotor.with_solver(solver)
    prestress = timed("prestress", rotor.prestress)
    modes = timed("modes", lambda: free_modes(rotor, MODES))
    timed("attachment modes", lambda: attachment_modes(rotor, modes.matrix))
    timed("reduction", lambda: rotor.reduce(modes, prestress=prestress))
    inertia = rotor.mass @ (modes.matrix * modes.frequencies**2)
    residual = np.linalg.norm(rotor.stiffness @ modes.matrix - inertia, axis=0)
    return {
        "degrees_of_freedom": rotor.nodes.size,
        "solver": solver,
        "stages": stages,
        "seconds": sum(stage["seconds"] for stage in stages.values()),
        "peak": peak_memory(),
        "residual": float((residual / np.linalg.norm(inertia, axis=0)).max()),
        "frequencies": modes.frequencies.tolist(),
    }


def peak_memory() -> float:
    """Return the largest memory of this process so far [GB]."""
    import psutil

    info = psutil.Process().memory_info()
    if hasattr(info, "peak_wset"):  # Windows
        return info.peak_wset / 1e9
    import resource

    unit = 1e9 if sys.platform == "darwin" else 1e6
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit


def in_process(element_size: float, solver: str) -> dict | None:
    """Return the result of :func:`set_up` in a process of its own; None where it fails."""
    command = [sys.executable, "-m", "validation.speed.growth", "--one", str(element_size), solver]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    return json.loads(result.stdout.splitlines()[-1]) if result.returncode == 0 else None


def draw(rows: list[dict], path: Path) -> None:
    """Write a picture of seconds and GB over the degrees of freedom."""
    figure = Figure(figsize=(9, 3.6), layout="constrained")
    axes = figure.subplots(1, 2)
    for solver in dict.fromkeys(row["solver"] for row in rows):
        chosen = [row for row in rows if row["solver"] == solver]
        sizes = [row["degrees_of_freedom"] for row in chosen]
        for ax, key in zip(axes, ("seconds", "peak"), strict=True):
            values = [row[key] for row in chosen]
            label = solver
            if len(chosen) > 1:
                label += f", n^{np.polyfit(np.log(sizes), np.log(values), 1)[0]:.2f}"
            ax.loglog(sizes, values, "o-", label=label)
    for ax, label in zip(axes, ("set-up [s]", "peak memory [GB]"), strict=True):
        ax.set(xlabel="degrees of freedom", ylabel=label)
        ax.grid(True, which="both", alpha=0.3)
        ax.legend()
    figure.savefig(path, dpi=150)


def table(rows: list[dict]) -> str:
    """Return the stages of each run, and how far frequencies of two solvers differ."""
    lines = []
    for row in rows:
        lines.append(
            f"\n{row['degrees_of_freedom']} degrees of freedom, solver {row['solver']}: "
            f"{row['seconds']:.1f} s, {row['peak']:.2f} GB, residual {row['residual']:.1e} of ω²Mφ"
        )
        for name, stage in row["stages"].items():
            lines.append(
                f"  {name:20s}{stage['seconds']:9.1f} s{stage['processor']:9.1f} s of processors"
                f"{stage['peak']:8.2f} GB so far"
            )
    sizes = {}
    for row in rows:
        first = sizes.setdefault(row["degrees_of_freedom"], row)
        if first is not row:
            ratio = np.array(row["frequencies"]) / first["frequencies"]
            lines.append(
                f"\n{row['degrees_of_freedom']} degrees of freedom: frequencies of "
                f"{first['solver']} and {row['solver']} differ by {np.abs(ratio - 1).max():.1e}"
            )
    return "\n".join(lines)


def main() -> None:
    """Measure, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--million", action="store_true", help="also a million degrees of freedom")
    parser.add_argument("--sizes", type=float, nargs="+", help="lengths of elements instead [m]")
    parser.add_argument("--solvers", nargs="+", default=["auto"], help="one or more solvers")
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    parser.add_argument("--picture", type=Path, default=PICTURE, help="where the picture goes")
    parser.add_argument("--one", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(set_up(float(options.one[0]), options.one[1])))
        return
    sizes = options.sizes or [*ELEMENT_SIZES, *([LARGEST] if options.million else [])]
    rows = []
    for size in sizes:
        for solver in options.solvers:
            row = in_process(size, solver)
            if row is None:
                print(f"element size {size} m, solver {solver}: failed, see above")
                continue
            rows.append(row)
            print(table([row]), flush=True)
    if len(options.solvers) > 1:
        print(table(rows))
    draw(rows, options.picture)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()
