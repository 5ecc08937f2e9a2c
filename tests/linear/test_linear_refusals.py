"""What linear analyses refuse, what to do then, and their values where little is given."""

import exudyn as exu
import numpy as np
import pytest
from bodies import point_mass
from forced_models import held, rings
from matplotlib.figure import Figure
from test_model import UNEVEN, flat
from test_model import held as held_ends
from test_scene_linear import in_a_list, on_springs
from test_structural_damping import ETA, K, one_mass

import exudyn_rotor as er
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.modal.resonance import Stiffness

POINT, ENDS, ON = point_mass().reduce(0), ("left", "right"), er.Support("at", 1e4, 1.0)
MAGNET, FILM = er.Support("at", -5e3), er.Support("at", lambda speed: 1e4 + speed)
UNSTEADY = er.linear_model(flat(), supports=held_ends(UNEVEN))
UNBALANCE = er.Unbalance("mid", 1e-4)
OVER = er.Support.from_table("at", frequencies=[1.0, 3.0], stiffness=[np.eye(2), 3.0 * np.eye(2)])


def forced(speed=100.0, own=True, loads=UNBALANCE, **options):
    return er.unbalance_response(rings(**options), [speed], loads, supports=held(), own=own)


def scene(**options):
    mbs, body = on_springs(**{"spin": 100.0, "modes": 0} | options)
    return er.linear_model(mbs, body=body)


def on_supports(*supports, **options):
    """Return the rings in a scene on supports."""
    mbs, rotor = exu.SystemContainer().AddSystem(), in_a_list(modes=0).rotors[""]
    options = {"spin": 100.0, "translation": "none", "gravity": [0.0, -9.81, 0.0]} | options
    body = er.add_rotor(mbs, rotor, **options)
    er.add_supports(body, supports)
    mbs.Assemble()
    return body


def on_dampers(spring, beside):
    """Return growth of the rings on dampers with a spring inside and one beside [N/m]."""
    sizes = {"radius": 0.06, "length": 0.02, "clearance": 1.5e-4, "viscosity": 0.003}
    dampers = [er.SqueezeFilmDamper(interface=e, centring_stiffness=spring, **sizes) for e in ENDS]
    body = on_supports(*dampers, *[er.Support(end, beside) for end in ENDS if beside])
    return er.campbell(body.mbs, [100.0], body=body).growth[0, 1:]


def map_of(stiffness=1e4, rotor=POINT, at="at"):
    def build(x, y):
        return er.linear_model(rotor, supports=er.Support(at, stiffness, x)), y

    return er.stability_map(build, [1.0], [1.0, 2.0])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: er.critical_speed_map(POINT, [], [1e4]), "interfaces: needs at least one name"),
        (lambda: er.critical_speed_map(POINT, "at", [0.0]), "positive finite numbers"),
        (lambda: er.critical_speed_map(POINT, "at", [1e3], supports=MAGNET), "negative stiffness"),
        (lambda: er.critical_speeds(POINT, supports=FILM), "needs the largest speed"),
        (lambda: er.critical_speeds(POINT, nodal_diameters=[]), "at least one whole number"),
        (lambda: er.linear_model(flat(), supports=held_ends()).state_space(9.0), r"\.matrices\("),
        (lambda: UNSTEADY.matrices(9.0), "repeat every revolution"),
        (lambda: forced().phasor(order=7), "no harmonic 7; there are 1"),
        (lambda: forced().plot(ax=Figure().subplots()), "ax: needs two Axes"),
        (lambda: forced(loads=(), own=False, point_mass=0.1), "own=False"),
        (lambda: er.linear_model(on_springs()[0], body=None), "RotorBody"),
        (lambda: er.linear_model(on_springs()[1]), "target: needs"),
        (lambda: er.linear_model(POINT, body=on_springs()[1]), "body: is only for"),
        (lambda: er.linear_model(on_springs()[0], body=on_springs()[1]), "another mbs"),
        (lambda: er.campbell(POINT, 0.0, modes=99), "99 is not between 1 and the"),
        (lambda: scene().matrices(np.nan), "finite"),
        (
            lambda: er.harmonic_response(scene(), [9.0], er.BaseAcceleration([1, 0])),
            "put a force on",
        ),
        (lambda: er.stability_map(lambda x, y: POINT, [1.0], [1.0], labels="a"), "two names"),
        (lambda: er.stability_map(lambda x, y: POINT, [1.0], [1.0]), "build: needs to return"),
        (lambda: er.stability_threshold(POINT, 0.0, 1.0, supports=str), "needs the spin speed"),
        (lambda: er.stability_threshold(POINT, 0.0, 1.0, speed=3.0), "is the parameter.*leave it"),
        (lambda: er.static_response(scene(), gravity=[9, 0, 0]), "steady_state.body. finds"),
    ],
)
def test_it_says_what_to_do(call, message):
    with pytest.raises((TypeError, ValueError), match=message):
        call()


@pytest.mark.filterwarnings("ignore:the harmonics of an uneven rotor")
@pytest.mark.parametrize(
    ("call", "value"),
    [
        (lambda: er.critical_speeds(POINT).speeds, []),  # nothing holds it
        (lambda: forced(0.0).phasor(), [0.0]),  # an unbalance at rest
        (lambda: er.linear_model(POINT, supports=OVER).matrices(1.0, 2.0).K[0, 0], 2.0),
        (lambda: er.stability(UNSTEADY, [1e-5], method="floquet").exponents[0, 1], np.nan),
        (
            lambda: er.static_response(
                one_mass(loss=ETA), {"disc": [K, 0, 0]}, speed=9.0
            ).deflection()[1],
            (1.0 / (1.0 - 1j * ETA)).imag,  # in the shaft the load turns backward
        ),
        (lambda: len(map_of().plot(Figure().subplots()).collections[0].get_offsets()), 2),
        (lambda: map_of(4e5, rings(4), "mid").table(), "basis error up to"),
        (lambda: er.stability_threshold(POINT, 1.0, 9.0, supports=ON).table(), "whole range"),
        (lambda: repr(scene()), "supports: forces of Exudyn"),
        (lambda: on_dampers(0.0, 1e6) / on_dampers(1e6, 0.0), np.ones(4)),
    ],
)
def test_values(call, value):
    found = call()
    shows = isinstance(value, str) and value in found
    assert shows or found == pytest.approx(value, rel=1e-6, abs=1e-12, nan_ok=True)


def test_a_parameter_without_coefficients_costs_no_other():
    """``q = c ω``; from 3 on a table ends below the speed."""

    def supports(q):
        end = 300.0 if q < 3.0 else 50.0
        return er.Support("at", ([0.0, end], [[[1e4, 100 * q], [-100 * q, 1e4]]] * 2), 1.0)

    with pytest.warns(UserWarning, match="no values at 3.*holds 0 to 50 rad/s, not 100"):
        found = er.stability_threshold(POINT, 0.0, 5.0, supports=supports, speed=100.0, samples=6)
    assert found.values == pytest.approx([1.0], rel=1e-7)


def test_critical_speeds_that_cannot_be_refined(monkeypatch):
    """They are found to a bracket of 0.5 %; of uneven rotors, which need it, they are left out."""

    def fails(*args):
        raise UnconvergedError("no equations")

    monkeypatch.setattr(Stiffness, "refined", fails)
    table = er.Support("mid", ([0.0, 500.0], [4e5, 4e5]), 0.0, 5e4)
    found = er.critical_speeds(rings(2), supports=table, max_speed=220.0)
    np.testing.assert_allclose(found.speeds, [200.0, 200.0], rtol=1e-5)
    assert np.isnan(found.basis_errors).all()
    with pytest.warns(UserWarning, match="still change with harmonics .*left out"):
        assert not er.critical_speeds(UNSTEADY).speeds.size
