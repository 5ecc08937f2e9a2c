"""Steady motion of a rotor on rolling bearings: varying compliance, unbalance, lost contact.

Elements that pass the load make the bearing's force vary at ZκΩ and its multiples, also without
unbalance, and contacts that open make the stiffness depend on the orbit; see
:mod:`exudyn_rotor.linear.response.contact_balance`. C. S. Sunnersjö, J. Sound Vib. 58 (1978), 363;
M. Tiwari, K. Gupta, O. Prakash, J. Sound Vib. 238 (2000), 723, by the same method.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given, given_supports
from exudyn_rotor.bearings.rolling import RollingBearing, contacts
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.callers import user_level
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear import options
from exudyn_rotor.linear.model.build import linear_model, warn_of_left_out_stiffening
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.contact_rest import Harmonics
from exudyn_rotor.linear.response.harmonic_loads import (
    BaseAcceleration,
    HarmonicForce,
    total,
    unbalance_load,
)
from exudyn_rotor.linear.response.places import At, Place, checked_places, places
from exudyn_rotor.linear.response.rolling_motion import RollingProblem, SteadyMotion
from exudyn_rotor.linear.response.rolling_result import RollingBearingResponse
from exudyn_rotor.linear.response.unbalance import Unbalance
from exudyn_rotor.reduction.mode_kind import ModeKind
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.sweep import ascending_from_zero
from exudyn_rotor.theory.rotating_axes import axes_of, parts_across
from exudyn_rotor.threads import one_thread

_SAME_PASS = 1e-9  # relative distance of ball pass frequencies that is rounding
_DEPTH = 1e-3  # of the radius of the elements, at which a contact has the stiffness of k₀
_NOT_ACROSS = (ModeKind.AXIAL.value, ModeKind.SPIN.value)
_ROUND = 1e-12  # share of the largest harmonic
_ALONG = 1e-9  # share of the largest static load that counts as none along the axis
_UNPRESSED = (
    "gravity: lies along the axis, where it presses no element; give a load across it, or an "
    "unbalance that is not small"
)


def rolling_bearing_response(
    target: ReducedRotor | SolidRotor,
    speeds: ArrayLike,
    unbalances: Sequence[Unbalance] = (),
    *,
    supports: Sequence[Given] | Given,
    gravity: ArrayLike = (0.0, 0.0, 0.0),
    loads: Sequence[HarmonicForce] = (),
    own: bool = True,
    foundation: Foundation | None = None,
    at: Sequence[At] | At | None = None,
    stiffening: str = "auto",
    tolerance: float = 1e-2,
    downwards: bool = False,
) -> RollingBearingResponse:
    """Compute the steady motion on rolling bearings whose contacts carry by their own laws.

    With the ball pass (varying compliance) and the spin (unbalance) as two frequencies that need
    no common period. At rest it is the equilibrium at every angle of the cage. How many harmonics
    are needed is found by itself.

    Parameters
    ----------
    target : ReducedRotor or SolidRotor
        A SolidRotor is reduced first, see :func:`linear_model`.
    speeds : array_like, shape (s,)
        Ascending spin speeds [rad/s], ≥ 0.
    unbalances : sequence of Unbalance, optional
        In addition to the rotor's own.
    supports : sequence of Support and bearings
        With one RollingBearing or more, which share one ball pass frequency; their own `load` plays
        no part. All others are linearised.
    gravity : array_like, shape (3,), optional
        In axes of the mesh, as the rotor is mounted at θ = 0 [m/s²]. What is along the axis does
        not count.
    loads : sequence of HarmonicForce, optional
        Constant forces: the real parts of their amplitudes.
    own : bool, optional
        Whether the rotor's own eccentricity counts.
    foundation : Foundation, optional
        What carries all supports, see :func:`linear_model`.
    at : sequence of str, int or position, optional
        Interfaces and mesh nodes to look at; all interfaces by default.
    stiffening : {'auto', 'none', 'tilt', 'full'}
    tolerance : float, optional
        Largest size of the harmonics left out, relative to the motion of the bearings.
    downwards : bool, optional
        Begin with the highest speed. Each speed begins with the motion at the one before, and where
        there are several steady motions the two ways show two of them.

    Returns
    -------
    RollingBearingResponse

    Raises
    ------
    TypeError, ValueError
        For bad input, no rolling bearing, two ball pass frequencies, no load at all, and a load
        on a motion that no support holds.
    UnconvergedError
        Where no steady motion of these two frequencies is found at any speed.

    Warns
    -----
    UserWarning
        Where a steady motion is unstable, lacks more harmonics than `tolerance` allows, or is not
        found: then its row is NaN.

    Notes
    -----
    With clearance and little damping a steady motion is often unstable: where the ball pass has
    twice a natural frequency, and near resonances, runs show far larger motions at half the
    frequency, jumps and chaos. :attr:`RollingBearingResponse.verdicts` tell where, and a run from
    :meth:`RollingBearingResponse.state` what becomes of it.

    Examples
    --------
    A mass of 20 kg on one bearing sways by 0.2 µm as balls pass below it at low speed:

    >>> import numpy as np
    >>> from exudyn_rotor import RollingBearing, SolidRotor, rolling_bearing_response
    >>> mass = SolidRotor.from_matrices(20.0 * np.eye(3), np.zeros((3, 3)), [[0.0, 0, 0]], "z")
    >>> bearing = RollingBearing(
    ...     interface="seat", count=8, pitch_radius=0.0326, element_radius=0.006, stiffness=7e9,
    ...     damping=1500.0,
    ... )
    >>> response = rolling_bearing_response(
    ...     mass.with_interface("seat", [0]).reduce(0), [10.0, 300.0], supports=bearing,
    ...     gravity=[0.0, -9.81, 0.0],
    ... )
    >>> print(1e9 * response.end_to_end("seat").round(8))  # nm along n1 and n2
    [[200.  40.]
     [460.  70.]]
    """
    values = ascending_from_zero(speeds, "speeds")
    unbalances = checks.instances(unbalances, "unbalances", Unbalance)
    loads = checks.instances(loads, "loads", HarmonicForce)
    gravity = checks.vector(gravity, "gravity", "m/s²")
    tolerance = options.accuracy(tolerance, "tolerance")
    checks.flag(own, "own")
    checks.flag(downwards, "downwards")
    checks.instance(target, "target", (ReducedRotor, SolidRotor))
    given = given_supports(supports)
    bearings = [one for one in given if isinstance(one, RollingBearing)]
    passes = _passes(bearings)
    springs = list(map(_spring, bearings))
    linear = [
        *map(_linear_support, bearings, springs),
        *(one for one in given if not isinstance(one, RollingBearing)),
    ]
    model = linear_model(target, supports=linear, foundation=foundation, stiffening=stiffening)
    warn_of_left_out_stiffening(model, values.max())
    model = model.for_responses
    asked = checked_places(at)
    observed = {moves: places(model, asked, float(moves)) for moves in (False, True)}
    across = parts_across(axes_of(target.axis), gravity)
    steady = [*([BaseAcceleration(-across)] if np.any(across) else []), *loads]
    unbalance, whirls = _unbalance(model, unbalances, own)

    def static(speed: float) -> dict[int, np.ndarray]:
        return _two_sided(total(steady, model, speed)) if steady else {}

    _check_loaded(static(values[0]), whirls and values[0] > 0.0)
    _check_held(model, given, static(0.0))
    problem = RollingProblem(model, bearings, np.repeat(springs, 2), passes, static, unbalance)
    pressed = bool(steady) or not np.any(gravity)
    with one_thread():
        solved, lost = problem.swept(values[::-1] if downwards else values, tolerance)
    solved = solved[::-1] if downwards else solved
    if not any(solved):
        raise lost if pressed else type(lost)(f"{_UNPRESSED} ({lost})") from lost
    if lost is not None:
        _warn_of_lost(values[[one is None for one in solved]], lost)
    _warn_of_left_out(max(filter(None, solved), key=lambda one: one.error), tolerance)
    found = _result(problem, observed, values, solved)
    _warn_of_instability(found)
    return found


def _unbalance(
    model: LinearModel, unbalances: Sequence[Unbalance], own: bool
) -> tuple[dict[int, np.ndarray], bool]:
    """Return the load per Ω² as harmonics (k,), and whether any unbalance is there."""
    try:
        return unbalance_load(model, unbalances, own), True
    except ValueError:
        if unbalances:
            raise
    # a balanced rotor is strained by centrifugal loads, too
    return model.unbalance() if own else {}, False


def _two_sided(load: Mapping[int, np.ndarray]) -> dict[int, np.ndarray]:
    """Return harmonics F of both signs of ``Re Σ F_n exp(inθ)``."""
    return {
        n: 0.5 * (load.get(n, 0.0) + np.conj(load.get(-n, 0.0)))
        for n in {*load, *(-n for n in load)}
    }


def _check_held(model: LinearModel, given: Sequence[Given], static: Mapping) -> None:
    """Refuse a rotor that supports leave free across its axis, or along it where a load acts."""
    ends = ", ".join(dict.fromkeys(repr(one.interface) for one in given))
    across = [name for name in model.free_motions if name not in _NOT_ACROSS]
    if across:
        motion = "tilting" if any("tilt" in name for name in across) else "lateral motion"
        raise ValueError(
            f"supports: nothing holds the rotor against {motion}: all stand at {ends}; add one at "
            "another interface"
        )
    spins = model.free_spins.shape[1]
    shifts = model.neutral_motions[:, : model.neutral_motions.shape[1] - spins]
    largest = max((np.abs(F).max() for F in static.values()), default=0.0)
    if any(np.abs(F @ shifts).max(initial=0.0) > _ALONG * largest for F in static.values()):
        raise ValueError(
            f"supports: nothing holds the rotor along its axis, with supports at {ends}; add a "
            "stiffness along the axis, or leave out loads along it"
        )


def _warn_of_lost(speeds: np.ndarray, first: Exception) -> None:
    shown = ", ".join(f"{speed:g}" for speed in speeds[:5]) + ", …" * (speeds.size > 5)
    warnings.warn(
        f"no values at {shown} rad/s, which are NaN: {first}", UserWarning, stacklevel=user_level()
    )


def _check_loaded(static: Mapping[int, np.ndarray], whirls: bool) -> None:
    """Refuse a rotor that nothing presses into its bearings."""
    if not static and not whirls:
        raise ValueError(
            "gravity, loads, unbalances: need one that is not zero: without a load no element "
            "carries, and preloaded ones do not move; unbalance alone needs speeds above zero"
        )


def _warn_of_left_out(worst: SteadyMotion, tolerance: float) -> None:
    if worst.error > tolerance:
        warnings.warn(
            f"rolling bearings at {worst.balance.rest.speed:g} rad/s: contacts that open and close "
            f"leave {worst.error:.0e} of the motion to higher harmonics",
            UserWarning,
            stacklevel=user_level(),
        )


def _warn_of_instability(found: RollingBearingResponse) -> None:
    speeds = found.speeds[[verdict == "unstable" for verdict in found.verdicts]]
    if speeds.size:
        shown = ", ".join(f"{speed:g}" for speed in speeds[:5]) + ", …" * (speeds.size > 5)
        warnings.warn(
            f"rolling bearings: at {speeds.size} of {len(found.speeds)} speeds ({shown} rad/s) the "
            "steady motion is unstable; the rotor moves otherwise, which a run shows",
            UserWarning,
            stacklevel=user_level(),
        )


def _passes(bearings: Sequence[RollingBearing]) -> float:
    """Return how many elements pass the load in a revolution, the same for all bearings."""
    if not bearings:
        raise ValueError(
            "supports: need a RollingBearing or more; unbalance_response takes all other bearings"
        )
    found = [one.count * one.cage_ratio for one in bearings]
    if np.ptp(found) > _SAME_PASS * max(found):
        raise ValueError(
            f"supports: {min(found):.6g} and {max(found):.6g} elements pass in a revolution, and "
            "one frequency of ball passes is balanced: give one kind as it is, with the other "
            "kinds linearised(), and then the other way round"
        )
    return found[0]


def _spring(bearing: RollingBearing) -> float:
    """Return k₀ in place of the contacts, of the size of their stiffness [N/m]."""
    deep = np.array([bearing.clearance + _DEPTH * bearing.element_radius, 0.0])
    return float(0.5 * np.trace(contacts(bearing, deep, 0.0)[2]))


def _linear_support(bearing: RollingBearing, spring: float) -> Support:
    """Return the spring k₀ and the damping in place of a bearing; the rest is its force."""
    return Support(bearing.interface, spring, bearing.damping)


def _result(
    problem: RollingProblem,
    observed: Mapping[bool, Sequence[Place]],
    speeds: np.ndarray,
    solved: Sequence[SteadyMotion | None],
) -> RollingBearingResponse:
    """Return the motions (s, p, h, 6) of places, and loads of elements; NaN where there is none."""
    model = problem.model
    kept = [one and one.balance.rest.coordinates(one.balance.forces(one.q)) for one in solved]
    motions = [
        None if each is None else _seen(each, observed[bool(speed)])
        for speed, each in zip(speeds, kept, strict=True)
    ]
    orders, motion = _stacked(motions)
    motion = np.swapaxes(motion, 1, 2)
    motion[:, [one.is_node for one in observed[True]], :, 3:] = np.nan
    coordinate_orders, coordinates = _stacked(kept)
    lost = np.full(len(problem.bearings), np.nan)
    loads = [one and one.balance.contacts(one.balance.values(one.q))[0] for one in solved]
    numbers = [
        (np.nan,) * 4 if one is None else (one.linear_error, one.error, *one.growth)
        for one in solved
    ]
    rotor = model.bodies[0]
    return RollingBearingResponse(
        tuple(one.label for one in observed[True]),
        speeds,
        orders,
        motion,
        problem.passes,
        tuple(one.interface for one in problem.bearings),
        np.array([lost if one is None else [each.max() for each in one] for one in loads]),
        np.array(
            [lost if one is None else [np.mean(~e.any(axis=-1)) for e in one] for one in loads]
        ),
        *np.array(numbers).T,
        coordinate_orders,
        coordinates=coordinates,
        basis="rotor",
        beside=model.coordinates[rotor.size :],
    )


def _seen(coordinates: Harmonics, observed: Sequence[Place]) -> dict[tuple[int, int], np.ndarray]:
    """Return the harmonics of places in the inertial frame, (p, 6) each; with k = 0, n ≥ 0."""
    motion: dict[tuple[int, int], np.ndarray] = {}
    for k in {k for k, _ in coordinates}:
        part = {n: x for (j, n), x in coordinates.items() if j == k}
        seen = [one.motion(part, "inertial") for one in observed]
        for n in sorted({n for each in seen for n in each}):
            a = np.array([each.get(n, np.zeros(6)) for each in seen])
            turned = k == 0 and n < 0
            order = (0, -n) if turned else (k, n)
            motion[order] = motion.get(order, 0.0) + (a.conj() if turned else a)
    return motion


def _stacked(motions: Sequence[Harmonics | None]) -> tuple[np.ndarray, np.ndarray]:
    """Return the orders (h, 2) that matter, and harmonics (s, h, …); NaN where there is none."""
    sizes: dict[tuple[int, int], float] = {}
    known = [motion for motion in motions if motion is not None]
    for motion in known:
        for order, a in motion.items():
            sizes[order] = max(sizes.get(order, 0.0), np.abs(a).max())
    orders = sorted(order for order, size in sizes.items() if size > _ROUND * max(sizes.values()))
    zero = np.zeros_like(next(iter(known[0].values())))
    stacked = [
        [zero + np.nan if motion is None else motion.get(order, zero) for order in orders]
        for motion in motions
    ]
    return np.array(orders), np.array(stacked)
