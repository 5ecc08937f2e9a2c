"""The twin of Exudyn's own call: one script, the name of the call swapped."""

import inspect

import exudyn as exu
import exudyn.utilities
import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface
from models import disc_fem
from run_scenes import item_counts
from scipy.spatial.transform import Rotation

import exudyn_rotor  # noqa: F401  adds the call to MainSystem

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


def test_signature_is_that_of_exudyn_with_more_at_the_end():
    own, twin = (
        inspect.signature(getattr(exu.MainSystem, call)).parameters for call in (OWN, TWIN)
    )
    assert list(twin)[: len(own)] == list(own)
    for name, parameter in own.items():
        default = twin[name].default
        if isinstance(parameter.default, (list, np.ndarray)):
            assert np.array_equal(default, parameter.default), name
        else:
            assert default is parameter.default or default == parameter.default, name
    extra = list(twin.values())[len(own) :]
    assert extra
    assert all(parameter.default is not inspect.Parameter.empty for parameter in extra)


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


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_marker_frames_follow_those_of_the_3d_body(fem, direction):
    """Offsets, positions and orientations of markers at rest and over one full turn."""
    mesh, space = DIRECTIONS[direction]
    offsets = np.array([[0.01, 0.0, 0.02], [0.0, -0.03, 0.0]]) @ mesh.T
    results = []
    for call in (OWN, TWIN):
        mbs = exu.SystemContainer().AddSystem()
        d = getattr(mbs, call)(
            "rotor",
            turned(fem, mesh),
            referencePosition=[1.0, 2.0, 3.0],
            referenceRotationMatrix=space,
            initialAngularVelocity=(space @ mesh @ [0.0, 0.0, 100.0]).tolist(),
            superElementRigidMarkersOffsets=offsets,
        )
        mbs.Assemble()
        kinds = exu.OutputVariableType.Position, exu.OutputVariableType.RotationMatrix
        rest = [
            mbs.GetMarkerOutput(d[name], kind, exu.ConfigurationType.Reference)
            for name in ("rotor:left", "rotor:right")
            for kind in kinds
        ]
        sensors = [
            mbs.AddSensor(
                exudyn.utilities.SensorMarker(
                    markerNumber=d[name], outputVariableType=kind, storeInternal=True
                )
            )
            for name in ("rotor:left", "rotor:right")
            for kind in kinds
        ]
        mbs.Assemble()
        mbs.SolveDynamic(settings(400, 2 * np.pi / 100.0))
        results.append((rest, [mbs.GetSensorStoredData(s)[:, 1:] for s in sensors]))
    (rest, motion), (twin_rest, twin_motion) = results
    for own, twin in zip(rest, twin_rest, strict=True):
        assert abs(own - twin).max() < 1e-12
    for own, twin in zip(motion, twin_motion, strict=True):
        # Euler parameters lag by (Ω h)² / 12 of the angle, which the rotor does not
        assert abs(own - twin).max() < 1.2 * (2 * np.pi / 400) ** 2 / 12 * 2 * np.pi


def test_a_script_without_names(fem):
    """As in Exudyn: markers are called like their boundaries, which must not be there already."""
    mbs = exu.SystemContainer().AddSystem()
    d = mbs.CreateFixedAxisFFRFReducedOrderObject(None, fem, axis="z")
    assert set(d) == {"FFRFReducedOrderObjectDict", "left", "right"}
    assert int(mbs.GetMarkerNumber("left")) == int(d["left"])
    with pytest.raises(ValueError, match="already has an item 'left'"):
        mbs.CreateFixedAxisFFRFReducedOrderObject(None, fem, axis="z")
    other = turned(fem, TO_X)
    other.nodeSets = [s | {"Name": s["Name"] + " 2"} for s in fem.nodeSets]
    mbs.CreateFixedAxisFFRFReducedOrderObject(None, other, axis="x")
    mbs.Assemble()


def test_rotor_beside_a_3d_body(fem):
    """Neither body notices the other."""

    def run(*calls):
        mbs = exu.SystemContainer().AddSystem()
        sensors = [
            mbs.AddSensor(
                exudyn.utilities.SensorMarker(
                    markerNumber=getattr(mbs, call)(
                        call, fem, initialAngularVelocity=[0.0, 0.0, 200.0], gravity=[0, -9.81, 0]
                    )[f"{call}:right"],
                    outputVariableType=exu.OutputVariableType.Velocity,
                    storeInternal=True,
                )
            )
            for call in calls
        ]
        mbs.Assemble()
        mbs.SolveDynamic(settings(50, 1e-3))
        return [mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in sensors]

    together = run(OWN, TWIN)
    for call, signal in zip((OWN, TWIN), together, strict=True):
        (alone,) = run(call)
        # both share the tolerance of Newton's method
        assert abs(signal - alone).max() < 1e-7 * abs(alone).max()


def test_verbose_prints_a_report(fem, capfd):
    exu.SystemContainer().AddSystem().CreateFixedAxisFFRFReducedOrderObject(
        "r", fem, axis="z", verbose=True
    )
    assert "Sect. 2.2" in capfd.readouterr().out


def bare_interface(fem):
    model = turned(fem, TO_X)
    model.modeBasis = {}
    return model


WRONG = {
    "transverse velocity": (
        {"axis": "z", "initialAngularVelocity": [1.0, 0.0, 100.0]},
        "1 rad/s across the spin axis",
    ),
    "spin twice": (
        {"axis": "z", "spin": 100.0, "initialAngularVelocity": [0.0, 0.0, 90.0]},
        "spin given twice",
    ),
    "offsets": (
        {"axis": "z", "superElementRigidMarkersOffsets": [[0.0, 0.0, 0.0]]},
        "needs 2 × 3 finite numbers for the interfaces left, right",
    ),
    "ragged offsets": (
        {"axis": "z", "superElementRigidMarkersOffsets": [[0.0], [0.0, 0.0]]},
        "superElementRigidMarkersOffsets",
    ),
    "color": ({"axis": "z", "color": [1.0, 0.0, 0.0]}, r"color: needs finite .* shape \(4,\)"),
    "reflection": (
        {"axis": "z", "referenceRotationMatrix": np.diag([1.0, 1.0, -1.0])},
        "referenceRotationMatrix: needs a rotation matrix",
    ),
    "nan": ({"axis": "z", "initialVelocity": [0.0, np.nan, 0.0]}, "initialVelocity"),
    "held": (
        {"axis": "z", "translation": "none", "initialVelocity": [1.0, 0.0, 0.0]},
        "translation='none' holds the rotor",
    ),
    "taken name": ({"axis": "z", "name": "taken"}, "give the second rotor another name"),
    "empty name": ({"axis": "z", "name": ""}, "name: needs a name that is not empty"),
    "no modes": ({"axis": "z", "femInterface": bare_interface}, "holds no modes"),
    "nothing imported": (
        {"axis": "z", "femInterface": lambda fem: FEMinterface()},
        "fem: massMatrix is missing",
    ),
    "no FEMinterface": ({"axis": "z", "femInterface": lambda fem: "rotor.npz"}, "FEMinterface"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_input_changes_nothing(fem, case):
    arguments, message = WRONG[case]
    mbs = exu.SystemContainer().AddSystem()
    mbs.CreateFixedAxisFFRFReducedOrderObject("taken", fem, axis="z")
    before = item_counts(mbs)
    arguments = {"name": "rotor", "femInterface": lambda fem: fem} | arguments
    arguments["femInterface"] = arguments["femInterface"](fem)
    with pytest.raises((ValueError, TypeError), match=message):
        mbs.CreateFixedAxisFFRFReducedOrderObject(**arguments)
    assert item_counts(mbs) == before


@pytest.mark.parametrize("turn", [np.eye(3), TO_X, TO_Y, SKEW], ids=["z", "x", "y", "skew"])
def test_rotor_at_rest_turns_about_the_line_through_its_seats(fem, turn):
    """The unevenness of the mesh is left out where the line is a mesh axis, and is small else."""
    mbs = exu.SystemContainer().AddSystem()
    made = mbs.CreateFixedAxisFFRFReducedOrderObject("rotor", turned(fem, turn))
    axis = made["FFRFReducedOrderObjectDict"]["rotorBody"].axis
    expected = turn @ [0.0, 0.0, 1.0]
    expected = expected * np.sign(expected[np.argmax(np.abs(expected))])
    tolerance = 1e-3 if turn is SKEW else 1e-15
    np.testing.assert_allclose(axis.direction, expected, atol=tolerance)


def test_rotor_at_rest_without_seats_needs_an_axis(fem):
    model = turned(fem, TO_X)
    model.nodeSets = model.nodeSets[:1]
    mbs = exu.SystemContainer().AddSystem()
    before = item_counts(mbs)
    with pytest.raises(ValueError, match="give axis='x'"):
        mbs.CreateFixedAxisFFRFReducedOrderObject("rotor", model)
    assert item_counts(mbs) == before


def test_the_translation_that_auto_stands_for(fem):
    """It must not depend on what comes later: free, unless the stiffness holds the rotor."""
    held = FEMinterface()
    held.nodes = {"Position": np.array([[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]])}
    held.massMatrix, held.stiffnessMatrix = sp.eye(6).tocsr(), 1e6 * sp.eye(6).tocsr()
    held.modeBasis = {"matrix": np.eye(6), "type": "NormalModes"}
    system = exu.SystemContainer().AddSystem
    for model, given, expected in (
        (fem, {}, "free"),
        (fem, {"gravity": [0, 0, 9.81], "initialVelocity": [1.0, 0, 0]}, "free"),
        (fem, {"translation": "in-plane"}, "in-plane"),
        (held, {"spin": 30.0}, "none"),
    ):
        made = getattr(system(), TWIN)(name=None, femInterface=model, axis="z", **given)
        body = made["FFRFReducedOrderObjectDict"]["rotorBody"]
        assert body.formulation.translation == expected
    with pytest.raises(ValueError, match="a prescribed spin"):
        getattr(system(), TWIN)(name=None, femInterface=held, axis="z")
    with pytest.raises(ValueError, match=r"translation.*auto"):
        getattr(system(), TWIN)(name=None, femInterface=fem, axis="z", translation="axial")


def test_what_is_returned_prints_short(fem):
    mbs = exu.SystemContainer().AddSystem()
    made = mbs.CreateFixedAxisFFRFReducedOrderObject("rotor", fem, axis="z")
    body = made["FFRFReducedOrderObjectDict"]["rotorBody"]
    assert repr(body) == (
        "RotorBody('rotor', Sect. 2.2, stiffening 'tilt', 8 modes, markers: left, right)"
    )
    assert len(repr(made)) < 400
