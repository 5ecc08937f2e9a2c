"""A scene whose rotor has the shapes, too, that its basis lacks first (coordinates c).

Connectors act on the rotor at its interfaces, by whose motion ``u = Uy + U_c c`` they see it. Where
the modes move the interfaces in every way, connectors cannot tell c from the motion ``y = Yc`` with

    UY = U_c,    Y = U⁺U_c,

the least one, in which other bodies stand still. A matrix X of the scene, less the rotor's own, is
therefore ``TᵀXT`` in all coordinates, with ``T = (I, Y)``: stiffness and damping alike, and each of
their harmonics. The rotor's own terms are those of its finer model. Along the axis and about it the
modes may move interfaces in fewer ways: where they do not stretch, axial springs count as shared by
all places.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import scipy.linalg

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.scene.linear_scene import LinearScene
from exudyn_rotor.linear.models.whole_space import InAllCoordinates
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.nodal import skew

# connectors that exert no moment on a marker with a rotation
_FORCES_ONLY = ("ConnectorCartesianSpringDamper", "ConnectorSpringDamper")
_ROUNDING = 1e-8  # share of the motion of an interface in that of its markers
_DEPENDENT = 1e-3  # of singular values of rows of unit length


@dataclass(frozen=True, eq=False)
class FinerScene(InAllCoordinates):
    """A scene with a finer rotor; its coordinates are those of the scene, then c.

    Attributes
    ----------
    given : LinearScene
    rotor : ReducedRotor
        With the columns of the rotor in the scene, then those that it lacks.
    places : mapping of str to ndarray, each (3, 6) or (6, 6)
        Interfaces that connectors act on: what they see of the interface's motion, mesh axes.
    """

    given: LinearScene
    rotor: ReducedRotor
    places: dict[str, np.ndarray]

    mesh: ClassVar[None] = None
    base_loads: ClassVar[None] = None
    standing_interfaces: ClassVar[tuple[str, ...]] = ()
    stiffness_varies: ClassVar[bool] = True

    @classmethod
    def of(cls, scene: LinearScene, rotor: ReducedRotor) -> FinerScene | None:
        """Give a scene a finer rotor; None where Y is not known.

        That is where a connector acts on coordinates of the rotor or on mesh nodes that are no
        interface, and where the modes do not move all of its places across the axis in every way.
        """
        places = _places(scene.body)
        if places is None:
            return None
        finer = cls(scene, rotor, places)
        return finer if finer._is_independent else None

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.given.size + self._more

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the interfaces that have a marker."""
        return self.given.interfaces

    @property
    def loaded(self) -> tuple[str, ...]:
        """Names of the interfaces that connectors act on."""
        return tuple(self.places)

    @property
    def is_balanced(self) -> bool:
        """Whether the rotor has no unbalance."""
        return self.given.is_balanced

    @property
    def unit_unbalance(self) -> np.ndarray:
        """Load of the rotor's own eccentricity per Ω², shape (k,)."""
        return np.r_[self.given.unit_unbalance, self._alone.invariants.h[self._kept :]]

    def interface_motion(self, name: str) -> np.ndarray:
        """Return an interface's motion (6, k), as :meth:`LinearScene.interface_motion`."""
        body = self.given.body
        place, at_marker = _seen_by(body, body.mbs.GetMarker(body.marker(name)))
        more = at_marker @ self.rotor.interfaces[place].motion[:, self._kept :]
        return np.hstack([self.given.interface_motion(name), self._turned(more)])

    def journal_motion(self, name: str) -> np.ndarray:
        """Return the displacement (3, k) of a journal, as :meth:`LinearScene.journal_motion`."""
        return self._motion(name)[:3]

    def at(self, speed: float) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s]."""
        scene, alone, F = self.given.at(speed), self._alone, self._columns
        inv = alone.invariants
        damping = inv.D + alone.terms.damping(speed)
        stiffness = inv.K + alone.terms.stiffness(speed)
        M, D, K = (
            {n: self._wider(X, F.T @ own @ F if n == 0 else None) for n, X in terms.items()}
            for terms, own in ((scene.M, inv.M), (scene.D, damping), (scene.K, stiffness))
        )
        H = None if inv.H is None else F.T @ inv.H @ F
        return replace(scene, M=M, D=D, K=K, H=H)

    def _wider(self, X: np.ndarray, own: np.ndarray | None) -> np.ndarray:
        """Return a matrix of the scene in all coordinates; `own` is what the finer rotor has."""
        T, k = self._alike, self.given.size
        if own is None:
            return T.T @ X @ T
        wider = T.T @ (X - own[:k, :k]) @ T + own
        wider[:k, :k] = X
        return wider

    @property
    def _kept(self) -> int:
        """Number of columns of the rotor in the scene."""
        return self.given.body.selection.source.size

    @property
    def _more(self) -> int:
        """Number of columns that it lacks."""
        return self.rotor.size - self._kept

    @cached_property
    def _alone(self) -> LinearRotor:
        """The finer rotor without supports."""
        with warnings.catch_warnings():  # said where the rotor was put into the scene
            warnings.filterwarnings(
                "ignore", message="the (centre of mass|nearest principal axis) is"
            )
            return LinearRotor.of(self.rotor, (), self.given.stiffening)

    @cached_property
    def _columns(self) -> np.ndarray:
        """Coordinates of the finer rotor by these, shape (l, k)."""
        scene, kept = self.given, self._kept
        # a translation of the frame is one of the whole rotor, q = Sᵀa
        moved = self.rotor.invariants.S[:, :kept].T @ scene.axes[:, : scene.count]
        known = np.hstack([moved, scene.body.selection.T]) @ scene.N[: scene.modal.stop]
        return scipy.linalg.block_diag(known, np.eye(self._more))

    @cached_property
    def _alike(self) -> np.ndarray:
        """T: the motions of the scene that connectors take these for, shape (k, size)."""
        k = self.given.size
        seen = np.vstack([np.zeros((0, self.size)), *map(self._motion, self.places)])
        seen = _scale(seen[:, :k])[:, None] * seen
        return np.hstack([np.eye(k), np.linalg.pinv(seen[:, :k], rcond=_DEPENDENT) @ seen[:, k:]])

    @property
    def _is_independent(self) -> bool:
        """Whether the modes move the places across the axis in every way."""
        across = [
            self._motion(name)[[i for i in range(len(seen)) if i % 3 < 2], : self.given.size]
            for name, seen in self.places.items()
        ]
        if not across:
            return True
        rows = np.vstack(across)
        if len(rows) > rows.shape[1]:
            return False
        sizes = np.linalg.svd(_scale(rows)[:, None] * rows, compute_uv=False)
        return bool(sizes[-1] > _DEPENDENT * sizes[0])

    def _motion(self, name: str) -> np.ndarray:
        """Return what connectors see of an interface, along (n1, n2, e)."""
        return self._turned(self.places[name] @ self.rotor.interfaces[name].motion @ self._columns)

    def _turned(self, motion: np.ndarray) -> np.ndarray:
        return np.kron(np.eye(len(motion) // 3), self.given.axes.T) @ motion


def _scale(rows: np.ndarray) -> np.ndarray:
    """Return the inverse lengths of rows; of those that are zero beside the others, a number."""
    lengths = np.linalg.norm(rows, axis=1)
    return 1.0 / np.maximum(lengths, max(_DEPENDENT * lengths.max(initial=0.0), 1e-300))


def _rigid(arm: np.ndarray) -> np.ndarray:
    """Return the motion (6, 6) of a point at an arm from that of its interface."""
    motion = np.eye(6)
    motion[:3, 3:] = -skew(arm)
    return motion


def _places(body: RotorBody) -> dict[str, np.ndarray] | None:
    """Return what connectors see of interfaces; None where they act on anything else as well."""
    places: dict[str, np.ndarray] = {}
    for item, marker in _connections(body):
        seen = _seen_by(body, marker)
        if seen is None:
            return None
        name, motion = seen
        if marker["markerType"] == "SuperElementPosition" or item["objectType"] in _FORCES_ONLY:
            motion = motion[:3]
        known = places.setdefault(name, motion)
        if known.shape != motion.shape or not np.allclose(known, motion):
            places[name] = np.eye(6)
    return places


def _connections(body: RotorBody) -> Iterator[tuple[dict, dict]]:
    """Yield connectors and the marker of the rotor at which each acts, but those on its spin."""
    mbs, locks = body.mbs, {int(number) for number in body.constraints.values()}
    nodes = {int(number) for number in body.nodes.values()}
    objects = {int(number) for number in body.objects.values()}
    for number in range(mbs.systemData.NumberOfObjects()):
        item = mbs.GetObject(number)
        if number in locks or not item.get("activeConnector", 1):
            continue
        for marker in map(mbs.GetMarker, item.get("markerNumbers", ())):
            on_body = int(marker.get("bodyNumber", -1)) in objects
            on_node = int(marker.get("nodeNumber", -1)) in nodes and not _is_spin(body, marker)
            if on_body or on_node:
                yield item, marker


def _is_spin(body: RotorBody, marker: dict) -> bool:
    """Return whether a marker is the spin angle, which is prescribed here."""
    return (
        marker["markerType"] == "NodeCoordinate"
        and int(marker["nodeNumber"]) == int(body.nodes.get("rigid", -1))
        and int(marker["coordinate"]) == body.frame.spin
    )


def _seen_by(body: RotorBody, marker: dict) -> tuple[str, np.ndarray] | None:
    """Return the interface that a marker belongs to, and the marker's motion (6, 6) by its own."""
    if not str(marker["markerType"]).startswith("SuperElement"):
        return None
    marker_body = body.mbs.GetObject(body.objects["marker_body"])
    nodes = list(marker["meshNodeNumbers"])
    weights = np.asarray(marker["weightingFactors"])
    places = np.reshape(marker_body["referencePositions"], (-1, 3))[nodes]
    columns = np.asarray(marker_body["modeBasis"])
    columns = columns.reshape(len(columns) // 3, 3, -1)[nodes]
    point = body.frame.origin + body.frame.B.T @ (weights @ places)
    moved = body.frame.B.T @ np.tensordot(weights, columns, 1)
    known = body.selection.source.interfaces.items()
    for name, interface in sorted(known, key=lambda one: np.linalg.norm(point - one[1].reference)):
        motion = interface.motion @ body.selection.T
        for arm in (point - interface.reference, np.zeros(3)):  # seats move as the interface does
            expected = _rigid(arm) @ motion
            if np.abs(expected[:3] - moved).max() <= _ROUNDING * np.abs(motion).max():
                return name, _rigid(arm)
    return None
