"""Running the demonstration's scene and measuring it."""

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
from tqdm import tqdm

from exudyn_rotor.demo.scene import AddRotor, add_foundation

MAGNIFICATION = 300.0


@dataclass(frozen=True, eq=False)
class Run:
    """One simulated variant.

    Attributes
    ----------
    label : str
    unknowns, locked, constraints : int
        Coordinates of the rotor: unknown, and locked ones of its marker body; constraints on it.
    seconds : float
        Wall-clock time of the time integration.
    time : ndarray, shape (s,)
        [s].
    orbit : ndarray, shape (s, 2)
        Horizontal and vertical displacement of the right journal, inertial axes [m].
    speed : ndarray, shape (s,)
        Spin speed [rad/s].
    """

    label: str
    unknowns: int
    locked: int
    constraints: int
    seconds: float
    time: np.ndarray
    orbit: np.ndarray
    speed: np.ndarray

    def deviation(self, reference: Run) -> np.ndarray:
        """Return the distance of the orbits at equal times, shape (s,) [m]."""
        return np.linalg.norm(self.orbit - reference.orbit, axis=1)


def simulate(
    label: str,
    add_rotor: AddRotor,
    fem: FEMinterface,
    end_time: float,
    step: float,
    picture: Path | None = None,
) -> Run:
    """Build the scene, run it up through the critical speed, and return what was measured."""
    SC = exudyn.SystemContainer()
    mbs = SC.AddSystem()
    rotor = add_rotor(mbs, fem)
    items = rotor["FFRFReducedOrderObjectDict"]
    constraints = 0 if "rotorBody" in items else 1  # norm of the Euler parameters
    add_foundation(mbs, rotor)
    kinds = exudyn.OutputVariableType
    stored = {"storeInternal": True, "writeToFile": False}
    journal = mbs.AddSensor(
        SensorMarker(
            markerNumber=rotor["rotor:right"], outputVariableType=kinds.Displacement, **stored
        )
    )
    spin = mbs.AddSensor(
        SensorNode(
            nodeNumber=items["nRigidBody"], outputVariableType=kinds.AngularVelocity, **stored
        )
    )
    mbs.Assemble()
    seconds = _integrate(mbs, label, end_time, step)
    if picture is not None:
        draw_rotor(SC, picture)
    displacement, velocity = (mbs.GetSensorStoredData(sensor) for sensor in (journal, spin))
    unknowns, locked = _rotor_coordinates(mbs, items)
    return Run(
        label=label,
        unknowns=unknowns,
        locked=locked,
        constraints=constraints,
        seconds=seconds,
        time=displacement[:, 0],
        orbit=displacement[:, 2:4],
        speed=velocity[:, 1],
    )


def _rotor_coordinates(mbs: exudyn.MainSystem, items: dict) -> tuple[int, int]:
    total = sum(
        len(mbs.GetNodeOutput(items[node], exudyn.OutputVariableType.Coordinates))
        for node in ("nRigidBody", "nGenericODE2")
    )
    locked = len(items["rotorBody"].locked) if "rotorBody" in items else 0
    return total - locked, locked


def _integrate(mbs: exudyn.MainSystem, label: str, end_time: float, step: float) -> float:
    """Run generalized-alpha with a progress bar; return the seconds it took."""
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(end_time / step)
    settings.timeIntegration.endTime = end_time
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 2.0 * step
    with tqdm(
        total=100, desc=f"{label:38s}", unit="%", bar_format="{l_bar}{bar:30}| {elapsed}"
    ) as bar:

        def show_progress(mbs: exudyn.MainSystem, t: float) -> bool:
            share = int(100.0 * t / end_time)
            if share > bar.n:
                bar.update(share - bar.n)
            return True

        mbs.SetPreStepUserFunction(show_progress)
        start = time.perf_counter()
        mbs.SolveDynamic(settings)
        seconds = time.perf_counter() - start
        bar.update(100 - bar.n)
    return seconds


def draw_rotor(SC: exudyn.SystemContainer, path: Path) -> None:
    """Draw the scene with the rotor's deformation, magnified."""
    from matplotlib import pyplot

    settings = SC.visualizationSettings
    settings.view0.scene.drawCoordinateSystem = 0
    settings.general.showSolverInformation = False
    settings.general.showSolutionInformation = False
    settings.view0.window.showComputationInfo = False
    settings.view0.scene.showFaceEdges = False
    settings.view0.scene.showMeshEdges = False
    for group in (settings.connectors, settings.markers, settings.loads, settings.sensors):
        group.show = False
    settings.bodies.deformationScaleFactor = MAGNIFICATION
    settings.contour.outputVariable = exudyn.OutputVariableType.DisplacementLocal
    settings.nodes.show = False
    view = RotationMatrixZ(-0.6) @ RotationMatrixX(1.25)
    image = ShowImage(SC, size=(1400, 900), modelRotation=view, show=False)
    pyplot.imsave(path, image, format="png")
