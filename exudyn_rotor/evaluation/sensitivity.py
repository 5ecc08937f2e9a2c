"""Sensitivity of magnetic bearings by ISO 14839-3.

On one control axis, with all other loops closed, a signal e is added to what the sensor shows; the
controller gets v = y + e, and

    S(iω) = v/e = 1/(1 + L(iω)),                                                           (1)

with the loop L opened there. The largest ``|S|`` is the inverse of the least distance of L from −1:
ISO 14839-3:2006, *Mechanical vibration — Vibration of rotating machinery equipped with active
magnetic bearings — Part 3: Evaluation of stability margin*, with its zones: A up to 3 (9.5 dB),
B up to 4 (12 dB), C up to 5 (14 dB), D above. Where supports make the equations periodic, the
harmonic of ω counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks, plotting
from exudyn_rotor.bearings.controlled_support import ControlledSupport
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.equations import Terms
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.rotor_train import RotorTrain
from exudyn_rotor.linear.over import forced_over
from exudyn_rotor.linear.stability.stability import stability
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.units import Units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ZONES = {"A": 3.0, "B": 4.0, "C": 5.0, "D": np.inf}  # largest |S|, ISO 14839-3:2006
_ROUNDS, _AROUND = 2, 33  # how often a peak is looked at, and with how many points around it
_SENSOR = slice(3, 6)  # ports of a controller; the bearing's come first


@storable
@dataclass(frozen=True, eq=False)
class Sensitivity(Result):
    """Sensitivity functions, one for each control axis.

    Attributes
    ----------
    axes : tuple of str
        Interface and number of the control axis.
    frequencies : ndarray, shape (f,)
        [rad/s]
    values : ndarray of complex, shape (axes, f)
        S.
    speed : float
        Spin speed [rad/s].

    Examples
    --------
    >>> from exudyn_rotor import Sensitivity
    >>> result = Sensitivity(("left, 1",), [100.0, 200.0], [[1.0 + 0j, -3.5 + 0j]], speed=0.0)
    >>> result.zones
    ('B',)
    >>> print(result.table())
    axis     peak |S|  peak [dB]  at [Hz]  zone
    left, 1       3.5    10.8814   31.831  B
    """

    axes: tuple[str, ...] = words("axes")
    frequencies: np.ndarray = numbers("frequencies")
    values: np.ndarray = numbers("axes", "frequencies", dtype=complex, finite=False)
    speed: float

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.ascending(self.frequencies, "frequencies", "rad/s")

    @property
    def peaks(self) -> np.ndarray:
        """Largest ``|S|`` of each axis, shape (axes,)."""
        return np.nanmax(np.abs(self.values), axis=1)

    @property
    def zones(self) -> tuple[str, ...]:
        """Zone of each axis by ISO 14839-3: 'A', 'B', 'C' or 'D'."""
        return tuple(next(z for z, most in ZONES.items() if peak <= most) for peak in self.peaks)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns, one row for each axis; see :meth:`Result.columns`."""
        shown, at = Units.of(units), np.nanargmax(np.abs(self.values), axis=1)
        return {
            "axis": np.array(self.axes),
            "peak |S|": self.peaks,
            "peak [dB]": 20.0 * np.log10(self.peaks),
            f"at [{shown.frequency}]": shown.frequencies(self.frequencies[at]),
            "zone": np.array(self.zones),
        }

    def plot(self, ax: Axes | None = None, *, units: str = "rpm") -> Axes:
        """Draw ``|S|`` of each axis over the frequency, with the limits of the zones."""
        shown = Units.of(units)
        ax = plotting.axes_or_new(ax)
        places = shown.frequencies(self.frequencies)
        for name, S in zip(self.axes, self.values, strict=True):
            ax.semilogx(places, 20.0 * np.log10(np.abs(S)), lw=1.3, label=name)
        for zone, most in ZONES.items():
            if np.isfinite(most):
                limit = 20.0 * np.log10(most)
                ax.axhline(limit, color="0.5", lw=0.8, ls="--")
                ax.annotate(zone, (places[0], limit), va="top", color="0.4")
        ax.set_xlabel(f"frequency [{shown.frequency}]")
        ax.set_ylabel("sensitivity |S| [dB]")
        ax.grid(alpha=0.3)
        plotting.legend_above(ax, 4)
        return ax


def sensitivity(
    rotor: ReducedRotor | SolidRotor | RotorTrain,
    frequencies: ArrayLike,
    *,
    supports: Sequence[Given] = (),
    foundation: Foundation | None = None,
    speed: float = 0.0,
    stiffening: str = "auto",
) -> Sensitivity:
    """Return the sensitivity function (1) of each control axis of the magnetic bearings.

    ``S = 1/(1 + L)`` with the loop L opened on one axis at its sensor, all others closed.

    Parameters
    ----------
    rotor : ReducedRotor, SolidRotor or RotorTrain
    frequencies : array_like, shape (f,)
        Where S is computed [rad/s], ascending, above zero. The closed loop's own frequencies
        between the first and the last, of motions with damping, are added, and points around the
        largest peak of each axis.
    supports : sequence of MagneticBearing, and others
        Of a rotor; a train has its own.
    foundation : Foundation, optional
        What carries them, as in :func:`linear_model`.
    speed : float, optional
        Spin speed [rad/s], of a train that of the analysis.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Of centrifugal stiffening.

    Returns
    -------
    Sensitivity

    Raises
    ------
    TypeError, ValueError
        For bad input, no magnetic bearing among the supports, and a closed loop that is unstable.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import LinearActuator, MagneticBearing, PIDController, rotor_example
    >>> from exudyn_rotor import sensitivity
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> controller = PIDController(
    ...     proportional=2e4, derivative=20.0, filter_frequency=2e4, amplifier_frequency=1e4
    ... )
    >>> parts = {"actuator": LinearActuator(80.0, 3e5), "controller": controller}
    >>> bearings = [MagneticBearing(interface=name, **parts) for name in ("left", "right")]
    >>> print(sensitivity(rotor, np.geomspace(10.0, 5e3, 50), supports=bearings).table())
    axis      peak |S|  peak [dB]  at [Hz]  zone
    left, 1    1.66895    4.44887  160.633  A
    left, 2    1.66895    4.44887  160.633  A
    right, 1   1.66895    4.44887  160.633  A
    right, 2   1.66895    4.44887  160.633  A
    """
    checks.instance(rotor, "rotor", (ReducedRotor, SolidRotor, RotorTrain))
    values = checks.ascending(frequencies, "frequencies", "rad/s")
    if values[0] <= 0.0:
        raise ValueError(f"frequencies: needs values above zero [rad/s], got {values[0]:g}")
    speed = checks.number(speed, "speed", "rad/s", least=0.0)
    model = linear_model(rotor, supports=supports, foundation=foundation, stiffening=stiffening)
    bearings = [
        (f"{name}:{one.interface}".removeprefix(":"), one)
        for name, given in model.supports.items()
        for one in given
        if isinstance(one, MagneticBearing)
    ]
    if not bearings:
        raise ValueError("supports: needs a MagneticBearing, whose loop has a sensitivity")
    assembly = model.assembly(speed)
    loops = [
        (element.matrices(speed), motion)
        for element, motion in zip(assembly.elements, assembly.motions, strict=True)
        if isinstance(element.law, ControlledSupport)
    ]
    state = stability(model, [speed], accuracy=None)
    heard, growth = state.frequencies_inertial[0], state.exponents.real[0]
    if not state.stable[0]:
        worst = state.least_stable[0]
        raise ValueError(
            f"supports: unstable at {speed:g} rad/s: a motion of {heard[worst]:.4g} rad/s grows by "
            f"{growth[worst]:.4g} 1/s, and there is no sensitivity of an unstable loop; see "
            "stability(…), change the controller"
        )
    own = heard[np.abs(growth) > state.bounds[0]]
    values = np.union1d(values, own[(own > values[0]) & (own < values[-1])])

    def found(at: np.ndarray) -> np.ndarray:
        return np.array([
            _of_axis(model, *loop, axis, at, speed)
            for (_, bearing), loop in zip(bearings, loops, strict=True)
            for axis in bearing.control_axes
        ])  # fmt: skip

    rows = found(values)
    for _ in range(_ROUNDS):  # a wide peak is at no own frequency
        largest = np.nanargmax(np.abs(rows), axis=1)
        sides = np.clip([largest - 1, largest + 1], 0, len(values) - 1)
        values = np.union1d(values, np.linspace(*values[sides], _AROUND))
        rows = found(values)
    names = [f"{name}, {number}" for name, _ in bearings for number in (1, 2)]
    return Sensitivity(tuple(names), values, rows, speed)


def _of_axis(
    model: LinearModel,
    matrices: tuple[np.ndarray, np.ndarray],
    motion: Terms,
    axis: np.ndarray,
    frequencies: np.ndarray,
    speed: float,
) -> np.ndarray:
    """Return S of a bearing's control axis, given along (n1, n2).

    A signal at the sensor loads the ports of the loop, of `motion`, by its stiffness and damping.
    """
    stiffness, damping = (X[:, _SENSOR] @ np.append(axis, 0.0) for X in matrices)
    rates = frequencies[:, None]
    loads = {n: -(stiffness + 1j * rates * damping) @ U for n, U in motion.items()}
    found = forced_over(model, speed, loads, frequencies, held=model.held_basis)
    place = sum(found[-n] @ U[_SENSOR].T for n, U in motion.items() if -n in found)
    return 1.0 + place[:, :2] @ axis
