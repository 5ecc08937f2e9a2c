"""Critical speeds against closed forms, Campbell diagrams and the full model."""

import exudyn
import numpy as np
import pytest
from bodies import BODIES, MASS, SHAFT, moments, point_mass, rings
from models import disc_rotor, disc_with_craig_bampton_modes, two_masses
from test_scene_linear import rings as scene_rotor

from exudyn_rotor import (
    JournalBearing,
    OilFilm,
    ShortJournalBearing,
    SolidRotor,
    Support,
    add_rotor,
    add_supports,
    bearing_loads,
    critical_speed_map,
    critical_speeds,
    grooved_pads,
    linear_model,
    load_result,
)
from exudyn_rotor.linear.over import motions_over

KY, KZ = 196e4, 100e4  # Appendix B, unit masses


@pytest.fixture(scope="module")
def masses():
    data = two_masses()
    rotor = SolidRotor.from_matrices(data["mass"], data["stiffness"], data["nodes"], "x")
    return rotor.reduce(6)


def two_each(*speeds):
    return np.repeat(speeds, 2)


def test_asymmetric_masses_order_1(masses):
    """Static in the rotor frame at √k_y, √k_z; ``(k_y − 5Ω²)(k_z − 5Ω²) = 16Ω⁴`` at ν = 2Ω."""
    result = critical_speeds(masses, nodal_diameters=[1])
    lower, upper = np.sqrt(np.sort(np.roots([9.0, -5.0 * (KY + KZ), KY * KZ])))
    forward = result.speeds[np.equal(result.whirl, "forward")]
    np.testing.assert_allclose(forward, two_each(1000.0, 1400.0), rtol=1e-12)  # (125)
    # at the lower root the motion is forward with 3Ω, not of order 1
    backward = result.speeds[np.equal(result.whirl, "backward")]
    np.testing.assert_allclose(backward, two_each(upper), rtol=1e-12)
    assert lower not in result.speeds


def test_asymmetric_masses_order_2(masses):
    """``(k_y − 2Ω²)(k_z − 2Ω²) = 4Ω⁴``: the critical speed of a horizontal, flat shaft."""
    result = critical_speeds(masses, order=2, nodal_diameters=[1])
    forward = result.speeds[np.equal(result.whirl, "forward")]
    np.testing.assert_allclose(forward, two_each(np.sqrt(KY * KZ / (KY + KZ) / 2.0)), rtol=1e-12)


@BODIES
def test_rigid_rotor_with_gyroscopic_moment(shape):
    """Forward at ``Ω² = k/(I_t − I_p)``, for a shaft only; backward at ``k/(I_t + I_p)``."""
    polar, transverse = moments(shape)
    supports = [Support("all", 1e6 * np.eye(3), tilt_stiffness=np.diag([1e4, 1e4, 1e9]))]
    result = critical_speeds(rings(shape).reduce(0), supports=supports, nodal_diameters=[1])
    translation = np.sqrt(1e6 / MASS)
    expected = {
        "forward": [translation]
        + ([np.sqrt(1e4 / (transverse - polar))] if shape == SHAFT else []),
        "backward": [translation, np.sqrt(1e4 / (transverse + polar))],
    }
    for word, speeds in expected.items():
        found = result.speeds[np.equal(result.whirl, word)]
        np.testing.assert_allclose(found, np.sort(speeds), rtol=1e-9)


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 3.0])
def test_anisotropic_support(order):
    support = Support("at", np.diag([1e4, 4e4]), 3.0)  # damping does not count
    result = critical_speeds(point_mass().reduce(0), supports=[support], order=order)
    np.testing.assert_allclose(np.unique(result.speeds.round(6)), np.array([100, 200]) / order)
    assert set(result.whirl) == {"mixed"}
    assert len(result.speeds) == 2


def test_support_that_stiffens_with_the_speed():
    """``Ω² = k (1 + Ω²/Ω₀²)``."""
    support = Support("at", lambda speed: 1e4 * (1.0 + (speed / 200.0) ** 2))
    rotor = point_mass().reduce(0)
    result = critical_speeds(rotor, supports=[support], max_speed=1000.0)
    np.testing.assert_allclose(result.speeds, 100.0 / np.sqrt(0.75), rtol=1e-9)
    assert sorted(result.whirl) == ["backward", "forward"]


@pytest.fixture(scope="module")
def disc():
    rotor = disc_rotor(1)
    return rotor.center_interfaces()


def rising(stiffness):
    """Return a stiffness that grows by a tenth within 4000 rad/s, as a table of nine speeds."""
    speeds = np.linspace(0.0, 4000.0, 9)
    return speeds, stiffness * (1.0 + 0.1 * speeds / 4000.0)


def test_critical_speeds_with_a_table_are_fixed_points(disc):
    """Each is a critical speed on springs of the stiffness that the table has there."""
    reduced = disc.reduce(8)
    names = ("left", "right")
    table = rising(2e7)
    result = critical_speeds(
        reduced, supports=[Support(name, table) for name in names], max_speed=4000.0
    )
    assert len(result.speeds) >= 2
    for speed in result.speeds:
        there = float(np.interp(speed, *table))
        fixed = critical_speeds(reduced, supports=[Support(name, there) for name in names])
        assert np.abs(fixed.speeds / speed - 1.0).min() < 1e-8
    varied = critical_speed_map(
        reduced, "left", [1e6, 1e7], supports=[Support("right", table)], max_speed=4000.0
    )
    assert np.all(np.sum(np.isfinite(varied.speeds), axis=1) >= 2)


# the spin is held, too: free, an uneven mesh lets it take part in ν = 0


def test_map_over_support_stiffness(tmp_path):
    """A rigid rotor: √(k/m) forward and backward."""
    stiffnesses = np.geomspace(1e4, 1e8, 5)
    rotor = point_mass().reduce(0)
    result = critical_speed_map(rotor, "at", stiffnesses)
    expected = np.repeat(np.sqrt(stiffnesses)[:, None], 2, axis=1)
    np.testing.assert_allclose(result.speeds, expected, rtol=1e-12)
    result.save(tmp_path / "map.npz")
    np.testing.assert_array_equal(load_result(tmp_path / "map.npz").speeds, result.speeds)
    assert "critical speed" in result.plot().get_ylabel()


def test_a_stiffness_without_values_costs_no_other():
    """On −5 kN/m of a magnet a mass of 1 kg needs more than that to be held."""
    with pytest.warns(UserWarning, match=r"no values at 1000 N/m, which are NaN: .* negative"):
        result = critical_speed_map(
            point_mass().reduce(0), "at", [1e3, 1.5e4], supports=[Support("at", -5e3)]
        )
    np.testing.assert_allclose(result.speeds, [[np.nan] * 2, [100.0] * 2], rtol=1e-9)


def test_a_stiffness_that_jumps_makes_no_critical_speed():
    """``Ω = √(k/m)`` is 110 rad/s below 100 rad/s, and 90 rad/s above."""
    support = Support("at", lambda speed: 1.2e4 if speed < 100.0 else 8e3)
    with pytest.warns(UserWarning, match=r"near 1?[90][90.0-9]* rad/s the stiffness .* jumps"):
        result = critical_speeds(point_mass().reduce(0), supports=[support], max_speed=300.0)
    assert result.speeds.size == 0


@pytest.mark.parametrize("kind", ["films", "springs that differ", "springs"])
def test_a_round_rotor_has_each_critical_speed_once(kind):
    """Also where its basis has one half alone of a pair of bending modes, and two unlike planes."""
    reduced = disc_with_craig_bampton_modes()
    ends = list(reduced.interfaces)
    if kind == "films":
        size = {"radius": 0.015, "length": 0.015, "clearance": 4e-5, "viscosity": 0.02}
        loads = bearing_loads(reduced, ends, [0.0, -9.81, 0.0])
        pairs = zip(ends, loads, strict=True)
        supports = [ShortJournalBearing(interface=end, load=load, **size) for end, load in pairs]
    else:
        stiffness = np.diag([1e7, 2e7]) if kind == "springs that differ" else 1e7
        supports = [Support(end, stiffness) for end in ends]
    given = {"supports": supports, "max_speed": 800.0, "nodal_diameters": [1], "accuracy": None}
    found = critical_speeds(reduced, **given)
    assert found.axes == "rotor"
    whole = critical_speeds(reduced.with_attachments, **given)  # both halves of each pair
    np.testing.assert_allclose(found.speeds, whole.speeds, rtol=2e-3)
    assert found.whirl == whole.whirl


@pytest.fixture(scope="module")
def on_uneven_springs():
    data = two_masses()
    rotor = SolidRotor.from_matrices(data["mass"], data["stiffness"], data["nodes"], "x")
    return rotor.with_interface("one", [0]).reduce(6), [Support("one", np.diag([2e6, 2e7]))]


def test_an_uneven_rotor_on_uneven_springs(on_uneven_springs):
    """Each critical speed is where an exponent has the frequency Ω seen from outside."""
    rotor, supports = on_uneven_springs
    result = critical_speeds(rotor, supports=supports, max_speed=3000.0, nodal_diameters=[1])
    assert result.axes == "rotor"
    assert len(result.speeds) >= 4
    M = linear_model(rotor, supports=supports)
    for speed in result.speeds:
        values = motions_over(M, [speed * (1.0 + 1e-7)], method="floquet")[0].values
        apart = np.abs(values - 1j * speed * np.arange(-4, 5)[:, None])
        assert apart.min() < 1e-3 * speed  # a root of the tolerance where two exponents meet
    # the same by brackets
    table = [Support("one", ([0.0, 4000.0], np.diag([2e6, 2e7])[None] * np.ones((2, 1, 1))))]
    by_table = critical_speeds(rotor, supports=table, max_speed=3000.0, nodal_diameters=[1])
    np.testing.assert_allclose(by_table.speeds, result.speeds, rtol=1e-6)


def test_tables_tell_that_there_are_none():
    rotor = point_mass().reduce(0)
    support = Support("at", 1e4)  # 100 rad/s
    found = critical_speeds(rotor, supports=support, max_speed=50.0, nodal_diameters=[1])
    assert found.table().splitlines()[1] == "none"
    over = critical_speed_map(rotor, "at", [1e2, 1e4], max_speed=50.0)
    rows = [line.split() for line in over.table().splitlines()[2:4]]
    assert rows == [["100", "95.493", "backward"], ["100", "95.493", "forward"]]
    low, high = over.plot().get_xlim()
    assert low < 1e2 < 1e4 < high


def test_speeds_at_which_films_are_too_thin_are_left_out():
    """Lists end there as scenes do; the stiffness of another speed would jump."""
    pads = grooved_pads(1e-4, [0.0, np.pi], 0.3)
    film = OilFilm(0.02, 0.02, 0.02, pads, "none", nodes=24, axial_nodes=0)
    rotor = scene_rotor()

    def found(load, limit):
        journal = JournalBearing(interface="left", film=film, load=[0.0, -load])
        springs = [Support(name, 1e7) for name in rotor.interfaces]
        return critical_speeds(rotor, supports=[journal, *springs], max_speed=limit, accuracy=None)

    with pytest.warns(UserWarning, match=r"none are looked for at .* rad/s: bearing at 'left'"):
        found(300.0, 1000.0)
    with pytest.raises(ValueError, match="presses the film below"):
        found(1e5, 1000.0)


@pytest.mark.parametrize(
    ("begins", "found", "in_scene"), [(-0.1, 1, False), (0.1, 0, False), (-0.1, 1, True)]
)
def test_critical_speeds_are_looked_for_from_where_tables_begin(begins, found, in_scene):
    """``Ω² = k(Ω)/m`` at 100 rad/s for a mass of 1 kg; brackets are at 99.6 and 100.15 rad/s."""
    most = 109.45
    ends = np.array([100.0 + begins, most])
    bearing = Support("at", (ends, 1e4 + 20.0 * (ends - 100.0)))
    thrust = Support("at", np.diag([0.0, 0.0, 1e6]))
    rotor, supports = point_mass().reduce(0), [bearing, thrust]
    model = linear_model(rotor, supports=supports)
    if in_scene:
        mbs = exudyn.SystemContainer().AddSystem()
        body = add_rotor(mbs, rotor, spin=200.0, translation="none")
        add_supports(body, supports)
        mbs.Assemble()
        model = linear_model(mbs, body=body)
    with pytest.warns(UserWarning, match=r"critical speeds: none are looked for .* table .* holds"):
        result = critical_speeds(model, max_speed=most, nodal_diameters=[1], accuracy=None)
    # forward and backward; scenes are linearised by differences
    np.testing.assert_allclose(result.speeds, 2 * found * [100.0], rtol=1e-6)
    # beyond the end of a table the rest counts
    with pytest.warns(UserWarning, match=r"critical speeds: none are looked for .* to 110 rad/s"):
        beyond = critical_speeds(model, max_speed=110.0, nodal_diameters=[1], accuracy=None)
    np.testing.assert_allclose(beyond.speeds, 2 * found * [100.0], rtol=1e-6)


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_a_map_over_a_table_is_many_analyses(disc, order):
    reduced, fixed = disc.reduce(8), Support("right", rising(2e7))
    given = {"order": order, "max_speed": 4000.0, "nodal_diameters": [1], "accuracy": None}
    stiffnesses = np.geomspace(1e5, 1e9, 3)
    varied = critical_speed_map(reduced, "left", stiffnesses, supports=fixed, **given)
    for row, stiffness in enumerate(stiffnesses):
        one = critical_speeds(reduced, supports=[Support("left", stiffness), fixed], **given)
        found = varied.speeds[row][np.isfinite(varied.speeds[row])]
        np.testing.assert_allclose(found, one.speeds, rtol=1e-7)


def test_a_map_has_lines_and_the_curve_of_a_bearing():
    """A mass of 1 kg: √k. A bearing of 1e4 (1 + Ω/100) meets it at Ω² = k."""
    table = ([0.0, 1000.0], np.multiply.outer([1.0, 11.0], np.diag([1e4, 2e4])))
    stiffnesses = np.geomspace(1e3, 1e6, 7)
    result = critical_speed_map(
        point_mass().reduce(0), "at", stiffnesses, bearing=Support("at", table), max_speed=1000.0
    )
    np.testing.assert_allclose(
        result.bearing_stiffnesses[:, 1], 2e4 * (1.0 + 0.01 * result.bearing_speeds)
    )
    ax = result.plot()
    labels = [line.get_label() for line in ax.get_lines()]
    assert labels.count("forward") == labels.count("backward") == 1
    assert {"bearing, k11", "bearing, k22"} <= set(labels)
    forward = ax.get_lines()[labels.index("forward")]
    np.testing.assert_allclose(forward.get_ydata(), 30.0 / np.pi * np.sqrt(stiffnesses))
