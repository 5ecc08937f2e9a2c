"""Rotor bodies in an Exudyn ``mbs``: report, markers, sensors, motion over a run, and start."""

from __future__ import annotations

import os
import warnings
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import SensorMarker, SensorNode, SensorSuperElement, SensorUserFunction
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor.connections import ConnectionWarning, lost_connections
from exudyn_rotor.multibody.rotor.plan import LOCKS, MARKER_KINDS, check_free
from exudyn_rotor.multibody.rotor.rotor_items import (
    RATES,
    Carrier,
    RotorItems,
    carrier_of,
    interface_of_nodes,
    nodes_of,
)
from exudyn_rotor.theory.formulation import ConstantSpeed

_KINDS = exudyn.OutputVariableType


@dataclass(frozen=True, eq=False)
class Record:
    """Motion of a rotor at the recorded instants.

    Attributes
    ----------
    time : ndarray, shape (s,)
        [s]
    q, q_t, q_tt : ndarray, shape (s, n)
        Coordinates of the body's nodes, those that are locked included.
    speed : ndarray, shape (s,)
        Spin speed [rad/s].
    """

    time: np.ndarray
    q: np.ndarray
    q_t: np.ndarray
    q_tt: np.ndarray
    speed: np.ndarray


_SAME = 1e-9  # share of the speed, and rad, by which start and prescribed spin may differ


@dataclass(frozen=True, eq=False)
class StartState(checks.Checked):
    """Coordinates and velocities of a scene at one angle of a rotor.

    Attributes
    ----------
    q, q_t : ndarray, shape (n,)
        All coordinates of second order of the ``mbs``, and their velocities.
    angle : float
        Spin angle of the rotor [rad].
    speed : float
        Its spin speed [rad/s].

    Examples
    --------
    :func:`exudyn_rotor.steady_state` makes one, and so do the responses of linear analyses
    (:meth:`UnbalanceResponse.state`); :meth:`RotorBody.start_from` takes it.

    >>> from exudyn_rotor import StartState
    >>> StartState([0.0, 1e-3], [0.0, 0.1], angle=0.0, speed=100.0).q_t
    array([0. , 0.1])
    """

    q: np.ndarray = checks.numbers("coordinates")
    q_t: np.ndarray = checks.numbers("coordinates")
    angle: float
    speed: float


def keep_in_node(mbs: exudyn.MainSystem, number: int, state: StartState) -> None:
    """Write the state into a node, so that it outlives ``mbs.Assemble()``."""
    node = mbs.GetNode(number)
    # one of them, by the kind of the node; nodes of the ground, or of data, have neither
    for velocities in {"initialVelocities", "initialCoordinates_t"} & node.keys():
        first = mbs.GetNodeODE2Index(number)
        place = slice(first, first + len(node[velocities]))
        mbs.SetNodeParameter(number, "initialCoordinates", state.q[place].tolist())
        mbs.SetNodeParameter(number, velocities, state.q_t[place].tolist())


def _warn_of_static_stress(body: RotorItems, output: exudyn.OutputVariableType) -> None:
    """Warn where a native stress sensor leaves out a static stress that the rotor was given."""
    spin = body.formulation.spin
    at_rest = isinstance(spin, ConstantSpeed) and spin.speed == 0.0
    # K2 is what a body keeps of a prestress
    if output != _KINDS.StressLocal or at_rest or body.selection.invariants.K2 is None:
        return
    warnings.warn(
        f"rotor {body.name!r}: Exudyn's stress sensor shows the stress of the modes alone, without "
        "the static centrifugal stress that they do not hold; record the modal coordinates and use "
        "StressField.of(reduced, body) with stress_history",
        UserWarning,
        stacklevel=3,
    )


def _external_moment(
    body: RotorItems,
    t: float,
    q: np.ndarray,
    q_t: np.ndarray,
    configuration: exudyn.ConfigurationType,
) -> float:
    """Return the external moment about e [N m].

    The locked spin collects it, but for those of gravity by the deflection Sζ, which Exudyn's load
    leaves out, and of the friction of bearings and stops, which a prescribed spin does not feel.
    """
    mbs, motion, spin = body.mbs, body.motion, body.locks.spin
    accelerations = mbs.GetNodeOutput(body.nodes["rigid"], _KINDS.Coordinates_tt, configuration)
    moment = body.layout.lock_mass[spin] * float(accelerations[spin])
    if body.guide is not None:
        moment -= body.guide(t)[spin]
    if body.constraints:
        number = body.constraints.get("spin", body.constraints[LOCKS])
        # the spin is the last that a constraint of several holds
        moment += float(np.ravel(mbs.GetObjectOutput(number, _KINDS.Force))[-1])
    if body.gravity_load is not None:
        at, gravity = motion.at(t, q, q_t), mbs.GetLoadParameter(body.gravity_load, "loadVector")
        moment += float(at.A @ (motion.S1 @ at.zeta) @ gravity)
    for made in (one.connector for one in body.supports):
        made.read(*made.state(mbs, configuration))
        moment += made.friction()
    return moment


def sensor_options(body: RotorItems, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of a sensor, checked; it is stored internally by default."""
    body.check_present()
    known = ("name", "storeInternal", "writeToFile", "fileName")
    for option in options:
        if option not in known:
            raise TypeError(f"{option}: is no option of this sensor; it takes {', '.join(known)}")
    settings = {"storeInternal": True, "writeToFile": False} | options
    for option in ("storeInternal", "writeToFile"):
        checks.flag(settings[option], option)
    if "fileName" in settings:
        settings["fileName"] = os.fspath(checks.path(settings["fileName"], "fileName"))
    if "name" in settings:
        check_free(settings["name"], "sensor", body.mbs.GetSensorNumber)
    return settings


def add_sensor(
    body: RotorItems, kind: type, options: Mapping[str, Any], **item: Any
) -> exudyn.SensorIndex:
    """Add a sensor of a kind, of what `item` says; Exudyn refuses unsuited outputs in Assemble."""
    if "outputVariableType" in item:
        checks.instance(item["outputVariableType"], "output", _KINDS)
    return body.mbs.AddSensor(kind(**item, **sensor_options(body, options)))


@dataclass(frozen=True, eq=False, repr=False)
class SceneBody(RotorItems, ABC):
    """A rotor body in a scene, reduced or full."""

    def __repr__(self) -> str:
        """Return one line; :meth:`report` says more."""
        return (
            f"{type(self).__name__}({self.name!r}, Sect. {self.formulation.section}, "
            f"stiffening {self.stiffening!r}, {self._coordinates_in_words()[0]}, "
            f"markers: {', '.join(self.markers) or 'none'})"
        )

    @abstractmethod
    def _coordinates_in_words(self) -> tuple[str, list[str]]:
        """Return the number of modes or nodes, and lines of :meth:`report` about them."""

    @abstractmethod
    def _nodes_carrier(self, where: Sequence[int], kind: str) -> Carrier:
        """Return what moves with the mean rigid motion of mesh nodes."""

    @property
    def uses_python(self) -> bool:
        """True when a time step calls Python user functions, of the rotor or its supports."""
        return not self.motion.is_constant or any(
            each.uses_python for each in (*self.supports, *self.drives)
        )

    def report(self) -> str:
        """Return a short table of what was added and what it means at run time."""
        names = {3: "x, y, z", 2: "two in the plane of rotation", 0: "none"}
        lines = [
            f"rotor {self.name!r}: Sect. {self.formulation.section}, "
            f"stiffening {self.stiffening!r}",
            f"  translations   {names[self.formulation.translation_count]}",
            f"  spin           {'unknown' if self.formulation.has_spin else 'prescribed'}",
            *self._coordinates_in_words()[1],
            f"  locked         {', '.join(self.locks.locked_names) or 'none'}",
            f"  constraints    {len(self.constraints)}",
            f"  supports       {'; '.join(map(str, self.supports)) or 'none added'}",
            *([f"  drives         {'; '.join(map(str, self.drives))}"] if self.drives else []),
            f"  per step       {'Python user functions' if self.uses_python else 'no Python call'}",
        ]
        return "\n".join(lines)

    def check_connections(self, *, warn: bool = True) -> tuple[str, ...]:
        """Return what the scene attaches to the rotor that it cannot carry.

        Loads and connectors on coordinates of the frame's node that are locked (tilts, translations
        that the formulation does not have) or that move the centre of mass and not the node's
        place, dampers of tilts at the node, forces at a marker's own offset that has no lever, and
        sensors of the node that show no tilts: one sentence for each, with what to use instead.
        Exudyn's own body carries them.
        ``mbs.Assemble()`` warns of each once, and :func:`exudyn_rotor.check_run` has a row of this.

        Parameters
        ----------
        warn : bool
            Whether there is a ConnectionWarning for each.

        Raises
        ------
        ValueError
            If the system is not assembled.
        """
        checks.flag(warn, "warn")
        self.check_assembled()
        lost = lost_connections(self)
        for sentence in lost if warn else ():
            warnings.warn(f"rotor {self.name!r}: {sentence}", ConnectionWarning, stacklevel=2)
        return lost

    def add_marker(
        self,
        where: str | Sequence[int],
        offset: ArrayLike = (0.0, 0.0, 0.0),
        *,
        kind: str = "rigid",
        name: str | None = None,
        show: bool = True,
    ) -> exudyn.MarkerIndex:
        """Add a marker that moves with the mean rigid motion of an interface or of mesh nodes.

        Its axes are those of the mesh, for every spin axis; forces at an offset have their whole
        lever, which they lack at the offset of a ``MarkerSuperElementRigid``; and its cost does not
        depend on the number of nodes. On a full body, every new place has twelve unknowns of its
        own.

        Parameters
        ----------
        where : str or sequence of int
            Interface, with or without a marker yet, or mesh nodes, which count alike.
        offset : array_like, shape (3,)
            From the interface's reference point or the mean of the nodes, mesh axes [m].
        kind : {'rigid', 'position'}
        name : str, optional
        show : bool
            Whether it is drawn.

        Raises
        ------
        TypeError, ValueError
            For bad input, e.g. nodes on a line for a rigid marker; nothing has been added then.
        """
        self.check_present()
        shift = self.frame.B @ checks.vector(offset, "offset", "m")
        checks.choice(kind, "kind", MARKER_KINDS)
        checks.flag(show, "show")
        if name is not None:
            check_free(name, "marker", self.mbs.GetMarkerNumber)
        if not isinstance(where, str):
            point = self._nodes_carrier(where, kind)
        else:
            known = tuple(self.selection.source.interfaces)
            point = self.interface_carrier(checks.choice(where, "where: interface", known))
        if np.any(shift):
            point = point.shifted(shift)
        return point.add_marker(self.mbs, kind, self.frame.B, name=name or "", show=show)

    def add_interface_sensor(self, interface: str, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at an interface's marker; `options` go to ``SensorMarker``."""
        marker = self.marker(interface)
        return add_sensor(
            self, SensorMarker, options, markerNumber=marker, outputVariableType=output
        )

    def add_spin_sensor(self, **options):
        """Add a sensor of spin angle [rad] and spin speed [rad/s]."""
        node, index = self.nodes["rigid"], self.locks.spin

        def spin(mbs, t, sensors, factors, configuration):
            angle = mbs.GetNodeOutput(node, _KINDS.Coordinates, configuration)[index]
            speed = mbs.GetNodeOutput(node, _KINDS.Coordinates_t, configuration)[index]
            return [float(angle), float(speed)]

        return add_sensor(self, SensorUserFunction, options, sensorUserFunction=spin)

    def add_drive_torque_sensor(self, **options):
        """Add a sensor of the torque about e that a prescribed spin needs [N m].

        The torque is the rotor's own share (the row of θ in (84–86)) minus the moment of all
        external forces, which the locked coordinate of the flexible body collects, and minus the
        friction of bearings and stops, which the motion of a prescribed spin does not feel. Not in
        static solutions: Exudyn's static solver returns multipliers with the opposite sign.
        Explicit solvers have no accelerations at the first instant, so the first value is wrong
        with them.
        """
        if self.formulation.has_spin:
            raise ValueError(
                f"rotor {self.name!r} spins freely and has no drive; a prescribed spin has one"
            )

        def torque(mbs, t, given, factors, configuration):
            q, q_t, q_tt = self.coordinates(configuration)
            needed = self.motion.drive_torque(t, q, q_t, q_tt[self.motion.modes])
            return [needed - _external_moment(self, t, q, q_t, configuration)]

        return add_sensor(self, SensorUserFunction, options, sensorUserFunction=torque)

    def add_energy_sensor(self, **options):
        """Add a sensor of kinetic energy, elastic energy and the potential of the weight [J].

        The kinetic energy is that in the inertial frame, with the spin. The weight's potential is
        zero where the rotor stands at the start, undeformed and at θ = 0. The sum changes by the
        work of all other loads and of a prescribed motion (``add_drive_torque_sensor`` gives its
        torque), less what damping takes; a drift without these is the integrator's error.
        """

        def energy(mbs, t, sensors, factors, configuration):
            q, q_t, _ = self.coordinates(configuration)
            gravity = self.gravity
            if self.gravity_load is not None:  # a script may change it
                gravity = mbs.GetLoadParameter(self.gravity_load, "loadVector")
            energy = self.motion.energy(t, q, q_t, gravity)
            return list(energy)

        return add_sensor(self, SensorUserFunction, options, sensorUserFunction=energy)

    def start_recording(self) -> None:
        """Record all coordinates of the coming run, for :func:`exudyn_rotor.check_run`.

        Adds native sensors, so call it before ``mbs.Assemble()``. They store as often as
        ``solution.sensors.writePeriod`` says, which decides how much memory a full body takes; a
        step calls no Python for them.
        """
        self.check_present()
        if self.record_sensors:
            return
        if self.mbs.systemIsConsistent:
            raise ValueError(
                f"start_recording: the system of rotor {self.name!r} is assembled already; call "
                "this before mbs.Assemble()"
            )
        for node in self.nodes.values():
            for kind in RATES:
                item = SensorNode(
                    nodeNumber=node, outputVariableType=kind, storeInternal=True, writeToFile=False
                )
                self.record_sensors[int(node), kind] = self.mbs.AddSensor(item)

    def recorded(self) -> Record:
        """Return what :meth:`start_recording` recorded; without it the current state alone."""
        self.check_assembled()
        mbs, nodes = self.mbs, self.nodes.values()

        def rows(node: exudyn.NodeIndex, kind: exudyn.OutputVariableType) -> np.ndarray:
            """Return the time and what a node has, (s, 1 + n)."""
            if self.record_sensors:
                stored = mbs.GetSensorStoredData(self.record_sensors[int(node), kind])
                if np.ndim(stored) == 2 and len(stored) > 1:
                    return stored
            return np.append(mbs.systemData.GetTime(), mbs.GetNodeOutput(node, kind))[None]

        time = rows(self.nodes["rigid"], RATES[0])[:, 0]
        parts = [np.hstack([rows(node, kind)[:, 1:] for node in nodes]) for kind in RATES]
        if self.formulation.has_spin:
            speed = parts[1][:, self.locks.spin]
        else:
            speed = np.array([float(self.formulation.spin.rate(t)) for t in time])
        return Record(time, *parts, speed)


@dataclass(frozen=True, eq=False, repr=False)
class RotorBody(SceneBody):
    """A fixed-axis rotor inside an ``mbs``; made by :func:`exudyn_rotor.add_rotor`.

    Attributes
    ----------
    mbs : exudyn.MainSystem
    name : str or None
    formulation : Formulation
        Which coordinates the rotor has.
    stiffening : str
        Level of the centrifugal stiffening.
    gravity : ndarray, shape (3,)
        As it was asked for, inertial axes [m/s²].
    selection : Selection
        The component modes in use; ``selection.labels`` names the modal coordinates.
    motion : Motion
        Equations of motion, inertial and mesh axes.
    frame, locks, layout
        Where mesh, flexible body and scene stand to each other; what happens to the six rigid
        coordinates of the flexible body; where the unknowns stand among the nodes' coordinates.
    nodes : mapping of str
        ``'rigid'`` (frame), and ``'modes'`` (modal coordinates) or ``'fields'`` (displacements).
    objects : mapping of str
        ``'physics'`` (the equations) and ``'marker_body'`` (markers, sensors, drawing).
    constraints : mapping of str
        Locking constraints, where ``locking='constraints'``: ``'locks'`` holds what stands still
        or turns at a constant speed; motions that vary with time have one each.
    gravity_load : LoadIndex or None
        None without gravity, and where it is part of the equations (``motion.gravity``): for a free
        spin without translation.
    mesh_node_count : int
        Mesh nodes that native sensors can be put at.
    markers : dict of str
        Marker number of every interface.
    supports : list
        What :func:`exudyn_rotor.add_supports` added.
    drives : list
        What :func:`exudyn_rotor.add_drive` added.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, add_rotor
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(6), 1e6 * np.eye(6), [[0.1, 0, 0], [-0.1, 0, 0]], "z", interfaces={"top": [0]}
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(2), name="fan", spin=10.0, translation="none")
    >>> displacement = body.add_interface_sensor("top", exudyn.OutputVariableType.Displacement)
    >>> force = mbs.CreateForce(itemNumber=body.marker("top"), loadVector=[0.0, 0.0, 5.0])
    >>> body.locks.locked_names
    ('x', 'y', 'z', 'tilt a', 'tilt b', 'spin')
    >>> body.uses_python
    False
    """

    def _coordinates_in_words(self) -> tuple[str, list[str]]:
        labels = self.selection.labels
        return f"{len(labels)} modes", [f"  modes          {len(labels)}: {', '.join(labels)}"]

    def _nodes_carrier(self, where: Sequence[int], kind: str) -> Carrier:
        """Return what moves with the mean rigid motion of mesh nodes."""
        count, body = self.mesh_node_count, self.objects["marker_body"]
        if not count:
            raise ValueError(
                f"where: rotor {self.name!r} has no shapes (without_shapes), "
                f"so no mesh nodes; name an interface, got {checks.shown(where)}"
            )
        interface = interface_of_nodes(nodes_of(self.mbs, body)[:count], where, kind)
        return carrier_of(self.mbs, body, interface)

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType, **options):
        """Add a native sensor at a mesh node; `options` go to ``SensorSuperElement``.

        ``StressLocal`` needs a rotor of ``reduce(…, stress=True)``. Stress in Exudyn, here and in
        contour plots, is that of the modal coordinates alone, without the static centrifugal stress
        that the modes do not show; for a rotor with a prestress that warns.
        :class:`exudyn_rotor.StressField` gives the whole.
        """
        marker_body, count = self.objects["marker_body"], self.mesh_node_count
        if checks.count(node, "node", least=-1) not in range(count):
            there = f"mesh nodes 0 … {count - 1}" if count else "no shapes, so no mesh nodes"
            raise ValueError(f"node: rotor {self.name!r} has {there}, got {node}")
        at = {"bodyNumber": marker_body, "meshNodeNumber": int(node)}
        made = add_sensor(self, SensorSuperElement, options, outputVariableType=output, **at)
        _warn_of_static_stress(self, output)
        return made

    def start_from(self, state: StartState) -> None:
        """Make a state of the whole scene the initial state of the coming runs.

        Coordinates and velocities of all bodies are set, in the assembled system and in its nodes,
        so that they outlive another ``mbs.Assemble()``.

        Parameters
        ----------
        state : StartState
            Of this system: ``steady_state(body).state()``, or ``state(point, body)`` of the result
            of :func:`periodic_response`.

        Raises
        ------
        TypeError, ValueError
            For a system without a state yet, a state of another system, or one that does not agree
            with the rotor's prescribed spin.
        """
        checks.instance(state, "state", StartState, "steady_state(body).state() makes one")
        self.check_assembled()
        data = self.mbs.systemData
        size = len(np.atleast_1d(data.GetODE2Coordinates()))
        if len(state.q) != size:
            raise ValueError(
                f"state: has {len(state.q)} coordinates, this system has {size}; it belongs to "
                "another system, or items were added since"
            )
        if not self.formulation.has_spin:
            angle, speed = self.placement.angle, self.placement.speed
            if abs(state.angle - angle) > _SAME or abs(state.speed - speed) > _SAME * abs(speed):
                raise ValueError(
                    f"state: is one at {state.angle:g} rad and {state.speed:g} rad/s, the "
                    f"prescribed spin starts at {angle:g} rad and {speed:g} rad/s"
                )
        for configuration in (exudyn.ConfigurationType.Initial, exudyn.ConfigurationType.Current):
            data.SetODE2Coordinates(state.q, configuration)
            data.SetODE2Coordinates_t(state.q_t, configuration)
        for number in range(data.NumberOfNodes()):
            keep_in_node(self.mbs, number, state)
