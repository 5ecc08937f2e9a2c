"""Nonlinear steady motion of a rotor over a parameter, all branches that hang together."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given, given_supports
from exudyn_rotor.bearings.support import NoCoefficientsError
from exudyn_rotor.calls import user_level
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.build import Target, warn_of_omissions
from exudyn_rotor.linear.response.loads import At, HarmonicForce, Unbalance, checked_places
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.nonlinear.balance import Balance
from exudyn_rotor.nonlinear.collect import collected
from exudyn_rotor.nonlinear.continuation import Family, Point, same
from exudyn_rotor.nonlinear.periodic_result import PeriodicResponse
from exudyn_rotor.nonlinear.problem import Problem
from exudyn_rotor.nonlinear.scene import as_lists
from exudyn_rotor.solvers.factor import one_thread

_LABELS = {"speed": "spin speed [rad/s]", "unbalance": "unbalance"}
_MOST = (24, 48)  # harmonics of the second phase, and of the spin in a revolution
_MOST_WITH_PASSES = 24  # harmonics of the spin beside the ball pass
_NOT_HELD = (
    "in its clearance nothing holds the rotor, which may stand anywhere there; give a load across "
    "the axis, or an unbalance"
)
_FAILS = (UnconvergedError, NoCoefficientsError, ArithmeticError, np.linalg.LinAlgError)
Over = str | Callable[[float], Sequence[Given] | Given]


def periodic_response(
    target: Target,
    values: ArrayLike,
    unbalances: Sequence[Unbalance] | Unbalance = (),
    *,
    supports: Sequence[Given] | Given = (),
    over: Over = "speed",
    speed: float | None = None,
    gravity: ArrayLike = (0.0, 0.0, 0.0),
    loads: Sequence[HarmonicForce] | HarmonicForce = (),
    own: bool = True,
    foundation: Foundation | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    revolutions: int = 1,
    at: Sequence[At] | At | None = None,
    stiffening: str = "auto",
    tolerance: float = 1e-3,
    follow: bool = True,
) -> PeriodicResponse:
    """Compute the steady motion of a rotor on nonlinear bearings, with its branches.

    Films, stops and rolling bearings act by their own laws, all other supports by their linear
    coefficients. The branch of the lowest value is followed upwards, through folds, and the one of
    the highest value downwards, unless it is the same. Every point tells whether its motion is
    stable; folds, period doublings, and changes to a motion with a second frequency (torus) are
    found and marked. With rolling bearings the motion has two frequencies, of the ball pass and the
    spin, that need no common period.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, LinearModel or exudyn.MainSystem
        As of :func:`linear_model`. A scene has laws of :func:`add_supports` on the ground or on one
        foundation, constant forces and weight; anything else in it is refused. Of a train, the
        unbalance is that of rotors of ratio 1.
    values : array_like, shape (v,)
        Ascending values of the parameter; all solutions that are met there are among the points.
        From the first to the last one the branches are followed.
    unbalances : sequence of Unbalance, optional
        In addition to the rotor's own.
    supports : sequence of Support and bearings
        Bearings under weight need no `load` of their own: it follows from `gravity` and `loads`.
    over : 'speed', 'unbalance' or callable, optional
        The parameter: the spin speed [rad/s]; a factor of all unbalances; or a function that takes
        a value and gives the supports.
    speed : float, optional
        Spin speed [rad/s] where the parameter is another one.
    gravity : array_like, shape (3,), optional
        In axes of the mesh, as the rotor is mounted at θ = 0 [m/s²]. What is along the axis does
        not count.
    loads : sequence of HarmonicForce, optional
        Constant forces: the real parts of their amplitudes. What is along the axis does not count
        where nothing holds the rotor there.
    own : bool, optional
        Whether the rotor's own eccentricity counts, by added point masses and by its mesh.
    foundation : Foundation, optional
        What carries all supports, see :func:`linear_model`.
    body : RotorBody or sequence of RotorBody, optional
        The rotor in a scene, or all of them; a scene has its own supports, foundation, loads and
        gravity. Whether and how fast it spins there plays no part; of several, the ratios do.
    revolutions : int, optional
        After which the motion repeats: 2 for motions at half of the spin frequency. From doublings
        on the branch of a shorter period, those of a longer one are followed, too.
    at : sequence of str, int or position, optional
        Interfaces and mesh nodes to look at; all interfaces by default.
    stiffening : {'auto', 'none', 'tilt', 'full'}
    tolerance : float, optional
        Largest size of the harmonics left out, relative to the motion of the journals; harmonics
        are added until it is met, or there are 48 in a revolution.
    follow : bool, optional
        Whether branches are followed. Without, each value has one solution, beginning with the one
        before: less work, and no folds.

    Returns
    -------
    PeriodicResponse

    Raises
    ------
    TypeError, ValueError
        For bad input, a bearing without a force by place and velocity, two ball pass frequencies, a
        rotor that nothing holds, an item of a scene that is no law of this package, and where no
        motion is found at all.

    Warns
    -----
    UserWarning
        Where a branch is lost, a value has no solution, or harmonics are lacking.

    Examples
    --------
    A mass of 20 kg on a centred squeeze-film damper, at 500 rad/s: between unbalances of 0.95 and
    1.27 kg mm there are two stable orbits, and an unstable one between them.

    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, SqueezeFilmDamper, Unbalance, periodic_response
    >>> mass = SolidRotor.from_matrices(20.0 * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], "z")
    >>> damper = SqueezeFilmDamper(
    ...     interface="seat", radius=0.06, length=0.02, clearance=1.5e-4, viscosity=0.003,
    ...     centring_stiffness=1e6,
    ... )
    >>> found = periodic_response(
    ...     mass.with_interface("seat", [0]).reduce(0), [0.0, 1.1, 2.0], Unbalance("seat", 1e-3),
    ...     supports=damper, over="unbalance", speed=500.0,
    ... )
    >>> found.amplitudes("seat")[found.at(1.1)].round(7)
    array([7.520e-05, 1.158e-04, 1.265e-04])
    >>> found.stable[found.at(1.1)].tolist()
    [True, False, True]
    """
    unbalances = checks.instances(unbalances, "unbalances", Unbalance)
    tolerance = checks.tolerance(tolerance)
    revolutions = checks.count(revolutions, "revolutions", least=1)
    checks.flag(own, "own")
    checks.flag(follow, "follow")
    asked = checked_places(at)
    values, speed = _checked_parameter(values, over, speed)
    given = as_lists(target, body, supports, foundation, gravity, loads, stiffening)
    if callable(over) and given.supports:
        raise ValueError("supports: come from over=…, a function; leave them out")
    make = partial(Problem.of, unbalances=unbalances, own=own, revolutions=revolutions)
    if callable(over):

        @lru_cache(maxsize=4)
        def problem_at(value: float) -> Problem:
            one = given._replace(supports=given_supports(over(value)))
            return make(one, speed=speed, highest=speed)
    else:
        highest = values[-1] if over == "speed" else speed
        lowest = next(iter(values[values > 0.0]), 0.0) if over == "speed" else speed
        one = make(given, speed=lowest, highest=highest)
        warn_of_omissions(one.model, highest)

        def problem_at(value: float) -> Problem:
            return one

    def balance(p: np.ndarray, reach: tuple[int, int], more: float = 1.0) -> Balance:
        value = float(p[-1])
        unbalance = more * value if over == "unbalance" else more
        at = value if over == "speed" else speed
        return problem_at(value).balance(at, reach, unbalance=unbalance)

    first = problem_at(float(values[0]))
    span = np.array([np.ptp(values) or abs(values[0]) or 1.0])
    family = Family(
        balance, span, first.size, tolerance,
        (_MOST[0], _MOST_WITH_PASSES if first.laws.passes else _MOST[1] * revolutions),
    )  # fmt: skip
    with one_thread():
        search = _branches if follow and len(values) > 1 else _one_by_one
        branches = search(family, problem_at, values)
        warn_of(family, [point for branch in branches for point in branch], follow)
        return collected(branches, "parameter" if callable(over) else _LABELS[over], asked)


def _checked_parameter(
    values: ArrayLike, over: Over, speed: float | None
) -> tuple[np.ndarray, float | None]:
    if not callable(over):
        checks.choice(over, "over", tuple(_LABELS))
    if over == "speed":
        if speed is not None:
            raise ValueError("speed: is for another parameter than over='speed'; leave it out")
        return checks.ascending_from_zero(values, "values"), None
    if speed is None:
        raise ValueError("speed: needs the spin speed [rad/s] where the parameter is another one")
    return checks.ascending(values, "values"), checks.number(speed, "speed", "rad/s", least=0.0)


def _first(family: Family, problem: Problem, value: float) -> Point:
    """Return the solution at a value, from where a search begins without another solution."""
    p = np.array([value])
    lost: Exception = UnconvergedError("no steady motion was found")
    for balance, c in problem.starts(partial(family.balance, p)):
        try:
            start = Point(balance.solved(c), p, balance, kind="value")
            start = family.refined(start)
            if start.balance.holds(start.c):
                return start
            lost = UnconvergedError(_NOT_HELD)
        except _FAILS as failed:
            lost = failed
    raise lost


def _branches(
    family: Family, problem_at: Callable[[float], Problem], values: np.ndarray
) -> list[list[Point]]:
    """Return the branch of the lowest value, and of the highest one if it is another."""
    found: list[list[Point]] = []
    lost = None
    for value, sense in ((float(values[0]), 1.0), (float(values[-1]), -1.0)):
        try:
            start = _first(family, problem_at(value), value)
        except _FAILS as failed:
            lost = failed
            continue
        met = [point for branch in found for point in branch]
        if not same(start, met, family.size):
            found.append(list(family.followed(start, values, sense)))
            found += _of_longer_periods(family, found[-1], values)
    if not found:
        raise ValueError(
            f"values: no steady motion was found at {values[0]:g} and {values[-1]:g}, from which a "
            f"branch could be followed ({lost}); give other values, or a damped run of a scene "
            "shows what the rotor does"
        ) from lost
    return found


def _of_longer_periods(
    family: Family, branch: list[Point], values: np.ndarray
) -> list[list[Point]]:
    """Return the branches of a longer period that begin at doublings, which are marked."""
    found = []
    for index, point in enumerate(branch):
        if point.kind != "branching" or point.balance.rest.revolutions == 1:
            continue
        beside = family.aside(point)
        if beside is None:
            continue
        branch[index] = replace(point, kind="doubling")
        start, g = beside

        def returns(one: Point, after: Point, g: int = g) -> bool:
            """Return whether a branch comes back to a motion of the shorter period."""
            new = after.balance.orders[:, 1] % g != 0
            before = family.widened(one, after.balance.reach).c
            return np.vdot(before[new], after.c[new]).real < 0.0

        sense = float(np.sign(start.tangent[1][-1]))
        one = list(family.followed(start, values, sense, until=returns))
        others = _of_longer_periods(family, one, values)
        found += [[branch[index], *one], *others]
    return found


def _one_by_one(
    family: Family, problem_at: Callable[[float], Problem], values: np.ndarray
) -> list[list[Point]]:
    """Return one branch: a solution at each value that has one, beginning with the one before."""
    found: list[Point] = []
    lost = None
    for value in map(float, values):
        try:
            try:
                near = found[-1:] and family.refined(family.at_value(found[-1], value)[0])
            except _FAILS:
                near = None
            found.append(family.measure(near or _first(family, problem_at(value), value)))
        except _FAILS as failed:
            lost = failed
            family.lost.append(f"{value:g}")
    if not found:
        raise ValueError(f"values: no steady motion was found at any ({lost})") from lost
    return [found]


def warn_of(family: Family, found: Sequence[Point], follow: bool = True) -> None:
    """Tell what is lost, lacking, or, unless branches are followed, unstable."""
    told = []
    unstable = [f"{one.value:g}" for one in found if one.growth > 0.0]
    if unstable and not follow:
        shown = ", ".join(unstable[:5]) + ", …" * (len(unstable) > 5)
        told.append(
            f"at {len(unstable)} of {len(found)} values ({shown}) the motion is unstable; the "
            "rotor moves otherwise, which a run shows"
        )
    if family.lost:
        shown = ", ".join(family.lost[:5]) + ", …" * (len(family.lost) > 5)
        told.append(f"no steady motion was found at, or a branch is lost beyond, {shown}")
    worst = max(found, key=lambda one: np.nan_to_num(one.error))
    if worst.error > 1.5 * family.tolerance:
        told.append(
            f"at {worst.value:g} harmonics that are left out have {worst.error:.0e} of the motion"
        )
    if told:
        warnings.warn("; ".join(told), UserWarning, stacklevel=user_level())
