"""Craig–Bampton modes of interfaces that share nodes: differences of large displacements."""

import numpy as np
import pytest
import scipy.sparse as sp
from models import centered_disc
from scipy.sparse.linalg import splu

from exudyn_rotor import SolidRotor, craig_bampton_modes


def probed() -> SolidRotor:
    """Return the disc's rotor with a node of a bearing's face as an interface of its own."""
    rotor = centered_disc()
    node = rotor.nearest_node([0.0, 0.01, 0.5])
    assert node in rotor.interfaces["right"].nodes
    return rotor.with_interface("probe", [node])


def doubled() -> SolidRotor:
    """Return the disc's rotor with a face and the same one without one of its nodes."""
    rotor = centered_disc(1)
    return rotor.with_interface("again", rotor.interfaces["left"].nodes[1:])


@pytest.mark.parametrize("made", [probed, doubled])
def test_static_modes_are_those_of_the_saddle_matrix(made):
    """They are differences of terms that are 1000 to 10,000 times as large."""
    rotor = made()
    modes = craig_bampton_modes(rotor, 4, coupling="RBE3")
    rows = [one.mean_motion(rotor.node_count) for one in rotor.interfaces.values()]
    count = modes.matrix.shape[1] - 4
    held = sp.vstack(rows).tocsr()[:count]
    static = modes.matrix[:, :count]
    np.testing.assert_allclose(held @ static, np.eye(count), atol=1e-9)
    scale = np.r_[1.0 / np.sqrt(rotor.stiffness.diagonal()), np.full(count, 1e5)]
    scaling = sp.diags_array(scale)
    saddle = scaling @ sp.block_array([[rotor.stiffness, held.T], [held, None]]) @ scaling
    loads = scale[:, None] * np.eye(len(scale), count, -rotor.nodes.size)
    expected = (scaling @ splu(saddle.tocsc()).solve(loads))[: rotor.nodes.size]
    errors = np.linalg.norm(static - expected, axis=0) / np.linalg.norm(expected, axis=0)
    assert errors.max() < 1e-7  # rounding times a condition of 1e8
