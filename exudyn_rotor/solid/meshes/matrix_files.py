"""Assembled matrices of CalculiX (.sti, .mas, .dof) and Nastran (DMIG cards)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.solid.meshes import nastran


def read(path: Path, numbers: list[int]) -> tuple[sp.csr_array, sp.csr_array]:
    """Return mass and stiffness on the displacements of nodes with these numbers, in file units.

    `path` is ``name.sti`` with ``name.mas`` and ``name.dof`` beside it (CalculiX, ``*FREQUENCY,
    SOLVER=MATRIXSTORAGE``), or a punch file of DMIG cards with one matrix whose name begins with M
    and one with K.
    """
    if path.suffix == ".sti":
        order = _equations(path.with_suffix(".dof"), numbers)
        mass, stiffness = (_calculix(path.with_suffix(end), order) for end in (".mas", ".sti"))
        return mass, stiffness
    names = sorted({fields[1] for _, fields in nastran.cards(path) if fields[0] == "DMIG"})
    chosen = [[name for name in names if name.upper().startswith(first)] for first in "MK"]
    if any(len(found) != 1 for found in chosen):
        raise ValueError(
            f"matrices: {path.name}: needs DMIG cards of one matrix M… and one K…, got {names}"
        )
    mass, stiffness = (nastran.read_dmig(path, numbers, found[0]) for found in chosen)
    return mass, stiffness


def _equations(path: Path, numbers: list[int]) -> np.ndarray:
    """Return the coordinate of each equation of CalculiX."""
    places = {number: 3 * i for i, number in enumerate(numbers)}
    pairs = [line.strip().partition(".") for line in _text(path).split()]
    try:
        order = np.array([places[int(node)] + int(direction) - 1 for node, _, direction in pairs])
    except (KeyError, ValueError) as error:
        raise ValueError(f"matrices: {path.name}: node {error} is none of the mesh") from error
    if not np.array_equal(np.sort(order), np.arange(3 * len(numbers))):
        raise ValueError(
            f"matrices: {path.name}: has {order.size} of the {3 * len(numbers)} displacements; "
            "export without *BOUNDARY, *EQUATION and *MPC, which take equations away"
        )
    return order


def _calculix(path: Path, order: np.ndarray) -> sp.csr_array:
    try:
        table = np.array(_text(path).split(), dtype=float).reshape(-1, 3)
        rows, columns = (order[table[:, i].astype(int) - 1] for i in (0, 1))
    except (ValueError, IndexError) as error:
        raise ValueError(
            f"matrices: {path.name}: needs lines of row, column, value: {error}"
        ) from error
    return nastran.symmetric(rows, columns, table[:, 2], order.size)


def _text(path: Path) -> str:
    if not path.is_file():
        raise ValueError(f"matrices: there is no file {path}; CalculiX writes .sti, .mas and .dof")
    return path.read_text(encoding="utf-8", errors="replace")
