"""Scenes for checks of runs: a rotor on two bearings, and short solutions."""

import exudyn as exu

from exudyn_rotor import add_rotor


def scene(reduced, translation, stiffness=(2e6, 2e6, 2e6), **options):
    """Return an mbs with the rotor of ``models.disc_on_shaft`` on two bearings, not assembled."""
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, translation=translation, **options)
    ground = mbs.CreateGround()
    for name, z in (("left", 0.0), ("right", 0.5)):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body.marker(name)],
            localPosition0=[0, 0, z],
            stiffness=list(stiffness),
            damping=[500.0] * 3,
        )
    return mbs, body


def solve(mbs, steps, end_time, period=None, **options):
    """Run the implicit solver, or that of `options`; `period` is that of sensors, every step."""
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = end_time
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = period or end_time / steps
    mbs.SolveDynamic(settings, **options)


def item_counts(mbs):
    data = mbs.systemData
    return [
        getattr(data, f"NumberOf{kind}")()
        for kind in ("Nodes", "Objects", "Markers", "Loads", "Sensors")
    ]
