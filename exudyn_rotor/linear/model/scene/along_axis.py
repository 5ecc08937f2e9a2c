"""The rotor's motion along its axis in a scene: where nothing holds it, it stays where it starts.

Springs, films and rolling elements across the axis leave it free. No force tells where the rotor
then is, and the rounding of other forces would take it along a skew axis by millimetres: so a
search for steady motions and equilibria leaves the mean of this motion out, and refuses a load.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.probe import Probe
from exudyn_rotor.linear.model.scene.scene_coordinates import (
    UNHELD,
    SceneCoordinates,
    nullspace,
)
from exudyn_rotor.reduction.fields import ModeKind

_REACHES = (1e-6, 1e-4, 1e-2, 1.0)  # of the rotor's length: a stop may have a gap
_SOFTEST = 1e-6  # 1/s²: of the force over mass and reach, that of no spring
_ROUNDING = 1e-11  # of the largest force
_ORDERS = np.arange(-1, 2)
_ANGLES = 2.0 * np.pi * np.arange(7) / 7


def held_along_axis(scene: SceneCoordinates, probe: Probe) -> np.ndarray:
    """Return the motions (k, r) whose mean a search looks for: all but a free one along the axis.

    Raises
    ------
    UnconvergedError
        For a mean load along the axis where nothing holds the rotor.
    """
    every = np.eye(scene.size)
    motion = _along_axis(scene)
    if motion is None:
        return every
    start = journal_start(scene, probe.speed, _ORDERS)
    loads = [_load(probe, start, theta) for theta in _ANGLES]
    along = np.array([force @ motion for force in loads])
    rounding = _ROUNDING * np.abs(loads).max()
    for reach in np.multiply(_REACHES, scene.length):
        least = _SOFTEST * scene.mass * reach + rounding
        for move in (reach, -reach):
            moved = start.copy()
            moved[_ORDERS == 0] += move * motion
            if abs(_load(probe, moved, _ANGLES[0]) @ motion - along[0]) > least:
                return every
    load = along.mean()
    if abs(load) > UNHELD * scene.mass + rounding:
        raise UnconvergedError(
            f"linear scene at {probe.speed:g} rad/s: no steady motion, as nothing holds the rotor "
            f"along its axis, where a load of {abs(load):.3g} N acts; add a thrust bearing, e.g. "
            "Support(interface, np.diag([0, 0, stiffness]))"
        )
    return nullspace(motion[None])


def _along_axis(scene: SceneCoordinates) -> np.ndarray | None:
    """Return the rotor's motion along its axis (k,) by a metre; None where it has none."""
    kinds = scene.body.selection.kinds
    if scene.count == 3:
        place, metre = 2, 1.0
    elif ModeKind.AXIAL in kinds:
        place = scene.count + kinds.index(ModeKind.AXIAL)
        mode = place - scene.count
        metre = np.sqrt(scene.mass / scene.body.motion.invariants.M[mode, mode])
    else:
        return None
    motion = metre * scene.N[place]
    # a constraint may hold it
    return motion if np.isclose(np.linalg.norm(scene.N[place]), 1.0, rtol=1e-9) else None


def _load(probe: Probe, Y: np.ndarray, theta: float) -> np.ndarray:
    """Return the forces (k,) at an angle, of a motion by its harmonics −1, 0, 1."""
    T, T1 = probe.turn(theta)[:2]
    waves = np.exp(1j * theta * _ORDERS)
    y, y_t = ((waves * (1j * probe.speed * _ORDERS) ** n @ Y).real for n in range(2))
    constant = probe.rotor_terms(theta)[3]
    return T.T @ (constant + probe.force(theta, T @ y, T @ y_t + probe.speed * T1 @ y))
