"""The scene of the speed measurements: one rotor on two bearings, with one body or another."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from unittest import mock

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface
from exudyn.itemInterface import ObjectGenericODE2

from exudyn_rotor import RotorBody, SolidRotor
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

STEP = 1e-4  # s
CALLS = ("massMatrixUserFunction", "forceUserFunction", "jacobianUserFunction")


@dataclass(frozen=True, eq=False)
class Model:
    """The rotor with the modes that every body gets, ascending in frequency."""

    fem: FEMinterface
    columns: np.ndarray
    node_count: int

    @classmethod
    def of(cls, element_size: float, mode_count: int, safety: float = 2.0) -> Model:
        """Mesh the rotor, put an unbalance on its rim, and compute free modes."""
        fem = FEMinterface()
        mesh = disc_on_shaft(element_size, safety)
        fem.ImportMeshFromNGsolve(
            mesh, materials=STEEL, boundaryNamesList=list(BEARINGS), meshOrder=2
        )
        rim = np.array([0.05, 0.0, 0.12])
        nodes = fem.GetNodePositionsAsArray()
        fem.AddNodeMass(int(np.argmin(np.linalg.norm(nodes - rim, axis=1))), 0.008)
        reduced = SolidRotor.from_fem_interface(fem, "x").reduce(mode_count)
        return cls(fem, np.array(reduced.shapes.matrix[:, len(reduced.rigid) :]), len(nodes))

    def with_modes(self, count: int) -> FEMinterface:
        """Return the FEMinterface with the first `count` modes."""
        self.fem.modeBasis = {"matrix": self.columns[:, :count].copy(), "type": "NormalModes"}
        return self.fem


def fixed_axis(**options) -> AddRotor:
    """Return a function that adds the fixed-axis rotor by the twin of Exudyn's call."""

    def add(mbs: exudyn.MainSystem, fem: FEMinterface) -> dict:
        speed = [START_SPEED, 0, 0]
        common = {"axis": "x", "gravity": GRAVITY, "initialAngularVelocity": speed}
        common["stiffening"] = "tilt"  # as much as Exudyn's body has
        return mbs.CreateFixedAxisFFRFReducedOrderObject(
            name="rotor", femInterface=fem, **(common | options)
        )

    return add


def without_python(add_rotor: AddRotor) -> AddRotor:
    """Return the floor: the body with its matrices frozen at the start, and no user function.

    The motion is wrong with a free spin; the scene costs what Exudyn itself needs for it.
    """

    def add(mbs: exudyn.MainSystem, fem: FEMinterface) -> dict:
        made = add_rotor(mbs, fem)
        body = made["FFRFReducedOrderObjectDict"]["rotorBody"]
        for name, matrix in frozen_matrices(body).items():
            mbs.SetObjectParameter(body.objects["physics"], name, matrix)
        for call in CALLS:
            mbs.SetObjectParameter(body.objects["physics"], call, 0)
        return made

    return add


def frozen_matrices(body: RotorBody) -> dict[str, np.ndarray]:
    """Return mass, stiffness and damping matrix at the start."""
    place, motion = body.layout, body.motion
    q, q_t = np.zeros(motion.size), np.zeros(motion.size)
    if body.formulation.has_spin:
        q_t[body.formulation.translation_count] = START_SPEED
    by_q, by_v = motion.jacobian(0.0, q, q_t)
    return {
        "massMatrix": place.spread(motion.mass_matrix(0.0, q), place.lock_mass),
        "stiffnessMatrix": place.spread(-by_q),
        "dampingMatrix": place.spread(-by_v),
    }


def assemble(add_rotor: AddRotor, fem: FEMinterface) -> tuple[exudyn.MainSystem, dict]:
    """Return a new system with the rotor on two bearings."""
    mbs = exudyn.SystemContainer().AddSystem()
    made = add_rotor(mbs, fem)
    ground = mbs.CreateGround()
    for interface, x in BEARINGS.items():
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, made[f"rotor:{interface}"]],
            localPosition0=[x, 0, 0],
            stiffness=[2e6, 1.2e6, 1.6e6],
            damping=[200.0, 200.0, 200.0],
        )
    mbs.Assemble()
    return mbs, made


def default_settings(steps: int) -> exudyn.SimulationSettings:
    """Return Exudyn's settings with modified Newton, for `steps` steps without output."""
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1.0
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = steps * STEP
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.verboseMode = 0
    return settings


def seconds(mbs: exudyn.MainSystem, settings: exudyn.SimulationSettings) -> float:
    """Return the time of one simulation."""
    start = time.perf_counter()
    mbs.SolveDynamic(settings)
    return time.perf_counter() - start


@dataclass(frozen=True)
class Calls:
    """Python calls of one simulation.

    Attributes
    ----------
    count : dict of str to int
        By kind: mass, force, jacobian.
    microseconds : dict of str to float
        Time inside Python per call.
    """

    count: dict[str, int]
    microseconds: dict[str, float]


def python_calls(
    add_rotor: AddRotor, fem: FEMinterface, settings: exudyn.SimulationSettings
) -> Calls:
    """Count and time the user functions of the rotor; no entry where there are none."""
    count, spent = {}, {}

    def watched(**options) -> ObjectGenericODE2:
        for name in CALLS:
            if name in options:
                kind = name.removesuffix("UserFunction").removesuffix("Matrix")
                count[kind], spent[kind] = 0, 0.0
                options[name] = _timed(options[name], kind, count, spent)
        return ObjectGenericODE2(**options)

    with mock.patch("exudyn_rotor.multibody.add_rotor.ObjectGenericODE2", watched):
        mbs, _ = assemble(add_rotor, fem)
    mbs.SolveDynamic(settings)
    return Calls(count, {kind: 1e6 * spent[kind] / max(count[kind], 1) for kind in count})


def _timed(call: Callable, kind: str, count: dict, spent: dict) -> Callable:
    def timed(*arguments):
        start = time.perf_counter()
        result = call(*arguments)
        spent[kind] += time.perf_counter() - start
        count[kind] += 1
        return result

    return timed


def with_points(mbs: exudyn.MainSystem, fem: FEMinterface) -> dict:
    """Add the 3D body with position markers on one virtual node an interface."""
    return add_3d_rotor_with_virtual_nodes(mbs, fem, markers="position")


FREE_SPIN = {"translation": "free"}
CONSTANT_SPEED = {"spin": START_SPEED, "translation": "none"}

BODIES: dict[str, AddRotor] = {
    "3D, markers on all face nodes": add_3d_rotor,
    "3D, virtual nodes": add_3d_rotor_with_virtual_nodes,
    "fixed axis, free spin": fixed_axis(**FREE_SPIN),
    "fixed axis, free spin, floor": without_python(fixed_axis(**FREE_SPIN)),
    "fixed axis, constant speed": fixed_axis(**CONSTANT_SPEED),
    "fixed axis, constant speed, floor": without_python(fixed_axis(**CONSTANT_SPEED)),
}
# the bearings need no more than these, and they cost a fraction
POINT_BODIES: dict[str, AddRotor] = {
    "3D, virtual nodes": with_points,
    "fixed axis, free spin": fixed_axis(**FREE_SPIN, markers="position"),
    "fixed axis, free spin, floor": without_python(fixed_axis(**FREE_SPIN, markers="position")),
    "fixed axis, constant speed": fixed_axis(**CONSTANT_SPEED, markers="position"),
    "fixed axis, constant speed, floor": without_python(
        fixed_axis(**CONSTANT_SPEED, markers="position")
    ),
}
