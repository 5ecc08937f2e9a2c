"""Points of branches as a result: motions of places, forces, and where runs begin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from exudyn_rotor.bearings.rolling import RollingBearing, contacts
from exudyn_rotor.linear.model.assembly import rotors_of
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.loads import At, Place, places
from exudyn_rotor.nonlinear.continuation import Point
from exudyn_rotor.nonlinear.periodic_result import PeriodicResponse
from exudyn_rotor.nonlinear.rest import Waves

_ROUND = 1e-12  # share of the largest harmonic


def collected(
    branches: Sequence[Sequence[Point]], label: str, asked: Sequence[At] | None
) -> PeriodicResponse:
    """Return a result of the points of branches."""
    points = [point for branch in branches for point in branch]
    rests = [point.balance.rest for point in points]
    model = rests[0].unloaded.model
    known: dict[tuple, list[Place]] = {}
    motions, own = [], []
    for point, rest in zip(points, rests, strict=True):
        key = rest.unloaded.model, bool(rest.speed)
        if key not in known:
            known[key] = places(rest.unloaded.model, asked, rest.speed)
        coordinates = point.balance.coordinates(point.c)
        motions.append(_seen(coordinates, known[key], rest.revolutions))
        own.append(_in_rotor_axes(rest.unloaded.model, coordinates, rest.revolutions))
    observed = known[model, bool(rests[0].speed)]
    orders, motion = _stacked(motions)
    motion = np.swapaxes(motion, 1, 2)
    motion[:, [one.is_node for one in observed], :, 3:] = np.nan
    of_run, beside = (np.zeros((0, 2), dtype=int), None), ()
    if all(each is not None for each in own):
        of_run = _stacked([_half(each) for each in own])
        beside = model.coordinates[model.bodies[0].size :]
    measured = np.array([_at_bearings(point) for point in points])  # (p, 3, b)
    return PeriodicResponse(
        tuple(one.label for one in observed),
        np.array([point.value for point in points]),
        np.repeat(np.arange(len(branches)), [len(branch) for branch in branches]),
        tuple(point.kind for point in points),
        np.array([rest.speed for rest in rests]),
        np.array([rest.rates for rest in rests]),
        orders,
        motion,
        tuple(points[0].balance.laws.names),
        *np.moveaxis(measured, 1, 0),
        np.array([point.error for point in points]),
        np.array([point.growth for point in points]),
        np.array([point.multiplier for point in points], dtype=complex),
        rests[0].revolutions,
        label,
        of_run[0],
        coordinates=of_run[1],
        beside=beside,
    )


def _seen(coordinates: Waves, observed: Sequence[Place], revolutions: int) -> Waves:
    """Return the harmonics of places (p, 6) in axes that stand still, of one sign."""
    found: Waves = {}
    for m in {m for one in observed for m in one.seen}:
        none = np.zeros_like(next(iter(observed[0].seen.values())))
        U = np.array([one.seen.get(m, none) for one in observed])
        for (k, n), x in coordinates.items():
            order = k, n + revolutions * m
            if order >= (0, 0):
                found[order] = found.get(order, 0.0) + U @ x
    return _half(found)


def _half(both: Mapping[tuple[int, int], np.ndarray]) -> Waves:
    """Return harmonics of ``Re Σ`` from those of both signs."""
    return {
        order: a * (1.0 if order == (0, 0) else 2.0) for order, a in both.items() if order >= (0, 0)
    }


def _stacked(motions: Sequence[Waves]) -> tuple[np.ndarray, np.ndarray]:
    """Return the orders (h, 2) that matter anywhere, and harmonics (p, h, …)."""
    orders = sorted({order for motion in motions for order in motion})
    zero = np.zeros_like(next(iter(motions[0].values())))
    found = np.array([[motion.get(order, zero) for order in orders] for motion in motions])
    sizes = np.abs(found).reshape(*found.shape[:2], -1).max(axis=(0, 2))
    matters = sizes > _ROUND * sizes.max()
    matters[0] |= not np.any(matters)
    return np.array(orders)[matters], found[:, matters]


def _at_bearings(point: Point) -> np.ndarray:
    """Return largest forces, smallest gaps, largest loads of elements, (3, b)."""
    balance, laws = point.balance, point.balance.laws
    motion = balance.motion(point.c)
    forces = laws.along(motion, *balance.phases, balance.rest.speed)[0]
    found = []
    for b, one in enumerate(laws.bearings):
        q, gap, load = motion[:, b, :2], one.clearance_along(), np.nan
        least = gap - np.linalg.norm(q, axis=1).max() if np.isfinite(gap) else np.nan
        if isinstance(one, RollingBearing):
            angles = laws.ratios[b] * balance.phases[0] / laws.passes
            load = contacts(one, q, angles)[0].max()
        found.append((np.linalg.norm(forces[:, b], axis=-1).max(), least, load))
    return np.array(found).T


def _in_rotor_axes(model: LinearModel, coordinates: Waves, revolutions: int) -> Waves | None:
    """Return coordinates of the reduced rotor, in its own axes, and of what is beside it.

    None where supports have coordinates of their own that turn.
    """
    rotor, *others = model.bodies
    own = not model.turns and any(hasattr(body, "rows") for body in others)
    if own or len(rotors_of(model.bodies)) > 1:
        return None
    # from axes that stand still, x = exp(−Nθ) η
    found, waves = {}, rotor.by_wave(np.eye(len(rotor.Q)))
    for (k, n), x in coordinates.items():
        for wave, U in waves.items():
            order = k, n - revolutions * wave
            part = np.r_[U @ x[: rotor.size], (wave == 0) * x[rotor.size :]]
            found[order] = found.get(order, 0.0) + part
    return found
