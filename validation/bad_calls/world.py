"""A small rotor, its scenes and its results, on which the valid calls are made."""

from __future__ import annotations

import tempfile
from dataclasses import fields
from functools import cached_property
from pathlib import Path
from typing import Any

import exudyn
import matplotlib
import ngsolve
import numpy as np
from exudyn.FEM import FEMinterface
from netgen.occ import Box, OCCGeometry, Pnt, Z

import exudyn_rotor as er
from exudyn_rotor.theory.stiffening import stiffening
from validation.bad_calls.bearings import Bearings

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
SPEEDS = (10.0, 20.0, 30.0, 40.0)


class World(Bearings):
    """Everything is made when it is first asked for, and once; scenes can be renewed."""

    def __init__(self) -> None:
        matplotlib.use("Agg")
        self.folder = Path(tempfile.mkdtemp(prefix="bad_calls"))

    @cached_property
    def mesh(self) -> ngsolve.Mesh:
        """A bar along z with the end faces 'left' and 'right'."""
        bar = Box(Pnt(-0.02, -0.03, 0), Pnt(0.02, 0.03, 0.3))
        bar.mat("steel")
        bar.faces.Min(Z).name, bar.faces.Max(Z).name = "left", "right"
        return ngsolve.Mesh(OCCGeometry(bar).GenerateMesh(maxh=0.15))

    @cached_property
    def solid(self) -> er.SolidRotor:
        """The bar with linear elements: some dozen nodes."""
        return er.SolidRotor.from_ngsolve(self.mesh, STEEL, "z", order=1)

    @cached_property
    def table(self) -> Path:
        """A file with times and accelerations."""
        path = self.folder / "record.csv"
        path.write_text("time,x,y,z\n0.0,1,0,0\n0.1,0,1,0\n", encoding="utf-8")
        return path

    @cached_property
    def record(self) -> er.BaseRecord:
        """A ground that shakes for three hundredths of a second."""
        return er.BaseRecord([0.0, 0.01, 0.02, 0.03], np.eye(4)[:, :3])

    @cached_property
    def foundation(self) -> er.Foundation:
        """Two modes below its ends."""
        points = {"left": np.ones((6, 2)), "right": np.ones((6, 2)) - np.eye(6)[:, :2]}
        places = {"left": [0.0, 0.0, 0.0], "right": [0.0, 0.0, 0.3]}
        return er.Foundation.from_modes(
            [300.0, 500.0], 0.02, points, places=places, participation=np.ones((3, 2))
        )

    @cached_property
    def prestress(self) -> er.Prestress:
        """Its static stress at speed."""
        return self.solid.prestress(euler=True)

    @cached_property
    def reduced(self) -> er.ReducedRotor:
        """The bar with two elastic modes, stress and prestress."""
        return self.solid.reduce(2, stress=True, prestress=self.prestress)

    @cached_property
    def selection(self) -> Any:
        """Its modes at constant speed."""
        return er.select_modes(self.reduced, er.Formulation("none", 10.0))

    @cached_property
    def motion(self) -> er.Motion:
        """Its equations of motion at constant speed."""
        return self.body.motion

    @cached_property
    def second_order(self) -> er.Stiffening:
        """Its second-order terms at the level 'tilt'."""
        return stiffening(self.selection.invariants, "tilt")

    @cached_property
    def stressed(self) -> er.SolidRotor:
        """The bar that carries its prestress."""
        return self.solid.with_prestress(self.prestress)

    @property
    def steel(self) -> dict[str, float]:
        """The material, a copy."""
        return dict(STEEL)

    @cached_property
    def fem(self) -> FEMinterface:
        """The bar as Exudyn's FE model, with its modes."""
        fem = FEMinterface()
        fem.ImportMeshFromNGsolve(
            self.mesh, materials={"steel": STEEL}, boundaryNamesList=["left", "right"], meshOrder=1
        )
        fem.ComputeEigenmodes(2, 6)
        return fem

    @cached_property
    def gears(self) -> er.GearMesh:
        """A mesh of two gears."""
        return er.GearMesh(radii=[0.05, 0.1], stiffness=1e8, teeth=[20, 40], variation=[0.1])

    @cached_property
    def train(self) -> er.RotorTrain:
        """The reduced rotor twice, the second turning the other way on the first."""
        return er.RotorTrain(
            {"first": self.reduced, "second": self.reduced},
            {"first": 1.0, "second": -1.0},
            {"first": self.supports},
            [er.Link("first:left", "second:left", er.Support("left", 1e6))],
        )

    @cached_property
    def linear(self) -> er.LinearModel:
        """Linear equations of the bar on its bearings."""
        return er.linear_model(self.reduced, supports=self.supports)

    # -------------------------------------------------------------- scenes

    @cached_property
    def mbs(self) -> exudyn.MainSystem:
        """An empty scene, for calls that add to it."""
        return exudyn.SystemContainer().AddSystem()

    @cached_property
    def assembled(self) -> exudyn.MainSystem:
        """The scene of `body`: the bar at constant speed on two springs, assembled."""
        mbs = exudyn.SystemContainer().AddSystem()
        body = er.add_rotor(mbs, self.reduced, spin=10.0, translation="none")
        ground = mbs.CreateGround()
        for name, z in (("left", 0.0), ("right", 0.3)):
            mbs.CreateCartesianSpringDamper(
                itemNumbers=[ground, body.marker(name)],
                localPosition0=[0, 0, z],
                stiffness=[1e6] * 3,
                damping=[100.0] * 3,
            )
        mbs.Assemble()
        self._body = body
        return mbs

    @property
    def body(self) -> er.RotorBody:
        """The rotor in `assembled`."""
        _ = self.assembled
        return self._body

    @cached_property
    def full_body(self) -> er.FullRotorBody:
        """The bar with all its displacements, assembled."""
        mbs = exudyn.SystemContainer().AddSystem()
        body = er.add_rotor(mbs, self.solid, spin=10.0, translation="none", stiffening="tilt")
        mbs.Assemble()
        return body

    @cached_property
    def steady(self) -> er.SteadyState:
        """The steady state of `assembled`."""
        return er.steady_state(self.body)

    @cached_property
    def recorded(self) -> er.RotorBody:
        """A rotor after four recorded steps."""
        body = er.add_rotor(exudyn.SystemContainer().AddSystem(), self.reduced)
        body.start_recording()
        return _after_four_steps(body)

    @cached_property
    def full_recorded(self) -> er.FullRotorBody:
        """A full body after four steps, with its displacements at two instants."""
        mbs = exudyn.SystemContainer().AddSystem()
        body = er.add_rotor(mbs, self.solid, spin=10.0, translation="none", stiffening="tilt")
        body.start_recording([0.0, 2e-5])
        return _after_four_steps(body)

    def renew(self) -> None:
        """Forget scenes and mesh, after a call that should have been refused has changed them."""
        for name in ("mbs", "assembled", "full_body", "steady", "motion", "run_check", "mesh"):
            self.__dict__.pop(name, None)

    # -------------------------------------------------------------- results

    @cached_property
    def run_check(self) -> er.RunCheck:
        """The check of the scene at rest."""
        return er.check_run(self.body, warn=False)

    @cached_property
    def proposal(self) -> er.Proposal:
        """A proposal for the bar."""
        return er.propose(self.reduced, speeds=(0.0, 40.0), supports=self.supports)

    @cached_property
    def campbell(self) -> er.Campbell:
        """Frequencies over four speeds."""
        return er.campbell(self.reduced, SPEEDS, supports=self.supports)

    @cached_property
    def critical(self) -> er.CriticalSpeeds:
        """Critical speeds."""
        return er.critical_speeds(self.reduced, supports=self.supports)

    @cached_property
    def critical_map(self) -> er.CriticalSpeedMap:
        """Critical speeds over the stiffness of the bearings."""
        return er.critical_speed_map(
            self.reduced, ["left", "right"], [1e6, 2e6], supports=self.axial
        )

    @cached_property
    def axial(self) -> tuple[er.Support, ...]:
        """A spring along the axis and against the spin."""
        return (er.Support("left", np.diag([0.0, 0.0, 1e6])),)

    @cached_property
    def unbalance(self) -> er.UnbalanceResponse:
        """The response to an unbalance up to above its first critical speed."""
        load, speeds = er.Unbalance("left", 1e-4), np.linspace(10.0, 2000.0, 9)
        given = {"supports": self.supports, "refine": True}
        return er.unbalance_response(self.reduced, speeds, [load], **given)

    @cached_property
    def rolls(self) -> er.RollingBearingResponse:
        """The motion on a ball bearing beside other supports."""
        given = {"supports": [self.rolling, *self.supports], "gravity": [0.0, -9.81, 0.0]}
        return er.rolling_bearing_response(self.reduced, [10.0, 20.0], **given)

    @cached_property
    def harmonic(self) -> er.HarmonicResponse:
        """The response to a force up to above its first resonance."""
        load, frequencies = er.HarmonicForce("left", [1.0, 0.0, 0.0]), np.linspace(10.0, 2000.0, 9)
        given = {"supports": self.supports, "refine": True}
        return er.harmonic_response(self.reduced, frequencies, load, **given)

    @cached_property
    def stability(self) -> er.Stability:
        """Exponents over four speeds."""
        return er.stability(self.reduced, SPEEDS, supports=self.supports)

    @cached_property
    def separation(self) -> er.SeparationMargins:
        """The peaks of `unbalance`."""
        return er.separation_margins(self.unbalance, (500.0, 800.0))

    @cached_property
    def level_one(self) -> er.StabilityLevelOne:
        """Log decrements over a cross-coupling."""
        given = {"at": "left", "supports": self.supports}
        return er.stability_level_one(self.reduced, 300.0, 1e4, **given)

    @cached_property
    def stability_map(self) -> er.StabilityMap:
        """Growth over stiffness and speed."""
        return er.stability_map(self.build, [1e6, 2e6], SPEEDS)

    @cached_property
    def thresholds(self) -> er.StabilityThresholds:
        """The range of speeds that has none."""
        return er.stability_threshold(self.reduced, 10.0, 20.0, supports=self.supports, samples=2)

    def build(self, stiffness: float, speed: float) -> tuple[Any, float]:
        """Return a target of the stability map."""
        supports = (*self.axial, er.Support("left", stiffness), er.Support("right", stiffness))
        return er.linear_model(self.reduced, supports=supports), speed

    @cached_property
    def stress(self) -> er.StressField:
        """The stress of the bar."""
        return er.StressField.of(self.reduced, self.selection)

    @cached_property
    def shapes(self) -> er.MotionShapes:
        """Its two lowest modes."""
        return er.mode_shapes(self.reduced, 10.0, supports=self.supports, modes=2)

    @cached_property
    def spectra(self) -> er.Spectra:
        """Spectra of some record."""
        time = 1e-3 * np.arange(40)
        return er.spectra(time, np.sin(200.0 * time), 10.0, length=0.02)

    @cached_property
    def coordinates(self) -> np.ndarray:
        """Modal coordinates at four instants."""
        return 1e-6 * np.ones((4, len(self.selection.labels)))

    @cached_property
    def history(self) -> er.StressHistory:
        """Its stress at four instants."""
        return er.stress_history(self.stress, [0.0, 0.1, 0.2, 0.3], self.coordinates, 10.0)

    def stored(self, result: Any) -> Path:
        """Return the path of a file that holds a result."""
        path = self.folder / f"{type(result).__name__}.npz"
        if not path.exists():
            result.save(path)
        return path


def arguments(instance: Any) -> dict[str, Any]:
    """Return the arguments that make a dataclass instance again."""
    return {field.name: getattr(instance, field.name) for field in fields(instance) if field.init}


def _after_four_steps(body: er.RotorBody | er.FullRotorBody) -> er.RotorBody | er.FullRotorBody:
    body.mbs.Assemble()
    settings = er.recommended_settings(4e-5, 1e-5, body=body)
    settings.solution.sensors.writePeriod = 1e-5
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    body.mbs.SolveDynamic(settings)
    return body
