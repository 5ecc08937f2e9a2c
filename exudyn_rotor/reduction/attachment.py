"""Static responses beside the modes: to loads at interfaces, and to the inertia of turning modes.

With them a basis is statically complete for loads at the interfaces. They tell what other modes
leave out: Rubin, "Improved component-mode representation", AIAA Journal 13 (1975).

A motion ``c_f = Q q e^{λt}`` in the mass-orthonormal columns Q of a basis, ``QᵀKQ = Λ``, leaves in
the full equations (105) the forces

    r = (λ²M + λ(D + 2ΩMẽ) + K + Ω²(K_G + Mẽẽ)) Q q,    ẽẽ = eeᵀ − I.

Their part that does no work on Q is a combination of ``KQ − MQΛ``, ``MẽQ``, ``M eeᵀQ``, ``K_G Q``
and ``DQ``, each less ``MQ`` times its work on Q. The static responses ``K⁺L`` to these loads L are
what the basis lacks first: its error is estimated with them beside Q
(:mod:`exudyn_rotor.linear.modal.basis_error`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exudyn_rotor.reduction.component import rigid_columns, unit_columns
from exudyn_rotor.solid.model import clamped_coordinates
from exudyn_rotor.solid.rotor import FiniteElementRotor, Interface
from exudyn_rotor.solvers.inertia_relief import held_inverse, inertia_relief
from exudyn_rotor.theory.axis import coordinates, rigid_motions, turned

# share of its motion by which an interface may deform and still be rigid on purpose (RBE2)
_RIGID = 1e-6
# residual of responses, share of the load: what a basis errs by is of second order in it
_TOLERANCE = 1e-8
# speed of the rim beyond which no solid holds [m/s]
_RIM = 1000.0
# times the highest frequency of the basis, a speed that no rotor of few modes reaches
_ABOVE = 10.0
# strain energy of a response, over that of a mode, below which it is left out: by this share it
# could change the square of a frequency at that speed; a tenth of it at 300 m/s
_SMALL = 1e-3


def attachment_modes(rotor: FiniteElementRotor, others: np.ndarray) -> np.ndarray:
    """Return static responses to unit forces and moments at the interfaces, with inertia relief.

    Interfaces that the modes `others` (3n, k) keep rigid on purpose, or that are clamped, get no
    loads of their own. Where there are such, or the rotor's own stiffness holds it, responses to
    uniform linear and angular accelerations are among them, with these interfaces held. ValueError
    if the rotor has loose parts.
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
    return unit_columns(rotor, np.hstack(responses))


def static_responses(
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


def rigid_interfaces(rotor: FiniteElementRotor, modes: np.ndarray) -> list[Interface]:
    """Return the interfaces that no mode (3n, k) deforms."""
    return [one for one in rotor.interfaces.values() if _stays_rigid(one, modes)]


def _stays_rigid(interface: Interface, modes: np.ndarray) -> bool:
    if modes.shape[1] == 0 or len(interface.nodes) < 3:
        return False
    motion = modes[coordinates(interface.nodes)]
    rigid = np.linalg.qr(rigid_motions(interface.positions, interface.center))[0]
    strain = np.linalg.norm(motion - rigid @ (rigid.T @ motion))
    return bool(strain <= _RIGID * np.linalg.norm(motion))


def inertial_modes(
    rotor: FiniteElementRotor, others: np.ndarray, basis: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Return static responses to the loads of a turning rotor's modes, of unit strain energy.

    Only the independent ones that can matter. Interfaces that the modes `others` (3n, k) keep rigid
    stay so; `basis` is Q (3n, m) with the rigid motions, `stiffness` the diagonal Λ of ``QᵀKQ``.
    """
    momenta = rotor.mass @ basis
    loads = _loads(rotor, basis, momenta, stiffness)
    loads -= momenta @ (basis.T @ loads)
    loads = _strongest(rotor, loads, stiffness)
    responses = static_responses(rotor, rigid_interfaces(rotor, others), loads)
    energy = loads.T @ responses
    values, turn = np.linalg.eigh(0.5 * (energy + energy.T))
    strong = values > _SMALL
    return responses @ (turn[:, strong] / np.sqrt(values[strong]))


def _loads(
    rotor: FiniteElementRotor, basis: np.ndarray, momenta: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Return loads (3n, j), so large that their energy is a relative change of stiffness."""
    e, radii = rotor.axis.direction, np.linalg.norm(rotor.axis.radial(rotor.nodes), axis=1)
    highest = np.sqrt(stiffness.max(initial=0.0))
    speed = min(_ABOVE * highest, _RIM / max(radii.max(), 1e-300))  # the largest that counts
    gyroscopic = turned(e, momenta)  # Mẽ = ẽM, as (24) says
    along = momenta + turned(e, gyroscopic)
    loads = [speed * gyroscopic, speed * along]
    elastic = stiffness > 0.0
    frequencies = np.sqrt(stiffness[elastic])
    columns = basis[:, elastic]
    forces = rotor.stiffness @ columns - momenta[:, elastic] * stiffness[elastic]
    loads.append(forces / frequencies)
    carried = rotor.carried_prestress
    if carried is not None:
        loads.append(speed * (carried.per_square @ basis))
    if rotor.damping is not None:
        loads.append(rotor.damping @ columns)
    return np.hstack(loads)


def _strongest(rotor: FiniteElementRotor, loads: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Return the independent loads whose responses can have an energy that counts.

    Where all frequencies that are left out are above ω, ``LᵀK⁺L ≤ LᵀM⁻¹L/ω²``. Here ω is the median
    of those kept, and M is lumped.
    """
    elastic = stiffness[stiffness > 0.0]
    square = np.median(elastic) if elastic.size else 0.0
    scaled = loads / np.sqrt(rotor.mass.diagonal())[:, None]
    values, turn = np.linalg.eigh(scaled.T @ scaled)
    return loads @ turn[:, values > _SMALL * square]
