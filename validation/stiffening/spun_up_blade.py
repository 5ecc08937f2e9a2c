"""A blade spun up beyond its first lag frequency: levels of stiffening and a nonlinear referee.

The classical spin-up manoeuvre: ω(t) grows smoothly from rest, the Euler force bends the blade
back, and without centrifugal stiffening the deflection runs away: at the level 'none', which is
what Exudyn's 3D body has with its frame in the hub (``overhung.py``), and at 'tilt'. The referee
integrates the geometrically nonlinear solid in the rotating frame; all models take the trapezoidal
rule with the same steps.

python -m validation spun_up_blade [--quick] [--picture FILE]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

import ngsolve as ngs
import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from netgen.occ import Box, OCCGeometry, Pnt, X
from tqdm import tqdm

from exudyn_rotor import Formulation, Motion, PrescribedMotion, plotting, select_modes
from exudyn_rotor.theory.stiffening import stiffening
from validation.rows import verdict
from validation.stiffening.nonlinear import ClampedSolid

HUB, LENGTH = 0.05, 0.4  # m
END_SPEED, SPIN_UP, DURATION = 500.0, 0.4, 0.45  # rad/s, s, s
STEP, QUICK_STEP = 1e-3, 2.5e-3  # s
MODES = 16
LEVELS = ("none", "tilt", "full")
SPIN = PrescribedMotion.run_up(0.0, END_SPEED, SPIN_UP)

# the residual f(t, q, q̇) without inertia, and its derivatives by q and q̇
Residual = Callable[[float, np.ndarray, np.ndarray], tuple]


def thin_blade(element_size: float = 0.04) -> ngs.Mesh:
    """Return a blade along x, 10 mm thin in the plane of rotation, 30 mm along the axis."""
    solid = Box(Pnt(HUB, -0.005, -0.015), Pnt(HUB + LENGTH, 0.005, 0.015))
    solid.faces.Min(X).name = "root"
    return ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=element_size))


def trapezoidal(
    mass: sp.csc_array, residual: Residual, step: float, watched: np.ndarray, label: str
) -> np.ndarray:
    """Integrate ``M q̈ + r(t, q, q̇) = 0`` from rest; return ``watched @ q`` over time.

    The trapezoidal rule with Newton's method, to 1e-10 of the state. NaN once it has run away.
    """
    count = round(DURATION / step)
    q, v = np.zeros((2, mass.shape[0]))
    a = np.zeros_like(q)
    track = np.full(count + 1, np.nan)
    track[0] = 0.0
    for index in tqdm(range(1, count + 1), desc=label, leave=False):
        t = index * step
        ahead, rate = q + step * v + step**2 / 4 * a, v + step / 2 * a
        new = a.copy()
        for _ in range(20):
            place, speed = ahead + step**2 / 4 * new, rate + step / 2 * new
            force, by_q, by_v = residual(t, place, speed)
            matrix = sp.csc_array(mass + step**2 / 4 * by_q + step / 2 * by_v)
            change = sla.spsolve(matrix, -(mass @ new + force))
            new = new + change
            moved = step**2 / 4 * np.linalg.norm(change)
            if moved <= 1e-10 * (np.linalg.norm(place) + 1e-12):
                break
        q, v, a = ahead + step**2 / 4 * new, rate + step / 2 * new, new
        track[index] = watched @ q
        if not abs(track[index]) < LENGTH:
            track[index] = np.nan
            break
    return track


def referee(solid: ClampedSolid, step: float) -> np.ndarray:
    """Return the tip's lag deflection of the nonlinear solid [m]."""
    free = solid.free
    mass, across, turning = (
        sp.csc_array(sp.csr_array(matrix)[free][:, free])
        for matrix in (solid.rotor.mass, solid.across_mass, solid.coriolis)
    )
    rest = solid.rotor.nodes.ravel()
    outward, sideways = (solid.across_mass @ rest)[free], (solid.coriolis @ rest)[free]

    def residual(t: float, q: np.ndarray, v: np.ndarray) -> tuple:
        omega, rate = SPIN.rate(t), SPIN.acceleration(t)
        u = np.zeros(rest.size)
        u[free] = q
        force, tangent = solid.elastic(u)
        inertia = rate * (sideways + turning @ q) - omega**2 * (outward + across @ q)
        by_q = sp.csr_array(tangent)[free][:, free] + rate * turning - omega**2 * across
        return force[free] + inertia + 2 * omega * (turning @ v), by_q, 2 * omega * turning

    return trapezoidal(mass, residual, step, tip(solid)[free], "nonlinear solid")


def reduced(solid: ClampedSolid, level: str, step: float) -> np.ndarray:
    """Return the tip's lag deflection of the reduced rotor [m]."""
    rotor = solid.clamped.reduce(MODES, prestress=True)
    formulation = Formulation("none", SPIN)
    chosen = select_modes(rotor, formulation)
    motion = Motion(chosen.invariants, formulation, stiffening(chosen.invariants, level))

    def residual(t: float, q: np.ndarray, v: np.ndarray) -> tuple:
        by_q, by_v = motion.jacobian(t, q, v)
        return -motion.forces(t, q, v), sp.csc_array(-by_q), sp.csc_array(-by_v)

    watched = tip(solid) @ (rotor.shapes.matrix @ chosen.T)
    mass = sp.csc_array(motion.mass_matrix(0.0, np.zeros(motion.size)))
    return trapezoidal(mass, residual, step, watched, level)


def tip(solid: ClampedSolid) -> np.ndarray:
    """Return the row that reads the mean displacement along y at the blade's end, shape (3n,)."""
    ends = np.flatnonzero(solid.rotor.nodes[:, 0] > HUB + LENGTH - 1e-9)
    row = np.zeros((solid.rotor.node_count, 3))
    row[ends, 1] = 1.0 / len(ends)
    return row.ravel()


def compare(solid: ClampedSolid, step: float) -> dict[str, np.ndarray]:
    """Return the deflections of the referee and of all levels over time [m]."""
    tracks = {"nonlinear solid": referee(solid, step)}
    return tracks | {level: reduced(solid, level, step) for level in LEVELS}


def summary(tracks: dict[str, np.ndarray], step: float) -> list[dict]:
    """Return the largest deviation of every level over the referee's largest deflection."""
    exact = tracks["nonlinear solid"]
    rows = []
    for level in LEVELS:
        lost = np.flatnonzero(np.isnan(tracks[level]))
        deviation = np.abs(tracks[level] - exact).max() / np.abs(exact).max()
        rows.append(
            {
                "level": level,
                "deviation": None if lost.size else float(deviation),
                "lost_at": float(step * lost[0]) if lost.size else None,
            }
        )
    return rows


def draw(tracks: dict[str, np.ndarray], step: float, path: Path) -> None:
    """Draw the deflections over time."""
    made, axes = plotting.figure()
    limit = 2.0 * np.abs(tracks["nonlinear solid"]).max()
    for (name, track), color, line in zip(
        tracks.items(), plotting.COLORS, plotting.LINES, strict=False
    ):
        axes.plot(step * np.arange(len(track)), 1e3 * track, line, color=color, label=name)
    axes.set(xlabel="time [s]", ylabel="lag deflection of the tip [mm]")
    axes.set_ylim(-1e3 * limit, 0.1e3 * limit)
    axes.grid(alpha=0.3)
    plotting.legend_above(axes, columns=4)
    plotting.save(made, path)


def main(argv: list[str] | None = None) -> int:
    """Integrate all models, print the table and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="larger steps")
    parser.add_argument("--picture", type=Path, help="draw the deflections to this file")
    options = parser.parse_args(argv)
    solid = ClampedSolid.of(thin_blade(), "root")
    step = QUICK_STEP if options.quick else STEP
    tracks = compare(solid, step)
    rows = summary(tracks, step)
    largest = np.abs(tracks["nonlinear solid"]).max()
    print(f"{solid.rotor.node_count} nodes, 0 to {END_SPEED} rad/s in {SPIN_UP} s, steps {step} s")
    print(f"largest lag deflection of the tip: {1e3 * largest:.3f} mm (nonlinear solid)")
    for row in rows:
        lost = row["lost_at"]
        text = f"runs away at {lost:.4f} s" if lost else f"deviation {row['deviation']:.1e}"
        print(f"{row['level']:8}{text}")
    if options.picture:
        draw(tracks, step, options.picture)
    full = next(row for row in rows if row["level"] == "full")
    return verdict({"deviation of 'full'": (full["deviation"], 1e-3)})
