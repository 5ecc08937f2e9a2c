"""``ObjectFixedAxisFFRFreducedOrderInterface``: the twin of Exudyn's class for flexible bodies.

Names of arguments, methods and returned keys are those of
``exudyn.FEM.ObjectFFRFreducedOrderInterface``; changing the name of the class swaps the
formulation. The twin of the call is a use of it.
"""

from __future__ import annotations

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.add_rotor import add_rotor
from exudyn_rotor.multibody.rotor.plan import LOCKINGS, MARKER_KINDS, main_system
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import (
    ConstantSpeed,
    Formulation,
    PrescribedMotion,
    start_values,
    suited_translation,
)
from exudyn_rotor.theory.stiffening import CHOICES

_NODE_TYPES = [f"NodeType.{kind}" for kind in exudyn.NodeType.__members__]
_GREEN = (0.1, 0.9, 0.1, 1.0)  # Exudyn's default colour here
_STRESS = (
    "SolidRotor.from_ngsolve(…).prestress() with the same mesh or Prestress(matrix, nodes) makes "
    "one; a FEMinterface has no elements to compute it on"
)
_SAME = 1e-9  # share of an angular velocity by which it may differ from another
_SEEN = 1e-6  # share of a mode's mass that moves as a rigid body, above rounding of free modes


class ObjectFixedAxisFFRFreducedOrderInterface:
    """A flexible rotor that spins about one fixed axis, made from a ``FEMinterface``.

    The twin of ``exudyn.FEM.ObjectFFRFreducedOrderInterface``: a script changes the name of the
    class and gives the axis. All arguments after `roundStiffnessMatrix` are the twin's own.

    Parameters
    ----------
    femInterface : FEMinterface
        With mesh, mass and stiffness matrix, a mode basis, and stress modes where the script shows
        stress.
    rigidBodyNodeType : str or exudyn.NodeType
        Accepted, and without effect: the frame's node always has Tait–Bryan angles.
    roundMassMatrix, roundStiffnessMatrix : float
        Accepted, and without effect: the modes are made mass-orthonormal.
    axis : SpinAxis, {'x', 'y', 'z'} or array_like, optional
        Spin axis in mesh coordinates; None takes the direction of `initialAngularVelocity` when the
        body is added, its largest component positive, through the mesh origin.
    translation, spin : optional
        The formulation; see :class:`exudyn_rotor.Formulation`. ``'auto'`` is ``'free'``, but
        ``'none'`` for a rotor that its own stiffness matrix holds.
    spin_coupling : {'full', 'frozen'}
        For a free spin; see :func:`exudyn_rotor.add_rotor`.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening; ``'full'`` needs `prestress`. ``'auto'`` is ``'full'`` with one,
        else ``'tilt'``: a FEMinterface has no elements to compute it on.
    locking : {'auto', 'constraints', 'mass'}
        See :func:`exudyn_rotor.add_rotor`.
    markers : {'rigid', 'position'}, optional
        Kind of markers that are added at all node sets; None adds none, as Exudyn's class, and the
        script makes its own.
    prestress : Prestress, optional
        Static stress for ``stiffening='full'``.

    Attributes
    ----------
    modeBasis : ndarray, shape (3n, r)
        Modes of the FEMinterface. The rotor has rigid motions beside them.
    xRef : ndarray, shape (3n,)
        Node positions [m].
    nModes, nNodes, dim3D : int
        Number of modes and mesh nodes, and 3.
    postProcessingModes : dict
        Stress modes of the FEMinterface.
    rotorBody : RotorBody or None
        The rotor that was added last; and, as in Exudyn's class, the numbers ``nRigidBody``,
        ``nGenericODE2``, ``oFFRFreducedOrder``, ``loadGravity``.

    Raises
    ------
    TypeError, ValueError
        For bad input, or a FEMinterface without modes.

    Notes
    -----
    What is attached to rigid and position markers at the node ``nRigidBody`` acts as on Exudyn's
    body, in the mesh origin. The flexible object is the first object that is added.
    Exudyn's own body may soften falsely with Craig–Bampton modes; see
    :func:`exudyn_rotor.use_mean_axis_modes`.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> import scipy.sparse as sp
    >>> from exudyn.FEM import FEMinterface
    >>> from exudyn_rotor import ObjectFixedAxisFFRFreducedOrderInterface
    >>> fem = FEMinterface()
    >>> fem.nodes = {"Position": np.array([[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]])}
    >>> fem.massMatrix, fem.stiffnessMatrix = sp.eye(6).tocsr(), 1e6 * sp.eye(6).tocsr()
    >>> fem.modeBasis = {"matrix": np.eye(6), "type": "NormalModes"}
    >>> cms = ObjectFixedAxisFFRFreducedOrderInterface(
    ...     fem, axis="z", translation="none", spin=10.0
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> rotor = cms.AddObjectFFRFreducedOrder(mbs, initialAngularVelocity=[0, 0, 10.0], name="fan")
    >>> rotor["oFFRFreducedOrder"], rotor["rotorBody"]
    (0, RotorBody('fan', Sect. 2.5, stiffening 'tilt', 6 modes, markers: none))
    """

    def __init__(
        self,
        femInterface: FEMinterface | None = None,
        rigidBodyNodeType: str | exudyn.NodeType = "NodeType.RotationEulerParameters",
        roundMassMatrix: float = 1e-13,
        roundStiffnessMatrix: float = 1e-13,
        axis: SpinAxis | str | ArrayLike | None = None,
        translation: str | PrescribedMotion = "auto",
        spin: str | float | ConstantSpeed | PrescribedMotion = "free",
        spin_coupling: str = "full",
        stiffening: str = "auto",
        locking: str = "auto",
        markers: str | None = None,
        prestress: Prestress | None = None,
    ) -> None:
        if not isinstance(rigidBodyNodeType, exudyn.NodeType):
            checks.choice(rigidBodyNodeType, "rigidBodyNodeType", _NODE_TYPES)
        checks.number(roundMassMatrix, "roundMassMatrix", least=0.0)
        checks.number(roundStiffnessMatrix, "roundStiffnessMatrix", least=0.0)
        self._fem = checks.instance(femInterface, "femInterface", FEMinterface)
        checks.choice(stiffening, "stiffening", CHOICES)
        if prestress is not None:
            checks.instance(prestress, "prestress", Prestress, _STRESS)
        elif stiffening == "full":
            raise ValueError(
                f"stiffening='full' needs the static stress: give prestress=; {_STRESS}"
            )
        Formulation(suited_translation(translation, False), spin, spin_coupling=spin_coupling)
        self._axis, self._prestress = None if axis is None else SpinAxis.of(axis), prestress
        self._options = {
            "translation": translation,
            "spin": spin,
            "spin_coupling": spin_coupling,
            "stiffening": stiffening,
            "locking": checks.choice(locking, "locking", LOCKINGS),
            "markers": {} if markers is None else checks.choice(markers, "markers", MARKER_KINDS),
        }
        self.rotorBody: RotorBody | None = None
        if "matrix" not in femInterface.modeBasis:
            raise ValueError(
                "femInterface: it holds no modes; call fem.ComputeEigenmodes(…) or "
                "fem.ComputeHurtyCraigBamptonModes(…) first"
            )
        self.modeBasis = checks.matrix(femInterface.modeBasis["matrix"], "femInterface: its modes")
        nodes = np.asarray(femInterface.nodes["Position"])
        self.xRef, self.nNodes, self.nModes = nodes.ravel(), len(nodes), self.modeBasis.shape[1]
        self.dim3D = 3
        self.postProcessingModes = femInterface.postProcessingModes

    def AddObjectFFRFreducedOrder(
        self,
        mbs: exudyn.MainSystem,
        positionRef: ArrayLike = (0.0, 0.0, 0.0),
        initialVelocity: ArrayLike = (0.0, 0.0, 0.0),
        rotationMatrixRef: ArrayLike = (),
        initialAngularVelocity: ArrayLike = (0.0, 0.0, 0.0),
        massProportionalDamping: float = 0.0,
        stiffnessProportionalDamping: float = 0.0,
        gravity: ArrayLike = (0.0, 0.0, 0.0),
        color: ArrayLike = _GREEN,
        name: str = "",
    ) -> dict:
        """Add the rotor to `mbs`.

        Parameters
        ----------
        mbs : exudyn.MainSystem
        positionRef, initialVelocity : array_like, shape (3,)
            Of the mesh origin, inertial axes [m], [m/s].
        rotationMatrixRef : array_like, shape (3, 3)
            Mesh axes → inertial axes; empty for the unit matrix.
        initialAngularVelocity : array_like, shape (3,)
            Inertial axes [rad/s]; must lie along the spin axis.
        massProportionalDamping, stiffnessProportionalDamping : float
            Rayleigh factors of the component modes [1/s], [s].
        gravity : array_like, shape (3,)
            Inertial axes [m/s²].
        color : sequence of 4 floats
            RGBA.
        name : str
            The nodes are called 'NodeRigidBody:' + name and 'NodeGeneric:' + name; empty for none.

        Returns
        -------
        dict
            ``'nRigidBody'``, ``'nGenericODE2'``, ``'oFFRFreducedOrder'``, ``'loadGravity'`` as in
            Exudyn, and ``'rotorBody'``.

        Raises
        ------
        TypeError, ValueError
            For bad input; nothing has been added then.
        """
        main_system(mbs)
        label = None if isinstance(name, str) and name == "" else checks.label(name, "name")
        place, turn = checks.vector(positionRef, "positionRef", "m"), np.eye(3)
        if np.size(rotationMatrixRef):
            turn = checks.rotation(rotationMatrixRef, "rotationMatrixRef")
        velocity = checks.vector(initialVelocity, "initialVelocity", "m/s")
        omega = checks.vector(initialAngularVelocity, "initialAngularVelocity", "rad/s")
        mass_damping = checks.number(massProportionalDamping, "massProportionalDamping", least=0.0)
        stiffness_damping = checks.number(
            stiffnessProportionalDamping, "stiffnessProportionalDamping", least=0.0
        )
        axis = _axis_of(turn.T @ omega) if self._axis is None else self._axis
        rotor = SolidRotor.from_fem_interface(self._fem, axis)
        reduced = rotor.reduce(self._fem, prestress=self._prestress)
        translation = suited_translation(self._options["translation"], reduced.grounded)
        formulation = Formulation(translation, self._options["spin"])
        if formulation.translation_count:  # Exudyn's is the velocity of the mesh origin
            velocity = velocity + np.cross(omega, turn @ reduced.center_of_mass)
        self.rotorBody = body = add_rotor(
            mbs,
            reduced,
            name=label,
            position=place,
            rotation=turn,
            initial_velocity=velocity,
            initial_speed=_initial_speed(formulation, turn @ reduced.axis.direction, omega),
            gravity=gravity,
            mass_damping=mass_damping,
            stiffness_damping=stiffness_damping,
            color=color,
            **self._options | {"translation": translation},
        )
        body.script.frame_shares = _frame_shares(rotor, reduced, self.modeBasis)
        self.nRigidBody, self.nGenericODE2 = body.nodes["rigid"], body.nodes["modes"]
        self.oFFRFreducedOrder, self.loadGravity = body.objects["marker_body"], body.gravity_load
        names = "nRigidBody", "nGenericODE2", "oFFRFreducedOrder", "loadGravity", "rotorBody"
        return {name: getattr(self, name) for name in names}


def _frame_shares(
    rotor: FiniteElementRotor, reduced: ReducedRotor, modes: np.ndarray
) -> np.ndarray | None:
    """Return how the frame of Exudyn's body moves with the columns of a rotor reduced with `modes`.

    In shares (r, k − r) of the rigid columns of `reduced`; None where they are zero, as for free
    eigenmodes. Displacements are ``Rρ + Ψη`` with the modes Ψ in Exudyn's body, and ``Rρ' + Qζ``
    here with the columns ``Q = (Ψ − RG_r) G_f⁺``, where ``G = [R Q]ᵀMΨ``; so ``ρ = ρ' − G_rG_f⁺ζ``.
    """
    rigid = len(reduced.rigid_kinds)
    G = reduced.shapes.matrix.T @ (rotor.mass @ modes)
    if np.all((G[:rigid] ** 2).sum(axis=0) <= _SEEN * (G**2).sum(axis=0)):
        return None
    return -G[:rigid] @ np.linalg.pinv(G[rigid:])


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


def _initial_speed(
    formulation: Formulation, direction: np.ndarray, omega: np.ndarray
) -> float | None:
    """Return the speed of a free spin along its axis; a prescribed one must agree with it."""
    speed = float(direction @ omega)
    across = np.linalg.norm(omega - speed * direction)
    if across > _SAME * np.linalg.norm(omega):
        raise ValueError(
            f"initialAngularVelocity {omega.tolist()} has {across:.3g} rad/s across the spin axis "
            f"{direction.tolist()}: a fixed-axis rotor cannot tumble; start it with modal "
            "velocities of its tilt modes (exudyn_rotor.add_rotor), or use the 3D body"
        )
    if formulation.has_spin:
        return speed
    _, prescribed, _ = start_values(formulation.spin, "spin")
    if speed and abs(speed - prescribed) > _SAME * abs(prescribed):
        raise ValueError(
            f"spin given twice: initialAngularVelocity is {speed} rad/s along the axis, "
            f"the prescribed spin starts with {prescribed} rad/s"
        )
    return None
