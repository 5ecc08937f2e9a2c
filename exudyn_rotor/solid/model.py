"""What a finite-element source delivers, before the checks: plain arrays without an axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.solid.elements import SolidElements

NodeSet = tuple[Sequence[int], Sequence[float] | None]


@dataclass(frozen=True, eq=False)
class FiniteElementModel:
    """Arrays of one finite-element model as its source gave them, as of ``SolidRotor``.

    `node_sets` are node numbers and weights of every interface; weights None means equal ones.
    """

    nodes: Any
    mass: Any
    stiffness: Any
    damping: Any = None
    node_sets: Mapping[str, NodeSet] = field(default_factory=dict)
    triangles: Any = ()
    elements: SolidElements | None = None

    @classmethod
    def of_elements(
        cls, elements: SolidElements, node_sets: Mapping[str, NodeSet], triangles: Any
    ) -> FiniteElementModel:
        """Return the model of elements."""
        return cls(
            nodes=elements.nodes,
            mass=elements.mass_matrix(),
            stiffness=elements.stiffness_matrix(),
            node_sets=node_sets,
            triangles=triangles,
            elements=elements,
        )


def node_set(name: str, entry: Any) -> NodeSet:
    """Read one entry of ``from_matrices(interfaces=…)``: nodes, or (nodes, weights)."""
    nodes, weights = entry, None
    if isinstance(entry, tuple) and len(entry) == 2 and not np.isscalar(entry[0]):
        nodes, weights = entry
    return checks.array(nodes, f"interfaces: {name!r}: nodes", dtype=int), weights
