"""Loads of forced responses, as harmonics in the rotor frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.linear import options
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.models.trains.linear_train import LinearTrain
from exudyn_rotor.linear.response.places import At, Place, place
from exudyn_rotor.linear.response.unbalance import Unbalance
from exudyn_rotor.theory.rotating_axes import FRAMES, into_rotor_frame


@dataclass(frozen=True, eq=False)
class HarmonicForce:
    """A force and a moment ``Re(F exp(iωt))`` at a place of the rotor.

    Parameters
    ----------
    at : str, int, or sequence of three floats
        Interface, mesh node, or the node nearest to a position in mesh coordinates [m].
    force : array_like, shape (2,) or (3,)
        Complex amplitude along (n1, n2[, e]) of :attr:`SpinAxis.plane` [N]. A force of constant
        size that circles forward is (1, −1j).
    moment : array_like, shape (2,) or (3,), optional
        About (n1, n2[, e]), at an interface only [N m].
    frame : {'inertial', 'rotor'}
        Whether its direction is fixed in space or in the rotor; it acts on the same material
        points either way.

    Raises
    ------
    TypeError, ValueError
        For an unknown frame, a place of another kind, a wrong shape, or an entry that is not
        finite.

    Examples
    --------
    A force of 10 N that circles forward in space:

    >>> from exudyn_rotor import HarmonicForce
    >>> HarmonicForce("disc", (10.0, -10.0j)).force
    array([10. +0.j, -0.-10.j,  0. +0.j])
    """

    at: At
    force: ArrayLike = (0.0, 0.0, 0.0)
    moment: ArrayLike = (0.0, 0.0, 0.0)
    frame: str = "inertial"

    def __post_init__(self) -> None:
        checks.choice(self.frame, "frame", FRAMES)
        object.__setattr__(self, "at", options.place(self.at, "at"))
        for name, unit in (("force", "N"), ("moment", "N m")):
            vector = _vector(getattr(self, name), f"{name} at {self.at!r}", unit)
            object.__setattr__(self, name, vector)

    def _harmonics(self, model: LinearModel) -> dict[int, np.ndarray]:
        """Return the harmonics (k,) of the load in the rotor frame."""
        point = place(model, self.at)
        if self.frame == "rotor" and isinstance(model, LinearTrain):
            model.check_turning(point.label)
        if point.is_node and np.any(self.moment):
            raise ValueError(
                f"moment at {self.at!r}: a mesh node has no rotation; use an interface"
            )
        wrench = np.concatenate([self.force, self.moment])
        stays = self.frame == ("inertial" if point.stands else "rotor")
        parts = {0: wrench} if stays else into_rotor_frame(wrench)
        if point.stands and not stays:  # seen from outside it turns the other way
            parts = {-n: amplitude for n, amplitude in parts.items()}
        return {n: _pulled(point, amplitude) for n, amplitude in parts.items()}


@dataclass(frozen=True, eq=False)
class BaseAcceleration:
    """An acceleration ``Re(a exp(iωt))`` of the ground under all supports, fixed in space.

    The response is the motion relative to the ground: ``f = −Sᵀ Aᵀ τ̈`` (109). The ground's own
    displacement is ``−a/ω²``.

    Parameters
    ----------
    acceleration : array_like, shape (2,) or (3,)
        Complex amplitude along (n1, n2[, e]) of :attr:`SpinAxis.plane` [m/s²]. Weight in steady
        rotation is the acceleration −g at frequency zero.

    Raises
    ------
    TypeError, ValueError
        For a wrong shape or an entry that is not finite.

    Examples
    --------
    >>> from exudyn_rotor import BaseAcceleration
    >>> BaseAcceleration((0.0, -9.81)).acceleration
    array([ 0.  +0.j, -9.81+0.j,  0.  +0.j])
    """

    acceleration: ArrayLike

    def __post_init__(self) -> None:
        vector = _vector(self.acceleration, "acceleration", "m/s²")
        object.__setattr__(self, "acceleration", vector)

    def _harmonics(self, model: LinearModel) -> dict[int, np.ndarray]:
        """Return the harmonics (k,) of the load in the rotor frame."""
        if model.base_loads is None:
            raise ValueError(
                "base acceleration needs a rotor with supports, and a foundation with its "
                "participation; in a scene, put a force on the moving parts"
            )
        loads, standing = model.base_loads.T, np.isin(np.arange(model.size), model.standing)
        parts = into_rotor_frame(self.acceleration)
        harmonics = {n: np.where(standing, 0.0, loads @ a) for n, a in parts.items()}
        if np.any(standing):
            still = np.where(standing, loads @ self.acceleration, 0.0)
            harmonics[0] = harmonics.get(0, 0.0) + still
        return harmonics


def unbalance_load(model: LinearModel, unbalances: Sequence[Unbalance], own: bool) -> np.ndarray:
    """Return the load (k,) per Ω² of all unbalances, constant in the rotor frame.

    Raises
    ------
    ValueError
        If there is no unbalance at all.
    """
    if not unbalances and (model.is_balanced or not own):
        reason = "the rotor itself is balanced" if own else "own=False leaves out the rotor's own"
        raise ValueError(f"no unbalance, so no response: {reason}; give unbalances=[Unbalance(…)]")
    load = np.array(model.unit_unbalance, dtype=float) if own else np.zeros(model.size)
    for unbalance in unbalances:
        wrench = np.concatenate([unbalance.vector, np.zeros(3)])
        point = place(model, unbalance.at)
        if point.stands:
            raise ValueError(f"unbalance at {unbalance.at!r}: a foundation does not turn")
        if isinstance(model, LinearTrain):
            model.check_turning(point.label)
        load += _pulled(point, wrench)
    return load


def total(loads: Sequence[HarmonicForce | BaseAcceleration], model: LinearModel) -> Mapping:
    """Return the harmonics of the sum of all loads.

    Raises
    ------
    ValueError
        If there is no load or all of them are zero.
    """
    harmonics: dict[int, np.ndarray] = {}
    for load in loads:
        for n, force in load._harmonics(model).items():
            harmonics[n] = harmonics.get(n, 0.0) + force
    if not any(np.any(force) for force in harmonics.values()):
        raise ValueError(
            "no load, so no response: give loads=[HarmonicForce(…)] that move the rotor"
        )
    return harmonics


def _pulled(point: Place, wrench: np.ndarray) -> np.ndarray:
    """Return the generalised force (k,) of a force and moment (6,) along (n1, n2, e)."""
    return point.motion.T @ wrench


def _vector(value: ArrayLike, name: str, unit: str) -> np.ndarray:
    """Return an amplitude along (n1, n2, e), shape (3,), complex and read-only."""
    vector = checks.array(value, name, unit, dtype=complex)
    if vector.shape not in ((2,), (3,)):
        raise ValueError(
            f"{name}: needs two or three numbers [{unit}] along (n1, n2[, e]), got "
            f"{checks.shown(value)}"
        )
    return checks.read_only(np.r_[vector, np.zeros(3 - len(vector))], complex)
