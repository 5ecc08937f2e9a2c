"""Attachment modes: static responses to loads at the interfaces, which no finite set of modes has.

With them a basis is statically complete for loads at the interfaces. They tell what other modes
leave out: Rubin, "Improved component-mode representation", AIAA Journal 13 (1975).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.reduction.basis import rigid_columns
from exudyn_rotor.reduction.component import ModeBasis
from exudyn_rotor.solid.clamp import clamped_coordinates
from exudyn_rotor.solid.interface import Interface
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers.choice import coordinates
from exudyn_rotor.solvers.inertia_relief import held_inverse, inertia_relief
from exudyn_rotor.theory.nodal import rotations, translations

# share of its motion by which an interface may deform and still be rigid on purpose (RBE2)
_RIGID = 1e-6
# residual of responses, share of the load: what a basis errs by is of second order in it
_TOLERANCE = 1e-8


def attachment_modes(rotor: FiniteElementRotor, others: np.ndarray) -> ModeBasis:
    """Return static responses to unit forces and moments at the interfaces, with inertia relief.

    Parameters
    ----------
    rotor : SolidRotor
    others : ndarray, shape (3n, k)
        Modes that these are to go with. Interfaces that they keep rigid on purpose, or that are
        clamped, get no loads of their own. Where there are such, or the rotor's own stiffness holds
        it, responses to uniform linear and angular accelerations are among them, with these
        interfaces held: with the rigid motions of interfaces that ``craig_bampton_modes`` has, that
        is the same as inertia relief.

    Raises
    ------
    ValueError
        If the rotor has loose parts.
    """
    rigid = rigid_interfaces(rotor, others)
    loads = [
        one.mean_motion(rotor.node_count).T.toarray()
        for one in rotor.interfaces.values()
        if one not in rigid and not is_clamped(rotor, one)
    ]
    if rigid or rotor.grounded:
        loads.append(rotor.mass @ rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass))
    responses = [np.zeros((rotor.nodes.size, 0))]
    if loads:
        responses.append(static_responses(rotor, rigid, np.hstack(loads)))
    columns = np.hstack(responses)
    norms = np.sqrt(np.einsum("ik,ik->k", columns, rotor.mass @ columns))
    columns = columns[:, norms > 0.0] / norms[norms > 0.0]
    labels = tuple(f"attachment mode {i + 1}" for i in range(columns.shape[1]))
    return ModeBasis(columns, labels, rotor.nodes)


def static_responses(
    rotor: FiniteElementRotor, held: Sequence[Interface], loads: np.ndarray
) -> np.ndarray:
    """Return static responses (3n, k) to loads, with the nodes of interfaces held.

    By inertia relief where none is. The rigid motions of held interfaces, which modes that keep
    them rigid contain, complete the responses.

    Raises
    ------
    ValueError
        If the rotor has loose parts.
    """
    if not held:
        return inertia_relief(rotor).solve(loads, _TOLERANCE)
    nodes = np.concatenate([one.nodes for one in held])
    moving = np.setdiff1d(np.arange(rotor.node_count), nodes)
    columns = np.zeros_like(loads)
    columns[coordinates(moving)] = held_inverse(rotor, moving).solve(
        loads[coordinates(moving)], _TOLERANCE
    )
    return columns


def is_clamped(rotor: FiniteElementRotor, interface: Interface) -> bool:
    """Return whether all nodes of an interface are held in all directions."""
    return bool(clamped_coordinates(rotor.stiffness).reshape(-1, 3)[interface.nodes].all())


def rigid_interfaces(rotor: FiniteElementRotor, modes: np.ndarray) -> list[Interface]:
    """Return the interfaces that no mode (3n, k) deforms."""
    return [one for one in rotor.interfaces.values() if _stays_rigid(one, modes)]


def _stays_rigid(interface: Interface, modes: np.ndarray) -> bool:
    """Return True if no mode deforms the interface."""
    if modes.shape[1] == 0 or len(interface.nodes) < 3:
        return False
    motion = modes.reshape(-1, 3, modes.shape[1])[interface.nodes].reshape(-1, modes.shape[1])
    turns = rotations(interface.positions, interface.center)
    rigid = np.linalg.qr(np.hstack([translations(len(interface.nodes)), turns]))[0]
    strain = np.linalg.norm(motion - rigid @ (rigid.T @ motion))
    return bool(strain <= _RIGID * np.linalg.norm(motion))
