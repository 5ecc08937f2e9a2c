"""Saving is atomic, keeps mode and links of a file, and touches nothing else."""

import os
import stat
import threading

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.figure import Figure
from small_results import STORED

from exudyn_rotor import plotting
from exudyn_rotor.storage import read_arrays, write_arrays
from validation import savers


@pytest.mark.parametrize(
    ("path", "kind", "message"),
    [
        ("none/a.npz", FileNotFoundError, r"path: the folder '.*none' does not exist"),
        ("none/../a.npz", FileNotFoundError, r"path: the folder '.*none/\.\.' does not exist"),
        (".", IsADirectoryError, "path: needs the name of a file"),
        ("none/", IsADirectoryError, "path: needs the name of a file, 'none/' is a folder"),
        (3, TypeError, "path: needs the path of a file"),
        ("", ValueError, "path: needs the path of a file"),
        ("loop", OSError, "path: 'loop' is a link that leads to itself"),
        ("pipe", OSError, "path: needs the name of a file, 'pipe' is a device"),
    ],
)
@pytest.mark.skipif(os.name == "nt", reason="links and pipes of POSIX")
def test_paths_that_cannot_be_saved_to(path, kind, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    os.symlink("loop", "loop")
    os.mkfifo("pipe")
    for name in ("ReducedRotor", "Campbell"):
        with pytest.raises(kind, match=message):
            STORED[name].save(path)
    assert sorted(os.listdir()) == ["loop", "pipe"]


@pytest.mark.skipif(os.name == "nt", reason="modes of POSIX")
def test_new_files_take_the_umask_and_old_ones_keep_their_mode(tmp_path):
    path, old = tmp_path / "a.npz", os.umask(0o027)
    try:
        write_arrays(path, "thing", {})
        assert stat.S_IMODE(path.stat().st_mode) == 0o640
        for mode in (0o600, 0o666, 0o755):
            path.chmod(mode)
            write_arrays(path, "thing", {})
            assert stat.S_IMODE(path.stat().st_mode) == mode
    finally:
        os.umask(old)


@pytest.mark.skipif(os.name == "nt", reason="links need rights there")
def test_links_are_followed(tmp_path):
    (tmp_path / "far").mkdir()
    target, link = tmp_path / "far" / "target.npz", tmp_path / "link.npz"
    link.symlink_to("far/target.npz")
    for _ in range(2):  # the target is made, then replaced
        write_arrays(link, "thing", {})
        assert link.is_symlink()
        assert not target.is_symlink()
        assert read_arrays(link, "thing") == {}
    assert sorted(os.listdir(tmp_path)) == ["far", "link.npz"]
    assert os.listdir(tmp_path / "far") == ["target.npz"]


def test_read_only_files_stay(tmp_path, monkeypatch):
    path = tmp_path / "a.npz"
    write_arrays(path, "thing", {"a": np.ones(1)})
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write anything
    with pytest.raises(PermissionError, match=r"path: the file '.*a\.npz' is read-only"):
        write_arrays(path, "thing", {"a": np.zeros(1)})
    assert read_arrays(path, "thing")["a"] == 1.0


def test_other_files_beside_it_are_left_alone(tmp_path):
    for name in ("u.npz.part", "u.npz.draft", "u.npz.0123456789abcdef.draft"):
        (tmp_path / name).write_text("mine")
    write_arrays(tmp_path / "u.npz", "thing", {})
    assert len(os.listdir(tmp_path)) == 4
    assert all(file.read_text() == "mine" for file in tmp_path.glob("u.npz.*"))


def test_long_names_have_drafts_too(tmp_path):
    path = tmp_path / ("ä" * 120 + ".npz")
    write_arrays(path, "thing", {})
    assert os.listdir(tmp_path) == [path.name]


@pytest.mark.parametrize("step", [(np, "savez_compressed"), (os, "fsync"), (os, "replace")])
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


def test_a_script_that_saves_pictures_keeps_none(tmp_path, monkeypatch):
    """Its backend writes files only; figures that are not saved stay, and those of the script."""
    maps = STORED["StabilityMap"]
    unsaved, (own, given) = maps.plot().figure, pyplot.subplots()
    plotting.save(maps.plot(given), tmp_path / "own.png")
    response, stress = STORED["UnbalanceResponse"], STORED["StressHistory"]
    for draw in (maps.plot, response.plot, stress.plot_peak):
        drawn = draw()
        plotting.save(drawn, tmp_path / "a.png")
        assert pyplot.get_fignums() == [unsaved.number, own.number]
        plotting.save(drawn, tmp_path / "b.png")  # it can be saved again
    monkeypatch.setattr("matplotlib.get_backend", lambda: "QtAgg")
    shown = maps.plot()
    plotting.save(shown, tmp_path / "a.png")
    assert shown.figure.number in pyplot.get_fignums()


def test_killed_savers_and_a_reader_lose_nothing(tmp_path):
    pairs = savers.killed_pairs(tmp_path, 2)
    assert (pairs.lost, pairs.unreadable) == (0, 0)
    reader = savers.beside_a_reader(tmp_path, 1.0)
    assert (reader.lost, reader.unreadable) == (0, 0)
    assert min(pairs.saves, reader.saves, reader.loads) >= 3


def test_savers_in_threads_beside_readers_lose_nothing(tmp_path):
    path, failed = tmp_path / "a.npz", []
    write_arrays(path, savers.KIND, savers.content(9, 0))

    def work(saver):
        try:
            for count in range(3):
                write_arrays(path, savers.KIND, savers.content(saver, count))
                savers.check(path)
        except Exception as error:
            failed.append(error)

    threads = [threading.Thread(target=work, args=(saver,)) for saver in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed
    assert os.listdir(tmp_path) == ["a.npz"]
