"""The side-by-side demonstration: Exudyn's 3D flexible body and the fixed-axis rotor."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface
from exudyn.interactive import ShowImage
from exudyn.itemInterface import SensorMarker, SensorNode
from exudyn.rigidBodyUtilities import RotationMatrixX, RotationMatrixZ

from exudyn_rotor import checks, plotting
from exudyn_rotor.demo import scene

MODES = 12
END_TIME = 0.5  # s
STEP = 1e-4  # s
MAGNIFICATION = 300.0  # of the picture's deformation
# largest element [m], and the radius of curves over the length of the elements there
FINE_MESH, QUICK_MESH = (0.0145, 2.0), (0.05, 1.0)


@dataclass(frozen=True, eq=False)
class Run:
    """One simulated variant."""

    label: str
    seconds: float  # wall-clock time of the time integration
    time: np.ndarray  # (s,) [s]
    orbit: np.ndarray  # (s, 2) of the right journal, horizontal and vertical, inertial axes [m]
    speed: np.ndarray  # (s,) of the spin [rad/s]

    def deviation(self, reference: Run) -> np.ndarray:
        """Return the distance of the orbits at equal times, shape (s,) [m]."""
        return np.linalg.norm(self.orbit - reference.orbit, axis=1)


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
    runs = []
    print(f"{'':34}{'seconds':>9}{'ratio':>7}{'deviation':>11}")
    for label, add in variants.items():
        run = _simulated(label, add, fem, end_time, pictures.get(label))
        runs.append(run)
        deviation = run.deviation(runs[0]).max() / np.abs(runs[0].orbit).max()
        ratio = runs[0].seconds / run.seconds
        print(f"{label:34}{run.seconds:9.2f}{ratio:7.1f}{deviation:11.1e}", flush=True)
    amplitude = 1e6 * np.abs(runs[0].orbit).max()
    print(
        f"spin speed {runs[0].speed[0]:.0f} → {runs[0].speed[-1]:.0f} rad/s, largest journal "
        f"displacement {amplitude:.0f} µm;\n"
        "deviation: largest distance of the orbits at equal times over that displacement"
    )
    _draw_comparison(runs[0], runs[2], target)
    print(f"pictures: {', '.join(sorted(path.name for path in target.glob('*.png')))} in {target}")
    return runs


def _draw_comparison(reference: Run, fixed: Run, folder: Path) -> None:
    """Write orbits and time histories of the 3D body and the fixed-axis rotor."""
    made, ax = plotting.figure(size=(6.0, 5.5))
    plotting.plot_orbits(ax, {run.label: run.orbit for run in (reference, fixed)})
    plotting.save(made, folder / "orbits.png")
    made, (above, below) = plotting.figure(2, 1, size=(9.0, 6.0), sharex=True)
    for run, color, line in zip((reference, fixed), plotting.COLORS, plotting.LINES, strict=False):
        above.plot(run.time, 1e6 * run.orbit[:, 1], line, color=color, lw=1.0, label=run.label)
    above.set_ylabel("right journal, vertical [µm]")
    plotting.legend_above(above)
    below.semilogy(fixed.time[1:], 1e6 * fixed.deviation(reference)[1:], lw=1.0)
    below.set_ylabel("deviation [µm]")
    below.set_xlabel("time [s]")
    plotting.save(made, folder / "displacement.png")


def _simulated(
    label: str,
    add_rotor: scene.AddRotor,
    fem: FEMinterface,
    end_time: float,
    picture: Path | None,
) -> Run:
    """Build the scene, run it up through the critical speed, and return what was measured."""
    SC = exudyn.SystemContainer()
    mbs = SC.AddSystem()
    rotor = add_rotor(mbs, fem)
    scene.add_foundation(mbs, rotor)
    kinds = exudyn.OutputVariableType
    stored = {"storeInternal": True, "writeToFile": False}
    marker, node = rotor["rotor:right"], rotor["FFRFReducedOrderObjectDict"]["nRigidBody"]
    journal = mbs.AddSensor(
        SensorMarker(markerNumber=marker, outputVariableType=kinds.Displacement, **stored)
    )
    spin = mbs.AddSensor(
        SensorNode(nodeNumber=node, outputVariableType=kinds.AngularVelocity, **stored)
    )
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(end_time / STEP)
    settings.timeIntegration.endTime = end_time
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 2.0 * STEP
    start = time.perf_counter()
    mbs.SolveDynamic(settings)
    seconds = time.perf_counter() - start
    if picture is not None:
        _draw_rotor(SC, picture)
    displacement, velocity = (mbs.GetSensorStoredData(sensor) for sensor in (journal, spin))
    return Run(label, seconds, displacement[:, 0], displacement[:, 2:4], velocity[:, 1])


def _draw_rotor(SC: exudyn.SystemContainer, path: Path) -> None:
    """Draw the scene with the rotor's deformation, magnified."""
    from matplotlib import pyplot

    settings = SC.visualizationSettings
    general, view = settings.general, settings.view0
    general.showSolverInformation = general.showSolutionInformation = False
    view.window.showComputationInfo = view.scene.showFaceEdges = view.scene.showMeshEdges = False
    view.scene.drawCoordinateSystem = 0
    for items in ("connectors", "markers", "loads", "sensors", "nodes"):
        getattr(settings, items).show = False
    settings.bodies.deformationScaleFactor = MAGNIFICATION
    settings.contour.outputVariable = exudyn.OutputVariableType.DisplacementLocal
    settings.contour.outputVariableComponent = -1
    view = RotationMatrixZ(-0.6) @ RotationMatrixX(1.25)
    image = ShowImage(SC, size=(1400, 900), modelRotation=view, show=False)
    pyplot.imsave(path, image, format="png")
