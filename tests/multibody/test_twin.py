"""The twin of Exudyn's own call: one script, the name of the call swapped."""

from importlib import reload

import exudyn as exu
import exudyn.utilities
import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface
from models import disc_fem
from scipy.spatial.transform import Rotation

from exudyn_rotor.multibody.twins import exudyn_call  # adds the call to MainSystem

OWN, TWIN = "CreateFFRFReducedOrderObject", "CreateFixedAxisFFRFReducedOrderObject"
SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
TO_X = Rotation.from_euler("y", np.pi / 2).as_matrix()
TO_Y = Rotation.from_euler("x", -np.pi / 2).as_matrix()

# all that a script knows of its body is the dictionary d
SCRIPT = """
d = mbs.CALL(name='rotor', femInterface=fem, referencePosition=place, initialVelocity=velocity,
    referenceRotationMatrix=space, initialAngularVelocity=omega, massProportionalDamping=20.,
    stiffnessProportionalDamping=2e-6, gravity=[3., -9., 2.])
parts = d['FFRFReducedOrderObjectDict']
left, right = d['rotor:left'], d['rotor:right']
ground = mbs.CreateGround()
mbs.Assemble()
for marker in (left, right):
    at_rest = mbs.GetMarkerOutput(
        marker, exu.OutputVariableType.Position, exu.ConfigurationType.Reference)
    mbs.CreateCartesianSpringDamper(itemNumbers=[ground, marker], localPosition0=list(at_rest),
        stiffness=[8e6, 5e6, 6e6], damping=[300., 200., 100.])
mbs.CreateTorque(itemNumber=left, loadVector=torque)
mbs.CreateForce(itemNumber=right, loadVector=[200., 300., -100.])
body = parts['oFFRFreducedOrder']
def sensor(kind, node):
    return mbs.AddSensor(eu.SensorSuperElement(bodyNumber=body, meshNodeNumber=node,
        outputVariableType=kind, storeInternal=True))
def marker_sensor(kind, marker):
    return mbs.AddSensor(eu.SensorMarker(
        markerNumber=marker, outputVariableType=kind, storeInternal=True))
sensors = {'position': sensor(exu.OutputVariableType.Position, rim),
    'displacement': sensor(exu.OutputVariableType.Displacement, rim),
    'velocity': sensor(exu.OutputVariableType.Velocity, rim),
    'left': marker_sensor(exu.OutputVariableType.Position, left),
    'right': marker_sensor(exu.OutputVariableType.Position, right),
    'turn': marker_sensor(exu.OutputVariableType.RotationMatrix, right)}
if has_stress:
    sensors['stress'] = sensor(exu.OutputVariableType.StressLocal, root)
"""
# largest difference between the two, as a share of the largest change of the signal: rigid turns
# agree to the 3D body's O(h²), small displacements but for second-order terms of the tilts
AGREEMENT = {
    "position": 2e-6,
    "displacement": 2e-6,
    "velocity": 3e-6,
    "turn": 3e-6,
    "left": 2e-3,
    "right": 2e-3,
    "stress": 2e-3,
}
DIRECTIONS = {
    "z": (np.eye(3), np.eye(3)),
    "x in the mesh": (TO_X, np.eye(3)),
    "y in space": (np.eye(3), TO_Y),
    "y in the mesh, x in space": (TO_Y, TO_X @ TO_Y.T),
    "skew in mesh and space": (SKEW, SKEW @ TO_Y),
}


@pytest.fixture(scope="module")
def fem():
    return disc_fem()


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
    result.timeIntegration.verboseMode = 0
    result.solution.file.write = False
    result.solution.sensors.writePeriod = end_time / steps
    return result


def run_script(call, fem, mesh, space):
    """Run the script with one of the calls, and return all sensor data."""
    mbs = exu.SystemContainer().AddSystem()
    model = turned(fem, mesh)
    nodes = np.asarray(fem.nodes["Position"])
    scene = {
        "mbs": mbs,
        "fem": model,
        "exu": exu,
        "eu": exudyn.utilities,
        "space": space,
        "place": [0.3, -0.2, 0.1],
        "omega": (space @ mesh @ [0.0, 0.0, 300.0]).tolist(),
        "velocity": (space @ mesh @ [0.02, -0.01, 0.03]).tolist(),
        "torque": (space @ mesh @ [20.0, 30.0, 250.0]).tolist(),
        "has_stress": bool(model.postProcessingModes),
        "rim": int(np.argmax(np.hypot(nodes[:, 0], nodes[:, 1]))),
        "root": int(np.argmin(np.linalg.norm(nodes - [0.02, 0, 0.2], axis=1))),
    }
    exec(SCRIPT.replace("CALL", call), scene)
    mbs.Assemble()
    mbs.SolveDynamic(settings(200, 4e-3))
    return {name: mbs.GetSensorStoredData(s)[:, 1:] for name, s in scene["sensors"].items()}


def test_returned_keys_are_those_of_exudyn(fem):
    given = [
        getattr(exu.SystemContainer().AddSystem(), call)(
            "shaft", fem, gravity=[0, 0, -9.81], **more
        )
        for call, more in ((OWN, {}), (TWIN, {"axis": "z"}))
    ]
    own, twin = given
    assert list(twin) == list(own)
    for key in ("nRigidBody", "nGenericODE2", "oFFRFreducedOrder", "loadGravity"):
        parts = [result["FFRFReducedOrderObjectDict"][key] for result in given]
        assert type(parts[0]) is type(parts[1]), key
    assert type(own["shaft:left"]) is type(twin["shaft:left"])


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_swapping_the_name_of_the_call_gives_the_same_motion(fem, direction):
    own, twin = (run_script(call, fem, *DIRECTIONS[direction]) for call in (OWN, TWIN))
    assert list(own) == list(twin)
    for name, signal in own.items():
        change = abs(signal - signal[0]).max()
        assert abs(twin[name] - signal).max() < AGREEMENT[name] * change, name


def test_offsets_of_markers_are_those_of_exudyn(fem, capfd):
    """In a mesh about x, whose axes are not those of the rotor's frame."""
    places, model = [], turned(fem, TO_X)
    for call, more in ((OWN, {}), (TWIN, {"axis": "x", "verbose": True})):
        mbs = exu.SystemContainer().AddSystem()
        offsets = [[0.1, 0.0, 0.2], [0.0, 0.3, 0.4]]
        made = getattr(mbs, call)("shaft", model, superElementRigidMarkersOffsets=offsets, **more)
        mbs.Assemble()
        markers = (made[f"shaft:{name}"] for name in ("left", "right"))
        places.append([mbs.GetMarkerOutput(m, exu.OutputVariableType.Position) for m in markers])
    np.testing.assert_allclose(places[1], places[0], atol=1e-9)
    assert "shaft" in capfd.readouterr().out


def test_a_second_import_leaves_assemble_as_it_is():
    wrapped = exu.MainSystem.Assemble
    reload(exudyn_call)
    assert exu.MainSystem.Assemble is wrapped
