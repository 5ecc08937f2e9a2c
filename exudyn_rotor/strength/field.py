"""Stress at mesh nodes from modal coordinates and spin speed.

The modal coordinates of a running rotor hold the part of the static centrifugal deformation that
the modes can show, ``ζ₀ = K⁻¹h`` per ω². What they cannot show is added from the static solution:

    σ = σ_r + Σ σ_k ζ_k + ω² (σ⁰ − Σ σ_k ζ₀_k)

with the stress σ_k of every mode, σ⁰ of the static centrifugal solution per ω², and σ_r at rest.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from exudyn_rotor.plotting import draw_surface
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import Selection
from exudyn_rotor.solid.tensor import von_mises

if TYPE_CHECKING:
    from exudyn_rotor.multibody.rotor_body import RotorBody

Nodes = slice | np.ndarray


@dataclass(frozen=True, eq=False)
class StressField:
    """Stress of a rotor in one formulation; made by :meth:`of`.

    Attributes
    ----------
    positions : ndarray, shape (n, 3)
        Mesh nodes, mesh coordinates [m].
    triangles : ndarray of int, shape (t, 3) or (t, 6)
        Surface of the rotor.
    modes : ndarray, shape (n, 6, m)
        Stress of every modal coordinate, xx, yy, zz, yz, xz, xy in mesh axes [Pa].
    rest : ndarray, shape (n, 6)
        Static stress per ω² that the modes do not show [Pa s²]; zero without a prestress.
    has_static : bool
        Whether the rotor was reduced with a prestress, so that the static stress is complete.
    constant : ndarray, shape (n, 6)
        Stress at rest [Pa]; zero unless the prestress was given one.
    """

    positions: np.ndarray
    triangles: np.ndarray
    modes: np.ndarray
    rest: np.ndarray
    has_static: bool
    constant: np.ndarray

    @classmethod
    def of(cls, reduced: ReducedRotor, selection: Selection | RotorBody) -> StressField:
        """Take the stress of `reduced` in the basis of a formulation.

        Parameters
        ----------
        reduced : ReducedRotor
            Reduced with ``stress=True``; with ``prestress=True`` the static stress is complete.
        selection : Selection or RotorBody
            Of :func:`exudyn_rotor.select_modes` for `reduced`, or the rotor in a scene that was
            added from it.

        Raises
        ------
        TypeError
            If an argument is of another kind.
        ValueError
            If the rotor has no stress modes, or the selection is of another rotor.
        """
        selection = _selection_of(reduced, selection)
        if reduced.shapes is None or reduced.shapes.stress is None:
            raise ValueError(
                "stress: the rotor was reduced without stress modes; use reduce(…, stress=True) "
                "with a model from NGSolve, and keep the shapes"
            )
        columns = reduced.shapes.stress
        static = getattr(reduced.centrifugal, "stress", None)
        rest = np.zeros(columns.shape[:2])
        if static is not None:
            rest = static - columns @ _static_share(reduced)
        constant = getattr(reduced.centrifugal, "constant_stress", None)
        return cls(
            positions=reduced.shapes.nodes,
            triangles=reduced.shapes.triangles,
            modes=columns @ selection.T,
            rest=rest,
            has_static=static is not None,
            constant=np.zeros(columns.shape[:2]) if constant is None else constant,
        )

    def at(self, zeta: np.ndarray, speed: float, nodes: Nodes = slice(None)) -> np.ndarray:
        """Return the stress of modal coordinates (m,) at a spin speed [rad/s], (n, 6) [Pa]."""
        zeta, count = np.asarray(zeta, dtype=float), self.modes.shape[2]
        if zeta.shape != (count,):
            raise ValueError(
                f"zeta: needs {count} modal coordinates, shape ({count},), got the shape "
                f"{zeta.shape}; rows over time go to stress_history"
            )
        return self.constant[nodes] + speed**2 * self.rest[nodes] + self.modes[nodes] @ zeta

    def history(self, zeta: np.ndarray, speed: np.ndarray, nodes: Nodes) -> np.ndarray:
        """Return the stress of (s, m) coordinates at s speeds, shape (s, n, 6) [Pa]."""
        dynamic = np.einsum("nck,sk->snc", self.modes[nodes], zeta, optimize=True)
        return dynamic + self.constant[nodes] + (speed**2)[:, None, None] * self.rest[nodes]

    def plot(self, zeta: np.ndarray, speed: float) -> Figure:
        """Return a picture of the von Mises stress on the surface [MPa]."""
        warn_without_static(self, speed)
        values = 1e-6 * von_mises(self.at(zeta, speed))
        return draw_surface(self.positions, self.triangles, values, "von Mises stress [MPa]")


def warn_without_static(field: StressField, speed: ArrayLike) -> None:
    """Warn where stress at speed lacks the static part; called by what a user calls."""
    fastest = np.max(np.abs(speed))
    if field.has_static or fastest == 0.0:
        return
    warnings.warn(
        f"stress at speeds up to {fastest:.6g} rad/s without the static centrifugal stress, which "
        "the modes show in part only; reduce the rotor with reduce(…, stress=True, prestress=True)",
        UserWarning,
        stacklevel=3,
    )


def _selection_of(reduced: ReducedRotor, given: Selection | RotorBody) -> Selection:
    """Return the selection given as such or by its rotor body, checked against `reduced`."""
    if not isinstance(reduced, ReducedRotor):
        raise TypeError(
            f"reduced: expected a ReducedRotor, got {type(reduced).__name__}; SolidRotor.reduce "
            "makes one"
        )
    selection = getattr(given, "selection", given)
    if not isinstance(selection, Selection):
        raise TypeError(
            "selection: expected what select_modes(reduced, formulation) returns, or a RotorBody, "
            f"got {type(given).__name__}"
        )
    if not selection.is_of(reduced):
        raise ValueError(
            f"selection: it is of another rotor, {selection.source!r}, than {reduced!r}; take the "
            "one that was added to the scene, or select_modes(reduced, formulation)"
        )
    return selection


def _static_share(reduced: ReducedRotor) -> np.ndarray:
    """Return the static centrifugal modal coordinates ``ζ₀ = K⁻¹h`` per ω², shape (k,)."""
    offset = reduced.axis.project(reduced.center_of_mass) - reduced.center_of_mass
    load = reduced.invariants.moved(offset).h
    stiffness = np.diag(reduced.invariants.K)
    rigid = len(reduced.rigid)
    share = np.zeros(reduced.size)
    share[rigid:] = load[rigid:] / stiffness[rigid:]
    return share
