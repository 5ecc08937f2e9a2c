"""The demonstration end to end, on its quick mesh."""

import numpy as np
import pytest

from exudyn_rotor import __main__
from exudyn_rotor.demo import run_demo


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


def test_the_command_line_runs_it(monkeypatch):
    calls = []
    monkeypatch.setattr(__main__, "run_demo", lambda output, quick: calls.append((output, quick)))
    __main__.main(["demo", "--quick"])
    assert calls == [("exudyn-rotor-demo", True)]
