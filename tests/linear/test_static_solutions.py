"""Static solutions in which forces are left, and one without any at its start."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import CoordinateConstraint, MarkerNodeCoordinate, NodePointGround
from rings import rings

from exudyn_rotor import Support, add_rotor, add_supports

GRAVITY = 9.81


def static(mbs):
    settings = exu.SimulationSettings()
    settings.staticSolver.verboseMode = 0
    settings.solution.file.write = False
    return mbs.SolveStatic(settings)


def test_a_free_spin_that_the_static_solver_flings_about_is_refused():
    """Unbalance 1e-7 rad above the horizontal holds the angle by 1e-7 of its moment.

    By 1e-3 of it Newton's method goes to 2.5e5 rad, and ends 0.4 rad beside an equilibrium. It
    begins with deflected bearings: with the rotor on its axis nothing at all holds the angle.
    """
    for angle, refused in ((1e-7, True), (1e-3, True), (5e3 * np.pi + 0.5, False)):
        mbs = exu.SystemContainer().AddSystem()
        rotor = rings(heavy=0.01).reduce(0)
        body = add_rotor(mbs, rotor, gravity=[0.0, -GRAVITY, 0.0], initial_angle=angle)
        add_supports(body, [Support(name, 1e6 * np.eye(3)) for name in ("left", "right")])
        mbs.Assemble()
        before = np.array(mbs.systemData.GetODE2Coordinates())
        before[:3] = 0.0  # the centre of mass where it is at the angle 0
        mbs.systemData.SetODE2Coordinates(before, exu.ConfigurationType.Initial)
        mbs.systemData.SetODE2Coordinates(before)
        if refused:
            with pytest.raises(ValueError, match=r"N are left of 49 N.*use spin=0"):
                static(mbs)
            np.testing.assert_array_equal(mbs.systemData.GetODE2Coordinates(), before)
        else:  # the heavy spot above or below
            static(mbs)
            assert np.cos(body.coordinates()[0][3]) == pytest.approx(0.0, abs=1e-4)


def test_static_solution_by_a_prescribed_displacement_stays():
    """Forces at its start are zero, and those at its end the reaction of a constraint."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rings().reduce(0), spin=40.0)
    add_supports(body, [Support(name, 1e6 * np.eye(3)) for name in ("left", "right")])
    ground = mbs.AddMarker(
        MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0)
    )
    along = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=body.nodes["rigid"], coordinate=2))
    mbs.AddObject(CoordinateConstraint(markerNumbers=[ground, along], offset=1e-2))
    mbs.Assemble()
    assert static(mbs)
    assert mbs.systemData.GetAECoordinates() == pytest.approx([2e4])


def test_a_full_body_is_told_of_the_reduced_one():
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, rings(), spin=40.0, gravity=[0.0, -GRAVITY, 0.0])
    add_supports(body, [Support(name, 1e6 * np.eye(3)) for name in ("left", "right")])
    mbs.Assemble()
    with pytest.raises(ValueError, match=r"with the reduced rotor, .* steady_state\(body\) finds"):
        static(mbs)
