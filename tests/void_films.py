"""Films that conserve mass, and a rigid rotor on two of them, in lists and in scenes."""

import exudyn as exu
import numpy as np
from exudyn.itemInterface import LoadForceVector
from point_rotors import ring_rotor
from scipy.spatial.transform import Rotation

from exudyn_rotor import (
    JournalBearing,
    OilFilm,
    add_foundation,
    add_rotor,
    add_supports,
    bearing_loads,
    grooved_pads,
    recommended_settings,
)

CLEARANCE, SPEED = 1e-4, 580.0
BEHIND = 0.19  # rad: a groove behind the thinnest film, so that the film begins again in the pad
GRAVITY = np.array([0.0, -9.81, 0.0])


def oil(groove=BEHIND, cavitation="mass-conserving", preload=0.0, **options):
    pads = grooved_pads(CLEARANCE, np.atleast_1d(groove), np.radians(20.0), preload=preload)
    return OilFilm(0.05, 0.05, 0.02, pads, cavitation, **{"nodes": 24, "axial_nodes": 0, **options})


def exponent(state, mass, start, step=0.0):
    """Return s of ``det(M s² + Z(s)) = 0`` by Newton's method, voids by steps where there are."""
    u = np.moveaxis(state.film.grid.u, 2, 0)

    def determinant(s):
        void_rate = (1.0 - np.exp(-s * step)) / step if step else s
        Z = state._gradient(-u, -s * u[:, 0], void_rate)
        return np.linalg.det((mass * s**2 * np.eye(2) + Z) / 1e8)

    s = start
    for _ in range(30):
        h = 1e-6 * abs(s)
        s -= determinant(s) * 2.0 * h / (determinant(s + h) - determinant(s - h))
    return s


def rotor(eccentric=0.0):
    ring = ring_rotor(0.1, 0.15, 107.0)
    if eccentric:
        ring = ring.add_point_mass([0.1, 0.0, 0.0], eccentric)
    return ring.with_interface("left", range(5)).with_interface("right", range(5, 10)).reduce(0)


def bearings(reduced, gravity=GRAVITY, **options):
    loads = bearing_loads(reduced, ["left", "right"], gravity)
    film = oil(**options)
    return [
        JournalBearing(interface=name, film=film, load=load)
        for name, load in zip(("left", "right"), loads, strict=True)
    ]


def scene(reduced, supports, gravity=GRAVITY, foundation=None, **options):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, gravity=gravity, **options)
    base = (
        None
        if foundation is None
        else add_foundation(mbs, foundation, rotation=options.get("rotation"))
    )
    added = add_supports(body, supports, base)
    sensor = added[0].add_sensor()
    mbs.Assemble()
    return mbs, body, sensor


def solve(mbs, end_time, step, **options):
    settings = recommended_settings(end_time=end_time, step=step)
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0
    mbs.SolveDynamic(settings, **options)


def kick(body, force):
    """Add a short push, (3,) [N], on both bearings, to an assembled scene."""

    def push(mbs, t, load):
        return (np.sin(np.pi * t / 5e-3) * np.array(force)).tolist() if t < 5e-3 else [0.0] * 3

    for name in ("left", "right"):
        marker = body.marker(name)
        body.mbs.AddLoad(
            LoadForceVector(markerNumber=marker, loadVector=force, loadVectorUserFunction=push)
        )
    body.mbs.Assemble()


def oscillations(motion, step, rank=7):
    """Return exponents of the oscillations in samples (n, 2), by the matrix pencil."""
    count = len(motion) // 2
    columns = [[signal[i : i + count] for i in range(len(motion) - count)] for signal in motion.T]
    U = np.linalg.svd(np.hstack([np.array(each).T for each in columns]), full_matrices=False)[0]
    U = U[:, :rank]
    s = np.log(np.linalg.eigvals(np.linalg.pinv(U[:-1]) @ U[1:]).astype(complex)) / step
    return s[s.imag > 50.0]


SKEW = Rotation.from_euler("XYZ", [0.7, -0.4, 1.1]).as_matrix()
