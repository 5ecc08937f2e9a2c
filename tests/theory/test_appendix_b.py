"""Every printed matrix and frequency of the paper's Appendix B: two masses on springs.

Source: Zwölfer, Rasmussen, Santos, SSRN 4830498, Eqs. (116–129). All numbers are exact integers
or printed with 15 digits, and the eigenvalue problems are well conditioned: 1e-12 relative.
"""

import numpy as np
import pytest
from spatial_frame import tilde_basis

from exudyn_rotor import Invariants, SolidRotor, free_modes

STIFFNESS = 1e4 * np.array(
    [  # (123)
        [272, 0, 0, -128, 0, 0],
        [0, 196, 0, 0, 0, 0],
        [0, 0, 100, 0, 0, 0],
        [-128, 0, 0, 272, 0, 0],
        [0, 0, 0, 0, 196, 0],
        [0, 0, 0, 0, 0, 100],
    ]
)
MODES = np.array(
    [  # (124)
        [0, 0, 1, 0, 0, -1],
        [0, 0, 0, 0, 1, 0],
        [1, 0, 0, 0, 0, 0],
        [0, 0, 1, 0, 0, 1],
        [0, 0, 0, 1, 0, 0],
        [0, 1, 0, 0, 0, 0],
    ],
    dtype=float,
)
AT_REST = [1000, 1000, 1200, 1400, 1400, 2000]  # (125)
# (129); the axial modes do not feel the spin, their printed digits beyond 1e-10 are round-off


@pytest.fixture(scope="module")
def rotor() -> SolidRotor:
    return SolidRotor.from_matrices(np.eye(6), STIFFNESS, [[1, 0, 0], [7 / 4, 0, 0]], "x")


def test_free_modes_have_the_printed_frequencies_and_eigenspaces(rotor):
    modes = free_modes(rotor, 6)
    np.testing.assert_allclose(modes.frequencies, AT_REST, rtol=1e-12)
    assert_same_eigenspaces(modes.matrix)


@pytest.mark.parametrize("modes", [6, MODES], ids=["number of modes", "printed modes"])
def test_reduced_rotor_has_the_printed_frequencies_and_eigenspaces(rotor, modes):
    reduced = rotor.reduce(modes)
    assert reduced.grounded
    assert reduced.rigid == ()
    np.testing.assert_allclose(reduced.frequencies, AT_REST, rtol=1e-12)
    assert_same_eigenspaces(reduced.shapes.matrix)


def assert_same_eigenspaces(modes: np.ndarray) -> None:
    """Compare the projectors of each multiple frequency with those of the printed modes."""
    for frequency in set(AT_REST):
        columns = np.equal(AT_REST, frequency)
        ours, _ = np.linalg.qr(modes[:, columns])
        printed, _ = np.linalg.qr(MODES[:, columns])
        np.testing.assert_allclose(ours @ ours.T, printed @ printed.T, atol=1e-12)


def test_contraction_of_the_tilde_basis_gives_the_invariants(rotor):
    contraction = np.kron(np.eye(6), rotor.axis.direction[:, None])
    printed = np.zeros((6, 18))
    printed[[0, 1, 2, 3, 4, 5], [0, 3, 6, 9, 12, 15]] = 1
    np.testing.assert_array_equal(contraction.T, printed)  # (127)

    turned = tilde_basis(MODES) @ contraction
    invariants = Invariants.of(
        rotor.nodes, rotor.mass, rotor.stiffness, None, MODES, rotor.axis.direction
    )
    np.testing.assert_array_equal(invariants.G, turned.T @ rotor.mass @ MODES)  # (80)
    np.testing.assert_array_equal(invariants.C, turned.T @ rotor.mass @ turned)  # (81)
