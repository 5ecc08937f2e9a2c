"""Forced responses of unreduced rotors against dense, sparse direct and reduced solutions."""

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from models import STEEL, block_beam, centered_disc, disc_rotor
from point_rotors import ring_rotor

from exudyn_rotor import SolidRotor
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.models.full import subspace
from exudyn_rotor.linear.models.full.full_rotor import FullRotor
from exudyn_rotor.linear.response.harmonic_loads import BaseAcceleration, HarmonicForce
from exudyn_rotor.linear.response.steady_response import harmonic_response, unbalance_response
from exudyn_rotor.linear.response.unbalance import Unbalance
from exudyn_rotor.reduction.craig_bampton import craig_bampton_modes

SPEEDS = np.array([0.0, 100.0, 1000.0, 3000.0])
AXIAL = np.diag([1e7, 1e7, 1e6])
SUPPORTS = {
    "isotropic": [Support("left", AXIAL), Support("right", 1e7)],
    "damped": [Support("left", AXIAL, 300.0), Support("right", 1e7, 100.0, 1e4, 5.0)],
    "anisotropic": [Support("left", np.diag([1e7, 1.3e7, 1e6]), 300.0), Support("right", 1e7, 100)],
    "in the rotor": [Support("left", AXIAL, 300.0), Support("right", 1e7, 50.0, frame="rotor")],
    "axially free": [Support("left", 1e7, 300.0), Support("right", 1e7, 100.0)],
    "spin held": [Support("left", AXIAL, 9.0, np.diag([0, 0, 1e3])), Support("right", 1e7)],
}
DISC_SUPPORTS = [Support("left", np.diag([2e7, 2e7, 1e6]), 400.0), Support("right", 1e7, 400.0)]
DISC_UNBALANCES = [Unbalance("left", 1e-4), Unbalance("right", 2e-4, 1.0)]


@pytest.fixture(scope="module")
def beam() -> SolidRotor:
    """Return a coarse beam with internal damping and an eccentric mass."""
    mesh = block_beam(0.1)
    rotor = SolidRotor.from_ngsolve(mesh, STEEL, "z", order=1).center_interfaces()
    rotor = rotor.add_point_mass([0.02, 0.03, 0.3], 0.01)
    return SolidRotor(
        **{name: getattr(rotor, name) for name in rotor.__dataclass_fields__}
        | {"damping": sp.csr_array(2e-6 * rotor.stiffness)}
    )


@pytest.fixture(scope="module")
def complete(beam):
    """Return the same rotor in the basis of all its modes: dense equations, nothing left out."""
    return beam.reduce(3 * beam.node_count - 6)


@pytest.fixture(scope="module")
def disc() -> SolidRotor:
    """Return a disc on a shaft with 15 000 degrees of freedom.

    An uneven mesh would be off balance."""
    return disc_rotor(safety=2.0).center_interfaces()


def assert_same(found, expected, tolerance):
    """Compare all amplitudes at each speed or frequency, relative to the largest there."""
    assert found.places == expected.places
    np.testing.assert_array_equal(found.orders, expected.orders)
    difference = np.nanmax(np.abs(found.motion - expected.motion), axis=(1, 2, 3))
    size = np.nanmax(np.abs(expected.motion), axis=(1, 2, 3))
    assert np.all(difference <= tolerance * size)


@pytest.mark.parametrize("kind", SUPPORTS)
def test_unbalance_response_is_that_of_all_modes(beam, complete, kind):
    """Dense equations in all modes (harmonic balance tested in test_response) are the reference."""
    unbalances = [Unbalance("right", 1e-4, 0.3)]
    options = {"supports": SUPPORTS[kind], "at": ["left", "right", 3]}
    found = unbalance_response(beam, SPEEDS, unbalances, **options)
    assert_same(found, unbalance_response(complete, SPEEDS, unbalances, **options), 1e-8)


@pytest.mark.parametrize("kind", [kind for kind in SUPPORTS if kind != "axially free"])
@pytest.mark.parametrize("speed", [0.0, 500.0, -500.0])
def test_harmonic_response_is_that_of_all_modes(beam, complete, kind, speed):
    loads = [
        HarmonicForce([0.0, 0.03, 0.15], [1.0, 2.0j, 0.5]),
        HarmonicForce("right", (0.0, 0.0), (0.1, 0.0, 0.2), frame="rotor"),
        BaseAcceleration([1.0, 0.0, 0.2]),
    ]
    options = {"supports": SUPPORTS[kind], "at": ["left", (0.0, 0.0, 0.3)], "speed": speed}
    frequencies = [30.0, 500.0, 2000.0]
    found = harmonic_response(beam, frequencies, loads, **options)
    assert_same(found, harmonic_response(complete, frequencies, loads, **options), 1e-8)


def test_one_support_in_the_rotor_frame_is_seen_from_the_rotor(beam, complete):
    options = {"supports": SUPPORTS["anisotropic"], "frame": "rotor"}
    found = unbalance_response(beam, SPEEDS, **options)
    assert_same(found, unbalance_response(complete, SPEEDS, **options), 1e-8)


def test_jeffcott_rotor():
    """z = U Ω² / (k − mΩ² + i c Ω): Friswell, Penny, Garvey, Lees (2010), Sect. 6.2."""
    rotor = ring_rotor(0.1, 0.2, 10.0).with_interface("mid", range(10))
    speeds = np.array([100.0, 190.0, 200.0, 210.0, 600.0])
    supports = [Support("mid", 4e5, 200.0, 5e4, 10.0)]
    response = unbalance_response(rotor, speeds, [Unbalance("mid", 1e-4)], supports=supports)
    expected = 1e-4 * speeds**2 / (4e5 - 10.0 * speeds**2 + 200.0j * speeds)
    np.testing.assert_allclose(response.phasor("mid", "n1", 1), expected, rtol=1e-8)


def test_mesh_against_one_sparse_solution_at_each_speed(disc):
    """``(K + Ω²(K2 − C) + Σ UᵀkU + ΩUᵀcJU) x = Ω² h`` by a direct solver, isotropic supports.

    The axial spring and a stiff one on the mean spin hold the rigid motions of the sparse matrix.
    """
    speeds = np.array([700.0])
    supports = [*DISC_SUPPORTS, Support("left", tilt_stiffness=np.diag([0.0, 0.0, 1e6]))]
    options = {"supports": supports, "own": False, "at": ["left", "right"]}
    found = unbalance_response(disc, speeds, DISC_UNBALANCES, stiffening="none", **options)
    rows = np.array(
        [disc.interfaces[n].mean_motion(disc.node_count).toarray() for n in found.places]
    )
    load = rows[0, 0] * 1e-4 + 2e-4 * (np.cos(1.0) * rows[1, 0] + np.sin(1.0) * rows[1, 1])
    C = FullRotor.of(disc).invariants.C
    turn = np.zeros((6, 6))
    turn[0, 1], turn[1, 0] = -1.0, 1.0
    for i, speed in enumerate(speeds):
        blocks = [np.zeros((6, 6)), np.zeros((6, 6))]
        blocks[0] += np.diag([2e7, 2e7, 1e6, 0.0, 0.0, 1e6]) + 400.0 * speed * turn
        blocks[1] += np.diag([1e7, 1e7, 0.0, 0.0, 0.0, 0.0]) + 400.0 * speed * turn
        A = disc.stiffness - speed**2 * C
        for U, block in zip(rows, blocks, strict=True):
            U = sp.csr_array(U)
            A = A + U.T @ sp.csr_array(block) @ U
        x = spla.spsolve(sp.csc_array(A), speed**2 * load)
        amplitudes = (rows @ x)[:, :2] @ np.array([1.0, 1.0j])  # u1 + i u2 in the rotor frame
        forward = np.array([found.whirl(place, 1)[0][i] for place in found.places])
        np.testing.assert_allclose(forward, amplitudes, rtol=1e-6)


def test_reduced_rotor_converges_to_the_full_one():
    """Craig–Bampton with mean interface motions: Craig, Bampton, AIAA J. 6 (1968)."""
    disc = centered_disc()
    speeds = np.array([200.0, 700.0, 1500.0])
    exact = unbalance_response(disc, speeds, DISC_UNBALANCES, supports=DISC_SUPPORTS)
    errors = []
    for count in (4, 12, 40):
        reduced = disc.reduce(craig_bampton_modes(disc, count, coupling="RBE3"))
        found = unbalance_response(reduced, speeds, DISC_UNBALANCES, supports=DISC_SUPPORTS)
        difference = found.phasor("right", order=1) / exact.phasor("right", order=1) - 1.0
        errors.append(np.abs(difference).max())
    assert errors[0] > 10.0 * errors[1] > 10.0 * errors[2]
    assert errors[2] < 1e-4


def test_residual_that_is_not_reached_is_an_error(beam, monkeypatch):
    monkeypatch.setattr(subspace, "_MOST_ROUNDS", 1)
    with pytest.raises(ValueError, match=r"residual stays at .* above residual=1.0e-09"):
        unbalance_response(beam, [3000.0], supports=SUPPORTS["damped"])
    response = unbalance_response(beam, [3000.0], supports=SUPPORTS["damped"], residual=0.1)
    assert np.all(np.isfinite(response.motion[..., :3]))


def test_bad_residual_is_refused(beam):
    with pytest.raises(ValueError, match="residual: needs"):
        unbalance_response(beam, [3000.0], supports=SUPPORTS["damped"], residual=0.0)
