"""Every block of the equations by its number, against sums over nodes and their derivatives."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from nodal_motion import inertia, jacobian, pseudo_forces
from point_rotors import SKEW_AXIS, random_arrays, random_invariants, random_spd
from scipy.spatial.transform import Rotation

from exudyn_rotor import Formulation, Invariants, Motion, PrescribedMotion
from exudyn_rotor.theory.stiffening import stiffening
from exudyn_rotor.theory.terms import Terms

ORIENTATION = Rotation.from_rotvec([0.3, -0.5, 0.8]).as_matrix()
GRAVITY = np.array([1.0, -2.0, 3.0])
TIME = 0.7
SWING = PrescribedMotion(
    lambda t: 0.5 * t + np.sin(t), lambda t: 0.5 + np.cos(t), lambda t: -np.sin(t)
)
FREE = pytest.mark.parametrize("translation", ["free", "in-plane", "none"])
SPINS = pytest.mark.parametrize("spin", ["free", 1.3, SWING], ids=["free", "constant", "driven"])
BLOCKS = {  # of the mass matrix and of the pseudo forces, by the places of (τ, θ, ζ)
    "M_tt": ("41", slice(0, 3), slice(0, 3)),
    "M_tζ": ("43", slice(0, 3), slice(4, None)),
    "M_tθ": ("65", slice(0, 3), 3),
    "M_ζζ": ("42", slice(4, None), slice(4, None)),
    "M_θζ": ("74, 84", 3, slice(4, None)),
    "M_θθ": ("75, 85", 3, 3),
    "Q_t": ("66", slice(0, 3), None),
    "Q_θ": ("76, 86", 3, None),
    "Q_ζ": ("77, 87", slice(4, None), None),
}


class Rotor:
    """A random rotor, eccentric, about a skew axis: component modes, or the full model."""

    def __init__(self, full: bool) -> None:
        self.full = full
        if full:
            self.arrays = random_arrays(3, node_count=3)
            self.arrays["damping"] = sp.csr_array(0.1 * np.eye(9))
            self.basis = sp.eye_array(9, format="csr")
            self.invariants = Invariants.of(**self.arrays, basis=self.basis, direction=SKEW_AXIS)
        else:
            self.invariants, self.basis, self.arrays = random_invariants(1, 3)
        self.nodes, self.mass = self.arrays["nodes"], self.arrays["mass"]
        self.state = np.random.default_rng(7).normal(size=(2, 4 + self.invariants.size))

    def motion(self, form: Formulation, level: str = "none", **terms) -> Motion:
        second = replace(stiffening(self.invariants, level), **terms)
        return Motion(self.invariants, form, second, ORIENTATION, gravity=GRAVITY)

    def positions(self, q: np.ndarray) -> np.ndarray:
        """Return the nodes (n, 3) at ``q = (τ, θ, ζ)``, inertial axes."""
        local = self.nodes + (self.basis @ q[4:]).reshape(-1, 3)
        e, angle = SKEW_AXIS, q[3]
        along = np.outer(local @ e, e)
        turned = along + np.cos(angle) * (local - along) + np.sin(angle) * np.cross(e, local)
        return q[:3] + turned @ ORIENTATION.T

    def terms(self, form: Formulation, **second) -> Terms:
        """Return the blocks at `state`, of whose entries only the unknown ones are taken."""
        motion = self.motion(form, **second)
        q, q_t = (self.unknowns(motion, values) for values in self.state)
        return motion.terms(TIME, q, q_t)

    def unknowns(self, motion: Motion, values: np.ndarray) -> np.ndarray:
        translations = motion.free_directions.T @ values[:3]
        return np.array([*translations, *values[3 : 3 + motion.formulation.has_spin], *values[4:]])


@pytest.fixture(scope="module", params=[False, True], ids=["modes", "full model"])
def rotor(request) -> Rotor:
    return Rotor(request.param)


def dense(value) -> np.ndarray:
    return value.toarray() if sp.issparse(value) else np.asarray(value)


def assert_same(actual, expected, tolerance: float = 1e-13) -> None:
    """Compare within `tolerance` of the largest entry; the numbers are of order one."""
    assert np.shape(dense(actual)) == np.shape(expected)
    scale = max(np.abs(expected).max(initial=0.0), 1e-3)
    np.testing.assert_allclose(dense(actual), expected, rtol=0, atol=tolerance * scale)


@FREE
def test_blocks_of_the_nodes(rotor, translation):
    """The difference formula leaves 1e-12: its error is h⁶ω⁷/140 with ω about 1, h = 2e-3."""
    terms = rotor.terms(Formulation(translation))
    q, q_t = rotor.state
    mass = inertia(rotor.positions, rotor.mass, q)
    force = pseudo_forces(rotor.positions, rotor.mass, q, q_t)
    for name, (numbers, rows, columns) in BLOCKS.items():
        expected = force[rows] if columns is None else mass[rows, columns]
        assert_same(terms[name].value, expected, 1e-10)
        assert terms[name].equation.endswith(numbers)


@SPINS
def test_gravity_is_the_virtual_power_of_the_weights(rotor, spin):
    terms = rotor.terms(Formulation("none", spin))
    q = rotor.state[0].copy()
    if spin != "free":
        q[3] = Formulation("none", spin).spin.value(TIME)
    weights = rotor.mass @ np.tile(GRAVITY, len(rotor.nodes))
    powers = jacobian(rotor.positions, q).T @ weights
    assert_same(terms["f_t,g"].value, powers[:3])
    assert_same(terms["m_θ,g"].value, powers[3])
    assert_same(terms["f_g"].value, powers[4:])
    assert {110, 111, 112, 113, 114} == terms["f_g"].numbers
    if rotor.full:
        assert_same(terms[106].value, rotor.mass @ np.tile(np.eye(3), (3, 1)))
        assert_same(terms[115].value, weights)


@pytest.mark.parametrize("level", ["none", "tilt"])
@FREE
@pytest.mark.parametrize(
    ("spin", "coupling"), [("free", "full"), ("free", "frozen"), (1.3, "full"), (SWING, "full")]
)
def test_blocks_make_the_equations(rotor, translation, spin, coupling, level):
    """Put together they are the mass matrix and the forces of a time step, of component modes."""
    if rotor.full:
        return
    K4 = None if spin == "free" else random_spd(np.random.default_rng(9), rotor.invariants.size)
    if coupling == "frozen" and translation == "none":
        return
    form = Formulation(translation, spin, spin_coupling=coupling)
    motion = rotor.motion(form, level, K4=K4)
    q, q_t = (rotor.unknowns(motion, values) for values in rotor.state)
    terms = motion.terms(TIME, q, q_t)
    value = {name: dense(term.value) for name, term in terms.items()}
    N, omega_t = motion.free_directions, 0.0 if form.has_spin else form.spin.acceleration(TIME)
    t_r, t_f = N.T @ value["M_tθ"][:, None], N.T @ value["M_tζ"]
    r_r, r_f = value["M_θθ"][None, None], value["M_θζ"][None]
    held = slice(None) if form.has_spin else slice(0)
    mass = np.block(
        [
            [N.T @ value["M_tt"] @ N, t_r[:, held], t_f],
            [t_r.T[held], r_r[held, held], r_f[held]],
            [t_f.T, r_f.T[:, held], value["M_ζζ"]],
        ]
    )
    assert_same(motion.mass_matrix(TIME, q), mass, 1e-12)
    on_modes = value["Q_ζ"] - value["K_ψψ"] @ q[motion.modes] - value["D_ψψ"] @ q_t[motion.modes]
    if not form.has_spin:
        zeta, zeta_t = q[motion.modes], q_t[motion.modes]
        linear = value["f(ω)"] - value["K(ω)"] @ zeta - value["D(ω)"] @ zeta_t
        assert_same(linear, on_modes - omega_t * value["M_θζ"], 1e-12)
        on_modes = linear
    expected = [
        *(N.T @ (value["Q_t"] - omega_t * value["M_tθ"] + value["f_t,g"])),
        *[value["Q_θ"] + value["m_θ,g"]][held],
        *(on_modes + value["f_g"]),
    ]
    assert_same(motion.forces(TIME, q, q_t), expected, 1e-12)


def test_a_falling_origin_carries_the_weight(rotor):
    """Loads of an origin that moves with the acceleration of gravity cancel the weights."""
    fall = PrescribedMotion(
        lambda t: 0.5 * GRAVITY * t**2, lambda t: GRAVITY * t, lambda t: GRAVITY
    )
    held, falling = (rotor.terms(Formulation(each, 1.3)) for each in ("none", fall))
    carried = falling["f(ω)"].value + falling["f_g"].value
    assert_same(carried, dense(held["f(ω)"].value), 1e-12)


def test_asking_for_a_block(rotor):
    if rotor.full:
        motion = rotor.motion(Formulation("none"))
        with pytest.raises(ValueError, match="motion: needs dense invariants"):
            motion.mass_matrix(TIME, rotor.state[0][3:])
    terms = rotor.terms(Formulation("none", 1.3))
    assert terms[84] is terms["M_θζ"] is terms[74]
    assert str(terms).count("\n") == len(terms) - 1
    for key, said in ((105 if rotor.full else 109, r"D\(ω\), K\(ω\), f\(ω\)"), (91, "no block")):
        with pytest.raises(KeyError, match=said):
            terms[key]
    with pytest.raises(KeyError, match=r"M_tr: no block; ask by a name out of m, χ"):
        terms["M_tr"]
