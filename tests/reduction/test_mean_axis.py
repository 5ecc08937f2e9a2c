"""Modes in a mean-axis frame, and how Exudyn's own body errs with Craig–Bampton modes."""

import warnings

import exudyn as exu
import numpy as np
import pytest
import scipy.linalg
from exudyn.FEM import FEMinterface, HCBstaticModeSelection
from models import disc_fem

from exudyn_rotor import SolidRotor, use_mean_axis_modes
from exudyn_rotor.reduction.component import rigid_columns

OWN, TWIN = "CreateFFRFReducedOrderObject", "CreateFixedAxisFFRFReducedOrderObject"
SPEED = 500.0


def copy(fem, modes=None):
    """Return the FEMinterface with other modes, which may be replaced."""
    model = FEMinterface()
    for name in ("nodes", "massMatrix", "stiffnessMatrix", "surface", "nodeSets"):
        setattr(model, name, getattr(fem, name))
    model.modeBasis = {"matrix": fem.modeBasis["matrix"] if modes is None else modes, "type": "x"}
    return model


@pytest.fixture(scope="module")
def held():
    """Craig–Bampton modes as in Exudyn's examples, of a disc on a shaft."""
    fem = copy(disc_fem())
    seats = [node_set["NodeNumbers"] for node_set in fem.nodeSets]
    fem.ComputeHurtyCraigBamptonModes(seats, 4, computationMode=HCBstaticModeSelection.RBE2)
    return fem


@pytest.fixture(scope="module")
def solid(held):
    return SolidRotor.from_fem_interface(held, "z")


def rigid_of(solid):
    return rigid_columns(solid.nodes, solid.axis, solid.center_of_mass)


def test_modes_lose_their_momentum_and_nothing_else(held, solid):
    fem = copy(held)
    assert use_mean_axis_modes(fem) == ()
    rigid, mass = rigid_of(solid), solid.mass
    before, after = held.modeBasis["matrix"], fem.modeBasis["matrix"]
    size = np.sqrt(np.outer(np.diag(rigid.T @ (mass @ rigid)), np.diag(after.T @ (mass @ after))))
    assert np.all(np.abs(rigid.T @ (mass @ after)) < 1e-10 * size)
    # with the rigid motions they span what they did
    both = scipy.linalg.orth(np.hstack([rigid, before]))
    np.testing.assert_allclose(after, both @ (both.T @ after), atol=1e-9 * np.abs(after).max())
    assert np.linalg.matrix_rank(after) == before.shape[1]
    # deformation energies stay
    np.testing.assert_allclose(
        after.T @ (solid.stiffness @ after),
        before.T @ (solid.stiffness @ before),
        atol=1e-9 * np.abs(before.T @ (solid.stiffness @ before)).max(),
    )


def whirl(call, fem, **more):
    """Return the path of a journal of an unbalanced rotor on two bearings over some turns."""
    mbs = exu.SystemContainer().AddSystem()
    omega = [0.0, 0.0, SPEED]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        made = getattr(mbs, call)("rotor", fem, initialAngularVelocity=omega, **more)
    ground = mbs.CreateGround()
    mbs.Assemble()
    sensor = None
    for name in ("rotor:left", "rotor:right"):
        marker = made[name]
        place = mbs.GetMarkerOutput(
            marker, exu.OutputVariableType.Position, exu.ConfigurationType.Reference
        )
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, marker],
            localPosition0=list(place),
            stiffness=[2e6] * 3,
            damping=[500.0] * 3,
        )
        sensor = mbs.AddSensor(
            exu.utilities.SensorMarker(
                markerNumber=marker,
                outputVariableType=exu.OutputVariableType.Displacement,
                storeInternal=True,
            )
        )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 250
    settings.timeIntegration.endTime = 0.025
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-4
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)[:, 1:3]


def test_exudyns_body_agrees_in_the_mean_axis_frame_only(held):
    """With the first boundary as its frame it softens falsely; the fixed axis does not."""
    held = copy(held)
    held.massMatrix = held.massMatrix.copy()
    rim = int(np.argmax(held.GetNodePositionsAsArray()[:, 0]))
    held.AddNodeMass(rim, 0.01)
    mean = copy(held)
    use_mean_axis_modes(mean)
    twin = whirl(TWIN, held, axis="z")
    size = np.abs(twin).max()
    np.testing.assert_allclose(whirl(TWIN, mean, axis="z"), twin, atol=1e-6 * size)
    away = [np.abs(whirl(OWN, fem) - twin).max() / size for fem in (held, mean)]
    # 2e-3, as the other tests of the swapped call: second order in the tilt, and O(h²) of the turn
    assert away[1] < 2e-3
    assert away[0] > 10.0 * away[1]


def test_stress_of_modes_goes_with_them(solid):
    rigid = rigid_of(solid)
    fem = copy(disc_fem(), np.hstack([rigid, disc_fem().modeBasis["matrix"]]))
    fem.postProcessingModes = {"matrix": np.arange(72.0)[None]}  # six columns of each mode
    assert use_mean_axis_modes(fem) == tuple(range(6))
    np.testing.assert_array_equal(fem.postProcessingModes["matrix"], [np.arange(36.0, 72.0)])
    with pytest.raises(ValueError, match="are rigid motions alone"):
        use_mean_axis_modes(copy(disc_fem(), rigid))
