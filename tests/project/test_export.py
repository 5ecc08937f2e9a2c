"""Results in other units, in Campbell diagrams of engineers, and in files of other programs."""

import csv

import numpy as np
import pytest
from small_results import STORED

from exudyn_rotor import SolidRotor, Support, campbell, critical_speeds
from exudyn_rotor.results import Result
from exudyn_rotor.units import Units


@pytest.fixture(scope="module")
def diagram():
    """A point of 1 kg on 1e4 N/m: ω = 100 rad/s at every speed."""
    point = SolidRotor.from_matrices(
        np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], axis="z", interfaces={"at": [0]}
    )
    return campbell(point, [0.0, 30.0, 70.0, 110.0], supports=[Support("at", 1e4 * np.eye(3))])


RESULTS = {name: kept for name, kept in STORED.items() if isinstance(kept, Result)}
EVERY = pytest.mark.parametrize("name", RESULTS)


# ------------------------------------------------------------------ units


def test_three_thousand_turns_a_minute_are_fifty_hertz():
    speed = 100.0 * np.pi
    assert Units.of("rpm").speeds(speed) == pytest.approx(3000.0, rel=1e-15)
    assert Units.of("rpm").frequencies(speed) == pytest.approx(50.0, rel=1e-15)
    assert Units.of("Hz").speeds(speed) == pytest.approx(50.0, rel=1e-15)
    assert Units.of("SI").speeds(speed) == speed
    with pytest.raises(ValueError, match="units: 'rps' is unknown; use one of 'SI', 'Hz'"):
        Units.of("rps")


@EVERY
def test_tables_and_columns_carry_their_units(name):
    result = RESULTS[name]
    columns = result.columns("rpm")
    assert len({len(values) for values in columns.values()}) == 1
    for label, values in result.columns("SI").items():
        twin = label.replace("[rad/s]", "[rpm]")
        if twin in columns and twin != label and "frequency" not in label:
            np.testing.assert_allclose(columns[twin], values * 30.0 / np.pi, rtol=1e-14)
    if name in ("Campbell", "CriticalSpeeds", "CriticalSpeedMap", "UnbalanceResponse", "Stability"):
        assert "[rpm]" in result.table(units="rpm")
        assert any("[rpm]" in label for label in columns)


# ------------------------------------------------------------------ excitation


def test_crossings_agree_with_critical_speeds():
    """Two masses on a rod in unlike bearings; the grid is fine, so lines are straight between."""
    inertia = np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    rotor = SolidRotor.from_matrices(inertia, rod, [[0, 0, -0.1], [0, 0, 0.1]], "z")
    rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    held = [Support("left", 2e4), Support("right", 3e4)]
    wanted = critical_speeds(rotor, supports=held, nodal_diameters=[1]).speeds
    found, _ = campbell(rotor, np.linspace(0.0, 250.0, 26), supports=held).crossings()
    np.testing.assert_allclose(np.unique(found.round(6)), np.unique(wanted.round(6)), rtol=1e-7)


# ------------------------------------------------------------------ files and other libraries


@EVERY
def test_csv_holds_every_number_as_it_is(name, tmp_path):
    result, path = RESULTS[name], tmp_path / "table.csv"
    result.to_csv(path)
    with open(path, encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    columns = result.columns()
    assert header == list(columns)
    for values, read in zip(columns.values(), zip(*rows, strict=True), strict=True):
        back = np.array(read) if values.dtype.kind in "Ub" else np.array(read, dtype=float)
        assert np.array_equal(back, values.astype(back.dtype), equal_nan=back.dtype.kind == "f")


@EVERY
def test_data_frames_hold_the_columns(name):
    columns, frame = RESULTS[name].columns("Hz"), RESULTS[name].to_dataframe("Hz")
    assert list(frame.columns) == list(columns)
    for label, values in columns.items():
        assert list(frame[label]) == pytest.approx(values.tolist(), nan_ok=True)


def test_orders_are_positive(diagram):
    with pytest.raises(ValueError, match="orders: needs positive numbers"):
        diagram.plot(orders=[1.0, 0.0])
