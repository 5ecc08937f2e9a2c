"""The default level of stiffening, and the estimate of what it leaves out."""

import warnings
from functools import cache

import exudyn as exu
import numpy as np
import pytest
from models import STEEL, block_beam, disc_rotor
from netgen.occ import Cylinder, OCCGeometry, Z
from ngsolve import Mesh

import exudyn_rotor as er
from exudyn_rotor import SolidRotor, campbell, critical_speeds, stability
from exudyn_rotor.theory.stiffening import estimated_error, stiffening
from validation.stiffening import nonlinear


@cache
def shaft() -> SolidRotor:
    geometry = OCCGeometry(Cylinder((0, 0, -0.5), Z, 0.03, 1.0))
    mesh = Mesh(geometry.GenerateMesh(maxh=0.15, curvaturesafety=1.0))
    return SolidRotor.from_ngsolve(mesh, STEEL, "z")


@cache
def blade() -> SolidRotor:
    return SolidRotor.from_ngsolve(nonlinear.blade_mesh(), STEEL, "z").clamped(["root"])


ROTORS = {"disc on a shaft": disc_rotor, "shaft": shaft, "blade": blade}


def without_elements(rotor: SolidRotor) -> SolidRotor:
    return SolidRotor.from_matrices(rotor.mass, rotor.stiffness, rotor.nodes, rotor.axis)


@pytest.mark.parametrize("make", ROTORS.values(), ids=ROTORS)
def test_estimate_is_near_the_stiffness_of_the_elements(make):
    """Wanted is a factor of 3; torsion of a blade has 1.25, the others 1.15."""
    rotor = make()
    known = rotor.reduce(8)
    modes = known.shapes.matrix[:, len(known.rigid) :]
    plain = without_elements(rotor).reduce(modes)
    first = len(plain.rigid)
    estimate = np.diag(plain.invariants.K2_estimated)[first:]
    exact = np.diag(known.invariants.K2)[len(known.rigid) :]
    assert np.all(estimate < 1.3 * exact)
    assert np.all(exact < 1.3 * estimate)
    tilt = np.diag(stiffening(known.invariants, "tilt").K2)[len(known.rigid) :]
    shifts = 0.5 * np.abs(exact - tilt) / np.diag(known.invariants.K)[len(known.rigid) :]
    assert estimated_error(plain.invariants, 1.0) == pytest.approx(shifts.max(), rel=0.3)
    assert estimated_error(known.invariants, 1.0) == 0.0


def test_a_blade_warns_and_a_stiff_shaft_does_not():
    stiff, thin = (without_elements(rotor).reduce(4) for rotor in (shaft(), blade()))
    with pytest.warns(UserWarning, match="what it changes beyond 'tilt' is left out"):
        campbell(thin, [0.0, 150.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        campbell(stiff, [0.0, 800.0])
        chosen = campbell(thin, [0.0, 150.0], stiffening="tilt")
    assert chosen.stiffening == "tilt"


def test_advice_before_and_after_a_run_has_the_estimate():
    """At a speed whose centrifugal energy is nothing beside the elastic one."""
    thin = without_elements(blade()).with_interface("tip", [0, 1, 2]).reduce(4)
    with pytest.warns(er.AssumptionWarning, match="soften falsely: .* with prestress=True"):
        er.propose(thin, speeds=150.0)
    mbs = exu.SystemContainer().AddSystem()
    held = {"translation": "none", "spin": 1.0}
    body = er.add_rotor(mbs, thin, modal_coordinates=[1e-3, 0.0, 0.0, 0.0], **held)
    mbs.Assemble()
    found = er.check_run(body, warn=False)["stiffening"].value
    assert found == pytest.approx(estimated_error(thin.invariants, 1.0), rel=1e-3)


def test_level_is_full_where_there_are_elements_and_results_name_it():
    rotor = SolidRotor.from_ngsolve(block_beam(0.1), STEEL, "z", order=1)
    reduced = rotor.reduce(4)
    for result in (
        campbell(reduced, [0.0, 100.0]),
        campbell(rotor, [0.0, 100.0]),
        stability(reduced, [100.0]),
        critical_speeds(reduced, max_speed=5000.0),
    ):
        assert result.stiffening == "full"
        assert "stiffening: full" in result.table()
        assert "stiffening='full'" in repr(result)
    plain = rotor.reduce(4, prestress=False)
    assert plain.invariants.K2 is None
    assert plain.invariants.K2_estimated is None
    assert "stiffening: tilt" in campbell(plain, [0.0, 100.0]).table()
