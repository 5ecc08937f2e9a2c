"""Surfaces with nodal values as files for ParaView, written by the package meshio."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from os import PathLike
from pathlib import Path

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.storage import write_bytes

FORMATS = (".vtu", ".vtk")


def write_surface(
    path: str | PathLike,
    positions: np.ndarray,
    triangles: np.ndarray,
    values: Mapping[str, np.ndarray],
) -> None:
    """Write nodal values of a surface; a file there is replaced by a complete one only.

    Parameters
    ----------
    path : str or path-like
        Ends with '.vtu' or '.vtk'.
    positions : ndarray, shape (n, 3)
        [m]
    triangles : ndarray of int, shape (t, 3) or (t, 6)
        Nodes that are in none are left out.
    values : mapping of str to ndarray, each (n,) or (n, c)
        '.vtk' holds no spaces in their names; '_' stands there for each.

    Raises
    ------
    ImportError
        Without meshio.
    ValueError
        For another ending, or if there are no triangles.
    """
    target = checks.path(path)
    if target.suffix not in FORMATS:
        raise ValueError(f"path: needs the ending {' or '.join(FORMATS)}, got {str(target)!r}")
    if len(triangles) == 0:
        raise ValueError(
            "triangles: there are none, so there is no surface to write; models from NGSolve have "
            "one, others need triangles=…"
        )
    try:
        import meshio
    except ImportError as error:
        raise ImportError(
            'VTK files need the package meshio: python -m pip install "exudyn-rotor[vtk]"'
        ) from error
    if target.suffix == ".vtk":  # whose names end at a space
        values = {name.replace(" ", "_"): array for name, array in values.items()}
    used, cells = np.unique(triangles, return_inverse=True)
    kind = "triangle" if triangles.shape[1] == 3 else "triangle6"
    mesh = meshio.Mesh(
        positions[used],
        [(kind, cells.reshape(triangles.shape))],
        point_data={name: np.ascontiguousarray(array[used]) for name, array in values.items()},
    )
    with tempfile.TemporaryDirectory() as folder:
        draft = Path(folder, "surface").with_suffix(target.suffix)
        mesh.write(draft)
        write_bytes(target, draft.read_bytes())
