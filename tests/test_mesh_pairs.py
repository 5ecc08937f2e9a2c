"""Pairs of modes that an uneven mesh splits, in Campbell diagrams."""

import numpy as np
import pytest
from models import disc_rotor

from exudyn_rotor import SolidRotor, Support, campbell

SPEEDS = [0.0, 1e-3, 100.0]


def bent(splits: tuple[float, float]) -> SolidRotor:
    """Return two points of 1 kg on a massless shaft whose stiffness differs in two planes."""
    K = 1e6 * np.diag([1.0, 1.0 + splits[0], 9.0])
    coupling = np.kron([[1.0, -0.5], [-0.5, 1.0]], K)
    nodes = [[0.0, 0.0, -0.2], [0.0, 0.0, 0.3]]
    return SolidRotor.from_matrices(np.eye(6) * (1.0 + splits[1]), coupling, nodes, "z")


@pytest.mark.parametrize("split", [1e-6, 4e-3])
def test_a_pair_is_listed_once_with_its_split(split):
    """K = k(1, 1 + s) in two planes: frequencies √(1 + s) apart, for both modes of the shaft."""
    result = campbell(bent((split, 0.0)), [0.0])
    expected = np.sqrt(1.0 + split) - 1.0
    lower = result.splits[0] > 0.0
    np.testing.assert_allclose(result.splits[0, lower], [expected] * 2, rtol=1e-6)
    assert np.sum(result.splits[0] < 0.0) == 2
    lines = result.table().splitlines()
    assert sum("pair, the other" in line for line in lines) == 2
    assert sum(line.endswith("axial") or "pair" in line for line in lines) == 4  # of six modes
    assert len(result.columns()["split"]) == 6
    assert result.frequencies_rotor.shape == (1, 6)


def test_no_pairs_where_planes_differ_by_more_or_by_the_supports():
    assert not np.any(campbell(bent((0.05, 0.0)), [0.0]).splits)
    rotor = disc_rotor(1).center_interfaces().reduce(4)
    uneven = [Support(name, np.diag([2e7, 2.0001e7])) for name in ("left", "right")]
    assert not np.any(campbell(rotor, [0.0], supports=uneven).splits)


def test_pairs_of_a_mesh_part_where_the_rotor_turns():
    """Planar at rest and up to speeds that are small against the split; whirl above."""
    rotor = disc_rotor(safety=2.0).center_interfaces().reduce(4)
    supports = [Support(name, 2e7) for name in ("left", "right")]
    result = campbell(rotor, SPEEDS, supports=supports, accuracy=None)
    assert np.any(result.splits[0] > 0.0) and np.any(result.splits[1] > 0.0)
    assert not np.any(result.splits[2])
    np.testing.assert_allclose(result.splits[1], result.splits[0], atol=1e-4)
    tracked = result.tracked()
    np.testing.assert_array_equal(np.sort(tracked.splits, axis=1), np.sort(result.splits, axis=1))
