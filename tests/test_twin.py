"""The twin of Exudyn's own call: one script, the name of the call swapped."""

import inspect

import exudyn as exu
import exudyn.utilities
import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface, KirchhoffMaterial
from models import STEEL, disc_on_shaft
from scipy.spatial.transform import Rotation

import exudyn_rotor  # noqa: F401  (adds the call to MainSystem)

OWN, TWIN = "CreateFFRFReducedOrderObject", "CreateFixedAxisFFRFReducedOrderObject"
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
TO_X = Rotation.from_euler("y", np.pi / 2).as_matrix()
TO_Y = Rotation.from_euler("x", -np.pi / 2).as_matrix()

# d['rotor:…'] and the dictionary below it are all that a script knows of its body
SCRIPT = """
d = mbs.CALL(name='rotor', femInterface=fem, referencePosition=[0.3, -0.2, 0.1],
    initialVelocity=velocity, referenceRotationMatrix=space, initialAngularVelocity=omega,
    massProportionalDamping=20., stiffnessProportionalDamping=2e-6, gravity=[3., -9., 2.],
    superElementRigidMarkersOffsets=offsets)
body = d['FFRFReducedOrderObjectDict']['oFFRFreducedOrder']
left, right = d['rotor:left'], d['rotor:right']
ground = mbs.CreateGround()
for marker in (left, right):
    mbs.CreateCartesianSpringDamper(
        itemNumbers=[ground, marker], localPosition0=at_rest[int(marker == right)],
        stiffness=[8e6, 5e6, 6e6], damping=[300., 200., 100.])
mbs.CreateTorque(itemNumber=left, loadVector=(space @ mesh @ [20., 30., 250.]).tolist())
mbs.CreateForce(itemNumber=right, loadVector=[200., 300., -100.])
def sensor(kind, node):
    return mbs.AddSensor(eu.SensorSuperElement(bodyNumber=body, meshNodeNumber=node,
        outputVariableType=kind, storeInternal=True))
sensors = {'position': sensor(exu.OutputVariableType.Position, rim),
    'displacement': sensor(exu.OutputVariableType.Displacement, rim),
    'velocity': sensor(exu.OutputVariableType.Velocity, rim),
    'stress': sensor(exu.OutputVariableType.StressLocal, foot)}
for name, marker in (('left', left), ('right', right)):
    sensors[name] = mbs.AddSensor(eu.SensorMarker(markerNumber=marker, storeInternal=True,
        outputVariableType=exu.OutputVariableType.Position))
sensors['turn'] = mbs.AddSensor(eu.SensorMarker(markerNumber=right, storeInternal=True,
    outputVariableType=exu.OutputVariableType.RotationMatrix))
"""


@pytest.fixture(scope="module")
def fem():
    model = FEMinterface()
    _, _, fes = model.ImportMeshFromNGsolve(
        disc_on_shaft(0.1),
        materials={"steel": STEEL},
        boundaryNamesList=["left", "right"],
        meshOrder=1,
    )
    model.ComputeEigenmodes(6, 6)
    model.ComputePostProcessingModesNGsolve(fes, KirchhoffMaterial(2.1e11, 0.3, 7850))
    return model


def turned(fem, rotation):
    """Return the FEMinterface with its mesh turned; stress modes are left out."""
    if np.array_equal(rotation, np.eye(3)):
        return fem
    blocks = sp.block_diag([rotation] * len(fem.nodes["Position"]), format="csr")
    model = FEMinterface()
    model.nodes = {"Position": np.asarray(fem.nodes["Position"]) @ rotation.T}
    model.massMatrix = sp.csr_matrix(blocks @ fem.massMatrix @ blocks.T)
    model.stiffnessMatrix = sp.csr_matrix(blocks @ fem.stiffnessMatrix @ blocks.T)
    model.modeBasis = fem.modeBasis | {"matrix": blocks @ fem.modeBasis["matrix"]}
    model.surface, model.nodeSets = fem.surface, fem.nodeSets
    return model


def settings(steps, end_time):
    result = exu.SimulationSettings()
    result.timeIntegration.numberOfSteps = steps
    result.timeIntegration.endTime = end_time
    result.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    result.timeIntegration.newton.relativeTolerance = 1e-10
    result.solution.file.write = False
    result.solution.sensors.writePeriod = end_time / steps
    result.timeIntegration.verboseMode = 0
    return result


def run_script(call, fem, mesh, space, steps, end_time=4e-3):
    """Run the script with one of the calls, and return all sensor data."""
    SC = exu.SystemContainer()
    mbs = SC.AddSystem()
    model = turned(fem, mesh)
    nodes = np.asarray(fem.nodes["Position"])
    feet = [nodes[s["NodeNumbers"]].T @ s["NodeWeights"] for s in fem.nodeSets]
    scene = {
        "mbs": mbs,
        "fem": model,
        "exu": exu,
        "eu": exudyn.utilities,
        "mesh": mesh,
        "space": space,
        "omega": (space @ mesh @ [0.0, 0.0, 300.0]).tolist(),
        "velocity": (space @ [0.02, -0.01, 0.03]).tolist(),
        "rim": int(np.argmax(np.hypot(nodes[:, 0], nodes[:, 1]))),
        "foot": int(np.argmin(np.linalg.norm(nodes - [0.02, 0, 0.2], axis=1))),
    }
    offsets = np.array([[0.0, 1e-4, -0.01], [2e-4, 0.0, 0.01]])
    scene["offsets"] = (offsets @ mesh.T).tolist()
    scene["at_rest"] = [
        (space @ mesh @ (foot + offset) + [0.3, -0.2, 0.1]).tolist()
        for foot, offset in zip(feet, offsets * [0.0, 0.0, 1.0], strict=True)
    ]
    script = SCRIPT.replace("CALL", call)
    if not model.postProcessingModes:
        script = script.replace("    'stress'", "    }  # 'stress'")
    exec(script, scene)
    mbs.Assemble()
    mbs.SolveDynamic(settings(steps, end_time))
    data = {name: mbs.GetSensorStoredData(s)[:, 1:] for name, s in scene["sensors"].items()}
    return data


if __name__ == "__main__":
    import time
    f = FEMinterface()
    _, _, fes = f.ImportMeshFromNGsolve(disc_on_shaft(0.1), materials={"steel": STEEL}, boundaryNamesList=["left", "right"], meshOrder=1)
    f.ComputeEigenmodes(6, 6)
    f.ComputePostProcessingModesNGsolve(fes, KirchhoffMaterial(2.1e11, 0.3, 7850))
    for mesh, space in ((np.eye(3), np.eye(3)), (TO_X, np.eye(3)), (np.eye(3), TO_Y), (SKEW, SKEW.T @ TO_X)):
        for steps in (100, 400):
            t=time.time()
            a = run_script(OWN, f, mesh, space, steps); ta=time.time()-t
            t=time.time()
            b = run_script(TWIN, f, mesh, space, steps); tb=time.time()-t
            print(steps, ta, tb, {k: (float(abs(a[k] - b[k]).max()), float(abs(a[k]-a[k][0]).max())) for k in a})
