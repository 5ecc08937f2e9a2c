"""Runs that begin in the steady motion of a linear response stay in it."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from point_rotors import SKEW_AXIS, ring_rotor
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    HarmonicForce,
    Support,
    UnbalanceResponse,
    add_rotor,
    harmonic_response,
    recommended_settings,
    unbalance_response,
)
from exudyn_rotor.multibody.rotor.start_state import spin_at_start

RADIUS, LENGTH, MASS = 0.1, 0.2, 8.0
STIFFNESS, DAMPING = 2e4, 40.0  # N/m, N s/m, of each of the two bearings
CRITICAL = np.sqrt(2 * STIFFNESS / MASS)  # rad/s
ENDS = {"left": -LENGTH, "right": LENGTH}
POSITION = exu.OutputVariableType.Displacement
AXES = {"x": [1.0, 0.0, 0.0], "z": [0.0, 0.0, 1.0], "skew": SKEW_AXIS}


def rotor(axis="z", excess=0.002):
    """Return two rings about any axis of the mesh, eccentric and with a product of inertia."""
    turn = to_axis(axis)
    nodes = ring_rotor(RADIUS, LENGTH, MASS).nodes @ turn.T
    plain = ring_rotor(RADIUS, LENGTH, MASS)
    turned = np.kron(np.eye(len(nodes)), turn)
    made = type(plain).from_matrices(
        plain.mass, turned @ plain.stiffness.toarray() @ turned.T, nodes, AXES[axis]
    )
    if excess:
        made = made.add_point_mass(turn @ [RADIUS, 0.0, LENGTH], excess)
    for name, z in ENDS.items():
        numbers = np.flatnonzero(np.isclose(plain.nodes[:, 2], z))
        made = made.with_interface(name, numbers)
    return made.reduce(2)


def to_axis(axis):
    """Return the rotation that takes z to an axis."""
    return Rotation.align_vectors([AXES[axis]], [[0.0, 0.0, 1.0]])[0].as_matrix()


def scene(reduced, stiffness, **options):
    """Return the rotor on two bearings that stand still, stiffness along n1, n2, e."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, stiffening="tilt", **options)
    axes = np.column_stack([reduced.axis.plane, reduced.axis.direction])
    K, D = (axes @ np.diag(values) @ axes.T for values in (stiffness, [DAMPING] * 3))

    def force(mbs, t, item, u, v, k, d, offset):
        return (K @ u + D @ v).tolist()

    for name in ENDS:
        reference = reduced.interfaces[name].reference
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[mbs.CreateGround(), body.marker(name)],
            localPosition0=reference,
            springForceUserFunction=force,
        )
    mbs.Assemble()
    return mbs, body


def supports(stiffness):
    K = np.diag(stiffness)
    return [Support(name, K, DAMPING * np.eye(3)) for name in ENDS]


def distances(mbs, body, response, value, steps):
    """Return by how much a run ends off the response, over its largest motion, shape (2, 3)."""
    end = 0.75 * 2 * np.pi / response.rates(1).max()
    angle = spin_at_start(body)[0]
    settings = recommended_settings(end, end / steps, accuracy=1e-7)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    axes = np.column_stack([body.axis.plane, body.axis.direction])
    away = []
    index = int(np.argmin(np.abs(response.abscissa - value)))
    for name in ENDS:
        phase = np.array(
            [np.exp(1j * (response.rates(n)[index] * end + n * angle)) for n in response.orders]
        )
        motion = response.motion[index, response.places.index(name)]
        expected = axes @ (phase @ motion).real[:3]
        found = mbs.GetMarkerOutput(body.marker(name), POSITION)
        away.append((found - expected) / np.abs(response.motion[index, ..., :3]).max())
    return np.array(away)


# share of the motion that a start off the steady state leaves after steps of 1/67 and 1/133 of a
# revolution are extrapolated: their error, below 0.05, in second order, and that of stiff elastic
# modes. Linear equations leave out the spin's share m e²/Θ = 1e-7, more at resonance
NO_TRANSIENT = 5e-4


def stays(response, value, build):
    """Assert that only the error of the step is left."""
    coarse, fine = (distances(*build(), response, value, steps=n) for n in (50, 100))
    assert np.abs(coarse).max() < 0.05
    assert np.abs(4.0 * fine - coarse).max() / 3.0 < NO_TRANSIENT


@pytest.mark.parametrize("translation", ["none", "free", "in-plane"])
@pytest.mark.parametrize(
    ("axis", "stiffness"), [("z", (1, 1, 1)), ("z", (1, 1.4, 1)), ("x", (1, 1.4, 1))]
)
def test_run_begins_in_steady_whirl(translation, axis, stiffness):
    """Centre of mass 25 µm off the axis, supports alike and not, level 'tilt'."""
    K = STIFFNESS * np.array(stiffness)
    reduced, speed = rotor(axis), 0.7 * CRITICAL
    response = unbalance_response(
        reduced, [0.5 * speed, speed], supports=supports(K), stiffening="tilt"
    )

    def build():
        mbs, body = scene(reduced, K, spin=speed, translation=translation)
        body.start_from(response.state(speed, body))
        return mbs, body

    stays(response, speed, build)


@pytest.mark.parametrize("translation", ["none", "free"])
@pytest.mark.parametrize("whole_scene", [False, True])
def test_run_under_a_harmonic_force_begins_in_its_response(translation, whole_scene):
    """A force that turns backward at 1.3 Ω, on a spinning rotor."""
    K = STIFFNESS * np.array([1.0, 1.4, 1.0])
    reduced, speed = rotor(excess=0.0), 0.4 * CRITICAL
    load, rate = HarmonicForce("left", [3.0, -3.0j, 0.0]), 1.3 * speed

    def build():
        mbs, body = scene(reduced, K, spin=speed, translation=translation)
        axes = np.column_stack([reduced.axis.plane, reduced.axis.direction])
        mbs.AddLoad(
            exu.itemInterface.LoadForceVector(
                markerNumber=body.marker("left"),
                loadVectorUserFunction=lambda mbs, t, given: (
                    3.0 * axes @ [np.cos(rate * t), np.sin(rate * t), 0.0]
                ).tolist(),
            )
        )
        mbs.Assemble()
        return mbs, body

    target = {"target": reduced, "supports": supports(K)}
    if whole_scene:
        mbs, body = scene(reduced, K, spin=speed, translation=translation)
        target = {"target": mbs, "body": body}
    response = harmonic_response(frequencies=[rate], loads=load, speed=speed, **target)

    def started():
        mbs, body = build()
        body.start_from(response.state(rate, body))
        return mbs, body

    stays(response, rate, started)


def test_responses_that_cannot_start_a_run_are_refused():
    reduced, speed = rotor(), 0.7 * CRITICAL
    on = supports(STIFFNESS * np.ones(3))
    response = unbalance_response(reduced, [speed], supports=on)
    _, body = scene(reduced, STIFFNESS * np.ones(3), spin=speed)
    with pytest.raises(ValueError, match="not computed at 50 rad/s"):
        response.state(50.0, body)
    with pytest.raises(TypeError, match="body: needs"):
        response.state(speed, "rotor")
    without = UnbalanceResponse(
        response.places, response.orders, response.motion, "inertial", [speed]
    )
    with pytest.raises(ValueError, match="without component modes"):
        without.state(speed, body)
    with pytest.raises(ValueError, match="coordinates, basis: need each other"):
        replace(response, coordinates=None)
    for other in (rotor("x"), rotor(excess=0.1)):
        with pytest.raises(ValueError, match="another rotor than that"):
            unbalance_response(other, [speed], supports=on).state(speed, body)
    _, faster = scene(reduced, STIFFNESS * np.ones(3), spin=2.0 * speed)
    with pytest.raises(ValueError, match="the prescribed spin starts at"):
        faster.start_from(response.state(speed, faster))
