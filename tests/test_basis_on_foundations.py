"""Estimates of what a basis leaves out on foundations and magnetic bearings, against more modes."""

from functools import cache

import numpy as np
import pytest
from models import centered_disc

from exudyn_rotor import (
    Foundation,
    HarmonicForce,
    LinearActuator,
    MagneticBearing,
    Mount,
    PIDController,
    SolidRotor,
    Support,
    Unbalance,
    campbell,
    craig_bampton_modes,
    critical_speeds,
    harmonic_response,
    linear_model,
    stability,
    unbalance_response,
)

PLACES = {"left": [0.0, 0.0, 0.0], "right": [0.0, 0.0, 0.5]}
BLOCK = Foundation.rigid(
    40.0,
    [10.0, 10.0, 5.0],
    [0.0, -0.05, 0.25],
    [Mount([x, -0.1, z], 3e6, 100.0) for x in (-0.1, 0.1) for z in (0.0, 0.5)],
    PLACES,
)
CONTROLLER = PIDController(
    proportional=2e4, derivative=25.0, filter_frequency=2e4, amplifier_frequency=1e4
)
LEVITATED = [
    MagneticBearing(interface=name, actuator=LinearActuator(2e3, 1e6), controller=CONTROLLER)
    for name in PLACES
]
HELD = [Support(name, 4e7, damping=200.0) for name in PLACES]
KINDS = {
    "foundation": {"supports": HELD, "foundation": BLOCK},
    "magnetic": {"supports": LEVITATED},
    "both": {"supports": LEVITATED, "foundation": BLOCK},
}
SPEED, LIMIT = 1500.0, 4000.0  # rad/s, the latter of eigenvalues that are looked at
# share of an estimate that the shapes leave out which even the finer basis lacks: those of 4 modes
# are most of what is missing
SHARE = 0.02


@cache
def rotors():
    """Return the rotor with 4 free modes, whose bending lacks flexibility, and the true one."""
    solid = centered_disc(order=1)
    return solid.reduce(4), solid.reduce(craig_bampton_modes(solid, 16, coupling="RBE3"))


@cache
def pair(kind):
    return tuple(linear_model(rotor, **KINDS[kind]) for rotor in rotors())


@pytest.mark.parametrize("kind", KINDS)
def test_shifts_of_modes(kind):
    few, true = pair(kind)
    found, expected = campbell(few, [0.0, SPEED]), campbell(true, [0.0, SPEED], accuracy=None)
    for row in range(2):
        values, known = (
            each.growth[row] + 1j * each.frequencies_rotor[row] for each in (found, expected)
        )
        shifts = found.basis_shifts[row]
        seen = np.isfinite(shifts) & (np.abs(values) < LIMIT) & (np.abs(shifts) > 0.01)
        assert seen.sum() > 5
        values, shifts = values[seen], shifts[seen]
        errors = known - values[:, None]
        errors = errors[np.arange(len(values)), np.abs(errors - shifts[:, None]).argmin(axis=1)]
        assert np.all(np.abs(errors - shifts) < SHARE * np.abs(errors) + 5e-5 * np.abs(values))
        assert np.abs(shifts / values).max() > 0.01


FORCE = HarmonicForce("left", [1.0, 0.0, 0.0])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("load", ["unbalance", "force"])
def test_errors_of_responses(kind, load):
    """In the largest harmonic, at journals and below one of them."""
    few, true = pair(kind)
    at = [*PLACES, *few.standing_interfaces[:1]]

    def response(model, **given):
        given |= {"at": at}
        if load == "force":
            return harmonic_response(model, [300.0, 900.0], FORCE, speed=SPEED, **given)
        return unbalance_response(model, [500.0, SPEED], Unbalance("left", 1e-4), **given)

    found, expected = response(few), response(true, accuracy=None)
    largest = np.abs(expected.motion).max(axis=(0, 1, 3)).argmax()
    row = found.orders.tolist().index(expected.orders[largest])
    moved = expected.motion[:, :, largest, :3]
    apart = np.linalg.norm(found.motion[:, :, row, :3] - moved, axis=2)
    size = np.linalg.norm(moved, axis=2)
    errors = apart / np.maximum(size, 0.1 * size.max(axis=1, keepdims=True))
    np.testing.assert_allclose(found.basis_errors, errors, rtol=SHARE, atol=1e-4)
    assert errors.max() > 0.01


@pytest.mark.parametrize("kind", KINDS)
def test_errors_of_critical_speeds_and_of_the_least_stable_motion(kind):
    few, true = pair(kind)
    given = {"max_speed": 4000.0, "nodal_diameters": [1]}
    found, expected = critical_speeds(few, **given), critical_speeds(true, accuracy=None, **given)
    assert len(found.speeds) == len(expected.speeds)
    # the mesh splits pairs by as much as the basis shifts some of them
    errors = np.abs(found.speeds / expected.speeds - 1.0)
    np.testing.assert_allclose(found.basis_errors, errors, rtol=0.05, atol=1e-6)
    assert np.sum(errors > 5e-3) > 2
    ours, theirs = stability(few, [SPEED]), stability(true, [SPEED], accuracy=None)
    value, shift = ours.exponents[0, ours.least_stable[0]], ours.basis_shifts[0]
    errors = theirs.exponents[0] - value
    nearest = errors[np.abs(errors - shift).argmin()]
    # above magnets a fast motion, whose value changes by a fifth: to the second order
    assert abs(nearest - shift) < 0.05 * abs(shift) + 1e-6 * abs(value)


def test_what_the_rotor_does_not_feel_has_no_error():
    """A block that moves along its shaft, which bearings leave free: √(8 · 3e6 / 40)."""
    mounts = [
        Mount([x, y, z], 3e6)
        for x, y in ((-0.1, 0.0), (0.1, 0.0), (0.0, -0.1), (0.0, 0.1))
        for z in (0.0, 0.5)
    ]
    block = Foundation.rigid(40.0, [10.0, 10.0, 5.0], [0.0, 0.0, 0.25], mounts, PLACES)
    model = linear_model(rotors()[0], supports=HELD, foundation=block)
    found = critical_speeds(model, max_speed=800.0)
    axial = np.abs(found.speeds - np.sqrt(8 * 3e6 / 40.0)).argmin()
    assert found.basis_errors[axial] < 1e-9
    assert found.basis_errors.max() > 1e-3


def test_a_full_rotor_leaves_nothing_out():
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    ends = np.array(list(PLACES.values()))
    rotor = SolidRotor.from_matrices(np.eye(6), rod, ends, "z")
    for number, name in enumerate(PLACES):
        rotor = rotor.with_interface(name, [number])
    model = linear_model(rotor, **KINDS["both"])
    assert not np.any(campbell(model, [SPEED]).basis_errors)
