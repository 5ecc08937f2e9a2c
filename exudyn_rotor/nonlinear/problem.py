"""A rotor with nonlinear laws as the equations of :mod:`.balance`, and where a search begins."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.bearings.annular_seal import AnnularSeal
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.calls import kept
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.response.loads import (
    BaseAcceleration,
    Unbalance,
    total,
    unbalance_load,
)
from exudyn_rotor.nonlinear.balance import Balance, Laws, padded, real_part_of
from exudyn_rotor.nonlinear.rest import Rest, Unloaded, of_both_signs
from exudyn_rotor.nonlinear.scene import Listed
from exudyn_rotor.reduction.reduced_rotor import ModeKind
from exudyn_rotor.theory.rotating_axes import axes_of, parts_across

_DEPTH = 1e-3  # of the radius of the elements, at which a contact has the stiffness of k₀
_INSIDE = 0.5  # of a clearance, where a film has that of k₀
_SAME_PASS = 1e-9  # relative distance of ball pass frequencies that is rounding
_MORE_UNBALANCE = 2.0 ** np.arange(6.0, -0.5, -0.5)
_ROUGH = 1e-3
_ANY_SIZE = 1e-12  # m, of motions without a clearance
_NOT_ACROSS = (ModeKind.AXIAL.value, ModeKind.SPIN.value)


def _is_law(one: Given) -> bool:
    """Return whether a support has a nonlinear law."""
    if isinstance(one, TiltingPadBearing):
        raise ValueError(
            f"supports: the bearing at {one.interface!r} has no force by place and velocity alone: "
            "its pads have motions of their own; give the linear coefficients, bearing.linearised()"
        )
    return isinstance(one, Bearing) and not isinstance(one, AnnularSeal)


def _passes(laws: Sequence[Bearing], ratios: Sequence[float]) -> float:
    """Return how many elements pass the load in a revolution, the same for all; 0 without any."""
    pairs = zip(laws, ratios, strict=True)
    found = [r * one.count * one.cage_ratio for one, r in pairs if isinstance(one, RollingBearing)]
    if found and np.ptp(found) > _SAME_PASS * np.abs(found).max():
        raise ValueError(
            f"supports: {min(found):.6g} and {max(found):.6g} elements pass in a revolution, and "
            "one frequency of ball passes is balanced: give one kind as it is, with the other "
            "kinds linearised(), and then the other way round"
        )
    return found[0] if found else 0.0


def _spring(one: Bearing, speed: float) -> tuple[float, float]:
    """Return k₀ [N/m] and d₀ [N s/m] in place of a law, of the size of its own."""
    gap = one.clearance_along()
    where = _INSIDE * gap if np.isfinite(gap) else 0.0
    if isinstance(one, RollingBearing):
        where = one.clearance + _DEPTH * one.element_radius
    elif not one.carries and hasattr(one, "stiffness"):
        return one.stiffness, 0.0
    slopes = one.law_along(np.array([[where, 0.0, 0.0, 0.0]]), np.zeros(1), speed)[1][0]
    k, d = np.linalg.norm(slopes[:, :2], 2), abs(np.trace(slopes[:, 2:])) / 2.0
    return max(k, 0.1 * d * abs(speed)), d


@dataclass(frozen=True, eq=False)
class Problem:
    """A rotor on linear supports and laws, under loads."""

    model: LinearModel  # with springs and dampers in place of the laws
    standing: LinearModel | None  # the same in axes that stand still
    laws: Laws
    static: Mapping[int, np.ndarray]  # harmonics of θ, both signs, of gravity and constant forces
    unbalance: Mapping[int, np.ndarray]  # per Ω²
    revolutions: int = 1

    @classmethod
    def of(
        cls,
        given: Listed,
        *,
        unbalances: Sequence[Unbalance],
        own: bool,
        speed: float,
        highest: float,
        revolutions: int = 1,
    ) -> Problem:
        """Return the equations of a rotor at speeds from a lowest one on that is not 0, if any.

        In axes in which the rest is constant: those of the rotor, in which nothing is averaged, if
        it can be.
        """
        asked = linear_model(
            given.target,
            supports=given.supports,
            foundation=given.foundation,
            stiffening=given.stiffening,
        )
        model, laws = _with_stand_ins(asked, highest)
        model, standing = _constant(model, speed or 1.0)
        _check_held(model)
        weight = parts_across(axes_of(next(iter(model.rotors.values())).axis), given.gravity)
        steady = [*([BaseAcceleration(-weight)] if np.any(weight) else []), *given.loads]
        static = of_both_signs(total(steady, model, speed)) if steady else {}
        try:
            unbalance = unbalance_load(model, unbalances, own)
        except ValueError:
            if unbalances:
                raise
            unbalance = {}
        unbalance = {n: F for n, F in of_both_signs(unbalance).items() if np.any(F)}
        if laws.passes and not unbalance and not any(map(np.any, static.values())):
            raise ValueError(
                "gravity, loads, unbalances: need one across the axis that is not zero: without a "
                "load no element carries, and preloaded ones do not move"
            )
        return cls(model, standing, laws, static, unbalance, revolutions)

    @property
    def size(self) -> float:
        """Size of a motion that matters [m]: a clearance."""
        gaps = [one.clearance_along() for one in self.laws.bearings]
        return float(min([gap for gap in gaps if np.isfinite(gap)], default=_ANY_SIZE))

    @property
    def reach(self) -> tuple[int, int]:
        """K and N with which a search begins."""
        whirls = 4 * self.revolutions if self.unbalance else 0
        return (4, min(whirls, 1)) if self.laws.passes else (0, whirls)

    def balance(
        self,
        speed: float,
        reach: tuple[int, int],
        *,
        unbalance: float = 1.0,
        whirl: float | None = None,
    ) -> Balance:
        """Return the equations at a speed, with a factor of the unbalance.

        The second phase has the frequency `whirl` [rad/s], or that of the ball pass.
        """
        loads = dict(self.static)
        for n, F in self.unbalance.items():
            loads[n] = loads.get(n, 0.0) + unbalance * speed**2 * F
        first = self.laws.passes * speed if whirl is None else whirl
        rates = first, speed / self.revolutions
        rest = Rest(self._unloaded(speed), rates, self.revolutions, loads)
        return Balance(self.laws, rest, reach)

    @kept
    def _unloaded(self, speed: float) -> Unloaded:
        """Return the rest at a speed."""
        return Unloaded(self.model, self.laws.names, speed, self.standing)

    # ------------------------------------------------------------ where a search begins

    def at_rest(self, speed: float) -> np.ndarray:
        """Return the mean place of the journals under static loads, c (1, d)."""
        balance = self.balance(speed, (0, 0), unbalance=0.0)
        pressed = self._pressed(balance.given.real, speed) + 0j
        for c in (pressed, np.zeros_like(balance.given), balance.given):
            try:
                return balance.solved(c)
            except UnconvergedError as failed:
                lost = failed
        raise lost

    def starts(self, of: Callable[..., Balance]) -> Iterator[tuple[Balance, np.ndarray]]:
        """Yield equations and harmonics, each nearer by more work, from which a search may lead.

        `of` makes the equations at the wanted speed; it takes K and N, and a factor of the
        unbalance.
        """
        balance = of(self.reach)
        try:
            c = padded(self.at_rest(balance.rest.speed), (0, 0), balance.reach)
            # a whole step: at large loads no share of it would make the residual smaller
            left, J = balance.linearised(c)
            yield balance, c - real_part_of(np.linalg.solve(J, left.ravel()).reshape(c.shape))
            yield balance, c
        except (UnconvergedError, np.linalg.LinAlgError):
            pass
        if self.unbalance:  # a rotor that unbalance alone presses: the whirl of a larger one
            most = of(self.reach, _MORE_UNBALANCE[0])
            c = most.harmonics(self._pressed(most.values(most.given), most.rest.speed))
            for more in _MORE_UNBALANCE:
                c = of(self.reach, more).solved(c, _ROUGH)
            yield balance, c

    def _pressed(self, moved: np.ndarray, speed: float) -> np.ndarray:
        """Return places (t, d) where the journals rest under what moves the springs (t, d)."""
        loads = self.laws.springs * moved
        places = np.zeros_like(loads)
        for b, (one, ratio) in enumerate(zip(self.laws.bearings, self.laws.ratios, strict=True)):
            pair = slice(2 * b, 2 * b + 2)
            for place, load in zip(places[:, pair], loads[:, pair], strict=True):
                with suppress(ValueError, ArithmeticError):
                    place[:] = one.equilibrium(ratio * speed, load)
        return places


def _with_stand_ins(model: LinearModel, speed: float) -> tuple[LinearModel, Laws]:
    """Return a model with springs and dampers in place of the laws, and these, up to a speed."""
    laws, linear = [], {}
    for rotor, given in model.supports.items():
        ratio, linear[rotor] = model.ratios[rotor], []
        for one in given:
            if not _is_law(one):
                linear[rotor].append(one)
                continue
            name = f"{rotor}:{one.interface}" if rotor else one.interface
            k, d = _spring(one, ratio * speed)
            laws.append((one, name, ratio, k, d))
            linear[rotor].append(Support(one.interface, k, d))
    if not laws:
        raise ValueError("supports: none has a nonlinear law; unbalance_response takes linear ones")
    bearings, names, ratios, k, d = zip(*laws, strict=True)
    laws = Laws(
        bearings, names, ratios, np.repeat(k, 2), np.repeat(d, 2), _passes(bearings, ratios)
    )
    return replace(model, supports=linear), laws


def _constant(model: LinearModel, speed: float) -> tuple[LinearModel, LinearModel | None]:
    """Return a model whose equations are constant, and one in axes that stand still."""
    model.check_without_frequency("a periodic motion")
    constant, turning = model.at(speed).is_constant, model.for_responses
    standing = model if constant and not model.turns else None
    several = len(model.rotors) > 1  # no axes turn with all of them
    if turning.at(speed).is_constant and not (standing and several):
        return turning, standing
    if not constant:
        raise ValueError(
            "target, supports: an uneven rotor on uneven linear supports has equations that repeat "
            "every revolution; give a finer mesh, or supports that are alike in all directions"
        )
    return model, standing


def _check_held(model: LinearModel) -> None:
    """Refuse a rotor that supports leave free across its axis."""
    across = [name for name in model.free_motions if name not in _NOT_ACROSS]
    # an eccentric rotor spins about its bearings, which is a combination of motions
    if across and len(model.free_motions) > model.neutral_motions.shape[1]:
        raise ValueError(
            f"supports: nothing holds the rotor against {' or '.join(across)}; add one at another "
            "interface"
        )
