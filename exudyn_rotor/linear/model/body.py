"""Bodies of a linear model: rotors in the axes chosen for the model, and what stands beside them.

A body has coordinates y with ``M ÿ + D ẏ + K y = f``, in axes that turn with aΩ: a = 0 for axes
that stand still, a = 1 for axes that turn with the speed Ω of the analysis. A rotor of the speed
ratio r, whose own coordinates are ``x = exp(−Nwθ) y`` with w = r − a (:mod:`.turning`), has

    M ÿ + (D + 2rΩ G − 2wΩ MN) ẏ
        + (K + r²Ω² (K2 − C) + w²Ω² MN² − wΩ DN − 2rwΩ² GN + r⁴Ω⁴ K4) y = f,

each matrix by its mean over a turn. That is Eq. (105) or (109) with centrifugal stiffening where
w = 0. A point mass, with N = [[0, −1], [1, 0]], G = mN and C = m, has ``M ÿ + K y = f`` for a = 0.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from exudyn_rotor.calls import kept
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.equations import Terms, others, turned
from exudyn_rotor.linear.model.spin import Spin, spin_of
from exudyn_rotor.linear.model.turning import Turning, interface_motion, turning_of
from exudyn_rotor.reduction.reduced_rotor import ModeKind, ReducedRotor
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.theory.stiffening import SpinTerms, chosen_level
from exudyn_rotor.theory.stiffening import stiffening as second_order

EVEN = 0.01  # unevenness up to which a rotor counts as round


@dataclass(frozen=True, eq=False)
class RotorAlone:
    """A reduced rotor at a level of stiffening, in its own frame, whatever it stands on.

    Attributes
    ----------
    rotor : ReducedRotor
    invariants : Invariants
        In the basis Q, about the foot of the centre of mass on the axis.
    terms : SpinTerms
        What the spin adds to the equations.
    level : str
        Level of centrifugal stiffening.
    Q : ndarray, shape (n, k)
        Columns of the reduced rotor by these coordinates.
    turning : Turning
    spin : Spin or None
        The spin as a coordinate.
    """

    rotor: ReducedRotor
    invariants: Invariants
    terms: SpinTerms
    level: str
    Q: np.ndarray
    turning: Turning
    spin: Spin | None

    @property
    def has_halves(self) -> bool:
        """Whether the number of modes has cut pairs in halves."""
        return bool(np.any(self.turning.halves))

    @cached_property
    def without_halves(self) -> RotorAlone:
        """The rotor without halves of pairs, which no mean over a turn can have."""
        if not self.has_halves:
            return self
        Q = others(self.turning.T[:, self.turning.halves].real)
        return self.within(Q[:, np.argsort(np.abs(Q).argmax(axis=0), kind="stable")])

    @kept
    def unevenness(self, places: tuple[str, ...]) -> float:
        """Return the largest share of the rotor, and of the motion of interfaces, not round.

        Of the interfaces that something acts on, or of all.
        """
        places = places or self.rotor.interfaces
        moved = [interface_motion(self.rotor, name) @ self.Q for name in places]
        return self.turning.unevenness((self.invariants.K, self.terms.C_hat), moved)

    def within(self, V: np.ndarray) -> RotorAlone:
        """Return the rotor with the motions of an orthonormal basis V (k, r) alone.

        The basis holds every wave or nothing of it.
        """
        turning, invariants = self.turning.within(V), self.invariants.in_basis(V)
        return _alone(self.rotor, invariants, self.level, self.Q @ V, turning)


@kept
def rotor_alone(
    rotor: ReducedRotor, stiffening: str, inner: ReducedRotor | None = None
) -> RotorAlone:
    """Return a rotor, or that with the attachments of an `inner` one, at a level of stiffening."""
    origin = rotor.axis.project(rotor.center_of_mass)
    invariants = rotor.invariants.moved(origin - rotor.center_of_mass)
    level = chosen_level(stiffening, invariants.K2 is not None)
    if level != "none":
        invariants = invariants.loaded
    return _alone(rotor, invariants, level, np.eye(rotor.size), turning_of(rotor, inner))


def _alone(
    rotor: ReducedRotor, invariants: Invariants, level: str, Q: np.ndarray, turning: Turning
) -> RotorAlone:
    """Return a rotor with the invariants in the basis Q."""
    terms = SpinTerms.of(invariants, second_order(invariants, level))
    spin = spin_of(rotor, invariants, Q)
    K4 = None if terms.K4 is None else _unresisted(terms.K4, rotor, spin, Q)
    terms = replace(terms, C_hat=_unresisted(terms.C_hat, rotor, spin, Q), K4=K4)
    return RotorAlone(rotor, invariants, terms, level, Q, turning, spin)


def _unresisted(X: np.ndarray, rotor: ReducedRotor, spin: Spin | None, Q: np.ndarray) -> np.ndarray:
    """Return a centrifugal stiffness that resists neither the spin nor a shift along the axis.

    Of the shift it is rounding, which would be a slow divergence.
    """
    if spin is not None:
        X = spin.apart(X)
    if ModeKind.AXIAL in rotor.rigid_kinds:
        axial = Q[rotor.rigid_kinds.index(ModeKind.AXIAL)]
        apart = np.eye(len(X)) - np.outer(axial, axial)
        X = apart @ X @ apart
    return X


@dataclass(frozen=True, eq=False)
class Body:
    """A part of a linear model with coordinates of its own.

    Attributes
    ----------
    name : str
        Before the names of interfaces, 'rotor:left'; empty for the only rotor.
    turns : int
        a of the axes of its coordinates.
    M : ndarray, shape (k, k)
    D, K : sequence of ndarray, shape (k, k)
        Coefficients of powers of Ω, ``K(Ω) = Σ Ωⁿ K[n]``.
    labels : tuple of str
        Names of the coordinates.
    H : sequence of (float, ndarray)
        Structural damping, see :class:`PeriodicSystem`.
    base_loads : mapping of int to ndarray, shape (3, k), or None
        Fourier terms of the loads of unit accelerations of the ground along (n1, n2, e), which
        stand still; None where they are not known.
    """

    name: str
    turns: int
    M: np.ndarray
    D: tuple[np.ndarray, ...]
    K: tuple[np.ndarray, ...]
    labels: tuple[str, ...]
    H: tuple[tuple[int, np.ndarray], ...] = ()
    base_loads: Terms | None = None

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return len(self.M)


@dataclass(frozen=True, eq=False)
class RotorBody(Body):
    """A rotor as a part of a linear model.

    Attributes
    ----------
    alone : RotorAlone
        In its own frame.
    ratio : float
        r, its speed over Ω.
    spin : Spin or None
    """

    alone: RotorAlone = field(kw_only=True)
    ratio: float = field(kw_only=True)
    spin: Spin | None = field(kw_only=True)

    @property
    def drift(self) -> float:
        """w, by which its coordinates turn in its own frame, over Ω."""
        return self.ratio - self.turns

    @property
    def mean(self) -> bool:
        """Whether its matrices are means over a turn."""
        return self.drift != 0.0

    @property
    def is_apart(self) -> bool:
        """Whether the spin is apart from other motions (:mod:`.spin`): at any speed."""
        return self.spin is not None and self.ratio != 0.0

    @cached_property
    def Q(self) -> np.ndarray:
        """Columns of the reduced rotor by these coordinates, (n, k)."""
        return self.spin.about_axis(self.alone.Q) if self.is_apart else self.alone.Q

    def by_wave(self, rows: np.ndarray) -> dict[int, np.ndarray]:
        """Return rows (…, n) of the reduced rotor by these coordinates, of each wave by its n.

        In the rotor's frame what acts on the wave n turns with ``exp(−inwθ)``.
        """
        return self.alone.turning.parts(rows @ self.Q) if self.mean else {0: rows @ self.Q}

    def motion(self, name: str) -> np.ndarray:
        """Return the motion of an interface in the rotor's frame, (6, k)."""
        return interface_motion(self.alone.rotor, name) @ self.Q

    def seen(self, name: str) -> dict[int, np.ndarray]:
        """Return the motion of an interface in axes that stand still, Fourier terms (6, k)."""
        return self.from_outside(self.motion(name))

    def from_outside(self, U: np.ndarray) -> dict[int, np.ndarray]:
        """Return a motion (3 or 6, k) in the rotor's frame as it is seen from outside.

        Of a rotor with another speed than Ω the parts that repeat with its own angle are left out.
        """
        if not self.mean:
            return turned({0: U}, self.turns)
        terms = self.alone.turning.motion(U)
        if self.drift != 1.0:
            terms = {0: terms[0]}
        return turned(terms, self.turns)

    @kept
    def supported(self, name: str) -> dict[int, np.ndarray]:
        """Return the motion of an interface that a support acts on, seen from outside, (6, k)."""
        U = self.motion(name)
        if self.spin is not None:
            U = self.spin.centred(U, self.alone.invariants.mass, self.is_apart)
        return turned({0: self.alone.turning.motion(U)[0] if self.mean else U}, self.turns)

    @cached_property
    def unbalance(self) -> dict[int, np.ndarray]:
        """Load of the own eccentricity per Ω² as harmonics of Ω, each (k,); h of Eq. (83)."""
        load = self.alone.invariants.h
        if not self.mean:
            return {0: load}
        return {-n: part for n, part in self.alone.turning.parts(load).items() if np.any(part)}


@kept  # maps and searches make many models of a rotor
def rotor_body(alone: RotorAlone, name: str, ratio: float, turns: int) -> RotorBody:
    """Return a rotor in axes that turn with `turns` times Ω; at rest its ratio is 0."""
    inv, terms, turning, spin = alone.invariants, alone.terms, alone.turning, alone.spin
    M, D, K, G, C, K4 = inv.M, inv.D, inv.K, terms.G, terms.C_hat, terms.K4
    w = ratio - turns
    wN = w * turning.generator
    if spin is not None and w:
        spin = spin.averaged(turning.still)
    if spin is not None and ratio:
        G = spin.unturned(G)
    if w:
        M, D, K, G, C = (turning.mean(X) for X in (M, D, K, G, C))
        C = C if spin is None else spin.apart(C)
        K4 = None if K4 is None else turning.mean(K4)
    powers_D = D, 2.0 * ratio * G - 2.0 * M @ wN
    powers_K = K, -D @ wN, M @ wN @ wN - 2.0 * ratio * G @ wN - ratio**2 * C
    if K4 is not None:
        powers_K = *powers_K, 0.0 * K, ratio**4 * K4
    labels = np.array(alone.rotor.labels)[np.abs(alone.Q).argmax(axis=0)]
    made = RotorBody(
        name, turns, M, powers_D, powers_K, tuple(labels.tolist()), _structural(turning, inv.H, w),
        alone=alone, ratio=ratio, spin=spin,
    )  # fmt: skip
    loads = -axes_of(alone.rotor.axis).T @ inv.S
    if made.is_apart:
        loads = spin.about_axis(loads)
    return replace(made, base_loads=made.from_outside(loads))


def _structural(turning: Turning, H: np.ndarray | None, w: float) -> tuple:
    """Return structural damping by waves: the wave n has the frequency ν − nwΩ in the rotor."""
    if H is None:
        return ()
    on_wave = turning.parts(np.eye(len(H))) if w else {0: np.eye(len(H))}
    parts = [(wave * w, P.conj().T @ H @ P) for wave, P in on_wave.items()]
    return tuple((n, part) for n, part in parts if np.any(part))


@dataclass(frozen=True, eq=False)
class StandingBody(Body):
    """A foundation or casing, in inertial axes.

    Attributes
    ----------
    points : mapping of str to ndarray, shape (6, k)
        Displacement and rotation of its points along (n1, n2, e).
    """

    points: dict[str, np.ndarray] = field(kw_only=True)

    def seen(self, name: str) -> dict[int, np.ndarray]:
        """Return the motion of a point, (6, k)."""
        return {0: self.points[name]}

    supported = seen  # what supports act on


def foundation_body(foundation: Foundation, rotor: ReducedRotor) -> StandingBody:
    """Return a foundation in the axes of a rotor's mesh as a body, in modal coordinates."""
    given = foundation.modal().turned(axes_of(rotor.axis).T)
    loads = None if given.participation is None else {0: -given.participation}
    labels = tuple(f"foundation, {number}" for number in range(1, given.size + 1))
    matrices = given.mass, (given.damping,), (given.stiffness,)
    return StandingBody(
        "foundation", 0, *matrices, labels, base_loads=loads, points=dict(given.points)
    )
