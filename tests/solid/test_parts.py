"""Meshes of several parts are refused, with number, masses and sizes."""

import ngsolve as ngs
import pytest
from models import ALUMINIUM, STEEL
from netgen.occ import Box, Compound, Glue, OCCGeometry, Pnt

from exudyn_rotor import SolidRotor

MATERIALS = {"steel": STEEL, "aluminium": ALUMINIUM}


def boxes(count, gap, join=Compound):
    """Return a mesh of cubes of 0.1 m in a row, steel and aluminium in turn."""
    solids = []
    for number in range(count):
        start = number * (0.1 + gap)
        box = Box(Pnt(-0.05, -0.05, start), Pnt(0.05, 0.05, start + 0.1))
        box.mat(list(MATERIALS)[number % 2])
        solids.append(box)
    return ngs.Mesh(OCCGeometry(join(solids)).GenerateMesh(maxh=0.1))


@pytest.mark.parametrize("count", [2, 4])
def test_loose_parts_are_told(count):
    with pytest.raises(ValueError, match=rf"falls into {count} parts .*Glue") as told:
        SolidRotor.from_ngsolve(boxes(count, 0.02), MATERIALS, "z", order=1)
    assert "0.1 × 0.1 × 0.1 m" in str(told.value)


def test_parts_that_touch_need_glue():
    with pytest.raises(
        ValueError, match="falls into 2 parts that nothing connects, one of 9 nodes"
    ):
        SolidRotor.from_ngsolve(boxes(2, 0.0), MATERIALS, "z", order=1)
    rotor = SolidRotor.from_ngsolve(boxes(2, 0.0, Glue), MATERIALS, "z", order=1)
    assert "size             0.1 × 0.1 × 0.2 m" in rotor.summary()
