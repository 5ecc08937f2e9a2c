"""Motions over speeds: what Campbell diagrams, stability and maps have in common."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from tqdm import tqdm

from exudyn_rotor.calls import one_thread, user_level
from exudyn_rotor.linear.equations import Terms
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.own_frequency import met, own_motions
from exudyn_rotor.linear.solve.forced import forced_motions
from exudyn_rotor.linear.solve.motions import Motions, margins, margins_of, motions_of


@one_thread()
def motions_over(
    model: LinearModel,
    speeds: Sequence[float],
    *,
    held: bool = False,
    method: str = "auto",
    tolerance: float = 1e-6,
    least_stable: bool = False,
    progress: bool = False,
    label: str = "",
) -> Motions:
    """Return the motions of a model at speeds [rad/s]; NaN where it has no equations.

    Parameters
    ----------
    model : LinearModel
    speeds : sequence of float
    held : bool, optional
        Whether a spin that nothing holds follows θ = Ωt and is no motion.
    method, tolerance, least_stable
        See :func:`motions_of`.
    progress : bool, optional
        Show a progress bar with the `label`.
    """
    stack, basis, neutral = model.at_all(speeds), model.moving_basis, model.neutral_motions
    if held:
        neutral = neutral[:, : neutral.shape[1] - model.free_spins.shape[1]]
    if model.over_frequency:
        found = own_motions(model, stack)
        model.warn_beyond(met(model, found))
        return found if basis is None else found.in_all(basis, neutral)
    if basis is not None:
        stack = stack.projected(basis)
    with tqdm(total=len(stack.speed), desc=label or None, disable=not progress) as bar:
        given = {"least_stable": least_stable, "told": bar.update}
        found = motions_of(stack, method, tolerance, **given)
    _warn_of_lost(found)
    return found if basis is None else found.in_all(basis, neutral)


@one_thread()
def margins_over(
    model: LinearModel,
    speeds: Sequence[float],
    *,
    method: str = "auto",
    tolerance: float = 1e-6,
) -> np.ndarray:
    """Return by how much the least stable motion grows beyond its bound at speeds [1/s], (s,).

    Free spins are held; neutral motions do not count; NaN where the model has no equations.
    """
    stack, basis = model.at_all(speeds), model.moving_basis
    if model.over_frequency:
        found = own_motions(model, stack)
        return margins(found.values, found.bounds)
    return margins_of(stack if basis is None else stack.projected(basis), method, tolerance)


def forced_over(
    model: LinearModel, speed: float, loads: Terms, frequencies: np.ndarray, **options: Any
) -> dict[int, np.ndarray]:
    """Return the harmonics (s, k) of steady motions under loads of frequencies (s,), at one speed.

    Each harmonic has the coefficients of its own frequency.

    Parameters
    ----------
    model : LinearModel
    speed : float
        Spin speed [rad/s].
    loads : mapping of int to ndarray, shape (k,)
        At the frequencies plus multiples of the speed.
    frequencies : ndarray, shape (s,)
        [rad/s]
    **options
        Of :func:`forced_motions`.
    """
    if not model.over_frequency:
        return forced_motions(model.at(speed), loads, frequencies, **options)
    found = {}
    for n, load in loads.items():
        rates = np.abs(frequencies + n * speed)
        stack = model.at_all(np.full(len(rates), speed), rates)
        found |= forced_motions(stack, {n: load}, frequencies, **options)
    return found


def _warn_of_lost(found: Motions) -> None:
    """Warn of motions of periodic equations that were not found."""
    lost = np.any(np.isnan(found.values), axis=1) & ~np.isnan(found.bounds)
    speeds = found.speeds[lost]
    if not speeds.size:
        return
    shown = ", ".join(f"{speed:.4g}" for speed in speeds[:5]) + (" …" if len(speeds) > 5 else "")
    warnings.warn(
        f"the harmonics of an uneven rotor on uneven supports do not converge for all motions at "
        f"{shown} rad/s, which are NaN there: at a speed that is small beside the difference of "
        "the frequencies in the rotor's two planes they are too many",
        UserWarning,
        stacklevel=user_level(),
    )


def warn_of_refused(refused: Sequence[tuple[str, Exception]], count: int) -> None:
    """Warn of points without values; raise the first error where all of `count` have none."""
    if len(refused) == count:
        raise refused[0][1]
    if refused:
        shown = ", ".join(point for point, _ in refused[:5]) + (" …" if len(refused) > 5 else "")
        warnings.warn(
            f"no values at {shown}, which are NaN: {refused[0][1]}",
            UserWarning,
            stacklevel=user_level(),
        )
