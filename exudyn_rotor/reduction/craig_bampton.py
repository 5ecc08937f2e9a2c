"""Hurty–Craig–Bampton modes: static modes of the interfaces and modes with fixed interfaces.

Source: Craig, Bampton, "Coupling of substructures for dynamic analyses", AIAA Journal 6 (1968).
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.reduction.attachment import is_clamped
from exudyn_rotor.reduction.component import ModeBasis, check_rotor, lowest_with_pairs, numbered
from exudyn_rotor.solid.model import rigid_basis
from exudyn_rotor.solid.rotor import FiniteElementRotor, Interface
from exudyn_rotor.solvers.constrained import ConstrainedInverse
from exudyn_rotor.solvers.inertia_relief import held_inverse, inertia_relief
from exudyn_rotor.theory.axis import coordinates, rigid_motions

# static modes, eigenvalues and eigenmodes
CoupledModes = tuple[np.ndarray, np.ndarray, np.ndarray]


def craig_bampton_modes(
    rotor: FiniteElementRotor,
    count: int,
    interfaces: Iterable[str] | None = None,
    *,
    coupling: str = "RBE2",
) -> ModeBasis:
    """Return static modes of the interfaces, then eigenmodes with the interfaces fixed.

    Every interface has three unit translations and three unit rotations of its reference point,
    about the mesh axes; an interface with a single node has the translations only. No motion
    is left out: together the static modes contain the rigid motions.

    Parameters
    ----------
    rotor : SolidRotor
    count : int
        Number of fixed-interface eigenmodes; may be zero.
    interfaces : iterable of str, optional
        Names of the rotor's interfaces to use; by default all but those that are clamped, whose
        motions are the springs' that hold them.
    coupling : {'RBE2', 'RBE3'}, optional
        'RBE2': the nodes of an interface move as one rigid body. 'RBE3': their weighted mean
        motion (:meth:`Interface.mean_motion`) is prescribed and the surface may deform.

    Returns
    -------
    ModeBasis
        Static modes in m/m and m/rad, labelled 'left translation x'; then mass-normalised
        eigenmodes in ascending order. Frequencies are NaN for static modes.

    Raises
    ------
    TypeError, ValueError
        If an interface or coupling is unknown, RBE2 interfaces share nodes, an interface has its
        nodes on one line, the interfaces do not hold the rotor, or there are fewer eigenmodes.

    Examples
    --------
    A unit mass on springs at another one, which is the interface:

    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, craig_bampton_modes
    >>> springs = 1e6 * np.kron([[1, -1], [-1, 1]], np.eye(3))
    >>> ends = [[0, 0, 0], [0, 0, 1]]
    >>> rotor = SolidRotor.from_matrices(np.eye(6), springs, ends, "z", interfaces={"hub": [0]})
    >>> modes = craig_bampton_modes(rotor, 1)
    >>> modes.labels
    ('hub translation x', 'hub translation y', 'hub translation z', 'eigenmode 1')
    >>> print(np.round(modes.frequencies))
    [  nan   nan   nan 1000.]
    """
    check_rotor(rotor)
    checks.count(count, "count")
    checks.choice(coupling, "coupling", _COUPLINGS)
    chosen = _choose(rotor, interfaces)
    static, values, eigenmodes = _COUPLINGS[coupling](rotor, count, chosen)
    labels = sum((_labels(interface) for interface in chosen), ()) + numbered("eigenmode", count)
    return ModeBasis(
        np.hstack([static, eigenmodes]),
        labels,
        rotor.nodes,
        frequencies=np.r_[np.full(static.shape[1], np.nan), np.sqrt(values)],
    )


def _choose(rotor: FiniteElementRotor, names: Iterable[str] | None) -> list[Interface]:
    known = rotor.interfaces
    if names is None:
        names = [name for name in known if not is_clamped(rotor, known[name])]
    names = checks.labels(names, "interfaces", known)
    if not names or len(set(names)) < len(names):
        raise ValueError(f"interfaces: name at least one, and each of them once; got {list(names)}")
    return [known[name] for name in names]


def _motion_count(interface: Interface) -> int:
    """Return 6, or 3 for a single node, which has no rotation."""
    count = rigid_basis(interface.positions).shape[1]
    if count == 5:
        raise ValueError(
            f"interface {interface.name!r} has its nodes on one line, so its rotation about the "
            "line is undefined; add a node off the line or use a single node"
        )
    return count


def _labels(interface: Interface) -> tuple[str, ...]:
    motions = ("translation", "rotation")
    names = [f"{interface.name} {motion} {axis}" for motion in motions for axis in "xyz"]
    return tuple(names[: _motion_count(interface)])


def _rigid_coupling(rotor: FiniteElementRotor, count: int, chosen: list[Interface]) -> CoupledModes:
    """Return static modes, eigenvalues and eigenmodes with rigid interfaces (RBE2)."""
    _refuse_shared_nodes(chosen)
    static = _rigid_interfaces(chosen, rotor.mass.shape[0])
    held = np.concatenate([interface.nodes for interface in chosen])
    nodes = np.setdiff1d(np.arange(len(rotor.nodes)), held)
    inner = coordinates(nodes)
    stiffness, mass = (matrix[inner][:, inner] for matrix in (rotor.stiffness, rotor.mass))
    try:
        inverse = held_inverse(rotor, nodes)
    except ValueError as error:
        raise ValueError(
            f"the interfaces do not hold the rotor, or it has loose parts ({error})"
        ) from error
    static[inner] = -inverse.solve((rotor.stiffness @ static)[inner])
    values, inner_modes = lowest_with_pairs(stiffness, mass, inverse, count)
    eigenmodes = np.zeros((rotor.mass.shape[0], count))
    eigenmodes[inner] = inner_modes
    return static, values, eigenmodes


def _mean_coupling(rotor: FiniteElementRotor, count: int, chosen: list[Interface]) -> CoupledModes:
    """Return static modes, eigenvalues and eigenmodes with prescribed mean motions (RBE3)."""
    rows = [
        interface.mean_motion(len(rotor.nodes))[: _motion_count(interface)] for interface in chosen
    ]
    constraints = sp.csr_array(sp.vstack(rows))
    inverse = ConstrainedInverse(inertia_relief(rotor), constraints)
    static = inverse.prescribe(np.eye(constraints.shape[0]))
    values, modes = lowest_with_pairs(rotor.stiffness, rotor.mass, inverse, count)
    return static, values, modes


_COUPLINGS = {"RBE2": _rigid_coupling, "RBE3": _mean_coupling}


def _rigid_interfaces(chosen: list[Interface], size: int) -> np.ndarray:
    """Return unit rigid motions of the interface nodes (size, modes), zero elsewhere."""
    blocks = []
    for interface in chosen:
        block = np.zeros((size, _motion_count(interface)))
        motions = rigid_motions(interface.positions, interface.reference)
        block[coordinates(interface.nodes)] = motions[:, : block.shape[1]]
        blocks.append(block)
    return np.hstack(blocks)


def _refuse_shared_nodes(chosen: list[Interface]) -> None:
    nodes, counts = np.unique(np.concatenate([one.nodes for one in chosen]), return_counts=True)
    if counts.max() > 1:
        node = nodes[np.argmax(counts)]
        names = [one.name for one in chosen if node in one.nodes]
        raise ValueError(
            f"interfaces {' and '.join(map(repr, names))} share node {node}, which cannot move "
            "rigidly with both; use coupling='RBE3' or separate the faces"
        )
