"""What Exudyn's own analyses of a scene see of a rotor: its unknowns, locks, and user functions."""

import exudyn as exu
import numpy as np
import pytest
from point_rotors import free_stiffness, ring_rotor

from exudyn_rotor import SolidRotor, add_rotor, recommended_settings

LOCKED = {"free": 2, "in-plane": 3, "none": 5}
SPINS = pytest.mark.parametrize("spin", ["free", 100.0])
TRANSLATIONS = pytest.mark.parametrize("translation", LOCKED)


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
def test_constraints_leave_no_locks_in_eigenvalues(reduced, spin, translation):
    """What 'mass' shows beyond the rotor's own are the false ones that the documentation lists."""
    constant = int(spin != "free")
    found = {}
    for locking in ("mass", "constraints"):
        mbs, body = scene(reduced, spin=spin, translation=translation, locking=locking)
        unknowns = body.motion.size
        freedom = mbs.ComputeSystemDegreeOfFreedom()["degreeOfFreedom"]
        held = constant + LOCKED[translation] * (locking == "mass")
        assert freedom == unknowns + held
        found[locking] = np.sqrt(np.abs(mbs.ComputeODE2Eigenvalues()[0]))
        assert len(found[locking]) == freedom
        if locking == "constraints" and not constant:
            mass = mbs.ComputeLinearizedSystem(projectIntoConstraintNullspace=True)[0]
            assert np.linalg.cond(mass) < 1e4
    # the free spin, or the held one, is at 0 to rounding: ω² of 1e-15 of the largest
    own = {name: values[values > 10.0] for name, values in found.items()}
    zero = {name: values[values <= 10.0] for name, values in found.items()}
    np.testing.assert_allclose(own["mass"], own["constraints"], rtol=1e-6)
    assert len(zero["constraints"]) == 1
    assert zero["constraints"][0] < 0.1
    assert sum(np.abs(zero["mass"] - 1.0) < 1e-3) == LOCKED[translation]


def test_user_functions_of_others_are_refused_as_before(reduced):
    mbs, _ = scene(reduced)
    node = mbs.AddNode(
        exu.itemInterface.NodePoint(referenceCoordinates=[0, 0, 0], initialCoordinates=[0, 0, 0])
    )
    mbs.AddObject(
        exu.itemInterface.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=np.eye(3),
            forceUserFunction=lambda mbs, t, item, q, q_t: [0.0, 0.0, 0.0],
        )
    )
    with pytest.raises(Exception, match="has a user function which cannot be copied"):
        mbs.GetDictionary()
    assert exu.special.exceptions.dictionaryNonCopyable
    exu.special.exceptions.dictionaryNonCopyable = False
    try:
        assert "objectList" in mbs.GetDictionary()
        assert not exu.special.exceptions.dictionaryNonCopyable
    finally:
        exu.special.exceptions.dictionaryNonCopyable = True


@SPINS
@TRANSLATIONS
def test_a_scene_can_be_put_into_a_dictionary_and_made_again(reduced, spin, translation):
    more = {"initial_speed": 100.0} if spin == "free" else {}
    mbs, _ = scene(reduced, spin=spin, translation=translation, gravity=[0, -9.81, 0], **more)
    copy = exu.SystemContainer().AddSystem()
    copy.SetDictionary(mbs.GetDictionary())
    copy.Assemble()
    settings = recommended_settings(end_time=0.01, step=1e-4)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ends = []
    for system in (mbs, copy, mbs):
        system.SolveDynamic(settings)
        ends.append(np.array(system.systemData.GetODE2Coordinates()))
    assert np.abs(ends[0]).max() > 1e-6
    np.testing.assert_array_equal(ends[0], ends[1])
    np.testing.assert_array_equal(ends[0], ends[2])
