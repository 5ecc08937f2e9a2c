"""What a finite-element source delivers, before the checks: plain arrays without an axis."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.solid.elements import SolidElements

StressRecovery = Callable[[np.ndarray], np.ndarray]
NodeSet = tuple[Sequence[int], Sequence[float] | None]


@dataclass(frozen=True, eq=False)
class FiniteElementModel:
    """Arrays of one finite-element model as its source gave them.

    Attributes
    ----------
    nodes : array_like, shape (n, 3)
        Reference positions [m].
    mass, stiffness, damping : array_like or sparse, shape (3n, 3n)
        Assembled matrices; the damping may be None.
    node_sets : mapping of str to (nodes, weights)
        Node numbers and their weights of every interface; weights None means equal weights.
    triangles : array_like of int, shape (t, 3) or (t, 6)
        Surface for drawing.
    stress_recovery : callable or None
        See :class:`exudyn_rotor.SolidRotor`.
    elements : SolidElements or None
        What matrices of a static stress are assembled on.
    """

    nodes: Any
    mass: Any
    stiffness: Any
    damping: Any = None
    node_sets: Mapping[str, NodeSet] = field(default_factory=dict)
    triangles: Any = ()
    stress_recovery: StressRecovery | None = None
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
            stress_recovery=elements.nodal_stress,
            elements=elements,
        )


def node_set(name: str, entry: Any) -> NodeSet:
    """Read one entry of ``from_matrices(interfaces=…)``: nodes, or (nodes, weights)."""
    nodes, weights = entry, None
    if isinstance(entry, tuple) and len(entry) == 2 and not np.isscalar(entry[0]):
        nodes, weights = entry
    return checks.array(nodes, f"interfaces: {name!r}: nodes", dtype=int), weights
