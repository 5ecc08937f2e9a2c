"""Files: loading refuses all that is not whole."""

import tracemalloc
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_results import STORED, rotor

from exudyn_rotor import Campbell, ReducedRotor, load_result, storage
from exudyn_rotor.storage import read_arrays, write_arrays

# what a response has at nodes, at rest, without damping, beyond the last critical speed or peak
MAY_BE_LONGER = ("triangles", "dropped", "field.free_motions", "field.vectors")
MAY_BE_EMPTY = ("triangles", "field.vectors")
MAY_BE_MISSING = (
    ".K2", ".B", ".K4", ".K2_estimated", ".H", "shapes.stress", ".threshold", ".stiffening",
    ".critical_speed_ratio", ".gas_density",
)  # fmt: skip
MAY_BE_NAN = {
    f"field.{name}"
    for name in (
        "motion",
        "multipliers",
        "log_decrement",
        "half_power",
        "amplification",
        "linear_errors",
        "exponent_errors",
    )
}
# results whose rows are NaN where nothing could be computed
WITH_GAPS = (
    "Campbell", "CriticalSpeedMap", "RollingBearingResponse", "SeparationMargins", "Sensitivity",
    "Stability", "StabilityMap",
)  # fmt: skip


def load(name: str, path: Path) -> object:
    return ReducedRotor.load(path) if name == "ReducedRotor" else load_result(path)


def entries(path: Path) -> dict[str, np.ndarray]:
    with np.load(path, allow_pickle=False) as file:  # nothing in it needs pickle
        return {name: file[name] for name in file.files}


def saved(name: str, folder: Path) -> tuple[Path, dict[str, np.ndarray]]:
    path = folder / "kept.npz"
    STORED[name].save(path)
    return path, entries(path)


def forge(path: Path, data: dict[str, np.ndarray]) -> None:
    """Write entries with the checksum that belongs to them, as another program might."""
    whole = {key: np.asarray(value) for key, value in data.items() if key != "sha256"}
    np.savez(path, sha256=storage._checksum(whole), **whole)


def wrong_values(key: str, value: np.ndarray, owner: str) -> dict[str, np.ndarray]:
    """Return values that an entry must not have, by what is wrong with them."""
    wrong = {
        "type": value.astype(np.float32) if value.dtype.kind == "f" else np.array([1.5 + 1j]),
        "shape": np.concatenate([np.atleast_1d(value)] * 2),
        "dimension": value[None],
        "bytes": np.zeros(value.shape, dtype="S4"),
    }
    if key.endswith(MAY_BE_LONGER):
        del wrong["shape"]
    if value.dtype.kind == "U":
        wrong["empty name"] = np.full(np.atleast_1d(value).shape, "")
        return wrong
    wrong["text"] = np.full(value.shape, "stiff")
    may_be_nan = key in MAY_BE_NAN or owner in WITH_GAPS
    if value.dtype.kind in "fc" and not may_be_nan:
        for label, number in (("NaN", np.nan), ("infinite", -np.inf)):
            wrong[label] = value.copy()
            wrong[label][(0,) * value.ndim] = number
    if value.ndim > 1 and not key.endswith(MAY_BE_EMPTY):
        wrong["emptied"] = value[:0]
    return wrong


@pytest.mark.parametrize("name", STORED)
def test_no_replaced_entry_loads(name, tmp_path):
    """Neither beside the old checksum, which tells damage, nor with one of its own."""
    path, data = saved(name, tmp_path)
    tried, loaded = 0, []
    for key, value in data.items():
        if key in ("sha256", "format"):
            continue
        np.savez(path, **data | {key: value[None]})
        with pytest.raises(ValueError, match=r"kept\.npz: damaged"):
            load(name, path)
        for label, wrong in wrong_values(key, value, name).items():
            if not value.size and np.array_equal(wrong, value):
                continue
            forge(path, data | {key: wrong})
            try:
                load(name, path)
                loaded.append((key, label))
            except ValueError as error:
                assert "kept.npz: " in str(error)  # noqa: PT017
            tried += 1
    assert loaded == []
    assert tried > 4 * (len(data) - 2)


def test_attachment_modes_are_checked_like_the_rotor(tmp_path):
    path = tmp_path / "kept.npz"
    rotor(attached=True).save(path)
    data = entries(path)
    assert sum(key.startswith("attached.") for key in data) > 15
    for key in ("attached.invariants.K", "attached.mode_mass", "attached.interface0.motion"):
        for wrong in (data[key] * np.nan, data[key][:-1], data[key].astype(str)):
            forge(path, data | {key: wrong})
            with pytest.raises(ValueError, match=r"kept\.npz: describes no reduced rotor"):
                ReducedRotor.load(path)
        forge(path, {other: value for other, value in data.items() if other != key})
        with pytest.raises(ValueError, match=rf"'{key}' is missing"):
            ReducedRotor.load(path)
    forge(path, data)
    ReducedRotor.load(path).save(tmp_path / "again.npz")
    assert str(entries(tmp_path / "again.npz")["sha256"]) == str(data["sha256"])


@pytest.mark.parametrize("name", STORED)
def test_no_missing_or_added_entry_loads(name, tmp_path):
    path, data = saved(name, tmp_path)
    for key in data:
        forge(path, {other: value for other, value in data.items() if other != key})
        if key == "sha256":  # forged again
            load(name, path)
            continue
        optional = key.endswith(MAY_BE_MISSING) or "centrifugal." in key
        if not optional:
            with pytest.raises(ValueError, match=r"kept\.npz: "):
                pytest.fail(f"without {key}: loaded as {load(name, path)!r}")
    for key in ("added", "field.added", "invariants.added"):
        forge(path, data | {key: np.zeros(3)})
        with pytest.raises(ValueError, match=r"added' are unknown|added' is unknown"):
            load(name, path)


WRONG_ROTORS = {
    "M": lambda data: -data["invariants.M"],
    "K": lambda data: data["invariants.K"] - 2.0 * data["invariants.K"].max() * np.eye(9),
    "G": lambda data: np.eye(9),
    "C": lambda data: data["invariants.C"] + np.triu(np.ones((9, 9)), 1),
    "K2": lambda data: data["invariants.K2"] + np.triu(np.ones((9, 9)), 1),
    "H": lambda data: -data["invariants.H"],
    "J": lambda data: -data["invariants.J"],
    "mass": lambda data: -data["invariants.mass"],
    "direction": lambda data: np.roll(data["invariants.direction"], 1),
}


@pytest.mark.parametrize("key", WRONG_ROTORS)
def test_no_impossible_rotor_loads(key, tmp_path):
    path, data = saved("ReducedRotor", tmp_path)
    forge(path, data | {f"invariants.{key}": WRONG_ROTORS[key](data)})
    with pytest.raises(ValueError, match=rf"kept\.npz: .*{key}\b"):
        ReducedRotor.load(path)


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("ReducedRotor", {"shapes.triangles": np.array([[0, 1, 6]])}),
        ("ReducedRotor", {"interface_names": np.array(["left", "left"])}),
        ("ReducedRotor", {"rigid": np.array([f"motion {i}" for i in range(10)])}),
        ("ReducedRotor", {"centrifugal.yield_stress": np.array(-1.0)}),
        ("Campbell", {"field.whirl_codes": np.full((3, 2), 10)}),
        ("Campbell", {"field.order": np.zeros((3, 2), dtype=int)}),
        ("StressHistory", {"field.nodes": np.array([2, 4])}),
        ("StressHistory", {"field.triangles": np.array([[0, 1, 4]])}),
        ("HarmonicResponse", {"field.frame": np.array("space")}),
        ("UnbalanceResponse", {"field.places": np.array(["left"])}),
        ("CriticalSpeeds", {"class": np.array("Campbell")}),
    ],
)
def test_values_that_contradict_each_other_are_refused(name, changes, tmp_path):
    path, data = saved(name, tmp_path)
    forge(path, data | changes)
    with pytest.raises(ValueError, match=r"kept\.npz: describes no "):
        load(name, path)


@pytest.mark.parametrize("name", STORED)
def test_whole_files_come_back_bit_for_bit(name, tmp_path):
    path, data = saved(name, tmp_path)
    load(name, path).save(tmp_path / "again.npz")
    again = entries(tmp_path / "again.npz")
    assert str(again["sha256"]) == str(data["sha256"])


# ------------------------------------------------------------------ damage


@dataclass(repr=False)
class Whole:
    """A file to damage, and what it was before."""

    path: Path
    content: bytes
    checksum: str


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Whole:
    path, data = saved("ReducedRotor", tmp_path_factory.mktemp("whole"))
    return Whole(path, path.read_bytes(), str(data["sha256"]))


def refused_or_same(path: Path, checksum: str) -> None:
    """Load a file: it is refused by our message, or what it holds did not change."""
    try:
        found = ReducedRotor.load(path)
    except ValueError as error:
        assert "kept.npz: " in str(error)  # noqa: PT017
        return
    found.save(path.with_name("found.npz"))
    assert str(entries(path.with_name("found.npz"))["sha256"]) == checksum


@settings(deadline=None)
@given(share=st.floats(0.0, 1.0, exclude_max=True))
def test_truncated_files_are_refused(whole, share):
    whole.path.write_bytes(whole.content[: int(share * len(whole.content))])
    with pytest.raises(ValueError, match=r"kept\.npz: damaged"):
        ReducedRotor.load(whole.path)


@settings(deadline=None)
@given(share=st.floats(0.0, 1.0, exclude_max=True), flip=st.integers(1, 255))
def test_flipped_bytes_are_noticed_or_harmless(whole, share, flip):
    changed = bytearray(whole.content)
    changed[int(share * len(changed))] ^= flip
    whole.path.write_bytes(bytes(changed))
    refused_or_same(whole.path, whole.checksum)


def bomb(path: Path, size: int) -> None:
    """Write an array of zeros that compresses to a thousandth."""
    archive = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
    with archive, archive.open("values.npy", "w") as stream:
        header = {"descr": "<f8", "fortran_order": False, "shape": (size // 8,)}
        np.lib.format.write_array_header_1_0(stream, header)
        for _ in range(size // 2**20):
            stream.write(bytes(2**20))


def false_header(path: Path, size: int) -> None:
    """Write an array whose header tells more than there is."""
    with zipfile.ZipFile(path, "w") as archive, archive.open("values.npy", "w") as stream:
        header = {"descr": "<f8", "fortran_order": False, "shape": (size // 8,)}
        np.lib.format.write_array_header_1_0(stream, header)
        stream.write(bytes(64))


@pytest.mark.parametrize(("write", "message"), [(bomb, "larger"), (false_header, "size")])
def test_small_files_take_no_memory(write, message, tmp_path):
    path, size = tmp_path / "big.npz", 100 * 2**20
    write(path, size)
    assert path.stat().st_size < size / 500
    tracemalloc.start()
    try:
        with pytest.raises(ValueError, match=rf"big\.npz: damaged.*{message}"):
            read_arrays(path, "thing")
        assert tracemalloc.get_traced_memory()[1] < size / 20
    finally:
        tracemalloc.stop()


def test_two_entries_of_one_name_are_refused(tmp_path):
    path = tmp_path / "a.npz"
    write_arrays(path, "thing", {"a": np.zeros(2)})
    with zipfile.ZipFile(path, "a") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("a.npy", b"")
    with pytest.raises(ValueError, match="two entries of one name"):
        read_arrays(path, "thing")


def test_arrays_that_compress_well_can_be_read_again(tmp_path, monkeypatch):
    monkeypatch.setattr(storage, "_FREE_BYTES", 10_000)
    write_arrays(tmp_path / "a.npz", "thing", {"zeros": np.zeros(100_000)})
    assert read_arrays(tmp_path / "a.npz", "thing")["zeros"].shape == (100_000,)


class Trap:
    """An object that shows if it was unpickled."""

    sprung = False

    def __reduce__(self):
        return _spring, ()


def _spring():
    Trap.sprung = True


def test_objects_are_neither_read_nor_written(tmp_path):
    path, data = saved("ReducedRotor", tmp_path)
    np.savez(path, **data | {"invariants.K": np.array([Trap()], dtype=object)})
    with pytest.raises(ValueError, match="without pickle"):
        ReducedRotor.load(path)
    assert not Trap.sprung
    with pytest.raises(TypeError, match="a: cannot be stored"):
        write_arrays(path, "thing", {"a": Trap()})


# ------------------------------------------------------------------ other files


def test_other_files_are_told_apart(tmp_path):
    path = tmp_path / "other.npz"
    np.savez(path, K=np.eye(3))
    with pytest.raises(ValueError, match="holds no reduced rotor, it was not written by"):
        ReducedRotor.load(path)
    STORED["Campbell"].save(path)
    with pytest.raises(ValueError, match="holds no reduced rotor, but a result"):
        ReducedRotor.load(path)
    STORED["ReducedRotor"].save(path)
    with pytest.raises(ValueError, match="holds no result, but a reduced rotor"):
        load_result(path)
    for version in (1, 3):
        forge(path, entries(path) | {"format": f"exudyn_rotor reduced rotor {version}"})
        with pytest.raises(ValueError, match="written by another version"):
            ReducedRotor.load(path)
    np.savez(path, format="exudyn_rotor reduced rotor 1", mode_mass=np.eye(3))
    with pytest.raises(ValueError, match="written by another version"):
        ReducedRotor.load(path)
    path.write_text("no archive at all")
    with pytest.raises(ValueError, match="not a readable"):
        ReducedRotor.load(path)
    np.save(tmp_path / "single.npy", np.eye(3))
    with pytest.raises(ValueError, match=r"single\.npy"):
        ReducedRotor.load(tmp_path / "single.npy")


@pytest.mark.parametrize(
    ("path", "kind", "message"),
    [
        ("missing.npz", FileNotFoundError, "path: there is no file"),
        (".", IsADirectoryError, "path: needs a file"),
        (3, TypeError, "path: needs the path of a file"),
        (b"a", TypeError, "path: needs the path of a file"),
        ("", ValueError, "path: needs the path of a file"),
    ],
)
def test_paths_that_cannot_be_loaded(path, kind, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for call in (ReducedRotor.load, load_result, Campbell.load):
        with pytest.raises(kind, match=message):
            call(path)
