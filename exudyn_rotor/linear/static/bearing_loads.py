"""Static loads of bearings, which their linearisation needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given, given_supports
from exudyn_rotor.bearings.resting import RigidBearing
from exudyn_rotor.linear.static.problem import Problem, with_supports
from exudyn_rotor.reduction.reduce import reduce_rotor, reduced_for_loads
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor

_ROUNDING = 1e-12  # share of the largest load that is none


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
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, bearing_loads
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # masses of 1 kg and 3 kg on a rod
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> rotor = SolidRotor.from_matrices(np.diag([1.0] * 3 + [3.0] * 3), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> print(bearing_loads(rotor, ["left", "right"], [0.0, -10.0, 0.0]).round(9))
    [[  0. -10.]
     [  0. -30.]]
    """
    checks.instance(rotor, "rotor", (ReducedRotor, SolidRotor))
    gravity = checks.vector(gravity, "gravity", "m/s²")
    speed = checks.number(speed, "speed", "rad/s")
    what = "interfaces, supports or bearings"
    listed = [bearings] if isinstance(bearings, str) else checks.items(bearings, "bearings", what)
    names = checks.labels([one for one in listed if isinstance(one, str)], "bearings")
    checks.different(checks.labels(names, "bearings", rotor.interfaces), "bearings")
    given = [
        RigidBearing(one) if isinstance(one, str) else given_supports([one])[0] for one in listed
    ]
    if isinstance(rotor, SolidRotor):
        if len(given) <= 2 and len(names) == len(given):
            rotor = reduce_rotor(rotor, 0, prestress=False)
        else:
            rotor = reduced_for_loads(rotor, (), spins=speed != 0.0, stress=False)
    e = rotor.axis.direction
    problem = Problem.of(with_supports(rotor, tuple(given), "auto"), speed, "inertial")
    elastic = rotor.size > len(rotor.rigid_kinds)
    if len(given) > 2 and elastic and problem.model.richer is not None:
        problem = replace(problem, model=problem.model.richer)
    found = problem.solved(problem.load({}, gravity - e * (e @ gravity)))
    loads = -problem.seen(*found, None)["reactions"][:, :2]
    return np.where(np.abs(loads) > _ROUNDING * np.abs(loads).max(initial=0.0), loads, 0.0)
