"""Stability analysis of level I: the log decrement over an applied cross-coupling.

Source: API RP 684, 2nd ed. (2005), standard paragraphs SP6.8.5.6 (anticipated cross-coupling),
SP6.8.5.8 and SP6.8.5.9 (how much is applied, and where) and SP6.8.5.10 (when level II is required);
API 617 asks for the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.given import Given, given_supports
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.evaluation.coupled_modes import MULTIPLES, first_forward
from exudyn_rotor.linear.modal.whirl import damping_of
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.results import Result, numbers, storable, text_table
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MACHINES = {"centrifugal": 3.0, "axial": 1.5}  # factor of the anticipated cross-coupling
_LEAST_DECREMENT = 0.1  # log decrement, API 617
_LEAST_RATIO, _LARGE_RATIO = 2.0, 10.0  # of Q₀ to Q_A


def anticipated_cross_coupling(
    power: float,
    speed: float,
    diameter: float,
    width: float,
    *,
    density_ratio: float = 1.0,
    machine: str = "centrifugal",
) -> float:
    """Return the cross-coupled stiffness of one stage, ``q = B P r / (D H Ω)`` [N/m].

    B = 3 and r the density ratio for centrifugal impellers (modified Wachel equation), B = 1.5 and
    r = 1 for axial stages (Alford); SP6.8.5.6.

    Parameters
    ----------
    power : float
        Rated power of the stage P [W].
    speed : float
        Normal operating speed Ω [rad/s].
    diameter : float
        Of the impeller, or pitch diameter of the blades, D [m].
    width : float
        The smaller of the widths of diffuser and impeller at the discharge, or the height of the
        blades, H [m].
    density_ratio : float, optional
        Density of the gas at discharge over that at suction; 1 for axial stages.
    machine : {'centrifugal', 'axial'}

    Raises
    ------
    TypeError, ValueError
        If a number is not positive, or an axial stage is given a density ratio.

    Examples
    --------
    >>> from exudyn_rotor import anticipated_cross_coupling
    >>> anticipated_cross_coupling(1e6, 1000.0, 0.5, 0.02, density_ratio=1.5)
    450000.0
    """
    factor = MACHINES[checks.choice(machine, "machine", MACHINES)]
    power = checks.number(power, "power", "W", above=0.0)
    speed = checks.number(speed, "speed", "rad/s", above=0.0)
    diameter = checks.number(diameter, "diameter", "m", above=0.0)
    width = checks.number(width, "width", "m", above=0.0)
    ratio = checks.number(density_ratio, "density_ratio", above=0.0)
    if machine == "axial" and ratio != 1.0:
        raise ValueError(f"density_ratio: axial stages have none, got {density_ratio!r}")
    return factor * power * ratio / (diameter * width * speed)


@storable
@dataclass(frozen=True, eq=False)
class StabilityLevelOne(Result):
    """Log decrement of the first forward mode over an applied cross-coupling.

    Attributes
    ----------
    applied : ndarray, shape (q,)
        Sum of the cross-coupled stiffnesses Q, from 0 to 10 Q_A [N/m].
    log_decrement : ndarray, shape (q,)
        Infinite where the mode decays without oscillating, NaN where it is not known.
    frequencies : ndarray, shape (q,)
        Of the mode in the inertial frame [rad/s].
    anticipated : float
        Q_A [N/m].
    speed : float
        Spin speed [rad/s].
    machine : {'centrifugal', 'axial'}
    threshold : float or None
        Q₀, where the log decrement is zero [N/m]; None above 10 Q_A.
    critical_speed_ratio : float or None
        Maximum continuous speed over the first undamped critical speed on rigid supports.
    gas_density : float or None
        Average of the densities at suction and discharge [kg/m³].

    Examples
    --------
    >>> from exudyn_rotor import StabilityLevelOne
    >>> result = StabilityLevelOne([0.0, 1e5, 2e5], [0.3, 0.2, 0.1], [99.0, 99.0, 99.0], 1e5,
    ...                            300.0, "centrifugal", 3e5)
    >>> result.needs_level_two
    True
    >>> print(result.table())
    log decrement of the first forward mode at 2864.79 rpm
    cross-coupling [N/m]  log decrement  frequency [Hz]
                       0            0.3         15.7563
                  100000            0.2         15.7563
                  200000            0.1         15.7563
    Q0 = 3e+05 N/m = 3 QA, log decrement at QA 0.2
    level II is required: Q0/QA is below 10, and critical speed ratio or gas density are not given
    """

    applied: np.ndarray = numbers("applied", least=0.0)
    log_decrement: np.ndarray = numbers("applied", finite=False)
    frequencies: np.ndarray = numbers("applied", finite=False)
    anticipated: float
    speed: float
    machine: str = checks.one_of(MACHINES)
    threshold: float | None = None
    critical_speed_ratio: float | None = None
    gas_density: float | None = None

    @property
    def anticipated_decrement(self) -> float:
        """Log decrement under the anticipated cross-coupling."""
        return float(np.interp(self.anticipated, self.applied, self.log_decrement))

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why an analysis of level II is required (SP6.8.5.10); empty where it is not."""
        reasons = []
        if self.anticipated_decrement < _LEAST_DECREMENT:
            reasons.append(f"the log decrement at QA is below {_LEAST_DECREMENT:g}")
        if self.machine == "centrifugal" and self.threshold is not None:
            ratio = self.threshold / self.anticipated
            if ratio < _LEAST_RATIO:
                reasons.append(f"Q0/QA is below {_LEAST_RATIO:g}")
            elif ratio < _LARGE_RATIO and self.critical_speed_ratio and self.gas_density:
                if self.critical_speed_ratio > largest_speed_ratio(self.gas_density):
                    reasons.append(
                        "Q0/QA is below 10 in region B of critical speed ratio and density"
                    )
            elif ratio < _LARGE_RATIO:
                reasons.append(
                    "Q0/QA is below 10, and critical speed ratio or gas density are not given"
                )
        return tuple(reasons)

    @property
    def needs_level_two(self) -> bool:
        """True where level I does not suffice; see :attr:`reasons`."""
        return bool(self.reasons)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns."""
        shown = Units.of(units)
        return {
            "cross-coupling [N/m]": self.applied,
            "log decrement": self.log_decrement,
            f"frequency [{shown.frequency}]": shown.frequencies(self.frequencies),
        }

    def table(self, *, units: str = "rpm") -> str:
        """Return the log decrements and the verdict as text; `units` are 'rpm', 'Hz' or 'SI'."""
        shown = Units.of(units)
        lines = [
            "log decrement of the first forward mode at "
            f"{shown.speeds(self.speed):.6g} {shown.speed}",
            *text_table(self.columns(units)),
        ]
        limit = f"above {self.applied[-1] / self.anticipated:.3g} QA"
        if self.threshold is not None:
            ratio = self.threshold / self.anticipated
            limit = f"= {self.threshold:.5g} N/m = {ratio:.3g} QA"
        lines.append(f"Q0 {limit}, log decrement at QA {self.anticipated_decrement:.3g}")
        required = "level II is required: " + "; ".join(self.reasons)
        lines.append(required if self.reasons else "level II is not required")
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the log decrement over the cross-coupling, with Q_A, Q₀ and the limit 0.1."""
        ax = plotting.axes_or_new(ax)
        mega, colors = 1e-6, plotting.COLORS
        line = [*zip(self.applied, self.log_decrement, strict=True)]
        if self.threshold:  # 0 where it is unstable without cross-coupling
            line.append((self.threshold, 0.0))
        applied, decrement = np.array(sorted(line)).T
        ax.plot(mega * applied, decrement, ".-", color=colors[0], label="first forward mode")
        at_anticipated = mega * self.anticipated, self.anticipated_decrement
        ax.plot(*at_anticipated, "s", color=colors[1], label="anticipated, QA")
        if self.threshold is not None:
            ax.plot(mega * self.threshold, 0.0, "o", color=colors[2], label="Q0")
        ax.axhline(_LEAST_DECREMENT, color="0.5", lw=0.9, ls="--", label="0.1, least at QA")
        lowest, highest = ax.get_ylim()
        room = 0.05 * (highest - lowest)
        ax.set_ylim(min(lowest, -room), max(highest, _LEAST_DECREMENT + room))
        ax.axhline(0.0, color="0.3", lw=0.8)
        ax.set_xlabel("applied cross-coupling [MN/m]")
        ax.set_ylabel("log decrement")
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, 4)
        return ax


def largest_speed_ratio(density: float) -> float:
    """Return the critical speed ratio between the regions A and B of SP6.8.5.10.

    2.5 up to an average gas density of 16.53 kg/m³, falling to 2.0 at 60 kg/m³; above, all is B.
    """
    if density > 60.0:
        return 0.0
    return float(min(2.5, 2.69 - 0.0115 * density))


def stability_level_one(
    target: ReducedRotor,
    speed: float,
    cross_coupling: ArrayLike,
    at: Sequence[str] | str,
    *,
    supports: Sequence[Given] | Given,
    machine: str = "centrifugal",
    critical_speed_ratio: float | None = None,
    gas_density: float | None = None,
    stiffening: str = "auto",
) -> StabilityLevelOne:
    """Compute the log decrement of the first forward mode from no cross-coupling to 10 Q_A.

    Cross-coupling Q gives the forces ``(−Q u_n2, Q u_n1)``, which feed forward whirl. One mode is
    followed over Q: the lateral one that becomes unstable first, at Q₀, or, where Q₀ is above
    10 Q_A, a lower one that whirls forward at Q₀. On supports that differ in two directions modes
    move in planes at less Q, and their sense of whirl tells little there; it decides where no mode
    becomes unstable up to 1000 Q_A. Modes of a damping ratio above 0.7, which have no resonance,
    are passed over where there is another.

    Parameters
    ----------
    target : ReducedRotor
    speed : float
        Maximum continuous speed [rad/s].
    cross_coupling : float or array_like
        Anticipated cross-coupling at each interface of `at` [N/m]; see
        :func:`anticipated_cross_coupling`. Their sum is Q_A.
    at : str or sequence of str
        Interfaces: midspan between bearings, the centre of mass of an overhung stage, or all stages
        of a double overhung rotor.
    supports : sequence of Support or bearings
        Bearings, without seals.
    machine : {'centrifugal', 'axial'}
        By which criteria level II is required.
    critical_speed_ratio : float, optional
        See :class:`StabilityLevelOne`.
    gas_density : float, optional
        Average gas density [kg/m³].
    stiffening
        See :func:`campbell`.

    Raises
    ------
    TypeError, ValueError
        If an argument is of another kind or out of range, an interface is unknown or given twice,
        there are no supports, or the rotor has no lateral mode.

    Examples
    --------
    A Jeffcott rotor is unstable from Q = c ω on:

    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, stability_level_one
    >>> point = SolidRotor.from_matrices(
    ...     np.eye(3), np.zeros((3, 3)), [[0, 0, 0]], axis="z", interfaces={"disc": [0]})
    >>> bearing = Support("disc", 1e4, damping=20.0)  # ω = 100 rad/s
    >>> result = stability_level_one(point.reduce(0), 300.0, 500.0, "disc", supports=bearing)
    >>> round(result.threshold, 6)
    2000.0
    """
    checks.instance(target, "target", ReducedRotor, "SolidRotor.reduce makes one")
    speed = checks.number(speed, "speed", "rad/s", above=0.0)
    names = checks.different(checks.labels(at, "at", target.interfaces), "at")
    amounts = np.atleast_1d(checks.array(cross_coupling, "cross_coupling", "N/m"))
    if amounts.shape != (len(names),) or not names or np.any(amounts <= 0.0):
        raise ValueError(
            "cross_coupling: needs a positive number [N/m] for each interface of at, got "
            + checks.shown(cross_coupling)
        )
    supports = given_supports(supports)
    if not supports:
        raise ValueError("supports: needs the bearings of the rotor, got none")
    checks.choice(machine, "machine", MACHINES)
    if critical_speed_ratio is not None:
        checks.number(critical_speed_ratio, "critical_speed_ratio", above=0.0)
    if gas_density is not None:
        checks.number(gas_density, "gas_density", "kg/m³", above=0.0)
    coupling = dict(zip(names, amounts, strict=True))

    def coupled(multiple: float) -> LinearModel:
        added = [
            Support(name, multiple * q * np.array([[0.0, 1.0], [-1.0, 0.0]]))
            for name, q in coupling.items()
        ]
        return linear_model(target, supports=(*supports, *added), stiffening=stiffening)

    found, limit = first_forward(coupled, speed)
    decrement = damping_of(found.real, found.imag)[1]
    still = np.isnan(decrement) & np.isfinite(found)
    decrement = np.where(still, np.copysign(np.inf, -found.real), decrement)
    total = float(amounts.sum())
    return StabilityLevelOne(
        total * MULTIPLES, decrement, found.imag, total, speed, machine,
        None if limit is None else total * limit, critical_speed_ratio, gas_density,
    )  # fmt: skip
