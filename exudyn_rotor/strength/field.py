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
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.calls import user_level
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.plotting import draw_surface
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import Selection
from exudyn_rotor.results import Result, numbers, storable
from exudyn_rotor.solid.elements import von_mises
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

Nodes = slice | np.ndarray


@storable
@dataclass(frozen=True, eq=False)
class StressField(Result):
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

    Examples
    --------
    A bar under unit stress along z for a unit of its only modal coordinate:

    >>> import numpy as np
    >>> nodes = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> along = np.zeros((4, 6, 1))
    >>> along[:, 2] = 1.0
    >>> field = StressField(nodes, [[0, 1, 2]], along, rest=np.zeros((4, 6)), has_static=True)
    >>> print(field.at([2e6], speed=0.0)[0])
    [      0.       0. 2000000.       0.       0.       0.]
    """

    positions: np.ndarray = numbers("nodes", 3)
    triangles: np.ndarray = numbers("triangles", "corners", dtype=int, least=0)
    modes: np.ndarray = numbers("nodes", 6, "modes")
    rest: np.ndarray = numbers("nodes", 6)
    has_static: bool

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
        checks.instance(reduced, "reduced", ReducedRotor, "SolidRotor.reduce makes one")
        how = "select_modes(reduced, formulation) makes one, add_rotor the other"
        checks.instance(selection, "selection", (Selection, RotorBody), how)
        if isinstance(selection, RotorBody):
            selection = selection.selection
        if not selection.is_of(reduced):
            raise ValueError(
                f"selection: it is of another rotor, {selection.source!r}, than {reduced!r}; take "
                "the one that was added to the scene, or select_modes(reduced, formulation)"
            )
        rest = reduced.unshown_stress
        return cls(
            positions=reduced.shapes.nodes,
            triangles=reduced.shapes.triangles,
            modes=reduced.shapes.stress @ selection.T,
            rest=rest,
            has_static=getattr(reduced.centrifugal, "stress", None) is not None,
        )

    def at(self, modal_coordinates: ArrayLike, speed: float) -> np.ndarray:
        """Return the stress of modal coordinates (m,) at a spin speed.

        Parameters
        ----------
        modal_coordinates : array_like, shape (m,)
        speed : float
            Spin speed [rad/s].

        Returns
        -------
        ndarray, shape (n, 6)
            Components xx, yy, zz, yz, xz, xy in mesh axes [Pa].

        Raises
        ------
        TypeError
            If an argument is of another kind.
        ValueError
            If there is not one finite coordinate per mode.
        """
        speed = checks.number(speed, "speed", "rad/s")
        count = self.modes.shape[2]
        values = checks.vector(modal_coordinates, "modal_coordinates", size=count)
        return self.history(values[None], [speed])[0]

    def history(
        self, modal_coordinates: ArrayLike, speed: ArrayLike, nodes: Nodes = slice(None)
    ) -> np.ndarray:
        """Return the stress of (s, m) coordinates at s speeds (s, n, 6) [Pa]; see :meth:`at`."""
        shape = (None, self.modes.shape[2])
        values = checks.array(modal_coordinates, "modal_coordinates", shape=shape)
        speed = checks.one_or_each(speed, "speed", "rad/s", len(values))
        if not isinstance(nodes, slice):
            nodes = checks.whole_numbers(nodes, "nodes", most=len(self.positions) - 1)
        dynamic = np.einsum("nck,sk->snc", self.modes[nodes], values, optimize=True)
        return dynamic + (speed**2)[:, None, None] * self.rest[nodes]

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return a row for each modal coordinate; `units` change nothing."""
        Units.of(units)
        sizes = von_mises(np.moveaxis(self.modes, 2, 0))
        nodes = sizes.argmax(axis=1)
        return {
            "coordinate": np.arange(len(sizes)),
            "largest von Mises stress per unit [Pa]": sizes.max(axis=1),
            "node": nodes,
            **{f"{axis} [m]": self.positions[nodes, i] for i, axis in enumerate("xyz")},
        }

    def plot(self, modal_coordinates: ArrayLike, speed: float, ax: Axes3D | None = None) -> Axes3D:
        """Draw the von Mises stress on the surface [MPa]; see :meth:`at`.

        `ax` are 3D axes to draw in; those of a new figure by default.
        """
        stress = self.at(modal_coordinates, speed)
        warn_without_static(self, speed)
        label = "von Mises stress [MPa]"
        return draw_surface(self.positions, self.triangles, 1e-6 * von_mises(stress), label, ax)


def warn_without_static(field: StressField, speed: ArrayLike) -> None:
    """Warn where stress at speed lacks the static part."""
    fastest = np.max(np.abs(speed))
    if not field.has_static and fastest > 0.0:
        warnings.warn(
            f"stress at speeds up to {fastest:.6g} rad/s without the static centrifugal stress, "
            "which the modes show in part only; reduce the rotor with reduce(…, stress=True, "
            "prestress=True)",
            UserWarning,
            stacklevel=user_level(),
        )
