"""The row of check_run that compares axial forces with the buckling load."""

import exudyn
import ngsolve as ngs
import numpy as np
import pytest
from beam_models import BeamRotor
from models import STEEL
from netgen.occ import Cylinder, OCCGeometry, Z

import exudyn_rotor as er

LENGTH, DIAMETER = 1.0, 0.02
EULER = np.pi**2 * STEEL["youngsModulus"] * np.pi * DIAMETER**4 / 64.0 / LENGTH**2


@pytest.mark.parametrize(("end", "share"), [("4", -0.2), ("4", 0.0005), ("2", -0.05)])
def test_a_thrust_in_a_scene_is_compared_with_the_buckling_load(end, share):
    """Hinged where it acts, at one end and at the end or the middle."""
    rotor = BeamRotor(tuple(np.linspace(0.0, LENGTH, 5)), 0.0, DIAMETER, STEEL, ()).reduced()
    row = pressed(rotor, end, share, 1e-4)
    # the thrust begins at once and rings, to twice its size
    expected = abs(share) * (float(rotor.interfaces[end].reference[2]) / LENGTH) ** 2
    assert 0.8 * expected < row.value < 2.5 * expected
    assert row.ok == (expected < 1e-3)


def pressed(rotor, end: str, share: float, step: float):
    """Return the row of a run with a thrust, a share of Euler's load."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, spin=100.0, translation="none", gravity=[0.0, -9.81, 0.0])
    held = [er.Support("0", 1e7 * np.eye(3), 1e4 * np.eye(3)), er.Support("4", 1e7, 1e4)]
    er.add_supports(body, held)
    force = [0.0, 0.0, share * EULER]
    mbs.AddLoad({"loadType": "ForceVector", "markerNumber": body.marker(end), "loadVector": force})
    body.start_recording()
    mbs.Assemble()
    settings = er.recommended_settings(200 * step, step)
    settings.timeIntegration.verboseMode = 0
    settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    mbs.SolveDynamic(settings)
    return er.check_run(body, warn=False)["axial force"]


def test_full_bodies_have_the_row():
    """The stress of a solid tells what the modes do, 2 % of the mesh apart."""
    solid = Cylinder((0, 0, 0), Z, 0.5 * DIAMETER, LENGTH)
    solid.faces.Min(Z).name, solid.faces.Max(Z).name = "0", "4"
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.1, curvaturesafety=0.5))
    rotor = er.SolidRotor.from_ngsolve(mesh, STEEL, "z").center_interfaces()
    modes = er.craig_bampton_modes(rotor, 8, coupling="RBE3")
    for place in (0.25, 0.5, 0.75):  # between interfaces the modes' shaft is bent by cubic lines
        rotor = rotor.interface_at(f"{place}", place, 0.1)
    rotor = rotor.with_interface("beside 4", rotor.interfaces["4"].nodes)  # no shaft between
    modes = rotor.reduce(modes)
    full, reduced = (pressed(one, "4", -0.2, 1e-4) for one in (rotor, modes))
    assert full.value == pytest.approx(reduced.value, rel=0.05)
    assert not full.ok
