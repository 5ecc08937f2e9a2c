"""Eigenfrequencies over spin speed in both frames (Campbell diagram)."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear import options
from exudyn_rotor.linear.modal.campbell_result import Campbell
from exudyn_rotor.linear.modal.damping import damping_of, decays_alone, oscillates
from exudyn_rotor.linear.modal.listing import listed, ranks
from exudyn_rotor.linear.modal.mesh_pairs import pair_splits
from exudyn_rotor.linear.modal.tracking import Tracks, track
from exudyn_rotor.linear.modal.whirl import STATIC, WhirlContent, named_still
from exudyn_rotor.linear.models.basis.basis_error import BasisError, judged
from exudyn_rotor.linear.models.linear_model import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.models.protocol import LinearModel, Space
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.sweep import checked_speeds, sweep
from exudyn_rotor.theory.rotating_axes import FRAMES
from exudyn_rotor.threads import meanwhile, one_thread
from exudyn_rotor.units import Units

_FULL_MODES = 10  # that are sought of a large SolidRotor by default
_SLOW = 1.0  # rad/s
_MOSTLY = 0.9  # share of a motion's energy


def campbell(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Sequence[Support] = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    modes: int | None = None,
    frame: str = "inertial",
    stiffening: str = "auto",
    allow_negative: bool = False,
    tolerance: float = 1e-8,
    residual: float = 1e-5,
    accuracy: float | None = 1e-2,
    executor: Executor | None = None,
    progress: bool = False,
) -> Campbell:
    """Compute the eigenfrequencies of a rotor on supports, or of a scene, over spin speed.

    Solves ``(λ²M + λ(D + 2ΩG) + K + Ω²(K2 − C)) x = 0``, the homogeneous Eq. (105) or (109) with
    supports and centrifugal stiffening; by Hill's method where supports that stand still differ
    in their two directions. Every conjugate pair counts once, and so does every pair of real
    eigenvalues: all modes are found, rigid and repeated ones included, or an error is raised.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, exudyn.MainSystem or linear model
        See :func:`linear_model`. A SolidRotor of more than 600 degrees of freedom is solved for
        its lowest modes, each checked by the residual of the full equations.
    speeds : array_like, shape (s,)
        Ascending spin speeds [rad/s].
    supports : sequence of Support, optional
        Of a rotor.
    body : RotorBody or sequence of these, optional
        The rotor in a scene, or all of several, see :func:`linear_model`.
    modes : int, optional
        How many modes to keep: those with the lowest frequencies in the `frame` at the first
        speed, followed from there, overdamped ones and those of voids in films last. All by
        default, 10 of a large SolidRotor; that is solved for as many more at every speed as move at
        up to the highest of their frequencies with one nodal diameter at most.
    frame : {'inertial', 'rotor'}
        In which modes are chosen, stand in order in the result, and are drawn.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening; 'none' gives the paper's equations, 'full' needs a rotor with
        prestress (:meth:`SolidRotor.prestress`).
    allow_negative : bool, optional
        Accept speeds below zero.
    tolerance : float, optional
        Largest error of an eigenvalue by the harmonics that Hill's method leaves out, relative to
        the larger of its size and the frequency of the turning coefficients.
    residual : float, optional
        Largest relative residual of a large SolidRotor; its eigenvalues err by about the square.
    accuracy : float, optional
        Relative error of frequencies and growth by the basis of a reduced rotor, estimated, above
        which a warning is given: see :attr:`Campbell.basis_errors`. It looks at the modes asked
        for by `modes`; without, at those up to twice the highest speed and at the lowest six. None
        for no estimate.
    executor : concurrent.futures.Executor, optional
        Computes the modes at the speeds. A large SolidRotor does not use it: its speeds share one
        subspace.
    progress : bool, optional
        Show a progress bar.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        If speeds are not finite, ascending and non-negative, an interface is unknown, or modes
        are lost.

    Notes
    -----
    A spin that no support holds has the frequency 0 and no growth, at every speed and level of
    stiffening. Rigid lateral motion is not coupled with it but is that of a rotor driven at
    constant speed, as in :func:`stability` and the responses: the mean rotation about the axis
    follows Ωt. Elastic motion is coupled by its Coriolis force alone, as a disc that breathes.
    Without a drive an eccentric centre of mass couples all. A
    Jeffcott rotor (mass m, eccentricity e, inertia Θ about the axis, critical speed ω) then has
    frequencies that differ, relative to ω, by ``½ m e²/Θ`` at rest and ``m r²/Θ`` near ω, with the
    whirl radius r of the centre of mass, and is unstable from ω to ``ω(1 + (½ m e²/Θ)^⅓)``; a
    product of inertia J adds ``½ J²/(I_t Θ)`` to tilts of the inertia ``I_t``. There is a warning
    from 0.1 % at rest on. A scene has its spin prescribed, for elastic motion, too, as
    :func:`stability` has it.

    Springs in the frame of the rotor that hold its spin, by torsion or off the axis, and springs
    that stand still with a distance between them, are complete, with the stiffness of the spin by
    their steady forces; tilts lack that stiffness.

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
    values = checked_speeds(speeds, allow_negative)
    if modes is not None:
        checks.count(modes, "modes", least=1)
    tolerance = options.accuracy(tolerance, "tolerance")
    residual = options.accuracy(residual, "residual")
    options.check_basis_accuracy(accuracy)
    options.check_sweep(executor, progress)
    seen = checks.choice(frame, "frame", FRAMES) == "inertial"
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening)
    warn_of_structural_damping(model, "campbell finds modes")
    warn_of_left_out_stiffening(model, np.abs(values).max())
    count = _checked_count(modes, model)
    space = model.space(count, np.abs(values).max(), residual=residual)
    if executor is not None:
        space = space.prepared(values)
    with (
        meanwhile(BasisError.of, model, accuracy) as basis_made,
        meanwhile(WhirlContent.of, model) as content_made,
    ):
        computed = model.size if model.gives_all else count
        if seen and not model.gives_all:
            fastest = values[np.argmax(np.abs(values))]
            computed = _computed(space, count, fastest, tolerance, content_made())
        modes_at = _modes_at(space, values, tolerance, executor, progress)
        basis, content = basis_made(), content_made()
    solved = _classified(modes_at, values, content, computed, seen)
    static = np.array([entry.codes == STATIC for entry in solved])
    seen_from_outside = content.mean_waves, static
    found = [entry.modes for entry in solved]
    tracks = track(found, values, model.mass_matrix.__matmul__, *seen_from_outside)
    solved, tracks = _lowest(solved, tracks, count, seen, model)
    inertial = np.array([entry.inertial for entry in solved])
    growth = np.array([entry.modes.values.real for entry in solved])
    chosen = judged(inertial, growth, values, modes is not None)
    shifts = basis.shifts(values, [entry.modes for entry in solved], chosen)
    splits = _splits(solved, values, content, space)
    result = _collected(values, solved, tracks, model, (shifts, splits, frame))
    _warn_of_basis(basis, result)
    return result


@one_thread()
def _modes_at(
    space: Space, speeds: np.ndarray, tolerance: float, executor: Executor | None, progress: bool
) -> list[FloquetModes]:
    """Return the modes at all speeds; at once where nobody else is to compute them."""
    if executor is None and not progress:
        try:
            modes = space.modes_at(speeds, tolerance)
        except ValueError:
            modes = None  # one by one below, so that the error names its speed
        if modes is not None:
            return modes
    task = _Task(space, tolerance)
    workers = None if space.is_shared else executor
    return sweep(task, speeds, executor=workers, progress=progress, label="Campbell")


@dataclass(frozen=True, eq=False)
class _Task:
    """Solves one speed; picklable where the space is, so that processes can do it."""

    space: Space
    tolerance: float

    def __call__(self, speed: float) -> FloquetModes:
        return self.space.modes(speed, self.tolerance)


class _Solved(NamedTuple):
    """Modes at one speed, with inertial frequency, whirl and nodal diameter, each (k,)."""

    modes: FloquetModes
    inertial: np.ndarray
    codes: np.ndarray
    diameters: np.ndarray

    def columns(self, chosen: np.ndarray) -> _Solved:
        """Return some of the modes."""
        return _Solved(self.modes.columns(chosen), *(array[chosen] for array in self[1:]))


@one_thread()
def _classified(
    modes: Sequence[FloquetModes],
    speeds: Sequence[float],
    content: WhirlContent,
    count: int,
    seen: bool,
) -> list[_Solved]:
    """Return the modes ascending as they are `seen` from outside, or in the rotor frame.

    Overdamped ones, which get the inertial frequency 0, stand behind the others.
    """
    vectors, *named = zip(*content.named_at(modes, speeds), strict=True)
    inertial, codes, diameters = (np.array([row[:count] for row in rows]) for rows in named)
    values = np.array([entry.values[:count] for entry in modes])
    growth, decays = values.real, np.array([_decays(entry)[:count] for entry in modes])
    resolution = np.array([[entry.resolution] for entry in modes])
    moves = oscillates(growth, inertial, resolution)
    moves &= ~decays_alone(growth, values.imag, np.reshape(speeds, (-1, 1)))
    codes = named_still(codes, ~moves & decays, ~moves & ~decays)
    inertial = np.where(moves, inertial, 0.0)
    bounds = np.array(
        [np.broadcast_to(_rounding(each), each.values.shape)[:count] for each in modes]
    )
    found = values, bounds, inertial, codes, diameters
    order = listed(*found, last=~moves & decays, seen=seen)
    solved = zip(modes, vectors, inertial, codes, diameters, order, strict=True)
    return [
        _Solved(
            FloquetModes(entry.values, shapes, entry.orders, entry.resolution, entry.bounds), *found
        ).columns(chosen)
        for entry, shapes, *found, chosen in solved
    ]


def _decays(modes: FloquetModes) -> np.ndarray:
    """Return which motions decay by more than rounding, shape (k,)."""
    return modes.values.real < -_rounding(modes)


def _rounding(modes: FloquetModes) -> np.ndarray | float:
    """Return the error of real parts by rounding, shape (k,) or one for all."""
    return modes.resolution if modes.bounds is None else modes.bounds


def _computed(
    space: Space, count: int, speed: float, tolerance: float, content: WhirlContent
) -> int:
    """Return how many modes of a large rotor to solve for, so that none of `count` is missed.

    A motion with one nodal diameter at most that is seen at ω has at most ω + Ω in the rotor frame.
    The space solves for as many from here on.
    """
    while True:
        modes = space.modes(speed, tolerance)
        lowest = _classified([modes], [speed], content, space.count, True)[0].inertial[:count]
        if modes.values.imag.max() >= lowest.max() + abs(speed) or not space.ask_for_more():
            return space.count


@one_thread()
def _splits(
    solved: list[_Solved], speeds: np.ndarray, content: WhirlContent, space: Space
) -> np.ndarray:
    """Return :attr:`Campbell.splits`; anisotropic supports have no pairs."""
    if np.any(speeds):
        alike = all(len(entry.modes.orders) == 1 for entry in solved)
    else:  # supports that stand still differ from turning ones at a speed only
        alike = space.at(_SLOW).is_constant
    inertial, codes, diameters = (np.array(rows) for rows in list(zip(*solved, strict=True))[1:])
    if not alike:
        return np.zeros(inertial.shape)
    return pair_splits(content, [e.modes.central for e in solved], inertial, codes, diameters)


def _lowest(
    solved: list[_Solved], tracks: Tracks, count: int, seen: bool, model: LinearModel
) -> tuple[list[_Solved], Tracks]:
    """Keep the modes that have the lowest frequencies at the first speed.

    Of overdamped ones, and of those of voids in films, only where there are no others left.
    """
    if count >= tracks.columns.shape[1]:
        return solved, tracks
    first = solved[0].columns(tracks.columns[0])
    modes = first.modes
    last = (first.inertial == 0.0) & _decays(modes) | _of_voids(modes, model)
    frequencies = first.inertial if seen else modes.values.imag
    chosen = np.sort(np.lexsort((ranks(frequencies, _rounding(modes)), last))[:count])
    used = tracks.columns[:, chosen]
    ascending = np.sort(used, axis=1)
    places = [np.searchsorted(*rows) for rows in zip(ascending, used, strict=True)]
    fewer = [entry.columns(row) for entry, row in zip(solved, ascending, strict=True)]
    return fewer, Tracks(np.array(places), tracks.continued[:, chosen])


def _of_voids(modes: FloquetModes, model: LinearModel) -> np.ndarray:
    """Return which motions have nearly all kinetic energy in what films remember, shape (k,)."""
    if not model.voids.size:
        return np.zeros(len(modes.values), dtype=bool)
    x, M = modes.vectors, model.mass_matrix
    moved = np.sum(np.abs(x[:, model.voids]) ** 2, axis=0)
    own = M.diagonal()[model.voids] @ moved
    return own > _MOSTLY * np.einsum("hck,cd,hdk->k", x.conj(), M, x).real


def _collected(
    speeds: np.ndarray,
    solved: list[_Solved],
    tracks: Tracks,
    model: LinearModel,
    found: tuple[np.ndarray | None, np.ndarray, str],
) -> Campbell:
    modes, inertial, whirl, diameters = zip(*solved, strict=True)
    # adding zero turns −0 into 0
    eigenvalues = np.array([entry.values for entry in modes]) + 0.0
    inertial = np.array(inertial)
    resolution = np.array([[entry.resolution] for entry in modes])
    neutral = (inertial == 0.0) & (np.abs(eigenvalues.real) <= resolution)
    neutral &= ~np.array([_decays(entry) for entry in modes])
    growth = np.where(neutral, 0.0, eigenvalues.real)
    told = [np.abs(entry.values.real) > _rounding(entry) for entry in modes]
    ratio, decrement = damping_of(np.where(told, growth, 0.0), inertial)
    return Campbell(
        speeds=speeds,
        frequencies_rotor=eigenvalues.imag,
        growth=growth,
        frequencies_inertial=inertial,
        damping_ratio=ratio,
        log_decrement=decrement,
        whirl_codes=np.array(whirl, dtype=np.int64),
        nodal_diameters=np.array(diameters, dtype=np.int64),
        vectors=np.array([entry.central for entry in modes]),
        order=tracks.columns,
        continued=tracks.continued,
        free_motions=model.free_motions,
        stiffening=model.stiffening,
        basis_shifts=found[0],
        splits=found[1],
        frame=found[2],
    )


def _warn_of_basis(basis: BasisError, result: Campbell) -> None:
    """Warn where the basis leaves out too much for the modes that count."""
    errors = result.basis_errors
    if errors is None:
        return
    at, mode = np.unravel_index(np.argmax(np.nan_to_num(errors)), errors.shape)
    shown = Units.of("rpm")
    speed = shown.speeds(result.speeds[at])
    heard = shown.frequencies(result.frequencies_inertial[at, mode])
    word = result.whirl[at, mode]
    basis.warn(errors, f"mode {mode + 1} ({word}, {heard:.4g} Hz) at {speed:.5g} rpm")


def _checked_count(modes: int | None, model: LinearModel) -> int:
    if modes is None:
        return model.size if model.gives_all else min(_FULL_MODES, model.size)
    if modes > model.size:
        raise ValueError(f"modes: {modes} is not between 1 and the {model.size} there are")
    return int(modes)
