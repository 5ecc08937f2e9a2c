"""Where a scene acts on a reduced rotor: markers of its body that loads and connectors hold."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import exudyn
import numpy as np

from exudyn_rotor.multibody.drives.connect_rotors import SceneConnection
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.solid.rotor import rotation_moments
from exudyn_rotor.theory.axis import skew

_MARKERS = {"SuperElementPosition": 3, "SuperElementRigid": 6}
# loads and connectors that exert no moment
_FORCES = ("ForceVector", "ConnectorCartesianSpringDamper", "ConnectorSpringDamper")
_SAME = 1e-6  # of the motion of an interface, by which a marker there may differ


@dataclass(frozen=True, eq=False)
class LoadPlace:
    """A place of a rotor where forces act, and perhaps moments.

    Attributes
    ----------
    point : ndarray, shape (3,)
        Mesh coordinates [m].
    motion : ndarray, shape (3, m) or (6, m)
        Displacement of the point, and rotation where moments act, by modal coordinates, mesh axes.
    interface : str or None
        The interface whose mean motion this is.
    """

    point: np.ndarray
    motion: np.ndarray
    interface: str | None


def load_places(body: RotorItems) -> tuple[LoadPlace, ...]:
    """Return where loads and connectors act on a reduced rotor with its marker body."""
    number = int(body.objects["marker_body"])
    item = body.mbs.GetObject(number)
    points = np.reshape(item["referencePositions"], (-1, 3))
    columns = np.reshape(item["modeBasis"], (len(points), 3, -1))
    found = []
    for held, moments in _held(body.mbs).items():
        marker = body.mbs.GetMarker(held)
        kind = marker["markerType"]
        if kind in _MARKERS and int(marker["bodyNumber"]) == number:
            count = _MARKERS[kind] if moments else 3
            found.append(_at_marker(body, marker, points, columns, count))
    return (*found, *_of_drives(body))


def _held(mbs: exudyn.MainSystem) -> dict[int, bool]:
    """Return the markers that something acts on, and whether it may exert moments."""
    held: dict[int, bool] = {}
    for markers, kind in _acting(mbs):
        for marker in map(int, markers):
            held[marker] = held.get(marker, False) or kind not in _FORCES
    return held


def _acting(mbs: exudyn.MainSystem) -> Iterator[tuple[list, str]]:
    """Yield markers of loads, connectors and joints, with the kind of these."""
    for number in range(mbs.systemData.NumberOfLoads()):
        load = mbs.GetLoad(number)
        yield [load["markerNumber"]], load["loadType"]
    for number in range(mbs.systemData.NumberOfObjects()):
        item = mbs.GetObject(number)
        if "markerNumbers" in item and item.get("activeConnector", True):
            yield item["markerNumbers"], item["objectType"]


def _at_marker(
    body: RotorItems,
    marker: dict,
    points: np.ndarray,
    columns: np.ndarray,
    count: int,
) -> LoadPlace:
    """Return the place of a marker; `points` and `columns` are those of the marker body."""
    numbers = np.asarray(marker["meshNodeNumbers"])
    weights = np.asarray(marker["weightingFactors"])
    places, moved, turn = points[numbers], columns[numbers], body.frame.B
    point, motion = weights @ places, np.tensordot(weights, moved, 1)
    if count == 6:
        moments, levers = rotation_moments(places - point, weights)
        lever = np.linalg.pinv(moments, rcond=1e-9, hermitian=True)
        motion = np.vstack([motion, lever @ np.einsum("kab,kbm->am", levers, moved)])
    motion = np.vstack([turn.T @ part for part in np.split(motion, count // 3)])
    on_mesh = point @ turn + body.frame.origin
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


def _of_drives(body: RotorItems) -> Iterator[LoadPlace]:
    """Yield the interfaces that connections of rotors act on, by coordinates.

    All of the second rotor's, of which the connection knows no name.
    """
    interfaces = body.selection.source.interfaces
    names: set[str] = set()
    for drive in body.drives:
        if isinstance(drive, SceneConnection):
            names |= {drive.at} if drive.body is body else set(interfaces)
    for name in sorted(names):
        interface = interfaces[name]
        yield LoadPlace(interface.reference, interface.motion @ body.selection.T, name)
