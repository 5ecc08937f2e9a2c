"""Vibrations about a geometrically nonlinear preload: a referee that shares no stiffening code.

St. Venant–Kirchhoff elasticity on the rotor's own mesh. NGSolve differentiates the strain energy,
Newton's method finds the static state at speed in the rotating frame, and the tangent there gives
the frequencies. ``stiffening='full'`` must agree to first order in Ω², with the
initial-displacement stiffness to second order.

python -m validation nonlinear [--json FILE] [--quick]
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import ngsolve as ngs
import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from netgen.occ import Box, OCCGeometry, Pnt, X
from tqdm import tqdm

from exudyn_rotor import SolidRotor
from exudyn_rotor.solid.elements import nodal_space, node_by_node
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.solvers.factor import SparseCholesky
from exudyn_rotor.theory.nodal import block_diagonal

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
LEVELS = ("none", "full", "full, initial displacement")
SPEEDS, QUICK_SPEEDS = (75.0, 150.0, 300.0, 600.0), (75.0, 150.0)  # rad/s
_STEPS = 30


def blade_mesh(hub: float = 0.1, length: float = 0.3, element_size: float = 0.03) -> ngs.Mesh:
    """Return a blade of 30 × 10 mm along x whose face 'root' is `hub` off the axis z [m]."""
    solid = Box(Pnt(hub, -0.015, -0.005), Pnt(hub + length, 0.015, 0.005))
    solid.faces.Min(X).name = "root"
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
        space = nodal_space(self.mesh, 2) ** 3
        # on this space Grad is the transpose of the gradient
        F = ngs.Id(3) + ngs.Grad(space.TrialFunction()).trans
        E = 0.5 * (F.trans * F - ngs.Id(3))
        ratio = STEEL["poissonsRatio"]
        mu = STEEL["youngsModulus"] / (2 * (1 + ratio))
        lam = 2 * mu * ratio / (1 - 2 * ratio)
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
        return force.FV().NumPy()[places], node_by_node(tangent)

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
        """Return ``K + Ω² K_G`` as the package has it; 'none' is without K_G."""
        if level == "none":
            return self.rotor.stiffness
        return self.rotor.stiffness + speed**2 * self._prestress[LEVELS.index(level) - 1].matrix

    @cached_property
    def _prestress(self) -> tuple:
        return tuple(self.clamped.prestress(initial_displacement=given) for given in (False, True))

    def strain(self, speed: float) -> float:
        """Return the largest static von Mises stress over the modulus of elasticity."""
        stress = speed**2 * self._prestress[0].stress
        return float(von_mises(stress).max() / STEEL["youngsModulus"])

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


def _solve(matrix: sp.csc_array, right: np.ndarray) -> np.ndarray:
    """Solve with a symmetric matrix, which is indefinite above the first critical speed."""
    options = {"SymmetricMode": True}
    factor = sla.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    return factor.solve(right)


def compare(solid: ClampedSolid, speed: float, modes: int = 6, basis_size: int = 20) -> dict:
    """Return the referee's frequencies and the largest relative error of every level.

    All are projected on one basis, the modes of the nonlinear tangent, so that the same subspace
    stands behind every number.
    """
    tangent = solid.static(speed)[1]
    basis = solid.basis(tangent, basis_size)
    exact = solid.frequencies(tangent, speed, basis)[:modes]
    row = {"speed": speed, "strain": solid.strain(speed), "frequencies": exact.tolist()}
    for level in LEVELS:
        found = solid.frequencies(solid.linear_tangent(level, speed), speed, basis)[:modes]
        row[level] = float(np.abs(found / exact - 1.0).max())
    return row


def orders(rows: Sequence[dict]) -> dict[str, float]:
    """Return the order in Ω² of the error of every level with K_G, from the two slowest speeds."""
    near, far = rows[:2]
    factor = np.log((far["speed"] / near["speed"]) ** 2)
    return {level: float(np.log(far[level] / near[level]) / factor) for level in LEVELS[1:]}


def main(argv: list[str] | None = None) -> None:
    """Compare on one mesh and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, help="write the numbers to this file")
    parser.add_argument("--quick", action="store_true", help="fewer speeds")
    options = parser.parse_args(argv)
    solid = ClampedSolid.of(blade_mesh(), "root")
    speeds = QUICK_SPEEDS if options.quick else SPEEDS
    rows = [compare(solid, speed) for speed in tqdm(speeds, unit="speed")]
    print(f"clamped blade, {solid.rotor.node_count} nodes; largest error of six frequencies")
    print(f"{'Ω [rad/s]':>10}{'strain':>10}" + "".join(f"{level:>28}" for level in LEVELS))
    for row in rows:
        errors = "".join(f"{row[level]:28.1e}" for level in LEVELS)
        print(f"{row['speed']:10.0f}{row['strain']:10.1e}{errors}")
    found = orders(rows)
    print("order in Ω²: " + ", ".join(f"{level} {value:.2f}" for level, value in found.items()))
    if options.json:
        options.json.write_text(json.dumps({"rows": rows, "orders": found}, indent=1) + "\n")
