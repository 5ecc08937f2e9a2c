"""Placing a rotor in its marker body: which angle of the body's node is the spin angle.

``NodeRigidBodyRxyz`` has the orientation ``Rx(a) Ry(b) Rz(c)``, and any one of the three angles may
turn without bound while the other two stand still. With n the spin axis in inertial axes and e in
mesh axes, the body can have the axes of the mesh where

- e is mesh z: c turns, however the rotor is mounted;
- n is inertial x: a turns, whatever e is;
- n is across inertial x and e across mesh z: b turns.

Elsewhere the axes of the marker body are the mesh axes turned by B, with ``B e = e_z``, and c
turns.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np
from exudyn.itemInterface import (
    CoordinateConstraint,
    MarkerNodeCoordinate,
    MarkerNodeCoordinates,
    NodePointGround,
    ObjectConnectorCoordinateVector,
    VCoordinateConstraint,
)
from scipy.spatial.transform import Rotation

from exudyn_rotor.theory.formulation import ConstantSpeed, Formulation, PrescribedMotion

FIRST, SECOND, THIRD = 3, 4, 5  # the angles among the coordinates of the node
_ALONG = 1e-8  # sine of the angle up to which an axis counts as a coordinate axis


@dataclass(frozen=True, eq=False)
class BodyFrame:
    """Mesh and scene as the marker body sees them."""

    origin: np.ndarray  # (3,) Of the frame, mesh coordinates [m]
    B: np.ndarray  # (3, 3) Mesh axes → axes of the marker body, the identity where that can be
    position: np.ndarray  # (3,) Of the frame origin at rest, inertial coordinates [m]
    angles: np.ndarray  # (3,) Reference Tait–Bryan angles (a, b, c) of the node [rad]
    spin: int  # 3, 4 or 5: the node's coordinate that is the spin angle

    @classmethod
    def of(
        cls, direction: np.ndarray, center: np.ndarray, position: np.ndarray, rotation: np.ndarray
    ) -> BodyFrame:
        """Place a rotor whose mesh origin lies at `position` with the orientation `rotation`.

        The origin is next to the mesh origin, where Exudyn's own body has its node. The frame does
        not tilt, so that its motion there is that of the `center`, the formulation's origin.
        """
        origin = center - direction * (direction @ center)
        B = np.eye(3)
        angles_and_spin = _with_mesh_axes(direction, rotation)
        if angles_and_spin is None:
            B = _turn_to_z(direction)
            angles_and_spin = _tait_bryan(rotation @ B.T), THIRD
        return cls(origin, B, position + rotation @ origin, *angles_and_spin)

    def axes_of_angles(self) -> np.ndarray:
        """Return the inertial axes (3, 3), in rows, that the node's angles turn about at rest."""
        a, b, _ = self.angles
        Rx, Ry = Rotation.from_euler("x", a).as_matrix(), Rotation.from_euler("y", b).as_matrix()
        return np.array([[1.0, 0.0, 0.0], Rx[:, 1], Rx @ Ry[:, 2]])

    def points(self, mesh_points: np.ndarray) -> np.ndarray:
        """Return mesh points (…, 3) in coordinates of the marker body."""
        return (np.asarray(mesh_points) - self.origin) @ self.B.T

    def columns(self, displacements: np.ndarray) -> np.ndarray:
        """Return nodal displacement columns (3n, k), given in mesh axes, in those of the body."""
        nodal = displacements.reshape(-1, 3, displacements.shape[1])
        return np.einsum("ab,nbk->nak", self.B, nodal).reshape(displacements.shape)


def _with_mesh_axes(
    direction: np.ndarray, orientation: np.ndarray
) -> tuple[np.ndarray, int] | None:
    """Return angles and spin coordinate of a body with mesh axes; None if there is none."""
    e, n = direction, orientation @ direction
    if np.hypot(e[0], e[1]) < _ALONG and e[2] > 0.0:
        return _tait_bryan(orientation), THIRD
    if np.hypot(n[1], n[2]) < _ALONG and n[0] > 0.0:
        return _tait_bryan(orientation), FIRST
    if abs(n[0]) < _ALONG and abs(e[2]) < _ALONG:  # Rx(a) e_y = n and Rz(−c) e_y = e
        a, c = np.arctan2(n[2], n[1]), np.arctan2(e[0], e[1])
        Ry = Rotation.from_euler("x", -a).as_matrix() @ orientation
        Ry = Ry @ Rotation.from_euler("z", -c).as_matrix()
        return np.array([a, np.arctan2(Ry[0, 2], Ry[0, 0]), c]), SECOND
    return None


def _tait_bryan(orientation: np.ndarray) -> np.ndarray:
    with warnings.catch_warnings():
        # at b = ±90° the split of a and c is free, and any serves: one of them turns by θ
        warnings.simplefilter("ignore", UserWarning)
        # a copy, as scipy takes no read-only matrix before 1.15.2
        return Rotation.from_matrix(np.array(orientation)).as_euler("XYZ")


def _turn_to_z(direction: np.ndarray) -> np.ndarray:
    """Return the smallest rotation that takes `direction` to e_z."""
    across = np.cross(direction, [0.0, 0.0, 1.0])
    size = np.linalg.norm(across)
    across = across / size if size else np.array([1.0, 0.0, 0.0])  # any serves for −e_z
    return Rotation.from_rotvec(np.arctan2(size, direction[2]) * across).as_matrix()


LOCKINGS = ("auto", "mass", "constraints")
MODES = 6  # the first coordinate after those of the rigid-body node
LOCKS = "locks"  # name of the constraint of all that stand still or turn at constant speed

LockedForce = Callable[[float], np.ndarray]


@dataclass(frozen=True, eq=False)
class Locks:
    """What happens to the six rigid coordinates of the marker body.

    Where the plane of translation is skew in space, all three translations are unknowns, and one
    row along the `normal` holds them in the plane.
    """

    unknown: tuple[int, ...]  # coordinates that are unknowns of the formulation
    fixed: tuple[int, ...]  # the tilts at last
    prescribed: dict[int, PrescribedMotion | ConstantSpeed]  # by the coordinate, scalar
    spin: int  # the spin angle
    plane: np.ndarray | None  # (3, 2) Inertial directions of in-plane unknowns
    normal: np.ndarray | None  # (3,)

    @classmethod
    def of(cls, formulation: Formulation, spin_direction: np.ndarray, spin: int) -> Locks:
        """Sort the coordinates for a spin axis along `spin_direction` in inertial axes."""
        translations, plane, normal = list(range(3)), None, None
        if formulation.translation_count == 0:
            translations = []
        elif formulation.translation_count == 2:
            along = np.flatnonzero(np.abs(spin_direction) > 1.0 - 1e-14)
            if along.size:
                translations.remove(along[0])
                plane = np.eye(3)[:, translations]
            else:
                normal = spin_direction
        rest = [i for i in range(3) if i not in translations]
        prescribed: dict[int, PrescribedMotion | ConstantSpeed] = {}
        if formulation.moves_origin:
            prescribed = {i: _component(formulation.translation, i) for i in rest}
            rest = []
        unknown = tuple(translations)
        if formulation.has_spin:
            unknown = (*unknown, spin)
        else:
            prescribed[spin] = formulation.spin
        tilts = [i for i in range(3, MODES) if i != spin]
        return cls(unknown, (*rest, *tilts), prescribed, spin, plane, normal)

    @property
    def tilts(self) -> tuple[int, int]:
        """The two coordinates that tilt the frame, always locked."""
        return self.fixed[-2:]

    @property
    def names(self) -> list[str]:
        """Names of the six coordinates."""
        names = ["x", "y", "z", "tilt a", "tilt b"]
        names.insert(self.spin, "spin")
        return names

    @property
    def varying(self) -> dict[int, PrescribedMotion]:
        """Coordinates with a time-varying prescribed motion."""
        return {i: m for i, m in self.prescribed.items() if isinstance(m, PrescribedMotion)}

    @property
    def locked_names(self) -> tuple[str, ...]:
        """Names of the coordinates that are no unknowns."""
        return tuple(self.names[i] for i in (*self.fixed, *self.prescribed))

    @property
    def stand_still(self) -> bool:
        """True where explicit solvers run: locked coordinates stand still, and are eliminated."""
        return not self.prescribed and self.normal is None

    @property
    def rows(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows (c, 6) over the coordinates, and the rates (c,) at which one constraint holds them.

        What varies with time is not among them.
        """
        steady = [i for i, motion in self.prescribed.items() if i not in self.varying]
        rows = np.eye(MODES)[[*self.fixed, *steady]]
        rates = np.array([0.0] * len(self.fixed) + [self.prescribed[i].speed for i in steady])
        if self.normal is not None:
            rows = np.vstack([rows, np.append(self.normal, np.zeros(3))])
            rates = np.append(rates, 0.0)
        return rows, rates


def _component(motion: PrescribedMotion, index: int) -> PrescribedMotion:
    """Return one coordinate of a prescribed translation."""
    return PrescribedMotion(
        lambda t: float(motion.value(t)[index]),
        lambda t: float(motion.rate(t)[index]),
        lambda t: float(motion.acceleration(t)[index]),
    )


@dataclass(frozen=True, eq=False)
class Layout:
    """Where the unknowns of a formulation stand among the coordinates of the nodes."""

    size: int  # of the nodes' coordinates
    unknowns: np.ndarray  # the coordinate of every unknown of the equations
    lock_mass: np.ndarray  # (size,) Masses of locked coordinates, zero for unknowns

    def spread(self, matrix: np.ndarray, diagonal: np.ndarray | float = 0.0) -> np.ndarray:
        """Return a (size, size) matrix with `matrix` on the unknowns and `diagonal` added."""
        full = np.diag(np.broadcast_to(diagonal, self.size).astype(float))
        full[np.ix_(self.unknowns, self.unknowns)] += matrix
        return full


def held(
    mbs: exudyn.MainSystem,
    ground: exudyn.NodeIndex,
    node: exudyn.NodeIndex,
    index: int,
    **motion: Any,
) -> exudyn.ObjectIndex:
    """Add a constraint of one coordinate of a node; explicit solvers eliminate it."""
    ends = [
        mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=number, coordinate=coordinate))
        for number, coordinate in ((ground, 0), (node, index))
    ]
    hidden = VCoordinateConstraint(show=False)
    return mbs.AddObject(CoordinateConstraint(markerNumbers=ends, visualization=hidden, **motion))


def add_constraints(
    mbs: exudyn.MainSystem, locks: Locks, node: exudyn.NodeIndex
) -> dict[str, exudyn.ObjectIndex]:
    """Hold the locked coordinates of the frame's node by constraints; return them by name."""
    ground = mbs.AddNode(NodePointGround())
    if locks.stand_still:
        return {locks.names[index]: held(mbs, ground, node, index) for index in locks.fixed}
    ends = [mbs.AddMarker(MarkerNodeCoordinates(nodeNumber=number)) for number in (ground, node)]
    rows, rates = locks.rows
    # at velocity level: drift is round-off, and a constant speed needs no function of time
    item = ObjectConnectorCoordinateVector(
        markerNumbers=ends,
        scalingMarker0=np.zeros((len(rates), 0)),
        scalingMarker1=rows,
        offset=rates,
        velocityLevel=True,
        visualization={"show": False},
    )
    constraints = {LOCKS: mbs.AddObject(item)}
    for index, motion in locks.varying.items():
        # index-2 solvers need the velocity beside the position
        constraints[locks.names[index]] = held(
            mbs,
            ground,
            node,
            index,
            offsetUserFunction=lambda mbs, t, item, offset, motion=motion: motion.value(t),
            offsetUserFunction_t=lambda mbs, t, item, offset, motion=motion: motion.rate(t),
        )
    return constraints
