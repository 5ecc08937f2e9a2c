"""Static responses beside the modes, to loads at the interfaces.

With them a basis is statically complete for these loads, which it lacks first. They tell what other
modes leave out: Rubin, "Improved component-mode representation", AIAA Journal 13 (1975). The error
of a basis is estimated with them (:mod:`exudyn_rotor.linear.modal.basis_error`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.reduction.component import rigid_columns, unit_columns
from exudyn_rotor.solid.model import clamped_coordinates
from exudyn_rotor.solid.rotor import FiniteElementRotor, Interface
from exudyn_rotor.solvers.inertia_relief import held_inverse, inertia_relief
from exudyn_rotor.theory.axis import coordinates, rigid_motions

# share of its motion by which an interface may deform and still be rigid on purpose (RBE2)
_RIGID = 1e-6
# residual of responses, share of the load: what a basis errs by is of second order in it
_TOLERANCE = 1e-8


def attachment_modes(rotor: FiniteElementRotor, others: np.ndarray) -> np.ndarray:
    """Return static responses to unit forces and moments at the interfaces, with inertia relief.

    Interfaces that the modes `others` (3n, k) keep rigid on purpose, or that are clamped, get no
    loads of their own. Where there are such, or the rotor's own stiffness holds it, responses to
    uniform linear and angular accelerations are among them, with these interfaces held. ValueError
    if the rotor has loose parts.
    """
    rigid = [one for one in rotor.interfaces.values() if _stays_rigid(one, others)]
    loads = [
        one.mean_motion(rotor.node_count).T.toarray()
        for one in rotor.interfaces.values()
        if one not in rigid and not is_clamped(rotor, one)
    ]
    if rigid or rotor.grounded:
        loads.append(rotor.mass @ rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass))
    responses = [np.zeros((rotor.nodes.size, 0))]
    if loads:
        responses.append(_static_responses(rotor, rigid, np.hstack(loads)))
    return unit_columns(rotor, np.hstack(responses))


def _static_responses(
    rotor: FiniteElementRotor, held: Sequence[Interface], loads: np.ndarray
) -> np.ndarray:
    """Return static responses (3n, k) to loads, with the nodes of interfaces held.

    By inertia relief where none is. The rigid motions of held interfaces, which modes that keep
    them rigid contain, complete the responses.
    """
    if not held:
        return inertia_relief(rotor).solve(loads, _TOLERANCE)
    nodes = np.concatenate([one.nodes for one in held])
    moving = np.setdiff1d(np.arange(rotor.node_count), nodes)
    columns, inner = np.zeros_like(loads), coordinates(moving)
    columns[inner] = held_inverse(rotor, moving).solve(loads[inner], _TOLERANCE)
    return columns


def is_clamped(rotor: FiniteElementRotor, interface: Interface) -> bool:
    """Return whether all nodes of an interface are held in all directions."""
    return bool(clamped_coordinates(rotor.stiffness).reshape(-1, 3)[interface.nodes].all())


def _stays_rigid(interface: Interface, modes: np.ndarray) -> bool:
    """Return whether no mode (3n, k) deforms an interface."""
    if modes.shape[1] == 0 or len(interface.nodes) < 3:
        return False
    motion = modes[coordinates(interface.nodes)]
    rigid = np.linalg.qr(rigid_motions(interface.positions, interface.center))[0]
    strain = np.linalg.norm(motion - rigid @ (rigid.T @ motion))
    return bool(strain <= _RIGID * np.linalg.norm(motion))
