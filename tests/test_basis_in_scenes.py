"""Estimates of what a basis leaves out in a scene: as on the same supports, and true."""

from functools import cache

import exudyn as exu
import numpy as np
import pytest
from exudyn.rigidBodyUtilities import InertiaCuboid
from models import centered_disc
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    Support,
    Unbalance,
    add_rotor,
    add_supports,
    campbell,
    craig_bampton_modes,
    linear_model,
    stability,
    unbalance_response,
)
from exudyn_rotor.linear.models.basis.basis_error import NOT_KNOWN

SKEW = Rotation.from_rotvec([0.3, -0.5, 0.9]).as_matrix()
SPEEDS = [600.0, 1500.0]
UNBALANCE = Unbalance("left", 1e-4)
ISOTROPIC, ANISOTROPIC = 1e7, [[1e7, 2e6], [-1e6, 4e7]]

pytestmark = pytest.mark.filterwarnings("ignore:.*errs by about:UserWarning")


@cache
def reduced(modes):
    solid = centered_disc(order=1)
    how, count = modes.split()
    if how == "free":
        return solid.reduce(int(count))
    return solid.reduce(craig_bampton_modes(solid, int(count), coupling=how))


def supports(across):
    return [Support(name, across, damping=200.0) for name in ("left", "right")]


def on_supports(rotor, across, rotation=None, **options):
    """Return the linear model of a rotor on supports in a scene."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, rotation=rotation, stiffening="tilt", **options)
    add_supports(body, supports(across))
    mbs.Assemble()
    return linear_model(mbs, body=body, about="given")


@pytest.mark.parametrize(
    ("modes", "across", "options"),
    [
        ("free 4", ISOTROPIC, {"rotation": SKEW}),
        ("free 4", ANISOTROPIC, {"translation": "none"}),
        ("RBE3 2", ISOTROPIC, {"rotation": SKEW, "translation": "none"}),
    ],
)
def test_a_scene_errs_as_a_rotor_on_the_same_supports(modes, across, options):
    rotor = reduced(modes)
    given = {"supports": supports(across), "stiffening": "tilt"}
    scene = on_supports(rotor, across, spin=100.0, **options)
    expected = stability(rotor, SPEEDS, **given).basis_errors
    np.testing.assert_allclose(stability(scene, SPEEDS).basis_errors, expected, rtol=0.1)
    expected = unbalance_response(rotor, SPEEDS, [UNBALANCE], **given).basis_errors
    response = unbalance_response(scene, SPEEDS, [UNBALANCE])
    np.testing.assert_allclose(response.basis_errors, expected, rtol=0.1)
    compared = 0
    found, expected = campbell(scene, SPEEDS), campbell(rotor, SPEEDS, **given)
    for row in range(len(SPEEDS)):
        values, shifts = eigenvalues(found)[row], expected.basis_shifts[row]
        for value, shift in zip(eigenvalues(expected)[row], shifts, strict=True):
            at = np.argmin(np.abs(values - value))
            moves = abs(value) > 1.0 and np.isfinite(shift)
            if moves and abs(values[at] - value) < 1e-6 * abs(value):  # the spin is held in one
                assert abs(found.basis_shifts[row, at] - shift) < 0.1 * abs(shift)
                compared += 1
    assert compared >= 2 * 4


def eigenvalues(result):
    return result.growth + 1j * result.frequencies_rotor


def on_a_foundation(rotor, **options):
    """Return the linear model of a rotor, one of whose bearings stands on a block on springs."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, stiffening="tilt", spin=100.0, **options)
    place = rotor.interfaces["left"].reference
    inertia = InertiaCuboid(density=1000.0, sideLengths=[0.2, 0.2, 0.1])
    block = mbs.CreateRigidBody(referencePosition=list(place), inertia=inertia)
    ground = mbs.CreateGround()
    mbs.CreateCartesianSpringDamper(
        itemNumbers=[ground, block],
        localPosition0=list(place),
        stiffness=[2e7, 1e7, 1e7],
        damping=[100.0] * 3,
    )
    left, right = supports(ISOTROPIC)
    add_supports(body, left, block)
    add_supports(body, right)
    mbs.Assemble()
    return linear_model(mbs, body=body, about="given")


def test_estimates_with_a_foundation_are_the_errors_against_more_modes():
    few, many = (campbell(on_a_foundation(reduced(m)), [0.0]) for m in ("free 4", "RBE3 8"))
    values, true = eigenvalues(few)[0], eigenvalues(many)[0]
    moves = (np.abs(values) > 1.0) & np.isfinite(few.basis_shifts[0])
    errors = true[: len(values)][moves] - values[moves]
    assert moves.sum() == 6
    assert np.abs(errors).max() > 5e-3 * np.abs(values[moves]).max()
    assert np.abs(errors).min() < 1e-9 * np.abs(values[moves]).min()  # the block alone
    # those of the many modes are a hundredth
    np.testing.assert_allclose(few.basis_shifts[0, moves], errors, rtol=0.02, atol=1e-6)


def test_connections_that_are_no_interfaces_make_it_unknown():
    rotor = reduced("free 4")
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, spin=100.0)
    add_supports(body, supports(ISOTROPIC))
    ground, marker = mbs.CreateGround(), body.add_marker([0, 1, 2], kind="position")
    place = rotor.shapes.nodes[:3].mean(axis=0)
    mbs.CreateCartesianSpringDamper(
        itemNumbers=[ground, marker], localPosition0=list(place), stiffness=[1e6] * 3
    )
    mbs.Assemble()
    result = campbell(linear_model(mbs, body=body, about="given"), [600.0])
    assert result.basis_errors is None
    assert NOT_KNOWN in result.table()
