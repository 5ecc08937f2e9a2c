"""Files: loading refuses all that is not whole."""

from dataclasses import MISSING, fields
from pathlib import Path

import numpy as np
import pytest
from small_results import STORED

from exudyn_rotor import ReducedRotor, load_result
from exudyn_rotor.storage import write_arrays

# what a response has at nodes, at rest, without damping, beyond the last critical speed or peak
MAY_BE_LONGER = ("triangles", "dropped", "field.free_motions", "field.vectors")
MAY_BE_EMPTY = ("triangles", "field.vectors")
MAY_BE_MISSING = (
    ".K2", ".B", ".K4", ".K2_estimated", ".H", ".K0", "shapes.stress", "dropped", "grounded",
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
    "Campbell", "CriticalSpeedMap", "PeriodicResponse", "StabilityLevelOne",
    "SeparationMargins", "Sensitivity", "Stability", "StabilityMap", "StaticResponse",
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


def assert_same(found: dict[str, np.ndarray], expected: dict[str, np.ndarray]) -> None:
    assert found.keys() == expected.keys()
    for name, value in expected.items():
        assert found[name].dtype == value.dtype
        np.testing.assert_array_equal(found[name], value)


def wrong_values(key: str, value: np.ndarray, owner: str) -> dict[str, np.ndarray]:
    """Return values that an entry must not have, by what is wrong with them."""
    wrong = {
        "type": np.array([1.5 + 1j]),
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
    path, data = saved(name, tmp_path)
    tried, loaded = 0, []
    for key, value in data.items():
        if key == "format":
            continue
        for label, wrong in wrong_values(key, value, name).items():
            if not value.size and np.array_equal(wrong, value):
                continue
            np.savez(path, **data | {key: wrong})
            try:
                load(name, path)
                loaded.append((key, label))
            except ValueError as error:
                assert "kept.npz: " in str(error)  # noqa: PT017
            tried += 1
    assert loaded == []
    assert tried > 4 * (len(data) - 1)


@pytest.mark.parametrize("name", STORED)
def test_no_missing_or_added_entry_loads(name, tmp_path):
    path, data = saved(name, tmp_path)
    for key in data:
        np.savez(path, **{other: value for other, value in data.items() if other != key})
        defaults = {item.name for item in fields(STORED[name]) if item.default is not MISSING}
        optional = key.endswith(MAY_BE_MISSING) or "centrifugal." in key
        optional |= key.removeprefix("field.") in defaults
        if not optional:
            with pytest.raises(ValueError, match=r"kept\.npz: "):
                pytest.fail(f"without {key}: loaded as {load(name, path)!r}")
    for key in ("added", "field.added", "invariants.added"):
        np.savez(path, **data | {key: np.zeros(3)})
        with pytest.raises(ValueError, match=r"unexpected keyword argument '.*added'"):
            load(name, path)


# ------------------------------------------------------------------ damage


@pytest.mark.parametrize("share", np.linspace(0.01, 0.99, 20))
def test_flipped_bytes_are_noticed_or_harmless(share, tmp_path):
    path, data = saved("ReducedRotor", tmp_path)
    changed = bytearray(path.read_bytes())
    changed[int(share * len(changed))] ^= 255
    path.write_bytes(bytes(changed))
    try:
        found = ReducedRotor.load(path)
    except ValueError as error:
        assert "kept.npz: " in str(error)  # noqa: PT017
        return
    found.save(path)
    assert_same(entries(path), data)


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
    with pytest.raises(ValueError, match=r"holds 'no format', where '.* reduced rotor"):
        ReducedRotor.load(path)
    STORED["Campbell"].save(path)
    with pytest.raises(ValueError, match=r"holds '.* result .*', where '.* reduced rotor"):
        ReducedRotor.load(path)
    STORED["ReducedRotor"].save(path)
    with pytest.raises(ValueError, match=r"holds '.* reduced rotor .*; ReducedRotor\.load\("):
        load_result(path)
    with pytest.raises(IsADirectoryError, match=r"of a file, '.*' is a folder"):
        ReducedRotor.load(tmp_path)
    for version in (1, 3):
        np.savez(path, **entries(path) | {"format": f"exudyn_rotor reduced rotor {version}"})
        with pytest.raises(ValueError, match="make the file anew"):
            ReducedRotor.load(path)
    np.savez(path, format="exudyn_rotor reduced rotor 1", mode_mass=np.eye(3))
    with pytest.raises(ValueError, match="make the file anew"):
        ReducedRotor.load(path)
    path.write_text("no archive at all")
    with pytest.raises(ValueError, match="not a readable"):
        ReducedRotor.load(path)
    np.save(tmp_path / "single.npy", np.eye(3))
    with pytest.raises(ValueError, match=r"single\.npy"):
        ReducedRotor.load(tmp_path / "single.npy")
