"""Nodal diameters of discs and slender shafts, beside those counted at the rim."""

import numpy as np
import pytest

from exudyn_rotor import campbell
from validation.stiffening.disc import PLATE, disc_rotor

AROUND = 30  # bricks around the axis


@pytest.fixture(scope="module")
def plate():
    """A clamped plate; of its 18 lowest modes eight have five nodal diameters or more."""
    return disc_rotor(PLATE, (5, AROUND, 1)).reduce(18)


def counted(reduced, vector):
    """Return n of the axial motion at the rim, and how much of the largest motion that is."""
    nodes, motion = reduced.shapes.nodes, (reduced.shapes.matrix @ vector).reshape(-1, 3)
    rim = np.hypot(*nodes[:, :2].T) > (1.0 - 1e-9) * PLATE.outer
    ring = np.flatnonzero(rim & (nodes[:, 2] > 0.499 * PLATE.thickness))
    ring = ring[np.argsort(np.arctan2(nodes[ring, 1], nodes[ring, 0]))]
    waves = np.abs(np.fft.fft(motion[ring, 2]))
    n = int(np.argmax(waves))
    share = np.abs(motion[ring, 2]).max() / np.abs(motion).max()
    return min(n, len(ring) - n), share


def test_modes_of_a_disc_have_the_nodal_diameters_that_the_rim_shows(plate):
    """Also with nodal circles; above four it is said that n is not known, not "torsional"."""
    found = campbell(plate, [200.0], accuracy=None)
    checked = []
    for column, vector in enumerate(found.vectors[0].T):
        n, share = counted(plate, vector)
        named, whirl = found.nodal_diameters[0, column], found.whirl[0, column]
        if share < 0.5 or whirl == "torsional":
            continue  # motion in the plane of the disc
        assert named == (n if n <= 4 else -1)
        assert (whirl == "axial") == (n == 0)
        assert (whirl == "unknown") == (n > 4)
        checked.append(n)
    assert {0, 1, 2, 3, 4, 5, 6} <= set(checked)
    assert checked.count(0) == 2  # without and with a nodal circle
