"""The rotor of the trade-off between error and cost: its bodies, and one timed simulation."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface
from exudyn.itemInterface import MarkerSuperElementPosition, SensorMarker, SensorSuperElement

from exudyn_rotor import (
    ReducedRotor,
    SolidRotor,
    add_rotor,
    craig_bampton_modes,
    recommended_settings,
)
from exudyn_rotor.demo.scene import (
    BEARINGS,
    GRAVITY,
    START_SPEED,
    STEEL,
    AddRotor,
    add_3d_rotor,
    add_3d_rotor_with_virtual_nodes,
    disc_on_shaft,
)
from exudyn_rotor.reduction.reduce import ModeSource
from validation.speed.scenes import assemble
from validation.trade.error import Motion

DISC = 0.05  # m, place of the disc's middle on the x axis
RIM = (DISC, 0.0, 0.12)  # m
HALF_WIDTH = 0.02  # m
DISC_NODES = 12  # at each of its edges
UNBALANCE = 0.008  # kg, at the rim
DURATION = 0.1  # s, three turns
SETTLED = 0.04  # s, when the shock of the unbalance that acts at once has decayed
DAMPING = 2e-6  # s, times the stiffness: 0.17 % of the critical one in the first bending mode
PERIOD = 2e-3  # s, from one sample to the next
TORQUE = 42.0  # N m, of the run-up
STATIC_FLEXIBLE = 6  # of the 12 static modes of two interfaces, the others are rigid motions
FREE, CRAIG_BAMPTON = "free", "Craig–Bampton"

STANDARD, VIRTUAL = "3D, all face nodes", "3D, virtual nodes"
FIXED_AXIS = {  # formulation family: translation and spin
    "fixed axis, translation free": {"translation": "free", "initial_speed": START_SPEED},
    "fixed axis, in-plane": {"translation": "in-plane", "initial_speed": START_SPEED},
    "fixed axis, translation none": {"translation": "none", "initial_speed": START_SPEED},
    "fixed axis, constant speed": {"translation": "none", "spin": START_SPEED},
}
FAMILIES = (STANDARD, VIRTUAL, *FIXED_AXIS)
FREE_FRAME, CONSTANT_SPEED = "fixed axis, translation free", "fixed axis, constant speed"


@dataclass(frozen=True)
class Body:
    """One way to put the rotor into the scene.

    Attributes
    ----------
    family : str
        One of `FAMILIES`.
    basis : {'free', 'Craig–Bampton'}
    modes : int
        Flexible modes.
    stiffening : {'none', 'tilt', 'full'}
        Of a fixed-axis body.
    markers : {'rigid', 'position'}
        Kind at both bearings; the 3D body with all face nodes has rigid ones.
    torque : float
        Drives the left journal [N m]; needs rigid markers.
    """

    family: str
    basis: str = CRAIG_BAMPTON
    modes: int = 20
    stiffening: str = "tilt"
    markers: str = "rigid"
    torque: float = 0.0


@dataclass(frozen=True)
class Config:
    """One simulation.

    Attributes
    ----------
    body : Body
    steps : int
        Time steps from one sample to the next.
    solver : str
        One of `SOLVERS`.
    """

    body: Body
    steps: int
    solver: str = "recommended"

    @property
    def step(self) -> float:
        """Step size [s]."""
        return PERIOD / self.steps


@dataclass(frozen=True, eq=False)
class Rotor:
    """The finite-element rotor in both forms, on one mesh."""

    solid: SolidRotor
    fem: FEMinterface

    @classmethod
    def of(cls, element_size: float, order: int = 2, unbalance: float = UNBALANCE) -> Rotor:
        """Mesh the rotor [m] and put the unbalance [kg] on its rim."""
        mesh, fem = disc_on_shaft(element_size), FEMinterface()
        fem.ImportMeshFromNGsolve(
            mesh, materials=STEEL, boundaryNamesList=list(BEARINGS), meshOrder=order
        )
        solid = SolidRotor.from_ngsolve(mesh, STEEL, "x", order=order)
        if unbalance:
            solid = solid.add_point_mass(RIM, unbalance)
            fem.AddNodeMass(solid.point_masses[0].node, unbalance)
        return cls(solid, fem)

    @cached_property
    def _known(self) -> dict:
        return {}

    def columns(self, basis: str, count: int) -> np.ndarray:
        """Return flexible modes (3n, count), free of rigid motions, ascending in frequency."""
        if basis == FREE:
            known = self._known.get(FREE, np.zeros((0, 0)))
            if known.shape[1] < count:
                self._known[FREE] = known = self._flexible(count)
            return known[:, :count]
        if (basis, count) not in self._known:
            modes = craig_bampton_modes(self.solid, count - STATIC_FLEXIBLE, coupling="RBE3")
            self._known[basis, count] = self._flexible(modes)
        return self._known[basis, count]

    def _flexible(self, modes: ModeSource) -> np.ndarray:
        reduced = self.solid.reduce(modes, prestress=False)
        return np.array(reduced.shapes.matrix[:, len(reduced.rigid) :])

    def reduced(self, body: Body) -> ReducedRotor:
        """Return the rotor reduced for a body."""
        columns = self.columns(body.basis, body.modes)
        # 'tilt' is as much as Exudyn's body has
        return self.solid.reduce(columns, prestress=body.stiffening == "full")

    @cached_property
    def disc(self) -> tuple[np.ndarray, np.ndarray]:
        """Some nodes of the disc's two edges, and weights that put their mean in its middle."""
        nodes, chosen = self.solid.nodes, []
        at_rim = np.abs(np.linalg.norm(nodes[:, 1:], axis=1) - RIM[2]) < 1e-3
        for x in (DISC - HALF_WIDTH, DISC + HALF_WIDTH):
            edge = np.flatnonzero(at_rim & (np.abs(nodes[:, 0] - x) < 1e-6))
            around = edge[np.argsort(np.arctan2(nodes[edge, 1], nodes[edge, 2]))]
            # few, because reading them out is in the measured time
            chosen.append(around[:: max(1, len(edge) // DISC_NODES)])
        rim = np.concatenate(chosen)
        rows = np.vstack([np.ones(len(rim)), nodes[rim].T])
        weights = np.full(len(rim), 1.0 / len(rim))
        lacking = np.array([1.0, DISC, 0.0, 0.0]) - rows @ weights
        return rim, weights + np.linalg.lstsq(rows, lacking, rcond=None)[0]


def add_body(rotor: Rotor, body: Body) -> AddRotor:
    """Return a function that adds a body, with the keys of Exudyn's own call."""
    if body.family in FIXED_AXIS:
        return _fixed_axis(rotor, body)
    columns = rotor.columns(body.basis, body.modes)

    def add(mbs: exudyn.MainSystem, fem: FEMinterface) -> dict:
        fem.modeBasis = {"matrix": columns.copy(), "type": "NormalModes"}
        if body.family == STANDARD:
            made = add_3d_rotor(mbs, fem)
        else:
            made = add_3d_rotor_with_virtual_nodes(mbs, fem, markers=body.markers)
        _damp(mbs, made["FFRFReducedOrderObjectDict"]["oFFRFreducedOrder"])
        return made

    return add


def _fixed_axis(rotor: Rotor, body: Body) -> AddRotor:
    def add(mbs: exudyn.MainSystem, fem: FEMinterface) -> dict:
        made = add_rotor(
            mbs,
            rotor.reduced(body),
            gravity=GRAVITY,
            stiffness_damping=DAMPING,
            initial_velocity=_start_velocity(rotor, body),
            stiffening=body.stiffening,
            markers=body.markers,
            **FIXED_AXIS[body.family],
        )
        items = {"oFFRFreducedOrder": made.objects["marker_body"], "rotorBody": made}
        markers = {f"rotor:{name}": marker for name, marker in made.markers.items()}
        return markers | {"FFRFReducedOrderObjectDict": items}

    return add


def _start_velocity(rotor: Rotor, body: Body) -> np.ndarray:
    """Return the velocity [m/s] of the frame origin while the rotor spins about its axis."""
    if FIXED_AXIS[body.family]["translation"] == "none":
        return np.zeros(3)
    return np.cross([START_SPEED, 0.0, 0.0], rotor.solid.center_of_mass)


def _damp(mbs: exudyn.MainSystem, flexible: exudyn.ObjectIndex) -> None:
    """Give Exudyn's own body the damping of the others."""
    stiffness = mbs.GetObject(flexible)["stiffnessMatrixReduced"]
    matrix = exudyn.MatrixContainer(DAMPING * stiffness.Convert2DenseMatrix())
    mbs.SetObjectParameter(flexible, "dampingMatrixReduced", matrix)


class Scene:
    """One body on its bearings, to be simulated as often as wanted.

    Attributes
    ----------
    set_up : float
        Time from the finite-element model and its modes to the assembled system [s].
    """

    def __init__(self, rotor: Rotor, body: Body) -> None:
        rotor.columns(body.basis, body.modes)
        start = time.perf_counter()
        self.mbs, made = assemble(add_body(rotor, body), rotor.fem)
        self.set_up = time.perf_counter() - start
        if body.torque:
            load = [body.torque, 0.0, 0.0]
            self.mbs.CreateTorque(itemNumber=made["rotor:left"], loadVector=load)
        self.sensors = self._watch(rotor, made)
        self.mbs.Assemble()

    def _watch(self, rotor: Rotor, made: dict) -> dict[str, exudyn.SensorIndex]:
        """Record both journals, the disc's middle and a node at its rim."""
        flexible = made["FFRFReducedOrderObjectDict"]["oFFRFreducedOrder"]
        nodes, weights = rotor.disc
        middle = self.mbs.AddMarker(
            MarkerSuperElementPosition(
                bodyNumber=flexible, meshNodeNumbers=nodes, weightingFactors=weights
            )
        )
        record = {
            "outputVariableType": exudyn.OutputVariableType.Displacement,
            "storeInternal": True,
            "writeToFile": False,
        }
        markers = {name: made[f"rotor:{name}"] for name in BEARINGS} | {"disc": middle}
        sensors = {
            name: self.mbs.AddSensor(SensorMarker(markerNumber=marker, **record))
            for name, marker in markers.items()
        }
        rim = rotor.solid.nearest_node((DISC, RIM[2], 0.0))
        sensor = SensorSuperElement(bodyNumber=flexible, meshNodeNumber=rim, **record)
        return sensors | {"rim": self.mbs.AddSensor(sensor)}

    def run(
        self, steps: int, solver: str, duration: float = DURATION, settled: float = SETTLED
    ) -> tuple[Motion, float]:
        """Return the motion from `settled` [s] on, and the time of the whole simulation [s].

        `steps` are those from one sample to the next; see :class:`Config`.
        """
        settings = SOLVERS[solver](duration, PERIOD / steps)
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = PERIOD
        settings.timeIntegration.verboseMode = 0
        start = time.perf_counter()
        self.mbs.SolveDynamic(settings)
        seconds = time.perf_counter() - start
        data = {name: self.mbs.GetSensorStoredData(one) for name, one in self.sensors.items()}
        late = data["disc"][:, 0] > settled - 0.5 * PERIOD
        return Motion({name: values[late, 1:] for name, values in data.items()}), seconds


def _plain(duration: float, step: float) -> exudyn.SimulationSettings:
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(duration / step)
    settings.timeIntegration.endTime = duration
    return settings


def _modified(duration: float, step: float) -> exudyn.SimulationSettings:
    settings = _plain(duration, step)
    settings.timeIntegration.newton.useModifiedNewton = True
    return settings


def _recommended(duration: float, step: float) -> exudyn.SimulationSettings:
    return recommended_settings(duration, step)


def _tight(duration: float, step: float) -> exudyn.SimulationSettings:
    return recommended_settings(duration, step, accuracy=1e-8)


SOLVERS = {
    "default": _plain,
    "modified Newton": _modified,
    "recommended": _recommended,
    "tight": _tight,
}
