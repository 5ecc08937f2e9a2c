"""Solver settings that suit a rotor in its rotating frame."""

from __future__ import annotations

import math

import exudyn

from exudyn_rotor.multibody.inputs import number

_LOOSEST, _TIGHTEST = 1e-5, 1e-9


def recommended_settings(
    end_time: float,
    step: float,
    *,
    accuracy: float = 1e-4,
    settings: exudyn.SimulationSettings | None = None,
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

    Raises
    ------
    ValueError
        For a value that is not positive and finite, or a step longer than the simulation.

    Notes
    -----
    What is changed under ``timeIntegration``, and what it does (two bearings, by
    ``python validation/ablation.py`` and ``python validation/speed.py``):

    ``newton.useModifiedNewton`` : True
        The Jacobian is kept over many steps. Full Newton needs fewer iterations, but a step costs
        twice as much with 10 modes and ten times as much with 20 modes and rigid markers.
    ``newton.relativeTolerance`` : a tenth of `accuracy`, from 1e-9 to 1e-5
        The default, 1e-8, iterates far below the error of the step size; 1e-5 changes the motion
        by 1e-5 of its size and saves a third of the iterations.
    ``newton.absoluteTolerance`` : a hundredth of the relative one
        Decides where nothing moves.
    ``newton.modifiedNewtonContractivity`` : 0.1
        The Jacobian is renewed when an iteration gains less than a digit. This costs nothing in a
        rotor with its frame in the centre of mass, and keeps iterations few where supports seen
        from the rotor turn.
    """
    if not (settings is None or isinstance(settings, exudyn.SimulationSettings)):
        raise TypeError(f"settings: needs exudyn.SimulationSettings, got {type(settings).__name__}")
    for value, name, unit in ((end_time, "end_time", "s"), (step, "step", "s")):
        if not number(value, name, unit) > 0.0:
            raise ValueError(f"{name}: must be positive [s], got {value!r}")
    if step > end_time:
        raise ValueError(f"step: {step!r} s is longer than end_time, {end_time!r} s")
    if not 0.0 < number(accuracy, "accuracy", "1") < 1.0:
        raise ValueError(f"accuracy: needs a share between 0 and 1, got {accuracy!r}")
    settings = exudyn.SimulationSettings() if settings is None else settings
    integration, newton = settings.timeIntegration, settings.timeIntegration.newton
    integration.endTime = end_time
    integration.numberOfSteps = math.ceil(end_time / step - 1e-6)
    tolerance = min(max(0.1 * accuracy, _TIGHTEST), _LOOSEST)
    newton.useModifiedNewton = True
    newton.relativeTolerance = tolerance
    newton.absoluteTolerance = 1e-2 * tolerance
    newton.modifiedNewtonContractivity = 0.1
    return settings
