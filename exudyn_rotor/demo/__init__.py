"""The side-by-side demonstration: Exudyn's 3D flexible body and the fixed-axis rotor."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exudyn_rotor import checks, plotting
from exudyn_rotor.demo import scene
from exudyn_rotor.demo.simulation import Run, simulate

MODES = 12
END_TIME = 0.5  # s
STEP = 1e-4  # s
# largest element [m], and the radius of curves over the length of the elements there
FINE_MESH, QUICK_MESH = (0.0145, 2.0), (0.05, 1.0)


def run_demo(folder: str | Path, *, quick: bool = False) -> list[Run]:
    """Run the demonstration; print a table and write pictures to `folder`.

    Parameters
    ----------
    folder : path-like
        Made if it does not exist; pictures of the same name are replaced.
    quick : bool
        A coarse mesh and a tenth of the time, to see that everything works.

    Returns
    -------
    list of Run
        The 3D body first, which all deviations refer to.

    Raises
    ------
    TypeError, ValueError
        For bad input.
    """
    target = checks.path(folder, "folder")
    checks.flag(quick, "quick")
    target.mkdir(parents=True, exist_ok=True)
    print("meshing with NGSolve, computing modes with FEMinterface …", flush=True)
    fem = scene.unbalanced_model(MODES, *(QUICK_MESH if quick else FINE_MESH))
    print(f"{len(fem.GetNodePositionsAsArray())} nodes, {MODES} modes")
    end_time = END_TIME / 10.0 if quick else END_TIME
    variants = {
        "3D body, markers on all nodes": scene.add_3d_rotor,
        "3D body, virtual interface nodes": scene.add_3d_rotor_with_virtual_nodes,
        "fixed axis, translation free": scene.add_fixed_axis_rotor("free"),
        "fixed axis, translation none": scene.add_fixed_axis_rotor("none"),
    }
    pictures = {"fixed axis, translation free": target / "rotor.png"}
    runs = [
        simulate(label, add, fem, end_time, STEP, pictures.get(label))
        for label, add in variants.items()
    ]
    print(table(runs))
    draw_comparison(runs, target)
    print(f"pictures: {', '.join(sorted(path.name for path in target.glob('*.png')))} in {target}")
    return runs


def table(runs: list[Run]) -> str:
    """Return the comparison as text; the first run is the reference."""
    reference = runs[0]
    amplitude = np.abs(reference.orbit).max()
    lines = [
        "",
        f"{'':34}{'unknowns':>9}{'locked':>8}{'constr.':>9}{'seconds':>9}{'ratio':>7}{'deviation':>11}",
    ]
    for run in runs:
        deviation = run.deviation(reference).max() / amplitude
        lines.append(
            f"{run.label:34}{run.unknowns:9d}{run.locked:8d}{run.constraints:9d}"
            f"{run.seconds:9.2f}{reference.seconds / run.seconds:7.1f}{deviation:11.1e}"
        )
    lines += [
        "",
        f"spin speed {reference.speed[0]:.0f} → {reference.speed[-1]:.0f} rad/s, largest journal "
        f"displacement {1e6 * amplitude:.0f} µm;",
        "deviation: largest distance of the orbits at equal times over that displacement",
        "",
    ]
    return "\n".join(lines)


def draw_comparison(runs: list[Run], folder: Path) -> None:
    """Write orbits and time histories of the 3D body and the fixed-axis rotor."""
    reference, fixed = runs[0], runs[2]
    made, axes = plotting.figure(size=(6.0, 5.5))
    plotting.plot_orbits(axes, {run.label: run.orbit for run in (reference, fixed)})
    plotting.save(made, folder / "orbits.png")

    made, (above, below) = plotting.figure(2, 1, size=(9.0, 6.0), sharex=True)
    plotting.plot_histories(
        above, reference.time, {run.label: run.orbit[:, 1] for run in (reference, fixed)}
    )
    above.set_ylabel("right journal, vertical [µm]")
    after_start = slice(1, None)  # all runs start from the same state
    plotting.plot_deviation(
        below,
        reference.time[after_start],
        {run.label: run.deviation(reference)[after_start] for run in runs[2:]},
    )
    plotting.save(made, folder / "displacement.png")
