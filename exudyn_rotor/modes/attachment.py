"""Attachment modes: static responses to loads at the interfaces, which no finite set of modes has.

With them a basis is statically complete for loads at the interfaces. They tell what other modes
leave out: Rubin, "Improved component-mode representation", AIAA Journal 13 (1975).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor.modes.basis import rigid_columns
from exudyn_rotor.modes.component import ModeBasis
from exudyn_rotor.modes.relief import inertia_relief
from exudyn_rotor.nodal import rotations, translations

if TYPE_CHECKING:
    from exudyn_rotor.solid.interface import Interface
    from exudyn_rotor.solid.rotor import SolidRotor

# share of its motion by which an interface may deform and still be rigid on purpose (RBE2)
_RIGID = 1e-6


def attachment_modes(rotor: SolidRotor, others: np.ndarray) -> ModeBasis:
    """Return static responses to unit forces and moments at the interfaces, with inertia relief.

    A rotor that its own stiffness holds gets those to uniform accelerations, too.

    Parameters
    ----------
    rotor : SolidRotor
    others : ndarray, shape (3n, k)
        Modes that these are to go with. Interfaces that they keep rigid are left out: such modes
        hold all that rigid interfaces can do.

    Raises
    ------
    ValueError
        If the rotor has loose parts.
    """
    loads = [
        interface.mean_motion(rotor.node_count).T.toarray()
        for interface in rotor.interfaces.values()
        if not _kept_rigid(interface, others)
    ]
    if rotor.grounded:
        loads.append(rotor.mass @ rigid_columns(rotor.nodes, rotor.axis, rotor.center_of_mass))
    columns = np.hstack([np.zeros((rotor.nodes.size, 0)), *loads])
    if columns.shape[1]:
        columns = inertia_relief(rotor).solve(columns)
        norms = np.sqrt(np.einsum("ik,ik->k", columns, rotor.mass @ columns))
        columns = columns[:, norms > 0.0] / norms[norms > 0.0]
    labels = tuple(f"attachment mode {i + 1}" for i in range(columns.shape[1]))
    return ModeBasis(columns, labels, rotor.nodes)


def _kept_rigid(interface: Interface, modes: np.ndarray) -> bool:
    """Return True if no mode deforms the interface."""
    if modes.shape[1] == 0 or len(interface.nodes) == 1:
        return False
    motion = modes.reshape(-1, 3, modes.shape[1])[interface.nodes].reshape(-1, modes.shape[1])
    turns = rotations(interface.positions, interface.center)
    rigid = np.linalg.qr(np.hstack([translations(len(interface.nodes)), turns]))[0]
    strain = np.linalg.norm(motion - rigid @ (rigid.T @ motion))
    return bool(strain <= _RIGID * np.linalg.norm(motion))
