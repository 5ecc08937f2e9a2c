"""Exponents of unreduced rotors against dense solutions and closed forms."""

import ngsolve as ngs
import numpy as np
import pytest
import scipy.sparse as sp
from models import STEEL, block_beam
from netgen.occ import Cylinder, OCCGeometry, Pnt, Z

from exudyn_rotor import SolidRotor
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.models.full import subspace
from exudyn_rotor.linear.models.full.full_rotor import FullRotor
from exudyn_rotor.linear.stability.stability import stability
from exudyn_rotor.linear.stability.thresholds import stability_threshold, unstable_ranges

SPEEDS = np.array([0.0, 800.0, 3000.0])
AXIAL = np.diag([1e7, 1e7, 1e6])
DAMPING = np.diag([300.0, 300.0, 50.0])
SUPPORTS = {
    "isotropic": [Support("left", AXIAL, DAMPING), Support("right", 1e7, 100.0)],
    "in the rotor": [Support("left", AXIAL, DAMPING), Support("right", 1e7, 90.0, frame="rotor")],
    "anisotropic": [
        Support("left", np.diag([1e7, 1.3e7, 1e6]), DAMPING),
        Support("right", 1e7, 100.0),
    ],
    "spin held": [
        Support("left", AXIAL, DAMPING, np.diag([0.0, 0.0, 1e4]), np.diag([0.0, 0.0, 1.0])),
        Support("right", 1e7, 100.0),
    ],
}
# soft against the mesh, so that the rotor moves like a rigid body: about 5e-7 of its stiffness
SOFT, OUTER, INNER = 1e3, 6.0, 4.0


def damped(rotor: SolidRotor, share: float) -> SolidRotor:
    """Return the rotor with the internal damping ``share·K``."""
    fields = {name: getattr(rotor, name) for name in rotor.__dataclass_fields__}
    return SolidRotor(**fields | {"damping": sp.csr_array(share * rotor.stiffness)})


@pytest.fixture(scope="module")
def beam() -> SolidRotor:
    """Return a coarse beam with internal damping and an eccentric mass."""
    rotor = SolidRotor.from_ngsolve(block_beam(0.1), STEEL, "z", order=1).center_interfaces()
    return damped(rotor.add_point_mass([0.02, 0.03, 0.3], 0.01), 2e-6)


@pytest.fixture(scope="module")
def shaft() -> SolidRotor:
    """Return a steel cylinder of more than 600 degrees of freedom."""
    solid = Cylinder(Pnt(0, 0, 0), Z, 0.03, 0.3)
    solid.mat("steel")
    solid.faces.Min(Z).name, solid.faces.Max(Z).name = "left", "right"
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.03, curvaturesafety=1.0))
    return SolidRotor.from_ngsolve(mesh, STEEL, "z", order=2).center_interfaces()


def internally_damped() -> list[Support]:
    """Return equal bearings, with a damper in the ground and one in the rotor each."""
    axial = np.diag([0.0, 0.0, SOFT])
    bearings = []
    for name in ("left", "right"):
        stiffness = np.diag([SOFT, SOFT, 0.0]) + axial
        bearings.append(Support(name, stiffness, np.diag([OUTER, OUTER, OUTER])))
        bearings.append(Support(name, damping=INNER, frame="rotor"))
    return bearings


@pytest.mark.parametrize("kind", SUPPORTS)
def test_lowest_exponents_are_those_of_all_modes(beam, kind):
    """Dense equations in all modes (exponents tested in test_stability) are the reference."""
    complete = beam.reduce(3 * beam.node_count - 6)
    source = FullRotor.of(beam, SUPPORTS[kind])
    found = stability(source, SPEEDS, modes=12)
    dense = stability(complete, SPEEDS, supports=SUPPORTS[kind], stiffening="tilt")
    assert found.exponents.shape == (3, 12)
    np.testing.assert_array_equal(found.base, dense.base)
    np.testing.assert_array_equal(found.stable, dense.stable)
    np.testing.assert_allclose(found.growth, dense.growth, rtol=1e-6)
    for few, all_of_them in zip(found.exponents, dense.exponents, strict=True):
        for value in few[:6]:
            distance = np.abs(all_of_them.real - value.real) + np.abs(
                np.abs(all_of_them.imag) - abs(value.imag)
            )
            assert distance.min() <= 1e-6 * max(abs(value), 1.0)


def test_internal_damping_threshold_of_a_mesh(shaft):
    """Ω = √(k/m) (1 + c_outer/c_inner): Genta, Dynamics of Rotating Systems (2005), Sect. 4.6."""
    assert 3 * shaft.node_count > 600
    expected = np.sqrt(2.0 * SOFT / shaft.total_mass) * (1.0 + OUTER / INNER)
    options = {"supports": internally_damped(), "modes": 6}
    found = stability_threshold(shaft, 0.5 * expected, 1.2 * expected, samples=2, **options)
    assert found.values == pytest.approx([expected], rel=1e-4)
    (low, high), *others = unstable_ranges(shaft, expected * np.array([0.5, 0.9, 1.2]), **options)
    assert not others
    assert low == pytest.approx(expected, rel=1e-4)
    assert high == 1.2 * expected


def test_material_damping_drives_the_shaft_unstable(shaft):
    """Above the critical speed, Genta (2005), Sect. 4.6; growth against 60 free modes.

    The damping also makes all modes above 2e5 rad/s overdamped.
    """
    rotor = damped(shaft, 1e-5)
    supports = [Support("left", AXIAL, 0.1), Support("right", 1e7, 0.1)]
    found = stability(rotor, [300.0, 4000.0], supports=supports, modes=8)
    reduced = stability(rotor.reduce(60), [300.0, 4000.0], supports=supports)
    np.testing.assert_array_equal(found.stable, [True, False])
    assert found.growth[1] == pytest.approx(reduced.growth[1], rel=0.02)


def test_residual_that_is_not_reached_is_an_error(beam, monkeypatch):
    monkeypatch.setattr(subspace, "_MOST_ROUNDS", 1)
    source = FullRotor.of(beam, SUPPORTS["isotropic"])
    with pytest.raises(ValueError, match="residual stays at"):
        stability(source, [3000.0], modes=12, residual=1e-12)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"modes": 0}, ValueError, "modes: needs a whole number ≥ 1, got 0"),
        ({"modes": 2.5}, TypeError, "whole number"),
        ({"residual": 0.0}, ValueError, "residual: needs"),
        ({"method": "floquet"}, ValueError, "takes 'auto' only"),
    ],
)
def test_bad_options_are_refused(beam, options, error, message):
    with pytest.raises(error, match=message):
        stability(FullRotor.of(beam, SUPPORTS["isotropic"]), [100.0], **options)


def test_number_of_modes_is_for_full_models(beam):
    with pytest.raises(ValueError, match="only for a large SolidRotor"):
        stability(beam.reduce(2), [100.0], supports=SUPPORTS["isotropic"], modes=3)


def test_slow_motions_near_a_critical_speed_are_not_taken_for_free_ones(shaft):
    """In the rotor frame the forward motion stands still there: λ = i(ω − Ω).

    Rigid on equal bearings, ω = √(k/m) to the 5e-7 by which the rotor is not rigid.
    """
    critical = np.sqrt(2.0 * SOFT / shaft.total_mass)
    supports = [Support(name, np.diag([SOFT] * 3), 1e-5) for name in ("left", "right")]
    options = {"supports": supports, "modes": 6}
    found = stability(shaft, critical * np.array([1.0 - 1e-4, 1.0 + 1e-4]), **options)
    slowest = np.abs(found.exponents.imag).min(axis=1)
    np.testing.assert_allclose(slowest, 1e-4 * critical, rtol=0.05)
    assert found.stable.all()
