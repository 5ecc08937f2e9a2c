"""Equations of motion against an energy written with nodal positions, and its conservation."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from point_rotors import SKEW_AXIS, random_arrays, random_invariants, random_spd
from scipy.spatial.transform import Rotation

from exudyn_rotor import Formulation, Invariants, Motion, PrescribedMotion, SpinAxis
from exudyn_rotor.theory.formulation import ConstantSpeed
from exudyn_rotor.theory.full_motion import FullMotion, full_stiffening
from exudyn_rotor.theory.stiffening import stiffening

AXIS = SpinAxis(SKEW_AXIS)
ORIENTATION = Rotation.from_rotvec([0.3, -0.5, 0.8]).as_matrix()
GRAVITY = np.array([1.0, -2.0, 3.0])
MODES = 3

SHAKE = PrescribedMotion(
    lambda t: np.array([0.3, -0.2, 0.4]) * np.sin(2 * t),
    lambda t: np.array([0.3, -0.2, 0.4]) * 2 * np.cos(2 * t),
    lambda t: np.array([0.3, -0.2, 0.4]) * -4 * np.sin(2 * t),
)
SWING = PrescribedMotion(
    lambda t: 0.5 * t + np.sin(t), lambda t: 0.5 + np.cos(t), lambda t: -np.sin(t)
)
TRANSLATIONS = {"free": "free", "in-plane": "in-plane", "none": "none", "shaken": SHAKE}
SPINS = {"free": "free", "constant": ConstantSpeed(1.3, 0.2), "prescribed": SWING}
FAMILY = pytest.mark.parametrize(
    "formulation",
    [
        pytest.param(Formulation(translation, spin), id=f"{name}-{turning}")
        for name, translation in TRANSLATIONS.items()
        for turning, spin in SPINS.items()
    ],
)
# prescribed motions do work, so energy and momentum are those of the coordinates alone here
FREE_SPIN = pytest.mark.parametrize("translation", ["free", "in-plane", "none"])


def motion_of(formulation: Formulation, level: str = "tilt", gravity=GRAVITY, seed: int = 1):
    """Return a motion with unbalance, S, g, damping and, at level 'tilt', B all non-zero."""
    invariants, modes, arrays = random_invariants(seed, MODES)
    terms = stiffening(invariants, level)
    motion = Motion(invariants, formulation, terms, ORIENTATION, gravity=gravity)
    return motion, modes, arrays


def random_state(size: int, count: int, seed: int = 7) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(count, size))


def first_derivative(function, step: float):
    """Return d/ds at s = 0, fourth-order central difference."""
    near = function(step) - function(-step)
    far = function(2 * step) - function(-2 * step)
    return (8 * near - far) / (12 * step)


def gradient(function, point: np.ndarray, step: float) -> np.ndarray:
    """Return derivatives by every entry of `point`, stacked along the last axis."""
    unit = np.eye(len(point))
    columns = [
        first_derivative(lambda s, i=i: function(point + s * unit[i]), step)
        for i in range(len(point))
    ]
    return np.stack(columns, axis=-1)


# ------------------------------------------------------------------ Jacobians


@FAMILY
def test_jacobians(formulation):
    motion, _, _ = motion_of(formulation)
    t = 0.7
    q, v = random_state(motion.size, 2)
    by_q, by_v = motion.jacobian(t, q, v)
    # the forces are polynomials up to the fourth degree but for the angle, so 1e-3 leaves 1e-13
    numeric_q = gradient(lambda point: motion.forces(t, point, v), q, 1e-3)
    numeric_v = gradient(lambda point: motion.forces(t, q, point), v, 1e-3)
    for analytic, numeric in ((by_q, numeric_q), (by_v, numeric_v)):
        for block in blocks_of(formulation, motion.size):
            scale = max(np.abs(numeric[block]).max(initial=0.0), 1e-3)
            np.testing.assert_allclose(analytic[block], numeric[block], rtol=0, atol=1e-8 * scale)


def with_static_displacement(motion: Motion) -> tuple[Motion, np.ndarray]:
    """Return the motion with a stiffness per ω⁴, and that matrix."""
    K4 = random_spd(np.random.default_rng(9), motion.invariants.size)
    terms = replace(stiffening(motion.invariants, "tilt"), K4=K4)
    return Motion(motion.invariants, motion.formulation, terms, ORIENTATION, gravity=GRAVITY), K4


@pytest.mark.parametrize("spin", [SPINS["constant"], SPINS["prescribed"]])
def test_stiffness_of_a_static_displacement(spin):
    """A force ``−ω⁴K4ζ``; a free spin does not take it."""
    plain, _, _ = motion_of(Formulation("free", spin))
    motion, K4 = with_static_displacement(plain)
    t = 0.7
    q, v = random_state(motion.size, 2)
    omega, zeta, rate = spin.rate(t), q[motion.modes], v[motion.modes]
    added = motion.forces(t, q, v) - plain.forces(t, q, v)
    assert added[motion.modes] == pytest.approx(-(omega**4) * K4 @ zeta, rel=1e-10)
    torques = [each.drive_torque(t, q, v, 0.0 * zeta) for each in (plain, motion)]
    expected = -4.0 * omega**3 * zeta @ K4 @ rate
    expected -= 6.0 * omega**2 * spin.acceleration(t) * (zeta @ K4 @ zeta)
    assert torques[1] - torques[0] == pytest.approx(expected, rel=1e-10)
    with pytest.raises(ValueError, match="a free spin does not take the stiffness per ω⁴"):
        with_static_displacement(motion_of(Formulation("free"))[0])


def test_stiffness_of_a_static_displacement_in_a_full_model():
    arrays, omega = random_arrays(3, node_count=3), SWING.rate(0.7)
    full = Invariants.of(
        **arrays, damping=None, basis=sp.eye_array(9, format="csr"), direction=SKEW_AXIS
    )
    q, K4 = random_state(9, 1)[0], random_spd(np.random.default_rng(9), 9)
    plain = full_stiffening(full, "none")
    forces = [
        FullMotion(full, Formulation("none", SWING), each).varying_forces(0.7, q, 0.0 * q)
        for each in (plain, replace(plain, K4=sp.csr_array(K4)))
    ]
    np.testing.assert_allclose(forces[1] - forces[0], -(omega**4) * K4 @ q, rtol=1e-10)


def blocks_of(formulation: Formulation, size: int) -> list:
    """Return index pairs of the blocks (t, r, f) × (t, r, f)."""
    spin = formulation.translation_count, formulation.translation_count + formulation.has_spin
    ranges = [range(spin[0]), range(*spin), range(spin[1], size)]
    return [np.ix_(rows, columns) for rows in ranges for columns in ranges]


def assert_relative(actual, expected, tolerance):
    scale = np.abs(expected).max()
    np.testing.assert_allclose(actual, expected, rtol=0, atol=tolerance * scale)


# ------------------------------------------------------------------ Lagrange's equations


class NodalEnergy:
    """Kinetic energy and potential of gravity from ``p = τ + R A(θ)(x + Ψζ)``, nothing else."""

    def __init__(self, formulation: Formulation, modes: np.ndarray, arrays: dict) -> None:
        self.formulation, self.modes = formulation, modes
        self.nodes, self.mass = arrays["nodes"], arrays["mass"].toarray()[::3, ::3]
        self.stiffness = modes.T @ (arrays["stiffness"] @ modes)
        self.damping = modes.T @ (arrays["damping"] @ modes)
        count = formulation.translation_count
        self.directions = {3: np.eye(3), 2: ORIENTATION @ AXIS.plane, 0: np.zeros((3, 0))}[count]

    def split(self, q: np.ndarray) -> tuple:
        count, spin = self.formulation.translation_count, int(self.formulation.has_spin)
        return q[:count], q[count : count + spin], q[count + spin :]

    def translation(self, t, q):
        if self.formulation.moves_origin:
            return self.formulation.translation.value(t)
        return self.directions @ self.split(q)[0]

    def angle(self, t, q):
        if self.formulation.has_spin:
            return self.split(q)[1][0]
        spin = self.formulation.spin
        # written out, because a complex step is no time for the class
        return spin.angle + spin.speed * t if isinstance(spin, ConstantSpeed) else spin.value(t)

    def positions(self, t, q) -> np.ndarray:
        local = self.nodes + (self.modes @ self.split(q)[2]).reshape(-1, 3)
        e, angle = SKEW_AXIS, self.angle(t, q)
        along = np.outer(local @ e, e)
        turned = along + np.cos(angle) * (local - along) + np.sin(angle) * np.cross(e, local)
        return self.translation(t, q) + turned @ ORIENTATION.T

    def velocities(self, t, q, v) -> np.ndarray:
        # complex step: exact, as positions are analytic functions
        step = 1e-30
        return self.positions(t + 1j * step, q + 1j * step * v).imag / step

    def lagrangian(self, t, q, v) -> float:
        speed, place = self.velocities(t, q, v), self.positions(t, q)
        zeta = self.split(q)[2]
        kinetic = 0.5 * np.sum(speed * (self.mass @ speed))
        gravity = np.sum((self.mass @ place) @ GRAVITY)
        return kinetic + gravity - 0.5 * zeta @ self.stiffness @ zeta

    def dissipation(self, v: np.ndarray) -> np.ndarray:
        damping = np.zeros(len(v))
        rates = self.split(v)[2]
        damping[len(v) - len(rates) :] = self.damping @ rates
        return damping


def lagrange_residual(lagrangian, t, q, v, a) -> np.ndarray:
    """Return d/dt ∂L/∂q̇ − ∂L/∂q along q(t + s) = q + s v + s² a/2."""

    def momenta(s: float) -> np.ndarray:
        place = q + s * v + 0.5 * s**2 * a
        return gradient(lambda rate: lagrangian(t + s, place, rate), v + s * a, 1.0)

    by_q = gradient(lambda place: lagrangian(t, place, v), q, 1e-2)
    return first_derivative(momenta, 2e-3) - by_q


@FAMILY
def test_equations_follow_from_the_energy_of_the_nodes(formulation):
    motion, modes, arrays = motion_of(formulation, "none")
    energy = NodalEnergy(formulation, modes, arrays)
    t = 0.7
    q, v, a = random_state(motion.size, 3)
    expected = lagrange_residual(energy.lagrangian, t, q, v, a) + energy.dissipation(v)
    actual = motion.mass_matrix(t, q) @ a - motion.forces(t, q, v)
    assert_relative(actual, expected, 1e-8)


@FREE_SPIN
def test_equations_with_stiffening_follow_from_their_energy(translation):
    motion, _, _ = motion_of(Formulation(translation), gravity=np.zeros(3))
    damping = motion.jacobian(0.0, np.zeros(motion.size), np.zeros(motion.size))[1]
    q, v, a = random_state(motion.size, 3)

    def lagrangian(t, place, rate):
        energy = motion.energy(t, place, rate)
        return energy.kinetic - energy.elastic

    expected = lagrange_residual(lagrangian, 0.0, q, v, a) - damping @ v
    actual = motion.mass_matrix(0.0, q) @ a - motion.forces(0.0, q, v)
    assert_relative(actual, expected, 1e-8)
