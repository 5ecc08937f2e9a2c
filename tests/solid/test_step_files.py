"""STEP files of drawings: always millimetres, off the origin, about any axis."""

import ngsolve as ngs
import numpy as np
import pytest
from models import STEEL
from netgen import occ

from exudyn_rotor import SolidRotor, SpinAxis


@pytest.mark.parametrize("unit", ["SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)"])
def test_a_step_file_of_any_unit_comes_in_millimetres(unit, tmp_path):
    """A stepped shaft about y, off the origin: ρπ(r₁²l₁ + r₂²l₂); curved edges are met to 1e-3."""
    size = 1000.0 if "MILLI" in unit else 1.0
    place = [size * x for x in (0.34, -0.08, 1.25)]
    thin = occ.Cylinder(occ.Pnt(*place), occ.Y, 0.05 * size, 0.4 * size)
    thick = occ.Cylinder(occ.Pnt(*place), occ.Y, 0.1 * size, 0.1 * size)
    whole = thick + thin
    whole.faces.Max(occ.Y).name = "free end"
    path = tmp_path / "shaft.step"
    whole.WriteStep(str(path))
    text = path.read_text(encoding="utf-8")
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    path.write_text(text.replace("SI_UNIT(.MILLI.,.METRE.)", unit), encoding="utf-8")
    read = occ.OCCGeometry(str(path))
    with pytest.raises(ValueError, match=r"lengths in mm, as Netgen.*Scale\(Pnt"):
        SolidRotor.from_ngsolve(ngs.Mesh(read.GenerateMesh(maxh=100.0)), STEEL, "y")
    scaled = occ.OCCGeometry(read.shape.Scale(occ.Pnt(0, 0, 0), 1e-3))
    axis = SpinAxis([0, 1, 0], [0.34, 0, 1.25])
    rotor = SolidRotor.from_ngsolve(ngs.Mesh(scaled.GenerateMesh(maxh=0.1)), STEEL, axis)
    mass = STEEL["density"] * np.pi * (0.1**2 * 0.1 + 0.05**2 * 0.3)
    assert rotor.total_mass == pytest.approx(mass, rel=1e-3)
    assert rotor.interfaces["free end"].reference == pytest.approx([0.34, 0.32, 1.25], abs=1e-3)
