"""Pairs of modes that an uneven mesh splits, in Campbell diagrams."""

import numpy as np
import pytest

from exudyn_rotor import SolidRotor, Support, campbell, linear_model
from exudyn_rotor.linear.modal.whirl import WhirlContent


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
    rotor = bent((0.0, 0.0)).with_interface("end", [1])
    for speeds in ([0.0], [0.0, 1e-3]):
        uneven = campbell(rotor, speeds, supports=[Support("end", np.diag([1e5, 1.01e5]))])
        even = campbell(rotor, speeds, supports=[Support("end", 1e5)])
        mixed = uneven.whirl[0] == "mixed"
        assert np.sum(mixed) == 4
        assert not np.any(uneven.splits)
        assert not np.any(even.splits)


def test_pairs_part_where_the_rotor_turns():
    """Planar at rest and at speeds that are small against the split; whirl above."""
    result = campbell(bent((4e-3, 0.0)), [0.0, 0.1, 100.0])
    assert np.sum(result.splits > 0.0, axis=1).tolist() == [2, 2, 0]
    np.testing.assert_allclose(result.splits[1], result.splits[0], atol=1e-3)
    tracked = result.tracked()
    np.testing.assert_array_equal(np.sort(tracked.splits, axis=1), np.sort(result.splits, axis=1))


@pytest.mark.parametrize(
    ("short", "both"), [(-1.0j, False), (-0.2j, False), (0.2j, False), (1.0j, True)]
)
def test_what_turns_both_ways(short, both):
    """A forward circle of one point beside an ellipse of the other with axes 1 and ``±short``.

    Of an ellipse (1, −ir) the mean wave number is ``2r/(1 + r²)``; backward alone it is below −0.8.
    """
    content = WhirlContent.of(linear_model(bent((0.0, 0.0))))
    circle, ellipse = np.zeros((2, 1, 6, 1), dtype=complex)
    circle[0, :2, 0], ellipse[0, 3:5, 0] = (1.0, -1.0j), (1.0, short)
    assert content.turn_both_ways(circle, ellipse, np.array([0])) == both
    assert not content.turn_both_ways(ellipse, ellipse, np.array([0]))
