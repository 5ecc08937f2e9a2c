"""Orthonormal bases: their definition, however nearly alike the columns are."""

import numpy as np
import pytest
from point_rotors import SKEW_AXIS, random_rotor

from exudyn_rotor.reduction.basis import (
    OrthonormalBasis,
    gram_schmidt,
    rigid_columns,
)
from exudyn_rotor.reduction.mode_kind import RIGID_KINDS

EXACT = 1e-12  # sums over six nodes with entries of order 1
TOLERANCE = 1e-7  # of what is new in a column
SCALES = np.array([1.0, 1e4, 1.0, 1e-4])


@pytest.fixture(scope="module")
def rotor():
    return random_rotor(11, SKEW_AXIS)


def of_rigid(rotor):
    """Return the basis of the rotor's rigid motions."""
    rigid = rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass)
    return OrthonormalBasis.of_rigid(rigid, RIGID_KINDS, rotor.mass, TOLERANCE)


def columns_nearly_alike(first, new):
    """Return columns (18, 4) of which the third has the share `new` of its own."""
    columns = np.random.default_rng(6).normal(size=(18, 4))
    columns[:, 2] = columns[:, 0] + first.matrix[:, 4] + new * columns[:, 2]
    return columns * SCALES


@pytest.mark.parametrize("new", [1.0, 1e-3, 1e-6, 1e-10])
def test_columns_are_orthonormal_and_give_the_old_ones_back(rotor, new):
    """C = QT + FS with QᵀMQ = I, QᵀMF = 0 and T upper triangular, to rounding at any `new`."""
    first = of_rigid(rotor)
    columns = columns_nearly_alike(first, new)
    found = gram_schmidt((first.matrix, first.momenta), columns, rotor.mass, TOLERANCE)
    used = [0, 1, 2, 3] if new > TOLERANCE else [0, 1, 3]
    assert found.used == used
    together = np.hstack([first.matrix, found.matrix])
    gram = together.T @ (rotor.mass @ together)
    np.testing.assert_allclose(gram, np.eye(len(gram)), atol=EXACT)
    # a column's momentum is known as precisely as what is left of it
    exact = rotor.mass @ found.matrix
    np.testing.assert_allclose(found.momenta, exact, atol=EXACT * np.abs(exact).max())
    np.testing.assert_array_equal(np.tril(found.triangle, -1), 0.0)
    assert np.all(np.diag(found.triangle) > 0.0)
    back = found.matrix @ found.triangle + first.matrix @ found.first
    scales = SCALES[used]
    np.testing.assert_allclose(back / scales, columns[:, used] / scales, atol=EXACT)
