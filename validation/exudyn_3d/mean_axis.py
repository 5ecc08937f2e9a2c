"""Craig–Bampton modes and Exudyn's 3D body: who errs, by how much, over the speed.

A disc on a shaft, unbalanced by 10 g at its rim, whirls steadily on two equal isotropic bearings.
The reference is the unbalance response of the whole solid with its centrifugal prestress, no modes
involved. Exudyn's body and the fixed axis run until the whirl is steady; what is compared is the
radius of the left journal's path.

``held frame`` shows the cause. It is the linear response in the rotor frame with the five rigid
motions and the same modes, K2 of the tilts included but for its block of the modes alone: that
block is the work of the centrifugal field on the second-order displacement of a tilt that the
modes hold, and a frame that is held at the first boundary leaves it out. ``all tilts`` has this
block, too; it is the twin's own equation.

Run ``python -m validation mean_axis``, with ``--quick`` for one speed and short runs, ``--json
FILE`` to keep the numbers.
"""

from __future__ import annotations

import argparse
import json
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import exudyn
import netgen.occ as occ
import ngsolve
import numpy as np
from exudyn.FEM import FEMinterface, HCBstaticModeSelection
from exudyn.utilities import SensorMarker

from exudyn_rotor import SolidRotor, Support, unbalance_response, use_mean_axis_modes
from exudyn_rotor.reduction.basis import rigid_columns
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.stiffening import stiffening

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
SEATS = ("left", "right")
STIFFNESS, DAMPING = 2e6, 2e3  # N/m, N s/m
UNBALANCE = 0.01  # kg at the rim
SPEEDS = (250.0, 500.0, 700.0)
OWN, TWIN = "CreateFFRFReducedOrderObject", "CreateFixedAxisFFRFReducedOrderObject"


def disc_on_shaft() -> ngsolve.Mesh:
    """Return the mesh, each time anew: both importers change it in place."""
    body = occ.Cylinder((0, 0, 0), occ.Z, 0.02, 0.5)
    body += occ.Cylinder((0, 0, 0.2), occ.Z, 0.15, 0.03)
    body.mat("steel")
    body.faces.Min(occ.Z).name, body.faces.Max(occ.Z).name = SEATS
    return ngsolve.Mesh(occ.OCCGeometry(body).GenerateMesh(maxh=0.06, curvaturesafety=1.0))


@dataclass(frozen=True)
class Case:
    """The rotor, as a solid and with its sets of modes in Exudyn's interface."""

    solid: SolidRotor
    modes: dict[str, FEMinterface]

    @classmethod
    def of(cls, eigenmodes: int = 8, free: int = 20) -> Case:
        """Mesh the rotor and compute the modes."""
        modes = {name: FEMinterface() for name in ("Craig–Bampton", "mean axis", "free")}
        for name, fem in modes.items():
            fem.ImportMeshFromNGsolve(
                disc_on_shaft(),
                materials={"steel": STEEL},
                boundaryNamesList=list(SEATS),
                meshOrder=2,
            )
            rim = int(np.argmax(fem.GetNodePositionsAsArray()[:, 0]))
            fem.AddNodeMass(rim, UNBALANCE)
            if name == "free":
                fem.ComputeEigenmodes(free, 6)
                continue
            seats = [node_set["NodeNumbers"] for node_set in fem.nodeSets]
            static = HCBstaticModeSelection.RBE2
            fem.ComputeHurtyCraigBamptonModes(seats, eigenmodes, computationMode=static)
        use_mean_axis_modes(modes["mean axis"])
        solid = SolidRotor.from_ngsolve(disc_on_shaft(), STEEL, "z")
        return cls(solid.add_point_mass(solid.nodes[rim], UNBALANCE), modes)

    def reference(self, speeds: Sequence[float]) -> np.ndarray:
        """Return the whirl radius of the left journal of the whole prestressed solid [m]."""
        supports = [Support(seat, STIFFNESS * np.eye(3), DAMPING * np.eye(3)) for seat in SEATS]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of resonances between these speeds
            response = unbalance_response(
                self.solid.with_prestress(self.solid.prestress()),
                speeds,
                supports=supports,
                stiffening="full",
                at=["left"],
            )
        return np.abs(response.phasor("left", "n1"))

    def linear(self, speed: float, held: bool) -> float:
        """Return the same for Craig–Bampton modes, K2 of the modes left out where `held`."""
        rotor = SolidRotor.from_fem_interface(self.modes["Craig–Bampton"], "z")
        rigid = rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass)
        rigid = np.delete(rigid, 3, axis=1)  # the spin is prescribed
        basis = np.hstack([rigid, self.modes["Craig–Bampton"].modeBasis["matrix"]])
        foot = rotor.axis.project(rotor.center_of_mass)
        inv = Invariants.of(
            rotor.nodes - foot, rotor.mass, rotor.stiffness, None, basis, rotor.axis.direction
        )
        K2 = np.array(stiffening(inv, "tilt").K2)
        if held:
            K2[5:, 5:] = 0.0
        matrix = inv.K - speed**2 * (inv.C - K2)
        turning = np.cross(rotor.axis.direction, np.eye(3), axisb=0, axisc=0)
        seats = [rotor.interfaces[seat].mean_motion(rotor.node_count)[:3] @ basis for seat in SEATS]
        for motion in seats:
            bearing = STIFFNESS * np.eye(3) + speed * DAMPING * turning
            matrix = matrix + motion.T @ bearing @ motion
        moved = seats[0] @ np.linalg.solve(matrix, speed**2 * inv.h)
        return float(np.linalg.norm(moved[:2]))

    def run(self, call: str, modes: str, speed: float, duration: float, step: float) -> float:
        """Return the whirl radius of the left journal at the end of a run with free spin [m]."""
        mbs = exudyn.SystemContainer().AddSystem()
        more = {"axis": "z"} if call == TWIN else {}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            made = getattr(mbs, call)(
                name="rotor",
                femInterface=self.modes[modes],
                initialAngularVelocity=[0.0, 0.0, speed],
                **more,
            )
        mbs.Assemble()
        ground = mbs.CreateGround()
        kinds = exudyn.OutputVariableType
        for seat in SEATS:
            marker = made[f"rotor:{seat}"]
            place = mbs.GetMarkerOutput(marker, kinds.Position, exudyn.ConfigurationType.Reference)
            mbs.CreateCartesianSpringDamper(
                itemNumbers=[ground, marker],
                localPosition0=list(place),
                stiffness=[STIFFNESS] * 3,
                damping=[DAMPING] * 3,
            )
        sensor = mbs.AddSensor(
            SensorMarker(
                markerNumber=made["rotor:left"],
                outputVariableType=kinds.Displacement,
                storeInternal=True,
            )
        )
        mbs.Assemble()
        settings = exudyn.SimulationSettings()
        settings.timeIntegration.numberOfSteps = round(duration / step)
        settings.timeIntegration.endTime = duration
        settings.timeIntegration.newton.useModifiedNewton = True
        settings.timeIntegration.newton.modifiedNewtonContractivity = 0.05
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = step
        mbs.SolveDynamic(settings)
        path = mbs.GetSensorStoredData(sensor)[:, 1:3]
        turn = round(2.0 * np.pi / speed / step)
        return float(np.linalg.norm(path[-turn:] - path[-turn:].mean(axis=0), axis=1).mean())


RUNS = (
    ("3D, Craig–Bampton", OWN, "Craig–Bampton"),
    ("3D, mean axis", OWN, "mean axis"),
    ("3D, 20 free", OWN, "free"),
    ("twin, Craig–Bampton", TWIN, "Craig–Bampton"),
)


def table(case: Case, speeds: Sequence[float], duration: float, step: float) -> list[dict]:
    """Return one row per speed: the reference [m], and deviations from it."""
    rows = []
    for speed, reference in zip(speeds, case.reference(speeds), strict=True):
        row = {"speed": speed, "reference": float(reference)}
        for name, held in (("held frame", True), ("all tilts", False)):
            row[name] = case.linear(speed, held) / reference - 1.0
        for name, call, modes in RUNS:
            row[name] = case.run(call, modes, speed, duration, step) / reference - 1.0
        rows.append(row)
    return rows


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the deviations from the reference over the speed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args(arguments)
    case = Case.of()
    speeds, duration, step = ((500.0,), 0.05, 1e-4) if options.quick else (SPEEDS, 0.15, 5e-5)
    rows = table(case, speeds, duration, step)
    print(f"{case.solid.node_count} nodes, deviation from the whole prestressed solid")
    names = [name for name in rows[0] if name not in ("speed", "reference")]
    print("rad/s  reference", *(f"{name:>20}" for name in names))
    for row in rows:
        values = (f"{row[name]:20.1e}" for name in names)
        print(f"{row['speed']:5.0f}  {1e6 * row['reference']:6.2f} µm", *values)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
