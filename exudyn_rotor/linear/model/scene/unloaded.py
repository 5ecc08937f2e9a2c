"""Bearings of a scene that no load presses to a side: films and rolling elements.

Where a film is equally thick all along a pad its pressure is that around it. Which part of it
carries depends on the side to which the journal moves next: it has no stiffness and damping that
do not depend on the direction. Tension in the film, a supply, or pads with preload make it smooth.

A journal in elements with clearance is free. Unbalance throws it from one to the next, and the
search for a motion that repeats with the revolution has nothing to begin with.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.attached import AttachedBearing
from exudyn_rotor.linear.model.scene.equilibrium import solved
from exudyn_rotor.linear.model.scene.journal_start import journal_places, journal_start
from exudyn_rotor.linear.model.scene.probe import Probe, linearised
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates

_ORDERS = np.arange(-1, 2)
_MIDDLE = 1e-6  # of the clearance: nearer to a pad's centre a film has no side


def check_films(scene: SceneCoordinates, probe: Probe) -> None:
    """Refuse to linearise films whose journals stand in the middle of a pad.

    One step of Newton's method from where the search begins moves those that something presses.

    Raises
    ------
    UnconvergedError
    """
    films = [one for one in probe.films if _needs_a_side(one)]
    if not films or probe.speed == 0.0:
        return
    start = journal_start(scene, probe.speed, _ORDERS)
    motion = [((1j * _ORDERS * probe.speed) ** n @ start).real for n in range(3)]
    middle = _in_the_middle(films, probe, motion)
    if middle and scene.about != "given":
        motion[0] = motion[0] + _pressed(scene, probe, motion)
        middle = _in_the_middle(films, probe, motion)
    if not middle:
        return
    where = f"linear scene at {probe.speed:g} rad/s"
    raise UnconvergedError(
        f"{where}: no load presses the journal at {middle[0].bearing.interface!r} to a side: it "
        "stands in the middle of its film, where stiffness and damping depend on the direction in "
        "which it moves. Give the bearing its static load (load=…, of bearing_loads(rotor, "
        "interfaces, gravity)), with which about='given' linearises it; without one the film needs "
        "pads with preload, a supply_pressure, or cavitation='none'"
    )


def _needs_a_side(one: AttachedBearing) -> bool:
    given = one.bearing.film
    return given.cavitation != "none" and given.supply_pressure == 0.0


def _pressed(scene: SceneCoordinates, probe: Probe, motion: list[np.ndarray]) -> np.ndarray:
    """Return one step of Newton's method, of what is left of the loads."""
    probe.step = probe.velocity_step = None
    point = linearised(probe, 0.0, *motion)
    residual = point.residual
    if scene.about == "equilibrium":
        residual = residual + probe.speed**2 * scene.unit_unbalance
    return solved(point.K, -residual)[0]


def _in_the_middle(
    films: list[AttachedBearing], probe: Probe, motion: list[np.ndarray]
) -> list[AttachedBearing]:
    """Return the bearings in which a motion holds the journal in the centre of a pad."""
    probe.forget()
    probe.see(0.0, motion[0], motion[1])
    return [one for one in films if _is_central(one)]


def _is_central(one: AttachedBearing) -> bool:
    """Return whether the place seen last is the centre of a pad."""
    near = _MIDDLE * one.bearing.film.clearance
    last = [
        (part.film.pads, seen[-1]) for part, seen in zip(one.connector.parts, one.seen, strict=True)
    ]
    return any(
        np.linalg.norm(seen[0] - pad.center) < near
        for pads, seen in last
        if seen is not None
        for pad in pads
    )


def loose_bearing(scene: SceneCoordinates, probe: Probe) -> str | None:
    """Return the interface of a rolling bearing whose elements no weight presses; None without."""
    bearings = [one.bearing for one in probe.bearings if isinstance(one.bearing, RollingBearing)]
    loose = [one.interface for one in bearings if one.clearance >= 0.0]
    return loose[0] if loose and not journal_places(scene.body, probe.speed) else None


def check_elements(scene: SceneCoordinates, probe: Probe, refused: UnconvergedError) -> None:
    """Tell where no motion was found because nothing presses the elements of a bearing.

    Raises
    ------
    UnconvergedError
    """
    interface = loose_bearing(scene, probe)
    if interface is not None:
        raise UnconvergedError(
            f"linear scene at {probe.speed:g} rad/s: nothing presses the elements of the rolling "
            f"bearing at {interface!r} across the axis, neither a load nor a preload: unbalance "
            "throws the rotor from one to the next, and no motion that repeats with the revolution "
            "was found. Give the bearing the interference that it is mounted with (a clearance "
            "below zero) or the load across the axis; a damped run from rest shows the motion"
        ) from refused
