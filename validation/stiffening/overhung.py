"""An overhung disc on a clamped elastic shaft: its elastic tilt needs ``stiffening='full'``.

Lowest bending frequencies in the rotating frame over the speed: the levels of stiffening, Exudyn's
3D body, and vibrations about the geometrically nonlinear static state as the referee.

python -m validation overhung [--quick]
"""

from __future__ import annotations

import argparse

import exudyn
import ngsolve as ngs
import numpy as np
from exudyn.FEM import FEMinterface
from exudyn.itemInterface import (
    GenericJoint,
    MarkerBodyRigid,
    MarkerNodeRigid,
    ObjectGround,
    SensorNode,
)
from netgen.occ import Cylinder, OCCGeometry, Pnt, Z
from tqdm import tqdm

from exudyn_rotor import Formulation, Motion, ReducedRotor, free_modes, select_modes
from exudyn_rotor.theory.stiffening import stiffening
from validation.rows import verdict
from validation.stiffening.nonlinear import LEVELS, STEEL, ClampedSolid

SPEEDS, QUICK_SPEEDS = (0.0, 30.0, 60.0, 90.0, 120.0, 150.0), (0.0, 60.0)  # rad/s
MODES = 12
STEP, DURATION = 2e-5, 0.05  # s


def overhung_mesh(element_size: float = 0.06, safety: float = 2.0) -> ngs.Mesh:
    """Return a disc (radius 120 mm, 15 mm) at the end of a shaft (radius 10 mm, 0.4 m).

    `safety` is the radius of the curves over the length of the elements there.
    """
    solid = Cylinder(Pnt(0, 0, 0), Z, 0.01, 0.4) + Cylinder(Pnt(0, 0, 0.4), Z, 0.12, 0.015)
    solid.mat("steel")
    solid.faces.Min(Z).name = "root"
    geometry = OCCGeometry(solid)
    return ngs.Mesh(geometry.GenerateMesh(maxh=element_size, curvaturesafety=safety))


def package_frequencies(reduced: ReducedRotor, speed: float, level: str) -> np.ndarray:
    """Return the frequencies in the rotating frame of the constant matrices (109) [rad/s]."""
    chosen = select_modes(reduced, Formulation("none", speed))
    motion = Motion(
        chosen.invariants, Formulation("none", speed), stiffening(chosen.invariants, level)
    )
    zero = np.zeros(motion.size)
    by_q, by_v = motion.jacobian(0.0, zero, zero)
    count = motion.size
    system = np.block([[np.zeros((count, count)), np.eye(count)], [by_q, by_v]])
    return np.sort(np.abs(np.linalg.eigvals(system).imag))[::2]


def imported(solid: ClampedSolid, mesh: ngs.Mesh) -> FEMinterface:
    """Return a FEMinterface of a mesh like the solid's, with the modes of the clamped solid.

    It makes the mesh second order itself, so it needs one of its own.
    """
    fem = FEMinterface()
    fem.ImportMeshFromNGsolve(mesh, materials={"steel": STEEL}, meshOrder=2)
    modes = free_modes(solid.clamped, MODES).matrix
    fem.modeBasis = {"matrix": np.array(modes), "type": "NormalModes"}
    return fem


def three_d_frequencies(fem: FEMinterface, speed: float) -> np.ndarray:
    """Return the two bending frequencies of Exudyn's 3D body in its rotating frame [rad/s].

    Its frame is the hub, free to spin; the modes are those of the clamped solid. The first
    bending pair starts at a velocity, and its complex coordinate is two harmonics.
    """
    mbs = exudyn.SystemContainer().AddSystem()
    body = mbs.CreateFFRFReducedOrderObject("disc", fem, initialAngularVelocity=[0, 0, speed])
    items = body["FFRFReducedOrderObjectDict"]
    ground = mbs.AddObject(ObjectGround())
    mbs.AddObject(
        GenericJoint(
            markerNumbers=[
                mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground)),
                mbs.AddMarker(MarkerNodeRigid(nodeNumber=items["nRigidBody"])),
            ],
            constrainedAxes=[1, 1, 1, 1, 1, 0],
        )
    )
    start = np.zeros(MODES)
    start[0] = 1e-4
    mbs.SetNodeParameter(items["nGenericODE2"], "initialCoordinates_t", start.tolist())
    sensor = mbs.AddSensor(
        SensorNode(
            nodeNumber=items["nGenericODE2"],
            outputVariableType=exudyn.OutputVariableType.Coordinates,
            storeInternal=True,
            writeToFile=False,
        )
    )
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = STEP
    settings.timeIntegration.endTime = DURATION
    settings.timeIntegration.numberOfSteps = round(DURATION / STEP)
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.99
    mbs.SolveDynamic(settings)
    pair = mbs.GetSensorStoredData(sensor)[:, 1:3]
    # differences: the mesh's own unbalance bends the shaft by a constant
    return _two_harmonics(np.diff(pair[:, 0] + 1j * pair[:, 1]))


def _two_harmonics(signal: np.ndarray) -> np.ndarray:
    """Return the sizes of the two frequencies of ``a exp(iαt) + b exp(iβt)`` by Prony [rad/s]."""
    skip = max(1, len(signal) // 100)
    past = np.column_stack([signal[skip : -skip or None], signal[: -2 * skip]])
    factors = np.linalg.lstsq(past, signal[2 * skip :], rcond=None)[0]
    roots = np.roots([1.0, -factors[0], -factors[1]])
    return np.sort(np.abs(np.angle(roots)) / (skip * STEP))


def compare(solid: ClampedSolid, fem: FEMinterface, speed: float) -> dict:
    """Return the referee's first pair and the largest relative error of every other model."""
    tangent = solid.static(speed)[1]
    basis = solid.basis(tangent, MODES)
    exact = solid.frequencies(tangent, speed, basis)[:2]
    row = {"speed": speed, "strain": solid.strain(speed), "frequencies": exact.tolist()}
    found = {
        level: solid.frequencies(solid.linear_tangent(level, speed), speed, basis)
        for level in LEVELS
    }
    reduced = solid.clamped.reduce(MODES, prestress=True)
    found["reduced, tilt"] = package_frequencies(reduced, speed, "tilt")
    found["reduced, full"] = package_frequencies(reduced, speed, "full")
    found["3D body"] = three_d_frequencies(fem, speed)
    return row | {name: float(np.abs(f[:2] / exact - 1.0).max()) for name, f in found.items()}


COLUMNS = ("none", "reduced, tilt", "3D body", "full", "reduced, full", LEVELS[2])


def main(argv: list[str] | None = None) -> int:
    """Compare, print the table and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer speeds")
    options = parser.parse_args(argv)
    solid = ClampedSolid.of(overhung_mesh(), "root")
    speeds = QUICK_SPEEDS if options.quick else SPEEDS
    fem = imported(solid, overhung_mesh())
    rows = [compare(solid, fem, speed) for speed in tqdm(speeds, unit="speed")]
    print(f"overhung disc, {solid.rotor.node_count} nodes; first bending pair, rotating frame")
    print(f"{'Ω [rad/s]':>10}{'strain':>10}{'referee [rad/s]':>20}", end="")
    print("".join(f"{name:>26}" if name == LEVELS[2] else f"{name:>15}" for name in COLUMNS))
    for row in rows:
        pair = f"{row['frequencies'][0]:.2f} {row['frequencies'][1]:.2f}"
        errors = "".join(
            f"{row[name]:26.1e}" if name == LEVELS[2] else f"{row[name]:15.1e}" for name in COLUMNS
        )
        print(f"{row['speed']:10.0f}{row['strain']:10.1e}{pair:>20}{errors}")
    return verdict({"error of 'full'": (max(row["full"] for row in rows), 1e-4)})
