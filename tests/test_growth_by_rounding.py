"""Growth that is rounding next to stiff supports, and growth that is not."""

import netgen.occ as occ
import ngsolve as ngs
import numpy as np
import pytest
from models import STEEL

from exudyn_rotor import SolidRotor, Support, craig_bampton_modes, stability
from exudyn_rotor.linear.periodic.exponents import constant_exponents
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.linear.periodic.verified import verified


def conservative(seed: int, stiffness: float) -> PeriodicSystem:
    """Return a gyroscopic system of ten coordinates, one of them on a stiff spring as well."""
    rng = np.random.default_rng(seed)
    root, spring = rng.normal(size=(10, 10)), rng.normal(size=10)
    gyroscopic = rng.normal(size=(10, 10))
    K = 1e4 * (root @ root.T + np.eye(10)) + stiffness * np.outer(spring, spring)
    return PeriodicSystem(
        100.0, {0: np.eye(10)}, {0: 20.0 * (gyroscopic - gyroscopic.T)}, {0: 0.5 * (K + K.T)}
    )


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("stiffness", [1e4, 1e14, 1e18])
def test_rounding_next_to_stiff_springs_is_no_growth(seed, stiffness):
    """With K positive definite and without damping a gyroscopic system does not grow (Kelvin)."""
    system = conservative(seed, stiffness)
    values, limits = constant_exponents(system), np.zeros(20)
    assert np.any(values.real > 0.0)  # rounding
    np.testing.assert_array_less(verified(values, limits, system).real, 1e-300)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("cause", ["damping", "circulatory"])
def test_growth_by_forces_stays(seed, cause):
    """Damping −d/2 or circulatory forces of 1 % of the stiffness: what grows is not touched."""
    system = conservative(seed, 1e14)
    D, K = system.D[0].copy(), system.K[0].copy()
    if cause == "damping":
        D -= 0.2 * np.eye(10)
    else:
        K += 100.0 * (D / np.abs(D).max())
    system = PeriodicSystem(100.0, system.M, {0: D}, {0: K})
    values = constant_exponents(system)
    checked = verified(values, np.full(20, 1e-3), system)
    growing = values.real > 1e-2
    assert np.sum(growing) >= 2
    np.testing.assert_array_equal(checked[growing], values[growing])


def test_bar_on_rigid_bearings_is_unstable_between_its_critical_speeds_only():
    """The range of a flat bar does not depend on bearings of 1e12 or 1e15 N/m, 1e5 times its own.

    The speeds are 30 rad/s apart; the bearings move the limits by less than 1e-4. A narrow range of
    two modes together, 0.5 rad/s wide at 1750 rad/s, is between two of them.
    """
    bar = occ.Box((-0.03, -0.02, 0.0), (0.03, 0.02, 1.0))
    bar.faces.Min(occ.Z).name, bar.faces.Max(occ.Z).name = "left", "right"
    mesh = ngs.Mesh(occ.OCCGeometry(bar).GenerateMesh(maxh=0.06))
    rotor = SolidRotor.from_ngsolve(mesh, STEEL, "z").center_interfaces()
    reduced = rotor.reduce(craig_bampton_modes(rotor, 8, coupling="RBE3"))
    torsion = Support("left", tilt_stiffness=np.diag([0.0, 0.0, 1e4]), frame="rotor")
    speeds = np.linspace(115.0, 2005.0, 64)
    verdicts = []
    for stiffness in (1e12, 1e15):
        bearings = [Support(name, stiffness * np.eye(3)) for name in ("left", "right")]
        verdicts.append(stability(reduced, speeds, supports=[*bearings, torsion]).stable)
    np.testing.assert_array_equal(*verdicts)
    assert 5 < np.sum(~verdicts[0]) < 12
    assert np.sum(np.diff(verdicts[0].astype(int)) != 0) == 2
