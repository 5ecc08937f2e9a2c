"""Growth that a rotor has only because its mesh is not quite axisymmetric.

Of a motion ``e^{iωt}`` in the rotor frame the part across the axis has the frequencies ω ± Ω in
inertial axes. Where ω < Ω, dampers of the bearings destabilise the part with ω − Ω: the drive that
holds the speed gives the energy. Torsion and axial motion have a part across the axis where the
mesh differs around the axis, by an unevenness u; they grow by no more than some u² of their rates.
"""

from __future__ import annotations

import warnings

import numpy as np

from exudyn_rotor.callers import user_level
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.trains.linear_train import LinearTrain
from exudyn_rotor.linear.models.trains.rotor_train import RotorTrain
from exudyn_rotor.linear.models.trains.train_elements import places_of
from exudyn_rotor.linear.periodic.exponents import motions
from exudyn_rotor.linear.stability.stability_result import Stability
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

_MOST = 0.05  # unevenness that a mesh may have; more is an uneven rotor


def warn_of_uneven_mesh(model: LinearModel, result: Stability) -> None:
    """Warn at the first unstable speed where an axisymmetric rotor would be stable.

    Only where growth is within the square of the unevenness: else it is the rotor's own.
    """
    rows = np.flatnonzero(~result.stable & (result.speeds > 0.0))
    small = _MOST**2 * (np.abs(result.exponents[rows]).max(axis=1) + result.speeds[rows])
    rows = rows[result.growth[rows] <= small]
    train = _train_of(model) if rows.size else None
    if train is None:
        return
    row, speed = rows[0], float(result.speeds[rows[0]])
    growing = result.exponents[row][result.exponents[row].real > result.bounds[row]]
    uneven = max(
        part.mesh_unevenness(places_of(name, train.elements)) for name, part in train.parts.items()
    )
    if uneven > _MOST or np.any(growing.real > uneven**2 * (np.abs(growing) + speed)):
        return
    found = motions(train.all_even[0].whole_space(True).at(speed), shapes=False)
    if np.any(found.values.real > found.bounds):
        return
    warnings.warn(
        f"at {speed:.5g} rad/s motions grow by {growing.real.max():.2g} 1/s only because the mesh "
        f"is not quite axisymmetric, by {uneven:.2g} of its stiffness and inertia: with the mean "
        "over a turn none grows. Make a finer mesh, or damp torsion and axial motion",
        UserWarning,
        stacklevel=user_level(),
    )


def _train_of(model: LinearModel) -> LinearTrain | None:
    """Return a model as a train; None where that cannot be."""
    if isinstance(model, LinearTrain):
        return model
    if not (isinstance(model, LinearRotor) and isinstance(model.rotor, ReducedRotor)):
        return None
    try:
        alone = RotorTrain({"rotor": model.rotor}, {"rotor": 1.0}, {"rotor": model.supports})
        return LinearTrain.of(alone, model.stiffening)
    except (TypeError, ValueError):  # supports or losses that trains do not take
        return None
