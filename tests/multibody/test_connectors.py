"""Every kind of law in a scene: Exudyn's Jacobian is the derivative of its forces."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.utilities import InertiaCuboid
from test_supports_in_scenes import SKEW, TO_X, rings

import exudyn_rotor as er
from exudyn_rotor.multibody.evaluation import evaluating

SPEED, CLEARANCE = 80.0, 2e-4
SIZES = {"interface": "left", "radius": 0.05, "length": 0.02, "clearance": CLEARANCE}
GAPS = np.radians([10.0, 130.0, 250.0])
PADS = er.grooved_pads(CLEARANCE, GAPS, 0.2, 0.5)
FILM = er.OilFilm(0.05, 0.02, 0.02, PADS, "none", nodes=24, axial_nodes=0)
LOOP = {"proportional": 2e4, "derivative": 20.0, "filter_frequency": 2e3}
PID = er.PIDController(**LOOP, amplifier_frequency=1e3, integral=1e5, delay=1e-4)
MAGNETS = er.SaturatingActuator(constant=1e-5, bias_current=2.0, gap=4e-4, current_limit=6.0)
BALLS = {"count": 8, "pitch_radius": 0.033, "element_radius": 0.006, "stiffness": 7e9}
CROSSED = np.array([[5e6, 1e6, 2e5], [-5e5, 8e6, 1e5], [1e5, -2e5, 2e6]])
TILTS = {"tilt_stiffness": [[4e3, 1e3], [-5e2, 2e3]], "tilt_damping": 3.0}
LAWS = {
    "turning": er.Support("left", CROSSED, 1e-4 * CROSSED, frame="rotor"),
    "table": er.Support("left", ([0.0, 300.0], [1e6, 4e6]), ([0.0, 300.0], [50.0, 90.0]), **TILTS),
    "short": er.ShortJournalBearing(viscosity=0.02, **SIZES),
    "damper": er.SqueezeFilmDamper(viscosity=0.02, centring_stiffness=1e6, **SIZES),
    "seal": er.AnnularSeal(pressure_drop=1e6, density=1e3, viscosity=1e-3, **SIZES),
    "rolling": er.RollingBearing(interface="left", clearance=-1e-5, damping=50.0, **BALLS),
    "stop": er.ClearanceStop(
        interface="left", radius=0.05, clearance=2e-5, stiffness=1e7, damping=40.0, friction=0.1
    ),
    "film": er.JournalBearing(interface="left", film=FILM),
    "pads": er.TiltingPadBearing(interface="left", film=FILM, pad_inertia=3e-4),
    "magnets": er.MagneticBearing(interface="left", actuator=MAGNETS, controller=PID, angle=0.4),
    "sensors apart": er.MagneticBearing(
        interface="left", actuator=er.LinearActuator(80.0, 3e5), controller=PID, sensor="right"
    ),
}
ENDS = {"left": [-0.15, 0.0, 0.0], "right": [0.15, 0.0, 0.0]}


def on(mbs, base):
    """Return what carries supports: nothing, a foundation or a body of Exudyn, turned."""
    if base == "foundation":
        mounts = [er.Mount([z, -0.3, x], 1e6) for x in (-0.2, 0.2) for z in (-0.4, 0.4)]
        return er.add_foundation(
            mbs, er.Foundation.rigid(9.0, [1.0, 1.0, 1.0], [0, 0, 0], mounts, ENDS)
        )
    if base is None:
        return None
    kind = getattr(exu.NodeType, f"Rotation{base}")
    return mbs.CreateRigidBody(
        inertia=InertiaCuboid(500.0, [0.3, 0.3, 0.3]), referenceRotationMatrix=SKEW, nodeType=kind
    )


def jacobians(mbs, locked):
    """Return Exudyn's and that by differences, by positions and rates, of free coordinates."""
    data, random = mbs.systemData, np.random.default_rng(5)
    size = data.ODE2Size()
    free = np.setdiff1d(np.arange(size), locked)
    q, q_t = (np.array(X) for X in (data.GetODE2Coordinates(), data.GetODE2Coordinates_t()))
    q[free] += 2e-5 * random.normal(size=len(free))
    q_t[free] += 2e-3 * random.normal(size=len(free))

    def forces(moved, rates):
        data.SetODE2Coordinates(moved)
        data.SetODE2Coordinates_t(rates)
        solver.ComputeODE2RHS(mbs)
        return np.array(solver.GetSystemResidual())[free]

    with evaluating(mbs) as solver:
        found, expected, h = [], [], 1e-7
        for factors, step in (((1.0, 0.0), h), ((0.0, 1.0), 100.0 * h)):
            moves = step * np.eye(size)[free]
            pairs = [(q, q_t, move, 0.0 * move) for move in moves]
            if factors[1]:
                pairs = [(q, q_t, 0.0 * move, move) for move in moves]
            ends = [[forces(x + a, v + b), forces(x - a, v - b)] for x, v, a, b in pairs]
            expected.append(np.array([np.subtract(*pair) for pair in ends]).T / (2.0 * step))
            forces(q, q_t)
            solver.SetSystemJacobian(np.zeros((size + solver.GetAEsize(),) * 2))
            solver.ComputeJacobianODE2RHS(mbs, *factors, 0.0)
            found.append(np.array(solver.GetSystemJacobian())[np.ix_(free, free)])
    return found, expected


@pytest.mark.parametrize("base", [None, "foundation", "Rxyz"])
@pytest.mark.parametrize("law", LAWS)
def test_the_jacobian_of_every_law_is_its_derivative(law, base):
    """What static forces do by small turns is left out: of the order of displacement over arm."""
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rings(TO_X), spin=SPEED)
    er.add_supports(body, LAWS[law], on(mbs, base))
    mbs.Assemble()
    places = np.asarray(mbs.systemData.GetNodeLTGODE2(body.nodes["rigid"]))
    for found, expected in zip(*jacobians(mbs, places[3:]), strict=True):
        scale = 1.0 / np.sqrt(np.maximum(np.abs(expected).max(axis=1), 1e-6))
        error = np.abs((found - expected) * np.outer(scale, scale)).max()
        assert error < (3e-5 if base != "Rxyz" else 3e-2)


def test_friction_has_its_slope_by_a_free_spin():
    """Where it begins to slide."""
    mbs = exu.SystemContainer().AddSystem()
    body = er.add_rotor(mbs, rings(TO_X), initial_speed=0.0)
    stop = {"radius": 0.05, "clearance": 1e-7, "stiffness": 1e6, "friction": 0.3}
    er.add_supports(body, [er.ClearanceStop(interface="left", **stop)])
    mbs.Assemble()
    places = np.asarray(mbs.systemData.GetNodeLTGODE2(body.nodes["rigid"]))
    found, expected = (pair[1] for pair in jacobians(mbs, places[4:]))
    found, expected = found[:, 3], expected[:, 3]  # by the spin speed
    assert np.abs(found - expected).max() < 1e-4 * np.abs(expected).max()
