"""Unbalance response over speed and harmonic response over frequency.

Both are steady motions: they are reached in time only where the rotor is stable.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.bearings.support import NoCoefficientsError
from exudyn_rotor.callers import user_level
from exudyn_rotor.linear import options
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.modal.basis_error import warn
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_left_out_stiffening
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.basis_check import basis_errors
from exudyn_rotor.linear.response.harmonic_loads import (
    BaseAcceleration,
    HarmonicForce,
    in_words,
    total,
    unbalance_load,
)
from exudyn_rotor.linear.response.places import At, Place, checked_places, places
from exudyn_rotor.linear.response.refinement import refined
from exudyn_rotor.linear.response.responses import HarmonicResponse, UnbalanceResponse
from exudyn_rotor.linear.response.run_start import kept_coordinates
from exudyn_rotor.linear.response.unbalance import Unbalance
from exudyn_rotor.linear.solve.forced import forced_motions
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.sweep import ascending_from_zero, checked_speeds
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.threads import one_thread
from exudyn_rotor.units import Units

Coordinates = Mapping[int, np.ndarray]  # harmonics (k,) at one speed or frequency
Motions = dict[int, np.ndarray]  # harmonics (s, p, 6) over speeds or frequencies
_AT_ONCE = 2_000_000  # entries of the matrices that are solved in one call
_PER_BAR = 16  # of speeds in a step of a progress bar
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
    axes: str = "auto",
    progress: bool = False,
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
        See :func:`linear_model`.
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
    axes : {'auto', 'inertial', 'rotor'}
        Axes of the equations, see :func:`linear_model`; by default the axes of the rotor, in which
        nothing is averaged.
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    ValueError
        For speeds that do not ascend or are negative, unknown places, an unbalance on a rotor with
        another speed than the analysis, no unbalance at all, or no steady motion at any speed.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, Unbalance, unbalance_response
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> unbalance = Unbalance("left", 1e-4)
    >>> response = unbalance_response(rotor, [50.0, 100.0, 150.0], unbalance, supports=supports)
    >>> response.semi_axes("left")[0].round(6)  # m e Ω² / |k − mΩ² + icΩ|
    array([1.7e-05, 1.0e-03, 9.0e-05])
    """
    values = checked_speeds(speeds, allow_negative)
    unbalances = checks.instances(unbalances, "unbalances", Unbalance)
    checks.flag(own, "own")
    _check(frame, tolerance, refine, accuracy, progress)
    at = checked_places(at)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening, axes=axes)
    warn_of_left_out_stiffening(model, np.abs(values).max())
    refused: list[ValueError] = []

    def solve(model: LinearModel, speeds: np.ndarray) -> list[Coordinates]:
        load = unbalance_load(model, unbalances, own)
        found = [{0: np.zeros(model.size, dtype=complex)} for _ in speeds]  # no load at rest
        systems = {}
        for place in np.flatnonzero(speeds):
            try:
                systems[place] = model.at(float(speeds[place]))
            except (NoCoefficientsError, UnconvergedError) as error:
                refused.append(error)
                found[place] = {0: np.full(model.size, np.nan, dtype=complex)}
        loads = [{n: one.speed**2 * F for n, F in load.items()} for one in systems.values()]
        given = list(systems.values()), loads, np.zeros(len(systems))
        solved = forced_motions(*given, held=model.held_basis, tolerance=tolerance)
        for place, motion in zip(systems, solved, strict=True):
            found[place] = motion
        return found

    def folded(motions: Motions, _: np.ndarray) -> Motions:
        return _folded(motions)

    parts = _in_parts(solve, progress, "unbalance response")
    steady = _Steady(model.for_responses, parts, at, frame, 1.0, folded, tolerance, refused)
    values, found = steady.over(values, refine, accuracy)
    loads = in_words(model, unbalances, own)
    response = UnbalanceResponse(frame=frame, speeds=values, loads=loads, **found)
    return _with_warning(steady.model, response, accuracy, "rpm")


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
    axes: str = "auto",
    progress: bool = False,
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
    target, supports, body, at, frame, stiffening, tolerance, refine, accuracy, axes, progress
        See :func:`unbalance_response`.

    Raises
    ------
    ValueError
        For frequencies that do not ascend or are negative, unknown places, loads that are all
        zero, or no steady motion at any frequency.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, HarmonicForce, harmonic_response
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> force = HarmonicForce("left", (1.0, 0.0))  # 1 N along n1
    >>> response = harmonic_response(rotor, [50.0, 100.0], force, supports=supports)
    >>> np.abs(response.phasor("left", "n1")).round(6)
    array([6.7e-05, 1.0e-03])
    """
    values = ascending_from_zero(
        frequencies, "frequencies", "conjugate the loads: a negative frequency is that"
    )
    speed = checks.number(speed, "speed", "rad/s")
    loads = checks.instances(loads, "loads", (HarmonicForce, BaseAcceleration))
    _check(frame, tolerance, refine, accuracy, progress)
    at = checked_places(at)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening, axes=axes)
    warn_of_left_out_stiffening(model, speed)

    def solve(model: LinearModel, frequencies: np.ndarray) -> list[Coordinates]:
        system, load, count = model.at(speed), total(loads, model, speed), len(frequencies)
        given = [system] * count, [load] * count, frequencies
        return forced_motions(*given, driven=model.free_spins, tolerance=tolerance)

    def joined(motions: Motions, frequencies: np.ndarray) -> Motions:
        return _joined(motions, frequencies, speed)

    parts = _in_parts(solve, progress, "harmonic response")
    steady = _Steady(model.for_responses, parts, at, frame, speed, joined, tolerance)
    values, found = steady.over(values, refine, accuracy)
    response = HarmonicResponse(frame=frame, frequencies=values, speed=speed, **found)
    return _with_warning(steady.model, response, accuracy, "Hz")


@dataclass(frozen=True, eq=False)
class _Steady:
    """Steady motions of a model at places, over speeds or frequencies.

    Attributes
    ----------
    model : LinearModel
    solve : callable
        Takes a model, and values (s,); gives the harmonics of the coordinates at each.
    at : sequence or None
        Places to look at.
    frame : str
        Axes of the motions.
    speed : float
        Spin speed at which places are looked at, or any but 0 [rad/s].
    joined : callable
        Takes motions and values; gives motions in which no two harmonics have one frequency.
    tolerance : float
        Share of the largest motion below which a harmonic does not matter.
    refused : list of ValueError
        Why there were no equations where there were none.
    """

    model: LinearModel
    solve: Callable[[LinearModel, np.ndarray], list[Coordinates]]
    at: Sequence[At] | None
    frame: str
    speed: float
    joined: Callable[[Motions, np.ndarray], Motions]
    tolerance: float
    refused: Sequence[ValueError] = ()

    def over(
        self, values: np.ndarray, refine: bool, accuracy: float | None
    ) -> tuple[np.ndarray, dict[str, object]]:
        """Return speeds or frequencies, and the fields of a response there."""
        model, observed = self.model, places(self.model, self.at, self.speed)
        found = self.solve(model, values)
        if refine:

            def phasors(found: list[Coordinates]) -> np.ndarray:
                motions = self.seen(observed, found)
                return np.concatenate(
                    [each[..., :3].reshape(len(found), -1) for each in motions.values()], axis=1
                )

            values, found = refined(lambda more: self.solve(model, more), phasors, values, found)
        missing = [not all(map(np.all, map(np.isfinite, each.values()))) for each in found]
        _warn_of_missing(values, np.array(missing), self.refused)
        motions = self.joined(self.seen(observed, found), values)
        errors = basis_errors(model, accuracy, values, motions, self._at_places)
        orders, motion = _collected(motions, observed, self.tolerance, model.radius)
        fields = {
            "places": tuple(one.label for one in observed),
            "orders": orders,
            "motion": motion,
            "basis_errors": errors,
            "stiffening": model.stiffening,
            "refined": refine,
        }
        return values, fields | kept_coordinates(model, found, self.speed)

    def seen(self, observed: Sequence[Place], found: Sequence[Coordinates]) -> Motions:
        """Return the motions of places."""
        orders = sorted({n for each in found for n in each})
        still = np.zeros_like(next(iter(found[0].values())))
        coordinates = {n: np.array([each.get(n, still) for each in found]) for n in orders}
        frame = self.frame if self.speed else "inertial"  # at θ = 0 the axes are the same
        parts = [one.motion(coordinates, frame) for one in observed]
        none = np.zeros((len(found), 6), dtype=complex)
        return {
            n: np.stack([part.get(n, none) for part in parts], axis=1)
            for n in sorted({n for part in parts for n in part})
        }

    def _at_places(self, model: LinearModel, values: np.ndarray) -> Motions:
        """Return the motions that a model has at values."""
        observed = places(model, self.at, self.speed)
        return self.joined(self.seen(observed, self.solve(model, values)), values)


def _in_parts(solve: Callable, progress: bool, label: str) -> Callable:
    """Return what solves a few speeds or frequencies at a time, for memory and a progress bar."""

    @one_thread()
    def solved(model: LinearModel, values: np.ndarray) -> list[Coordinates]:
        count = max(1, _AT_ONCE // model.size**2)
        if progress:
            count = min(count, _PER_BAR)
        parts = range(0, len(values), count)
        if progress:
            from tqdm import tqdm

            parts = tqdm(parts, desc=label)
        return [one for first in parts for one in solve(model, values[first : first + count])]

    return solved


def _folded(motions: Motions) -> Motions:
    """Return real periodic motions by their harmonics n ≥ 0: ``Re Σ a_n exp(inΩt)``."""
    folded: Motions = {}
    for n, a in motions.items():
        folded[abs(n)] = folded.get(abs(n), 0.0) + (a if n > 0 else a.conj())
    folded[0] = folded[0].real + 0j if 0 in folded else np.zeros_like(a)
    return folded


def _joined(motions: Motions, frequencies: np.ndarray, speed: float) -> Motions:
    """Return motions of harmonics ω + nΩ in which no two have one frequency.

    Where ω + nΩ = −(ω + mΩ), the conjugate of the harmonic with the negative rate is added to the
    other one.
    """
    if speed == 0.0:
        return motions
    joined = {n: a.copy() for n, a in motions.items()}
    twice = 2.0 * frequencies / speed
    whole = np.abs(twice - np.round(twice)) <= _WHOLE * np.maximum(np.abs(twice), 1.0)
    for row in np.flatnonzero(whole):
        total = round(twice[row])  # the harmonics n and −total − n have opposite rates
        for n in motions:
            partner = -total - n
            if (n + 0.5 * total) * speed < 0.0:
                added = motions[n][row].conj()
                if partner not in joined:
                    joined[partner] = np.zeros_like(motions[n])
                joined[partner][row] += added
                joined[n][row] = 0.0
    return joined


def _collected(
    motions: Motions, observed: Sequence[Place], tolerance: float, length: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the orders (h,) that matter anywhere, and the motions (s, p, h, 6)."""
    orders = np.array(sorted(motions))
    full = np.stack([motions[n] for n in orders.tolist()], axis=2)
    # a rotation counts as the displacement that it makes at the rotor's radius of gyration
    sizes = np.abs(full * np.repeat([1.0, length], 3)).max(axis=(1, 3))
    sizes = np.nan_to_num(sizes).max(axis=0)
    keep = sizes > tolerance * sizes.max()
    if not np.any(keep):
        keep[np.argmin(np.abs(orders))] = True
    full[:, [one.is_node for one in observed], :, 3:] = np.nan
    return orders[keep], full[:, :, keep]


def _warn_of_missing(
    values: np.ndarray, missing: np.ndarray, refused: Sequence[ValueError]
) -> None:
    """Tell where there is no steady motion.

    Raises
    ------
    ValueError
        Where there is none at all.
    """
    if not np.any(missing):
        return
    why = "a constant load acts on a motion that nothing holds, or nothing damps a resonance"
    if refused:
        why = str(refused[0])
    shown = ", ".join(f"{value:.5g}" for value in values[missing][:5])
    shown += " …" if missing.sum() > 5 else ""
    if np.all(missing):
        raise ValueError(f"no steady motion at {shown} rad/s: {why}")
    warnings.warn(
        f"no steady motion at {shown} rad/s, NaN there: {why}", UserWarning, stacklevel=user_level()
    )


def _with_warning(model: LinearModel, response, accuracy: float | None, unit: str):
    """Return the response; warn where the basis leaves out too much, in `unit`, Hz or rpm."""
    errors = response.basis_errors
    if errors is not None and np.any(np.isfinite(errors)):
        at, place = np.unravel_index(np.nanargmax(errors), errors.shape)
        value = Units.of(unit).speeds(response.abscissa[at])
        what = f"the motion of {response.places[place]!r} at {value:.5g} {unit}"
        warn(errors, what, model, accuracy)
    return response


def _check(
    frame: str, tolerance: float, refine: bool, accuracy: float | None, progress: bool
) -> None:
    checks.choice(frame, "frame", FRAMES)
    options.accuracy(tolerance, "tolerance")
    checks.flag(refine, "refine")
    checks.flag(progress, "progress")
    options.check_basis_accuracy(accuracy)
