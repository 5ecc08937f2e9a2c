"""Values between two samples to look at, by the largest growth at many of them."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby

import numpy as np

from exudyn_rotor.linear.stability.growth_scan import GrowthScan

PARTS = 40  # of the distance of two samples
_NEARER, _TIMES = 8, 2  # parts in which the surroundings of a peak are seen again, and how often
_NOISE = 1e-6  # of the speed: growth that may be rounding


def to_look_at(scan: GrowthScan, ends: tuple[float, float], known: Mapping[float, bool]) -> list:
    """Return one value, of the largest growth or decay, of each range of one verdict.

    Of those in which no value is known, whether unstable.
    """
    places, growths = _scanned(scan, ends)
    seen = {float(at): growth for at, growth in zip(places, growths, strict=True)}
    verdicts = {at: bool(growth > 0.0) for at, growth in seen.items()} | dict(known)
    found = []
    for _, part in groupby(sorted(verdicts), key=verdicts.get):
        values = list(part)
        if not known.keys() & set(values):
            found.append(max(values, key=lambda value: abs(seen[value])))
    return found


def _scanned(scan: GrowthScan, ends: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Return values between two and how much growth exceeds rounding, dense where it has a peak.

    Of stable values; of unstable ones where it has a low.
    """
    noise = _NOISE * scan.speeds(np.array(ends)).max()
    places = np.linspace(*ends, PARTS + 1)
    growths = scan.growths(places) - noise
    step = (ends[1] - ends[0]) / PARTS
    for _ in range(_TIMES):
        heights = np.where(growths > 0.0, -growths, growths)
        rises = np.diff(heights, prepend=heights[0]), -np.diff(heights, append=heights[-1])
        higher = (np.minimum(*rises) >= 0.0) & (np.maximum(*rises) > noise)
        step /= 0.5 * _NEARER
        around = step * np.arange(1 - _NEARER // 2, _NEARER // 2)
        peaks = places[higher]
        more = np.setdiff1d(peaks[:, None] + around, places)
        more = more[(ends[0] < more) & (more < ends[1])]
        if not len(more):
            break
        places, growths = np.append(places, more), np.append(growths, scan.growths(more) - noise)
        order = np.argsort(places)
        places, growths = places[order], growths[order]
    told = np.isfinite(growths)
    return places[told], growths[told]
