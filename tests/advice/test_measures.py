"""Numbers of a run against motions whose energies, frequencies and loads are known exactly."""

import exudyn as exu
import numpy as np
import pytest
from asymmetric import DISC, END, SHAFT, asymmetric_shaft
from point_rotors import ring_rotor
from run_scenes import solve

from exudyn_rotor import add_rotor, check_run
from exudyn_rotor.advice.request import PERIOD_ERROR
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

RADIUS, HALF, MASS, STIFFNESS = 0.2, 0.1, 4.0, 1e4  # stiffness at each ring
POLAR = MASS * RADIUS**2
TRANSVERSE = MASS * (RADIUS**2 / 2 + HALF**2)


@pytest.fixture(scope="module")
def rings() -> ReducedRotor:
    """Two rigid rings, the interfaces 'left' and 'right'."""
    rotor = ring_rotor(RADIUS, HALF, MASS)
    for name, first in (("left", 0), ("right", 5)):
        rotor = rotor.with_interface(name, range(first, first + 5))
    return rotor.reduce(0)


def modal(rotor: ReducedRotor, body, field: np.ndarray) -> np.ndarray:
    """Return the modal coordinates of a displacement or velocity field (n, 3) of the modes."""
    columns = rotor.shapes.matrix @ body.selection.T
    return np.linalg.lstsq(columns, field.ravel(), rcond=None)[0]


def rotating_body(rotor: ReducedRotor, **options):
    mbs = exu.SystemContainer().AddSystem()
    return mbs, add_rotor(mbs, rotor, translation="none", markers="position", **options)


def started(rotor: ReducedRotor, displacement: np.ndarray, velocity: np.ndarray, **options):
    """Return an mbs and the body with nodal displacements and velocities (n, 3), rotor frame."""
    body = rotating_body(rotor, **options)[1]
    start = {
        "modal_coordinates": modal(rotor, body, displacement),
        "modal_velocities": modal(rotor, body, velocity),
    }
    return rotating_body(rotor, **options, **start)


def on_springs(mbs, body, steps: int, end_time: float, stiffness: float = STIFFNESS):
    """Run the rings on springs at both ends."""
    ground = mbs.CreateGround()
    for name, z in (("left", -HALF), ("right", HALF)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=[0, 0, z],
            stiffness=[stiffness] * 3,
        )
    body.start_recording()
    mbs.Assemble()
    solve(mbs, steps, end_time)


# ------------------------------------------------------------------ energies


@pytest.mark.parametrize("turn", [-1.0, 0.0, 1.0])
def test_energy_of_the_motion_is_that_of_the_nodes_in_space(turn):
    """A shaft displaced sideways and bent, moving in the rotor frame by `turn` times Ω.

    At −1 it stands still in space but for the bending. Kinetic energy ``½ Σ m |v + Ω e × u|²``
    node by node; the second bending mode is the highest fifth and has all elastic energy,
    ``½ ω² ζ²``, ω² = k (1/M + 1/2m).
    """
    speed, shaft = 150.0, asymmetric_shaft()
    shift = np.zeros((6, 3))
    shift[:, 0] = 1e-3
    bent = np.zeros((6, 3))
    bent[:, 1] = 1e-4 * np.array([1.0] * 4 + [-0.5 * DISC / END] * 2)
    velocity = turn * speed * np.cross((0, 0, 1), shift)
    mbs, body = started(shaft, shift + bent, velocity, spin=speed)
    mbs.Assemble()
    mass = np.array([DISC / 4] * 4 + [END] * 2)
    moved = velocity + speed * np.cross((0, 0, 1), shift + bent)
    kinetic = 0.5 * mass @ np.sum(moved**2, axis=1)
    elastic = 0.5 * SHAFT[1] * np.ptp(bent[:, 1]) ** 2
    found = check_run(body, warn=False)["top modes"].value
    assert found == pytest.approx(elastic / (elastic + kinetic), rel=1e-9)


@pytest.mark.parametrize("speed", [-40.0, 20.0])
@pytest.mark.parametrize("forward", [True, False])
def test_left_out_stiffening_is_the_change_of_a_frequency(rings, speed, forward):
    """Two rings on springs in a steady conical whirl at the speed λ, without stiffening.

    Without it ``I_t λ² − I_p Ωλ + I_p Ω²/2 = k``; the energy of the motion is ``½ k φ²`` and what
    is left out ``½ (I_p Ω²/2) φ²``: half their ratio is I_p Ω²/4k. Numerical damping and periods
    of generalised alpha, with ωh < 0.03, err by less than (ωh)².
    """
    k = 2 * STIFFNESS * HALF**2
    roots = np.roots([TRANSVERSE, -POLAR * speed, POLAR * speed**2 / 2 - k])
    whirl = roots.max() if forward else roots.min()
    tilted = np.cross((1, 0, 0), rings.shapes.nodes) * 1e-4
    velocity = (whirl - speed) * np.cross((0, 1, 0), rings.shapes.nodes) * 1e-4
    options = {"spin": speed, "stiffening": "none"}
    mbs, body = started(rings, tilted, velocity, **options)
    on_springs(mbs, body, 400, 0.1)
    found = check_run(body, warn=False)["stiffening"].value
    assert found == pytest.approx(POLAR * speed**2 / (4 * k), rel=2e-3)


# ------------------------------------------------------------------ frequencies in space


@pytest.mark.parametrize("ratio", [5, -5, 3])
def test_slow_whirl_in_space_is_seen_from_the_rotor_frame(rings, ratio):
    """Forward whirl ω_s = √(2k/m) at the spin Ω = ratio ω_s, over one turn in space.

    The rotor frame sees ω = |ω_s − Ω|, and periods in space err by κ(ωh)² ω/ω_s. Signals of n
    instants over whole periods: 1/n.
    """
    whirl = np.sqrt(2 * STIFFNESS / MASS)
    speed, steps = ratio * whirl, 400
    shift = np.zeros((10, 3))
    shift[:, 0] = 1e-5
    velocity = (whirl - speed) * np.cross((0, 0, 1), shift)
    mbs, body = started(rings, shift, velocity, spin=speed)
    period = 2 * np.pi / whirl
    on_springs(mbs, body, steps, period)
    seen = abs(whirl - speed)
    expected = PERIOD_ERROR * (seen * period / steps) ** 2 * seen / whirl
    assert check_run(body, warn=False)["step"].value == pytest.approx(expected, rel=4 / steps)
