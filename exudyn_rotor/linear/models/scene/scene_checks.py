"""Which scenes can be linearised around one rotor."""

from __future__ import annotations

import exudyn

from exudyn_rotor import checks
from exudyn_rotor.multibody.drives.connect_rotors import SceneConnection
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.mark import mark_of
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody


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
    for drive in body.drives:
        if isinstance(drive, SceneConnection):
            raise ValueError(
                f"linear scene: {drive} connects rotor {body.name!r} with a shaft, which turns at "
                "a speed of its own; give linear analyses the rotor with "
                f"supports=[…, coupling.support({drive.at!r})]"
            )


def rotors_in(mbs: exudyn.MainSystem) -> dict[int, str | None]:
    """Return the rotors of a scene: names by the numbers of the objects with their equations."""
    names, found = {}, {}
    for number in range(mbs.systemData.NumberOfObjects()):
        item = mbs.GetObject(number)
        nodes = [int(node) for node in item.get("nodeNumbers", ())]
        if item["objectType"] == "FFRFreducedOrder":
            names[nodes[0]] = item["name"]
        if item["objectType"] == "GenericODE2" and mark_of(mbs, exudyn.ObjectIndex(number)):
            found[number] = names.get(nodes[0], item["name"])
    return found
