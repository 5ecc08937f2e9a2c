"""Prestress: rigid hubs, refusals of another static state, and the stress at rest."""

import exudyn as exu
import ngsolve as ngs
import numpy as np
import pytest
import scipy.sparse as sp
from models import ALUMINIUM, STEEL, block_beam
from netgen.occ import Box, Cylinder, Glue, OCCGeometry, Pnt, X, Z

from exudyn_rotor import (
    Prestress,
    ReducedRotor,
    SolidRotor,
    add_rotor,
    check_run,
    free_modes,
)
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.theory.nodal import rotations
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


@pytest.fixture(scope="module")
def bar(mesh) -> SolidRotor:
    return SolidRotor.from_ngsolve(mesh, STEEL, "z")


@pytest.fixture(scope="module")
def blade(bar) -> SolidRotor:
    return bar.clamped("root")


@pytest.fixture(scope="module")
def lopsided() -> SolidRotor:
    """A free rotor without symmetry, whose axis is off its centre and no principal axis."""
    arm = Box(Pnt(-0.012, -0.01, -0.3), Pnt(0.012, 0.01, 0.3))
    solid = arm + Box(Pnt(-0.1, -0.08, 0.3), Pnt(0.1, 0.09, 0.32))
    solid.mat("steel")
    solid.faces.Min(Z).name = "end"
    solid.faces.Max(X).name = "side"
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.1))
    rotor = SolidRotor.from_ngsolve(mesh, STEEL, ((0.3, 0.1, 1.0), (0.02, -0.03, 0.1)))
    return rotor.add_point_mass((0.1, 0.05, 0.3), 0.5)


# ------------------------------------------------------------------ a rigid hub


def test_hub_gives_no_stiffness_to_rigid_rotations_of_a_disc(ring):
    reduced = ring.reduce(0, prestress=ring.prestress(clamped="bore"))
    found = np.diag(stiffening(reduced.invariants, "full").K2)
    # from moments of inertia per m: spin I_p / I_p, tilt (I_p / 2) / I_t
    polar = (OUTER**2 + BORE**2) / 2
    tilt = polar / 2 / (polar / 2 + THICKNESS**2 / 12)
    np.testing.assert_allclose(found, [0, 0, 0, 1, tilt, tilt], rtol=1e-3, atol=1e-9)


def test_a_disc_turned_with_its_hub_feels_the_load_turned(ring):
    # a uniform ring is in balance, so that the hub's forces are, but for the mesh
    held = ring.prestress(clamped="bore")
    load = ring.mass @ ring.axis.radial(ring.nodes).ravel()
    for axis, turn in zip(np.eye(3), rotations(ring.nodes, (0, 0, 0)).T, strict=True):
        expected = np.cross(axis, load.reshape(-1, 3)).ravel()
        assert np.abs(held.matrix @ turn - expected).max() < 2e-3 * np.abs(expected).max()


@pytest.mark.parametrize("names", [["end"], ["side"], ["end", "side"]])
def test_rigid_rotations_feel_what_the_level_tilt_gives(lopsided, names):
    held = lopsided.prestress(clamped=names, euler=True, initial_displacement=True)
    reduced = lopsided.reduce(0, prestress=held)
    assert reduced.labels[6].startswith("mode 1")  # the static displacement, turned
    rigid = np.ix_(*2 * (range(6),))
    full, tilt = (stiffening(reduced.invariants, level) for level in ("full", "tilt"))
    size = np.abs(tilt.K2[rigid]).max()
    np.testing.assert_allclose(full.K2[rigid], tilt.K2[rigid], rtol=0, atol=5e-9 * size)
    np.testing.assert_allclose(full.B[rigid], tilt.B[rigid], rtol=0, atol=5e-9 * size)
    assert np.abs(tilt.B).max() > 0.1 * size
    assert np.abs(held.load.reshape(-1, 3).sum(axis=0)).max() > 0.01  # the hub has a net force


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


def test_press_fit_leaves_a_free_rotor_free(ring):
    # Lamé: pressure p at the bore of an annulus in plane stress
    pressure, ratio = 1e7, BORE**2 / (OUTER**2 - BORE**2)
    x, y, _ = ring.nodes.T
    r, c, s = np.hypot(x, y), x / np.hypot(x, y), y / np.hypot(x, y)
    radial, hoop = (pressure * ratio * (1 + sign * OUTER**2 / r**2) for sign in (-1, 1))
    stress = np.zeros((ring.node_count, 6))
    stress[:, 0] = radial * c**2 + hoop * s**2
    stress[:, 1] = radial * s**2 + hoop * c**2
    stress[:, 5] = (radial - hoop) * c * s
    fitted = ring.prestress(clamped="bore", stress=stress)
    np.testing.assert_allclose(fitted.constant_stress, stress, atol=0.05 * np.abs(stress).max())
    turns = rotations(ring.nodes, (0, 0, 0))
    assert np.abs(fitted.constant @ turns).max() < 1e-11 * abs(fitted.constant).max() * OUTER
    before, after = (free_modes(r, 3).frequencies for r in (ring, ring.with_prestress(fitted)))
    assert 1e-6 < np.abs(after / before - 1).max() < 0.01


# ------------------------------------------------------------------ another static state


@pytest.mark.parametrize(
    ("other", "message"),
    [
        (lambda bar, mesh: bar, "none of this rotor.*other clamped nodes"),
        (lambda bar, mesh: bar.clamped("tip"), "none of this rotor.*other clamped nodes"),
        (
            lambda bar, mesh: SolidRotor.from_ngsolve(mesh, STEEL, "y").clamped("root"),
            "another centrifugal load.*axis",
        ),
        (
            lambda bar, mesh: SolidRotor.from_ngsolve(mesh, ALUMINIUM, "z").clamped("root"),
            "another centrifugal load.*density",
        ),
        (
            lambda bar, mesh: SolidRotor.from_ngsolve(
                mesh, STEEL | {"youngsModulus": 2.0e11}, "z"
            ).clamped("root"),
            "none of this rotor.*elastic modulus",
        ),
        (
            lambda bar, mesh: bar.clamped("root").add_point_mass((0.4, 0, 0), 1e-5),
            "another centrifugal load.*point masses",
        ),
    ],
)
def test_prestress_of_another_static_state_is_refused(bar, blade, mesh, other, message):
    with pytest.raises(ValueError, match=rf"prestress: .*{message}.*rotor\.prestress\(\)"):
        blade.with_prestress(other(bar, mesh).prestress())


def test_prestress_of_a_clamped_rotor_is_none_of_a_free_one(bar, blade):
    with pytest.raises(ValueError, match="none of this rotor"):
        bar.with_prestress(blade.prestress())


def test_prestress_held_where_the_rotor_is_clamped_is_its_own(bar, blade):
    modes = free_modes(blade, 4)
    found, expected = (
        blade.reduce(modes, prestress=rotor.prestress(clamped=names)).invariants.K2
        for rotor, names in ((bar, "root"), (blade, ()))
    )
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def springs(rotor: SolidRotor) -> SolidRotor:
    """Return a rotor as imported, on springs of 1e6 N/m at its end face."""
    nodes = rotor.interfaces["end"].nodes
    held = np.zeros((rotor.node_count, 3))
    held[nodes] = 1e6
    stiffness = rotor.stiffness + sp.diags_array(held.ravel())
    return SolidRotor.from_matrices(rotor.mass, stiffness, rotor.nodes, rotor.axis)


def elastic_answer(rotor: SolidRotor, elements: SolidRotor, load: np.ndarray) -> sp.csr_array:
    """Return K_G of a static solution of a grounded rotor by an ordinary sparse solver."""
    u = sp.linalg.spsolve(sp.csc_array(rotor.stiffness), load)
    return elements.elements.geometric_stiffness(u)


@pytest.mark.parametrize("factor", [0.01, 0.98, -1.0, 100.0])
def test_imported_matrix_of_another_scale_is_refused_on_grounded_rotors(
    bar, blade, lopsided, factor
):
    supported = springs(lopsided)
    load = lopsided.mass @ lopsided.axis.radial(lopsided.nodes).ravel()
    on_springs = elastic_answer(supported, lopsided, load)
    # a program may keep the rows of clamped nodes
    whole = bar.elements.geometric_stiffness(blade.prestress().displacement)
    for rotor, matrix in (
        (blade, blade.prestress().matrix),
        (blade, whole),
        (supported, on_springs),
    ):
        rotor.with_prestress(Prestress.from_matrix(matrix, rotor.nodes))
        with pytest.raises(ValueError, match="prestress: the matrix times the nodal positions"):
            rotor.with_prestress(Prestress.from_matrix(factor * matrix, rotor.nodes))


@pytest.mark.parametrize("factor", [-1.0, 0.5, 100.0])
def test_imported_euler_matrix_of_another_scale_is_refused(blade, factor):
    own = blade.prestress(euler=True)
    blade.with_prestress(Prestress.from_matrix(own.matrix, blade.nodes, own.euler))
    scaled = Prestress.from_matrix(own.matrix, blade.nodes, factor * own.euler)
    with pytest.raises(ValueError, match="the Euler matrix times the nodal positions"):
        blade.with_prestress(scaled)


def test_imported_euler_matrix_of_a_free_rotor_must_vanish(bar, blade):
    # the Euler load of a free rotor is the inertia of its own acceleration and strains nothing
    own = bar.prestress(euler=True)
    bar.with_prestress(Prestress.from_matrix(own.matrix, bar.nodes, own.euler))
    of_blade = Prestress.from_matrix(own.matrix, bar.nodes, blade.prestress(euler=True).euler)
    with pytest.raises(ValueError, match="the Euler matrix"):
        bar.with_prestress(of_blade)


def test_imported_matrix_with_held_nodes_needs_a_held_rotor(bar, blade):
    matrix = blade.prestress().matrix
    blade.with_prestress(Prestress.from_matrix(matrix, blade.nodes, balanced=False))
    with pytest.raises(ValueError, match=r"leaves 6 rigid motions free.*rotor\.clamped"):
        bar.with_prestress(Prestress.from_matrix(matrix, bar.nodes, balanced=False))


def test_worst_entry_on_rotations_is_named(lopsided):
    matrix = lopsided.prestress().matrix
    # a stress that resists y with x alone: K_G of forces at two nodes, zero for all other pairs
    turns = rotations(lopsided.nodes, lopsided.center_of_mass)
    dual = turns @ np.linalg.inv(turns.T @ turns)
    extra = 5.0 * (np.outer(dual[:, 0], dual[:, 1]) + np.outer(dual[:, 1], dual[:, 0]))
    wrong = Prestress.from_matrix(matrix.toarray() + extra, lopsided.nodes)
    with pytest.raises(
        ValueError, match=r"mesh axes x and y with .*axis, density and point masses"
    ):
        lopsided.with_prestress(wrong)


def test_other_mesh_is_said_to_be_of_the_prestress(bar, ring):
    with pytest.raises(ValueError, match=r"^prestress from another mesh: .*nodes in the prestress"):
        bar.with_prestress(ring.prestress())


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


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_yield_row_holds_the_stress_at_rest(stretched, sign):
    given = stretched.prestress(
        stress=uniform_tension(stretched, sign * TENSION), yield_stress=0.9 * TENSION
    )
    reduced = stretched.reduce(2, prestress=given)
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, translation="none", spin=300.0)
    mbs.Assemble()
    row = check_run(body, reduced=reduced, warn=False)["yield"]
    by_spin = 300.0**2 * stretched.prestress().stress
    at_speed = von_mises(uniform_tension(stretched, sign * TENSION) + by_spin).max()
    assert row.value == pytest.approx(max(at_speed, TENSION) / (0.9 * TENSION), rel=1e-6)
    assert not row.ok


def test_carried_prestress_is_not_taken_for_a_new_one(stretched):
    carrying = stretched.with_prestress(stretched.prestress(stress=uniform_tension(stretched)))
    with pytest.raises(ValueError, match="what another rotor carries"):
        stretched.with_prestress(carrying.carried_prestress)


# ------------------------------------------------------------------ input


@pytest.mark.parametrize("nodes", [lambda r: [5], lambda r: np.flatnonzero(on_edge(r))])
def test_nodes_on_one_line_cannot_clamp(bar, nodes):
    rotor = bar.with_interface("line", nodes(bar))
    for use in (rotor.clamped, lambda name: rotor.prestress(clamped=name)):
        with pytest.raises(ValueError, match=r"nodes of \['line'\] lie on one line"):
            use("line")


def on_edge(rotor: SolidRotor) -> np.ndarray:
    """Return the nodes on an edge of the bar along x."""
    return np.all(np.abs(rotor.nodes[:, 1:] - 0.01) < 1e-9, axis=1)


@pytest.mark.parametrize(
    ("speed", "error", "message"),
    [
        (np.nan, ValueError, "speed: needs a finite number"),
        (np.inf, ValueError, "speed: needs a finite number"),
        ("a", TypeError, "speed: needs a finite number .* got 'a'"),
        (np.ones(2), TypeError, "speed: needs a finite number"),
        (None, TypeError, "speed: needs a finite number"),
    ],
)
def test_speed_of_static_fields_is_one_finite_number(stretched, speed, error, message):
    reduced = stretched.reduce(2, prestress=True)
    for field in (reduced.static_stress, reduced.static_displacement):
        with pytest.raises(error, match=message):
            field(speed)
    assert np.array_equal(reduced.static_stress(np.int64(3)), reduced.static_stress(3.0))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"stress": "abc"}, "stress: needs finite numbers .* got 'abc'"),
        ({"yield_stress": "high"}, r"yield_stress: needs a finite number \[Pa\] > 0, got 'high'"),
        ({"yield_stress": 1e8, "speed": [1.0]}, r"speed: needs a finite number .* got \[1.0\]"),
    ],
)
def test_arguments_that_are_no_numbers_are_refused(bar, given, message):
    with pytest.raises(TypeError, match=message):
        bar.prestress(**given)
