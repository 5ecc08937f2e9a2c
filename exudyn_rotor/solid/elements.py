"""Isoparametric solid elements: their matrices, of second order too, and stress."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.solid import matrices
from exudyn_rotor.solid.shapes import KINDS, ElementKind, Rule

# Components xx, yy, zz, yz, xz, xy as entries of the 3 × 3 tensor.
_FIRST, _SECOND = np.array([0, 1, 2, 1, 0, 0]), np.array([0, 1, 2, 2, 2, 1])
_CHUNK = 4_000_000  # numbers in the largest array of a step


@dataclass(frozen=True, eq=False)
class Block:
    """Elements of one of ``KINDS``: nodes (e, n) in meshio's order, numbers of materials (e,)."""

    kind: str
    nodes: np.ndarray
    regions: np.ndarray

    @property
    def shape(self) -> ElementKind:
        """Shape functions and integration points."""
        return KINDS[self.kind]


@dataclass(frozen=True, eq=False)
class SolidElements:
    """Elements of a model, for its matrices and those of a static field.

    All integrals of a static field use the integration points of the stiffness matrix. A stress
    field in discrete equilibrium then stays so: for a rotation ``a × x`` its geometric stiffness
    is ``vᵀ K_G (a × x) = v · (a × f)`` with the nodal load f, to rounding.

    Parameters
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions, mesh coordinates [m].
    blocks : sequence of Block
    materials : sequence of str
        Names of the regions.
    lame : ndarray, shape (regions, 2)
        Lamé parameters λ, μ of every region [Pa].
    densities : ndarray, shape (regions,)
        [kg/m³].
    """

    nodes: np.ndarray
    blocks: Sequence[Block]
    materials: Sequence[str]
    lame: np.ndarray
    densities: np.ndarray

    @classmethod
    def of_materials(
        cls,
        nodes: np.ndarray,
        blocks: Sequence[Block],
        regions: Sequence[str],
        materials: Mapping[str, Mapping[str, float]],
    ) -> SolidElements:
        """Return the elements with a material by the name of each region."""
        young, ratio, densities = np.array([list(materials[name].values()) for name in regions]).T
        shear = young / (2.0 * (1.0 + ratio))
        lame = np.column_stack([2.0 * shear * ratio / (1.0 - 2.0 * ratio), shear])
        return cls(nodes, blocks, regions, lame, densities)

    def mass_matrix(self) -> sp.csr_array:
        """Return the mass matrix (3n, 3n)."""

        def entries(block: Block) -> Iterator[np.ndarray]:
            points = block.shape.mass_rule[0]
            values = block.shape.values(points)
            products = np.einsum("qi,qj->qij", values, values).reshape(len(points), -1)
            for part in self._parts(block, block.shape.mass_rule):
                yield (self.densities[part.regions][:, None] * part.weights) @ products

        return matrices.in_all_directions(self._assembled(entries, 1))

    def stiffness_matrix(self) -> sp.csr_array:
        """Return the stiffness matrix (3n, 3n)."""
        return self._of_strains(None, None)

    def geometric_stiffness(self, displacement: np.ndarray) -> sp.csr_array:
        """Return ``vᵀ K_G u = ∫ σ⁰ : (∇uᵀ∇v) dV`` with σ⁰ of a displacement (3n,).

        σ⁰ is Hooke's stress of its linear strain.
        """
        static = displacement.reshape(-1, 3)

        def entries(block: Block) -> Iterator[np.ndarray]:
            for part in self._parts(block, block.shape.stiffness_rule):
                stress = part.weights[..., None, None] * part.stress(static, self.lame)
                weighted = part.slopes @ stress
                yield np.einsum("eqic,eqjc->eij", weighted, part.slopes, optimize=True)

        # it acts on each direction by itself, the same on all
        return matrices.in_all_directions(self._assembled(entries, 1))

    def displacement_stiffness(self, displacement: np.ndarray) -> tuple[sp.csr_array, sp.csr_array]:
        """Return K_u and K_uu of a displacement u⁰ (3n,), with ``E₁(u) = sym(∇u⁰ᵀ∇u)``.

        ``vᵀ K_u u = ∫ E₁(v) : C : ε(u) + ε(v) : C : E₁(u) dV``,
        ``vᵀ K_uu u = ∫ E₁(v) : C : E₁(u) dV``. The tangent stiffness of
        St. Venant–Kirchhoff elasticity, from ``W = ½ E : C : E`` with ``E = sym ∇u + ½ ∇uᵀ∇u``, has
        :meth:`geometric_stiffness` and K_u to first order in u⁰, and K_uu to second order.
        """
        static = displacement.reshape(-1, 3)
        half = self._of_strains(static, None)
        return sp.csr_array(half + half.T), self._of_strains(static, static)

    def nodal_stress(self, displacements: np.ndarray) -> np.ndarray:
        """Return the stress (n, 6, k) of displacement columns (3n, k).

        Each element's stress is that at its integration points, linear between them; a node gets
        the mean of its elements. In a curved tetrahedron that has two faces on a smooth surface,
        which is flat where they meet, the stress grows without bound there. At a node shared by
        two materials this is the mean over both. Components xx, yy, zz, yz, xz, xy in mesh axes.
        """
        columns = checks.array(displacements, "stress: columns", shape=(self.nodes.size, None))
        result = np.zeros((len(self.nodes), 6, columns.shape[1]))
        counts = np.zeros(len(self.nodes))
        for block in self.blocks:
            counts += np.bincount(block.nodes.ravel(), minlength=len(self.nodes))
            for part in self._parts(block, block.shape.stiffness_rule):
                for k, column in enumerate(columns.T):
                    stress = part.stress(column.reshape(-1, 3), self.lame)
                    at_nodes = block.shape.to_nodes @ stress[:, :, _FIRST, _SECOND]
                    np.add.at(result[:, :, k], part.nodes, at_nodes)
        return result / counts[:, None, None]

    def check_shapes(self) -> None:
        """Raise ValueError where an element is turned inside out or has no volume."""
        for block in self.blocks:
            slopes = block.shape.slopes(block.shape.stiffness_rule[0])
            jacobians = np.einsum("enx,qnc->eqxc", self.nodes[block.nodes], slopes, optimize=True)
            sizes = np.linalg.det(jacobians)
            if block.kind.startswith("wedge"):  # programs number them either way round
                sizes *= np.sign(sizes[:, :1])
            bad = np.flatnonzero((sizes <= 0.0).any(axis=1))
            if bad.size:
                place = np.round(self.nodes[block.nodes[bad[0]]].mean(axis=0), 6).tolist()
                raise ValueError(
                    f"mesh: {bad.size} {block.kind} elements are turned inside out or have no "
                    f"volume, one about {place} m; mend the mesh there (nodes in the wrong order, "
                    "or mid nodes too far from the middle of their edges?)"
                )

    def described(self) -> list[tuple[str, float, float, float, float]]:
        """Return name, mass [kg], Young's modulus [Pa], Poisson's ratio and density by region."""
        volumes = np.zeros(len(self.materials))
        for block in self.blocks:
            for part in self._parts(block, block.shape.mass_rule):
                np.add.at(volumes, part.regions, part.weights.sum(axis=1))
        first, second = self.lame.T
        young = second * (3.0 * first + 2.0 * second) / (first + second)
        ratio = 0.5 * first / (first + second)
        columns = (self.densities * volumes, young, ratio, self.densities)
        return [
            (name, *(float(column[i]) for column in columns))
            for i, name in enumerate(self.materials)
        ]

    def interpolation(self) -> sp.csr_array | None:
        """Return what gives all displacements (3n,) that are linear in every element.

        From those of the vertices; a mid node takes the mean of its edge. None for elements of
        first order, and where the vertices are not the first nodes.
        """
        ends = np.repeat(np.arange(len(self.nodes))[:, None], 2, axis=1)
        for block in self.blocks:
            corners = len(block.shape.corners)
            for mid, edge in zip(block.nodes.T[corners:], block.shape.edges, strict=True):
                ends[mid] = block.nodes[:, edge]
        vertices = int(ends.max()) + 1
        if vertices == len(ends) or np.any(ends[:vertices, 0] != np.arange(vertices)):
            return None
        every = np.repeat(np.arange(len(ends)), 2)
        means = sp.csr_array(
            (np.full(every.size, 0.5), (every, ends.ravel())), shape=(len(ends), vertices)
        )
        return matrices.in_all_directions(means)

    def _of_strains(self, first: np.ndarray | None, second: np.ndarray | None) -> sp.csr_array:
        """Return ``∫ E(v) : C : E(u) dV``, of E = ε for None, else E₁ of nodal displacements."""

        def entries(block: Block) -> Iterator[np.ndarray]:
            for part in self._parts(block, block.shape.stiffness_rule):
                left = right = part.strains(first)
                if second is not first:
                    right = part.strains(second)
                right = _hooke(self.lame)[part.regions][:, None] @ right
                right *= part.weights[..., None, None]
                size = left.shape[3]
                shape = (len(left), -1, size)
                matrix = left.reshape(shape).transpose(0, 2, 1) @ right.reshape(shape)
                pairs = matrix.reshape(len(left), size // 3, 3, size // 3, 3)
                yield pairs.transpose(0, 1, 3, 2, 4).reshape(len(left), -1, 9)

        return self._assembled(entries, 3)

    def _assembled(
        self, entries: Callable[[Block], Iterator[np.ndarray]], dim: int
    ) -> sp.csr_array:
        """Return the sum over the elements of what `entries` yields for a block's parts."""
        count, keys, values = len(self.nodes), [], []
        for block in self.blocks:
            keys.append((block.nodes[:, :, None] * count + block.nodes[:, None, :]).ravel())
            values += [part.reshape(-1, dim * dim) for part in entries(block)]
        places, where = np.unique(np.concatenate(keys), return_inverse=True)
        table = np.concatenate(values)
        data = np.stack(
            [np.bincount(where, column, minlength=places.size) for column in table.T], axis=1
        )
        rows, columns = np.divmod(places, count)
        ends = np.append(0, np.cumsum(np.bincount(rows, minlength=count))).astype(np.int32)
        columns = columns.astype(np.int32)
        if dim == 1:
            return sp.csr_array((data[:, 0].copy(), columns, ends), shape=(count, count))
        shape = (dim * count, dim * count)
        return sp.bsr_array((data.reshape(-1, dim, dim), columns, ends), shape=shape).tocsr()

    def _parts(self, block: Block, rule: Rule) -> Iterator[_Part]:
        """Return a block's elements at the points of a rule, some at a time."""
        points, weights = rule
        slopes = block.shape.slopes(points)
        step = max(1, _CHUNK // (27 * slopes[..., 0].size))
        for start in range(0, len(block.nodes), step):
            nodes = block.nodes[start : start + step]
            jacobians = np.einsum("enx,qnc->eqxc", self.nodes[nodes], slopes, optimize=True)
            sizes = np.linalg.det(jacobians)
            across = np.einsum("qnc,eqcx->eqnx", slopes, np.linalg.inv(jacobians), optimize=True)
            regions = block.regions[start : start + step]
            yield _Part(nodes, regions, np.abs(sizes) * weights, across)


@dataclass(frozen=True, eq=False)
class _Part:
    """Some elements of a block at integration points.

    Nodes (e, n), regions (e,), weights (e, q) [m³], and the slopes ∂N_j/∂x_c (e, q, n, 3) of the
    shape functions.
    """

    nodes: np.ndarray
    regions: np.ndarray
    weights: np.ndarray
    slopes: np.ndarray

    def gradient(self, displacement: np.ndarray) -> np.ndarray:
        """Return ∂u_k/∂x_c of nodal displacements (n, 3), shape (e, q, 3, 3)."""
        return displacement[self.nodes].transpose(0, 2, 1)[:, None] @ self.slopes

    def stress(self, displacement: np.ndarray, lame: np.ndarray) -> np.ndarray:
        """Return Hooke's stress of nodal displacements (n, 3), shape (e, q, 3, 3)."""
        gradient = self.gradient(displacement)
        first, second = lame[self.regions].T[:, :, None, None, None]
        trace = np.trace(gradient, axis1=2, axis2=3)[..., None, None]
        return second * (gradient + gradient.swapaxes(2, 3)) + first * trace * np.eye(3)

    def strains(self, static: np.ndarray | None) -> np.ndarray:
        """Return what makes ε of the nodes' displacements, or E₁ of `static`, (e, q, 6, 3n).

        Components xx, yy, zz, 2 yz, 2 xz, 2 xy.
        """
        turned = np.eye(3)[None, None] if static is None else self.gradient(static)
        # [i, j]: u_k of node n times (∂u⁰_k/∂x_i) ∂N_n/∂x_j
        products = np.einsum("eqki,eqnj->eqijnk", turned, self.slopes)
        rows = products[:, :, _FIRST, _SECOND]
        rows[:, :, 3:] += products[:, :, _SECOND[3:], _FIRST[3:]]
        return rows.reshape(*rows.shape[:3], -1)


def _hooke(lame: np.ndarray) -> np.ndarray:
    """Return Hooke's matrix of every region in six components, shape (regions, 6, 6)."""
    matrix = np.zeros((len(lame), 6, 6))
    matrix[:, :3, :3] = lame[:, 0, None, None]
    matrix[:, np.arange(6), np.arange(6)] += lame[:, 1:] * [2, 2, 2, 1, 1, 1]
    return matrix


# where the six components stand in the 3 × 3 tensor
_PLACES = ((0, 5, 4), (5, 1, 3), (4, 3, 2))


def von_mises(stress: ArrayLike) -> np.ndarray:
    """Return the von Mises stress of components (…, 6), shape (…)."""
    xx, yy, zz, yz, xz, xy = np.moveaxis(np.asarray(stress, dtype=float), -1, 0)
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(normal / 2.0 + 3.0 * (yz**2 + xz**2 + xy**2))


def principal(stress: ArrayLike) -> np.ndarray:
    """Return the principal stresses of components (…, 6), largest first, shape (…, 3)."""
    tensor = np.asarray(stress, dtype=float)[..., np.array(_PLACES)]
    return np.linalg.eigvalsh(tensor)[..., ::-1]
