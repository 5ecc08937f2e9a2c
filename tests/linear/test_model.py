"""The linear model: axes, what is averaged, free motions, matrices and state space for others."""

import numpy as np
import pytest
from models import centered_disc

from exudyn_rotor import (
    Foundation,
    LinearModel,
    RotorTrain,
    SeriesSupport,
    SolidRotor,
    Support,
    Unbalance,
    campbell,
    linear_model,
    stability,
    unbalance_response,
)

UNEVEN = np.diag([2e7, 4e7])


def disc(modes=12):
    return centered_disc().reduce(modes)


def held(stiffness=2e7, damping=300.0):
    return [Support(name, stiffness, damping) for name in ("left", "right")]


def flat(across=3e4):
    """Return three masses on a rod whose bending stiffness differs in two planes."""
    bend = np.kron([[1, -2, 1], [-2, 4, -2], [1, -2, 1]], np.diag([1e4, across, 0.0]))
    axial = np.kron([[1, -1, 0], [-1, 2, -1], [0, -1, 1]], np.diag([0.0, 0.0, 1e8]))
    nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.0], [0.0, 0.0, 0.1]]
    rotor = SolidRotor.from_matrices(2.0 * np.eye(9), bend + axial, nodes, "z")
    return rotor.with_interface("left", [0]).with_interface("right", [2])


@pytest.mark.parametrize(
    ("made", "supports", "axes", "constant"),
    [
        (disc, held(), "inertial", True),
        (disc, held(UNEVEN), "inertial", True),
        (disc, [*held(), Support("left", 1e5, 10.0, frame="rotor")], "inertial", True),
        (disc, [*held(), Support("left", UNEVEN, frame="rotor")], "rotor", True),
        (flat, held(), "rotor", True),
        (flat, held(UNEVEN), "rotor", False),
    ],
)
def test_axes_are_those_in_which_equations_are_constant(made, supports, axes, constant):
    model = linear_model(made(), supports=supports)
    assert model.axes == axes
    assert model.at(200.0).is_constant == constant
    assert model.at(0.0).is_constant


RINGS = [
    SeriesSupport(interface=inner.interface, inner=inner, outer=outer, mass=9.0)
    for inner, outer in zip(held(), held(1e4 * np.eye(2)), strict=True)
]


@pytest.mark.parametrize("supports", [held(), held(UNEVEN, np.diag([300.0, 900.0])), RINGS])
@pytest.mark.parametrize("speed", [0.0, 150.0])
def test_axes_do_not_change_motions_seen_from_outside(supports, speed):
    rotor = flat(1e4)
    both = [
        campbell(rotor, [speed], supports=supports, axes=axes, accuracy=None, modes=6)
        for axes in ("inertial", "rotor")
    ]
    for name in ("frequencies_inertial", "growth"):
        one, other = (np.sort(getattr(each, name)[0]) for each in both)
        np.testing.assert_allclose(one, other, rtol=1e-8, atol=1e-7)


def test_meshs_own_unevenness_is_averaged_and_told():
    model = linear_model(disc(), supports=held(UNEVEN))
    assert 1e-5 < model.unevenness < 1e-2
    result = campbell(disc(), [100.0], supports=held(UNEVEN), accuracy=None)
    assert result.unevenness == model.unevenness
    assert "unevenness of the mesh" in result.table()
    given = {"supports": held(UNEVEN), "accuracy": None}
    turning = unbalance_response(disc(), [100.0], Unbalance("left", 1e-4), **given)
    assert turning.unevenness == model.unevenness
    assert f"unevenness of the rotor: {model.unevenness:.2g}" in turning.table()


def test_a_rotor_that_is_all_but_round_is_told():
    with pytest.warns(UserWarning, match="counts as uneven: 1.*axes='inertial'"):
        result = campbell(flat(1.03e4), [100.0], supports=held(UNEVEN), accuracy=None)
    assert "unevenness of the rotor" in result.table()


def test_rotor_and_train_of_one_are_the_same():
    supports, speeds = held(UNEVEN), [0.0, 100.0, 400.0]
    assert linear_model(RotorTrain({"r": flat(1.03e4).reduce(3)}, {"r": 1.0})).axes == "rotor"
    alone = stability(disc(), speeds, supports=supports, accuracy=None)
    train = RotorTrain({"r": disc()}, {"r": 1.0}, {"r": supports})
    np.testing.assert_allclose(
        np.sort_complex(stability(train, speeds, accuracy=None).exponents),
        np.sort_complex(alone.exponents),
        rtol=1e-8, atol=1e-6,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("supports", "free"),
    [
        (held(), ("translation along axis", "spin")),
        (held(np.diag([1e7, 1e7, 1e6])), ("spin",)),
        # stiffness and damping of a film: only the axis and the spin are free
        ([Support("left", [[2.5e6, 6.5e7], [-1.9e7, 2.5e6]], np.diag([6.2e5, 1.8e5])),
          Support("right", [[2.5e6, 6.5e7], [-1.9e7, 2.5e6]], np.diag([6.2e5, 1.8e5]))],
         ("translation along axis", "spin")),
    ],
)  # fmt: skip
def test_free_motions_are_the_real_ones(supports, free):
    model = linear_model(disc(), supports=supports)
    assert model.free_motions == free
    result = campbell(model, [100.0], accuracy=None)
    resting = (result.frequencies_inertial == 0.0) & (result.growth == 0.0)
    assert np.count_nonzero(resting) == len(free)


def test_matrices_and_state_space_are_what_analyses_solve():
    model = linear_model(disc(), supports=held(UNEVEN))
    space = model.state_space(300.0)
    assert space.B.shape == (2 * model.size, 4)
    assert space.C.shape == (4, 2 * model.size)
    values = np.linalg.eigvals(space.A)
    wanted = campbell(model, [300.0], accuracy=None)
    for growth, frequency in zip(wanted.growth[0], wanted.frequencies_inertial[0], strict=True):
        if 10.0 < frequency < 1e4 and wanted.nodal_diameters[0, 0] <= 1:
            assert np.abs(values - (growth + 1j * frequency)).min() < 1e-5 * frequency
    static = -space.C @ np.linalg.lstsq(space.A, space.B)[0]
    assert static[0, 0] > static[1, 1] > 0.0  # softer along n1
    coordinates = model.matrices(300.0).coordinates
    assert len(coordinates) == model.size
    assert coordinates[0] == "translation 1"


def test_model_shows_itself_in_a_few_lines():
    block = Foundation(mass=np.eye(3) * 50.0, damping=np.zeros((3, 3)), stiffness=5e6 * np.eye(3),
                       points={n: np.eye(3) for n in ("left", "right")})  # fmt: skip
    model = linear_model(disc(), supports=held(), foundation=block)
    assert isinstance(model, LinearModel)
    text = repr(model)
    assert len(text.splitlines()) == 5
    assert len(text) < 500
    assert "on a foundation" in text
