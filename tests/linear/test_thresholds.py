"""Limits of stability against closed forms."""

import numpy as np
import pytest
from asymmetric import asymmetric_shaft

from exudyn_rotor import (
    Foundation,
    LinearModel,
    Mount,
    SolidRotor,
    Support,
    linear_model,
    stability,
    stability_threshold,
    unstable_ranges,
)

MASS, STIFFNESS = 2.0, 2e4  # ω = 100 rad/s


@pytest.fixture(scope="module")
def point():
    return SolidRotor.from_matrices(
        MASS * np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], axis="z", interfaces={"disc": [0]}
    ).reduce(0)


@pytest.mark.parametrize(("outer", "inner"), [(10.0, 5.0), (1.0, 20.0), (30.0, 10.0)])
def test_onset_by_inner_damping(point, outer, inner):
    """ω(1 + c_o/c_i)."""
    supports = [Support("disc", STIFFNESS, outer), Support("disc", damping=inner, frame="rotor")]
    limit = 100.0 * (1.0 + outer / inner)
    found = stability_threshold(point, 10.0, 500.0, supports=supports)
    assert found.values == pytest.approx([limit], abs=5e-5)
    assert found.onset.tolist() == [True]
    assert found.frequencies_inertial == pytest.approx([100.0], rel=1e-3)
    ranges = unstable_ranges(point, np.linspace(0.0, 500.0, 11), supports=supports)
    assert ranges == pytest.approx(np.array([[limit, 500.0]]), abs=5e-5)


@pytest.mark.parametrize("damping", [1.0, 20.0])
def test_onset_by_cross_coupling(point, damping):
    """q = c ω."""

    def supports(q: float) -> list[Support]:
        return [Support("disc", [[STIFFNESS, q], [-q, STIFFNESS]], damping)]

    found = stability_threshold(
        point, 0.0, 5e3, supports=supports, speed=300.0, label="q [N/m]", samples=6
    )
    assert found.values == pytest.approx([100.0 * damping], rel=1e-7)
    assert found.table().splitlines()[0].split()[:2] == ["q", "[N/m]"]


def test_table_with_a_gap_of_coefficients(point):
    """Speeds beyond the table are left out, with one warning."""
    supports = [
        Support("disc", ([0.0, 400.0], [STIFFNESS, STIFFNESS]), 10.0),
        Support("disc", damping=5.0, frame="rotor"),
    ]
    with pytest.warns(UserWarning, match="no values at") as heard:
        found = stability_threshold(point, 50.0, 500.0, supports=supports)
    assert len(heard) == 1
    assert found.values == pytest.approx([300.0], abs=5e-5)


def test_an_asymmetric_shaft_is_unstable_between_its_critical_speeds():
    shaft = asymmetric_shaft()
    name = next(iter(shaft.interfaces))
    found = stability_threshold(shaft, 1.0, 400.0, supports=[Support(name, 1e9)], samples=60)
    assert len(found.values) % 2 == 0
    assert len(found.values) >= 2
    assert np.all(np.diff(found.ranges, axis=1) > 0.0)


@pytest.mark.parametrize("damping", [20.0, 150.0])
def test_limits_of_an_uneven_rotor_on_uneven_bearings(damping):
    """Floquet's method has growth on one side of each, and decay on the other."""
    shaft = asymmetric_shaft()
    supports = [Support(name, np.diag([1e6, 3e6, 1e6]), damping) for name in shaft.interfaces]
    given = {"supports": supports, "accuracy": None}
    found = stability_threshold(shaft, 180.0, 232.0, samples=4, **given)
    beside = np.outer(found.values, [1.0 - 3e-7, 1.0 + 3e-7]).ravel()
    growth = stability(shaft, beside, method="floquet", **given).growth_of("lateral")
    assert (growth > 0.0).tolist() == [False, True, True, False]


@pytest.mark.parametrize("ratio", [1.2, 1.5, 3.0])
def test_undamped_round_rotors_on_uneven_supports_are_stable(point, ratio):
    supports = [Support("disc", np.diag([STIFFNESS, ratio * STIFFNESS]))]
    found = stability_threshold(point, 1.0, 500.0, supports=supports)
    assert not found.values.size
    assert not found.unstable_at_low


def flat_shaft_on_a_block(points: int = 6) -> LinearModel:
    """Return a shaft of masses, three times as stiff in one plane, on bearings on a rigid block."""
    heights = np.linspace(-0.3, 0.3, points)
    curvature, strain = np.diff(np.eye(points), 2, axis=0), np.diff(np.eye(points), axis=0)
    bending, along = 4e6 * curvature.T @ curvature, 1e8 * strain.T @ strain
    planes = ((bending, [1, 0, 0]), (3.0 * bending, [0, 1, 0]), (along, [0, 0, 1]))
    stiffness = sum(np.kron(K, np.diag(plane)) for K, plane in planes)
    nodes = np.c_[np.zeros((points, 2)), heights]
    ends = {"left": [0], "right": [points - 1]}
    shaft = SolidRotor.from_matrices(
        2.0 * np.eye(3 * points), stiffness, nodes, "z", interfaces=ends
    ).reduce(3 * points - 6)
    supports = [Support(end, 1e6, 20.0) for end in ends]
    supports.append(Support("left", np.diag([0.0, 0.0, 4e6]), np.diag([0.0, 0.0, 100.0])))
    corners = [(-0.16, y, z) for y in (-0.1, 0.1) for z in (-0.3, 0.3)]
    foundation = Foundation.rigid(
        mass=20.0,
        inertia=[0.3, 0.3, 0.1],
        center=[-0.1, 0.0, 0.0],
        mounts=[Mount(corner, stiffness=4e5, damping=80.0) for corner in corners],
        points={"left": nodes[0], "right": nodes[-1]},
    )
    return linear_model(shaft, supports=supports, foundation=foundation)


def test_slow_motions_of_many_coordinates_are_waited_for():
    """At the limit, which few harmonics miss by 0.5 %, the monodromy matrix has no growth."""
    model = flat_shaft_on_a_block()
    [limit] = stability_threshold(model, 521.0, 522.0, samples=2, accuracy=None).values
    state = stability(model, [limit], method="floquet", accuracy=None)
    assert limit == pytest.approx(521.663, abs=1e-3)
    assert abs(state.growth[0]) < 1e-3  # of 2.8 1/s for each rad/s beside it
