"""The rotor that a proposal starts from, alone or in a scene, as linear equations."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.equations import PeriodicSystem
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
        The same with attachment modes; None where that is not known, as in a scene.
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
    _systems: dict[float, PeriodicSystem] = field(default_factory=dict, repr=False)

    @property
    def _rotor(self) -> LinearBody:
        return self.source.bodies[0]

    @property
    def invariants(self) -> Invariants:
        """Invariants in the basis of the coordinates of the rotor, about a point of the axis."""
        return self._rotor.alone.invariants

    @property
    def modal(self) -> np.ndarray:
        """Where the coordinates of the rotor stand among those of `source`."""
        return np.arange(self._rotor.size)

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

    @property
    def places(self) -> np.ndarray:
        """Where the flexible modes stand among the coordinates of `source`."""
        return self.flexible

    def conservative(self, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
        """Return Hermitian M, G, K of ``(−ν²M + νG + K) X = 0`` and the number of harmonics.

        Damping and circulatory forces are left out.
        """
        alone = self.resonating
        system = self.system(speed) if alone is self.source else alone.at(speed)
        orders = _harmonics(system)
        M, D, K = _hill(system, orders)
        G = 1j * D
        return M, 0.5 * (G + G.conj().T), 0.5 * (K + K.conj().T), len(orders)

    @cached_property
    def resonating(self) -> LinearModel:
        """The source; on what holds it in place of controllers, pads and voids, if it has these."""
        alone = self.source.undamped()
        return alone if alone.size < self.source.size else self.source

    def hill(self, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
        """Return M, D, K in the rotor frame, harmonics of the speed included."""
        system, orders = self.system(speed), self.orders(speed)
        return *_hill(system, orders), len(orders)

    def system(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s]; a scene is probed at many angles once."""
        if speed not in self._systems:
            self._systems[speed] = self.source.at(speed)
        return self._systems[speed]

    def orders(self, speed: float) -> np.ndarray:
        """Return the harmonics of the speed that :meth:`hill` holds."""
        return _harmonics(self.system(speed))

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
    return _of_scene(target, body, supports, interfaces, axial, speed)


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
    supports: Sequence[Support] | Support | None,
    interfaces: Sequence[str] | None,
    axial: bool | None,
    speed: float,
) -> Candidate:
    reduced_body(body, how="a scene needs what add_rotor returned")
    if supports is not None:
        raise ValueError("supports: are for a rotor; a scene has its own connectors")
    source = linear_model(mbs, body=body, about="given", axes="rotor")
    rotor = body.selection.source
    columns = np.abs(source.bodies[0].alone.Q).argmax(axis=0)
    elastic = [rotor.kinds[column] is ModeKind.ELASTIC for column in columns]
    return Candidate(
        source=source,
        flexible=np.flatnonzero((np.diag(source.bodies[0].alone.invariants.K) > 0.0) & elastic),
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
    along = Q[kinds.index(ModeKind.AXIAL)]
    system = source.at(speed)
    scale = max(np.abs(term).max() for term in system.K.values())
    return any(
        np.abs(along @ term[: len(along)]).max() > 1e-9 * scale for term in system.K.values()
    )


def _harmonics(system: PeriodicSystem) -> np.ndarray:
    """Return the harmonics of the speed that coefficients couple."""
    step = system.step or _ORDER + 1
    return step * np.arange(-(_ORDER // step), _ORDER // step + 1)


def _hill(system: PeriodicSystem, orders: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return M, D, K of ``(s²M + sD + K) X`` for harmonics X, in Hill's matrices (h k, h k)."""
    h, k = len(orders), system.size
    none = np.zeros((h, k, h, k), dtype=complex)
    M, D, K = none.copy(), none.copy(), none.copy()
    for a, m in enumerate(orders):
        for b, n in enumerate(orders):
            for blocks, terms in ((D, system.D), (K, system.K)):
                if m - n in terms:
                    blocks[a, :, b] = terms[m - n]
        M[a, :, a] = system.M
    M, D, K = (X.reshape(h * k, h * k) for X in (M, D, K))
    rate = np.repeat(1j * orders * system.speed, k)
    return M, D + 2.0 * M * rate, K + D * rate + M * rate**2


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
