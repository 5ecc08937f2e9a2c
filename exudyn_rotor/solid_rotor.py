"""The solid rotor as users see it: sources, static stress, reduction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.prestress.carrying import with_prestress
from exudyn_rotor.prestress.static_solution import prestress
from exudyn_rotor.reduction.reduce import reduce
from exudyn_rotor.solid import matrices, ngsolve_model
from exudyn_rotor.solid.meshes import mesh_model
from exudyn_rotor.solid.model import FiniteElementModel, import_model
from exudyn_rotor.solid.rotor import AxisLike, FiniteElementRotor
from exudyn_rotor.solid.summary import summary

if TYPE_CHECKING:
    import os

    import meshio
    import ngsolve
    from exudyn.FEM import FEMinterface


@dataclass(frozen=True, eq=False, repr=False)
class SolidRotor(FiniteElementRotor):
    """Solid finite-element rotor; immutable. Make one with a ``from_…`` constructor.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions in mesh coordinates [m].
    mass, stiffness : scipy.sparse.csr_array, shape (3n, 3n)
        Assembled FE matrices, ordered x0 y0 z0 x1 … [kg], [N/m].
    axis : SpinAxis
        Spin axis in mesh coordinates.
    damping : scipy.sparse.csr_array or None
        Damping of the rotor's own material, acting in the rotor frame [N s/m].
    interfaces : mapping of str to Interface
    triangles : ndarray of int, shape (t, 3) or (t, 6)
        Surface for drawing, 6-node triangles where the mesh is quadratic: corners, then the mid
        nodes of the edges 0-1, 1-2, 2-0.
    point_masses : tuple of PointMass
        What :meth:`add_point_mass` placed, with the snapping distances.
    rigid_motions : int
        How many of the six rigid motions the stiffness leaves free; 6 for a free rotor. A
        rotation that displaces no node (all nodes on its axis) counts as free.
    elements : SolidElements or None
        What :meth:`prestress` assembles on; only of :meth:`from_ngsolve`.
    carried_prestress : Prestress or None
        Set by :meth:`with_prestress`.
    mass_damping, structural_damping : float
        Damping per mass [1/s] of the motion beside the free rigid ones, and loss factor η; set by
        :meth:`with_damping`.
    discs : tuple of RigidDisc
        What :meth:`add_disc` placed.

    Examples
    --------
    Three masses on a line along z, held by springs to the ground across it:

    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor
    >>> springs = np.kron([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 2.0]], np.eye(3))
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(9), 1e6 * springs, [[0, 0, 0], [0, 0, 0.5], [0, 0, 1]], axis="z",
    ...     interfaces={"disc": [1]})
    >>> print(rotor.add_point_mass([0, 0, 0.9], 0.5).summary())
    nodes            3
    mass             3.5 kg (lumped mass matrix)
    size             0 × 0 × 1 m
    centre of mass   [0, 0, 0.57143] m
    spin axis        direction [0, 0, 1], point [0, 0, 0] m
    across the axis  n1 [1, 0, 0], n2 [0, 1, 0]
    rigid motions    1 of 6 free (grounded)
    interface        disc: 1 nodes, centre [0, 0, 0.5] m, on the axis
    point mass       0.5 kg at [0, 0, 0.9] m, on node 2, 0.1 m away
    """

    @classmethod
    def from_ngsolve(
        cls,
        mesh: ngsolve.Mesh,
        materials: Mapping[str, Any],
        axis: AxisLike,
        *,
        order: int = 2,
        interfaces: Sequence[str] | None = None,
        check_units: bool = True,
    ) -> SolidRotor:
        """Assemble a rotor from an NGSolve mesh of tetrahedra.

        Parameters
        ----------
        mesh : ngsolve.Mesh
            Gets mid nodes on the geometry (``SecondOrder``) if `order` is 2 and it has none yet;
            they replace the curved elements of ``mesh.Curve``. Node numbers are those of the
            Netgen mesh and of Exudyn's FEMinterface, counted from zero.
        materials : mapping
            Region name → ``{'youngsModulus': Pa, 'poissonsRatio': 1, 'density': kg/m³}``; one
            such dict by itself for all regions.
        axis : SpinAxis, str or array_like
            Read by :meth:`SpinAxis.of`: 'x', 'y', 'z', a direction, or (one of these, point) [m].
        order : int, optional
            Order of the displacements, 2 (10-node tetrahedra) or 1.
        interfaces : sequence of str, optional
            Names of the faces that become interfaces; all faces with a name by default. The
            weights are area shares, see :func:`exudyn_rotor.solid.surface.area_weights`.
        check_units : bool, optional
            Refuse materials and sizes that cannot be in SI units.

        Raises
        ------
        TypeError, ValueError
            If the mesh is no tetrahedral solid or falls into unconnected parts, a material or
            face is missing or impossible, or the units cannot be SI.

        Examples
        --------
        >>> import ngsolve
        >>> from netgen.occ import Box, OCCGeometry, Z
        >>> from exudyn_rotor import SolidRotor
        >>> bar = Box((-0.02, -0.02, 0), (0.02, 0.02, 0.2))
        >>> bar.faces.Min(Z).name = "left"
        >>> mesh = ngsolve.Mesh(OCCGeometry(bar).GenerateMesh(maxh=0.1))
        >>> steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
        >>> rotor = SolidRotor.from_ngsolve(mesh, steel, "z")
        >>> round(rotor.total_mass, 6), list(rotor.interfaces)
        (2.512, ['left'])
        """
        model = ngsolve_model.assemble_model(
            mesh, materials, order=order, interfaces=interfaces, check_units=check_units
        )
        return cls._of_model(model, axis, check_units)

    @classmethod
    def from_mesh(
        cls,
        mesh: str | os.PathLike | meshio.Mesh,
        materials: Mapping[str, Any] | None,
        axis: AxisLike,
        *,
        interfaces: Sequence[str] | None = None,
        length_unit: str = "m",
        leave_out: Sequence[str] = (),
        matrices: str | os.PathLike | None = None,
        check_units: bool = True,
    ) -> SolidRotor:
        """Assemble a rotor on the mesh of another program: Abaqus, CalculiX, ANSYS, Nastran, Gmsh.

        Tetrahedra, wedges and hexahedra of first order, or of second order with straight or
        curved edges, keep the shape functions and nodes that they have there. ``C3D20R`` and
        ``SOLID186`` keep their reduced integration of the stiffness, with the whole mass.
        Loads, steps and ``*BOUNDARY`` are not read.

        Parameters
        ----------
        mesh : str, path or meshio.Mesh
            ``.inp`` (Abaqus, CalculiX), ``.cdb`` (ANSYS), ``.bdf``, ``.nas``, ``.dat`` (Nastran),
            or what the package meshio reads, such as ``.msh`` of Gmsh.
        materials : mapping or None
            As of :meth:`from_ngsolve`, in SI units, by element set, name of a material (``.inp``),
            number of a property (Nastran) or material (ANSYS), or physical group (Gmsh). None for
            the materials of the file.
        axis : SpinAxis, str or array_like
            Read by :meth:`SpinAxis.of`, in metres.
        interfaces : sequence of str, optional
            Node sets and surfaces that become interfaces; by default all but sets of the whole
            mesh. Weights are area shares where the set is a part of the surface, else equal.
        length_unit : {'m', 'mm'}, optional
            'mm' for files in mm, t, s, N and MPa.
        leave_out : sequence of str, optional
            Keywords and types of elements of the file that the rotor is to do without; others
            than solids, and constraints, are refused.
        matrices : str or path, optional
            Mass and stiffness from a file, instead of elements: ``.sti`` of CalculiX with
            ``.mas`` and ``.dof`` beside it, or DMIG cards of Nastran.
        check_units : bool, optional
            As of :meth:`from_ngsolve`.

        Raises
        ------
        ImportError
            If the format needs meshio, and it is not installed.
        TypeError, ValueError
            If the file cannot be read, holds what solid elements do not, an element is turned
            inside out, a material is missing or anisotropic, or the units cannot be SI.

        Warns
        -----
        UserWarning
            Where elements are taken as others, such as C3D8R as C3D8.

        Examples
        --------
        >>> import meshio
        >>> from exudyn_rotor import SolidRotor
        >>> corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        >>> points = [[x, y, z + h] for h in (0, 1, 2) for x, y, z in corners]
        >>> cells = [("hexahedron", [list(range(8)), list(range(4, 12))])]
        >>> mesh = meshio.Mesh(points, cells, point_sets={"bottom": [0, 1, 2, 3]})
        >>> steel = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
        >>> SolidRotor.from_mesh(mesh, steel, ("z", [0.5, 0.5, 0]))
        SolidRotor(12 nodes, 15700 kg, interfaces ['bottom'], 6 rigid motions free)
        """
        model = mesh_model.import_model(
            mesh,
            materials,
            interfaces=interfaces,
            length_unit=length_unit,
            leave_out=leave_out,
            matrices=matrices,
            check_units=check_units,
        )
        return cls._of_model(model, axis, check_units)

    @classmethod
    def from_fem_interface(
        cls,
        fem: FEMinterface,
        axis: AxisLike,
        *,
        check_units: bool = True,
    ) -> SolidRotor:
        """Take a rotor from Exudyn's FEMinterface; its node sets with a name become interfaces.

        Parameters
        ----------
        fem : exudyn.FEM.FEMinterface
            With 'Position' nodes, mass and stiffness matrix; surface and node sets are optional.
        axis : SpinAxis, str or array_like
            Read by :meth:`SpinAxis.of`.
        check_units : bool, optional
            Refuse sizes and masses that cannot be in SI units.

        Raises
        ------
        TypeError, ValueError
            If `fem` is not a FEMinterface, nodes carry rotations, something is missing, or a check
            of the matrices fails.
        """
        model = import_model(fem)
        return cls._of_model(model, axis, check_units)

    @classmethod
    def from_matrices(
        cls,
        mass: Any,
        stiffness: Any,
        nodes: ArrayLike,
        axis: AxisLike,
        damping: Any = None,
        *,
        interfaces: Mapping[str, Any] | None = None,
        triangles: ArrayLike = (),
        check_units: bool = True,
    ) -> SolidRotor:
        """Make a rotor from plain arrays.

        Parameters
        ----------
        mass, stiffness, damping : array_like or scipy.sparse, shape (3n, 3n)
            Symmetric, ordered x0 y0 z0 x1 … [kg], [N/m], [N s/m]. The damping is optional.
        nodes : array_like, shape (n, 3)
            Reference positions [m].
        interfaces : mapping, optional
            Name → node numbers; :meth:`with_interface` takes weights, too.
        triangles : array_like of int, shape (t, 3) or (t, 6), optional
            Surface for drawing.
        axis, check_units
            As those of :meth:`from_fem_interface`.

        Raises
        ------
        TypeError, ValueError
            If a check fails: kind, shape, finite entries, symmetry, I₃ blocks and positive mass,
            rigid motions, node numbers, units.
        """
        entries = {} if interfaces is None else checks.mapping(interfaces, "interfaces", "nodes")
        node_sets = {
            name: (checks.array(entry, f"interfaces: {name!r}", dtype=int), None)
            for name, entry in entries.items()
        }
        model = FiniteElementModel(nodes, mass, stiffness, damping, node_sets, triangles)
        return cls._of_model(model, axis, check_units)

    prestress = prestress
    with_prestress = with_prestress
    reduce = reduce
    summary = summary

    def with_damping(
        self,
        *,
        mass: float = 0.0,
        stiffness: float = 0.0,
        loss: float = 0.0,
    ) -> SolidRotor:
        """Return the rotor with damping of its own material added to what it has.

        ``mass·M + stiffness·K`` acts in the rotor frame, where it makes a rotor unstable above a
        critical speed: with an external damping c_e, an internal one c_i and the eigenfrequency
        ω₀ of a Jeffcott rotor above ``ω₀ (1 + c_e/c_i)``. Scenes and all linear analyses take it.

        Structural (hysteretic) damping dissipates the same work per cycle at any frequency: a
        motion ``e^{iνt}`` in the rotor frame has the stiffness ``K + i sign(ν) η K``. Where ν = 0
        it does nothing, so it does not damp synchronous whirl on isotropic supports; where a
        forward whirl is slower than the spin, ν < 0 and it drives the whirl. It is only for
        :func:`harmonic_response` and :func:`unbalance_response`; scenes, :func:`campbell` and
        :func:`stability` leave it out with a warning. ``stiffness=η/ν`` is equal at one ν.

        Parameters
        ----------
        mass : float, optional
            Damping per mass [1/s]. The rigid motions that the stiffness leaves free are not
            damped: a material resists strains only.
        stiffness : float, optional
            Damping per stiffness [s] (Kelvin and Voigt's material); that of springs to the ground
            inside the stiffness matrix as well.
        loss : float, optional
            Loss factor η of structural damping, of the whole stiffness as well.

        Raises
        ------
        TypeError, ValueError
            If a factor is no number, or negative.

        Examples
        --------
        Loss factor 2 ζ = stiffness · ω of a mode at rest:

        >>> import numpy as np
        >>> from exudyn_rotor import SolidRotor
        >>> rotor = SolidRotor.from_matrices(np.eye(3), 1e6 * np.eye(3), [[0, 0, 0]], "z")
        >>> damped = rotor.with_damping(stiffness=1e-5)
        >>> float(damped.damping[0, 0])
        10.0
        """
        mass = checks.number(mass, "mass", "1/s", least=0.0)
        damping = checks.number(stiffness, "stiffness", "s", least=0.0) * self.stiffness
        loss = checks.number(loss, "loss", least=0.0)
        if self.damping is not None:
            damping = self.damping + damping
        if not self.rigid_motions:
            damping, mass = damping + mass * self.mass, 0.0
        damping = matrices.frozen(sp.csr_array(damping))
        return replace(
            self,
            damping=damping if damping.nnz else None,
            mass_damping=self.mass_damping + mass,
            structural_damping=self.structural_damping + loss,
        )
