"""Saving is atomic, and touches nothing else."""

import os
import sys

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure
from small_results import STORED

from exudyn_rotor import Result, plotting
from exudyn_rotor.storage import read_arrays, write_arrays


@pytest.mark.parametrize("step", [(np, "savez_compressed"), (os, "replace")])
def test_interrupted_saves_leave_the_old_file_and_no_draft(step, tmp_path, monkeypatch):
    path = tmp_path / "a.npz"
    write_arrays(path, "thing", {"a": np.ones(1)})

    def full(*_, **__):
        raise OSError("no space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(*step, full)
        with pytest.raises(OSError, match="no space"):
            write_arrays(path, "thing", {"a": np.zeros(1)})
    assert read_arrays(path, "thing")["a"] == 1.0
    assert os.listdir(tmp_path) == ["a.npz"]


def test_pictures_replace_old_ones_when_they_are_complete(tmp_path, monkeypatch):
    made = pyplot.figure()
    for name, start in (("a", b"\x89PNG"), ("a.SVG", b"<?xml")):
        plotting.save(made, tmp_path / name)
        assert next(tmp_path.glob(f"{name}*")).read_bytes().startswith(start)
    before = (tmp_path / "a.png").read_bytes()
    whole = Figure.savefig

    def half(drawn, target, **options):
        whole(drawn, target, **options)
        raise OSError("no space left on device")

    monkeypatch.setattr(Figure, "savefig", half)
    pyplot.plot([0.0, 1.0])
    with pytest.raises(OSError, match="no space"):
        plotting.save(made, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes() == before
    assert sorted(os.listdir(tmp_path)) == ["a.SVG", "a.png"]


def test_pictures_of_several_axes(tmp_path):
    """As responses and histories return them."""
    made, axes = pyplot.subplots(2, 2)
    for drawn in (axes, axes[0], made):
        plotting.save(drawn, tmp_path / "a")
        assert (tmp_path / "a.png").stat().st_size > 1000
        (tmp_path / "a.png").unlink()
    for wrong in (np.array([]), np.array([1.0]), [axes]):
        with pytest.raises(TypeError, match="drawn: needs Axes"):
            plotting.save(wrong, tmp_path / "a")


REFUSED = [  # what is called in a folder with a file a.npz, and what it says
    (
        lambda: write_arrays(".", "thing", {}),
        r"path: needs the name of a file, '\.' is a folder or",
    ),
    (lambda: write_arrays("a.npz", "thing", {}), "path: the file 'a.npz' is read-only"),
    (lambda: Result().save("b.npz"), "a Result cannot be stored; its class needs the decorator"),
    (lambda: Result().columns(), "columns: a Result has none"),
    (lambda: STORED["Spectra"].to_dataframe(), "to_dataframe: needs pandas, which is not inst"),
]


@pytest.mark.parametrize(("call", "words"), REFUSED)
def test_what_cannot_be_stored_is_told(call, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "pandas", None)
    STORED["Spectra"].save("a.npz")
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises((TypeError, ValueError, OSError, ImportError), match=words):
        call()
