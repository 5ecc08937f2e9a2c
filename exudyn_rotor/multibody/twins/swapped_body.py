"""A rotor in place of Exudyn's flexible body: what the twins of both of its calls share."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.add_rotor import add_rotor
from exudyn_rotor.multibody.rotor.frame import LOCKINGS, MESH_ORIGIN
from exudyn_rotor.multibody.rotor.plan import MARKER_KINDS, color_of
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.rotor_items import known_rotor
from exudyn_rotor.multibody.twins.axis_of_body import axis_at_rest, axis_of_motion
from exudyn_rotor.reduction.mean_axis import frame_shares
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import (
    ConstantSpeed,
    Formulation,
    PrescribedMotion,
    start_values,
    suited_translation,
)
from exudyn_rotor.theory.stiffening import chosen_level


@dataclass(frozen=True, eq=False)
class State:
    """Where a body stands, how it starts, and its damping, as Exudyn's calls say it.

    Attributes
    ----------
    position, velocity : ndarray, shape (3,)
        Of the mesh origin, inertial axes [m], [m/s].
    rotation : ndarray, shape (3, 3)
        Mesh axes → inertial axes.
    omega : ndarray, shape (3,)
        Angular velocity, inertial axes [rad/s].
    mass_damping, stiffness_damping : float
        Rayleigh factors [1/s], [s].
    gravity : ndarray, shape (3,)
        Inertial axes [m/s²].
    color : tuple of float
    """

    position: np.ndarray
    velocity: np.ndarray
    rotation: np.ndarray
    omega: np.ndarray
    mass_damping: float
    stiffness_damping: float
    gravity: np.ndarray
    color: tuple[float, ...]

    @classmethod
    def checked(cls, position: str, rotation: str, given: dict[str, ArrayLike]) -> State:
        """Return the arguments, or refuse them; two have another name in each of the calls."""
        by_mass, by_stiffness = (
            checks.number(given[name], name, least=0.0)
            for name in ("massProportionalDamping", "stiffnessProportionalDamping")
        )
        return cls(
            position=checks.vector(given[position], position, "m"),
            velocity=checks.vector(given["initialVelocity"], "initialVelocity", "m/s"),
            rotation=checks.rotation(given[rotation], rotation),
            omega=checks.vector(given["initialAngularVelocity"], "initialAngularVelocity", "rad/s"),
            mass_damping=by_mass,
            stiffness_damping=by_stiffness,
            gravity=checks.vector(given["gravity"], "gravity", "m/s²"),
            color=color_of(given["color"]),
        )


def checked_options(
    translation: str | PrescribedMotion,
    spin: str | float | ConstantSpeed | PrescribedMotion,
    spin_coupling: str,
    stiffening: str,
    locking: str,
    markers: str | None,
    condense_markers: bool,
    prestress: Prestress | None,
) -> dict[str, Any]:
    """Return what the twins take beyond the arguments of Exudyn's calls, or refuse it."""
    _check_prestress(chosen_level(stiffening, prestress is not None), prestress)
    if markers is not None:
        checks.choice(markers, "markers", MARKER_KINDS)
    suited = suited_translation(translation, grounded=False)
    Formulation(suited, spin, spin_coupling=spin_coupling)  # or refuse it
    return {
        "translation": translation,
        "spin": spin,
        "spin_coupling": spin_coupling,
        "stiffening": stiffening,
        "locking": checks.choice(locking, "locking", LOCKINGS),
        "markers": {} if markers is None else markers,
        "condense_markers": checks.flag(condense_markers, "condense_markers"),
        "prestress": prestress,
    }


def solid_rotor(
    fem: FEMinterface, axis: SpinAxis | str | ArrayLike | None, start: State
) -> SolidRotor:
    """Return the model in `fem`; without an axis it spins about that of its angular velocity.

    A body at rest spins about the line through its seats. Either must fit the body: see
    :mod:`exudyn_rotor.multibody.twins.axis_of_body`.
    """
    if axis is not None:
        return SolidRotor.from_fem_interface(fem, axis)
    rotor = SolidRotor.from_fem_interface(fem, "z")
    if np.any(start.omega):
        return replace(rotor, axis=axis_of_motion(rotor, start.rotation.T @ start.omega))
    return replace(rotor, axis=axis_at_rest(rotor))


def add_swapped_body(
    mbs: exudyn.MainSystem,
    name: str | None,
    fem: FEMinterface,
    rotor: SolidRotor,
    start: State,
    options: dict[str, Any],
    offsets: dict[str, np.ndarray] | None = None,
    show_markers: bool = True,
) -> RotorBody:
    """Add the rotor; nothing has been added where this raises ValueError or TypeError.

    The offsets of rigid markers turn with the rotor's mean rotation, as on Exudyn's body.
    """
    more = dict(options)
    reduced = rotor.reduce(fem, prestress=more.pop("prestress"))
    modes = np.asarray(fem.modeBasis["matrix"])
    speed = _speed_along(start.rotation @ reduced.axis.direction, start.omega)
    more["translation"] = suited_translation(more["translation"], reduced.grounded)
    formulation = Formulation(more["translation"], more["spin"])
    velocity = start.velocity
    if formulation.translation_count:
        velocity = velocity + np.cross(start.omega, start.rotation @ reduced.center_of_mass)
    rigid = more["markers"] == "rigid"
    body = add_rotor(
        mbs,
        reduced,
        name=name,
        position=start.position,
        rotation=start.rotation,
        initial_velocity=velocity,
        initial_speed=_initial_speed(formulation, speed),
        gravity=start.gravity,
        mass_damping=start.mass_damping,
        stiffness_damping=start.stiffness_damping,
        marker_offsets=None if rigid else offsets,
        show_markers=show_markers,
        frame_node=MESH_ORIGIN,
        color=start.color,
        **more,
    )
    known_rotor(body).frame_shares = frame_shares(rotor, reduced, modes)
    for interface, offset in (offsets or {}).items() if rigid else ():
        # Exudyn's own, which turns with the mean rotation, not with that of the interface
        mbs.SetMarkerParameter(body.marker(interface), "offset", body.frame.B @ offset)
    return body


def numbers(body: RotorBody) -> dict[str, Any]:
    """Return the entries that Exudyn's calls return for a flexible body, and the rotor."""
    return {
        "nRigidBody": body.nodes["rigid"],
        "nGenericODE2": body.nodes["modes"],
        "oFFRFreducedOrder": body.objects["marker_body"],
        "loadGravity": body.gravity_load,
        "rotorBody": body,
    }


def _check_prestress(stiffening: str, prestress: Prestress | None) -> None:
    if prestress is not None and not isinstance(prestress, Prestress):
        raise TypeError(
            f"prestress: needs a Prestress, got {checks.shown(prestress)}; a FEMinterface has no "
            "elements "
            "to compute one on: use SolidRotor.from_ngsolve(…).prestress() with the same mesh, or "
            "Prestress.from_matrix(…)"
        )
    if stiffening == "full" and prestress is None:
        raise ValueError(
            "stiffening='full' needs the static stress: give prestress=, made by "
            "SolidRotor.from_ngsolve(…).prestress() with the same mesh or by "
            "Prestress.from_matrix(…), or use stiffening='tilt'"
        )


def _speed_along(direction: np.ndarray, omega: np.ndarray) -> float:
    """Return the spin speed of an angular velocity that must lie along the axis."""
    speed = float(direction @ omega)
    across = np.linalg.norm(omega - speed * direction)
    if across > 1e-9 * np.linalg.norm(omega):
        raise ValueError(
            f"initialAngularVelocity {omega.tolist()} has {across:.3g} rad/s across the spin axis "
            f"{direction.tolist()}: a fixed-axis rotor cannot tumble; start it with modal "
            "velocities of its tilt modes (exudyn_rotor.add_rotor), or use the 3D body"
        )
    return speed


def _initial_speed(formulation: Formulation, speed: float) -> float | None:
    """Return the initial speed of a free spin; a prescribed one must agree with what is given."""
    if formulation.has_spin:
        return speed
    _, prescribed, _ = start_values(formulation.spin, "spin")
    if speed and abs(speed - prescribed) > 1e-9 * abs(prescribed):
        raise ValueError(
            f"spin given twice: initialAngularVelocity is {speed} rad/s along the axis, "
            f"the prescribed spin starts with {prescribed} rad/s"
        )
    return None
