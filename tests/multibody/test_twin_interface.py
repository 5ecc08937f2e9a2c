"""The twin of Exudyn's class ObjectFFRFreducedOrderInterface: one script, one name swapped."""

import inspect

import exudyn as exu
import exudyn.utilities as eu
import numpy as np
import pytest
from exudyn.FEM import CMSObjectComputeNorm, FEMinterface, ObjectFFRFreducedOrderInterface
from models import disc_fem
from run_scenes import item_counts

from exudyn_rotor import ObjectFixedAxisFFRFreducedOrderInterface

CLASSES = ObjectFFRFreducedOrderInterface, ObjectFixedAxisFFRFreducedOrderInterface
METHODS = "__init__", "AddObjectFFRFreducedOrder", "AddObjectFFRFreducedOrderWithUserFunctions"
UNIT = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


@pytest.fixture(scope="module")
def fem():
    return disc_fem()


def made(kind, fem, **more):
    """Return the interface; the twin's axis is that of the angular velocity."""
    return kind(fem, **(more if kind is CLASSES[1] else {}))


def run_script(kind, fem, later=None, **more):
    """Run a script as Exudyn's examples are: the markers its own, bodies known by numbers."""
    mbs = exu.SystemContainer().AddSystem()
    cms = made(kind, fem, **more)
    rotor = cms.AddObjectFFRFreducedOrder(
        mbs,
        positionRef=[0.1, 0.0, 0.2],
        initialVelocity=[0.01, 0.02, 0.0],
        rotationMatrixRef=UNIT,
        initialAngularVelocity=[0.0, 0.0, 200.0],
        massProportionalDamping=10.0,
        stiffnessProportionalDamping=1e-6,
        gravity=[0.0, -9.81, 0.0],
        color=[0.1, 0.9, 0.1, 1.0],
        name="rotor",
    )
    if later is not None:
        number = rotor["oFFRFreducedOrder"]
        mbs.SetObjectParameter(
            objectNumber=number, parameterName="outputVariableModeBasis", value=later
        )
        mbs.SetObjectParameter(
            number, "outputVariableTypeModeBasis", exu.OutputVariableType.StressLocal
        )
    ground = mbs.CreateGround()
    sensors = []
    for z in (0.0, 0.5):
        nodes = fem.GetNodesInPlane([0, 0, z], [0, 0, 1])
        marker = mbs.AddMarker(
            eu.MarkerSuperElementPosition(
                bodyNumber=rotor["oFFRFreducedOrder"],
                meshNodeNumbers=nodes,
                weightingFactors=np.full(len(nodes), 1 / len(nodes)),
            )
        )
        center = np.mean(fem.GetNodePositionsAsArray()[nodes], axis=0)
        center += [0.1, 0.0, 0.2]
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, marker],
            localPosition0=center.tolist(),
            stiffness=[8e6, 5e6, 6e6],
            damping=[300.0, 200.0, 100.0],
        )
        sensors.append(
            mbs.AddSensor(
                eu.SensorMarker(
                    markerNumber=marker,
                    outputVariableType=exu.OutputVariableType.Displacement,
                    storeInternal=True,
                )
            )
        )
    peaks = []

    def peak(mbs, t):
        stress = exu.OutputVariableType.StressLocal
        peaks.append(CMSObjectComputeNorm(mbs, 0, stress, "Mises"))
        return True

    mbs.SetPreStepUserFunction(peak)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 100
    settings.timeIntegration.endTime = 2e-3
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 2e-5
    mbs.SolveDynamic(settings)
    motion = np.hstack([mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in sensors])
    return motion, np.array(peaks)


def test_names_and_defaults_are_those_of_exudyn():
    for method in METHODS:
        own, twin = (inspect.signature(getattr(kind, method)).parameters for kind in CLASSES)
        assert list(twin)[: len(own)] == list(own)
        for name, parameter in own.items():
            default = twin[name].default
            if isinstance(parameter.default, list):
                assert np.array_equal(default, parameter.default), (method, name)
            else:
                assert default == parameter.default, (method, name)


def test_returned_keys_and_attributes_are_those_of_exudyn(fem):
    own, twin = (made(kind, fem, axis="z") for kind in CLASSES)
    for name in ("nModes", "nNodes", "dim3D"):
        assert getattr(own, name) == getattr(twin, name)
    np.testing.assert_array_equal(own.xRef, twin.xRef)
    np.testing.assert_array_equal(own.modeBasis, twin.modeBasis)
    given = [
        cms.AddObjectFFRFreducedOrder(exu.SystemContainer().AddSystem(), gravity=[0, 0, -9.81])
        for cms in (own, twin)
    ]
    assert list(given[1]) == [*given[0], "rotorBody"]
    for key, number in given[0].items():
        assert type(number) is type(given[1][key])
        assert getattr(twin, key) is given[1][key]
    assert int(given[0]["oFFRFreducedOrder"]) == int(given[1]["oFFRFreducedOrder"]) == 0


@pytest.mark.parametrize("locking", ["mass", "constraints"])
@pytest.mark.parametrize("later", [False, True], ids=["stress before", "stress set later"])
def test_swapping_the_name_of_the_class_gives_motion_and_stress(fem, later, locking):
    """Stress by body number 0, and with one set of columns per mode of the FEMinterface.

    The bounds are those of the other call: 2e-3 of the motion, by second-order terms of the tilts.
    """
    model, stress = fem, None
    if later:
        model, stress = bare(fem), fem.postProcessingModes["matrix"]
    own, twin = (
        run_script(kind, model, stress, locking=locking, translation="free") for kind in CLASSES
    )
    for signal, other in zip(own, twin, strict=True):
        assert abs(signal).max() > 0.0
        assert abs(other - signal).max() < 2e-3 * abs(signal - signal[0]).max()


def bare(fem):
    """Return the FEMinterface without its stress modes."""
    model = FEMinterface()
    for name in ("nodes", "massMatrix", "stiffnessMatrix", "modeBasis", "surface", "nodeSets"):
        setattr(model, name, getattr(fem, name))
    return model


def test_orientation_by_euler_parameters(fem):
    half = np.sqrt(0.5)
    mbs = exu.SystemContainer().AddSystem()
    cms = ObjectFixedAxisFFRFreducedOrderInterface(fem, axis="z")
    body = cms.AddObjectFFRFreducedOrderWithUserFunctions(
        exu, mbs, eulerParametersRef=[half, half, 0.0, 0.0], initialAngularVelocity=[0, -30.0, 0]
    )["rotorBody"]
    np.testing.assert_allclose(
        body.plan.setup.placement.rotation @ [0, 0, 1], [0, -1, 0], atol=1e-15
    )
    assert body.plan.setup.placement.speed == pytest.approx(30.0, rel=1e-14)


def test_a_file_keeps_the_rotor(fem, tmp_path):
    """An empty interface adds what another has saved."""
    cms = ObjectFixedAxisFFRFreducedOrderInterface(fem, axis="z", translation="none", spin=10.0)
    cms.SaveToFile(tmp_path / "rotor")
    empty = ObjectFixedAxisFFRFreducedOrderInterface(translation="none", spin=10.0)
    assert empty.LoadFromFile(str(tmp_path / "rotor.npz")) == 1
    bodies = [
        one.AddObjectFFRFreducedOrder(exu.SystemContainer().AddSystem())["rotorBody"]
        for one in (cms, empty)
    ]
    stiffness = [body.motion.invariants.K for body in bodies]
    np.testing.assert_array_equal(*stiffness)
    assert (empty.nModes, empty.nNodes) == (cms.nModes, cms.nNodes)
    with pytest.raises(ValueError, match="spin axis is"):
        ObjectFixedAxisFFRFreducedOrderInterface(axis="x").LoadFromFile(tmp_path / "rotor.npz")


WRONG = {
    "user function": ({"UFforce": lambda *given: 0.0}, "UFforce: needs 0"),
    "mass function": ({"UFmassMatrix": 3}, "UFmassMatrix: needs 0"),
    "two orientations": (
        {"eulerParametersRef": [1.0, 0, 0, 0], "rotationMatrixRef": UNIT},
        "given twice",
    ),
    "norm": ({"eulerParametersRef": [1.0, 1.0, 0, 0]}, "eulerParametersRef: needs 4 numbers"),
    "position": ({"positionRef": [0.0, np.nan, 0.0]}, "positionRef"),
    "reflection": ({"rotationMatrixRef": -np.eye(3)}, "rotationMatrixRef: needs a rotation"),
    "across": ({"initialAngularVelocity": [0.0, 1.0, 9.0]}, "across the spin axis"),
    "name": ({"name": " "}, "name: needs a name"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_input_changes_nothing(fem, case):
    arguments, message = WRONG[case]
    mbs = exu.SystemContainer().AddSystem()
    cms = ObjectFixedAxisFFRFreducedOrderInterface(fem, axis="z")
    before = item_counts(mbs)
    with pytest.raises((ValueError, TypeError), match=message):
        cms.AddObjectFFRFreducedOrderWithUserFunctions(exu, mbs, **arguments)
    assert item_counts(mbs) == before


def test_an_interface_without_a_model(fem, tmp_path):
    mbs = exu.SystemContainer().AddSystem()
    with pytest.raises(ValueError, match="femInterface: this interface is empty"):
        ObjectFixedAxisFFRFreducedOrderInterface().AddObjectFFRFreducedOrder(mbs)
    model = bare(fem)
    model.modeBasis = {}
    with pytest.raises(ValueError, match="holds no modes"):
        ObjectFixedAxisFFRFreducedOrderInterface(model)
    with pytest.raises(ValueError, match="nothing to save before the spin axis is known"):
        ObjectFixedAxisFFRFreducedOrderInterface(fem).SaveToFile(tmp_path / "rotor")
