"""The twin of Exudyn's call with a prestress, and what it refuses."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.FEM import FEMinterface
from models import disc_fem, disc_rotor
from run_scenes import item_counts

from exudyn_rotor import Formulation, Prestress, select_modes


@pytest.fixture(scope="module")
def fem():
    return disc_fem()


@pytest.fixture(scope="module")
def solid():
    return disc_rotor(1)


def stiffness_at_speed(fem, **options):
    """Return the eigenvalues of the stiffness of the modes at 2000 rad/s."""
    mbs = exu.SystemContainer().AddSystem()
    made = mbs.CreateFixedAxisFFRFReducedOrderObject(
        "rotor", fem, axis="z", translation="none", spin=2000.0, **options
    )
    motion = made["FFRFReducedOrderObjectDict"]["rotorBody"].motion
    rest = np.zeros(motion.size)
    at_rest = motion.forces(0.0, rest, rest)
    matrix = [at_rest - motion.forces(0.0, unit, rest) for unit in np.eye(motion.size)]
    return np.linalg.eigvalsh(np.array(matrix))


@pytest.mark.parametrize("source", ["same mesh", "matrix"])
def test_full_stiffening_with_a_given_prestress(fem, solid, source):
    """``K + ω²(K2 − C)`` is that of the rotor reduced with the same prestress."""
    prestress = solid.prestress()
    if source == "matrix":
        prestress = Prestress(prestress.matrix, solid.nodes)
    found = stiffness_at_speed(fem, stiffening="full", prestress=prestress)
    reduced = solid.reduce(fem, prestress=prestress)
    chosen = select_modes(reduced, Formulation("none", 2000.0)).invariants
    expected = np.linalg.eigvalsh(chosen.K + 2000.0**2 * (chosen.K2 - chosen.C))
    assert found == pytest.approx(expected, rel=1e-6, abs=1.0)  # a spin has none
    tilt = stiffness_at_speed(fem, stiffening="tilt")
    assert np.abs(found - tilt).max() > 0.1 * 2000.0**2


WRONG_CALLS = {
    "full without": ({"stiffening": "full"}, ValueError, r"full' .*: give prestress=; .*makes one"),
    "True": ({"prestress": True}, TypeError, "prestress: needs Prestress, got True"),
    "no modes": ({"femInterface": FEMinterface()}, ValueError, "no modes; call fem.Compute"),
    "no axis": ({"axis": None}, ValueError, "axis: is not known, .* give axis='x'"),
    "tumbles": ({"initialAngularVelocity": [3, 0, 4]}, ValueError, "has 3 rad/s across .* cannot"),
    "two speeds": (
        {"spin": 5.0, "initialAngularVelocity": [0.0, 0.0, 4.0]},
        ValueError,
        "spin given twice: .* is 4.0 rad/s .* starts with 5.0",
    ),
    "offsets": (
        {"superElementRigidMarkersOffsets": np.zeros((2, 3)), "markers": "position"},
        ValueError,
        "superElementRigidMarkersOffsets: needs markers='rigid', got 'position'",
    ),
}


@pytest.mark.parametrize("case", WRONG_CALLS)
def test_calls_that_cannot_be_say_what_to_give(fem, case):
    options, kind, message = WRONG_CALLS[case]
    mbs = exu.SystemContainer().AddSystem()
    before = item_counts(mbs)
    with pytest.raises(kind, match=message):
        mbs.CreateFixedAxisFFRFReducedOrderObject(
            "rotor", **{"femInterface": fem, "axis": "z"} | options
        )
    assert item_counts(mbs) == before
