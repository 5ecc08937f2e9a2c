"""Models of several parts: told with number, materials and sizes, unless asked for."""

import ngsolve as ngs
import numpy as np
import pytest
import scipy.sparse as sp
from models import ALUMINIUM, STEEL
from netgen.occ import Box, Compound, Glue, OCCGeometry, Pnt

from exudyn_rotor import SolidRotor
from exudyn_rotor.solid.model import loose_parts

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
def test_loose_parts_are_told_and_taken_if_asked_for(count):
    mesh = boxes(count, 0.02)
    with pytest.raises(ValueError, match=rf"falls into {count} parts .*Glue.*allow_parts") as told:
        SolidRotor.from_ngsolve(mesh, MATERIALS, "z", order=1)
    # masses of cubes of 1 litre
    assert str(told.value).count("7.85 kg, 0.1 × 0.1 × 0.1 m") == count // 2
    assert str(told.value).count("'aluminium'") == count // 2
    rotor = SolidRotor.from_ngsolve(mesh, MATERIALS, "z", order=1, allow_parts=True)
    text = rotor.summary()
    assert f"loose parts      {count}: " in text
    assert text.count("\npart             ") == count
    assert f"part             {count}: 'aluminium': " in text or count % 2
    parts = loose_parts(rotor.nodes, rotor.stiffness)
    assert sorted(np.concatenate(parts)) == list(range(rotor.node_count))
    assert all(np.ptp(rotor.nodes[part, 2]) == pytest.approx(0.1) for part in parts)


def test_parts_that_touch_need_glue():
    with pytest.raises(ValueError, match="falls into 2 parts that nothing connects: 'steel': "):
        SolidRotor.from_ngsolve(boxes(2, 0.0), MATERIALS, "z", order=1)
    rotor = SolidRotor.from_ngsolve(boxes(2, 0.0, Glue), MATERIALS, "z", order=1)
    assert "loose parts" not in rotor.summary()
    assert "part             1: 'aluminium' and 'steel': " in rotor.summary()


def test_springs_between_parts_connect_them():
    loose = SolidRotor.from_ngsolve(boxes(2, 0.02), MATERIALS, "z", order=1, allow_parts=True)
    arrays = {"mass": loose.mass, "nodes": loose.nodes, "axis": "z"}
    with pytest.raises(ValueError, match=r"2 parts .*springs inside the stiffness matrix"):
        SolidRotor.from_matrices(stiffness=loose.stiffness, **arrays)
    # springs along all three directions between nodes that face each other, across the gap
    stiffness = sp.lil_array(loose.stiffness)
    for corner in ([0.05, 0.05], [-0.05, 0.05], [0.05, -0.05]):
        ends = [loose.nearest_node([*corner, z]) for z in (0.1, 0.12)]
        for direction in range(3):
            i, j = (3 * end + direction for end in ends)
            for row, column, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
                stiffness[row, column] += sign * 1e8
    # across the axis such springs resist a tilt of the whole, so that the free motions are fewer
    assert loose_parts(loose.nodes, sp.csr_array(stiffness)) == []
    rotor = SolidRotor.from_matrices(stiffness=stiffness, **arrays)
    assert "loose parts" not in rotor.summary()
