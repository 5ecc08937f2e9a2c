"""Files of arrays (``.npz``) without pickle: reading executes nothing, writing loses nothing.

A file holds named arrays and its format. What is written goes to a draft beside the file, which
takes its place when it is complete.
"""

from __future__ import annotations

import io
import os
from collections.abc import Mapping
from os import PathLike
from pathlib import Path

import numpy as np

from exudyn_rotor import checks

_PACKAGE = "exudyn_rotor"
_VERSION = 2  # of the file format
_KINDS = "biufcU"  # flags, numbers, text
RESULT, REDUCED_ROTOR = "result", "reduced rotor"  # what a file holds, and what loads it:
_LOADED_BY = {RESULT: "load_result(path)", REDUCED_ROTOR: "ReducedRotor.load(path)"}


def write_arrays(path: str | PathLike, kind: str, data: Mapping[str, object]) -> None:
    """Write arrays, numbers and text to `path` as :func:`write_bytes` does.

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
        As :func:`write_bytes`.
    """
    entries = {"format": np.array(_format(kind))}
    entries |= {name: np.asarray(value) for name, value in data.items()}
    for name, value in entries.items():
        if value.dtype.kind not in _KINDS:
            raise TypeError(f"{name}: cannot be stored, needs numbers, got {checks.shown(value)}")
    content = io.BytesIO()
    np.savez_compressed(content, **entries)
    write_bytes(path, content.getvalue())


def write_bytes(path: str | PathLike, data: bytes) -> None:
    """Write bytes to `path`; a file there is replaced by a complete one only.

    Raises
    ------
    TypeError
        If `path` is no path.
    OSError
        If the folder does not exist, `path` is a folder, a device or read-only, or the disk is
        full; the old file stays then.
    """
    target = Path(os.path.realpath(checks.path(path)))
    if not target.parent.is_dir():
        raise FileNotFoundError(f"path: the folder {str(target.parent)!r} does not exist; make it")
    if target.exists() and not target.is_file():
        raise OSError(f"path: needs the name of a file, {os.fspath(path)!r} is a folder or device")
    if target.exists() and not os.access(target, os.W_OK):
        raise PermissionError(f"path: the file {os.fspath(path)!r} is read-only")
    draft = target.with_name(f"{target.name}.{os.getpid()}.draft")
    try:
        draft.write_bytes(data)
        os.replace(draft, target)
    finally:
        draft.unlink(missing_ok=True)


def read_arrays(path: str | PathLike, kind: str) -> dict[str, np.ndarray]:
    """Read the arrays of a file of a kind; they are read-only.

    Raises
    ------
    TypeError
        If `path` is no path.
    OSError
        If there is no such file.
    ValueError
        If the file is damaged, of another kind, or written by another version of the package.
    """
    source = checks.file(path)
    try:
        with open(source, "rb") as opened, np.load(opened, allow_pickle=False) as file:
            data = {name: file[name] for name in file.files}
    # damage shows as errors of zip, zlib, struct, numpy or the file system, or as a wrong type
    except Exception as error:
        raise ValueError(
            f"{source}: damaged, or not a readable file of {_PACKAGE}, .npz without pickle "
            f"({error})"
        ) from error
    written = str(data.pop("format", "no format"))
    if written != _format(kind):
        loaders = {_format(one): loader for one, loader in _LOADED_BY.items()}
        raise ValueError(
            f"{source}: holds {written!r}, where {_format(kind)!r} is needed; "
            + (f"{loaders[written]} reads it" if written in loaders else "make the file anew")
        )
    for array in data.values():
        array.flags.writeable = False
    return data


def read_rows(path: str | PathLike, name: str = "path") -> list[tuple[int, list[str]]]:
    """Return number and words of the lines of a text table, without comments and empty lines.

    Words stand between semicolons, commas, tabs or blanks; in lines with semicolons a comma is that
    of decimals. Text after ``#`` is a comment.

    Raises
    ------
    TypeError, OSError
        As :func:`read_arrays`.
    """
    # Excel marks UTF-8; names may be in another encoding
    text = checks.file(path, name).read_text(encoding="utf-8-sig", errors="replace")
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        line = line.split("#")[0].strip()
        line = line.replace(",", ".") if ";" in line else line
        between = next((mark for mark in ";,\t" if mark in line), None)
        if line:
            rows.append((number, [word.strip() for word in line.split(between)]))
    return rows


def plain(value: np.ndarray) -> object:
    """Return an entry of a file as it was given: a number, word, tuple of words, or array."""
    if value.ndim == 0:
        return value.item()
    return tuple(value.tolist()) if value.dtype.kind == "U" else value


def _format(kind: str) -> str:
    return f"{_PACKAGE} {kind} {_VERSION}"
