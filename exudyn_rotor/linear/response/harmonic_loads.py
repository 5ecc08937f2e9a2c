"""Loads of forced responses, as harmonics of the speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.places import At, Place, place
from exudyn_rotor.linear.response.unbalance import Unbalance
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.rotating_axes import FRAMES, turning_harmonics

_BALANCED = 1e-13  # rounding leaves this much of the unbalance of a perfectly balanced mesh


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
        object.__setattr__(self, "at", checks.place(self.at, "at"))
        for name, unit in (("force", "N"), ("moment", "N m")):
            vector = _vector(getattr(self, name), f"{name} at {self.at!r}", unit)
            object.__setattr__(self, name, vector)

    def _harmonics(self, model: LinearModel, speed: float) -> dict[int, np.ndarray]:
        """Return the harmonics (k,) of the load."""
        point = place(model, self.at, speed)
        if point.is_node and np.any(self.moment):
            raise ValueError(
                f"moment at {self.at!r}: a mesh node has no rotation; use an interface"
            )
        parts = {0: np.concatenate([self.force, self.moment])}
        if self.frame == "rotor":
            _check_turning(model, point)
            if speed:
                parts = {n: R @ parts[0] for n, R in turning_harmonics(6).items()}
        return _pulled(point, parts)


@dataclass(frozen=True, eq=False)
class BaseAcceleration:
    """An acceleration ``Re(a exp(iωt))`` of the ground under all supports, fixed in space.

    The response is the motion relative to the ground: ``f = −Sᵀ Aᵀ τ̈`` (109). The ground's own
    displacement is ``−a/ω²``. Gravity g acts as the acceleration −g of the ground does, at
    frequency zero: ground that accelerates upward presses as weight does.

    Parameters
    ----------
    acceleration : array_like, shape (2,) or (3,)
        Complex amplitude along (n1, n2[, e]) of :attr:`SpinAxis.plane` [m/s²].

    Raises
    ------
    TypeError, ValueError
        For a wrong shape or an entry that is not finite.

    Examples
    --------
    Weight in the direction −n2 makes a rotor of 4 kg sag by m g/k:

    >>> import numpy as np
    >>> from exudyn_rotor import BaseAcceleration, SolidRotor, Support, harmonic_response
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> weight = BaseAcceleration((0.0, +9.81))
    >>> response = harmonic_response(rotor, [0.0], weight, supports=supports)
    >>> response.phasor("left", "n2").real
    array([-0.000981])
    """

    acceleration: ArrayLike

    def __post_init__(self) -> None:
        vector = _vector(self.acceleration, "acceleration", "m/s²")
        object.__setattr__(self, "acceleration", vector)

    def _harmonics(self, model: LinearModel, speed: float) -> dict[int, np.ndarray]:
        """Return the harmonics (k,) of the load."""
        loads = model.base_loads(speed)
        if loads is None:
            raise ValueError(
                "base acceleration needs a rotor with supports, and a foundation with its "
                "participation; in a scene, put a force on the moving parts"
            )
        return {n: each.T @ self.acceleration for n, each in loads.items()}


def unbalance_load(
    model: LinearModel, unbalances: Sequence[Unbalance], own: bool
) -> dict[int, np.ndarray]:
    """Return the load per Ω² of all unbalances, as harmonics (k,).

    Raises
    ------
    ValueError
        If there is no unbalance at all.
    """
    turning = [rotor for name, rotor in model.rotors.items() if model.ratios[name] == 1.0]
    balanced = all(map(_is_balanced, turning))
    if not unbalances and (balanced or not own):
        reason = "the rotor itself is balanced" if own else "own=False leaves out the rotor's own"
        raise ValueError(f"no unbalance, so no response: {reason}; give unbalances=[Unbalance(…)]")
    load = dict(model.unbalance()) if own else {0: np.zeros(model.size)}
    for unbalance in unbalances:
        point = place(model, unbalance.at)
        if point.ratio == 0.0:
            raise ValueError(f"unbalance at {unbalance.at!r}: a foundation does not turn")
        _check_turning(model, point)
        for n, force in model.unbalance_at(point.seen, unbalance.vector).items():
            load[n] = load.get(n, 0.0) + force
    return load


def in_words(model: LinearModel, unbalances: Sequence[Unbalance], own: bool) -> tuple[str, ...]:
    """Return the unbalances as text, the own one with its amount beside those that are given."""
    found = tuple(map(str, unbalances))
    if not own:
        return found
    given = sum(unbalance.amount for unbalance in unbalances)
    for name, rotor in model.rotors.items():
        if model.ratios[name] == 1.0:
            amount = float(np.linalg.norm(_static_unbalance(rotor)))
            share = f", {amount / given:.2g} of the amount given" if given else ""
            whose = f"rotor {name!r}" if name else "the rotor"
            found += (f"eccentricity of {whose}, with its mesh: {1e6 * amount:.4g} g mm{share}",)
    return found


def _static_unbalance(rotor: ReducedRotor) -> np.ndarray:
    """Return mass times eccentricity (3,) [kg m]."""
    off = rotor.center_of_mass - rotor.axis.project(rotor.center_of_mass)
    return rotor.invariants.mass * off


def _is_balanced(rotor: ReducedRotor) -> bool:
    """Return whether centre of mass and principal axis are on the spin axis but for rounding."""
    inv, e = rotor.invariants, rotor.axis.direction
    static, couple = _static_unbalance(rotor), inv.J @ e
    couple = couple - e * (e @ couple)
    second = np.trace(inv.J)
    arm = np.sqrt(second / inv.mass)
    return bool(np.linalg.norm(static) * arm + np.linalg.norm(couple) <= _BALANCED * second)


def total(
    loads: Sequence[HarmonicForce | BaseAcceleration], model: LinearModel, speed: float
) -> dict[int, np.ndarray]:
    """Return the harmonics (k,) of the sum of all loads at a spin speed [rad/s].

    Raises
    ------
    ValueError
        If there is no load or all of them are zero.
    """
    harmonics: dict[int, np.ndarray] = {}
    for load in loads:
        for n, force in load._harmonics(model, speed).items():
            harmonics[n] = harmonics.get(n, 0.0) + force
    if not any(np.any(force) for force in harmonics.values()):
        raise ValueError(
            "no load, so no response: give loads=[HarmonicForce(…)] that move the rotor"
        )
    return harmonics


def _check_turning(model: LinearModel, point: Place) -> None:
    """Refuse what turns with a rotor of another speed than that of the analysis."""
    if point.ratio not in (0.0, 1.0):
        owner, _, _ = point.label.partition(":")
        raise ValueError(
            f"at: {point.label!r}: turns with {point.ratio:g} times the speed of the analysis; "
            f"give train.relative_to({owner!r}), over the speed of that rotor"
        )


def _pulled(point: Place, wrench: dict[int, np.ndarray]) -> dict[int, np.ndarray]:
    """Return the generalised force (k,) of harmonics of a force and moment that stand still."""
    load: dict[int, np.ndarray] = {}
    for n, force in wrench.items():
        for m, U in point.seen.items():
            load[m + n] = load.get(m + n, 0.0) + U.T @ force
    return load


def _vector(value: ArrayLike, name: str, unit: str) -> np.ndarray:
    """Return an amplitude along (n1, n2, e), shape (3,), complex and read-only."""
    vector = checks.array(value, name, unit, dtype=complex)
    if vector.shape not in ((2,), (3,)):
        raise ValueError(
            f"{name}: needs two or three numbers [{unit}] along (n1, n2[, e]), got "
            f"{checks.shown(value)}"
        )
    return checks.read_only(np.r_[vector, np.zeros(3 - len(vector))], complex)
