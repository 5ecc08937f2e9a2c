"""What each section of the paper costs and gives: 2.1 to 2.5, full and reduced, on three meshes.

A balanced disc on a shaft on two bearings spins and is pushed into a small tilt; 2.5 holds its
speed, the others are free. Section 2.1 is Exudyn's own body with Euler parameters, ``ObjectFFRF``
and ``ObjectFFRFreducedOrder``; reduced bodies have twelve free modes. All take the same steps.

- ``coordinates``, ``constraints``: unknowns of the scene and algebraic equations;
- ``set-up``: from the FE model to the end of the first step, reduction included [s];
- ``step`` [µs]; ``memory``: what the process grew by [MB];
- ``deviation``: lateral motion of the bearings off that of the most general body on this mesh, over
  the motion: the full body of 2.1, or of 2.2 where Exudyn cannot carry that. It holds the phase
  errors of a step of 0.1 ms, and of reduced bodies the missing modes.

Run ``python -m validation family``, with ``--quick`` for the smallest mesh alone; on Unix.
"""

from __future__ import annotations

import argparse
import multiprocessing
import time
from collections.abc import Callable
from dataclasses import dataclass

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.FEM import FEMinterface
from exudyn.itemInterface import MarkerSuperElementPosition, SensorMarker, SensorSuperElement

from exudyn_rotor import Formulation, ReducedRotor, SolidRotor, add_rotor, select_modes
from exudyn_rotor.multibody.spatial_body import LARGEST, add_spatial_rotor
from validation.exudyn_3d.against_3d import Row, print_table
from validation.exudyn_3d.full_3d import (
    BEARINGS,
    SPEED,
    balanced,
    hold,
    inertia,
    integrate,
    run,
    system,
)
from validation.exudyn_3d.scenes import STEEL, Orbits, deviation, disc_on_shaft

MODES = 12
TILT = 1e-3  # rad
STEP, STEPS = 1e-4, 40  # of the compared motion
SECTIONS = {
    "2.1": {},
    "2.2": {"translation": "free", "spin": "free"},
    "2.3": {"translation": "in-plane", "spin": "free"},
    "2.4": {"translation": "none", "spin": "free"},
    "2.5": {"translation": "none", "spin": SPEED},
}
MESHES = {"coarse": (0.5, 1), "medium": (1.0, 1), "fine": (1.0, 2)}  # roundness, order
TIMED = {"full 3D": 5, "full": 40, "reduced": 1000}  # steps


@dataclass(frozen=True, eq=False)
class ReducedSpatialBody:
    """Exudyn's reduced 3D body, with the methods of the others that :func:`run` calls."""

    mbs: exudyn.MainSystem
    body: exudyn.ObjectIndex
    markers: dict[str, exudyn.MarkerIndex]

    def marker(self, interface: str) -> exudyn.MarkerIndex:
        """Return the marker of an interface."""
        return self.markers[interface]

    def add_interface_sensor(
        self, interface: str, output: exudyn.OutputVariableType
    ) -> exudyn.SensorIndex:
        """Add a sensor at an interface."""
        kind = {"outputVariableType": output, "storeInternal": True}
        return self.mbs.AddSensor(SensorMarker(markerNumber=self.markers[interface], **kind))

    def add_node_sensor(self, node: int, output: exudyn.OutputVariableType) -> exudyn.SensorIndex:
        """Add a sensor at a mesh node."""
        kind = {"outputVariableType": output, "storeInternal": True}
        return self.mbs.AddSensor(
            SensorSuperElement(bodyNumber=self.body, meshNodeNumber=node, **kind)
        )


def reduced_3d(rotor: SolidRotor, reduced: ReducedRotor, omega: np.ndarray) -> ReducedSpatialBody:
    """Return Exudyn's reduced 3D body in a new system."""
    mbs, fem = system(), FEMinterface()
    fem.nodes = {"Position": np.array(rotor.nodes)}
    fem.massMatrix, fem.stiffnessMatrix = sp.csr_matrix(rotor.mass), sp.csr_matrix(rotor.stiffness)
    columns = reduced.shapes.matrix[:, len(reduced.rigid_kinds) :]
    fem.modeBasis = {"matrix": np.array(columns), "type": "NormalModes"}
    made = mbs.CreateFFRFReducedOrderObject(
        "rotor",
        fem,
        initialVelocity=-np.cross(omega, rotor.center_of_mass),
        initialAngularVelocity=omega,
    )
    body = made["FFRFReducedOrderObjectDict"]["oFFRFreducedOrder"]
    markers = {
        name: mbs.AddMarker(
            MarkerSuperElementPosition(
                bodyNumber=body,
                meshNodeNumbers=interface.nodes,
                weightingFactors=interface.weights,
            )
        )
        for name, interface in rotor.interfaces.items()
    }
    return ReducedSpatialBody(mbs, body, markers)


def fixed_axis(
    rotor: SolidRotor, model: SolidRotor | ReducedRotor, omega: np.ndarray, options: dict
):
    """Return a fixed-axis body in a new system, started like the 3D bodies."""
    rates = np.cross(omega * [1, 1, 0], rotor.nodes - rotor.center_of_mass).ravel()
    if isinstance(model, ReducedRotor):
        selection = select_modes(model, Formulation(**options))
        rates = selection.T.T @ (model.shapes.matrix.T @ (rotor.mass @ rates))
    if options["spin"] == "free":
        options = options | {"initial_speed": omega[2]}
    return add_rotor(
        system(), model, stiffening="tilt", modal_velocities=rates, markers="position", **options
    )


def build(section: str, full: bool, rotor: SolidRotor, omega: np.ndarray):
    """Return the body of a section in a new system, from the FE model on."""
    if section == "2.1" and full:
        return add_spatial_rotor(system(), rotor, initial_angular_velocity=omega)
    reduced = None if full else rotor.reduce(MODES)
    if section == "2.1":
        return reduced_3d(rotor, reduced, omega)
    return fixed_axis(rotor, reduced or rotor, omega, SECTIONS[section])


def measured(section: str, full: bool, rotor: SolidRotor) -> tuple[Row, Orbits]:
    """Return costs and the motion of one body."""
    import resource  # only on Unix, as processes that fork

    rate = TILT * np.sqrt(BEARINGS.tilt_stiffness(rotor) / inertia(rotor))
    omega = np.array([rate, 0.0, SPEED])
    kind = "reduced" if not full else "full 3D" if section == "2.1" else "full"
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    began = time.perf_counter()
    body = build(section, full, rotor, omega)
    hold(body, rotor)
    integrate(body.mbs, STEP, 1)
    start = time.perf_counter() - began
    repeats = 1 if kind == "full 3D" else 3
    counts = (1, 1 + TIMED[kind])
    first, more = (
        min(integrate(body.mbs, steps * STEP, steps) for _ in range(repeats)) for steps in counts
    )
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    data = body.mbs.systemData
    row = {
        "section": section,
        "form": "full" if full else "reduced",
        "nodes": float(rotor.node_count),
        "coordinates": float(len(data.GetODE2Coordinates())),
        "constraints": float(len(data.GetAECoordinates())),
        "set-up/s": start,
        "step/µs": 1e6 * (more - first) / TIMED[kind],
        "memory/MB": grown / 1024.0,
    }
    orbits = run(build(section, full, rotor, omega), rotor, STEPS * STEP, STEPS)
    return row, orbits


def apart(function: Callable, *arguments):
    """Return what a function returns in a process of its own, whose memory is its own."""
    with multiprocessing.get_context("fork").Pool(1) as pool:
        return pool.apply(function, arguments)


def family(rotor: SolidRotor) -> list[Row]:
    """Return a row per section and form; the most general one first."""
    cases = [(section, full) for section in SECTIONS for full in (True, False)]
    if rotor.node_count > LARGEST:
        cases.remove(("2.1", True))
        cases.remove(("2.2", True))
        cases.insert(0, ("2.2", True))
    rows, reference = [], None
    for section, full in cases:
        row, orbits = apart(measured, section, full, rotor)
        reference = reference or orbits
        off = deviation(orbits, reference)["lateral"] / reference.excursion["lateral"]
        rows.append(row | {"deviation": off})
    return rows


def main() -> None:
    """Print a table per mesh."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="the smallest mesh alone")
    quick = parser.parse_args().quick
    for name, (roundness, order) in list(MESHES.items())[: 1 if quick else None]:
        mesh = disc_on_shaft(0.1, roundness)
        rotor = balanced(SolidRotor.from_ngsolve(mesh, STEEL, "z", order=order))
        print_table(f"{name} mesh", family(rotor))


if __name__ == "__main__":
    main()
