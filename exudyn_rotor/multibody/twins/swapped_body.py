"""A rotor in place of Exudyn's flexible body: what the twins of both of its calls share."""

from __future__ import annotations

from typing import Any

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.add_rotor import add_rotor
from exudyn_rotor.multibody.rotor.frame import LOCKINGS
from exudyn_rotor.multibody.rotor.plan import MARKER_KINDS, color_of
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import Formulation, start_values, suited_translation
from exudyn_rotor.theory.stiffening import chosen_level

_SEEN = 1e-6  # share of a mode's mass that moves as a rigid body, above rounding of free modes
# what the twins take beyond the arguments of Exudyn's calls
OWN = ("translation", "spin", "spin_coupling", "stiffening", "locking", "markers", "prestress")


def checked_options(given: dict[str, Any]) -> dict[str, Any]:
    """Return the twin's own arguments among those `given`, or refuse them."""
    options = {name: given[name] for name in OWN}
    prestress, markers = options["prestress"], options["markers"]
    level = chosen_level(options["stiffening"], prestress is not None)
    where = (
        "SolidRotor.from_ngsolve(…).prestress() with the same mesh or Prestress.from_matrix(…) "
        "makes one; a FEMinterface has no elements to compute it on"
    )
    if prestress is not None:
        checks.instance(prestress, "prestress", Prestress, where)
    elif level == "full":
        raise ValueError(f"stiffening='full' needs the static stress: give prestress=; {where}")
    if markers is not None:
        checks.choice(markers, "markers", MARKER_KINDS)
    suited = suited_translation(options["translation"], grounded=False)
    Formulation(suited, options["spin"], spin_coupling=options["spin_coupling"])  # or refuse it
    checks.choice(options["locking"], "locking", LOCKINGS)
    return options | {"markers": {} if markers is None else markers}


def add_swapped_body(
    mbs: exudyn.MainSystem,
    name: str | None,
    fem: FEMinterface,
    axis: SpinAxis | str | ArrayLike | None,
    options: dict[str, Any],
    given: dict[str, Any],
    *,
    position: str,
    rotation: str,
) -> RotorBody:
    """Add the rotor; nothing has been added where this raises ValueError or TypeError.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    name : str or None
    fem : FEMinterface
    axis : optional
        Spin axis; None takes the direction of the angular velocity.
    options : dict
        Of :func:`checked_options`.
    given : dict
        Arguments of the twin's call by their names, of which two, `position` and `rotation`, are
        called otherwise in each of Exudyn's calls.
    """
    placed = {
        "position": checks.vector(given[position], position, "m"),
        "rotation": checks.rotation(given[rotation], rotation),
        "gravity": checks.vector(given["gravity"], "gravity", "m/s²"),
        "color": color_of(given["color"]),
    }
    for key, argument in (
        ("mass_damping", "massProportionalDamping"),
        ("stiffness_damping", "stiffnessProportionalDamping"),
    ):
        placed[key] = checks.number(given[argument], argument, least=0.0)
    velocity = checks.vector(given["initialVelocity"], "initialVelocity", "m/s")
    omega = checks.vector(given["initialAngularVelocity"], "initialAngularVelocity", "rad/s")
    turn, options = placed["rotation"], dict(options)
    rotor = SolidRotor.from_fem_interface(fem, _axis_of(turn.T @ omega) if axis is None else axis)
    reduced = rotor.reduce(fem, prestress=options.pop("prestress"))
    modes = np.asarray(fem.modeBasis["matrix"])
    options["translation"] = suited_translation(options["translation"], reduced.grounded)
    formulation = Formulation(options["translation"], options["spin"])
    if formulation.translation_count:  # Exudyn's is the velocity of the mesh origin
        velocity = velocity + np.cross(omega, turn @ reduced.center_of_mass)
    speed = _speed_along(turn @ reduced.axis.direction, omega)
    body = add_rotor(
        mbs,
        reduced,
        name=name,
        initial_velocity=velocity,
        initial_speed=_initial_speed(formulation, speed),
        **placed,
        **options,
    )
    body.script.frame_shares = _frame_shares(rotor, reduced, modes)
    return body


def _frame_shares(
    rotor: FiniteElementRotor, reduced: ReducedRotor, modes: np.ndarray
) -> np.ndarray | None:
    """Return how the frame of Exudyn's body moves with the columns of a rotor reduced with `modes`.

    Displacements are ``Rρ + Ψη`` with the modes Ψ in Exudyn's body, and ``Rρ' + Qζ`` here with the
    columns ``Q = (Ψ − RG_r) G_f⁺``, where ``G = [R Q]ᵀMΨ``; so ``ρ = ρ' − G_rG_f⁺ζ``.

    Returns
    -------
    ndarray, shape (r, k − r), or None
        ``−G_rG_f⁺``, shares of the rigid columns of `reduced`; None where it is zero, as for free
        eigenmodes.
    """
    rigid = len(reduced.rigid_kinds)
    G = reduced.shapes.matrix.T @ (rotor.mass @ modes)
    energy = np.einsum("ik,ik->k", G, G)
    if np.all(np.einsum("ik,ik->k", G[:rigid], G[:rigid]) <= _SEEN * energy):
        return None
    return -G[:rigid] @ np.linalg.pinv(G[rigid:])


def numbers(body: RotorBody) -> dict[str, Any]:
    """Return the entries that Exudyn's calls return for a flexible body, and the rotor."""
    return {
        "nRigidBody": body.nodes["rigid"],
        "nGenericODE2": body.nodes["modes"],
        "oFFRFreducedOrder": body.objects["marker_body"],
        "loadGravity": body.gravity_load,
        "rotorBody": body,
    }


def _axis_of(omega: np.ndarray) -> SpinAxis:
    """Return the axis of an angular velocity (3,), mesh axes, through the mesh origin.

    Its largest component is positive, so that the spin counts like the angle of Exudyn's node.
    """
    if not np.any(omega):
        raise ValueError(
            "axis: is not known, for the rotor starts at rest; give axis='x', 'y', 'z' or a "
            "direction in mesh coordinates"
        )
    return SpinAxis(omega * np.sign(omega[np.argmax(np.abs(omega))]))


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
