"""The rotor as a finite-element model: nodes, matrices, axis, interfaces, surface."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.axis import SpinAxis, read_only
from exudyn_rotor.solid import checks
from exudyn_rotor.solid.interface import Interface

StressRecovery = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True, eq=False)
class SolidRotor:
    """Solid finite-element rotor; immutable. Make one with a ``from_…`` constructor.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions in mesh coordinates [m].
    mass, stiffness : scipy.sparse.csr_array, shape (3n, 3n)
        Assembled FE matrices, ordered x0 y0 z0 x1 … [kg], [N/m].
    damping : scipy.sparse.csr_array or None
        Damping of the rotor's own material, acting in the rotor frame [N s/m].
    axis : SpinAxis
        Spin axis in mesh coordinates.
    interfaces : mapping of str to Interface
    triangles : ndarray of int, shape (t, 3) or (t, 6)
        Surface for drawing, 6-node triangles where the mesh is quadratic: corners, then the mid
        nodes of the edges 0-1, 1-2, 2-0.
    stress_recovery : callable or None
        Maps displacement columns (3n, k) to nodal stress (n, 6, k) [Pa], components xx, yy, zz,
        yz, xz, xy in mesh axes.
    point_masses : tuple of PointMass
        What :meth:`add_point_mass` placed, with the snapping distances.
    """

    nodes: np.ndarray
    mass: sp.csr_array
    stiffness: sp.csr_array
    axis: SpinAxis
    damping: sp.csr_array | None = None
    interfaces: Mapping[str, Interface] = field(default_factory=dict)
    triangles: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int64))
    stress_recovery: StressRecovery | None = None
