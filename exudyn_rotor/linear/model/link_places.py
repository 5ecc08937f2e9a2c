"""Whether links connect what is in one place: rotors stand where links, or the user, put them.

A support needs both interfaces at one point of one axis; gears need their axes apart by the centre
distance, in the direction of ``line_angle``. Where nothing else says where a rotor stands, the
first link that it has puts it there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from exudyn_rotor.drives.gear_mesh import GearMesh
from exudyn_rotor.linear.model.links import Link
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.places import OF_RADIUS, SAME_PLACE
from exudyn_rotor.theory.rotating_axes import axes_of

_OF_DISTANCE = 1e-3  # of the centre distance of gears


def check_places(
    rotors: Mapping[str, ReducedRotor],
    links: Sequence[Link],
    positions: Mapping[str, np.ndarray],
) -> None:
    """Refuse links whose ends are not in one place, along (n1, n2, e).

    Raises
    ------
    ValueError
    """
    at = dict(positions)
    left = list(links)
    while left:
        link = next((one for one in left if _is_known(one, at)), left[0])
        left.remove(link)
        (first, _), (second, _) = link.ends
        apart = _apart(rotors, link)
        if first not in at and second not in at:
            at[first] = np.zeros(3)
        if second not in at:
            at[second] = at[first] - apart
        elif first not in at:
            at[first] = at[second] + apart
        _check(rotors, link, at[second] - at[first] + apart)


def _is_known(link: Link, at: Mapping[str, np.ndarray]) -> bool:
    return any(rotor in at for rotor, _ in link.ends)


def _apart(rotors: Mapping[str, ReducedRotor], link: Link) -> np.ndarray:
    """Return how far the ends are from where they should be, of rotors at one position."""
    places = []
    for name, interface in link.ends:
        axis = rotors[name].axis
        foot = axis.project(rotors[name].interfaces[interface].reference)
        places.append(axes_of(axis).T @ foot)
    expected = np.zeros(3)
    if isinstance(link.connection, GearMesh):
        angle, distance = link.connection.line_angle, link.connection.center_distance
        expected = distance * np.array([np.cos(angle), np.sin(angle), 0.0])
    return places[1] - places[0] - expected


def _check(rotors: Mapping[str, ReducedRotor], link: Link, off: np.ndarray) -> None:
    radii = (rotors[name].interfaces[interface].radius for name, interface in link.ends)
    allowed = max(SAME_PLACE, OF_RADIUS * max(radii))
    what = "both ends need one place"
    if isinstance(link.connection, GearMesh):
        distance = link.connection.center_distance
        allowed = max(allowed, _OF_DISTANCE * distance)
        what = f"gears need axes {distance:.6g} m apart at line_angle, in one plane"
    if np.linalg.norm(off) > allowed:
        across, along = np.hypot(off[0], off[1]), off[2]
        raise ValueError(
            f"links: {link.first} – {link.second} is off by {across:.4g} m across and "
            f"{along:.4g} m along the axis, as the other links or positions= place the rotors; "
            f"{what}"
        )
