"""Tables of coefficients over speed and frequency, and files of them."""

import numpy as np
import pytest

from exudyn_rotor import BaseRecord, SqueezeFilmDamper, Support

SPEEDS, FREQUENCIES = [100.0, 200.0, 400.0], [0.0, 50.0, 60.0, 300.0]


def test_points_are_met_and_nothing_overshoots():
    values = np.cumsum(np.random.default_rng(1).uniform(0.0, 1e6, (3, 4)), axis=1)
    values = np.cumsum(values, axis=0)[..., None, None] * np.eye(3)
    made = Support.from_table(
        "left", speeds=SPEEDS, frequencies=FREQUENCIES, stiffness=values, damping=1e-3 * values
    )
    for i, speed in enumerate(SPEEDS):
        for j, frequency in enumerate(FREQUENCIES):
            K, D = made.matrices(speed, frequency)
            assert K[:3, :3] == pytest.approx(values[i, j], rel=1e-12)
            assert pytest.approx(1e-3 * K) == D
    for i, j in np.ndindex(2, 3):  # between the corners of each cell
        corners = values[i : i + 2, j : j + 2, 2, 2]
        for share in (0.1, 0.5, 0.9):
            pair = (
                np.interp(share, (0.0, 1.0), x[k : k + 2])
                for x, k in ((SPEEDS, i), (FREQUENCIES, j))
            )
            assert corners.min() <= made.matrices(*pair)[0][2, 2] <= corners.max()
    assert made.matrices(150.0, 1e4)[0] == pytest.approx(made.matrices(150.0, 300.0)[0])
    one = made.at_frequency(55.0)
    assert one.matrices(200.0)[0] == pytest.approx(made.matrices(200.0, 55.0)[0], rel=1e-12)


def test_tables_and_matrices_are_told_apart():
    """Lists in a tuple are a table, nested lists a matrix, three tuples of three a matrix."""
    for given, entry, expected in (
        (([0.0, 10.0], [1.0, 3.0]), (0, 0), 2.0),
        ([[0.0, 1e5], [-1e5, 0.0]], (1, 0), -1e5),
        (((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)), (1, 2), 6.0),
    ):
        assert Support("left", given).matrices(5.0)[0][entry] == expected


def text(separator, header, rows):
    return "\n".join(separator.join(map(str, row)) for row in (header, *rows))


HEADER = ("Speed (rpm)", "Kxx", "Kxy", "Kyx", "Kyy", "Cxx", "Cxy", "Cyx", "Cyy")
UNITS = [f"{name} [{'kN/m' if name[0] == 'K' else 'N·s/mm'}]" for name in HEADER[1:]]
ROWS = [(3000, 1e7, 2e6, -2e6, 3e7, 1e3, 0, 0, 2e3), (6000, 2e7, 3e6, -3e6, 4e7, 2e3, 1, 1, 3e3)]
FILES = {
    "XLTRC": text("\t", HEADER, ROWS),
    "commas": text(",", HEADER, ROWS[::-1]),
    "semicolons": "# measured\n" + text(";", ("rpm", *HEADER[1:]), ROWS) + "\n\n",
    "units": text(
        "\t", ("speed [U/min]", *UNITS), [(row[0], *np.multiply(1e-3, row[1:])) for row in ROWS]
    ),
    "hertz": text(
        ",", ("frequency [Hz]", *HEADER[1:]), [(row[0] / 60.0, *row[1:]) for row in ROWS]
    ),
}


@pytest.mark.parametrize("kind", FILES)
def test_files_of_other_programs(kind, tmp_path):
    path = tmp_path / "bearing.txt"
    path.write_text(FILES[kind])
    made = Support.from_columns("left", path)
    for rpm, *row in ROWS:
        speed = rpm * np.pi / 30.0
        K, D = made.matrices(speed, speed)
        assert K[:2, :2].ravel() == pytest.approx(row[:4], rel=1e-12)
        assert D[:2, :2].ravel() == pytest.approx(row[4:], rel=1e-12)


def test_a_grid_of_speeds_and_frequencies_in_any_order_of_rows():
    s, f = (X.ravel() for X in np.meshgrid(SPEEDS, FREQUENCIES))
    table = {"w": s, "freq": f, "mzz": s + f, "kaa": s - f, "kbb [N m/rad]": s}
    made = Support.from_columns("left", table)
    assert made.mass_matrix(200.0, 60.0)[2, 2] == pytest.approx(260.0)
    assert made.matrices(200.0, 60.0)[0][3, 3] == pytest.approx(140.0)


@pytest.mark.parametrize("read", [Support.from_columns, BaseRecord.from_csv])
def test_a_file_that_is_not_there_is_named(read, tmp_path):
    arguments = ("left", tmp_path / "no.csv") if read == Support.from_columns else ("no.csv", "g")
    with pytest.raises(FileNotFoundError, match=r": there is no file '.*no.csv'; give its whole"):
        read(*arguments)


def test_uneven_lines_of_a_file_are_refused(tmp_path):
    path = tmp_path / "bearing.csv"
    path.write_text("speed,kxx\n1,2\n3\n")
    with pytest.raises(ValueError, match=r"line 3 .* needs 2 values, got 1"):
        Support.from_columns("left", path)


def test_a_damper_without_states_is_the_same_at_all_frequencies():
    damper = SqueezeFilmDamper(
        interface="left", radius=0.05, length=0.02, clearance=1e-4, viscosity=0.02, orbit=0.3
    )
    table = damper.table([100.0, 200.0], [10.0, 20.0, 30.0])
    for speed in (100.0, 200.0):
        for found, expected in zip(
            table.matrices(speed, 15.0), damper.linearised().matrices(speed), strict=True
        ):
            assert found == pytest.approx(expected)
