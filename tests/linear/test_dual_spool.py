"""Two spools of solids, coaxial and geared, against beams of ROSS; what mesh and few modes do."""

import warnings

import numpy as np
import pytest
from spool_models import ROSS, dual_spool, spool
from train_models import lateral, two_discs

from exudyn_rotor import (
    GearMesh,
    Link,
    RotorTrain,
    Support,
    Unbalance,
    campbell,
    critical_speeds,
    linear_model,
    stability,
    unbalance_response,
)

GEARS = ROSS["geared"]
SPEED = 800.0
LIMIT = 2000.0  # rad/s, of the frequencies that are looked at
BEARING = np.diag([2e7, 6e7])


@pytest.mark.parametrize("ratio", [1.5, -1.3])
def test_dual_spool_against_ross(ratio):
    """Frequencies of beams within the give of a solid's sections, which speed does not change."""
    found = campbell(dual_spool(ratio), ROSS["speeds"], accuracy=None)
    exact = ROSS["dual"][str(ratio)]
    errors = []
    for row, reference in enumerate(exact):
        values = lateral(found, row)[: len(reference["frequencies"])]
        errors.append(values.imag / reference["frequencies"] - 1.0)
        np.testing.assert_allclose(values.real, reference["growth"], rtol=0.05, atol=0.1)
    # the mesh of this test errs by 1 %, one with three times the nodes by half of that
    assert np.abs(errors).max() < 1.2e-2
    assert np.abs(np.diff(errors, axis=0)).max() < 2.5e-3
    assert stability(dual_spool(ratio), ROSS["speeds"][-1:], accuracy=None).stable[0]


@pytest.mark.parametrize(("name", "order"), [("inner", 1.0), ("outer", 1.5)])
def test_critical_speeds_of_the_dual_spool_against_ross(name, order):
    """By unbalance of each spool, in speeds of the inner one."""
    found = critical_speeds(
        dual_spool(1.5), order=order, nodal_diameters=[1], max_speed=4000.0, accuracy=None
    )
    forward = found.speeds[np.array(found.whirl) == "forward"][:4]
    np.testing.assert_allclose(forward, ROSS["critical"][name], rtol=1.2e-2)


def test_axisymmetric_part_and_what_is_left():
    """Mean over a turn: even to rounding for rings, of the mesh for a solid."""
    assert linear_model(two_discs(1.7)).unevenness < 1e-12
    train = dual_spool(1.5)
    for each in (train, train.relative_to("outer")):
        assert 1e-4 < linear_model(each).unevenness < 5e-2


def geared(modes: int, free: bool = False) -> RotorTrain:
    """Return the spools side by side, geared 1 : -1."""
    rotors = {name: spool(name, modes, free) for name in ("inner", "outer")}
    held = Support("front", 2e7 * np.eye(3)), Support("rear", 2e7, 200.0)
    gears = GearMesh(radii=[0.1, 0.1], stiffness=2e8)
    links = [Link("inner:middle", "outer:rear", gears)]
    return RotorTrain(rotors, {"inner": 1.0, "outer": -1.0}, dict.fromkeys(rotors, held), links)


def uneven(modes: int, free: bool = False) -> RotorTrain:
    """Return the dual spool with unequal bearings of the outer one."""
    given = dual_spool(1.5, modes, free)
    supports = {"inner": given.supports["inner"], "outer": [Support("front", BEARING, 300.0)]}
    return RotorTrain(given.rotors, given.ratios, supports, given.links)


TRAINS = {
    "1.5": lambda *modes: dual_spool(1.5, *modes),
    "uneven": uneven,
    "geared": geared,
}


def nearest(values: np.ndarray, given: np.ndarray, speed: float) -> np.ndarray:
    """Return those of `values` nearest to given ones, in any frame that turns with n Ω."""
    copies = np.r_[values, values.conj()] + 1j * speed * np.arange(-4, 5)[:, None]
    copies = copies.ravel()
    return copies[np.argmin(np.abs(copies - given[:, None]), axis=1)]


@pytest.mark.parametrize("name", TRAINS)
def test_estimates_are_the_errors_against_more_modes(name):
    """Five free modes of each rotor lack flexibility; 16 with static ones are the truth."""
    with pytest.warns(UserWarning, match=r"rotor 'inner' .* rotor 'outer' .* the flexibility"):
        found = campbell(TRAINS[name](5, True), [0.0, SPEED], modes=18)
    exact = campbell(TRAINS[name](16), [0.0, SPEED], accuracy=None)
    for row, speed in enumerate(found.speeds):
        given, true = (r.growth[row] + 1j * r.frequencies_rotor[row] for r in (found, exact))
        looked_at = (found.frequencies_inertial[row] < LIMIT) & (np.abs(given) > 1.0)
        given, shifts = given[looked_at], found.basis_shifts[row, looked_at]
        errors = nearest(true, given + shifts, speed) - given
        known = np.isfinite(shifts)  # motions that err too much are not found again
        assert known.sum() >= 0.8 * len(known)
        # frequencies fall in the frame of one rotor where they rise in that of another
        shifts, errors = (np.abs(x[known].view(float)) for x in (shifts, errors))
        assert errors.max() > 20.0
        assert np.all(np.abs(shifts - errors) < 0.05 * errors + 0.02)


@pytest.mark.parametrize("order", [1.0, 1.5])
def test_estimates_of_critical_speeds(order):
    """By unbalance of either spool."""
    given = {"order": order, "nodal_diameters": [1], "max_speed": 1400.0}
    with pytest.warns(UserWarning, match="the critical speed of"):
        found = critical_speeds(dual_spool(1.5, 5, True), **given)
    exact = critical_speeds(dual_spool(1.5, 16), accuracy=None, **given)
    errors = 1.0 - exact.speeds[: len(found.speeds)] / found.speeds
    assert errors.max() > 0.02
    np.testing.assert_allclose(found.basis_errors, errors, rtol=0.05)


@pytest.mark.parametrize("name", ["1.5", "uneven"])
def test_estimates_of_responses(name):
    """At the first speed, the middle one and the last one."""
    speeds, unbalance = [150.0, 300.0, 350.0, 600.0], Unbalance("inner:front", 1e-3)
    with pytest.warns(UserWarning, match="the motion of"):
        found = unbalance_response(TRAINS[name](5, True), speeds, unbalance, own=False)
    exact = unbalance_response(TRAINS[name](16), speeds, unbalance, own=False, accuracy=None)
    known = np.isfinite(found.basis_errors[:, 0])
    assert known.sum() == 3
    for row in np.flatnonzero(known):
        given, true = (
            one.motion[row, :, one.orders.tolist().index(1), :3] for one in (found, exact)
        )
        sizes = np.linalg.norm(true, axis=1)
        away = np.linalg.norm(given - true, axis=1) / np.maximum(sizes, 0.1 * sizes.max())
        np.testing.assert_allclose(found.basis_errors[row], away, rtol=0.1, atol=1e-3)


def gears() -> GearMesh:
    """Return the mesh of the reference."""
    names = ("stiffness", "pressure_angle", "line_angle")
    return GearMesh(radii=GEARS["base_radii"], **{name: GEARS[name] for name in names})


def geared_spools(meshing: bool) -> RotorTrain:
    """Return the spools of the reference side by side."""
    supports = {
        name: [
            Support(at, np.diag([k, k, along]), np.diag([c, c, 0.0]))
            for at, (_, k, c, along) in zip(("front", "rear"), each, strict=True)
        ]
        for name, each in GEARS["bearings"].items()
    }
    links = [Link("inner:middle", "outer:rear", gears())] if meshing else []
    rotors = {name: spool(name) for name in supports}
    first, second = GEARS["teeth"]
    return RotorTrain(rotors, {"inner": 1.0, "outer": -first / second}, supports, links)


def test_gear_mesh_is_that_of_ross():
    """``k v vᵀ``; ROSS's torsion of the driven rotor is positive as that rotor turns."""
    v = gears().direction
    v = v * np.r_[np.ones(11), -1.0]
    np.testing.assert_allclose(np.outer(v, v), GEARS["coupling"], atol=1e-15)


@pytest.mark.parametrize("meshing", [True, False], ids=["meshing", "apart"])
def test_geared_spools_against_ross(meshing):
    """As far from the beams with gears as without: the solids' mesh errs by up to 1 %."""
    found = campbell(geared_spools(meshing), ROSS["speeds"], accuracy=None)
    assert len(found.free_motions) == (1 if meshing else 2)
    for row, reference in enumerate(GEARS["meshing" if meshing else "apart"]):
        values = found.growth[row] + 1j * found.frequencies_inertial[row]
        values = values[values.imag > 1.0]
        values = values[np.argsort(values.imag)][:12]
        np.testing.assert_allclose(values.imag, reference["frequencies"], rtol=1e-2)
        np.testing.assert_allclose(values.real, reference["growth"], rtol=0.05, atol=0.1)


def test_modes_of_geared_spools_are_those_of_ross():
    """Motions of both gears at rest: the angle between ours and theirs in twelve coordinates."""
    train, sizes = geared_spools(True), np.tile(np.repeat([1.0, 0.075], 3), 2)
    found, model = campbell(train, [0.0], accuracy=None), linear_model(train)
    seen = np.vstack([model.seen(at, 0.0)[0] for at in ("inner:middle", "outer:rear")])
    moving = np.flatnonzero(found.frequencies_inertial[0] > 1.0)[:12]
    given, theirs = seen @ found.vectors[0][:, moving], np.array(GEARS["shapes"]).T
    theirs[-1] *= -1.0
    given, theirs = (sizes[:, None] * each for each in (given, theirs))
    products = np.abs(np.sum(given.conj() * theirs, axis=0)) ** 2
    lengths = np.sum(np.abs(given) ** 2, axis=0) * np.sum(theirs**2, axis=0)
    assert (products / lengths).min() > 0.99


def test_bases_that_suffice_give_small_errors_without_a_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        good = campbell(dual_spool(1.5, 16), [0.0, SPEED], modes=8)
    assert 0.0 < np.nanmax(good.basis_errors) < 1e-3
