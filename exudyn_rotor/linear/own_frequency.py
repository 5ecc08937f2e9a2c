"""Free motions on supports whose coefficients depend on the frequency of the motion itself.

Coefficients of steady motions are taken for growing and decaying ones. With the coefficients of a
frequency ω the k motions at a spin speed have eigenvalues λ_j in the order of |Im λ|, in which they
are continuous in ω: the motion j is found where ``|Im λ_j(ω)| − ω`` first changes its sign.
"""

from __future__ import annotations

import warnings

import numpy as np

from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.equations import PeriodicSystem
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.solve.motions import REAL, Motions, joined_motions, motions_of

_TOLERANCE, _ENOUGH = 1e-10, 1e-6  # of a frequency: what is aimed at, and what counts as found
_STILL = 1e-6  # of the largest motion of a support: none
_MOST = 20  # rounds


def own_motions(model: LinearModel, stack: PeriodicSystem) -> Motions:
    """Return the motions of a model at the speeds of a stack; NaN where that is.

    In the motions of :attr:`LinearModel.moving_basis`. A motion that is not found is NaN, with one
    warning for all.
    """
    speeds, known = stack.speed, np.flatnonzero(stack.known)
    parts = [_at_speed(model, float(speed)) for speed in speeds[known]]
    lost = sum(int(np.isnan(part.values).sum()) for part in parts)
    if lost:
        warnings.warn(
            f"{lost} motions on coefficients over the frequency do not settle at their own "
            "frequency and are NaN; are the tables smooth?",
            UserWarning,
            stacklevel=user_level(),
        )
    return joined_motions(speeds, list(zip(known[:, None], parts, strict=True)))


def met(model: LinearModel, found: Motions) -> np.ndarray:
    """Return the frequencies > 0 [rad/s] of motions that move a support with tables over it."""
    assembly, used, shapes = model.assembly(1.0), [], found.main
    for element, U in zip(assembly.elements, assembly.motions, strict=True):
        if element.table_frequencies.size:
            acted = np.any(element.matrices(float(found.speeds[found.known[0]]))[0], axis=0)
            moved = np.linalg.norm(U[0].real[acted] @ shapes, axis=1)
            moves = moved > _STILL * np.nanmax(moved, initial=0.0)
            values = found.values[moves & (np.abs(found.values.imag) > REAL * np.abs(found.values))]
            used.append(np.abs(values.imag))
    return np.concatenate(used)


def _at_speed(model: LinearModel, speed: float) -> Motions:
    """Return the motions at one speed, each with the coefficients of its own frequency."""
    ends, basis = model.table_frequencies[[0, -1]], model.moving_basis
    wanted = np.unique([*ends, min(max(abs(speed), ends[0]), ends[1])])
    samples, parts = np.zeros(0), []
    for sweep in range(_MOST):
        systems = model.at_all(np.full(len(wanted), speed), wanted)
        parts.append(motions_of(systems if basis is None else systems.projected(basis)))
        samples = np.concatenate([samples, wanted])
        values = np.concatenate([part.values for part in parts])
        # beyond the ends of the tables nothing changes: a motion there has its coefficients
        gap = np.clip(np.abs(values.imag), *ends) - samples[:, None]
        done = np.abs(gap) <= _TOLERANCE * np.maximum(samples[:, None], 1e-300)
        open_ = ~np.any(done, axis=0)
        wanted = np.setdiff1d(_next(samples, gap[:, open_], sweep), samples)
        if not wanted.size:
            break
    # motions of one frequency have one sample, for their shapes are apart there
    first = np.where(open_, np.argmin(np.abs(gap), axis=0), np.argmax(done, axis=0))
    columns = np.arange(len(first))
    lost = np.abs(gap[first, columns]) > _ENOUGH * samples[first]
    values = np.where(lost, complex(np.nan, np.nan), values[first, columns])
    vectors = np.concatenate([part.vectors for part in parts])[first, :, :, columns]  # (k, h, c)
    bound = np.array([max(part.bounds.max() for part in parts)])
    orders = parts[0].orders
    return Motions(
        np.array([speed]), values[None], np.moveaxis(vectors, 0, -1)[None], orders, bound
    )


def _next(samples: np.ndarray, gap: np.ndarray, sweep: int) -> np.ndarray:
    """Return where the gaps (n, m) at samples (n,) may vanish: in their lowest change of sign."""
    order = np.argsort(samples)
    x, h = samples[order], gap[order]
    change = (h[:-1] > 0.0) & (h[1:] < 0.0)
    low = np.argmax(change, axis=0)
    columns = np.arange(h.shape[1])
    a, b, ha, hb = x[low], x[low + 1], h[low, columns], h[low + 1, columns]
    share = 0.5 if sweep % 3 == 2 else ha / (ha - hb)  # halves where secants are slow
    return a + share * (b - a)
