"""Two spools of solids, coaxial and geared: what the mesh and few modes do."""

import numpy as np
import pytest
from spool_models import dual_spool, spool
from train_models import two_discs

import exudyn_rotor as er

SPEED = 800.0
LIMIT = 2000.0  # rad/s, of the frequencies that are looked at
BEARING = np.diag([2e7, 6e7])


def test_axisymmetric_part_and_what_is_left():
    """Mean over a turn: even to rounding for rings, of the mesh for a solid."""
    assert er.linear_model(two_discs(1.7)).unevenness < 1e-12
    train = dual_spool(1.5)
    for each in (train, train.relative_to("outer")):
        assert 1e-4 < er.linear_model(each).unevenness < 5e-2


def geared(modes: int, free: bool = False) -> er.RotorTrain:
    """Return the spools side by side, geared 1 : -1."""
    rotors = {name: spool(name, modes, free) for name in ("inner", "outer")}
    held = er.Support("front", 2e7 * np.eye(3)), er.Support("rear", 2e7, 200.0)
    gears = er.GearMesh(radii=[0.1, 0.1], stiffness=2e8)
    links = [er.Link("inner:middle", "outer:rear", gears)]
    return er.RotorTrain(rotors, {"inner": 1.0, "outer": -1.0}, dict.fromkeys(rotors, held), links)


def uneven(modes: int, free: bool = False) -> er.RotorTrain:
    """Return the dual spool with unequal bearings of the outer one."""
    given = dual_spool(1.5, modes, free)
    supports = {"inner": given.supports["inner"], "outer": [er.Support("front", BEARING, 300.0)]}
    return er.RotorTrain(given.rotors, given.ratios, supports, given.links)


TRAINS = {
    "1.5": lambda *modes: dual_spool(1.5, *modes),
    "uneven": uneven,
    "geared": geared,
}


def copies(values: np.ndarray, speed: float) -> np.ndarray:
    """Return λ of motions as seen in any frame that turns with n Ω, and their conjugates."""
    return (np.r_[values, values.conj()] + 1j * speed * np.arange(-4, 5)[:, None]).ravel()


@pytest.mark.parametrize("name", TRAINS)
def test_estimates_are_the_errors_against_more_modes(name):
    """Five free modes of each rotor lack flexibility; 16 with static ones are the truth."""
    with pytest.warns(UserWarning, match=r"rotor 'inner' .* rotor 'outer' .* the flexibility"):
        found = er.campbell(TRAINS[name](5, True), [0.0, SPEED], modes=18)
    exact = er.campbell(TRAINS[name](16), [0.0, SPEED], accuracy=None)
    for row, speed in enumerate(found.speeds):
        given, true = (r.growth[row] + 1j * r.frequencies_rotor[row] for r in (found, exact))
        looked_at = (found.frequencies_inertial[row] < LIMIT) & (np.abs(given) > 1.0)
        known = looked_at & np.isfinite(found.basis_errors[row])
        assert known.sum() >= 0.8 * looked_at.sum()  # those that err too much are not found again
        away = copies(true, speed) - given[known, None]
        least = np.maximum(found.frequencies_inertial[row, known], 0.1 * speed)
        sizes = np.maximum(np.abs(given[known].real), 0.01 * least)
        parts = np.abs(away.imag) / least[:, None], np.abs(away.real) / sizes[:, None]
        estimates = found.basis_errors[row, known]
        assert estimates.max() > 0.01
        missed = np.abs(np.maximum(*parts) - estimates[:, None]).min(axis=1)
        assert np.all(missed < 0.05 * estimates + 1e-3)


@pytest.mark.parametrize("order", [1.0, 1.5])
def test_estimates_of_critical_speeds(order):
    """By unbalance of either spool."""
    given = {"order": order, "nodal_diameters": [1], "max_speed": 1400.0}
    with pytest.warns(UserWarning, match="the critical speed of"):
        found = er.critical_speeds(dual_spool(1.5, 5, True), **given)
    exact = er.critical_speeds(dual_spool(1.5, 16), accuracy=None, **given)
    errors = 1.0 - exact.speeds[: len(found.speeds)] / found.speeds
    assert errors.max() > 0.02
    np.testing.assert_allclose(found.basis_errors, errors, rtol=0.1)


@pytest.mark.parametrize("name", ["1.5", "uneven"])
def test_estimates_of_responses(name):
    """At the first speed, the middle one and the last one."""
    speeds, unbalance = [150.0, 300.0, 350.0, 600.0], er.Unbalance("inner:front", 1e-3)
    with pytest.warns(UserWarning, match="the motion of"):
        found = er.unbalance_response(TRAINS[name](5, True), speeds, unbalance, own=False)
    exact = er.unbalance_response(TRAINS[name](16), speeds, unbalance, own=False, accuracy=None)
    known = np.isfinite(found.basis_errors[:, 0])
    assert known.sum() == 3
    for row in np.flatnonzero(known):
        given, true = (
            one.motion[row, :, one.orders.tolist().index(1), :3] for one in (found, exact)
        )
        sizes = np.linalg.norm(true, axis=1)
        away = np.linalg.norm(given - true, axis=1) / np.maximum(sizes, 0.1 * sizes.max())
        np.testing.assert_allclose(found.basis_errors[row], away, rtol=0.1, atol=1e-3)
