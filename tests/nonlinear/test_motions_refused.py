"""What periodic_response and limit_cycles refuse, what to do then, and what they find beside it."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
import scipy.linalg as la
from test_inter_shaft import PADS
from test_limit_cycles import DOWN, films
from test_periodic_response import MASS, Cubic, point
from test_rolling_bearings import UPRIGHT
from test_rolling_bearings import bearing as rolling
from test_rolling_bearings import response as on_balls
from test_scenes_and_trains import DAMPERS, ENDS, THRUST, UNBALANCE, block, rings
from test_structural_damping import ETA, K, one_mass
from test_structural_damping import MASS as DISC

import exudyn_rotor as er
from exudyn_rotor.nonlinear import continuation
from exudyn_rotor.nonlinear.rest import Unloaded

STILL = er.PrescribedMotion(*[lambda t: [0.0, 0.0, 0.0]] * 3)
PADDED = er.TiltingPadBearing(interface="seat", film=PADS)
STOP = er.ClearanceStop(interface="seat", radius=0.05, clearance=2e-4, stiffness=5e6)
DUFFING, SMALL = Cubic(interface="seat"), er.Unbalance("seat", 1e-6)


def on_point(*values, load=SMALL, **options):
    return er.periodic_response(point(), values, load, **({"supports": DUFFING} | options))


def on_dampers(**options):
    given = {"supports": [*DAMPERS, THRUST], "gravity": DOWN, "follow": False}
    return er.periodic_response(rings(), [200.0], UNBALANCE, **given, **options)


def scene(*supports, based=(), sags=True, down=(DOWN,), **options):
    """Return a system of one or more rotors on supports on the ground, or on a block."""
    mbs, options = exu.SystemContainer().AddSystem(), {"spin": 100.0} | options
    names = [str(number) for number in range(len(down))]
    bodies = [
        er.add_rotor(mbs, rings(), name=name, gravity=gravity, **options)
        for name, gravity in zip(names, down, strict=True)
    ]
    for body in bodies:
        er.add_supports(body, supports)
        if based:
            carried = er.add_foundation(mbs, block(), **({"gravity": DOWN} if sags else {}))
            er.add_supports(body, based, carried)
    mbs.Assemble()
    return mbs, bodies if len(down) > 1 else bodies[0]


def in_scene(*supports, load=UNBALANCE, given=None, **changes):
    mbs, body = scene(*supports, **changes)
    return er.periodic_response(mbs, [200.0], load, body=body, follow=False, **(given or {}))


def start(changes, **options):
    return replace(on_dampers(), **changes).state(0, scene(**options)[1])


def cycles(supports=None, down=DOWN, highest=3000.0):
    onset = er.stability_threshold(rings(), 50.0, highest, supports=films())
    return er.limit_cycles(rings(), [80.0], onset, supports=supports or films(), gravity=down)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: on_point(1.0, over=lambda k: DUFFING, speed=9.0), "supports: come from over=…"),
        (lambda: on_point(1.0, speed=9.0), "speed: is for another parameter .*leave it out"),
        (lambda: on_point(1.0, over="unbalance"), "speed: needs the spin speed"),
        (lambda: on_point(300.0, supports=STOP), "at any .in its clearance .*give a load"),
        (lambda: on_point(300.0, 400.0, supports=STOP), "at 300 and 400, .*give other values"),
        (lambda: on_point(9.0, load=er.Unbalance("top", 1.0)), "at: 'top': no such interface"),
        (lambda: on_point(9.0, body=3), "body: is only for an exudyn.MainSystem"),
        (lambda: on_point(9.0, supports=PADDED), r"motions of their own; give .*linearised\(\)"),
        (lambda: on_balls(rolling("left"), [9.0], rotor=rings()), "against .*tilt"),
        (lambda: on_balls(rolling(), [9.0], gravity=UPRIGHT), "without a load no element carries"),
        (lambda: on_balls(er.Support("seat", 1e6), [9.0]), "none has a nonlinear law"),
        (lambda: on_balls([rolling(), rolling(count=9)], [9.0]), "give one kind as it is"),
        (lambda: on_balls(rolling(), [-9.0, 9.0]), "-9 is negative"),
        (lambda: on_dampers().at(120.0), "nothing was computed at 120; the nearest is 200"),
        (lambda: on_dampers().phasor(spin=0.5), "needs a multiple of 1/1, got 0.5; .*revolutions="),
        (lambda: in_scene(given={"supports": DUFFING}), "a scene has its own; leave these out"),
        (lambda: in_scene(*DAMPERS, translation=STILL), "'0' follows a prescribed translation"),
        (lambda: in_scene(DAMPERS[0], based=DAMPERS[1:]), "'right' stands on something else"),
        (lambda: in_scene(down=(DOWN, [0, 0, 0]), load=()), "different gravity; give all the same"),
        (lambda: start({}, based=DAMPERS), "'0' has 6 .* and 6 of a foundation"),
        (lambda: start({"coordinates": None}), "coordinates that turn"),
        (lambda: cycles([rolling(end) for end in ENDS]), "a round rotor without rolling bearings"),
        (lambda: cycles(highest=100.0), "onset: the rotor does not turn unstable"),
        (lambda: cycles(down=[0.0, -20.0, 0.0]), r"no whirl begins; are the supports the same\?"),
        (lambda: cycles(down=[0.0, -1e5, 0.0]), "onset: no whirl of small size"),
    ],
)
def test_it_says_what_to_do(call, message):
    with pytest.raises((TypeError, ValueError), match=message):
        call()


# ------------------------------------------------------------------ values


def test_supports_over_a_parameter_of_the_user():
    """``|k + k₃ r² − mΩ² + icΩ| r = U Ω²``, with one point for each stiffness."""
    found = er.periodic_response(
        point(), [3e5, 1e6], er.Unbalance("seat", 1e-5), follow=False, speed=90.0,
        over=lambda k: Cubic(interface="seat", k=k),
    )  # fmt: skip
    r = found.amplitudes()
    k = found.values + DUFFING.k3 * r**2 - MASS * 90.0**2 + 90j * DUFFING.c
    np.testing.assert_allclose(np.abs(k) * r, 1e-5 * 90.0**2, rtol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(found.orbit(1), axis=1), r[1], rtol=1e-9)


def test_weight_bends_a_turning_shaft_with_structural_damping_sideways():
    """``(k + K (1 − iη)) z = −i m g``: what stands still turns backward in the shaft."""
    found = er.periodic_response(
        one_mass(loss=ETA), [120.0], er.Unbalance("disc", 1e-5), gravity=DOWN, follow=False,
        supports=Cubic(interface="disc", k=1e5, k3=0.0),
    )  # fmt: skip
    x, y = (found.phasor("disc", name, spin=0.0)[0].real for name in ("n1", "n2"))
    assert x + 1j * y == pytest.approx(-9.81j * DISC / (1e5 + K * (1.0 - 1j * ETA)), rel=1e-8)


def test_fast_modes_yield_as_springs():
    """Constant forces move the journals as much; slow modes stay; ω of the others is 7 kHz."""
    springs = [er.Support(end, 1e5) for end in ENDS]
    rest = Unloaded(er.linear_model(rings(modes=8), supports=springs), ENDS, 0.0)
    made = [rest.up_to(limit) for limit in (np.inf, 1e3)]
    assert made[0][0].size > made[1][0].size
    (yields, slow), found = (
        (C[0] @ la.solve(K, C[0].T), la.eigh(K, M, eigvals_only=True)[:4])
        for (M, _, K), C in ((system.matrices(), C) for system, C in made)
    )
    np.testing.assert_allclose(found[0], yields, atol=1e-9 * np.abs(yields).max())
    np.testing.assert_allclose(found[1], slow, rtol=1e-9)


def test_a_train_of_a_scene_and_ground_that_does_not_sag():
    found = in_scene(*DAMPERS, THRUST, down=(DOWN, DOWN), load=er.Unbalance("0:left", 1e-4))
    alone = on_dampers().amplitudes("left")
    np.testing.assert_allclose(found.amplitudes("0:left"), alone, rtol=1e-9)
    sagging, not_sagging = (
        in_scene(based=[*DAMPERS, THRUST], sags=sags).phasor("left", spin=0.0)[0].real
        for sags in (True, False)
    )
    assert sagging - not_sagging == pytest.approx(-9.81 * 10.0 / 8e6, rel=1e-9)


@pytest.mark.parametrize(
    ("constant", "value", "told"),
    [("_SHORTEST", 1.0, "a branch is lost beyond, 100, 150"), ("_MOST_POINTS", 2, "beyond, 10")],
)
def test_a_branch_that_is_lost_is_told(constant, value, told, monkeypatch):
    monkeypatch.setattr(continuation, constant, value)
    with pytest.warns(UserWarning, match=told):
        found = on_point(100.0, 150.0, load=er.Unbalance("seat", 1e-4))
    assert {100.0, 150.0} <= set(found.values)


def test_a_value_without_coefficients_costs_no_other():
    spring = er.Support("seat", lambda speed: np.nan if speed == 120.0 else 1e5)
    with pytest.warns(UserWarning, match="no steady motion was found at, .* 120"):
        found = on_point(100.0, 120.0, 150.0, supports=[DUFFING, spring])
    assert found.at(150.0).size
