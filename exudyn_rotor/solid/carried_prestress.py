"""Static stress of a spinning rotor as stiffness matrices, which the rotor carries."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.solid import matrices


@dataclass(frozen=True, eq=False)
class Prestress:
    """Stiffness of a rotor from its static stress; made by :meth:`SolidRotor.prestress`.

    An imported model has ``Prestress(matrix, nodes)`` of the geometric stiffness alone.

    Vibrations have the stiffness ``K + ω² (K_G + K_u) + ω⁴ K_uu``, see
    :mod:`exudyn_rotor.prestress.static_solution`.

    Attributes
    ----------
    matrix : scipy.sparse.csr_array, shape (3n, 3n)
        Stiffness per ω², ordered x0 y0 z0 x1 …: K_G of the centrifugal stress for 1 rad/s, without
        the spin softening ``−ẽᵀMẽ`` [N s²/m].
    nodes : ndarray, shape (n, 3)
        Positions of the mesh it belongs to [m].
    displacement : ndarray or None, shape (3n,)
        Static centrifugal displacement per ω², mesh axes [m s²]; None for an imported matrix.
    stress : ndarray or None, shape (n, 6)
        Its stress at the nodes per ω², xx, yy, zz, yz, xz, xy in mesh axes [Pa s²].
    initial_displacement : tuple of two scipy.sparse.csr_array, or None
        K_u per ω² and K_uu per ω⁴ of the static displacement [N s²/m, N s⁴/m].
    yield_stress : float or None
        Yield stress of the material [Pa].
    by_loads : scipy.sparse.csr_array or None
        K_G of the stress by given loads [N/m]. It resists tilts of the whole rotor, too, as loads
        keep their direction, so that it is no part of the rotor's own stiffness.
    buckling_factor : float or None
        Multiple of the given loads at which the rotor buckles; None where it never does.
    reactions : ndarray or None, shape (3n,)
        Nodal forces per ω² of the supports that hold the rotor under the centrifugal load [N s²].

    Raises
    ------
    TypeError, ValueError
        If an entry is of another kind, its shape does not fit, or a matrix is not symmetric.

    Examples
    --------
    A bar along x between two masses of 1 kg carries ``ω² · 1 kg · 0.5 m``, which stiffens it
    across by that over its length of 1 m:

    >>> import numpy as np
    >>> from exudyn_rotor import Prestress
    >>> across = np.kron([[0.5, -0.5], [-0.5, 0.5]], np.eye(3))
    >>> Prestress(across, [[-0.5, 0, 0], [0.5, 0, 0]])
    Prestress(2 nodes)
    """

    matrix: sp.csr_array
    nodes: np.ndarray
    displacement: np.ndarray | None = None
    stress: np.ndarray | None = None
    initial_displacement: tuple[sp.csr_array, sp.csr_array] | None = None
    yield_stress: float | None = None
    by_loads: sp.csr_array | None = None
    buckling_factor: float | None = None
    reactions: np.ndarray | None = None

    def __post_init__(self) -> None:
        nodes = matrices.as_nodes(self.nodes)
        count = len(nodes)
        matrix = matrices.as_matrix("prestress matrix", self.matrix, count)
        checked = {"nodes": nodes, "matrix": matrix}
        if self.by_loads is not None:
            checked["by_loads"] = matrices.as_matrix("by_loads matrix", self.by_loads, count)
        if self.initial_displacement is not None:
            both = checks.items(self.initial_displacement, "initial_displacement", "K_u and K_uu")
            if len(both) != 2:
                raise ValueError(f"initial_displacement: needs K_u and K_uu, got {len(both)}")
            checked["initial_displacement"] = tuple(
                matrices.as_matrix("initial_displacement matrix", one, count) for one in both
            )
        shapes = {"displacement": (3 * count,), "reactions": (3 * count,), "stress": (count, 6)}
        for name, shape in shapes.items():
            if getattr(self, name) is not None:
                checked[name] = checks.array(getattr(self, name), name, shape=shape)
        for name, unit in (("yield_stress", "Pa"), ("buckling_factor", "")):
            if getattr(self, name) is not None:
                checked[name] = checks.number(getattr(self, name), name, unit, above=0.0)
        checks.keep(self, **checked)

    @property
    def per_square(self) -> sp.csr_array:
        """Stiffness per ω², ``K_G + K_u``."""
        if self.initial_displacement is None:
            return self.matrix
        return self.matrix + self.initial_displacement[0]

    @property
    def per_fourth_power(self) -> sp.csr_array | None:
        """Stiffness per ω⁴, ``K_uu``."""
        return None if self.initial_displacement is None else self.initial_displacement[1]

    def __repr__(self) -> str:
        names = ("by_loads", "initial_displacement")
        given = [f", {name}" for name in names if getattr(self, name) is not None]
        return f"Prestress({len(self.nodes)} nodes{''.join(given)})"
