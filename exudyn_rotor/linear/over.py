"""Motions over speeds: what Campbell diagrams, stability and maps have in common."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.equations import PeriodicSystem
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.solve.motions import Motions, margins_of, motions_of
from exudyn_rotor.threads import one_thread

_AT_ONCE = 2_000_000  # entries of matrices that are made at once


def systems_at(model: LinearModel, speeds: Sequence[float]) -> list[PeriodicSystem | None]:
    """Return the equations at speeds [rad/s]; None where there are none, with one warning."""
    stack = model.at_all(speeds)
    return [stack[i] if known else None for i, known in enumerate(stack.known)]


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
) -> list[Motions | None]:
    """Return the motions of a model at speeds [rad/s]; None where it has no equations.

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
    speeds = np.asarray(speeds, dtype=float)
    count = max(1, _AT_ONCE // (2 * model.size) ** 2)
    basis, neutral = model.moving_basis, model.neutral_motions
    if held:
        neutral = neutral[:, : neutral.shape[1] - model.free_spins.shape[1]]
    systems = systems_at(model, speeds)
    found: list[Motions | None] = []
    parts = range(0, len(speeds), 1 if progress else count)
    if progress:
        from tqdm import tqdm

        parts = tqdm(parts, desc=label or None)
    for first in parts:
        few = systems[first : first + (1 if progress else count)]
        if basis is not None:
            few = [None if system is None else system.projected(basis) for system in few]
        solved = motions_of(few, method, tolerance, least_stable=least_stable)
        found += solved if basis is None else [_in_all(each, basis, neutral) for each in solved]
    _warn_of_lost([each for each in found if each is not None])
    return found


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
    speeds = np.asarray(speeds, dtype=float)
    basis, count = model.moving_basis, max(1, _AT_ONCE // (2 * model.size) ** 2)
    margins = np.full(len(speeds), np.nan)
    systems = [
        system if basis is None or system is None else system.projected(basis)
        for system in systems_at(model, speeds)
    ]
    known = [i for i, system in enumerate(systems) if system is not None]
    for first in range(0, len(known), count):
        few = known[first : first + count]
        margins[few] = margins_of([systems[i] for i in few], method, tolerance)
    return margins


def _warn_of_lost(motions: Sequence[Motions]) -> None:
    """Warn of motions of periodic equations that were not found."""
    speeds = [each.speed for each in motions if np.any(np.isnan(each.values))]
    if not speeds:
        return
    shown = ", ".join(f"{speed:.4g}" for speed in speeds[:5]) + (" …" if len(speeds) > 5 else "")
    warnings.warn(
        f"the harmonics of an uneven rotor on uneven supports do not converge for all motions at "
        f"{shown} rad/s, which are NaN there: at a speed that is small beside the difference of "
        "the frequencies in the rotor's two planes they are too many",
        UserWarning,
        stacklevel=user_level(),
    )


def _in_all(motions: Motions | None, basis: np.ndarray, neutral: np.ndarray) -> Motions | None:
    """Return motions of a basis in all coordinates, after neutral ones with λ = 0."""
    if motions is None:
        return None
    vectors = np.einsum("ck,hkj->hcj", basis, motions.vectors)
    still = np.zeros((len(motions.orders), *neutral.shape), dtype=complex)
    still[list(motions.orders).index(0)] = neutral / np.linalg.norm(neutral, axis=0)
    values = np.r_[np.zeros(neutral.shape[1]), motions.values]
    joined = np.concatenate([still, vectors], axis=2)
    return Motions(motions.speed, values, joined, motions.orders, motions.bound)
