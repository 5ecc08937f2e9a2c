"""Eigenfrequencies over spin speed in both frames (Campbell diagram)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.campbell_result import Campbell
from exudyn_rotor.linear.modal.tracking import track
from exudyn_rotor.linear.modal.whirl import (
    BACKWARD,
    FORWARD,
    MIXED,
    OVERDAMPED,
    STATIC,
    Content,
    Named,
    damping_of,
    rounded,
    signed_diameters,
)
from exudyn_rotor.linear.model.build import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import motions_over
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.units import Units

_SPLIT = 4e-8  # of the fastest motion: the split of a double zero by rounding
_FEWEST = 6  # modes that are listed of a basis with halves of pairs


def campbell(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Sequence[Given] | Given = (),
    foundation: Foundation | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    modes: int | None = None,
    frame: str = "inertial",
    stiffening: str = "auto",
    axes: str = "auto",
    allow_negative: bool = False,
    tolerance: float = 1e-6,
    accuracy: float | None = 1e-2,
    progress: bool = False,
) -> Campbell:
    """Compute the eigenfrequencies of a rotor on supports, or of a scene, over spin speed.

    Solves ``(λ²M + λ(D + 2ΩG) + K + Ω²(K2 − C)) x = 0``, the homogeneous Eq. (105) or (109) with
    supports and centrifugal stiffening, in axes in which it is constant (:func:`linear_model`).
    Every conjugate pair counts once, and so does every pair of real eigenvalues.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or LinearModel
        See :func:`linear_model`.
    speeds : array_like, shape (s,)
        Ascending spin speeds [rad/s].
    supports : sequence of Support or bearings, optional
        Of a rotor.
    foundation : Foundation, optional
        What carries them; the ground by default.
    body : RotorBody or sequence of RotorBody, optional
        The rotor in a scene, or all of several, see :func:`linear_model`.
    modes : int, optional
        How many modes to keep: those with the lowest frequencies in the `frame` at the first
        speed, followed from there, overdamped ones and those of voids in films last. All by
        default; of a basis that cuts pairs of bending modes in halves, those below the first half.
    frame : {'inertial', 'rotor'}
        In which modes are chosen, stand in order in the result, and are drawn.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening; 'none' gives the paper's equations, 'full' needs a rotor with
        prestress (:meth:`SolidRotor.prestress`).
    axes : {'auto', 'inertial', 'rotor'}
        Of the equations, see :func:`linear_model`.
    allow_negative : bool, optional
        Accept speeds below zero.
    tolerance : float, optional
        Largest relative error of an eigenvalue by the harmonics that are left out of periodic
        equations, of an uneven rotor on uneven supports.
    accuracy : float, optional
        Relative error of frequencies and growth by the basis of a reduced rotor, estimated, above
        which a warning is given: see :attr:`Campbell.basis_errors`. It looks at the modes asked
        for by `modes`; without, at those up to twice the highest speed and at the lowest six. None
        for no estimate.
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        If speeds are not finite, ascending and non-negative, an interface is unknown, or nothing
        can be computed at any speed. A single speed that fails is NaN, with a warning.

    Notes
    -----
    A spin that no support holds has the frequency 0 and no growth, at every speed and level of
    stiffening. Lateral motion is that of a rotor driven at constant speed, as in :func:`stability`
    and the responses. Without a drive an eccentric centre of mass couples both: a Jeffcott rotor
    (mass m, eccentricity e, inertia Θ about the axis, critical speed ω) then has frequencies that
    differ, relative to ω, by ``½ m e²/Θ`` at rest and ``m r²/Θ`` near ω, with the whirl radius r of
    the centre of mass.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, campbell
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> result = campbell(rotor, [0.0, 50.0], supports=supports)
    >>> result.frequencies_inertial[1, 1:5].round(2)
    array([99.97, 99.97, 99.97, 99.97])
    >>> result.whirl[1, 1:5].tolist()
    ['forward', 'forward', 'backward', 'backward']
    """
    values = checks.spin_speeds(speeds, allow_negative)
    if modes is not None:
        modes = checks.count(modes, "modes", least=1)
    tolerance = checks.tolerance(tolerance)
    checks.accuracy(accuracy)
    checks.flag(progress, "progress")
    checks.choice(frame, "frame", FRAMES)
    model = linear_model(
        target, supports=supports, foundation=foundation, body=body, stiffening=stiffening,
        axes=axes,
    )  # fmt: skip
    if modes is not None and modes > model.size:
        raise ValueError(f"modes: {modes} is not between 1 and the {model.size} there are")
    warn_of_structural_damping(model, "campbell finds modes")
    warn_of_left_out_stiffening(model, np.abs(values).max())
    motions = motions_over(model, values, tolerance=tolerance, progress=progress, label="Campbell")
    named = Content.of(model).named(motions)
    if model.free_motions:
        named = _resting(named)
    named = named.columns(ascending(named, frame))
    order, continued = track(named, model.mass_matrix)
    kept = _lowest(named, order, modes, frame, model)
    tracked = named.columns(order[:, kept])
    shifts = None
    if accuracy is not None:
        shifts = basis_error.shifts_over(model, tracked)
    result = _collected(tracked, continued[:, kept], shifts, model, frame, modes)
    _warn_of_basis(result, model, accuracy)
    return result


def _resting(found: Named) -> Named:
    """Return motions of which free ones, double zeros that rounding splits, do not grow."""
    values = found.motions.values
    split = _SPLIT * np.nanmax(np.abs(values), axis=1, keepdims=True, initial=0.0)
    rests = np.hypot(found.inertial, values.real) <= split
    motions = replace(found.motions, values=np.where(rests, 1j * values.imag, values))
    lateral = rests & np.isin(found.codes, (FORWARD, BACKWARD, MIXED, OVERDAMPED))
    return found._replace(
        motions=motions,
        inertial=np.where(rests, 0.0, found.inertial),
        codes=np.where(lateral, STATIC, found.codes),
    )


def ascending(found: Named, frame: str = "inertial") -> np.ndarray:
    """Return the order of motions (s, k): ascending in a frame, overdamped and lost ones last.

    Equal frequencies ascend in the other frame, then from backward to forward waves.
    """
    main, other = found.inertial, found.rotor
    if frame == "rotor":
        main, other = other, main
    last = np.isnan(found.motions.values) | _overdamped(found)
    keys = [-found.motions.values.real, signed_diameters(found.codes, found.diameters), other, main]
    return np.lexsort([*map(rounded, keys), last], axis=-1)


def _overdamped(found: Named) -> np.ndarray:
    growth, bounds = found.motions.values.real, found.motions.bounds[:, None]
    return (found.inertial == 0.0) & (growth < -bounds)


def _lowest(
    named: Named, order: np.ndarray, modes: int | None, frame: str, model: LinearModel
) -> np.ndarray:
    """Return the tracked columns that are kept: the lowest at the first speed with values."""
    row = named.motions.known[:1]
    first = named.rows(row).columns(order[row])
    frequencies = first.inertial if frame == "inertial" else first.rotor
    count = modes or frequencies.shape[1]
    if modes is None and np.isfinite(model.complete_up_to):
        complete = np.count_nonzero(np.abs(first.motions.values) < model.complete_up_to)
        count = max(min(_FEWEST, count), complete)
    last = _overdamped(first) | np.isnan(first.motions.values)
    rows = [i for i, name in enumerate(model.coordinates) if name.startswith("voids")]
    if rows:
        moved = np.abs(first.motions.main[0]) ** 2 * np.diag(model.mass_matrix)[:, None]
        last |= moved[rows].sum(axis=0) > 0.9 * moved.sum(axis=0)
    return np.sort(np.lexsort((rounded(frequencies), last), axis=-1)[0, :count])


def _collected(
    tracked: Named,
    continued: np.ndarray,
    shifts: np.ndarray | None,
    model: LinearModel,
    frame: str,
    modes: int | None,
) -> Campbell:
    """Return the result, whose columns ascend at every speed."""
    speeds, upwards = tracked.motions.speeds, ascending(tracked, frame)
    order = np.argsort(upwards, axis=1)
    order[np.isnan(tracked.motions.bounds)] = np.arange(order.shape[1])
    found = tracked.columns(upwards)
    growth, bounds = found.motions.values.real, found.motions.bounds[:, None]
    growth = np.where(np.abs(growth) <= bounds, 0.0, growth)
    if shifts is not None:
        chosen = basis_error.judged(found.inertial, growth, speeds, modes is not None)
        shifts = np.where(chosen, np.take_along_axis(shifts, upwards, 1), np.nan)
    ratio, decrement = damping_of(growth, found.inertial)
    return Campbell(
        speeds=speeds,
        frequencies_rotor=found.rotor,
        growth=growth,
        frequencies_inertial=found.inertial,
        damping_ratio=ratio,
        log_decrement=decrement,
        whirl_codes=found.codes,
        nodal_diameters=found.diameters,
        vectors=found.motions.main,
        order=order,
        continued=continued,
        free_motions=model.free_motions,
        stiffening=model.stiffening,
        basis_shifts=shifts,
        frame=frame,
        axes=model.axes,
        unevenness=model.unevenness,
    )


def _warn_of_basis(result: Campbell, model: LinearModel, accuracy: float | None) -> None:
    """Warn where the basis leaves out too much for the modes that count."""
    errors = result.basis_errors
    if accuracy is None or errors is None or not np.any(np.nan_to_num(errors) > accuracy):
        return
    at, mode = np.unravel_index(np.argmax(np.nan_to_num(errors)), errors.shape)
    shown = Units.of("rpm")
    speed = shown.speeds(result.speeds[at])
    heard = shown.frequencies(result.frequencies_inertial[at, mode])
    what = f"mode {mode + 1} ({result.whirl[at, mode]}, {heard:.4g} Hz) at {speed:.5g} rpm"
    basis_error.warn(errors, what, model, accuracy)
