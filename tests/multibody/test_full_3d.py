"""The full fixed-axis body against Exudyn's own full 3D body, started and held alike."""

import pytest

from exudyn_rotor import SolidRotor
from validation.exudyn_3d import full_3d
from validation.exudyn_3d.scenes import STEEL, cylinder


@pytest.fixture(scope="module")
def rotor() -> SolidRotor:
    shaft = SolidRotor.from_ngsolve(cylinder(0.05, 0.3, 0.1), STEEL, "z", order=1)
    return full_3d.balanced(shaft)


@pytest.fixture(scope="module")
def rows(rotor) -> dict:
    found = full_3d.compare(rotor, 0.0025, 20, (1e-3, 1e-4))
    return {level: [r for r in found if r["stiffening"] == level] for level in full_3d.LEVELS}


def test_deviation_falls_with_the_tilt(rows):
    """The motion in the plane agrees to the fourth order of the step, 1e-5 at 1/160 of a turn."""
    wide, narrow = rows["tilt"]
    assert 0.5e-4 < narrow["tilt"] < 1e-4
    assert max(narrow[name] for name in ("lateral", "axial", "rim")) < 1e-3
    assert narrow["lateral"] < 2e-5
    assert narrow["axial order"] == pytest.approx(1.0, abs=0.05)
    assert wide["axial"] / narrow["axial"] == pytest.approx(10.0, rel=0.1)
