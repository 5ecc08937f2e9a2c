"""Where the search for the steady motion of a scene begins: journals in their equilibria.

The film of a bearing without load is that of a centred journal, and from there Newton's method
oversteps the clearance. The search therefore begins with the journals where their static loads hold
them. How the rotor is deformed there does not matter: its equations are linear.
"""

from __future__ import annotations

import numpy as np

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.theory.rotating_axes import into_rotor_frame, parts_across


def journal_start(scene: LinearScene, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the motion with all journals at rest in their equilibria, at a spin speed [rad/s].

    Orders (3,) and harmonics (3, k).
    """
    orders = np.array([-1, 0, 1])
    harmonics = np.zeros((3, scene.size), dtype=complex)
    loads = _static_loads(scene.body)
    harmonics[1] = scene.N.T @ _tilts(scene, speed, loads)
    places = {one.interface: _place(one, load, speed) for one, load in loads.items()}
    places = {name: place for name, place in places.items() if np.any(place)}
    if not places:
        return orders, harmonics
    motion = np.linalg.pinv(np.vstack([scene.interface_motion(name)[:2] for name in places]))
    turned = [into_rotor_frame(np.array([*place, 0.0])) for place in places.values()]
    for n in (-1, 1):
        harmonics[1 + n] += motion @ np.concatenate([harmonic[n][:2] for harmonic in turned])
    return orders, harmonics


def _tilts(scene: LinearScene, speed: float, loads: dict[Bearing, np.ndarray]) -> np.ndarray:
    """Return the tilts of pads in equilibrium [rad] by the free coordinates."""
    found = np.zeros(len(scene.rest))
    for one in scene.body.supports:
        if isinstance(one.support, TiltingPadBearing) and one.support in loads:
            tilts = one.support.tilts(speed, loads[one.support])
            found[one.own_coordinates(scene.body.mbs)] = np.nan_to_num(tilts)
    return found[scene.free]


def _place(bearing: Bearing, load: np.ndarray, speed: float) -> np.ndarray:
    """Return the equilibrium of a journal (2,) [m]; a film at rest does not carry."""
    try:
        return bearing.equilibrium(speed, load)
    except (ValueError, ArithmeticError) as error:
        if not speed:
            return np.zeros(2)
        where = f"linear scene at {speed:g} rad/s, bearing at {bearing.interface!r}"
        raise UnconvergedError(f"{where}: {error}") from error


def _static_loads(body: RotorBody) -> dict[Bearing, np.ndarray]:
    """Return loaded bearings and their loads: on two the weight by the lever rule, or their own."""
    bearings = [each.support for each in body.supports if isinstance(each.support, Bearing)]
    bearings = [bearing for bearing in bearings if bearing.carries]
    loads = [bearing.load for bearing in bearings]
    if len(bearings) == 2:
        source = body.selection.source
        e = source.axis.direction
        left, right = (source.interfaces[each.interface].reference @ e for each in bearings)
        weight = source.invariants.mass * parts_across(body.standing_axes, body.gravity)
        if left != right and np.any(weight):
            share = (source.center_of_mass @ e - left) / (right - left)
            loads = [(1.0 - share) * weight, share * weight]
    pairs = zip(bearings, loads, strict=True)
    return {bearing: load for bearing, load in pairs if load is not None and np.any(load)}
