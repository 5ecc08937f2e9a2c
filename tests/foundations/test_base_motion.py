"""Ground that shakes: scenes against linear responses, and records."""

from dataclasses import replace

import exudyn as exu
import numpy as np
import pytest
from point_rotors import ring_rotor
from scipy.interpolate import CubicSpline
from shaken_rotors import rigid, springs
from test_foundations import BLOCK, HELD
from test_supports_in_scenes import KINDS, SKEW

import exudyn_rotor as er
from exudyn_rotor.theory.rotating_axes import axes_of
from validation.exudyn_3d.spatial_body import add_spatial_rotor

# ------------------------------------------------------------------ scenes

SHAKEN = er.BaseRecord(
    np.linspace(0.0, 0.05, 51),
    3.0 * np.column_stack([np.sin(40.0 * (t := np.linspace(0.0, 0.05, 51))),
                           np.cos(70.0 * t), np.sin(90.0 * t)]),
)  # fmt: skip
SUPPORTS = [replace(KINDS["2 x 2"], tilt_stiffness=2e3), KINDS["3 x 3"], HELD]


def run(step, rotation=None):
    """Return time and displacement of a journal against the ground, global axes."""
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rigid(), rotation=rotation, spin=200.0)
    base = er.add_foundation(mbs, BLOCK, rotation=rotation)
    er.add_base_motion(mbs, SHAKEN, [body, base], rotation=rotation)
    er.add_supports(body, SUPPORTS, base)
    sensor = body.add_interface_sensor("left", exu.OutputVariableType.Displacement)
    mbs.Assemble()
    settings = er.recommended_settings(end_time=0.04, step=step)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-3
    mbs.SolveDynamic(settings)
    data = mbs.GetSensorStoredData(sensor)
    return data[:, 0], data[:, 1:4]


@pytest.mark.parametrize("rotation", [None, SKEW], ids=["upright", "skew"])
def test_scene_and_linear_response_agree(rotation):
    """By the integrator's second order: two steps, and what they lead to."""
    model = er.linear_model(rigid(), supports=SUPPORTS, foundation=BLOCK)
    found = er.base_response(model, SHAKEN, speed=200.0, end_time=0.05, tolerance=1e-7, at="left")
    to_scene = np.eye(3) if rotation is None else rotation
    exact = CubicSpline(found.time, found.displacement("left") @ axes_of(rigid().axis).T)
    (time, coarse), (_, fine) = (run(step, rotation=rotation) for step in (2e-4, 1e-4))
    expected = exact(time) @ to_scene.T
    errors = [
        np.abs(x - expected).max() / np.abs(expected).max()
        for x in (coarse, fine, (4.0 * fine - coarse) / 3.0)
    ]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[2] < 1e-4


# ------------------------------------------------------------------ records


def test_a_record_from_a_file(tmp_path):
    lines = "# made by hand\ntime;x;y;z\n0,0.1,0,0\n0.5, 0.2, 0, -1\n\n1.0 ,0,0,0  # end\n"
    (tmp_path / "record.csv").write_text(lines, encoding="utf-8")
    found = er.BaseRecord.from_csv(tmp_path / "record.csv", "g")
    np.testing.assert_allclose(found.accelerations[1], [0.2 * 9.80665, 0.0, -9.80665])
    (tmp_path / "spaces.txt").write_text("0 1 2 3\n1 1 2 3\n", encoding="utf-8")
    assert er.BaseRecord.from_csv(tmp_path / "spaces.txt", "gal").peak == pytest.approx(
        0.14**0.5 / 10
    )
    (tmp_path / "excel.csv").write_text("0;1;2;3\n1;4;5;6\n2;7;8;9\n", encoding="utf-8-sig")
    assert er.BaseRecord.from_csv(tmp_path / "excel.csv", "m/s²").accelerations[0, 0] == 1.0
    text = "Zeit;längs;quer;hoch\n0,0;1,5;2;3e-1\n0,5;-1,25;0;0,1\n"  # decimals by commas
    (tmp_path / "comma.csv").write_bytes(text.encode("latin-1"))
    found = er.BaseRecord.from_csv(tmp_path / "comma.csv", "m/s²")
    np.testing.assert_array_equal(found.times, [0.0, 0.5])
    np.testing.assert_array_equal(found.accelerations, [[1.5, 2.0, 0.3], [-1.25, 0.0, 0.1]])
    for text, match in (
        ("0,1,a,3\n1,1,2,3\n2,1,2,3\n", "line 1: could not"),
        ("0,1,2\n1,1,2\n", "line 1: needs time and three"),
        ("0,1,2,3\n1,a,2,3\n", "line 2: could not"),
        ("t,x,y,z\n", "times: needs two or more"),
    ):
        (tmp_path / "bad.csv").write_text(text, encoding="utf-8")
        with pytest.raises(ValueError, match=match):
            er.BaseRecord.from_csv(tmp_path / "bad.csv", "g")


def test_baseline_and_integrals():
    """Of a record by polynomials: velocity and displacement exactly, and a ground that stops."""
    t = np.linspace(1.0, 3.0, 5)
    line = er.BaseRecord(t, np.outer(t - 1.0, [2.0, 0.0, 1.0]))
    velocity, place = line.integrals(np.array([0.0, 2.3, 4.0]))
    np.testing.assert_allclose(velocity[:, 0], [0.0, 1.3**2, 4.0], atol=1e-14)
    np.testing.assert_allclose(place[:, 0], [0.0, 1.3**3 / 3.0, 8.0 / 3.0 + 4.0], atol=1e-14)
    stops = line.with_baseline()
    np.testing.assert_allclose(stops.end_velocity, 0.0, atol=1e-14)
    assert stops.peak < 1e-12
    np.testing.assert_allclose(line.turned(SKEW).end_velocity, SKEW @ line.end_velocity)


def test_bad_records_and_calls_are_refused():
    still = np.zeros((3, 3))
    for times, rows, match in (
        ([0.0, 2.0, 1.0], 3, "in ascending order"),
        ([0.0, 1.0, 3.0], 3, "needs even steps .*, got 1 to 2"),
        ([0.0], 1, "needs two or more"),
        ([0.0, 1.0, 2.0], 2, "accelerations: needs finite numbers"),
    ):
        with pytest.raises(ValueError, match=match):
            er.BaseRecord(times, still[:rows])
    mbs = exu.SystemContainer().AddSystem()
    body, base = er.add_rotor(mbs, rigid()), er.add_foundation(mbs, BLOCK)
    spatial = add_spatial_rotor(mbs, ring_rotor(0.1, 0.15, 5.0))
    blind = er.add_foundation(mbs, replace(BLOCK, participation=None))
    loads = mbs.systemData.NumberOfLoads()
    for bodies, match in (
        ([body, base, body], "given twice"),
        ([blind], "needs its participation"),
        ([spatial.body], "is an ObjectFFRF, whose loads by its mass"),
        ([exu.ObjectIndex(99)], "this system has no"),
    ):
        with pytest.raises(ValueError, match=match):
            er.add_base_motion(mbs, SHAKEN, bodies)
        assert mbs.systemData.NumberOfLoads() == loads
    model = er.linear_model(rigid(), supports=SUPPORTS, foundation=blind.foundation)
    with pytest.raises(ValueError, match="with its participation"):
        er.base_response(model, SHAKEN)
    unstable = [*springs(100.0), er.Support("left", [[0.0, 1e5], [-1e5, 0.0]])]
    with pytest.raises(ValueError, match="is the rotor unstable"):
        er.base_response(rigid(), SHAKEN, supports=unstable, end_time=60.0)
