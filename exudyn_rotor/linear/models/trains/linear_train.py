"""The linear equations of a :class:`RotorTrain`.

All coordinates are seen in axes that turn with the speed Ω of the analysis: those of a rotor of
ratio 1 are its own, those of others are turned (:mod:`.turned_rotor`). Axisymmetric rotors have
constant coefficients there at any ratio, and so has what stands still and is the same in both
directions across the axis; the rest repeats with θ = Ωt. Coordinates of controllers and of pads
(:mod:`.own_coordinates`) come after those of all rotors.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import scipy.linalg as la

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.fourier_terms import add, join, join_turning, stacked
from exudyn_rotor.linear.models.free_motions import named_motions
from exudyn_rotor.linear.models.links import Element
from exudyn_rotor.linear.models.points import radius_of_gyration, with_pairs
from exudyn_rotor.linear.models.protocol import PointMotions
from exudyn_rotor.linear.models.rotor.own_coordinates import OwnCoordinates
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.trains.rotor_train import RotorTrain
from exudyn_rotor.linear.models.trains.standing_space import StandingSpace
from exudyn_rotor.linear.models.trains.train_elements import (
    check_rotor,
    elements_of,
    held_elements,
    place_of,
    places_of,
)
from exudyn_rotor.linear.models.trains.turned_rotor import TurnedRotor
from exudyn_rotor.linear.models.trains.turning import Turning
from exudyn_rotor.linear.models.trains.uneven_space import UnevenSpace
from exudyn_rotor.linear.models.whole_space import InAllCoordinates, WholeSpace
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, Terms
from exudyn_rotor.reduction.driven import without_spin
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
        Supports and links, see :mod:`.train_elements`.
    own : OwnCoordinates
        Of some supports.
    """

    gives_all: ClassVar[bool] = True
    is_full: ClassVar[bool] = False
    mesh: ClassVar[None] = None
    has_structural_damping: ClassVar[bool] = False
    standing_interfaces: ClassVar[tuple[str, ...]] = ()

    train: RotorTrain
    parts: dict[str, TurnedRotor]
    elements: tuple[Element, ...]
    own: OwnCoordinates

    @classmethod
    def of(cls, train: RotorTrain, stiffening: str = "auto") -> LinearTrain:
        """Prepare the rotors; errors are those that :class:`RotorTrain` lists."""
        elements, own = elements_of(train)
        parts = {}
        for name, rotor in train.rotors.items():
            given = without_spin(rotor) if name in train.driven else rotor
            alone = LinearRotor.of(given, (), stiffening, twisted=True)
            check_rotor(name, alone, held_elements(elements, own))
            at = places_of(name, elements)
            parts[name] = TurnedRotor.of(
                name, alone, train.ratios[name], at, train.largest_unevenness
            )
            parts[name].terms(0.0)  # refuses what does not repeat with θ, as do motions
        model = cls(train, parts, elements, own)
        _ = model._motions
        return model

    @cached_property
    def _standing(self) -> LinearTrain | None:
        """The equations in inertial axes where these are constant and those here are not."""
        harmonics = any(n for terms in (*self._constant, *self._between) for n in terms)
        varies = any(element.varies for element in self.elements)
        if not (harmonics or varies or self.own.varies):
            return None
        if any(element.turns for element in self.elements):
            return None
        parts = {}
        for name, part in self.parts.items():
            given = self.train.ratios[name], places_of(name, self.elements)
            uneven = self.train.largest_unevenness
            parts[name] = TurnedRotor.of(name, part.alone, *given, uneven, frame=0.0)
            if not parts[name].is_even:
                return None
        elements = tuple(replace(element, frame=0.0) for element in self.elements)
        return replace(self, parts=parts, elements=elements, own=replace(self.own, frame=0.0))

    @cached_property
    def all_even(self) -> tuple[LinearTrain, float]:
        """The equations with rotors of ratio 1 even, and what unevenness is left out of others."""
        parts = {name: part.evened() for name, part in self.parts.items()}
        left_out = max(part.is_even * part.unevenness for part in self.parts.values())
        return replace(self, parts=parts), left_out

    @cached_property
    def held(self) -> LinearTrain:
        """The rotors on the static stiffness of supports that have coordinates of their own."""
        elements = held_elements(self.elements, self.own)
        return replace(self, elements=elements, own=OwnCoordinates())

    def _place(self, index: int) -> int:
        """Return where a controller's pair of elements is."""
        return place_of(index, self.elements, self.own)

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
        return sum(part.size for part in self.parts.values()) + self.own.size

    @property
    def standing(self) -> np.ndarray:
        """Coordinates of pads."""
        return np.arange(self.size - self.own.size + self.own.turning, self.size)

    @property
    def voids(self) -> np.ndarray:
        """Coordinates of what films remember."""
        return self.size - self.own.size + self.own.voids

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
        parts = (self._standing or self).parts
        return {name: part.unevenness for name, part in parts.items()}

    @cached_property
    def mass_matrix(self) -> np.ndarray:
        """M, shape (k, k)."""
        own = np.diag(self.own.masses)
        return la.block_diag(*(part.alone.mass_matrix for part in self.parts.values()), own)

    @property
    def unit_unbalance(self) -> np.ndarray:
        """Load per Ω² of the own eccentricity of the rotors of ratio 1, shape (k,)."""
        return np.hstack(
            [
                *(
                    part.alone.unit_unbalance if part.drift == 0.0 else np.zeros(part.size)
                    for part in self.parts.values()
                ),
                np.zeros(self.own.size),
            ]
        )

    @property
    def is_balanced(self) -> bool:
        """True where no rotor of ratio 1 has an unbalance but for rounding."""
        return all(p.alone.is_balanced for p in self.parts.values() if p.drift == 0.0)

    @property
    def base_loads(self) -> np.ndarray:
        """Loads of unit accelerations of the ground (109), shape (3, k)."""
        none = np.zeros((3, self.own.size))
        return np.hstack([*(part.base_loads for part in self.parts.values()), none])

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
        varies = any(element.stiffness_varies for element in self.elements) or self.own.varies
        return varies or any(p.alone.stiffness_varies for p in self.parts.values())

    @property
    def table_speeds(self) -> np.ndarray:
        """Ω at the points of the tables of supports and links [rad/s]."""
        return np.concatenate([np.zeros(0), *(element.table_speeds for element in self.elements)])

    @cached_property
    def free_motions(self) -> tuple[str, ...]:
        """Rigid motions that no spring holds at rest."""
        if self.own.size:
            return self.held.free_motions
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

    def own_rows(self, index: int) -> slice:
        """Return where the coordinates of a controller are."""
        rows, first = self.own.rows(index), self.size - self.own.size
        return slice(first + rows.start, first + rows.stop)

    def sensed(self, index: int) -> Terms:
        """Return the displacement (3, k) along (n1, n2, e) that a controller measures."""
        return _displacement(self._motions[self._place(index) + 1])

    @cached_property
    def _journals(self) -> list[Terms]:
        """Displacements (3, k) where supports with coordinates of their own act."""
        indices = range(len(self.own.supports))
        return [_displacement(self._motions[self._place(index)]) for index in indices]

    @cached_property
    def _between(self) -> tuple[Terms, Terms, Terms]:
        """Damping, stiffness and stiffness per Ω that controllers bring."""
        return self.own.between(self._journals, list(map(self.sensed, range(len(self._journals)))))

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
                f"speed; look at it with relative_to({owner!r}), or name other places, at=…, which "
                "are all interfaces by default"
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
        for more in (self._between, self.own.films(speed, self._journals)):
            for terms, added in zip((D, K, carried), more, strict=True):
                join(terms, added)
        for terms, inertia in zip((D, K), self.own.inertia_terms(speed), strict=True):
            add(terms, 0, np.pad(inertia, (self.size - self.own.size, 0)))
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
        """Return :attr:`held` without damping of supports, nor the skew part of their stiffness."""
        elements = tuple(element.undamped() for element in self.held.elements)
        return replace(self.held, elements=elements)

    def point_motions(self, most: int) -> PointMotions:
        """Return points of all rotors, up to `most` of each, and of controllers and pads.

        These as :meth:`ControlledRotor.point_motions`.
        """
        points, motions, is_mesh = [], [], True
        for name, part in self.parts.items():
            given = part.alone.point_motions(most)
            wide = np.zeros((len(given.motion), self.size))
            wide[:, self._slices[name]] = given.motion
            points.append(given.points)
            motions.append(wide)
            is_mesh = is_mesh and given.is_mesh
        ends = tuple(np.cumsum([len(each) for each in points]).tolist())
        given = PointMotions(np.vstack(points), np.vstack(motions), None, is_mesh, ends=ends)
        if not self.own.size:
            return given
        mass = sum(part.alone.invariants.mass for part in self.parts.values())
        rows = np.eye(self.size)[self.size - self.own.size :]
        pads = np.sqrt(given.share(mass) * self.own.masses)[:, None] * rows
        standing = pads[self.own.turning :] if self.own.turning < self.own.size else None
        return with_pairs(replace(given, standing=standing), rows[: self.own.turning])

    @cached_property
    def _free_spins(self) -> np.ndarray:
        """Momenta of the combinations of spins that nothing holds, orthonormal, shape (k, f)."""
        if self.own.size:
            return np.pad(self.held._free_spins, ((0, self.own.size), (0, 0)))
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
        options = {"driven": tuple(pivots[: momenta.shape[1]].tolist())}
        if held and momenta.shape[1]:
            options = {"others": la.null_space(momenta.T)}
        options |= {"can_be_sent": True, "train": self}
        if self._standing is None:
            return UnevenSpace(self, **options)
        still = self.own.size - self.own.turning
        turnings = [part.turning for part in self._standing.parts.values()]
        turnings.append(Turning.beside(self.own.turning // 2, still))
        return StandingSpace(self, **options, standing=self._standing, turnings=turnings)


def _displacement(motion: Terms) -> dict[int, np.ndarray]:
    return {n: U[:3] for n, U in motion.items()}
