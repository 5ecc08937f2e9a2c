"""Static responses to what the modes of a basis leave unbalanced in a turning rotor.

A motion ``c_f = Q q e^{λt}`` in the columns Q of a basis leaves, in the full equations (105), the
forces

    r = (λ²M + λ(D + 2ΩMẽ) + K + Ω²(K_G + Mẽẽ)) Q q,    ẽẽ = eeᵀ − I.

For a mass-orthonormal basis that diagonalises K (``QᵀKQ = Λ``) the part of r that does no work on
Q is a combination of the columns of

    KQ − MQΛ,   MẽQ,   M eeᵀQ,   K_G Q,   DQ

(with K_u beside K_G where that is carried), each less ``MQ`` times its work on Q. The static
responses ``K⁺L`` to these loads L, with those to loads at the interfaces
(:mod:`exudyn_rotor.reduction.attachment`), are what the basis lacks first: the lowest left-out
modes, weighted by how much the motions in the basis excite them. Beside Q they make a finer rotor,
and by it the error of the basis is estimated (:mod:`exudyn_rotor.linear.modal.basis_error`).
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.reduction.attachment import rigid_interfaces, static_responses
from exudyn_rotor.reduction.component import ModeBasis
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.theory.nodal import turned

# speed of the rim beyond which no solid holds [m/s]
_RIM = 1000.0
_ABOVE = (
    10.0  # times the highest frequency of the basis, a speed that no rotor of few modes reaches
)
# strain energy of a response, over that of a mode, below which it is left out: by this share it
# could change the square of a frequency at that speed; a tenth of it at 300 m/s
_SMALL = 1e-3


def inertial_modes(
    rotor: FiniteElementRotor, others: np.ndarray, basis: np.ndarray, stiffness: np.ndarray
) -> ModeBasis:
    """Return static responses to the loads of a turning rotor's modes.

    Parameters
    ----------
    rotor : SolidRotor
    others : ndarray, shape (3n, k)
        Component modes that these are to go with; interfaces that they keep rigid stay so.
    basis : ndarray, shape (3n, m)
        Mass-orthonormal basis Q of the rotor, rigid motions included.
    stiffness : ndarray, shape (m,)
        Diagonal Λ of ``QᵀKQ`` [1/s²].

    Returns
    -------
    ModeBasis
        Only the independent responses that can matter, of unit strain energy.

    Raises
    ------
    ValueError
        If the rotor has loose parts.
    """
    momenta = rotor.mass @ basis
    loads = _loads(rotor, basis, momenta, stiffness)
    loads -= momenta @ (basis.T @ loads)
    loads = _strongest(rotor, loads, stiffness)
    responses = static_responses(rotor, rigid_interfaces(rotor, others), loads)
    energy = loads.T @ responses
    values, turn = np.linalg.eigh(0.5 * (energy + energy.T))
    strong = values > _SMALL
    columns = responses @ (turn[:, strong] / np.sqrt(values[strong]))
    labels = tuple(f"inertial mode {i + 1}" for i in range(columns.shape[1]))
    return ModeBasis(columns, labels, rotor.nodes)


def _loads(
    rotor: FiniteElementRotor, basis: np.ndarray, momenta: np.ndarray, stiffness: np.ndarray
) -> np.ndarray:
    """Return loads (3n, j), so large that their energy is a relative change of stiffness."""
    e, speed = rotor.axis.direction, _fastest(rotor, stiffness)
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
    if rotor.structural_damping is not None:
        loads.append((rotor.structural_damping @ columns) / frequencies)
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


def _fastest(rotor: FiniteElementRotor, stiffness: np.ndarray) -> float:
    """Return the largest speed that counts [rad/s]: of a solid's rim, or far above the modes."""
    radius = np.linalg.norm(rotor.axis.radial(rotor.nodes), axis=1).max()
    highest = np.sqrt(stiffness.max(initial=0.0))
    return float(min(_ABOVE * highest, _RIM / max(radius, 1e-300)))
