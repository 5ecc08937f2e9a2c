"""Unbalance response over speed and harmonic response over frequency.

Both are steady motions: they are reached in time only where the rotor is stable.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear import options
from exudyn_rotor.linear.models.basis.basis_error import BasisError
from exudyn_rotor.linear.models.linear_model import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
)
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.models.rotor.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.models.scene.remembering_scene import RememberingScene
from exudyn_rotor.linear.response.basis_check import (
    HARMONICS,
    looked_at,
    motion_error,
    with_warning,
)
from exudyn_rotor.linear.response.harmonic_loads import (
    BaseAcceleration,
    HarmonicForce,
    total,
    unbalance_load,
)
from exudyn_rotor.linear.response.places import (
    At,
    checked_places,
    collected,
    places,
)
from exudyn_rotor.linear.response.refinement import refined
from exudyn_rotor.linear.response.responses import HarmonicResponse, UnbalanceResponse
from exudyn_rotor.linear.response.run_start import kept_basis
from exudyn_rotor.linear.response.steady_tasks import (
    HarmonicTask,
    Observation,
    Solved,
    UnbalanceTask,
)
from exudyn_rotor.linear.response.unbalance import Unbalance
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.sweep import ascending_from_zero, checked_speeds, sweep
from exudyn_rotor.theory.rotating_axes import FRAMES

_MODES = 6  # that the subspace of a full rotor begins with


def unbalance_response(
    target: Target,
    speeds: ArrayLike,
    unbalances: Sequence[Unbalance] = (),
    *,
    own: bool = True,
    supports: Sequence[Support] = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    at: Sequence[At] | At | None = None,
    frame: str = "inertial",
    stiffening: str = "auto",
    tolerance: float = 1e-9,
    residual: float = 1e-9,
    refine: bool = False,
    accuracy: float | None = 1e-2,
    allow_negative: bool = False,
    executor: Executor | None = None,
    progress: bool = False,
) -> UnbalanceResponse:
    """Compute the steady motion of an unbalanced rotor over its spin speed.

    The load ``Ω² (h + Σ Uᵀu)`` is constant in the rotor frame; h is the rotor's own (83). So is the
    motion where no coefficient turns with the rotor; on anisotropic supports it is found in
    harmonics of the speed, and how many are needed is found by itself. A drive keeps the mean
    rotation about the axis at Ωt, where nothing else holds it.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, exudyn.MainSystem or linear model
        See :func:`linear_model`. A SolidRotor is solved unreduced, each speed checked by the
        residual of the full equations.
    speeds : array_like, shape (s,)
        Ascending spin speeds [rad/s], ≥ 0 but with `allow_negative`.
    unbalances : sequence of Unbalance, optional
        In addition to the rotor's own.
    own : bool, optional
        Whether the rotor's own eccentricity counts: that of added point masses, and of the mesh.
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
    residual : float, optional
        Largest residual of the equations of a SolidRotor, relative to the loads in the norm of
        their static response.
    refine : bool, optional
        Add speeds around resonances until the phase of the motion turns by less than 0.3 rad
        between neighbours, so that a peak is known within 1 %. An interval in which two resonances
        cancel each other's phase is not seen.
    accuracy : float, optional
        Relative error of a motion by the basis of a reduced rotor, estimated, above which a warning
        is given: see :attr:`Response.basis_errors`. None for no estimate.
    allow_negative : bool, optional
        Accept speeds below zero: the rotor spins the other way round.
    executor : concurrent.futures.Executor, optional
        Computes the speeds; see :func:`exudyn_rotor.sweep.sweep`. A SolidRotor does not use
        it: its speeds share one subspace.
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    ValueError
        For speeds that do not ascend or are negative, unknown places, no unbalance at all, a
        speed without a steady motion, or a `residual` that is not reached.

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
    _check(frame, tolerance, residual, accuracy)
    checks.flag(refine, "refine")
    options.check_sweep(executor, progress)
    at = checked_places(at)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening, dense=False)
    fastest = np.abs(values).max()
    warn_of_left_out_stiffening(model, fastest)
    observed = places(model, at)
    load = unbalance_load(model, unbalances, own)
    basis = BasisError.of(model, accuracy)
    space = model.space(_MODES, fastest, loads=[load], held=True, residual=residual)
    observation = Observation.of(observed, frame, tolerance, model)
    task = UnbalanceTask(space.prepared(values[values != 0.0]), load, observation)
    workers = None if space.is_shared else executor
    given = {"executor": workers, "progress": progress, "label": "unbalance response"}
    solved = sweep(task, values, **given)
    if refine:

        def solve(added: np.ndarray) -> list[Solved]:
            return sweep(replace(task, space=space.prepared(added)), added, **given)

        values, solved = refined(solve, values, solved)
    labels = tuple(one.label for one in observed)
    found = collected([one.motion for one in solved], observed, tolerance, model.radius)

    def better(finer: LinearModel, observation: Observation) -> Callable[[float], Solved]:
        load = unbalance_load(finer, unbalances, own)
        space = finer.space(_MODES, fastest, loads=[load], held=True)
        return UnbalanceTask(space, load, observation)

    constant = space.at(values[np.argmax(np.abs(values))]).is_constant
    errors = _basis_errors(basis, observation, at, values, solved, better, constant)
    extra = _kept(model, solved) | {"refined": refine, "basis_errors": errors}
    extra["loads"] = tuple(map(str, unbalances)) + ("the rotor's own unbalance",) * own
    response = UnbalanceResponse(labels, *found, frame, values, **extra)
    return with_warning(basis, response, "rpm")


def harmonic_response(
    target: Target,
    frequencies: ArrayLike,
    loads: Sequence[HarmonicForce | BaseAcceleration] | HarmonicForce | BaseAcceleration,
    *,
    speed: float = 0.0,
    supports: Sequence[Support] = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    at: Sequence[At] | At | None = None,
    frame: str = "inertial",
    stiffening: str = "auto",
    tolerance: float = 1e-9,
    residual: float = 1e-9,
    refine: bool = False,
    accuracy: float | None = 1e-2,
    executor: Executor | None = None,
    progress: bool = False,
) -> HarmonicResponse:
    """Compute the steady motion under harmonic loads over their frequency, at one spin speed.

    Parameters
    ----------
    frequencies : array_like, shape (s,)
        Ascending angular frequencies ω ≥ 0 of the loads [rad/s].
    loads : sequence of HarmonicForce or BaseAcceleration
        All of one frequency, with their complex amplitudes.
    speed : float, optional
        Spin speed Ω [rad/s].
    target, supports, body, at, frame, stiffening, tolerance, residual, refine, accuracy
        See :func:`unbalance_response`.
    executor, progress
        See :func:`unbalance_response`.

    Raises
    ------
    ValueError
        For frequencies that do not ascend or are negative, unknown places, loads that are all
        zero, a frequency without a steady motion, or a `residual` that is not reached.

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
    _check(frame, tolerance, residual, accuracy)
    checks.flag(refine, "refine")
    options.check_sweep(executor, progress)
    at = checked_places(at)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening, dense=False)
    warn_of_left_out_stiffening(model, speed)
    observed = places(model, at)
    load = total(loads, model)
    fastest = max(values[-1], abs(speed))
    basis = BasisError.of(model, accuracy)
    space = model.space(_MODES, fastest, loads=list(load.values()), residual=residual)
    observation = Observation.of(observed, frame, tolerance, model)
    task = HarmonicTask(space.prepared([speed]), speed, load, observation)
    workers = None if space.is_shared else executor
    given = {"executor": workers, "progress": progress, "label": "harmonic response"}
    solved = sweep(task, values, **given)
    if refine:
        values, solved = refined(partial(sweep, task, **given), values, solved)
    labels = tuple(one.label for one in observed)
    found = collected([one.motion for one in solved], observed, tolerance, model.radius)

    def better(finer: LinearModel, observation: Observation) -> Callable[[float], Solved]:
        space = finer.space(_MODES, fastest, loads=list(load.values())).prepared([speed])
        return HarmonicTask(space, speed, total(loads, finer), observation)

    constant = space.at(speed).is_constant
    errors = _basis_errors(basis, observation, at, values, solved, better, constant)
    extra = _kept(model, solved) | {"refined": refine, "basis_errors": errors}
    response = HarmonicResponse(labels, *found, frame, values, speed, **extra)
    return with_warning(basis, response, "Hz")


def _basis_errors(
    basis: BasisError,
    observation: Observation,
    at: Sequence[At] | None,
    values: np.ndarray,
    solved: Sequence[Solved],
    task: Callable[[LinearModel, Observation], Callable[[float], Solved]],
    constant: bool,
) -> np.ndarray | None:
    """Return relative errors (s, p) by the basis; None where they are not known."""
    if not basis.is_known:
        return None
    if basis.left_out is None:
        return np.zeros((len(solved), len(observation.rows)))
    finer = basis.left_out.equations
    rows = np.array([one.motion for one in places(finer, at)])
    tolerance = max(observation.tolerance, HARMONICS)
    better = task(finer, replace(observation, rows=rows, keeps=False, tolerance=tolerance))
    motions = [one.motion for one in solved]
    errors = np.full((len(solved), len(rows)), np.nan)
    for index in looked_at(motions, constant):
        errors[index] = motion_error(motions[index], better(float(values[index])).motion)
    return errors


def _kept(model: LinearModel, solved: Sequence[Solved]) -> dict[str, object]:
    """Return what a response keeps beside its motion: the level, and what runs begin with."""
    level = {"stiffening": model.stiffening}
    if isinstance(model, RememberingScene):  # runs begin with films at rest
        model = model.scene
    if kept_basis(model) is None:
        return level
    top = max(abs(n) for one in solved for n in one.coordinates)
    coordinates = np.zeros((len(solved), 2 * top + 1, model.size), dtype=complex)
    for row, one in zip(coordinates, solved, strict=True):
        for n, x in one.coordinates.items():
            row[top + n] = x[: model.size]
    beside = model.beside if isinstance(model, ExtendedRotor) else ()
    return level | {"coordinates": coordinates, "basis": kept_basis(model), "beside": beside}


def _check(frame: str, tolerance: float, residual: float, accuracy: float | None) -> None:
    checks.choice(frame, "frame", FRAMES)
    options.accuracy(tolerance, "tolerance")
    options.accuracy(residual, "residual")
    options.check_basis_accuracy(accuracy)
