"""Campbell diagrams against closed forms, and what they do where a value cannot be computed."""

import time
import warnings

import numpy as np
import pytest
from asymmetric import asymmetric_shaft
from models import centered_disc
from point_rotors import ring_rotor

from exudyn_rotor import RotorTrain, Support, campbell


def disc(modes=12):
    return centered_disc().reduce(modes)


def rigid(axis="z"):
    """Return a rigid rotor of ten masses with its I_p and I_t, supported where they are."""
    radius, half, mass = 0.15, 0.05, 20.0
    rotor = ring_rotor(radius, half, mass).with_interface("left", range(5))
    rotor = rotor.with_interface("right", range(5, 10))
    return rotor, mass * radius**2, mass * (0.5 * radius**2 + half**2), half, mass


@pytest.mark.parametrize("speed", [0.0, 40.0, 200.0, 700.0])
@pytest.mark.parametrize(("kx", "ky"), [(1e6, 1e6), (1e6, 2.5e6)])
def test_rigid_disc_on_springs_that_differ(speed, kx, ky):
    """``(c_x − I_t ω²)(c_y − I_t ω²) = (I_p Ω ω)²`` for tilts, ``k_x/m`` and ``k_y/m`` else."""
    rotor, Ip, It, half, mass = rigid()
    supports = [Support(name, np.diag([kx, ky])) for name in ("left", "right")]
    found = campbell(rotor, [speed], supports=supports, accuracy=None)
    cx, cy = 2.0 * kx * half**2, 2.0 * ky * half**2
    tilts = np.roots([It**2, -(It * (cx + cy) + (Ip * speed) ** 2), cx * cy])
    wanted = np.sqrt(np.r_[2.0 * kx / mass, 2.0 * ky / mass, tilts.real])
    frequencies = found.frequencies_inertial[0]
    frequencies = np.sort(frequencies[frequencies > 1.0])[:4]
    # the masses are on springs of 1e8 N/m
    np.testing.assert_allclose(frequencies, np.sort(wanted), rtol=2e-2)


def test_uneven_bearings_over_fifty_speeds_take_no_time_and_agree_with_a_train():
    supports = [Support(n, np.diag([2e7, 4e7]), np.diag([500.0, 300.0])) for n in ("left", "right")]
    speeds = np.linspace(0.0, 628.0, 51)
    rotor = disc()
    begun = time.process_time()
    found = campbell(rotor, speeds, supports=supports, accuracy=None)
    assert time.process_time() - begun < 5.0
    assert np.all(np.isfinite(found.growth))
    train = RotorTrain({"r": rotor}, {"r": 1.0}, {"r": supports})
    other = campbell(train, speeds, accuracy=None)
    np.testing.assert_allclose(
        np.sort(found.frequencies_inertial), np.sort(other.frequencies_inertial), rtol=1e-8,
        atol=1e-6,
    )  # fmt: skip


def test_spin_stands_once_and_overdamped_motions_stand_in_the_list():
    supports = [Support(n, np.diag([1e6, 2e6]), 1.5e5) for n in ("left", "right")]
    found = campbell(disc(6), [31.4], supports=supports, accuracy=None)
    assert found.growth.shape[1] == found.vectors.shape[1]
    spins = (found.whirl[0] == "torsional") & (found.frequencies_inertial[0] == 0.0)
    assert np.count_nonzero(spins) == 1
    assert np.count_nonzero(found.whirl[0] == "overdamped") >= 2
    assert np.all(found.frequencies_rotor >= 0.0)


def test_speeds_without_values_are_nan_with_one_warning():
    table = np.array([0.0, 300.0]), np.array([1e7, 2e7])
    supports = [Support(n, table, 300.0) for n in ("left", "right")]
    with pytest.warns(UserWarning, match="no values at 301") as caught:
        found = campbell(disc(), [100.0, 299.0, 301.0], supports=supports, accuracy=None)
    assert len(caught) == 1
    assert np.all(np.isnan(found.growth[2]))
    assert np.all(np.isfinite(found.growth[:2]))
    assert found.table(1).splitlines()[3].split()[2:6] == ["-"] * 4
    assert found.plot().get_legend() is not None


def test_a_mode_that_is_not_found_at_one_speed_is_missing_there_alone():
    """At 1 rad/s three of the lowest six need more harmonics than are taken."""
    uneven = np.diag([3e5, 3e6, 1e7])
    rotor, supports = asymmetric_shaft(), [Support(n, uneven, 50.0) for n in ("left", "right")]
    later = campbell(rotor, [20.0, 100.0], supports=supports, modes=6, accuracy=None)
    with pytest.warns(UserWarning, match="do not converge for all motions at 1 rad/s, which are"):
        found = campbell(rotor, [1.0, 20.0, 100.0], supports=supports, modes=6, accuracy=None)
    wanted = later.frequencies_inertial
    np.testing.assert_allclose(found.frequencies_inertial[1:], wanted, rtol=1e-6, atol=1e-9)
    assert np.all(found.continued)
    first = found.frequencies_inertial[0]
    np.testing.assert_allclose(first[:3], wanted[0, [0, 3, 5]], atol=1e-6, rtol=1e-3)
    assert np.all(np.isnan(first[3:]))
    with warnings.catch_warnings():  # where none that is shown is missing nothing is told
        warnings.simplefilter("error")
        few = campbell(rotor, [2.0, 20.0], supports=supports, modes=1, accuracy=None)
    assert np.all(np.isfinite(few.growth))


def test_lines_follow_their_modes_through_a_crossing():
    supports = [Support(n, 2e7, 200.0) for n in ("left", "right")]
    found = campbell(disc(), np.linspace(0.0, 2000.0, 41), supports=supports, accuracy=None)
    tracked = found.tracked()
    lateral = (tracked.nodal_diameters[20] == 1) & (tracked.frequencies_inertial[20] > 1.0)
    steps = np.abs(np.diff(tracked.frequencies_inertial[:, lateral], axis=0))
    assert steps.max() < 2.1 * 50.0 + 1e-2 * tracked.frequencies_inertial.max()
    assert tracked.continued[:, lateral].mean() > 0.97
