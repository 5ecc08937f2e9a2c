"""Component modes of a rotor at several spin speeds, for rotors that stiffen much by spinning."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.reduction.component import ModeBasis, check_count, check_rotor, free_modes
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers import modes as eigen
from exudyn_rotor.solvers.inertia_relief import InertiaRelief, Way
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.nodal import block_diagonal
from exudyn_rotor.theory.spin_terms import SpinTerms
from exudyn_rotor.theory.stiffening import Stiffening

_ACROSS = 1e-2  # share of its energy across the axis from which a mode feels Coriolis forces


def spinning_modes(
    rotor: FiniteElementRotor, count: int, speeds: Sequence[float], *, tolerance: float = 1e-10
) -> ModeBasis:
    """Return the lowest eigenmodes at rest and those at spin speeds, as one basis.

    At a speed Ω these are the modes φ of ``A = K + Ω²(K2 − ẽᵀMẽ) + Ω⁴K4``, and the static responses
    ``A⁻¹Mẽφ`` to the Coriolis forces of those that move across the axis: a blade that swings in
    the plane of rotation is stretched by them, and the stretch is far above all bending modes. A
    blade whose tension has changed its mode shapes needs fewer columns of this basis than of modes
    at rest. Modes of different speeds are much alike; :meth:`SolidRotor.reduce` makes them
    orthonormal and drops what is not new.

    Parameters
    ----------
    rotor : SolidRotor
        Carrying a prestress, see :meth:`SolidRotor.with_prestress`.
    count : int
        Number of flexible modes at rest and at each speed.
    speeds : sequence of float
        Spin speeds Ω > 0 [rad/s].
    tolerance : float, optional
        As in :func:`free_modes`.

    Returns
    -------
    ModeBasis
        Modes at rest first. A column at a speed has no frequency at rest, hence NaN.

    Raises
    ------
    TypeError, ValueError
        If the rotor carries no prestress, no speed is given or one is not positive, there are not
        that many modes, or the prestress makes the rotor unstable at a speed.

    Examples
    --------
    Two unit masses on springs; strings to the axis would give each the tension ``m Ω² r``.

    >>> import numpy as np
    >>> from exudyn_rotor import Prestress, SolidRotor, spinning_modes
    >>> nodes = [[1, 0, 0], [-1, 0, 0]]
    >>> rotor = SolidRotor.from_matrices(np.eye(6), 1e6 * np.eye(6), nodes, "z")
    >>> tension = Prestress.from_matrix(np.diag([0.0, 1, 1, 0, 1, 1]), nodes)
    >>> modes = spinning_modes(rotor.with_prestress(tension), 1, [100.0])
    >>> modes.labels[:2]
    ('eigenmode 1', 'mode 1 at 100 rad/s')
    """
    check_rotor(rotor)
    checks.tolerance(tolerance)
    checks.count(count, "count", least=1)
    speeds = checks.vector(speeds, "speeds", "rad/s", size=None)
    if speeds.size == 0 or np.any(speeds <= 0.0):
        raise ValueError(f"speeds: need a list of positive numbers [rad/s], got {speeds.tolist()}")
    if rotor.carried_prestress is None:
        raise ValueError(
            "spinning_modes: the rotor carries no prestress; use "
            "rotor.with_prestress(rotor.prestress())"
        )
    terms = _spin_terms(rotor)
    rest = free_modes(rotor, count, tolerance=tolerance)
    columns, labels = [rest.matrix], list(rest.labels)
    for speed in speeds:
        kinds = zip(
            ("mode", "Coriolis response"),
            _modes_at(rotor, terms, count, speed, tolerance),
            strict=True,
        )
        for name, shapes in kinds:
            columns.append(shapes)
            labels += [f"{name} {i + 1} at {speed:.6g} rad/s" for i in range(shapes.shape[1])]
    frequencies = np.full(len(labels), np.nan)
    frequencies[:count] = rest.frequencies
    return ModeBasis(np.hstack(columns), tuple(labels), rotor.nodes, frequencies)


def _spin_terms(rotor: FiniteElementRotor) -> SpinTerms:
    """Return the terms of the full model with its prestress, origin anywhere."""
    identity = sp.eye_array(rotor.nodes.size, format="csr")
    matrices = (rotor.mass, rotor.stiffness, None)
    invariants = Invariants.of(rotor.nodes, *matrices, identity, rotor.axis.direction)
    carried = rotor.carried_prestress
    K2 = carried.per_square
    return SpinTerms.of(invariants, Stiffening(K2, 0.0 * K2, carried.per_fourth_power))


def _modes_at(
    rotor: FiniteElementRotor, terms: SpinTerms, count: int, speed: float, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest modes at a speed, and the static responses to their Coriolis forces.

    There are as many more modes as rigid motions are free, which are among them.
    """
    wanted = count + rotor.rigid_motions
    check_count(wanted, 3 * rotor.node_count, smallest=1)
    stiffness = rotor.stiffness + terms.stiffness(speed)
    # softening takes at most Ω² from any eigenvalue, so that this is definite unless K_G buckles
    shifted = sp.csr_array(stiffness + 2.0 * speed**2 * rotor.mass)
    try:
        held = np.zeros((shifted.shape[0], 0))
        inverse = InertiaRelief(shifted, rotor.mass, held, Way.of(rotor))
    except ValueError as error:
        raise ValueError(
            f"at {speed:.6g} rad/s the compression by the static stress makes the rotor buckle "
            f"({error}); leave this speed out"
        ) from error
    if eigen.is_small(shifted.shape[0], wanted):
        _, modes = eigen.dense_modes(shifted.toarray(), rotor.mass.toarray(), wanted)
    else:
        _, modes = eigen.lowest_modes(shifted, rotor.mass, inverse, wanted, tolerance)
    modes = eigen.with_fixed_sign(modes)
    forces = terms.G @ modes
    # (ẽφ)ᵀMẽφ, the share of a mode's energy that moves across e
    turned = block_diagonal(rotor.axis.skew, rotor.node_count) @ modes
    share = np.einsum("ik,ik->k", turned, forces)
    return modes, inverse.solve(forces[:, share > _ACROSS])
