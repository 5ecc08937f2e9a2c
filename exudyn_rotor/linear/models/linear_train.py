"""The linear equations of a :class:`RotorTrain`.

All coordinates are seen in axes that turn with the speed Ω of the analysis: those of a rotor of
ratio 1 are its own, those of others are turned (:mod:`.turned_rotor`). Axisymmetric rotors have
constant coefficients there at any ratio, and so has what stands still and is the same in both
directions across the axis; the rest repeats with θ = Ωt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np
import scipy.linalg as la

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import checked_supports
from exudyn_rotor.linear.models.free_motions import named_motions
from exudyn_rotor.linear.models.links import (
    Element,
    add,
    join,
    join_turning,
    stacked,
)
from exudyn_rotor.linear.models.points import radius_of_gyration
from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.linear.models.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.rotor_train import RotorTrain
from exudyn_rotor.linear.models.spin import Spin
from exudyn_rotor.linear.models.standing_space import StandingSpace
from exudyn_rotor.linear.models.turned_rotor import TurnedRotor
from exudyn_rotor.linear.models.whole_space import InAllCoordinates, WholeSpace
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms
from exudyn_rotor.theory.stiffening import LEVELS

_HELD = 1e-10  # share of the largest torsional stiffness per unit mass that counts as none


@dataclass(frozen=True, eq=False)
class LinearTrain(InAllCoordinates):
    """Several rotors with supports and links, ready for any speed.

    Attributes
    ----------
    train : RotorTrain
    parts : mapping of str to TurnedRotor
    elements : tuple of Element
        Supports and links.
    """

    gives_all: ClassVar[bool] = True
    is_full: ClassVar[bool] = False
    mesh: ClassVar[None] = None
    has_structural_damping: ClassVar[bool] = False
    standing: ClassVar[np.ndarray] = checks.read_only(np.zeros(0, dtype=int), int)
    standing_interfaces: ClassVar[tuple[str, ...]] = ()

    train: RotorTrain
    parts: dict[str, TurnedRotor]
    elements: tuple[Element, ...]

    @classmethod
    def of(cls, train: RotorTrain, stiffening: str = "auto") -> LinearTrain:
        """Prepare the rotors; errors are those that :class:`RotorTrain` lists."""
        supports = {name: checked_supports(given) for name, given in train.supports.items()}
        elements = [
            Element.of_support(name, train.ratios[name], support)
            for name, given in supports.items()
            for support in given
        ]
        elements += [Element.of_link(link, train.ratios) for link in train.links]
        for element in elements:
            element.check()
        parts = {}
        for name, rotor in train.rotors.items():
            alone = LinearRotor.of(rotor, (), stiffening)
            _check(name, alone, supports.get(name, ()))
            at = places_of(name, elements)
            parts[name] = TurnedRotor.of(
                name, alone, train.ratios[name], at, train.largest_unevenness
            )
            parts[name].terms(0.0)  # refuses what does not repeat with θ, as do motions
        model = cls(train, parts, tuple(elements))
        _ = model._motions
        return model

    @cached_property
    def _standing(self) -> LinearTrain | None:
        """The equations in inertial axes where these are constant and those here are not."""
        harmonics = any(n for terms in self._constant for n in terms)
        varies = any(element.varies for element in self.elements)
        if not (harmonics or varies) or any(element.turns for element in self.elements):
            return None
        parts = {}
        for name, part in self.parts.items():
            given = self.train.ratios[name], places_of(name, self.elements)
            uneven = self.train.largest_unevenness
            parts[name] = TurnedRotor.of(name, part.alone, *given, uneven, frame=0.0)
            if not parts[name].is_even:
                return None
        elements = tuple(replace(element, frame=0.0) for element in self.elements)
        return replace(self, parts=parts, elements=elements)

    @cached_property
    def _slices(self) -> dict[str, slice]:
        ends = np.cumsum([part.size for part in self.parts.values()])
        return {
            name: slice(end - part.size, end)
            for (name, part), end in zip(self.parts.items(), ends.tolist(), strict=True)
        }

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return sum(part.size for part in self.parts.values())

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of all interfaces, as 'rotor:interface'."""
        return tuple(
            f"{name}:{interface}"
            for name, rotor in self.train.rotors.items()
            for interface in rotor.interfaces
        )

    @property
    def unevenness(self) -> dict[str, float]:
        """Share of each rotor's matrices that differs around its axis; 0 where it plays no part."""
        return {name: part.unevenness for name, part in self.parts.items()}

    @cached_property
    def mass_matrix(self) -> np.ndarray:
        """M, shape (k, k)."""
        return la.block_diag(*(part.alone.mass_matrix for part in self.parts.values()))

    @property
    def unit_unbalance(self) -> np.ndarray:
        """Load per Ω² of the own eccentricity of the rotors of ratio 1, shape (k,)."""
        return np.hstack(
            [
                part.alone.unit_unbalance if part.drift == 0.0 else np.zeros(part.size)
                for part in self.parts.values()
            ]
        )

    @property
    def is_balanced(self) -> bool:
        """True where no rotor of ratio 1 has an unbalance but for rounding."""
        return all(p.alone.is_balanced for p in self.parts.values() if p.drift == 0.0)

    @property
    def base_loads(self) -> np.ndarray:
        """Loads of unit accelerations of the ground (109), shape (3, k)."""
        return np.hstack([part.base_loads for part in self.parts.values()])

    @property
    def radius(self) -> float:
        """Radius of gyration of the largest rotor [m]."""
        return max(radius_of_gyration(part.alone.invariants) for part in self.parts.values())

    @property
    def stiffening(self) -> str:
        """Level of centrifugal stiffening, the lowest of all rotors."""
        return min((part.alone.stiffening for part in self.parts.values()), key=LEVELS.index)

    @property
    def stiffness_varies(self) -> bool:
        """True where something has a stiffness that is not in Ω²."""
        varies = any(element.stiffness_varies for element in self.elements)
        return varies or any(p.alone.stiffness_varies for p in self.parts.values())

    @cached_property
    def free_motions(self) -> tuple[str, ...]:
        """Rigid motions that no spring holds at rest."""
        names, columns = [], []
        for name, part in self.parts.items():
            rigid = part.alone.rotor.rigid
            names += [f"{name}: {motion}" for motion in rigid]
            columns += range(self._slices[name].start, self._slices[name].start + len(rigid))
        return named_motions(names, self._held_at_rest[np.ix_(columns, columns)])

    @cached_property
    def _held_at_rest(self) -> np.ndarray:
        """Stiffness of supports and links at rest, shape (k, k)."""
        K = np.zeros((self.size, self.size))
        for element, U in zip(self.elements, self._motions, strict=True):
            at_rest = sum(U.values()).real
            K += at_rest.T @ element.at_rest @ at_rest
        return K

    @cached_property
    def _motions(self) -> list[Terms]:
        """Motions (6 or 12, k) of the ends of the elements, by multiples of θ."""
        return [
            stacked([self._wide(name, self.parts[name].motion(at)) for name, at in element.ends])
            for element in self.elements
        ]

    def _wide(self, name: str, motion: Terms) -> Terms:
        wide = {}
        for n, U in motion.items():
            wide[n] = np.zeros((len(U), self.size), dtype=U.dtype)
            wide[n][:, self._slices[name]] = U
        return wide

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's motion (6, k): displacement and rotation along (n1, n2, e).

        Raises
        ------
        ValueError
            At a rotor that is neither axisymmetric nor of ratio 1: its motion repeats with θ.
        """
        owner, _, interface = name.partition(":")
        part = self.parts[owner]
        motion = self._wide(owner, part.seen(interface))
        if len(motion) > 1:
            raise ValueError(
                f"at: {name!r}: rotor {owner!r} is uneven and turns with {part.ratio:g} times the "
                "speed; look at it with relative_to()"
            )
        return motion[0]

    def check_turning(self, name: str) -> None:
        """Refuse a load that turns with an interface whose rotor has another speed than Ω.

        Raises
        ------
        ValueError
        """
        owner, _, _ = name.partition(":")
        ratio = self.train.ratios[owner]
        if ratio != 1.0:
            raise ValueError(
                f"at: {name!r}: turns with {ratio:g} times the speed of the analysis; give "
                f"train.relative_to({owner!r}), over the speed of that rotor"
            )

    @cached_property
    def _constant(self) -> tuple[Terms, Terms, Terms]:
        """Damping, stiffness and stiffness per Ω of the elements that do not vary with it."""
        sums: tuple[dict, dict, dict] = ({}, {}, {})
        for element, U in zip(self.elements, self._motions, strict=True):
            if not element.varies:
                join_turning(sums, element.parts(0.0), U)
        return sums

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed Ω [rad/s]."""
        D, K, carried = (dict(terms) for terms in self._constant)
        for element, U in zip(self.elements, self._motions, strict=True):
            if element.varies:
                join_turning((D, K, carried), element.parts(speed), U)
        join(K, {n: speed * X for n, X in carried.items()})
        for name, part in self.parts.items():
            own = self._slices[name]
            for terms, blocks in zip((D, K), part.terms(speed), strict=True):
                for n, block in blocks.items():
                    wide = np.zeros((self.size, self.size), dtype=block.dtype)
                    wide[own, own] = block
                    add(terms, n, wide)
        return PeriodicSystem(float(speed), {0: self.mass_matrix}, D, K)

    def undamped(self) -> LinearTrain:
        """Return the model itself: its damping does not enter the Hermitian part of equations."""
        return self

    def point_motions(self, most: int) -> PointMotions:
        """Return points of all rotors, up to `most` of each."""
        points, motions, is_mesh = [], [], True
        for name, part in self.parts.items():
            given = part.alone.point_motions(most)
            wide = np.zeros((len(given.motion), self.size))
            wide[:, self._slices[name]] = given.motion
            points.append(given.points)
            motions.append(wide)
            is_mesh = is_mesh and given.is_mesh
        ends = tuple(np.cumsum([len(each) for each in points]).tolist())
        return PointMotions(np.vstack(points), np.vstack(motions), None, is_mesh, ends=ends)

    @cached_property
    def _free_spins(self) -> np.ndarray:
        """Momenta of the combinations of spins that nothing holds, orthonormal, shape (k, f)."""
        spins, momenta = [], []
        for name, part in self.parts.items():
            spin = part.alone.spin
            if spin is not None:
                for columns, given in ((spins, spin.motion), (momenta, spin.momentum)):
                    columns.append(np.zeros(self.size))
                    columns[-1][self._slices[name]] = given
        if not spins:
            return np.zeros((self.size, 0))
        S = np.column_stack(spins)
        values, turn = la.eigh(S.T @ self._held_at_rest @ S)
        free = turn[:, values <= _HELD * max(values[-1], 0.0)]
        return la.orth(np.column_stack(momenta) @ free)

    def whole_space(self, held: bool) -> WholeSpace:
        """Return all coordinates, `held` without a spin that nothing holds."""
        momenta = self._free_spins
        # coordinates that fix the free spins, as far apart as can be
        _, _, pivots = la.qr(momenta.T, pivoting=True)
        options = {"can_be_sent": True, "driven": tuple(pivots[: momenta.shape[1]].tolist())}
        if held and momenta.shape[1]:
            options = {"can_be_sent": True, "others": la.null_space(momenta.T)}
        if self._standing is None:
            return WholeSpace(self, **options)
        turnings = [part.turning for part in self._standing.parts.values()]
        return StandingSpace(self, **options, standing=self._standing, turnings=turnings)


def places_of(name: str, elements: Sequence[Element]) -> tuple[str, ...]:
    """Return the interfaces of a rotor that elements act on."""
    return tuple(at for element in elements for owner, at in element.ends if owner == name)


def _check(name: str, alone: LinearRotor, supports: Sequence) -> None:
    """Refuse what the equations of several rotors do not have."""
    if alone.has_structural_damping:
        raise ValueError(
            f"rotors[{name!r}]: has structural damping, which is for responses of one rotor; give "
            "damping by mass= and stiffness="
        )
    if alone.spin is None:
        return
    motions = [alone.interface_motion(support.interface) for support in supports]
    given = alone.spin.motion, alone.spin.momentum, supports, motions
    if Spin.of(*given, alone.invariants, alone.rotor.axis).coupled:
        raise ValueError(
            f"supports[{name!r}]: hold the spin by an arm off the axis, or turn with the rotor and "
            "hold its torsion, which is for analyses of one rotor"
        )
