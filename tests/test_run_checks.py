"""Every check after a run passes a good run and finds what went wrong in a bad one."""

import exudyn
import numpy as np
import pytest
from exudyn.itemInterface import LoadCoordinate, MarkerNodeCoordinate
from models import STEEL, disc_on_shaft

from exudyn_rotor import (
    AssumptionWarning,
    PrescribedMotion,
    SolidRotor,
    Support,
    add_rotor,
    check_run,
    keep_modes,
    propose,
    recommended_settings,
)

SUPPORTS = [Support(name, 1e7, 500.0) for name in ("left", "right")]
PLACES = {"left": 0.0, "right": 0.5}


@pytest.fixture(scope="module")
def solid() -> SolidRotor:
    solid = SolidRotor.from_ngsolve(disc_on_shaft(0.09), STEEL, "z", order=1)
    return solid.center_interfaces().add_point_mass((0.15, 0.0, 0.215), 0.01)


@pytest.fixture(scope="module")
def reduced(solid):
    return solid.reduce(40)


@pytest.fixture(scope="module")
def stressed(solid):
    return solid.reduce(12, prestress=solid.prestress(yield_stress=2e8))


def solve(mbs, end_time, step) -> None:
    mbs.Assemble()
    settings = recommended_settings(end_time, step)
    settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
    settings.solution.sensors.writePeriod = step
    mbs.SolveDynamic(settings)


def on_bearings(rotor, stiffness=1e7, **options):
    """Return a rotor body on two bearings; neither assembled nor run."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, **options)
    for name, z in PLACES.items():
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[mbs.CreateGround(), body.marker(name)],
            localPosition0=[0, 0, z],
            stiffness=[stiffness] * 3,
            damping=[500.0] * 3,
        )
    body.watch()
    return body


def at_start(rotor, values=None, **options):
    """Return a body in its initial state, with modal coordinates by label."""
    body = add_rotor(exudyn.SystemContainer().AddSystem(), rotor, **options)
    start = [(values or {}).get(label.split(" (")[0], 0.0) for label in body.selection.labels]
    mbs = exudyn.SystemContainer().AddSystem()
    body = add_rotor(mbs, rotor, modal_coordinates=start, **options)
    mbs.Assemble()
    return body


def failed(body, **options) -> set[str]:
    """Return the names of the failed rows, each of which is one warning."""
    with pytest.warns(AssumptionWarning) as caught:
        result = check_run(body, **options)
    assert len(caught) == len(result.failed)
    assert all(row.advice in str(w.message) for row, w in zip(result.failed, caught, strict=True))
    return {row.name for row in result.failed}


def test_without_a_watch_the_final_state_alone_is_checked(reduced):
    result = check_run(at_start(keep_modes(reduced, range(4))), warn=False)
    assert not result.complete
    assert "body.watch()" in str(result)
    body = on_bearings(keep_modes(reduced, range(4)), spin=50.0)
    solve(body.mbs, 0.01, 1e-4)
    assert check_run(body, warn=False).complete


def test_a_wide_tilt_fails(reduced):
    inv = reduced.invariants
    transverse = np.sqrt(np.trace(inv.J) - inv.Theta / 2)
    body = at_start(keep_modes(reduced, []), {"tilt 1": 0.05 * transverse}, spin=10.0)
    assert "tilt" in failed(body)
    assert check_run(body, warn=False)["tilt"].value == pytest.approx(0.05, rel=0.01)


def test_wide_bending_and_travel_fail(reduced):
    size = np.sqrt(np.trace(reduced.invariants.J))  # √kg m: coordinates per radius of gyration
    few = keep_modes(reduced, range(4))
    assert "deflection" in failed(at_start(few, {"mode 1": 0.04 * size}, spin=10.0))
    moved = at_start(few, {"translation 1": 0.2 * size}, spin=10.0, translation="none")
    assert "travel" in failed(moved)
    assert check_run(moved, warn=False)["travel"].value == pytest.approx(0.2, rel=1e-3)


def test_energy_in_the_highest_modes_fails(reduced):
    few = keep_modes(reduced, range(10))
    body = at_start(few, {"mode 10": 0.2 / few.frequencies[-1], "mode 1": 1.0 / few.frequencies[6]})
    assert failed(body) == {"top modes"}
    share = check_run(body, warn=False)["top modes"].value
    assert share == pytest.approx(0.04 / 1.04, rel=1e-2)


@pytest.mark.parametrize("start", ["sudden", "settled"])
def test_breathing_of_a_disc_is_no_lack_of_modes(reduced, start):
    few = keep_modes(reduced, [0, 1, 2, 3, 4, 5, 10, 11, 28, 29])  # 28 breathes
    inv, options = few.invariants, {"spin": 300.0, "translation": "none"}
    stretch = np.append(np.zeros(5), 300.0**2 * inv.h[6:] / np.diag(inv.K)[6:])
    settled = {"modal_coordinates": stretch} if start == "settled" else {}
    body = on_bearings(few, **options, **settled)
    solve(body.mbs, 0.02, 1e-4)
    assert check_run(body, warn=False)["top modes"].ok
    # what moves besides is seen
    ringing = on_bearings(few, **options, modal_velocities=np.append(np.zeros(14), 0.5))
    solve(ringing.mbs, 0.02, 1e-5)
    assert "top modes" in failed(ringing)


def test_a_fast_rotor_lacks_stiffening(stressed):
    few = keep_modes(stressed, range(4))
    values = {"mode 1": 1e-2}
    assert "stiffening" in failed(at_start(few, values, spin=1200.0))
    full = at_start(few, values, spin=1200.0, stiffening="full")
    assert check_run(full, warn=False)["stiffening"].ok


def test_strain_yielding_and_speed_fail(solid, stressed):
    # discs breathe at high frequencies
    modes = solid.reduce(40, prestress=solid.prestress(yield_stress=2e8))
    proposal = propose(stressed, speeds=300.0, supports=SUPPORTS)
    with pytest.warns(AssumptionWarning):
        result = check_run(at_start(modes, spin=3500.0), reduced=modes, proposal=proposal)
    assert not any(result[name].ok for name in ("strain", "yield", "speed"))
    body = at_start(modes, spin=200.0)
    slow = check_run(body, reduced=modes, proposal=proposal, warn=False)
    assert all(slow[name].ok for name in ("strain", "yield", "speed"))


def test_a_servo_that_lags_leaves_its_place(reduced):
    motion = PrescribedMotion.run_up(0.0, 300.0, 0.02)
    few = keep_modes(reduced, range(4))
    rows = {}
    for locking in ("mass", "constraints"):
        body = on_bearings(few, spin=motion, translation="none", locking=locking)
        solve(body.mbs, 0.02, 2e-4)
        rows[locking] = check_run(body, warn=False)["locked"]
    assert not rows["mass"].ok
    assert rows["constraints"].ok


def test_a_torque_that_no_equation_feels_is_lost(reduced):
    body = on_bearings(keep_modes(reduced, range(4)), spin=50.0)
    marker = body.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=body.nodes["rigid"], coordinate=3))
    body.mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=1e4))
    solve(body.mbs, 0.01, 1e-4)
    assert "lost load" in failed(body)


def test_coarse_steps_fail(reduced):
    body = on_bearings(keep_modes(reduced, range(4)), spin=300.0)
    solve(body.mbs, 0.06, 2e-3)
    assert {"step", "spin step"} <= failed(body)


def test_limits_are_checked(reduced):
    body = at_start(keep_modes(reduced, range(4)), {"mode 1": 1e-5}, spin=10.0)
    assert "deflection" in failed(body, limits={"deflection": 1e-9})
    for limits in ({"height": 1.0}, {"tilt": -1.0}, {"tilt": np.nan}):
        with pytest.raises(ValueError, match="limits"):
            check_run(body, limits=limits)
