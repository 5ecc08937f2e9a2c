"""What each bearing costs in a scene, and what its linear model loses in large motions.

Cost: one rotor of 8 modes on two bearings, under its weight; each kind in turn, the fastest of
several runs of the same steps. Loss: a rigid rotor with unbalance in the same two bearings, the
orbit of a run against the unbalance response with the bearing linearised under its load.

    python -m validation bearings [--quick]
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import exudyn
import numpy as np

import exudyn_rotor as er
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.demo.scene import BEARINGS, STEEL, disc_on_shaft

SPEED, STEP, WEIGHT = 180.0, 1e-4, [0.0, 0.0, -9.81]
OIL = {"radius": 0.02, "length": 0.015, "viscosity": 0.02}
PADS = er.grooved_pads(5e-5, [0.0, np.pi], 0.35)
Kind = Callable[[str, np.ndarray], Given]


def _finite(axial_nodes: int, cavitation: str = "reynolds") -> Kind:
    film = er.OilFilm(**OIL, pads=PADS, axial_nodes=axial_nodes, cavitation=cavitation)
    return lambda name, load: er.JournalBearing(interface=name, film=film, load=load)


def _tilting(name: str, load: np.ndarray) -> Given:
    gaps = np.radians([54.0, 126.0, 198.0, 270.0, 342.0])
    film = er.OilFilm(**OIL, pads=er.grooved_pads(1e-4, gaps, 0.2, 0.5), axial_nodes=0)
    return er.TiltingPadBearing(interface=name, film=film, load=load, pad_inertia=1e-5)


def _rolling(name: str, load: np.ndarray) -> Given:
    size = {"count": 8, "pitch_radius": 0.033, "element_radius": 0.006, "stiffness": 7e9}
    return er.RollingBearing(interface=name, load=load, damping=500.0, **size)


CROSSED = np.array([[5e6, 1e6], [-5e5, 8e6]])
KINDS: dict[str, Kind] = {
    "Support, diagonal": lambda name, load: er.Support(name, [[5e6, 0], [0, 8e6]], 900.0),
    "Support, cross-coupled": lambda name, load: er.Support(name, CROSSED, 900.0),
    "Support, table over speed": lambda name, load: er.Support(
        name, ([0.0, 500.0], [CROSSED, 2.0 * CROSSED]), 900.0
    ),
    "SqueezeFilmDamper, with spring": lambda name, load: er.SqueezeFilmDamper(
        interface=name, load=load, clearance=1e-4, centring_stiffness=5e6, **OIL
    ),
    "ClearanceStop, in contact": lambda name, load: er.ClearanceStop(
        interface=name, radius=0.02, clearance=2e-5, stiffness=1e7, damping=1e4, friction=0.1
    ),
    "RollingBearing, 8 balls": _rolling,
    "ShortJournalBearing": lambda name, load: er.ShortJournalBearing(
        interface=name, load=load, clearance=5e-5, **OIL
    ),
    "JournalBearing, one axial profile": _finite(0),
    "JournalBearing, 12 axial nodes": _finite(12),
    "JournalBearing, 12, mass-conserving": _finite(12, "mass-conserving"),
    "JournalBearing, profile, mass-conserving": _finite(0, "mass-conserving"),
    "TiltingPadBearing, 5 pads, one profile": _tilting,
}


# ------------------------------------------------------------------ cost


def _seconds(rotor: er.ReducedRotor, bearings: list[Given], steps: int, **spin: float) -> float:
    """Return the processor time of a step after a settling run [s]."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, gravity=WEIGHT, markers="position", **spin)
    er.add_supports(body, bearings)
    mbs.Assemble()
    settings = er.recommended_settings(steps * STEP, STEP)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings, updateInitialValues=True)
    start = time.process_time()
    mbs.SolveDynamic(settings)
    return (time.process_time() - start) / steps


def cost(steps: int, repeats: int) -> list[str]:
    """Return the time of a step with each kind, and as multiples of the first."""
    rotor = er.SolidRotor.from_ngsolve(disc_on_shaft(0.08, 1.0), STEEL["steel"], axis="x")
    rotor = rotor.reduce(8).without_shapes()
    loads = er.bearing_loads(rotor, list(BEARINGS), WEIGHT)
    spins = {"constant speed": {"spin": SPEED}, "free spin": {"initial_speed": SPEED}}
    times = {(name, spin): [] for name in KINDS for spin in spins}
    for _ in range(repeats):
        for (name, spin), found in times.items():
            pair = zip(BEARINGS, loads, strict=True)
            bearings = [KINDS[name](end, load) for end, load in pair]
            found.append(_seconds(rotor, bearings, steps, **spins[spin]))
    first = min(times[next(iter(KINDS)), "constant speed"])
    lines = [f"{'µs per step, two bearings':40}" + "".join(f"{spin:>24}" for spin in spins)]
    for name in KINDS:
        best = [min(times[name, spin]) for spin in spins]
        lines.append(f"{name:40}" + "".join(f"{1e6 * t:15.0f} ({t / first:5.1f})" for t in best))
    return lines


# ------------------------------------------------------------------ what the linear model loses

CLEARANCE, MASS, SIZES = 5e-5, 20.0, (0.05, 0.2, 0.5, 1.0)
TURNS, SHOWN, PER_TURN = 30, 5, 200
LOSING = ("SqueezeFilmDamper, with spring", "RollingBearing, 8 balls", "ShortJournalBearing")
LOSING += ("JournalBearing, one axial profile",)


def _rigid(eccentricity: float) -> er.ReducedRotor:
    """Return two rings about x of together 20 kg, their centre of mass off the axis by so much."""
    angles = 2.0 * np.pi * np.arange(6) / 6
    ring = 0.1 * np.column_stack([np.zeros(6), np.cos(angles), np.sin(angles)])
    nodes = np.vstack([ring - [0.2, 0.0, 0.0], np.add(ring, [0.2, 0.0, 0.0])])
    masses = MASS / 12 * (1.0 + 2.0 * eccentricity / 0.1 * np.tile(np.cos(angles), 2))
    mass = np.diag(np.repeat(masses, 3))
    rotor = er.SolidRotor.from_matrices(mass, np.zeros((36, 36)), nodes, "x", allow_parts=True)
    rotor = rotor.with_interface("left", range(6)).with_interface("right", range(6, 12))
    return rotor.reduce(0)


def _orbit(rotor: er.ReducedRotor, bearings: list[Given], speed: float) -> float:
    """Return the larger semi-axis of the harmonic of a run that turns with the rotor [m]."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, gravity=WEIGHT, spin=speed, markers="position")
    er.add_supports(body, bearings)
    sensor = body.add_interface_sensor("left", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    turn = 2.0 * np.pi / speed
    settings = er.recommended_settings(TURNS * turn, turn / PER_TURN, accuracy=1e-6)
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = turn / PER_TURN
    mbs.SolveDynamic(settings)
    path = mbs.GetSensorStoredData(sensor)[-SHOWN * PER_TURN :]
    place, wave = path[:, 2] + 1j * path[:, 3], np.exp(1j * speed * path[:, 0])
    return abs(np.mean(place / wave)) + abs(np.mean(place * wave))


def loss(speed: float, sizes: tuple[float, ...]) -> list[str]:
    """Return orbits over the clearance by the linear model, and what runs add to them."""
    even = _rigid(0.0)
    loads = er.bearing_loads(even, list(BEARINGS), WEIGHT)
    head = "".join(f"{f'{size:g}':>18}" for size in sizes)
    lines = [f"{f'{speed:g} rad/s; offset of the mass / {CLEARANCE:g} m':36}{head}"]
    for name in LOSING:
        pair = zip(BEARINGS, loads, strict=True)
        bearings, cells = [KINDS[name](end, load) for end, load in pair], []
        for size in sizes:
            offset = size * CLEARANCE
            unbalance = [er.Unbalance(end, 0.5 * MASS * offset) for end in BEARINGS]
            linear = er.unbalance_response(even, [speed], unbalance, supports=bearings)
            expected = float(linear.semi_axes("left")[0][0])
            found = _orbit(_rigid(offset), bearings, speed)
            cells.append(f"{expected / CLEARANCE:8.4f} {found / expected - 1.0:+9.2%}")
        lines.append(f"{name:36}" + "".join(cells))
    return lines


def main(arguments: list[str] | None = None) -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer steps and sizes")
    quick = parser.parse_args(arguments).quick
    print("\n".join(cost(*((50, 1) if quick else (200, 3)))))
    print("\n".join(loss(300.0, SIZES[-1:] if quick else SIZES)))


if __name__ == "__main__":
    main()
