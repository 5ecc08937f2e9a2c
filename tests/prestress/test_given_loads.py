"""Thrust, torque and supports in the static stress, against beam columns."""

from functools import cache

import exudyn
import ngsolve as ngs
import numpy as np
import pytest
import scipy.linalg as la
from models import STEEL
from netgen.occ import Box, Cylinder, OCCGeometry, Pnt, Z

import exudyn_rotor as er

RADIUS, LENGTH = 0.01, 1.0
YOUNG, NU, RHO = (STEEL[name] for name in ("youngsModulus", "poissonsRatio", "density"))
AREA, SECOND = np.pi * RADIUS**2, np.pi * RADIUS**4 / 4.0
EULER = np.pi**2 * YOUNG * SECOND / LENGTH**2
STIFF = 1e10
PINNED = [
    er.Support("left", np.diag([STIFF, STIFF, STIFF])),
    er.Support("right", np.diag([STIFF, STIFF, 0.0])),
]


@cache
def shaft(radius: float = RADIUS, length: float = LENGTH, maxh: float = 0.05) -> er.SolidRotor:
    solid = Cylinder((0, 0, 0), Z, radius, length)
    solid.faces.Min(Z).name, solid.faces.Max(Z).name = "left", "right"
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=maxh, curvaturesafety=1.0))
    return er.SolidRotor.from_ngsolve(mesh, STEEL, "z").center_interfaces()


@cache
def modes(count: int = 8) -> er.ModeBasis:
    return er.craig_bampton_modes(shaft(), count, ["left", "right"], coupling="RBE3")


def thrust(force: float) -> er.Prestress:
    return shaft().prestress(loads={"right": [0.0, 0.0, force]}, supports=PINNED)


def bending(rotor: er.ReducedRotor, count: int = 1) -> np.ndarray:
    """Return the lowest squared bending frequencies of a plane on stiff bearings."""
    M, _, K, *_ = er.linear_model(rotor, supports=PINNED).matrices(0.0)
    values = la.eigh(K, M, eigvals_only=True)
    return values[values > 1e3][: 2 * count : 2]


@cache
def unloaded() -> er.ReducedRotor:
    return shaft().reduce(modes())


@pytest.mark.parametrize("share", [-0.8, 1.0])
def test_a_beam_column_between_two_bearings(share):
    """``ω² = ω₀² + N (π/L)²/(ρA)``; ω₀ is the mesh's own, 0.8 % above a beam's here."""
    loaded = shaft().reduce(modes(), prestress=thrust(share * EULER))
    square = bending(unloaded())
    added = share * EULER * (np.pi / LENGTH) ** 2 / (shaft().total_mass / LENGTH)
    # a solid has its static strain beside that, 2e-4 over 1 + N/N_cr
    assert np.sqrt(bending(loaded)) == pytest.approx(np.sqrt(square + added), rel=1e-3)


def test_whirl_of_a_spinning_shaft_under_thrust():
    """``EI k⁴ + N k² = ω² (ρA + ρI k²) ∓ 2 Ω ω ρI k²`` with k = π/L: Rayleigh's beam.

    ω without thrust at rest is the mesh's own.
    """
    speed, force, wave = 3000.0, -0.6 * EULER, (np.pi / LENGTH) ** 2
    line, turn = RHO * AREA, RHO * SECOND * wave
    stiff = bending(unloaded())[0] * (line + turn) + force * wave
    loaded = shaft().reduce(modes(), prestress=thrust(-0.6 * EULER))
    found = er.campbell(loaded, [speed], supports=PINNED, accuracy=None)
    for name, sign in (("backward", 1.0), ("forward", -1.0)):
        expected = np.roots([line + turn, sign * 2.0 * speed * turn, -stiff]).max()
        whirls = found.frequencies_inertial[0, np.array(found.whirl[0]) == name]
        assert whirls[whirls > 1.0].min() == pytest.approx(expected, rel=1e-3)


def test_a_spinning_shaft_held_at_both_ends_is_in_tension():
    """Poisson's contraction ``ν ρ ω² R²/(2E)`` meets the springs and E A."""
    radius, length, spring = 0.05, 1.5, 2e9
    solid = shaft(radius, length, 0.1)
    area = np.pi * radius**2
    supports = [er.Support(n, np.diag([0.0, 0.0, spring])) for n in ("left", "right")]
    strain = NU * RHO * radius**2 / (2.0 * YOUNG)
    force = strain * length / (length / (YOUNG * area) + 2.0 / spring)  # per ω²
    basis = er.craig_bampton_modes(solid, 6, ["left", "right"], coupling="RBE3")
    held, free = (
        solid.reduce(basis, prestress=solid.prestress(supports=s)).invariants.K2
        for s in (supports, ())
    )
    pull = {"left": [0.0, 0.0, -force], "right": [0.0, 0.0, force]}
    pulled = solid.reduce(basis, prestress=solid.prestress(loads=pull)).invariants.K0
    bend = np.argmax(np.diag(pulled)[:6])  # a tilt of the whole rotor
    assert (held - free)[bend, bend] == pytest.approx(pulled[bend, bend], rel=0.01)
    tilt = np.einsum("ij,jk,ik->i", pulled, np.eye(len(pulled)), pulled)
    assert np.abs(held - free - pulled).max() < 0.02 * np.sqrt(tilt.max())


def test_a_torque_makes_a_clamped_shaft_buckle():
    """``T_cr = 8.987 EI/L`` where both ends are clamped, whatever the kind of the torque."""
    torque = 100.0
    loads = {"left": [0, 0, 0, 0, 0, -torque], "right": [0, 0, 0, 0, 0, torque]}
    reduced = shaft().reduce(modes(12), prestress=shaft().prestress(loads=loads))
    held = [er.Support(n, STIFF, tilt_stiffness=1e7) for n in ("left", "right")]
    K = er.linear_model(unloaded_with(12), supports=held).matrices(0.0).K
    T = er.linear_model(reduced, supports=held).matrices(0.0).K - K
    free = np.abs(np.diag(K)) > 1e-6 * np.abs(np.diag(K)).max()
    factors = la.eigh(T[np.ix_(free, free)], K[np.ix_(free, free)], eigvals_only=True)
    assert torque / np.abs(factors).max() == pytest.approx(
        8.987 * YOUNG * SECOND / LENGTH, rel=0.02
    )


@cache
def unloaded_with(count: int) -> er.ReducedRotor:
    return shaft().reduce(modes(count))


def deflection(rotor: er.SolidRotor | er.ReducedRotor, speed: float) -> np.ndarray:
    """Return the sag of the middle in a scene, by a static solution."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rotor, spin=speed, translation="none", gravity=[0.0, -9.81, 0.0])
    er.add_supports(body, [*PINNED, er.Support("middle", 1.0)])
    number = body.add_interface_sensor("middle", exudyn.OutputVariableType.Displacement)
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.staticSolver.verboseMode = 0
    settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    mbs.SolveStatic(settings)
    return np.array(mbs.GetSensorValues(number))


def test_scenes_have_it_reduced_and_full():
    solid = shaft().interface_at("middle", 0.5, 0.04)
    force = -0.5 * EULER
    prestress = solid.prestress(loads={"right": [0.0, 0.0, force]}, supports=PINNED)
    sag, pinned = [], [*PINNED, er.Support("middle", 1.0)]
    for rotor in (
        solid.with_prestress(prestress),
        solid.reduce(er.craig_bampton_modes(solid, 4, coupling="RBE3"), prestress=prestress),
    ):
        sag.append(deflection(rotor, 0.0)[1])
    assert sag[0] == pytest.approx(sag[1], rel=3e-4)
    listed = er.static_response(rotor, gravity=[0.0, -9.81, 0.0], supports=pinned, at="middle")
    assert listed.deflection()[1] == pytest.approx(sag[1], rel=1e-6)
    free = er.static_response(solid, gravity=[0.0, -9.81, 0.0], supports=pinned, at="middle")
    assert listed.deflection()[1] / free.deflection()[1] == pytest.approx(2.0, rel=0.01)


BOTH = {"left": [0.0, 0.0, 0.9 * EULER], "right": [0.0, 0.0, -0.9 * EULER]}
ALONG = [er.Support("left", np.diag([0.0, 0.0, STIFF]))]
BUILT_IN = [er.Support("left", STIFF * np.eye(3), tilt_stiffness=1e9)]
GUIDED = [*BUILT_IN, er.Support("right", np.diag([STIFF, STIFF, 0.0]), tilt_stiffness=1e9)]


@pytest.mark.parametrize(
    ("loads", "supports", "shares"),
    [
        (BOTH, None, 1.0),  # free: hinged where the loads act
        ({"right": BOTH["right"]}, ALONG, 1.0),
        ({"right": BOTH["right"]}, PINNED, 1.0),
        ({"right": [0.0, 0.0, -0.2 * EULER]}, BUILT_IN, 0.25),
        ({"right": [0.0, 0.0, -3.0 * EULER]}, GUIDED, 4.0),
        ({"right": [0.0, 0.0, EULER]}, PINNED, np.inf),
        ({"right": [0.0, 0.0, 0.0]}, PINNED, np.inf),
    ],
)
def test_loads_above_eulers_are_refused_with_the_factor(loads, supports, shares):
    """The free one turns over under any thrust: there the supports that come later decide."""
    factor = shaft().prestress(loads=loads, supports=supports).buckling_factor
    if shares == np.inf:
        assert factor is None
        return
    # shear lowers Euler's load by 7e-4 times the share, the mesh raises it by 1.6 %
    thrust = abs(loads["right"][2]) / EULER
    assert factor * thrust == pytest.approx(shares, rel=0.02)
    more = {name: 1.01 * factor * np.array(load) for name, load in loads.items()}
    with pytest.raises(ValueError, match=r"loads: the rotor buckles at 0\.9901 of them"):
        shaft().prestress(loads=more, supports=supports)


def test_loads_of_nodes_are_those_of_an_array_and_of_interfaces():
    end = np.flatnonzero(np.isclose(shaft().nodes[:, 2], LENGTH))
    forces = np.zeros((shaft().node_count, 3))
    forces[end, 2] = BOTH["right"][2] / len(end)
    of_nodes = {node: forces[node] for node in end.tolist()}
    listed = (of_nodes, forces, {"right": BOTH["right"]})
    given = [shaft().prestress(loads=loads, supports=PINNED) for loads in listed]
    assert abs(given[0].by_loads - given[1].by_loads).max() == 0.0
    assert given[0].buckling_factor == pytest.approx(given[2].buckling_factor, rel=1e-3)
    with pytest.raises(ValueError, match=r"nothing takes up the force \[0\.0, 0\.0, 5\.0\] N"):
        shaft().prestress(loads={int(np.argmax(shaft().nodes[:, 0])): [0.0, 0.0, 5.0]})


def test_supports_that_let_the_rotor_buckle_have_no_deflection():
    """Hinged the shaft bears 0.9 of Euler's load, built in at one end a quarter of it."""
    pressed = shaft().reduce(modes(), prestress=shaft().prestress(loads=BOTH))
    weight = {"gravity": [0.0, -9.81, 0.0], "at": "right"}
    assert er.static_response(pressed, supports=PINNED, **weight).deflection()[1] < 0.0
    with pytest.raises(ValueError, match="supports: the rotor buckles on them"):
        er.static_response(pressed, supports=BUILT_IN, **weight)
    assert er.stability(pressed, 0.0, supports=BUILT_IN).growth.max() > 100.0


@pytest.mark.parametrize(
    ("loads", "supports", "message"),
    [
        ({"right": [0, 0, 5.0]}, (), "nothing takes up the force"),
        ({"right": [0, 0, 5.0]}, [er.Support("left", 1e9)], "nothing takes up"),
        ({"right": [0, 0, 0, 0, 0, 3.0]}, PINNED, r"the moment \[.*, 3\.0\] N m"),
        ({"right": [0, 0, 0, 3.0, 0, 0]}, PINNED, "moment across the axis"),
        ({3: [0, 0, 0, 0, 0, 3.0]}, PINNED, "a mesh node has no rotation"),
        ({"no": [0, 0, 1.0]}, PINNED, "'no' is unknown"),
        ({"right": [0, 1.0]}, PINNED, "needs 3 or 6 numbers"),
        ({"right": [0, 0, 5.0]}, [er.Support("left", lambda w: w * np.eye(3))], "varies"),
        ({"right": [0, 0, 5.0]}, [3], "supports: needs objects of kind Support, got 3"),
    ],
)
def test_what_has_no_static_stress_is_refused(loads, supports, message):
    with pytest.raises((TypeError, ValueError), match=message):
        shaft().prestress(loads=loads, supports=supports)


def test_a_torque_on_one_side_of_the_shaft_is_refused():
    solid = Box(Pnt(-0.02, -0.02, 0.0), Pnt(0.02, 0.02, 0.2))
    solid.faces.Min(Z).name = "left"
    mesh = ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=0.03))
    rotor = er.SolidRotor.from_ngsolve(mesh, STEEL, "z")
    flat = np.flatnonzero(np.isclose(rotor.nodes[:, 2], 0.2) & (abs(rotor.nodes[:, 1]) < 0.011))
    rotor = rotor.with_interface("key", flat)
    loads = {"left": [0, 0, 0, 0, 0, -9.0], "key": [0, 0, 0, 0, 0, 9.0]}
    with pytest.raises(ValueError, match="semi-tangential"):
        rotor.prestress(loads=loads)
    with pytest.raises(ValueError, match="loads, supports: have no solution with initial_disp"):
        rotor.prestress(initial_displacement=True, supports=[er.Support("left", 1e9)])
