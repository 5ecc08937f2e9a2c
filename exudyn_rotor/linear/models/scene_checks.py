"""Which scenes can be linearised around one rotor."""

from __future__ import annotations

import exudyn

from exudyn_rotor import checks
from exudyn_rotor.multibody.drives.connect_rotors import SceneConnection
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody


def check_scene(mbs: exudyn.MainSystem, body: RotorBody) -> None:
    """Refuse a system that is not assembled, another one's rotor, and what has its own speed.

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
    other = _second_rotor(mbs, {int(node) for node in body.nodes.values()})
    if other is not None:
        raise ValueError(
            f"linear scene: a second rotor in this system, {other!r}; one revolution is a period "
            "for one spin speed only. Give linear analyses a RotorTrain of the reduced rotors and "
            "their supports, with gears and couplings as Link(…)"
        )
    for drive in body.drives:
        if isinstance(drive, SceneConnection):
            raise ValueError(
                f"linear scene: {drive} connects rotor {body.name!r} with a shaft, which turns at "
                "a speed of its own; give linear analyses the rotor with "
                f"supports=[…, coupling.support({drive.at!r})]"
            )


def _second_rotor(mbs: exudyn.MainSystem, own: set[int]) -> str | None:
    """Return the name of a rotor on other nodes than a rotor's own; None where there is none."""
    names = {}
    for number in range(mbs.systemData.NumberOfObjects()):
        item = mbs.GetObject(number)
        nodes = [int(node) for node in item.get("nodeNumbers", ())]
        if item["objectType"] == "FFRFreducedOrder":
            names[nodes[0]] = item["name"]
        if item["objectType"] != "GenericODE2" or own & set(nodes):
            continue
        if str(mbs.GetNode(nodes[0])["nodeType"]) == "RigidBodyRxyz":
            return names.get(nodes[0], item["name"])
    return None
