"""Results are small, readable, stored without pickle, and drawn without a display."""

import inspect
from dataclasses import dataclass, replace

import numpy as np
import pytest
from matplotlib import pyplot
from point_rotors import ring_rotor
from small_results import STORED

import exudyn_rotor
from exudyn_rotor import results
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.response.loads import Unbalance
from exudyn_rotor.linear.response.response import UnbalanceResponse
from exudyn_rotor.linear.response.steady_response import unbalance_response
from exudyn_rotor.results import Result, load_result, numbers, storable, words


@storable
@dataclass(frozen=True, eq=False)
class Everything(Result):
    """One field of every kind."""

    reals: np.ndarray
    counts: np.ndarray
    name: str
    names: tuple[str, ...]
    number: float
    flag: bool
    pairs: np.ndarray = numbers("pairs", 2, least=0.0)
    marks: np.ndarray = numbers("pairs", dtype=bool)
    titles: tuple[str, ...] = words(2, default=("x", "y"))
    absent: np.ndarray | None = None


def everything(**changes) -> Everything:
    values = {"reals": np.array([1.0, np.nan]), "counts": np.arange(3), "name": "Läufer",
              "names": (), "number": 0.1, "flag": True, "pairs": np.zeros((1, 2)),
              "marks": np.zeros(1, dtype=bool)}  # fmt: skip
    return Everything(**(values | changes))


@pytest.fixture(scope="module")
def ellipses() -> UnbalanceResponse:
    rotor = ring_rotor(0.1, 0.2, 10.0).with_interface("mid", range(10)).reduce(0)
    supports = [Support("mid", np.diag([4e5, 8e5]), 200.0, 5e4, 10.0)]
    speeds = np.linspace(0.0, 400.0, 101)
    return unbalance_response(
        rotor, speeds, [Unbalance("mid", 1e-4)], supports=supports, at=["mid", 2]
    )


def test_every_kind_of_field_comes_back(tmp_path):
    kept = everything(names=("a", "b"))
    kept.save(tmp_path / "kept.npz")
    back = load_result(tmp_path / "kept.npz")
    assert type(back) is Everything
    assert np.array_equal(back.reals, kept.reals, equal_nan=True)
    assert back.counts.dtype == kept.counts.dtype
    assert (back.name, back.names, back.number, back.flag) == ("Läufer", ("a", "b"), 0.1, True)
    assert type(back.flag) is bool
    assert back.absent is None
    with pytest.raises(ValueError, match="pairs: needs values ≥ 0"):
        everything(pairs=-np.ones((1, 2)))
    everything().save(tmp_path / "empty.npz")
    assert load_result(tmp_path / "empty.npz").names == ()


RESULTS = {name: kept for name, kept in STORED.items() if isinstance(kept, Result)}


def test_every_result_of_the_package_is_stored():
    package = {n for n, c in results._REGISTERED.items() if c.__module__.startswith("exudyn_rotor")}
    assert set(RESULTS) == package
    assert package <= set(exudyn_rotor.__all__)  # load_result finds their modules there


@pytest.mark.parametrize("name", RESULTS)
def test_every_result_has_a_table_a_short_repr_and_a_picture(name):
    result = RESULTS[name]
    lines = result.table().splitlines()
    assert len(lines) >= 2
    assert max(map(len, lines)) <= 120
    assert repr(result).startswith(f"{name}(")
    assert len(repr(result)) < 400
    if name == "CriticalSpeeds":  # their places in a Campbell diagram are its picture
        return
    assert inspect.signature(result.plot).parameters["ax"].default is None
    drawn = result.plot(*((np.ones(2), 1.0) if name == "StressField" else ()))
    for ax in np.ravel(drawn):  # a Bode diagram has two: size and phase
        assert isinstance(ax, pyplot.Axes)
        assert ax.figure is pyplot.gcf()


def test_orbits_of_many_places_have_a_line_each(ellipses):
    names = tuple(f"place {i}" for i in range(9))
    many = replace(ellipses, places=names, motion=ellipses.motion[:, :1].repeat(9, axis=1),
                   basis_errors=None)  # fmt: skip
    assert len(many.plot_orbit(240.0).lines) == 2 * len(names)  # with a dot each


def test_orbit_is_drawn_for_every_place(ellipses):
    axes = ellipses.plot_orbit(240.0)
    drawn = axes.lines[0].get_xdata() + 1j * axes.lines[0].get_ydata()
    major, minor = ellipses.semi_axes("mid")
    index = np.argmin(np.abs(ellipses.speeds - 240.0))
    assert np.abs(drawn).max() == pytest.approx(1e6 * major[index], rel=1e-3)
    assert minor[index] < 0.0
    area = 0.5 * np.sum((drawn[:-1].conj() * drawn[1:]).imag)
    expected = np.pi * 1e12 * major[index] * minor[index]  # negative: it turns backward
    assert area == pytest.approx(expected, rel=1e-3)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["mid", "node 2"]
    title = ellipses.plot_orbit(240.0, units="rpm").get_title(loc="right")
    assert title == f"spin speed {30.0 / np.pi * ellipses.speeds[index]:.4g} rpm"
