"""Every block of the equations by its number, against sums over nodes and their derivatives."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from nodal_motion import derivative, inertia, jacobian, pseudo_forces
from point_rotors import SKEW_AXIS, random_arrays, random_invariants, random_spd
from scipy.spatial.transform import Rotation

from exudyn_rotor import Formulation, Invariants, Motion, PrescribedMotion, SpinAxis
from exudyn_rotor.theory.spatial import SpatialInvariants
from exudyn_rotor.theory.stiffening import stiffening
from exudyn_rotor.theory.terms import Terms

ORIENTATION = Rotation.from_rotvec([0.3, -0.5, 0.8]).as_matrix()
GRAVITY = np.array([1.0, -2.0, 3.0])
TIME = 0.7
SHAKE = PrescribedMotion(
    lambda t: np.array([0.3, -0.2, 0.4]) * np.sin(2 * t),
    lambda t: np.array([0.3, -0.2, 0.4]) * 2 * np.cos(2 * t),
    lambda t: np.array([0.3, -0.2, 0.4]) * -4 * np.sin(2 * t),
)
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


def test_blocks_in_the_plane(rotor):
    terms = rotor.terms(Formulation("in-plane"))
    N = ORIENTATION @ SpinAxis(SKEW_AXIS).plane
    q, q_t = rotor.state
    mass = inertia(rotor.positions, rotor.mass, q)
    assert_same(terms["A*"].value, N.T @ terms["A"].value)
    np.testing.assert_allclose(terms["A*"].value @ SKEW_AXIS, 0.0, atol=1e-15)
    assert_same(terms["M*_tt"].value, N.T @ mass[:3, :3] @ N)
    assert_same(terms["M*_tθ"].value, N.T @ mass[:3, 3])
    assert_same(terms["M*_tζ"].value, N.T @ mass[:3, 4:])
    force = N.T @ pseudo_forces(rotor.positions, rotor.mass, q, q_t)[:3]
    assert_same(terms["Q*_t"].value, force, 1e-10)
    assert terms[91] is terms["A*"]
    assert terms[98] is terms["Q*_t"]
    assert "A*" not in rotor.terms(Formulation("free"))


def test_constant_blocks(rotor):
    """Sums over pairs of nodes, with the axis as a cross product."""
    terms, e = rotor.terms(Formulation("free")), SKEW_AXIS
    m = rotor.mass.toarray()[::3, ::3]
    modes = dense(rotor.basis).T.reshape(-1, len(rotor.nodes), 3)
    x, turned, x_turned = rotor.nodes, np.cross(e, modes), np.cross(e, rotor.nodes)

    def sums(a, b):
        return np.einsum("kic,ij,ljc->kl", a, m, b)

    center = np.einsum("ij,jc->c", m, x) / m.sum()
    first = np.einsum("ij,kjc->ck", m, modes)
    expected = {
        31: m.sum(),
        32: center,
        34: sums(modes, modes),
        37: first,
        67: np.cross(e, center),
        68: np.cross(e, np.cross(e, center)),
        69: np.cross(e, first.T).T,
        70: np.cross(e, np.cross(e, first.T)).T,
        79: sums(x_turned[None], x_turned[None])[0, 0],
        80: sums(modes, turned),
        81: sums(turned, turned),
        82: -sums(modes, x_turned[None])[:, 0],
        83: sums(turned, x_turned[None])[:, 0],
    }
    for number, value in expected.items():
        assert_same(terms[number].value, value)
    basis = dense(rotor.basis)
    for number, name in ((19, "stiffness"), (20, "damping")):
        assert_same(terms[number].value, basis.T @ rotor.arrays[name].toarray() @ basis)


@pytest.mark.parametrize("translation", ["none", SHAKE], ids=["none", "shaken"])
@pytest.mark.parametrize("spin", [1.3, SWING], ids=["constant", "driven"])
def test_linear_equations_at_a_prescribed_spin(rotor, spin, translation):
    form = Formulation(translation, spin)
    terms = rotor.terms(form)
    size = rotor.invariants.size

    def inertia_force(zeta, zeta_t):
        """Return the inertia forces on the modes of a motion without modal acceleration."""

        def place(s):
            shift = SHAKE.value(TIME + s) if form.moves_origin else np.zeros(3)
            angle = form.spin.value(TIME + s)
            return rotor.positions(np.array([*shift, angle, *(zeta + s * zeta_t)]))

        acceleration = derivative(lambda s: derivative(lambda r: place(s + r)))
        q = np.array([0.0, 0.0, 0.0, form.spin.value(TIME), *zeta])
        J = jacobian(rotor.positions, q)[:, 4:]
        return -J.T @ (rotor.mass @ acceleration.ravel())

    rest, unit = np.zeros(size), np.eye(size)
    load = inertia_force(rest, rest)
    by_place = np.stack([load - inertia_force(column, rest) for column in unit], axis=-1)
    by_rate = np.stack([load - inertia_force(rest, column) for column in unit], axis=-1)
    basis = dense(rotor.basis)
    elastic, damping = (
        basis.T @ rotor.arrays[name].toarray() @ basis for name in ("stiffness", "damping")
    )
    # round-off 2e-16 over the square of the step leaves 1e-10
    assert_same(terms["f(ω)"].value, load, 2e-9)
    assert_same(terms["K(ω)"].value, elastic + by_place, 2e-9)
    assert_same(terms["D(ω)"].value, damping + by_rate, 2e-9)
    assert ("104" if rotor.full else "108") in terms["K(ω)"].equation
    assert (("105" if rotor.full else "109") in terms["K(ω)"].equation) == (spin != SWING)


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
    """Put together they are the mass matrix and the forces of a time step."""
    K4 = random_spd(np.random.default_rng(9), rotor.invariants.size)
    if coupling == "frozen" and translation == "none":
        return
    form = Formulation(translation, spin, spin_coupling=coupling)
    motion = rotor.motion(form, level, K4=sp.csr_array(K4) if rotor.full else K4)
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
    assert_same(motion.mass_matrix(TIME, q, q_t), mass, 1e-12)
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


def test_contracted_blocks_of_three_dimensions(rotor):
    """(67–83) from the tilde bases are the same as from the products with one axis."""
    terms = rotor.terms(Formulation("free"))
    spatial = SpatialInvariants.of(**rotor.arrays, basis=rotor.basis)
    q, q_t = rotor.state
    contracted = spatial.contracted(SKEW_AXIS, q_t[3], q[4:], q_t[4:])
    assert len(contracted) == 13
    for name, term in contracted.items():
        assert_same(term.value, dense(terms[name].value))
        assert term.numbers <= terms[name].numbers


def test_asking_for_a_block(rotor):
    terms = rotor.terms(Formulation("none", 1.3))
    assert terms[84] is terms["M_θζ"] is terms[74]
    assert str(terms).count("\n") == len(terms)
    assert repr(terms).startswith("Terms(m, χ, χ*")
    for key, said in ((105 if rotor.full else 109, r"D\(ω\), K\(ω\), f\(ω\)"), (91, "no block")):
        with pytest.raises(KeyError, match=said):
            terms[key]
    with pytest.raises(KeyError, match=r"no block 'M_tr'; there are: m, χ"):
        terms["M_tr"]
