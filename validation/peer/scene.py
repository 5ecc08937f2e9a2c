"""A peer scene: the same script with Exudyn's call and with the swapped one, run and compared."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface, ObjectFFRFreducedOrderInterface
from exudyn.itemInterface import (
    LoadMassProportional,
    MarkerBodyMass,
    MarkerSuperElementPosition,
    MarkerSuperElementRigid,
    SensorMarker,
    SensorSuperElement,
)

from exudyn_rotor import ObjectFixedAxisFFRFreducedOrderInterface, RotorBody
from validation.peer import parts

ORIGINAL = "CreateFFRFReducedOrderObject"
SWAPPED = "CreateFixedAxisFFRFReducedOrderObject"
# the other way to add a body, and what its arguments are called there
CLASSES = {
    ORIGINAL: ObjectFFRFreducedOrderInterface,
    SWAPPED: ObjectFixedAxisFFRFreducedOrderInterface,
}
_NAMES = {"referencePosition": "positionRef", "referenceRotationMatrix": "rotationMatrixRef"}
Vector = Sequence[float]


@dataclass(frozen=True)
class Flexible:
    """What a script knows of a flexible body: its numbers in the ``mbs``.

    Attributes
    ----------
    mbs : exudyn.MainSystem
    fem : FEMinterface
    object, node : ObjectIndex, NodeIndex
        The flexible object, and the node of its frame.
    markers : dict of str
        Markers that the call made, by boundary.
    rotor : RotorBody or None
        Of the swapped call.
    """

    mbs: exudyn.MainSystem
    fem: FEMinterface
    object: exudyn.ObjectIndex
    node: exudyn.NodeIndex
    markers: dict
    rotor: RotorBody | None

    def rigid_marker(self, boundary: str, **options) -> exudyn.MarkerIndex:
        """Add the script's own rigid marker at a boundary."""
        nodes, weights = parts.nodes_of(self.fem, boundary)
        return self.mbs.AddMarker(
            MarkerSuperElementRigid(
                bodyNumber=self.object, meshNodeNumbers=nodes, weightingFactors=weights, **options
            )
        )

    def position_marker(self, boundary: str) -> exudyn.MarkerIndex:
        """Add the script's own position marker at a boundary."""
        nodes, weights = parts.nodes_of(self.fem, boundary)
        return self.mbs.AddMarker(
            MarkerSuperElementPosition(
                bodyNumber=self.object, meshNodeNumbers=nodes, weightingFactors=weights
            )
        )

    def node_marker(self, point: Vector) -> exudyn.MarkerIndex:
        """Add the script's own position marker at the mesh node next to a point in mesh axes."""
        positions = self.fem.GetNodePositionsAsArray()
        nearest = int(np.linalg.norm(positions - np.asarray(point), axis=1).argmin())
        return self.mbs.AddMarker(
            MarkerSuperElementPosition(
                bodyNumber=self.object, meshNodeNumbers=[nearest], weightingFactors=[1.0]
            )
        )

    def weigh(self, gravity: Vector) -> None:
        """Add gravity by the script's own marker of the body's mass."""
        marker = self.mbs.AddMarker(MarkerBodyMass(bodyNumber=self.object))
        self.mbs.AddLoad(LoadMassProportional(markerNumber=marker, loadVector=gravity))

    def watch(self, node: int) -> exudyn.SensorIndex:
        """Add a sensor of the displacement of a mesh node."""
        return self.mbs.AddSensor(
            SensorSuperElement(
                bodyNumber=self.object,
                meshNodeNumber=node,
                storeInternal=True,
                writeToFile=False,
                outputVariableType=exudyn.OutputVariableType.Displacement,
            )
        )


@dataclass
class Script:
    """A script that is being written: its system, the call under trial, and what is compared.

    Attributes
    ----------
    call : str
        Name of the method of ``mbs`` that adds a flexible body.
    by_class : bool
        Whether the class of Exudyn's older examples, or its twin, adds it instead.
    """

    call: str
    by_class: bool = False
    container: exudyn.SystemContainer = field(default_factory=exudyn.SystemContainer)
    sensors: list[exudyn.SensorIndex] = field(default_factory=list)
    bodies: list[Flexible] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.mbs = self.container.AddSystem()
        self.ground = self.mbs.CreateGround()

    def flexible(self, fem: FEMinterface, axis: str | Vector | None = None, **given) -> Flexible:
        """Add a flexible body by the call under trial; the spin axis is for the swapped one."""
        name = given.pop("name", f"body{len(self.bodies)}")
        extra = {"axis": axis} if self.call != ORIGINAL and axis is not None else {}
        if self.by_class:
            given = {_NAMES.get(key, key): value for key, value in given.items()}
            added = CLASSES[self.call](fem, **extra)
            items = added.AddObjectFFRFreducedOrder(self.mbs, name=name, **given)
            made = {"FFRFReducedOrderObjectDict": items}
        else:
            made = getattr(self.mbs, self.call)(name=name, femInterface=fem, **given, **extra)
        body = _flexible(self.mbs, fem, name, made)
        self.bodies.append(body)
        return body

    def unchanged(self, fem: FEMinterface, **given) -> Flexible:
        """Add a flexible body of Exudyn in either case."""
        made = self.mbs.CreateFFRFReducedOrderObject(name="unchanged", femInterface=fem, **given)
        return _flexible(self.mbs, fem, "unchanged", made)

    def spring(self, first, second, stiffness: Vector, damping: Vector, **options) -> None:
        """Add a spring and damper between two markers, at their present distance."""
        self.mbs.CreateCartesianSpringDamper(
            itemNumbers=[first, second], stiffness=stiffness, damping=damping, **options
        )

    def ground_marker(self, position: Vector) -> exudyn.MarkerIndex:
        """Add a rigid marker of the ground."""
        return self.mbs.AddMarker(
            exudyn.itemInterface.MarkerBodyRigid(
                bodyNumber=self.ground, localPosition=list(position)
            )
        )

    def observe(self, marker, kind=exudyn.OutputVariableType.Displacement) -> None:
        """Compare what a marker does."""
        self.sensors.append(
            self.mbs.AddSensor(
                SensorMarker(
                    markerNumber=marker,
                    storeInternal=True,
                    writeToFile=False,
                    outputVariableType=kind,
                )
            )
        )

    def observe_node(self, body: Flexible, point: Vector) -> None:
        """Compare the displacement of the mesh node next to a point in mesh axes."""
        positions = body.fem.GetNodePositionsAsArray()
        nearest = int(np.linalg.norm(positions - np.asarray(point), axis=1).argmin())
        self.sensors.append(body.watch(nearest))


def _flexible(mbs: exudyn.MainSystem, fem: FEMinterface, name: str, made: dict) -> Flexible:
    items = made["FFRFReducedOrderObjectDict"]
    markers = {key.partition(":")[2]: value for key, value in made.items() if ":" in key}
    return Flexible(
        mbs, fem, items["oFFRFreducedOrder"], items["nRigidBody"], markers, items.get("rotorBody")
    )


@dataclass(frozen=True)
class Scene:
    """A scene and how it is run.

    Attributes
    ----------
    name, source : str
        What it is; which of Exudyn's examples or test models has its like.
    build : callable
        Writes a :class:`Script`, all but the solution.
    end, step : float
        [s]
    note : str
        The known cause of what the scene deviates by.
    by_class : bool
        Whether bodies are added by Exudyn's class, or its twin, as in most of its examples.
    """

    name: str
    build: Callable[[Script], None]
    end: float
    step: float
    source: str = ""
    note: str = ""
    by_class: bool = False


@dataclass(frozen=True)
class Run:
    """One run of a scene with one call.

    Attributes
    ----------
    histories : list of ndarray, each (steps + 1, k)
        What the sensors recorded.
    seconds : float
        Time of the solution alone, without the build-up.
    nodes, modes, markers : int
        Of the flexible bodies under trial.
    messages : tuple of str
        Warnings and the error that a user sees.
    """

    histories: list[np.ndarray]
    seconds: float
    nodes: int = 0
    modes: int = 0
    markers: str = ""
    messages: tuple[str, ...] = ()


def run(
    scene: Scene,
    call: str,
    fraction: float = 1.0,
    refined: int = 1,
    change: Callable[[exudyn.SimulationSettings], None] | None = None,
) -> Run:
    """Run a scene with a call, for a share of its time, with steps divided by `refined`.

    The settings are Exudyn's defaults, with what `change` does to them.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        script = Script(call, scene.by_class)
        try:
            scene.build(script)
            script.mbs.Assemble()
            seconds = _solve(script.mbs, scene, fraction, refined, change)
        except (ValueError, TypeError, RuntimeError) as error:
            return Run([], np.nan, messages=(*_texts(caught), f"{type(error).__name__}: {error}"))
    histories = [np.array(script.mbs.GetSensorStoredData(number)) for number in script.sensors]
    return Run(
        [history[::refined, 1:] for history in histories],
        seconds,
        sum(body.fem.NumberOfNodes() for body in script.bodies),
        sum(body.fem.modeBasis["matrix"].shape[1] for body in script.bodies),
        _marker_kinds(script),
        _texts(caught),
    )


def _solve(
    mbs: exudyn.MainSystem, scene: Scene, fraction: float, refined: int, change: Callable | None
) -> float:
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = scene.step / refined
    integration = settings.timeIntegration
    integration.verboseMode = 0
    steps = round(fraction * scene.end / scene.step)
    integration.numberOfSteps = steps * refined
    integration.endTime = steps * scene.step
    if change is not None:
        change(settings)
    start = time.process_time()  # other work on the machine does not count
    if not mbs.SolveDynamic(settings, showHints=False):
        raise RuntimeError("the solver stopped")
    return time.process_time() - start


def _texts(caught: list) -> tuple[str, ...]:
    return tuple(str(entry.message) for entry in caught if entry.category is not DeprecationWarning)


def _marker_kinds(script: Script) -> str:
    """Return how many markers a scene has at its flexible bodies, and of which kinds."""
    names = [
        str(script.mbs.GetMarker(number)["markerType"])
        for number in range(script.mbs.systemData.NumberOfMarkers())
    ]
    rigid, position = names.count("SuperElementRigid"), names.count("SuperElementPosition")
    return f"{rigid} rigid, {position} position"


def deviation(original: Run, swapped: Run) -> float:
    """Return the largest difference of any sensor over the size of its motion."""
    worst = 0.0
    for first, second in zip(original.histories, swapped.histories, strict=True):
        size = np.linalg.norm(first - first[0], axis=1).max()
        worst = max(worst, np.linalg.norm(first - second, axis=1).max() / max(size, 1e-300))
    return worst
