"""Files of arrays (``.npz``) without pickle: reading executes nothing, writing loses nothing.

A file holds named arrays, its format and a checksum of all entries. Saving is atomic: the data go
to a draft of a name of its own in the same folder, ``<name>.<16 hexadecimal digits>.draft``, which
takes the place of the file when it is complete and on the disk. A saver that is killed leaves its
draft, which nothing reads; it can be deleted. On Windows a file that another process reads cannot
be replaced: the saver gets a PermissionError, and the file stays as it was.
"""

from __future__ import annotations

import contextlib
import hashlib
import math
import os
import secrets
import stat
import zipfile
from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from exudyn_rotor import checks

_PACKAGE = "exudyn_rotor"
_VERSION = 2  # of the file format
_CHECKSUM = "sha256"
_KINDS = "biufcU"  # flags, numbers, text
_HEADER = 10_000  # characters of an array's header at most
# Without this limit a small file could fill the memory. Arrays of zeros compress by more; such
# files are written without compression, so that every file can be read again.
_FREE_BYTES = 64 * 2**20
_RATIO = 20


def write_arrays(path: str | PathLike, kind: str, data: Mapping[str, object]) -> None:
    """Write arrays, numbers and text to `path`; a file there is replaced by a complete one only.

    Any number of processes may save and read the same path. The mode of an existing file stays;
    through a symbolic link its target is written. No other file is touched.

    Parameters
    ----------
    path : str or path-like
    kind : str
        What the file holds, for :func:`read_arrays`.
    data : mapping of str to array_like

    Raises
    ------
    TypeError
        If `path` is no path, or an entry is neither numbers, flags nor text.
    OSError
        If the folder does not exist, `path` is a folder, a device or read-only, or the disk is
        full; the old file stays then.
    """
    target = _target(path)
    entries = {"format": np.array(_format(kind))}
    entries |= {name: np.asarray(value) for name, value in data.items()}
    for name, value in entries.items():
        if value.dtype.kind not in _KINDS:
            raise TypeError(f"{name}: cannot be stored, needs numbers, got {checks.shown(value)}")
    entries[_CHECKSUM] = np.array(_checksum(entries))
    with _replacing(target) as file:
        # not with allow_pickle=False, which is one more array before numpy 2.2; no kind is pickled
        np.savez_compressed(file, **entries)
        if sum(value.nbytes for value in entries.values()) > _most_bytes(file.tell()):
            file.seek(0)
            file.truncate()
            np.savez(file, **entries)


def write_text(path: str | PathLike, text: str) -> None:
    """Write text, UTF-8, to `path` in the way of :func:`write_arrays`.

    Raises
    ------
    TypeError, OSError
        As :func:`write_arrays`.
    """
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: str | PathLike, data: bytes) -> None:
    """Write bytes to `path` in the way of :func:`write_arrays`.

    Raises
    ------
    TypeError, OSError
        As :func:`write_arrays`.
    """
    with _replacing(_target(path)) as file:
        file.write(data)


def read_arrays(path: str | PathLike, kind: str) -> dict[str, np.ndarray]:
    """Read the arrays of a file of a kind; they are read-only.

    Sizes are checked before memory is taken: at most 64 MiB, or 20 times the size of the file.

    Raises
    ------
    TypeError
        If `path` is no path.
    OSError
        If there is no such file.
    ValueError
        If the file is damaged, of another kind, or written by another version of the package.
    """
    source = checks.path(path)
    if not source.exists():
        raise FileNotFoundError(f"path: there is no file {str(source)!r}")
    if not source.is_file():
        raise IsADirectoryError(f"path: needs a file, {str(source)!r} is a folder or a device")
    with open(source, "rb") as file:
        try:
            data = _entries(file)
        # damage shows as errors of zip, zlib, struct, numpy, the file system, or as a wrong type
        except Exception as error:
            raise ValueError(
                f"{source}: damaged, or not a readable file of {_PACKAGE}, .npz without pickle "
                f"({error})"
            ) from error
    _check_format(source, data, kind)
    del data["format"]
    return data


class Entries:
    """Entries of a file, taken one by one with a check of their type; none may be left."""

    def __init__(self, data: Mapping[str, np.ndarray], prefix: str = "") -> None:
        self._data, self._prefix = dict(data), prefix

    def __len__(self) -> int:
        return len(self._data)

    def __contains__(self, name: str) -> bool:
        return name in self._data

    def array(self, name: str, dtype: type = float) -> np.ndarray:
        """Return an array of exactly this type."""
        value = self._taken(name)
        if value.dtype != dtype:
            raise ValueError(f"{self._prefix}{name}: needs {np.dtype(dtype)}, holds {value.dtype}")
        return value

    def arrays(self, *names: str, optional: bool = False) -> dict[str, np.ndarray]:
        """Return arrays of floats by their names; those that are there, if they are optional."""
        return {name: self.array(name) for name in names if name in self or not optional}

    def number(self, name: str) -> float:
        """Return one number."""
        return self._one(self.array(name), name)

    def flag(self, name: str) -> bool:
        """Return True or False."""
        return self._one(self.array(name, bool), name)

    def words(self, name: str, unique: bool = True) -> tuple[str, ...]:
        """Return a row of words, each once if `unique`."""
        value = self._taken(name)
        if value.dtype.kind != "U" or value.ndim != 1:
            raise ValueError(f"{self._prefix}{name}: needs a row of words, holds {value.dtype}")
        words = tuple(str(word) for word in value)
        if unique and len(set(words)) < len(words):
            raise ValueError(f"{self._prefix}{name}: needs each word once")
        return words

    def group(self, prefix: str) -> Entries:
        """Take all entries whose names begin with `prefix`, without it."""
        names = [name for name in self._data if name.startswith(prefix)]
        taken = {name.removeprefix(prefix): self._data.pop(name) for name in names}
        return Entries(taken, self._prefix + prefix)

    def close(self) -> None:
        """Refuse what was not taken."""
        if self._data:
            names = ", ".join(repr(self._prefix + name) for name in sorted(self._data))
            raise ValueError(f"the entries {names} are unknown")

    def _taken(self, name: str) -> np.ndarray:
        if name not in self._data:
            raise ValueError(f"the entry {self._prefix + name!r} is missing")
        return self._data.pop(name)

    def _one(self, value: np.ndarray, name: str) -> Any:
        if value.ndim:
            raise ValueError(f"{self._prefix}{name}: needs one value, got {value.shape}")
        return value.item()


# ------------------------------------------------------------------ writing


def _target(path: str | PathLike) -> Path:
    """Return the file to write, links followed, after checks of what is there."""
    given = checks.path(path)
    target = Path(os.path.realpath(given))
    if target.is_symlink():
        raise OSError(f"path: {str(given)!r} is a link that leads to itself")
    if target.is_dir() or os.fspath(path).endswith(("/", os.sep)):  # which Path leaves out
        raise IsADirectoryError(f"path: needs the name of a file, {os.fspath(path)!r} is a folder")
    # realpath takes 'none/../a.npz' for 'a.npz', which no system does
    for folder in (Path.cwd() / given.parent, target.parent):
        if not folder.is_dir():
            raise FileNotFoundError(f"path: the folder {str(folder)!r} does not exist; make it")
    if target.exists():
        if not target.is_file():
            raise OSError(f"path: needs the name of a file, {str(given)!r} is a device")
        if not os.access(target, os.W_OK):
            raise PermissionError(f"path: the file {str(given)!r} is read-only")
    return target


@contextlib.contextmanager
def _replacing(target: Path) -> Iterator[BinaryIO]:
    """Open a draft that takes the place of `target` when it is complete and on the disk."""
    mode = stat.S_IMODE(target.stat().st_mode) if target.exists() else None
    draft = target.with_name(f"{target.name[:40]}.{secrets.token_hex(8)}.draft")
    try:
        with _made(draft, mode) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(draft, target)
    finally:
        draft.unlink(missing_ok=True)
    _flush_folder(target.parent)


def _made(draft: Path, mode: int | None) -> BinaryIO:
    """Open a file that must not exist yet; the draft of a private file is private, too."""
    if mode is None:
        return open(draft, "xb")
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    descriptor = os.open(draft, flags, mode)
    draft.chmod(mode)  # what the umask took away
    return os.fdopen(descriptor, "wb")


def _flush_folder(folder: Path) -> None:
    """Put the new name on the disk, where the system can flush folders."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


# ------------------------------------------------------------------ reading


def _entries(file: BinaryIO) -> dict[str, np.ndarray]:
    """Return all entries; none is read before the sizes of all have been checked."""
    most = _most_bytes(os.fstat(file.fileno()).st_size)
    with zipfile.ZipFile(file) as archive:
        listed = archive.infolist()
        if sum(entry.file_size for entry in listed) > most:
            raise ValueError(f"its content is larger than {most} bytes")
        names = [entry.filename.removesuffix(".npy") for entry in listed]
        if len(set(names)) < len(names):
            raise ValueError("it holds two entries of one name")
        return {name: _array(archive, entry) for name, entry in zip(names, listed, strict=True)}


def _array(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> np.ndarray:
    """Read one array; its header must tell the size that the entry has."""
    with archive.open(entry) as stream:
        major, _ = np.lib.format.read_magic(stream)
        read = (
            np.lib.format.read_array_header_1_0 if major == 1
            else np.lib.format.read_array_header_2_0
        )  # fmt: skip
        shape, fortran, dtype = read(stream, max_header_size=_HEADER)
        size = math.prod(shape) * dtype.itemsize
        if dtype.kind not in _KINDS or min(shape, default=0) < 0:
            raise ValueError(f"{entry.filename}: holds neither numbers nor text, but {dtype}")
        if stream.tell() + size != entry.file_size:
            raise ValueError(f"{entry.filename}: its size is not that of its header")
        content = stream.read()
    return np.ndarray(shape, dtype, content, order="F" if fortran else "C")


def _most_bytes(file_size: int) -> int:
    """Return how large the content of a file may be."""
    return max(_FREE_BYTES, _RATIO * file_size)


def _check_format(source: Path, data: dict[str, np.ndarray], kind: str) -> None:
    """Refuse files of other origin, kind or version, and damaged ones; drop the checksum."""
    written = str(data.get("format", ""))
    if not written.startswith(_PACKAGE):
        raise ValueError(f"{source}: holds no {kind}, it was not written by {_PACKAGE}")
    checksum = data.pop(_CHECKSUM, None)
    damaged = checksum is not None and str(checksum) != _checksum(data)
    if damaged or (checksum is None and written == _format(kind)):
        raise ValueError(f"{source}: damaged, its checksum is not that of its content")
    if written == _format(kind):
        return
    held = written.removeprefix(_PACKAGE).strip().rstrip("0123456789").strip()
    if held != kind:
        raise ValueError(f"{source}: holds no {kind}, but a {held}")
    raise ValueError(
        f"{source}: written by another version of {_PACKAGE} ({written!r}, needed is "
        f"{_format(kind)!r}); make it anew"
    )


def _format(kind: str) -> str:
    return f"{_PACKAGE} {kind} {_VERSION}"


def _checksum(entries: Mapping[str, np.ndarray]) -> str:
    """Return a checksum of names, types, shapes and values."""
    result = hashlib.sha256()
    for name in sorted(entries):
        value = entries[name]
        result.update(repr((name, value.dtype.str, value.shape)).encode())
        if value.size:
            result.update(np.ascontiguousarray(value).reshape(-1).view(np.uint8))
    return result.hexdigest()
