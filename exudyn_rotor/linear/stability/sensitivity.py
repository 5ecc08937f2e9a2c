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

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given, given_supports
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.modal.whirl import WhirlContent
from exudyn_rotor.linear.models.linear_model import linear_model
from exudyn_rotor.linear.models.protocol import Space
from exudyn_rotor.linear.models.rotor.controlled_rotor import ControlledRotor
from exudyn_rotor.linear.models.trains.linear_train import LinearTrain
from exudyn_rotor.linear.models.trains.rotor_train import RotorTrain
from exudyn_rotor.linear.periodic.periodic_system import Terms
from exudyn_rotor.linear.stability.growth import Growth, GrowthAt, held_space
from exudyn_rotor.linear.stability.sensitivity_result import Sensitivity
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.rotating_axes import into_inertial_frame, into_rotor_frame

_TOLERANCE = 1e-9  # of the harmonics
_RESIDUAL = 1e-7  # of no influence here: all motions are found


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
        between the first and the last, of motions with damping, are added, so that no peak is
        missed.
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
    >>> from exudyn_rotor import LinearActuator, MagneticBearing, PIDController, SolidRotor
    >>> from exudyn_rotor import sensitivity
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> controller = PIDController(
    ...     proportional=2e4, derivative=20.0, filter_frequency=2e4, amplifier_frequency=1e4
    ... )
    >>> parts = {"actuator": LinearActuator(80.0, 3e5), "controller": controller}
    >>> bearings = [MagneticBearing(interface=name, **parts) for name in ("left", "right")]
    >>> print(sensitivity(rotor, np.geomspace(10.0, 5e3, 50), supports=bearings).table())
    axis      peak |S|  peak [dB]  at [Hz]  zone
    left, 1      1.662        4.4      153  A
    left, 2      1.662        4.4      153  A
    right, 1     1.662        4.4      153  A
    right, 2     1.662        4.4      153  A
    """
    checks.instance(rotor, "rotor", (ReducedRotor, SolidRotor, RotorTrain))
    values = checks.ascending(frequencies, "frequencies", "rad/s")
    if values[0] <= 0.0:
        raise ValueError(f"frequencies: needs values above zero [rad/s], got {values[0]:g}")
    speed = checks.number(speed, "speed", "rad/s", least=0.0)
    bearings = _bearings(rotor, supports)
    if not bearings:
        raise ValueError("supports: needs a MagneticBearing, whose loop has a sensitivity")
    model = linear_model(rotor, supports=supports, foundation=foundation, stiffening=stiffening)
    held = held_space(model, speed, None, _RESIDUAL)
    found = GrowthAt(held, "auto", _TOLERANCE, WhirlContent.of(model))(speed)
    if found.excess > 0.0:
        raise _unstable(found, model, [name for name, _ in bearings], speed)
    space = model.space(len(values), values[-1])
    own = np.abs(found.names[0][np.abs(found.values.real) > found.bounds])
    values = np.union1d(values, own[(own > values[0]) & (own < values[-1])])
    rows = [
        _of_axis(model, space, index, axis, values, speed)
        for index, (_, bearing) in enumerate(bearings)
        for axis in bearing.control_axes
    ]
    names = [f"{name}, {number}" for name, _ in bearings for number in (1, 2)]
    return Sensitivity(tuple(names), values, np.array(rows), speed)


def _bearings(
    rotor: ReducedRotor | SolidRotor | RotorTrain, supports: Sequence[Given]
) -> list[tuple[str, MagneticBearing]]:
    """Return the magnetic bearings with their names, in the order of the model's coordinates."""
    given = [("", given_supports(supports))]
    if isinstance(rotor, RotorTrain):
        given += [(f"{name}:", own) for name, own in rotor.supports.items()]
    return [
        (name + one.interface, one)
        for name, each in given
        for one in each
        if isinstance(one, MagneticBearing)
    ]


def _unstable(
    found: Growth, model: ControlledRotor | LinearTrain, names: Sequence[str], speed: float
) -> ValueError:
    """Return the error of an unstable loop: frequency, growth, and the controller that moves most.

    `names` are those of the bearings, in the order of the model's coordinates.
    """
    heard, where = found.names[0][found.least_stable], ""
    if found.critical is not None:
        shape = found.critical.vectors
        moves = [np.linalg.norm(shape[:, model.own_rows(index)]) for index in range(len(names))]
        where = f", in which most moves the controller of {names[np.argmax(moves)]!r},"
    return ValueError(
        f"supports: unstable at {speed:g} rad/s: a motion of {heard:.4g} rad/s{where} grows by "
        f"{found.values.real.max():.4g} 1/s, and there is no sensitivity of an unstable loop; "
        "see stability(…), change the controller"
    )


def _of_axis(
    model: ControlledRotor | LinearTrain,
    space: Space,
    index: int,
    axis: np.ndarray,
    frequencies: np.ndarray,
    speed: float,
) -> np.ndarray:
    """Return S of a bearing's control axis, given along (n1, n2)."""
    one, rows = model.own.supports[index], model.own_rows(index)
    drive = np.zeros((one.size // 2, 3))
    drive[:, :2] = (-one.stiffness[4:, 2:4] @ axis).reshape(-1, 2)
    loads = {}
    for n, turned in into_rotor_frame(drive.ravel()).items():
        loads[n] = np.zeros(model.size, dtype=complex)
        loads[n][rows] = turned.reshape(-1, 3)[:, :2].ravel()
    sensed, found = model.sensed(index), []
    for frequency in frequencies:
        motion = space.steady_motion(speed, loads, frequency, _TOLERANCE)
        seen = into_inertial_frame(_seen(sensed, motion))
        place = seen[0][0] if speed else sum(seen.values())[0]
        found.append(1.0 + place[:2] @ axis)
    return np.array(found)


def _seen(sensed: Terms, motion: Terms) -> dict[int, np.ndarray]:
    """Return the harmonics (1, 3) of what a sensor shows of a motion."""
    seen: dict[int, np.ndarray] = {}
    for m, U in sensed.items():
        for n, X in motion.items():
            seen[m + n] = seen.get(m + n, 0.0) + (U @ X)[None]
    return seen
