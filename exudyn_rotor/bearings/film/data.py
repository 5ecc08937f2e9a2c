"""What describes an oil film: sizes, oil, pads, and the grid it is solved on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.film.grid import Axial, Grid
from exudyn_rotor.bearings.film.pads import Pad
from exudyn_rotor.bearings.film.reynolds import CAVITATION

_PEAK = 4.5  # the pressure's peak, √(2 h_min/c) wide, holds three nodes


@dataclass(frozen=True, eq=False)
class FilmData:
    """Data of a film, checked; :class:`OilFilm` says what each is."""

    radius: float
    length: float
    viscosity: float
    pads: Sequence[Pad]
    cavitation: str = "reynolds"
    supply_pressure: float = 0.0
    nodes: int = 120
    axial_nodes: int = 12
    grid: Grid = field(init=False, repr=False)

    def __post_init__(self) -> None:
        checks.number(self.radius, "radius", "m", above=0.0)
        checks.number(self.length, "length", "m", above=0.0)
        checks.number(self.viscosity, "viscosity", "Pa s", above=0.0)
        checks.choice(self.cavitation, "cavitation", CAVITATION)
        checks.number(self.supply_pressure, "supply_pressure", "Pa", least=0.0)
        checks.count(self.nodes, "nodes", least=12, most=10_000)
        checks.count(self.axial_nodes, "axial_nodes", most=1000)
        if self.axial_nodes == 1:
            raise ValueError("axial_nodes: needs 0 (one profile), or 2 nodes or more, got 1")
        pads = _in_order(checks.instances(self.pads, "pads", Pad))
        widest = max(pad.clearance for pad in pads)
        if widest >= self.radius:
            raise ValueError(
                f"pads: need clearances far below the radius of {self.radius:g} m, got {widest:g} m"
            )
        if pads[0].closed and self.supply_pressure > 0.0:
            raise ValueError("supply_pressure: needs pads with a groove between them")
        if pads[0].closed and self.cavitation == "mass-conserving":
            raise ValueError(
                "cavitation: 'mass-conserving' needs pads with a groove between them, from which "
                "oil replaces what leaves at the ends; 'reynolds' needs none"
            )
        object.__setattr__(self, "pads", pads)
        half = 0.5 * self.length / self.radius
        axial = Axial.volumes(half, self.axial_nodes) if self.axial_nodes else Axial.profile(half)
        object.__setattr__(self, "grid", Grid(pads, self.nodes, axial))
        if self.clearance <= 0.0:
            raise ValueError("pads: their centers leave no clearance for a journal in the middle")

    @property
    def clearance(self) -> float:
        """Least thickness of the film about a journal in the middle [m]."""
        return float(self._heights(np.zeros(2))[0].min())

    @property
    def thinnest(self) -> float:
        """Thickness of the thinnest film that the grid still resolves [m]."""
        return _PEAK * float(self.grid.step.max()) ** 2 * self.clearance

    @property
    def reach_along(self) -> Callable[[np.ndarray, float], float]:
        """For bearings: how far that way, of length 1 (2,), to a thickness [m], unchecked."""
        return self._reach

    def _reach(self, direction: np.ndarray, thinnest: float) -> float:
        """Return how far the journal may go that way, of length 1 (2,), to a thickness [m]."""
        closing = (self.grid.u @ direction).ravel()
        room = (self.grid.offset - thinnest).ravel()
        near = closing > 0.0
        return float(np.min(room[near] / closing[near], initial=np.inf))

    def _heights(self, position: np.ndarray) -> np.ndarray:
        """Return h in the middle, at the left and the right face of each volume, (3, n) [m]."""
        return self.grid.offset - self.grid.u @ position


def _in_order(pads: tuple[Pad, ...]) -> tuple[Pad, ...]:
    """Return pads by their angle; ValueError if two overlap."""
    if not pads:
        raise ValueError("pads: needs one at least")
    ordered = sorted(pads, key=lambda pad: pad.start % (2.0 * np.pi))
    starts = np.array([pad.start % (2.0 * np.pi) for pad in ordered])
    arcs = np.array([pad.arc for pad in ordered])
    room = np.diff(starts, append=starts[0] + 2.0 * np.pi)
    if np.any(arcs > room * (1.0 + 1e-12)):
        raise ValueError(f"pads: overlap; starts {starts} rad, arcs {arcs} rad")
    return tuple(ordered)
