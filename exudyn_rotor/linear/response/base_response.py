"""Motion of a rotor over time while a record shakes the ground: analysis and result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import exudyn
import numpy as np

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.linear.model.build import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.response.loads import At, checked_places, places
from exudyn_rotor.linear.response.response import DIRECTIONS
from exudyn_rotor.linear.response.shaken_rotor import ShakenRotor
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@storable
@dataclass(frozen=True, eq=False)
class BaseResponse(Result):
    """Motion against the ground over time, along and about (n1, n2, e), inertial axes.

    Attributes
    ----------
    places : tuple of str
    time : ndarray, shape (t,)
        So close that straight lines between them are within 1 % of the largest displacement [s].
    motion : ndarray, shape (t, p, 6)
        Displacement [m] and rotation [rad]; NaN for rotations of mesh nodes.
    speed : float
        Spin speed [rad/s].

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import BaseResponse
    >>> motion = np.zeros((3, 1, 6))
    >>> motion[1, 0, :2] = 3e-6, 4e-6
    >>> print(BaseResponse(("left",), [0.0, 0.1, 0.2], motion, 50.0).table())
    largest motion against the ground at 477.465 rpm
    place                     n1 [m]      n2 [m]       e [m]  across [m]  at [s]
    left                   3.000e-06   4.000e-06   0.000e+00   5.000e-06  0.1
    """

    places: tuple[str, ...] = words("places")
    time: np.ndarray = numbers("steps")
    motion: np.ndarray = numbers("steps", "places", 6, finite=False)
    speed: float = 0.0

    def displacement(self, place: str) -> np.ndarray:
        """Return the displacement of a place over time, shape (t, 3) [m]."""
        return self._moved(place, "place")

    def between(self, place: str, other: str) -> np.ndarray:
        """Return the displacement of a place against another, shape (t, 3) [m].

        Of a journal against its foundation: ``between("left", "left (foundation)")``.
        """
        return self._moved(place, "place") - self._moved(other, "other")

    def peak(self, place: str, other: str | None = None) -> tuple[float, float]:
        """Return the largest displacement across the axis [m], and its time [s].

        Against another place, if one is named.
        """
        moved = self.displacement(place) if other is None else self.between(place, other)
        across = np.hypot(moved[:, 0], moved[:, 1])
        return float(across.max()), float(self.time[np.argmax(across)])

    def table(self, *, units: str = "rpm") -> str:
        """Return the largest values of every place as text; `units` are 'rpm', 'Hz' or 'SI'."""
        shown = Units.of(units)
        lines = [
            f"largest motion against the ground at {shown.speeds(self.speed):g} {shown.speed}",
            "place                     n1 [m]      n2 [m]       e [m]  across [m]  at [s]",
        ]
        for place in self.places:
            most = np.abs(self.displacement(place)).max(axis=0)
            across, time = self.peak(place)
            values = "".join(f"{value:12.3e}" for value in (*most, across))
            lines.append(f"{place:20}{values}  {time:.6g}")
        return "\n".join(lines)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return time and displacements as columns."""
        checks.choice(units, "units", ("SI", "Hz", "rpm"))
        moved = {
            f"{place} {direction} [m]": self.motion[:, index, axis]
            for index, place in enumerate(self.places)
            for axis, direction in enumerate(DIRECTIONS[:3])
        }
        return {"time [s]": self.time} | moved

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the displacement across the axis over time."""
        ax = plotting.axes_or_new(ax)
        for index, place in enumerate(self.places):
            across = np.hypot(*self.motion[:, index, :2].T)
            color = plotting.COLORS[index % len(plotting.COLORS)]
            ax.plot(self.time, 1e6 * across, color=color, label=place)
        ax.set_xlabel("time [s]")
        ax.set_ylabel("displacement across the axis [µm]")
        ax.legend()
        return ax

    def _moved(self, place: str, name: str) -> np.ndarray:
        return self.motion[:, self.places.index(checks.choice(place, name, self.places)), :3]


def base_response(
    target: Target,
    record: BaseRecord,
    *,
    speed: float = 0.0,
    supports: Sequence[Given] | Given = (),
    at: Sequence[At] | At | None = None,
    end_time: float | None = None,
    stiffening: str = "auto",
    tolerance: float = 1e-4,
    axes: str = "auto",
) -> BaseResponse:
    """Compute the motion of a rotor at constant speed while a record shakes the ground.

    From rest against the ground. Unbalance and weight are not in it: :func:`unbalance_response` has
    the one, and linear motions add up.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain or LinearModel
        See :func:`linear_model`; a foundation is that of a model.
    record : BaseRecord
        Its axes are those of the rotor's mesh at the spin angle 0.
    speed : float, optional
        Spin speed Ω [rad/s].
    supports : sequence of Support, optional
        Of a rotor.
    at : sequence of str, int or position, optional
        All interfaces and points of a foundation by default.
    end_time : float, optional
        [s]; the end of the record by default.
    stiffening : {'auto', 'none', 'tilt', 'full'}
    tolerance : float, optional
        Largest error by the length of steps, relative to the largest motion, estimated by halved
        steps. Constant equations are followed exactly with any step.
    axes : {'auto', 'inertial', 'rotor'}
        Axes of the equations, see :func:`linear_model`; by default the axes of the rotor, in which
        nothing is averaged.

    Raises
    ------
    TypeError, ValueError
        For bad input, unknown places, a scene, a foundation without participation, and motions
        that leave the range of floats or do not converge.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import BaseRecord, SolidRotor, Support, base_response
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> step = BaseRecord(np.linspace(0.0, 0.05, 101), np.tile([1.0, 0.0, 0.0], (101, 1)))
    >>> response = base_response(rotor, step, speed=50.0, supports=supports)
    >>> round(response.peak("left")[0], 6)  # 2 a / ω², ω = 100 rad/s
    0.0002
    """
    checks.instance(record, "record", BaseRecord)
    speed = checks.number(speed, "speed", "rad/s")
    tolerance = checks.tolerance(tolerance)
    start, end = record.times[[0, -1]]
    if end_time is not None:
        end = checks.number(end_time, "end_time", "s", above=start)
    at = checked_places(at)
    refusal = (
        "target: a motion of the ground needs a reduced rotor on supports, and a foundation with "
        "its participation; in a scene, use add_base_motion"
    )
    if isinstance(target, exudyn.MainSystem):
        raise ValueError(refusal)
    model = linear_model(target, supports=supports, stiffening=stiffening, axes=axes)
    if model.base_loads(speed) is None:
        raise ValueError(refusal)
    warn_of_structural_damping(model, "base_response computes motion over time")
    warn_of_left_out_stiffening(model, speed)
    model = model.for_responses
    observed = places(model, at, speed)
    time, motion = ShakenRotor.of(model, speed, record, observed).converged(end, tolerance)
    motion[:, [one.is_node for one in observed], 3:] = np.nan
    return BaseResponse(tuple(one.label for one in observed), time, motion, speed)
