"""Stability of a rotor on its supports over the spin speed.

The exponents λ are eigenvalues where the equations are constant in the rotor frame (isotropic
supports, or none at rest), else Floquet exponents
(:mod:`exudyn_rotor.linear.periodic.exponents`). Growth is the largest real part; exact zeros of it,
as without damping, count as stable.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear import options
from exudyn_rotor.linear.modal.whirl import WhirlContent
from exudyn_rotor.linear.models.basis.basis_error import BasisError
from exudyn_rotor.linear.models.linear_model import Target, linear_model
from exudyn_rotor.linear.stability.growth import (
    GrowthAt,
    check_options,
    constant_growths,
    held_space,
)
from exudyn_rotor.linear.stability.stability_result import Stability
from exudyn_rotor.linear.stability.uneven_mesh import warn_of_uneven_mesh
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.sweep import ascending_from_zero, sweep
from exudyn_rotor.threads import meanwhile
from exudyn_rotor.units import Units


def stability(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Sequence[Support] = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    stiffening: str = "auto",
    method: str = "auto",
    tolerance: float = 1e-9,
    modes: int | None = None,
    residual: float = 1e-7,
    accuracy: float | None = 1e-2,
    executor: Executor | None = None,
    progress: bool = False,
) -> Stability:
    """Compute the exponents of a rotor over the spin speed.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, exudyn.MainSystem or linear model
        See :func:`linear_model`. Of a SolidRotor with more than 600 degrees of freedom only the
        lowest `modes` are looked at, each checked by the residual of the full equations.
    speeds : array_like, shape (s,)
        Spin speeds [rad/s], not negative, ascending.
    supports : sequence of Support
        For a rotor. A spin that no support holds follows θ = Ωt and gives no exponent, see the
        notes of :func:`campbell`.
    body : RotorBody or sequence of these, optional
        The rotor in a ``MainSystem``, or all of several, see :func:`linear_model`.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        For a rotor; 'full' needs one with prestress.
    method : {'auto', 'floquet', 'hill', 'eigen'}
        ``'auto'``: eigenvalues where the system is constant, else Hill's method, and Floquet's
        where that does not converge. A large SolidRotor takes 'auto' only, without Floquet's.
    tolerance : float
        Error of periodic exponents relative to Ω, or to a faster decay; those beyond 100 Ω are
        not waited for.
    modes : int, optional
        How many modes of a large SolidRotor, those of smallest ``|λ|`` in the rotor frame; 10 by
        default. The growth of modes above them is not looked at.
    residual : float, optional
        Largest relative residual of those modes; see :meth:`Subspace.modes`.
    accuracy : float, optional
        Relative error of the least stable motion's growth by the basis of a reduced rotor,
        estimated, above which a warning is given: see :attr:`Stability.basis_errors`. None for no
        estimate.
    executor : concurrent.futures.Executor, optional
        Where the exponents are computed; see :func:`exudyn_rotor.sweep.sweep`. A large
        SolidRotor does not use it: its speeds share one subspace.
    progress : bool

    Raises
    ------
    ValueError
        For bad input, and where `tolerance` or `residual` is not reached.

    Examples
    --------
    Damping in the rotor drives it unstable above its critical speed:

    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, stability
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> inner = [Support(name, damping=5.0, frame="rotor") for name in ("left", "right")]
    >>> result = stability(rotor, [100.0, 400.0], supports=supports + inner)
    >>> result.stable.tolist()
    [True, False]
    """
    values = ascending_from_zero(speeds, "speeds")
    check_options(method, tolerance, modes, residual)
    options.check_basis_accuracy(accuracy)
    options.check_sweep(executor, progress)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening)
    space = held_space(model, values[-1], modes, residual)
    if executor is not None:
        space = space.prepared(values)
    with (
        meanwhile(partial(BasisError.of, held=True), model, accuracy) as basis_made,
        meanwhile(WhirlContent.of, model) as content,
    ):
        solved = None
        if executor is None and not progress and method != "floquet":
            solved = constant_growths(space, values, content)
        if solved is None:
            task = GrowthAt(space, method, tolerance, content())
            workers = None if space.is_shared else executor
            solved = sweep(task, values, executor=workers, progress=progress, label="stability")
    exponents, base = (np.array([getattr(s, name) for s in solved]) for name in ("values", "base"))
    names = ("frequencies_inertial", "whirl_codes", "nodal_diameters")
    basis = basis_made()
    result = Stability(
        speeds=values,
        exponents=exponents,
        multipliers=_multipliers(exponents, np.where(base > 0.0, base, values)),
        growth=exponents.real.max(axis=1),
        stable=np.array([entry.excess for entry in solved]) <= 0.0,
        base=base,
        bounds=np.array([entry.bounds for entry in solved]),
        **{name: np.array([s.names[i] for s in solved]) for i, name in enumerate(names)},
        tolerance=tolerance,
        basis_shifts=basis.shifts_of(values, [entry.critical for entry in solved]),
        stiffening=model.stiffening,
    )
    _warn_of_basis(basis, result)
    warn_of_uneven_mesh(model, result)
    return result


def _multipliers(exponents: np.ndarray, base: np.ndarray) -> np.ndarray:
    """Return the factors of motions over a period of the frequencies `base`; NaN without one."""
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        multipliers = np.exp(2.0 * np.pi * exponents / base[:, None])
    multipliers[base == 0.0] = np.nan
    return multipliers


def _warn_of_basis(basis: BasisError, result: Stability) -> None:
    """Warn where the basis leaves out too much for the growth of a least stable motion."""
    errors = result.basis_errors
    if errors is None or np.all(np.isnan(errors)):
        return
    row = int(np.nanargmax(errors))
    column = result.least_stable[row]
    shown = Units.of("rpm")
    heard = shown.frequencies(result.frequencies_inertial[row, column])
    motion = f"the least stable motion ({result.whirl[row, column]}, {heard:.4g} Hz)"
    speed = shown.speeds(result.speeds[row])
    basis.warn(np.nan_to_num(errors), f"{motion} at {speed:.5g} rpm")
