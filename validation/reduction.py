"""What reduction costs in accuracy: reduced runs against the full run of the same scene.

A disc on a shaft with an unbalance and gravity on two bearings runs up smoothly and stays at its
speed: on stiff bearings, on soft ones where it passes a critical speed, and overhung, about x, with
the axis beside the middle of the shaft and the whole centrifugal stiffening. All bodies take the
same steps, so that only the basis differs. Errors are the largest in the run-up, or in the last
third, relative to the largest value of the full run:

- ``interfaces``: their displacement in space;
- ``shape``: their displacement against the mean motion of the rotor, which the bearings do not hold
  and the row ``residual`` of ``check_run`` estimates; over the displacement or the bending there,
  whichever is larger;
- ``anywhere``: the displacement of any node in the rotor frame, which the row ``displacement`` of
  ``check_run`` estimates with the full model; the radial stretch by the spin is nearly all of it
  where no mode breathes;
- ``stress``: von Mises stress of the difference at any node, the static centrifugal stress added
  (``StressField``), which the row ``stress`` estimates.

Beside each stands the true error over the estimate, which is one for the whole run. A last table
compares the true errors with what ``propose`` promises: the largest change of the response of the
interfaces to any load by the modes left out.

Run ``python -m validation reduction``, with ``--quick`` for one scene and fewer modes, ``--picture
FILE`` for a picture of the errors over the number of flexible modes.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import exudyn
import ngsolve
import numpy as np
from exudyn.itemInterface import SensorNode
from netgen.occ import Cylinder, OCCGeometry, Pnt, X, Z

from exudyn_rotor import (
    PrescribedMotion,
    ReducedRotor,
    RotorBody,
    SolidRotor,
    SpinAxis,
    StressField,
    Support,
    add_rotor,
    check_run,
    craig_bampton_modes,
    plotting,
    propose,
    spinning_modes,
)
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.theory.nodal import rotations, translations
from validation.exudyn_3d.against_3d import Row, print_table
from validation.exudyn_3d.scenes import ENDS, STEEL

SPEED, RUN_UP, DURATION = 300.0, 0.15, 0.3  # rad/s, s
STEP, SAMPLES = 2e-4, 150  # s
STIFF, SOFT = (2e7, 2e4), (2e5, 500.0)  # N/m, N s/m
WINDOWS = {"run-up": slice(15, 76), "steady": slice(100, 151)}  # samples
ACCURACIES = (1e-1, 1e-2, 1e-3)
ESTIMATES = {"shape": "residual", "anywhere": "displacement", "stress": "stress"}


@dataclass(frozen=True, eq=False)
class Motion:
    """A run at the sampled instants.

    Attributes
    ----------
    nodes : ndarray, shape (s, 3n)
        Displacements in the rotor frame [m].
    interfaces : ndarray, shape (s, 3i)
        Displacements in space [m].
    stress : ndarray, shape (s, n, 6)
        [Pa]
    """

    nodes: np.ndarray
    interfaces: np.ndarray
    stress: np.ndarray


def disc_on_shaft() -> SolidRotor:
    """Return a disc of radius 0.12 m on a shaft of 0.5 m, with 20 g at its rim; 307 nodes."""
    shaft = Cylinder(Pnt(0, 0, 0), Z, 0.02, 0.5)
    solid = shaft + Cylinder(Pnt(0, 0, 0.18), Z, 0.12, 0.03)
    return _rotor(solid, Z, 0.1, "z", ([0.12, 0, 0.2], 0.02))


def overhung_disc() -> SolidRotor:
    """Return an overhung disc about x, its axis 1 mm beside the middle of the shaft; 332 nodes."""
    shaft = Cylinder(Pnt(0, 0, 0), X, 0.02, 0.4)
    solid = shaft + Cylinder(Pnt(0.35, 0, 0), X, 0.1, 0.03)
    axis = SpinAxis([1.0, 0.0, 0.0], [0.0, 1e-3, 0.0])
    return _rotor(solid, X, 0.12, axis, ([0.365, 0.1, 0], 0.03))


def _rotor(solid, along, largest: float, axis: SpinAxis | str, mass: tuple) -> SolidRotor:
    """Return a steel solid, meshed, damped, prestressed, with a mass at a place."""
    solid.mat("steel")
    solid.faces.Min(along).name, solid.faces.Max(along).name = ENDS
    mesh = ngsolve.Mesh(OCCGeometry(solid).GenerateMesh(maxh=largest, curvaturesafety=0.5))
    rotor = SolidRotor.from_ngsolve(mesh, STEEL, axis).center_interfaces()
    rotor = rotor.with_damping(stiffness=2e-5).add_point_mass(*mass)
    return rotor.with_prestress(rotor.prestress())


class Scene:
    """The scene of some runs, and what is compared in it."""

    def __init__(
        self, rotor: SolidRotor, bearings: tuple[float, float], stiffening: str = "tilt"
    ) -> None:
        self.rotor, self.stiffening = rotor, stiffening
        self.spin = PrescribedMotion.run_up(0.0, SPEED, RUN_UP)
        self.stiffness, self.damping = bearings
        self.supports = [
            Support(end, self.stiffness * np.eye(3), self.damping * np.eye(3)) for end in ENDS
        ]

    @cached_property
    def full(self) -> Motion:
        """The full run."""
        _, nodes, interfaces = self._run(self.rotor, "fields")
        stress = self.rotor.stress_recovery(nodes.T).transpose(2, 0, 1)
        return Motion(nodes, interfaces, stress)

    def reduced(self, reduced: ReducedRotor) -> tuple[RotorBody, Motion]:
        """Return body and motion of a reduced run."""
        body, modal, interfaces = self._run(reduced, "modes")
        nodes = modal @ (reduced.shapes.matrix @ body.selection.T).T
        speed = np.array([self.spin.rate(t) for t in np.linspace(0.0, DURATION, SAMPLES + 1)])
        stress = StressField.of(reduced, body).history(modal, speed, slice(None))
        return body, Motion(nodes, interfaces, stress)

    def _run(
        self, rotor: SolidRotor | ReducedRotor, node: str
    ) -> tuple[RotorItems, np.ndarray, np.ndarray]:
        mbs = exudyn.SystemContainer().AddSystem()
        body = add_rotor(
            mbs,
            rotor,
            translation="none",
            spin=self.spin,
            stiffening=self.stiffening,
            gravity=[0, -9.81, 0],
            markers="position",
        )
        ground = mbs.CreateGround()
        for end in ENDS:
            mbs.CreateCartesianSpringDamper(
                itemNumbers=[ground, body.marker(end)],
                localPosition0=rotor.interfaces[end].reference,
                stiffness=[self.stiffness] * 3,
                damping=[self.damping] * 3,
            )
        kinds = exudyn.OutputVariableType
        ends = [body.add_interface_sensor(end, kinds.Displacement) for end in ENDS]
        state = mbs.AddSensor(
            SensorNode(
                nodeNumber=body.nodes[node],
                outputVariableType=kinds.Coordinates,
                storeInternal=True,
                writeToFile=False,
            )
        )
        if isinstance(rotor, ReducedRotor):
            body.start_recording()
        mbs.Assemble()
        settings = exudyn.SimulationSettings()
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = DURATION / SAMPLES
        settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
        integration = settings.timeIntegration
        integration.endTime, integration.numberOfSteps = DURATION, round(DURATION / STEP)
        integration.newton.useModifiedNewton = True
        integration.verboseMode = 0
        mbs.SolveDynamic(settings)
        stored = (mbs.GetSensorStoredData(sensor)[:, 1:] for sensor in ends)
        return body, mbs.GetSensorStoredData(state)[:, 1:], np.hstack(list(stored))

    @cached_property
    def _shape(self) -> np.ndarray:
        """Displacements of the interfaces less their mean rigid motion, (3i, 3n)."""
        rotor = self.rotor
        nodes, center = rotor.nodes, rotor.center_of_mass
        rigid = np.hstack([translations(len(nodes)), rotations(nodes, center)])
        weighted = rotor.mass @ rigid
        mean = np.linalg.solve(rigid.T @ weighted, weighted.T)
        parts = (rotor.interfaces[end].mean_motion(len(nodes))[:3] for end in ENDS)
        rows = np.vstack([part.toarray() for part in parts])
        return rows - (rows @ rigid) @ mean

    def errors(self, found: Motion, window: slice) -> Row:
        """Return the errors of a reduced run in a window of time."""
        full = self.full
        change = found.nodes[window] - full.nodes[window]
        ends = np.linalg.norm(full.interfaces[window], axis=1).max()
        bent = np.linalg.norm(full.nodes[window] @ self._shape.T, axis=1).max()
        difference = found.interfaces[window] - full.interfaces[window]
        stress = von_mises(found.stress[window] - full.stress[window]).max()
        return {
            "interfaces": float(np.linalg.norm(difference, axis=1).max() / ends),
            "shape": float(np.linalg.norm(change @ self._shape.T, axis=1).max() / max(ends, bent)),
            "anywhere": _longest(change) / _longest(full.nodes[window]),
            "stress": float(stress / von_mises(full.stress[window]).max()),
        }


def _longest(displacements: np.ndarray) -> float:
    return float(np.linalg.norm(displacements.reshape(-1, 3), axis=1).max())


def bases(rotor: SolidRotor, counts: Sequence[int]) -> list[tuple[str, ReducedRotor]]:
    """Return reduced rotors with their kinds of modes."""
    made = []
    for count in counts:
        fixed = craig_bampton_modes(rotor, count, coupling="RBE3")
        made.append(("free", rotor.reduce(count, stress=True)))
        made.append(("Craig–Bampton", rotor.reduce(fixed, stress=True)))
        spinning = spinning_modes(rotor, count, [SPEED])
        made.append(("spinning", rotor.reduce(spinning, stress=True)))
    return made


def certified(scene: Scene, counts: Sequence[int]) -> list[Row]:
    """Return the errors of each basis in each window, beside what ``check_run`` tells."""
    rows = []
    for kind, reduced in bases(scene.rotor, counts):
        body, found = scene.reduced(reduced)
        check = check_run(body, reduced=reduced, solid=scene.rotor, warn=False)
        for name, window in WINDOWS.items():
            errors = scene.errors(found, window)
            row = {"modes": kind, "flexible": float(reduced.size - len(reduced.rigid_kinds))}
            row |= {"window": name, "interfaces": errors["interfaces"]}
            for error, told in ESTIMATES.items():
                row[error] = errors[error]
                row[f"{error}/{told}"] = errors[error] / check[told].value
            rows.append(row)
    return rows


def promised(scene: Scene, count: int) -> list[Row]:
    """Return what proposals promise, and their true errors."""
    rich = scene.rotor.reduce(craig_bampton_modes(scene.rotor, count, coupling="RBE3"), stress=True)
    rows = []
    for accuracy in ACCURACIES:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            proposal = propose(
                rich,
                speeds=(0.0, SPEED),
                supports=scene.supports,
                accuracy=accuracy,
                spin=scene.spin,
            )
        _, found = scene.reduced(proposal.truncated(rich))
        errors = scene.errors(found, slice(WINDOWS["run-up"].start, None))
        row = {"accuracy": accuracy, "flexible": float(proposal.count), "promised": proposal.error}
        rows.append(row | errors | {"truth/promise": errors["shape"] / proposal.error})
    return rows


def draw(rows: list[Row], path: str) -> None:
    """Draw the errors in the steady part over the number of flexible modes."""
    made, axes = plotting.figure(1, 3, (12.0, 4.0), sharey=True)
    for ax, kind in zip(axes, ("free", "Craig–Bampton", "spinning"), strict=True):
        chosen = [row for row in rows if row["modes"] == kind and row["window"] == "steady"]
        counts = [row["flexible"] for row in chosen]
        for name, color in zip(("interfaces", *ESTIMATES), plotting.COLORS, strict=False):
            values = np.array([row[name] for row in chosen])
            ax.semilogy(counts, values, marker="o", color=color, label=name)
            if name in ESTIMATES:
                ratios = [row[f"{name}/{ESTIMATES[name]}"] for row in chosen]
                ax.semilogy(counts, values / ratios, "--", marker="x", color=color)
        ax.set_title(f"{kind} modes")
        ax.set_xlabel("flexible modes")
    axes[0].semilogy([], [], "k--", marker="x", label="estimate of check_run")
    axes[0].set_ylabel("error relative to the full run")
    axes[0].legend()
    plotting.save(made, path)


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="one scene, fewer modes, no proposals")
    parser.add_argument("--picture", metavar="FILE", help="draw the errors")
    options = parser.parse_args()
    scene = Scene(disc_on_shaft(), STIFF)
    rows = certified(scene, (4, 12) if options.quick else (4, 8, 16, 30))
    print_table("reduced runs against the full run of 307 nodes, stiff bearings", rows)
    if not options.quick:
        soft = Scene(scene.rotor, SOFT)
        print_table("the same on soft bearings, a critical speed passed", certified(soft, (4, 16)))
        other = Scene(overhung_disc(), STIFF, "full")
        print_table("overhung disc about x, axis 1 mm off", certified(other, (4, 16)))
        print_table("proposals, stiff bearings", promised(scene, 30))
    if options.picture:
        draw(rows, options.picture)


if __name__ == "__main__":
    main()
