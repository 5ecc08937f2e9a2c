"""Growth of a model over its spin speed, or over a parameter by which a function makes it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear import options
from exudyn_rotor.linear.modal.whirl import WhirlContent
from exudyn_rotor.linear.models.basis.basis_error import BasisError
from exudyn_rotor.linear.models.linear_model import Target, linear_model
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.linear.stability.growth import Growth, GrowthAt, check_options, held_space

Supports = Sequence[Support] | Support


@dataclass(frozen=True, eq=False)
class Options:
    """Options of :func:`exudyn_rotor.stability`."""

    model: dict
    modes: int | None
    residual: float
    method: str
    tolerance: float
    accuracy: float | None

    @classmethod
    def of(cls, given: dict) -> Options:
        given = dict(given)
        method, tolerance = given.pop("method", "auto"), given.pop("tolerance", 1e-9)
        modes, residual = given.pop("modes", None), given.pop("residual", 1e-7)
        accuracy = given.pop("accuracy", 1e-2)
        options.check_basis_accuracy(accuracy)
        check_options(method, tolerance, modes, residual)
        unknown = set(given) - {"supports", "body", "stiffening"}
        if unknown:
            raise TypeError(f"stability: unknown option {', '.join(sorted(unknown))}")
        return cls(given, modes, residual, method, tolerance, accuracy)


class GrowthOver:
    """Growth over a parameter.

    `accuracy` is that of the basis, `solver` method and tolerance of exponents.
    """

    accuracy: float | None
    solver: tuple[str, float]

    def growth(self, value: float, named: bool = False) -> Growth:
        """Return the growth, with the names of the motions if asked for."""
        raise NotImplementedError

    @property
    def kinks(self) -> np.ndarray:
        """Values at which growth over the parameter has kinks, as far as they are known."""
        return np.zeros(0)

    def is_at_rest(self, value: float) -> bool:
        """Return False: the spin speed is that of all values."""
        return False

    def system(self, value: float) -> PeriodicSystem | None:
        """Return None: growths alone are known."""
        return None

    def rates(self, growth: Growth, value: float, step: float) -> np.ndarray | None:
        """Return None: a second growth tells the rates of exponents."""
        return None

    def limit(self, growth: Growth, ends: tuple[float, float], accuracy: float) -> float | None:
        """Return where a motion that grows at the second of two values does no longer.

        NaN where that is not found; None here, as growths alone tell it.
        """
        return None

    def basis(self, value: float) -> tuple[BasisError, float]:
        """Return the check of the basis, and the spin speed."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False)
class OverSpeed(GrowthOver):
    """The parameter is the spin speed."""

    task: GrowthAt
    named: GrowthAt
    checked: BasisError
    table_speeds: np.ndarray

    @classmethod
    def of(cls, target: Target, highest: float, given: dict) -> OverSpeed:
        chosen = Options.of(given)
        model = linear_model(target, **chosen.model)
        space = held_space(model, highest, chosen.modes, chosen.residual)
        parts = space, chosen.method, chosen.tolerance
        checked = BasisError.of(model, chosen.accuracy, held=True)
        named = GrowthAt(*parts, WhirlContent.of(model), keeps=True)
        return cls(GrowthAt(*parts, keeps=True), named, checked, model.table_speeds)

    @property
    def accuracy(self) -> float | None:
        return self.checked.accuracy

    @property
    def solver(self) -> tuple[str, float]:
        return self.task.method, self.task.tolerance

    @property
    def kinks(self) -> np.ndarray:
        return self.table_speeds

    def growth(self, value: float, named: bool = False) -> Growth:
        return (self.named if named else self.task)(value)

    def is_at_rest(self, value: float) -> bool:
        return value == 0.0

    def system(self, value: float) -> PeriodicSystem | None:
        return self.task.system(value)

    def rates(self, growth: Growth, value: float, step: float) -> np.ndarray | None:
        return self.task.rates(growth, value, step)

    def limit(self, growth: Growth, ends: tuple[float, float], accuracy: float) -> float | None:
        return self.task.limit(growth, ends, accuracy)

    def basis(self, value: float) -> tuple[BasisError, float]:
        return self.checked, value


@dataclass(frozen=True, eq=False)
class Finer(GrowthOver):
    """Growth with the shapes that the basis of a reduced rotor lacks first."""

    made: GrowthOver

    def is_at_rest(self, value: float) -> bool:
        return self.made.is_at_rest(value)

    def growth(self, value: float) -> Growth:
        """Return the growth at a value of the parameter."""
        basis, speed = self.made.basis(value)
        space = basis.left_out.equations.space(0, speed, held=True)
        method, tolerance = self.made.solver
        # high frequencies of what the basis lacks take many times as long by Floquet's method
        return GrowthAt(space, "hill" if method == "auto" else method, tolerance)(speed)


@dataclass(frozen=True, eq=False)
class OverParameter(GrowthOver):
    """The parameter changes the model at one spin speed."""

    target: Target | Callable[[float], Target]
    supports: Supports | Callable[[float], Supports]
    speed: float
    options: Options

    @property
    def accuracy(self) -> float | None:
        return self.options.accuracy

    @property
    def solver(self) -> tuple[str, float]:
        return self.options.method, self.options.tolerance

    def growth(self, value: float, named: bool = False) -> Growth:
        model = self._model(value)
        content = WhirlContent.of(model) if named else None
        return self._task(model, content)(self.speed)

    def system(self, value: float) -> PeriodicSystem | None:
        return self._task(self._model(value)).system(self.speed)

    def _task(self, model: LinearModel, content: WhirlContent | None = None) -> GrowthAt:
        chosen = self.options
        space = held_space(model, self.speed, chosen.modes, chosen.residual)
        return GrowthAt(space, chosen.method, chosen.tolerance, content)

    def basis(self, value: float) -> tuple[BasisError, float]:
        return BasisError.of(self._model(value), self.accuracy, held=True), self.speed

    def _model(self, value: float) -> LinearModel:
        target = self.target(value) if callable(self.target) else self.target
        supports = self.supports(value) if callable(self.supports) else self.supports
        return linear_model(target, supports=supports, **self.options.model)
