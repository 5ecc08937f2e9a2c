"""Supports and bearings between a rotor in a scene and the ground or a foundation.

The same objects as in linear analyses, with the same meaning: an interface's mean displacement,
axes (n1, n2, e) of :attr:`SpinAxis.plane` as the rotor is mounted, frame 'inertial' or 'rotor'.
The spring is relaxed where the interface stands at rest with its centre on the axis.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing, bearing_of
from exudyn_rotor.bearings.given import Given, check_interfaces, given_supports
from exudyn_rotor.bearings.journal_bearing import JournalBearing
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.bearings.support import Support, acts, varies
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.known_rotor import carrying_rotor
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.supports.magnetic_connectors import add_magnetic
from exudyn_rotor.multibody.supports.seats import Base, Seat
from exudyn_rotor.multibody.supports.support_connectors import (
    PYTHON,
    bearing_connector,
    displacement_connector,
    tilt_connector,
)
from exudyn_rotor.multibody.supports.tilting_pads import add_pads

_PARALLEL = 1e-9  # of the cosine between axes of two rotors


@dataclass(frozen=True, eq=False)
class SceneSupport:
    """A support in a scene.

    Attributes
    ----------
    support : Support or bearing
    objects : tuple of ObjectIndex
        Its connectors: for displacements, for tilts, where it acts on them; of a magnetic bearing
        that of the magnets and the controller; of tilting pads their films and, last, the pads,
        whose coordinates are the tilts [rad].
    evaluation : tuple of str
        Who evaluates each of them in a time step.
    base : SceneFoundation, MarkerIndex, ObjectIndex or None
        What carries it; None for the ground.
    """

    support: Given
    objects: tuple[exudyn.ObjectIndex, ...]
    evaluation: tuple[str, ...]
    base: Base | None = None

    def own_coordinates(self, mbs: exudyn.MainSystem) -> np.ndarray:
        """Return where coordinates of its own are in an assembled system, shape (p,); else none."""
        if not isinstance(self.support, MagneticBearing | TiltingPadBearing):
            return np.zeros(0, dtype=int)
        return np.asarray(mbs.systemData.GetObjectLTGODE2(self.objects[-1]), dtype=int)

    def carrier_rotations(self, mbs: exudyn.MainSystem) -> np.ndarray:
        """Return which coordinates of an assembled system turn what carries pads; else none."""
        if not isinstance(self.support, TiltingPadBearing):
            return np.zeros(0, dtype=int)
        pad = mbs.GetMarker(mbs.GetObject(self.objects[0])["markerNumbers"][0])
        return np.asarray(mbs.systemData.GetObjectLTGODE2(pad["bodyNumber"])[3:6], dtype=int)

    @property
    def uses_python(self) -> bool:
        """True when a time step calls Python for it."""
        return PYTHON in self.evaluation

    def __str__(self) -> str:
        """Return interface and who evaluates it."""
        return f"{self.support.interface} by {', '.join(self.evaluation) or 'nothing'}"


def add_supports(
    body: RotorBody | FullRotorBody,
    supports: Sequence[Given] | Given,
    base: Base | Mapping[str, Base] | None = None,
) -> tuple[SceneSupport, ...]:
    """Put a rotor in a scene on the supports that linear analyses take.

    Call it before ``mbs.Assemble()``. Tables over the speed and supports in the rotor's frame
    follow the rotor's spin at every instant, prescribed or free.

    Parameters
    ----------
    body : RotorBody or FullRotorBody
        From :func:`exudyn_rotor.add_rotor`, with its marker body.
    supports : sequence of Support or bearings
        A bearing acts by its law at the rotor's place, velocity and spin; a support, too, where it
        depends on the spin.
    base : SceneFoundation, MarkerIndex, ObjectIndex, or mapping of interface to these, optional
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
    torque on a free spin, at twice the cost. A prescribed spin does not feel it, and the torque of
    its drive lacks it. What carries the bearing takes the reaction; where it turns about the axis,
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
    checks.instance(body, "body", (RotorBody, FullRotorBody), "add_rotor returns one")
    body.check_present()
    supports = given_supports(supports)
    if "marker_body" not in body.objects:
        raise ValueError(
            f"body: rotor {body.name!r} was added with marker_body=False; supports need the marker "
            "body"
        )
    check_interfaces(supports, body.selection.source.interfaces)
    for support in supports:
        if isinstance(support, Bearing):
            _check_law(body, _with_law(support))
        elif isinstance(support, Support):
            _check_about_the_axis(body, support)
    _check_base(body, base)
    seats = [Seat.of(body, support.interface, base) for support in supports]
    for support, seat in zip(supports, seats, strict=True):
        _check_on_rotor(body, support, seat)
    sensed = [_seat_of_sensor(body, support, base) for support in supports]
    added = tuple(
        _added(body, support, *places)
        for support, *places in zip(supports, seats, sensed, strict=True)
    )
    body.supports.extend(added)
    return added


def add_to(
    self: Given,
    body: RotorBody | FullRotorBody,
    interface: str | None = None,
    base: Base | Mapping[str, Base] | None = None,
) -> SceneSupport:
    """Put this support or bearing into a scene, as :func:`exudyn_rotor.add_supports` does.

    Parameters
    ----------
    body : RotorBody or FullRotorBody
        From :func:`exudyn_rotor.add_rotor`, with its marker body.
    interface : str, optional
        Where it acts on the rotor; its own `interface` by default.
    base : SceneFoundation, MarkerIndex, ObjectIndex, or mapping of interface to these, optional
        What carries it; the ground by default.

    Returns
    -------
    SceneSupport
        With the numbers of its connectors.

    Raises
    ------
    TypeError, ValueError
        As :func:`exudyn_rotor.add_supports`; nothing has been added then.
    """
    one = self if interface is None else replace(self, interface=interface)
    return add_supports(body, one, base)[0]


# here, since the laws of supports know no scenes
Support.add_to = Bearing.add_to = MagneticBearing.add_to = add_to


def _check_base(body: RotorBody | FullRotorBody, base: Base | Mapping[str, Base] | None) -> None:
    """Refuse a mapping with names that the rotor does not have."""
    names = body.selection.source.interfaces
    unknown = [name for name in base if name not in names] if isinstance(base, Mapping) else []
    if unknown:
        raise ValueError(
            f"base: {', '.join(map(repr, unknown))} is no interface of rotor {body.name!r}; it has "
            f"{', '.join(map(repr, names))}"
        )


def _with_law(bearing: Bearing) -> Bearing:
    """Return a bearing whose law scenes take: of tilting pads with inertia, that of one film."""
    if isinstance(bearing, TiltingPadBearing) and bearing.pad_inertia is not None:
        return bearing.pad_bearings[0]
    return bearing


def _check_law(body: RotorBody | FullRotorBody, bearing: Bearing) -> None:
    """Refuse a bearing without a law for scenes, and one that could not brake a free spin."""
    remembers = isinstance(bearing, JournalBearing) and bearing.remembers
    turns = remembers or (bearing.law and bearing.law_with_torque is not None)
    interface = body.selection.source.interfaces[bearing.interface]
    if turns and body.formulation.has_spin and interface.radius == 0.0:
        raise ValueError(
            f"support at {bearing.interface!r}: its torque would not brake the free spin, since "
            "the interface is a single node, which has no rotation; make the interface of three "
            "nodes or more, or prescribe the spin"
        )


def _check_about_the_axis(body: RotorBody | FullRotorBody, support: Support) -> None:
    """Refuse what acts against the rotation of a frame whose spin is free."""
    if not body.formulation.has_spin:
        return
    stiffness, damping = support.matrices(body.plan.setup.placement.speed)
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


def _check_on_rotor(body: RotorBody | FullRotorBody, support: Given, seat: Seat) -> None:
    """Refuse what another rotor cannot carry: its markers have axes that turn."""
    rotor = carrying_rotor(body.mbs, seat.base)
    if rotor is None:
        return
    where = f"base: the support at {support.interface!r} stands on another rotor"
    tilts = isinstance(support, Support) and (
        acts(support.tilt_stiffness) or acts(support.tilt_damping)
    )
    across = isinstance(support, Support) and not tilts
    if not across and abs(rotor.axis @ seat.axes[:, 2]) < 1.0 - _PARALLEL:
        raise ValueError(
            f"{where}, whose axis is not parallel to that of rotor {body.name!r}; mount both on "
            "parallel axes"
        )
    if isinstance(support, TiltingPadBearing | MagneticBearing):
        raise ValueError(
            f"{where}, with which its pads or magnets would turn; give another bearing there"
        )
    bearing = bearing_of(support)
    if bearing is not None and not isinstance(bearing, RollingBearing):
        raise ValueError(
            f"{where}, and has the coefficients of a {type(bearing).__name__} whose bore is at "
            "rest; give the bearing itself"
        )
    if tilts and not _is_alike_in_all_tilts(support):
        raise ValueError(
            f"{where}, against whose tilts it has to be constant and alike in all directions, "
            "without tilt_damping and without moments about the axis; between rotors of one speed "
            "connect_rotors with a FlexibleCoupling has torsion, tilts and their damping"
        )


def _is_alike_in_all_tilts(support: Support) -> bool:
    """Return whether the moments of a support are the same in axes that turn."""
    given = support.tilt_stiffness, support.tilt_damping
    if support.frame == "rotor" or any(map(varies, given)) or acts(support.tilt_damping):
        return False
    K = support.matrices(0.0)[0][3:, 3:]
    about = np.any(K[2]) or np.any(K[:, 2])
    return not about and K[0, 0] == K[1, 1] and K[0, 1] == -K[1, 0]


def _seat_of_sensor(
    body: RotorBody | FullRotorBody, support: Given, base: Base | Mapping[str, Base] | None
) -> Seat | None:
    """Return where the sensors of a magnetic bearing are; the bearing's base carries them."""
    if not isinstance(support, MagneticBearing):
        return None
    given = base.get(support.interface) if isinstance(base, Mapping) else base
    apart = support.sensor_interface != support.interface
    if apart and isinstance(given, exudyn.MarkerIndex):
        raise ValueError(
            f"base: the magnetic bearing at {support.interface!r} has its sensors at "
            f"{support.sensor!r}, where a marker has no place; give the rigid body itself"
        )
    return Seat.of(body, support.sensor_interface, given)


def _added(
    body: RotorBody | FullRotorBody, support: Given, seat: Seat, sensed: Seat | None
) -> SceneSupport:
    mbs, parts = body.mbs, []
    if isinstance(support, MagneticBearing):
        items = add_magnetic(body, support, seat, seat.marker(mbs), sensed.marker(mbs))
        return SceneSupport(support, items, (PYTHON, PYTHON), seat.base)
    if isinstance(support, TiltingPadBearing):
        return SceneSupport(support, *add_pads(body, support, seat), seat.base)
    if isinstance(support, Bearing):
        item = bearing_connector(body, support, seat, seat.marker(mbs))
        return SceneSupport(support, (item,), (PYTHON,), seat.base)
    across = support.stiffness, support.damping
    tilts = support.tilt_stiffness, support.tilt_damping
    if not any(map(acts, (*across, *tilts))):
        return SceneSupport(support, (), (), seat.base)
    base = seat.marker(mbs)
    if any(map(acts, across)):
        parts.append(displacement_connector(body, support, seat, base))
    if any(map(acts, tilts)):
        parts.append(tilt_connector(body, support, seat, base))
    objects, evaluation = zip(*parts, strict=True)
    return SceneSupport(support, objects, evaluation, seat.base)
