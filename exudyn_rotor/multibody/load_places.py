"""Where a scene acts on a reduced rotor: markers of its body that loads and connectors hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor.multibody.rotor.connections import attached
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems, marker_carrier
from exudyn_rotor.theory.axis import skew

_MARKERS = ("SuperElementPosition", "SuperElementRigid")
# loads and connectors that exert no moment
_FORCES = ("ForceVector", "ConnectorCartesianSpringDamper", "ConnectorSpringDamper")
_SAME = 1e-6  # of the motion of an interface, by which a marker there may differ


@dataclass(frozen=True, eq=False)
class LoadPlace:
    """A place of a rotor where forces act, and perhaps moments."""

    point: np.ndarray  # (3,) Mesh coordinates [m]
    # (3, m) or (6, m) Displacement, and rotation where moments act, by modal coordinates, mesh axes
    motion: np.ndarray
    interface: str | None  # whose mean motion this is


def load_places(body: RotorItems) -> tuple[LoadPlace, ...]:
    """Return where loads and connectors act on a reduced rotor."""
    moments: dict[int, bool] = {}  # of markers, whether moments may act there
    for is_load, _, item, markers in attached(body.mbs):
        kind = item["loadType" if is_load else "objectType"]
        for marker in markers if item.get("activeConnector", True) else ():
            moments[marker] = moments.get(marker, False) or kind not in _FORCES
    found = []
    for number, with_moments in moments.items():
        marker = body.mbs.GetMarker(number)
        own = int(marker.get("bodyNumber", -1)) == int(body.objects["marker_body"])
        if own and marker["markerType"] in _MARKERS:
            rigid = with_moments and marker["markerType"] == "SuperElementRigid"
            found.append(_at_marker(body, marker, 6 if rigid else 3))
    interfaces = body.selection.source.interfaces
    for name in sorted(_driven(body)):
        motion = interfaces[name].motion @ body.selection.T
        found.append(LoadPlace(interfaces[name].reference, motion, name))
    return tuple(found)


def _driven(body: RotorItems) -> set[str]:
    """Return the interfaces that drives and connections of rotors act on, by coordinates."""
    places = {
        drive.at if drive.body.token is body.token else drive.other_at for drive in body.drives
    }
    return places - {None}


def _at_marker(body: RotorItems, marker: dict, count: int) -> LoadPlace:
    carrier, turn = marker_carrier(body.mbs, marker), body.frame.B
    parts = np.split(carrier.motion[:count], count // 3)
    motion = np.vstack([turn.T @ part for part in parts])
    on_mesh = carrier.point @ turn + body.frame.origin
    return LoadPlace(on_mesh, motion, _interface_at(body, on_mesh, motion))


def _interface_at(body: RotorItems, point: np.ndarray, motion: np.ndarray) -> str | None:
    """Return the interface, the nearest, that moves a point (3,) of its own by `motion`."""
    found = {}
    for name, interface in body.selection.source.interfaces.items():
        mean, arm = interface.motion @ body.selection.T, point - interface.reference
        expected = mean[:3] - skew(arm) @ mean[3:]
        if np.abs(motion[:3] - expected).max() <= _SAME * np.abs(expected).max():
            found[name] = float(np.linalg.norm(arm))
    return min(found, key=found.__getitem__, default=None)
