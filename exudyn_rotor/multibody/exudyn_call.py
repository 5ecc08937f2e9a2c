"""``mbs.CreateFixedAxisFFRFReducedOrderObject``: the twin of Exudyn's own call.

Argument names, defaults and returned keys are those of
``mbs.CreateFFRFReducedOrderObject``; changing the name of the call swaps the formulation.
"""

from __future__ import annotations

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface
from exudyn.misc.extensionRegistry import extends, install
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody import inputs
from exudyn_rotor.multibody.add_rotor import add_rotor
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.fem_interface import import_model
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import (
    ConstantSpeed,
    Formulation,
    PrescribedMotion,
    start_values,
)
from exudyn_rotor.theory.stiffening import LEVELS


@extends(exudyn.MainSystem)
def MainSystemCreateFixedAxisFFRFReducedOrderObject(
    mbs: exudyn.MainSystem,
    name: str | None,
    femInterface: FEMinterface,
    referencePosition: ArrayLike = (0.0, 0.0, 0.0),
    initialVelocity: ArrayLike = (0.0, 0.0, 0.0),
    referenceRotationMatrix: ArrayLike = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    initialAngularVelocity: ArrayLike = (0.0, 0.0, 0.0),
    massProportionalDamping: float = 0.0,
    stiffnessProportionalDamping: float = 0.0,
    gravity: ArrayLike = (0.0, 0.0, 0.0),
    color: ArrayLike = exudyn.graphics.color.defaultFFRF,
    superElementRigidMarkersOffsets: ArrayLike | None = None,
    showMarkers: bool = True,
    verbose: bool = False,
    axis: SpinAxis | str | ArrayLike | None = None,
    translation: str | PrescribedMotion = "free",
    spin: str | float | ConstantSpeed | PrescribedMotion = "free",
    stiffening: str = "tilt",
    locking: str = "auto",
    markers: str = "rigid",
    condense_markers: bool = True,
    prestress: Prestress | None = None,
) -> dict:
    """Create a flexible rotor that spins about one fixed axis.

    The twin of CreateFFRFReducedOrderObject; the arguments after verbose are its own.

    Args:
        mbs: the MainSystem to which the rotor is added
        name: name of the rotor; markers are called name + ':' + boundaryName, nodes
            'NodeRigidBody:' + name and 'NodeGeneric:' + name; None: nodes and objects have no name,
            and markers are called boundaryName
        femInterface: FEMinterface with mesh, mass and stiffness matrix and a mode basis; its named
            node sets become markers
        referencePosition: position of the mesh origin (3D vector)
        initialVelocity: initial velocity of the mesh origin (3D vector)
        referenceRotationMatrix: rotation from mesh axes to global axes
        initialAngularVelocity: initial angular velocity (3D vector, global); must lie along the
            spin axis
        massProportionalDamping: Rayleigh factor of the component modes' mass matrix
        stiffnessProportionalDamping: Rayleigh factor of the component modes' stiffness matrix
        gravity: gravity (3D vector, global)
        color: RGBA color if no contour is drawn
        superElementRigidMarkersOffsets: local offset per marker, N x 3, mesh axes
        showMarkers: if True, the markers are drawn
        verbose: if True, a report of the new body is printed
        axis: spin axis in mesh coordinates: 'x', 'y', 'z', a direction, or (direction, point);
            None takes the direction of initialAngularVelocity, through the mesh origin, or at
            rest the line through the centres of the boundaries
        translation: 'free', 'in-plane', 'none' or a PrescribedMotion
        spin: 'free', a constant speed in rad/s, or a PrescribedMotion
        stiffening: centrifugal stiffening, 'tilt' or 'none' (the paper's equations); 'full' needs
            prestress
        locking: 'auto', 'mass' or 'constraints'; see exudyn_rotor.multibody.locking
        markers: kind of the markers, 'rigid' or 'position'; the latter serves springs and forces
            at a fraction of the cost
        condense_markers: whether mbs.Assemble() moves the script's own markers on many mesh nodes
            to few added nodes with the same mean motion: the same to round-off, and much faster
        prestress: static stress for stiffening='full', since a FEMinterface holds no elements to
            compute it on: SolidRotor.prestress() of a rotor from NGSolve with the same mesh, or
            Prestress.from_matrix() with the geometric stiffness of another program

    Returns:
        :dict: marker number of every boundary under its marker name, and under
            'FFRFReducedOrderObjectDict' the entries 'nRigidBody', 'nGenericODE2',
            'oFFRFreducedOrder', 'loadGravity' and 'rotorBody'

    Note:
        The node 'nRigidBody' sits in the centre of mass (translation free) or on the spin axis,
        and carries only spin and translation: apply loads at the boundary markers. Sensor output
        in local axes (DisplacementLocal) has z along the spin axis; stress is in mesh axes.

    Example:
        >>> import exudyn
        >>> import exudyn_rotor  # adds the method to MainSystem
        >>> import numpy as np
        >>> import scipy.sparse as sp
        >>> from exudyn.FEM import FEMinterface
        >>> fem = FEMinterface()
        >>> fem.nodes = {"Position": np.array([[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]])}
        >>> fem.massMatrix, fem.stiffnessMatrix = sp.eye(6).tocsr(), 1e6 * sp.eye(6).tocsr()
        >>> fem.nodeSets = [{"Name": "top", "NodeNumbers": [0], "NodeWeights": [1.0]}]
        >>> fem.modeBasis = {"matrix": np.eye(6), "type": "NormalModes"}
        >>> mbs = exudyn.SystemContainer().AddSystem()
        >>> rotor = mbs.CreateFixedAxisFFRFReducedOrderObject(
        ...     name="rotor", femInterface=fem, axis="z", translation="none", spin=100.0
        ... )
        >>> force = mbs.CreateForce(itemNumber=rotor["rotor:top"], loadVector=[0.0, 0.0, 5.0])
        >>> rotor["FFRFReducedOrderObjectDict"]["rotorBody"]
        RotorBody('rotor', Sect. 2.5, stiffening 'tilt', 6 modes, markers: top)
    """
    inputs.main_system(mbs)
    checks.instance(femInterface, "femInterface", FEMinterface)
    _check_prestress(checks.choice(stiffening, "stiffening", LEVELS), prestress)
    rotation = checks.rotation(referenceRotationMatrix, "referenceRotationMatrix")
    omega = checks.vector(initialAngularVelocity, "initialAngularVelocity", "rad/s")
    velocity = checks.vector(initialVelocity, "initialVelocity", "m/s")
    # what add_rotor checks, under the names of this call
    arguments = {
        "position": checks.vector(referencePosition, "referencePosition", "m"),
        "mass_damping": checks.number(
            massProportionalDamping, "massProportionalDamping", "1/s", least=0.0
        ),
        "stiffness_damping": checks.number(
            stiffnessProportionalDamping, "stiffnessProportionalDamping", "s", least=0.0
        ),
        "markers": checks.choice(markers, "markers", inputs.MARKER_KINDS),
        "show_markers": checks.flag(showMarkers, "showMarkers"),
        "condense_markers": checks.flag(condense_markers, "condense_markers"),
    }
    checks.flag(verbose, "verbose")
    if axis is None:
        axis = SpinAxis(rotation.T @ omega) if np.any(omega) else axis_through_seats(femInterface)
    rotor = SolidRotor.from_fem_interface(femInterface, axis)
    offsets = _offsets(list(rotor.interfaces), superElementRigidMarkersOffsets)
    formulation = Formulation(translation, spin)
    speed = _speed_along(rotation @ rotor.axis.direction, omega)
    initial_speed = _initial_speed(formulation, speed)
    reduced = rotor.reduce(femInterface, prestress=prestress)
    if formulation.translation_count:
        velocity = velocity + np.cross(omega, rotation @ reduced.center_of_mass)
    body = add_rotor(
        mbs,
        reduced,
        name=name,
        translation=translation,
        spin=spin,
        stiffening=stiffening,
        rotation=rotation,
        initial_velocity=velocity,
        initial_speed=initial_speed,
        gravity=gravity,
        marker_offsets=offsets,
        locking=locking,
        color=color,
        **arguments,
    )
    if verbose:
        exudyn.Print(body.report())
    return _dictionary(body)


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


def axis_through_seats(fem: FEMinterface) -> SpinAxis:
    """Return the line through the centres of the node sets, for a rotor that starts at rest.

    The seats of bearings and couplings lie on the spin axis. A line that is a mesh axis but for the
    unevenness of the mesh is taken as that axis.

    Raises
    ------
    ValueError
        If there are fewer than two seats, or their centres are not on one line.
    """
    model = import_model(fem)
    positions = np.asarray(model.nodes)
    centers = np.array(
        [
            np.average(positions[nodes], axis=0, weights=weights)
            for nodes, weights in model.node_sets.values()
        ]
    ).reshape(-1, 3)
    mean = centers.mean(axis=0) if len(centers) else np.zeros(3)
    _, spread, lines = np.linalg.svd(centers - mean)
    if len(centers) < 2 or spread[0] == 0.0 or np.any(spread[1:] > _UNEVEN * spread[0]):
        raise ValueError(
            "the spin axis is not known: the rotor starts at rest, and the centres of its "
            f"{len(centers)} node sets are not on one line; give axis='x', 'y', 'z' or a "
            "direction in mesh coordinates"
        )
    direction = lines[0] * np.sign(lines[0][np.argmax(np.abs(lines[0]))])
    nearest = np.eye(3)[np.argmax(direction)]
    offset = mean - nearest * (nearest @ mean)
    if np.linalg.norm(direction - nearest) < _UNEVEN:
        direction = nearest
        if np.linalg.norm(offset) < _UNEVEN * spread[0]:
            mean = np.zeros(3)
    return SpinAxis(direction, mean)


# share of the length by which an uneven mesh may put the centres of round faces off the axis
_UNEVEN = 1e-2


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


def _offsets(interfaces: list[str], offsets: ArrayLike | None) -> dict[str, np.ndarray]:
    if offsets is None:
        return {}
    table = checks.array(offsets, "superElementRigidMarkersOffsets", "m")
    if table.shape != (len(interfaces), 3):
        raise ValueError(
            f"superElementRigidMarkersOffsets: needs {len(interfaces)} × 3 finite numbers for the "
            f"interfaces {', '.join(interfaces) or 'none'}, got {checks.shown(offsets)}"
        )
    return dict(zip(interfaces, table, strict=True))


def _dictionary(body: RotorBody) -> dict:
    result = {
        "FFRFReducedOrderObjectDict": {
            "nRigidBody": body.nodes["rigid"],
            "nGenericODE2": body.nodes["modes"],
            "oFFRFreducedOrder": body.objects["marker_body"],
            "loadGravity": body.gravity_load,
            "rotorBody": body,
        }
    }
    return result | {
        inputs.marker_name(body.name, interface): marker
        for interface, marker in body.markers.items()
    }


install()
