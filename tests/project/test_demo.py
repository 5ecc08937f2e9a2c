"""The demonstration end to end, on its quick mesh."""

import numpy as np
import pytest
from matplotlib.image import imread

from exudyn_rotor.demo import run_demo, table


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo") / "new"
    return run_demo(folder, quick=True), folder


def test_variants_agree_with_the_3d_body(demo):
    """The 3D body's own O(h²) phase error bounds the agreement.

    ``python -m validation against_3d`` measures it.
    """
    reference, virtual, free, none = demo[0]
    amplitude = np.abs(reference.orbit).max()
    assert amplitude > 1e-4
    assert virtual.deviation(reference).max() < 1e-9 * amplitude
    assert free.deviation(reference).max() < 1e-3 * amplitude
    assert none.deviation(reference).max() < 5e-3 * amplitude


def test_table_states_sizes(demo):
    reference, _, free, none = demo[0]
    assert (reference.unknowns, reference.constraints) == (19, 1)  # 3 + 4 + 12
    assert (free.unknowns, free.locked) == (18, 2)  # 3 + 1 + 2 tilts + 12
    assert (none.unknowns, none.locked) == (18, 5)  # 1 + 3 translations + 2 tilts + 12
    assert free.label in table(demo[0])


def test_pictures_show_something(demo):
    for name in ("orbits.png", "displacement.png", "rotor.png"):
        assert imread(demo[1] / name)[..., :3].std() > 0.05
