"""Finite-element models that Exudyn's FEMinterface holds (NGSolve, Abaqus, Ansys, own files)."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from exudyn.FEM import FEMinterface

from exudyn_rotor import checks
from exudyn_rotor.solid.model import FiniteElementModel, NodeSet

# Face names that Netgen invents for faces without a name.
_INVENTED_NAME = re.compile(r"(default|bc_\d+)?")


def is_named(face: str) -> bool:
    """Tell whether a user gave this face name, rather than Netgen."""
    return _INVENTED_NAME.fullmatch(face) is None


def import_model(fem: FEMinterface) -> FiniteElementModel:
    """Return the model in `fem`; parameters and errors as ``SolidRotor.from_fem_interface``."""
    checks.instance(fem, "fem", FEMinterface, "of exudyn.FEM")
    for attribute in ("massMatrix", "stiffnessMatrix"):
        matrix = getattr(fem, attribute)
        if matrix is None or np.size(matrix) == 0:
            raise ValueError(f"fem: {attribute} is missing; import or compute it first")
    return FiniteElementModel(
        nodes=_positions(fem.nodes),
        mass=fem.massMatrix,
        stiffness=fem.stiffnessMatrix,
        node_sets=_node_sets(fem.nodeSets),
        triangles=_triangles(fem.surface),
    )


def _positions(nodes: dict[str, Any]) -> np.ndarray:
    """Return the positions of the only node list; rotations and planar nodes are refused."""
    kinds = list(nodes)
    if any(kind.startswith("RigidBody") for kind in kinds):
        raise ValueError(
            f"fem: its nodes {kinds} are rotation-carrying (shells, beams); a solid rotor needs "
            "solid elements with 'Position' nodes"
        )
    if kinds != ["Position"]:
        raise ValueError(f"fem: needs 'Position' nodes only, got {kinds or 'no nodes'}")
    return nodes["Position"]


def _triangles(surfaces: list[dict[str, Any]]) -> np.ndarray:
    """Return the triangles of all surfaces, 6-node triangles if every surface has them."""
    surfaces = [surface for surface in surfaces if len(surface.get("Trigs", ()))]
    if not surfaces:
        return np.zeros((0, 3), dtype=np.int64)
    kind = "Trigs6" if all("Trigs6" in surface for surface in surfaces) else "Trigs"
    return np.vstack([np.asarray(surface[kind]) for surface in surfaces])


def _node_sets(node_sets: list[dict[str, Any]]) -> dict[str, NodeSet]:
    """Return node numbers and weights by name, without the sets of faces that have no name."""
    named = [node_set for node_set in node_sets if is_named(node_set["Name"])]
    names = [node_set["Name"] for node_set in named]
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise ValueError(f"fem: several node sets are named {repeated}; rename them")
    return {s["Name"]: (s["NodeNumbers"], s.get("NodeWeights")) for s in named}
