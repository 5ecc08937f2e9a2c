"""What linear analyses have in common: motions over speeds, warnings, the base of results."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from tqdm import tqdm

from exudyn_rotor.calls import user_level
from exudyn_rotor.checks import one_of
from exudyn_rotor.linear.equations import PeriodicSystem, Terms
from exudyn_rotor.linear.model.linear_model import AXES, LinearModel
from exudyn_rotor.linear.own_frequency import met, own_motions
from exudyn_rotor.linear.solve.forced import forced_motions
from exudyn_rotor.linear.solve.motions import Motions, motions_of
from exudyn_rotor.results import Result, text_table
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.theory.stiffening import LEVELS

NOT_KNOWN = "error of the basis: not known"
_SHOWN = 1e-6  # unevenness that is told


@one_thread()
def motions_over(
    model: LinearModel,
    speeds: Sequence[float],
    *,
    held: bool = False,
    method: str = "auto",
    tolerance: float = 1e-6,
    least_stable: bool = False,
    warns: bool = True,
    progress: bool = False,
    label: str = "",
) -> Motions:
    """Return the motions of a model at speeds [rad/s]; NaN where it has no equations.

    Where a spin that nothing holds is `held`, it follows θ = Ωt and is no motion. The `method`,
    `tolerance` and `least_stable` are those of :func:`motions_of`; the bar of progress has the
    `label`. Where not all motions are shown, it `warns` of none, and :func:`warn_of` does.
    """
    with tqdm(total=len(speeds), desc=label or None, disable=not progress) as bar:
        given = {"held": held, "least_stable": least_stable, "told": bar.update}
        found = motions_in(model, model.at_all(speeds), method, tolerance, warns=False, **given)
    if warns:
        warn_of(model, found, found)
    return found


def warn_of(model: LinearModel, found: Motions, shown: Motions) -> None:
    """Warn of motions that were not `found` or are beyond the tables, of those that are `shown`.

    One that was `found` at no speed counts as shown up to the highest frequency of these.
    """
    never = np.any(np.all(np.isnan(found.values), axis=0))
    highest = np.nanmax(np.abs(shown.values.imag), initial=0.0) if never else -1.0
    missing = shown.speeds[np.isnan(shown.values).any(axis=1)]
    lost = [speed for speed, least in found.lost if least <= highest or speed in missing]
    if lost:
        speeds = ", ".join(f"{speed:.4g}" for speed in lost[:5])
        warnings.warn(
            "the harmonics of an uneven rotor on uneven supports do not converge for all motions "
            f"at {speeds}{' …' * (len(lost) > 5)} rad/s, which are NaN there: at a speed "
            "that is small beside the difference of the frequencies in the rotor's two planes "
            "they are too many",
            UserWarning,
            stacklevel=user_level(),
        )
    if model.over_frequency:
        model.warn_beyond(met(model, shown))


def motions_in(
    model: LinearModel,
    stack: PeriodicSystem,
    method: str,
    tolerance: float,
    *,
    held: bool = False,
    warns: bool = True,
    **given,
) -> Motions:
    """Return the motions of a stack of equations of a model, see :func:`motions_over`.

    It `warns` of motions beyond the tables over the frequency.
    """
    basis, neutral = model.moving_basis, model.neutral_motions
    if held:
        neutral = neutral[:, : neutral.shape[1] - model.free_spins.shape[1]]
    if model.over_frequency:
        found = own_motions(model, stack)
    else:
        stack = stack if basis is None else stack.projected(basis)
        found = motions_of(stack, method, tolerance, **given)
    found = found if basis is None else found.in_all(basis, neutral)
    if warns and model.over_frequency:
        model.warn_beyond(met(model, found))
    return found


def forced_over(
    model: LinearModel,
    speed: float,
    loads: Terms,
    frequencies: np.ndarray,
    **options: Any,
) -> dict[int, np.ndarray]:
    """Return the harmonics (s, k) of steady motions under loads of frequencies (s,) [rad/s].

    At one speed [rad/s]. The harmonic n of the loads, (k,), has the frequencies plus n times the
    speed, and the coefficients of these. The `options` are those of :func:`forced_motions`.
    """
    if not model.over_frequency:
        return forced_motions(model.at(speed), loads, frequencies, **options)
    found = {}
    for n, load in loads.items():
        rates = np.abs(frequencies + n * speed)
        stack = model.at_all(np.full(len(rates), speed), rates)
        found |= forced_motions(stack, {n: load}, frequencies, **options)
    return found


@dataclass(frozen=True, eq=False)
class ModelResult(Result):
    """Result of the analysis of a linear model.

    Attributes
    ----------
    stiffening : str or None
        Level of centrifugal stiffening, 'none', 'tilt' or 'full'; None where it is not known.
    axes : {'inertial', 'rotor'}
        In which the equations were solved.
    unevenness : float
        Largest share of a rotor that differs around its axis, as that of a mesh: in inertial axes
        it was averaged over a turn, in the axes of the rotor it counts.
    """

    stiffening: str | None = one_of(LEVELS, default=None, kw_only=True)
    axes: str = one_of(AXES[1:], default="inertial", kw_only=True)
    unevenness: float = field(default=0.0, kw_only=True)

    def _closing(self, errors: np.ndarray | None) -> list[str]:
        """Return the last lines of a table; `errors` of the basis, None where not known."""
        lines = [f"stiffening: {self.stiffening}"] if self.stiffening else []
        if _SHOWN < self.unevenness < np.inf:
            what = "the mesh, averaged" if self.axes == "inertial" else "the rotor"
            lines.append(f"unevenness of {what}: {self.unevenness:.2g}")
        return lines if errors is not None else [*lines, NOT_KNOWN]


def basis_column(errors: np.ndarray | None, size: int) -> dict[str, np.ndarray]:
    """Return the column of errors of the basis, NaN where they are not known."""
    return {"basis error": np.full(size, np.nan) if errors is None else errors.ravel()}


def table_lines(columns: Mapping[str, np.ndarray], *left_out: str) -> list[str]:
    """Return a table as lines, without some columns, and errors of the basis that are all zero."""
    if not np.any(np.nan_to_num(columns["basis error"])):
        left_out += ("basis error",)
    shown = {name: each for name, each in columns.items() if name not in left_out}
    return text_table({{"nodal diameters": "n"}.get(name, name): shown[name] for name in shown})
