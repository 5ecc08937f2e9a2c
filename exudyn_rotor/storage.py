"""Files of arrays (``.npz``) without pickle: reading never executes code, writing loses nothing."""

from __future__ import annotations

import os
from collections.abc import Mapping
from os import PathLike
from pathlib import Path

import numpy as np


def write_arrays(path: str | PathLike, data: Mapping[str, object]) -> None:
    """Write arrays to `path`; a file of that name is replaced only by a complete one."""
    target = Path(path)
    draft = target.with_name(target.name + ".part")
    try:
        with open(draft, "wb") as file:
            np.savez_compressed(file, allow_pickle=False, **data)
        os.replace(draft, target)
    finally:
        draft.unlink(missing_ok=True)


def read_arrays(path: str | PathLike) -> dict[str, np.ndarray]:
    """Read the arrays of a file.

    Raises
    ------
    ValueError
        When the file is damaged, or of another kind.
    """
    with open(path, "rb") as file:
        try:
            archive = np.load(file, allow_pickle=False)
            return {key: archive[key] for key in archive.files}
        # damage shows as errors of zip, zlib, struct, numpy, the file system, or as a wrong type
        except Exception as error:
            raise ValueError(
                f"{path}: not a readable .npz file without pickle ({error})"
            ) from error
