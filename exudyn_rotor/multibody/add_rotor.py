"""Adding a rotor to an Exudyn ``mbs``: checks first, then nodes, objects, markers."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import exudyn
import numpy as np
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.multibody.full.add_full import add_full, check_memory, make_full_plan
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.plan import (
    LOCKINGS,
    Plan,
    Setup,
    add_nodes,
    check_free,
    color_of,
    in_space,
    main_system,
    make_plan,
    marker_kinds,
    marker_name,
    placement,
)
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.rotor_items import finished, flexible_body
from exudyn_rotor.prestress.carrying import with_chosen_prestress
from exudyn_rotor.reduction.reduced_rotor import ModeShapes, ReducedRotor
from exudyn_rotor.solid.rotor import LOSS_LEFT_OUT
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.formulation import (
    ConstantSpeed,
    Formulation,
    PrescribedMotion,
    suited_translation,
)
from exudyn_rotor.theory.kernel import Kernel, constant_part
from exudyn_rotor.theory.stiffening import CHOICES, chosen_level, warn_of_left_out

DEFAULT_COLOR = (0.62, 0.70, 0.80, 1.0)


def add_rotor(
    mbs: exudyn.MainSystem,
    rotor: ReducedRotor | SolidRotor,
    *,
    name: str | None = "rotor",
    translation: str | PrescribedMotion = "free",
    spin: str | float | ConstantSpeed | PrescribedMotion = "free",
    drive: str = "rigid",
    spin_coupling: str = "full",
    stiffening: str = "auto",
    position: ArrayLike = (0.0, 0.0, 0.0),
    rotation: ArrayLike | None = None,
    initial_velocity: ArrayLike = (0.0, 0.0, 0.0),
    initial_angle: float | None = None,
    initial_speed: float | None = None,
    modal_coordinates: ArrayLike | None = None,
    modal_velocities: ArrayLike | None = None,
    gravity: ArrayLike = (0.0, 0.0, 0.0),
    mass_damping: float = 0.0,
    stiffness_damping: float = 0.0,
    markers: Mapping[str, str] | str | None = None,
    locking: str = "auto",
    color: Sequence[float] = DEFAULT_COLOR,
) -> RotorBody | FullRotorBody:
    """Add a fixed-axis rotor to `mbs`.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    rotor : ReducedRotor or SolidRotor
        A reduced rotor, or a solid one for the full formulation; see the notes.
    name : str or None
        Unique name; items are called like those of Exudyn's own flexible body. None leaves them
        without names; markers are then called like their interfaces.
    translation, spin, drive
        The formulation; see :class:`exudyn_rotor.Formulation`. `spin` as a number is a constant
        speed [rad/s]; translation ``'auto'`` is ``'free'``, or ``'none'`` for a rotor that its
        stiffness matrix holds (:func:`exudyn_rotor.theory.formulation.suited_translation`).
        In a plane that is skew to the inertial axes ``'in-plane'`` is ``'free'``, the same motion.
    spin_coupling : {'full', 'frozen'}
        For a free spin. ``'frozen'`` leaves out how the deflection changes the moment of inertia
        about the axis, with the forces that belong to it, so that energy stays conserved: the mass
        matrix is constant for a frame in the centre of mass, and a step needs half the Python
        calls. Spin speeds err by half that change, which :func:`exudyn_rotor.check_run` reports.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening; ``'none'`` gives the paper's own equations, ``'full'`` needs a
        rotor reduced with a prestress. ``'auto'`` is ``'full'`` with one, else ``'tilt'``.
    position : array_like, shape (3,)
        Place of the mesh origin, inertial axes [m].
    rotation : array_like, shape (3, 3), optional
        Mesh axes → inertial axes at θ = 0.
    initial_velocity : array_like, shape (3,)
        Of the centre of mass, wherever the node is, inertial axes [m/s]; in the plane of rotation
        where the translation is in-plane. Ω e × d starts a rotor whose centre of mass is off the
        axis by d in a turn about the axis, as translation 'none' does.
    initial_angle, initial_speed : float, optional
        Of a free spin [rad], [rad/s]. At any angle the rotor starts with its axis in place.
    modal_coordinates, modal_velocities : array_like, optional
        Initial values of the modes named by ``body.selection.labels`` (√kg m, √kg m/s); of a full
        body the displacements [m] of all nodes in the rotor frame and their rates, (3n,) or (n, 3).
    gravity : array_like, shape (3,)
        Inertial axes [m/s²].
    mass_damping, stiffness_damping : float
        Rayleigh factors of the component modes [1/s], [s], acting in the rotor frame.
    markers : {'rigid', 'position'} or mapping of str to these, optional
        Kind of the markers at all interfaces, or interfaces that get a marker; all of them, rigid,
        by default. A position marker serves springs and forces at a fifth of the cost of a rigid
        one. ``body.add_marker`` adds others, with an offset too.
    locking : {'auto', 'constraints', 'mass'}
        How coordinates of the marker body's node that the formulation does not have are held.
        ``'constraints'``, which ``'auto'`` is, serves all solvers, and Exudyn's analyses of the
        scene. Where the spin or a translation is prescribed, explicit solvers (RK44, DOPRI5, …) end
        with an error that says so: they need ``'mass'``, huge masses that are driven along the
        motion, which static solvers do not take.
    color : sequence of 4 floats
        RGBA.

    Returns
    -------
    RotorBody
        A FullRotorBody for a solid rotor.

    Raises
    ------
    ValueError, TypeError
        For bad input; nothing has been added then.
    TooLittleMemoryError
        Where an implicit run with a full body needs more memory than is available.

    Notes
    -----
    The flexible body and its node have mesh axes, as with Exudyn's own body, if the spin axis is
    mesh z (any mounting), is mounted along inertial x (any mesh axis), or lies across mesh z and is
    mounted across inertial x. For any other axis they have the mesh axes turned by
    ``body.frame.B``, with z along the spin axis; local output, and rotations about single axes of
    the node, are in those. Markers have mesh axes always.

    The node of the frame is in the mesh origin, as that of Exudyn's body. It carries the frame's
    coordinates, which do not tilt: its translation is that of the centre of mass, its angle the
    rotor's mean rotation about the axis. What a script attaches to rigid and position markers there
    (``MarkerNodeRigid``, ``MarkerNodePosition``) is pointed by ``mbs.Assemble()`` at markers with
    the rotor's mean motion, so that forces, torques, springs, joints and sensors act as on Exudyn's
    body. Markers of single coordinates, and sensors of the node, stay what they are; a warning, and
    ``body.check_connections()``, name what they lack.

    A script's own markers on many mesh nodes are moved by ``mbs.Assemble()`` to one or three added
    nodes with the same mean motion: the same to round-off, at a cost that does not depend on the
    mesh (:mod:`exudyn_rotor.multibody.rotor.assembly`).

    The static solver keeps the initial velocities, so the rotor spins in it, its angle stands
    still. With a constant spin and translation ``'none'`` its solution is the steady state in the
    rotating frame, where nothing that stands still in space acts across the axis: no gravity there,
    and supports that are alike in all directions. Else the solution is wrong, without a word, and
    :func:`exudyn_rotor.steady_state` gives the motion instead. For θ(t) a static solution has no
    meaning but at its initial speed.

    A solid rotor is added with the displacements of all its nodes, Ψ = I, and sparse matrices: the
    formulations of Sects. 2.2 to 2.5 in full. What the frame describes, 4, 3 or 1 rigid motions, is
    held out of the displacements by linear conditions within the same equations, and each interface
    with a marker has its mean motion as coordinates (:mod:`exudyn_rotor.multibody.full.ties`). At a
    constant speed a time step calls no Python and needs no new factor. Give
    ``recommended_settings(…, body=body)``: Exudyn's default linear solver is a dense one. Markers
    come by `markers` and ``body.add_marker``, not by mesh nodes of the flexible body; markers at
    the node of the frame, damping by `mass_damping` of a rotor that nothing holds, and checks and
    linear analyses of the scene need a reduced rotor.

    Examples
    --------
    Two masses of 1 kg at r = 0.1 m, each on springs k = 1 MN/m in the rotor frame. At Ω = 10 rad/s
    they move outwards by ``Ω² m r / (k − Ω² m)``:

    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, add_rotor
    >>> rotor = SolidRotor.from_matrices(
    ...     np.eye(6), 1e6 * np.eye(6), [[0.1, 0, 0], [-0.1, 0, 0]], "z", interfaces={"top": [0]}
    ... )
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(6), spin=10.0, translation="none")
    >>> body
    RotorBody('rotor', Sect. 2.5, stiffening 'tilt', 6 modes, markers: top)
    >>> mbs.Assemble()
    >>> settings = exudyn.SimulationSettings()
    >>> settings.staticSolver.verboseMode = 0
    >>> mbs.SolveStatic(settings)
    True
    >>> kind = exudyn.OutputVariableType.Displacement
    >>> outwards = mbs.GetMarkerOutput(body.marker("top"), kind)[0]
    >>> bool(np.isclose(outwards, 10.0 / (1e6 - 100.0), rtol=1e-9))
    True
    """
    main_system(mbs)
    how = "SolidRotor.from_ngsolve(…) makes one, SolidRotor.reduce(…) the other"
    checks.instance(rotor, "rotor", (ReducedRotor, SolidRotor), how)
    full = isinstance(rotor, SolidRotor)
    checks.choice(stiffening, "stiffening", CHOICES)
    turn = np.eye(3) if rotation is None else checks.rotation(rotation)
    axis = turn @ rotor.axis.direction
    asked = suited_translation(translation, rotor.grounded)
    formulation = in_space(Formulation(asked, spin, drive, spin_coupling), axis)
    setup = Setup(
        name=None if name is None else checks.label(name, "name"),
        formulation=formulation,
        stiffening=stiffening,
        placement=placement(
            formulation, axis, position, turn, initial_velocity, initial_angle, initial_speed
        ),
        modal_coordinates=modal_coordinates,
        modal_velocities=modal_velocities,
        gravity=checks.vector(gravity, "gravity", "m/s²"),
        mass_damping=checks.number(mass_damping, "mass_damping", "1/s", least=0.0),
        stiffness_damping=checks.number(stiffness_damping, "stiffness_damping", "s", least=0.0),
        marker_kinds=marker_kinds(rotor.interfaces, markers),
        locking=checks.choice(locking, "locking", LOCKINGS),
        color=color_of(color),
    )
    for one in setup.marker_kinds:
        check_free(marker_name(setup.name, one), "marker", mbs.GetMarkerNumber)
    if setup.name is not None:
        check_free(setup.name, "object", mbs.GetObjectNumber)
    if full:
        check_memory(rotor)
        if stiffening in ("auto", "full"):
            rotor = with_chosen_prestress(rotor, None)
        has_stress, has_loss = rotor.carried_prestress is not None, bool(rotor.structural_damping)
    else:
        has_stress, has_loss = rotor.invariants.K2 is not None, rotor.invariants.H is not None
    setup = replace(setup, stiffening=chosen_level(stiffening, has_stress))
    plan = make_full_plan(rotor, setup) if full else make_plan(rotor, setup)
    if not full and stiffening == "auto" and plan.stiffening == "tilt":
        warn_of_left_out(rotor.invariants, setup.placement.speed, 3)
    if has_loss:
        warnings.warn(LOSS_LEFT_OUT.format("A scene runs"), UserWarning, stacklevel=2)
    return add_full(mbs, plan) if full else _add_reduced(mbs, plan, rotor.shapes)


def _add_reduced(mbs: exudyn.MainSystem, plan: Plan, shapes: ModeShapes | None) -> RotorBody:
    nodes = list(add_nodes(mbs, plan))
    # first of all objects, as in scripts that know it by its number
    item = flexible_body(plan, nodes, plan.motion.invariants.S, shapes, plan.name or "")
    marker_body = mbs.AddObject(item)
    physics = mbs.AddObject(_equations(plan, nodes))
    return finished(
        RotorBody,
        mbs,
        plan,
        nodes=dict(zip(("rigid", "modes"), nodes, strict=True)),
        objects={"physics": physics, "marker_body": marker_body},
        mesh_node_count=0 if shapes is None else len(shapes.nodes),
    )


def _equations(plan: Plan, nodes: list) -> ObjectGenericODE2:
    """Return the object of the equations: matrices, and user functions for what varies.

    With the constant matrices of (109) alone, a time step calls no Python.
    """
    motion, layout, guide = plan.motion, plan.layout, plan.guide
    constant, rest = constant_part(motion), np.zeros(motion.size)
    mass, functions = layout.spread(motion.mass_matrix(0.0, rest), layout.lock_mass), {}
    force = np.zeros(layout.size)
    force[layout.unknowns] = constant.force
    if not motion.is_constant:
        kernel = Kernel(motion, layout.unknowns, layout.size)
        if kernel.rows.size:
            mass, functions["massMatrixUserFunction"] = _varying_mass(mass, kernel, layout.size)

        def forces(mbs, t, item, q, q_t):
            found = kernel.forces(t, q, q_t)
            # Exudyn takes a list faster than an array
            return (found if guide is None else found + guide(t)).tolist()

        functions["forceUserFunction"] = forces
        # even where it is zero: without it, Exudyn differentiates the object numerically with all
        # its matrices, and calls the user force for every coordinate
        functions["jacobianUserFunction"] = lambda mbs, t, item, q, q_t, factor_q, factor_v: (
            kernel.jacobian(t, q, q_t, factor_q, factor_v)
        )
    return ObjectGenericODE2(
        nodeNumbers=nodes,
        massMatrix=mass,
        stiffnessMatrix=layout.spread(constant.stiffness),
        dampingMatrix=layout.spread(constant.damping),
        forceVector=force,
        **functions,
        visualization=VObjectGenericODE2(show=False),
    )


def _varying_mass(
    start: np.ndarray, kernel: Kernel, size: int
) -> tuple[exudyn.MatrixContainer, Callable]:
    """Return the mass matrix and its user function: only some entries vary.

    Exudyn takes entries (row, column, value) faster than a matrix.
    """
    above, beside = kernel.rows, kernel.columns
    off = above != beside
    fixed = start.copy()
    fixed[above, beside] = fixed[beside, above] = 0.0
    rows, columns = np.nonzero(fixed)
    table = np.zeros((rows.size + above.size + np.count_nonzero(off), 3))
    table[:, 0] = np.concatenate([rows, above, beside[off]])
    table[:, 1] = np.concatenate([columns, beside, above[off]])
    table[: rows.size, 2] = fixed[rows, columns]
    one = table[rows.size : rows.size + above.size, 2]
    mirrored = table[rows.size + above.size :, 2]
    skipped = above.size - mirrored.size  # the only diagonal entry is the first
    matrix = exudyn.MatrixContainer()
    # one container, its method found once: Exudyn takes a copy, and a new one costs a microsecond
    fill = matrix.SetWithSparseMatrixCSR

    def mass_matrix(mbs, t, item, q, q_t):
        values = kernel.mass_entries(t, q)
        one[:], mirrored[:] = values, values[skipped:]
        fill(size, size, table, False)
        return matrix

    return mass_matrix(None, 0.0, None, [0.0] * size, [0.0] * size), mass_matrix
