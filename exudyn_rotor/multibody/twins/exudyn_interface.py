"""``ObjectFixedAxisFFRFreducedOrderInterface``: the twin of Exudyn's class for flexible bodies.

Names of arguments, methods and returned keys are those of
``exudyn.FEM.ObjectFFRFreducedOrderInterface``; changing the name of the class swaps the
formulation.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from types import ModuleType
from typing import Any

import exudyn
import numpy as np
from exudyn.FEM import FEMinterface
from exudyn.utilities import EulerParameters2RotationMatrix
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.rotor import inputs
from exudyn_rotor.multibody.rotor.node_markers import carry_markers
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.twins.later_stress import StressConversion, accept_stress_modes
from exudyn_rotor.multibody.twins.swapped_body import (
    Additions,
    State,
    add_swapped_body,
    numbers,
    solid_rotor,
)
from exudyn_rotor.reduction.mean_axis import frame_shares, warn_of_held_frame
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import ConstantSpeed, PrescribedMotion

_UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_NODE_TYPES = [f"NodeType.{kind}" for kind in exudyn.NodeType.__members__]
_GREEN = (0.1, 0.9, 0.1, 1.0)  # Exudyn's default colour here


class ObjectFixedAxisFFRFreducedOrderInterface:
    """A flexible rotor that spins about one fixed axis, made from a ``FEMinterface``.

    The twin of ``exudyn.FEM.ObjectFFRFreducedOrderInterface``: a script changes the name of the
    class and gives the axis. All arguments after `roundStiffnessMatrix` are the twin's own.

    Parameters
    ----------
    femInterface : FEMinterface, optional
        With mesh, mass and stiffness matrix and a mode basis. None makes an empty object for
        :meth:`LoadFromFile`.
    rigidBodyNodeType : str or exudyn.NodeType
        Accepted, and without effect: the frame's node always has Tait–Bryan angles.
    roundMassMatrix, roundStiffnessMatrix : float
        Accepted, and without effect: the modes are made mass-orthonormal.
    axis : SpinAxis, {'x', 'y', 'z'} or array_like, optional
        Spin axis in mesh coordinates; None takes the direction of `initialAngularVelocity` when the
        body is added, its largest component positive, if a principal axis of inertia is within 10°;
        or at rest the line through the centres of the node sets, if these and the body are round
        about it.
    translation, spin : optional
        The formulation; see :class:`exudyn_rotor.Formulation`. ``'auto'`` is ``'free'``, but
        ``'none'`` for a rotor that its own stiffness matrix holds.
    spin_coupling : {'full', 'frozen'}
        For a free spin; see :func:`exudyn_rotor.add_rotor`.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening; ``'full'`` needs `prestress`. ``'auto'`` is ``'full'`` with one,
        else ``'tilt'``: a FEMinterface has no elements to compute it on.
    locking : {'auto', 'mass', 'constraints'}
        See :func:`exudyn_rotor.add_rotor`.
    markers : {'rigid', 'position'}, optional
        Kind of markers that are added at all node sets; None adds none, as Exudyn's class, and the
        script makes its own.
    condense_markers : bool
        Whether ``mbs.Assemble()`` moves the script's markers on many mesh nodes to few added nodes
        with the same mean motion: the same to round-off, and faster.
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
    Markers and sensors at the node ``nRigidBody`` move as on Exudyn's body, in the mesh origin.
    The flexible object is the first object that is added. Stress modes that a script sets later,
    six columns for each mode of the FEMinterface, are converted to the rotor's coordinates.
    It warns where Exudyn's own body would soften falsely with these modes; see
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
        condense_markers: bool = True,
        prestress: Prestress | None = None,
    ) -> None:
        if not isinstance(rigidBodyNodeType, exudyn.NodeType):
            checks.choice(rigidBodyNodeType, "rigidBodyNodeType", _NODE_TYPES)
        checks.number(roundMassMatrix, "roundMassMatrix", least=0.0)
        checks.number(roundStiffnessMatrix, "roundStiffnessMatrix", least=0.0)
        self._more = Additions.checked(
            *(translation, spin, spin_coupling, stiffening, locking),
            *(markers, condense_markers, prestress),
        )
        self._axis = None if axis is None else SpinAxis.of(axis)
        self._fem: FEMinterface | None = None
        self._solid: SolidRotor | None = None
        self._reduced: ReducedRotor | None = None
        self.rotorBody: RotorBody | None = None
        if femInterface is not None:
            self._fem = checks.instance(femInterface, "femInterface", FEMinterface)
            self._reduced = None if self._axis is None else self._reduce(None)
            self._show(_modes(femInterface), np.asarray(femInterface.nodes["Position"]))
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
        return self._add(
            mbs,
            name,
            positionRef,
            rotationMatrixRef,
            velocity=initialVelocity,
            omega=initialAngularVelocity,
            mass_damping=massProportionalDamping,
            stiffness_damping=stiffnessProportionalDamping,
            gravity=gravity,
            color=color,
        )

    def _add(
        self,
        mbs: exudyn.MainSystem,
        name: str,
        position: ArrayLike,
        rotation: ArrayLike,
        **more: Any,
    ) -> dict:
        """Add the rotor; warnings point at what called the method that calls this."""
        inputs.main_system(mbs)
        label = None if isinstance(name, str) and name == "" else checks.label(name, "name")
        rotation = _UNIT if _empty(rotation) else rotation
        start = State.checked(("positionRef", position), ("rotationMatrixRef", rotation), **more)
        reduced = self._reduce(start) if self._reduced is None else self._reduced
        conversion = None
        if self._solid is not None:
            warn_of_held_frame(self._solid, self.modeBasis, stacklevel=3)
            conversion = StressConversion(self.modeBasis, reduced, self._fem.postProcessingModes)
        body = add_swapped_body(mbs, label, reduced, start, self._more)
        if conversion is not None:
            accept_stress_modes(body, conversion)
            carry_markers(body, frame_shares(self._solid, reduced, self.modeBasis))
        self.rotorBody = body
        made = numbers(body)
        self.nRigidBody, self.nGenericODE2 = made["nRigidBody"], made["nGenericODE2"]
        self.oFFRFreducedOrder, self.loadGravity = made["oFFRFreducedOrder"], made["loadGravity"]
        return made

    def AddObjectFFRFreducedOrderWithUserFunctions(
        self,
        exu: ModuleType,
        mbs: exudyn.MainSystem,
        positionRef: ArrayLike = (0.0, 0.0, 0.0),
        initialVelocity: ArrayLike = (0.0, 0.0, 0.0),
        rotationMatrixRef: ArrayLike = (),
        initialAngularVelocity: ArrayLike = (0.0, 0.0, 0.0),
        gravity: ArrayLike = (0.0, 0.0, 0.0),
        UFforce: Callable | int = 0,
        UFmassMatrix: Callable | int = 0,
        massProportionalDamping: float = 0.0,
        stiffnessProportionalDamping: float = 0.0,
        color: ArrayLike = _GREEN,
        eulerParametersRef: ArrayLike = (),
        name: str = "",
    ) -> dict:
        """Add the rotor to `mbs`, by the arguments of Exudyn's longer call.

        As :meth:`AddObjectFFRFreducedOrder`, whose other arguments it takes, too.

        Parameters
        ----------
        exu : module
            Exudyn.
        UFforce, UFmassMatrix : 0
            User functions of Exudyn's equations are refused: the rotor has its own.
        eulerParametersRef : array_like, shape (4,)
            The orientation, in place of `rotationMatrixRef`.
        """
        checks.instance(exu, "exu", ModuleType, "import exudyn as exu")
        if not exu.__name__.startswith("exudyn"):
            raise ValueError(f"exu: needs the module exudyn, got {checks.shown(exu)}")
        for argument, function in (("UFforce", UFforce), ("UFmassMatrix", UFmassMatrix)):
            if function is not None and not _is_zero(function):
                raise ValueError(
                    f"{argument}: needs 0, got {checks.shown(function)}; user functions replace "
                    "the equations of Exudyn's body, and a fixed-axis rotor has its own: leave "
                    "UFforce and UFmassMatrix out, and add other forces as loads or connectors"
                )
        if not _empty(eulerParametersRef):
            if not _empty(rotationMatrixRef):
                raise ValueError(
                    "orientation given twice: by rotationMatrixRef and by eulerParametersRef"
                )
            rotationMatrixRef = _orientation(eulerParametersRef)
        return self._add(
            mbs,
            name,
            positionRef,
            rotationMatrixRef,
            velocity=initialVelocity,
            omega=initialAngularVelocity,
            mass_damping=massProportionalDamping,
            stiffness_damping=stiffnessProportionalDamping,
            gravity=gravity,
            color=color,
        )

    def SaveToFile(self, fileName: str | os.PathLike, fileVersion: int = 1) -> None:
        """Save the reduced rotor, as ``ReducedRotor.save`` does.

        Parameters
        ----------
        fileName : path-like
            '.npz' is added where it is missing.
        fileVersion : 1
            Exudyn's argument; there is one version.
        """
        checks.count(fileVersion, "fileVersion", least=1, most=1)
        if self._reduced is None:
            raise ValueError(
                "fileName: nothing to save before the spin axis is known; give axis= when the "
                "interface is made"
            )
        self._reduced.save(_file(fileName))

    def LoadFromFile(self, fileName: str | os.PathLike, mode: str | None = None) -> int:
        """Load what :meth:`SaveToFile` or ``ReducedRotor.save`` has written; return 1, the version.

        Files of Exudyn's own class hold other matrices and are refused.

        Parameters
        ----------
        fileName : path-like
            '.npz' is added where it is missing.
        mode : {'NPZ', None}
        """
        if mode is not None:
            checks.choice(mode, "mode", ("NPZ",))
        reduced = ReducedRotor.load(_file(fileName))
        if self._axis is not None and not np.allclose(
            self._axis.direction, reduced.axis.direction, atol=1e-9
        ):
            raise ValueError(
                f"fileName: the file's spin axis is {reduced.axis.direction.tolist()}, this "
                f"interface has axis {self._axis.direction.tolist()}"
            )
        self._reduced, self._fem, self._solid = reduced, None, None
        if reduced.shapes is not None:
            elastic = reduced.shapes.matrix[:, len(reduced.rigid_kinds) :]
            self._show(elastic, reduced.shapes.nodes)
        self.postProcessingModes = {}
        return 1

    def _reduce(self, start: State | None) -> ReducedRotor:
        if self._fem is None:
            raise ValueError(
                "femInterface: this interface is empty; give a FEMinterface, or call LoadFromFile"
            )
        self._solid = solid_rotor(self._fem, self._axis, start)
        return self._solid.reduce(self._fem, prestress=self._more.prestress)

    def _show(self, modes: np.ndarray, nodes: np.ndarray) -> None:
        self.modeBasis, self.xRef = modes, nodes.ravel()
        self.nNodes, self.nModes, self.dim3D = len(nodes), modes.shape[1], 3


def _modes(fem: FEMinterface) -> np.ndarray:
    """Return the modes, checked already where the axis is known."""
    if "matrix" not in fem.modeBasis:
        raise ValueError(
            "femInterface: it holds no modes; call fem.ComputeEigenmodes(…) or "
            "fem.ComputeHurtyCraigBamptonModes(…) first"
        )
    return checks.matrix(fem.modeBasis["matrix"], "femInterface: its modes")


def _is_zero(value: object) -> bool:
    number = isinstance(value, int | float | np.number | np.ndarray) and np.ndim(value) == 0
    return bool(number and value == 0)


def _empty(values: ArrayLike | None) -> bool:
    sized = isinstance(values, list | tuple) or (isinstance(values, np.ndarray) and values.ndim)
    return bool(sized and len(values) == 0)


def _orientation(parameters: ArrayLike) -> np.ndarray:
    values = checks.vector(parameters, "eulerParametersRef", size=4)
    if abs(np.linalg.norm(values) - 1.0) > 1e-9:
        raise ValueError(
            f"eulerParametersRef: needs 4 numbers of norm 1, got {checks.shown(parameters)}"
        )
    return np.asarray(EulerParameters2RotationMatrix(values))


def _file(name: str | os.PathLike) -> str:
    text = os.fspath(checks.path(name, "fileName"))
    return text if text.lower().endswith(".npz") else f"{text}.npz"
