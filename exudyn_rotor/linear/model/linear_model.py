"""Linear equations of rotors, what they stand on, and what is between them: one model for all.

A model is solved in axes in which its equations are constant, if there are any:

- Axes that stand still, where all rotors are round: supports, foundations, gears and other rotors
  enter as they are. The unevenness of the mesh is averaged over the circumference
  (:mod:`.turning`), up to 1 % of it; :attr:`LinearModel.unevenness` tells how much.
- The axes of the rotor, where it is uneven: constant on supports that turn with it or are alike in
  all directions, else periodic.

At rest nothing turns, and nothing is averaged.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from exudyn_rotor import checks
from exudyn_rotor.calls import user_level
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.equations import PeriodicSystem, add, others, spread
from exudyn_rotor.linear.model.assembly import (
    NO_EQUATIONS,
    Assembly,
    Element,
    End,
    Powers,
    elements_of,
    rotors_of,
    stacked_coefficients,
)
from exudyn_rotor.linear.model.body import (
    EVEN,
    RotorAlone,
    RotorBody,
    StandingBody,
    foundation_body,
    rotor_alone,
    rotor_body,
)
from exudyn_rotor.linear.model.rotor_train import Link
from exudyn_rotor.linear.model.turning import radius_of_gyration
from exudyn_rotor.reduction.reduced_rotor import ModeKind, ReducedRotor
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.theory.stiffening import LEVELS

AXES = ("auto", "inertial", "rotor")
ON_FOUNDATION = "{} (foundation)"
_HELD = 1e-10  # share of the largest stiffness per unit mass that counts as none
_ALONE = 1.0 - 1e-6  # share of a free motion's energy in one rigid motion, but for rounding


class Matrices(NamedTuple):
    """Matrices of a model at one speed, and the names of its coordinates and axes."""

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    coordinates: tuple[str, ...]
    axes: str


class StateSpace(NamedTuple):
    """``ż = A z + B u, y = C z + D u``: forces u and displacements y at the places."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Linear equations of rotors on supports, ready for any spin speed; see :func:`linear_model`.

    Attributes
    ----------
    rotors : mapping of str to ReducedRotor
        By name; the only rotor has the name ''.
    ratios : mapping of str to float
        Speed of each over the speed Ω of the analysis.
    supports : mapping of str to sequence
        Supports and bearings of each rotor.
    links : sequence of Link
        Between rotors.
    foundation : Foundation or None
        What carries the supports.
    stiffening : str
        Level of centrifugal stiffening asked for.
    wanted_axes : {'auto', 'inertial', 'rotor'}
    largest_unevenness : float
        Up to which a rotor counts as round.
    is_undamped : bool
        Whether damping and the skew part of stiffness are left out, as for critical speeds.
    is_richer : bool
        Whether the rotors have the shapes, too, that their bases lack first.

    Examples
    --------
    >>> from exudyn_rotor import Support, linear_model, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> model = linear_model(rotor, supports=supports)
    >>> model
    LinearModel of 6 coordinates in inertial axes
    rotor: 6 coordinates, interfaces left, right
    supports: left, right
    free motions: translation along axis
    stiffening: tilt, unevenness ...e-16
    """

    rotors: Mapping[str, ReducedRotor]
    ratios: Mapping[str, float]
    supports: Mapping[str, Sequence]
    links: Sequence[Link] = ()
    foundation: Foundation | None = None
    stiffening_asked: str = "auto"
    wanted_axes: str = "auto"
    largest_unevenness: float = EVEN
    is_undamped: bool = False
    is_richer: bool = False

    # ------------------------------------------------------------------ how it is put together

    @cached_property
    def _used(self) -> Mapping[str, ReducedRotor]:
        """The rotors with the basis that is solved in."""
        if not self.is_richer:
            return self.rotors
        return {name: rotor.with_attachments for name, rotor in self.rotors.items()}

    @cached_property
    def _elements(self) -> tuple[list[Element], list]:
        """Elements and own coordinates, as for axes that stand still."""
        return self._elements_for(0)

    @property
    def _is_list(self) -> bool:
        """Whether all is known by lists, without a look at a scene."""
        return True

    def _elements_for(
        self, turns: int, kind: str = "", supports: Sequence | None = None
    ) -> tuple[list[Element], list]:
        """Return elements and own coordinates; `supports` of the only rotor in place of others."""
        given = self.supports if supports is None else {"": supports}
        kind = kind or ("undamped" if self.is_undamped else "full")
        return elements_of(given, self.ratios, self.links, self._base, turns, kind)

    def _base(self, number: int, name: str) -> End | None:
        """Return what carries the support of a number at an interface; None for the ground."""
        carried = self.foundation is not None and name in self.foundation.points
        return ("foundation", name) if carried else None

    def _alone(self, name: str, whole: bool) -> RotorAlone:
        """Return a rotor in its own frame; without halves of pairs unless it is `whole`."""
        alone = self._whole(name)
        return alone if whole else alone.without_halves

    def _whole(self, name: str) -> RotorAlone:
        inner = self.rotors[name] if self.is_richer else None
        return rotor_alone(self._used[name], self.stiffening_asked, inner)

    @cached_property
    def _own_unevenness(self) -> dict[str, float]:
        """Unevenness of each rotor and of the places that something acts on."""
        ends = dict.fromkeys(end for element in self._elements[0] for end in element.ends)
        places = {name: tuple(at for owner, at in ends if owner == name) for name in self._used}
        return {name: self._whole(name).unevenness(at) for name, at in places.items()}

    @cached_property
    def turns(self) -> int:
        """Whether the axes of the rotors turn with Ω (1) or stand still (0)."""
        if self.wanted_axes != "auto":
            return int(self.wanted_axes == "rotor")
        is_uneven = any(u > self.largest_unevenness for u in self._own_unevenness.values())
        turning = (element for element in self._elements[0] if element.turns)
        if is_uneven or not all(each.is_isotropic(0.0) for each in turning):
            return 1
        # a basis with halves of pairs is taken whole where that is constant, too
        return int(self._is_alike and any(self._whole(name).has_halves for name in self._used))

    @property
    def _is_alike(self) -> bool:
        """Whether what acts on the only rotor is constant and the same in all directions."""
        elements, own = self._elements
        if own or self._standing_bodies or len(self._used) > 1:
            return False
        return not any(one.varies or one.stands or not one.is_isotropic(0.0) for one in elements)

    @property
    def axes(self) -> str:
        """Axes in which the equations are: 'inertial' or 'rotor'."""
        return AXES[1 + self.turns]

    def _assembled(self, at_rest: bool = False, kind: str = "") -> Assembly:
        turns = 0 if at_rest else self.turns
        elements, own = self._elements_for(turns, kind)
        if not at_rest:
            for element in elements:
                element.check_axes(turns)
        return Assembly((*self._bodies(turns, at_rest), *own), tuple(elements), turns)

    def _bodies(self, turns: int, at_rest: bool) -> list[RotorBody | StandingBody]:
        """Return rotors and what stands beside them."""
        bodies = []
        for name, ratio in self.ratios.items():
            whole = self.turns == 1 and ratio == 1.0
            alone, uneven = self._alone(name, whole), self._own_unevenness[name]
            is_refused = len(self._used) > 1 and uneven > self.largest_unevenness
            if is_refused and not (whole or at_rest):
                raise ValueError(
                    f"rotors[{name!r}]: its unevenness is {uneven:.2g}, and it turns with {ratio:g}"
                    " times the speed of the analysis; give a finer mesh, a number of modes that "
                    "leaves no pair of bending modes in halves, a larger largest_unevenness=…, or "
                    f"train.relative_to({name!r})"
                )
            bodies.append(rotor_body(alone, name, 0.0 if at_rest else ratio, turns))
        return bodies + self._standing_bodies

    @cached_property
    def _standing_bodies(self) -> list[StandingBody]:
        if self.foundation is None:
            return []
        return [foundation_body(self.foundation, next(iter(self._used.values())))]

    @cached_property
    def _running(self) -> Assembly:
        return self._assembled()

    @cached_property
    def _at_rest(self) -> Assembly:
        return self._assembled(at_rest=True)

    def assembly(self, speed: float) -> Assembly:
        """Return bodies and elements as they are at a speed [rad/s]."""
        return self._running if speed else self._at_rest

    # ------------------------------------------------------------------ equations

    def at(self, speed: float, frequency: float | None = None) -> PeriodicSystem:
        """Return the equations at a spin speed, and a frequency of motions [rad/s].

        Supports with coefficients over the frequency have those of the spin speed by default.

        Raises
        ------
        NoCoefficientsError
            For a speed beyond a table, or at which a film carries nothing.
        """
        return self.assembly(speed).system(float(speed), frequency, self._added(speed))

    def _added(self, speed: float) -> Powers:
        """Return what acts beside the elements, at rest or at any other speed."""
        return {}

    def at_all(
        self, speeds: Sequence[float], frequencies: Sequence[float] | None = None
    ) -> PeriodicSystem:
        """Return the equations at spin speeds (s,) [rad/s] as one stack.

        NaN at speeds where there are none, of which one warning tells. With motions of the
        frequencies (s,) [rad/s]; those of the speeds by default.

        Raises
        ------
        NoCoefficientsError, UnconvergedError
            Where there are equations at none of the speeds.
        """
        speeds = np.asarray(speeds, dtype=float)
        stack, refused = self.systems(
            speeds, np.abs(speeds) if frequencies is None else frequencies
        )
        lost = [(f"{speeds[i]:.5g}", refused[i]) for i in sorted(refused)]
        warn_of_refused(lost, len(speeds), " rad/s")
        return stack

    def systems(
        self, speeds: np.ndarray, frequencies: np.ndarray
    ) -> tuple[PeriodicSystem | None, dict[int, Exception]]:
        """Return the stack at speeds (s,), None where all are refused, and why some are."""
        parts, refused = [], {}
        for at in (np.flatnonzero(speeds), np.flatnonzero(speeds == 0.0)):
            if at.size and self._is_list:
                assembly, added = self.assembly(speeds[at[0]]), self._added(speeds[at[0]])
                try:
                    parts.append((at, assembly.system(speeds[at], frequencies[at], added)))
                    continue
                except NO_EQUATIONS:
                    pass  # one by one, then
            for i in sorted(at.tolist(), key=lambda i: -abs(speeds[i])):  # films carry more there
                try:
                    parts.append((i, self.at(speeds[i], frequencies[i])))
                except NO_EQUATIONS as error:
                    refused[i] = error
        return spread(speeds, parts) if parts else None, refused

    @property
    def pattern(self) -> tuple:
        """What models have in common whose equations differ in numbers of their supports alone."""
        given = [
            (getattr(one, "pattern", None) or id(one))
            for each in self.supports.values()
            for one in each
        ]
        parts = *self.rotors.values(), *self.links, self.foundation
        rest = *self.ratios.values(), self.stiffening_asked, self.wanted_axes
        kind = self.largest_unevenness, self.is_undamped, self.is_richer
        return *given, *map(id, parts), *rest, *kind

    def coefficients(self, speed: float, frequency: float | None = None) -> list:
        """Return what :meth:`at_points` needs of a model at a speed, as :meth:`at` [rad/s]."""
        return [element.matrices(speed, frequency) for element in self._elements[0]]

    def at_points(self, speeds: np.ndarray, coefficients: Sequence) -> PeriodicSystem:
        """Return the equations of models of one :attr:`pattern` at points, as one stack.

        `speeds` (s,) [rad/s] are all zero or none; `coefficients` are those of each point.
        """
        return self.assembly(speeds[0]).at_points(speeds, stacked_coefficients(coefficients))

    def matrices(self, speed: float, frequency: float | None = None) -> Matrices:
        """Return mass, damping and stiffness at a spin speed [rad/s].

        Parameters
        ----------
        speed : float
        frequency : float, optional
            Of motions, for supports with coefficients over it; that of the speed by default.

        Returns
        -------
        Matrices
            M, D, K (k, k), the names of the coordinates and of the axes.

        Raises
        ------
        ValueError
            Where the equations are periodic, as of an uneven rotor on uneven supports.
        """
        if frequency is not None:
            checks.number(frequency, "frequency", "rad/s", least=0.0)
        system = self.at(checks.number(speed, "speed", "rad/s"), frequency)
        if not system.is_constant:
            raise ValueError(
                "matrices: the equations of an uneven rotor on uneven supports repeat every "
                "revolution; model.at(speed) has their Fourier terms"
            )
        return Matrices(*system.matrices(), self.coordinates, self.axes)

    def state_space(self, speed: float) -> StateSpace:
        """Return the state space between forces and displacements at all interfaces.

        Inputs and outputs stand still, along n1 and n2 of each of :attr:`interfaces` in their
        order. States are the coordinates and their rates.

        Parameters
        ----------
        speed : float
            Spin speed [rad/s].

        Raises
        ------
        ValueError
            As :meth:`matrices`, and in axes of the rotor, where what stands still turns.
        """
        M, D, K, _, axes = self.matrices(speed)
        if axes == "rotor" and speed:
            raise ValueError(
                "state_space: forces that stand still turn in the axes of an uneven rotor; see "
                "model.matrices(speed)"
            )
        rows = [self.seen(name, speed)[0][:2] for name in self.interfaces]
        U = np.vstack([np.zeros((0, self.size)), *rows])
        inverse = la.inv(M)
        none, one = np.zeros_like(M), np.eye(len(M))
        return StateSpace(
            np.block([[none, one], [-inverse @ K, -inverse @ D]]),
            np.vstack([np.zeros((len(M), len(U))), inverse @ U.T]),
            np.hstack([U, np.zeros(U.shape)]),
            np.zeros((len(U), len(U))),
        )

    @property
    def mass_matrix(self) -> np.ndarray:
        """M, shape (k, k)."""
        return self._running.M

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return self._running.size

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return self._running.labels()

    def undamped(self) -> LinearModel:
        """Return the model whose critical speeds are those without damping."""
        return replace(self, is_undamped=True)

    @property
    def is_full(self) -> bool:
        """Whether the bases of its rotors leave nothing out that is known of."""
        found = [(rotor.size, rotor.with_attachments) for rotor in self.rotors.values()]
        return all(finer is not None and finer.size == size for size, finer in found)

    @cached_property
    def richer(self) -> LinearModel | None:
        """The model with the shapes that the bases of its rotors lack; None if not known."""
        if self.is_richer or any(r.with_attachments is None for r in self.rotors.values()):
            return None
        return replace(self, is_richer=True, wanted_axes=self.axes, largest_unevenness=np.inf)

    # ------------------------------------------------------------------ what it consists of

    @property
    def bodies(self) -> tuple:
        """Bodies at a speed."""
        return self._running.bodies

    @property
    def unevenness(self) -> float:
        """Largest share of a rotor that differs around its axis, averaged or not."""
        return max(self._own_unevenness.values())

    @property
    def stiffening(self) -> str:
        """Level of centrifugal stiffening, the lowest of all rotors."""
        return min((b.alone.level for b in rotors_of(self.bodies)), key=LEVELS.index)

    @property
    def stiffness_varies(self) -> bool:
        """Whether a stiffness depends on the speed other than by Ω²."""
        fourth = any(b.alone.terms.K4 is not None for b in rotors_of(self.bodies))
        return fourth or any(element.stiffness_varies for element in self._elements[0])

    @property
    def table_speeds(self) -> np.ndarray:
        """Ω at the points of the tables of supports [rad/s], at which there are kinks."""
        return np.unique(np.concatenate([[], *(e.table_speeds for e in self._elements[0])]))

    @property
    def table_frequencies(self) -> np.ndarray:
        """Frequencies of the tables of supports [rad/s]; none where nothing depends on it."""
        return np.unique(np.concatenate([[], *(e.table_frequencies for e in self._elements[0])]))

    @cached_property
    def over_frequency(self) -> bool:
        """Whether coefficients of a support depend on the frequency of a motion."""
        return bool(self.table_frequencies.size)

    def check_without_frequency(self, what: str) -> None:
        """Refuse coefficients over the frequency, of which motions of `what` have several."""
        for element in self._elements[0]:
            if element.table_frequencies.size:
                raise ValueError(
                    f"supports: {element.what} has coefficients over the frequency, and {what} has "
                    "several at once; give support.at_frequency(…), or a bearing with states of "
                    "its own"
                )

    def warn_beyond(self, frequencies: np.ndarray) -> None:
        """Warn of motions [rad/s] beyond a table over the frequency, which keeps its end there."""
        for element in () if self.is_richer else self._elements[0]:
            table, used = element.table_frequencies, np.asarray(frequencies)
            if table.size and not element.law.extrapolate:
                slack = _HELD * table.max()
                used = used[(used < table.min() - slack) | (used > table.max() + slack)]
                if used.size:
                    warnings.warn(
                        f"support at {element.what}: its table holds {table.min():g} to "
                        f"{table.max():g} rad/s, and keeps its ends for motions of "
                        f"{used.min():.5g} to {used.max():.5g} rad/s; give more of it, or "
                        "extrapolate=True",
                        UserWarning,
                        stacklevel=user_level(),
                    )
                    return

    @property
    def has_structural_damping(self) -> bool:
        """Whether steady motions have structural damping, which other analyses leave out."""
        return any(body.H for body in self.bodies)

    @cached_property
    def radius(self) -> float:
        """By which a rotation counts as a displacement [m]."""
        return max(radius_of_gyration(b.alone.invariants) for b in rotors_of(self.bodies))

    @cached_property
    def _named(self) -> dict[str, tuple[str, str]]:
        """Bodies and the own names of their places, by the names of these in the model."""
        several = len(self._used) > 1
        found = {
            f"{owner}:{name}" if several or owner else name: (owner, name)
            for owner, rotor in self._used.items()
            for name in rotor.interfaces
        }
        points = () if self.foundation is None else self.foundation.points
        return found | {ON_FOUNDATION.format(name): ("foundation", name) for name in points}

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of what can be loaded and looked at, of foundations, too."""
        return tuple(self._named)

    def owner(self, name: str) -> tuple[RotorBody | StandingBody, str]:
        """Return the body of an interface of this name, and its own name there."""
        owner, interface = self._named[name]
        return self._running.body(owner), interface

    def seen(self, name: str, speed: float = 1.0) -> dict[int, np.ndarray]:
        """Return the motion of an interface in axes that stand still.

        Fourier terms (6, k): displacement and rotation along (n1, n2, e).
        """
        assembly, (owner, interface) = self.assembly(speed), self._named[name]
        return assembly.seen(assembly.body(owner), interface)

    def seen_at_node(self, number: int, speed: float = 1.0) -> dict[int, np.ndarray]:
        """Return the motion of a mesh node of the only rotor, as :meth:`seen` does; no rotation."""
        assembly = self.assembly(speed)
        body = rotors_of(assembly.bodies)[0]
        rotor = self.rotors[body.name]
        rows = rotor.shapes.matrix[3 * number : 3 * number + 3]
        if self.is_richer:  # the shapes that are added have no motion of nodes
            rows = rows @ rotor.in_attached.T
        rows = axes_of(rotor.axis).T @ rows @ body.Q
        rows = np.vstack([rows, 0.0 * rows])
        return assembly.wide(body.from_outside(rows), assembly.slices[0])

    def unbalance(self, speed: float = 1.0) -> dict[int, np.ndarray]:
        """Return the load (k,) per Ω² of the own eccentricity of the rotors of ratio 1.

        By its harmonics of Ω.
        """
        assembly = self.assembly(speed)
        total: dict[int, np.ndarray] = {}
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, RotorBody) and self.ratios[body.name] == 1.0:
                add(total, assembly.wide(body.unbalance, place))
        return total

    def base_loads(self, speed: float = 1.0) -> dict[int, np.ndarray] | None:
        """Return the loads (3, k) of unit accelerations of the ground, as Fourier terms."""
        assembly, total = self.assembly(speed), {}
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, StandingBody) and body.base_loads is None:
                return None
            add(total, assembly.wide(body.base_loads or {}, place))
        return total

    # ------------------------------------------------------------------ free motions

    @cached_property
    def _held_at_rest(self) -> tuple[Assembly, np.ndarray]:
        """Bodies at rest without own coordinates, and the stiffness of what holds them."""
        assembly = self._assembled(at_rest=True, kind="static")
        K = np.zeros((assembly.size, assembly.size))
        for element, U in zip(assembly.elements, assembly.motions, strict=True):
            U = sum(U.values()).real
            K += U.T @ element.at_rest() @ U
        return assembly, K

    @cached_property
    def free_motions(self) -> tuple[str, ...]:
        """Rigid motions that nothing holds at rest; 'combination of …' where several take part."""
        assembly, K = self._held_at_rest
        names, columns = [], []
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, RotorBody):
                prefix = f"{body.name}: " if len(self._used) > 1 else ""
                for name, motion in zip(body.alone.rotor.rigid, body.alone.Q, strict=False):
                    if np.linalg.norm(motion) > 0.5:  # a scene may prescribe it
                        names.append(prefix + name)
                        columns.append(np.zeros(assembly.size))
                        columns[-1][place] = motion
        free = _unheld(np.reshape(columns, (-1, assembly.size)).T, K)
        share = np.sum(free**2, axis=1)
        alone = [name for name, s in zip(names, share, strict=True) if s > _ALONE]
        partly = [name for name, s in zip(names, share, strict=True) if 1.0 - _ALONE < s <= _ALONE]
        combination = "combination of " + ", ".join(partly)
        return (*alone, *(combination,) * (free.shape[1] - len(alone)))

    @cached_property
    def _neutral(self) -> tuple[np.ndarray, np.ndarray]:
        """Shifts along the axis and spins that nothing holds at any speed, (2, k, f) each.

        The motions, then their momenta.
        """
        assembly, K = self._held_at_rest
        shifts, spins = [], []
        for body, place in zip(self.bodies, assembly.slices, strict=False):
            if not isinstance(body, RotorBody):
                continue
            if ModeKind.AXIAL in body.alone.rotor.rigid_kinds:
                shifts.append(np.zeros((2, self.size)))
                along = body.alone.Q[body.alone.rotor.rigid_kinds.index(ModeKind.AXIAL)]
                shifts[-1][:, place] = along
            if body.spin is not None:
                spins.append(np.zeros((2, self.size)))
                spins[-1][:, place] = body.spin.turn, body.spin.momentum
        pairs = [np.reshape(X, (-1, 2, self.size)).transpose(1, 2, 0) for X in (shifts, spins)]
        return tuple(each @ _unheld(each[0, : len(K)], K) for each in pairs)

    @property
    def free_spins(self) -> np.ndarray:
        """Momenta of the spins that nothing holds, shape (k, f)."""
        return self._neutral[1][1]

    @property
    def neutral_motions(self) -> np.ndarray:
        """Motions that nothing holds at any speed: shifts along the axis, then spins, (k, f)."""
        return np.hstack([motions for motions, _ in self._neutral])

    @cached_property
    def held_basis(self) -> np.ndarray | None:
        """Motions without a free spin as orthonormal columns; None where no spin is free."""
        return others(self.free_spins) if self.free_spins.shape[1] else None

    @cached_property
    def moving_basis(self) -> np.ndarray | None:
        """Motions without :attr:`neutral_motions` as orthonormal columns; None for all."""
        momenta = np.hstack([momenta for _, momenta in self._neutral])
        return others(momenta) if momenta.shape[1] else None

    @cached_property
    def for_responses(self) -> LinearModel:
        """The model in which forced motions are found: nothing of the rotor is averaged.

        Near a critical speed a forced motion stands in the rotor, where the unevenness of a mesh
        counts to first order. It has few harmonics in the axes of the rotor. Coefficients over the
        frequency, and a mass that differs in two directions, need axes that stand still.
        """
        if self.wanted_axes != "auto" or any(one.stands for one in self._elements[0]):
            return self
        return replace(self, wanted_axes="rotor")

    def __repr__(self) -> str:
        lines = [f"LinearModel of {self.size} coordinates in {self.axes} axes"]
        for name, rotor in self.rotors.items():
            body = next(b for b in rotors_of(self.bodies) if b.name == name)
            known = ", ".join(rotor.interfaces) or "none"
            label = f"rotor {name!r}" if name else "rotor"
            lines.append(f"{label}: {body.size} coordinates, interfaces {known}")
        standing = "" if self.foundation is None else " on a foundation"
        acted = ", ".join(dict.fromkeys(element.what for element in self._elements[0])) or "none"
        lines.append(f"supports{standing}: {acted}")
        lines.append("free motions: " + (", ".join(self.free_motions) or "none"))
        lines.append(f"stiffening: {self.stiffening}, unevenness {self.unevenness:.1e}")
        return "\n".join(lines)


def warn_of_refused(refused: Sequence[tuple[str, Exception]], count: int, unit: str = "") -> None:
    """Warn of points without values; raise the first error where all of `count` have none."""
    if refused and len(refused) == count:
        raise refused[0][1]
    if refused:
        shown = ", ".join(point for point, _ in refused[:5]) + (" …" if len(refused) > 5 else "")
        warnings.warn(
            f"no values at {shown}{unit}, which are NaN: {refused[0][1]}",
            UserWarning,
            stacklevel=user_level(),
        )


def _unheld(columns: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Return which combinations (f, r) of motions (k, f) a stiffness (k, k) leaves free."""
    _, values, combined = np.linalg.svd(columns.T @ K @ columns)
    most = max(np.abs(np.diag(K)).max(initial=0.0), 1e-300)
    return combined[values <= _HELD * most].T
