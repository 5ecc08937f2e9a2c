"""Foundations and casings: linear equations, and how the points that carry bearings move.

    M ÿ + D ẏ + K y = Σ Bᵢᵀ fᵢ − Sᵀ a

with the force and moment fᵢ that a support exerts at its point, whose displacement and rotation are
``Bᵢ y``, and the acceleration a of the ground, against which y is counted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.reduction.craig_bampton import craig_bampton_modes
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.places import SAME_PLACE, off_place
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.axis import skew

_SINGULAR = 1e-10  # of a matrix scaled to a diagonal of ones
_UNITS = {"mass": "kg", "damping": "N s/m", "stiffness": "N/m"}


@dataclass(frozen=True, eq=False)
class Mount:
    """Spring and damper between a foundation and the ground.

    Parameters
    ----------
    at : str or array_like, shape (3,)
        Interface of a solid foundation, or the place on a rigid one [m].
    stiffness, damping : float or array_like, shape (3,) or (3, 3)
        A number acts alike in x, y and z, three numbers along each of them, a symmetric matrix in
        these axes [N/m], [N s/m].

    Raises
    ------
    TypeError, ValueError
        For another shape, or a matrix that is not symmetric or takes energy from nowhere.

    Examples
    --------
    >>> from exudyn_rotor import Mount
    >>> Mount([0.2, 0.0, -0.1], [1e6, 1e6, 4e6], 200.0).damping
    array([[200.,   0.,   0.],
           [  0., 200.,   0.],
           [  0.,   0., 200.]])
    """

    at: str | ArrayLike
    stiffness: float | ArrayLike
    damping: float | ArrayLike = 0.0

    def __post_init__(self) -> None:
        at = self.at
        at = checks.label(at, "at") if isinstance(at, str) else checks.vector(at, "at", "m")
        stiffness = _in_three_axes(self.stiffness, "stiffness", "N/m")
        damping = _in_three_axes(self.damping, "damping", "N s/m")
        checks.keep(self, at=at, stiffness=stiffness, damping=damping)


@dataclass(frozen=True, eq=False)
class Foundation:
    """A linear foundation or casing on the ground, which carries supports of a rotor.

    In scenes (:func:`exudyn_rotor.add_foundation`) and linear analyses (``foundation=…``) alike. It
    stands still beside the rotor; all axes are those of the rotor's mesh at the spin angle 0.

    Parameters
    ----------
    mass, damping, stiffness : array_like, shape (k, k)
        M, D, K of any coordinates, symmetric; M and K positive definite.
    points : mapping of str to array_like, shape (6, k) or (3, k)
        What carries the supports at the interface of this name: displacement and rotation along
        and about x, y, z per coordinate. With three rows it does not rotate.
    places : mapping of str to array_like, shape (3,), optional
        Where these points are [m]. Those given must be where the supports are: on the axis.
    participation : array_like, shape (3, k), optional
        S, the momentum along x, y, z per rate of each coordinate, ``ΦᵀMΨ``. Gravity and motions
        of the ground need it.

    Raises
    ------
    TypeError, ValueError
        For matrices of other shapes, not symmetric, not positive, or a foundation that the ground
        does not hold.

    Examples
    --------
    A block of 50 kg on four springs, below two bearings:

    >>> from exudyn_rotor import Foundation, Mount
    >>> corners = [[x, -0.3, z] for x in (-0.2, 0.2) for z in (-0.4, 0.4)]
    >>> block = Foundation.rigid(
    ...     mass=50.0, inertia=[4.0, 5.0, 1.0], center=[0.0, -0.2, 0.0],
    ...     mounts=[Mount(corner, 1e6, 200.0) for corner in corners],
    ...     points={"left": [0.0, 0.0, -0.3], "right": [0.0, 0.0, 0.3]},
    ... )
    >>> block
    Foundation(6 coordinates, 38.18 to 75.07 Hz, points: left, right)
    """

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    points: Mapping[str, np.ndarray]
    places: Mapping[str, np.ndarray] = field(default_factory=dict)
    participation: np.ndarray | None = None

    def __post_init__(self) -> None:
        size = len(checks.array(self.mass, "mass", "kg", shape=(None, None)))
        if size == 0:
            raise ValueError("mass: needs one coordinate or more")
        for name, unit in _UNITS.items():
            matrix = checks.symmetric(getattr(self, name), name, unit, size=size)
            checks.keep(self, **{name: checks.read_only(0.5 * (matrix + matrix.T))})
        _check_definite(self.mass, "mass: needs a positive definite matrix [kg]")
        _check_definite(
            self.stiffness,
            "stiffness: needs a positive definite matrix [N/m], so that the ground holds every "
            "coordinate; add mounts, or clamp the structure",
        )
        _check_definite(self.damping, "damping: needs a matrix ≥ 0 [N s/m]", -_SINGULAR)
        checks.mapping(self.points, "points", "the motion (6, k) or (3, k) of each point")
        points = {
            checks.label(name, "points"): _motion(motion, f"points: {name!r}", size)
            for name, motion in self.points.items()
        }
        if not points:
            raise ValueError(
                "points: needs the motion of one point or more, which carries supports"
            )
        places = _positions(self.places, "places")
        for name in places.keys() - points.keys():
            raise ValueError(f"places: {name!r} is none of the points {', '.join(points)}")
        checks.keep(self, points=checks.read_only_mapping(points))
        checks.keep(self, places=checks.read_only_mapping(places))
        if self.participation is not None:
            S = checks.array(self.participation, "participation", "kg", shape=(3, size))
            checks.keep(self, participation=S)

    @classmethod
    def rigid(
        cls,
        mass: float,
        inertia: ArrayLike,
        center: ArrayLike,
        mounts: Sequence[Mount] | Mount,
        points: Mapping[str, ArrayLike],
    ) -> Foundation:
        """Return a rigid block on mounts; its rotations are small.

        Parameters
        ----------
        mass : float
            [kg]
        inertia : array_like, shape (3,) or (3, 3)
            About the centre of mass, along x, y, z [kg m²].
        center : array_like, shape (3,)
            Centre of mass [m].
        mounts : sequence of Mount
            At places.
        points : mapping of str to array_like, shape (3,)
            Where the block carries the supports at the interfaces of these names [m].
        """
        mass = checks.number(mass, "mass", "kg", above=0.0)
        moments = checks.array(inertia, "inertia", "kg m²")
        if moments.shape == (3,):
            moments = np.diag(moments)
        moments = checks.symmetric(moments, "inertia", "kg m²", size=3)
        _check_definite(moments, "inertia: needs a positive definite matrix [kg m²]")
        center = checks.vector(center, "center", "m")
        places = _positions(points, "points")
        M = scipy.linalg.block_diag(mass * np.eye(3), moments)
        held = []
        for mount in checks.instances(mounts, "mounts", Mount):
            if isinstance(mount.at, str):
                raise ValueError(f"mounts: a rigid block needs places [m], got {mount.at!r}")
            held.append((mount, _of_rigid(mount.at - center)))
        K, D = _on_mounts(np.zeros((6, 6)), np.zeros((6, 6)), held)
        motions = {name: _of_rigid(place - center) for name, place in places.items()}
        return cls(M, D, K, motions, places, M[:3])

    @classmethod
    def from_modes(
        cls,
        frequencies: ArrayLike,
        damping_ratios: ArrayLike,
        points: Mapping[str, ArrayLike],
        *,
        masses: ArrayLike = 1.0,
        places: Mapping[str, ArrayLike] | None = None,
        participation: ArrayLike | None = None,
    ) -> Foundation:
        """Return a foundation given by its modes, as by an analysis or a modal test.

        Parameters
        ----------
        frequencies : array_like, shape (k,)
            Undamped natural frequencies > 0 [rad/s].
        damping_ratios : float or array_like, shape (k,)
            From 0 to 1.
        points : mapping of str to array_like, shape (6, k) or (3, k)
            Mode shapes at the points that carry supports, see :class:`Foundation`.
        masses : float or array_like, shape (k,), optional
            Modal masses of these shapes [kg]; 1 where they are normalised by the mass.
        places, participation
            See :class:`Foundation`.
        """
        count = np.size(frequencies)
        omega = checks.one_or_each(frequencies, "frequencies", "rad/s", count, above=0.0)
        zeta = checks.one_or_each(damping_ratios, "damping_ratios", "", count, least=0.0, most=1.0)
        m = checks.one_or_each(masses, "masses", "kg", count, above=0.0)
        matrices = m, 2.0 * zeta * omega * m, omega**2 * m
        known = {} if places is None else places
        return cls(*map(np.diag, matrices), points, known, participation)

    @classmethod
    def from_solid(
        cls,
        solid: SolidRotor | ReducedRotor,
        points: Mapping[str, ArrayLike],
        *,
        mounts: Sequence[Mount] | Mount = (),
        modes: int = 12,
    ) -> Foundation:
        """Return an elastic structure from its finite elements.

        Parameters
        ----------
        solid : SolidRotor or ReducedRotor
            The structure, meshed where it stands, with an interface for every point and mount; its
            axis plays no part. Clamp it (:meth:`SolidRotor.clamped`) or give mounts. Damping is its
            own (:meth:`SolidRotor.with_damping`).
        points : mapping of str to array_like, shape (3,)
            Where the interface of this name carries the support of the same name [m]: a rigid arm
            leads from the interface there.
        mounts : sequence of Mount, optional
            At interfaces, whose mean displacement they act on.
        modes : int, optional
            Of a SolidRotor: eigenmodes with the interfaces fixed, beside their static modes.
        """
        checks.instance(solid, "solid", (SolidRotor, ReducedRotor))
        mounts = checks.instances(mounts, "mounts", Mount)
        places = _positions(points, "points")
        used = checks.labels(tuple(points), "points", solid.interfaces)
        used += checks.labels([mount.at for mount in mounts], "mounts", solid.interfaces)
        if isinstance(solid, SolidRotor):
            count = checks.count(modes, "modes")
            basis = craig_bampton_modes(solid, count, list(dict.fromkeys(used)), coupling="RBE3")
            solid = solid.reduce(basis, prestress=False).without_shapes()
        if solid.invariants.H is not None:
            raise ValueError(
                "solid: its structural damping is for steady motions only; use "
                "with_damping(stiffness=…), or with_damping_ratio of the foundation"
            )
        held = [(mount, solid.interfaces[mount.at].motion) for mount in mounts]
        K, D = _on_mounts(solid.invariants.K, solid.invariants.D, held)
        motions = {
            name: _of_rigid(place - solid.interfaces[name].reference)
            @ solid.interfaces[name].motion
            for name, place in places.items()
        }
        return cls(solid.invariants.M, D, K, motions, places, solid.invariants.S)

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return len(self.mass)

    @cached_property
    def frequencies(self) -> np.ndarray:
        """Undamped natural frequencies of the foundation alone, ascending [rad/s]."""
        return np.sqrt(scipy.linalg.eigh(self.stiffness, self.mass, eigvals_only=True))

    @cached_property
    def mode_shapes(self) -> np.ndarray:
        """Its modes, ascending, as columns (k, k) normalised by the mass [1/√kg]."""
        return scipy.linalg.eigh(self.stiffness, self.mass)[1]

    def __repr__(self) -> str:
        """Return a short summary."""
        low, high = self.frequencies[[0, -1]] / (2.0 * np.pi)
        return (
            f"Foundation({self.size} coordinates, {low:.4g} to {high:.4g} Hz, points: "
            f"{', '.join(self.points)})"
        )

    def modal(self) -> Foundation:
        """Return the same foundation in the coordinates of its modes, normalised by the mass."""
        T = self.mode_shapes
        return replace(
            self,
            mass=np.eye(self.size),
            damping=T.T @ self.damping @ T,
            stiffness=np.diag(self.frequencies**2),
            points={name: motion @ T for name, motion in self.points.items()},
            participation=None if self.participation is None else self.participation @ T,
        )

    def with_damping_ratio(self, ratio: float) -> Foundation:
        """Return the foundation with one damping ratio of all its modes, instead of its damping."""
        checks.number(ratio, "ratio", least=0.0, most=1.0)
        rates = self.mass @ self.mode_shapes
        return replace(self, damping=(rates * (2.0 * ratio * self.frequencies)) @ rates.T)

    def turned(self, rotation: np.ndarray, position: ArrayLike = (0.0, 0.0, 0.0)) -> Foundation:
        """Return it in other axes, into which `rotation` (3, 3) leads, the origin at `position`."""
        rotation = checks.rotation(rotation)
        position = checks.vector(position, "position", "m")
        S = self.participation
        return replace(
            self,
            points={n: np.kron(np.eye(2), rotation) @ U for n, U in self.points.items()},
            places={n: rotation @ place + position for n, place in self.places.items()},
            participation=None if S is None else rotation @ S,
        )

    def motion(
        self, name: str, place: ArrayLike, leeway: ArrayLike = (0.0, 0.0, 0.0)
    ) -> np.ndarray:
        """Return displacement and rotation (6, k) of what carries the support `name`.

        `leeway` (3,) is by how much a mesh may put its `place` elsewhere, along the axis [m].

        Raises
        ------
        ValueError
            Where there is no such point, or it is not at the place [m] of the support.
        """
        place = checks.vector(place, "place", "m")
        if checks.label(name, "name") not in self.points:
            raise ValueError(
                f"name: the foundation has no point for the support at {name!r}, only for: "
                f"{', '.join(self.points)}"
            )
        slack = checks.vector(leeway, "leeway", "m")
        apart = np.linalg.norm(off_place(self.places.get(name, place) - place, slack))
        if apart > SAME_PLACE:
            raise ValueError(
                f"foundation: its point {name!r} is {apart:.3g} m off the support there, which is "
                f"at {np.round(place, 9).tolist()}"
            )
        return self.points[name]


def _positions(given: Mapping[str, ArrayLike], name: str) -> dict[str, np.ndarray]:
    checks.mapping(given, name, "the position of each point")
    return {n: checks.vector(place, f"{name}: {n!r}", "m") for n, place in given.items()}


def _of_rigid(arm: np.ndarray) -> np.ndarray:
    """Return displacement and rotation of a point at an arm from a rigid motion (6,)."""
    motion = np.eye(6)
    motion[:3, 3:] = -skew(arm)
    return motion


def _on_mounts(
    K: np.ndarray, D: np.ndarray, held: Sequence[tuple[Mount, np.ndarray]]
) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and damping with mounts at motions (6, k)."""
    for mount, motion in held:
        U = motion[:3]
        K, D = K + U.T @ mount.stiffness @ U, D + U.T @ mount.damping @ U
    return K, D


def _motion(value: ArrayLike, name: str, size: int) -> np.ndarray:
    motion = checks.array(value, name)
    if motion.shape not in ((3, size), (6, size)):
        raise ValueError(
            f"{name}: needs an array of shape (6, {size}) or (3, {size}): displacement, and "
            f"rotation, per coordinate; got shape {motion.shape}"
        )
    return checks.read_only(np.vstack([motion, np.zeros((6 - len(motion), size))]))


def _check_definite(matrix: np.ndarray, needed: str, least: float = _SINGULAR) -> None:
    """Refuse a symmetric matrix by its least eigenvalue, scaled to a diagonal of ones."""
    diagonal = np.diag(matrix)
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, np.abs(matrix).max() or 1.0))
    if np.linalg.eigvalsh(scale[:, None] * matrix * scale)[0] < least:
        lowest = np.linalg.eigvalsh(matrix)[0]
        raise ValueError(f"{needed}, got one with the eigenvalue {lowest:.3g}")


def _in_three_axes(value: float | ArrayLike, name: str, unit: str) -> np.ndarray:
    given = checks.array(value, name, unit)
    if given.ndim < 2:
        given = np.diag(checks.one_or_each(given, name, unit, 3, least=0.0))
    matrix = checks.symmetric(given, name, unit, size=3)
    _check_definite(matrix, f"{name}: needs a matrix ≥ 0 [{unit}]", -_SINGULAR)
    return matrix
