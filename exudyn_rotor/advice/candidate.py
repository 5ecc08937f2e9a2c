"""The rotor that a proposal starts from, alone or in a scene, as linear equations."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.model.body import RotorBody as LinearBody
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.fields import ModeKind
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.rotating_axes import axes_of

_BALANCED = 1e-5  # share of the rotor's size by which a mesh may be off the axis
_ORDER = 2  # harmonics of the speed by which turning coefficients couple: bearings, foundations


class Hill(NamedTuple):
    """Equations at a speed for h harmonics of it: ``(s²M + sD + K) X = F``, each (h k, h k).

    Attributes
    ----------
    M, D, K : ndarray
    rates : ndarray, shape (h k,)
        What a harmonic adds to the exponent s of a coordinate in the rotor frame, ``imΩ``.
    orders : ndarray, shape (h,)
    """

    M: np.ndarray
    D: np.ndarray
    K: np.ndarray
    rates: np.ndarray
    orders: np.ndarray

    @property
    def count(self) -> int:
        """Number k of coordinates."""
        return len(self.M) // len(self.orders)


@dataclass(frozen=True, eq=False)
class Candidate:
    """All modes that can be chosen from, and what holds the rotor.

    Attributes
    ----------
    source : LinearModel
        In axes of the rotor.
    flexible : ndarray of int
        Which coordinates of the rotor are flexible modes.
    grounded : bool
    supported : bool
        Whether it is known what holds the rotor.
    axial : bool
        Whether something acts along the axis; True where nothing is known.
    interfaces : tuple of str
    attached : Candidate or None
        The same with attachment modes; None where these are not known, as in a scene.
    held : tuple of int
        Coordinates of `source` without a steady motion: the spin, where nothing holds it. Loads
        that grow slowly would turn an eccentric rotor by far more than they move its interfaces.
    """

    source: LinearModel
    flexible: np.ndarray
    grounded: bool
    supported: bool
    axial: bool
    interfaces: tuple[str, ...]
    attached: Candidate | None = None
    held: tuple[int, ...] = ()
    _hill: dict[float, Hill] = field(default_factory=dict, repr=False)
    _motions: dict[float, tuple] = field(default_factory=dict, repr=False)

    @property
    def _rotor(self) -> LinearBody:
        return self.source.bodies[0]

    @property
    def invariants(self) -> Invariants:
        """Invariants in the basis of the coordinates of the rotor, about a point of the axis."""
        return self._rotor.alone.invariants

    @cached_property
    def frequencies(self) -> np.ndarray:
        """Frequencies of the flexible modes [rad/s]."""
        return np.sqrt(np.maximum(np.diag(self.invariants.K)[self.flexible], 0.0))

    @cached_property
    def translations(self) -> np.ndarray:
        """Load of a unit acceleration along (n1, n2, e), (3, k)."""
        return self._wide(axes_of(self._rotor.alone.rotor.axis).T @ self.invariants.S)

    def _wide(self, rows: np.ndarray) -> np.ndarray:
        return np.pad(rows, [(0, 0), (0, self.source.size - rows.shape[1])])

    def hill(self, speed: float) -> Hill:
        """Return the equations in the rotor frame at a speed [rad/s]."""
        if speed not in self._hill:
            system, k = self.source.at(speed), self.source.size
            step = system.step or _ORDER + 1
            orders = step * np.arange(-(_ORDER // step), _ORDER // step + 1)
            M = np.kron(np.eye(len(orders)), system.M)
            D, K = (
                np.block([[terms.get(m - n, np.zeros((k, k))) for n in orders] for m in orders])
                for terms in (system.D, system.K)
            )
            rates = np.repeat(1j * orders * speed, k)
            K = K + D * rates + M * rates**2
            self._hill[speed] = Hill(M, D + 2.0 * M * rates, K, rates, orders)
        return self._hill[speed]

    def motions(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Return exponents (2hk,) of the free motions [1/s] and their states (2hk, 2hk)."""
        if speed not in self._motions:
            made = self.hill(speed)
            rates = np.linalg.solve(made.M, np.hstack([-made.K, -made.D]))
            unit = np.eye(len(rates), 2 * len(rates), k=len(rates))
            self._motions[speed] = np.linalg.eig(np.vstack([unit, rates]))
        return self._motions[speed]

    def motion(self) -> np.ndarray:
        """Return the displacements that count, across the axis and along it if need be, (p, k)."""
        rows = 3 if self.axial else 2
        motions = (self._wide(self._rotor.motion(name)[:rows]) for name in self.interfaces)
        return np.vstack(list(motions))

    def inertia_loads(self) -> np.ndarray:
        """Return loads of acceleration, and of the rotor's own unbalance if it has one, (l, k)."""
        rows = self.translations[: 3 if self.axial else 2]
        inv = self.invariants
        across = np.eye(3) - np.outer(inv.direction, inv.direction)
        second = np.trace(inv.J)
        couple = np.linalg.norm(across @ inv.J @ inv.direction) / second
        unbalance = self.source.unbalance()[0].real
        # flexible modes of a balanced rotor stretch under the rotation; that is no unbalance
        static = np.linalg.norm(self.translations @ unbalance) / np.sqrt(inv.mass**3 * second)
        if max(couple, static) < _BALANCED:
            return rows
        return np.vstack([rows, unbalance])


def candidate(
    target: ReducedRotor | exudyn.MainSystem,
    body: RotorBody | None,
    supports: Sequence[Support] | Support | None,
    interfaces: Sequence[str] | None,
    axial: bool | None,
    speed: float = 0.0,
) -> Candidate:
    """Take a reduced rotor with its supports, or a scene with its body.

    Where `axial` is None, whether anything acts along the axis is found in the scene at a `speed`
    [rad/s].

    Raises
    ------
    TypeError, ValueError
        For a target of another kind, unknown interfaces, or supports given with a scene.
    """
    checks.instance(
        target, "target", (ReducedRotor, exudyn.MainSystem), "a scene needs body=…, too"
    )
    if axial is not None:
        checks.flag(axial, "axial")
    if isinstance(target, ReducedRotor):
        return _of_rotor(target, body, supports, interfaces, axial)
    if supports is not None:
        raise ValueError("supports: are for a rotor; a scene has its own connectors")
    return _of_scene(target, body, interfaces, axial, speed)


def _of_rotor(
    reduced: ReducedRotor,
    body: RotorBody | None,
    supports: Sequence[Support] | Support | None,
    interfaces: Sequence[str] | None,
    axial: bool | None,
) -> Candidate:
    known = supports is not None
    source = linear_model(reduced, body=body, supports=supports if known else (), axes="rotor")
    attached = None
    if reduced.with_attachments is not None:
        with warnings.catch_warnings():  # said above
            warnings.filterwarnings(
                "ignore", message="the (centre of mass|nearest principal axis) is"
            )
            attached = _of_rotor(reduced.with_attachments, body, supports, interfaces, axial)
    if axial is None:
        axial = not known or any(map(_acts_along, source.supports[""]))
    free = source.free_spins.shape[1] and ModeKind.SPIN in reduced.rigid_kinds
    return Candidate(
        source=source,
        flexible=np.arange(len(reduced.rigid_kinds), reduced.size),
        grounded=reduced.grounded,
        supported=known or reduced.grounded,
        axial=bool(axial),
        interfaces=_named(interfaces, tuple(reduced.interfaces)),
        attached=attached,
        held=(reduced.rigid_kinds.index(ModeKind.SPIN),) if free else (),
    )


def _acts_along(given: object) -> bool:
    """True if a support acts along the axis, at rest or spinning; a bearing acts across it."""
    if not isinstance(given, Support):
        return False
    matrices = [matrix for speed in (0.0, 1.0, 1e3) for matrix in given.matrices(speed)]
    return any(np.any(matrix[2]) or np.any(matrix[:, 2]) for matrix in matrices)


def _of_scene(
    mbs: exudyn.MainSystem,
    body: RotorBody | None,
    interfaces: Sequence[str] | None,
    axial: bool | None,
    speed: float,
) -> Candidate:
    reduced_body(body, how="a scene needs what add_rotor returned")
    source = linear_model(mbs, body=body, about="given", axes="rotor")
    rotor, alone = body.selection.source, source.bodies[0].alone
    elastic = [rotor.kinds[column] is ModeKind.ELASTIC for column in np.abs(alone.Q).argmax(axis=0)]
    return Candidate(
        source=source,
        flexible=np.flatnonzero((np.diag(alone.invariants.K) > 0.0) & elastic),
        grounded=rotor.grounded,
        supported=True,
        axial=_scene_acts_along(source, body, speed) if axial is None else bool(axial),
        interfaces=_named(interfaces, tuple(body.markers)),
    )


def _scene_acts_along(source: LinearModel, body: RotorBody, speed: float) -> bool:
    """True if gravity or a connector acts along the axis; films do not."""
    axis = body.frame.orientation @ body.motion.invariants.direction
    gravity = body.motion.gravity
    if body.gravity_load is not None:
        gravity = np.asarray(body.mbs.GetLoadParameter(body.gravity_load, "loadVector"))
    if abs(axis @ gravity) > 1e-9 * np.linalg.norm(gravity):
        return True
    Q, kinds = source.bodies[0].alone.Q, body.selection.source.rigid_kinds
    if ModeKind.AXIAL not in kinds:
        return True
    along, terms = Q[kinds.index(ModeKind.AXIAL)], list(source.at(speed).K.values())
    scale = max(np.abs(term).max() for term in terms)
    return any(np.abs(along @ term[: len(along)]).max() > 1e-9 * scale for term in terms)


def _named(interfaces: Sequence[str] | None, known: tuple[str, ...]) -> tuple[str, ...]:
    if interfaces is None:
        if not known:
            raise ValueError(
                "propose: the rotor has no interfaces (in a scene: no markers), so nothing says "
                "where it is loaded; add some with rotor.with_interface"
            )
        return known
    names = checks.labels(interfaces, "interfaces", known)
    if not names:
        raise ValueError(f"interfaces: needs some of those of the rotor: {', '.join(known)}")
    return names
