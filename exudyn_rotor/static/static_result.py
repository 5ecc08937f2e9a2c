"""Deflection, reactions and stress under loads that stand still."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear.response.response import AtPlaces
from exudyn_rotor.plotting import axes_or_new, legend_above
from exudyn_rotor.results import numbers, storable, text_table, words
from exudyn_rotor.solid.elements import von_mises
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SLICES = 40  # of a rotor along its axis, whose mean displacements are drawn


@storable
@dataclass(frozen=True, eq=False)
class StaticResponse(AtPlaces):
    """Equilibrium of a rotor under loads that stand still; made by :func:`static_response`.

    Vectors are along (n1, n2, e) of :attr:`SpinAxis.plane`, in axes that stand still or turn with
    the rotor; the rotor is seen at the spin angle 0.

    Attributes
    ----------
    places : tuple of str, shape (p,)
        Interfaces and 'node 12'.
    motion : ndarray, shape (p, 6)
        Displacement [m] and rotation [rad]; rotations of a node are NaN.
    supports : tuple of str, shape (b,)
        Interfaces of the supports in the order in which they were given, then couplings.
    reactions : ndarray, shape (b, 6)
        Force [N] and moment [N m] of each support on the rotor.
    journals : ndarray, shape (b, 6)
        Displacement [m] and rotation [rad] of the rotor in each support.
    heights : ndarray, shape (p,)
        Positions of the places along the axis, from the origin of the mesh [m]; NaN of a point of a
        foundation that is no interface.
    support_heights : ndarray, shape (b,)
    speed : float
        Spin speed [rad/s].
    frame : {'inertial', 'rotor'}
        Axes in which the loads stand still.
    basis_errors : ndarray, shape (p,), or None
        Estimated relative errors by the basis of a reduced rotor; None where they are not known.
    nodes, displacement : ndarray, shape (n, 3), or None
        Mesh nodes and their displacement, mesh axes [m]; None of several rotors, and of a rotor
        that was reduced without its shapes.
    axes : ndarray, shape (3, 3)
        (n1, n2, e) as columns, mesh coordinates.
    stress : ndarray, shape (n, 6), or None
        xx, yy, zz, yz, xz, xy at the nodes in mesh axes [Pa], where it was asked for.

    Examples
    --------
    Two masses of 2 kg on a rod, each on a spring of 2e4 N/m:

    >>> from exudyn_rotor import Support, rotor_example, static_response
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> found = static_response(rotor, gravity=[0.0, -9.81, 0.0], supports=supports)
    >>> print(found.reactions[:, 1].round(6))
    [19.62 19.62]
    """

    motion: np.ndarray = numbers("places", 6, finite=False)
    supports: tuple[str, ...] = words("supports")
    reactions: np.ndarray = numbers("supports", 6)
    journals: np.ndarray = numbers("supports", 6)
    heights: np.ndarray = numbers("places", finite=False)
    support_heights: np.ndarray = numbers("supports")
    axes: np.ndarray = numbers(3, 3)
    speed: float
    frame: str = checks.one_of(FRAMES, default="inertial")
    basis_errors: np.ndarray | None = numbers("places", optional=True)
    nodes: np.ndarray | None = numbers("nodes", 3, optional=True)
    displacement: np.ndarray | None = numbers("nodes", 3, optional=True)
    stress: np.ndarray | None = numbers("nodes", 6, optional=True)

    def deflection(self, place: str | None = None) -> np.ndarray:
        """Return the displacement along (n1, n2, e) of a place, the first by default, (3,) [m]."""
        return self.motion[self._at(place), :3].copy()

    def rotation(self, place: str | None = None) -> np.ndarray:
        """Return the rotation about (n1, n2, e) of a place, the first by default, (3,) [rad]."""
        return self.motion[self._at(place), 3:].copy()

    def reaction(self, support: str | None = None) -> np.ndarray:
        """Return force [N] and moment [N m] of a support on the rotor, the first by default, (6,).

        Along and about (n1, n2, e). The load on the support, as a bearing's `load`, is less that.
        """
        return self.reactions[self._support(support)].copy()

    def journal(self, support: str | None = None) -> np.ndarray:
        """Return where the rotor rests in a support, the first by default, (2,) [m]."""
        return self.journals[self._support(support), :2].copy()

    @property
    def von_mises(self) -> np.ndarray:
        """Von Mises stress at the nodes (n,) [Pa].

        Raises
        ------
        ValueError
            Without stress: ``static_response(…, stress=True)`` finds it.
        """
        if self.stress is None:
            raise ValueError("stress: was not asked for; use static_response(…, stress=True)")
        return von_mises(self.stress)

    def _support(self, name: str | None) -> int:
        known = self.supports
        return 0 if name is None and known else known.index(checks.choice(name, "support", known))

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return a row for every place and every support; `units` change nothing."""
        Units.of(units)
        kinds = ["displacement"] * len(self.places) + ["reaction"] * len(self.supports)
        values = np.vstack([self.motion, self.reactions])
        columns = {"what": np.array(kinds), "at": np.array([*self.places, *self.supports])}
        return columns | _six(values, "{} [m or N]", "about {} [rad or N m]")

    def table(self, units: str = "rpm") -> str:
        """Return deflections and reactions as text, the speed in `units`: 'rpm', 'Hz' or 'SI'."""
        unit = Units.of(units)
        at = f"{unit.speeds(self.speed):.6g} {unit.speed}" if self.speed else "rest"
        frame = "" if self.frame == "inertial" else ", in axes that turn with the rotor"
        places, supports = {"place": np.array(self.places)}, {"support": np.array(self.supports)}
        places |= _six(self.motion, "{} [m]", "about {} [rad]")
        supports |= _six(self.reactions, "reaction {} [N]", "about {} [N m]")
        lines = [f"static response at {at}{frame}", *text_table(places)]
        return "\n".join([*lines, *text_table(supports)] if self.supports else lines)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the deflection across the axis over the position along it, and the supports.

        The line is the mean displacement of the mesh's sections where it is known.
        """
        ax = axes_or_new(ax)
        z, lateral = self._centre_line()
        for i, name in enumerate(("n1", "n2")):
            [line] = ax.plot(z, 1e6 * lateral[:, i], label=f"along {name}")
            ax.plot(self.heights, 1e6 * self.motion[:, i], "o", ms=4, color=line.get_color())
        if self.supports:
            base = np.zeros(len(self.supports))
            ax.plot(self.support_heights, base, "k^", ms=8, label="supports", zorder=0)
        ax.axhline(0.0, color="0.7", lw=0.8, zorder=0)
        ax.set(xlabel="position along the axis [m]", ylabel="deflection [µm]")
        legend_above(ax, 3)
        return ax

    def _centre_line(self) -> tuple[np.ndarray, np.ndarray]:
        """Return positions along the axis and the displacement across it there, (s, 2)."""
        if self.nodes is None:
            order = np.argsort(self.heights, kind="stable")
            return self.heights[order], self.motion[order, :2]
        along = self.nodes @ self.axes[:, 2]
        edges = np.linspace(along.min(), along.max(), _SLICES + 1)[1:-1]
        index = np.searchsorted(edges, along)
        values = np.column_stack([along, self.displacement @ self.axes[:, :2]])
        means = np.array([values[index == i].mean(axis=0) for i in np.unique(index)])
        return means[:, 0], means[:, 1:]


def _six(values: np.ndarray, along: str, about: str) -> dict[str, np.ndarray]:
    """Return values (r, 6) along and about the axes as columns."""
    names = [kind.format(axis) for kind in (along, about) for axis in ("n1", "n2", "e")]
    return dict(zip(names, values.T + 0.0, strict=True))  # no zero is negative
