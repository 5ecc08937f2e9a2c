"""Prestress: rigid hubs, refusals of another static state, and the stress at rest."""

import ngsolve as ngs
import numpy as np
import pytest
import scipy.sparse as sp
from models import STEEL, block_beam
from netgen.occ import Box, Cylinder, Glue, OCCGeometry, Pnt, X, Z

from exudyn_rotor import (
    ReducedRotor,
    SolidRotor,
)
from exudyn_rotor.theory.axis import rotations
from exudyn_rotor.theory.stiffening import stiffening

OUTER, BORE, THICKNESS = 0.2, 0.1, 0.02
TENSION = 5e7
# as stiff as a rigid hub, and without mass against steel
RIGID = {"youngsModulus": 2.1e15, "poissonsRatio": 0.3, "density": 1e-6}


def annulus(with_hub: bool = False) -> SolidRotor:
    """Return a steel disc with the face 'bore'; there is a hub in it or nothing."""
    hub = Cylinder(Pnt(0, 0, -THICKNESS / 2), Z, BORE, THICKNESS)
    disc = Cylinder(Pnt(0, 0, -THICKNESS / 2), Z, OUTER, THICKNESS) - hub
    hub.mat("hub")
    disc.mat("steel")
    for face in disc.faces:
        at = np.array([face.center.x, face.center.y, face.center.z])
        if np.abs(at).max() < 1e-6 and face.mass < 1.01 * 2 * np.pi * BORE * THICKNESS:
            face.name = "bore"
    solid = Glue([hub, disc]) if with_hub else disc
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.03))
    materials = {"steel": STEEL} | ({"hub": RIGID} if with_hub else {})
    return SolidRotor.from_ngsolve(mesh, materials, "z", check_units=not with_hub)


@pytest.fixture(scope="module")
def ring() -> SolidRotor:
    return annulus()


@pytest.fixture(scope="module")
def mesh() -> ngs.Mesh:
    """A blade along x on a face 'root' 0.1 m from the origin."""
    solid = Box(Pnt(0.1, -0.01, -0.01), Pnt(0.4, 0.01, 0.01))
    solid.mat("steel")
    solid.faces.Min(X).name = "root"
    solid.faces.Max(X).name = "tip"
    return ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.03))


# ------------------------------------------------------------------ a rigid hub


def test_hub_gives_no_stiffness_to_rigid_rotations_of_a_disc(ring):
    reduced = ring.reduce(0, prestress=ring.prestress(clamped="bore"))
    found = np.diag(stiffening(reduced.invariants, "full").K2)
    # from moments of inertia per m: spin I_p / I_p, tilt (I_p / 2) / I_t
    polar = (OUTER**2 + BORE**2) / 2
    tilt = polar / 2 / (polar / 2 + THICKNESS**2 / 12)
    np.testing.assert_allclose(found, [0, 0, 0, 1, tilt, tilt], rtol=1e-3, atol=1e-9)


def test_hub_acts_as_a_light_and_stiff_one_in_the_mesh(ring):
    """The geometric stiffness of motions that leave the hub rigid, with the hub's own stress."""
    whole = annulus(with_hub=True)

    def fields(rotor: SolidRotor) -> np.ndarray:
        # rotations that grow outside the bore, on top of a bending of the disc
        x, y, _ = rotor.nodes.T
        out = np.maximum(np.hypot(x, y) - BORE, 0.0) / OUTER
        turns = rotations(rotor.nodes, (0, 0, 0)).reshape(-1, 3, 3)
        bent = np.zeros((rotor.node_count, 3, 1))
        bent[:, 2, 0] = x * y * out / OUTER
        grown = np.concatenate([turns * (1 + out)[:, None, None], bent], axis=2)
        return grown.reshape(-1, 4)

    def form(rotor: SolidRotor, matrix: sp.csr_array) -> np.ndarray:
        return fields(rotor).T @ (matrix @ fields(rotor))

    expected = form(whole, whole.prestress().matrix)
    found = form(ring, ring.prestress(clamped="bore").matrix)
    bare = form(
        ring, ring.elements.geometric_stiffness(ring.prestress(clamped="bore").displacement)
    )
    assert np.abs(found - expected).max() < 5e-3 * np.abs(expected).max()
    assert np.abs(bare - expected).max() > 0.2 * np.abs(expected).max()


# ------------------------------------------------------------------ stress at rest


@pytest.fixture(scope="module")
def stretched() -> SolidRotor:
    beam = SolidRotor.from_ngsolve(block_beam(), STEEL, "z")
    return beam.clamped(["left", "right"])


def uniform_tension(rotor: SolidRotor, value: float = TENSION) -> np.ndarray:
    stress = np.zeros((rotor.node_count, 6))
    stress[:, 2] = value
    return stress


def test_static_stress_holds_the_stress_at_rest(stretched, tmp_path):
    given = stretched.prestress(stress=uniform_tension(stretched), yield_stress=1e9)
    reduced = stretched.reduce(2, prestress=given)
    plain = stretched.reduce(2, prestress=True)
    # uniform tension between clamped ends is in equilibrium as it is
    np.testing.assert_allclose(reduced.static_stress(0.0), uniform_tension(stretched), atol=1.0)
    by_spin = reduced.static_stress(300.0) - reduced.static_stress(0.0)
    np.testing.assert_allclose(by_spin, 300.0**2 * given.stress, atol=1.0)
    # the tension takes part in what the rotation does: little in a bar on its axis
    np.testing.assert_allclose(by_spin, plain.static_stress(300.0), atol=50.0)
    assert np.all(plain.static_stress(0.0) == 0.0)
    reduced.save(tmp_path / "new.npz")
    loaded = ReducedRotor.load(tmp_path / "new.npz")
    assert np.array_equal(loaded.static_stress(300.0), reduced.static_stress(300.0))
    plain.save(tmp_path / "old.npz")
    with np.load(tmp_path / "old.npz") as old:  # as written before there was this entry
        assert "centrifugal.constant_stress" not in old
    loaded = ReducedRotor.load(tmp_path / "old.npz")
    assert np.array_equal(loaded.static_stress(300.0), plain.static_stress(300.0))
