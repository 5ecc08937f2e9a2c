"""Runs the simulations of the trade-off and measures errors, their parts, and times."""

from __future__ import annotations

from collections.abc import Sequence

from tqdm import tqdm

from validation.exudyn_3d.against_3d import SUPPORTS, compare
from validation.exudyn_3d.scenes import Model, disc_on_shaft
from validation.trade.error import Motion, Row, errors
from validation.trade.plan import bodies
from validation.trade.scene import (
    CONSTANT_SPEED,
    CRAIG_BAMPTON,
    FIXED_AXIS,
    STANDARD,
    VIRTUAL,
    Body,
    Config,
    Rotor,
    Scene,
)

AXES = ("lateral", "axial", "rim")
USERS = "3D as users write it"
_LONG = 2.0  # s


class Bench:
    """One rotor with its scenes; each is built once and simulated as often as needed.

    Exudyn starts every simulation from the initial state that the scene was built with.
    """

    def __init__(self, rotor: Rotor) -> None:
        self.rotor = rotor
        self._scenes: dict[Body, Scene] = {}

    def scene(self, body: Body) -> Scene:
        """Return the scene of a body."""
        if body not in self._scenes:
            self._scenes[body] = Scene(self.rotor, body)
        return self._scenes[body]

    def converged(self, body: Body, steps: int, **options) -> tuple[Motion, float]:
        """Return the motion extrapolated to the step zero, and how far it is converged.

        Simulates with `steps`, twice, and four times as many between samples, almost to
        round-off. The second value is the distance between the extrapolations from the first
        and from the last two of them, relative to the motion: a bound of the last one's error.
        """
        scene = self.scene(body)
        ladder = tqdm((steps, 2 * steps, 4 * steps), desc=f"limit, {body.family}", leave=False)
        coarse, fine, finest = (scene.run(n, "tight", **options)[0] for n in ladder)
        limit = fine.extrapolated(finest)
        return limit, errors(coarse.extrapolated(fine), limit)["total"]


def measure(
    bench: Bench, configs: Sequence[Config], reference: Motion, repeats: int, **options
) -> list[Row]:
    """Return one row per simulation: what it was, its errors, and its shortest time.

    The repeats are interleaved, so that a busy spell of the machine spoils one of them at most.
    What takes long is run once.

    Parameters
    ----------
    bench : Bench
    configs : sequence of Config
    reference : Motion
    repeats : int
    **options
        Of :meth:`trade_scene.Scene.run`.
    """
    for body in tqdm(bodies(configs), desc="set-up", unit="scene"):
        bench.scene(body)
    shortest: dict[Config, float] = {}
    found: dict[Config, dict[str, float]] = {}
    with tqdm(total=repeats * len(configs), desc="runs", unit="run") as progress:
        for _ in range(repeats):
            for config in configs:
                if shortest.get(config, 0.0) > _LONG:
                    progress.update()
                    continue
                scene = bench.scene(config.body)
                motion, seconds = scene.run(config.steps, config.solver, **options)
                shortest[config] = min(seconds, shortest.get(config, seconds))
                found[config] = errors(motion, reference)
                progress.update()
    return [_row(bench, one, found[one], shortest[one]) for one in configs]


def _row(bench: Bench, config: Config, found: dict[str, float], seconds: float) -> Row:
    body = config.body
    return {
        "group": group(config),
        "family": body.family,
        "basis": body.basis,
        "modes": body.modes,
        "stiffening": body.stiffening,
        "markers": body.markers,
        "solver": config.solver,
        "step": config.step,
        **found,
        "seconds": seconds,
        "set-up": bench.scene(body).set_up,
    }


def group(config: Config) -> str:
    """Return the name under which a simulation competes."""
    family, plain = config.body.family, config.solver == "default"
    if family == STANDARD:
        return USERS if plain else "3D, all face nodes, other settings"
    if plain and config.body.markers == "rigid":
        return f"{family}, another call only"
    return family


def contributions(
    bench: Bench, reference: Motion, modes: int, steps: int = 50, torque: float = 0.0
) -> list[Row]:
    """Return what the total error of each family is made of, with Craig–Bampton modes.

    ``reduction``
        The 3D body without step error against the reference: modes left out.
    ``formulation``
        The family without step error against the 3D body with the same modes: what a fixed axis
        leaves out.
    ``step``
        The family with the given step size against itself without step error; it grows with the
        square of the step.
    ``limit``
        How far the family without step error is converged.
    """
    rows, three_d = [], None
    for family in (VIRTUAL, *FIXED_AXIS):
        if torque and family == CONSTANT_SPEED:
            continue
        markers = "rigid" if torque else "position"
        body = Body(family, CRAIG_BAMPTON, modes, markers=markers, torque=torque)
        limit, own = bench.converged(body, steps)
        three_d = limit if three_d is None else three_d
        motion, _ = bench.scene(body).run(steps // 2, "tight")
        rows.append(
            {
                "family": family,
                "torque": torque,
                "modes": modes,
                "reduction": errors(three_d, reference)["total"],
                "formulation": errors(limit, three_d)["total"],
                "step size": Config(body, steps // 2).step,
                "step": errors(motion, limit)["total"],
                "limit": own,
            }
        )
    return rows


def tilts(amplitudes: Sequence[float]) -> list[Row]:
    """Return deviations of the fixed-axis body from the 3D body by tilt, without step error.

    The scene is that of ``against_3d.py``: a disc on a shaft, tilted by an impulse at 314 rad/s.
    Everything is relative to the lateral motion.
    """
    model, rows = Model.of(disc_on_shaft(), 8), []
    for amplitude in tqdm(amplitudes, desc="tilts", unit="tilt"):
        found = compare(model, SUPPORTS["anisotropic"], amplitude, 0.02, 2e-5, 100)
        row = next(row for row in found if row["stiffening"] == "tilt")
        rows.append({name: float(row[name]) for name in ("tilt", *AXES, "step error")})
    return sorted(rows, key=lambda row: row["tilt"])
