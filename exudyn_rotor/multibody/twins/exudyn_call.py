"""What importing the package does to Exudyn's ``MainSystem``: the twin of a call, and ``Assemble``.

Argument names, defaults and returned keys of ``mbs.CreateFixedAxisFFRFReducedOrderObject`` are
those of ``mbs.CreateFFRFReducedOrderObject``; changing the name of the call swaps the formulation.
What ``mbs.Assemble()`` does for rotors stands in :mod:`exudyn_rotor.multibody.rotor.assembly`.
"""

from __future__ import annotations

from functools import wraps
from typing import TYPE_CHECKING

import exudyn
from exudyn.misc.extensionRegistry import extends, install
from numpy.typing import ArrayLike

from exudyn_rotor.multibody import ENTRY

if TYPE_CHECKING:
    from exudyn.FEM import FEMinterface

    from exudyn_rotor.solid.carried_prestress import Prestress
    from exudyn_rotor.theory.axis import SpinAxis
    from exudyn_rotor.theory.formulation import ConstantSpeed, PrescribedMotion


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
    translation: str | PrescribedMotion = "auto",
    spin: str | float | ConstantSpeed | PrescribedMotion = "free",
    spin_coupling: str = "full",
    stiffening: str = "auto",
    locking: str = "auto",
    markers: str = "rigid",
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
        superElementRigidMarkersOffsets: local offset per rigid marker, N x 3, mesh axes; it turns
            with the mean rotation of the body, as there. The whole lever of a rigid interface, by
            its own rotation, has rotorBody.add_marker(interface, offset)
        showMarkers: if True, the markers are drawn
        verbose: if True, a report of the new body is printed
        axis: spin axis in mesh coordinates: 'x', 'y', 'z', a direction, or (one of these, point);
            None takes the direction of initialAngularVelocity, its largest component positive,
            through the mesh origin
        translation: 'free', 'in-plane', 'none', a PrescribedMotion, or 'auto': 'free', since
            supports and loads are not known yet, but 'none' for a rotor that its own stiffness
            matrix holds
        spin: 'free', a constant speed in rad/s, or a PrescribedMotion
        spin_coupling: 'full', or 'frozen' for a free spin whose inertia is that of the undeformed
            rotor, at half the Python calls of a step; see exudyn_rotor.add_rotor
        stiffening: centrifugal stiffening, 'tilt' or 'none' (the paper's equations); 'full' needs
            prestress; 'auto' is 'full' with prestress, else 'tilt'
        locking: 'auto', 'constraints', or 'mass' for explicit solvers and a prescribed spin; see
            exudyn_rotor.add_rotor
        markers: kind of the markers, 'rigid' or 'position'; the latter serves springs and forces
            at a fraction of the cost
        prestress: static stress for stiffening='full', since a FEMinterface holds no elements to
            compute it on: SolidRotor.prestress() of a rotor from NGSolve with the same mesh, or
            Prestress(matrix, nodes) with the geometric stiffness of another program

    Returns:
        :dict: marker number of every boundary under its marker name, and under
            'FFRFReducedOrderObjectDict' the entries 'nRigidBody', 'nGenericODE2',
            'oFFRFreducedOrder', 'loadGravity' and 'rotorBody'

    Note:
        What a script attaches to rigid and position markers at the node 'nRigidBody' acts in the
        mesh origin, and moves and tilts with the rotor, as on Exudyn's body with these modes. The
        node's own coordinates are the spin and the translation of the centre of mass;
        mbs.GetNodeOutput(), sensors of the node and markers of single coordinates see these, and
        body.check_connections() names what they lack. In local output (DisplacementLocal) the modes
        hold the rigid tilts, which Exudyn's own frame takes. Stress modes must be in the
        FEMinterface before.

        Craig-Bampton modes of FEMinterface hold the frame of Exudyn's own body at the first
        boundary, and what tilts the rotor against it softens falsely with the square of the speed;
        use_mean_axis_modes(fem) gives both bodies the same modes.

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
    # not before: importing the package adds this method, and most scripts do not call it
    from exudyn_rotor import checks
    from exudyn_rotor.multibody.rotor.plan import MARKER_KINDS, main_system, marker_name
    from exudyn_rotor.multibody.twins.exudyn_interface import (
        ObjectFixedAxisFFRFreducedOrderInterface,
    )

    main_system(mbs)
    checks.flag(showMarkers, "showMarkers")
    checks.flag(verbose, "verbose")
    checks.choice(markers, "markers", MARKER_KINDS)
    made = ObjectFixedAxisFFRFreducedOrderInterface(
        femInterface,
        axis=axis,
        translation=translation,
        spin=spin,
        spin_coupling=spin_coupling,
        stiffening=stiffening,
        locking=locking,
        markers=markers,
        prestress=prestress,
    )
    offsets = superElementRigidMarkersOffsets
    if offsets is not None:
        shape = (len(femInterface.nodeSets), 3)
        offsets = checks.array(offsets, "superElementRigidMarkersOffsets", "m", shape=shape)
        if markers != "rigid":
            raise ValueError(
                f"superElementRigidMarkersOffsets: needs markers='rigid', got {markers!r}"
            )
    numbers = made.AddObjectFFRFreducedOrder(
        mbs,
        checks.vector(referencePosition, "referencePosition", "m"),
        initialVelocity,
        checks.rotation(referenceRotationMatrix, "referenceRotationMatrix"),
        initialAngularVelocity,
        massProportionalDamping,
        stiffnessProportionalDamping,
        gravity,
        color,
        "" if name is None else checks.label(name, "name"),
    )
    body = made.rotorBody
    for number, marker in enumerate(body.markers.values()):
        mbs.SetMarkerParameter(marker, "Vshow", showMarkers)
        if offsets is not None:
            # Exudyn's own, which turns with the mean rotation, not with that of the interface
            mbs.SetMarkerParameter(marker, "offset", body.frame.B @ offsets[number])
    if verbose:
        exudyn.Print(body.report())
    return {"FFRFReducedOrderObjectDict": numbers} | {
        marker_name(body.name, interface): marker for interface, marker in body.markers.items()
    }


_OWN = "_knows_fixed_axis_rotors"  # attribute of the wrapped method


def _wrap_assemble() -> None:
    """Let ``mbs.Assemble()`` look after rotors; once, however often the package is imported."""
    original = exudyn.MainSystem.Assemble
    if hasattr(original, _OWN):
        return

    @wraps(original)
    def assemble(mbs: exudyn.MainSystem) -> None:
        if ENTRY not in mbs.sys:
            return original(mbs)
        from exudyn_rotor.multibody.rotor import assembly

        assembly.prepare(mbs)
        original(mbs)
        return assembly.warn_of_lost_connections(mbs, stacklevel=3)

    setattr(assemble, _OWN, True)
    exudyn.MainSystem.Assemble = assemble


_wrap_assemble()
install()
