"""Supports and bearings between a rotor in a scene and the ground or a foundation.

The same objects as in linear analyses, with the same meaning: an interface's mean displacement,
axes (n1, n2, e) of :attr:`SpinAxis.plane` as the rotor is mounted, frame 'inertial' or 'rotor'.
The spring is relaxed where the interface stands at rest with its centre on the axis.

Displacements go through a ``CartesianSpringDamper``, tilts through a ``RigidBodySpringDamper``.
Exudyn evaluates constant coefficients itself: diagonal matrices by numbers, others by a symbolic
function. What depends on the rotor's angle or speed is a Python function, which reads them from the
node of the frame. Native tilt damping would act on Exudyn's angular velocity of the marker. Of a
spinning rotor with the tilt φ, on a base with the tilt β, it is not the rate of their difference ψ:
``ω = ψ̇ − Ω e × ψ − Ω e × φ`` in axes of the base, the last term because Exudyn gives the marker's
local angular velocity in axes of the frame.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import exudyn
import numpy as np
from exudyn.advancedUtilities import CreateSymbolicUserFunction
from exudyn.itemInterface import (
    CartesianSpringDamper,
    MarkerBodyRigid,
    MarkerSuperElementPosition,
    MarkerSuperElementRigid,
    ObjectGround,
    RigidBodySpringDamper,
)

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import (
    Support,
    acts,
    check_interfaces,
    checked_supports,
    varies,
)
from exudyn_rotor.multibody.marker_body import append_nodes, virtual_nodes
from exudyn_rotor.multibody.more_markers import interface_motion
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.rotating_axes import axes_of

NATIVE, SYMBOLIC, PYTHON = "Exudyn", "symbolic function", "Python function"
_SAME_PLACE = 1e-6  # m, between a marker of the base and the bearing's place
_ROUNDING = 1e-13  # of the largest entry of a turned matrix
_KINDS = exudyn.OutputVariableType
_REFERENCE = exudyn.ConfigurationType.Reference
_FUNCTIONS = "exudyn_rotor: symbolic functions of supports"  # key in mbs.sys
_HIDDEN = {"show": False, "showMarkerNodes": False}
Base = exudyn.MarkerIndex | exudyn.ObjectIndex
Numbers = Sequence[float]


@dataclass(frozen=True, eq=False)
class SceneSupport:
    """A support in a scene.

    Attributes
    ----------
    support : Support
    objects : tuple of ObjectIndex
        Its connectors: for displacements, for tilts, where it acts on them.
    evaluation : tuple of str
        Who evaluates each of them in a time step.
    """

    support: Support
    objects: tuple[exudyn.ObjectIndex, ...]
    evaluation: tuple[str, ...]

    @property
    def uses_python(self) -> bool:
        """True when a time step calls Python for it."""
        return PYTHON in self.evaluation

    def __str__(self) -> str:
        """Return interface and who evaluates it."""
        return f"{self.support.interface} by {', '.join(self.evaluation) or 'nothing'}"


def add_supports(
    body: RotorBody,
    supports: Sequence[Support] | Support,
    base: Base | Mapping[str, Base] | None = None,
) -> tuple[SceneSupport, ...]:
    """Put a rotor in a scene on the supports that linear analyses take.

    Call it before ``mbs.Assemble()``. Tables over the speed and supports in the rotor's frame
    follow the rotor's spin at every instant, prescribed or free.

    Parameters
    ----------
    body : RotorBody
        From :func:`exudyn_rotor.add_rotor`, with its marker body.
    supports : sequence of Support
    base : MarkerIndex, ObjectIndex, or mapping of interface to these, optional
        What carries them: a marker at the place of the interface, a rigid body, which gets such a
        marker; the ground by default. Forces act along the inertial axes, also where the base
        tilts.

    Returns
    -------
    tuple of SceneSupport
        One for each support, with the numbers of its connectors.

    Raises
    ------
    TypeError, ValueError
        For bad input; nothing has been added then. A run that leaves the range of a table stops
        with an error.

    Notes
    -----
    About the spin axis, a damper that stands still brakes the whole spin; a spring, and a damper in
    the rotor's frame, act on the interface's rotation against the frame, so that they need a
    prescribed spin. Supports in the rotor's frame stand on something that turns with the frame and
    is driven there: its reaction does not act on a free spin.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, add_rotor, add_supports
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(1), spin=50.0)
    >>> springs = [Support("left", 2e4 * np.eye(3)), Support("right", [[2e4, 1e3], [-1e3, 2e4]])]
    >>> print(*add_supports(body, springs), sep=" and ")
    left by Exudyn and right by symbolic function
    """
    checks.instance(body, "body", RotorBody, "add_rotor returns one")
    body.check_present()
    supports = checked_supports(supports)
    if "marker_body" not in body.objects:
        raise ValueError(
            f"body: rotor {body.name!r} was added with marker_body=False; supports need the marker "
            "body"
        )
    check_interfaces(supports, body.selection.source.interfaces)
    for support in supports:
        _check_about_the_axis(body, support)
    seats = [_Seat.of(body, support, base) for support in supports]
    added = tuple(
        _added(body, support, seat) for support, seat in zip(supports, seats, strict=True)
    )
    body.supports.extend(added)
    return added


def _check_about_the_axis(body: RotorBody, support: Support) -> None:
    """Refuse what acts against the rotation of a frame whose spin is free."""
    if not body.formulation.has_spin:
        return
    stiffness, damping = support.matrices(_start_speed(body))
    acting = {"tilt_stiffness": stiffness}
    if support.frame == "rotor":
        acting["tilt_damping"] = damping
    for name, matrix in acting.items():
        if np.any(matrix[5]) or np.any(matrix[:, 5]):
            raise ValueError(
                f"support at {support.interface!r}: {name} about the spin axis needs a prescribed "
                f"spin, and that of rotor {body.name!r} is free; use a matrix with zeros there, or "
                "a torsional spring on the frame's node"
            )


@dataclass(frozen=True, eq=False)
class _Seat:
    """Where a support is, checked, before anything is added.

    `place` is inertial [m], `axes` (n1, n2, e) in inertial axes; `base` is what carries it, with
    its reference position and orientation.
    """

    place: np.ndarray
    axes: np.ndarray
    base: Base | None
    origin: np.ndarray
    orientation: np.ndarray

    @classmethod
    def of(cls, body: RotorBody, support: Support, base: Base | Mapping[str, Base] | None) -> _Seat:
        name, setup = support.interface, body.plan.setup.placement
        on_axis = body.axis.project(body.selection.source.interfaces[name].reference)
        place = setup.position + setup.rotation @ on_axis
        axes = setup.rotation @ axes_of(body.axis)
        if isinstance(base, Mapping):
            if name not in base:
                raise ValueError(
                    f"base: has nothing for the support at {name!r}, only for: "
                    f"{', '.join(map(str, base)) or 'none'}"
                )
            base = base[name]
        if base is None:
            return cls(place, axes, None, np.zeros(3), np.eye(3))
        checks.instance(base, "base", (exudyn.MarkerIndex, exudyn.ObjectIndex))
        origin, orientation = _reference(body.mbs, base)
        apart = np.linalg.norm(origin - place)
        if isinstance(base, exudyn.MarkerIndex) and apart > _SAME_PLACE:
            raise ValueError(
                f"base: the marker {int(base)} is {apart:.3g} m off the support at {name!r}, which "
                f"is at {place.tolist()}; put it there, or give the rigid body itself"
            )
        return cls(place, axes, base, origin, orientation)

    def marker(self, mbs: exudyn.MainSystem) -> exudyn.MarkerIndex:
        """Add a marker of the base at the place, with the axes (n1, n2, e)."""
        turn = self.orientation.T @ self.axes
        if isinstance(self.base, exudyn.MarkerIndex):
            item = mbs.GetMarker(self.base)
            item["localHT"] = item["localHT"] @ _frame(turn)
            del item["name"]
            return mbs.AddMarker(item)
        number = mbs.AddObject(ObjectGround()) if self.base is None else self.base
        local = _frame(turn, self.orientation.T @ (self.place - self.origin))
        return mbs.AddMarker(MarkerBodyRigid(bodyNumber=number, localHT=local))


def _frame(turn: np.ndarray, shift: np.ndarray = (0.0, 0.0, 0.0)) -> np.ndarray:
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = turn, shift
    return frame


def _reference(mbs: exudyn.MainSystem, base: Base) -> tuple[np.ndarray, np.ndarray]:
    """Return the reference position and orientation of a marker or a rigid body."""
    count = mbs.systemData.NumberOfMarkers(), mbs.systemData.NumberOfObjects()
    is_marker = isinstance(base, exudyn.MarkerIndex)
    if not 0 <= int(base) < count[0 if is_marker else 1]:
        raise ValueError(f"base: this system has no {base}")
    try:
        kinds = _KINDS.Position, _KINDS.RotationMatrix
        if is_marker:
            values = [mbs.GetMarkerOutput(base, kind, _REFERENCE) for kind in kinds]
        else:
            values = [
                mbs.GetObjectOutputBody(base, kind, np.zeros(3), _REFERENCE) for kind in kinds
            ]
    except Exception as error:  # Exudyn's own, of several kinds
        raise ValueError(
            f"base: {base} has no place and orientation; give a rigid marker or a rigid body"
        ) from error
    if is_marker and "localHT" not in mbs.GetMarker(base):
        raise ValueError(f"base: {base} is no rigid marker with a frame of its own (localHT)")
    return np.asarray(values[0]), np.reshape(values[1], (3, 3))


def _added(body: RotorBody, support: Support, seat: _Seat) -> SceneSupport:
    mbs, parts = body.mbs, []
    across = support.stiffness, support.damping
    tilts = support.tilt_stiffness, support.tilt_damping
    if not any(map(acts, (*across, *tilts))):
        return SceneSupport(support, (), ())
    base = seat.marker(mbs)
    if any(map(acts, across)):
        parts.append(_displacement_connector(body, support, seat, base))
    if any(map(acts, tilts)):
        parts.append(_tilt_connector(body, support, seat, base))
    objects, evaluation = zip(*parts, strict=True)
    return SceneSupport(support, objects, evaluation)


# ------------------------------------------------------------------ displacements


def _displacement_connector(
    body: RotorBody, support: Support, seat: _Seat, base: exudyn.MarkerIndex
) -> tuple[exudyn.ObjectIndex, str]:
    mbs = body.mbs
    item = CartesianSpringDamper(markerNumbers=[base, _point_marker(body, support.interface)])
    if _follows_the_spin(support, ("stiffness", "damping")):
        item.springForceUserFunction = _varying_force(body, support, seat.axes)
        return mbs.AddObject(item), PYTHON
    K, D = (_turned(seat.axes, X[:3, :3]) for X in support.matrices(0.0))
    if not np.any(K - np.diag(np.diag(K))) and not np.any(D - np.diag(np.diag(D))):
        item.stiffness, item.damping = np.diag(K), np.diag(D)
        return mbs.AddObject(item), NATIVE

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        return exudyn.symbolic.Vector(_sum(_times(K, u), _times(D, v)))

    item.springForceUserFunction = _symbolic(mbs, force, item, "springForceUserFunction")
    return mbs.AddObject(item), SYMBOLIC


def _varying_force(body: RotorBody, support: Support, axes: np.ndarray) -> Callable:
    spin = _spin_reader(body)
    turns = support.frame == "rotor"

    def force(mbs, t, item, u, v, stiffness, damping, offset):
        angle, speed = spin(mbs)
        support.check_range(speed)
        K, D = (X[:3, :3] for X in support.matrices(speed))
        into = axes @ _rotation(angle) if turns else axes
        x, x_t = np.dot(u, into), np.dot(v, into)
        if turns:
            x_t -= speed * np.array([-x[1], x[0], 0.0])
        return (into @ (K @ x + D @ x_t)).tolist()

    return force


# ------------------------------------------------------------------ tilts


def _tilt_connector(
    body: RotorBody, support: Support, seat: _Seat, base: exudyn.MarkerIndex
) -> tuple[exudyn.ObjectIndex, str]:
    mbs = body.mbs
    item = RigidBodySpringDamper(
        markerNumbers=[base, _rigid_marker(body, support.interface)],
        stiffness=np.zeros((6, 6)),
        damping=np.zeros((6, 6)),
    )
    K, D = (X[3:, 3:] for X in support.matrices(_start_speed(body)))
    about_axis = np.any(K[2]) or np.any(K[:, 2])
    follows = _follows_the_spin(support, ("tilt_stiffness", "tilt_damping"))
    if about_axis or follows or (np.any(D) and seat.base is not None):
        tilt_of_base = None if seat.base is None else _tilt_reader(base, seat.axes)
        item.springForceTorqueUserFunction = _varying_torque(body, support, tilt_of_base)
        return mbs.AddObject(item), PYTHON
    if not np.any(D):
        item.stiffness = np.kron(np.diag([0.0, 1.0]), K)
        return mbs.AddObject(item), NATIVE

    def torque(mbs, t, item, u, angles, v, omega, stiffness, damping, r0, r1, offset):
        rate = _tilt_rate(angles, omega)
        values = _sum(_times(K, angles), _times(D, rate))
        return exudyn.symbolic.Vector([0.0, 0.0, 0.0, *values])

    item.springForceTorqueUserFunction = _symbolic(
        mbs, torque, item, "springForceTorqueUserFunction"
    )
    return mbs.AddObject(item), SYMBOLIC


def _varying_torque(body: RotorBody, support: Support, tilt_of_base: Callable | None) -> Callable:
    spin = _spin_reader(body)
    turns = support.frame == "rotor"

    def torque(mbs, t, item, u, angles, v, omega, stiffness, damping, r0, r1, offset):
        angle, speed = spin(mbs)
        support.check_range(speed)
        K, D = (X[3:, 3:] for X in support.matrices(speed))
        rate = np.array(_tilt_rate(angles, omega))
        if tilt_of_base is not None:
            a, b = tilt_of_base(mbs)
            rate += omega[2] * np.array([-b, a, 0.0])
        twist = (angles[2] - angle + np.pi) % (2.0 * np.pi) - np.pi
        tilt = np.array([angles[0], angles[1], twist])
        if not turns:
            return [0.0, 0.0, 0.0, *(K @ tilt + D @ rate).tolist()]
        R = _rotation(angle)
        tilt, rate = tilt @ R, rate @ R
        rate -= speed * np.array([-tilt[1], tilt[0], 1.0])
        return [0.0, 0.0, 0.0, *(R @ (K @ tilt + D @ rate)).tolist()]

    return torque


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


def _start_speed(body: RotorBody) -> float:
    return body.plan.setup.placement.speed


def _spin_reader(body: RotorBody) -> Callable[[exudyn.MainSystem], tuple[float, float]]:
    """Return a function that reads spin angle [rad] and speed [rad/s] from the frame's node."""
    node, place, sign = int(body.nodes["rigid"]), body.locks.spin, body.locks.sign

    def spin(mbs: exudyn.MainSystem) -> tuple[float, float]:
        angles, rates = (
            mbs.GetNodeOutput(node, kind) for kind in (_KINDS.Coordinates, _KINDS.Coordinates_t)
        )
        return sign * float(angles[place]), sign * float(rates[place])

    return spin


def _rotation(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


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


def _symbolic(mbs: exudyn.MainSystem, function: Callable, item: object, name: str) -> object:
    """Return a function as Exudyn's symbolic one, kept alive by the system."""
    kind = type(item).__name__
    made = CreateSymbolicUserFunction(mbs, function, name, itemTypeName=kind)
    mbs.sys.setdefault(_FUNCTIONS, []).append(made)
    return made


def _point_marker(body: RotorBody, interface: str) -> exudyn.MarkerIndex:
    """Add a marker with the interface's mean displacement, its place on the axis."""
    place, motion, _ = interface_motion(body, interface)
    number = body.objects["marker_body"]
    nodes = append_nodes(body.mbs, number, place[None, :], motion[:3])
    return body.mbs.AddMarker(
        MarkerSuperElementPosition(
            bodyNumber=number, meshNodeNumbers=nodes, weightingFactors=[1.0], visualization=_HIDDEN
        )
    )


def _rigid_marker(body: RotorBody, interface: str) -> exudyn.MarkerIndex:
    """Add a marker with the mean displacement and rotation, on the axis, axes (n1, n2, e)."""
    place, motion, radius = interface_motion(body, interface)
    number = body.objects["marker_body"]
    axis = SpinAxis(body.frame.B @ body.axis.direction)
    nodes = append_nodes(body.mbs, number, *virtual_nodes(place, radius, motion, axis))
    return body.mbs.AddMarker(
        MarkerSuperElementRigid(
            bodyNumber=number,
            meshNodeNumbers=nodes,
            weightingFactors=[1.0 / 3.0] * 3,
            localHT=_frame(body.frame.B @ axes_of(body.axis)),
            visualization=_HIDDEN,
        )
    )
