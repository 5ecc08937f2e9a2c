"""Solver settings that suit a rotor in its rotating frame."""

from __future__ import annotations

import math

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

_LOOSEST, _TIGHTEST = 1e-5, 1e-9
# of the tolerance, for a full body: its elements' forces are larger than those of the motion, and
# those of interfaces that discs hold rigid by a hundred times more
_OF_FULL = 1e-3
_COORDINATE = 0.01  # m, Exudyn's default
_MOST_STEPS = 2**31  # Exudyn counts steps with 32 bits


def recommended_settings(
    end_time: float,
    step: float,
    *,
    accuracy: float = 1e-4,
    settings: exudyn.SimulationSettings | None = None,
    body: RotorItems | None = None,
) -> exudyn.SimulationSettings:
    """Return settings for the implicit solver, matched to a wanted accuracy.

    Parameters
    ----------
    end_time, step : float
        Duration and largest step size [s]; the steps are made equal.
    accuracy : float
        Share of the motion's size that errors of Newton's method may reach. The error of the step
        size is another matter; :func:`exudyn_rotor.propose` proposes a step.
    settings : exudyn.SimulationSettings, optional
        Settings to change and return; Exudyn's defaults otherwise.
    body : RotorBody or FullRotorBody, optional
        The rotor of the run; give it where it is a full one, which needs a sparse linear solver, or
        a small one: mass times length below 1 kg m.

    Raises
    ------
    TypeError, ValueError
        For a value that is not positive and finite, or a step longer than the simulation.

    Notes
    -----
    What is changed under ``timeIntegration``, and what it does (two bearings, by
    ``python -m validation speed``):

    ``newton.useModifiedNewton`` : True
        The Jacobian is kept over many steps. Full Newton needs fewer iterations, but a step costs
        twice as much with 10 modes and ten times as much with 20 modes and rigid markers.
    ``newton.relativeTolerance`` : a tenth of `accuracy`, from 1e-9 to 1e-5
        The default, 1e-8, iterates far below the error of the step size; 1e-5 changes the motion
        by 1e-5 of its size and saves a third of the iterations. For a full body a thousandth of
        that: it is a share of the forces, which are those of the elements there.
    ``newton.absoluteTolerance`` : a hundredth of the relative one of a reduced body
        Decides where nothing moves. It is a force [N], so that without `body` it is that of a rotor
        of a metre and some kilograms: the forces of a rotor of a millimetre are below it, and
        contacts and films would not be iterated. With a `body` of the mass m and the length L it is
        less by the share ``m L`` of 1 kg m, as forces are that accelerate it through its length,
        and not below what rounding in Exudyn's positions leaves of the forces of linear supports:
        ten times 2.2e-16 of their stiffness and the distance from the origin. Newton's method ends
        nowhere below that, and Exudyn takes ever smaller steps. Add the supports before.
    ``newton.numericalDifferentiation.minimumCoordinateSize`` : 0.01, times L/1 m where that is less
        With a `body` only. Exudyn differentiates Python functions by a step of 1e-7 of this [m],
        which has to be small beside the depth of a contact.
    ``newton.modifiedNewtonContractivity`` : 0.1
        The Jacobian is renewed when an iteration gains less than a digit. This costs nothing in a
        rotor with its frame in the centre of mass, and keeps iterations few where supports seen
        from the rotor turn.

    Under ``linearSolver``, for a full body: ``solverType`` is ``EigenSparse``, which factorises the
    Jacobian once where the equations are constant.

    Examples
    --------
    >>> from exudyn_rotor import recommended_settings
    >>> settings = recommended_settings(end_time=0.1, step=1e-4, accuracy=1e-4)
    >>> int(settings.timeIntegration.numberOfSteps)
    1000
    >>> settings.timeIntegration.newton.relativeTolerance
    1e-05
    """
    if settings is not None:
        checks.instance(settings, "settings", exudyn.SimulationSettings)
    if body is not None:
        checks.instance(body, "body", RotorItems, "add_rotor returned it")
    end_time = checks.number(end_time, "end_time", "s", above=0.0)
    step = checks.number(step, "step", "s", above=0.0)
    if step > end_time:
        raise ValueError(f"step: {step!r} s is longer than end_time, {end_time!r} s")
    if not end_time / step < _MOST_STEPS:
        raise ValueError(f"step: {step} s makes {end_time / step:.3g} steps; give a longer one")
    accuracy = checks.tolerance(accuracy, "accuracy")
    settings = exudyn.SimulationSettings() if settings is None else settings
    integration, newton = settings.timeIntegration, settings.timeIntegration.newton
    integration.endTime = end_time
    integration.numberOfSteps = math.ceil(end_time / step - 1e-6)
    tolerance = min(max(0.1 * accuracy, _TIGHTEST), _LOOSEST)
    newton.useModifiedNewton = True
    newton.relativeTolerance = tolerance
    newton.absoluteTolerance = 1e-2 * tolerance
    newton.modifiedNewtonContractivity = 0.1
    if body is not None:
        length, mass = _size(body), body.motion.invariants.mass
        newton.absoluteTolerance *= min(1.0, mass * length)
        newton.absoluteTolerance = max(newton.absoluteTolerance, _rounding(body))
        newton.numericalDifferentiation.minimumCoordinateSize = _COORDINATE * min(1.0, length)
    if isinstance(body, FullRotorBody):
        settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
        newton.relativeTolerance = max(_OF_FULL * tolerance, _TIGHTEST)
    return settings


def _rounding(body: RotorItems) -> float:
    """Return what rounding in positions leaves of the forces of linear supports, tenfold [N]."""
    place = body.placement
    linear = [each.support for each in body.supports if isinstance(each.support, Support)]
    matrices = [support.matrices(place.speed)[0] for support in linear]
    across, about = (
        max((np.linalg.norm(K[rows, rows], 2) for K in matrices), default=0.0)
        for rows in (slice(3), slice(3, 6))
    )
    ends = [body.axis.project(one.reference) for one in body.selection.source.interfaces.values()]
    far = max((np.linalg.norm(place.position + place.rotation @ end) for end in ends), default=0.0)
    return 10.0 * float(np.finfo(float).eps * max(far * across, about))


def _size(body: RotorItems) -> float:
    """Return how far an interface is from the centre of mass at most, or the radius of gyration."""
    rotor, inv = body.selection.source, body.motion.invariants
    places = [one.reference - rotor.center_of_mass for one in rotor.interfaces.values()]
    distances = np.linalg.norm(np.reshape(places, (-1, 3)), axis=1)
    return float(distances.max(initial=math.sqrt(inv.Theta / inv.mass)))
