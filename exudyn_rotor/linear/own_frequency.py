"""Free motions on supports whose coefficients depend on the frequency of the motion itself.

At a given spin speed the k motions of the equations with the coefficients of a frequency ω have
eigenvalues, in the order of |Im λ|. That of the place j is found where

    |Im λ_j(ω)| = ω,

by the textbook's convention that coefficients of steady motions hold for growing and decaying ones.
In this order |Im λ_j| is continuous in ω, so that each place has such a frequency between two
at which the difference changes its sign; of several the lowest is taken.
"""

from __future__ import annotations

import warnings

import numpy as np

from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.equations import PeriodicSystem, joined
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.solve.motions import Motions, motions_of

_TOLERANCE, _ENOUGH = 1e-10, 1e-6  # of a frequency: what is aimed at, and what counts as found
_STILL = 1e-6  # of the largest motion of a support: none
_MOST = 20  # rounds


def own_motions(model: LinearModel, stack: PeriodicSystem) -> Motions:
    """Return the motions of a model at the speeds of a stack; NaN where that is.

    In the motions of :attr:`LinearModel.moving_basis`. A motion that is not found is NaN, with one
    warning for all.
    """
    basis = model.moving_basis
    found, lost = [], 0
    for place, known in enumerate(stack.known):
        if known:
            found.append(_at_speed(model, float(stack.speed[place]), basis))
            lost += int(np.sum(np.isnan(found[-1].values)))
        else:
            found.append(None)
    solved = next(one for one in found if one is not None)
    missing = _without_values(solved)
    parts = [missing if one is None else one for one in found]
    if lost:
        warnings.warn(
            f"{lost} motions on coefficients over the frequency do not settle at their own "
            "frequency and are NaN; are the tables smooth?",
            UserWarning,
            stacklevel=user_level(),
        )
    values, vectors = (
        np.concatenate([getattr(p, n) for p in parts]) for n in ("values", "vectors")
    )
    bounds = np.concatenate([part.bounds for part in parts])
    return Motions(stack.speed, values, vectors, solved.orders, bounds)


def met(model: LinearModel, found: Motions) -> np.ndarray:
    """Return the frequencies > 0 [rad/s] of motions that move a support with tables over it."""
    basis = np.eye(model.size) if model.moving_basis is None else model.moving_basis
    assembly, used = model.assembly(1.0), []
    shapes = np.einsum("ck,shkm->scm", basis, found.vectors)
    for element, U in zip(assembly.elements, assembly.motions, strict=True):
        if element.table_frequencies.size:
            acted = np.any(element.matrices(float(found.speeds[found.known[0]]))[0], axis=0)
            moved = np.linalg.norm(U[0].real[acted] @ shapes, axis=1)
            moves = moved > _STILL * np.nanmax(moved, initial=0.0)
            used.append(np.abs(found.values.imag[moves]))
    used = np.concatenate(used)
    return used[used > 0.0]


def _without_values(like: Motions) -> Motions:
    none = (np.full(X.shape, np.nan, dtype=X.dtype) for X in (like.values, like.vectors))
    return Motions(like.speeds, *none, like.orders, np.array([np.nan]))


def _at_speed(model: LinearModel, speed: float, basis: np.ndarray | None) -> Motions:
    """Return the motions at one speed, each with the coefficients of its own frequency."""
    ends = model.table_frequencies[[0, -1]]
    wanted = np.unique([*ends, min(max(abs(speed), ends[0]), ends[1])])
    samples, solved = np.zeros(0), None
    for sweep in range(_MOST):
        part = _solved(model, speed, wanted, basis)
        samples = np.concatenate([samples, wanted])
        solved = part if solved is None else after(solved, part)
        imag = np.abs(solved.values.imag)
        # beyond the ends of the tables nothing changes: a motion there has its coefficients
        gap = np.clip(imag, *ends) - samples[:, None]
        done = np.abs(gap) <= _TOLERANCE * np.maximum(samples[:, None], 1e-300)
        open_ = ~np.any(done, axis=0)
        if not np.any(open_):
            break
        wanted = np.unique(_next(samples, gap[:, open_], sweep))
        wanted = np.setdiff1d(wanted, samples)
        if not wanted.size:
            break
    # motions of one frequency have one sample, for their shapes are apart there
    first = np.where(open_, np.argmin(np.abs(gap), axis=0), np.argmax(done, axis=0))
    columns = np.arange(len(first))
    lost = np.abs(gap[first, columns]) > _ENOUGH * samples[first]
    values = np.where(lost, complex(np.nan, np.nan), solved.values[first, columns])
    vectors = solved.vectors[first, :, :, columns]  # (k, h, c)
    vectors = np.moveaxis(vectors, 0, -1)[None]
    bound = solved.bounds.max(keepdims=True)
    return Motions(np.array([speed]), values[None], vectors, solved.orders, bound)


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


def _solved(
    model: LinearModel, speed: float, frequencies: np.ndarray, basis: np.ndarray | None
) -> Motions:
    """Return the motions with the coefficients of frequencies, (s, k)."""
    stack = joined([model.at(speed, float(each)) for each in frequencies])
    return motions_of(stack if basis is None else stack.projected(basis))


def after(one: Motions, other: Motions) -> Motions:
    """Return motions of constant equations one after the other."""
    each = ("speeds", "values", "vectors", "bounds")
    speeds, values, vectors, bounds = (
        np.concatenate([getattr(one, n), getattr(other, n)]) for n in each
    )
    return Motions(speeds, values, vectors, one.orders, bounds)
