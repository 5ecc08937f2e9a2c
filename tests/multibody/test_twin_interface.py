"""The twin of Exudyn's class ObjectFFRFreducedOrderInterface: one script, one name swapped."""

import exudyn as exu
import exudyn.utilities as eu
import numpy as np
import pytest
from exudyn.FEM import CMSObjectComputeNorm, ObjectFFRFreducedOrderInterface
from models import disc_fem

from exudyn_rotor import ObjectFixedAxisFFRFreducedOrderInterface

CLASSES = ObjectFFRFreducedOrderInterface, ObjectFixedAxisFFRFreducedOrderInterface
UNIT = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


@pytest.fixture(scope="module")
def fem():
    return disc_fem()


def made(kind, fem, **more):
    """Return the interface; the twin's axis is that of the angular velocity."""
    return kind(fem, **(more if kind is CLASSES[1] else {}))


def run_script(kind, fem, **more):
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
def test_swapping_the_name_of_the_class_gives_motion_and_stress(fem, locking):
    """Stress by body number 0, and with one set of columns per mode of the FEMinterface.

    The bounds are those of the other call: 2e-3 of the motion, by second-order terms of the tilts.
    """
    own, twin = (run_script(kind, fem, locking=locking, translation="free") for kind in CLASSES)
    for signal, other in zip(own, twin, strict=True):
        assert abs(signal).max() > 0.0
        assert abs(other - signal).max() < 2e-3 * abs(signal - signal[0]).max()


def test_stress_modes_of_a_fem_interface_come_before_the_rotor(fem):
    mbs = exu.SystemContainer().AddSystem()
    made = ObjectFixedAxisFFRFreducedOrderInterface(fem, axis="z").AddObjectFFRFreducedOrder(mbs)
    columns = fem.postProcessingModes["matrix"]
    mbs.SetObjectParameter(made["oFFRFreducedOrder"], "outputVariableModeBasis", columns)
    with pytest.raises(ValueError, match=r"outputVariableModeBasis: .* needs the shape"):
        mbs.Assemble()
