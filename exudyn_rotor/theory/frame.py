"""A rotor in its floating frame: its unknowns, and what the terms of its equations share."""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.theory.axis import SpinAxis, skew
from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.stiffening import SpinTerms, Stiffening


class Instant(NamedTuple):
    """One instant of a motion, split into its parts."""

    omega: float  # spin speed, and its prescribed rate; zero for a free spin, whose rate is unknown
    omega_t: float
    zeta: np.ndarray  # (m,) Modal coordinates and their rates
    zeta_t: np.ndarray
    A: np.ndarray  # (3, 3) Rotor axes → inertial axes (55)


class FloatingFrame:
    """Coordinates of one formulation; parameters and attributes of :class:`.motion.Motion`."""

    def __init__(
        self,
        invariants: Invariants,
        formulation: Formulation,
        second_order: Stiffening,
        orientation: ArrayLike | None = None,
        plane: ArrayLike | None = None,
        gravity: ArrayLike | None = None,
    ) -> None:
        self.invariants = checks.instance(invariants, "invariants", Invariants)
        self.formulation = checks.instance(formulation, "formulation", Formulation)
        self.spin_terms = SpinTerms.of(invariants, second_order)
        if second_order.K4 is not None and formulation.has_spin:
            raise ValueError(
                "spin: a free spin does not take the stiffness per ω⁴ of a static displacement; "
                "prescribe the spin, or compute the prestress with initial_displacement=False"
            )
        self.orientation = np.eye(3)
        if orientation is not None:
            self.orientation = checks.rotation(orientation, "orientation")
        self.gravity = checks.vector(np.zeros(3) if gravity is None else gravity, "gravity", "m/s²")
        if plane is not None:
            columns = 2 if formulation.translation_count == 2 else None
            plane = checks.array(plane, "plane", shape=(3, columns))
        self._e = skew(invariants.direction)
        self._axis = SpinAxis(invariants.direction)
        self.free_directions = self._free_directions(plane)
        counts = (formulation.translation_count, int(formulation.has_spin), invariants.size)
        ends = np.cumsum(counts)
        self.translations, self._spin, self.modes = (
            slice(end - count, end) for end, count in zip(ends, counts, strict=True)
        )
        self.size = int(ends[-1])
        self.has_body_force = bool(
            (formulation.moves_origin or np.any(self.gravity))
            and (np.any(invariants.S) or np.any(self.static_unbalance))
        )
        self.weight = invariants.mass * (self.free_directions.T @ self.gravity)

    def _free_directions(self, plane: np.ndarray | None) -> np.ndarray:
        count = self.formulation.translation_count
        if count != 2:
            return np.eye(3)[:, :count]
        return self.orientation @ self._axis.plane if plane is None else plane

    @cached_property
    def static_unbalance(self) -> np.ndarray:
        """``mχ*`` (67) [kg m], a quarter turn ahead of the centre of mass, rotor axes."""
        return self.invariants.mass * self._e @ self.invariants.center

    @cached_property
    def S1(self) -> np.ndarray:
        """``S* = ẽS`` (69), shape (3, m)."""
        return self._e @ self.invariants.S

    @cached_property
    def is_coupled(self) -> bool:
        """True when ``mχ*`` or S couple unknown translations with the other coordinates."""
        count = self.formulation.translation_count
        seen = self.invariants.S if count == 3 else self.S1  # in the plane, S* is S turned
        return bool(count and (np.any(self.static_unbalance) or np.any(seen)))

    def at(self, t: float, q: ArrayLike, q_t: ArrayLike) -> Instant:
        """Return an instant, split into its parts."""
        q, q_t = self._checked(q, "q"), self._checked(q_t, "q_t")
        form, t = self.formulation, checked_time(t)
        if form.has_spin:
            theta, omega, omega_t = float(q[self._spin][0]), float(q_t[self._spin][0]), 0.0
        else:
            theta, omega = form.spin.value(t), form.spin.rate(t)
            omega_t = form.spin.acceleration(t)
        A = self.orientation @ self._axis.rotation(theta)
        return Instant(omega, omega_t, q[self.modes], q_t[self.modes], A)

    def unbalance(self, zeta: np.ndarray) -> np.ndarray:
        """``mχ* + S*ζ``, the bracket of (65): the static unbalance of the deformed rotor."""
        return self.static_unbalance + self.S1 @ zeta

    def _checked(self, values: ArrayLike, name: str) -> np.ndarray:
        """Return one finite number per unknown; quick where there is nothing to refuse."""
        right = type(values) is np.ndarray and values.shape == (self.size,)
        if right and values.dtype == float and math.isfinite(values.dot(values)):
            return values
        return checks.vector(values, name, size=self.size)


def checked_time(t: float) -> float:
    """Return a finite time [s]."""
    if type(t) is not float or not math.isfinite(t):
        t = checks.number(t, "t", "s")
    return t
