"""Laws of linear analyses that hold for every rotor on every support."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from test_properties import arrays_of

from exudyn_rotor import (
    SolidRotor,
    SpinAxis,
    Support,
    campbell,
    stability,
    stability_threshold,
)

examples = settings(max_examples=8, deadline=None, derandomize=True)
seeds = st.integers(0, 2**32 - 1)
powers = st.floats(0.0, 14.0)
NAMES = ("a", "b", "c")


def point_mass() -> SolidRotor:
    nodes = [[0.0, 0.0, 0.0]]
    return SolidRotor.from_matrices(np.eye(3), np.zeros((3, 3)), nodes, "z", interfaces={"at": [0]})


def arrays(seed: int) -> dict:
    """Return an undamped random rotor of four nodes, masses and springs of order 1."""
    given = arrays_of(seed, 4)
    given["damping"] = 0.0 * given["damping"]
    return given | {"interfaces": {"a": [0], "b": [1], "c": [3]}}


@examples
@given(seeds, powers, st.sampled_from(["inertial", "rotor"]))
def test_conservative_supports_cause_no_growth(seed, power, frame):
    """Far below the first critical speed K − Ω²(C − K2) is positive definite (Kelvin).

    Springs that stand still are isotropic, those in the rotor any, up to numerically rigid ones.
    """
    rng, k = np.random.default_rng(seed), 10.0**power
    matrices = [np.diag([1.0, 1.0, 0.3])] * 3
    if frame == "rotor":
        roots = rng.normal(size=(3, 3, 3))
        matrices = [root @ root.T + 0.1 * np.eye(3) for root in roots]
    springs = [
        Support(name, k * matrix, frame=frame) for name, matrix in zip(NAMES, matrices, strict=True)
    ]
    rotor = SolidRotor.from_matrices(**arrays(seed)).reduce(3)
    result = stability(rotor, [0.0, 1e-3], supports=springs)
    assert result.stable.tolist() == [True, True]


@examples
@given(seeds)
def test_results_do_not_depend_on_place_and_basis(seed):
    """Turned in space; in nodal coordinates or in all modes of the reduction."""
    given, rng = arrays(seed), np.random.default_rng([seed, 7])
    turn = Rotation.random(rng=rng).as_matrix()
    axis = given["axis"]
    whole = np.kron(np.eye(4), turn)
    turned = given | {
        "nodes": given["nodes"] @ turn.T,
        "stiffness": whole @ given["stiffness"] @ whole.T,
        "axis": SpinAxis(turn @ axis.direction, turn @ axis.point),
    }
    rotor, moved = (SolidRotor.from_matrices(**entry) for entry in (given, turned))
    bearings = [Support(name, np.diag([2.0, 2.0, 1.0]), 0.05) for name in NAMES]
    found = [
        (campbell(target, 0.4, supports=bearings), stability(target, [0.4], supports=bearings))
        for target in (rotor, moved, rotor.reduce(6))
    ]
    first, *others = found
    for diagram, margins in others:
        for name in ("frequencies_rotor", "growth", "frequencies_inertial"):
            here, there = getattr(first[0], name)[0], getattr(diagram, name)[0]
            np.testing.assert_allclose(np.sort(there), np.sort(here), rtol=1e-7, atol=1e-8)
        assert margins.growth == pytest.approx(first[1].growth, abs=1e-8)
        assert margins.stable.tolist() == first[1].stable.tolist()


@examples
@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(0.5, 1e4), st.floats(0.0, 14.0))
def test_known_instabilities_are_found(outer, inner, stiffness, power):
    """Ω = ω(1 + c_e/c_i), and cross-coupling q = cω; a stiff axial spring changes nothing."""
    scale = 1e-2 * np.sqrt(stiffness)
    axial = Support("at", np.diag([0.0, 0.0, 10.0**power]))
    springs = [axial, Support("at", stiffness, scale * outer)]
    damper = Support("at", damping=scale * inner, frame="rotor")
    omega = np.sqrt(stiffness)
    expected = omega * (1.0 + outer / inner)
    given = {"samples": 3, "supports": [*springs, damper]}
    found = stability_threshold(point_mass(), 0.3 * expected, 2.0 * expected, **given)
    np.testing.assert_allclose(found.values, [expected], rtol=1e-5)
    assert found.nodal_diameters.tolist() == [1]

    def coupled(share: float) -> list[Support]:
        q = share * scale * outer * omega
        return [*springs, Support("at", np.array([[0.0, q], [-q, 0.0]]))]

    limit = stability_threshold(point_mass(), 0.2, 5.0, supports=coupled, speed=0.7, samples=3)
    np.testing.assert_allclose(limit.values, [1.0], rtol=1e-3)
