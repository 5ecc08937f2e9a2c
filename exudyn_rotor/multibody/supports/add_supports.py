"""Supports and bearings between a rotor in a scene and the ground or a foundation.

The same objects as in linear analyses, with the same meaning: an interface's mean displacement,
axes (n1, n2, e) of :attr:`SpinAxis.plane` as the rotor is mounted, frame 'inertial' or 'rotor'.
The spring is relaxed where the interface stands at rest with its centre on the axis.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, bearing_of
from exudyn_rotor.bearings.given import Given, check_interfaces, given_supports
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.bearings.series import FloatingRingBearing, SeriesSupport
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.calls import user_level
from exudyn_rotor.multibody.supports.connector import (
    CURRENT,
    PYTHON,
    BearingConnector,
    Body,
    MagneticConnector,
    SceneLaw,
    SupportConnector,
    check_body,
    has_torque,
    watch_clearance,
)
from exudyn_rotor.multibody.supports.ends import Base, RotorEnd, Seat
from exudyn_rotor.multibody.supports.native import native_parts

_PARALLEL = 1e-9  # of the cosine between axes of two rotors
_OF_NO_FORCE = "objectType", "name", "markerNumbers", "nodeNumber", "V"  # parameters of connectors


@dataclass(frozen=True, eq=False)
class SceneSupport(SceneLaw):
    """A support in a scene.

    Of a linear support its `objects` are those that Exudyn evaluates, for displacements and for
    tilts, and one for the rest; of a bearing the one with its law.

    Attributes
    ----------
    body, objects, evaluation, connector
        See :class:`SceneLaw`.
    support : Support or bearing
    base : SceneFoundation, MarkerIndex, ObjectIndex or None
        What carries it; None for the ground.
    """

    support: Given
    base: Base | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.keep(self, _made=self._parameters())

    def _parameters(self) -> dict[str, list]:
        """Return what connectors of Exudyn have for this support, each name's values in a list."""
        found: dict[str, list] = {}
        for number, by in zip(self.objects, self.evaluation, strict=True):
            for name, value in () if by == PYTHON else self.body.mbs.GetObject(number).items():
                if not name.startswith(_OF_NO_FORCE):
                    value = value.tolist() if isinstance(value, np.ndarray) else value
                    found.setdefault(name, []).append(value)
        return found

    def check_present(self) -> None:
        """Raise ValueError where objects were deleted, switched off, or got other parameters."""
        super().check_present()
        if changed := self._changed():
            raise ValueError(
                f"{changed}, which analyses do not follow: build the scene anew with the Support "
                "that is meant, or without what is switched off"
            )

    def _changed(self) -> str:
        """Return which parameters of its connectors is not as it was added; nothing where none."""
        now, where = self._parameters(), f"support at {self.support.interface!r}"
        names = ", ".join(each for each in now if now[each] != self._made.get(each))
        named = f"mbs: rotor {self.body.name!r}, {where}: {names} of its connector was changed"
        return named if names else ""

    def own_coordinates(self, mbs: exudyn.MainSystem) -> np.ndarray:
        """Return where coordinates of its own are in an assembled system, shape (p,); else none."""
        made = self.connector
        places = mbs.systemData.GetNodeLTGODE2(made.nodes[-1]) if made.own else ()
        return np.asarray(places, dtype=int)

    def values(
        self, configuration: exudyn.ConfigurationType = CURRENT
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return displacement [m], velocity [m/s] and force [N] on the rotor there, each (3,).

        Along (n1, n2, e). Displacement and velocity are those against the base. The force is NaN,
        with a warning, where parameters of its connectors are not as they were added.
        """
        self.body.check_assembled()
        made, mbs = self.connector, self.body.mbs
        made.read(*made.state(mbs, configuration))
        place, rate = (each[:3] for each in made.motion)
        force = np.array(made.wrench(mbs.systemData.GetTime(configuration))[:3])
        if changed := self._changed():
            warnings.warn(f"{changed}; the force of the Support is NaN", stacklevel=user_level())
            force[:] = np.nan
        return place, rate, force

    def __str__(self) -> str:
        """Return interface and who evaluates it."""
        return f"{self.support.interface} by {', '.join(self.evaluation) or 'nothing'}"


def add_supports(
    body: Body,
    supports: Sequence[Given] | Given,
    base: Base | None = None,
) -> tuple[SceneSupport, ...]:
    """Put a rotor in a scene on the supports that linear analyses take.

    Call it before ``mbs.Assemble()``. Tables over the speed, and supports in the rotor's frame,
    follow the rotor's spin at every instant, prescribed or free.

    Parameters
    ----------
    body : RotorBody or FullRotorBody
        From :func:`exudyn_rotor.add_rotor`, with its marker body.
    supports : sequence of Support or bearings
        A bearing acts by its law at the rotor's place, velocity and spin; a support, too, where it
        depends on the spin.
    base : SceneFoundation, MarkerIndex or ObjectIndex, optional
        What carries them: a foundation, by its point of the interface's name; a marker at the place
        of the interface, along the axis to a hundredth of its radius, as a mesh may shift it, also
        that of another rotor; a rigid body, which gets such a marker; the ground by default. Forces
        act along the inertial axes, also where the base tilts.

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
    is driven there: its reaction does not act on a free spin. Those that stand still and act
    against tilts have no moment about the shaft's own axis, whatever its tilt.

    The friction of journal films and stops, and what a rolling bearing's contacts store, act as a
    torque on a free spin. A prescribed spin does not feel it; ``add_drive_torque_sensor`` has it.
    What carries the bearing takes the reaction; where it turns about the axis,
    bearings see the spin against it, a prescribed one but on a foundation, which hardly turns. The
    force of a bearing pulls at the middles of journal and bore, so that about the axis the base
    lacks the moment ``u × F`` of their distance u.

    On a marker of another rotor (an inter-shaft bearing) the bore, with its grooves, or the outer
    ring turns with that rotor; of a body of Exudyn that turns, bearings see the rate alone. Tables
    of a `Support` on another rotor are over the difference of the speeds, as those of a
    :class:`Link`.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import Support, add_rotor, add_supports, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(1), spin=50.0)
    >>> springs = [Support("left", 2e4 * np.eye(3)), Support("right", [[2e4, 1e3], [-1e3, 2e4]])]
    >>> print(*add_supports(body, springs), sep=" and ")
    left by Exudyn and right by symbolic function
    """
    check_body(body, "body")
    supports = given_supports(supports)
    check_interfaces(supports, body.selection.source.interfaces)
    seats = []
    for support in supports:
        where = f"support at {support.interface!r}"
        if fault := _fault(body, support):
            raise ValueError(f"{where}: {fault}")
        # the bearing's base carries the sensors of a magnetic bearing
        sensor = getattr(support, "sensor_interface", support.interface)
        seats.append([Seat.of(body, name, base) for name in (support.interface, sensor)])
        seat = seats[-1][0]
        if seat.rotor is not None and (fault := _fault_on_rotor(body, support, seat)):
            raise ValueError(f"base: the {where} stands on another rotor, which {fault}")
    pairs = zip(supports, seats, strict=True)
    added = tuple(_added(body, support, *places) for support, places in pairs)
    body.supports.extend(added)
    return added


def _fault(body: Body, support: Given) -> str:
    """Return why a support has no force by the coordinates of a scene; nothing where it has."""
    free = body.formulation.has_spin
    if isinstance(support, SeriesSupport | FloatingRingBearing):
        return (
            "has a ring, which is a body of a scene: add the ring as a rotor with the outer "
            "bearing, and give the inner one base=ring.marker(…)"
        )
    if isinstance(support, TiltingPadBearing) and support.pad_inertia is None:
        support.law(*6 * (0.0,))  # which says what there is instead
    turns = body.selection.source.interfaces[support.interface].radius > 0.0
    if isinstance(support, Bearing) and has_torque(support) and free and not turns:
        return (
            "its torque would not brake the free spin, since the interface is a single node, which "
            "has no rotation; make the interface of three nodes or more, or prescribe the spin"
        )
    if not isinstance(support, Support):
        return ""
    if support.over_frequency:
        return (
            "a scene has no single frequency, which its coefficients need; give "
            "support.at_frequency(…), e.g. of the motion of interest, or what has states of its "
            "own: a MagneticBearing, pads with pad_inertia, a SeriesSupport"
        )
    M = support.mass_matrix(0.0)
    if np.any(M - M[0, 0] * np.diag([1.0, 1.0, 0.0, 0.0, 0.0, 0.0])):
        return "mass: a scene takes one number, alike across the axis [kg], got a matrix"
    acting = zip(("stiffness", "damping"), support.matrices(body.placement.speed), strict=True)
    about = [kind for kind, X in acting if np.any(X[5]) or np.any(X[:, 5])]
    # what stands still may brake the spin
    if free and ("stiffness" in about or (about and support.frame == "rotor")):
        return (
            f"{about[0]} about the spin axis needs a prescribed spin, and that of rotor "
            f"{body.name!r} is free; use a matrix with zeros there, or a torsional spring on the "
            "frame's node"
        )
    return ""


def _fault_on_rotor(body: Body, support: Given, seat: Seat) -> str:
    """Return why another rotor cannot carry a support, or nothing."""
    linear = isinstance(support, Support)
    tilts, bearing = linear and support.tilts, bearing_of(support)
    skew = abs(seat.rotor.standing_axes[:, 2] @ seat.axes[:, 2]) < 1.0 - _PARALLEL
    if skew and (tilts or not linear):
        return f"has an axis that is not parallel to that of rotor {body.name!r}; turn it"
    if isinstance(support, TiltingPadBearing | MagneticBearing):
        return "would turn with its pads or magnets; give another bearing there"
    if bearing is not None and not isinstance(bearing, RollingBearing):
        return (
            f"turns, unlike the bore whose coefficients are those of a {type(bearing).__name__}; "
            "give the bearing itself"
        )
    if tilts and any(np.any(X[5]) or np.any(X[:, 5]) for X in support.matrices(0.0)):
        return (
            "would be held about the axis; between rotors of one speed connect_rotors with a "
            "FlexibleCoupling has torsion"
        )
    return ""


def _added(body: Body, support: Given, seat: Seat, sensed: Seat) -> SceneSupport:
    mbs, end, base = body.mbs, RotorEnd(body, support.interface), seat.end
    if isinstance(support, Support):
        parts, left = native_parts(body, support, seat)
        on_rotor = seat.rotor is not None
        made = SupportConnector(support, end, base, on_rotor)
        if left is not None:
            ends = copy(end), copy(base)  # of its own: each knows what it has read last
            rest = made if left is support else SupportConnector(left, *ends, on_rotor)
            parts.append((mbs.AddObject(rest.item(made)), PYTHON))
        objects, evaluation = zip(*parts, strict=True) if parts else ((), ())
        return SceneSupport(body, objects, evaluation, made, support, seat.base)
    if isinstance(support, MagneticBearing):
        sensors = end, base
        if support.sensor_interface != support.interface:
            sensors = RotorEnd(body, support.sensor_interface), sensed.end
        made = MagneticConnector(support, (end, base), sensors, mbs)
    else:
        made = BearingConnector(support, end, base, mbs, body.formulation.has_spin)
    watch_clearance(body, made)
    number = mbs.AddObject(made.item())
    return SceneSupport(body, (number,), (PYTHON,), made, support, seat.base)
