"""What Exudyn's own analyses of a scene see of a rotor: its unknowns, locks, and user functions."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import free_stiffness, ring_rotor

from exudyn_rotor import SolidRotor, add_rotor

SPINS = pytest.mark.parametrize("spin", ["free", 100.0])
TRANSLATIONS = pytest.mark.parametrize("translation", ["free", "in-plane", "none"])


@pytest.fixture(scope="module")
def reduced():
    """Eccentric, with two elastic modes, so that all coordinates are coupled."""
    ring = ring_rotor(0.1, 0.1, 2.0)
    soft = free_stiffness(ring.nodes, 1e6 * np.eye(ring.nodes.size))
    rotor = SolidRotor.from_matrices(ring.mass, soft, ring.nodes, "z")
    rotor = rotor.with_interface("left", range(5)).with_interface("right", range(5, 10))
    return rotor.add_point_mass([0.1, 0.0, 0.1], 0.1).reduce(2)


def scene(reduced, **options):
    """Return a rotor on two springs, assembled."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, **options)
    ground = mbs.CreateGround()
    for name, z in (("left", -0.1), ("right", 0.1)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=[0, 0, z],
            stiffness=[1e6] * 3,
            damping=[10.0] * 3,
        )
    mbs.Assemble()
    return mbs, body


@SPINS
@TRANSLATIONS
def test_exudyns_analyses_show_no_false_values(reduced, spin, translation):
    """Eigenvalues are those of the rotor's unknowns, with the zero of a free spin among them."""
    mbs, body = scene(reduced, spin=spin, translation=translation)
    unknowns = body.motion.size
    assert mbs.ComputeSystemDegreeOfFreedom()["degreeOfFreedom"] == unknowns
    found = np.sqrt(np.abs(mbs.ComputeODE2Eigenvalues()[0]))
    assert len(found) == unknowns
    mass = mbs.ComputeLinearizedSystem(projectIntoConstraintNullspace=True)[0]
    assert len(mass) == unknowns
    assert np.linalg.cond(mass) < 1e4
    assert sum(found < 10.0) == (spin == "free")
    by_mass, _ = scene(reduced, spin=spin, translation=translation, locking="mass")
    other = np.sqrt(np.abs(by_mass.ComputeODE2Eigenvalues()[0]))
    np.testing.assert_allclose(found[found > 10.0], other[other > 10.0], rtol=1e-6)
