"""The full fixed-axis body against Exudyn's own full 3D body, at tilts from 1e-2 to 1e-4 rad.

Both hold the displacements of all nodes of one small mesh, in balance, on the same bearings, from
the same start, with the same steps; the 3D body has Euler parameters and mean-axis conditions. What
the fixed axis leaves out is of second order, so the deviation relative to the motion falls with the
tilt. With ``stiffening='none'``, the paper's own equations, it does not.

Run ``python -m validation full_3d``, with ``--quick`` for a smaller mesh.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

import exudyn
import numpy as np
from scipy.optimize import nnls

from exudyn_rotor import SolidRotor, add_rotor
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from validation.exudyn_3d.against_3d import with_orders
from validation.exudyn_3d.scenes import (
    STEEL,
    Bearings,
    Orbits,
    cylinder,
    deviation,
    disc_on_shaft,
    extrapolated,
    simulate,
)
from validation.exudyn_3d.spatial_body import SpatialBody, add_spatial_rotor
from validation.rows import Row, print_rows, verdict

SPEED = 314.0  # rad/s
ENDS = ("centred left", "centred right")
BEARINGS = Bearings((1e6, 1e6, 1e6), 200.0)
LEVELS = ("tilt", "none")
TILTS = (1e-2, 1e-3, 1e-4)


def balanced(rotor: SolidRotor) -> SolidRotor:
    """Return the rotor in balance, statically and dynamically, its interfaces on the axis z.

    A coarse mesh is neither: it would tilt by itself, whatever the start. Masses at nodes balance
    it, and the least change of their weights moves the interfaces.
    """
    mass = rotor.mass[::3, ::3]
    x, y, z = rotor.nodes.T
    moments = np.stack([x, y, x * z, y * z])
    found = [(mass @ x).sum(), (mass @ y).sum(), x @ (mass @ z), y @ (mass @ z)]
    added, _ = nnls(moments, -np.array(found))
    for node in np.flatnonzero(added):
        rotor = rotor.add_point_mass(rotor.nodes[node], float(added[node]))
    for name, interface in rotor.interfaces.items():
        moments = np.vstack([np.ones(interface.nodes.size), interface.positions[:, :2].T])
        error = np.array([1.0, 0.0, 0.0]) - moments @ interface.weights
        weights = interface.weights + np.linalg.pinv(moments) @ error
        rotor = rotor.with_interface(f"centred {name}", interface.nodes, weights)
    return rotor


def inertia(rotor: SolidRotor) -> float:
    """Return the mean transverse moment of inertia about the centre of mass [kg m²]."""
    arms = rotor.nodes - rotor.center_of_mass
    J = arms.T @ (rotor.mass[::3, ::3] @ arms)
    return float(J[2, 2] + 0.5 * (J[0, 0] + J[1, 1]))


def three_d(mbs: exudyn.MainSystem, rotor: SolidRotor, omega: np.ndarray) -> SpatialBody:
    """Add Exudyn's full 3D body that turns with `omega` about its centre of mass [rad/s]."""
    return add_spatial_rotor(mbs, rotor, angular_velocity=omega)


def fixed_axis(
    mbs: exudyn.MainSystem, rotor: SolidRotor, omega: np.ndarray, level: str = "tilt"
) -> RotorItems:
    """Add the full fixed-axis body with free translation and spin, started alike."""
    rates = np.cross(omega * [1, 1, 0], rotor.nodes - rotor.center_of_mass)
    return add_rotor(
        mbs,
        rotor,
        translation="free",
        spin="free",
        stiffening=level,
        initial_speed=omega[2],
        modal_velocities=rates.ravel(),
        markers="position",
    )


def run(
    body: SpatialBody | RotorItems,
    rotor: SolidRotor,
    duration: float,
    steps: int,
    samples: int = 20,
) -> Orbits:
    """Return the motion of a body on its bearings."""
    mbs, ground = body.mbs, body.mbs.CreateGround()
    for end in ENDS:
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.markers[end]],
            localPosition0=rotor.interfaces[end].center,
            stiffness=list(BEARINGS.stiffness),
            damping=[BEARINGS.damping] * 3,
        )
    place = exudyn.OutputVariableType.Position
    rim = int(np.argmax(np.linalg.norm(rotor.nodes[:, :2], axis=1)))
    sensors = [body.add_interface_sensor(end, place) for end in ENDS]
    sensors.append(body.add_node_sensor(rim, place))
    return simulate(mbs, sensors, duration, duration / steps, samples, spectral_radius=0.9)


def system() -> exudyn.MainSystem:
    """Return an empty system."""
    return exudyn.SystemContainer().AddSystem()


def compare(
    rotor: SolidRotor,
    duration: float,
    steps: int,
    tilts: tuple[float, ...] = TILTS,
    levels: tuple[str, ...] = LEVELS,
) -> list[Row]:
    """Return deviations of the full fixed-axis body relative to the lateral motion.

    Of both bodies `steps` and twice as many are extrapolated to a step of zero.
    """

    def limit(add: Callable, *options) -> Orbits:
        counts = steps, 2 * steps
        runs = (run(add(system(), rotor, *options), rotor, duration, n) for n in counts)
        return extrapolated(*runs)

    rows = []
    for tilt in tilts:
        rate = tilt * np.sqrt(BEARINGS.tilt_stiffness(rotor) / inertia(rotor))
        omega = np.array([rate, 0.0, SPEED])
        reference = limit(three_d, omega)
        size = reference.excursion["lateral"]
        for level in levels:
            found = deviation(limit(fixed_axis, omega, level), reference)
            row = {"bearings": "isotropic", "stiffening": level}
            row["tilt"] = float(np.abs(reference.tilt).max())
            rows.append(row | {key: value / size for key, value in found.items()})
    rows.sort(key=lambda row: row["stiffening"] != "tilt")
    return with_orders(rows, ("lateral", "axial"))


LIMITS = {"lateral": 1e-5, "axial": 1e-4, "rim": 1e-4}  # at the least tilt


def main() -> int:
    """Print the table and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a smaller mesh")
    quick = parser.parse_args().quick
    mesh = cylinder(0.05, 0.3, 0.1) if quick else disc_on_shaft(0.1, 0.5)
    rotor = balanced(SolidRotor.from_ngsolve(mesh, STEEL, "z", order=1))
    duration, steps = (0.005, 40) if quick else (0.01, 80)
    rows = compare(rotor, duration, steps)
    print_rows(f"full bodies, {rotor.node_count} nodes, deviation over lateral motion", rows)
    least = min((row for row in rows if row["stiffening"] == "tilt"), key=lambda row: row["tilt"])
    return verdict({name: (least[name], most) for name, most in LIMITS.items()})
