"""Campbell diagrams of full models: the few lowest modes of large matrices."""

import numpy as np
import pytest
from models import STEEL, block_beam

from exudyn_rotor import SolidRotor, campbell
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.models.full.full_rotor import FullRotor


@pytest.mark.parametrize("ratio", [1.0, 1.3], ids=["constant", "periodic"])
def test_subspace_of_a_full_model_meets_the_dense_solution(ratio):
    """Eigenvalues are accurate to about the square of the residual, 1e-10."""
    beam = SolidRotor.from_ngsolve(block_beam(0.1), STEEL, "z", order=1).center_interfaces()
    left = Support("left", np.diag([1e7, ratio * 1e7, 1e6]), 50.0)
    supports = [left, Support("right", 1e7)]
    subspace = FullRotor.of(beam, supports).space(8, 900.0, residual=1e-5)
    for speed in (300.0, 900.0):
        found = subspace.modes(speed, 1e-8).values
        given = {"supports": supports, "stiffening": "tilt", "frame": "rotor"}
        dense = campbell(beam, speed, modes=8, **given)
        np.testing.assert_allclose(found.imag, dense.frequencies_rotor[0], rtol=1e-8, atol=1e-3)
        np.testing.assert_allclose(found.real, dense.growth[0], rtol=1e-6, atol=1e-3)


def test_full_model_is_solved_for_the_modes_that_are_lowest_as_they_are_asked_for():
    """Dense equations of all coordinates are the reference; backward whirl is fast in the rotor."""
    beam = SolidRotor.from_ngsolve(block_beam(0.1), STEEL, "z", order=1).center_interfaces()
    supports = [Support(name, np.diag([1e7, 1e7, 1e6])) for name in ("left", "right")]
    speeds, chosen = [4000.0, 5000.0], {}
    for frame in ("inertial", "rotor"):
        options = {"modes": 4, "frame": frame}
        found = campbell(FullRotor.of(beam, supports), speeds, **options)
        dense = campbell(beam, speeds, supports=supports, stiffening="tilt", **options)
        for name in ("frequencies_inertial", "frequencies_rotor"):
            values, expected = getattr(found, name), getattr(dense, name)
            np.testing.assert_allclose(values, expected, rtol=1e-6, atol=1e-3)
        chosen[frame] = np.sort(dense.frequencies_inertial[0])
    assert np.abs(chosen["inertial"] - chosen["rotor"]).max() > 1.0


def test_large_full_model_by_its_residual():
    """The equations (104) written out with nodal rotations, on modes of a mesh."""
    rotor = SolidRotor.from_ngsolve(block_beam(0.03), STEEL, "z")
    assert 3 * rotor.node_count > 600
    speed = 500.0
    result = campbell(rotor, speed, stiffening="none")
    assert result.frequencies_rotor.shape == (1, 10)
    assert len(result.free_motions) == 6
    turn = np.kron(np.eye(rotor.node_count), rotor.axis.skew)
    eigenvalues = result.growth[0] + 1j * result.frequencies_rotor[0]
    M, K = rotor.mass, rotor.stiffness
    spin = M @ (turn @ (rotor.nodes - rotor.center_of_mass).ravel())
    spin /= np.sqrt(spin @ (turn @ (rotor.nodes - rotor.center_of_mass).ravel()))
    for value, x in zip(eigenvalues, result.vectors[0].T, strict=True):
        velocity = value * x + speed * (turn @ x)
        inertia = M @ (value * velocity + speed * (turn @ velocity))
        # the spin is an exact rotation, which the centrifugal field does not feel at any level
        inertia += speed**2 * (spin @ x) * spin
        energy = np.abs(x.conj() @ (K @ x)) + np.abs(x.conj() @ (M @ x)) * speed**2
        assert np.abs(x.conj() @ (inertia + K @ x)) < 1e-6 * energy
