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
from exudyn_rotor.linear.models.linear_model import (
    DENSE_SIZE,
    linear_model,
    warn_of_left_out_stiffening,
)
from exudyn_rotor.linear.models.rotor.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.periodic.periodic_system import UnconvergedError
from exudyn_rotor.linear.response.contact_rest import Harmonics
from exudyn_rotor.linear.response.harmonic_loads import (
    BaseAcceleration,
    HarmonicForce,
    total,
    unbalance_load,
)
from exudyn_rotor.linear.response.places import At, Place, checked_places, in_frame, places
from exudyn_rotor.linear.response.rolling_motion import RollingProblem, SteadyMotion
from exudyn_rotor.linear.response.rolling_result import RollingBearingResponse
from exudyn_rotor.linear.response.run_start import kept_basis
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
        A SolidRotor of up to 600 degrees of freedom; reduce a larger one.
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
        Where no steady motion of these two frequencies is found.

    Warns
    -----
    UserWarning
        Where a steady motion is unstable, or lacks more harmonics than `tolerance` allows.

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
    _check_target(target)
    values = ascending_from_zero(speeds, "speeds")
    unbalances = checks.instances(unbalances, "unbalances", Unbalance)
    loads = checks.instances(loads, "loads", HarmonicForce)
    gravity = checks.vector(gravity, "gravity", "m/s²")
    tolerance = options.accuracy(tolerance, "tolerance")
    checks.flag(own, "own")
    checks.flag(downwards, "downwards")
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
    observed = places(model, checked_places(at))
    across = parts_across(axes_of(target.axis), gravity)
    weight = [BaseAcceleration(-across)] if np.any(across) else []
    static = total([*weight, *loads], model) if weight or loads else {}
    whirls = bool(unbalances) or (own and not model.is_balanced)
    # a balanced rotor is strained by centrifugal loads, too
    unbalance = (unbalance_load(model, unbalances, own) if whirls
                 else own * np.array(model.unit_unbalance, dtype=float))  # fmt: skip
    _check_loaded(static, whirls * values[0] * unbalance)
    problem = RollingProblem(model, bearings, np.repeat(springs, 2), passes, static, unbalance)
    try:
        with one_thread():
            solved = problem.swept(values[::-1] if downwards else values, tolerance)
    except ValueError as error:
        pressed = bool(weight or loads) or not np.any(gravity)
        raise _explained(error, model.free_motions, given, pressed) from error
    solved = solved[::-1] if downwards else solved
    _warn_of_left_out(max(solved, key=lambda one: one.error), tolerance)
    found = _result(problem, observed, values, solved)
    _warn_of_instability(found)
    return found


def _check_target(target: ReducedRotor | SolidRotor) -> None:
    checks.instance(target, "target", (ReducedRotor, SolidRotor))
    if isinstance(target, SolidRotor) and 3 * target.node_count > DENSE_SIZE:
        raise ValueError(
            f"target: needs a SolidRotor of up to {DENSE_SIZE} degrees of freedom, got "
            f"{3 * target.node_count}; give the reduced rotor, rotor.reduce(…)"
        )


def _explained(
    error: ValueError, free: Sequence[str], supports: Sequence[Given], pressed: bool
) -> ValueError:
    """Return the error with what the rotor lacks, where that is known: a support or a load."""
    across = [name for name in free if name not in _NOT_ACROSS]
    ends = ", ".join(dict.fromkeys(repr(one.interface) for one in supports))
    if across:
        motion = "tilting" if any("tilt" in name for name in across) else "lateral motion"
        lacking = (
            f"supports: nothing holds the rotor against {motion}: all stand at {ends}; add one at "
            "another interface"
        )
    elif ModeKind.AXIAL.value in free and not isinstance(error, UnconvergedError):
        lacking = (
            f"supports: nothing holds the rotor along its axis, with supports at {ends}; add "
            "a stiffness along the axis, or leave out loads along it"
        )
    elif not pressed:
        lacking = (
            "gravity: lies along the axis, where it presses no element; give a load across it, or "
            "an unbalance that is not small"
        )
    else:
        return error
    return type(error)(f"{lacking} ({error})")


def _check_loaded(static: Mapping[int, np.ndarray], unbalance: np.ndarray) -> None:
    """Refuse a rotor that nothing presses into its bearings."""
    if not static and not np.any(unbalance):
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
    observed: Sequence[Place],
    speeds: np.ndarray,
    solved: Sequence[SteadyMotion],
) -> RollingBearingResponse:
    """Return the motions (s, p, h, 6) of places, and loads of elements."""
    kept = [one.balance.rest.coordinates(one.balance.forces(one.q)) for one in solved]
    motions = [_seen(answer, observed, speed) for speed, answer in zip(speeds, kept, strict=True)]
    orders, motion = _stacked(motions)
    motion = np.swapaxes(motion, 1, 2)
    motion[:, [one.is_node for one in observed], :, 3:] = np.nan
    coordinate_orders, coordinates = _stacked(kept)
    loads = [one.balance.contacts(one.balance.values(one.q))[0] for one in solved]
    return RollingBearingResponse(
        tuple(one.label for one in observed),
        speeds,
        orders,
        motion,
        problem.passes,
        tuple(one.interface for one in problem.bearings),
        np.array([[each.max() for each in one] for one in loads]),
        np.array([[np.mean(~each.any(axis=-1)) for each in one] for one in loads]),
        np.array([one.linear_error for one in solved]),
        np.array([one.error for one in solved]),
        *np.array([one.growth for one in solved]).T,
        coordinate_orders,
        coordinates=coordinates,
        basis=kept_basis(problem.model),
        beside=problem.model.beside if isinstance(problem.model, ExtendedRotor) else (),
    )


def _seen(coordinates: Harmonics, observed: Sequence[Place], speed: float) -> Harmonics:
    """Return the harmonics of places in the inertial frame, (p, 6) each; with k = 0, n ≥ 0."""
    rows = np.array([one.motion for one in observed])
    stands = np.array([one.stands for one in observed])
    motion: dict[tuple[int, int], np.ndarray] = {}
    for k in {k for k, _ in coordinates}:
        seen = {n: rows @ x for (j, n), x in coordinates.items() if j == k}
        for n, a in (in_frame(seen, stands, "inertial") if speed else seen).items():
            turned = k == 0 and n < 0
            order = (0, -n) if turned else (k, n)
            motion[order] = motion.get(order, 0.0) + (a.conj() if turned else a)
    return motion


def _stacked(motions: Sequence[Harmonics]) -> tuple[np.ndarray, np.ndarray]:
    """Return the orders (h, 2) that matter, and harmonics (s, h, …), zero where one has none."""
    sizes: dict[tuple[int, int], float] = {}
    for motion in motions:
        for order, a in motion.items():
            sizes[order] = max(sizes.get(order, 0.0), np.abs(a).max())
    orders = sorted(order for order, size in sizes.items() if size > _ROUND * max(sizes.values()))
    zero = np.zeros_like(next(iter(motions[0].values())))
    stacked = [[motion.get(order, zero) for order in orders] for motion in motions]
    return np.array(orders), np.array(stacked)
