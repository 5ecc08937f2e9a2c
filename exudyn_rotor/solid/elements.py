"""Matrices of second order in the displacements, on the elements of an NGSolve model."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import ngsolve as ngs
import numpy as np
import scipy.sparse as sp

from exudyn_rotor.solid import matrices

# Components xx, yy, zz, yz, xz, xy as entries of the 3 × 3 tensor, row by row.
_TENSOR = (0, 5, 4, 5, 1, 3, 4, 3, 2)


def nodal_space(mesh: ngs.Mesh, order: int, dim: int = 1) -> ngs.FESpace:
    """Return the space whose degrees of freedom are the mesh nodes, `dim` of them at each."""
    if order == 2:
        return ngs.NodalFESpace(mesh, order=2, dim=dim)
    return ngs.H1(mesh, order=1, dim=dim)


def assembled(form: ngs.BilinearForm) -> sp.csr_array:
    """Return the matrix of a form as arrays of its own, coordinates in the order x0 y0 z0 x1 …."""
    with ngs.TaskManager():
        form.Assemble()
    # the arrays belong to the form, which ends here
    dim, data = form.space.dim, form.mat.AsVector().FV().NumPy()
    # half the memory of long ones
    columns, ends = (array.NumPy().astype(np.int32) for array in form.mat.CSR()[1:])
    if dim == 1:
        return sp.csr_array((data.copy(), columns, ends), shape=form.mat.shape)
    return sp.bsr_array((data.reshape(-1, dim, dim), columns, ends)).tocsr()


def assemble_mass(space: ngs.FESpace, densities: np.ndarray) -> sp.csr_array:
    """Return the consistent mass matrix; one direction is assembled, all three have the same."""
    u, v = space.TnT()
    form = ngs.BilinearForm(space)
    form += ngs.CoefficientFunction(list(densities)) * u * v * ngs.dx
    return matrices.in_all_directions(assembled(form))


def assemble_stiffness(mesh: ngs.Mesh, order: int, lame: np.ndarray) -> sp.csr_array:
    """Return the stiffness matrix of linear isotropic elasticity."""
    space = nodal_space(mesh, order, dim=3)
    u, v = space.TnT()
    form = ngs.BilinearForm(space)
    form += ngs.InnerProduct(_hooke(ngs.Sym(ngs.Grad(u)), lame), ngs.Sym(ngs.Grad(v))) * ngs.dx
    return assembled(form)


@dataclass(frozen=True, eq=False)
class NgsolveElements:
    """Elements of a model, for matrices of a static field and of single materials.

    All integrals of a static field use the integration points of the stiffness matrix. A stress
    field in discrete equilibrium then stays so: for a rotation ``a × x`` its geometric stiffness
    is ``vᵀ K_G (a × x) = v · (a × f)`` with the nodal load f, to rounding. More points change K_G
    of the lowest flexible modes by 3e-4 or less, but lose this balance by 4e-3 at curved elements.

    Parameters
    ----------
    mesh : ngsolve.Mesh
    order : int
        Order of the displacements, 1 or 2.
    nodes : ndarray, shape (n, 3)
        Positions at the time of assembly, mesh coordinates [m].
    lame : ndarray, shape (regions, 2)
        Lamé parameters λ, μ of every region [Pa].
    densities : ndarray, shape (regions,)
        [kg/m³].
    edges : ndarray of int, shape (n, 2)
        Ends of the edge in whose middle a node is; itself twice for a vertex. Vertices come first.
    held : ndarray of int, optional
        Nodes that are clamped: their rows and columns are zero in every matrix.
    free : scipy.sparse.csr_array, optional
        Takes held directions of nodes out of displacements, shape (3n, 3n).
    """

    mesh: ngs.Mesh
    order: int
    nodes: np.ndarray
    lame: np.ndarray
    densities: np.ndarray
    edges: np.ndarray
    held: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    free: sp.csr_array | None = None

    def materials_at(self, nodes: np.ndarray) -> tuple[str, ...]:
        """Return the names of the regions whose elements have any of these nodes."""
        elements = self.mesh.ngmesh.Elements3D().NumPy()
        touched = np.isin(elements["nodes"].astype(np.int64) - 1, nodes).any(axis=1)
        regions = self.mesh.GetMaterials()
        return tuple(sorted({regions[i - 1] for i in np.unique(elements["index"][touched])}))

    def mass_matrix(self, factors: np.ndarray) -> sp.csr_array:
        """Return the mass matrix (3n, 3n) with a factor for every region, shape (regions,)."""
        self._check_mesh()
        space = nodal_space(self.mesh, self.order)
        return self._without_held(assemble_mass(space, factors * self.densities))

    def stiffness_matrix(self, factors: np.ndarray) -> sp.csr_array:
        """Return the stiffness matrix (3n, 3n) with a factor for every region."""
        self._check_mesh()
        lame = factors[:, None] * self.lame
        return self._without_held(assemble_stiffness(self.mesh, self.order, lame))

    def holding(self, nodes: np.ndarray) -> NgsolveElements:
        """Return the elements with more nodes clamped."""
        return replace(self, held=np.union1d(self.held, nodes))

    def holding_directions(self, free: sp.csr_array) -> NgsolveElements:
        """Return the elements with more directions held, which the projection `free` takes out."""
        return replace(self, free=free if self.free is None else sp.csr_array(self.free @ free))

    def interpolation(self) -> sp.csr_array | None:
        """Return what gives all displacements (3n,) that are linear in every element.

        From those of the vertices; a mid node takes the mean of its edge. None for elements of
        first order, all of whose nodes are vertices.
        """
        if self.order == 1:
            return None
        every = np.repeat(np.arange(len(self.edges)), 2)
        shape = (len(self.edges), int(self.edges.max()) + 1)
        means = sp.csr_array((np.full(every.size, 0.5), (every, self.edges.ravel())), shape=shape)
        linear = sp.csr_array(sp.kron(means, sp.eye_array(3), format="csr"))
        return linear if self.free is None else sp.csr_array(self.free @ linear)

    def described(self) -> list[tuple[str, float, float, float, float]]:
        """Return name, mass [kg], Young's modulus [Pa], Poisson's ratio and density by region."""
        self._check_mesh()
        one = ngs.CoefficientFunction(1.0)
        volumes = ngs.Integrate(one, self.mesh, order=2 * self.order, region_wise=True)
        first, second = self.lame.T
        young = second * (3.0 * first + 2.0 * second) / (first + second)
        ratio = 0.5 * first / (first + second)
        masses = self.densities * np.array(volumes)
        columns = (masses, young, ratio, self.densities)
        return [
            (name, *(float(column[i]) for column in columns))
            for i, name in enumerate(self.mesh.GetMaterials())
        ]

    def geometric_stiffness(self, displacement: np.ndarray) -> sp.csr_array:
        """Return ``vᵀ K_G u = ∫ σ⁰ : (∇uᵀ∇v) dV`` with σ⁰ of a displacement, shape (3n, 3n).

        Parameters
        ----------
        displacement : ndarray, shape (3n,)
            Static displacement u⁰, mesh axes; σ⁰ is Hooke's stress of its linear strain.

        Raises
        ------
        ValueError
            If the mesh was changed since the model was made, or the shape does not fit.
        """
        static = self._displacement(displacement)
        return self._without_held(self._of_stress(self._hooke(ngs.Sym(ngs.grad(static)))))

    def geometric_stiffness_of_stress(self, stress: np.ndarray) -> sp.csr_array:
        """Return the same of a nodal stress field, interpolated by the shape functions.

        Parameters
        ----------
        stress : ndarray, shape (n, 6)
            Components xx, yy, zz, yz, xz, xy in mesh axes [Pa].
        """
        return self._without_held(self._of_stress(self._nodal_stress(stress)))

    def load_of_stress(self, stress: np.ndarray) -> np.ndarray:
        """Return the nodal forces ``v · r = ∫ σ : ∇v dV`` of a nodal stress (n, 6), shape (3n,).

        The positions are in the space of the displacements and ``∇x = I``, so ``r = K_G x``.
        """
        return self._of_stress(self._nodal_stress(stress)) @ self.nodes.ravel()

    def initial_displacement_stiffness(self, displacement: np.ndarray) -> sp.csr_array:
        """Return ``∫ E₁(v) : C : ε(u) + ε(v) : C : E₁(u) dV``, ``E₁(u) = sym(∇u⁰ᵀ∇u)``.

        With :meth:`geometric_stiffness` this is the derivative of the tangent stiffness of
        St. Venant–Kirchhoff elasticity in the direction u⁰, from ``W = ½ E : C : E`` with
        ``E = sym ∇u + ½ ∇uᵀ∇u``. Parameters as there.
        """
        # with a row per component: ngs.grad in product spaces, ngs.Grad in spaces of vectors
        static = ngs.grad(self._displacement(displacement))
        space = nodal_space(self.mesh, self.order, dim=3)
        u, v = (ngs.Grad(function) for function in space.TnT())
        form = ngs.BilinearForm(space)
        form += ngs.InnerProduct(self._hooke(ngs.Sym(u)), ngs.Sym(static.trans * v)) * ngs.dx
        form += ngs.InnerProduct(self._hooke(ngs.Sym(static.trans * u)), ngs.Sym(v)) * ngs.dx
        return self._without_held(assembled(form))

    def squared_displacement_stiffness(self, displacement: np.ndarray) -> sp.csr_array:
        """Return ``∫ E₁(v) : C : E₁(u) dV``, the tangent's part of second order in u⁰.

        Symbols and parameters of :meth:`initial_displacement_stiffness`.
        """
        static = ngs.grad(self._displacement(displacement))
        space = nodal_space(self.mesh, self.order, dim=3)
        u, v = (ngs.Sym(static.trans * ngs.Grad(function)) for function in space.TnT())
        form = ngs.BilinearForm(space)
        form += ngs.InnerProduct(self._hooke(u), v) * ngs.dx
        return self._without_held(assembled(form))

    def _of_stress(self, stress: ngs.CoefficientFunction) -> sp.csr_array:
        """Return K_G of a stress tensor; it acts on each direction by itself, the same on all."""
        space = nodal_space(self.mesh, self.order)
        u, v = space.TnT()
        form = ngs.BilinearForm(space)
        form += ngs.InnerProduct(stress * ngs.grad(u), ngs.grad(v)) * ngs.dx
        return matrices.in_all_directions(assembled(form))

    def _hooke(self, strain: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        return _hooke(strain, self.lame)

    def _displacement(self, displacement: np.ndarray) -> ngs.GridFunction:
        values = self._nodal("displacement", displacement, (self.nodes.size,)).reshape(-1, 3)
        return _function(nodal_space(self.mesh, self.order) ** 3, values.T)

    def _nodal_stress(self, stress: np.ndarray) -> ngs.CoefficientFunction:
        values = self._nodal("stress", stress, (len(self.nodes), 6))
        space = nodal_space(self.mesh, self.order)
        components = [_function(space, column) for column in values.T]
        return ngs.CoefficientFunction(tuple(components[i] for i in _TENSOR), dims=(3, 3))

    def _nodal(self, label: str, values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
        """Check a nodal field, and that the mesh is still the one the field belongs to."""
        values = np.asarray(values, dtype=float)
        if values.shape != shape:
            raise ValueError(
                f"{label}: the shape must be {shape} for the rotor's {len(self.nodes)} nodes, got "
                f"{values.shape}; it may belong to another mesh"
            )
        if not np.all(np.isfinite(values)):
            raise ValueError(f"{label}: has entries that are not finite")
        self._check_mesh()
        return values

    def _check_mesh(self) -> None:
        """Raise ValueError if the mesh was changed since the model was made."""
        present = np.array(self.mesh.ngmesh.Coordinates(), dtype=float)
        if self.order == 1:
            present = present[: self.mesh.nv]
        if not np.array_equal(present, self.nodes):
            raise ValueError(
                "the NGSolve mesh was changed after SolidRotor.from_ngsolve read it; make the "
                "rotor anew from the changed mesh"
            )

    def _without_held(self, matrix: sp.csr_array) -> sp.csr_array:
        if self.free is not None:
            matrix = sp.csr_array(self.free.T @ matrix @ self.free)
        return matrix if self.held.size == 0 else matrices.without_nodes(matrix, self.held)


def _hooke(strain: ngs.CoefficientFunction, lame: np.ndarray) -> ngs.CoefficientFunction:
    """Return Hooke's stress of a strain, with the Lamé parameters of every region."""
    first, second = (ngs.CoefficientFunction(values.tolist()) for values in lame.T)
    return 2 * second * strain + first * ngs.Trace(strain) * ngs.Id(3)


def _function(space: ngs.FESpace, values: np.ndarray) -> ngs.GridFunction:
    function = ngs.GridFunction(space)
    function.vec.FV().NumPy()[:] = values.ravel()
    return function
