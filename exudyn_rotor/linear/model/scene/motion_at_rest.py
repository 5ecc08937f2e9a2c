"""Equilibria of a scene at rest, at all angles of the rotor."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.model.scene.along_axis import held_along_axis
from exudyn_rotor.linear.model.scene.equilibrium import equilibrium
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.probe import Probe
from exudyn_rotor.linear.model.scene.searched_scene import Motion, Scene

_SAMPLES = 7  # an odd number: the harmonics are exact at all of them


def motion_at_rest(
    scene: Scene, probe: Probe, tolerance: float, angle: float, begin: Motion | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Return orders (h,) and harmonics (h, k) of the equilibria at all angles of the rotor.

    Exact at the start's angle [rad] and those of the same distance from it. A search begins with
    the motion `begin` where one is given.

    Raises
    ------
    UnconvergedError
        Where there is no equilibrium.
    """
    kept = held_along_axis(scene, probe)
    first, start = begin or (np.arange(-1, 2), journal_start(scene, 0.0, np.arange(-1, 2)))
    count = _SAMPLES
    while True:
        angles = angle + 2.0 * np.pi * np.arange(count) / count
        orders = np.arange(-(count // 2), count // 2 + 1)
        values = []
        for theta in angles:
            near = values[-1] if values else (np.exp(1j * theta * first) @ start).real
            values.append(equilibrium(scene, probe, theta, near, tolerance, kept))
        harmonics = np.exp(-1j * np.outer(orders, angles)) @ values / count
        sizes = np.abs(harmonics).max(axis=1)
        if sizes[[0, -1]].max() <= tolerance * sizes.max() or count > 2 * _SAMPLES:
            return orders, harmonics
        count = 2 * count + 1
