"""Which scenes can be linearised around one rotor."""

from __future__ import annotations

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.probe import Probe
from exudyn_rotor.linear.model.scene.scene_coordinates import UNHELD, SceneCoordinates
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.rotor_items import known_rotors

_PERIODIC = 1e-6  # share of the forces that may change from one revolution to the next: round-off
_ROUNDING = 1e-13  # rad, of an angle after some revolutions


def check_body(mbs: exudyn.MainSystem, body: RotorBody) -> None:
    """Refuse a system that is not assembled, another one's rotor, and coordinates of first order.

    Raises
    ------
    TypeError, ValueError
    """
    checks.instance(mbs, "mbs", exudyn.MainSystem)
    how = "exudyn_rotor.add_rotor returned it for the rotor in this system"
    reduced_body(body, how=how)
    if body.mbs is not mbs:
        raise ValueError(f"rotor {body.name!r} belongs to another mbs")
    body.check_present()
    if not mbs.systemIsConsistent:
        raise ValueError("the system is not assembled: call mbs.Assemble() first")
    if mbs.systemData.ODE1Size():
        raise ValueError("linear scene: coordinates of first order (ODE1) are not supported")


def check_scene(mbs: exudyn.MainSystem, body: RotorBody) -> None:
    """Refuse what :func:`check_body` does, a second rotor, and what has its own speed.

    Raises
    ------
    TypeError, ValueError
    """
    check_body(mbs, body)
    others = [n for number, n in rotors_in(mbs).items() if number != int(body.objects["physics"])]
    if others:
        raise ValueError(
            f"linear scene: a second rotor in this system, {others[0]!r}; one revolution is a "
            "period for one spin speed only. Give body=[…] with all rotors, on supports of "
            "add_supports and linked by these and connect_rotors; or give linear analyses a "
            "RotorTrain of the reduced rotors and their supports, with gears and couplings as "
            "Link(…)"
        )


def rotors_in(mbs: exudyn.MainSystem) -> dict[int, str | None]:
    """Return the rotors of a scene: names by the numbers of the objects with their equations."""
    return {int(body.objects["physics"]): body.name for body in known_rotors(mbs)}


def check_period(scene: SceneCoordinates, probe: Probe) -> None:
    """Refuse loads that are others after a revolution, as those that vary in time by themselves."""
    still = np.zeros(len(scene.free))
    for theta in (0.5, 2.5, 4.5):
        first = probe.force(theta, still, still)
        loads = max(np.abs(first).max(), np.abs(probe.rotor_terms(theta)[3]).max())
        # where a journal that is off its axis is all but at the wall, rounding is a force
        rounding = np.abs(probe.force(theta + _ROUNDING, still, still) - first).max()
        for turns in (1.0, 2.0):
            later = probe.force(theta + 2.0 * np.pi * turns, still, still)
            if np.abs(later - first).max() > _PERIODIC * loads + UNHELD * scene.mass + rounding:
                raise UnconvergedError(
                    f"linear scene at {probe.speed:g} rad/s: a load does not repeat with every "
                    "revolution of the rotor, so there is no steady motion; leave out loads and "
                    "motions that vary in time"
                )
