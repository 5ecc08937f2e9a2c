"""Elements of scenes that take energy, with what they store and lose written here.

Losses follow from the motion alone, by dissipation functions: squares of rates, the pressure
gradient and shear of films, sliding times friction.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.signal
from test_magnetic_bearing import K_I, K_S, LINEAR, controller_states

from exudyn_rotor import (
    AnnularSeal,
    ClearanceStop,
    JournalBearing,
    MagneticBearing,
    OilFilm,
    PIDController,
    RollingBearing,
    ShortJournalBearing,
    SqueezeFilmDamper,
    Support,
    TiltingPadBearing,
    grooved_pads,
)

MASS = 5.002  # of the rotor [kg]


@dataclass
class Motion:
    """What one interface and the element there do over the steps, along n1, n2 (and e)."""

    angle: np.ndarray
    speed: np.ndarray
    u: np.ndarray  # (s, 3)
    v: np.ndarray
    tilt: np.ndarray  # (s, 2)
    tilt_rate: np.ndarray
    time: np.ndarray
    own: np.ndarray  # coordinates of the element, if any
    own_rate: np.ndarray


@dataclass
class Shares:
    """Energy stored [J], power lost and power fed in [W], over the steps."""

    stored: np.ndarray | float = 0.0
    lost: np.ndarray | float = 0.0
    fed: np.ndarray | float = 0.0


def dot(a, b):
    return np.einsum("...i,...i->...", a, b)


def around(u):
    """Return e × u of rows."""
    return np.column_stack([-u[:, 1], u[:, 0], *np.zeros((u.shape[1] - 2, len(u)))])


# ------------------------------------------------------------------ linear supports and seals

K = np.array([[2.0e6, 4e5, 1e5], [4e5, 1.2e6, 2e5], [1e5, 2e5, 3e6]])
SKEW = np.array([[0.0, 3e5, 0.0], [-3e5, 0.0, 1e5], [0.0, -1e5, 0.0]])
D = np.array([[300.0, 40.0, 10.0], [-30.0, 200.0, 20.0], [5.0, -10.0, 100.0]])
TILT_K, TILT_D = np.array([[4e3, 1e3], [1e3, 2e3]]), np.array([[9.0, 2.0], [1.0, 5.0]])
TILTS = {"tilt_stiffness": TILT_K, "tilt_damping": TILT_D}


def linear(m):
    tilts = dot(m.tilt @ TILT_K, m.tilt), dot(m.tilt_rate @ TILT_D, m.tilt_rate)
    stored, lost = 0.5 * dot(m.u @ K, m.u) + 0.5 * tilts[0], dot(m.v @ D, m.v) + tilts[1]
    return Shares(stored, lost, -dot(m.u @ SKEW.T, m.v))


def tilt_springs(m):
    return Shares(5e5 * dot(m.u, m.u) + 0.5 * dot(m.tilt @ TILT_K, m.tilt))


def by_table(m):
    u, v = m.u[:, :2], m.v[:, :2]
    lost = 4.0 * dot(v, v) + 0.1 * dot(m.tilt_rate, m.tilt_rate)
    return Shares(5e5 * dot(u, u), m.speed * lost)


def turning(m):
    """In axes that turn with the rotor; what turns them holds the force, and feels no moment."""
    c, s = np.cos(m.angle), np.sin(m.angle)
    R = np.zeros((len(c), 3, 3))  # into these axes
    R[:, 0, 0], R[:, 0, 1], R[:, 1, 0], R[:, 1, 1], R[:, 2, 2] = c, s, -s, c, 1.0
    speed = m.speed[:, None]
    carried = speed * around(m.u)
    x, x_t = (np.einsum("sij,sj->si", R, w) for w in (m.u, m.v - carried))
    tilts = m.tilt, m.tilt_rate - speed * around(m.tilt)
    y, y_t = (np.einsum("sij,sj->si", R[:, :2, :2], w) for w in tilts)
    force = -np.einsum("sji,sj->si", R, x @ K + x_t @ D.T)
    stored, lost = 0.5 * dot(x @ K, x), dot(x_t @ D, x_t)
    return Shares(
        stored + 0.5 * dot(y @ TILT_K, y), lost + dot(y_t @ TILT_D, y_t), dot(force, carried)
    )


SEAL = {"radius": 0.1, "length": 0.01, "clearance": 3e-4, "pressure_drop": 1.2e6}
SEAL |= {"density": 1000.0, "viscosity": 1e-3}


def seal(m):
    """−k z − d (ż − iΩ z/2) − M (z̈ − iΩ ż − Ω² z/4), whose M changes with the speed."""
    k, d, M = np.array([AnnularSeal(interface="left", **SEAL)._terms(each) for each in m.speed]).T
    u, v, half = m.u[:, :2], m.v[:, :2], 0.5 * m.speed
    fed = half * d * dot(around(u), v) - (k - M * half**2) * dot(u, v)
    fed = fed + 0.5 * np.gradient(M, m.time, edge_order=2) * dot(v, v)
    return Shares(0.5 * M * dot(v, v), d * dot(v, v), fed)


# ------------------------------------------------------------------ films

OIL = {"radius": 0.05, "length": 0.02, "clearance": 1e-4, "viscosity": 0.02}


def short_film(m, turns=1.0):
    """Shear μ R³ L Ω²/h, and flow h³ (∂p/∂z)²/12 μ = μ R L³ fed²/h³ where the film carries."""
    R, L, c, mu = OIL.values()
    phi, speed = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False), turns * m.speed[:, None]
    n, t = np.array([np.cos(phi), np.sin(phi)]), np.array([-np.sin(phi), np.cos(phi)])
    h = c - m.u[:, :2] @ n
    fed = -0.5 * speed * (m.u[:, :2] @ t) - m.v[:, :2] @ n
    lost = mu * R * L**3 * np.minimum(fed, 0.0) ** 2 / h**3 + mu * L * R**3 * speed**2 / h
    return Shares(lost=2.0 * np.pi * lost.mean(axis=1))


def squeeze_film(m):
    return Shares(1e6 * dot(m.u[:, :2], m.u[:, :2]), short_film(m, turns=0.0).lost)


def film_loss(film, place, velocity, speed):
    """Return shear μ R³ L Ω²/h and flow h³ |∇p|²/12 μ on the grid, whose faces lie between [W]."""
    state = film.state(place, velocity, speed)
    grid, (h, *faces) = film.grid, state.solution.equation.heights
    p, (mass,), ((rigidity,),) = (
        state.solution.pressure[:, 0],
        grid.axial.mass,
        grid.axial.stiffness,
    )
    flow, covered = rigidity * np.sum(grid.step * h**3 * p**2), np.sum(grid.step / h)
    for face, inside, to in zip(
        faces, (grid.at_left, grid.at_right), (grid.left, grid.right), strict=True
    ):
        drop, share = p - np.where(inside, p[to], 0.0), np.where(inside, 0.5, 1.0)
        flow += mass * np.sum(share * face**3 * drop**2 / grid.step)
        covered += 0.5 * np.sum(grid.step[~inside] / face[~inside])
    shear = film.viscosity * film.radius**3 * film.length * speed**2 * covered
    return flow / (12.0 * film.viscosity) + shear


def finite_film(film, u, v, speed):
    return np.array([film_loss(film, *each) for each in zip(u, v, speed, strict=True)])


PADS = grooved_pads(2e-4, np.radians([10.0, 130.0, 250.0]), 0.2, 0.5)
FILM = OilFilm(0.05, 0.02, 0.02, PADS, "none", nodes=24, axial_nodes=0)
INERTIA, PIVOT = 3e-4, 0.55


def pads(m):
    """A pad that tilts by δ moves by −R δ t; the pads have kinetic energy."""
    total = Shares(stored=0.5 * INERTIA * dot(m.own_rate, m.own_rate))
    for number, pad in enumerate(PADS):
        at = pad.start + PIVOT * pad.arc
        t = -0.05 * np.array([-np.sin(at), np.cos(at)])
        moved = (x[:, :2] - np.outer(y[:, number], t) for x, y in ((m.u, m.own), (m.v, m.own_rate)))
        film = OilFilm(0.05, 0.02, 0.02, [pad], "none", nodes=24, axial_nodes=0)
        total.lost += finite_film(film, *moved, m.speed)
    return total


# ------------------------------------------------------------------ stops, balls, magnets

STOP = {"radius": 0.05, "clearance": 1e-4, "stiffness": 4e6, "damping": 30.0, "friction": 0.1}


def stop(m):
    e = np.hypot(*m.u.T[:2])
    n = m.u[:, :2] / e[:, None]
    depth, approach = e - 1e-4, dot(n, m.v[:, :2])
    assert np.all(depth > 0.0)  # in contact all the time, or the order is another
    damper = 30.0 * depth * approach / 1e-4
    drag = 0.1 * (4e6 * depth + damper)
    sliding = 0.05 * m.speed + dot(around(n), m.v[:, :2])
    assert np.all(sliding > 1.0)
    return Shares(2e6 * depth**2, damper * approach + drag * sliding)


BALLS = {"count": 8, "pitch_radius": 0.03, "element_radius": 0.006, "stiffness": 7e9}
BALLS |= {"clearance": 1e-5, "damping": 200.0}


def balls(m):
    phi = 2.0 * np.pi * np.arange(8) / 8 + 0.4 * m.angle[:, None]
    depth = np.maximum(m.u[:, :1] * np.cos(phi) + m.u[:, 1:2] * np.sin(phi) - 1e-5, 0.0)
    assert np.all(np.sum(depth > 0.0, axis=1) == 3)  # the same carry all the time
    stored = 7e9 / 2.5 * np.sum(depth**2.5, axis=1)
    return Shares(stored, 200.0 * dot(m.v[:, :2], m.v[:, :2]))


CONTROLLER = PIDController(
    proportional=2e4, derivative=25.0, integral=2e5, filter_frequency=4e3, amplifier_frequency=2e3
)


def magnets(m):
    """What the actuators give: the current of a state space of its own, by the sensed motion."""
    A, b, c = controller_states(CONTROLLER)
    system = A, b[:, None], c[None], np.zeros((1, 1))
    force = [-K_I * scipy.signal.lsim(system, x, m.time)[1] + K_S * x for x in m.u.T[:2]]
    return Shares(fed=dot(np.transpose(force), m.v[:, :2]))


# ------------------------------------------------------------------ table


@dataclass
class Kind:
    """An element, by its interface, its shares, and the run: weight [N], along −n2, and start."""

    make: Callable
    shares: Callable
    step: float = 5e-5
    steps: int = 60
    weight: float = 0.0
    start: tuple = (0.0, 0.0)


KINDS = {
    "linear": Kind(partial(Support, stiffness=K + SKEW, damping=D, **TILTS), linear),
    "tilt-springs": Kind(
        partial(Support, stiffness=1e6 * np.eye(3), tilt_stiffness=TILT_K), tilt_springs,
        step=2e-4, steps=30,  # the squares of its tilts, 1e-6 of the energy, do not fall
    ),
    "table": Kind(
        partial(Support, stiffness=1e6, damping=([0.0, 200.0], [0.0, 800.0]),
                tilt_damping=([0.0, 200.0], [0.0, 20.0])),
        by_table,
    ),
    "rotor-frame": Kind(partial(Support, stiffness=K, damping=D, frame="rotor", **TILTS), turning),
    "seal": Kind(lambda name: AnnularSeal(interface=name, **SEAL), seal),
    "short-film": Kind(
        lambda name: ShortJournalBearing(interface=name, **OIL), short_film,
        step=2.5e-5, start=(5e-5, -4e-5),
    ),
    "squeeze-film": Kind(
        lambda name: SqueezeFilmDamper(interface=name, centring_stiffness=2e6, **OIL),
        squeeze_film, step=2.5e-5, start=(5e-5, -4e-5),
    ),
    "finite-film": Kind(
        lambda name: JournalBearing(interface=name, film=FILM),
        lambda m: Shares(lost=finite_film(FILM, m.u[:, :2], m.v[:, :2], m.speed)),
        step=2.5e-5, steps=20, start=(5e-5, -4e-5),
    ),
    "pads": Kind(
        lambda name: TiltingPadBearing(
            interface=name, film=FILM, pivot=PIVOT, pad_inertia=INERTIA
        ),
        pads, steps=20,
    ),
    "stop": Kind(
        lambda name: ClearanceStop(interface=name, **STOP), stop,
        step=2.5e-5, weight=9.81 * MASS, start=(-1.06e-5, -1.057e-4),
    ),
    "balls": Kind(
        lambda name: RollingBearing(interface=name, **BALLS), balls,
        step=2e-5, weight=2000.0, start=(0.0, -3.2e-5),
    ),
    "magnets": Kind(
        lambda name: MagneticBearing(interface=name, actuator=LINEAR, controller=CONTROLLER),
        magnets,
    ),
}  # fmt: skip
