"""Vibrations about a geometrically nonlinear preload: a referee that shares no stiffening code.

St. Venant–Kirchhoff elasticity on the rotor's own mesh. NGSolve differentiates the strain energy,
Newton's method finds the static state at speed in the rotating frame, and the tangent there gives
the frequencies. ``stiffening='full'`` must agree to first order in Ω², with the
initial-displacement stiffness to second order.

Beside it stands the tangent at the linear static state: the displacement Ω²u⁰ of linear elasticity
with its linear stress, as a linear preload of other programs. K_G, K_u and K_uu together are
this tangent, so that only rounding may be between them; what is between the two references is the
second-order part of the static state. Three solids: a stout blade, a thin blade whose sections turn
with the static deflection, and a disc with staggered blades.

python -m validation nonlinear [--quick]
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import ngsolve as ngs
import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from netgen.occ import Axis, Box, Cylinder, OCCGeometry, Pnt, X, Z
from tqdm import tqdm

from exudyn_rotor import SolidRotor
from exudyn_rotor.solid.elements import von_mises
from exudyn_rotor.solvers.factor import SparseCholesky
from exudyn_rotor.theory.axis import block_diagonal
from validation.rows import verdict

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
LEVELS = ("none", "full", "full, initial displacement")
PRELOAD = ", linear preload"  # of errors against that
SPEEDS, QUICK_SPEEDS = (75.0, 150.0, 300.0, 600.0), (75.0, 150.0)  # rad/s
_STEPS = 30


def blade_mesh(hub: float = 0.1, length: float = 0.3, element_size: float = 0.03) -> ngs.Mesh:
    """Return a blade of 30 × 10 mm along x whose face 'root' is `hub` off the axis z [m]."""
    solid = Box(Pnt(hub, -0.015, -0.005), Pnt(hub + length, 0.015, 0.005))
    solid.faces.Min(X).name = "root"
    return ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=element_size))


def thin_blade_mesh() -> ngs.Mesh:
    """Return a blade of 20 × 5 mm along x, 0.1 to 0.5 m off the axis z; its face 'root'."""
    solid = Box(Pnt(0.1, -0.01, -0.0025), Pnt(0.5, 0.01, 0.0025))
    solid.faces.Min(X).name = "root"
    return ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.02))


def bladed_disc_mesh(element_size: float = 0.03, blades: int = 3) -> ngs.Mesh:
    """Return a disc of 0.1 m radius with blades of 24 × 4 mm at 40°, its face 'bore'."""
    solid = Cylinder((0, 0, -0.01), Z, 0.1, 0.02) - Cylinder((0, 0, -0.02), Z, 0.03, 0.04)
    for face in solid.faces:
        if np.hypot(face.center.x, face.center.y) < 0.05 and abs(face.center.z) < 1e-6:
            face.name = "bore"
    blade = Box(Pnt(0.09, -0.012, -0.002), Pnt(0.25, 0.012, 0.002)).Rotate(Axis((0, 0, 0), X), 40)
    for index in range(blades):
        solid = solid + blade.Rotate(Axis((0, 0, 0), Z), 360 / blades * index)
    return ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=element_size))


@dataclass(frozen=True, eq=False)
class ClampedSolid:
    """A solid clamped to a rigid hub, with its nonlinear elasticity.

    Attributes
    ----------
    mesh : ngsolve.Mesh
    rotor : SolidRotor
        Of that mesh, not clamped.
    face : str
        Interface that the hub holds.
    """

    mesh: ngs.Mesh
    rotor: SolidRotor
    face: str

    @classmethod
    def of(cls, mesh: ngs.Mesh, face: str, axis: str = "z") -> ClampedSolid:
        """Assemble a steel solid."""
        return cls(mesh, SolidRotor.from_ngsolve(mesh, STEEL, axis), face)

    @cached_property
    def clamped(self) -> SolidRotor:
        """The rotor as the package clamps it."""
        return self.rotor.clamped([self.face])

    @cached_property
    def free(self) -> np.ndarray:
        """Coordinates that may move, shape (3n,) of bool."""
        moves = np.ones((self.rotor.node_count, 3), dtype=bool)
        moves[self.rotor.interfaces[self.face].nodes] = False
        return moves.ravel()

    @cached_property
    def across_mass(self) -> sp.csr_array:
        """``−ẽ_bd M ẽ_bd``, the mass that feels the centrifugal field."""
        e = self.rotor.axis.skew
        return self.rotor.mass @ block_diagonal(-e @ e, self.rotor.node_count)

    @cached_property
    def coriolis(self) -> sp.csr_array:
        """``G = M ẽ_bd``."""
        return self.rotor.mass @ block_diagonal(self.rotor.axis.skew, self.rotor.node_count)

    @cached_property
    def _energy(self) -> tuple[ngs.BilinearForm, ngs.GridFunction, np.ndarray]:
        """Return the strain energy, a displacement, and where mesh coordinates stand in it."""
        space = ngs.NodalFESpace(self.mesh, order=2) ** 3
        # on this space Grad is the transpose of the gradient
        F = ngs.Id(3) + ngs.Grad(space.TrialFunction()).trans
        E = 0.5 * (F.trans * F - ngs.Id(3))
        mu, lam = _lame()
        form = ngs.BilinearForm(space)
        density = mu * ngs.InnerProduct(E, E) + 0.5 * lam * ngs.Trace(E) ** 2
        form += ngs.Variation(density * ngs.dx)
        count = self.rotor.node_count
        return form, ngs.GridFunction(space), np.arange(3 * count).reshape(3, count).T.ravel()

    def elastic(self, displacement: np.ndarray) -> tuple[np.ndarray, sp.csr_array]:
        """Return the internal forces (3n,) [N] and the tangent stiffness [N/m]."""
        form, function, places = self._energy
        function.vec.FV().NumPy()[places] = displacement
        force = function.vec.CreateVector()
        form.Apply(function.vec, force)
        form.AssembleLinearization(function.vec)
        tangent = sp.csr_array(form.mat.CSR(), copy=True)
        return force.FV().NumPy()[places], tangent[places][:, places]

    def linear_preload(self, speed: float) -> sp.csr_array:
        """Return the tangent about the displacement of linear elasticity, with its linear stress.

        Second derivative of ``½ δE : C : δE + σ : δE`` with ``δE = E(Ω²u⁰ + w) − E(Ω²u⁰)`` at
        w = 0, differentiated by NGSolve. u⁰ is of a factorisation of its own.
        """
        space = ngs.NodalFESpace(self.mesh, order=2) ** 3
        places = self._energy[2]
        linear = self._part(self.rotor.stiffness)
        load = speed**2 * (self.across_mass @ self.rotor.nodes.ravel())
        displacement = np.zeros(load.size)
        displacement[self.free] = _solve(linear, load[self.free])
        state = ngs.GridFunction(space)
        state.vec.FV().NumPy()[places] = displacement
        H, W = ngs.Grad(state).trans, ngs.Grad(space.TrialFunction()).trans

        def green(G: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
            return 0.5 * (G + G.trans + G.trans * G)

        mu, lam = _lame()
        strain = ngs.Sym(H)
        stress = 2 * mu * strain + lam * ngs.Trace(strain) * ngs.Id(3)
        change = green(H + W) - green(H)
        density = mu * ngs.InnerProduct(change, change) + 0.5 * lam * ngs.Trace(change) ** 2
        form = ngs.BilinearForm(space)
        form += ngs.Variation((density + ngs.InnerProduct(stress, change)) * ngs.dx)
        rest = ngs.GridFunction(space)
        form.AssembleLinearization(rest.vec)
        return sp.csr_array(form.mat.CSR(), copy=True)[places][:, places]

    def static(self, speed: float) -> tuple[np.ndarray, sp.csr_array]:
        """Return displacement (3n,) [m] and elastic tangent, at rest in the rotating frame.

        Raises
        ------
        RuntimeError
            If Newton's method does not converge: the speed is past a divergence.
        """
        u, rest = np.zeros(self.rotor.nodes.size), self.rotor.nodes.ravel()
        for _ in range(_STEPS):
            force, tangent = self.elastic(u)
            tangent = tangent - speed**2 * self.across_mass
            gap = force - speed**2 * (self.across_mass @ (rest + u))
            change = np.zeros_like(u)
            change[self.free] = _solve(self._part(tangent), -gap[self.free])
            u = u + change
            # Newton's next change would be of the order of this one's square
            if np.linalg.norm(change) <= 1e-8 * np.linalg.norm(u):
                return u, self.elastic(u)[1]
        raise RuntimeError(f"no static state found at {speed} rad/s")

    def linear_tangent(self, level: str, speed: float) -> sp.csr_array:
        """Return ``K + Ω²(K_G + K_u) + Ω⁴K_uu`` as the package has it; 'none' is K alone."""
        if level == "none":
            return self.rotor.stiffness
        prestress = self._prestress[LEVELS.index(level) - 1]
        tangent = self.rotor.stiffness + speed**2 * prestress.per_square
        fourth = prestress.per_fourth_power
        return tangent if fourth is None else tangent + speed**4 * fourth

    @cached_property
    def _prestress(self) -> tuple:
        return tuple(self.clamped.prestress(initial_displacement=given) for given in (False, True))

    def strain(self, speed: float) -> float:
        """Return the largest static von Mises stress over the modulus of elasticity."""
        stress = speed**2 * self._prestress[0].stress
        return float(von_mises(stress).max() / STEEL["youngsModulus"])

    def rotation(self, speed: float) -> float:
        """Return the largest rotation of an element by the static deflection [rad]."""
        space = ngs.NodalFESpace(self.mesh, order=2) ** 3
        state = ngs.GridFunction(space)
        state.vec.FV().NumPy()[self._energy[2]] = speed**2 * self._prestress[0].displacement
        H = ngs.Grad(state).trans
        vector = 0.5 * ngs.CoefficientFunction(
            (H[2, 1] - H[1, 2], H[0, 2] - H[2, 0], H[1, 0] - H[0, 1])
        )
        mean = ngs.Integrate(ngs.Norm(vector), self.mesh, element_wise=True).NumPy()
        volume = ngs.Integrate(ngs.CoefficientFunction(1.0), self.mesh, element_wise=True).NumPy()
        return float(np.max(mean / volume))

    def basis(self, tangent: sp.csr_array, count: int) -> np.ndarray:
        """Return the lowest modes of an elastic tangent on the free coordinates."""
        matrix = self._part(tangent)
        inverse = sla.LinearOperator(matrix.shape, SparseCholesky(matrix).solve)
        mass = self._part(self.rotor.mass)
        return sla.eigsh(matrix, count, mass, sigma=0.0, OPinv=inverse)[1]

    def frequencies(self, tangent: sp.csr_array, speed: float, basis: np.ndarray) -> np.ndarray:
        """Return the frequencies of an elastic tangent in the rotating frame [rad/s].

        With spin softening and gyroscopic term. A mode that diverges has the frequency 0.
        """
        mass, turning, stiffness = (
            basis.T @ (self._part(matrix) @ basis)
            for matrix in (self.rotor.mass, self.coriolis, tangent - speed**2 * self.across_mass)
        )
        count = len(mass)
        system = np.block(
            [
                [np.zeros((count, count)), np.eye(count)],
                [-la.solve(mass, stiffness), -2.0 * speed * la.solve(mass, turning)],
            ]
        )
        return np.sort(np.abs(la.eigvals(system).imag))[::2]

    def _part(self, matrix: sp.csr_array) -> sp.csc_array:
        return sp.csc_array(sp.csr_array(matrix)[self.free][:, self.free])


def _lame() -> tuple[float, float]:
    """Return μ and λ [Pa]."""
    ratio = STEEL["poissonsRatio"]
    mu = STEEL["youngsModulus"] / (2 * (1 + ratio))
    return mu, 2 * mu * ratio / (1 - 2 * ratio)


def _solve(matrix: sp.csc_array, right: np.ndarray) -> np.ndarray:
    """Solve with a symmetric matrix, which is indefinite above the first critical speed."""
    options = {"SymmetricMode": True}
    factor = sla.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    return factor.solve(right)


SOLIDS = {
    "stout blade": (blade_mesh, "root"),
    "thin blade": (thin_blade_mesh, "root"),
    "bladed disc": (bladed_disc_mesh, "bore"),
}


def compare(solid: ClampedSolid, speed: float, modes: int = 6, basis_size: int = 20) -> dict:
    """Return the referee's frequencies and the largest relative error of every level.

    Against the nonlinear static state, and (:data:`PRELOAD`) against the linear preload.
    All are projected on one basis, the modes of the nonlinear tangent, so that the same subspace
    stands behind every number.
    """
    tangent = solid.static(speed)[1]
    basis = solid.basis(tangent, basis_size)
    exact = solid.frequencies(tangent, speed, basis)[:modes]
    preload = solid.frequencies(solid.linear_preload(speed), speed, basis)[:modes]
    row = {
        "speed": speed,
        "strain": solid.strain(speed),
        "rotation": solid.rotation(speed),
        "frequencies": exact.tolist(),
    }
    for level in LEVELS:
        found = solid.frequencies(solid.linear_tangent(level, speed), speed, basis)[:modes]
        row[level] = float(np.abs(found / exact - 1.0).max())
        row[level + PRELOAD] = float(np.abs(found / preload - 1.0).max())
    return row


def orders(rows: Sequence[dict]) -> dict[str, float]:
    """Return the order in Ω² of the error of every level with K_G, from the two slowest speeds."""
    near, far = rows[:2]
    factor = np.log((far["speed"] / near["speed"]) ** 2)
    return {level: float(np.log(far[level] / near[level]) / factor) for level in LEVELS[1:]}


def main(argv: list[str] | None = None) -> int:
    """Compare on one mesh, print the tables and the verdict."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer speeds")
    options = parser.parse_args(argv)
    speeds = QUICK_SPEEDS if options.quick else SPEEDS
    written = {}
    for name, (make, face) in SOLIDS.items():
        solid = ClampedSolid.of(make(), face)
        rows = [compare(solid, speed) for speed in tqdm(speeds, unit="speed")]
        print(f"{name}, {solid.rotor.node_count} nodes; largest error of six frequencies against")
        print("the nonlinear static state | the linear preload")
        head = "".join(f"{level:>28}" for level in LEVELS)
        print(f"{'Ω [rad/s]':>10}{'strain':>10}{'rotation':>10}{head}")
        for row in rows:
            errors = "".join(f"{row[x]:>17.1e} | {row[x + PRELOAD]:8.1e}" for x in LEVELS)
            print(f"{row['speed']:10.0f}{row['strain']:10.1e}{row['rotation']:10.1e}{errors}")
        found = orders(rows)
        print("order in Ω²: " + ", ".join(f"{x} {value:.2f}" for x, value in found.items()) + "\n")
        written[name] = {"rows": rows, "orders": found}
    rows = [row for solid in written.values() for row in solid["rows"]]
    return verdict(
        {
            "against the nonlinear static state": (max(row[LEVELS[2]] for row in rows), 2e-4),
            "against the linear one": (max(row[LEVELS[2] + PRELOAD] for row in rows), 1e-8),
        }
    )
