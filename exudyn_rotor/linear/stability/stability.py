"""Stability of a rotor on its supports over the spin speed.

The exponents λ of all motions are eigenvalues where the equations are constant, as of a round rotor
on any supports, or of an uneven one on supports alike in all directions, else Floquet exponents
(:mod:`exudyn_rotor.linear.solve`). A rotor is stable where no motion grows by more than rounding.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.tracking import track
from exudyn_rotor.linear.modal.whirl import Content, Named, rounded
from exudyn_rotor.linear.model.build import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import motions_over
from exudyn_rotor.linear.solve.motions import METHODS, Motions
from exudyn_rotor.linear.stability.stability_result import Stability
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.units import Units

WHAT = "stability finds exponents"  # of structural damping, for the warning


def stability(
    target: Target,
    speeds: ArrayLike,
    *,
    supports: Sequence[Given] | Given = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    stiffening: str = "auto",
    axes: str = "auto",
    method: str = "auto",
    tolerance: float = 1e-6,
    accuracy: float | None = 1e-2,
    progress: bool = False,
) -> Stability:
    """Compute the exponents of a rotor over the spin speed.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or LinearModel
        See :func:`linear_model`.
    speeds : array_like, shape (s,)
        Spin speeds [rad/s], not negative, ascending.
    supports : sequence of Support or bearings
        For a rotor. A spin that no support holds follows θ = Ωt and gives no exponent, see the
        notes of :func:`campbell`.
    body : RotorBody or sequence of these, optional
        The rotor in a ``MainSystem``, or all of several, see :func:`linear_model`.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        For a rotor; 'full' needs one with prestress.
    axes : {'auto', 'inertial', 'rotor'}
        Of the equations, see :func:`linear_model`.
    method : {'auto', 'hill', 'floquet'}
        For periodic equations, as of uneven rotors on uneven supports: sums of harmonics ('hill',
        by default), or integration over a period, which finds motions up to some 20 Ω only.
    tolerance : float
        Largest relative error of λ by harmonics of periodic equations that are left out.
    accuracy : float, optional
        Relative error of the least stable motion's growth by the basis of a reduced rotor,
        estimated, above which a warning is given: see :attr:`Stability.basis_errors`. None for no
        estimate.
    progress : bool
        Show a progress bar.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        For bad input, and where there are values at none of the speeds. A single speed without
        values is NaN, with a warning.

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
    values = checks.ascending_from_zero(speeds, "speeds")
    check_options(method, tolerance, accuracy)
    checks.flag(progress, "progress")
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening, axes=axes)
    warn_of_structural_damping(model, WHAT)
    warn_of_left_out_stiffening(model, values[-1])
    motions = motions_over(
        model, values, held=True, method=method, tolerance=tolerance, progress=progress,
        label="stability",
    )  # fmt: skip
    result = _collected(Content.of(model).named(motions), model, tolerance, accuracy)
    _warn_of_basis(result, model, accuracy)
    return result


def check_options(method: str, tolerance: float, accuracy: float | None) -> None:
    """Check the options that all analyses of stability have."""
    checks.choice(method, "method", METHODS)
    checks.tolerance(tolerance)
    checks.accuracy(accuracy)


def least_stable_of(motions: Motions) -> np.ndarray:
    """Return which motion is the least stable one of those that are not neutral, (s,)."""
    growth = motions.values.real
    moves = np.abs(growth) > motions.bounds[:, None]
    return np.argmax(rounded(np.where(moves, growth, np.nan), nan=-2.0), axis=1)


def _collected(
    named: Named, model: LinearModel, tolerance: float, accuracy: float | None
) -> Stability:
    """Return the result, in each row the least stable motion first."""
    found = named.columns(
        np.lexsort((rounded(named.inertial), -rounded(named.motions.values.real, nan=-2.0)))
    )
    values = found.motions.values
    growth = np.fmax.reduce(values.real, axis=1, initial=np.nan)
    return Stability(
        speeds=found.motions.speeds,
        exponents=values.real + 1j * np.where(np.isnan(values), np.nan, found.rotor),
        growth=growth,
        stable=growth <= found.motions.bounds,
        bounds=found.motions.bounds,
        frequencies_inertial=np.where(np.isnan(values), np.nan, found.inertial),
        whirl_codes=found.codes,
        nodal_diameters=found.diameters,
        tolerance=tolerance,
        basis_shifts=_shifts(model, named, accuracy),
        stiffening=model.stiffening,
        axes=model.axes,
        unevenness=model.unevenness,
    )


def _shifts(model: LinearModel, named: Named, accuracy: float | None) -> np.ndarray | None:
    """Return the shifts (s,) of the least stable motions by what the basis leaves out."""
    if not basis_error.is_known(model, accuracy):
        return None
    tracked = named.columns(track(named, model.mass_matrix)[0])
    shifts = basis_error.shifts_over(model, tracked, held=True)
    if shifts is None:
        return None
    return np.take_along_axis(shifts, least_stable_of(tracked.motions)[:, None], 1)[:, 0]


def _warn_of_basis(result: Stability, model: LinearModel, accuracy: float | None) -> None:
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
    basis_error.warn(errors, f"{motion} at {speed:.5g} rpm", model, accuracy)
