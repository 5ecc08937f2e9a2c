"""Deflection, reactions and stress under loads that stand still, and the weight on bearings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given, check_interfaces, given_supports
from exudyn_rotor.linear.modal.basis_error import is_known, motion_error, warn
from exudyn_rotor.linear.model.build import warn_of_omissions
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.rotor_train import RotorTrain
from exudyn_rotor.linear.response.loads import At, checked_places, node_number
from exudyn_rotor.reduction.reduce import reduce, reduced_for_loads
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.static.problem import Problem
from exudyn_rotor.static.resting import RigidBearing
from exudyn_rotor.static.static_result import StaticResponse
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.theory.stiffening import CHOICES

Loads = Mapping[At, ArrayLike]
_ROUNDING = 1e-12  # share of the largest load that is none


def static_response(
    target: LinearModel | ReducedRotor | SolidRotor | RotorTrain,
    loads: Loads | None = None,
    *,
    gravity: ArrayLike | None = None,
    supports: Sequence[Given] | Given = (),
    speed: float = 0.0,
    frame: str = "inertial",
    at: Sequence[At] | At | None = None,
    stiffening: str = "auto",
    stress: bool = False,
    accuracy: float | None = 1e-2,
) -> StaticResponse:
    """Compute deflection and reactions under loads that stand still.

    Bearings need no static load here: their forces and the places of their journals are what is
    found, of films, magnets and rolling elements as of springs, alone and in series. A film carries
    at a speed only.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain or LinearModel
        See :func:`linear_model`. A SolidRotor is solved as it is at rest, without the error of
        a basis. Of a scene, :func:`steady_state` finds the equilibrium.
    loads : mapping, optional
        Interface, node number or position [m] → force (3,) [N], or force and moment (6,) [N], [N m]
        at an interface, in mesh axes.
    gravity : array_like, shape (3,), optional
        In mesh axes, as the rotor is mounted at θ = 0 [m/s²].
    supports : sequence of Support or bearings, optional
        Any number, of a rotor; a train and a model have their own.
    speed : float, optional
        Spin speed [rad/s].
    frame : {'inertial', 'rotor'}
        Axes in which the loads stand still. Those of a rotor take supports that are alike in all
        directions, and the unbalance of the rotor is among the loads.
    at : sequence of interfaces, node numbers or positions, optional
        Places to look at; all interfaces by default.
    stiffening
        See :func:`linear_model`.
    stress : bool, optional
        Whether to find the stress of the rotor, which needs one reduced with ``stress=True``.
    accuracy : float or None, optional
        Largest error by the basis of a reduced rotor without a warning; None for no estimate.

    Returns
    -------
    StaticResponse

    Raises
    ------
    TypeError, ValueError
        For a target, load or support of another kind, an unknown place, a load on a motion that
        nothing holds, a torque left over on a free spin of a train, a film that does not carry, and
        a moment at a node.
    UnconvergedError
        Where bearings have no equilibrium.

    Notes
    -----
    A drive holds the free spin of a single rotor, and its torque is the reaction; torques on a
    train must balance where nothing holds its spin, or ``driven`` names the rotor with the drive.
    The elements of a rolling bearing stand as at θ = 0; magnets sense where they act. The ring of a
    bearing in series has no weight here. An uneven rotor has at a speed the mean of its stiffness
    over a turn.

    Examples
    --------
    Two masses of 2 kg on three springs of 2e4 N/m, one of them in the middle:

    >>> from exudyn_rotor import Support, rotor_example, static_response
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> rotor = rotor.with_interface("middle", [0, 1])
    >>> supports = [Support(name, 2e4) for name in ("left", "middle", "right")]
    >>> found = static_response(rotor, gravity=[0.0, -9.81, 0.0], supports=supports)
    >>> print(found.reactions[:, 1].round(6))
    [13.08 13.08 13.08]
    >>> round(float(found.deflection("left")[1]), 9)
    -0.000654
    """
    given = given_supports(supports)
    speed = checks.number(speed, "speed", "rad/s")
    checks.choice(frame, "frame", FRAMES)
    checks.choice(stiffening, "stiffening", CHOICES)
    checks.flag(stress, "stress")
    checks.accuracy(accuracy)
    named = _checked_loads(loads)
    g = np.zeros(3) if gravity is None else checks.vector(gravity, "gravity", "m/s²")
    at = checked_places(at)
    if isinstance(target, SolidRotor):
        check_interfaces(given, target.interfaces)
        nodes = {node_number(target.nodes, at) for at in named if not isinstance(at, str)}
        target = reduced_for_loads(target, sorted(nodes), spins=speed != 0.0, stress=stress)
        accuracy = None  # nothing is left out at rest
    problem = Problem.of(target, given, stiffening, speed, frame)
    warn_of_omissions(problem.model, speed)
    load = problem.load(named, g)
    y, forces = problem.solved(load)
    fields = problem.seen(y, forces, at)
    if is_known(problem.model, accuracy) and not problem.model.is_full:
        richer = replace(problem, model=problem.model.richer)
        better = richer.seen(*richer.solved(richer.load(named, g)), at)
        fields["basis_errors"] = motion_error({0: fields["motion"]}, {0: better["motion"]})
        away = np.abs(fields["reactions"] - better["reactions"]).max(initial=0.0)
        most = np.abs(better["reactions"]).max(initial=1e-300)
        errors = np.append(fields["basis_errors"], away / most)
        warn(errors, lambda _: "a static deflection or reaction", problem.model, accuracy)
    return StaticResponse(**fields, **problem.mesh(y, stress), speed=speed, frame=frame)


def _checked_loads(loads: Loads | None) -> dict[At, np.ndarray]:
    """Return loads as force and moment (6,) by places."""
    if loads is None:
        return {}
    if not isinstance(loads, Mapping):
        raise TypeError(
            "loads: needs a dictionary of interface or node to a force (3,) [N] or force and "
            f"moment (6,), got {checks.shown(loads)}"
        )
    found = {}
    for key, value in loads.items():
        name = f"loads[{key!r}]"
        vector = checks.vector(value, name, "N", size=None)
        if len(vector) not in (3, 6):
            raise ValueError(f"{name}: needs 3 or 6 numbers [N], [N m], got {checks.shown(value)}")
        found[checks.place(key, "loads")] = np.r_[vector, np.zeros(6 - len(vector))]
    return found


def bearing_loads(
    rotor: ReducedRotor | SolidRotor,
    bearings: Sequence[str | Given],
    gravity: ArrayLike,
    *,
    speed: float = 0.0,
) -> np.ndarray:
    """Return the weight that bearings carry, any number of them.

    Two carry by the lever rule. More share the weight by the flexibility of the shaft, and by their
    own where they are given as supports; the loads of a rigid rotor on rigid bearings are those of
    bearings of equal stiffness.

    Parameters
    ----------
    rotor : ReducedRotor or SolidRotor
    bearings : sequence of str, supports or bearings
        Interfaces, which rigid bearings in line hold across the axis, or supports and bearings.
    gravity : array_like, shape (3,)
        In axes of the mesh, as the rotor is mounted at θ = 0 [m/s²]; what is along the axis counts
        for no bearing.
    speed : float, optional
        Spin speed of films [rad/s].

    Returns
    -------
    ndarray, shape (b, 2)
        A row for each bearing: the load on its journal along (n1, n2) of
        :attr:`SpinAxis.plane` [N], downward under gravity.

    Raises
    ------
    TypeError, ValueError
        If the rotor is of another kind, an interface unknown, there are too few bearings, or all
        are at one place.

    Examples
    --------
    >>> from exudyn_rotor import bearing_loads, rotor_example
    >>> rotor = rotor_example((1.0, 3.0))  # masses of 1 kg and 3 kg on a rod
    >>> print(bearing_loads(rotor, ["left", "right"], [0.0, -10.0, 0.0]).round(9))
    [[  0. -10.]
     [  0. -30.]]
    """
    checks.instance(rotor, "rotor", (ReducedRotor, SolidRotor))
    gravity = checks.vector(gravity, "gravity", "m/s²")
    speed = checks.number(speed, "speed", "rad/s")
    what = "interfaces, supports or bearings"
    listed = [bearings] if isinstance(bearings, str) else checks.items(bearings, "bearings", what)
    names = [one for one in listed if isinstance(one, str)]
    checks.different(checks.labels(names, "bearings", rotor.interfaces), "bearings")
    given = tuple(
        RigidBearing(one) if isinstance(one, str) else given_supports(one, "bearings")[0]
        for one in listed
    )
    if isinstance(rotor, SolidRotor):
        if len(given) <= 2 and len(names) == len(given):
            rotor = reduce(rotor, 0, prestress=False)
        else:
            rotor = reduced_for_loads(rotor, (), spins=speed != 0.0, stress=False)
    e = rotor.axis.direction
    problem = Problem.of(rotor, given, "auto", speed, "inertial")
    elastic = rotor.size > len(rotor.rigid_kinds)
    if len(given) > 2 and elastic and problem.model.richer is not None:
        problem = replace(problem, model=problem.model.richer)
    found = problem.solved(problem.load({}, gravity - e * (e @ gravity)))
    loads = -problem.seen(*found, None)["reactions"][:, :2]
    return np.where(np.abs(loads) > _ROUNDING * np.abs(loads).max(initial=0.0), loads, 0.0)
