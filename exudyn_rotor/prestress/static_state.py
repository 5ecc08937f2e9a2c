"""Whether a prestress belongs to the static state of a rotor."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.prestress.static_solution import centrifugal_load, euler_load
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.rigid import lost_digits, unsupported_nodes
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers.inertia_relief import free_motions_of
from exudyn_rotor.theory.nodal import coupled, rotations

# share of the load by which an imported matrix may miss it, on positions and on rotations
_IMPORT_TOLERANCE = 0.01
# the same of a computed prestress, and how far rounding of the elastic forces goes: with full
# precision, and in terms of the digits that an export lost
_SAME = 1e-6
_ROUNDING = 1e-12
_LOST = 10.0
_COMPUTE = "compute the prestress with this rotor: rotor.prestress()"
_ALONE = (
    "it must hold the geometric stiffness alone (no spin softening, no elastic stiffness), for "
    "1 rad/s or 1 rad/s²"
)


def check_static_state(rotor: FiniteElementRotor, prestress: Prestress) -> None:
    """Refuse a prestress of another static state than the rotor's own."""
    if prestress.constant is None and prestress.constant_stress is not None:
        raise ValueError(
            "prestress: this is what another rotor carries, whose stiffness holds the stress at "
            f"rest already; {_COMPUTE[:-1]}stress=…)"
        )
    if prestress.load is None or prestress.displacement is None:
        _check_imported(rotor, prestress)
    else:
        _check_computed(rotor, prestress)
    _check_loads(rotor, prestress)
    if not rotor.grounded:
        _check_rotations(rotor, prestress)
        if prestress.hub is None or prestress.hub.size == 0:
            _check_strains(rotor, prestress)


def _check_computed(rotor: FiniteElementRotor, prestress: Prestress) -> None:
    """Compare load and displacement; forces of clamped nodes, which are alone, are not known."""
    load = centrifugal_load(rotor)
    change = np.linalg.norm(prestress.load - load)
    if change > _SAME * np.linalg.norm(load):
        raise ValueError(
            "prestress: it was computed for another centrifugal load, which differs by "
            f"{change / max(np.linalg.norm(load), 1e-300):.3g} of this rotor's own: another "
            f"density or axis, or point masses that were added or taken off; {_COMPUTE}"
        )
    if prestress.balanced:
        load = _balanced(rotor, load)
    stiffness, strength = rotor.stiffness, abs(rotor.stiffness)
    compared = coupled(stiffness).reshape(-1, 3)
    if prestress.hub is not None:
        compared[prestress.hub] = False
    if prestress.constant is not None:
        stiffness = stiffness + prestress.constant
    imbalance = np.linalg.norm((stiffness @ prestress.displacement - load)[compared.ravel()])
    precision = max(_ROUNDING, _LOST * lost_digits(rotor.nodes, rotor.stiffness))
    rounding = precision * np.linalg.norm(strength @ np.abs(prestress.displacement))
    size = np.linalg.norm(load)
    if imbalance > _SAME * size + rounding:
        raise ValueError(
            "prestress: its static displacement is none of this rotor, the elastic forces differ "
            f"from its load by {imbalance / max(size, 1e-300):.3g} of it (rounding of an exported "
            f"matrix explains {rounding / max(size, 1e-300):.1g}): another elastic modulus, other "
            f"clamped nodes, or other springs to the ground; {_COMPUTE}"
        )


def _check_imported(rotor: FiniteElementRotor, prestress: Prestress) -> None:
    """Refuse reactions of held nodes where the rotor can move."""
    if not prestress.balanced and rotor.rigid_motions:
        raise ValueError(
            "prestress: balanced=False says that held nodes take up the load, but the stiffness "
            f"of this rotor leaves {rotor.rigid_motions} rigid motions free, which their forces "
            "would resist falsely; hold them with rotor.clamped(...), or use a matrix computed "
            "with inertia relief"
        )


def _check_loads(rotor: FiniteElementRotor, prestress: Prestress) -> None:
    """Check ``K_G x = f``, which holds by ``∇x = I`` at nodes that no support or hub touches."""
    away = np.ones(rotor.node_count, dtype=bool)
    if rotor.grounded:
        away = unsupported_nodes(rotor.nodes, rotor.stiffness)
    if prestress.hub is not None:
        away[prestress.hub] = False
    positions = (rotor.nodes - rotor.center_of_mass).ravel()
    for name, matrix, load, resisted in _known_loads(rotor, prestress):
        expected = (_balanced(rotor, load) if prestress.balanced else load) - resisted
        difference = (matrix @ positions - expected).reshape(-1, 3)[away]
        error, size = np.linalg.norm(difference), np.linalg.norm(expected.reshape(-1, 3)[away])
        if error > _IMPORT_TOLERANCE * size + _SAME * np.linalg.norm(load):
            raise ValueError(
                f"prestress: the {name} times the nodal positions gives the load of its stress, "
                f"which is {error / max(size, 1e-300):.3g} times this rotor's own load off it at "
                f"nodes away from supports; {_ALONE}, with this rotor's axis, density, point "
                "masses and held nodes"
            )


def _known_loads(
    rotor: FiniteElementRotor, prestress: Prestress
) -> Iterator[tuple[str, sp.csr_array, np.ndarray, np.ndarray | float]]:
    """Yield name and matrix, the load behind it, and what a stress at rest resists of that.

    Of a free rotor the centrifugal load is left to :func:`_check_strains`: elements of other
    programs may balance it as a whole, and not at every node.
    """
    resists, displacement = prestress.constant, prestress.displacement
    if rotor.grounded:
        load = _acting(rotor, prestress)
        if resists is None:
            yield "matrix", prestress.matrix, load, 0.0
        elif displacement is not None:
            yield "matrix", prestress.matrix, load, resists @ displacement
    if prestress.euler is not None and resists is None:
        yield "Euler matrix", prestress.euler, euler_load(rotor), 0.0


def _check_strains(rotor: FiniteElementRotor, prestress: Prestress) -> None:
    """Refuse a matrix that resists uniform strains of a free rotor otherwise than its load does.

    K_G acts on each direction alike and ``K_G x = f``, so that ``(A x)ᵀ K_G (B x) = (A x) · (B f)``
    for all A and B; rotations are the part of this that the elastic stiffness does not resist.
    """
    positions = rotor.nodes - rotor.center_of_mass
    virial = positions.T @ _balanced(rotor, _acting(rotor, prestress)).reshape(-1, 3)
    fields = np.kron(positions, np.eye(3))
    resistance, expected = fields.T @ (prestress.matrix @ fields), np.kron(virial, np.eye(3))
    e = rotor.axis.direction
    error = np.abs(resistance - expected)
    worst = np.unravel_index(np.argmax(error), error.shape)
    if error[worst] > _IMPORT_TOLERANCE * abs(np.trace(virial) - e @ virial @ e):
        raise ValueError(
            "prestress: the matrix resists uniform strains of the whole rotor with "
            f"{resistance[worst]:.6g} kg m², and its centrifugal load per (rad/s)² with "
            f"{expected[worst]:.6g}; {_ALONE}, and no initial-displacement stiffness"
        )


def _check_rotations(rotor: FiniteElementRotor, prestress: Prestress) -> None:
    """Refuse a matrix that does not act on rotations of a free rotor as the load does.

    By equilibrium ``(a×x)ᵀ K_G (b×x) = (a×x) · (b×f)`` with f the balanced load.
    """
    turns = rotations(rotor.nodes, rotor.center_of_mass)
    load = _acting(rotor, prestress)
    load = (_balanced(rotor, load) if prestress.balanced else load).reshape(-1, 3)
    turned = np.stack([np.cross(axis, load).ravel() for axis in np.eye(3)], axis=1)
    expected, resistance = turns.T @ turned, turns.T @ (prestress.matrix @ turns)
    expected = 0.5 * (expected + expected.T)
    e = rotor.axis.direction
    error = np.abs(resistance - expected)
    i, j = np.unravel_index(np.argmax(error), error.shape)
    if error[i, j] > _IMPORT_TOLERANCE * abs(e @ expected @ e):
        raise ValueError(
            f"prestress: the matrix couples rotations about mesh axes {'xyz'[i]} and {'xyz'[j]} "
            f"with {resistance[i, j]:.6g} kg m², and the centrifugal load per (rad/s)² of this "
            f"rotor with {expected[i, j]:.6g}; {_ALONE}, and with this rotor's axis, density and "
            "point masses"
        )


def _acting(rotor: FiniteElementRotor, prestress: Prestress) -> np.ndarray:
    """Return the centrifugal load (3n,) per ω² with the reactions of supports."""
    load = centrifugal_load(rotor)
    return load if prestress.reactions is None else load + prestress.reactions


def _balanced(rotor: FiniteElementRotor, load: np.ndarray) -> np.ndarray:
    """Return a load (3n,) less the inertia forces of the rigid motions that it causes."""
    free = free_motions_of(rotor)
    return load - rotor.mass @ (free @ (free.T @ load))
