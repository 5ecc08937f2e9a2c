"""Stress at mesh nodes from modal coordinates and spin speed.

The modal coordinates of a running rotor hold the part of the static centrifugal deformation that
the modes can show, ``ζ₀ = K⁻¹h`` per ω². What they cannot show is added from the static solution:

    σ = Σ σ_k ζ_k + ω² (σ⁰ − Σ σ_k ζ₀_k)

with the stress σ_k of every mode and σ⁰ of the static centrifugal solution per ω².
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from exudyn_rotor.modes.selection import Selection
from exudyn_rotor.plots import draw_surface
from exudyn_rotor.reduced import ReducedRotor
from exudyn_rotor.solid.tensor import von_mises

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
    """

    positions: np.ndarray
    triangles: np.ndarray
    modes: np.ndarray
    rest: np.ndarray
    has_static: bool

    @classmethod
    def of(cls, reduced: ReducedRotor, selection: Selection) -> StressField:
        """Take the stress of `reduced` in the basis of a formulation.

        Parameters
        ----------
        reduced : ReducedRotor
            Reduced with ``stress=True``; with ``prestress=True`` the static stress is complete.
        selection : Selection
            ``body.selection`` of a rotor in a scene, or of :func:`exudyn_rotor.select_modes`.

        Raises
        ------
        ValueError
            If the rotor has no stress modes.
        """
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
        return cls(
            positions=reduced.shapes.nodes,
            triangles=reduced.shapes.triangles,
            modes=columns @ selection.T,
            rest=rest,
            has_static=static is not None,
        )

    def at(self, zeta: np.ndarray, speed: float, nodes: Nodes = slice(None)) -> np.ndarray:
        """Return the stress of modal coordinates (m,) at a spin speed [rad/s], (n, 6) [Pa]."""
        return self.modes[nodes] @ zeta + speed**2 * self.rest[nodes]

    def history(self, zeta: np.ndarray, speed: np.ndarray, nodes: Nodes) -> np.ndarray:
        """Return the stress of (s, m) coordinates at s speeds, shape (s, n, 6) [Pa]."""
        dynamic = np.einsum("nck,sk->snc", self.modes[nodes], zeta, optimize=True)
        return dynamic + (speed**2)[:, None, None] * self.rest[nodes]

    def plot(self, zeta: np.ndarray, speed: float) -> Figure:
        """Return a picture of the von Mises stress on the surface [MPa]."""
        values = 1e-6 * von_mises(self.at(zeta, speed))
        return draw_surface(self.positions, self.triangles, values, "von Mises stress [MPa]")


def _static_share(reduced: ReducedRotor) -> np.ndarray:
    """Return the static centrifugal modal coordinates ``ζ₀ = K⁻¹h`` per ω², shape (k,)."""
    offset = reduced.axis.project(reduced.center_of_mass) - reduced.center_of_mass
    load = reduced.invariants.moved(offset).h
    stiffness = np.diag(reduced.invariants.K)
    rigid = len(reduced.rigid)
    share = np.zeros(reduced.size)
    share[rigid:] = load[rigid:] / stiffness[rigid:]
    return share
