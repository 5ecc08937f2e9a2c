"""The rotor that a proposal starts from, alone or in a scene, as linear equations."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.linear_model import linear_model
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.models.rotor.controlled_rotor import ControlledRotor
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.scene.linear_scene import LinearScene
from exudyn_rotor.linear.models.scene.remembering_scene import RememberingScene
from exudyn_rotor.linear.periodic.harmonics import hill_matrices
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.mode_kind import ModeKind
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
    source : LinearRotor, ControlledRotor, LinearScene or RememberingScene
    invariants : Invariants
        In the basis of the rotor's modal coordinates.
    modal : ndarray of int
        Where the modal coordinates stand among those of `source`.
    flexible : ndarray of int
        Which modal coordinates are flexible modes.
    frequencies : ndarray
        Of the flexible modes [rad/s].
    grounded : bool
    supported : bool
        Whether it is known what holds the rotor.
    axial : bool
        Whether something acts along the axis; True where nothing is known.
    interfaces : tuple of str
    translations : ndarray, shape (3, k)
        Load of a unit acceleration along (n1, n2, e).
    attached : Candidate or None
        The same with attachment modes; None where that is not known, as in a scene.
    held : tuple of int
        Coordinates of `source` without a steady motion: the spin, where nothing holds it.
    """

    source: LinearRotor | ControlledRotor | LinearScene | RememberingScene
    invariants: Invariants
    modal: np.ndarray
    flexible: np.ndarray
    frequencies: np.ndarray
    grounded: bool
    supported: bool
    axial: bool
    interfaces: tuple[str, ...]
    translations: np.ndarray
    attached: Candidate | None = None
    held: tuple[int, ...] = ()
    _systems: dict[float, PeriodicSystem] = field(default_factory=dict, repr=False)

    @property
    def places(self) -> np.ndarray:
        """Where the flexible modes stand among the coordinates of `source`."""
        return self.modal[self.flexible]

    def conservative(self, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
        """Return Hermitian M, G, K of ``(−ν²M + νG + K) X = 0`` and the number of harmonics.

        Damping and circulatory forces are left out.
        """
        alone = self.resonating
        system = self.system(speed) if alone is self.source else alone.at(speed)
        orders = system.harmonics(_ORDER)
        M, D, K = hill_matrices(system, orders)
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
        return *hill_matrices(system, orders), len(orders)

    def system(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s]; a scene is probed at many angles once."""
        if speed not in self._systems:
            self._systems[speed] = self.source.at(speed)
        return self._systems[speed]

    def orders(self, speed: float) -> np.ndarray:
        """Return the harmonics of the speed that :meth:`hill` holds."""
        return self.system(speed).harmonics(_ORDER)

    def motion(self) -> np.ndarray:
        """Return the displacements that count, across the axis and along it if need be, (p, k)."""
        rows = 3 if self.axial else 2
        motions = (self.source.interface_motion(name)[:rows] for name in self.interfaces)
        return np.vstack(list(motions))

    def inertia_loads(self) -> np.ndarray:
        """Return loads of acceleration, and of the rotor's own unbalance if it has one, (l, k)."""
        rows = self.translations[: 3 if self.axial else 2]
        inv = self.invariants
        across = np.eye(3) - np.outer(inv.direction, inv.direction)
        second = np.trace(inv.J)
        couple = np.linalg.norm(across @ inv.J @ inv.direction) / second
        unbalance = np.asarray(self.source.unit_unbalance, dtype=float)
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
    source = linear_model(reduced, body=body, supports=supports if known else ())
    attached = None
    if reduced.with_attachments is not None:
        with warnings.catch_warnings():  # said above
            warnings.filterwarnings(
                "ignore", message="the (centre of mass|nearest principal axis) is"
            )
            attached = _of_rotor(reduced.with_attachments, body, supports, interfaces, axial)
    plain = source.plain if isinstance(source, ControlledRotor) else source
    if axial is None:  # what has coordinates of its own acts across the axis
        axial = not known or any(_acts_along(support) for support in plain.supports)
    first = len(reduced.rigid_kinds)
    return Candidate(
        source=source,
        invariants=source.invariants,
        modal=np.arange(reduced.size),
        flexible=np.arange(first, reduced.size),
        frequencies=reduced.frequencies[first:],
        grounded=reduced.grounded,
        supported=known or reduced.grounded,
        axial=bool(axial),
        interfaces=_named(interfaces, tuple(reduced.interfaces)),
        translations=_wide(axes_of(reduced.axis).T @ source.invariants.S, source),
        attached=attached,
        held=_free_spin(reduced, plain),
    )


def _free_spin(reduced: ReducedRotor, source: LinearRotor) -> tuple[int, ...]:
    """Return where the spin stands if nothing holds it: it has no steady motion.

    Loads that grow slowly would turn an eccentric rotor, and its interfaces with it, by far more
    than they move them.
    """
    if source.free_spin is None or ModeKind.SPIN not in reduced.rigid_kinds:
        return ()
    return (reduced.rigid_kinds.index(ModeKind.SPIN),)


def _acts_along(support: Support) -> bool:
    """True if a support acts along the axis, at rest or spinning."""
    matrices = [matrix for speed in (0.0, 1.0, 1e3) for matrix in support.matrices(speed)]
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
    scene = LinearScene.of(mbs, body, about="given")
    source = RememberingScene.of(scene)
    inv, kinds = body.motion.invariants, body.selection.kinds
    first = body.motion.formulation.translation_count
    # constraints may mix coordinates; those of the rotor's modes stay as they are
    modal = np.argmax(np.abs(scene.N[first : first + inv.size]), axis=1)
    elastic = [kind is ModeKind.ELASTIC for kind in kinds]
    flexible = np.flatnonzero((np.diag(inv.K) > 0.0) & elastic)
    return Candidate(
        source=source,
        invariants=inv,
        modal=modal,
        flexible=flexible,
        frequencies=np.sqrt(np.maximum(np.diag(inv.K)[flexible], 0.0)),
        grounded=body.selection.source.grounded,
        supported=True,
        axial=_scene_acts_along(scene, body, speed) if axial is None else bool(axial),
        interfaces=_named(interfaces, tuple(body.markers)),
        translations=_wide(_scene_translations(scene, body), source),
    )


def _wide(columns: np.ndarray, source: LinearModel) -> np.ndarray:
    """Return columns with zeros for coordinates that come last, of supports."""
    return np.pad(columns, [(0, 0), (0, source.size - columns.shape[1])])


def _scene_translations(scene: LinearScene, body: RotorBody) -> np.ndarray:
    inv = body.motion.invariants
    count = body.motion.formulation.translation_count
    loads = np.zeros((3, len(scene.free)))
    loads[:count, :count] = inv.mass * np.eye(3)[:count, :count]
    loads[:, count : count + inv.size] = axes_of(body.axis).T @ inv.S
    return loads @ scene.N


def _scene_acts_along(scene: LinearScene, body: RotorBody, speed: float) -> bool:
    """True if gravity or a connector acts along the axis; films do not."""
    axis = body.frame.orientation @ body.motion.invariants.direction
    gravity = body.motion.gravity
    if body.gravity_load is not None:
        gravity = np.asarray(body.mbs.GetLoadParameter(body.gravity_load, "loadVector"))
    if abs(axis @ gravity) > 1e-9 * np.linalg.norm(gravity):
        return True
    count = body.motion.formulation.translation_count
    kinds = body.selection.kinds
    if count == 3:
        row = 2
    elif ModeKind.AXIAL in kinds:
        row = count + kinds.index(ModeKind.AXIAL)
    else:
        return True
    row = int(np.argmax(np.abs(scene.N[row])))
    system = scene.at(speed)
    scale = max(np.abs(term).max() for term in system.K.values())
    return any(np.abs(term[row]).max() > 1e-9 * scale for term in system.K.values())


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
