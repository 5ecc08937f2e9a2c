"""Which simulations to run: one-factor sweeps around sensible centres, and what fronts need."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from validation.trade.scene import (
    CONSTANT_SPEED,
    CRAIG_BAMPTON,
    FIXED_AXIS,
    FREE,
    FREE_FRAME,
    STANDARD,
    TORQUE,
    VIRTUAL,
    Body,
    Config,
)

# steps in the 2 ms from one sample to the next: step sizes from 2 ms to 10 µs
LADDER = (1, 2, 4, 6, 8, 12, 16, 24, 32, 40, 48, 56, 64, 80, 96, 128, 200)
QUICK_LADDER = (2, 8, 16, 32, 96)
CHEAP = (VIRTUAL, *FIXED_AXIS)
CENTRES = (VIRTUAL, FREE_FRAME, CONSTANT_SPEED)
NEAR = (40, 48, 56, 64, 80, 96, 112)  # where errors of 1e-4 are met


def plan(quick: bool = False) -> list[Config]:
    """Return the simulations at constant speed, each once."""
    return _unique(_quick() if quick else [*_users(), *_steps(), *_modes(), *_one_factor()])


def run_up(quick: bool = False) -> list[Config]:
    """Return the simulations with a driving torque; it needs rigid markers."""
    sweeps = {
        STANDARD: ("default", (16,) if quick else (16, 48, 64)),
        VIRTUAL: ("recommended", (16, 32) if quick else (16, 32, 48, 64, 80)),
        FREE_FRAME: ("recommended", (16, 32) if quick else (16, 32, 48, 64, 80, 96)),
    }
    return [
        Config(Body(family, modes=12, torque=TORQUE), steps, solver)
        for family, (solver, ladder) in sweeps.items()
        for steps in ladder
    ]


def bodies(configs: Iterable[Config]) -> list[Body]:
    """Return the bodies of simulations, each once."""
    return list(dict.fromkeys(config.body for config in configs))


def _users() -> list[Config]:
    """Exudyn's own call and solver settings, and the fixed axis with nothing but another call."""
    standard = {
        (CRAIG_BAMPTON, 10): (4, 6, 12, 16),
        (CRAIG_BAMPTON, 12): (1, 4, 8, 12, 16, 24, 48, 56),
        (CRAIG_BAMPTON, 20): (16,),
        (FREE, 12): (8, 12),
    }
    made = [
        Config(Body(STANDARD, basis, modes), steps, "default")
        for (basis, modes), ladder in standard.items()
        for steps in ladder
    ]
    made += [Config(Body(STANDARD, modes=12), 24, s) for s in ("modified Newton", "recommended")]
    return made + [
        Config(Body(family, modes=12), steps, "default")
        for family in CENTRES
        for steps in (6, 8, 12, 24, 32, 40, 48, 56, 64)
    ]


def _steps() -> list[Config]:
    position = {"markers": "position"}
    made = _grid(CHEAP, CRAIG_BAMPTON, (12,), LADDER)
    made += _grid(CHEAP, CRAIG_BAMPTON, (10,), (4, 6, 8, 12, 16))
    made += _grid(CENTRES, CRAIG_BAMPTON, (20,), (*NEAR, 200))
    return made + [Config(Body(f, CRAIG_BAMPTON, 40, **position), 200) for f in CENTRES]


def _modes() -> list[Config]:
    """Numbers and kinds of modes, at a step small enough to see their error alone."""
    made = _grid(CENTRES, FREE, (4, 8, 12, 20, 40), (128,))
    made += _grid(CENTRES, CRAIG_BAMPTON, (8, 10, 12, 20, 40), (128,))
    return made + _grid(CENTRES, FREE, (12, 20), (8, 16))


def _one_factor() -> list[Config]:
    """Solver settings, centrifugal stiffening and kind of the markers, one at a time."""
    centres = [Config(Body(f, modes=12, markers="position"), 64) for f in CENTRES]
    made = [
        Config(one.body, 64, solver)
        for one in centres
        for solver in ("default", "modified Newton", "recommended", "tight")
    ]
    made += [
        Config(Body(family, modes=20, stiffening=level, markers="position"), 96)
        for family in (FREE_FRAME, CONSTANT_SPEED)
        for level in ("none", "tilt", "full")
    ]
    return made + [Config(Body(family, modes=12), 64) for family in CHEAP]


def _quick() -> list[Config]:
    made = _grid(CHEAP, CRAIG_BAMPTON, (12,), QUICK_LADDER)
    made += _grid((FREE_FRAME,), FREE, (4, 12), (96,))
    made += _grid((FREE_FRAME,), CRAIG_BAMPTON, (8, 10), (96,))
    made += [Config(Body(STANDARD, modes=12), steps, "default") for steps in (2, 8, 64)]
    return made + [
        Config(Body(FREE_FRAME, modes=12, stiffening=level, markers="position"), 96)
        for level in ("none", "tilt", "full")
    ]


def _grid(
    families: Sequence[str], basis: str, modes: Sequence[int], ladder: Sequence[int]
) -> list[Config]:
    """Combine families with numbers of modes and steps; position markers, recommended settings."""
    return [
        Config(Body(family, basis, count, markers="position"), steps)
        for family in families
        for count in modes
        for steps in ladder
    ]


def _unique(configs: list[Config]) -> list[Config]:
    return list(dict.fromkeys(configs))
