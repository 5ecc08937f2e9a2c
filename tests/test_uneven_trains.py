"""Growth of trains of uneven rotors: that of an asymmetric one, and spurious growth by a mesh."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from point_rotors import free_stiffness
from spool_models import spool_with_growth

from exudyn_rotor import (
    Link,
    ReducedRotor,
    RotorTrain,
    SolidRotor,
    Support,
    linear_model,
    stability,
)
from exudyn_rotor.linear.models.trains.turning import Turning
from linear_values import exponents

CROSS = np.array([[0.0, 1e6, 0.0], [-1e6, 0.0, 0.0], [0.0, 0.0, 0.0]])
RADIUS, HALF, SPRING = 0.1, 0.2, 2e5  # [m], [m], [N/m] at each end


def masses(asymmetry: float) -> np.ndarray:
    """Return four masses of a ring [kg]: those on n1 are heavier, those on n2 lighter."""
    return 0.5 * (1.0 + asymmetry * np.array([1.0, -1.0, 1.0, -1.0]))


def rotor(asymmetry: float) -> ReducedRotor:
    """Return two rigid rings of four masses."""
    corners = RADIUS * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    nodes = np.vstack([corners + np.array([0.0, 0.0, z]) for z in (-HALF, HALF)])
    mass = np.kron(np.diag(np.tile(masses(asymmetry), 2)), np.eye(3))
    made = SolidRotor.from_matrices(mass, free_stiffness(nodes, 1e8 * np.eye(24)), nodes, "z")
    return made.with_interface("a", range(4)).with_interface("b", range(4, 8)).reduce(0)


def train(first: float, second: float, cross: float = 0.0) -> RotorTrain:
    """Return a rotor on springs, and one that turns faster and hardly pulls at it."""
    springs = [Support(name, [[SPRING, cross], [-cross, SPRING]]) for name in "ab"]
    stiff = [Support(name, 1e3 * SPRING) for name in "ab"]
    links = [Link(f"A:{n}", f"B:{n}", Support(n, 1e-9 * SPRING)) for n in "ab"]
    rotors = {"A": rotor(first), "B": rotor(second)}
    return RotorTrain(rotors, {"A": 1.0, "B": 1.37}, {"A": springs, "B": stiff}, links)


def conical(asymmetry: float) -> tuple[float, float]:
    """Return a speed at which a rotor by itself is unstable, and its growth [1/s].

    Euler's equations in the frame of the rotor, ``I₁φ̈₁ − (I₁+I₂−I₃)Ωφ̇₂ + κ₁φ₁ = 0`` with
    ``κ₁ = k + (I₃−I₂)Ω²``, likewise φ₂: unstable where κ₁κ₂ < 0.
    """
    m, squares = 2.0 * masses(asymmetry), RADIUS**2 * np.array([1.0, 0.0, 1.0, 0.0])
    I1, I2 = m @ (squares[[1, 0, 1, 0]] + HALF**2), m @ (squares + HALF**2)
    I3, k = m.sum() * RADIUS**2, 2.0 * SPRING * HALF**2
    speed = np.sqrt(k / (0.5 * (I1 + I2) - I3))
    K1, K2 = k + (I3 - I2) * speed**2, k + (I3 - I1) * speed**2
    middle = I1 * K2 + I2 * K1 + ((I1 + I2 - I3) * speed) ** 2
    return speed, np.sqrt(np.roots([I1 * I2, middle, K1 * K2]).max())


@pytest.mark.parametrize(
    ("first", "second", "counts"),
    [(1e-4, 0.0, True), (1e-4, 3e-2, False), (2e-2, 3e-2, True), (2e-2, 1e-4, True)],
)
def test_growth_counts_above_what_the_mean_of_another_rotor_leaves_out(first, second, counts):
    """That errs by the square of its unevenness, and growth by the first power of the other's."""
    speed, growth = conical(first)
    found = stability(train(first, second), [speed])
    # the link changes the rate 1 and the width of unstable speeds by 1e-9 and 1e-9/1e-4
    np.testing.assert_allclose(found.growth, growth, rtol=1e-4)
    assert found.stable[0] != counts


def test_growth_that_even_rotors_have_counts_however_small():
    """Cross-coupled springs: ``mz̈ + (k − ik_c)z = 0`` grows by ``k_c/2√(km)``, 2e-5 of its rate."""
    cross = 4e-5 * SPRING
    found = stability(train(1e-3, 3e-2, cross), [0.3 * conical(1e-3)[0]])
    assert cross / SPRING < 0.1 * 3e-2**2  # the error of the mean over a turn
    assert not found.stable[0]
    growth = 0.5 * cross / np.sqrt(SPRING * 2.0)  # two of k, k_c and 2 kg
    assert np.abs(found.exponents[0].real - growth).min() < 1e-3 * growth


@pytest.mark.filterwarnings("ignore:at 4000 rad/s motions grow")
@pytest.mark.parametrize(("ratio", "method"), [(1.0, "auto"), (2.0, "floquet")])
def test_axial_motion_of_an_uneven_mesh_grows_in_any_axes(ratio, method):
    """The drive feeds it by the bearings' damping; of a finer mesh it would be less.

    As constant equations in the frame of the rotor and as periodic ones in slower axes.
    """
    one, speed, springs = spool_with_growth()
    alone = stability(one, [speed], supports=springs, accuracy=None)
    assert not alone.stable[0]
    given = RotorTrain({"A": one}, {"A": ratio}, {"A": springs}, largest_unevenness=0.0)
    system = linear_model(given).whole_space(True).at(speed / ratio)
    assert system.is_constant == (ratio == 1.0)
    found = exponents(system, method, 1e-12).real.max()
    # of Floquet's method in 5e4 times the period that the tolerance is for
    assert abs(found - alone.growth[0]) < 1e-2 * alone.growth[0]


def test_growth_by_bearings_is_not_laid_to_the_mesh():
    one, speed, springs = spool_with_growth()
    crossed = [replace(each, stiffness=each.stiffness + CROSS, damping=0.0) for each in springs]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not stability(one, [speed], supports=crossed, accuracy=None).stable[0]


def test_free_motions_without_rigid_coordinates_count_whole():
    """Two masses on a rod: five free motions, whose frequencies are rounding, and the axial one."""
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    made = SolidRotor.from_matrices(2.0 * np.eye(6), rod, [[0, 0, -0.1], [0, 0, 0.1]], "z")
    turning = Turning.of(linear_model(made))
    assert sorted(turning.waves) == [-1, -1, 0, 0, 1, 1]
    np.testing.assert_allclose(np.sort(turning.weights), [0.5, 1, 1, 1, 1, 1], rtol=1e-12)
