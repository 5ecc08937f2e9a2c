"""Sect. 2.1, the frame in three dimensions, against sums over nodes and against Exudyn's body."""

import exudyn
import numpy as np
import pytest
import scipy.sparse as sp
from exudyn.FEM import FEMinterface, ObjectFFRFreducedOrderInterface
from exudyn.itemInterface import NodePoint, NodeRigidBodyEP, ObjectFFRF
from exudyn.utilities import EulerParameters2GLocal, EulerParameters2RotationMatrix
from point_rotors import random_arrays, random_invariants
from spatial_frame import SpatialFrame
from test_terms import dense


def cardan(angles: np.ndarray) -> np.ndarray:
    """Return ``A = Rx Ry Rz``; of complex angles, too."""
    (a, b, c), (p, q, r) = np.cos(angles), np.sin(angles)
    x = np.array([[1, 0, 0], [0, a, -p], [0, p, a]])
    y = np.array([[b, 0, q], [0, 1, 0], [-q, 0, b]])
    z = np.array([[c, -r, 0], [r, c, 0], [0, 0, 1]])
    return x @ y @ z


class Body:
    """A random body, its frame turned by Cardan angles: component modes, or the full model."""

    def __init__(self, full: bool) -> None:
        if full:
            self.arrays = random_arrays(3, node_count=3)
            self.basis = sp.eye_array(9, format="csr")
        else:
            _, self.basis, self.arrays = random_invariants(1, 3)
        self.mass = self.arrays["mass"]
        self.spatial = SpatialFrame(**{"damping": None, **self.arrays}, basis=self.basis)
        self.q, self.q_t = np.random.default_rng(5).normal(size=(2, 6 + self.spatial.size))

    def positions(self, q: np.ndarray) -> np.ndarray:
        local = self.arrays["nodes"] + (self.basis @ q[6:]).reshape(-1, 3)
        return q[:3] + local @ cardan(q[3:6]).T


@pytest.fixture(scope="module", params=[False, True], ids=["modes", "full model"])
def body(request) -> Body:
    return Body(request.param)


def assert_same(actual, expected, tolerance: float) -> None:
    scale = np.abs(expected).max()
    np.testing.assert_allclose(dense(actual), expected, rtol=0, atol=tolerance * scale)


PLACES = {"t": slice(0, 3), "r": slice(3, 6), "f": slice(6, None)}


def test_unprojected_invariants(body):
    """(31–40) by sums over pairs of nodes, with cross products."""
    terms = body.spatial.invariants
    m, x = body.mass.toarray()[::3, ::3], body.arrays["nodes"]
    psi = dense(body.basis).T.reshape(-1, len(x), 3)
    # column 3k + c of Ψ̃, and column c of x̃, turn the unit vector c: ψ × e_c
    psi_tilde = np.cross(psi[:, None], np.eye(3)[None, :, None]).reshape(-1, len(x), 3)
    x_tilde = np.cross(x[None], np.eye(3)[:, None])
    phi = np.tile(np.eye(3)[:, None], (1, len(x), 1))
    sets = {"φ": phi, "x̃": x_tilde, "ψ": psi, "ψ̃": psi_tilde}
    pairs = {
        31: ("φ", "φ"),
        32: ("φ", "x̃"),
        33: ("x̃", "x̃"),
        34: ("ψ", "ψ"),
        35: ("ψ̃", "ψ"),
        36: ("ψ̃", "ψ̃"),
        37: ("φ", "ψ"),
        38: ("φ", "ψ̃"),
        39: ("x̃", "ψ"),
        40: ("x̃", "ψ̃"),
    }
    for number, (a, b) in pairs.items():
        expected = np.einsum("kic,ij,ljc->kl", sets[a], m, sets[b])
        scale = terms[31].value[0, 0] if number == 32 else 1.0
        assert_same(terms[number].value, expected / scale, 1e-13)


def test_linear_equations_of_a_prescribed_motion(body):
    """(103), (107): ω(t) of any direction, the frame's origin shaken."""
    omega, omega_t, shake = np.array([[0.7, -0.4, 0.9], [-0.5, 0.8, 0.3], [1.0, 2.0, -1.5]])
    terms = body.spatial.linear_terms(omega, omega_t, shake)
    size = body.spatial.size

    def inertia_force(zeta, zeta_t):
        local = body.arrays["nodes"] + (body.basis @ zeta).reshape(-1, 3)
        rate = (body.basis @ zeta_t).reshape(-1, 3)
        acceleration = shake + np.cross(omega_t, local) + 2.0 * np.cross(omega, rate)
        acceleration = acceleration + np.cross(omega, np.cross(omega, local))
        return -body.basis.T @ (body.mass @ acceleration.ravel())

    rest, unit = np.zeros(size), np.eye(size)
    load = inertia_force(rest, rest)
    by_place = np.stack([load - inertia_force(column, rest) for column in unit], axis=-1)
    by_rate = np.stack([load - inertia_force(rest, column) for column in unit], axis=-1)
    assert_same(terms["f(ω)"].value, load, 1e-13)
    assert_same(terms["K(ω)"].value, dense(body.spatial.invariants["K_ψψ"].value) + by_place, 1e-13)
    assert_same(terms["D(ω)"].value, dense(body.spatial.invariants["D_ψψ"].value) + by_rate, 1e-13)
    assert terms["K(ω)"].numbers == ({103, 107} if sp.issparse(body.basis) else {107})


# ------------------------------------------------------------------ Exudyn's bodies


def exudyn_body(body: Body) -> tuple[exudyn.MainSystem, np.ndarray]:
    """Return a scene with Exudyn's own body, and the reference of its seven frame coordinates."""
    arrays = body.arrays
    reference = np.array([0.3, -0.2, 0.5, 0.5, -0.5, 0.1, 0.7])
    mbs = exudyn.SystemContainer().AddSystem()
    if sp.issparse(body.basis):
        frame = mbs.AddNode(NodeRigidBodyEP(referenceCoordinates=reference))
        points = [mbs.AddNode(NodePoint(referenceCoordinates=x)) for x in arrays["nodes"]]
        matrices = (container(arrays[name]) for name in ("mass", "stiffness"))
        names = ("massMatrixFF", "stiffnessMatrixFF")
        mbs.AddObject(
            ObjectFFRF(nodeNumbers=[frame, *points], **dict(zip(names, matrices, strict=True)))
        )
        return mbs, reference
    fem = FEMinterface()
    fem.nodes = {"Position": arrays["nodes"]}
    fem.massMatrix, fem.stiffnessMatrix = (
        sp.csr_matrix(arrays[name]) for name in ("mass", "stiffness")
    )
    fem.modeBasis = {"matrix": body.basis, "type": "NormalModes"}
    reference[3:] /= np.linalg.norm(reference[3:])
    ObjectFFRFreducedOrderInterface(fem).AddObjectFFRFreducedOrder(
        mbs,
        positionRef=reference[:3],
        rotationMatrixRef=EulerParameters2RotationMatrix(reference[3:]),
        initialVelocity=[0, 0, 0],
        initialAngularVelocity=[0, 0, 0],
    )
    return mbs, np.array(mbs.GetNode(0)["referenceCoordinates"])


def container(matrix) -> exudyn.MatrixContainer:
    made = exudyn.MatrixContainer()
    made.SetWithSparseMatrix(sp.csr_matrix(matrix), useDenseMatrix=False)
    return made


def mass_and_forces(mbs: exudyn.MainSystem, q, q_t) -> tuple[np.ndarray, np.ndarray]:
    """Return Exudyn's mass matrix and right-hand side of the coordinates."""
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    solver = exudyn.MainSolverImplicitSecondOrder()
    solver.InitializeSolver(mbs, settings)
    mbs.systemData.SetODE2Coordinates(q)
    mbs.systemData.SetODE2Coordinates_t(q_t)
    solver.ComputeMassMatrix(mbs, 1.0)
    solver.ComputeODE2RHS(mbs)
    found = np.array(solver.GetSystemMassMatrix()), np.array(solver.GetSystemResidual())
    solver.FinalizeSolver(mbs, settings)
    return found[0], found[1][: len(q)]


def test_exudyns_bodies_have_these_terms(body):
    """Euler parameters, at a random state; round-off of products of order 100."""
    mbs, reference = exudyn_body(body)
    parameters = np.array([0.1, -0.7, 0.5, 0.5])
    rng, zeta, zeta_t = np.random.default_rng(2), body.q[6:], body.q_t[6:]
    A, G = EulerParameters2RotationMatrix(parameters), EulerParameters2GLocal(parameters)
    omega, tau, tau_t = rng.normal(size=(3, 3))
    # θ̇ = Gᵀω / 4 is orthogonal to the parameters
    q = np.array([*tau, *(parameters - reference[3:]), *zeta])
    q_t = np.array([*tau_t, *(0.25 * G.T @ omega), *zeta_t])
    mass, forces = mass_and_forces(mbs, q, q_t)
    places = PLACES | {"r": slice(3, 7), "f": slice(7, None)}
    spatial = body.spatial
    for name, term in spatial.mass_terms(A, G, zeta).items():
        rows, columns = (places[letter] for letter in name[2:])
        assert_same(mass[rows, columns], dense(term.value), 1e-12)
    terms = spatial.velocity_terms(A, G, omega, zeta, zeta_t)
    for name, term in terms.items():
        elastic = spatial.invariants["K_ψψ"].value @ zeta if name == "Q_f" else 0.0
        assert_same(forces[places[name[2:]]], term.value - elastic, 1e-12)
