"""What is attached to a rotor in a scene: one object of forces on the coordinates of its ends.

A law has forces by the motion x of ports, with the rows J of the coordinates: displacement and
rotation of an interface against what carries it, and coordinates of the law's own, of a controller
or of pads. Exudyn gets ``Jᵀf`` and the tangent ``Jᵀ(K, D)J``; a law may have a mass matrix.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import NamedTuple

import exudyn
import numpy as np
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.multibody.supports.ends import BaseEnd, RotorEnd

_KINDS = exudyn.OutputVariableType
CURRENT, START = exudyn.ConfigurationType.Current, exudyn.ConfigurationType.StartOfStep


class Force(NamedTuple):
    """Forces [N], [N m] of a law on its ports, and less their derivatives by motion and rate.

    The ports have the rows `J`, and `L` the derivative of their rate by the coordinates.
    """

    values: np.ndarray
    J: np.ndarray
    L: np.ndarray
    K: np.ndarray
    D: np.ndarray

    def slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """Return less the derivatives of the forces on coordinates, by these and their rates."""
        damping = self.J.T @ self.D
        return self.J.T @ (self.K @ self.J) + damping @ self.L, damping @ self.J


class Connector(ABC):
    """A law between a rotor and what carries it.

    Attributes
    ----------
    end : RotorEnd
    base : FoundationEnd, MarkerEnd or None
        None for the ground.
    nodes : tuple of NodeIndex
        Of the rotor, of the base, and of coordinates of the law's own.
    own : int
        Number of these.
    muted : bool
        Whether its object has no force, as where linear equations take the law itself.
    native : tuple of ndarray or None
        Constant stiffness and damping (size, size) that Exudyn evaluates itself.
    """

    whole = False  # whether it needs rotations
    outside = False  # whether it was evaluated beyond a clearance
    guard: Callable[[exudyn.MainSystem], None] | None = None  # looks at the accepted state then

    def __init__(
        self,
        end: RotorEnd,
        base: BaseEnd | None,
        own: exudyn.NodeIndex | None = None,
        count: int = 0,
    ) -> None:
        self.end, self.base, self.own = end, base, count
        nodes = () if base is None else base.nodes
        self.nodes = (*end.nodes, *nodes, *(() if own is None else (own,)))
        self._first = end.size
        self._second = end.size + (0 if base is None else base.size)
        self.size = self._second + count
        self.muted, self.native = False, (None, None)

    # ------------------------------------------------------------------ motion

    def read(self, q: list[float], q_t: list[float]) -> None:
        """Take the motion of the ends from coordinates and their rates."""
        if self.size == self._first:
            self.end.read(q, q_t, self.whole)
            return
        first, second = self._first, self._second
        self.end.read(q[:first], q_t[:first], self.whole)
        if self.base is not None:
            self.base.read(q[first:second], q_t[first:second])

    @property
    def relative(self) -> tuple[float, float, float, float, float, float]:
        """Place x, y [m] and velocity of the rotor against the base, spin angle and speed."""
        end, base = self.end, self.base
        (x, y, _), (vx, vy, _) = end.place, end.rate
        if base is None:
            return x, y, vx, vy, end.angle, end.speed
        (a, b, _), (a_t, b_t, _) = base.place, base.rate
        return x - a, y - b, vx - a_t, vy - b_t, end.angle, end.speed

    def rows(self) -> np.ndarray:
        """Return the rows J (6, size) of the rotor's motion against the base."""
        J = np.zeros((6, self.size))
        J[:, : self._first] = self.end.rows()
        if self.base is not None:
            J[:, self._first : self._second] = -self.base.rows()
        return J

    def rate_rows(self) -> np.ndarray:
        """Return the derivative (6, size) of the rotor's rate by the coordinates."""
        L = np.zeros((6, self.size))
        L[:, : self._first] = self.end.rate_rows()
        return L

    def pull(
        self,
        fx: float,
        fy: float,
        fz: float = 0.0,
        moment: tuple[float, float, float] | None = None,
        own: np.ndarray | None = None,
    ) -> list[float]:
        """Return the forces on all coordinates by a force and a moment on the rotor."""
        found = self.end.pull(fx, fy, fz, moment).tolist()
        if self.base is not None:
            load = [-fx, -fy, -fz, *(-m for m in moment or (0.0, 0.0, 0.0))]
            found += (load @ self.base.rows()).tolist()
        return found if own is None else found + own.tolist()

    def state(
        self, mbs: exudyn.MainSystem, configuration: exudyn.ConfigurationType = CURRENT
    ) -> tuple[list[float], list[float]]:
        """Return coordinates and rates in a configuration."""
        return tuple(
            np.hstack(
                [mbs.GetNodeOutput(node, kind, configuration) for node in self.nodes]
            ).tolist()
            for kind in (_KINDS.Coordinates, _KINDS.Coordinates_t)
        )

    # ------------------------------------------------------------------ law

    def begin(self, mbs: exudyn.MainSystem, t: float) -> None:
        """Take the state at the beginning of a step; only laws with a memory need it."""
        return

    @abstractmethod
    def wrench(self, t: float) -> tuple:
        """Return force and moment on the rotor, and forces on own coordinates, as :meth:`pull`."""

    @abstractmethod
    def tangent(self, t: float) -> Force:
        """Return the law's forces on its ports where the ends have been read, and its tangent."""

    @property
    def has_mass(self) -> bool:
        """Whether a mass goes with the rotor across the axis."""
        return False

    def added_mass(self) -> float:
        """Return the mass that goes with the rotor at its speed [kg]."""
        return 0.0

    def inertia(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return the mass matrix of what goes with the rotor, the forces beside it, and slopes.

        The forces (size,) are those of the turning frame, and the slopes less their derivatives
        by coordinates and by rates, (size, size).
        """
        m, J, H = self.added_mass(), self.rows()[:2], np.zeros((2, 2, self.size))
        bent, H[0][:, : self._first], H[1][:, : self._first] = self.end.turning()
        K, D = m * np.einsum("ia,nib->nab", J, H)
        return m * J.T @ J, -m * bent @ J, K, D

    def friction(self) -> float:
        """Return the torque on the rotor that a prescribed spin does not feel [N m]."""
        return 0.0

    # ------------------------------------------------------------------ object

    def item(self, whole: Connector | None = None, **matrices: np.ndarray) -> ObjectGenericODE2:
        """Return the object, with constant matrices of the law's own; mute where `whole` is."""
        whole = whole or self

        none, massive = [0.0] * self.size, self.has_mass

        def force(mbs, t, item, q, q_t):
            if whole.muted:
                return none
            self.begin(mbs, t)
            self.read(q, q_t)
            found = self.pull(*self.wrench(t))
            found = (found + self.inertia()[1]).tolist() if massive else found
            if self.outside:
                self.outside = False
                if self.guard is not None:
                    self.guard(mbs)
            return found

        def jacobian(mbs, t, item, q, q_t, factor_q, factor_v):
            self.begin(mbs, t)
            self.read(q, q_t)
            found = self.tangent(t)
            K, D = found.slopes()
            if massive:
                K, D = (X + Y for X, Y in zip((K, D), self.inertia()[2:], strict=True))
            return factor_q * K + factor_v * D

        def mass(mbs, t, item, q, q_t):
            self.read(q, q_t)
            return self.inertia()[0]

        if massive:
            matrices["massMatrixUserFunction"] = mass
        given = {"massMatrix": np.zeros((self.size, self.size))} | matrices
        self.native = tuple(given.get(name) for name in ("stiffnessMatrix", "dampingMatrix"))
        return ObjectGenericODE2(
            nodeNumbers=list(self.nodes),
            forceUserFunction=force,
            jacobianUserFunction=jacobian,
            visualization=VObjectGenericODE2(show=False),
            **given,
        )
