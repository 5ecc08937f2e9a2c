"""Unbalance response over speed and harmonic response over frequency.

Both are steady motions: they are reached in time only where the rotor is stable.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.calls import user_level
from exudyn_rotor.linear.equations import stacked
from exudyn_rotor.linear.modal.basis_error import basis_errors, warn
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_omissions
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import forced_over
from exudyn_rotor.linear.response.loads import (
    At,
    BaseAcceleration,
    HarmonicForce,
    Harmonics,
    Place,
    Unbalance,
    checked_places,
    in_words,
    places,
    total,
    unbalance_load,
)
from exudyn_rotor.linear.response.response import HarmonicResponse, UnbalanceResponse
from exudyn_rotor.linear.solve.forced import forced_motions
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.units import Units

_ALONG = 1e-6  # share of motion along the axis under unbalance: no static stretch by the rotation
_MOST_TURN = 0.3  # phase [rad] between neighbours: 1 − cos(0.15) = 1 % of a peak lies between
_SMALL = 1e-3  # share of the largest motion below which a motion does not count
_NARROWEST = 1e-7  # of the range: without damping a resonance has no width
_MOST_ROUNDS = 30
_MOST_ADDED = 4000
_WHOLE = 1e-9  # of 2ω/Ω: harmonics meet but for rounding


def unbalance_response(
    target: Target,
    speeds: ArrayLike,
    unbalances: Sequence[Unbalance] = (),
    *,
    own: bool = True,
    supports: Sequence[Given] | Given = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    at: Sequence[At] | At | None = None,
    frame: str = "inertial",
    stiffening: str = "auto",
    tolerance: float = 1e-6,
    refine: bool = False,
    accuracy: float | None = 1e-2,
    allow_negative: bool = False,
) -> UnbalanceResponse:
    """Compute the steady motion of an unbalanced rotor over its spin speed.

    The load ``Ω² (h + Σ Uᵀu)`` stands still in the rotor frame; h is the load of the rotor's own
    eccentricity (83). Motions have harmonics of the speed where supports or the rotor are not alike
    in all directions; how many matter is found by itself. A drive keeps the mean rotation about
    the axis at Ωt, where nothing else holds it. Amplitudes are peak values, half of peak to peak.
    A speed without a steady motion is NaN, with one warning.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or LinearModel
        See :func:`linear_model`, whose axes count; of others nothing of the rotor is averaged.
    speeds : array_like, shape (s,)
        Ascending spin speeds [rad/s], ≥ 0 but with `allow_negative`.
    unbalances : sequence of Unbalance, optional
        In addition to the rotor's own.
    own : bool, optional
        Whether the rotor's own eccentricity counts, by added point masses and by its mesh. A mesh
        that is not symmetric has some: :attr:`UnbalanceResponse.loads` tells how much.
    supports : sequence of Support, optional
        Of a rotor.
    body : RotorBody or sequence of these, optional
        The rotor in a scene, or all of several, see :func:`linear_model`.
    at : sequence of str, int or position, optional
        Interfaces and mesh nodes to look at; all interfaces by default.
    frame : {'inertial', 'rotor'}
        Axes of the resulting motion.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening; 'full' needs a rotor with prestress.
    tolerance : float, optional
        Largest relative change of the motion by further harmonics; smaller harmonics are left out.
    refine : bool, optional
        Add speeds around resonances until the phase of the motion turns by less than 0.3 rad
        between neighbours, so that a peak is known within 1 %. An interval in which two resonances
        cancel each other's phase is not seen.
    accuracy : float, optional
        Relative error of a motion by the basis of a reduced rotor, estimated, above which a warning
        is given: see :attr:`Response.basis_errors`. None for no estimate.
    allow_negative : bool, optional
        Accept speeds below zero: the rotor spins the other way round.

    Raises
    ------
    ValueError
        For speeds that do not ascend or are negative, unknown places, an unbalance on a rotor with
        another speed than the analysis, no unbalance at all, or no steady motion at any speed.

    Examples
    --------
    >>> from exudyn_rotor import Support, Unbalance, rotor_example, unbalance_response
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> unbalance = Unbalance("left", 1e-4)
    >>> response = unbalance_response(rotor, [50.0, 100.0, 150.0], unbalance, supports=supports)
    >>> response.semi_axes("left")[0].round(6)  # m e Ω² / |k − mΩ² + icΩ|
    array([1.7e-05, 1.0e-03, 9.0e-05])
    """
    values = checks.spin_speeds(speeds, allow_negative)
    unbalances = checks.instances(unbalances, "unbalances", Unbalance)
    checks.flag(own, "own")

    def solve(model: LinearModel, speeds: np.ndarray) -> tuple[Harmonics, np.ndarray]:
        load, shape = unbalance_load(model, unbalances, own), (len(speeds), model.size)
        known, found = np.ones(len(speeds), dtype=bool), {0: np.zeros(shape, dtype=complex)}
        moving = np.flatnonzero(speeds)  # at rest there is no load
        if moving.size:
            stack = model.at_all(speeds[moving])
            model.warn_beyond(np.abs(speeds[moving]))
            known[moving] = stack.known
            rows = moving[stack.known]
            acting = {n: speeds[rows, None] ** 2 * F for n, F in load.items()}
            # no unbalance acts along the axis, where nothing may hold the rotor
            options = {"held": model.moving_basis, "tolerance": tolerance}
            part = stack if np.all(known) else stack[stack.known]
            for n, X in forced_motions(part, acting, np.zeros(len(rows)), **options).items():
                found[n] = np.zeros(shape, dtype=complex)
                found[n][rows] = X
            found[0][~known] = np.nan
        return found, known

    sweep = _Sweep(at, frame, tolerance, refine, accuracy, solve)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening).for_responses
    warn_of_omissions(model, np.abs(values).max())
    values, found = sweep.over(model, values)
    loads = in_words(model, unbalances, own)
    return UnbalanceResponse(frame=frame, speeds=values, loads=loads, **found)


def harmonic_response(
    target: Target,
    frequencies: ArrayLike,
    loads: Sequence[HarmonicForce | BaseAcceleration] | HarmonicForce | BaseAcceleration,
    *,
    speed: float = 0.0,
    supports: Sequence[Given] | Given = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    at: Sequence[At] | At | None = None,
    frame: str = "inertial",
    stiffening: str = "auto",
    tolerance: float = 1e-6,
    refine: bool = False,
    accuracy: float | None = 1e-2,
) -> HarmonicResponse:
    """Compute the steady motion under harmonic loads over their frequency, at one spin speed.

    A free spin follows the moments of the loads about the axis; a drive keeps its mean where the
    load is constant. Amplitudes are peak values, half of peak to peak. Harmonics ω + nΩ that meet
    at one frequency are one motion: they are added, to the harmonic whose rate is positive. Of a
    constant load and motion the real part counts. A frequency without a steady motion is NaN, with
    one warning.

    Parameters
    ----------
    frequencies : array_like, shape (s,)
        Ascending angular frequencies ω ≥ 0 of the loads [rad/s].
    loads : sequence of HarmonicForce or BaseAcceleration
        All of one frequency, with their complex amplitudes.
    speed : float, optional
        Spin speed Ω [rad/s].
    target, supports, body, at, frame, stiffening, tolerance, refine, accuracy
        See :func:`unbalance_response`.

    Raises
    ------
    ValueError
        For frequencies that do not ascend or are negative, unknown places, loads that are all
        zero, or no steady motion at any frequency.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import HarmonicForce, Support, harmonic_response, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> force = HarmonicForce("left", (1.0, 0.0))  # 1 N along n1
    >>> response = harmonic_response(rotor, [50.0, 100.0], force, supports=supports)
    >>> np.abs(response.phasor("left", "n1")).round(6)
    array([6.7e-05, 1.0e-03])
    """
    values = checks.ascending_from_zero(
        frequencies, "frequencies", "conjugate the loads: a negative frequency is that"
    )
    speed = checks.number(speed, "speed", "rad/s")
    loads = checks.instances(loads, "loads", (HarmonicForce, BaseAcceleration))

    def solve(model: LinearModel, frequencies: np.ndarray) -> tuple[Harmonics, np.ndarray]:
        load = total(loads, model, speed)
        if not any(map(np.any, load.values())):
            what = "give loads=[HarmonicForce(…)] that move the rotor"
            raise ValueError(f"no load, so no response: {what}")
        model.warn_beyond(np.abs(np.add.outer(frequencies, speed * np.array(list(load)))))
        options = {"driven": model.free_spins, "tolerance": tolerance}
        found = forced_over(model, speed, load, frequencies, **options)
        return found, np.ones(len(frequencies), dtype=bool)

    sweep = _Sweep(at, frame, tolerance, refine, accuracy, solve, speed)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening).for_responses
    warn_of_omissions(model, speed)
    values, found = sweep.over(model, values)
    return HarmonicResponse(frame=frame, frequencies=values, speed=speed, **found)


# ------------------------------------------------------------------ over speeds or frequencies


@dataclass(frozen=True, eq=False)
class _Sweep:
    """Steady motions at places over speeds, or at one speed over the frequency of loads.

    What `solve` returns for a model and speeds or frequencies (s,) are coordinates by harmonics,
    and where there are equations for them.
    """

    at: Sequence[At] | At | None
    frame: str
    tolerance: float
    refine: bool
    accuracy: float | None
    solve: Callable[[LinearModel, np.ndarray], tuple[Harmonics, np.ndarray]]
    speed: float | None = None

    def __post_init__(self) -> None:
        checks.keep(self, at=checked_places(self.at))
        checks.choice(self.frame, "frame", FRAMES)
        checks.tolerance(self.tolerance)
        checks.flag(self.refine, "refine")
        checks.accuracy(self.accuracy)

    @one_thread()
    def over(self, model: LinearModel, values: np.ndarray) -> tuple[np.ndarray, dict[str, object]]:
        """Return speeds or frequencies, and the fields of a response there."""
        motions, known = self._motions(model, values)
        _warn_of_missing(values, motions, known)
        if self.refine:
            values, motions = self._refined(model, values, motions)
        motions, observed = self._joined(motions, values), self._places(model)
        along, unit = (_ALONG, "rpm") if self.speed is None else (1.0, "Hz")

        def better(model: LinearModel, values: np.ndarray) -> Harmonics:
            return self._joined(self._motions(model, values)[0], values)

        def told(row: int, place: int) -> str:
            where = f"{Units.of(unit).speeds(values[row]):.5g} {unit}"
            return f"the motion of {observed[place].label!r} at {where}"

        errors = basis_errors(model, self.accuracy, values, motions, better, along)
        warn(errors, told, model, self.accuracy)
        orders = np.array(sorted(motions))
        motion = np.stack([motions[n] for n in orders.tolist()], axis=2)
        # a rotation counts as the displacement that it makes at the rotor's radius of gyration
        sizes = np.abs(motion * np.repeat([1.0, model.radius], 3)).max(axis=(1, 3))
        sizes = np.nan_to_num(sizes).max(axis=0)
        matters = sizes > self.tolerance * sizes.max()
        if not np.any(matters):
            matters[np.argmin(np.abs(orders))] = True
        motion[:, [one.is_node for one in observed], :, 3:] = np.nan
        return values, {
            "places": tuple(one.label for one in observed),
            "orders": orders[matters],
            "motion": motion[:, :, matters],
            "basis_errors": errors,
            "stiffening": model.stiffening,
            "radius": model.radius,
            "axes": model.axes,
            "unevenness": model.unevenness,
        }

    def _motions(self, model: LinearModel, values: np.ndarray) -> tuple[Harmonics, np.ndarray]:
        """Return the motions of places, and at which values there are equations, (s,)."""
        frame = self.frame if self.speed != 0.0 else "inertial"  # at θ = 0 the axes are the same
        observed, (found, known) = self._places(model), self.solve(model, values)
        parts = [one.motion(found, frame) for one in observed]
        none = np.zeros((len(values), 6), dtype=complex)
        orders = sorted({n for part in parts for n in part})
        motions = {n: np.stack([part.get(n, none) for part in parts], axis=1) for n in orders}
        return motions, known

    def _places(self, model: LinearModel) -> list[Place]:
        """Return the places as seen at rest, or at any other speed."""
        return places(model, self.at, 0.0 if self.speed == 0.0 else 1.0)

    def _joined(self, motions: Harmonics, values: np.ndarray) -> Harmonics:
        """Return motions in which no two harmonics ω + nΩ have one frequency.

        Where ω + nΩ = −(ω + mΩ), the conjugate of the harmonic with the negative rate is added to
        the other one.
        """
        if self.speed == 0.0:
            return motions
        sense = 1.0 if self.speed is None else np.sign(self.speed)
        twice = 0.0 * values if self.speed is None else 2.0 * values / self.speed  # 2ω/Ω
        joined = {n: a.copy() for n, a in motions.items()}
        nearest = np.round(twice)
        meets = np.abs(twice - nearest) <= _WHOLE * np.maximum(np.abs(twice), 1.0)
        for both in np.unique(nearest[meets]).astype(int):
            rows = meets & (nearest == both)
            for n, a in motions.items():
                if sense * (2 * n + both) < 0.0:
                    partner = joined.setdefault(-both - n, np.zeros_like(a))
                    partner[rows] += a[rows].conj()
                    joined[n][rows] = 0.0
        return joined

    def _refined(
        self, model: LinearModel, values: np.ndarray, motions: Harmonics
    ) -> tuple[np.ndarray, Harmonics]:
        """Add points until the phase of every motion turns little between neighbours.

        None is added where there is no steady motion, as at a resonance without damping.
        """
        given, narrowest = values, _NARROWEST * np.ptp(values)
        for _ in range(_MOST_ROUNDS):
            wide = (np.diff(values) > narrowest) & (_turns(motions) > _MOST_TURN)
            between = np.flatnonzero(wide)[: len(given) + _MOST_ADDED - len(values)]
            if between.size == 0:
                break
            added = 0.5 * (values[between] + values[between + 1])
            values = np.concatenate([values, added])
            order = np.argsort(values)
            motions = stacked([motions, self._motions(model, added)[0]])
            values, motions = values[order], {n: a[order] for n, a in motions.items()}
        kept = ~_is_missing(motions) | np.isin(values, given)
        return values[kept], {n: a[kept] for n, a in motions.items()}


def _is_missing(motions: Harmonics) -> np.ndarray:
    """Return at which values (s,) there is no steady motion."""
    return np.isnan(sum(a.sum(axis=(1, 2)) for a in motions.values()))


def _warn_of_missing(values: np.ndarray, motions: Harmonics, known: np.ndarray) -> None:
    """Warn where equations that are known have no steady motion; refuse a sweep without any."""
    missing = _is_missing(motions)
    untold = values[missing & known]
    if not untold.size:
        return
    why = "a constant load acts on a motion that nothing holds, or nothing damps a resonance"
    shown = ", ".join(f"{value:.5g}" for value in untold[:5]) + " …" * (untold.size > 5)
    if np.all(missing):
        raise ValueError(f"no steady motion at {shown} rad/s: {why}")
    text = f"no steady motion at {shown} rad/s, NaN there: {why}"
    warnings.warn(text, UserWarning, stacklevel=user_level())


def _turns(motions: Harmonics) -> np.ndarray:
    """Return the largest change of phase between neighbours, shape (s − 1,) [rad].

    Half a turn beside rest without a load, where there is no phase and may be a resonance.
    """
    phasors = np.hstack([a[..., :3].reshape(len(a), -1) for a in motions.values()])
    size, product = np.abs(phasors), phasors[1:] * phasors[:-1].conj()
    matters = np.maximum(size[1:], size[:-1]) > _SMALL * np.nan_to_num(size).max()
    turned = np.where(product == 0.0, np.pi, np.abs(np.angle(product)))
    return np.where(matters, turned, 0.0).max(axis=1)
