"""Static prestress of a spinning rotor, and the stiffness that it gives.

The centrifugal load per ω², ``f_c = M x_⊥``, deforms the rotor statically by u⁰ and stresses it by
σ⁰; vibrations about this state have the stiffness ``K + ω² K_G``,
``vᵀ K_G u = ∫ σ⁰ : (∇uᵀ∇v) dV``. Inertia relief balances the load where nothing holds the rotor.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.axis import read_only
from exudyn_rotor.modes.relief import InertiaRelief, free_rigid_motions
from exudyn_rotor.solid import checks
from exudyn_rotor.solid.tensor import von_mises

if TYPE_CHECKING:
    from exudyn_rotor.solid.rotor import SolidRotor

# a stress field in equilibrium loses a few per cent where it was averaged at nodes
_OUT_OF_BALANCE = 0.3


@dataclass(frozen=True, eq=False)
class Prestress:
    """Stiffness of a rotor from its static stress; made by :meth:`SolidRotor.prestress`.

    Attributes
    ----------
    matrix : scipy.sparse.csr_array, shape (3n, 3n)
        Stiffness per ω², ordered x0 y0 z0 x1 …: K_G of the centrifugal stress, with the
        initial-displacement stiffness if that was asked for [N s²/m].
    nodes : ndarray, shape (n, 3)
        Positions of the mesh it belongs to [m].
    euler : scipy.sparse.csr_array or None
        K_G per ω̇, of the stress by the Euler load ``−M ẽx`` [N s²/m].
    displacement : ndarray or None, shape (3n,)
        Static centrifugal displacement per ω², mesh axes [m s²].
    stress : ndarray or None, shape (n, 6)
        Its stress at the nodes per ω², xx, yy, zz, yz, xz, xy in mesh axes [Pa s²].
    constant : scipy.sparse.csr_array or None
        K_G of a stress that does not depend on the speed [N/m].
    initial_displacement : bool
        Whether `matrix` holds the initial-displacement stiffness.
    balanced : bool
        True if inertia forces balance the load on every rigid motion that the rotor's stiffness
        leaves free; False if clamped nodes take it up.
    yield_stress : float or None
        Yield stress of the material [Pa].
    """

    matrix: sp.csr_array
    nodes: np.ndarray
    euler: sp.csr_array | None = None
    displacement: np.ndarray | None = None
    stress: np.ndarray | None = None
    constant: sp.csr_array | None = None
    initial_displacement: bool = False
    balanced: bool = True
    yield_stress: float | None = None

    def __post_init__(self) -> None:
        for name in ("nodes", "displacement", "stress"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, read_only(getattr(self, name)))

    @classmethod
    def from_matrix(
        cls, matrix: Any, nodes: ArrayLike, euler: Any = None, *, balanced: bool = True
    ) -> Prestress:
        """Take the geometric stiffness of an imported model.

        Parameters
        ----------
        matrix : array_like or sparse, shape (3n, 3n)
            K_G of the centrifugal load for 1 rad/s, in the order of the rotor's matrices and
            without the spin softening ``−ẽᵀMẽ`` [N s²/m].
        nodes : array_like, shape (n, 3)
            Positions of the mesh, those of the rotor [m].
        euler : array_like or sparse, shape (3n, 3n), optional
            The same for the Euler load ``−M ẽx`` of an angular acceleration of 1 rad/s².
        balanced : bool, optional
            False if the stress was computed with nodes held fixed, not with inertia relief.

        Raises
        ------
        TypeError
            If an array does not hold numbers.
        ValueError
            If a shape does not fit, a matrix is not symmetric, or an entry is not finite.
        """
        positions = checks.as_nodes(nodes)
        return cls(
            matrix=checks.as_matrix("prestress matrix", matrix, len(positions)),
            nodes=positions,
            euler=None
            if euler is None
            else checks.as_matrix("Euler prestress matrix", euler, len(positions)),
            balanced=bool(balanced),
        )

    def __repr__(self) -> str:
        parts = [f"{len(self.nodes)} nodes"]
        parts += [name for name in ("euler", "constant") if getattr(self, name) is not None]
        parts += ["initial displacement"] if self.initial_displacement else []
        parts += [] if self.balanced else ["clamped"]
        return f"Prestress({', '.join(parts)})"


def static_prestress(
    rotor: SolidRotor,
    clamped: Sequence[str],
    initial_displacement: bool,
    euler: bool,
    stress: ArrayLike | None,
    yield_stress: float | None,
    speed: float | None,
) -> Prestress:
    """Return the prestress; parameters as :meth:`exudyn_rotor.SolidRotor.prestress`."""
    if rotor.elements is None:
        raise ValueError(
            "prestress: this rotor has no elements to assemble a geometric stiffness on; make it "
            "with SolidRotor.from_ngsolve, give the matrix of another program with "
            "Prestress.from_matrix, or use stiffening='tilt'"
        )
    _check_yield(yield_stress, speed)
    elements = rotor.elements
    own = None if stress is None else np.asarray(stress, dtype=float)
    residual = None if own is None else elements.load_of_stress(own)
    supported = rotor.clamped(clamped) if clamped else rotor
    rigid = free_rigid_motions(
        supported.nodes, supported.mass, supported.stiffness, supported.rigid_motions
    )
    relief = InertiaRelief(supported.stiffness, supported.mass, rigid)

    displacement = relief.solve(centrifugal_load(rotor))
    matrix = elements.geometric_stiffness(displacement)
    if initial_displacement:
        matrix = matrix + elements.initial_displacement_stiffness(displacement)
    constant = None
    if own is not None:
        springback = relief.solve(residual)
        own = _in_equilibrium(rotor, own, springback)
        constant = elements.geometric_stiffness_of_stress(np.asarray(stress, dtype=float))
        constant = constant - elements.geometric_stiffness(springback)
    by_spin = rotor.stress_recovery(displacement[:, None])[:, :, 0]
    if speed is not None:
        total = speed**2 * by_spin + (0.0 if own is None else own)
        _warn_of_yield(rotor.nodes, total, yield_stress, speed)
    return Prestress(
        matrix=_symmetric(matrix),
        nodes=rotor.nodes,
        euler=_symmetric(elements.geometric_stiffness(relief.solve(euler_load(rotor))))
        if euler
        else None,
        displacement=displacement,
        stress=by_spin,
        constant=None if constant is None else _symmetric(constant),
        initial_displacement=bool(initial_displacement),
        balanced=not clamped,
        yield_stress=yield_stress,
    )


def centrifugal_load(rotor: SolidRotor) -> np.ndarray:
    """Return ``f_c = M x_⊥``, the centrifugal nodal load per ω², shape (3n,)."""
    return rotor.mass @ rotor.axis.radial(rotor.nodes).ravel()


def euler_load(rotor: SolidRotor) -> np.ndarray:
    """Return ``−M ẽx``, the Euler nodal load per ω̇, shape (3n,)."""
    return -rotor.mass @ np.cross(rotor.axis.direction, rotor.nodes - rotor.axis.point).ravel()


def _symmetric(matrix: sp.csr_array) -> sp.csr_array:
    return checks.frozen(sp.csr_array(0.5 * (matrix + matrix.T)))


def _check_yield(yield_stress: float | None, speed: float | None) -> None:
    for name, value in (("yield_stress", yield_stress), ("speed", speed)):
        if value is not None and not (np.isfinite(value) and value > 0.0):
            raise ValueError(f"{name}: must be a positive number, got {value!r}")
    if speed is not None and yield_stress is None:
        raise ValueError("speed: only serves the check of yielding; give yield_stress=, too")


def _in_equilibrium(rotor: SolidRotor, stress: np.ndarray, springback: np.ndarray) -> np.ndarray:
    """Return a stress (n, 6) less the part that no load balances; warn if that is much of it."""
    part = rotor.stress_recovery(springback[:, None])[:, :, 0]
    share = np.linalg.norm(part) / max(np.linalg.norm(stress), 1e-300)
    if share > _OUT_OF_BALANCE:
        warnings.warn(
            f"stress: {share:.0%} of it is not in equilibrium without external load and was left "
            "out; a thermal stress must have the thermal strain taken off, C : (ε − ε_T)",
            UserWarning,
            stacklevel=4,
        )
    return stress - part


def _warn_of_yield(
    nodes: np.ndarray, stress: np.ndarray, yield_stress: float, speed: float
) -> None:
    values = von_mises(stress)
    worst = int(np.argmax(values))
    if values[worst] > yield_stress:
        place = ", ".join(f"{x:.4g}" for x in nodes[worst])
        warnings.warn(
            f"at {speed:.6g} rad/s the static von Mises stress is {values[worst]:.4g} Pa at node "
            f"{worst} ({place}) m, above yield_stress={yield_stress:.4g} Pa; the prestress is "
            "elastic and holds below that only",
            UserWarning,
            stacklevel=4,
        )
