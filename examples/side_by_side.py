"""Swap the call, keep the script: Exudyn's 3D flexible body and the fixed-axis rotor.

The same scene is built twice; only the name of the call differs. The full comparison with speed,
foundation and pictures is ``python -m exudyn_rotor demo``.
"""

import exudyn
import ngsolve
import numpy as np
from exudyn.FEM import FEMinterface
from netgen import occ

import exudyn_rotor  # noqa: F401  adds CreateFixedAxisFFRFReducedOrderObject to mbs

SPEED = 314.0  # rad/s
STEP, END_TIME = 5e-5, 0.05  # s


def finite_element_model() -> FEMinterface:
    """Return an unbalanced disc on a shaft with eight free modes."""
    shaft = occ.Cylinder(occ.Pnt(0, 0, -0.2), occ.Z, 0.012, 0.4)
    solid = shaft + occ.Cylinder(occ.Pnt(0, 0, 0.02), occ.Z, 0.09, 0.02)
    solid.name = "steel"
    solid.faces.Min(occ.Z).name, solid.faces.Max(occ.Z).name = "left", "right"
    fem = FEMinterface()
    fem.ImportMeshFromNGsolve(
        ngsolve.Mesh(occ.OCCGeometry(solid).GenerateMesh(maxh=0.04, curvaturesafety=1.0)),
        materials={"steel": {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}},
        boundaryNamesList=["left", "right"],
        meshOrder=2,
    )
    rim = np.linalg.norm(fem.GetNodePositionsAsArray() - [0.09, 0.0, 0.03], axis=1)
    fem.AddNodeMass(int(np.argmin(rim)), 0.01)
    fem.ComputeEigenmodes(8, excludeRigidBodyModes=6)
    return fem


def orbit(call: str, fem: FEMinterface, **extra) -> np.ndarray:
    """Return the orbit (steps, 2) of the right journal [m]."""
    SC = exudyn.SystemContainer()
    mbs = SC.AddSystem()
    rotor = getattr(mbs, call)(
        name="rotor", femInterface=fem, initialAngularVelocity=[0, 0, SPEED], **extra
    )
    ground = mbs.CreateGround()
    for name, z in (("left", -0.2), ("right", 0.2)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, rotor[f"rotor:{name}"]],
            localPosition0=[0, 0, z],
            stiffness=[1e6, 1e6, 1e6],
            damping=[100.0, 100.0, 100.0],
        )
    sensor = mbs.AddSensor(
        exudyn.itemInterface.SensorMarker(
            markerNumber=rotor["rotor:right"],
            outputVariableType=exudyn.OutputVariableType.Displacement,
            storeInternal=True,
        )
    )
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(END_TIME / STEP)
    settings.timeIntegration.endTime = END_TIME
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = STEP
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)[:, 1:3]


fem = finite_element_model()
spatial = orbit("CreateFFRFReducedOrderObject", fem)
fixed_axis = orbit("CreateFixedAxisFFRFReducedOrderObject", fem, axis="z")
amplitude = np.abs(spatial).max()
deviation = np.abs(fixed_axis - spatial).max() / amplitude
print(f"amplitude {1e6 * amplitude:.1f} µm, deviation {deviation:.1e} of it")
assert deviation < 2e-3
