"""Small rotors that several tests share."""

from functools import cache

import ngsolve as ngs
import numpy as np
from exudyn.FEM import FEMinterface, KirchhoffMaterial
from netgen.occ import Box, Cylinder, Glue, OCCGeometry, Pnt, Z

from exudyn_rotor import ReducedRotor, SolidRotor, craig_bampton_modes

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
ALUMINIUM = {"youngsModulus": 7.0e10, "poissonsRatio": 0.33, "density": 2700.0}


def disc_rotor(order: int = 2, safety: float = 1.0) -> SolidRotor:
    """Return the rotor of :func:`disc_on_shaft`; made once, for rotors do not change."""
    return _disc_rotor(order, safety)


@cache
def _disc_rotor(order: int, safety: float) -> SolidRotor:
    return SolidRotor.from_ngsolve(disc_on_shaft(safety=safety), STEEL, "z", order=order)


@cache
def centered_disc(order: int = 2) -> SolidRotor:
    """Return :func:`disc_rotor` with its interfaces on the axis; made once, with its factors."""
    return disc_rotor(order).center_interfaces()


@cache
def disc_with_two_modes(heavy: float = 0.0) -> ReducedRotor:
    """Return :func:`disc_rotor` in two modes, with a point mass [kg] on its rim; made once."""
    rotor = disc_rotor()
    return (rotor.add_point_mass([0.15, 0.0, 0.2], heavy) if heavy else rotor).reduce(2)


@cache
def disc_with_craig_bampton_modes() -> ReducedRotor:
    """Return :func:`disc_rotor` in four Craig-Bampton modes, ends coupled by RBE3; made once."""
    rotor = disc_rotor()
    return rotor.reduce(craig_bampton_modes(rotor, 4, coupling="RBE3"))


def disc_on_shaft(maxh: float = 0.06, scale: float = 1.0, safety: float = 1.0) -> ngs.Mesh:
    """Return a steel disc (radius 0.15 m) on a shaft (radius 0.02 m, z from 0 to 0.5 m).

    Material 'steel'; the end faces of the shaft are named 'left' and 'right'. `safety` is the
    radius of the curves over the length of the elements there; Netgen's default is 2.
    """
    shaft = Cylinder(Pnt(0, 0, 0), Z, 0.02 * scale, 0.5 * scale)
    disc = Cylinder(Pnt(0, 0, 0.2 * scale), Z, 0.15 * scale, 0.03 * scale)
    solid = shaft + disc
    solid.mat("steel")
    solid.faces.Min(Z).name = "left"
    solid.faces.Max(Z).name = "right"
    geometry = OCCGeometry(solid)
    return ngs.Mesh(geometry.GenerateMesh(maxh=maxh * scale, curvaturesafety=safety))


@cache
def disc_fem() -> FEMinterface:
    """Return a FEMinterface of :func:`disc_on_shaft`, first order, with six modes and their stress.

    Made once: change a copy only.
    """
    fem = FEMinterface()
    _, _, space = fem.ImportMeshFromNGsolve(
        disc_on_shaft(),
        materials={"steel": STEEL},
        boundaryNamesList=["left", "right"],
        meshOrder=1,
    )
    fem.ComputeEigenmodes(6, 6)
    fem.ComputePostProcessingModesNGsolve(space, KirchhoffMaterial(2.1e11, 0.3, 7850.0))
    return fem


def two_material_cylinder(maxh: float = 0.06, safety: float = 1.0) -> ngs.Mesh:
    """Return a cylinder of radius 0.1 m: 'steel' for z below 0.3 m, 'aluminium' up to 0.4 m.

    The face z = 0 is named 'left', the face between the materials 'joint'. `safety` as in
    :func:`disc_on_shaft`: the better, the less is the mesh off balance.
    """
    lower = Cylinder(Pnt(0, 0, 0), Z, 0.1, 0.3)
    lower.mat("steel")
    lower.faces.Min(Z).name = "left"
    lower.faces.Max(Z).name = "joint"
    upper = Cylinder(Pnt(0, 0, 0.3), Z, 0.1, 0.1)
    upper.mat("aluminium")
    geometry = OCCGeometry(Glue([lower, upper]))
    return ngs.Mesh(geometry.GenerateMesh(maxh=maxh, curvaturesafety=safety))


def block_beam(maxh: float = 0.05, scale: float = 1.0) -> ngs.Mesh:
    """Return a beam of 0.04 × 0.06 × 0.3 m along z with the end faces 'left' and 'right'."""
    corner = 0.02 * scale, 0.03 * scale
    solid = Box(Pnt(-corner[0], -corner[1], 0), Pnt(corner[0], corner[1], 0.3 * scale))
    solid.mat("steel")
    solid.faces.Min(Z).name = "left"
    solid.faces.Max(Z).name = "right"
    return ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=maxh * scale))


def two_masses() -> dict[str, np.ndarray]:
    """Return M, K and nodes of the two masses on springs in the paper's Appendix B (122, 123)."""
    stiffness = 1e4 * np.diag([272.0, 196.0, 100.0, 272.0, 196.0, 100.0])
    stiffness[0, 3] = stiffness[3, 0] = -128e4
    nodes = np.array([[1.0, 0.0, 0.0], [1.75, 0.0, 0.0]])
    return {"mass": np.eye(6), "stiffness": stiffness, "nodes": nodes}
