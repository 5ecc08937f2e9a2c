"""The connectors of a support in a scene: who evaluates its law, and how.

Displacements go through a ``CartesianSpringDamper``, tilts through a ``RigidBodySpringDamper``.
Exudyn evaluates constant coefficients itself: diagonal matrices by numbers, others by a symbolic
function. What depends on the rotor's angle or speed is a Python function, which reads them from the
node of the frame. Native tilt damping would act on Exudyn's angular velocity of the marker. Of a
spinning rotor with the tilt φ, on a base with the tilt β, it is not the rate of their difference ψ:
``ω = ψ̇ − Ω e × ψ − Ω e × φ`` in axes of the base, the last term because Exudyn gives the marker's
local angular velocity in axes of the frame.

The moment across the axis, m, of a support that stands still has none about the shaft's own axis,
``e + ψ × e``, so that it has the part ``m · (e × ψ)`` about e. Without it springs that are not
alike in all directions, and dampers, would drive a free spin: the work of m on Exudyn's angular
velocity is ``m · (ψ̇ − Ω e × ψ)``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import exudyn
import numpy as np
from exudyn.advancedUtilities import CreateSymbolicUserFunction
from exudyn.itemInterface import CartesianSpringDamper, RigidBodySpringDamper

from exudyn_rotor.bearings.bearing import Bearing, LawWithTorque
from exudyn_rotor.bearings.held_law import HeldLaw
from exudyn_rotor.bearings.journal_bearing import FilmLaw, JournalBearing, RememberingLaw
from exudyn_rotor.bearings.support import Support, varies
from exudyn_rotor.multibody.mark import entry
from exudyn_rotor.multibody.rotor.known_rotor import KnownRotor, carrying_rotor
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.supports.clearances import noting_outside, watch_clearance
from exudyn_rotor.multibody.supports.differenced_law import DifferencedLaw
from exudyn_rotor.multibody.supports.differences import differences_of
from exudyn_rotor.multibody.supports.seats import Seat, point_marker, rigid_marker
from exudyn_rotor.multibody.supports.turning_base import (
    feels_turning,
    in_axes_at_rest,
    on_turning_base,
    on_turning_rotor,
    seen_from_rotor,
)
from exudyn_rotor.theory.rotating_axes import axial_rotation

NATIVE, SYMBOLIC, PYTHON = "Exudyn", "symbolic function", "Python function"
_ROUNDING = 1e-13  # of the largest entry of a turned matrix
_FUNCTIONS = "symbolic functions of supports"
_KINDS = exudyn.OutputVariableType
_ANGLES, _RATES = _KINDS.Coordinates, _KINDS.Coordinates_t
_START = exudyn.ConfigurationType.StartOfStep
_BRAKING = "springForceTorqueUserFunction"
Numbers = Sequence[float]
SpinReader = Callable[[exudyn.MainSystem], tuple[float, float]]
Beginning = Callable[[exudyn.MainSystem, float, int], None]
Note = Callable[[int, float, float], None]


# ------------------------------------------------------------------ displacements


def displacement_connector(
    body: RotorItems, support: Support, seat: Seat, base: exudyn.MarkerIndex
) -> tuple[exudyn.ObjectIndex, str]:
    mbs = body.mbs
    item = CartesianSpringDamper(markerNumbers=[base, point_marker(body, support.interface)])
    if _follows_the_spin(support, ("stiffness", "damping")):
        item.springForceUserFunction = _varying_force(body, support, seat)
        return mbs.AddObject(item), PYTHON
    K, D = (_turned(seat.axes, X[:3, :3]) for X in support.matrices(0.0))
    if not np.any(K - np.diag(np.diag(K))) and not np.any(D - np.diag(np.diag(D))):
        item.stiffness, item.damping = np.diag(K), np.diag(D)
        return mbs.AddObject(item), NATIVE

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        return exudyn.symbolic.Vector(_sum(_times(K, u), _times(D, v)))

    item.springForceUserFunction = symbolic_function(mbs, force, item, "springForceUserFunction")
    return mbs.AddObject(item), SYMBOLIC


def _varying_force(body: RotorItems, support: Support, seat: Seat) -> Callable:
    spin, axes = spin_reader(body), seat.axes
    against = _speed_of_base(body.mbs, seat)
    turns = support.frame == "rotor"

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        angle, speed = spin(mbs)
        relative = speed - against(mbs)
        support.check_range(relative)
        K, D = (X[:3, :3] for X in support.matrices(relative))
        into = axes @ axial_rotation(angle) if turns else axes
        x, x_t = np.dot(u, into), np.dot(v, into)
        if turns:
            x_t -= speed * np.array([-x[1], x[0], 0.0])
        return (into @ (K @ x + D @ x_t)).tolist()

    return force


def _speed_of_base(mbs: exudyn.MainSystem, seat: Seat) -> Callable:
    """Return a function that reads the speed of a rotor that carries a support, about e [rad/s].

    Zero on anything else; tables between two rotors are over the difference of their speeds.
    """
    rotor = carrying_rotor(mbs, seat.base)
    if rotor is None:
        return lambda mbs: 0.0
    sense = float(np.sign(rotor.axis @ seat.axes[:, 2]))
    return lambda mbs: sense * rotor.spin(mbs)[1]


def bearing_connector(
    body: RotorItems, bearing: Bearing, seat: Seat, base: exudyn.MarkerIndex
) -> exudyn.ObjectIndex:
    """Add the connector of a bearing with a law of its own.

    Its torque acts on a spin that is free; a prescribed one does not feel it.
    """
    stands = None if seat.base is None else base
    name, force = bearing_function(body, bearing, seat.axes, spin_reader(body), stands)
    if name == _BRAKING:
        item = RigidBodySpringDamper(
            markerNumbers=[base, rigid_marker(body, bearing.interface)],
            stiffness=np.zeros((6, 6)),
            damping=np.zeros((6, 6)),
        )
    else:
        marker = point_marker(body, bearing.interface)
        item = CartesianSpringDamper(markerNumbers=[base, marker])
    setattr(item, name, force)
    number = body.mbs.AddObject(item)
    watch_clearance(body, bearing, number)
    return number


def bearing_function(
    body: RotorItems,
    bearing: Bearing | HeldLaw,
    axes: np.ndarray,
    spin: SpinReader,
    base: exudyn.MarkerIndex | None,
) -> tuple[str, Callable]:
    """Return the user function of a bearing's connector, and the name that Exudyn gives it."""
    brakes, begin = body.formulation.has_spin, _no_memory
    least, note = bearing.clearance_along() ** 2, noting_outside(body.mbs, bearing)
    rotor = carrying_rotor(body.mbs, base)
    if isinstance(bearing, JournalBearing) and bearing.remembers:
        law = RememberingLaw(bearing.film, torque=brakes)
        begin = _beginning(body, law, axes, rotor)
    else:
        brakes = brakes and bearing.law_with_torque is not None
        law = bearing.law_with_torque if brakes else bearing.law
    if not bearing.uses_angle:
        spin = _speed_reader(body)
    if isinstance(law, FilmLaw):
        law = DifferencedLaw(law, bearing.film.clearance, differences_of(body))
    if rotor is not None:
        law = on_turning_rotor(law, body.mbs, rotor, axes)
    elif feels_turning(body, base) and not isinstance(bearing, HeldLaw):
        law = on_turning_base(law, body.mbs, base, axes)
    if brakes:
        function = _braking_function(law, spin, begin, least, note)
        return _BRAKING, in_axes_at_rest(function, base, axes)
    (a, d), (b, e), (c, f) = axes[:, :2].tolist()

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        begin(mbs, t, item)
        x, y = a * u[0] + b * u[1] + c * u[2], d * u[0] + e * u[1] + f * u[2]
        if x * x + y * y >= least:
            note(item, x, y)
        vx, vy = a * v[0] + b * v[1] + c * v[2], d * v[0] + e * v[1] + f * v[2]
        fx, fy = law(x, y, vx, vy, *spin(mbs))
        return [-a * fx - d * fy, -b * fx - e * fy, -c * fx - f * fy]

    return "springForceUserFunction", force


def _braking_function(
    law: LawWithTorque, spin: SpinReader, begin: Beginning, least: float, note: Note
) -> Callable:
    """Return force and torque along (n1, n2, e).

    Beyond the square `least` of the least clearance it calls `note`.
    """

    def force(mbs, t, item, u, angles, v, omega, stiffness, damping, r0, r1, offset):
        begin(mbs, t, item)
        if u[0] * u[0] + u[1] * u[1] >= least:
            note(item, u[0], u[1])
        fx, fy, torque = law(u[0], u[1], v[0], v[1], *spin(mbs))
        return [-fx, -fy, 0.0, 0.0, 0.0, -torque]

    return force


def _no_memory(mbs: exudyn.MainSystem, t: float, item: int) -> None:
    """Do nothing: a law of place and velocity has no memory."""


def _beginning(
    body: RotorItems, law: RememberingLaw, axes: np.ndarray, rotor: KnownRotor | None
) -> Beginning:
    """Return what gives a film with a memory the state at the beginning of the step.

    Exudyn repeats steps and evaluates forces at trial states; the configuration of the beginning of
    the step alone holds what has been accepted.
    """
    across, spin, begun = axes[:, :2], spin_reader(body, _START), []
    seen = None if rotor is None else seen_from_rotor(body.mbs, rotor, axes, _START)

    def begin(mbs: exudyn.MainSystem, t: float, item: int) -> None:
        time = mbs.systemData.GetTime(_START)
        if begun == [time, t]:
            return
        begun[:] = time, t
        markers = mbs.GetObject(item)["markerNumbers"]
        (p0, p1), (v0, v1) = (
            [mbs.GetMarkerOutput(each, kind, _START) for each in markers]
            for kind in (_KINDS.Position, _KINDS.Velocity)
        )
        place, rate = ((b - a) @ across for a, b in ((p0, p1), (v0, v1)))
        motion = *place.tolist(), *rate.tolist(), *spin(mbs)
        *moved, _, speed = motion if seen is None else seen(motion)[1]
        law.begin(time, *moved, speed, t)

    return begin


# ------------------------------------------------------------------ tilts


def tilt_connector(
    body: RotorItems, support: Support, seat: Seat, base: exudyn.MarkerIndex
) -> tuple[exudyn.ObjectIndex, str]:
    mbs = body.mbs
    item = RigidBodySpringDamper(
        markerNumbers=[base, rigid_marker(body, support.interface)],
        stiffness=np.zeros((6, 6)),
        damping=np.zeros((6, 6)),
    )
    K, D = (X[3:, 3:] for X in support.matrices(_start_speed(body)))
    about_axis = np.any(K[2]) or np.any(K[:, 2])
    follows = _follows_the_spin(support, ("tilt_stiffness", "tilt_damping"))
    if about_axis or follows or (np.any(D) and seat.base is not None):
        item.springForceTorqueUserFunction = varying_torque(
            body, support, None if seat.base is None else base
        )
        return mbs.AddObject(item), PYTHON
    if not np.any(D) and np.array_equal(K[:2, :2], K[0, 0] * np.eye(2)):
        item.stiffness = np.kron(np.diag([0.0, 1.0]), K)
        return mbs.AddObject(item), NATIVE

    def torque(mbs, t, item, u, angles, v, omega, stiffness, damping, r0, r1, offset):
        a, b, about = _sum(_times(K, angles), _times(D, _tilt_rate(angles, omega)))
        values = [a, b, about + b * angles[0] - a * angles[1]]
        return exudyn.symbolic.Vector([0.0, 0.0, 0.0, *values])

    item.springForceTorqueUserFunction = symbolic_function(
        mbs, torque, item, "springForceTorqueUserFunction"
    )
    return mbs.AddObject(item), SYMBOLIC


def varying_torque(body: RotorItems, support: Support, base: exudyn.MarkerIndex | None) -> Callable:
    """Return the user function of moments against tilts on a base's marker, or on the ground."""
    spin = spin_reader(body)
    tilt_of_base = None if base is None else _tilt_reader(base, body.standing_axes)

    def torque(mbs, t, item, u, angles, v, omega, stiffness, damping, r0, r1, offset):
        angle, speed = spin(mbs)
        support.check_range(speed)
        rate = np.array(_tilt_rate(angles, omega))
        if tilt_of_base is not None:
            a, b = tilt_of_base(mbs)
            rate += omega[2] * np.array([-b, a, 0.0])
        tilt = np.array([angles[0], angles[1], twist_of(angles, angle)])
        moment = moment_of(support, tilt, rate, angle, speed)
        if support.frame != "rotor":
            moment[2] += moment[1] * tilt[0] - moment[0] * tilt[1]
        return [0.0, 0.0, 0.0, *moment.tolist()]

    return torque


def moment_of(
    support: Support, tilt: np.ndarray, rate: np.ndarray, angle: float, speed: float
) -> np.ndarray:
    """Return stiffness and damping times tilts (3,) [rad] and their rates, along (n1, n2, e)."""
    K, D = (X[3:, 3:] for X in support.matrices(speed))
    if support.frame != "rotor":
        return K @ tilt + D @ rate
    R = axial_rotation(angle)
    tilt, rate = tilt @ R, rate @ R
    rate -= speed * np.array([-tilt[1], tilt[0], 1.0])
    return R @ (K @ tilt + D @ rate)


def twist_of(angles: Numbers, angle: float) -> float:
    """Return by how much a marker turns about the axis beyond the spin angle [rad]."""
    return float((angles[2] - angle + np.pi) % (2.0 * np.pi) - np.pi)


def _tilt_reader(base: exudyn.MarkerIndex, axes: np.ndarray) -> Callable:
    """Return a function that reads the tilts of the base's marker about n1 and n2."""

    def tilts(mbs: exudyn.MainSystem) -> tuple[float, float]:
        turned = np.reshape(mbs.GetMarkerOutput(base, _KINDS.RotationMatrix), (3, 3))
        n1, n2, _ = axes.T
        return -float(n2 @ turned[:, 2]), float(n1 @ turned[:, 2])

    return tilts


def _tilt_rate(tilt: Numbers, omega: Numbers) -> list:
    """Return ψ̇ from ψ and Exudyn's angular velocity ω on a base that stands still.

    Of numbers or of symbols; a base that tilts by β adds ``Ω e × β``.
    """
    return [
        omega[0] - 2.0 * omega[2] * tilt[1],
        omega[1] + 2.0 * omega[2] * tilt[0],
        omega[2],
    ]


# ------------------------------------------------------------------ shared


def _follows_the_spin(support: Support, names: Sequence[str]) -> bool:
    return support.frame == "rotor" or any(varies(getattr(support, name)) for name in names)


def _start_speed(body: RotorItems) -> float:
    return body.plan.setup.placement.speed


def spin_reader(
    body: RotorItems, state: exudyn.ConfigurationType = exudyn.ConfigurationType.Current
) -> SpinReader:
    """Return a function that reads spin angle [rad] and speed [rad/s] from the frame's node."""
    node, place = int(body.nodes["rigid"]), body.locks.spin

    def spin(mbs: exudyn.MainSystem) -> tuple[float, float]:  # called at every force
        read = mbs.GetNodeOutput
        angle, rate = read(node, _ANGLES, state)[place], read(node, _RATES, state)[place]
        return float(angle), float(rate)

    return spin


def _speed_reader(body: RotorItems) -> SpinReader:
    """Return as :func:`spin_reader`, with 0 in place of the angle, in half the time."""
    node, place = int(body.nodes["rigid"]), body.locks.spin

    def spin(mbs: exudyn.MainSystem) -> tuple[float, float]:
        return 0.0, float(mbs.GetNodeOutput(node, _RATES)[place])

    return spin


def _turned(axes: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Return a matrix in inertial axes, its rounding cut off."""
    turned = axes @ matrix @ axes.T
    turned[np.abs(turned) <= _ROUNDING * np.abs(turned).max()] = 0.0
    return turned


def _times(matrix: np.ndarray, vector: Numbers) -> list:
    """Return a matrix times numbers or symbols, without its zeros."""
    return [
        sum((float(row[i]) * vector[i] for i in np.flatnonzero(row)), start=0.0 * vector[0])
        for row in matrix
    ]


def _sum(first: list, second: list) -> list:
    return [a + b for a, b in zip(first, second, strict=True)]


def symbolic_function(
    mbs: exudyn.MainSystem, function: Callable, item: object, name: str
) -> object:
    """Return a function as Exudyn's symbolic one, kept alive by the system."""
    kind = type(item).__name__
    made = CreateSymbolicUserFunction(mbs, function, name, itemTypeName=kind)
    entry(mbs).setdefault(_FUNCTIONS, []).append(made)
    return made
