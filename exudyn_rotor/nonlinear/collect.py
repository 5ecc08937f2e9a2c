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

Harmonics = dict[tuple[int, int], np.ndarray]
_ROUND = 1e-12  # share of the largest harmonic


def collected(
    points: Sequence[Point], branches: np.ndarray, label: str, asked: Sequence[At] | None
) -> PeriodicResponse:
    """Return a result of points, whose branches have numbers (p,)."""
    rests = [point.balance.rest for point in points]
    model = rests[0].unloaded.model
    known: dict[tuple, list[Place]] = {}
    motions, kept = [], []
    for point, rest in zip(points, rests, strict=True):
        own = rest.unloaded.model
        key = id(own), bool(rest.speed)
        if key not in known:
            known[key] = places(own, asked, rest.speed)
        coordinates = point.balance.coordinates(point.c)
        motions.append(_seen(coordinates, known[key], rest.revolutions))
        kept.append(in_rotor_axes(own, coordinates, rest.revolutions))
    observed = known[id(model), bool(rests[0].speed)]
    orders, motion = _stacked(motions)
    motion = np.swapaxes(motion, 1, 2)
    motion[:, [one.is_node for one in observed], :, 3:] = np.nan
    of_run = {"coordinate_orders": np.zeros((0, 2), dtype=int)}
    if all(each is not None for each in kept):
        coordinate_orders, coordinates = _stacked([_half(each) for each in kept])
        beside = model.coordinates[rotors_of(model.bodies)[0].size :]
        of_run = {
            "coordinate_orders": coordinate_orders, "coordinates": coordinates, "beside": beside,
        }  # fmt: skip
    measured = np.array([_at_bearings(point) for point in points])  # (p, 4, b)
    return PeriodicResponse(
        tuple(one.label for one in observed),
        np.array([point.value for point in points]),
        np.asarray(branches, dtype=int),
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
        **of_run,
    )


def _seen(coordinates: Harmonics, observed: Sequence[Place], revolutions: int) -> Harmonics:
    """Return the harmonics of places (p, 6) in axes that stand still, of one sign."""
    found: Harmonics = {}
    for index, one in enumerate(observed):
        for m, U in one.seen.items():
            for (k, n), x in coordinates.items():
                order = k, n + revolutions * m
                if order >= (0, 0):
                    if order not in found:
                        found[order] = np.zeros((len(observed), 6), dtype=complex)
                    found[order][index] += U @ x
    return _half(found)


def _half(both: Mapping[tuple[int, int], np.ndarray]) -> Harmonics:
    """Return harmonics of ``Re Σ`` from those of both signs."""
    return {
        order: a * (1.0 if order == (0, 0) else 2.0) for order, a in both.items() if order >= (0, 0)
    }


def _stacked(motions: Sequence[Harmonics]) -> tuple[np.ndarray, np.ndarray]:
    """Return the orders (h, 2) that matter anywhere, and harmonics (p, h, …)."""
    sizes: dict[tuple[int, int], float] = {}
    for motion in motions:
        for order, a in motion.items():
            sizes[order] = max(sizes.get(order, 0.0), float(np.abs(a).max()))
    largest = max(sizes.values())
    orders = sorted(order for order, size in sizes.items() if size > _ROUND * largest)
    orders = orders or [(0, 0)]
    zero = np.zeros_like(next(iter(motions[0].values())))
    stacked = [[motion.get(order, zero) for order in orders] for motion in motions]
    return np.array(orders), np.array(stacked)


def _at_bearings(point: Point) -> np.ndarray:
    """Return largest forces, smallest gaps, loads of elements, shares without force, (4, b)."""
    balance = point.balance
    motion = balance.motion(point.c)
    phi, theta = balance.phases
    laws = balance.laws
    forces = np.linalg.norm(laws.along(motion, phi, theta, balance.rest.speed)[0], axis=-1)
    found = []
    for b, one in enumerate(laws.bearings):
        q = motion[:, b, :2]
        far = np.linalg.norm(q, axis=1)
        gap = one.clearance_along()
        least = gap - far.max() if np.isfinite(gap) else np.nan
        load, away = np.nan, float(np.mean(forces[:, b] == 0.0))
        if isinstance(one, RollingBearing):
            angles = laws.ratios[b] * phi / laws.passes
            loads = contacts(one, q, angles)[0]
            load, away = loads.max(), float(np.mean(~np.any(loads, axis=1)))
        found.append((forces[:, b].max(), least, load, away))
    return np.array(found).T


def in_rotor_axes(model: LinearModel, coordinates: Harmonics, revolutions: int) -> Harmonics | None:
    """Return coordinates of the reduced rotor, in its own axes, and of what is beside it.

    From axes that stand still, ``x = exp(−Nθ) η`` of :mod:`exudyn_rotor.linear.model.turning`. None
    where supports have coordinates of their own that turn.
    """
    rotor, *others = model.bodies
    if len(rotors_of(model.bodies)) > 1:
        return None
    found = coordinates
    if not model.turns:
        if any(hasattr(body, "rows") for body in others):
            return None
        turning, found = rotor.alone.turning, {}
        for wave in (-1, 0, 1):
            P = turning.T * (turning.waves == wave) @ turning.T.conj().T
            for (k, n), x in coordinates.items():
                order = k, n - revolutions * wave
                part = np.r_[P @ x[: rotor.size], (wave == 0) * x[rotor.size :]]
                found[order] = found.get(order, 0.0) + part
    Q = rotor.alone.Q
    if rotor.is_apart:  # the spin is a rotation about the axis
        shift = rotor.spin.turn - rotor.spin.momentum
        found = {
            order: np.r_[x[: rotor.size] + (rotor.spin.momentum @ x[: rotor.size]) * shift,
                         x[rotor.size :]]
            for order, x in found.items()
        }  # fmt: skip
    return {order: np.r_[Q @ x[: rotor.size], x[rotor.size :]] for order, x in found.items()}
