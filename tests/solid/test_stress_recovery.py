"""Nodal stress of curved elements against displacements whose stress is known."""

import numpy as np
import pytest

from exudyn_rotor.solid.stress_recovery import EDGES, TetrahedronStress

E, NU = 2.1e11, 0.3
LAME = np.array([[E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))]])


def bending(nodes):
    """Return the displacement of pure bending with σ_zz = E x per unit of curvature (3n, 1)."""
    x, y, z = nodes.T
    moved = [-0.5 * (z**2 + NU * (x**2 - y**2)), -NU * x * y, x * z]
    return np.stack(moved, axis=1).reshape(-1, 1)


def tetrahedron(corners, on_surface=()):
    """Return the nodes of an element; mid nodes of some edges are moved onto the unit cylinder."""
    mids = np.array([(corners[a] + corners[b]) / 2 for a, b in EDGES])
    for index in on_surface:
        mids[index, :2] /= np.hypot(*mids[index, :2])
    return np.vstack([corners, mids])


def recovered(nodes):
    return TetrahedronStress(nodes, np.arange(10)[None], LAME)(bending(nodes))[:, :, 0]


def test_stress_of_straight_elements_is_exact():
    nodes = tetrahedron(np.array([[0, 0, 0], [1, 0, 0.1], [0, 2, 0], [0.3, 0.2, 1.5]]))
    expected = np.zeros((10, 6))
    expected[:, 2] = E * nodes[:, 0]
    assert recovered(nodes) == pytest.approx(expected, abs=1e-12 * E)


@pytest.mark.parametrize("angle", [0.4, 0.2])
def test_stress_where_two_faces_on_a_cylinder_meet(angle):
    """The element is flat along the edge where they meet; meshes of shafts have such elements.

    Four mid nodes are off the chords by angle²/8 of the radius, by which each shifts where the
    interpolated strain, of slope 1, has its value.
    """
    c, s = np.cos(angle), np.sin(angle)
    corners = np.array([[1, 0, 0], [1, 0, angle], [c, s, angle / 2], [c, -s, angle / 2]])
    nodes = tetrahedron(corners, on_surface=[1, 2, 3, 4])
    expected = np.zeros((10, 6))
    expected[:, 2] = E * nodes[:, 0]
    assert np.abs(recovered(nodes) - expected).max() < 4.0 * angle**2 / 8.0 * E
